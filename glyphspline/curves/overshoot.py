"""How far a curve leaves the convex hull of its polygon, from a few chords a segment."""

from __future__ import annotations

import numpy as np

from ..arrays import ascending
from ..compiled import compiled, inlined
from ..types import FloatArray, IntArray
from .cubics import jet, square

STEPS = 12
"""Chords a cubic; a straight one takes a single chord."""


@compiled
def overshoot(cubics: FloatArray, polygon: FloatArray) -> float:
    """Largest distance of a closed chain of cubics (m, 4, 2), at the ends of its :func:`chords`, outside a polygon's
    convex hull; 0 for no polygon."""
    worst = 0.0
    if len(polygon) == 0:
        return worst
    points, first = chords(cubics)
    hull = convex_hull(polygon)
    for s in range(len(cubics)):
        # The distance from a convex set is convex: no point of a segment is farther away than its Bézier points are.
        reach = 0.0
        for k in range(4):
            reach = max(reach, outside(hull, cubics[s, k, 0], cubics[s, k, 1]))
        if reach > worst:
            for k in range(first[s], first[s + 1]):
                worst = max(worst, outside(hull, points[k, 0], points[k, 1]))
    return worst


@compiled
def chords(cubics: FloatArray) -> tuple[FloatArray, IntArray]:
    """(N, 2) ends of the chords, the first not repeated at the end, and (m + 1,) where each segment's begin."""
    m = len(cubics)
    points, first = np.empty((STEPS * m, 2)), np.empty(m + 1, dtype=np.int64)
    count = first[0] = 0
    for j in range(m):
        b = cubics[j]
        bend = 0.0
        for k in range(1, 3):
            x, y = b[k + 1, 0] - 2 * b[k, 0] + b[k - 1, 0], b[k + 1, 1] - 2 * b[k, 1] + b[k - 1, 1]
            bend = max(bend, abs(x) + abs(y))
        n = STEPS if bend > 1e-9 * (abs(b[3, 0] - b[0, 0]) + abs(b[3, 1] - b[0, 1])) else 1
        for k in range(n):
            x, y, _, _, _, _ = jet(cubics, j, k / n)
            if count == 0 or points[count - 1, 0] != x or points[count - 1, 1] != y:
                points[count, 0], points[count, 1] = x, y
                count += 1
        first[j + 1] = count
    return points[:count], first


@compiled
def outside(hull: FloatArray, x: float, y: float) -> float:
    """Distance of a point from a convex polygon, 0 within."""
    n = len(hull)
    seen = n < 3
    for k in range(n):
        ax, ay, bx, by = hull[k - 1, 0], hull[k - 1, 1], hull[k, 0], hull[k, 1]
        seen = seen or side(ax, ay, bx, by, x, y) < 0
    if not seen:
        return 0.0
    nearest = np.inf  # of all sides: rounding shows a point of the hull the outside of a side far away, in line with it
    for k in range(n):
        ax, ay = hull[k - 1, 0], hull[k - 1, 1]
        dx, dy = hull[k, 0] - ax, hull[k, 1] - ay
        whole = dx * dx + dy * dy
        along = ((x - ax) * dx + (y - ay) * dy) / whole if whole > 0 else 0.0
        along = min(max(along, 0.0), 1.0)
        nearest = min(nearest, square(x - ax - along * dx) + square(y - ay - along * dy))
    return np.sqrt(nearest)


@compiled
def convex_hull(points: FloatArray) -> FloatArray:
    """The convex hull, counter-clockwise, by Andrew's monotone chain."""
    n = len(points)
    hull = np.empty((2 * n + 1, 2))
    order = ascending(points[:, 1].copy())
    order = order[ascending(points[:, 0][order])]
    count = 0
    for step in range(2):
        base = count
        for k in range(n):
            q = order[k if step == 0 else n - 1 - k]
            px, py = points[q, 0], points[q, 1]
            while count >= base + 2:
                a, b = count - 2, count - 1
                if side(hull[a, 0], hull[a, 1], hull[b, 0], hull[b, 1], px, py) > 0:
                    break
                count -= 1
            hull[count, 0], hull[count, 1] = px, py
            count += 1
        count -= 1
    return hull[: max(count, 1)]


@inlined
def side(ax: float, ay: float, bx: float, by: float, px: float, py: float) -> float:
    """Positive where p lies to the left of the line from a to b."""
    return (bx - ax) * (py - ay) - (by - ay) * (px - ax)
