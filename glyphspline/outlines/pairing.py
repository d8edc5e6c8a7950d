"""Cyclic alignment of two sequences of landmarks: pairs in one order, the rest without a partner, at the least cost."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..types import FloatArray, IntArray

REACH = 24
"""Landmarks that may be without a partner in a row, and one more."""

TURN = 0.5
"""Cost of two arcs between neighbouring pairs whose turns differ by half a circle; it counts by its square."""


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
