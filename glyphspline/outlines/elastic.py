"""Elastic matching of two open arcs: which parameter makes one of the other, by directions and stretches together."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..types import FloatArray, IntArray

STEP = 8
"""Pieces of one arc, at most, that are one step of the alignment; more if one arc has many more than the other."""


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
