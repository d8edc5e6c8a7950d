"""Curves through polygons sampled by step or by count: one interpolation a contour, no search."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..curves.pairing import SHARPNESS, pair_stretches
from ..errors import GlyphsplineError
from ..interpolation.result import Interpolation
from ..outlines.contour_arrays import ContourArrays, Polylines, cubic_contours, offsets_of
from ..outlines.places import sampled
from ..outlines.sampling import MOST_VERTICES
from ..outlines.segments import all_cubics
from ..types import FloatArray, IntArray, Views
from .closed_curves import beziers, interpolated
from .faithful import Fits
from .measures import distance_columns, solved_columns
from .options import Options
from .results import ConvertedContours


def fixed_fits(options: Options, tolerance: float) -> Fits:
    """The one fit of :func:`convert_fixed`: vertices are where the options put them, whatever comes of it."""
    return Fits(1, lambda contours, attempt: convert_fixed(contours, options, tolerance), keeps_collapsed=False)


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
    contours: ContourArrays,
    points: FloatArray,
    offsets: IntArray,
    options: Options,
    tolerance: float,
    places: FloatArray | None = None,
) -> ConvertedContours:
    """Put a closed C2 curve through each of some polygons.

    Args:
        contours: what the polygons stand for. points: (N, 2) and offsets: (C + 1,) of the polygons.
        places: (N,) where on the contours the vertices lie; without them distances are not measured.

    Raises:
        PolygonError: a polygon that cannot be interpolated; its ``contour`` is the index.
    """
    found = interpolated(points, offsets, options)
    counts = found.whole[:, 1]
    if counts.sum() < len(points):  # duplicates were merged
        kept = found.kept[_leading(offsets, counts)] + np.repeat(offsets[:-1], counts)
        points, places = points[kept], None if places is None else places[kept]
    ends = offsets_of(counts)
    controls = found.controls[_leading(offsets, counts)]
    knots = found.knots[_leading(offsets + np.arange(len(offsets)), counts + 1)]  # one more a spline
    pieces, written = beziers(controls, knots, ends, 10.0**options.precision)
    closed = np.ones(len(counts), dtype=np.bool_)
    curves, arcs = cubic_contours(pieces, ends), Views(len(counts), found.results)
    polygons = Polylines(points, ends, closed)
    measures: dict[str, Sequence[Any]] = solved_columns([(found, np.arange(len(counts)))])
    if options.measure and places is not None:
        measures |= _distances(contours, written, places, ends, arcs, tolerance)
    return ConvertedContours(
        contours, curves, polygons, arcs, Polylines(controls, ends, closed),
        np.arange(len(counts) + 1), measures,
    )  # fmt: skip


def _leading(offsets: IntArray, counts: IntArray) -> IntArray:
    """Indices of the first ``counts[k]`` entries of each part."""
    total = int(counts.sum())
    if total == offsets[-1]:
        return np.arange(total)
    return np.arange(total) + np.repeat(offsets[:-1] - offsets_of(counts)[:-1], counts)


def _distances(
    contours: ContourArrays,
    written: FloatArray,
    places: FloatArray,
    ends: IntArray,
    arcs: Sequence[Interpolation],
    tolerance: float,
) -> dict[str, Sequence[Any]]:
    """Certified distances of the curves, as they are written, from the contours."""
    vertices, segments = np.split(places, ends[1:-1]), np.diff(contours.offsets).tolist()
    anchors = np.concatenate([_anchors(*each) for each in zip(vertices, arcs, segments, strict=True)])
    found = pair_stretches(
        written, ends, all_cubics(contours), contours.offsets, anchors, ends + np.arange(len(ends)),
        SHARPNESS * tolerance, tolerance,
    )  # fmt: skip
    bounds, gaps = (np.maximum.reduceat(values, ends[:-1]).tolist() for values in found)
    return distance_columns(gaps, bounds, tolerance)


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
