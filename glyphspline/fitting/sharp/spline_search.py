"""The fewest spans with which one spline of variant 2 follows a stretch of outline.

A first guess comes from the density of vertices that the curvature asks for. Spans that stay too far off are cut in
two, vertices that seem unnecessary are taken out, and after every change the vertices move to where they serve best.

After each step of these a few warm passes of variant 2 put the curve through the moved vertices again. What counts is a
cold run from the vertices alone, as the interpolation that is written makes it.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import length
from ...intrinsics import borrowed, keep_alive
from ..ladders import STARTS
from .corners import Joints
from .cubics import fit_cubic, limited, solve
from .feet import copy_rows, find_places, measure, measure_afresh
from .pieces import Pieces
from .settings import Settings
from .spline_curve import (
    FREE,
    LONGEST_HANDLE,
    SHORTEST_HANDLE,
    copy_curve,
    hold_tied,
    interpolate_cold,
    iterate,
    set_handles,
    set_knots,
)
from .spline_equations import (
    LARGEST_RATIO,
    Fit,
    add_rows,
    agree_on_handles,
    differentiate,
    empty_fit,
    equations,
    knots_per_step,
    objective,
)
from .vertices import insert_vertices, keep, place_vertices, resize, samples_between

PATIENCE = 12
"""Insertions after a first guess from which on all spans that miss the tolerance are cut.

On long stretches of fine detail very many miss it by little, and would get two or three vertices at a time. It saves 13
of 35,142 segments.
"""


@compiled
def fit_spline(joints: Joints, near: float, settings: Settings, given: bool, pieces: Pieces, q: int) -> None:
    """Put one spline in the place of piece q, the last, of as few spans as the search finds.

    The piece gets an infinite error if there is none.

    Args:
        near: how near all samples have to be. given: begin from the piece's own vertices and tangents.
    """
    k, closed = pieces.spans[q], pieces.closed[q]
    missed, begun = pieces.errors[q] if k == 1 else np.inf, k if given else 0
    samples = samples_between(joints, pieces.joints[q, 0], pieces.joints[q, 1], closed)
    alone, most = len(samples.Q) == 1, len(samples.places) - 1
    if begun == 1 and alone:
        free = (samples.free[0] == FREE, samples.free[1] == FREE)
        missed = fit_cubic(
            samples.Q[0], samples.directions[0], free, near, settings.cubic_rounds, pieces.tangents[q, 0]
        )
        pieces.errors[q] = missed
        if missed <= near:
            return
        begun = 0
    pieces.errors[q] = np.inf
    wanted = int(np.rint(settings.guess * min(samples.D[-1], len(samples.places))))
    least = 4 if closed else (2 if alone else 1)
    # A cubic that misses the tolerance by less than this factor is followed by a try with two spans: this saves 483
    # segments with "fast"; without a limit 289 more, for 1.4 times the time.
    guess = 2 if not closed and missed < 30.0 * near else max(least, wanted)
    # Spans of one spline at most: what needs more stays as the source has it.
    if max(guess, begun) > min(1000, most):
        return
    owned = empty_fit(samples, near, settings, min(2 * max(wanted, 4, begun) + 16, most), closed)
    fit = borrowed(owned)
    if begun > 0:
        at, n = pieces.starts[q], begun + 1 - closed
        fit.curve.size[0] = begun
        for v in range(len(samples.Q)):
            fit.curve.p[v, :n] = pieces.vertices[at : at + n, v]
        set_handles(fit.curve, pieces.tangents[q])
    if grow(fit, begun, guess, wanted):
        if begun == 0:
            remove_vertices(fit, least)
        best, k, at = fit.best, fit.best.size[0], pieces.starts[q]
        n = k + 1 - closed
        pieces.errors[q] = measure_afresh(fit.samples, best, fit.near, fit.rows)
        pieces.spans[q], pieces.starts[q + 1] = k, at + n
        find_places(fit.samples, best, fit.rows, pieces.places[at : at + n])
        for v in range(len(best.p)):
            pieces.vertices[at : at + n, v] = best.p[v, :n]
            if not closed:
                X, tangents = best.X[v], pieces.tangents[q, v]
                for axis in range(2):
                    tangents[0, axis] = 3 * (X[1, axis] - X[0, axis]) / best.h[2]
                    tangents[1, axis] = 3 * (X[k + 2, axis] - X[k + 1, axis]) / best.h[k + 1]
    keep_alive(owned)


@compiled
def grow(fit: Fit, begun: int, guess: int, wanted: int) -> bool:
    """Move the vertices, and add more where they miss the tolerance, until a curve passes; whether one does.

    Args:
        begun: spans of the curve to begin with; 0 to begin with ``guess`` spans, and then with more.
        wanted: spans by the density.
    """
    settings, near = fit.settings, fit.near
    last = np.inf
    for start in range(1 if begun > 0 else STARTS):
        if start > 0:
            guess = max(wanted, guess + 2) + start - 1
        possible = begun > 0 or place_vertices(fit, guess)
        slow = insertions = 0
        while possible:
            k = fit.curve.size[0]
            error = move(fit, settings.rounds, k, k)
            if error <= near:
                keep(fit)
                return True
            slow = slow + 1 if error > 4 * near and error > 0.7 * last else 0
            last = error
            if error == np.inf or slow == 3:
                break
            insertions += 1
            possible = insert_vertices(fit, settings.growth if insertions <= PATIENCE else np.inf)
        if not possible:
            last = np.inf
    return False


@compiled
def move(fit: Fit, rounds: int, i: int, reach: int) -> float:
    """Interpolate the vertices, and move those up to ``reach`` on either side of vertex i, in ``rounds`` steps at most.

    Returns:
        The largest distance of a sample: see :func:`improve`.
    """
    curve, settings = fit.curve, fit.settings
    hold_tied(curve, fit.samples.directions, fit.samples.free)
    if not interpolate_cold(curve, settings.margin, settings.residual) < np.inf:
        return np.inf
    k, closed, place = curve.size[0], curve.size[1], fit.place
    slots, width, start = k + 1 - closed, 2 * reach, 0
    if width >= slots:
        width = slots
    else:
        start = i - reach if closed else min(max(i - reach, 0), slots - width)
    place[: k + 3] = -1
    for n in range(width):
        place[(start + n) % slots + 1] = n
    if closed:
        place[0], place[k + 1], place[k + 2] = place[k], place[1], place[2]
    return improve(fit, settings.few_rounds if k <= 3 else rounds, width)


@compiled
def remove_vertices(fit: Fit, least: int) -> None:
    """Take vertices out of the best curve, the cheapest first, as long as what is left passes.

    In a pass a share of them is tried, each once. After a pass that took any out another one follows. Where none can be
    taken out, a new guess has one less.
    """
    curve, best, costs, settings = fit.curve, fit.best, fit.costs, fit.settings
    left = np.empty(len(costs), dtype=np.bool_)  # which ones are still to be tried
    for n in range(settings.passes):
        before, tried = best.size[0], 0
        most = max(int(np.ceil(settings.removals * before)), 1)
        left[:] = True
        while tried < most and best.size[0] > least:
            k, i = best.size[0], -1
            for j in range(1 - best.size[1], k):
                if left[j] and costs[j] <= settings.dear * fit.near and (i < 0 or costs[j] < costs[i]):
                    i = j
            if i < 0:
                break
            tried += 1
            curve.p[:, :i], curve.p[:, i : k - 1] = best.p[:, :i], best.p[:, i + 1 : k]
            resize(curve, best, k - 1)
            left[i] = False
            if move(fit, settings.removal_rounds, i, settings.reach) <= fit.near:
                keep(fit)
                for j in range(i, k - 1):
                    left[j] = left[j + 1]
        k = best.size[0] - 1
        if k < least or (tried > 0 and n == settings.passes - 1):
            return
        if tried == 0 or k + 1 == before:
            if not place_vertices(fit, k) or not move(fit, settings.rounds, k, k) <= fit.near:
                return
            keep(fit)


@compiled
def improve(fit: Fit, rounds: int, width: int) -> float:
    """Move those slots of ``fit.curve`` that are chosen until all rows are near enough on a cold run of variant 2.

    Args:
        rounds: most steps. width: the number of slots.

    Returns:
        The largest distance of a cold run that passed, whose results ``fit.curve`` and ``fit.rows`` are; else the least
        one seen, of a warm run.
    """
    samples, near, margin, residual = fit.samples, fit.near, fit.settings.margin, fit.settings.residual
    curve, trial, rows, tried = fit.curve, fit.trial, fit.rows, fit.tried
    error, k = measure_afresh(samples, curve, near, rows), curve.size[0]
    wobble = 0.0
    for s in range(k):
        wobble += curve.h[s + 2]
    # Weight of the curve's wobble beside its distances: of the integral of (dκ/ds)², by the cube of the mean chord.
    wobble = 1e-2 * (wobble / k) ** 3
    # Damping of the first step, as a share of the mean of the diagonal.
    damping, failures = 1e-2, 0
    for n in range(rounds + 1):
        graded = error <= near
        for s in range(1 - curve.size[1], k if graded else 0):
            a, b = curve.h[s + 1], curve.h[s + 2]
            graded = graded and a <= LARGEST_RATIO * b and b <= LARGEST_RATIO * a
        if graded:
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
        add_rows(fit, error, minimax, wobble)
        old = objective(curve, rows, error, minimax, wobble)
        while True:
            agreed = tied = True
            while agreed:
                for v in range(len(fit.step)):
                    equations(fit, v, damping, width)
                    solve(fit.A, fit.step[v], fit.first, 2 * width)
                agreed = tied and agree_on_handles(fit)
                tied = False
            fit.longer[:] = np.nan
            better = False
            if _advance(fit, 0.5 if minimax else 1.0):
                iterate(trial, 0.02 * near, 12)  # enough for the next step
                new = measure(samples, trial, near, rows, tried)
                better = objective(trial, tried, error, minimax, wobble) < old
            if better:
                break
            failures += 1
            damping *= 10
            # Steps that fail in a row before a fit is given up.
            if failures >= 4:
                return max(error, np.nextafter(near, np.inf))
        failures, damping = 0, damping / 4
        copy_curve(trial, curve)
        copy_rows(tried, rows)
        error = new
    return max(error, np.nextafter(near, np.inf))


@compiled
def _advance(fit: Fit, share: float) -> bool:
    """The trial: the curve with vertices, knots and control points moved by a share of the step.

    A vertex moves across the curve as the curve does at its footpoint. False if chords vanish.
    """
    curve, trial = fit.curve, fit.trial
    copy_curve(curve, trial)
    k, closed, h = curve.size[0], curve.size[1], curve.h
    for v in range(len(fit.step)):
        X, p, step, frames, moves = trial.X[v], trial.p[v], fit.step[v], fit.frames[v], fit.moves[v]
        for i in range(k + 1 - closed):
            r = 2 * fit.place[i + 1]
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
            s, x = (i, curve.t[i]) if curve.t[i] >= 0 else ((i - 1) % k, curve.t[i] + 1)
            y, across = 1 - x, 0.0
            for c in range(4):
                r = 2 * fit.place[s + c]
                for u in range(2 if r >= 0 else 0):
                    m, column = moves[s], 2 * c + u
                    for axis in range(2):
                        d = y * y * (y * m[axis, column] + 3 * x * m[2 + axis, column])
                        d += x * x * (3 * y * m[4 + axis, column] + x * m[6 + axis, column])
                        across += step[r + u] * d * frames[i, axis]
            r = 2 * fit.place[i + 1]
            along = step[r + 1] if r >= 0 else 0.0
            for axis in range(2):
                p[i, axis] += across * frames[i, axis] + along * frames[i, 2 + axis]
    if not set_knots(trial):
        return False
    for v in range(0 if closed else len(fit.step)):
        p, X, old = trial.p[v], trial.X[v], curve.X[v]
        for end, tip, i in ((0, 1, 0), (k + 2, k + 1, k - 1)):
            own = length(p[i + 1, 0] - p[i, 0], p[i + 1, 1] - p[i, 1])
            if own > 0.0:
                x, y, size = limited(
                    old[tip, 0] - old[end, 0], old[tip, 1] - old[end, 1], X[tip, 0] - X[end, 0], X[tip, 1] - X[end, 1],
                    SHORTEST_HANDLE * own, LONGEST_HANDLE * own,
                )  # fmt: skip
                X[tip, 0], X[tip, 1] = X[end, 0] + x * size, X[end, 1] + y * size
    hold_tied(trial, fit.samples.directions, fit.samples.free)
    return True
