"""Chains of quadratics that follow samples of an outline: their control points move, by least squares."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ....compiled import compiled
from ....curves.cubics import length
from ....fitting.sharp.cubics import solve
from ....intrinsics import borrowed, keep_alive
from ....types import BoolArray, FloatArray, IntArray
from .nearness import add_samples, reweight, shared_feet

ROUNDS = 5
"""Gauss-Newton steps."""

DAMPING = 0.03
"""Weight of control points' motion, as far as samples leave a choice: along the curve they would lose their order."""

SLIP = 0.01
"""Weight of a distance along the curve against one across it, in several masters: instances mix what is at the same
parameter in these."""


SLACK, LEAST, OWN, REACH = range(4)
"""Rows of ``Quads.turns``: the largest turn that is no new kink; the smallest in any mix; the largest that the source
has, and how long a leg beside it may be."""


class Quads(NamedTuple):
    """The R quadratics of a run or section, in K masters.

    Attributes:
        c: (K, R, 2) control points. node: (K, R + 1, 2) where they meet. implied: (R + 1,) midway between control
            points.
        T: (K, R + 1, 2) unit tangents at nodes. tied: (R, 2) whether a control point is on that of its start, or end.
        beyond: (K, R + 1, 2) where tied, what is beyond the node. turns: (4, R + 1) from it.
        fixed: (R,) control points that do not move. held: (R,) quadratics of the source.
        owner: (R,) their sections. lo: (R + 1,) samples at which they meet.
    """

    c: FloatArray
    node: FloatArray
    implied: BoolArray
    T: FloatArray
    beyond: FloatArray
    turns: FloatArray
    tied: BoolArray
    fixed: BoolArray
    held: BoolArray
    owner: IntArray
    lo: IntArray


@compiled
def empty_quads(masters: int, count: int) -> Quads:
    """Quadratics whose points are not set yet, all nodes implied."""
    nodes = count + 1
    return Quads(
        np.zeros((masters, count, 2)), np.zeros((masters, nodes, 2)), np.ones(nodes, np.bool_),
        np.zeros((masters, nodes, 2)), np.zeros((masters, nodes, 2)), np.zeros((4, nodes)),
        np.zeros((count, 2), np.bool_), np.zeros(count, np.bool_), np.zeros(count, np.bool_), np.zeros(count, np.int64),
        np.zeros(nodes, np.int64),
    )  # fmt: skip


def joined(sections: Sequence[Quads]) -> Quads:
    """Sections end to end, copied. Of the node between two the later one counts."""
    before, last = sections[:-1], sections[-1]
    return Quads(
        np.concatenate([one.c for one in sections], axis=1),
        np.concatenate([*(one.node[:, :-1] for one in before), last.node], axis=1),
        np.concatenate([*(one.implied[:-1] for one in before), last.implied]),
        np.concatenate([*(one.T[:, :-1] for one in before), last.T], axis=1),
        np.concatenate([*(one.beyond[:, :-1] for one in before), last.beyond], axis=1),
        np.concatenate([*(one.turns[:, :-1] for one in before), last.turns], axis=1),
        np.concatenate([one.tied for one in sections]),
        np.concatenate([one.fixed for one in sections]),
        np.concatenate([one.held for one in sections]),
        np.arange(len(sections)).repeat([len(one.fixed) for one in sections]),
        np.concatenate([*(one.lo[:-1] for one in before), last.lo]),
    )


@compiled
def set_nodes(q: Quads) -> None:
    """Put the implied nodes where control points have them."""
    for v in range(len(q.c)):
        for s in range(1, q.c.shape[1]):
            if q.implied[s]:
                for axis in range(2):
                    q.node[v, s, axis] = (q.c[v, s - 1, axis] + q.c[v, s, axis]) / 2


@compiled
def as_cubics(q: Quads, s: int, out: FloatArray) -> None:
    """Quadratic s as a cubic (K, 4, 2)."""
    for v in range(len(q.c)):
        for axis in range(2):
            a, b, c = q.node[v, s, axis], q.c[v, s, axis], q.node[v, s + 1, axis]
            out[v, 0, axis], out[v, 3, axis] = a, c
            out[v, 1, axis], out[v, 2, axis] = a + (b - a) * (2 / 3), c + (b - c) * (2 / 3)


@compiled
def set_moves(q: Quads, s: int, J: FloatArray) -> None:
    """How the control points before, of and behind quadratic s move the points of its cubic: J (4, 2, 6)."""
    a, b = 0.5 if q.implied[s] else 0.0, 0.5 if q.implied[s + 1] else 0.0
    J[:] = 0.0
    for axis in range(2):
        one, two, three = axis, 2 + axis, 4 + axis
        J[0, axis, one], J[0, axis, two] = a, a
        J[1, axis, one], J[1, axis, two] = a / 3, (a + 2) / 3
        J[2, axis, two], J[2, axis, three] = (b + 2) / 3, b / 3
        J[3, axis, two], J[3, axis, three] = b, b


@compiled
def relax(q: Quads, samples: FloatArray, enough: float, hopeless: float) -> float:
    """Move the control points nearest to the samples (K, N, 2), by least squares; the largest distance left.

    Args:
        enough: the distance that ends this. hopeless: that from which two steps end it.
    """
    K, R, N = len(q.c), q.c.shape[1], samples.shape[1]
    n = 2 * R
    work = (
        np.zeros((K, n, n)), np.zeros((K, n)), np.zeros(n, dtype=np.int64), np.empty(N), np.zeros(N), np.ones(N),
        np.empty((K, 3, 2)), np.empty((K, 4, 2)), np.empty((4, 2, 6)), np.empty((6, 7)),
    )  # fmt: skip
    A, g, first, x, e, weight, c, p, J, own = borrowed(work)
    set_nodes(q)
    for k in range(n):
        first[k] = max(0, 2 * (k // 2 - 2))
    for s in range(R):
        for k in range(q.lo[s], q.lo[s + 1] + 1):
            x[k] = (k - q.lo[s]) / max(q.lo[s + 1] - q.lo[s], 1)
    m, rounds = 0, ROUNDS if K == 1 else 2 * ROUNDS
    while True:
        A[:], g[:], worst = 0.0, 0.0, 0.0
        for s in range(R):
            a, b = q.lo[s], q.lo[s + 1] + 1
            as_cubics(q, s, p)
            far = shared_feet(p, samples[:, a:b], c, x[a:b], e[a:b])
            worst = max(worst, far)
            if q.held[s] or m == rounds:
                continue
            if m > 0 and far > 0.0:
                reweight(weight[a:b], e[a:b], far)
            set_moves(q, s, J)
            for w in range(K):
                own[:] = 0.0
                add_samples(p[w], c[w], samples[w, a:b], x[a:b], weight[a:b], J, 1.0, own, SLIP if K > 1 else 0.0)
                for u in range(6):
                    at = 2 * s - 2 + u
                    if 0 <= at < n:
                        g[w, at] += own[u, 6]
                        for v in range(max(0, 2 - 2 * s), u + 1):
                            A[w, at, at - u + v] += own[u, v]
        if m == rounds or worst <= enough or (m == 2 and worst > hopeless):
            break
        for w in range(K):
            improve(q, w, A[w], g[w], first)
        set_nodes(q)
        for s in range(1, R):
            if not (q.held[s - 1] or q.held[s]):
                share_samples(q, s, samples, x)
        m += 1
    keep_alive(work)
    return worst


@compiled
def improve(q: Quads, w: int, A: FloatArray, g: FloatArray, first: IntArray) -> None:
    """Move the control points of master w as the equations A, g say, as far as they keep their order."""
    R, c, node, T = q.c.shape[1], q.c[w], q.node[w], q.T[w]
    for s in range(R):
        # Motion across a tangent is dear; all motion costs a little.
        for axis in range(2):
            A[2 * s + axis, 2 * s + axis] += 1e6 if q.fixed[s] else DAMPING
        for end in range(2):
            if q.tied[s, end]:
                tx, ty = T[s + end]
                A[2 * s, 2 * s] += 1e6 * ty * ty
                A[2 * s + 1, 2 * s] -= 1e6 * tx * ty
                A[2 * s + 1, 2 * s + 1] += 1e6 * tx * tx
    solve(A, g, first, 2 * R)
    for s in range(R):
        if q.tied[s, 0] and q.tied[s, 1]:
            continue
        dx, dy = g[2 * s], g[2 * s + 1]
        leg = 0.5 * length(node[s + 1, 0] - node[s, 0], node[s + 1, 1] - node[s, 1])
        share = min(1.0, leg / max(length(dx, dy), 1e-12))
        push(q, w, s, share * dx, share * dy)
    for s in range(R + 1):
        if q.implied[s]:
            lack = (1.0 - ahead(c, T, s)) / 2
            if lack > 0.0:
                push(q, w, s - 1, -lack * T[s, 0], -lack * T[s, 1])
                push(q, w, s, lack * T[s, 0], lack * T[s, 1])
            continue
        for u, sign in ((s - 1, -1.0), (s, 1.0)):
            if 0 <= u < R:
                dx, dy = c[u, 0] - node[s, 0], c[u, 1] - node[s, 1]
                lack = 1.0 - sign * (dx * T[s, 0] + dy * T[s, 1])
                if lack > 0.0:
                    push(q, w, u, sign * lack * T[s, 0], sign * lack * T[s, 1])


@compiled
def push(q: Quads, w: int, s: int, dx: float, dy: float) -> None:
    """Move a control point in master w by as much of a vector as it may."""
    if q.fixed[s]:
        return
    for end in range(2):
        if q.tied[s, end]:
            tx, ty = q.T[w, s + end]
            along = dx * tx + dy * ty
            dx, dy = along * tx, along * ty
    q.c[w, s, 0] += dx
    q.c[w, s, 1] += dy


@compiled
def ahead(c: FloatArray, T: FloatArray, s: int) -> float:
    """How far control point s is ahead of the one before it, along the tangent between them."""
    return (c[s, 0] - c[s - 1, 0]) * T[s, 0] + (c[s, 1] - c[s - 1, 1]) * T[s, 1]


@compiled
def share_samples(q: Quads, s: int, samples: FloatArray, x: FloatArray) -> None:
    """Let the quadratics before and behind node s meet at the sample nearest to it, and their feet be even again."""
    before, a, b = q.lo[s], q.lo[s - 1], q.lo[s + 1]
    for step in (-1, 1):
        while a + 2 <= q.lo[s] + step <= b - 2:
            k, o, near, other = q.lo[s], q.lo[s] + step, 0.0, 0.0
            for w in range(len(q.c)):
                near += length(samples[w, k, 0] - q.node[w, s, 0], samples[w, k, 1] - q.node[w, s, 1])
                other += length(samples[w, o, 0] - q.node[w, s, 0], samples[w, o, 1] - q.node[w, s, 1])
            if other >= near:
                break
            q.lo[s] = o
    if q.lo[s] != before:
        if not q.tied[s, 0]:
            set_tangents(q, s, samples)
        for k in range(a + 1, b):
            first, last = (a, q.lo[s]) if k < q.lo[s] else (q.lo[s], b)
            x[k] = (k - first) / (last - first)


@compiled
def set_tangents(q: Quads, s: int, samples: FloatArray) -> None:
    """Let node s have the tangents at its sample."""
    k = q.lo[s]
    for w in range(len(samples)):
        x, y = samples[w, k + 1, 0] - samples[w, k - 1, 0], samples[w, k + 1, 1] - samples[w, k - 1, 1]
        size = max(length(x, y), 1e-12)
        q.T[w, s, 0], q.T[w, s, 1] = x / size, y / size
