"""Self-crossings of closed contours and their overshoot over a convex hull, from a few chords a segment.

Bézier points rule out most segments: a segment lies in their convex hull, and does not cross itself if all legs run
forward along a common direction.
"""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..types import FloatArray, IntArray
from .cubics import jet
from .sorting import ascending

STEPS = 12
"""Chords a cubic; a straight one takes a single chord. Loops smaller than a twelfth of a segment go uncounted."""


@compiled(internal=True)
def crossings_and_overshoot(cubics: FloatArray, polygon: FloatArray) -> tuple[int, float]:
    """Self-crossings of a closed chain of cubics (m, 4, 2), and overshoot over a polygon, 0 if that is empty."""
    points, first = chords(cubics)
    beyond = farthest_outside(cubics, points, first, polygon) if len(polygon) > 0 else 0.0
    return count_crossings(cubics, points, first), beyond


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
def count_crossings(cubics: FloatArray, points: FloatArray, first: IntArray) -> int:
    """Pairs of chords that cross properly, of a closed chain (m, 4, 2) and its :func:`chords`."""
    m, n = len(cubics), len(points)
    left, right, low, high = np.empty(m), np.empty(m), np.empty(m), np.empty(m)
    for j in range(m):
        left[j] = right[j] = cubics[j, 0, 0]
        low[j] = high[j] = cubics[j, 0, 1]
        for k in range(1, 4):
            left[j], right[j] = min(left[j], cubics[j, k, 0]), max(right[j], cubics[j, k, 0])
            low[j], high[j] = min(low[j], cubics[j, k, 1]), max(high[j], cubics[j, k, 1])
    order = ascending(left)
    found = 0
    for oi in range(m):
        for oj in range(oi, m):
            s, t = order[oi], order[oj]
            if left[t] > right[s]:
                break
            if low[t] > high[s] or high[t] < low[s]:
                continue
            if abs(s - t) <= 1 and runs_forward(cubics, min(s, t), max(s, t)):
                continue
            for i in range(first[s], first[s + 1]):
                ax, ay, bx, by = points[i, 0], points[i, 1], points[(i + 1) % n, 0], points[(i + 1) % n, 1]
                least_x, most_x, least_y, most_y = min(ax, bx), max(ax, bx), min(ay, by), max(ay, by)
                for j in range(i + 1 if s == t else first[t], first[t + 1]):
                    cx, cy, dx, dy = points[j, 0], points[j, 1], points[(j + 1) % n, 0], points[(j + 1) % n, 1]
                    if max(cx, dx) < least_x or min(cx, dx) > most_x or max(cy, dy) < least_y or min(cy, dy) > most_y:
                        continue
                    if j == (i + 1) % n or i == (j + 1) % n:
                        continue
                    # A chord that only reaches the other one is counted at one of its ends: zero belongs to the left.
                    one = (side(ax, ay, bx, by, cx, cy) >= 0) != (side(ax, ay, bx, by, dx, dy) >= 0)
                    if one and (side(cx, cy, dx, dy, ax, ay) >= 0) != (side(cx, cy, dx, dy, bx, by) >= 0):
                        found += 1
    return found


@compiled(internal=True)
def runs_forward(cubics: FloatArray, i: int, j: int) -> bool:
    """Whether all legs of segments i to j run along the chord from the first point to the last."""
    x, y = cubics[j, 3, 0] - cubics[i, 0, 0], cubics[j, 3, 1] - cubics[i, 0, 1]
    for s in range(i, j + 1):
        for k in range(3):
            dx, dy = cubics[s, k + 1, 0] - cubics[s, k, 0], cubics[s, k + 1, 1] - cubics[s, k, 1]
            if dx * x + dy * y <= 0 and (dx != 0 or dy != 0):
                return False
    return True


@compiled(internal=True)
def side(ax: float, ay: float, bx: float, by: float, px: float, py: float) -> float:
    """Positive where p lies to the left of the line from a to b."""
    return (bx - ax) * (py - ay) - (by - ay) * (px - ax)


@compiled
def farthest_outside(cubics: FloatArray, points: FloatArray, first: IntArray, polygon: FloatArray) -> float:
    """Largest distance of ends of the chain's :func:`chords` outside a polygon's convex hull."""
    hull = convex_hull(polygon)
    worst = 0.0
    for s in range(len(cubics)):
        # The distance from a convex set is convex: no point of a segment is farther away than its Bézier points are.
        reach = 0.0
        for k in range(4):
            reach = max(reach, outside(hull, cubics[s, k, 0], cubics[s, k, 1]))
        if reach > worst:
            for k in range(first[s], first[s + 1]):
                worst = max(worst, outside(hull, points[k, 0], points[k, 1]))
    return worst


@compiled(internal=True)
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
        square = dx * dx + dy * dy
        along = ((x - ax) * dx + (y - ay) * dy) / square if square > 0 else 0.0
        along = min(max(along, 0.0), 1.0)
        nearest = min(nearest, (x - ax - along * dx) ** 2 + (y - ay - along * dy) ** 2)
    return np.sqrt(nearest)


@compiled(internal=True)
def convex_hull(points: FloatArray) -> FloatArray:
    """The convex hull, counter-clockwise, by Andrew's monotone chain."""
    n = len(points)
    x, y, hull = np.empty(n), np.empty(n), np.empty((2 * n + 1, 2))
    for i in range(n):
        y[i] = points[i, 1]
    by_y = ascending(y)
    for i in range(n):
        x[i] = points[by_y[i], 0]
    by_x = ascending(x)
    count = 0
    for step in range(2):
        base = count
        for k in range(n):
            q = by_y[by_x[k if step == 0 else n - 1 - k]]
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
