"""The fewest spans with which one spline of variant 2 follows a stretch of outline.

A first guess comes from the density of vertices that the curvature asks for. Spans that stay too far off are cut in
two, vertices that seem unnecessary are taken out, and after every change the vertices move to where they serve best.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet, length
from ...types import BoolArray, FloatArray
from .cubic_fit import fit_cubic
from .cutting import Stretches
from .pieces import Pieces, add_piece, add_pieces, empty_pieces, part, row_of, used
from .search_settings import Search
from .spline_curve import Curve, copy_curve, empty_curve, inner_vertices, interpolate_cold
from .spline_fit import Fit, Rows, Samples, empty_rows, improve, measure

SOME_MORE = 30.0
"""A cubic that misses the tolerance by less than this factor is followed by a try with two spans."""

STARTS = 3
"""First guesses, each with more vertices, before a stretch is given up."""

GROWTH = 1.35
"""How fast the wanted distance of vertices grows along the outline: by exp(1.35) < 4 from one to the next."""

BEGIN, INSERT, REMOVE, RESTART = 0, 1, 2, 3
"""What is tried: a first guess, more vertices, one vertex less, a new guess with one less."""


@compiled
def fit_splines(pieces: Pieces, stretches: Stretches, near: float, search: Search, given: bool) -> Pieces:
    """The pieces with splines in the place of those that stretches are for; infinite errors where none was found.

    Args:
        near: how near all samples have to be. given: begin from the pieces' own vertices and tangents.
    """
    P, S = len(pieces.where), len(stretches.piece)
    found, count, s = empty_pieces(P, len(pieces.vertices) + len(stretches.points) + S), 0 * P, 0 * P
    tangents = np.empty((2, 2))
    for q in range(P):
        if s == S or stretches.piece[s] != q:
            count = add_pieces(found, count, part(pieces, q, q + 1))
            continue
        c, i, j, k, closed, choice = row_of(pieces, q)
        samples = _samples(stretches, s, closed)
        p = np.empty((len(samples.Q) + 1, 3))
        for axis in range(2):
            tangents[0, axis], tangents[1, axis] = pieces.tangents[q, 0, axis], pieces.tangents[q, 1, axis]
        for r in range(k + 1 - closed):
            for axis in range(3):
                p[r, axis] = pieces.vertices[pieces.starts[q] + r, axis]
        k, error = find_spline(
            samples, stretches.directions[s], closed, near, search, k if given else 0, pieces.errors[q], p, tangents
        )
        count = add_piece(found, count, (c, i, j, max(k, 1), closed, choice), p, tangents, error)
        s += 1
    return used(found, count)


@compiled(internal=True)
def _samples(stretches: Stretches, s: int, closed: int) -> Samples:
    """The samples of a stretch, with the integral of the density of vertices."""
    first, n = stretches.starts[s], stretches.starts[s + 1] - stretches.starts[s] - 1
    Q = stretches.points[first : first + n + 1]
    D, h, step = np.empty(n + 1), np.empty(n), np.empty(n)
    for r in range(n):
        h[r], step[r] = stretches.spacing[first + r], length(Q[r + 1, 0] - Q[r, 0], Q[r + 1, 1] - Q[r, 1])
    # Spacings grow no faster than chords may; around a closed contour from the last to the first, too.
    for _ in range(2):
        for r in range(n):
            if r > 0 or closed:
                h[r] = min(h[r], h[r - 1] + GROWTH * (step[r] + step[r - 1]) / 2)
        for r in range(n - 1, -1, -1):
            if r + 1 < n or closed:
                e = (r + 1) % n
                h[r] = min(h[r], h[e] + GROWTH * (step[r] + step[e]) / 2)
    D[0] = 0.0
    for r in range(n):
        D[r + 1] = D[r] + step[r] / h[r]
    return Samples(Q[: n + 1 - closed], D, stretches.free[s], Q[n, 2])


@compiled(internal=True)
def empty_fit(samples: int, spans: int, closed: int) -> Fit:
    """Scratch arrays for a stretch of so many samples and curves of up to so many spans."""
    slots = spans + 1
    return Fit(
        empty_curve(spans, closed), empty_curve(spans, closed), empty_rows(samples), empty_rows(samples),
        np.empty((slots, 4)), np.empty((slots, 8, 8)), np.empty((slots, 9, 8)), np.empty(8),
        np.empty((2 * slots, 2 * slots)), np.empty(2 * slots), np.empty(2 * slots, dtype=np.int64),
    )  # fmt: skip


@compiled(internal=True)
def find_spline(
    samples: Samples, directions: FloatArray, closed: int, near: float, search: Search, given: int, missed: float,
    p: FloatArray, tangents: FloatArray,
) -> tuple[int, float]:  # fmt: skip
    """Fit one spline to a stretch, of as few spans as the search finds.

    Args:
        directions: (2, 2) unit tangents at the ends. near: how near all samples have to be.
        given: spans to begin with, whose vertices and tangents are in p and ``tangents``; 0 for a first guess.
        missed: by how much a single cubic misses the samples.
        p: (n + 1, 3) receives the vertices and their places. tangents: (2, 2) receives the end tangents of an arc,
            derivatives by chord length.

    Returns:
        The number of spans and the largest distance of a sample; 0 and infinity if there is none.
    """
    Q = samples.Q
    n = len(Q)
    if given == 1:
        missed = fit_cubic(
            Q, directions[0], samples.free[0] > 0, directions[1], samples.free[1] > 0, near, search.cubic_rounds,
            tangents[0], tangents[1],
        )  # fmt: skip
        if missed <= near:
            return 1, missed
    wanted = int(np.rint(search.guess * min(samples.D[len(samples.D) - 1], float(n))))
    least = 4 if closed else 2
    guess = 2 if not closed and missed < SOME_MORE * near else max(least, wanted)
    if max(guess, given) > min(search.most, n - 1):
        return 0, np.inf
    fit = empty_fit(n, min(2 * max(guess, wanted, given) + 16, n - 1), closed)
    curve, best = fit.curve, empty_curve(len(fit.gram) - 1, closed)
    tried, costs = np.zeros(len(fit.gram) + 1, dtype=np.bool_), np.empty(len(fit.gram))
    what, at, starts, slow, turn, tries, removed = BEGIN, 0 * n, 1, 0, 0, 0, False
    best_error = last = np.inf
    while True:
        # What is tried next, in ``curve``.
        possible = True
        if what == BEGIN and given > 1:
            begin_from(curve, given, p, tangents)
        elif what in (BEGIN, RESTART):
            possible = place_vertices(curve, samples, directions, guess, len(fit.gram) - 1)
        elif what == INSERT:
            possible = insert_vertices(fit, near, search)
        else:
            remove_vertex(curve, best, at)
        error = np.inf
        if possible and interpolate_cold(curve, search.margin, search.residual) < np.inf:
            k = curve.size[0]
            width, start = k + 1 - closed, 0 * k
            rounds = search.few_rounds if k <= 3 else (search.removal_rounds if what == REMOVE else search.rounds)
            if what == REMOVE and 2 * search.reach < width:
                start = (at - search.reach) % k if closed else min(max(at - search.reach, 0), width - 2 * search.reach)
                width = 2 * search.reach
            mean = 0.0
            for s in range(k):
                mean += curve.h[s + 2] / k
            wobble = search.fairness * mean**3
            error = improve(fit, samples, near, search.margin, search.residual, rounds, start, width, wobble)
        # How it went.
        good = error <= near
        if good:
            copy_curve(curve, best)
            best_error, removed = error, True
        if not best_error <= near:  # no good curve yet: more vertices, or another guess
            slow = slow + 1 if error > 4 * near and error > 0.7 * last else 0
            last = error
            what = INSERT if possible and error < np.inf and slow < 3 else BEGIN
            if what == BEGIN:
                if starts == STARTS or given > 1:
                    return 0, np.inf
                guess, starts, slow = max(wanted, guess + 2) + starts - 1, starts + 1, 0
            continue
        if what != REMOVE or good:  # another good curve: what it would cost to take out each vertex
            copy_curve(best, curve)
            measure(samples, curve, False, near, fit.rows)
            removal_costs(fit, costs)
        if what != REMOVE:
            if turn >= search.passes or (what == RESTART and not good) or given > 1:
                break
            turn, removed = turn + 1, False
            tries = max(int(np.ceil(search.removals * best.size[0])), 1)
            tried[:] = False
        elif good:
            for i in range(at, best.size[0]):
                tried[i] = tried[i + 1]
        else:
            tried[at] = True
        what, at = REMOVE, cheapest(best, costs, tried)
        if tries == 0 or best.size[0] <= least or at < 0 or costs[at] > search.dear * near:
            # This pass is over: another one if vertices were taken out, or else a new guess with one less.
            if turn >= search.passes or best.size[0] <= least:
                break
            if removed:
                turn, removed = turn + 1, False
                tries = max(int(np.ceil(search.removals * best.size[0])), 1)
                tried[:] = False
                at = cheapest(best, costs, tried)
                if at < 0 or costs[at] > search.dear * near:
                    break
            else:
                what, guess = RESTART, best.size[0] - 1
        tries -= 1
    k = best.size[0]
    for i in range(k + 1 - closed):
        p[i, 0], p[i, 1] = best.p[i, 0], best.p[i, 1]
    measure(samples, best, False, near, fit.rows)
    find_places(samples, best, fit.rows, p)
    if not closed:
        for axis in range(2):
            tangents[0, axis] = 3 * (best.X[1, axis] - best.X[0, axis]) / best.h[2]
            tangents[1, axis] = 3 * (best.X[k + 2, axis] - best.X[k + 1, axis]) / best.h[k + 1]
    return k, best_error


@compiled(internal=True)
def find_places(samples: Samples, curve: Curve, rows: Rows, p: FloatArray) -> None:
    """The places of the outline beside the knots of a curve, from the feet of the samples, into column 2 of p."""
    Q, k, closed, n = samples.Q, curve.size[0], curve.size[1], len(samples.Q)
    lap = samples.laps
    j = 0 * n
    for i in range(k + 1 - closed):
        knot = float(i)
        if closed and knot < rows.span[0] + rows.x[0]:
            knot += k
        if closed:
            j = 0 * n
        while j + 1 < n and rows.span[j + 1] + rows.x[j + 1] <= knot:
            j += 1
        low, here = rows.span[j] + rows.x[j], Q[j, 2]
        if j + 1 < n:
            high, there = rows.span[j + 1] + rows.x[j + 1], Q[j + 1, 2]
        else:
            high, there = rows.span[0] + rows.x[0] + k, Q[0, 2] + lap
        share = (knot - low) / (high - low) if high > low else 0.0
        p[i, 2] = here + share * (there - here)
    if closed:
        for i in range(1, k):
            if p[i, 2] < p[0, 2]:
                p[i, 2] += lap
        if p[0, 2] >= lap:
            for i in range(k):
                p[i, 2] -= lap
    else:
        p[k, 2] = Q[n - 1, 2]


@compiled(internal=True)
def begin_from(curve: Curve, k: int, p: FloatArray, tangents: FloatArray) -> None:
    """A curve of k spans with the given vertices and end tangents."""
    closed = curve.size[1]
    curve.size[0] = k
    for i in range(k + 1 - closed):
        curve.p[i, 0], curve.p[i, 1] = p[i, 0], p[i, 1]
    if not closed:
        _set_handles(curve, tangents, 1.0)


@compiled(internal=True)
def _set_handles(curve: Curve, tangents: FloatArray, size: float) -> None:
    """End handles of an arc along tangents, whose length is ``size`` if they are derivatives by chord length."""
    k, p, X = curve.size[0], curve.p, curve.X
    first = size * length(p[1, 0] - p[0, 0], p[1, 1] - p[0, 1]) / 3
    last = size * length(p[k, 0] - p[k - 1, 0], p[k, 1] - p[k - 1, 1]) / 3
    for axis in range(2):
        X[0, axis], X[1, axis] = p[0, axis], p[0, axis] + first * tangents[0, axis]
        X[k + 1, axis], X[k + 2, axis] = p[k, axis] - last * tangents[1, axis], p[k, axis]


@compiled(internal=True)
def place_vertices(curve: Curve, samples: Samples, directions: FloatArray, k: int, most: int) -> bool:
    """A curve of k spans with its vertices on the outline, as the density has them; False if there is no room."""
    Q, D, p, closed = samples.Q, samples.D, curve.p, curve.size[1]
    n = len(Q)
    if k > most:
        return False
    curve.size[0] = k
    j = 0 * k
    for i in range(k + 1 - closed):
        goal = D[len(D) - 1] * i / k
        while j + 2 < len(D) and D[j + 1] <= goal:
            j += 1
        after = (j + 1) % n
        share = min(max((goal - D[j]) / max(D[j + 1] - D[j], 1e-300), 0.0), 1.0)
        p[i, 0] = Q[j, 0] + share * (Q[after, 0] - Q[j, 0])
        p[i, 1] = Q[j, 1] + share * (Q[after, 1] - Q[j, 1])
    if not closed:
        p[k, 0], p[k, 1] = Q[n - 1, 0], Q[n - 1, 1]
        _set_handles(curve, directions, 1.0)
    return True


@compiled(internal=True)
def _span_errors(rows: Rows, k: int, errors: FloatArray) -> None:
    """The largest distance in each span."""
    for s in range(k):
        errors[s] = 0.0
    for r in range(rows.used[0]):
        s = rows.span[r] % k
        errors[s] = max(errors[s], abs(rows.e[r]))


@compiled(internal=True)
def insert_vertices(fit: Fit, near: float, search: Search) -> bool:
    """Cut the worst spans in two, no two adjacent ones; False if there is no room for more."""
    curve, trial = fit.curve, fit.trial
    k, closed = curve.size[0], curve.size[1]
    errors = np.empty(k)
    _span_errors(fit.rows, k, errors)
    wanted = 0.0
    for s in range(k):
        if errors[s] > near:
            wanted += min((errors[s] / near) ** search.growth - 1, 1.0)
    count = min(max(int(np.rint(wanted)), 1), len(fit.gram) - 1 - k)
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
    at = 0 * k
    for s in range(k):
        curve.p[at, 0], curve.p[at, 1] = trial.p[s, 0], trial.p[s, 1]
        at += 1
        if cut[s]:
            curve.p[at, 0], curve.p[at, 1], _, _, _, _ = jet(trial.b, s, 0.5)
            at += 1
    _resize(curve, trial, at)
    return True


@compiled(internal=True)
def _resize(curve: Curve, old: Curve, k: int) -> None:
    """Give a curve whose vertices are set, but for the last of an arc, k spans; an arc's ends stay those of ``old``."""
    before = old.size[0]
    curve.size[0] = k
    if curve.size[1]:
        return
    for axis in range(2):
        curve.p[k, axis] = old.p[before, axis]
        curve.X[0, axis], curve.X[1, axis] = old.X[0, axis], old.X[1, axis]
        curve.X[k + 1, axis], curve.X[k + 2, axis] = old.X[before + 1, axis], old.X[before + 2, axis]
    # Handles stay within the bounds of the chords beside them.
    first = length(curve.p[1, 0] - curve.p[0, 0], curve.p[1, 1] - curve.p[0, 1])
    last = length(curve.p[k, 0] - curve.p[k - 1, 0], curve.p[k, 1] - curve.p[k - 1, 1])
    for end, tip, chord in ((0, 1, first), (k + 2, k + 1, last)):
        x, y = curve.X[tip, 0] - curve.X[end, 0], curve.X[tip, 1] - curve.X[end, 1]
        size = length(x, y)
        share = min(1.0, 0.5 * chord / size) if size > 0 else 1.0
        curve.X[tip, 0], curve.X[tip, 1] = curve.X[end, 0] + share * x, curve.X[end, 1] + share * y


@compiled(internal=True)
def removal_costs(fit: Fit, costs: FloatArray) -> None:
    """What taking out each vertex is estimated to cost: the jump of the third derivative at its knot, and the error."""
    curve = fit.curve
    k, b, h = curve.size[0], curve.b, curve.h
    errors = np.empty(k)
    _span_errors(fit.rows, k, errors)
    first, stop = inner_vertices(curve)
    for i in range(first, stop):
        last = i - 1 if i > 0 else k - 1
        _, _, dx, dy, _, _ = jet(b, i, 0.0)
        speed = max(length(dx, dy), 1e-12)
        before, after = h[i + 1], h[i + 2]
        jump = 0.0
        for axis, normal in ((0, -dy / speed), (1, dx / speed)):
            own = b[i, 3, axis] - b[i, 0, axis] - 3 * (b[i, 2, axis] - b[i, 1, axis])
            other = b[last, 3, axis] - b[last, 0, axis] - 3 * (b[last, 2, axis] - b[last, 1, axis])
            jump += normal * 6 * (own / after**3 - other / before**3)
        reach = before * after / (before + after)
        costs[i] = abs(jump) * reach**3 / 6 + max(errors[last], errors[i]) / 4


@compiled(internal=True)
def cheapest(curve: Curve, costs: FloatArray, tried: BoolArray) -> int:
    """The vertex that costs least of those not tried; -1 if there is none."""
    first, stop = inner_vertices(curve)
    found = -1 - 0 * stop
    for i in range(first, stop):
        if not tried[i] and (found < 0 or costs[i] < costs[found]):
            found = i
    return found


@compiled(internal=True)
def remove_vertex(curve: Curve, good: Curve, i: int) -> None:
    """The good curve without vertex i."""
    k, closed = good.size[0], good.size[1]
    curve.size[1] = closed
    for j in range(k - closed):
        n = j if j < i else j + 1
        curve.p[j, 0], curve.p[j, 1] = good.p[n, 0], good.p[n, 1]
    _resize(curve, good, k - 1)
