"""Vertices taken out of a contour's polygon where the curve is nearer to the outline than it has to be."""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.sorting import ascending
from ...types import BoolArray, FloatArray


@compiled
def sparse(
    points: FloatArray, places: FloatArray, turns: FloatArray, corner_angle: float, needed: BoolArray,
    errors: FloatArray, near: float, ratio: float, power: float,
) -> BoolArray:  # fmt: skip
    """Which vertices of a closed polygon to keep: not those without which the error would still be small enough.

    The error of a span is taken to grow with the given power of its length. Smallest errors first, no two neighbours
    at once, and none without which adjacent chords would be beyond ``ratio``. Without a vertex at a corner, the error
    is at least its height over the chord that takes its place.

    Args:
        points: (n, 2), at places (n,). turns: at the joints; from ``corner_angle`` a joint is a corner.
        needed: (n,) vertices that are kept in any case. errors: (n,) of the span after each vertex.
    """
    n = len(points)
    keep, expected = np.empty(n, dtype=np.bool_), np.empty(n)
    for i in range(n):
        keep[i], expected[i] = True, np.inf
        if needed[i]:
            continue
        k = (i + 1) % n
        h, g = chord(points, i - 1, i), chord(points, i, k)
        expected[i] = max(errors[i - 1], errors[i]) * ((g + h) / max(g, h)) ** power
        j = int(places[i])
        if places[i] == j and turns[j] >= corner_angle:
            ax, ay = points[k, 0] - points[i - 1, 0], points[k, 1] - points[i - 1, 1]
            bx, by = points[i, 0] - points[i - 1, 0], points[i, 1] - points[i - 1, 1]
            square = ax * ax + ay * ay
            along = min(max((ax * bx + ay * by) / square, 0.0), 1.0) if square > 0 else 0.0
            expected[i] = max(expected[i], np.sqrt((bx - along * ax) ** 2 + (by - along * ay) ** 2))
    order, left = ascending(expected), n
    for k in range(n):
        i = order[k]
        if not expected[i] <= near or left <= 4:
            break
        before, after = (i - 1) % n, (i + 1) % n
        if not (keep[before] and keep[after]):
            continue
        further, beyond = (before - 1) % n, (after + 1) % n
        while not keep[further]:
            further = (further - 1) % n
        while not keep[beyond]:
            beyond = (beyond + 1) % n
        h, g, f = chord(points, further, before), chord(points, before, after), chord(points, after, beyond)
        if max(h, g) <= ratio * min(h, g) and max(f, g) <= ratio * min(f, g):
            keep[i] = False
            left -= 1
    return keep


@compiled
def chord(points: FloatArray, i: int, j: int) -> float:
    """Distance between vertices i and j."""
    return np.sqrt((points[j, 0] - points[i, 0]) ** 2 + (points[j, 1] - points[i, 1]) ** 2)


@compiled
def put_back(points: FloatArray, keep: BoolArray, errors: FloatArray, near: float, ratio: float) -> BoolArray:
    """Keep again what had been taken out of the spans that are now too far off, or of those beside them.

    Args:
        points: (n, 2) the polygon before. keep: (n,) the vertices of the polygon after. errors: of its spans.
    """
    n = len(points)
    kept = np.flatnonzero(keep)
    m = len(kept)
    after = keep.copy()
    for j in range(m):
        if errors[j] > near:
            last = kept[(j + 2) % m]
            i = (kept[j - 1] + 1) % n
            while i != last:
                after[i] = True
                i = (i + 1) % n
    while True:
        kept = np.flatnonzero(after)
        m = len(kept)
        changed = False
        for j in range(m):
            a, b, c, d = kept[j - 1], kept[j], kept[(j + 1) % m], kept[(j + 2) % m]
            h = chord(points, b, c)
            if (b + 1) % n != c and h > ratio * min(chord(points, a, b), chord(points, c, d)):
                after[(b + 1) % n] = True
                changed = True
        if not changed:
            return after
