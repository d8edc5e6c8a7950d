"""Self-crossings of closed contours, and how far they leave a convex hull, on a few chords a segment.

Segments that cannot matter are told by their Bézier points: a segment lies in their hull, and one whose legs all run
forward along a common direction crosses nothing by itself.
"""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..types import FloatArray, IntArray
from .cubics import jet

STEPS = 12
"""Chords a cubic; a straight one takes a single chord. Loops smaller than a twelfth of a segment go uncounted."""


def self_crossings(cubics: FloatArray) -> int:
    """Number of places where a closed chain of cubics (m, 4, 2) crosses itself. Touching is not crossing."""
    return int(count_crossings(cubics, *chords(cubics)))


def overshoot(cubics: FloatArray, polygon: FloatArray) -> float:
    """Largest distance of points of a closed chain of cubics (m, 4, 2) outside the convex hull of a polygon (n, 2)."""
    return float(farthest_outside(cubics, *chords(cubics), polygon))


@compiled
def crossings_and_overshoot(cubics: FloatArray, polygon: FloatArray) -> tuple[int, float]:
    """Both of a closed chain of cubics (m, 4, 2), from the same chords; no overshoot over a polygon of no vertices."""
    points, first = chords(cubics)
    beyond = farthest_outside(cubics, points, first, polygon) if len(polygon) > 0 else 0.0
    return count_crossings(cubics, points, first), beyond


@compiled
def chords(cubics: FloatArray) -> tuple[FloatArray, IntArray]:
    """(N, 2) ends of the chords, the first not repeated at the end, and (m + 1,) where each segment's begin."""
    m = len(cubics)
    points, first = np.empty((STEPS * m, 2)), np.zeros(m + 1, dtype=np.int64)
    count = 0
    for j in range(m):
        b = cubics[j]
        bend = 0.0
        for k in (1, 2):
            bend = max(
                bend, abs(b[k + 1, 0] - 2 * b[k, 0] + b[k - 1, 0]) + abs(b[k + 1, 1] - 2 * b[k, 1] + b[k - 1, 1])
            )
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
    m = len(cubics)
    box = np.empty((m, 4))
    for j in range(m):
        b = cubics[j]
        for axis in range(2):
            box[j, 2 * axis] = min(min(b[0, axis], b[1, axis]), min(b[2, axis], b[3, axis]))
            box[j, 2 * axis + 1] = max(max(b[0, axis], b[1, axis]), max(b[2, axis], b[3, axis]))
    order = np.argsort(box[:, 0])
    found = 0
    for oi in range(m):
        i = order[oi]
        if not _forward(cubics, i, i):
            found += _crossing_chords(points, first, i, i)
        for oj in range(oi + 1, m):
            j = order[oj]
            if box[j, 0] > box[i, 1]:
                break
            if box[j, 2] > box[i, 3] or box[j, 3] < box[i, 2]:
                continue
            if (j == i + 1 and _forward(cubics, i, j)) or (i == j + 1 and _forward(cubics, j, i)):
                continue
            found += _crossing_chords(points, first, i, j)
    return found


@compiled
def _forward(cubics: FloatArray, i: int, j: int) -> bool:
    """Whether all legs of segments i to j run along the chord from the first point to the last."""
    x, y = cubics[j, 3, 0] - cubics[i, 0, 0], cubics[j, 3, 1] - cubics[i, 0, 1]
    for s in range(i, j + 1):
        for k in range(3):
            dx, dy = cubics[s, k + 1, 0] - cubics[s, k, 0], cubics[s, k + 1, 1] - cubics[s, k, 1]
            if dx * x + dy * y <= 0 and (dx != 0 or dy != 0):
                return False
    return True


@compiled
def _side(ax: float, ay: float, bx: float, by: float, px: float, py: float) -> float:
    return (bx - ax) * (py - ay) - (by - ay) * (px - ax)


@compiled
def _crossing_chords(p: FloatArray, first: IntArray, s: int, t: int) -> int:
    """Pairs of a chord of segment s and one of segment t that cross; those within a segment once."""
    n = len(p)
    found = 0
    for i in range(first[s], first[s + 1]):
        ax, ay = p[i]
        bx, by = p[(i + 1) % n]
        left, right, low, high = min(ax, bx), max(ax, bx), min(ay, by), max(ay, by)
        for j in range(i + 1 if s == t else first[t], first[t + 1]):
            cx, cy = p[j]
            dx, dy = p[(j + 1) % n]
            if max(cx, dx) < left or min(cx, dx) > right or max(cy, dy) < low or min(cy, dy) > high:
                continue
            if j == (i + 1) % n or i == (j + 1) % n:
                continue
            # A chord that only reaches the other one is counted at one of its ends: zero belongs to the left side.
            one = (_side(ax, ay, bx, by, cx, cy) >= 0) != (_side(ax, ay, bx, by, dx, dy) >= 0)
            two = (_side(cx, cy, dx, dy, ax, ay) >= 0) != (_side(cx, cy, dx, dy, bx, by) >= 0)
            if one and two:
                found += 1
    return found


@compiled
def farthest_outside(cubics: FloatArray, points: FloatArray, first: IntArray, polygon: FloatArray) -> float:
    """Largest distance of ends of the chain's :func:`chords` outside a polygon's convex hull."""
    hull = _hull(polygon)
    worst = 0.0
    for s in range(len(cubics)):
        # The distance from a convex set is convex: no point of a segment is farther away than its Bézier points are.
        reach = 0.0
        for k in range(4):
            reach = max(reach, _outside(hull, cubics[s, k, 0], cubics[s, k, 1]))
        if reach > worst:
            for k in range(first[s], first[s + 1]):
                worst = max(worst, _outside(hull, points[k, 0], points[k, 1]))
    return worst


@compiled
def _outside(hull: FloatArray, x: float, y: float) -> float:
    """Distance of a point from a convex polygon, 0 within."""
    n = len(hull)
    nearest, outside = np.inf, False
    for k in range(n):
        ax, ay = hull[k, 0], hull[k, 1]
        dx, dy = hull[k + 1 if k + 1 < n else 0, 0] - ax, hull[k + 1 if k + 1 < n else 0, 1] - ay
        # The nearest point lies on a side that is seen from outside.
        if n < 3 or dx * (y - ay) - dy * (x - ax) < 0:
            outside = True
            square = dx * dx + dy * dy
            along = ((x - ax) * dx + (y - ay) * dy) / square if square > 0 else 0.0
            along = min(max(along, 0.0), 1.0)
            nearest = min(nearest, (x - ax - along * dx) ** 2 + (y - ay - along * dy) ** 2)
    return np.sqrt(nearest) if outside else 0.0


@compiled
def _hull(points: FloatArray) -> FloatArray:
    """The convex hull, counter-clockwise, by Andrew's monotone chain."""
    p = points[np.argsort(points[:, 1], kind="mergesort")]
    p = p[np.argsort(p[:, 0], kind="mergesort")]
    n = len(p)
    hull = np.empty((2 * n + 1, 2))
    count = 0
    for step in range(2):
        base = count
        for k in range(n):
            q = p[k] if step == 0 else p[n - 1 - k]
            while (
                count >= base + 2
                and _side(hull[count - 2, 0], hull[count - 2, 1], hull[count - 1, 0], hull[count - 1, 1], q[0], q[1])
                <= 0
            ):
                count -= 1
            hull[count] = q
            count += 1
        count -= 1
    return hull[: max(count, 1)]
