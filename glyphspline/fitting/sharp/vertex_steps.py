"""Vertices of a spline that move to where they serve best: one kernel of steps of Gauss and Newton.

After each step a few warm passes, which are eager (:func:`.spline_curve.iterate`), bring the curve near the moved
vertices again. What counts is a cold run of variant 2 from the vertices alone, as the interpolation that is written
makes it.
"""

from __future__ import annotations

import numpy as np

from ...arrays import put
from ...compiled import compiled
from ...curves.cubics import length
from ...intrinsics import borrowed, keep_alive
from ...types import FloatArray, IntArray
from .cubics import limited
from .feet import empty_rows, measure, set_errors
from .spline_curve import (
    LONGEST_HANDLE,
    SHORTEST_HANDLE,
    Curve,
    copy_points,
    curve_of,
    hold_tied,
    interpolate_cold,
    iterate,
    set_knots,
    tried_in,
    wrapped,
)
from .spline_equations import add_rows, differentiate, knots_per_step, objective, solve_step, system_of

FAILURES = 4
"""Steps that fail in a row before a fit is given up."""

STRIDES = (2.6, 2.0, 1.3)
"""By how much the first step, the second and each later one lower the largest distance, at most: a fit that needs more
is given up. That ends 13 of some 580 fits that would pass, and saves a fifth of all steps."""

ENOUGH = 0.02
"""Distance of the vertices from the curve, in tolerances, that is enough for the next step."""

WOBBLE = 1e-2
"""Weight of a curve's wobble beside its distances: of the integral of (dκ/ds)², by the cube of the mean chord."""

OFF, SPANS_OFF = 1.3, 3
"""A fit is also given up if so many spans are off by this many tolerances after the first two steps: later ones shift
distances from span to span. It saves a seventh of all steps. Fits of masters get nearer later, and take all steps."""


@compiled
def move_vertices(
    numbers: FloatArray, k: int, closed: int, outline: tuple[FloatArray, FloatArray, IntArray],
    limits: tuple[float, float, float], rounds: int, i: int, reach: int,
) -> float:  # fmt: skip
    """Move the vertices up to ``reach`` on either side of vertex i until all rows are near enough on a cold run.

    Args:
        numbers: of a curve with vertices, see :func:`.spline_curve.tried_in`; receives the curve as it is then.
        outline: ``Q``, ``directions`` and ``free`` of :class:`.feet.Samples`.
        limits: how near the samples have to be; margin and residual of the interpolation. rounds: most steps.

    Returns:
        The largest distance of a cold run that passed; else the least one seen, of a warm run, and more than the limit:
        infinite if variant 2 finds no curve.
    """
    (samples, directions, free), (near, margin, residual) = outline, limits
    masters, n = samples.shape[0], samples.shape[1]
    p, tips, powers, h, errors = tried_in(numbers, masters, k, closed)
    owned = (
        curve_of(p, tips, closed), curve_of(p, tips, closed), empty_rows(masters, n), empty_rows(masters, n),
        system_of(masters, k, closed, i, reach),
    )  # fmt: skip
    curve, trial, rows, tried, system = borrowed(owned)
    hold_tied(curve, directions, free)
    error, passed, wobble, damping, enough = np.inf, False, 0.0, 1e-2, ENOUGH * near
    cold, found = interpolate_cold(curve, margin, max(enough, residual), True)
    hope = near if masters == 1 else np.inf
    for m in range(rounds):
        hope *= STRIDES[min(m, 2)]
    if cold < np.inf:
        error = measure(samples, curve.c, curve.h, curve.closed, near, (False, rows.span, rows.x), rows)
        total = 0.0
        for s in range(k):
            total += curve.h[s + 2]
        mean = total / k
        wobble = WOBBLE * (mean * mean * mean)
    else:
        rounds = -1
    for m in range(rounds + 1):
        if error <= near:
            copy_points(curve, trial)
            cold, found = interpolate_cold(trial, margin, residual, False)
            if cold < residual:
                curve, trial = trial, curve
                error = measure(samples, curve.c, curve.h, curve.closed, near, (True, rows.span, rows.x), rows)
        passed = error <= near and cold < residual and found
        far = m > 1 and masters == 1 and set_errors(rows, OFF * near, errors) >= SPANS_OFF
        if passed or m == rounds or error > hope or far:
            break
        hope /= STRIDES[min(m, 2)]
        minimax, failures, new = m >= 2, 0, np.inf
        differentiate(curve, system)
        add_rows(rows, curve.b, curve.h, system, error, minimax, wobble)
        old = objective(curve, rows, error, minimax, wobble)
        while failures < FAILURES:
            solve_step(curve, system, damping, n, directions, free)
            share = 0.5 if minimax else 1.0
            if _advance(curve, trial, system.frames, system.moves, system.step, system.place, share):
                hold_tied(trial, directions, free)
                iterate(trial, enough, 12, True)
                new = measure(samples, trial.c, trial.h, trial.closed, near, (True, rows.span, rows.x), tried)
                if objective(trial, tried, error, minimax, wobble) < old:
                    break
            failures += 1
            damping *= 10
        if failures == FAILURES:
            break
        damping /= 4
        curve, trial, rows, tried, error = trial, curve, tried, rows, new
    if not passed:
        error = max(error, np.nextafter(near, np.inf))
    put(curve.p, p)
    put(curve.c, powers)
    put(curve.h, h)
    set_errors(rows, near, errors)
    for v in range(0 if closed else masters):
        for axis in range(2):
            tips[v, 0, axis], tips[v, 1, axis] = curve.X[v, 1, axis], curve.X[v, k + 1, axis]
    keep_alive(owned)
    return error


@compiled
def _advance(
    curve: Curve, trial: Curve, frames: FloatArray, moves: FloatArray, step: FloatArray, place: IntArray, share: float
) -> bool:  # fmt: skip
    """Move vertices, knots and control points of a copy of the curve by a share of the step; False if chords vanish.

    A vertex moves across the curve as the curve does at its footpoint.
    """
    copy_points(curve, trial)
    for v in range(len(step)):
        _move_points(curve, trial.X[v], trial.p[v], v, (frames[v], moves[v], step[v], place), share)
    if not set_knots(trial):
        return False
    k, closed = curve.k, curve.closed
    for v in range(0 if closed else len(step)):
        p, X, old = trial.p[v], trial.X[v], curve.X[v]
        for end, tip, i in ((0, 1, 0), (k + 2, k + 1, k - 1)):
            own = length(p[i + 1, 0] - p[i, 0], p[i + 1, 1] - p[i, 1])
            if own > 0.0:
                x, y, size = limited(
                    old[tip, 0] - old[end, 0], old[tip, 1] - old[end, 1], X[tip, 0] - X[end, 0], X[tip, 1] - X[end, 1],
                    SHORTEST_HANDLE * own, LONGEST_HANDLE * own,
                )  # fmt: skip
                X[tip, 0], X[tip, 1] = X[end, 0] + x * size, X[end, 1] + y * size
    return True


@compiled
def _move_points(
    curve: Curve, X: FloatArray, p: FloatArray, v: int, by: tuple[FloatArray, FloatArray, FloatArray, IntArray],
    share: float,
) -> None:  # fmt: skip
    """Move control points X and vertices p of master v by a share of the step.

    Args:
        by: ``frames``, ``moves`` and ``step`` of this master, and ``place``, see :class:`.spline_equations.System`.
    """
    frames, moves, step, place = by
    k, closed, h = curve.k, curve.closed, curve.h
    for i in range(k + 1 - closed):
        r = 2 * place[i + 1]
        if r < 0:
            continue
        nu, sigma = share * step[r], share * step[r + 1]
        if closed or 0 < i < k:
            # A vertex moves along the curve by this share of its shorter chord at most.
            most = 0.3 * min(h[i + 1], h[i + 2]) / knots_per_step(curve, v, i)
            sigma = min(max(sigma, -most), most)
        step[r], step[r + 1] = nu, sigma
        for axis in range(2):
            X[i + 1, axis] += nu * frames[i, axis] + sigma * frames[i, 2 + axis]
    for i in range(1 - closed, k):
        s, x = (i, curve.t[i]) if curve.t[i] >= 0 else (wrapped(i - 1, k), curve.t[i] + 1)
        y, across = 1 - x, 0.0
        for c in range(4):
            r = 2 * place[s + c]
            for u in range(2 if r >= 0 else 0):
                m, column = moves[s], 2 * c + u
                for axis in range(2):
                    d = y * y * (y * m[axis, column] + 3 * x * m[2 + axis, column])
                    d += x * x * (3 * y * m[4 + axis, column] + x * m[6 + axis, column])
                    across += step[r + u] * d * frames[i, axis]
        r = 2 * place[i + 1]
        along = step[r + 1] if r >= 0 else 0.0
        for axis in range(2):
            p[i, axis] += across * frames[i, axis] + along * frames[i, 2 + axis]
