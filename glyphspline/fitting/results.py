"""What comes out of the glyph pipeline: :class:`GlyphResult` and its parts, pure data."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ..interpolation.result import Interpolation
from ..outlines.outline import Contour, FontMetrics, Outline
from ..types import FloatArray
from .options import Options


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


def as_glyph(thing: GlyphResult | Outline | Contour) -> GlyphResult:
    """Whatever has contours as a result whose curves are those contours, for what draws results."""
    if isinstance(thing, GlyphResult):
        return thing
    if isinstance(thing, Contour):
        extent = float(np.ptp(thing.points, axis=0).max()) if len(thing) else 1.0
        return as_glyph(Outline("", contours=(thing,), metrics=FontMetrics(units_per_em=extent or 1.0)))
    nothing = Measures(0, 0, 0, 0, 0.0, True, 0.0, 0)
    drawn = [contour for contour in thing.contours if len(contour)]
    contours = [ContourResult(c, c.points[c.offsets], (), c, nothing) for c in drawn]
    return GlyphResult(thing, Options(), tuple(contours))
