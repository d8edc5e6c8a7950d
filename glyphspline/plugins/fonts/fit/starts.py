"""Quadratics to begin with, between two joints of an outline."""

from __future__ import annotations

import numpy as np

from ....compiled import compiled
from ....curves.cubics import length
from ....fitting.sharp.corners import turn_between
from ....types import FloatArray
from .chains import LEAST, SLACK, Quads, empty_quads, set_tangents
from .gates import KINK
from .outlines import Ends


@compiled
def ended(ends: Ends, a: int, b: int, count: int, before: bool, behind: bool) -> Quads:
    """Quadratics from joint a to joint b that are to be placed between their ends; the tangents there, and what is
    beyond.

    Args:
        ends: of :class:`.fit.outlines.Given`. before, behind: whether they begin along the line before them, and end
            along that behind.
    """
    first, corner, arriving, leaving, way, turns, node = ends
    q = empty_quads(len(node), count)
    for s in range(count + 1):
        q.turns[SLACK, s] = q.turns[LEAST, s] = KINK
    for end in range(2):
        s, k, along = (count, b, behind) if end else (0, a, before)
        for row in range(4):
            q.turns[row, s] = turns[1 - end, row, k]
        for w in range(len(node)):
            tangent = leaving[w, k] if along == (end == 1) else arriving[w, k]
            for axis in range(2):
                q.T[w, s, axis], q.beyond[w, s, axis] = tangent[axis], way[end, w, k, axis]
                q.node[w, s, axis] = node[w, k, axis]
        q.lo[s], q.implied[s], q.tied[s - end, end] = first[k], False, not corner[k]
    return q


@compiled
def begin(
    ends: Ends, samples: FloatArray, a: int, b: int, count: int, before: bool, behind: bool
) -> tuple[bool, Quads]:  # fmt: skip
    """Quadratics to begin with, see :func:`ended`, along samples (K, N, 2) of the outline; False: these are too few."""
    q, K = ended(ends, a, b, count, before, behind), len(samples)
    first, n = q.lo[0], q.lo[count] - q.lo[0]
    # Quadratics are short where the outline turns, and none is much longer than its neighbours.
    sizes, bends, at, total, turn = np.zeros(n), np.zeros(n + 1), np.zeros(n + 1), 0.0, 0.0
    for w in range(K):
        x_before = y_before = 0.0
        for k in range(n):
            x = samples[w, first + k + 1, 0] - samples[w, first + k, 0]
            y = samples[w, first + k + 1, 1] - samples[w, first + k, 1]
            sizes[k] += length(x, y)
            if k > 0:
                bends[k] += turn_between(x_before, y_before, x, y)
            x_before, y_before = x, y
    for k in range(n):
        total, turn = total + sizes[k], turn + bends[k]
    total, turn = max(total, 1e-12), max(turn, 1e-6)
    for k in range(n):
        share = sizes[k] / total
        at[k + 1] = at[k] + np.sqrt((bends[k] + bends[k + 1]) / 2 / turn * share) + 0.1 * share
    k = 0
    for s in range(1, count):
        while k < n and at[k] < at[n] * s / count:
            k += 1
        q.lo[s] = first + min(max(k, q.lo[s - 1] - first + 2), n - 2 * (count - s))
        if q.lo[s] <= q.lo[s - 1] + 1:
            return False, q
        set_tangents(q, s, samples)
    for w in range(K):
        c, node, T = q.c[w], q.node[w], q.T[w]
        for s in range(1, count):
            node[s, 0], node[s, 1] = samples[w, q.lo[s], 0], samples[w, q.lo[s], 1]
        least = 0.05 * length(node[count, 0] - node[0, 0], node[count, 1] - node[0, 1]) / count
        for s in range(count):
            c[s, 0], c[s, 1] = meeting(node[s], T[s], node[s + 1], T[s + 1])
        for s, end in ((0, 0), (count - 1, 1)):
            if q.tied[s, end] and not q.tied[s, 1 - end]:
                # On its tangent, ahead of the end.
                px, py, tx, ty = node[s + end, 0], node[s + end, 1], T[s + end, 0], T[s + end, 1]
                along = (c[s, 0] - px) * tx + (c[s, 1] - py) * ty
                along = min(along, -least) if end else max(along, least)
                c[s, 0], c[s, 1] = px + along * tx, py + along * ty
    return True, q


@compiled
def meeting(p: FloatArray, a: FloatArray, r: FloatArray, b: FloatArray) -> tuple[float, float]:
    """Where the line from p along a meets that from r along b; midway if nowhere near."""
    x, y = r[0] - p[0], r[1] - p[1]
    cross, size = a[0] * b[1] - a[1] * b[0], length(x, y)
    if abs(cross) > 0.02:
        s, t = (x * b[1] - y * b[0]) / cross, (x * a[1] - y * a[0]) / cross
        if 0.0 < s < 2.0 * size and -2.0 * size < t < 0.0:
            return p[0] + s * a[0], p[1] + s * a[1]
    return (p[0] + r[0]) / 2, (p[1] + r[1]) / 2
