"""Results of the glyph pipeline: arrays of all contours end to end, and objects that are views of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import MISSING, dataclass, field, fields
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ..curves.bspline import Spline
from ..interpolation.result import Interpolation
from ..outlines.contour_arrays import (
    NO_POLYLINES,
    ContourArrays,
    Polylines,
    joined,
    joined_offsets,
    joined_polylines,
    offsets_of,
    polylines,
)
from ..outlines.open_paths import are_open, paths
from ..outlines.outline import Contour, Contours, FontMetrics, Outline
from ..types import FloatArray, IntArray, Views, counted, rounded_up
from .options import Options
from .whole_splines import whole_splines

PER_EM = "1/em"
"""Unit of all curvature that people look at: a measure in 1/unit, times the units per em."""


class Quantity(NamedTuple):
    """What people read of a measure: a label, a unit, "" for numbers without any, and a sentence."""

    label: str
    unit: str
    about: str


def _about(sentence: str, unit: str = "", *, label: str = "", default: Any = None) -> Any:
    """A field of a measure, with what people read of it; without a label it is the field's name."""
    return field(default=default, metadata={"quantity": Quantity(label, unit, sentence)})


@dataclass(frozen=True)
class Measures:
    """Measures of one contour's result; None where not computed. Lengths are in font units.

    Attributes:
        vertices: of the polygon. segments: Bézier segments of the result. numbers: coordinates to store.
        iterations, residual, converged, rate_bound, fallbacks: of the interpolation (worst of several arcs).
        deviation: largest distance seen between points of the result and of the source that the certificate pairs. It
            is near the two-sided distance, and mostly a little below it. Of traces it is the bound.
        deviation_bound: certified bound of that distance, with what the reader snapped.
        within_tolerance: whether the bound (or, failing one, the measure) is within the tolerance.
        overshoot: largest distance of the curve outside the polygon's convex hull. This and what follows is measured on
            the curve as it is written, rounded; but the extrema of curvature.
        length: arc length. area_change: area of the result less that of the source contour.
        bending_energy: integral of curvature squared over arc length, in 1/unit.
        max_curvature: largest absolute curvature, in 1/unit.
        curvature_extrema: significant extrema of the signed curvature of the result, before rounding, between corners:
            where it has risen and then falls, or the reverse, each time by at least a tenth of the larger absolute
            value, as less is the rounding of coordinates, and by 1/length, which is one radian around the contour, as
            less is not seen. An 'o' has four, or eight if its shoulders are square. A corner that "smooth" rounds makes
            one or more. See :func:`..curves.fairness.extrema_of`.
        source_curvature_extrema: the same of the source contour. Sources of quadratics have many: each quadratic has a
            peak of curvature of its own.
        curvature_extrema_floor: those of the source if each corner is rounded as tightly as can be, to a peak of
            curvature above all others: one for each corner, one between two corners that turn the same way, and what
            the curvature of the sides adds. A curve within the tolerance may have fewer. None in "sharp", where corners
            stay.
        new_crossings: crossings of the contour, with itself and with others of the glyph, beyond those of the source. A
            crossing of two contours counts for both.
        collapsed: whether the written contour has less than a quarter of the source's area, or runs the other way
            round; never of contours that cross themselves.
        corners_kept: whether the result of "smooth" has the corners of its source, as every smooth fit crosses.
        source_kept: whether the result is the source's own contour, because every fit crosses or collapses.
    """

    vertices: int = _about("points of the outline that the curve passes through", default=MISSING)
    segments: int = _about("Bézier segments of the result", default=MISSING)
    numbers: int = _about("coordinates that a file of splines stores", label="numbers to store", default=MISSING)
    iterations: int | None = _about("updates until the curve passes through all vertices")
    residual: float | None = _about("largest distance left between a vertex and its footpoint on the curve", "units")
    converged: bool | None = _about("whether the residual is below the solver's tolerance")
    rate_bound: float | None = _about("certified factor by which the largest error shrinks at every step")
    fallbacks: int | None = _about("vertices for which Lemma 2 has no interval")
    deviation: float | None = _about("largest distance seen between paired points of result and source", "units")
    deviation_bound: float | None = _about(
        "bound that the distance is proven to be within", "units", label="deviation, certified"
    )
    within_tolerance: bool | None = _about("whether that bound is within the tolerance asked for")
    overshoot: float | None = _about("largest distance of the curve outside the hull of its polygon", "units")
    length: float | None = _about("arc length of the result", "units")
    area_change: float | None = _about("area of the result less that of the source", "units²", label="change of area")
    bending_energy: float | None = _about("integral of squared curvature: less is rounder", PER_EM)
    max_curvature: float | None = _about(
        "of the sharpest bend: 1/radius, with the em as the unit", PER_EM, label="largest curvature"
    )
    curvature_extrema: int | None = _about("where curvature peaks between corners; an ellipse has 4")
    source_curvature_extrema: int | None = _about("the same of the source outline", label="curvature extrema, source")
    curvature_extrema_floor: int | None = _about(
        "those of the source with each corner rounded to a peak",
        label="curvature extrema, floor",
    )
    new_crossings: int | None = _about("crossings of contours, with themselves and others, beyond the source's")
    collapsed: bool | None = _about("whether a contour has lost its area, or runs the other way round")
    corners_kept: bool | None = _about("whether a contour has sharp corners, as every smooth curve there crosses")
    source_kept: bool | None = _about("whether a contour is the source's own, as every fit crosses or collapses")

    def __repr__(self) -> str:
        said = []
        for name in MEASURES:
            value = getattr(self, name)
            if value is not None:
                value = rounded_up(value, 4) if name in BOUNDS else value
                said.append(f"{name}={f'{value:.4g}' if isinstance(value, float) else value}")
        return f"Measures({', '.join(said)})"


QUANTITIES: dict[str, Quantity] = {
    one.name: one.metadata["quantity"]._replace(label=one.metadata["quantity"].label or one.name.replace("_", " "))
    for one in fields(Measures)
}
"""What people read of the measures, by name."""

MEASURES = tuple(QUANTITIES)
"""The measures, in the order in which they are written."""

BOUNDS = ("rate_bound", "deviation_bound")
"""The measures that are proven bounds, which are rounded up wherever they are written."""

SOLVED = MEASURES[:8]
"""The measures that the interpolation itself provides."""


def shown(name: str, value: Any, units_per_em: float) -> Any:
    """A measure's value in the unit that people read; None stays None."""
    return value * units_per_em if value is not None and QUANTITIES[name].unit == PER_EM else value


MeasureColumns = Mapping[str, Sequence[Any]]
"""For each measure, its value for each contour. A measure that no contour has is left out."""


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

    @cached_property
    def spline(self) -> Spline | None:
        """The contour as one closed spline, lines included, or as an open one; None if it has no length.

        In "smooth" it is the interpolation's. With corners, knots are triple at the ends of arcs and of straight lines,
        where the curve is in its control points; between them it is C2. Curves are those of ``curve``, up to rounding.
        """
        return _arrays_of([self]).splines()[0]

    def __repr__(self) -> str:
        return f"<ContourResult: {_told([self.measures])}>"


@dataclass(frozen=True, eq=False)
class ConvertedContours:
    """Results of C contours end to end, of one glyph or many: the input of the writers.

    Attributes:
        source: the contours. curves: the results as exact Béziers, before rounding.
        polygons: C polygons, whose vertices the curves pass through; those of open paths are open.
        arcs: A interpolations. controls: their A control polygons.
        arc_offsets: (C + 1,) where the arcs of each contour begin in ``arcs``, and A.
        measures: a column of C values for each measure.
    """

    source: ContourArrays
    curves: ContourArrays
    polygons: Polylines
    arcs: Sequence[Interpolation]
    controls: Polylines
    arc_offsets: IntArray
    measures: MeasureColumns

    def __len__(self) -> int:
        return self.source.num_contours

    def __repr__(self) -> str:
        return f"<ConvertedContours: {counted(len(self), 'contour')}>"

    def part(self, first: int, last: int) -> ConvertedContours:
        """The contours from ``first`` up to ``last``, as views."""
        if first == 0 and last == len(self):
            return self
        a, b = int(self.arc_offsets[first]), int(self.arc_offsets[last])
        return ConvertedContours(
            self.source.part(first, last),
            self.curves.part(first, last),
            self.polygons.part(first, last),
            Views(b - a, lambda: self.arcs[a:b]),
            self.controls.part(a, b),
            self.arc_offsets[first : last + 1] - a,
            {name: column[first:last] for name, column in self.measures.items()},
        )

    def splines(self) -> list[Spline | None]:
        """One spline a contour: :attr:`ContourResult.spline`."""
        opened = are_open(self.curves)
        knots, controls = whole_splines(paths(self.curves, opened), self.arcs, self.controls, self.arc_offsets)
        found: list[Spline | None] = []
        for c, (a, b) in enumerate(pairwise(controls.offsets.tolist())):
            points, own = controls.points[a:b], knots[a + c : b + c + 1]
            if opened[c]:  # without the line back, which has the last two control points
                points, own = points[:-2], own[1:-4]
            found.append(Spline.trusted(points, own, 3, not opened[c]) if a < b else None)
        return found

    @property
    def whole_splines(self) -> tuple[FloatArray, Polylines]:
        """Knots and control points of closed splines, of open paths there and back: see :func:`.whole_splines`."""
        return whole_splines(self.curves, self.arcs, self.controls, self.arc_offsets)

    def contour_results(self) -> list[ContourResult]:
        """An object for each contour."""
        unknown = [None] * len(self)
        known = map(Measures, *(self.measures.get(name, unknown) for name in MEASURES))
        vertices, arcs = pairwise(self.polygons.offsets.tolist()), pairwise(self.arc_offsets.tolist())
        return [
            ContourResult(source, self.polygons.points[i:j], tuple(self.arcs[a:b]), curve, measures)
            for source, (i, j), (a, b), curve, measures in zip(
                Contours(self.source), vertices, arcs, Contours(self.curves), known, strict=True
            )
        ]


def assembled(chosen: Sequence[tuple[ConvertedContours, int]]) -> ConvertedContours:
    """Results that take contour c from number ``chosen[c][1]`` of ``chosen[c][0]``."""
    runs: list[tuple[ConvertedContours, int, int]] = []
    for found, k in chosen:
        follows = runs and runs[-1][0] is found and runs[-1][2] == k
        first = runs.pop()[1] if follows else k
        runs.append((found, first, k + 1))
    parts = [found.part(first, last) for found, first, last in runs]
    return parts[0] if len(parts) == 1 else concatenated(parts)


def concatenated(parts: Sequence[ConvertedContours]) -> ConvertedContours:
    """Several results end to end."""
    names = {name: None for part in parts for name in part.measures}
    return ConvertedContours(
        joined([part.source for part in parts]),
        joined([part.curves for part in parts]),
        joined_polylines([part.polygons for part in parts]),
        Views(sum(len(part.arcs) for part in parts), lambda: [arc for part in parts for arc in part.arcs]),
        joined_polylines([part.controls for part in parts]),
        joined_offsets([part.arc_offsets for part in parts]),
        {name: [x for part in parts for x in part.measures.get(name, [None] * len(part))] for name in names},
    )


NOTHING = concatenated([])
"""Results of no contours."""


class ContourResults(Views[ContourResult]):
    """The results of a glyph's contours: a lazy sequence of :class:`ContourResult`, made from arrays.

    Attributes:
        batch: results of all glyphs of the batch. first, last: the glyph's range in it, ``last`` excluded.
    """

    __slots__ = ("_part", "batch", "first", "last")

    def __init__(self, batch: ConvertedContours, first: int = 0, last: int | None = None) -> None:
        self.batch, self.first, self.last = batch, first, len(batch) if last is None else last
        self._part: ConvertedContours | None = None
        super().__init__(self.last - first, lambda: self.arrays.contour_results())

    @property
    def arrays(self) -> ConvertedContours:
        """The glyph's part of the batch."""
        if self._part is None:
            self._part = self.batch.part(self.first, self.last)
        return self._part


def _arrays_of(results: Sequence[ContourResult]) -> ConvertedContours:
    arcs = [arc for result in results for arc in result.interpolations]
    splines = [arc.spline for arc in arcs]
    return ConvertedContours(
        Contours(result.source for result in results).arrays,
        Contours(result.curve for result in results).arrays,
        polylines([result.polygon for result in results], [not result.curve.is_open for result in results]),
        arcs,
        polylines([spline.control_points for spline in splines], [spline.closed for spline in splines]),
        offsets_of([len(result.interpolations) for result in results]),
        {name: [getattr(result.measures, name) for result in results] for name in MEASURES},
    )


@dataclass(frozen=True, eq=False)
class GlyphResult:
    """One converted glyph: the source outline, the options, a result for each contour, and remarks."""

    outline: Outline
    options: Options
    contours: Sequence[ContourResult]
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "options", self.options.for_em(self.outline.metrics.units_per_em))
        if not isinstance(self.contours, ContourResults):
            object.__setattr__(self, "contours", ContourResults(_arrays_of(self.contours)))

    def __reduce__(self) -> tuple[Any, ...]:
        return GlyphResult, (self.outline, self.options, tuple(self.contours), self.notes)

    def __repr__(self) -> str:
        name, contours = self.outline.name, counted(len(self.contours), "contour")
        return f"<GlyphResult {name!r}: {contours}, {_told([contour.measures for contour in self.contours])}>"

    @property
    def arrays(self) -> ConvertedContours:
        """The contours' results end to end."""
        assert isinstance(self.contours, ContourResults)
        return self.contours.arrays


def _told(measures: Sequence[Measures]) -> str:
    """The key measures of some contours together, for a line."""
    said = [f"{sum(m.vertices for m in measures)} vertices", f"{sum(m.segments for m in measures)} segments"]
    if bounds := [m.deviation_bound for m in measures if m.deviation_bound is not None]:
        said.append(f"certified within {rounded_up(max(bounds), 3):.3g} units")
    if bad := sum(m.converged is False for m in measures):
        said.append(f"{bad} not converged")
    return ", ".join(said)


def as_glyph(thing: GlyphResult | Outline | Contour) -> GlyphResult:
    """A result whose curves are the contours of ``thing``, for functions that draw results."""
    if isinstance(thing, GlyphResult):
        return thing
    if isinstance(thing, Contour):
        extent = float(np.ptp(thing.points, axis=0).max()) if len(thing) else 1.0
        return as_glyph(Outline("", contours=(thing,), metrics=FontMetrics(units_per_em=extent or 1.0)))
    return as_glyphs([thing])[0]


def as_glyphs(outlines: Sequence[Outline], options: Options | None = None) -> list[GlyphResult]:
    """Results whose curves are the outlines' contours, those without segments left out: nothing is fitted."""
    options = options or Options()
    given = joined([outline.arrays for outline in outlines])
    ends = offsets_of([outline.arrays.num_contours for outline in outlines])
    kept = np.diff(given.offsets) > 0
    if not kept.all():
        given, ends = given.chosen(np.flatnonzero(kept).tolist()), offsets_of(kept.astype(np.int64))[ends]
    found = not_fitted(given, given)
    return [
        GlyphResult(outline, options, ContourResults(found, first, last))
        for outline, (first, last) in zip(outlines, pairwise(ends.tolist()), strict=True)
    ]


def not_fitted(source: ContourArrays, curves: ContourArrays) -> ConvertedContours:
    """Results without interpolations: polygons have the points where the curves' segments meet, and are counted."""
    joints = curves.points[np.cumsum(curves.degrees) - curves.degrees]
    polygons = Polylines(joints, curves.offsets, np.ones(curves.num_contours, dtype=np.bool_))
    segments, numbers = np.diff(curves.offsets).tolist(), (2 * np.diff(curves.starts)).tolist()
    counts = {"vertices": segments, "segments": segments, "numbers": numbers}
    return ConvertedContours(source, curves, polygons, (), NO_POLYLINES, np.zeros_like(curves.offsets), counts)


def joined_results(glyphs: Sequence[GlyphResult]) -> tuple[ConvertedContours, IntArray]:
    """The contours of many glyphs end to end, and (G + 1,) where each glyph begins. A complete batch is not copied."""
    contours = [glyph.contours for glyph in glyphs]
    offsets = offsets_of([len(own) for own in contours])
    parts = [own for own in contours if isinstance(own, ContourResults)]
    if parts and all(own.batch is parts[0].batch and own.first == a for own, a in zip(parts, offsets, strict=False)):
        return parts[0].batch.part(0, parts[-1].last), offsets
    return concatenated([own.arrays for own in parts]), offsets
