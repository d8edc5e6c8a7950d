"""What goes into the glyph pipeline and what comes out: :class:`Options` and :class:`GlyphResult`, pure data."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Literal

from .arrays import FloatArray
from .outline import Contour, Outline
from .result import Interpolation

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


@dataclass(frozen=True)
class Measures:
    """What is known of one contour's result; None where it was not computed. Lengths in font units.

    Attributes:
        vertices: of the polygon. segments: Bézier segments of the result. numbers: coordinates to store.
        iterations, residual, converged, rate_bound, fallbacks: of the interpolation (worst of several arcs).
        deviation: measured two-sided distance to the source; deviation_bound: certified bound of it.
        within_tolerance: whether the bound (or, failing one, the measure) is within the tolerance.
        overshoot: largest distance of the curve outside the polygon's convex hull.
        length: arc length. area_change: area of the result less that of the source contour.
        bending_energy: integral of curvature squared over arc length, in 1/unit.
        max_curvature: largest absolute curvature, in 1/unit.
        new_crossings: self-crossings of the result beyond those of the source contour.
    """

    vertices: int
    segments: int
    numbers: int
    iterations: int
    residual: float
    converged: bool
    rate_bound: float
    fallbacks: int
    deviation: float | None = None
    deviation_bound: float | None = None
    within_tolerance: bool | None = None
    overshoot: float | None = None
    length: float | None = None
    area_change: float | None = None
    bending_energy: float | None = None
    max_curvature: float | None = None
    new_crossings: int | None = None


SOLVED = tuple(field.name for field in fields(Measures))[:8]
"""The first of the measures: those that the interpolation itself knows."""


@dataclass(frozen=True, eq=False)
class ContourResult:
    """One contour: its source, its polygon (n, 2), the interpolations run on it, and the curve they make.

    ``curve`` is the result as exact Béziers, before rounding; in "smooth" it is the one interpolation's
    spline, in "sharp" the arcs' splines joined with the source's straight lines.
    """

    source: Contour
    polygon: FloatArray
    interpolations: tuple[Interpolation, ...]
    curve: Contour
    measures: Measures


@dataclass(frozen=True, eq=False)
class GlyphResult:
    """One glyph, converted: the source outline, the options, a result for each contour, and remarks."""

    outline: Outline
    options: Options
    contours: tuple[ContourResult, ...]
    notes: tuple[str, ...] = ()
