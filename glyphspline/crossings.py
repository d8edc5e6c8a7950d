"""Self-crossings of a closed contour, counted on a polyline that is straight to a small share of its size."""

from __future__ import annotations

import numpy as np

from .arcs import jet, jit
from .arrays import FloatArray

STEPS = 12
"""Chords a cubic; a straight one takes a single chord. Loops smaller than a twelfth of a segment go uncounted."""


def self_crossings(cubics: FloatArray) -> int:
    """Number of places where a closed chain of cubics (m, 4, 2) crosses itself. Touching is not crossing."""
    return int(_count(flatten(np.ascontiguousarray(cubics))))


@jit
def flatten(cubics: FloatArray) -> FloatArray:
    """(N, 2) points of the polyline, the first not repeated at the end."""
    points = np.empty((STEPS * len(cubics), 2))
    count = 0
    for j in range(len(cubics)):
        c = cubics[j]
        bend = 0.0
        for k in (1, 2):
            bend = max(
                bend, abs(c[k + 1, 0] - 2 * c[k, 0] + c[k - 1, 0]) + abs(c[k + 1, 1] - 2 * c[k, 1] + c[k - 1, 1])
            )
        n = STEPS if bend > 1e-9 * (abs(c[3, 0] - c[0, 0]) + abs(c[3, 1] - c[0, 1])) else 1
        for k in range(n):
            x, y, _, _, _, _ = jet(cubics, j, k / n)
            if count == 0 or points[count - 1, 0] != x or points[count - 1, 1] != y:
                points[count] = x, y
                count += 1
    return points[:count]


@jit
def _side(ax: float, ay: float, bx: float, by: float, px: float, py: float) -> float:
    return (bx - ax) * (py - ay) - (by - ay) * (px - ax)


@jit
def _count(p: FloatArray) -> int:
    """Pairs of chords that cross properly: sorted by their left ends, only those that overlap in x are compared."""
    n = len(p)
    left, right = np.empty(n), np.empty(n)
    for i in range(n):
        a, b = p[i, 0], p[(i + 1) % n, 0]
        left[i], right[i] = min(a, b), max(a, b)
    order = np.argsort(left)
    found = 0
    for oi in range(n):
        i = order[oi]
        ax, ay = p[i]
        bx, by = p[(i + 1) % n]
        low, high = min(ay, by), max(ay, by)
        for oj in range(oi + 1, n):
            j = order[oj]
            if left[j] > right[i]:
                break
            if j == (i + 1) % n or i == (j + 1) % n:
                continue
            cx, cy = p[j]
            dx, dy = p[(j + 1) % n]
            if max(cy, dy) < low or min(cy, dy) > high:
                continue
            # A chord that only reaches the other one is counted at one of its ends: zero belongs to the left side.
            one = (_side(ax, ay, bx, by, cx, cy) >= 0) != (_side(ax, ay, bx, by, dx, dy) >= 0)
            two = (_side(cx, cy, dx, dy, ax, ay) >= 0) != (_side(cx, cy, dx, dy, bx, by) >= 0)
            if one and two:
                found += 1
    return found


@jit
def overshoot(cubics: FloatArray, polygon: FloatArray) -> float:
    """Largest distance of points of the curve outside the convex hull of a polygon (n, 2)."""
    hull = _hull(polygon)
    n = len(hull)
    worst = 0.0
    for p in flatten(cubics):
        outside, nearest = False, np.inf
        for k in range(n):
            ax, ay = hull[k]
            bx, by = hull[(k + 1) % n]
            outside |= _side(ax, ay, bx, by, p[0], p[1]) < 0
            square = (bx - ax) ** 2 + (by - ay) ** 2
            along = ((p[0] - ax) * (bx - ax) + (p[1] - ay) * (by - ay)) / square if square > 0 else 0.0
            along = min(max(along, 0.0), 1.0)
            nearest = min(nearest, np.hypot(p[0] - ax - along * (bx - ax), p[1] - ay - along * (by - ay)))
        if outside or n < 3:
            worst = max(worst, nearest)
    return worst


@jit
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
