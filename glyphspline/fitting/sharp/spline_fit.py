"""Moving the vertices of a spline of variant 2 until it is near the samples of an outline.

After each step a few warm passes of variant 2 put the curve through the moved vertices again. What counts is a cold run
from the vertices alone, as the interpolation that is written makes it.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import length
from ...types import FloatArray
from .cubic_fit import solve
from .feet import Samples, copy_rows, measure, measure_afresh
from .spline_curve import Curve, copy_curve, hold_tied, inner_vertices, interpolate_cold, iterate, set_knots
from .spline_equations import (
    LARGEST_RATIO,
    Fit,
    add_all,
    agree_on_handles,
    differentiate,
    equations,
    knots_per_step,
    objective,
    place_of,
)  # fmt: skip

WARM_PASSES, WARM = 12, 0.02
"""Passes of variant 2 after a step, and the share of the tolerance below which its error is small enough."""

DAMPING = 1e-2
"""Damping of the first step, as a share of the mean of the diagonal."""

MOST_SLIDE = 0.3
"""A vertex moves along the curve by this share of its shorter chord at most."""

FAILURES = 4
"""Steps that fail in a row before a fit is given up."""

SHORTEST_HANDLE, LONGEST_HANDLE = 1 / 8, 4 / 3
"""Lengths between which the end handles of an arc are kept, in chords of their end: shorter ones end in a spike of
curvature."""


@compiled
def improve(
    fit: Fit, samples: Samples, near: float, margin: float, residual: float, rounds: int, start: int, width: int,
    wobble: float,
) -> float:  # fmt: skip
    """Move some slots of ``fit.curve`` until all rows are within ``near`` of the outline on a cold run of variant 2.

    Args:
        near: the tolerance. margin, residual: of the interpolation. rounds: most steps.
        start, width: the slots that move. wobble: weight of :func:`.spline_equations.third_derivatives`.

    Returns:
        The largest distance of a cold run that passed, of which ``fit.curve`` and ``fit.rows`` are then; else the least
        one seen, of a warm run.
    """
    curve, trial, rows, tried = fit.curve, fit.trial, fit.rows, fit.tried
    error = measure_afresh(samples, curve, near, rows)
    damping, failures = DAMPING, 0
    for n in range(rounds + 1):
        if error <= near and is_graded(curve):
            copy_curve(curve, trial)
            if interpolate_cold(trial, margin, residual) < residual:
                copy_curve(trial, curve)
                error = measure_afresh(samples, curve, near, rows)
                if error <= near:
                    return error
        if n == rounds:
            break
        minimax = n >= 2
        differentiate(fit)
        add_all(fit, error, minimax, wobble)
        old = objective(curve, rows, error, minimax, wobble)
        while True:
            agreed = tied = True
            while agreed:
                for v in range(len(fit.step)):
                    equations(fit, samples, v, damping, start, width)
                    solve(fit.A, fit.step[v], fit.first, 2 * width)
                agreed = tied and agree_on_handles(fit, samples, start, width)
                tied = False
            fit.longer[:] = np.nan
            better = False
            if _advance(fit, samples, 0.5 if minimax else 1.0, start, width):
                iterate(trial, WARM * near, WARM_PASSES)
                new = measure(samples, trial, near, rows, tried)
                better = objective(trial, tried, error, minimax, wobble) < old
            if better:
                break
            failures += 1
            damping *= 10
            if failures >= FAILURES:
                return max(error, np.nextafter(near, np.inf))
        failures, damping = 0, damping / 4
        copy_curve(trial, curve)
        copy_rows(tried, rows)
        error = new
    return max(error, np.nextafter(near, np.inf))


@compiled
def is_graded(curve: Curve) -> bool:
    """Whether all adjacent chords are within the largest ratio of each other."""
    first, stop = inner_vertices(curve)
    good = True
    for s in range(first, stop):
        a, b = curve.h[s + 1], curve.h[s + 2]
        good = good and a <= LARGEST_RATIO * b and b <= LARGEST_RATIO * a
    return good


@compiled
def _advance(fit: Fit, samples: Samples, share: float, start: int, width: int) -> bool:
    """The trial: the curve with vertices, knots and control points moved by a share of the step.

    A vertex moves across the curve as the curve does at its footpoint. False if chords vanish.
    """
    curve, trial = fit.curve, fit.trial
    copy_curve(curve, trial)
    k, closed, h = curve.size[0], curve.size[1], curve.h
    first, stop = inner_vertices(curve)
    for v in range(len(fit.step)):
        X, p, step, frames = trial.X[v], trial.p[v], fit.step[v], fit.frames[v]
        for place in range(width):
            i = (start + place) % k if closed else start + place
            nu, sigma = share * step[2 * place], share * step[2 * place + 1]
            if first <= i < stop:
                most = MOST_SLIDE * min(h[i + 1], h[i + 2]) / knots_per_step(curve, v, i)
                sigma = min(max(sigma, -most), most)
            step[2 * place], step[2 * place + 1] = nu, sigma
            for axis in range(2):
                X[i + 1, axis] += nu * frames[i, axis] + sigma * frames[i, 2 + axis]
        for i in range(first, stop):
            place = place_of(i, start, width, k, closed)
            across, along = _change_across(fit, v, i, start, width), step[2 * place + 1] if place >= 0 else 0.0
            for axis in range(2):
                p[i, axis] += across * frames[i, axis] + along * frames[i, 2 + axis]
    if not set_knots(trial):
        return False
    for v in range(0 if closed else len(fit.step)):
        p = trial.p[v]
        for end, tip, i in ((0, 1, 0), (k + 2, k + 1, k - 1)):
            own = length(p[i + 1, 0] - p[i, 0], p[i + 1, 1] - p[i, 1])
            if own > 0.0:
                _limit_handle(curve.X[v], trial.X[v], end, tip, own)
    hold_tied(trial, samples.directions, samples.free)
    return True


@compiled
def _change_across(fit: Fit, v: int, i: int, start: int, width: int) -> float:
    """How far a step moves the curve across itself at the footpoint of vertex i in master v."""
    curve, moves, step, frames = fit.curve, fit.moves[v], fit.step[v], fit.frames[v]
    k, closed = curve.size[0], curve.size[1]
    s, x = (i, curve.t[i]) if curve.t[i] >= 0 else ((i - 1) % k, curve.t[i] + 1)
    y = 1 - x
    nx, ny = frames[i, 0], frames[i, 1]
    across = 0.0
    for c in range(4):
        place = place_of(s - 1 + c, start, width, k, closed)
        for u in range(2 if place >= 0 else 0):
            m, column = moves[s], 2 * c + u
            for axis, normal in ((0, nx), (1, ny)):
                d = y * y * (y * m[axis, column] + 3 * x * m[2 + axis, column])
                d += x * x * (3 * y * m[4 + axis, column] + x * m[6 + axis, column])
                across += step[2 * place + u] * d * normal
    return across


@compiled
def _limit_handle(old: FloatArray, X: FloatArray, end: int, tip: int, chord: float) -> None:
    """Keep an end handle on its old side, and its length within bounds beside its chord."""
    ax, ay = old[tip, 0] - old[end, 0], old[tip, 1] - old[end, 1]
    bx, by = X[tip, 0] - X[end, 0], X[tip, 1] - X[end, 1]
    size, new = length(ax, ay), length(bx, by)
    if ax * bx + ay * by <= 0.1 * size * new:
        bx, by, new, size = ax, ay, size, size / 2
    else:
        size = new
    size = min(max(size, SHORTEST_HANDLE * chord), LONGEST_HANDLE * chord)
    X[tip, 0], X[tip, 1] = X[end, 0] + bx / new * size, X[end, 1] + by / new * size
