"""How glyphs are converted: :class:`Options`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Corners = Literal["smooth", "sharp"]
Effort = Literal["fast", "best"]


@dataclass(frozen=True)
class Options:
    """How glyphs are converted. Lengths are in font units.

    Attributes:
        variant: 0 to 4 (the paper's Table 1).
        tolerance: two-sided distance allowed between the result and the source outline; None is 1/1000 em.
        step, count: sample by arc length or by number instead of by tolerance.
        corners: "smooth" is one closed C2 curve a contour (the paper), "sharp" splits at corners.
        corner_angle: in "sharp", the turn in degrees from which a join of segments is a corner.
        effort: "fast" takes few fits, "best" seeks the fewest vertices.
        margin: c of Lemma 2. fallback: what to do where Lemma 2 has no interval, "knot" or "peak".
        max_ratio: bound on the ratio of adjacent chords.
        precision: decimals written; the solver's residual tolerance is half of the last of them.
        max_iterations: of the interpolation, for each contour.
        measure: also measure deviation where it is not needed for fitting (``step``, ``count``).
        remove_overlaps: unite overlapping contours before sampling.
    """

    variant: int = 2
    tolerance: float | None = None
    step: float | None = None
    count: int | None = None
    corners: Corners = "smooth"
    corner_angle: float = 12.0
    effort: Effort = "fast"
    margin: float = 0.02
    fallback: Literal["knot", "peak"] = "peak"
    max_ratio: float = 4.0
    precision: int = 2
    max_iterations: int = 1000
    measure: bool = False
    remove_overlaps: bool = False

    def tolerance_for(self, units_per_em: float) -> float:
        """The geometric tolerance in font units."""
        return units_per_em / 1000 if self.tolerance is None else self.tolerance

    @property
    def residual_tolerance(self) -> float:
        """The solver's tolerance in font units: half of the last digit written."""
        return 0.5 * 10.0**-self.precision
