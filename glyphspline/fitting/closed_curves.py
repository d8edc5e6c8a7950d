"""Closed curves through several polygons under a glyph's options, and their Béziers."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..curves.cubics import spline_beziers
from ..interpolation.api import interpolate_batch
from ..interpolation.driver import interpolate_any_degree
from ..interpolation.method import Fallback, Method, method_of
from ..interpolation.polygon import explain
from ..interpolation.result import BatchedInterpolation
from ..types import BoolArray, FloatArray, IntArray
from .options import Options

History = tuple[tuple[FloatArray, FloatArray], ...]
"""Control points (n, 2) and parameters (n,) pass by pass."""

CERTAIN_RATIO = 6.0
"""Basis functions rise above 1/2 as long as adjacent knot intervals are within 6.15 of each other."""


def method_for(options: Options, fallback: Fallback | None = None, closed: bool = True) -> Method:
    """How a glyph's options interpolate, with another fallback if one is given."""
    return method_of(
        options.variant, 3, options.margin, "chord", fallback or options.fallback, options.solver_tolerance,
        options.max_iterations, closed, "iterate", False,
    )  # fmt: skip


def interpolated(points: FloatArray, offsets: IntArray, options: Options) -> BatchedInterpolation:
    """Interpolate closed polygons.

    Lemma 2 has an interval everywhere on graded polygons, which need no fallback; others have that of the options.

    Args:
        points: (n, 2) end to end, with offsets.

    Raises:
        PolygonError: one that cannot be interpolated; its ``contour`` is the number of the polygon.
    """
    even = graded_polygons(points, offsets, min(options.max_ratio, CERTAIN_RATIO) * (1 + 1e-9))
    found = interpolate_batch(points, offsets, method_for(options), by_knot=even, threads=1)
    for k in np.flatnonzero(found.whole[:, 0]).tolist():
        raise explain(points[offsets[k] : offsets[k + 1]], "chord", True).locate(contour=k)
    return found


def recorded(points: FloatArray, options: Options) -> History:
    """Control points and footpoints' parameters of a closed polygon (n, 2) before each of its updates, and at the end.

    The run is that of :func:`interpolated`, by the passes that keep what they do.
    """
    even = graded_polygons(points, np.array([0, len(points)]), min(options.max_ratio, CERTAIN_RATIO) * (1 + 1e-9))
    method = method_for(options, "knot" if even[0] else None)
    return interpolate_any_degree(points, method, keep_history=True).history or ()


@compiled
def beziers(controls: FloatArray, knots: FloatArray, offsets: IntArray, unit: float) -> tuple[FloatArray, FloatArray]:
    """Ragged Bézier pieces (n, 4, 2) of closed cubic splines, and the same rounded to multiples of 1/unit.

    Knots of part k begin at ``offsets[k] + k``.
    """
    pieces, written = np.empty((len(controls), 4, 2)), np.empty((len(controls), 4, 2))
    for k in range(len(offsets) - 1):
        a, b = offsets[k], offsets[k + 1]
        spline_beziers(controls[a:b], knots[a + k : b + k + 1], True, pieces[a:b])
    for i in range(len(pieces)):
        for j in range(4):
            for axis in range(2):
                written[i, j, axis] = np.rint(pieces[i, j, axis] * unit) / unit
    return pieces, written


@compiled
def chords_of(points: FloatArray, ratio: float) -> tuple[FloatArray, bool]:
    """(n,) distance from each vertex to the next, the last to the first; whether adjacent ones are within a ratio."""
    n = len(points)
    chords = np.empty(n)
    for i in range(n):
        j = (i + 1) % n
        chords[i] = np.sqrt((points[j, 0] - points[i, 0]) ** 2 + (points[j, 1] - points[i, 1]) ** 2)
    even = True
    for i in range(n):
        a, b = chords[i - 1], chords[i]
        even = even and not (a > ratio * b or b > ratio * a)
    return chords, even


@compiled
def graded_polygons(points: FloatArray, offsets: IntArray, ratio: float) -> BoolArray:
    """(K,) which of some closed polygons (ragged) have all adjacent chords within a ratio of each other."""
    even = np.empty(len(offsets) - 1, dtype=np.bool_)
    for k in range(len(offsets) - 1):
        _, even[k] = chords_of(points[offsets[k] : offsets[k + 1]], ratio)
    return even
