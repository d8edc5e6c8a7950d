"""The fewest spans with which one spline of variant 2 follows a stretch of outline.

A first guess comes from the density of vertices that the curvature asks for. Spans that stay too far off are cut in
two, vertices that seem unnecessary are taken out, and after every change the vertices move to where they serve best.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...intrinsics import borrowed, keep_alive
from ...types import FloatArray
from ..ladders import Search
from .cubic_fit import fit_cubic
from .feet import Samples, find_places, measure_afresh
from .laying import lay_on_outline, measure_laid
from .pieces import Pieces, add_piece, add_pieces, empty_pieces, part, row_of, used
from .spline_curve import FREE, end_tangents, hold_tied, interpolate_cold
from .spline_equations import empty_fit
from .spline_fit import improve
from .stretches import Stretches, samples_of
from .trial import (
    Trial,
    begin_from,
    cheapest,
    insert_vertices,
    keep,
    mark_tried,
    mean_chord,
    place_vertices,
    remove_vertex,
    slots_beside,
)


@compiled
def fit_splines(pieces: Pieces, stretches: Stretches, near: float, search: Search, given: bool) -> Pieces:
    """The pieces with splines in the place of those that stretches are for; infinite errors where none was found.

    Args:
        near: how near all samples have to be. given: begin from the pieces' own vertices and tangents.
    """
    P, S, masters = len(pieces.where), len(stretches.piece), len(pieces.vertices)
    room = len(pieces.places) + len(stretches.places) + S
    found, count, s = empty_pieces(masters, P, room), 0, 0
    for q in range(P):
        if s == S or stretches.piece[s] != q:
            count = add_pieces(found, count, part(pieces, q, q + 1))
            continue
        c, i, j, k, closed, choice = row_of(pieces, q)
        samples = samples_of(stretches, s, closed)
        n, tangents = len(samples.places), pieces.tangents[:, q].copy()
        p, places = np.empty((masters, n + 1, 2)), np.empty(n + 1)
        for r in range(k + 1 - closed):
            at = pieces.starts[q] + r
            places[r] = pieces.places[at]
            for v in range(masters):
                p[v, r, 0], p[v, r, 1] = pieces.vertices[v, at, 0], pieces.vertices[v, at, 1]
        fit = empty_fit(masters, n, most_spans(samples, search, k if given else 0, closed), closed)
        room = fit.curve.p.shape[1]
        trial = Trial(samples, near, search, fit, np.empty(room), np.empty(room), np.empty(room, dtype=np.bool_))
        missed = pieces.errors[q] if k == 1 else np.inf
        k, error = find_spline(borrowed(trial), k if given else 0, missed, p, places, tangents)
        keep_alive(trial)
        count = add_piece(found, count, (c, i, j, max(k, 1), closed, choice), p, places, tangents, error)
        s += 1
    return used(found, count)


@compiled
def most_spans(samples: Samples, search: Search, given: int, closed: int) -> int:
    """Spans for which a fit has room, begun with so many; 0 for a first guess."""
    return min(
        (8 if search.lays > 0 and closed else 2) * max(spans_wanted(samples, search), 4, given) + 16,
        len(samples.places) - 1,
    )


@compiled
def spans_wanted(samples: Samples, search: Search) -> int:
    """Spans of a first guess, by the density of vertices."""
    return int(np.rint(search.guess * min(samples.D[len(samples.D) - 1], float(len(samples.places)))))


@compiled
def find_spline(
    trial: Trial, given: int, missed: float, p: FloatArray, places: FloatArray, tangents: FloatArray
) -> tuple[int, float]:
    """Fit one spline to a stretch, of as few spans as the search finds.

    Args:
        given: spans to begin with, whose vertices and tangents are in p and ``tangents``; 0 for a first guess.
        missed: by how much a single cubic misses the samples.
        p: (K, n + 1, 2) receives the vertices, and places: (n + 1,) theirs. tangents: (K, 2, 2) receives the end
            tangents of an arc, derivatives by chord length.

    Returns:
        The number of spans and the largest distance of a sample; 0 and infinity if there is none.
    """
    samples, near, search, fit = trial.samples, trial.near, trial.search, trial.fit
    closed, alone = fit.curve.size[1], len(samples.Q) == 1
    if given == 1 and alone:
        missed = fit_cubic(
            samples.Q[0], samples.directions[0, 0], samples.free[0] == FREE, samples.directions[0, 1],
            samples.free[1] == FREE, near, search.cubic_rounds, tangents[0, 0], tangents[0, 1],
        )  # fmt: skip
        if missed <= near:
            return 1, missed
        given = 0
    least, wanted = 4 if closed else (2 if alone else 1), spans_wanted(samples, search)
    guess = 2 if not closed and missed < search.some_more * near else max(least, wanted)
    if max(guess, given) > min(search.most, len(samples.places) - 1):
        return 0, np.inf
    if given > 0:
        begin_from(fit.curve, given, p, tangents)
    lays, laid = search.lays if closed else 0, 0
    good = lays < 2 and grow(trial, given, guess, wanted, lays > 0)
    if not good and lays > 0:
        laid = lay_on_outline(trial)
    if not good and laid == 0:
        return 0, np.inf
    if given == 0 and (laid == 0 or search.passes > 1):
        remove_vertices(trial, least)
    return take_result(trial, laid, p, places, tangents)


@compiled
def grow(trial: Trial, given: int, guess: int, wanted: int, lays: bool) -> bool:
    """Move the vertices, and add more where they miss the tolerance, until a curve passes; whether one does.

    Args:
        given: spans of the curve to begin with; 0 to begin with ``guess`` spans, and then with more.
        wanted: spans by the density. lays: give up soon, as vertices can be laid on the outline.
    """
    fit, search, near = trial.fit, trial.search, trial.near
    last = np.inf
    for start in range(1 if given > 0 or lays else search.starts):
        if start > 0:
            guess = max(wanted, guess + 2) + start - 1
        possible = given > 0 or place_vertices(fit.curve, trial.samples, guess)
        slow = insertions = 0
        while possible:
            k = fit.curve.size[0]
            error = move(trial, search.rounds, k, k)
            if error <= near:
                keep(trial)
                return True
            if lays and (error > search.far * near or insertions >= search.few):
                return False
            slow = slow + 1 if error > 4 * near and error > 0.7 * last else 0
            last = error
            if error == np.inf or slow == 3:
                break
            insertions += 1
            possible = insert_vertices(fit, near, search.growth if insertions <= search.patience else np.inf)
        if not possible:
            last = np.inf
    return False


@compiled
def move(trial: Trial, rounds: int, i: int, reach: int) -> float:
    """Interpolate the vertices, and move those up to ``reach`` on either side of vertex i, in ``rounds`` steps at most.

    Returns:
        The largest distance of a sample: see :func:`.spline_fit.improve`.
    """
    fit, samples, search = trial.fit, trial.samples, trial.search
    hold_tied(fit.curve, samples.directions, samples.free)
    if not interpolate_cold(fit.curve, search.margin, search.residual) < np.inf:
        return np.inf
    if fit.curve.size[0] <= 3:
        rounds = search.few_rounds
    start, width = slots_beside(fit.curve, i, reach)
    wobble = search.fairness * mean_chord(fit.curve) ** 3
    return improve(fit, samples, trial.near, search.margin, search.residual, rounds, start, width, wobble)


@compiled
def remove_vertices(trial: Trial, least: int) -> None:
    """Take vertices out of the best curve, the cheapest first, as long as what is left passes.

    After a pass that took any out another one follows. Where none can be taken out, a new guess has one less.
    """
    fit, search = trial.fit, trial.search
    best = fit.best
    for n in range(search.passes):
        if best.size[0] <= least:
            return
        before = best.size[0]
        if remove_cheapest(trial, least):
            if best.size[0] <= least or n == search.passes - 1:
                return
            if best.size[0] < before:
                continue
        k = best.size[0] - 1
        if not place_vertices(fit.curve, trial.samples, k) or not move(trial, search.rounds, k, k) <= trial.near:
            return
        keep(trial)


@compiled
def remove_cheapest(trial: Trial, least: int) -> bool:
    """One pass: try to take out a share of the vertices, each of them once; False if all are too dear to be tried."""
    fit, search, tried = trial.fit, trial.search, trial.tried
    curve, best = fit.curve, fit.best
    tried[:] = False
    for n in range(max(int(np.ceil(search.removals * best.size[0])), 1)):
        i = cheapest(best, trial.costs, tried, search.dear * trial.near)
        if i < 0:
            return n > 0
        remove_vertex(curve, best, i)
        good = move(trial, search.removal_rounds, i, search.reach) <= trial.near
        if good:
            keep(trial)
        mark_tried(tried, i, good, best.size[0])
        if best.size[0] <= least:
            break
    return True


@compiled
def take_result(trial: Trial, laid: int, p: FloatArray, places: FloatArray, tangents: FloatArray) -> tuple[int, float]:
    """Write the best curve, of which ``laid`` vertices are laid; arguments and result as of :func:`find_spline`."""
    samples, fit, best = trial.samples, trial.fit, trial.fit.best
    k = best.size[0]
    error = measure_laid(trial, best) if k == laid else measure_afresh(samples, best, trial.near, fit.rows)
    find_places(samples, best, fit.rows, places)
    for v in range(len(p)):
        for i in range(k + 1 - best.size[1]):
            p[v, i, 0], p[v, i, 1] = best.p[v, i, 0], best.p[v, i, 1]
    end_tangents(best, tangents)
    return k, error
