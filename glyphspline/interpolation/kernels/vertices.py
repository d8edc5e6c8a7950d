"""Preparation of a polygon: duplicates merged, knots computed.

The rules are those of ``polygon.py`` and ``parameters.py``, which explain them; results agree to rounding.
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import compiled, inlined
from ...types import FloatArray, IntArray
from ..method import RELATIVE_TOLERANCE
from ..polygon import LARGEST, SAME_VERTEX, SMALLEST
from .blocks import PAD, Found, Given

OK, BAD_POLYGON, BAD_KNOTS = 0, 1, 2
"""Status codes. A refused polygon is checked again in Python to build the error message."""

STATUS, KEPT, ITERATIONS, FALLEN_BACK, SEARCHED, UNCERTIFIED = range(6)
"""Columns of ``Found.whole``."""


@inlined
def distance(p: FloatArray, i: int, j: int) -> float:
    """Distance of two vertices. Squares do not overflow within the limits of extents; ``hypot`` doubles the time."""
    squared = (p[i, 0] - p[j, 0]) * (p[i, 0] - p[j, 0]) + (p[i, 1] - p[j, 1]) * (p[i, 1] - p[j, 1])
    for axis in range(2, p.shape[1]):
        squared += (p[i, axis] - p[j, axis]) * (p[i, axis] - p[j, axis])
    return np.sqrt(squared)


@compiled
def _merge(points: FloatArray, closed: bool, kept: IntArray) -> tuple[int, float]:
    """Write the indices of the vertices that are kept; returns their number, -1 for a bad polygon, and the extent."""
    n = points.shape[0]
    if n == 0:
        return -1, 0.0
    x0 = x1 = points[0, 0]
    y0 = y1 = points[0, 1]
    for i in range(n):
        x, y = points[i, 0], points[i, 1]
        if not (np.isfinite(x) and np.isfinite(y)):
            return -1, 0.0
        x0, x1, y0, y1 = min(x0, x), max(x1, x), min(y0, y), max(y1, y)
    extent = max(x1 - x0, y1 - y0)
    for axis in range(2, points.shape[1]):
        x0 = x1 = points[0, axis]
        for i in range(n):
            if not np.isfinite(points[i, axis]):
                return -1, 0.0
            x0, x1 = min(x0, points[i, axis]), max(x1, points[i, axis])
        extent = max(extent, x1 - x0)
    if not SMALLEST <= extent <= LARGEST:
        return -1, extent
    apart = SAME_VERTEX * extent
    count, last = 1, 0
    kept[0] = 0
    for i in range(1, n):
        if distance(points, i, last) > apart:
            kept[count] = last = i
            count += 1
    while closed and count > 1:
        last = kept[count - 1]
        if distance(points, last, 0) > apart:
            break
        count -= 1
    if count < 2 or not closed:
        return (count if count >= (3 if closed else 2) else -1), extent
    a, b = kept[0], kept[1]
    for i in range(2, count):
        c = kept[i]
        if distance(points, c, a) > 0.0 and distance(points, c, b) > 0.0:
            return count, extent
    return -1, extent


@compiled
def _fill_knots(
    p: FloatArray, kept: IntArray, n: int, closed: bool, exponent: float, own: FloatArray, u: FloatArray
) -> bool:
    """Write knots, sums of powers of chord lengths or the vertices' ``own`` parameters, to u.

    Returns False if they are not finite and increasing.
    """
    u[0] = 0.0
    for i in range(1, n + 1 if closed else n):
        if exponent < 0.0:
            value = own[kept[i] if i < n else own.shape[0] - 1] - own[kept[0]]
        else:
            chord = 1.0 if exponent == 0.0 else distance(p, kept[i - 1], kept[i if i < n else 0])
            value = u[i - 1] + (np.sqrt(chord) if exponent == 0.5 else chord)
        if not np.inf > value or not value > u[i - 1]:
            return False
        u[i] = value
    return True


@inlined
def _power_of_two(x: float) -> float:
    """The power of two that brings x > 0 between 1 and 2."""
    return math.ldexp(1.0, 1 - math.frexp(x)[1])


@compiled
def knots_of(given: Given, found: Found, k: int, n: int) -> FloatArray:
    """The knots of polygon k."""
    first = given.offsets[k] + (k if given.closed else 0)
    return found.knots[first : first + n + (1 if given.closed else 0)]


@compiled
def prepare(given: Given, found: Found, k: int) -> tuple[int, float, float]:
    """Merge vertices of polygon k and compute its knots; returns the number kept, 0 if refused, and two scales.

    The scales, of lengths and of parameters, bring extent and mean knot interval near 1.
    """
    start, stop, closed = given.offsets[k], given.offsets[k + 1], given.closed
    points, kept = given.points[start:stop], found.kept[start:stop]
    row = found.whole[k]
    row[STATUS], row[ITERATIONS], row[FALLEN_BACK], row[SEARCHED], row[UNCERTIFIED] = BAD_POLYGON, -1, 0, 0, 0
    n, extent = _merge(points, closed, kept)
    row[KEPT] = n
    if n < 0:
        return 0, 1.0, 1.0
    if np.isnan(given.tolerances[k]):
        given.tolerances[k] = RELATIVE_TOLERANCE * extent
    u = knots_of(given, found, k, n)
    own = given.knots[start + (k if closed else 0) : stop + (k + 1 if closed else 0)]  # nothing, if there is a rule
    if not _fill_knots(points, kept, n, closed, given.exponent, own, u):
        row[STATUS] = BAD_KNOTS
        return 0, 1.0, 1.0
    return n, _power_of_two(extent), _power_of_two(u[-1] / n)


@compiled
def pad_intervals(u: FloatArray, closed: bool, unit: float, h: FloatArray) -> None:
    """Knot intervals times ``unit``: h[PAD + i] is that from u_i on, continued periodically, or by zeros."""
    spans = u.shape[0] - 1
    for i in range(spans):
        h[PAD + i] = (u[i + 1] - u[i]) * unit
    for k in range(PAD):  # one after another: fewer spans than PAD repeat more than once
        h[PAD - 1 - k] = h[PAD + spans - 1 - k] if closed else 0.0
    for k in range(PAD + 2):
        h[PAD + spans + k] = h[PAD + k] if closed else 0.0
