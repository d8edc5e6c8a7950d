"""How polygons are interpolated: one value for everything that does not depend on the polygon, checked once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import nan
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, get_args

from ..curves import DEGREES
from ..errors import OptionError, is_number, is_positive, is_whole, require, require_choice

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ..types import FloatArray

Parametrisation: TypeAlias = Literal["chord", "uniform", "centripetal"]
Fallback: TypeAlias = Literal["knot", "peak"]
Tangents: TypeAlias = "tuple[ArrayLike | None, ArrayLike | None]"

CHORD_EXPONENT: dict[str, float] = {"chord": 1.0, "centripetal": 0.5, "uniform": 0.0}

GIVEN = -1.0
"""In place of a chord exponent: knots are given."""

MOST_ITERATIONS = 10**9
"""Upper bound of ``max_iterations``."""

RELATIVE_TOLERANCE = 1e-6
"""The default of ``residual_tolerance``, as a share of the polygon's extent."""

PEAK_SHARE = 0.9
"""``fallback="peak"`` asks for B_i ≥ min(1/2 + c, this share of its peak).

Nearer to 1 the interval shrinks to the peak, which freezes the parameters; the lower, the less is left of
the bound of Theorem 2 where peaks are low.
"""

END_MARGIN = 1 / 16
"""Least margin of the first and the last vertex of an arc.

With c = 0 their intervals would begin at the end of the arc, where nothing moves. The largest W_i is above 5/8 for all
knots, and 9/16 is also ``PEAK_SHARE`` of that.
"""

TIE = 1e-12
"""Two squared distances are a tie if they differ by less than this share of them."""

TIE_DISTANCE = 1e-14
"""Distances below this share of the extent count as 0, and as a tie: their last bits are rounding errors."""


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
    diagnostics: bool = False

    def __post_init__(self) -> None:
        require(is_whole(self.variant, 0, 4), "variant is 0 to 4", self.variant)
        require(is_whole(self.degree, DEGREES[0], DEGREES[-1]), "degree is 2 to 6", self.degree)
        require(is_number(self.margin, 0, 0.5), "margin is 0 to 0.5", self.margin)
        known = self.knots is None or (isinstance(self.knots, str) and self.knots in CHORD_EXPONENT)
        require(known, f"knots are {', '.join(CHORD_EXPONENT)} or an array", self.knots)
        require_choice("fallback", self.fallback, get_args(Fallback))
        positive = self.residual_tolerance is None or is_positive(self.residual_tolerance)
        require(positive, "residual_tolerance is a positive distance or None", self.residual_tolerance)
        rule = f"max_iterations is a whole number from 0 to {MOST_ITERATIONS}"
        require(is_whole(self.max_iterations, 0, MOST_ITERATIONS), rule, self.max_iterations)
        require_choice("closed", self.closed)
        require_choice("diagnostics", self.diagnostics)
        if not self.closed and self.degree != 3:
            raise OptionError("an open arc is cubic (degree=3)")

    @property
    def readable(self) -> bool:
        """Whether it takes the method in its plainest form (:mod:`.reference`): other degrees, diagnostics."""
        return self.degree != 3 or self.diagnostics

    @property
    def peak_share(self) -> float:
        """``PEAK_SHARE`` with ``fallback="peak"``, else 0."""
        return PEAK_SHARE if self.fallback == "peak" else 0.0

    @cached_property
    def numbers(self) -> FloatArray:
        """(7,) what :func:`.found.rule_of` reads: an array is handed over in less time than a named tuple."""
        import numpy as np  # which a command that checks its options does not need

        exponent = GIVEN if self.knots is None else CHORD_EXPONENT[self.knots]
        tolerance = nan if self.residual_tolerance is None else self.residual_tolerance
        return np.array(
            (self.closed, self.variant, self.margin, exponent, tolerance, self.peak_share, self.max_iterations),
            dtype=np.float64,
        )

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
