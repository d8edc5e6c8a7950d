"""How glyphs are converted: :class:`Options`, checked where they are made."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any, Literal, get_args

from ..errors import OptionError

Corners = Literal["smooth", "sharp"]
Effort = Literal["fast", "best"]
Fallback = Literal["knot", "peak"]

CHOICES: dict[str, tuple[Any, ...]] = {
    "variant": (0, 1, 2, 3, 4),
    "corners": get_args(Corners),
    "effort": get_args(Effort),
    "fallback": get_args(Fallback),
    "measure": (False, True),
    "remove_overlaps": (False, True),
}
"""Options that are one of a few values."""

COUNTS = {"count": (3, 200_000), "precision": (0, 9), "max_iterations": (0, 10**9)}
"""Options that are whole numbers: the least and the largest."""

LARGEST_RATIO = 1e6

NUMBERS = {
    "tolerance": ("a positive distance", 0.0, math.inf),
    "step": ("a positive distance", 0.0, math.inf),
    "residual_tolerance": ("a positive distance", 0.0, math.inf),
    "corner_angle": ("an angle in degrees, above 0 and up to 180", 0.0, math.nextafter(180.0, math.inf)),
    "margin": ("a number from 0 to 0.5", -math.ulp(0.0), math.nextafter(0.5, 1.0)),
    "max_ratio": ("a ratio of 2 or more", math.nextafter(2.0, 0.0), LARGEST_RATIO),
}
"""Options that are numbers: what they are, and the limits between which they lie."""


@dataclass(frozen=True)
class Options:
    """How glyphs are converted. Lengths are in font units.

    Attributes:
        variant: 0 to 4 (the paper's Table 1).
        tolerance: two-sided distance allowed between the result and the source outline; None is 1/1000 em.
        step, count: sample by arc length or by number instead of by tolerance.
        corners: "smooth" is one closed C2 curve a contour (the paper), "sharp" splits at corners.
        corner_angle: the turn in degrees from which a join of segments is a corner: a vertex in "smooth", where arcs
            end in "sharp".
        effort: "fast" takes few fits, "best" seeks the fewest vertices.
        margin: c of Lemma 2. fallback: what to do where Lemma 2 has no interval, "knot" or "peak".
        max_ratio: bound on the ratio of adjacent chords.
        precision: decimals written, 0 to 9.
        residual_tolerance: the solver's, in font units; None is half of the last decimal written.
        max_iterations: of the interpolation, for each contour.
        measure: also measure distance, length and curvature where fitting does not need them (``step``, ``count``).
        remove_overlaps: unite overlapping contours before sampling.

    Raises:
        OptionError: a value out of its range or of the wrong kind, or options that contradict each other.
    """

    variant: int = 2
    tolerance: float | None = None
    step: float | None = None
    count: int | None = None
    corners: Corners = "smooth"
    corner_angle: float = 12.0
    effort: Effort = "fast"
    margin: float = 0.02
    fallback: Fallback = "peak"
    max_ratio: float = 4.0
    precision: int = 2
    residual_tolerance: float | None = None
    max_iterations: int = 1000
    measure: bool = False
    remove_overlaps: bool = False

    def __post_init__(self) -> None:
        for name, choices in CHOICES.items():
            _check_choice(name, getattr(self, name), choices)
        for name, (least, largest) in COUNTS.items():
            _check_count(name, getattr(self, name), least, largest)
        for name, (what, low, high) in NUMBERS.items():
            _check_number(name, getattr(self, name), what, low, high)
        given = [name for name in ("tolerance", "step", "count") if getattr(self, name) is not None]
        if len(given) > 1:
            raise OptionError(f"give one of tolerance, step and count, not {' and '.join(given)}")
        if self.corners == "sharp" and self.is_fixed:
            raise OptionError('step and count sample whole contours, which corners="sharp" cuts: give a tolerance')

    @property
    def is_fixed(self) -> bool:
        """Whether vertices are placed by ``step`` or ``count``, whatever the distance from the source."""
        return self.step is not None or self.count is not None

    def tolerance_for(self, units_per_em: float) -> float:
        """The geometric tolerance in font units."""
        return units_per_em / 1000 if self.tolerance is None else self.tolerance

    @property
    def solver_tolerance(self) -> float:
        """The solver's tolerance in font units."""
        return 0.5 * 10.0**-self.precision if self.residual_tolerance is None else self.residual_tolerance


def _check_choice(name: str, value: Any, choices: tuple[Any, ...]) -> None:
    fits = any(value == choice and isinstance(value, bool) == isinstance(choice, bool) for choice in choices)
    if not fits:
        raise OptionError(f"{name} is one of {', '.join(map(str, choices))}, not {value!r}")


def _check_count(name: str, value: Any, least: int, largest: int) -> None:
    if value is None and name == "count":
        return
    if isinstance(value, bool) or not (isinstance(value, Integral) and least <= int(value) <= largest):
        raise OptionError(f"{name} is a whole number from {least} to {largest}, not {value!r}")


def _check_number(name: str, value: Any, what: str, low: float, high: float) -> None:
    if value is None and name in ("tolerance", "step", "residual_tolerance"):
        return
    if isinstance(value, bool) or not (isinstance(value, Real) and low < float(value) < high):
        raise OptionError(f"{name} is {what}, not {value!r}")
