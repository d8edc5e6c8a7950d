"""Validation of polygons, and merging of duplicate vertices."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..curves.parameters import lengths
from ..errors import PolygonError
from ..types import FloatArray, IntArray

SAME_VERTEX = 1e-12
"""Neighbours nearer than this share of the polygon's extent are one vertex.

With a much smaller value, sums of chords in floating point would give them the same knot.
"""


def as_points(points: ArrayLike) -> FloatArray:
    """Vertices as (n, d) float64, d ≥ 2, contiguous; a PolygonError if they are not numbers or of another shape."""
    try:
        p = np.ascontiguousarray(points, dtype=np.float64)
    except (TypeError, ValueError) as cause:
        raise PolygonError("a polygon is an array of numbers of shape (n, d) with d >= 2") from cause
    if p.ndim != 2 or p.shape[1] < 2:
        raise PolygonError(f"a polygon has shape (n, d) with d >= 2, not {p.shape}")
    return p


def as_tangent(tangent: ArrayLike, d: int) -> FloatArray:
    """An end tangent as (d,) float64; a PolygonError if it is not so many numbers."""
    try:
        given = np.asarray(tangent, dtype=np.float64)
    except (TypeError, ValueError) as cause:
        raise PolygonError("an end tangent is an array of numbers") from cause
    if given.shape != (d,):
        raise PolygonError(f"an end tangent of a polygon (n, {d}) has shape ({d},), not {given.shape}")
    return given


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


LARGEST, SMALLEST = 1e100, 1e-100
"""Extents beyond which squared distances leave the range of floats."""


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
