"""What can be said of closed chains of cubics, for whole glyphs: length, area, curvature, crossings, overshoot.

The numbers are those of :mod:`..measure` and :mod:`..crossings`, which look at every piece in full. Here pieces are
looked at closely only where their Bézier points do not settle the matter.
"""

from __future__ import annotations

import numpy as np

from ..arcs import jet, jit
from ..arrays import FloatArray, IntArray
from ..crossings import STEPS, _hull, _side
from ..measure import CURVATURE_STEPS, NODES, WEIGHTS

LENGTH, AREA, ENERGY, CURVATURE, OVERSHOOT, CROSSINGS = range(6)
"""Columns of what :func:`forms` gives."""

PLACES = np.concatenate([(NODES + 1) / 2, np.arange(CURVATURE_STEPS + 1) / CURVATURE_STEPS])
"""Parameters at which speed and curvature are looked at: for integrals, then for the largest curvature."""


@jit
def forms(pieces: FloatArray, offsets: IntArray, polygons: FloatArray, corners: IntArray) -> FloatArray:
    """(K, 6) measures of ragged closed chains of cubics.

    Args:
        pieces: (N, 4, 2) with ``offsets``. polygons: ragged, with offsets ``corners``: the overshoot is the largest
            distance of the curve outside a polygon's convex hull. Without polygons it is 0.
    """
    found = np.zeros((len(offsets) - 1, 6))
    for k in range(len(offsets) - 1):
        part = pieces[offsets[k] : offsets[k + 1]]
        _shape(part, found[k])
        if len(polygons) > 0:
            found[k, OVERSHOOT] = _overshoot(part, polygons[corners[k] : corners[k + 1]])
        found[k, CROSSINGS] = _crossings(part)
    return found


@jit
def _shape(pieces: FloatArray, found: FloatArray) -> None:
    """Integrals by Gauss's rule over each piece, and the largest curvature at even parameters."""
    count = len(PLACES)
    speeds, bends, areas = np.empty(count), np.empty(count), np.empty(count)
    for s in range(len(pieces)):
        c = pieces[s]
        ax, ay = 3 * (c[1, 0] - c[0, 0]), 3 * (c[1, 1] - c[0, 1])
        bx, by = 3 * (c[2, 0] - c[1, 0]) - ax, 3 * (c[2, 1] - c[1, 1]) - ay
        ex, ey = 3 * (c[3, 0] - c[2, 0]) - ax - 2 * bx, 3 * (c[3, 1] - c[2, 1]) - ay - 2 * by
        for k in range(count):
            x = PLACES[k]
            dx, dy = ax + x * (2 * bx + x * ex), ay + x * (2 * by + x * ey)
            hx, hy = 2 * (bx + x * ex), 2 * (by + x * ey)
            px = c[0, 0] + x * (ax + x * (bx + x * (ex / 3)))
            py = c[0, 1] + x * (ay + x * (by + x * (ey / 3)))
            speed = np.sqrt(dx * dx + dy * dy)
            # Dividing by the speed three times keeps tiny and huge curves from under- and overflow.
            inverse = 1 / speed
            speeds[k] = speed
            bends[k] = abs(dx * inverse * (hy * inverse) - dy * inverse * (hx * inverse)) * inverse
            areas[k] = px * dy - py * dx
        for k in range(len(NODES)):
            found[LENGTH] += WEIGHTS[k] * speeds[k] / 2
            found[AREA] += WEIGHTS[k] * areas[k] / 4
            found[ENERGY] += WEIGHTS[k] * bends[k] * bends[k] * speeds[k] / 2 if speeds[k] > 0 else np.inf
        for k in range(len(NODES), count):
            found[CURVATURE] = max(found[CURVATURE], bends[k] if speeds[k] > 0 else np.inf)


@jit
def _overshoot(pieces: FloatArray, polygon: FloatArray) -> float:
    """Largest distance of points of the curve outside the convex hull of a polygon, in whose order its pieces are.

    The hull holds the polygon's sides, and distance from a convex set is largest at a Bézier point: so a piece is no
    farther outside than its Bézier points are from a side. Pieces that may be farthest come first.
    """
    n, m = len(pieces), len(polygon)
    most = np.zeros(n)
    for s in range(n):
        for k in range(4):
            d = _from_side(polygon, s % m, (s + 1) % m, pieces[s, k, 0], pieces[s, k, 1])
            most[s] = max(most[s], d)
    hull = _hull(polygon)
    worst = 0.0
    for s in np.argsort(-most):
        if most[s] <= worst:
            break
        for k in range(STEPS):
            x, y, _, _, _, _ = jet(pieces, s, k / STEPS)
            worst = max(worst, _outside(hull, x, y, worst))
    return np.sqrt(worst)


@jit
def _from_side(points: FloatArray, i: int, j: int, x: float, y: float) -> float:
    """Squared distance of (x, y) from the line segment between points i and j."""
    ax, ay = points[i]
    bx, by = points[j, 0] - ax, points[j, 1] - ay
    square = bx * bx + by * by
    along = ((x - ax) * bx + (y - ay) * by) / square if square > 0 else 0.0
    along = min(max(along, 0.0), 1.0)
    return (x - ax - along * bx) ** 2 + (y - ay - along * by) ** 2


@jit
def _outside(hull: FloatArray, x: float, y: float, enough: float) -> float:
    """Squared distance of (x, y) from a convex polygon that runs counter-clockwise; 0 if it is at most ``enough``."""
    n = len(hull)
    outside, nearest = n < 3, np.inf
    for k in range(n):
        j = k + 1 if k + 1 < n else 0
        outside |= _side(hull[k, 0], hull[k, 1], hull[j, 0], hull[j, 1], x, y) < 0
        nearest = min(nearest, _from_side(hull, k, j, x, y))
        if nearest <= enough:
            return 0.0
    return nearest if outside else 0.0


@jit
def _crossings(pieces: FloatArray) -> int:
    """Number of places where a closed chain crosses itself, on chords as :func:`..crossings.flatten` has them.

    Pieces are compared if their boxes overlap; a piece with itself, or with the next one, unless it is monotone in the
    direction of its chord, or both are in that of theirs.
    """
    n = len(pieces)
    box = np.empty((n, 4))
    for s in range(n):
        for c in range(2):
            box[s, c] = min(min(pieces[s, 0, c], pieces[s, 1, c]), min(pieces[s, 2, c], pieces[s, 3, c]))
            box[s, c + 2] = max(max(pieces[s, 0, c], pieces[s, 1, c]), max(pieces[s, 2, c], pieces[s, 3, c]))
    order = np.argsort(box[:, 0])
    a, b = np.empty((STEPS + 1, 2)), np.empty((STEPS + 1, 2))
    found = 0
    for oi in range(n):
        i = order[oi]
        for oj in range(oi, n):
            j = order[oj]
            if box[j, 0] > box[i, 2]:
                break
            if box[j, 1] > box[i, 3] or box[j, 3] < box[i, 1]:
                continue
            first, second = (i, j) if j == (i + 1) % n else (j, i)
            follows = second == (first + 1) % n
            if (first == second or (follows and n > 2)) and _monotone(pieces, first, second):
                continue
            ring = first == (second + 1) % n
            found += _crossed(
                a, _chords(pieces, first, a), b, _chords(pieces, second, b), first == second, follows, ring
            )
    return found


@jit
def _monotone(pieces: FloatArray, i: int, j: int) -> bool:
    """Whether pieces i and j both run forward all along the direction from the start of i to the end of j."""
    x, y = pieces[j, 3, 0] - pieces[i, 0, 0], pieces[j, 3, 1] - pieces[i, 0, 1]
    for s in (i, j):
        for k in range(3):
            if (pieces[s, k + 1, 0] - pieces[s, k, 0]) * x + (pieces[s, k + 1, 1] - pieces[s, k, 1]) * y <= 0:
                return False
    return True


@jit
def _chords(pieces: FloatArray, s: int, points: FloatArray) -> int:
    """Ends of the chords of a piece into ``points``; how many chords: one if it is straight."""
    c = pieces[s]
    bend = 0.0
    for k in (1, 2):
        bend = max(bend, abs(c[k + 1, 0] - 2 * c[k, 0] + c[k - 1, 0]) + abs(c[k + 1, 1] - 2 * c[k, 1] + c[k - 1, 1]))
    n = STEPS if bend > 1e-9 * (abs(c[3, 0] - c[0, 0]) + abs(c[3, 1] - c[0, 1])) else 1
    for k in range(n):
        points[k, 0], points[k, 1], _, _, _, _ = jet(pieces, s, k / n)
    points[n] = c[3]
    return n


@jit
def _crossed(a: FloatArray, m: int, b: FloatArray, n: int, same: bool, follows: bool, ring: bool) -> int:
    """Chords of one piece that properly cross those of another, which is the ``same``, or ``follows`` it, or neither.

    In a ring the first also follows the second.
    """
    found = 0
    for i in range(m):
        ax, ay = a[i]
        bx, by = a[i + 1]
        low, high, left, right = min(ay, by), max(ay, by), min(ax, bx), max(ax, bx)
        for j in range(i + 2 if same else 0, n):
            if follows and not same and i == m - 1 and j == 0:
                continue
            if ring and i == 0 and j == n - 1:
                continue
            cx, cy = b[j]
            dx, dy = b[j + 1]
            if max(cy, dy) < low or min(cy, dy) > high or max(cx, dx) < left or min(cx, dx) > right:
                continue
            # A chord that only reaches the other one is counted at one of its ends: zero belongs to the left side.
            one = (_side(ax, ay, bx, by, cx, cy) >= 0) != (_side(ax, ay, bx, by, dx, dy) >= 0)
            two = (_side(cx, cy, dx, dy, ax, ay) >= 0) != (_side(cx, cy, dx, dy, bx, by) >= 0)
            if one and two:
                found += 1
    return found
