"""The fewest spans with which one spline of variant 2 follows a stretch of outline.

A first guess comes from the density of vertices that the curvature asks for. Spans that stay too far off are cut in
two, vertices that seem unnecessary are taken out, and after every change the vertices move to where they serve best.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet, length
from ...intrinsics import borrowed, keep_alive
from ...types import BoolArray, FloatArray
from .cubic_fit import fit_cubic
from .feet import Rows, Samples, find_places, measure, measure_afresh, span_errors
from .pieces import Pieces, add_piece, add_pieces, empty_pieces, part, row_of, used
from .search_settings import Search
from .spline_curve import (
    FREE,
    TIED,
    Curve,
    chord,
    copy_curve,
    end_tangents,
    hold_tied,
    inner_vertices,
    interpolate_cold,
    set_handles,
)  # fmt: skip
from .spline_equations import Fit, empty_fit, third_along
from .spline_fit import SHORTEST_HANDLE as SHORTEST
from .spline_fit import improve
from .stretches import Stretches, integrate_density, samples_of

SOME_MORE = 30.0
"""A cubic that misses the tolerance by less than this factor is followed by a try with two spans."""

STARTS = 3
"""First guesses, each with more vertices, before a stretch is given up."""

PATIENCE = 12
"""Insertions after a first guess from which on all spans that miss the tolerance are cut.

On long stretches of fine detail very many miss it by little, and would get two or three vertices at a time.
"""

FAR, FEW = 2.0, 3
"""A closed curve that may go round corners is laid on the outline once its vertices, moved, leave it this many
tolerances off, or after so many insertions.
"""

RESPACINGS = 4
"""How often laid vertices are spaced anew, before spans that miss the tolerance are cut."""

AIM, POWER = 0.85, 0.4
"""Share of the tolerance that spacing aims at, and the power of a span's error with which its vertices become denser:
a quarter is right where the outline is smooth, one beside a corner.
"""

STEEP = 3.0
"""Ratio of adjacent chords from which the longer one is cut where vertices are laid on the outline."""


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


class Trial(NamedTuple):
    """One search for the spline of a stretch.

    Attributes:
        samples: of the stretch. near: how near all of them have to be.
        fit: scratch arrays: ``curve`` is what is tried now, ``best`` the curve with the fewest spans that passed.
        goals: (room,) integrals of the density up to vertices that are laid.
        costs, tried: (room,) of the vertices of ``best``: see :func:`removal_costs` and :func:`remove_cheapest`.
    """

    samples: Samples
    near: float
    search: Search
    fit: Fit
    goals: FloatArray
    costs: FloatArray
    tried: BoolArray


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
    guess = 2 if not closed and missed < SOME_MORE * near else max(least, wanted)
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
    fit, near = trial.fit, trial.near
    last = np.inf
    for start in range(1 if given > 0 or lays else STARTS):
        if start > 0:
            guess = max(wanted, guess + 2) + start - 1
        possible = given > 0 or place_vertices(fit.curve, trial.samples, guess)
        slow = insertions = 0
        while possible:
            error = move_all(trial)
            if error <= near:
                keep(trial)
                return True
            if lays and (error > FAR * near or insertions >= FEW):
                return False
            slow = slow + 1 if error > 4 * near and error > 0.7 * last else 0
            last = error
            if error == np.inf or slow == 3:
                break
            insertions += 1
            possible = insert_vertices(fit, near, trial.search.growth if insertions <= PATIENCE else np.inf)
        if not possible:
            last = np.inf
    return False


@compiled
def move_all(trial: Trial) -> float:
    """Move all vertices of the curve; see :func:`move`."""
    curve, search = trial.fit.curve, trial.search
    k = curve.size[0]
    return move(trial, search.few_rounds if k <= 3 else search.rounds, 0, k + 1 - curve.size[1])


@compiled
def move(trial: Trial, rounds: int, start: int, width: int) -> float:
    """Interpolate the vertices and move ``width`` slots from ``start`` on, in ``rounds`` steps at most.

    Returns:
        The largest distance of a sample: see :func:`.spline_fit.improve`.
    """
    fit, samples, search = trial.fit, trial.samples, trial.search
    hold_tied(fit.curve, samples.directions, samples.free)
    if not interpolate_cold(fit.curve, search.margin, search.residual) < np.inf:
        return np.inf
    wobble = search.fairness * mean_chord(fit.curve) ** 3
    return improve(fit, samples, trial.near, search.margin, search.residual, rounds, start, width, wobble)


@compiled
def keep(trial: Trial) -> None:
    """Keep the curve, which passed, as the best so far."""
    copy_curve(trial.fit.curve, trial.fit.best)
    removal_costs(trial.fit, trial.costs)


@compiled
def lay_on_outline(trial: Trial) -> int:
    """Lay the vertices of a closed curve on the outline, more and more, until it passes.

    Returns:
        The number of vertices; 0 if no curve passes.
    """
    fit, samples, search, near = trial.fit, trial.samples, trial.search, trial.near
    laid, respaced = 0, 0
    while lay_vertices(fit, samples, trial.goals, laid, near):
        laid = fit.curve.size[0]
        if not interpolate_cold(fit.curve, search.margin, search.residual) < search.residual:
            return 0
        error = measure_laid(trial, fit.curve)
        if error <= near:
            keep(trial)
            return laid
        if error == np.inf:
            return 0
        if respaced < RESPACINGS:
            respace(samples, fit.rows, trial.goals[:laid], AIM * near)
            laid, respaced = 0, respaced + 1
    return 0


@compiled
def measure_laid(trial: Trial, curve: Curve) -> float:
    """The largest distance of a sample from a closed curve whose vertices are laid."""
    rows = trial.fit.rows
    guess_feet(trial.samples, trial.goals[: curve.size[0]], rows)
    return measure(trial.samples, curve, trial.near, rows, rows)


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
        if not place_vertices(fit.curve, trial.samples, best.size[0] - 1) or not move_all(trial) <= trial.near:
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
        start, width = slots_beside(curve, i, search.reach)
        good = move(trial, search.few_rounds if curve.size[0] <= 3 else search.removal_rounds, start, width)
        if good <= trial.near:
            keep(trial)
        mark_tried(tried, i, good <= trial.near, best.size[0])
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
def lay_vertices(fit: Fit, samples: Samples, goals: FloatArray, laid: int, near: float) -> bool:
    """A closed curve with its vertices on the outline: more of them in spans that miss the tolerance, and where
    adjacent chords differ too much; False if there is no room.

    Interpolated with vertices dense enough, any outline is within the tolerance, round corners too, from which moved
    vertices run away.

    Args:
        goals: (room,) integrals of the density up to the vertices. laid: how many there are; 0 for the first guess.
    """
    curve, D, k = fit.curve, samples.D, laid
    total = D[len(D) - 1]
    cut = np.zeros(len(goals), dtype=np.bool_)
    if laid == 0:
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
            cut[s] = own > STEEP * beside
            steep = steep or cut[s]
        if not steep:
            return True


@compiled
def respace(samples: Samples, rows: Rows, goals: FloatArray, near: float) -> None:
    """Make the wanted density higher where laid vertices are too far apart, and lower where they are too close."""
    D, Q, n, k = samples.D, samples.Q, len(samples.places), len(goals)
    errors, h, step = span_errors(rows, k), np.empty(n), np.empty(n)
    s = 0
    for j in range(n):
        while s + 1 < k and D[j] >= goals[s + 1]:
            s += 1
        change = min(max((errors[s] / near) ** POWER, 0.75), 2.0)
        step[j] = chord(Q, j, (j + 1) % n)
        h[j] = step[j] / max((D[j + 1] - D[j]) * change, 1e-300) if step[j] > 0.0 else np.inf
    integrate_density(D, h, step, 1)


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
def slots_beside(curve: Curve, at: int, reach: int) -> tuple[int, int]:
    """The first of the slots that move where vertex ``at`` was taken out, ``reach`` on either side; and how many."""
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
def remove_vertex(curve: Curve, good: Curve, i: int) -> None:
    """The good curve without vertex i."""
    k, closed = good.size[0], good.size[1]
    for v in range(len(curve.p)):
        for j in range(k - closed):
            n = j if j < i else j + 1
            curve.p[v, j, 0], curve.p[v, j, 1] = good.p[v, n, 0], good.p[v, n, 1]
    _resize(curve, good, k - 1)
