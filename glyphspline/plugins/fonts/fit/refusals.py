"""What rounded quadratics are refused for: too far from the source, off the grid, or a turn that it does not have."""

from __future__ import annotations

import numpy as np

from ....compiled import compiled
from ....curves.cubics import length
from ....fitting.sharp.corners import turn_between
from ....types import BoolArray, FloatArray
from .chains import Quads, as_cubics
from .gates import CORNER, KINK, mixed
from .grid import is_kink
from .nearness import certified
from .outlines import mean


@compiled
def distances(
    q: Quads, places: FloatArray, outline: FloatArray, corners: FloatArray, i: int, j: int, tolerance: float
) -> FloatArray:
    """(R,) certified distances of quadratics from the source between its joints i and j.

    Args:
        places: of samples of the source. outline, corners: see :class:`.fit.outlines.Given`.
    """
    K, R = q.c.shape[0], q.c.shape[1]
    P, p, hints, arc = np.empty((K, R, 4, 2)), np.empty((K, 4, 2)), np.empty(R + 1), np.empty(4 if K > 1 else 0)
    for s in range(R):
        as_cubics(q, s, p)
        hints[s] = places[q.lo[s]]
        for w in range(K):
            for k in range(4):
                P[w, s, k, 0], P[w, s, k, 1] = p[w, k, 0], p[w, k, 1]
    hints[0], hints[R], stays = i, j, np.zeros(R + 1, np.bool_)
    stays[0] = True
    if K > 1:
        arc[0], arc[1], arc[2], arc[3] = 0.0, R, i, j
    skip, chain = np.zeros(R, np.bool_), mixed(corners, P)
    return certified(len(corners), chain, hints, stays, skip, False, outline, arc, tolerance)


@compiled
def wrong_quads(
    q: Quads, far: BoolArray, way: FloatArray, line: BoolArray, corner: BoolArray, mixes: FloatArray, i: int, j: int,
    ring: bool,
) -> tuple[BoolArray, int]:  # fmt: skip
    """(R,) which quadratics are too far from the source, off the grid, or turn where they may not; and the number of
    new kinks.

    Args:
        far: (R,) those that are too far.
        way, line, mixes: see :class:`.fit.outlines.Given`. corner: (m + 1,) joints that are corners. i, j: between
            which joints the quadratics are. ring: whether these are one.
    """
    K, R, m, kinks = q.c.shape[0], q.c.shape[1], len(line), 0
    bad, legs = np.zeros(R, np.bool_), np.zeros((2, K, R + 1, 2))  # what arrives at nodes, and leaves them
    for s in range(R):
        none, none_there, off = True, True, far[s]
        for w in range(K):
            for axis in range(2):
                at = q.c[w, s, axis]
                legs[1, w, s, axis], legs[0, w, s + 1, axis] = at - q.node[w, s, axis], q.node[w, s + 1, axis] - at
                none, none_there = none and at == q.node[w, s, axis], none_there and at == q.node[w, s + 1, axis]
                off = off or abs(at - np.rint(at)) > 1e-6
        # A control point on a node has no leg there whose turn is seen below.
        kinks += 0 if q.held[s] else int(none) + int(none_there)
        bad[s] = off or (not q.held[s] and (none or none_there))
    for s in range(1, R):
        if not q.implied[s] and not (q.held[s] and q.held[s - 1]):
            for weights in mixes:
                (ax, ay), (bx, by) = mean(weights, legs[0, :, s]), mean(weights, legs[1, :, s])
                if turn_between(ax, ay, bx, by) > KINK:
                    bad[s] = bad[s - 1] = True
    for end in range(2):
        k, s = j if end else i, R * end
        if q.held[s - end]:
            continue
        arriving, leaving = way[0, :, k], way[1, :, k]
        if ring:
            arriving, leaving = legs[0, :, R], legs[1, :, 0]
        share, worse, off = 1.0 if line[k % m] or line[k - 1] else 2.0, False, False
        for weights in mixes:
            (ax, ay), (bx, by) = mean(weights, arriving), mean(weights, leaving)
            x, y = mean(weights, legs[1 - end, :, s])
            own = turn_between(x, y, ax, ay) if end else turn_between(x, y, bx, by)
            turn = turn_between(x, y, bx, by) if end else turn_between(x, y, ax, ay)
            if corner[k]:  # what is beyond may turn as much, unless it is a line
                off = off or share * own > turn_between(ax, ay, bx, by) - CORNER
            else:
                worse = worse or is_kink(q, s, turn, length(x, y))
        kinks += int(worse)
        bad[s - end] = bad[s - end] or off or worse
    return bad, kinks
