"""Alignments of two contours by dynamic programming: of their landmarks, cyclic, and of two open arcs, elastic."""

from __future__ import annotations

import numpy as np

from ....compiled import compiled
from ....types import FloatArray, IntArray

REACH = 24
"""Landmarks that may be without a partner in a row, and one more."""


@compiled
def cheapest_pairs(costs: FloatArray, one: FloatArray, other: FloatArray, starts: IntArray) -> tuple[float, IntArray]:
    """The cheapest cyclic alignment that has one of the pairs ``starts``.

    Args:
        costs: (n, m) of each pair; infinite for pairs that cannot be.
        one, other: (2n, 4) and (2m, 4) of the landmarks in two laps: the weight, which is the cost of having no
            partner, the length up to it as a part of the whole, and the direction before and after it, unwrapped.
        starts: (k, 2) pairs.

    Returns:
        The cost, infinite if there is none, and (p, 2) indices of the pairs, ascending in the first.
    """
    n, m = costs.shape
    least = np.inf
    chosen = np.empty((0, 2), dtype=np.int64)
    reached, came = np.empty((n + 1, m + 1)), np.empty((n + 1, m + 1), dtype=np.int64)
    for s in range(len(starts)):
        i0, j0 = starts[s, 0], starts[s, 1]
        a, b = one[i0:], other[j0:]
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
                            # Two arcs between neighbouring pairs cost 1 if one is longer by the length of the whole
                            # contour, and 0.5 if their turns differ by half a circle; this counts by its square.
                            cost = before + left_a + left_b + abs(shares) + 0.5 * turn * turn
                            if cost < best:
                                best, at = cost, di * (REACH + 1) + dj
                        left_b += b[j - dj, 0]
                    left_a += a[i - di, 0]
                reached[i, j], came[i, j] = best + own, at
        if reached[n, m] < least:
            least = float(reached[n, m])
            chosen = _followed(came, REACH)[:-1] + np.array([i0, j0])
    first = 0  # of those in the second lap
    while first < len(chosen) and chosen[first, 0] < n:
        first += 1
    for k in range(len(chosen)):
        chosen[k, 0], chosen[k, 1] = chosen[k, 0] % n, chosen[k, 1] % m
    return least, np.concatenate((chosen[first:], chosen[:first]))


@compiled
def _followed(came: IntArray, reach: int) -> IntArray:
    """(p, 2) the cells of an alignment from the first to the last; ``came`` has di (reach + 1) + dj of its steps."""
    i, j = came.shape[0] - 1, came.shape[1] - 1
    cells, count = np.empty((i + j + 2, 2), dtype=np.int64), 0
    while True:
        cells[count, 0], cells[count, 1] = i, j
        count += 1
        if i == 0 or j == 0:
            return cells[:count][::-1].copy()
        step = came[i, j]
        i, j = i - step // (reach + 1), j - step % (reach + 1)


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
    # Pieces of one arc, at most, that are one step of the alignment; more if one arc has many more than the other.
    reach = max(8, 2 * (max(n, m) // min(n, m) + 1))  # so that there is an alignment, whatever their numbers
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
                    p, q, mean, done = i - di, j - dj, 0.0, 0.0  # of ``alike``, both sides run at constant speed
                    x, y = one[p] / a, other[q] / b
                    while done < 1.0 - 1e-9:
                        step = min(x, y)
                        mean += step * alike[p, q]
                        done += step
                        x, y = x - step, y - step
                        if x < 1e-9 and p + 1 < n:
                            p += 1
                            x += one[p] / a
                        if y < 1e-9 and q + 1 < m:
                            q += 1
                            y += other[q] / b
                        if step == 0.0:
                            break
                    total = before + bound * mean
                    if total > best[i, j]:
                        best[i, j], came[i, j] = total, di * (reach + 1) + dj
    return _followed(came, reach)
