"""Closed curves through polygons under a glyph's options, and those sampled by step or by count: no search."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ..compiled import compiled
from ..curves.pairing import SHARPNESS, pair_stretches
from ..curves.spline_beziers import spline_beziers
from ..errors import GlyphsplineError
from ..interpolation.batch import interpolate_batch
from ..interpolation.kernels.driver import distance
from ..interpolation.method import Fallback, Method
from ..interpolation.polygon import NO_FLAGS, Polygons, explain
from ..interpolation.result import BatchedInterpolation, Interpolation
from ..outlines.contour_arrays import ContourArrays, Polylines, cubic_contours, offsets_of
from ..outlines.places import sampled
from ..outlines.sampling import MOST_VERTICES
from ..outlines.segments import all_cubics
from ..types import BoolArray, FloatArray, IntArray, Views
from .measures import distance_columns, solved_columns
from .options import Options
from .results import ConvertedContours

History = dict[int, tuple[FloatArray, FloatArray]]
"""Control points (n, 2) and parameters (n,) after numbers of updates."""

CERTAIN_RATIO = 6.0
"""Basis functions rise above 1/2 as long as adjacent knot intervals are within 6.15 of each other."""


def method_for(options: Options, fallback: Fallback) -> Method:
    """How a glyph's options interpolate closed polygons, with this fallback."""
    return Method(
        options.variant, margin=options.margin, fallback=fallback, residual_tolerance=options.solver_tolerance,
        max_iterations=options.max_iterations,
    )  # fmt: skip


def interpolated(
    points: FloatArray, offsets: IntArray, options: Options, held: BoolArray = NO_FLAGS
) -> BatchedInterpolation:
    """Interpolate closed polygons.

    Lemma 2 has an interval everywhere on graded polygons, which need no fallback; others have that of the options.

    Args:
        points: (n, 2) end to end, with offsets. held: see :class:`.Polygons`.

    Raises:
        PolygonError: one that cannot be interpolated; its ``contour`` is the number of the polygon.
    """
    ratio, ends = min(options.max_ratio, CERTAIN_RATIO) * (1 + 1e-9), pairwise(offsets.tolist())
    even = np.array([chords_of(points[first:last], ratio)[1] for first, last in ends], dtype=np.bool_)
    polygons = Polygons(points, offsets, held=held, by_knot=even)
    found = interpolate_batch(polygons, method_for(options, options.fallback), threads=1)
    for k in np.flatnonzero(found.arrays.whole[:, 0]).tolist():
        raise explain(points[offsets[k] : offsets[k + 1]], "chord", True).locate(contour=k)
    return found


def recorded(points: FloatArray, options: Options, updates: Iterable[int]) -> History:
    """Control points and footpoints' parameters of a closed polygon (n, 2) after numbers of updates.

    Each is a run of its own, stopped there: they take as long as the passes that they make, and nothing is kept twice.
    """
    offsets, found = np.array([0, len(points)]), {}
    for m in updates:
        (run,) = interpolated(points, offsets, replace(options, max_iterations=m)).results()
        found[m] = run.spline.control_points, run.parameters
    return found


def beziers(controls: FloatArray, knots: FloatArray, offsets: IntArray, unit: float) -> tuple[FloatArray, FloatArray]:
    """Ragged Bézier pieces (n, K, 4, 2) of closed cubic splines in K masters, and those rounded to multiples of 1/unit.

    Args:
        controls: (n, 2 K). knots: those of part k begin at ``offsets[k] + k``.
    """
    closed = np.ones(len(offsets) - 1, dtype=np.bool_)
    pieces = spline_beziers(controls.reshape(len(controls), -1, 2), knots, np.diff(offsets), closed)
    written = pieces * unit
    np.rint(written, out=written)
    written /= unit
    return pieces, written


@compiled
def chords_of(points: FloatArray, ratio: float) -> tuple[FloatArray, bool]:
    """(n,) distance from each vertex to the next, the last to the first; whether adjacent ones are within a ratio."""
    n = len(points)
    chords = np.empty(n)
    for i in range(n):
        j = (i + 1) % n
        chords[i] = distance(points, i, j)
    even = True
    for i in range(n):
        a, b = chords[i - 1], chords[i]
        even = even and not (a > ratio * b or b > ratio * a)
    return chords, even


def convert_fixed(contours: ContourArrays, options: Options, tolerance: float) -> ConvertedContours:
    """Put a closed C2 curve through points of each contour, as many or as far apart as the options ask for.

    Args:
        contours: of one glyph or of many. options: with ``step`` or ``count``.
        tolerance: in font units, what the distance is compared with if ``options.measure`` asks for it.

    Raises:
        GlyphsplineError: a contour that cannot be interpolated; its ``contour`` is the index.
    """
    cubics = all_cubics(contours)
    points, places, offsets, refused = sampled(
        cubics, contours.offsets, options.step or 0.0, options.count or 0, options.max_ratio,
        np.radians(options.corner_angle), MOST_VERTICES,
    )  # fmt: skip
    if refused.any():
        message = f"sampling takes more than {MOST_VERTICES} vertices"
        raise GlyphsplineError(message, contour=int(np.flatnonzero(refused)[0]))
    return through_polygons(contours, points, offsets, options, tolerance, places)


def through_polygons(
    contours: ContourArrays, points: FloatArray, offsets: IntArray, options: Options, tolerance: float,
    places: FloatArray | None = None,
) -> ConvertedContours:  # fmt: skip
    """Put a closed C2 curve through each of some polygons.

    Args:
        contours: what the polygons stand for. points: (N, 2) and offsets: (C + 1,) of the polygons.
        places: (N,) where on the contours the vertices lie; without them distances are not measured.

    Raises:
        PolygonError: a polygon that cannot be interpolated; its ``contour`` is the index.
    """
    found = interpolated(points, offsets, options)
    counts, arrays = found.arrays.whole[:, 1], found.arrays
    if counts.sum() < len(points):  # duplicates were merged
        kept = arrays.kept[_leading(offsets, counts)] + np.repeat(offsets[:-1], counts)
        points, places = points[kept], None if places is None else places[kept]
    ends = offsets_of(counts)
    controls = arrays.controls[_leading(offsets, counts)]
    knots = arrays.knots[_leading(offsets + np.arange(len(offsets)), counts + 1)]  # one more a spline
    pieces, written = (each[:, 0] for each in beziers(controls, knots, ends, 10.0**options.precision))
    closed, arcs = np.ones(len(counts), dtype=np.bool_), Views(len(counts), found.results)
    measures = solved_columns([(found, np.arange(len(counts)))])
    if options.measure and places is not None:
        vertices, segments = np.split(places, ends[1:-1]), np.diff(contours.offsets).tolist()
        anchors = np.concatenate([_anchors(*each) for each in zip(vertices, arcs, segments, strict=True)])
        distances = pair_stretches(
            (written, ends), (all_cubics(contours), contours.offsets), (anchors, ends + np.arange(len(ends))),
            SHARPNESS * tolerance, tolerance,
        )  # fmt: skip
        bounds, gaps = (np.maximum.reduceat(values, ends[:-1]).tolist() for values in distances)
        measures |= distance_columns(gaps, bounds, tolerance)
    return ConvertedContours(
        contours, cubic_contours(pieces, ends), Polylines(points, ends, closed), arcs,
        Polylines(controls, ends, closed), np.arange(len(counts) + 1), measures,
    )  # fmt: skip


def _leading(offsets: IntArray, counts: IntArray) -> IntArray:
    """Indices of the first ``counts[k]`` entries of each part."""
    return np.arange(counts.sum()) + np.repeat(offsets[:-1] - offsets_of(counts)[:-1], counts)


def _anchors(places: FloatArray, arc: Interpolation, segments: int) -> FloatArray:
    """(n + 1, 2) places on the curve and on the outline of all vertices, the first one again at the end."""
    u, n = arc.spline.knots, len(places)
    t = np.maximum.accumulate(arc.parameters)
    laps = np.floor(t / u[-1])
    within = t - laps * u[-1]
    span = np.clip(np.searchsorted(u, within, side="right") - 1, 0, n - 1)
    on_curve = laps * n + span + (within - u[span]) / (u[span + 1] - u[span])
    anchors = np.stack([np.minimum(on_curve, on_curve[0] + n), places], axis=1)
    return np.concatenate([anchors, anchors[:1] + np.array([n, segments])])
