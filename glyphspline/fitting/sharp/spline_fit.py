"""Moving the vertices of a spline of variant 2 until it is near the samples of an outline.

The vertices need not lie on the outline. Every pass of variant 2 moves a control point along the normal at the
footpoint of its vertex, so in the limit *the vertex is the foot of its control point*: across the curve the two move
together, and along the curve the vertex takes its knot with it. A step has these two unknowns a vertex and two for each
free end tangent. It is one of Gauss and Newton (Levenberg and Marquardt's damping) on the distances of the samples
along the normals; a few warm passes of variant 2 put its curve through the moved vertices again. Weights that grow with
the distance turn least squares towards the least maximum.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet, length, newton_step
from ...types import FloatArray, IntArray
from .cholesky import solve
from .spline_curve import Curve, copy_curve, inner_vertices, interpolate_cold, iterate, set_knots, span_weights

EXTRA = 6
"""Most points of the curve between two feet that count as rows of their own."""

NOTICED = 0.5
"""Points of the curve between two feet count from this share of the tolerance on."""

WARM_PASSES, WARM = 12, 0.02
"""Passes of variant 2 after a step, and the share of the tolerance below which its error is small enough."""

LARGEST_RATIO = 4.0
"""Bound on the ratio of adjacent chords: up to 4 Lemma 2 has an interval everywhere."""

END_RATIO = 3.0
"""The same for the first two and the last two pairs of chords of an arc, whose end controls take part of the peak."""

RATIO_ROOM = 0.85
"""Ratios above this share of the bound are held back."""

DAMPING = 1e-2
"""Damping of the first step, as a share of the mean of the diagonal."""

MOST_SLIDE = 0.3
"""A vertex moves along the curve by this share of its shorter chord at most."""

BAND = 8
"""Unknowns that meet in one equation: those of four slots."""

FAILURES = 4
"""Steps that fail in a row before a fit is given up."""

SHORTEST_HANDLE, LONGEST_HANDLE = 1 / 30, 4 / 3
"""Lengths between which the end handles of an arc are kept, in chords of their end."""


class Samples(NamedTuple):
    """The stretch of outline that a curve follows.

    Attributes:
        Q: (n, 3) points in order, and their places on the contour; the ends of an arc are the first and the last.
        D: (n,) integral of the wanted vertex density up to each.
        free: (2,) whether the end tangents of an arc may turn. laps: the places around a closed contour.
    """

    Q: FloatArray
    D: FloatArray
    free: IntArray
    laps: float


class Rows(NamedTuple):
    """Points of a curve and their signed distances from the outline: the samples' feet, then others between them.

    Attributes:
        used: (1,) rows in use. span, x: span and local parameter; spans count on around a closed curve.
        e: distance from the curve to the outline, along the normal (nx, ny).
    """

    used: IntArray
    span: IntArray
    x: FloatArray
    e: FloatArray
    nx: FloatArray
    ny: FloatArray


class Fit(NamedTuple):
    """Scratch arrays of a fit, for curves of up to ``room`` spans.

    Attributes:
        curve, trial: the curve so far, and the one tried. rows, tried: of both.
        frames: (room + 1, 4) normal and tangent of each vertex at its footpoint.
        moves: (room, 8, 8) derivatives of the coordinates of each span's Bézier points by the unknowns of its four
            slots: across and along the curve; along, a vertex takes its knot with it.
        gram: (room, 9, 8) equations of each span, J: (8,) of one row.
        A, step: the equations. first: (2 room + 2,) where each row of A begins.
    """

    curve: Curve
    trial: Curve
    rows: Rows
    tried: Rows
    frames: FloatArray
    moves: FloatArray
    gram: FloatArray
    J: FloatArray
    A: FloatArray
    step: FloatArray
    first: IntArray


@compiled(internal=True)
def empty_rows(samples: int) -> Rows:
    """Room for the rows of so many samples."""
    n = (1 + EXTRA) * samples
    return Rows(
        np.zeros(1, dtype=np.int64), np.empty(n, dtype=np.int64), np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    )


@compiled(internal=True)
def measure(samples: Samples, curve: Curve, known: bool, near: float, rows: Rows) -> float:
    """Pair the outline with the curve, in order; the largest distance.

    Each foot is the nearest point after the foot before it, by Newton's method across the spans. Between two feet the
    curve is measured too, in several places where they are far apart on it: from loops, and from humps of short spans,
    no sample is far.

    Args:
        known: ``rows`` has the feet on a similar curve, as first guesses.
        near: the tolerance. rows: receives the feet and distances.
    """
    Q, b, h, k, closed = samples.Q, curve.b, curve.h, curve.size[0], curve.size[1]
    n = len(Q)
    span, x, e, nx, ny = rows.span, rows.x, rows.e, rows.nx, rows.ny
    worst = 0.0
    for j in range(n):
        s, at = (k - 1, 1.0) if j > 0 else (0 * k, 0.0)
        if closed or 0 < j < n - 1:
            s0, at0 = (span[j - 1], x[j - 1]) if j > 0 else (-k, 0.0)
            later = known and (span[j] > s0 or (span[j] == s0 and x[j] > at0))
            s, at = (span[j], x[j]) if later else ((s0, at0) if j > 0 else (0 * k, 0.0))
            end = k if not closed else (span[0] + k + 1 if j > 0 else k)
            s, at = _foot(b, k, s, at, s0, at0, end, Q[j, 0], Q[j, 1])
        cx, cy, dx, dy, _, _ = jet(b, s % k, at)
        ex, ey, speed = Q[j, 0] - cx, Q[j, 1] - cy, max(length(dx, dy), 1e-12)
        span[j], x[j], nx[j], ny[j] = s, at, -dy / speed, dx / speed
        away = length(ex, ey)
        e[j] = away if ex * nx[j] + ey * ny[j] > 0 else -away
        worst = max(worst, away)
    count = n
    for j in range(n if closed else n - 1):
        i = j + 1 if j + 1 < n else 0
        lap = k if i == 0 else 0 * k
        step_x, step_y = Q[i, 0] - Q[j, 0], Q[i, 1] - Q[j, 1]
        chord = length(step_x, step_y)
        own = _distance_along(h, k, span[j], x[j], span[i] + lap, x[i])
        if chord == 0.0 or own <= 0.0:
            continue
        spans = (span[i] + lap + x[i]) - (span[j] + x[j])
        wanted = max(4 * spans, own / (chord + near)) if spans > 0.25 or own > 2 * chord + 2 * near else 0.0
        pieces = min(int(wanted) + 2, EXTRA + 1)
        for r in range(1, pieces):
            s, at = _moved(h, k, span[j], x[j], own * r / pieces)
            cx, cy, _, _, _, _ = jet(b, s % k, at)
            along = min(max(((cx - Q[j, 0]) * step_x + (cy - Q[j, 1]) * step_y) / (chord * chord), 0.0), 1.0)
            ex, ey = Q[j, 0] + along * step_x - cx, Q[j, 1] + along * step_y - cy
            away = length(ex, ey)
            if away > NOTICED * near:
                span[count], x[count], e[count] = s, at, away
                nx[count], ny[count] = ex / away, ey / away
                count += 1
                worst = max(worst, away)
    rows.used[0] = count
    return worst


@compiled(internal=True)
def _foot(
    b: FloatArray, k: int, s: int, at: float, s0: int, at0: float, end: int, qx: float, qy: float
) -> tuple[int, float]:
    """The nearest point to (qx, qy) from span s, parameter ``at``; not before (s0, at0), nor from span ``end`` on."""
    for _ in range(12):
        cx, cy, dx, dy, ax, ay = jet(b, s % k, at)
        speed = dx * dx + dy * dy
        if speed <= 0:
            at = min(at + 0.01, 1.0)
            continue
        slope = (cx - qx) * dx + (cy - qy) * dy
        bend = speed + (cx - qx) * ax + (cy - qy) * ay
        new = newton_step(at, slope, speed, bend, at - 0.5, at + 0.5)
        if new > 1.0:
            if s + 1 < end:
                s, at = s + 1, min(new - 1, 0.5)
                continue
            new = 1.0
        elif new < 0.0:
            if s > s0:
                s, at = s - 1, max(1 + new, 0.5)
                continue
            new = 0.0
        moved = abs(new - at)
        at = new
        if moved < 1e-4:
            break
    if s < s0 or (s == s0 and at < at0):
        s, at = s0, at0
    return s, at


@compiled(internal=True)
def _distance_along(h: FloatArray, k: int, s: int, x: float, t: int, y: float) -> float:
    """Parameter distance from place (s, x) to place (t, y)."""
    total = (y * h[t % k + 2]) - (x * h[s % k + 2])
    for r in range(s, t):
        total += h[r % k + 2]
    return total


@compiled(internal=True)
def _moved(h: FloatArray, k: int, s: int, x: float, distance: float) -> tuple[int, float]:
    """The place at a parameter distance after (s, x)."""
    left = distance + x * h[s % k + 2]
    while left > h[s % k + 2]:
        left -= h[s % k + 2]
        s += 1
    return s, left / h[s % k + 2]


@compiled(internal=True)
def _differentiate(fit: Fit) -> None:
    """The frames of all vertices, and the derivatives of the Bézier points by the unknowns.

    Those by the knots are differences; a knot's influence beyond two spans to either side is small and left out.
    """
    curve, frames, moves = fit.curve, fit.frames, fit.moves
    k, closed, X, h = curve.size[0], curve.size[1], curve.X, curve.h
    first, stop = inner_vertices(curve)
    for i in range(k + 1 - closed):
        if i < first or i >= stop:
            tip, end = (1, 0) if i == 0 else (k + 1, k + 2)
            dx, dy = X[tip, 0] - X[end, 0], X[tip, 1] - X[end, 1]
        else:
            s, at = (i, curve.t[i]) if curve.t[i] >= 0 else ((i - 1) % k, curve.t[i] + 1)
            _, _, dx, dy, _, _ = jet(curve.b, s, at)
        speed = max(length(dx, dy), 1e-12)
        frames[i, 0], frames[i, 1], frames[i, 2], frames[i, 3] = -dy / speed, dx / speed, dx / speed, dy / speed
    for s in range(k):
        for c in range(4):
            i = (s - 1 + c) % k if closed else s - 1 + c
            exists = 0 <= i <= k
            for r in range(4):
                for axis in range(2):
                    moves[s, 2 * r + axis, 2 * c] = curve.W[s, r, c] * frames[i, axis] if exists else 0.0
                    moves[s, 2 * r + axis, 2 * c + 1] = curve.W[s, r, c] * frames[i, 2 + axis] if exists else 0.0
    W = np.empty((4, 4))
    for i in range(first, stop):
        delta = 1e-4 * min(h[i + 1], h[i + 2])
        _shift_knot(curve, i, delta)
        for c in range(4):
            s = (i + 1 - c) % k if closed else i + 1 - c
            if 0 <= s < k:
                span_weights(h, s, W)
                for r in range(4):
                    for axis in range(2):
                        total = W[r, 0] * X[s, axis] + W[r, 1] * X[s + 1, axis]
                        total += W[r, 2] * X[s + 2, axis] + W[r, 3] * X[s + 3, axis]
                        moves[s, 2 * r + axis, 2 * c + 1] += (total - curve.b[s, r, axis]) / delta
        _shift_knot(curve, i, -delta)


@compiled(internal=True)
def _shift_knot(curve: Curve, i: int, delta: float) -> None:
    """Move knot i of the intervals, and of their repetition around a closed curve."""
    k, closed, h = curve.size[0], curve.size[1], curve.h
    for n in range(k + 4):
        s = n - 2
        if closed:
            s %= k
        if s == i:
            h[n] -= delta
        elif s == (i - 1) % k:
            h[n] += delta


@compiled(internal=True)
def _add_row(
    gram: FloatArray, J: FloatArray, moves: FloatArray, B: FloatArray, nx: float, ny: float, e: float, weight: float
) -> None:
    """Ask that B[0] b_0 + ... + B[3] b_3 of a span change by ``e`` along (nx, ny)."""
    for u in range(8):
        J[u] = 0.0
    for r in range(4):
        x, y = B[r] * nx, B[r] * ny
        for u in range(8):
            J[u] += x * moves[2 * r, u] + y * moves[2 * r + 1, u]
    for u in range(8):
        gram[8, u] += weight * e * J[u]
    for u in range(8):
        scaled = weight * J[u]
        for v in range(8):
            gram[u, v] += scaled * J[v]


@compiled(internal=True)
def _add_all(fit: Fit, scale: float, minimax: bool, wobble: float) -> None:
    """The equations of all rows by spans, in units of ``scale``: matrices (8, 8), and right sides in their row 8."""
    curve, rows, gram, J, moves = fit.curve, fit.rows, fit.gram, fit.J, fit.moves
    k = curve.size[0]
    for s in range(k):
        for u in range(9):
            for v in range(8):
                gram[s, u, v] = 0.0
    B = np.empty(4)
    for r in range(rows.used[0]):
        x = rows.x[r]
        y = 1 - x
        B[0], B[1], B[2], B[3] = y * y * y, 3 * y * y * x, 3 * y * x * x, x * x * x
        square = (rows.e[r] / scale) ** 2
        weight = (2 * square + 0.02 if minimax else 1.0) / scale**2
        s = rows.span[r] % k
        _add_row(gram[s], J, moves[s], B, rows.nx[r], rows.ny[r], rows.e[r], weight)
    if wobble > 0.0:
        B[0], B[1], B[2], B[3] = -6.0, 18.0, -18.0, 6.0
        for s in range(k):
            nx, ny = _middle_normal(curve.b[s])
            _add_row(gram[s], J, moves[s], B, nx, ny, -_third(curve.b[s], nx, ny), wobble / curve.h[s + 2] ** 5)


@compiled(internal=True)
def _largest_ratio(curve: Curve, s: int) -> float:
    """Bound on the ratio of intervals s and s - 1."""
    at_end = not curve.size[1] and min(s, curve.size[0] - s) <= 2
    return END_RATIO if at_end else LARGEST_RATIO


@compiled(internal=True)
def _ratio_excess(curve: Curve, s: int) -> float:
    """By how much the logarithm of the ratio of intervals s and s - 1 exceeds what is allowed, with its sign."""
    ratio, allowed = np.log(curve.h[s + 2] / curve.h[s + 1]), np.log(RATIO_ROOM * _largest_ratio(curve, s))
    return ratio - allowed if ratio > allowed else (ratio + allowed if ratio < -allowed else 0.0)


@compiled(internal=True)
def _objective(curve: Curve, rows: Rows, scale: float, minimax: bool, wobble: float) -> float:
    """What a step has to lower: squares (``minimax``: fourth powers) of the distances, ratios and wobble."""
    total = 0.0
    for r in range(rows.used[0]):
        square = (rows.e[r] / scale) ** 2
        total += square * square + 0.02 * square if minimax else square
    first, stop = inner_vertices(curve)
    for s in range(first, stop):
        total += len(rows.e) / (1 + EXTRA) * _ratio_excess(curve, s) ** 2
    if wobble > 0.0:
        total += wobble * third_derivatives(curve)
    return total


@compiled(internal=True)
def third_derivatives(curve: Curve) -> float:
    """The integral of the squared third derivative across the curve: of (dκ/ds)², as knots run by arc length."""
    total = 0.0
    for s in range(curve.size[0]):
        nx, ny = _middle_normal(curve.b[s])
        total += _third(curve.b[s], nx, ny) ** 2 / curve.h[s + 2] ** 5
    return total


@compiled(internal=True)
def _third(b: FloatArray, nx: float, ny: float) -> float:
    """The third derivative of a cubic (4, 2) by its local parameter, along (nx, ny)."""
    x, y = b[3, 0] - b[0, 0] - 3 * (b[2, 0] - b[1, 0]), b[3, 1] - b[0, 1] - 3 * (b[2, 1] - b[1, 1])
    return 6 * (x * nx + y * ny)


@compiled(internal=True)
def _middle_normal(b: FloatArray) -> tuple[float, float]:
    """The unit normal of a cubic (4, 2) at its middle."""
    dx = b[3, 0] - b[0, 0] + b[2, 0] - b[1, 0]
    dy = b[3, 1] - b[0, 1] + b[2, 1] - b[1, 1]
    size = max(length(dx, dy), 1e-12)
    return -dy / size, dx / size


@compiled(internal=True)
def _equations(fit: Fit, samples: Samples, damping: float, start: int, width: int) -> None:
    """The equations of one step of ``width`` slots from ``start`` on: those of the rows, of ratios, and damping."""
    curve, A, g, first = fit.curve, fit.A, fit.step, fit.first
    k, closed = curve.size[0], curve.size[1]
    n = 2 * width
    for r in range(n):
        g[r], first[r] = 0.0, r
        for c in range(0 if closed and r >= n - BAND else max(r - BAND, 0), r + 1):
            A[r, c] = 0.0
    index = np.empty(8, dtype=np.int64)
    for s in range(k):
        for c in range(4):
            place = _place(s - 1 + c, start, width, k, closed)
            index[2 * c], index[2 * c + 1] = 2 * place, 2 * place + 1
        _scatter(fit, index, fit.gram[s], 8)
    _hold_ratios(fit, len(samples.Q), start, width)
    mean = 0.0
    for r in range(n):
        mean += A[r, r] / n
    for r in range(n):
        A[r, r] += damping * mean * (1.0 if r % 2 else 0.01) + 1e-12 * mean
    for i in (0, k):
        if not closed and start <= i < start + width:
            r = 2 * (i - start)
            A[r, r] += damping * mean + (0.0 if samples.free[min(i, 1)] else 1e9 * max(mean, 1.0))


@compiled(internal=True)
def _place(slot: int, start: int, width: int, k: int, closed: int) -> int:
    """Where a slot stands among those that move; negative if it does not."""
    place = (slot - start) % k if closed else slot - start
    return place if 0 <= place < width and (closed or 0 <= slot <= k) else -1


@compiled(internal=True)
def _scatter(fit: Fit, index: IntArray, gram: FloatArray, n: int) -> None:
    """Add equations of n unknowns, the right side in row n of ``gram``, to all; negative indices are left out."""
    A, g, first = fit.A, fit.step, fit.first
    for u in range(n):
        r = index[u]
        if r < 0:
            continue
        g[r] += gram[n, u]
        for v in range(n):
            c = index[v]
            if 0 <= c <= r:
                A[r, c] += gram[u, v]
                first[r] = min(first[r], c)


@compiled(internal=True)
def _hold_ratios(fit: Fit, n: int, start: int, width: int) -> None:
    """Equations that bring ratios of adjacent chords back to what is allowed; ``n`` is their weight."""
    curve = fit.curve
    k, closed, h = curve.size[0], curve.size[1], curve.h
    first, stop = inner_vertices(curve)
    index, gram = np.empty(3, dtype=np.int64), np.empty((4, 3))
    for s in range(first, stop):
        excess = _ratio_excess(curve, s)
        if excess == 0.0:
            continue
        J = (1 / h[s + 1], -1 / h[s + 1] - 1 / h[s + 2], 1 / h[s + 2])
        for c in range(3):
            i = (s - 1 + c) % k if closed else s - 1 + c
            place = _place(i, start, width, k, closed) if first <= i < stop else -1
            index[c], gram[3, c] = 2 * place + 1, -n * J[c] * excess
            for d in range(3):
                gram[c, d] = n * J[c] * J[d]
        _scatter(fit, index, gram, 3)


@compiled(internal=True)
def _advance(fit: Fit, share: float, start: int, width: int) -> bool:
    """The trial: the curve with vertices, knots and control points moved by a share of the step.

    A vertex moves across the curve as the curve does at its footpoint. False if chords vanish.
    """
    curve, trial, step, frames = fit.curve, fit.trial, fit.step, fit.frames
    copy_curve(curve, trial)
    k, closed, X, h = curve.size[0], curve.size[1], trial.X, curve.h
    first, stop = inner_vertices(curve)
    for place in range(width):
        i = (start + place) % k if closed else start + place
        nu, sigma = share * step[2 * place], share * step[2 * place + 1]
        if first <= i < stop:
            most = MOST_SLIDE * min(h[i + 1], h[i + 2])
            sigma = min(max(sigma, -most), most)
        step[2 * place], step[2 * place + 1] = nu, sigma
        for axis in range(2):
            X[i + 1, axis] += nu * frames[i, axis] + sigma * frames[i, 2 + axis]
    for i in range(first, stop):
        s, x = (i, curve.t[i]) if curve.t[i] >= 0 else ((i - 1) % k, curve.t[i] + 1)
        y = 1 - x
        across = sigma = 0.0
        for c in range(4):
            place = _place(s - 1 + c, start, width, k, closed)
            if place < 0:
                continue
            for u in range(2):
                for axis in range(2):
                    m = fit.moves[s, axis::2, 2 * c + u]
                    d = y * y * (y * m[0] + 3 * x * m[1]) + x * x * (3 * y * m[2] + x * m[3])
                    across += step[2 * place + u] * d * frames[i, axis]
        place = _place(i, start, width, k, closed)
        sigma = step[2 * place + 1] if place >= 0 else 0.0
        for axis in range(2):
            trial.p[i, axis] += across * frames[i, axis] + sigma * frames[i, 2 + axis]
    if not set_knots(trial):
        return False
    if not closed:
        _limit_handle(curve.X, X, 0, 1, trial.h[2])
        _limit_handle(curve.X, X, k + 2, k + 1, trial.h[k + 1])
    return True


@compiled(internal=True)
def _limit_handle(old: FloatArray, X: FloatArray, end: int, tip: int, chord: float) -> None:
    """Keep an end handle on its old side, and its length within bounds."""
    ax, ay = old[tip, 0] - old[end, 0], old[tip, 1] - old[end, 1]
    bx, by = X[tip, 0] - X[end, 0], X[tip, 1] - X[end, 1]
    size, new = length(ax, ay), length(bx, by)
    if ax * bx + ay * by <= 0.1 * size * new:
        bx, by, new, size = ax, ay, size, size / 2
    else:
        size = new
    size = min(max(size, SHORTEST_HANDLE * chord), LONGEST_HANDLE * chord)
    X[tip, 0], X[tip, 1] = X[end, 0] + bx / new * size, X[end, 1] + by / new * size


@compiled(internal=True)
def is_graded(curve: Curve) -> bool:
    """Whether all adjacent chords are within the largest ratio of each other."""
    first, stop = inner_vertices(curve)
    good = True
    for s in range(first, stop):
        a, b, most = curve.h[s + 1], curve.h[s + 2], _largest_ratio(curve, s)
        good = good and a <= most * b and b <= most * a
    return good


@compiled(internal=True)
def improve(
    fit: Fit, samples: Samples, near: float, margin: float, residual: float, rounds: int, start: int, width: int,
    wobble: float,
) -> float:  # fmt: skip
    """Move some slots of ``fit.curve`` until all rows are within ``near`` of the outline on a cold run of variant 2.

    Args:
        near: the tolerance. margin, residual: of the interpolation. rounds: most steps.
        start, width: the slots that move. wobble: weight of :func:`third_derivatives`.

    Returns:
        The largest distance of a cold run that passed; else the least one seen, of a warm run.
    """
    curve, trial = fit.curve, fit.trial
    error = measure(samples, curve, False, near, fit.rows)
    damping, failures = DAMPING, 0
    for n in range(rounds + 1):
        if error <= near and is_graded(curve):
            copy_curve(curve, trial)
            if interpolate_cold(trial, margin, residual) < residual:
                cold = measure(samples, trial, False, near, fit.tried)
                if cold <= near:
                    copy_curve(trial, curve)
                    return cold
                copy_curve(trial, curve)
                error = measure(samples, curve, False, near, fit.rows)
        if n == rounds:
            break
        minimax = n >= 2
        _differentiate(fit)
        _add_all(fit, error, minimax, wobble)
        old = _objective(curve, fit.rows, error, minimax, wobble)
        while True:
            _equations(fit, samples, damping, start, width)
            solve(fit.A, fit.step, fit.first, 2 * width)
            better = False
            if _advance(fit, 0.5 if minimax else 1.0, start, width):
                iterate(trial, WARM * near, WARM_PASSES)
                copy_rows(fit.rows, fit.tried)
                new = measure(samples, trial, True, near, fit.tried)
                better = _objective(trial, fit.tried, error, minimax, wobble) < old
            if better:
                break
            failures += 1
            damping *= 10
            if failures >= FAILURES:
                return max(error, np.nextafter(near, np.inf))
        failures, damping = 0, damping / 4
        copy_curve(trial, curve)
        copy_rows(fit.tried, fit.rows)
        error = new
    return max(error, np.nextafter(near, np.inf))


@compiled(internal=True)
def copy_rows(source: Rows, target: Rows) -> None:
    """Copy the rows in use."""
    target.used[0] = source.used[0]
    for r in range(source.used[0]):
        target.span[r], target.x[r], target.e[r] = source.span[r], source.x[r], source.e[r]
        target.nx[r], target.ny[r] = source.nx[r], source.ny[r]
