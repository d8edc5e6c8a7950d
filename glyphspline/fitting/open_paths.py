"""Open paths fitted: clamped arcs of variant 2 from end to end, or between corners.

By tolerance a path is closed by two long lines, which the sharp mode keeps as they are, so that arcs end where the path
does; then these are left out. By step or count an arc is put through points of the path.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from ..curves.cubics import directions
from ..errors import GlyphsplineError, PolygonError
from ..interpolation.api import interpolate_each
from ..interpolation.result import Interpolation
from ..outlines.contour_arrays import ContourArrays, end_to_end, offsets_of, polylines
from ..outlines.open_paths import Path, paths, there_and_back
from ..outlines.places import sampled
from ..outlines.sampling import MOST_VERTICES
from ..outlines.segments import all_cubics
from ..types import FloatArray, IntArray
from .closed_curves import method_for
from .measures import Columns, with_geometry
from .options import Options
from .results import ConvertedContours

LONG = 1.0
"""Length in em of the lines that close a path: far more than a line has that the sharp mode keeps."""

TURNS = np.radians(np.arange(0.0, 360.0, 30.0))
"""Directions in which the corner between them may lie."""

OF_BOTH_WAYS = ("length", "bending_energy")
UNKNOWN = ("area_change", "curvature_extrema_floor", "new_crossings", "collapsed")
"""Measures that count the way back too; those that say nothing of a path."""


def convert_open(contours: ContourArrays, options: Options, tolerance: float, em: float) -> ConvertedContours:
    """Fit open contours; tolerance and ``em`` are in font units.

    Raises:
        GlyphsplineError: a contour that cannot be fitted; its ``contour`` is the index.
    """
    found = _through_points(contours, options) if options.is_fixed else _within(contours, options, tolerance, em)
    if options.is_fixed and not options.measure:
        return found
    columns = {**with_geometry(found, options).measures}
    for name in OF_BOTH_WAYS:
        columns[name] = [value / 2 for value in columns[name]]
    for name in ("curvature_extrema", "source_curvature_extrema"):
        columns[name] = [value // 2 for value in columns[name]]
    nothing = [None] * len(found)
    return replace(found, measures={**columns, **dict.fromkeys(UNKNOWN, nothing)})


def _within(contours: ContourArrays, options: Options, tolerance: float, em: float) -> ConvertedContours:
    """Paths within the tolerance, with their corners, whatever the options say of these."""
    from .sharp.sharp_fit import sharp_fits

    options = replace(options, corners="sharp", continuity="c2")
    ways = paths(contours, np.ones(contours.num_contours, dtype=np.bool_))
    detours = end_to_end([_with_detour(*way, LONG * em, options.precision) for way in _each(ways)])
    found = sharp_fits(options, tolerance, em).fit(detours, 0)
    # The two lines are the last segments of each contour; the path ends where the first of them begins.
    curves = end_to_end([there_and_back(points[:-1], degrees[:-2]) for points, degrees in _each(found.curves)])
    polygons = [found.polygons.points[a : b - 1] for a, b in pairwise(found.polygons.offsets.tolist())]
    fewer: Columns = {
        "vertices": [count - 1 for count in found.measures["vertices"]],
        "segments": [count - 2 for count in found.measures["segments"]],
        "numbers": [count - 2 for count in found.measures["numbers"]],
    }
    drawn = polylines(polygons, [False] * len(polygons))
    return replace(found, source=contours, curves=curves, polygons=drawn, measures={**found.measures, **fewer})


def _each(contours: ContourArrays) -> list[Path]:
    """Points and degrees of each contour."""
    points, degrees, offsets, starts = contours
    ends = zip(pairwise(starts.tolist()), pairwise(offsets.tolist()), strict=True)
    return [(points[a:b], degrees[i:j]) for (a, b), (i, j) in ends]


def _with_detour(points: FloatArray, degrees: IntArray, length: float, precision: int) -> Path:
    """A path (N + 1, 2) that is closed by a line, closed by two instead: by a corner where both ends turn the most."""
    cubics = all_cubics(end_to_end([(points, degrees)]))
    _, _, *before = directions(cubics, len(cubics) - 2, 0.0)
    after = directions(cubics, 0, 0.0)[:2]
    first, last = points[0], points[-1]
    corners = (first + last) / 2 + (length + np.abs(last - first).max()) * np.stack([np.cos(TURNS), np.sin(TURNS)], 1)
    ahead, home = _unit(corners - last), _unit(first - corners)
    straight = np.maximum(ahead @ _unit(np.array(before)), home @ _unit(np.array(after)))
    return np.concatenate([points, np.round(corners[[np.argmin(straight)]], precision)]), np.append(degrees, 1)


def _unit(vectors: FloatArray) -> FloatArray:
    """Vectors (..., 2) of length 1; those without length stay."""
    lengths = np.hypot(vectors[..., 0], vectors[..., 1])[..., None]
    return vectors / np.where(lengths > 0.0, lengths, 1.0)


def _through_points(contours: ContourArrays, options: Options) -> ConvertedContours:
    """One arc a path through as many of its points, or as far apart, as the options ask for."""
    both, ends = all_cubics(contours), contours.offsets
    count = 2 * (options.count - 1) if options.count else 0
    points, places, offsets, refused = sampled(
        both, ends, options.step or 0.0, count, options.max_ratio, np.radians(options.corner_angle), MOST_VERTICES
    )
    if refused.any():
        message = f"sampling takes more than {MOST_VERTICES} vertices"
        raise GlyphsplineError(message, contour=int(np.flatnonzero(refused)[0]))
    polygons, tangents = list[FloatArray](), list[tuple[FloatArray, FloatArray]]()
    for c, (a, b) in enumerate(pairwise(ends.tolist())):
        own, half = slice(*offsets[c : c + 2].tolist()), (b - a) // 2
        inner = (places[own] > 1e-9) & (places[own] < half - 1e-9)
        polygons.append(np.concatenate([both[a : a + 1, 0], points[own][inner], both[a + half : a + half + 1, 0]]))
        _, _, *arriving = directions(both, a + half - 1, 0.0)
        leaving = directions(both, a, 0.0)[:2]
        tangents.append((_unit(np.array(leaving)), _unit(np.array(arriving))))
    method = replace(method_for(options, options.fallback), closed=False)
    arcs = list[Interpolation]()
    for c, arc in enumerate(interpolate_each(polygons, method, None, tangents, 1)):
        if isinstance(arc, PolygonError):
            raise arc.locate(contour=c)
        arcs.append(arc)
    return _of_arcs(contours, polygons, arcs)


def _of_arcs(contours: ContourArrays, polygons: list[FloatArray], arcs: list[Interpolation]) -> ConvertedContours:
    """Results of one arc a path."""
    found = []
    for arc in arcs:
        pieces = arc.spline.to_bezier()
        points = np.concatenate([pieces[:, :3].reshape(-1, 2), pieces[-1:, 3]])
        found.append(there_and_back(points, np.full(len(pieces), 3)))
    counts = [len(arc.parameters) for arc in arcs]
    measures: Columns = {
        "vertices": counts,
        "segments": [count - 1 for count in counts],
        "numbers": [2 * len(arc.spline.control_points) for arc in arcs],
        "iterations": [arc.iterations for arc in arcs],
        "residual": [arc.max_error for arc in arcs],
        "converged": [arc.converged for arc in arcs],
        "rate_bound": [arc.rate_bound for arc in arcs],
        "fallbacks": [arc.fallbacks for arc in arcs],
    }
    controls = [arc.spline.control_points for arc in arcs]
    opened = [False] * len(arcs)
    return ConvertedContours(
        contours, end_to_end(found), polylines(polygons, opened), arcs, polylines(controls, opened),
        offsets_of([1] * len(arcs)), measures,
    )  # fmt: skip
