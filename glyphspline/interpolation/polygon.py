"""Polygons: validation, merging of duplicate vertices, and the parameters of the vertices."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..errors import PolygonError
from ..types import BoolArray, FloatArray, IntArray
from .method import CHORD_EXPONENT, Parametrisation, Tangents

SAME_VERTEX = 1e-12
"""Neighbours nearer than this share of the polygon's extent are one vertex.

With a much smaller value, sums of chords in floating point would give them the same knot.
"""

LARGEST, SMALLEST = 1e100, 1e-100
"""Extents beyond which squared distances leave the range of floats."""

NO_TANGENTS = np.empty((0, 2, 2))
NO_KNOTS = np.empty(0)
NO_FLAGS = np.empty(0, dtype=np.bool_)


class Polygons(NamedTuple):
    """K polygons of N vertices in R^d in shared arrays.

    Attributes:
        points: (N, d) end to end. offsets: (K + 1,) part k of ``points`` is ``offsets[k]:offsets[k + 1]``.
        knots: () or all polygons' own parameters end to end, n + 1 each if closed, n if open.
        tangents: (K, 2, d) end tangents of open arcs, NaN for natural ends; (): all are natural, or closed.
        held: (N,) whether a vertex of a closed polygon is held: its control point stays at it, and the curve need not
            pass through it; () where none is.
        by_knot: (K,) whether a polygon has ``fallback="knot"`` instead of the method's; () where none has.
    """

    points: FloatArray
    offsets: IntArray
    knots: FloatArray = NO_KNOTS
    tangents: FloatArray = NO_TANGENTS
    held: BoolArray = NO_FLAGS
    by_knot: BoolArray = NO_FLAGS


def as_points(points: ArrayLike) -> FloatArray:
    """Vertices as (n, d) float64, d ≥ 2, contiguous; a PolygonError if they are not numbers or of another shape."""
    try:
        p = np.ascontiguousarray(points, dtype=np.float64)
    except (TypeError, ValueError) as cause:
        raise PolygonError("a polygon is an array of numbers of shape (n, d) with d >= 2") from cause
    if p.ndim != 2 or p.shape[1] < 2:
        raise PolygonError(f"a polygon has shape (n, d) with d >= 2, not {p.shape}")
    return p


def as_tangents(tangents: Sequence[Tangents | None], d: int) -> FloatArray:
    """End tangents of K arcs as (K, 2, d), NaN for natural ends; a PolygonError if one is not d numbers."""
    array = np.full((len(tangents), 2, d), np.nan)
    for k, pair in enumerate(tangents):
        for end, tangent in enumerate(pair or ()):
            if tangent is None:
                continue
            try:
                given = np.asarray(tangent, dtype=np.float64)
            except (TypeError, ValueError) as cause:
                raise PolygonError("an end tangent is an array of numbers") from cause
            if given.shape != (d,):
                raise PolygonError(f"an end tangent of a polygon (n, {d}) has shape ({d},), not {given.shape}")
            array[k, end] = given
    return array


def clean_polygon(points: ArrayLike, closed: bool = True) -> tuple[FloatArray, IntArray]:
    """Check a polygon and merge consecutive duplicates.

    Args:
        points: (n, d) vertices in order, d ≥ 2, the first not repeated at the end.
        closed: whether the last vertex is followed by the first.

    Returns:
        The vertices kept, (n', d) float64, and the indices of those dropped, each a duplicate of a kept one before it.

    Raises:
        PolygonError: not of shape (n, d); a coordinate is NaN or infinite, or so large that distances overflow;
            fewer than three distinct vertices (two for an open arc).
    """
    p = as_points(points)
    bad = np.flatnonzero(~np.isfinite(p).all(axis=1))
    if len(bad):
        raise PolygonError(f"vertex {bad[0]} is not finite: ({', '.join(map(str, p[bad[0]]))})")
    needed = 3 if closed else 2
    extent = float(np.ptp(p, axis=0).max()) if len(p) else 0.0
    if not extent <= LARGEST:
        raise PolygonError(f"coordinates spread over {extent:g}, more than {LARGEST:g}")
    kept = _distinct(p, closed, SAME_VERTEX * extent)
    if len(np.unique(p[kept], axis=0)) < needed:
        distinct = len(np.unique(p, axis=0))
        raise PolygonError(f"{distinct} distinct vertices; a curve needs {needed} or more")
    if 0 < extent < SMALLEST:
        raise PolygonError(f"coordinates spread over {extent:g}, less than {SMALLEST:g}")
    return p[kept], np.setdiff1d(np.arange(len(p)), kept)


def _distinct(p: FloatArray, closed: bool, apart: float) -> IntArray:
    """Indices of the vertices that lie farther than ``apart`` from the kept one before them."""
    if (lengths(np.diff(p, axis=0)) > apart).all():
        kept = list(range(len(p)))
    else:
        kept = [0]
        for i in range(1, len(p)):
            if lengths(p[i] - p[kept[-1]]) > apart:
                kept.append(i)
    while closed and len(kept) > 1 and lengths(p[kept[-1]] - p[0]) <= apart:
        kept.pop()
    return np.array(kept, dtype=np.int64)


def lengths(vectors: FloatArray) -> Any:
    """Euclidean lengths of vectors (..., d), d ≥ 2: (...,). Squares of the coordinates may overflow."""
    return reduce(np.hypot, np.moveaxis(vectors, -1, 0))


def vertex_parameters(
    points: FloatArray, knots: Parametrisation | ArrayLike = "chord", closed: bool = True
) -> FloatArray:
    """The parameter s_i of every vertex; the first is 0.

    Args:
        points: (n, d) vertices, consecutive ones distinct. closed: whether the polygon returns to its first vertex.
        knots: "chord", "uniform", "centripetal", or the parameters themselves, increasing.

    Returns:
        (n + 1,) for a closed polygon, where the last entry is the period T; (n,) for an open one.

    Raises:
        PolygonError: the number of given parameters is wrong, or they are not finite or not increasing.
    """
    n = len(points)
    if isinstance(knots, str):
        if knots not in CHORD_EXPONENT:
            raise PolygonError(f"knots are {', '.join(CHORD_EXPONENT)} or an array, not {knots!r}")
        ends = np.concatenate([points, points[:1]]) if closed else points
        chords = lengths(np.diff(ends, axis=0))
        return np.concatenate([[0.0], np.cumsum(chords ** CHORD_EXPONENT[knots])])
    given, expected = np.asarray(knots, dtype=np.float64), n + closed
    if given.shape != (expected,):
        raise PolygonError(f"{n} vertices need {expected} knots, not an array of shape {given.shape}")
    if not np.isfinite(given).all() or not (np.diff(given) > 0).all():
        raise PolygonError("knots have to be finite and increasing")
    return given - given[0]


def closed_knots(parameters: FloatArray, degree: int) -> FloatArray:
    """The (n + 1,) knots of a closed spline whose B_i is centred on vertex parameter s_i, from 0 to T.

    For odd degrees the knots are the parameters. For even degrees they are the midpoints of neighbouring parameters,
    counted from the one before s_0. ``B_i`` is centred on s_i either way.
    """
    if degree % 2:
        return parameters
    before = parameters[-2] - parameters[-1]
    middles = (np.concatenate([[before], parameters[:-1]]) + parameters) / 2
    return middles - middles[0]


def vertex_centres(parameters: FloatArray, degree: int) -> FloatArray:
    """(n,) the parameter s_i of each vertex, relative to the first knot of :func:`closed_knots`."""
    centres = parameters[:-1]
    return centres if degree % 2 else centres + (parameters[-1] - parameters[-2]) / 2


def explain(points: ArrayLike, knots: Any, closed: bool) -> PolygonError:
    """The error that says why the compiled kernels refused a polygon."""
    try:
        p, merged = clean_polygon(points, closed)
        if not isinstance(knots, str):
            knots = np.delete(np.asarray(knots, dtype=np.float64), merged)
        vertex_parameters(p, knots, closed)
    except PolygonError as error:
        return error
    return PolygonError(
        "neighbouring vertices are so close, beside the polygon's length, that their knots fall together"
    )
