"""Where a spline's vertices are: on the outline as densely as it asks for, and then more or fewer of them."""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import length
from ...types import FloatArray, IntArray
from .corners import JointArrays, Joints
from .feet import Samples
from .spline_curve import FREE, HELD, SHORTEST_HANDLE, TIED, chord, jet_of, numbers_for, set_tips, tried_in

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
def place_vertices(outline: tuple[FloatArray, FloatArray, IntArray], D: FloatArray, k: int, closed: int) -> FloatArray:
    """The numbers of a curve with vertices of k spans on the outline, as the density has them.

    Args:
        outline: ``Q``, ``directions`` and ``free`` of :class:`.feet.Samples`.
    """
    Q, directions, free = outline
    masters, n, j = Q.shape[0], Q.shape[1], 0
    numbers = numbers_for(masters, k, closed)
    p, tips, _, _, _ = tried_in(numbers, masters, k, closed)
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
        return numbers
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
    set_tips(p, tangents, tips)
    return numbers


@compiled
def insert_vertices(
    numbers: FloatArray, masters: int, k: int, closed: int, near: float, growth: float, most: int
) -> tuple[int, FloatArray]:
    """A curve with the worst spans cut in two, no two adjacent ones: its number of spans, and its numbers.

    Args:
        numbers: of a curve whose vertices have moved, of k spans in K masters, see :func:`.spline_curve.tried_in`.
        growth: power of a span's error with which vertices are added; with infinity all that miss the tolerance are.
        most: spans then, at most.
    """
    p, tips, powers, _, errors = tried_in(numbers, masters, k, closed)
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
    found, at = numbers_for(masters, k + added, closed), 0
    more, new_tips, _, _, _ = tried_in(found, masters, k + added, closed)
    for s in range(k + 1 - closed):
        for v in range(masters):
            more[v, at, 0], more[v, at, 1] = p[v, s, 0], p[v, s, 1]
        at += 1
        if s < k and cut[s]:
            for v in range(masters):
                more[v, at, 0], more[v, at, 1], _, _, _, _ = jet_of(powers[v], s, 0.5)
            at += 1
    set_shorter(p, tips, closed, more, new_tips)
    return k + added, found


@compiled
def without(numbers: FloatArray, masters: int, k: int, closed: int, i: int) -> FloatArray:
    """The numbers of a curve without vertex i."""
    p, tips, _, _, _ = tried_in(numbers, masters, k, closed)
    found = numbers_for(masters, k - 1, closed)
    fewer, new_tips, _, _, _ = tried_in(found, masters, k - 1, closed)
    for v in range(masters):
        for j in range(k - closed):
            for axis in range(2):
                fewer[v, j, axis] = p[v, j if j < i else j + 1, axis]
    set_shorter(p, tips, closed, fewer, new_tips)
    return found


@compiled
def set_shorter(old: FloatArray, tips: FloatArray, closed: int, p: FloatArray, found: FloatArray) -> None:
    """Write the tips of an arc's handles for other vertices between its ends: at most half as long as their chord."""
    for v in range(0 if closed else len(p)):
        for end, at, beside in ((0, 0, 1), (1, p.shape[1] - 1, p.shape[1] - 2)):
            before = end * (old.shape[1] - 1)
            x, y = tips[v, end, 0] - old[v, before, 0], tips[v, end, 1] - old[v, before, 1]
            size, own = length(x, y), length(p[v, beside, 0] - p[v, at, 0], p[v, beside, 1] - p[v, at, 1])
            share = min(1.0, 0.5 * own / size) if size > 0 else 1.0
            found[v, end, 0], found[v, end, 1] = old[v, before, 0] + share * x, old[v, before, 1] + share * y


@compiled
def cheap_removals(numbers: FloatArray, masters: int, k: int, closed: int, dear: float) -> IntArray:
    """The vertices of a curve that passed, but an arc's ends, whose removal is estimated to cost up to ``dear``, the
    cheapest first.

    The estimate is the jump of the third derivative at the knot, and the error.
    """
    (_, _, powers, h, errors), count = tried_in(numbers, masters, k, closed), 0
    costs, found = np.empty(k), np.empty(k, dtype=np.int64)
    for i in range(1 - closed, k):
        last, cost = i - 1 if i > 0 else k - 1, 0.0
        before, after = h[i + 1], h[i + 2]
        reach = before * after / (before + after)
        for v in range(masters):
            c = powers[v]
            dx, dy = c[i, 1, 0], c[i, 1, 1]
            speed = max(length(dx, dy), 1e-12)
            nx, ny = -dy / speed, dx / speed
            jump = 6 * (c[i, 3, 0] * nx + c[i, 3, 1] * ny) / (after * after * after)
            jump -= 6 * (c[last, 3, 0] * nx + c[last, 3, 1] * ny) / (before * before * before)
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
