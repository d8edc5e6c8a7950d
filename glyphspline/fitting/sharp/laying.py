"""Closed curves that go round corners: their vertices are laid on the outline, and stay there.

Interpolated with vertices dense enough, any outline is within the tolerance, round corners too, from which moved
vertices run away.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...types import FloatArray
from .feet import Rows, Samples, measure, span_errors
from .spline_curve import Curve, chord, interpolate_cold
from .stretches import integrate_density
from .trial import Trial, keep, put_on_outline


@compiled
def lay_on_outline(trial: Trial) -> int:
    """Lay the vertices of a closed curve on the outline, more and more, until it passes.

    Returns:
        The number of vertices; 0 if no curve passes.
    """
    fit, search = trial.fit, trial.search
    laid, respaced = 0, 0
    while lay_vertices(trial, laid):
        laid = fit.curve.size[0]
        if not interpolate_cold(fit.curve, search.margin, search.residual) < search.residual:
            return 0
        error = measure_laid(trial, fit.curve)
        if error <= trial.near:
            keep(trial)
            return laid
        if error == np.inf:
            return 0
        if respaced < search.respacings:
            respace(trial, laid)
            laid, respaced = 0, respaced + 1
    return 0


@compiled
def lay_vertices(trial: Trial, laid: int) -> bool:
    """A closed curve with its vertices on the outline: more of them in spans that miss the tolerance, and where
    adjacent chords differ too much; False if there is no room.

    Args:
        laid: how many there are now, with their errors in the fit's rows; 0 for the first guess.
    """
    samples, goals, near, far = trial.samples, trial.goals, trial.near, trial.search.far
    curve, D, k = trial.fit.curve, samples.D, laid
    total = D[len(D) - 1]
    cut = np.zeros(len(goals), dtype=np.bool_)
    if laid == 0:
        k = max(int(np.ceil(total)), 6)
        if k > len(goals) - 1:
            return False
        for i in range(k):
            goals[i] = total * i / k
    else:
        errors = span_errors(trial.fit.rows, k)
        for s in range(k):
            beside = max(errors[s - 1], errors[(s + 1) % k])
            cut[s] = errors[s] > near and (errors[s] >= beside or errors[s] > 2 * far * near)
    while True:
        count = k
        for s in range(k):
            count += cut[s]
        if count > len(goals) - 1:
            return False
        at = count - 1
        for s in range(k - 1, -1, -1):
            if cut[s]:
                goals[at] = (goals[s] + (goals[s + 1] if s + 1 < k else total + goals[0])) / 2
                at -= 1
            goals[at] = goals[s]
            at -= 1
        k = count
        curve.size[0] = k
        put_on_outline(samples, goals[:k], curve.p)
        steep = False
        for s in range(k):
            last, after = s - 1 if s > 0 else k - 1, s + 1 if s + 1 < k else 0
            own = chord(curve.p, s, after)
            beside = min(chord(curve.p, last, s), chord(curve.p, after, after + 1 if after + 1 < k else 0))
            cut[s] = own > trial.search.steep * beside
            steep = steep or cut[s]
        if not steep:
            return True


@compiled
def respace(trial: Trial, laid: int) -> None:
    """Make the wanted density higher where laid vertices are too far apart, and lower where they are too close."""
    samples, goals, k, aim = trial.samples, trial.goals, laid, trial.search.aim * trial.near
    D, Q, n = samples.D, samples.Q, len(samples.places)
    errors, h, step = span_errors(trial.fit.rows, k), np.empty(n), np.empty(n)
    s = 0
    for j in range(n):
        while s + 1 < k and D[j] >= goals[s + 1]:
            s += 1
        change = min(max((errors[s] / aim) ** trial.search.power, 0.75), 2.0)
        step[j] = chord(Q, j, (j + 1) % n)
        h[j] = step[j] / max((D[j + 1] - D[j]) * change, 1e-300) if step[j] > 0.0 else np.inf
    integrate_density(D, h, step, 1)


@compiled
def measure_laid(trial: Trial, curve: Curve) -> float:
    """The largest distance of a sample from a closed curve whose vertices are laid."""
    rows = trial.fit.rows
    guess_feet(trial.samples, trial.goals[: curve.size[0]], rows)
    return measure(trial.samples, curve, trial.near, rows, rows)


@compiled
def guess_feet(samples: Samples, goals: FloatArray, rows: Rows) -> None:
    """First guesses for the feet on a closed curve whose vertices are laid: the samples' places between these."""
    D, k, n = samples.D, len(goals), len(samples.places)
    s = 0
    for j in range(n):
        while s + 1 < k and D[j] >= goals[s + 1]:
            s += 1
        after = goals[s + 1] if s + 1 < k else D[len(D) - 1] + goals[0]
        x = min(max((D[j] - goals[s]) / max(after - goals[s], 1e-300), 0.0), 1.0)
        for v in range(len(rows.used)):
            rows.span[v, j], rows.x[v, j] = s, x
    rows.used[:] = n
