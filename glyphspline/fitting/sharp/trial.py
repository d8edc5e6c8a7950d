"""One search for a spline: all that it tries, and changes of the vertices of what it tries."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet, length
from ...types import BoolArray, FloatArray
from ..ladders import Search
from .feet import Samples, span_errors
from .spline_curve import TIED, Curve, chord, copy_curve, inner_vertices, set_handles
from .spline_equations import Fit, third_along
from .spline_fit import SHORTEST_HANDLE as SHORTEST


class Trial(NamedTuple):
    """One search for the spline of a stretch.

    Attributes:
        samples: of the stretch. near: how near all of them have to be.
        fit: scratch arrays: ``curve`` is what is tried now, ``best`` the curve with the fewest spans that passed.
        goals: (room,) integrals of the density up to vertices that are laid.
        costs, tried: (room,) of the vertices of ``best``: see :func:`removal_costs` and :func:`mark_tried`.
    """

    samples: Samples
    near: float
    search: Search
    fit: Fit
    goals: FloatArray
    costs: FloatArray
    tried: BoolArray


@compiled
def keep(trial: Trial) -> None:
    """Keep the curve, which passed, as the best so far."""
    copy_curve(trial.fit.curve, trial.fit.best)
    removal_costs(trial.fit, trial.costs)


@compiled
def begin_from(curve: Curve, k: int, p: FloatArray, tangents: FloatArray) -> None:
    """A curve of k spans with the given vertices and end tangents."""
    curve.size[0] = k
    for v in range(len(p)):
        for i in range(k + 1 - curve.size[1]):
            curve.p[v, i, 0], curve.p[v, i, 1] = p[v, i, 0], p[v, i, 1]
    set_handles(curve, tangents)


@compiled
def place_vertices(curve: Curve, samples: Samples, k: int) -> bool:
    """A curve of k spans with its vertices on the outline, as the density has them; False if there is no room."""
    Q, D, p, closed = samples.Q, samples.D, curve.p, curve.size[1]
    n = len(samples.places)
    if k > curve.p.shape[1] - 1:
        return False
    curve.size[0] = k
    goals = np.empty(k + 1 - closed)
    for i in range(len(goals)):
        goals[i] = D[len(D) - 1] * i / k
    put_on_outline(samples, goals, p)
    if closed:
        return True
    directions = samples.directions
    tangents = np.empty_like(directions)
    for v in range(len(Q)):
        p[v, k, 0], p[v, k, 1] = Q[v, n - 1, 0], Q[v, n - 1, 1]
    for end in range(2):
        i = end * (k - 1)
        whole = chord(p, i, i + 1)
        for v in range(len(Q)):
            own = length(p[v, i + 1, 0] - p[v, i, 0], p[v, i + 1, 1] - p[v, i, 1])
            share = max(own / whole, SHORTEST) if whole > 0.0 and samples.free[end] != TIED else 1.0
            for axis in range(2):
                tangents[v, end, axis] = share * directions[v, end, axis]
    set_handles(curve, tangents)
    return True


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
            p[v, i, 0] = Q[v, j, 0] + share * (Q[v, after, 0] - Q[v, j, 0])
            p[v, i, 1] = Q[v, j, 1] + share * (Q[v, after, 1] - Q[v, j, 1])


@compiled
def insert_vertices(fit: Fit, near: float, growth: float) -> bool:
    """Cut the worst spans in two, no two adjacent ones; False if there is no room for more.

    Args:
        growth: power of a span's error with which vertices are added; with infinity all that miss the tolerance are.
    """
    curve, trial = fit.curve, fit.trial
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
            beside = (s > 0 or closed) and cut[s - 1]
            if s + 1 < k or closed:
                beside = beside or cut[(s + 1) % k]
            if not cut[s] and not beside and (worst < 0 or errors[s] > errors[worst]):
                worst = s
        if worst < 0:
            break
        cut[worst] = True
    copy_curve(curve, trial)
    at = 0
    for v in range(len(curve.p)):
        p, at = curve.p[v], 0
        for s in range(k):
            p[at, 0], p[at, 1] = trial.p[v, s, 0], trial.p[v, s, 1]
            at += 1
            if cut[s]:
                p[at, 0], p[at, 1], _, _, _, _ = jet(trial.b[v], s, 0.5)
                at += 1
    _resize(curve, trial, at)
    return True


@compiled
def remove_vertex(curve: Curve, good: Curve, i: int) -> None:
    """The good curve without vertex i."""
    k, closed = good.size[0], good.size[1]
    for v in range(len(curve.p)):
        for j in range(k - closed):
            n = j if j < i else j + 1
            curve.p[v, j, 0], curve.p[v, j, 1] = good.p[v, n, 0], good.p[v, n, 1]
    _resize(curve, good, k - 1)


@compiled
def _resize(curve: Curve, old: Curve, k: int) -> None:
    """Give a curve whose vertices are set, but for the last of an arc, k spans; an arc's ends stay those of ``old``."""
    before = old.size[0]
    curve.size[0] = k
    if curve.size[1]:
        return
    for v in range(len(curve.p)):
        p, X = curve.p[v], curve.X[v]
        for axis in range(2):
            p[k, axis] = old.p[v, before, axis]
            X[0, axis], X[1, axis] = old.X[v, 0, axis], old.X[v, 1, axis]
            X[k + 1, axis], X[k + 2, axis] = old.X[v, before + 1, axis], old.X[v, before + 2, axis]
        # Handles stay within the bounds of the chords beside them.
        first = length(p[1, 0] - p[0, 0], p[1, 1] - p[0, 1])
        last = length(p[k, 0] - p[k - 1, 0], p[k, 1] - p[k - 1, 1])
        for end, tip, own in ((0, 1, first), (k + 2, k + 1, last)):
            x, y = X[tip, 0] - X[end, 0], X[tip, 1] - X[end, 1]
            size = length(x, y)
            share = min(1.0, 0.5 * own / size) if size > 0 else 1.0
            X[tip, 0], X[tip, 1] = X[end, 0] + share * x, X[end, 1] + share * y


@compiled
def removal_costs(fit: Fit, costs: FloatArray) -> None:
    """What taking out each vertex is estimated to cost: the jump of the third derivative at its knot, and the error."""
    curve = fit.curve
    k, h = curve.size[0], curve.h
    errors = span_errors(fit.rows, k)
    first, stop = inner_vertices(curve)
    for i in range(first, stop):
        last = i - 1 if i > 0 else k - 1
        before, after = h[i + 1], h[i + 2]
        reach = before * after / (before + after)
        costs[i] = 0.0
        for v in range(len(curve.b)):
            b = curve.b[v]
            _, _, dx, dy, _, _ = jet(b, i, 0.0)
            speed = max(length(dx, dy), 1e-12)
            nx, ny = -dy / speed, dx / speed
            jump = third_along(b, i, nx, ny) / after**3 - third_along(b, last, nx, ny) / before**3
            costs[i] = max(costs[i], abs(jump) * reach**3 / 6 + max(errors[last], errors[i]) / 4)


@compiled
def cheapest(curve: Curve, costs: FloatArray, tried: BoolArray, most: float) -> int:
    """The vertex that costs least of those not tried, ``most`` at most; -1 if there is none."""
    first, stop = inner_vertices(curve)
    found = -1
    for i in range(first, stop):
        if not tried[i] and costs[i] <= most and (found < 0 or costs[i] < costs[found]):
            found = i
    return found


@compiled
def mark_tried(tried: BoolArray, i: int, removed: bool, k: int) -> None:
    """Mark vertex i as tried, or forget it if it is no longer there: k are left."""
    if not removed:
        tried[i] = True
        return
    for j in range(i, k):
        tried[j] = tried[j + 1]


@compiled
def slots_beside(curve: Curve, at: int, reach: int) -> tuple[int, int]:
    """The first of the slots up to ``reach`` on either side of vertex ``at``, and how many there are."""
    k, closed = curve.size[0], curve.size[1]
    slots, width = k + 1 - closed, 2 * reach
    if width >= slots:
        return 0, slots
    return (at - reach) % k if closed else min(max(at - reach, 0), slots - width), width


@compiled
def mean_chord(curve: Curve) -> float:
    """The mean of the knot intervals."""
    total = 0.0
    for s in range(curve.size[0]):
        total += curve.h[s + 2]
    return total / curve.size[0]
