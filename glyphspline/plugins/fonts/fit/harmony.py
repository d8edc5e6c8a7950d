"""Curvatures that meet: all cubics of a run moved together.

A node of a run and the handles on both sides of it lie on one line. It moves as its :class:`Run` allows: along that
line, across it, turning it, and with longer or shorter handles. Gauss-Newton steps make two things small together: the
distances of the outline's samples, as for a single cubic (:mod:`.cubics`), and at every joint the difference of the two
curvatures as a share of the larger one.

Of two handle lengths a cubic and one condition a joint, one length a cubic and one more are left to follow the outline;
nodes that slide, as a designer's harmoniser has it, give one more each. Meeting derivatives of curvature (G3) would
leave nothing.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....compiled import compiled, inlined
from ....curves.cubics import length, square
from ....fitting.sharp.corners import Joints
from ....fitting.sharp.cubics import solve
from ....fitting.sharp.nearness import add_samples, feet, reweight
from ....intrinsics import borrowed, keep_alive
from ....types import BoolArray, FloatArray, IntArray

FIXED, HELD, AXIS, FREE = range(4)
"""What a node may do: nothing, while its handle is free, at a corner; nothing, while its handle keeps its direction;
slide along its tangent, which stays; move and turn."""

ROUNDS = 7
"""Gauss-Newton steps. More change lengths by less than the grid's step."""

JUMP = 0.04
"""Jump of curvature that costs as much as all samples of a cubic at the tolerance."""

FLAT = 1.0
"""Curvature, in 1/em, up to which both sides of a joint are straight."""

SHORTEST = 0.05
"""Length in chords from which handles are not made shorter."""


class Run(NamedTuple):
    """Cubics from one cut of a contour to the next.

    Attributes:
        P: (r, 4, 2) the cubics. held: (r,) those that do not move.
        kind: (r + 1,) what the nodes may do. T: (r + 1, 2) unit tangents of nodes that are not corners.
        places: (r + 1,) joints of the outline, counted from the first, at which the nodes were.
        extrema: (r,) most extrema inside each cubic: as many as the source's segments have there.
        ease: (r + 1,) weights of the nodes' equations of curvature. slack: (r + 1,) jumps of curvature that may stay.
        closed: whether the last node is the first again.
    """

    P: FloatArray
    held: BoolArray
    kind: IntArray
    T: FloatArray
    places: IntArray
    extrema: IntArray
    ease: FloatArray
    slack: FloatArray
    closed: bool


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
def set_moves(run: Run, i: int, end: int, s: int, J: FloatArray) -> None:
    """How node i moves the two points at one end of cubic s: J (2, 2, 5), the node and its handle, by its unknowns.

    These are: along the tangent, across it, its turn, and the lengths of the handles after and before the node. At a
    corner they are the coordinates of the two handles.
    """
    J[:] = 0.0
    kind, tx, ty = run.kind[i], run.T[i, 0], run.T[i, 1]
    own = 3 + end
    if kind == FIXED:
        J[1, 0, 2 * end], J[1, 1, 2 * end + 1] = 1.0, 1.0
        return
    sign = 1.0 - 2.0 * end
    J[1, 0, own], J[1, 1, own] = sign * tx, sign * ty
    if kind == HELD:
        return
    for k in range(2):
        J[k, 0, 0], J[k, 1, 0] = tx, ty
    if kind == FREE:
        for k in range(2):
            J[k, 0, 1], J[k, 1, 1] = -ty, tx
        p = run.P[s]
        hx, hy = p[1 + end, 0] - p[3 * end, 0], p[1 + end, 1] - p[3 * end, 1]
        size = sign * length(hx, hy)
        J[1, 0, 2], J[1, 1, 2] = -ty * size, tx * size


@compiled
def harmonise(run: Run, joints: Joints, i: int, tolerance: float, em: float) -> None:
    """Move the cubics of a run, whose first node is joint i of the outline, until curvatures meet."""
    r, P = len(run.P), run.P
    nodes = r if run.closed else r + 1
    align(run)
    # Nodes between cubics that are held have no unknowns: after the first try these are most.
    number, n = np.full(nodes, -1), 0
    for k in range(nodes):
        after, before = sides(run, k)
        if after >= 0 or before >= 0:
            number[k], n = n, n + 5
    N = len(joints.places)
    work = (
        np.zeros((n, n)), np.zeros(n), np.zeros(n, dtype=np.int64), np.empty(n, dtype=np.int64), np.empty(N),
        np.ones(N), np.zeros(N), np.empty((3, 2)), np.zeros((4, 2, 10)), np.zeros((2, 2, 5)), np.empty((10, 11)),
    )  # fmt: skip
    A, g, begins, first, x, weight, e, c, J, spread, own = borrowed(work)
    for k in range(n if not run.closed else n - 10):  # the last two nodes of a closed run go with the first
        begins[k] = max(0, 5 * (k // 5 - 2))
    for s in range(r):
        a, b = joints.first[i + run.places[s]], joints.first[i + run.places[s + 1]]
        for k in range(a, b + 1):
            x[k] = (k - a) / (b - a)
    for m in range(ROUNDS):
        A[:], g[:] = 0.0, 0.0
        for s in range(r):
            if run.held[s]:
                continue
            u, v = s, (s + 1) % nodes
            set_moves(run, u, 0, s, spread)
            J[:] = 0.0
            J[0, :, :5], J[1, :, :5] = spread[0], spread[1]
            set_moves(run, v, 1, s, spread)
            J[3, :, 5:], J[2, :, 5:] = spread[0], spread[1]
            a, b = joints.first[i + run.places[s]], joints.first[i + run.places[s + 1]] + 1
            Q = joints.samples[0, a:b]
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
def align(run: Run) -> None:
    """Put the handles of a run on the tangents of their nodes, at the length they have; but not at corners."""
    r = len(run.P)
    for s in range(r):
        if run.held[s]:
            continue
        p = run.P[s]
        for end in range(2):
            k = (s + end) % r if run.closed else s + end
            if run.kind[k] == FIXED:
                continue
            size = length(p[1 + end, 0] - p[3 * end, 0], p[1 + end, 1] - p[3 * end, 1])
            size = max(size, SHORTEST * length(p[3, 0] - p[0, 0], p[3, 1] - p[0, 1]))
            for axis in range(2):
                p[1 + end, axis] = p[3 * end, axis] + (1 - 2 * end) * size * run.T[k, axis]


@compiled
def add_joint(run: Run, s: int, em: float, A: FloatArray, g: FloatArray, number: IntArray, share: float) -> None:
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
    spread, D = np.zeros((6, 2, 15)), np.zeros((2, 2, 5))  # the last three points before, and the first three behind
    if not run.held[s]:
        set_moves(run, i, 0, s, D)
        spread[0, :, :5] = D[1]
        set_moves(run, k, 1, s, D)
        spread[1, :, 5:10], spread[2, :, 5:10] = D[1], D[0]
    if not run.held[q]:
        set_moves(run, k, 0, q, D)
        spread[3, :, 5:10], spread[4, :, 5:10] = D[0], D[1]
        set_moves(run, j, 1, q, D)
        spread[5, :, 10:] = D[1]
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
                dax, day = spread[2, 0, u] - spread[1, 0, u], spread[2, 1, u] - spread[1, 1, u]
                dbx, dby = spread[1, 0, u] - spread[0, 0, u], spread[1, 1, u] - spread[0, 1, u]
            else:
                dax, day = spread[4, 0, u] - spread[3, 0, u], spread[4, 1, u] - spread[3, 1, u]
                dbx, dby = spread[5, 0, u] - spread[4, 0, u], spread[5, 1, u] - spread[4, 1, u]
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
def damp(run: Run, A: FloatArray, number: IntArray, tolerance: float) -> None:
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


@inlined
def sides(run: Run, k: int) -> tuple[int, int]:
    """The cubics after and before a node that move; -1 where there is none."""
    r = len(run.P)
    after, before = k if k < r else -1, k - 1 if k > 0 else (r - 1 if run.closed else -1)
    return -1 if after < 0 or run.held[after] else after, -1 if before < 0 or run.held[before] else before


@inlined
def handles_at(run: Run, k: int) -> tuple[float, float]:
    """The lengths of the handles after and before a node; one at an end of the run counts for both."""
    r, P = len(run.P), run.P
    after, before = k if k < r else -1, k - 1 if k > 0 else (r - 1 if run.closed else -1)
    a = length(P[after, 1, 0] - P[after, 0, 0], P[after, 1, 1] - P[after, 0, 1]) if after >= 0 else 0.0
    b = length(P[before, 3, 0] - P[before, 2, 0], P[before, 3, 1] - P[before, 2, 1]) if before >= 0 else 0.0
    return (b, b) if after < 0 else (a, a) if before < 0 else (a, b)


@compiled
def moved(run: Run, g: FloatArray, number: IntArray, tolerance: float) -> bool:
    """Move all nodes by their unknowns; whether anything moved by more than a tenth of a step of the grid."""
    r, P = len(run.P), run.P
    most = 0.0
    for k, at in enumerate(number):
        if at < 0:
            continue
        (a, b), (after, before) = handles_at(run, k), sides(run, k)
        y = g[at : at + 5]
        kind = run.kind[k]
        if kind == FIXED:
            for end, s in ((0, after), (1, before)):
                if s < 0:
                    continue
                dx, dy, own = y[2 * end], y[2 * end + 1], b if end else a
                size = length(dx, dy)
                share = min(1.0, 0.4 * own / max(size, 1e-12))
                P[s, 1 + end, 0] += share * dx
                P[s, 1 + end, 1] += share * dy
                most = max(most, share * size)
            continue
        along = min(max(y[0], -0.3 * min(a, b)), 0.3 * min(a, b)) if kind >= AXIS else 0.0
        across = min(max(y[1], -tolerance), tolerance) if kind == FREE else 0.0
        turn = min(max(y[2], -0.06), 0.06) if kind == FREE else 0.0
        tx, ty = run.T[k, 0], run.T[k, 1]
        dx, dy = along * tx - across * ty, along * ty + across * tx
        if turn != 0.0:
            tx, ty = tx - turn * ty, ty + turn * tx
            size = length(tx, ty)
            tx, ty = tx / size, ty / size
            run.T[k, 0], run.T[k, 1] = tx, ty
        most = max(most, max(abs(along), abs(across)))
        for end, s in ((0, after), (1, before)):
            if s < 0:
                continue
            own = b if end else a
            new = own + min(max(y[3 + end], -0.4 * own), 0.4 * own)
            p = P[s]
            new = max(new, SHORTEST * length(p[3, 0] - p[0, 0], p[3, 1] - p[0, 1]))
            most = max(most, abs(new - own) + abs(turn) * own)
            for axis in range(2):
                p[3 * end, axis] += dy if axis else dx
                p[1 + end, axis] = p[3 * end, axis] + (1 - 2 * end) * new * (ty if axis else tx)
    if run.closed:
        run.T[r], run.kind[r] = run.T[0], run.kind[0]
    return most > 0.1
