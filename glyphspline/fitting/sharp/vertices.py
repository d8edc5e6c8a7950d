"""Where a spline's vertices are: on the outline as densely as it asks for, and then more or fewer of them."""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet, length
from ...types import FloatArray, IntArray
from .corners import JointArrays, Joints
from .feet import Samples
from .spline_curve import FREE, HELD, SHORTEST_HANDLE, TIED, chord, tips_of
from .spline_equations import third_along

GROWTH = 1.35
"""How fast the wanted distance of vertices grows along the outline: by exp(1.35) < 4 from one to the next."""


@compiled
def samples_between(around: JointArrays, i: int, j: int, closed: int) -> Samples:
    """The samples from joint i to joint j of :class:`.corners.Joints`, with the integral of the density of vertices."""
    joints = Joints(*around)
    a, b = joints.first[i], joints.first[j]
    D, h, step = np.empty(b - a + 1), joints.spacing[a:b].copy(), np.empty(b - a)
    for r in range(b - a):
        step[r] = chord(joints.samples, a + r, a + r + 1)
    # Wanted distances grow no faster than chords may; around a closed contour from the last to the first, too.
    n = len(h)
    for _ in range(2):
        for r in range(1 - closed, n):
            h[r] = min(h[r], h[r - 1] + GROWTH * (step[r] + step[r - 1]) / 2)
        for r in range(n - 2 + closed, -1, -1):
            e = r + 1 if r + 1 < n else 0
            h[r] = min(h[r], h[e] + GROWTH * (step[r] + step[e]) / 2)
    D[0] = 0.0
    for r in range(n):
        D[r + 1] = D[r] + step[r] / h[r]
    directions, free = np.empty((len(joints.samples), 2, 2)), np.empty(2, dtype=np.int64)
    for v in range(len(directions)):
        for axis in range(2):
            directions[v, 0, axis], directions[v, 1, axis] = joints.leaving[v, i, axis], joints.arriving[v, j, axis]
    for end, joint in ((0, i), (1, j)):
        free[end] = FREE if joints.corner[joint] else (TIED if joints.tied[joint] else HELD)
    stop = b + 1 - closed
    return Samples(joints.samples[:, a:stop].copy(), joints.places[a:stop], D, directions, free, joints.places[b])


@compiled
def place_vertices(
    outline: tuple[FloatArray, FloatArray, IntArray], D: FloatArray, k: int, closed: int
) -> tuple[FloatArray, FloatArray]:
    """Vertices (K, n, 2) of k spans on the outline, as the density has them, and tips (K, 2, 2) of an arc's handles.

    Args:
        outline: ``Q``, ``directions`` and ``free`` of :class:`.feet.Samples`.
    """
    Q, directions, free = outline
    masters, n = Q.shape[0], Q.shape[1]
    p, j = np.empty((masters, k + 1 - closed, 2)), 0
    for i in range(k + 1 - closed):
        goal = D[len(D) - 1] * i / k
        while j + 2 < len(D) and D[j + 1] <= goal:
            j += 1
        after = (j + 1) % n
        share = min(max((goal - D[j]) / max(D[j + 1] - D[j], 1e-300), 0.0), 1.0)
        for v in range(masters):
            for axis in range(2):
                p[v, i, axis] = Q[v, j, axis] + share * (Q[v, after, axis] - Q[v, j, axis])
    if closed:
        return p, np.zeros((masters, 2, 2))
    for v in range(masters):
        p[v, k, 0], p[v, k, 1] = Q[v, n - 1, 0], Q[v, n - 1, 1]
    tangents = directions.copy()
    for end in range(2):
        i = end * (k - 1)
        whole = chord(p, i, i + 1)
        if whole > 0.0 and free[end] != TIED:
            for v in range(masters):
                own = length(p[v, i + 1, 0] - p[v, i, 0], p[v, i + 1, 1] - p[v, i, 1])
                for axis in range(2):
                    tangents[v, end, axis] *= max(own / whole, SHORTEST_HANDLE)
    return p, tips_of(p, tangents)


@compiled
def insert_vertices(
    vertices: tuple[FloatArray, FloatArray], beziers: FloatArray, errors: FloatArray, near: float, growth: float,
    most: int,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """Vertices and tips with the worst spans cut in two, no two adjacent ones.

    Args:
        vertices: of a curve, and tips; they and the others are as :func:`.vertex_steps.move_vertices` returns them.
        growth: power of a span's error with which vertices are added; with infinity all that miss the tolerance are.
        most: spans then, at most.

    """
    p, tips = vertices
    masters, slots, k = p.shape[0], p.shape[1], len(errors)
    closed = k + 1 - slots
    wanted = 0.0
    for s in range(k):
        if errors[s] > near:
            wanted += min((errors[s] / near) ** growth - 1, 1.0)
    count = min(max(int(np.rint(wanted)), 1), most - k)
    cut = np.zeros(k, dtype=np.bool_)
    added = 0
    for _ in range(count):
        worst = -1
        for s in range(k):
            beside = ((s > 0 or closed) and cut[s - 1]) or ((s + 1 < k or closed) and cut[(s + 1) % k])
            if not cut[s] and not beside and (worst < 0 or errors[s] > errors[worst]):
                worst = s
        if worst < 0:
            break
        cut[worst] = True
        added += 1
    more, at = np.empty((masters, slots + added, 2)), 0
    for s in range(slots):
        for v in range(masters):
            more[v, at, 0], more[v, at, 1] = p[v, s, 0], p[v, s, 1]
        at += 1
        if s < k and cut[s]:
            for v in range(masters):
                more[v, at, 0], more[v, at, 1], _, _, _, _ = jet(beziers[v], s, 0.5)
            at += 1
    return more, tips if closed else shortened(p, tips, more)


@compiled
def without(vertices: tuple[FloatArray, FloatArray], i: int, closed: int) -> tuple[FloatArray, FloatArray]:
    """Vertices and tips without vertex i."""
    p, tips = vertices
    masters, n = p.shape[0], p.shape[1] - 1
    fewer = np.empty((masters, n, 2))
    for v in range(masters):
        for j in range(n):
            for axis in range(2):
                fewer[v, j, axis] = p[v, j if j < i else j + 1, axis]
    return fewer, tips if closed else shortened(p, tips, fewer)


@compiled
def shortened(old: FloatArray, tips: FloatArray, p: FloatArray) -> FloatArray:
    """The tips of an arc's handles for other vertices between its ends: at most half as long as their chord."""
    found = np.empty((len(p), 2, 2))
    for v in range(len(p)):
        for end, at, beside in ((0, 0, 1), (1, p.shape[1] - 1, p.shape[1] - 2)):
            before = end * (old.shape[1] - 1)
            x, y = tips[v, end, 0] - old[v, before, 0], tips[v, end, 1] - old[v, before, 1]
            size, own = length(x, y), length(p[v, beside, 0] - p[v, at, 0], p[v, beside, 1] - p[v, at, 1])
            share = min(1.0, 0.5 * own / size) if size > 0 else 1.0
            found[v, end, 0], found[v, end, 1] = old[v, before, 0] + share * x, old[v, before, 1] + share * y
    return found


@compiled
def cheap_removals(beziers: FloatArray, h: FloatArray, errors: FloatArray, closed: int, dear: float) -> IntArray:
    """The vertices of a curve that passed, but an arc's ends, whose removal is estimated to cost up to ``dear``, the
    cheapest first.

    The estimate is the jump of the third derivative at the knot, and the error.
    """
    k, count = len(errors), 0
    costs, found = np.empty(k), np.empty(k, dtype=np.int64)
    for i in range(1 - closed, k):
        last, cost = i - 1 if i > 0 else k - 1, 0.0
        before, after = h[i + 1], h[i + 2]
        reach = before * after / (before + after)
        for v in range(len(beziers)):
            b = beziers[v]
            _, _, dx, dy, _, _ = jet(b, i, 0.0)
            speed = max(length(dx, dy), 1e-12)
            nx, ny = -dy / speed, dx / speed
            jump = third_along(b, i, nx, ny) / (after * after * after)
            jump -= third_along(b, last, nx, ny) / (before * before * before)
            cost = max(cost, abs(jump) * (reach * reach * reach) / 6 + max(errors[last], errors[i]) / 4)
        if not cost <= dear:
            continue
        at = count
        while at > 0 and costs[at - 1] > cost:
            costs[at], found[at] = costs[at - 1], found[at - 1]
            at -= 1
        costs[at], found[at] = cost, i
        count += 1
    return found[:count]
