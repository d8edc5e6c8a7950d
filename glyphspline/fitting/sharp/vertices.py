"""Where a spline's vertices are: on the outline as densely as it asks for, and then more or fewer of them."""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet, length
from .corners import Joints
from .feet import Samples, span_errors
from .spline_curve import FREE, HELD, SHORTEST_HANDLE, TIED, Curve, chord, copy_curve, set_handles
from .spline_equations import Fit, third_along

GROWTH = 1.35
"""How fast the wanted distance of vertices grows along the outline: by exp(1.35) < 4 from one to the next."""


@compiled
def samples_between(joints: Joints, i: int, j: int, closed: int) -> Samples:
    """The samples from joint i to joint j, with the integral of the density of vertices."""
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
            e = (r + 1) % n
            h[r] = min(h[r], h[e] + GROWTH * (step[r] + step[e]) / 2)
    D[0] = 0.0
    for r in range(n):
        D[r + 1] = D[r] + step[r] / h[r]
    directions, free = np.empty((len(joints.samples), 2, 2)), np.empty(2, dtype=np.int64)
    directions[:, 0], directions[:, 1] = joints.leaving[:, i], joints.arriving[:, j]
    for end, joint in ((0, i), (1, j)):
        free[end] = FREE if joints.corner[joint] else (TIED if joints.tied[joint] else HELD)
    stop = b + 1 - closed
    return Samples(joints.samples[:, a:stop].copy(), joints.places[a:stop], D, directions, free, joints.places[b])


@compiled
def place_vertices(fit: Fit, k: int) -> bool:
    """A curve of k spans with its vertices on the outline, as the density has them; False if it is too large."""
    curve, samples = fit.curve, fit.samples
    Q, D, p, closed = samples.Q, samples.D, curve.p, curve.size[1]
    if k > p.shape[1] - 1:
        return False
    curve.size[0] = k
    j = 0
    for i in range(k + 1 - closed):
        goal = D[len(D) - 1] * i / k
        while j + 2 < len(D) and D[j + 1] <= goal:
            j += 1
        after = (j + 1) % len(samples.places)
        share = min(max((goal - D[j]) / max(D[j + 1] - D[j], 1e-300), 0.0), 1.0)
        for v in range(len(Q)):
            for axis in range(2):
                p[v, i, axis] = Q[v, j, axis] + share * (Q[v, after, axis] - Q[v, j, axis])
    if closed:
        return True
    p[:, k] = Q[:, len(samples.places) - 1]
    tangents = samples.directions.copy()
    for end in range(2):
        i = end * (k - 1)
        whole = chord(p, i, i + 1)
        if whole > 0.0 and samples.free[end] != TIED:
            for v in range(len(Q)):
                own = length(p[v, i + 1, 0] - p[v, i, 0], p[v, i + 1, 1] - p[v, i, 1])
                tangents[v, end] *= max(own / whole, SHORTEST_HANDLE)
    set_handles(curve, tangents)
    return True


@compiled
def insert_vertices(fit: Fit, growth: float) -> bool:
    """Cut the worst spans in two, no two adjacent ones; False if the curve would be too large.

    Args:
        growth: power of a span's error with which vertices are added; with infinity all that miss the tolerance are.
    """
    curve, trial, near = fit.curve, fit.trial, fit.near
    k, closed = curve.size[0], curve.size[1]
    errors = span_errors(fit.rows, k)
    wanted = 0.0
    for s in range(k):
        if errors[s] > near:
            wanted += min((errors[s] / near) ** growth - 1, 1.0)
    count = min(max(int(np.rint(wanted)), 1), curve.p.shape[1] - 1 - k)
    if count <= 0:
        return False
    cut = np.zeros(k, dtype=np.bool_)
    for _ in range(count):
        worst = -1
        for s in range(k):
            beside = ((s > 0 or closed) and cut[s - 1]) or ((s + 1 < k or closed) and cut[(s + 1) % k])
            if not cut[s] and not beside and (worst < 0 or errors[s] > errors[worst]):
                worst = s
        if worst < 0:
            break
        cut[worst] = True
    copy_curve(curve, trial)
    at = 0
    for s in range(k):
        curve.p[:, at] = trial.p[:, s]
        at += 1
        if cut[s]:
            for v in range(len(curve.p)):
                curve.p[v, at, 0], curve.p[v, at, 1], _, _, _, _ = jet(trial.b[v], s, 0.5)
            at += 1
    resize(curve, trial, at)
    return True


@compiled
def resize(curve: Curve, old: Curve, k: int) -> None:
    """Give a curve whose vertices are set, but for the last of an arc, k spans; an arc's ends stay those of ``old``."""
    before = old.size[0]
    curve.size[0] = k
    if curve.size[1]:
        return
    curve.p[:, k] = old.p[:, before]
    curve.X[:, :2], curve.X[:, k + 1 : k + 3] = old.X[:, :2], old.X[:, before + 1 : before + 3]
    for v in range(len(curve.p)):
        p, X = curve.p[v], curve.X[v]
        for end, tip, i in ((0, 1, 0), (k + 2, k + 1, k - 1)):  # handles are at most half as long as their chord
            x, y = X[tip, 0] - X[end, 0], X[tip, 1] - X[end, 1]
            size, own = length(x, y), length(p[i + 1, 0] - p[i, 0], p[i + 1, 1] - p[i, 1])
            share = min(1.0, 0.5 * own / size) if size > 0 else 1.0
            X[tip, 0], X[tip, 1] = X[end, 0] + share * x, X[end, 1] + share * y


@compiled
def keep(fit: Fit) -> None:
    """Keep the curve, which passed, as the best so far, and estimate what it costs to take out each vertex.

    That is the jump of the third derivative at its knot, and the error.
    """
    curve, k, h = fit.curve, fit.curve.size[0], fit.curve.h
    copy_curve(curve, fit.best)
    errors = span_errors(fit.rows, k)
    for i in range(1 - curve.size[1], k):
        last = i - 1 if i > 0 else k - 1
        before, after = h[i + 1], h[i + 2]
        reach = before * after / (before + after)
        fit.costs[i] = 0.0
        for v in range(len(curve.b)):
            b = curve.b[v]
            _, _, dx, dy, _, _ = jet(b, i, 0.0)
            speed = max(length(dx, dy), 1e-12)
            nx, ny = -dy / speed, dx / speed
            jump = third_along(b, i, nx, ny) / after**3 - third_along(b, last, nx, ny) / before**3
            fit.costs[i] = max(fit.costs[i], abs(jump) * reach**3 / 6 + max(errors[last], errors[i]) / 4)
