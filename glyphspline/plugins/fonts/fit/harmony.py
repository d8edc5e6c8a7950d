"""Curvatures that meet: all cubics of a run moved together.

A node of a run and the handles on both sides of it lie on one line. It moves as its :class:`.run_nodes.Run` allows:
along that line, across it, turning it, and with longer or shorter handles. Gauss-Newton steps make two things small
together: the distances of the outline's samples, as for a single cubic (:mod:`.cubics`), and at every joint the
difference of the two curvatures as a share of the larger one.

Of two handle lengths a cubic and one condition a joint, one length a cubic and one more are left to follow the outline;
nodes that slide, as a designer's harmoniser has it, give one more each. Meeting derivatives of curvature (G3) would
leave nothing.
"""

from __future__ import annotations

import numpy as np

from ....compiled import compiled
from ....curves.cubics import length, square
from ....fitting.sharp.cubics import solve
from ....intrinsics import borrowed, keep_alive
from ....types import FloatArray, IntArray
from .nearness import add_samples, feet, reweight
from .run_nodes import FIXED, CubicRun, GuideArrays, RunArrays, align, handles_at, moved, set_kinds, set_moves, sides

ROUNDS = 7
"""Gauss-Newton steps. More change lengths by less than the grid's step."""

JUMP = 0.04
"""Jump of curvature that costs as much as all samples of a cubic at the tolerance."""

FLAT = 1.0
"""Curvature, in 1/em, up to which both sides of a joint are straight."""


@compiled
def end_curvature(p: FloatArray, end: int) -> float:
    """The curvature at the beginning (``end`` 0) or the end (1) of a cubic (4, 2); not finite without a handle."""
    sign, i, j, k = 1 - 2 * end, 3 * end, 1 + end, 2 - end
    ax, ay, bx, by = p[j, 0] - p[i, 0], p[j, 1] - p[i, 1], p[k, 0] - p[j, 0], p[k, 1] - p[j, 1]
    size = length(ax, ay)
    return sign * (2 / 3 * (ax * by - ay * bx) / (size * size * size))


@compiled
def end_jump(before: FloatArray, behind: FloatArray, em: float) -> float:
    """By which share of the larger one curvatures differ where two cubics (4, 2) meet; 0 where both are straight."""
    a, b = end_curvature(before, 1), end_curvature(behind, 0)
    most = max(abs(a), abs(b))
    return abs(a - b) / most if FLAT < most * em < np.inf else 0.0


@compiled
def end_jumps(P: FloatArray, em: float) -> FloatArray:
    """(K, r) of chains of cubics (K, r, 4, 2) the jump where each follows on the one before; the first on the last."""
    found = np.empty(P.shape[:2])
    for v in range(len(P)):
        for s in range(P.shape[1]):
            found[v, s] = end_jump(P[v, s - 1], P[v, s], em)
    return found


@compiled
def harmonise(arrays: RunArrays, guide: GuideArrays, tolerance: float, em: float) -> None:
    """Move the cubics of a :class:`.run_nodes.Run` until curvatures meet, along a :class:`.run_nodes.Guide`."""
    run, (samples, joints, corner, upright, arriving, leaving) = borrowed(CubicRun(*arrays)), borrowed(guide)
    r, P = len(run.P), run.P
    nodes = r if run.closed else r + 1
    set_kinds(run, corner, upright, arriving, leaving)
    align(run)
    # Nodes between cubics that are held have no unknowns: after the first try these are most.
    number, n = np.full(nodes, -1), 0
    for k in range(nodes):
        after, before = sides(run, k)
        if after >= 0 or before >= 0:
            number[k], n = n, n + 5
    N = len(samples)
    work = (
        np.zeros((n, n)), np.zeros(n), np.zeros(n, dtype=np.int64), np.empty(n, dtype=np.int64), np.empty(N),
        np.ones(N), np.zeros(N), np.empty((3, 2)), np.zeros((4, 2, 10)), np.empty((10, 11)),
    )  # fmt: skip
    A, g, begins, first, x, weight, e, c, J, own = borrowed(work)
    for k in range(n if not run.closed else n - 10):  # the last two nodes of a closed run go with the first
        begins[k] = max(0, 5 * (k // 5 - 2))
    for s in range(r):
        a, b = joints[run.places[s]], joints[run.places[s + 1]]
        for k in range(a, b + 1):
            x[k] = (k - a) / (b - a)
    for m in range(ROUNDS):
        A[:], g[:] = 0.0, 0.0
        for s in range(r):
            if run.held[s]:
                continue
            u, v = s, (s + 1) % nodes
            J[:] = 0.0
            set_moves(run, u, 0, s, J, 0, 0)
            set_moves(run, v, 1, s, J, 3, 5)
            a, b = joints[run.places[s]], joints[run.places[s + 1]] + 1
            Q = samples[a:b]
            worst = feet(P[s], Q, c, x[a:b], e[a:b])
            if m > 0 and worst > 0.0:
                reweight(weight[a:b], e[a:b], worst)
            own[:] = 0.0
            add_samples(P[s], c, Q, x[a:b], weight[a:b], J, tolerance, own)
            for q in range(10):
                at = number[u] + q if q < 5 else number[v] + q - 5
                g[at] += own[q, 10]
                for p in range(q + 1):
                    to = number[u] + p if p < 5 else number[v] + p - 5
                    A[max(at, to), min(at, to)] += own[q, p]
        for s in range(r if run.closed else r - 1):  # the joint between cubic s and the next
            add_joint(run, s, em, A, g, number, run.ease[s + 1] * min(1.0, 0.25 + 0.25 * m))
        damp(run, A, number, tolerance)
        for k in range(n):  # unknowns that move nothing, and pairs that have no equation
            first[k] = begins[k]
            while first[k] < k and A[k, first[k]] == 0.0:
                first[k] += 1
        solve(A, g, first, n)
        if not moved(run, g, number, tolerance):
            break
    keep_alive(work)


@compiled
def add_joint(run: CubicRun, s: int, em: float, A: FloatArray, g: FloatArray, number: IntArray, share: float) -> None:
    """The equation of the joint after cubic s: its two curvatures are to be the same, unless one has no handle."""
    r = len(run.P)
    q = (s + 1) % r
    if run.held[s] and run.held[q]:
        return
    before, behind = run.P[s], run.P[q]
    one, other = end_curvature(before, 1), end_curvature(behind, 0)
    most = max(max(abs(one), abs(other)), 2 * FLAT / em)
    if not abs(one) + abs(other) < np.inf:
        return
    # Unknowns of three nodes: where cubic s begins, the joint, and where the next cubic ends.
    nodes = len(number)
    i, k, j = s, (s + 1) % nodes, (s + 2) % nodes
    spread = np.zeros((8, 2, 15))  # of the points of both cubics
    if not run.held[s]:
        set_moves(run, i, 0, s, spread, 0, 0)
        set_moves(run, k, 1, s, spread, 3, 5)
    if not run.held[q]:
        set_moves(run, k, 0, q, spread, 4, 5)
        set_moves(run, j, 1, q, spread, 7, 10)
    row = np.zeros(15)
    for side in range(2):
        # A runs along the handle, B to or from the other one; the curvature is 2/3 (A x B) / |A|³ but for the sign.
        if side == 0:
            ax, ay, bx, by = (
                before[3, 0] - before[2, 0],
                before[3, 1] - before[2, 1],
                before[2, 0] - before[1, 0],
                before[2, 1] - before[1, 1],
            )
            value, sign = one, -1.0
        else:
            ax, ay, bx, by = (
                behind[1, 0] - behind[0, 0],
                behind[1, 1] - behind[0, 1],
                behind[2, 0] - behind[1, 0],
                behind[2, 1] - behind[1, 1],
            )
            value, sign = other, 1.0
        size = length(ax, ay)
        f = 2 / 3 * sign / (size * size * size)
        for u in range(15):
            if side == 0:
                dax, day = spread[3, 0, u] - spread[2, 0, u], spread[3, 1, u] - spread[2, 1, u]
                dbx, dby = spread[2, 0, u] - spread[1, 0, u], spread[2, 1, u] - spread[1, 1, u]
            else:
                dax, day = spread[5, 0, u] - spread[4, 0, u], spread[5, 1, u] - spread[4, 1, u]
                dbx, dby = spread[6, 0, u] - spread[5, 0, u], spread[6, 1, u] - spread[5, 1, u]
            d = f * (dax * by - day * bx + ax * dby - ay * dbx) - 3 * value * (ax * dax + ay * day) / (size * size)
            row[u] += d / most if side else -d / most
    gap = (one - other) / most
    gap -= min(max(gap, -run.slack[s + 1]), run.slack[s + 1])
    w = share / (JUMP * JUMP)
    for u in range(15):
        if row[u] == 0.0:
            continue
        at = number[i if u < 5 else k if u < 10 else j] + u % 5
        g[at] += w * row[u] * gap
        for v in range(15):
            to = number[i if v < 5 else k if v < 10 else j] + v % 5
            if row[v] != 0.0 and to <= at:
                A[at, to] += w * row[u] * row[v]


@compiled
def damp(run: CubicRun, A: FloatArray, number: IntArray, tolerance: float) -> None:
    """Small steps where the equations leave a choice; unknowns that move nothing stay 0."""
    for k, at in enumerate(number):
        if at < 0:
            continue
        a, b = handles_at(run, k)
        size = max(min(a, b), tolerance)
        A[at, at] += 0.02 / square(0.2 * size)
        A[at + 1, at + 1] += 0.02 / square(tolerance)
        A[at + 2, at + 2] += 0.02 / square(0.03)
        for side, own in ((3, a), (4, b)):
            A[at + side, at + side] += 0.02 / square(0.2 * max(own, tolerance))
        if run.kind[k] == FIXED:
            for side in range(5):
                A[at + side, at + side] += 0.02 / square(0.2 * max(a, b, tolerance))
