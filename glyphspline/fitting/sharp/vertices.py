"""Where a spline's vertices are: on the outline as densely as it asks for, and then more or fewer of them.

Those of closed curves that go round corners are fixed on the outline. Interpolated with vertices dense enough, any
outline is within the tolerance, round corners too, from which moved vertices run away.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet, length
from ...types import FloatArray
from ..ladders import RESPACINGS
from .corners import Joints
from .feet import Samples, measure, span_errors
from .spline_curve import FREE, HELD, SHORTEST_HANDLE, TIED, Curve, chord, copy_curve, interpolate_cold, set_handles
from .spline_equations import Fit, third_along

GROWTH = 1.35
"""How fast the wanted distance of vertices grows along the outline: by exp(1.35) < 4 from one to the next."""

FAR = 2.0
"""Vertices of a closed curve are fixed on the outline once, moved, they leave it this many tolerances off."""

AIM, POWER = 0.85, 0.4
"""Share of the tolerance that spacing aims at, and the power of a span's error with which its vertices become denser: a
quarter is right where the outline is smooth, one beside a corner."""


@compiled
def samples_between(joints: Joints, i: int, j: int, closed: int) -> Samples:
    """The samples from joint i to joint j, with the integral of the density of vertices."""
    a, b = joints.first[i], joints.first[j]
    D, h, step = np.empty(b - a + 1), joints.spacing[a:b].copy(), np.empty(b - a)
    for r in range(b - a):
        step[r] = chord(joints.samples, a + r, a + r + 1)
    integrate_density(D, h, step, closed)
    directions, free = np.empty((len(joints.samples), 2, 2)), np.empty(2, dtype=np.int64)
    directions[:, 0], directions[:, 1] = joints.leaving[:, i], joints.arriving[:, j]
    for end, joint in ((0, i), (1, j)):
        free[end] = FREE if joints.corner[joint] else (TIED if joints.tied[joint] else HELD)
    stop = b + 1 - closed
    return Samples(joints.samples[:, a:stop].copy(), joints.places[a:stop], D, directions, free, joints.places[b])


@compiled
def integrate_density(D: FloatArray, h: FloatArray, step: FloatArray, closed: int) -> None:
    """The integral D: (n + 1,) of the density of vertices, from wanted distances h and steps: (n,).

    Wanted distances grow no faster than chords may; around a closed contour from the last to the first, too.
    """
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


@compiled
def put_on_outline(samples: Samples, goals: FloatArray, p: FloatArray) -> None:
    """Put vertices p on the outline where the density's integral reaches the goals, which increase."""
    Q, D, n = samples.Q, samples.D, len(samples.places)
    j = 0
    for i in range(len(goals)):
        while j + 2 < len(D) and D[j + 1] <= goals[i]:
            j += 1
        after = (j + 1) % n
        share = min(max((goals[i] - D[j]) / max(D[j + 1] - D[j], 1e-300), 0.0), 1.0)
        for v in range(len(Q)):
            for axis in range(2):
                p[v, i, axis] = Q[v, j, axis] + share * (Q[v, after, axis] - Q[v, j, axis])


@compiled
def place_vertices(fit: Fit, k: int) -> bool:
    """A curve of k spans with its vertices on the outline, as the density has them; False if it is too large."""
    curve, samples = fit.curve, fit.samples
    Q, D, p, closed = samples.Q, samples.D, curve.p, curve.size[1]
    if k > p.shape[1] - 1:
        return False
    curve.size[0] = k
    goals = np.empty(k + 1 - closed)
    for i in range(len(goals)):
        goals[i] = D[len(D) - 1] * i / k
    put_on_outline(samples, goals, p)
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


@compiled
def fix_on_outline(fit: Fit) -> int:
    """Fix the vertices of a closed curve on the outline, more and more, until it passes.

    Returns:
        The number of vertices; 0 if no curve passes.
    """
    fixed = respaced = 0
    while place_fixed(fit, fixed):
        fixed = fit.curve.size[0]
        if not interpolate_cold(fit.curve, fit.settings.margin, fit.settings.residual) < fit.settings.residual:
            return 0
        error = measure_fixed(fit, fit.curve)
        if error <= fit.near:
            keep(fit)
            return fixed
        if error == np.inf:
            return 0
        if respaced < RESPACINGS:
            respace(fit, fixed)
            fixed, respaced = 0, respaced + 1
    return 0


@compiled
def place_fixed(fit: Fit, fixed: int) -> bool:
    """A closed curve with its vertices on the outline: more of them in spans that miss the tolerance, and where
    adjacent chords differ too much; False if it would be too large.

    Args:
        fixed: how many there are now, with their errors in the fit's rows; 0 for the first guess.
    """
    samples, goals, near, curve = fit.samples, fit.goals, fit.near, fit.curve
    total, k = samples.D[-1], fixed
    cut = np.zeros(len(goals), dtype=np.bool_)
    if fixed == 0:
        k = max(int(np.ceil(total)), 6)
        if k > len(goals) - 1:
            return False
        for i in range(k):
            goals[i] = total * i / k
    else:
        errors = span_errors(fit.rows, k)
        for s in range(k):
            beside = max(errors[s - 1], errors[(s + 1) % k])
            cut[s] = errors[s] > near and (errors[s] >= beside or errors[s] > 2 * FAR * near)
    while True:
        count = k + cut[:k].sum()
        if count > len(goals) - 1:
            return False
        at = count - 1
        for s in range(k - 1, -1, -1):
            if cut[s]:
                goals[at] = (goals[s] + (goals[s + 1] if s + 1 < k else total + goals[0])) / 2
                at -= 1
            goals[at] = goals[s]
            at -= 1
        k = curve.size[0] = count
        put_on_outline(samples, goals[:k], curve.p)
        for s in range(k):
            last, after = s - 1 if s > 0 else k - 1, s + 1 if s + 1 < k else 0
            own = chord(curve.p, s, after)
            beside = min(chord(curve.p, last, s), chord(curve.p, after, after + 1 if after + 1 < k else 0))
            # Ratio of adjacent chords from which the longer one is cut where vertices are fixed.
            cut[s] = own > 3.0 * beside
        if not cut[:k].any():
            return True


@compiled
def respace(fit: Fit, fixed: int) -> None:
    """Make the wanted density higher where fixed vertices are too far apart, and lower where they are too close."""
    samples, goals, k = fit.samples, fit.goals, fixed
    D, Q, n = samples.D, samples.Q, len(samples.places)
    errors, h, step = span_errors(fit.rows, k), np.empty(n), np.empty(n)
    s = 0
    for j in range(n):
        while s + 1 < k and D[j] >= goals[s + 1]:
            s += 1
        change = min(max((errors[s] / (AIM * fit.near)) ** POWER, 0.75), 2.0)
        step[j] = chord(Q, j, (j + 1) % n)
        h[j] = step[j] / max((D[j + 1] - D[j]) * change, 1e-300) if step[j] > 0.0 else np.inf
    integrate_density(D, h, step, 1)


@compiled
def measure_fixed(fit: Fit, curve: Curve) -> float:
    """The largest distance of a sample from a closed curve whose vertices are fixed.

    First guesses for the feet are the samples' places between these.
    """
    samples, goals, rows, k = fit.samples, fit.goals, fit.rows, curve.size[0]
    D, s = samples.D, 0
    for j in range(len(samples.places)):
        while s + 1 < k and D[j] >= goals[s + 1]:
            s += 1
        after = goals[s + 1] if s + 1 < k else D[-1] + goals[0]
        rows.span[:, j] = s
        rows.x[:, j] = min(max((D[j] - goals[s]) / max(after - goals[s], 1e-300), 0.0), 1.0)
    rows.used[:] = len(samples.places)
    return measure(samples, curve, fit.near, rows, rows)
