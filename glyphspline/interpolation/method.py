"""How polygons are interpolated: one value for everything that does not depend on the polygon, checked once."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from numbers import Integral, Real
from typing import Any, Literal, TypeAlias

from numpy.typing import ArrayLike

from ..curves.bspline import DEGREES
from ..curves.parameters import CHORD_EXPONENT, Parametrisation
from ..errors import OptionError

Fallback: TypeAlias = Literal["knot", "peak"]
Finish: TypeAlias = Literal["iterate", "solve"]
Tangents: TypeAlias = tuple[ArrayLike | None, ArrayLike | None]

STEPWISE = (0, 4)
"""Variants that the passes of many vertices at once do not have."""

RELATIVE_TOLERANCE = 1e-6
"""The default of ``residual_tolerance``, as a share of the polygon's extent."""

PEAK_SHARE = 0.9
"""``fallback="peak"`` asks for B_i ≥ min(1/2 + c, this share of its peak).

Nearer to 1 the interval shrinks to the peak, which freezes the parameters; the lower, the less is left of
the bound of Theorem 2 where peaks are low.
"""

TIE = 1e-12
"""Two squared distances are a tie if they differ by less than this share of them."""

TIE_DISTANCE = 1e-14
"""Distances below this share of the extent count as 0, and as a tie: their last bits are rounding errors."""

SETTLED = 3e-3
"""``finish="solve"`` freezes the footpoints once the largest error is below this share of the mean chord.

The curve then lies beside the limit of the iteration: measured on contours of glyphs, by 5e-4 of the mean chord
(median; at most 1.5e-3), on random polygons by 3e-4. At 1e-3 that is a third of it, for a quarter more passes; at 1e-2
three times as much, for a quarter less.
"""


@dataclass(frozen=True)
class Method:
    """How polygons are interpolated. The arguments of :func:`glyphspline.interpolate` say what each attribute means.

    Attributes:
        knots: a rule, or None where each polygon has parameters of its own.

    Raises:
        OptionError: a value out of its range or of the wrong kind, or values that contradict each other.
    """

    variant: int = 2
    degree: int = 3
    margin: float = 0.0
    knots: Parametrisation | None = "chord"
    fallback: Fallback = "knot"
    residual_tolerance: float | None = None
    max_iterations: int = 1000
    closed: bool = True
    finish: Finish = "iterate"
    diagnostics: bool = False

    def __post_init__(self) -> None:
        _check(_whole(self.variant) and 0 <= self.variant <= 4, "variant is 0 to 4", self.variant)
        _check(_whole(self.degree) and self.degree in DEGREES, "degree is 2 to 6", self.degree)
        _check(_number(self.margin) and 0 <= self.margin <= 0.5, "margin is 0 to 0.5", self.margin)
        rules = ", ".join(CHORD_EXPONENT)
        _check(self.knots is None or _one_of(self.knots, *CHORD_EXPONENT), f"knots are {rules} or an array", self.knots)
        _check(_one_of(self.fallback, "knot", "peak"), 'fallback is "knot" or "peak"', self.fallback)
        tolerance = self.residual_tolerance
        positive = tolerance is None or (_number(tolerance) and tolerance > 0)
        _check(positive, "residual_tolerance is a positive distance or None", tolerance)
        whole = _whole(self.max_iterations) and self.max_iterations >= 0
        _check(whole, "max_iterations is a whole number, 0 or more", self.max_iterations)
        _check(_truth(self.closed), "closed is True or False", self.closed)
        _check(_one_of(self.finish, "iterate", "solve"), 'finish is "iterate" or "solve"', self.finish)
        _check(_truth(self.diagnostics), "diagnostics is True or False", self.diagnostics)
        if not self.closed and self.degree != 3:
            raise OptionError("an open arc is cubic (degree=3)")

    @property
    def stepwise(self) -> bool:
        """Whether each polygon is iterated on its own, by the passes of any degree and variant."""
        return self.degree != 3 or self.variant in STEPWISE or self.diagnostics

    @property
    def peak_share(self) -> float:
        """``PEAK_SHARE`` with ``fallback="peak"``, else 0."""
        return PEAK_SHARE if self.fallback == "peak" else 0.0

    def tolerance_for(self, extent: float) -> float:
        """The residual tolerance for a polygon of this extent."""
        return RELATIVE_TOLERANCE * extent if self.residual_tolerance is None else self.residual_tolerance


_known = lru_cache(maxsize=64, typed=True)(Method)


def method_of(*values: Any) -> Method:
    """The :class:`Method` of these attributes, in order, checked once for many calls with the same."""
    try:
        return _known(*values)
    except TypeError:  # a value that cannot be hashed
        return Method(*values)


def _check(good: bool, rule: str, value: object) -> None:
    if not good:
        raise OptionError(f"{rule}, not {value!r}")


def _whole(value: object) -> bool:
    return isinstance(value, Integral) and not isinstance(value, bool)


def _number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


def _truth(value: object) -> bool:
    return isinstance(value, bool)


def _one_of(value: object, *words: str) -> bool:
    return isinstance(value, str) and value in words
