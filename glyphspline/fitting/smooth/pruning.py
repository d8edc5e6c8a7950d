"""Vertices taken out of a contour's polygon where the curve is nearer to the outline than it has to be."""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...types import BoolArray, FloatArray


@compiled
def sparse(
    points: FloatArray, corners: BoolArray, stay: BoolArray, errors: FloatArray, near: float, ratio: float, power: float
) -> BoolArray:
    """Which vertices of a closed polygon to keep: not those without which the error would still be small enough.

    The error of a span is taken to grow with the given power of its length. Smallest errors first, no two neighbours
    at once, and none without which adjacent chords would be beyond ``ratio``.

    Args:
        points: (n, 2). corners: (n,) vertices at corners, expected to be off by their height over the chord that
            would take their place. stay: (n,) vertices that are kept in any case. errors: (n,) of the span after each
            vertex.
    """
    n = len(points)
    keep = np.ones(n, dtype=np.bool_)
    expected = np.full(n, np.inf)
    for i in range(n):
        if stay[i]:
            continue
        h, g = _chord(points, i - 1, i), _chord(points, i, (i + 1) % n)
        expected[i] = max(errors[i - 1], errors[i]) * ((g + h) / max(g, h)) ** power
        if corners[i]:
            expected[i] = max(expected[i], _height(points, i - 1, i, (i + 1) % n))
    left = n
    for i in np.argsort(expected):
        if not expected[i] <= near or left <= 4:
            break
        before, after = (i - 1) % n, (i + 1) % n
        if not (keep[before] and keep[after]):
            continue
        further, beyond = _kept(keep, before, -1), _kept(keep, after, 1)
        h, g, f = _chord(points, further, before), _chord(points, before, after), _chord(points, after, beyond)
        if max(h, g) <= ratio * min(h, g) and max(f, g) <= ratio * min(f, g):
            keep[i] = False
            left -= 1
    return keep


@compiled
def _height(points: FloatArray, i: int, j: int, k: int) -> float:
    """Distance of vertex j from the chord between i and k."""
    ax, ay = points[k, 0] - points[i, 0], points[k, 1] - points[i, 1]
    bx, by = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
    square = ax * ax + ay * ay
    along = min(max((ax * bx + ay * by) / square, 0.0), 1.0) if square > 0 else 0.0
    return np.sqrt((bx - along * ax) ** 2 + (by - along * ay) ** 2)


@compiled
def _chord(points: FloatArray, i: int, j: int) -> float:
    return np.sqrt((points[j, 0] - points[i, 0]) ** 2 + (points[j, 1] - points[i, 1]) ** 2)


@compiled
def _kept(keep: BoolArray, i: int, step: int) -> int:
    """The next vertex kept from i on."""
    i = (i + step) % len(keep)
    while not keep[i]:
        i = (i + step) % len(keep)
    return i


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
            first, last = kept[j - 1], kept[(j + 2) % m]
            i = (first + 1) % n
            while i != last:
                after[i] = True
                i = (i + 1) % n
    while True:
        kept = np.flatnonzero(after)
        m = len(kept)
        changed = False
        for j in range(m):
            a, b, c, d = kept[j - 1], kept[j], kept[(j + 1) % m], kept[(j + 2) % m]
            h = _chord(points, b, c)
            if (b + 1) % n != c and h > ratio * min(_chord(points, a, b), _chord(points, c, d)):
                after[(b + 1) % n] = True
                changed = True
        if not changed:
            return after
