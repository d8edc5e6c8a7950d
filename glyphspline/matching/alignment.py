"""Alignments of two contours by dynamic programming: of their landmarks, cyclic, and of two open arcs, elastic."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..types import FloatArray, IntArray

REACH = 24
"""Landmarks that may be without a partner in a row, and one more."""

TURN = 0.5
"""Cost of two arcs between neighbouring pairs whose turns differ by half a circle; it counts by its square."""

STEP = 8
"""Pieces of one arc, at most, that are one step of the alignment; more if one arc has many more than the other."""


@compiled
def cheapest_pairs(
    costs: FloatArray, one: FloatArray, other: FloatArray, turns: FloatArray, starts: IntArray, stretch: float
) -> tuple[float, IntArray]:
    """The cheapest cyclic alignment that has one of the pairs ``starts``.

    Args:
        costs: (n, m) of each pair; infinite for pairs that cannot be.
        one, other: (n, 4) and (m, 4) of the landmarks: the weight, which is the cost of having no partner, the length
            up to it as a part of the whole, and the direction before and after it, unwrapped.
        turns: (2,) of both contours as a whole. starts: (k, 2) pairs.
        stretch: the cost of two arcs between neighbouring pairs whose shares of the lengths differ by 1.

    Returns:
        The cost, infinite if there is none, and (p, 2) indices of the pairs, ascending in the first.
    """
    n, m = costs.shape
    least = np.inf
    chosen = np.empty((0, 2), dtype=np.int64)
    a, b = np.empty((n + 1, 4)), np.empty((m + 1, 4))
    reached, came = np.empty((n + 1, m + 1)), np.empty((n + 1, m + 1), dtype=np.int64)
    for s in range(len(starts)):
        i0, j0 = starts[s, 0], starts[s, 1]
        _turned(one, i0, turns[0], a)
        _turned(other, j0, turns[1], b)
        reached[:] = np.inf
        reached[0, 0] = costs[i0, j0]
        for i in range(1, n + 1):
            for j in range(1, m + 1):
                own = costs[(i0 + i) % n, (j0 + j) % m]
                if i == n and j == m:
                    own = 0.0
                elif i == n or j == m or not own < np.inf:
                    continue
                best, at = np.inf, -1
                left_a = 0.0
                for di in range(1, min(REACH, i) + 1):
                    left_b = 0.0
                    for dj in range(1, min(REACH, j) + 1):
                        before = reached[i - di, j - dj]
                        if before < np.inf:
                            shares = (a[i, 1] - a[i - di, 1]) - (b[j, 1] - b[j - dj, 1])
                            turn = ((a[i, 2] - a[i - di, 3]) - (b[j, 2] - b[j - dj, 3])) / np.pi
                            cost = before + left_a + left_b + stretch * abs(shares) + TURN * turn * turn
                            if cost < best:
                                best, at = cost, di * (REACH + 1) + dj
                        left_b += b[j - dj, 0]
                    left_a += a[i - di, 0]
                reached[i, j], came[i, j] = best + own, at
        if reached[n, m] < least:
            least = float(reached[n, m])
            chosen = _followed(came, n, m, i0, j0)
    return least, chosen


@compiled
def _turned(landmarks: FloatArray, first: int, lap: float, out: FloatArray) -> None:
    """The landmarks from one on, and that one again after a lap."""
    n = len(landmarks)
    for i in range(n + 1):
        k = first + i
        for c in range(4):
            out[i, c] = landmarks[k % n, c]
        if k >= n:
            out[i, 1] += 1.0
            out[i, 2] += lap
            out[i, 3] += lap


@compiled
def _followed(came: IntArray, n: int, m: int, i0: int, j0: int) -> IntArray:
    """The pairs of an alignment, from its end back."""
    pairs, count = np.empty((n, 2), dtype=np.int64), 0
    i, j = n, m
    while i > 0:
        step = came[i, j]
        i, j = i - step // (REACH + 1), j - step % (REACH + 1)
        pairs[count, 0], pairs[count, 1] = (i0 + i) % n, (j0 + j) % m
        count += 1
    pairs = pairs[:count]
    return pairs[np.argsort(pairs[:, 0])]


@compiled
def elastic_nodes(one: FloatArray, other: FloatArray, alike: FloatArray, gains: FloatArray) -> IntArray:
    """Nodes of two arcs that correspond, the first of both and the last of both among them.

    What is largest is the sum over all steps between them of √(ab) times the mean of ``alike`` along the step, where a
    and b are the lengths of both sides, and of the ``gains`` of the nodes. Without the latter this is the distance of
    the square root velocities (Srivastava, Klassen, Joshi, Jermyn 2011): a straight piece that became longer costs
    little, a piece in another direction all that it has.

    Args:
        one, other: (n,) and (m,) lengths of pieces, positive. alike: (n, m) how alike the directions of two pieces are,
            at most 1. gains: (n + 1, m + 1) of taking two nodes for partners, finite.

    Returns:
        (p, 2) indices of nodes, both columns ascending.
    """
    n, m = alike.shape
    reach = max(STEP, 2 * (max(n, m) // min(n, m) + 1))  # so that there is an alignment, whatever their numbers
    best, came = np.full((n + 1, m + 1), -np.inf), np.zeros((n + 1, m + 1), dtype=np.int64)
    best[0, 0] = 0.0
    for i in range(1, n + 1):
        for j in range(1, m + 1):
            if (i == n) != (j == m):
                continue
            a = 0.0
            for di in range(1, min(reach, i) + 1):
                a += one[i - di]
                b = 0.0
                for dj in range(1, min(reach, j) + 1):
                    b += other[j - dj]
                    before = best[i - di, j - dj] + gains[i, j]
                    bound = np.sqrt(a * b)
                    if before + bound <= best[i, j]:
                        continue
                    total = before + bound * _mean(one, other, alike, i - di, j - dj, a, b)
                    if total > best[i, j]:
                        best[i, j], came[i, j] = total, di * (reach + 1) + dj
    pairs, count = np.empty((n + m + 2, 2), dtype=np.int64), 0
    i, j = n, m
    while True:
        pairs[count, 0], pairs[count, 1] = i, j
        count += 1
        if i == 0 or j == 0:
            return pairs[:count][::-1].copy()
        step = came[i, j]
        i, j = i - step // (reach + 1), j - step % (reach + 1)


@compiled
def _mean(one: FloatArray, other: FloatArray, alike: FloatArray, p: int, q: int, a: float, b: float) -> float:
    """The mean of ``alike`` along pieces of the lengths a and b, from p and from q on, each at constant speed."""
    x, y, total, done = one[p] / a, other[q] / b, 0.0, 0.0
    while done < 1.0 - 1e-9:
        step = min(x, y)
        total += step * alike[p, q]
        done += step
        x, y = x - step, y - step
        if x < 1e-9 and p + 1 < len(one):
            p += 1
            x += one[p] / a
        if y < 1e-9 and q + 1 < len(other):
            q += 1
            y += other[q] / b
        if step == 0.0:
            break
    return total
