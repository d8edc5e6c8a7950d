"""Fairing within the tolerance: vertices leave the outline so that curvature rises and falls less often.

Control points move along the curve's normals at their footpoints, which is how variant 2 moves them: from the places
that the footpoints move to, it finds the same curve again but for small terms of second order. What is minimized is the
total variation of curvature, each change as a share of the curvature there, by Newton steps of reweighted least
squares; a logarithmic barrier keeps samples of the curve near the outline. Each of several masters is faired alone.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet, nearest
from ...curves.fairness import SHARE, TURN, curvatures, extrema_of, swings
from ...curves.nearest import near_place
from ...types import BoolArray, FloatArray, IntArray
from ..measures import CORNER, extrema_floor
from .canonical_contours import CanonicalContours, in_master
from .spacing import spans_after
from .steps import Trial

SAMPLES, POINTS = 4, 2
"""Samples of curvature in a span, from its first end; and of distance, among these."""

STEPS = 6
"""Newton steps at most; there are fewer where the samples have lost all extrema that need not be. With four, a tenth
more of these is left in 200 glyphs of Noto Serif CJK."""

SMALL = 0.3
"""Share of the curvature up to which its changes are squared; larger ones cost their size. With less, steps stall."""

FLAT = 10 * TURN
"""Over the length of the contour, the curvature below which changes count as if it were this."""

STRAIGHT = 0.1 * TURN
"""Over the length of the contour, the curvature up to which a span is straight."""

BARRIER, WEAKER = 0.2, 0.5
"""The barrier's first weight, and its share from step to step."""

LIMIT, CUT = 0.85, 0.7
"""Share of the distance allowed that samples keep to at first, as they are few: with 0.9, a quarter of the contours is
faired again instead of a sixth. Share of what a span that then fails should have had."""

TRIES = 5
"""How often contours are faired before they stay as they were: each time nearer to the outline where they failed."""

PEAK = 1.2
"""Largest factor by which the largest curvature may grow."""

BAND, CLOSED_BAND = 3, 6
"""Diagonals of the equations beside the first: a span has four control points. With the rows of a closed curve folded,
neighbours are twice as far apart."""


@compiled
def bends(
    contours: CanonicalContours, trial: Trial, pieces: FloatArray, keep: BoolArray, mark: bool
) -> tuple[IntArray, IntArray, FloatArray, BoolArray]:
    """How often the curves of a trial bend, and where more often than they have to.

    Args:
        pieces: (n, K, 4, 2). keep: (k,) the contours that count. mark: whether to look for the spans.

    Returns:
        (k, K) extrema of curvature, and how many of them need not be (see :class:`..results.Measures`); (n, K) the
        largest curvature of each span; and (n, K) the spans to be faired: those that bend, between corners where they
        need not so often, of contours with more extrema than needed.
    """
    offsets, K = trial.offsets, pieces.shape[1]
    extrema, surplus = np.zeros((2, len(keep), K), dtype=np.int64)
    peaks, uneven = np.zeros((len(pieces), K)), np.zeros((len(pieces), K), dtype=np.bool_)
    for i in np.flatnonzero(keep):
        a, b = offsets[i], offsets[i + 1]
        for v in range(K):
            outline, length = in_master(contours, trial.which[i], v)
            values, where, n = curvatures(pieces[a:b, v].copy(), length, CORNER)
            extrema[i, v] = extrema_of(values, n, TURN / length)
            for j in range(n):
                span = a + min(int(where[j]), b - a - 1)
                peaks[span, v] = max(peaks[span, v], abs(values[j]))
            if mark:
                _, fewest, given, corners = extrema_floor(outline, length)
                surplus[i, v] = max(extrema[i, v] - fewest, 0)
                if surplus[i, v] > 0:
                    _mark(given, corners, values[:n], where[:n], trial.places[a:b], TURN / length, uneven[a:b, v])
                for j in range(a, b):
                    uneven[j, v] = uneven[j, v] and peaks[j, v] > STRAIGHT / length
    return extrema, surplus, peaks, uneven


@compiled
def _mark(
    given: FloatArray, corners: FloatArray, values: FloatArray, where: FloatArray, places: FloatArray, least: float,
    uneven: BoolArray,
) -> None:  # fmt: skip
    """Mark the spans between two corners where the curve bends more often than it has to; all if there are none.

    Args:
        given: curvatures of the outline, infinite at corners; corners: the places of all. values, where: the same of
            the curve. places: (n,) of its vertices. least: see :func:`..curves.fairness.extrema_of`.
    """
    n, at = len(values), np.flatnonzero(np.isinf(given))
    count = len(at)
    vertices, tops = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    found = np.empty(n + 2, dtype=np.int64)
    for k in range(count):
        j = np.searchsorted(places, corners[at[k]]) % len(places)
        first = np.searchsorted(where, j - 0.5) if j > 0 else np.searchsorted(where, len(places) - 0.5) - n
        vertices[k], tops[k] = j, first
        for i in range(first, np.searchsorted(where, j + 0.5, side="right")):
            if values[i % n] * given[at[k]] > values[tops[k] % n] * given[at[k]]:
                tops[k] = i
    for k in range(count):
        after, lap = (k + 1) % count, k + 1 == count
        need = 2 if given[at[k]] == given[at[after]] else 1
        if swings(values, n, tops[k], tops[after] + lap * n + 1, 1.0, SHARE, least, found) > need:
            for j in range(-1, spans_after(vertices, k, len(places)) + 1):
                uneven[(vertices[k] + j) % len(places)] = True
    if not uneven.any():
        uneven[:] = True


@compiled
def lowered(
    limits: FloatArray, offsets: IntArray, bounds: FloatArray, near: float, peaks: FloatArray, most: FloatArray
) -> BoolArray:
    """Lower ragged limits (n, K) in the spans whose bounds are too large, and in those beside them.

    They are 0, and nothing moves, where a span misses again, or its peak is above that allowed for its contour.

    Args:
        limits: they change. bounds: (n,). peaks: (n, K). most: (k, K) those allowed.

    Returns:
        (n, K) the spans to be faired again: those from which and up to which nothing moves, around one that is lower.
    """
    before, again = limits.copy(), np.zeros(limits.shape, dtype=np.bool_)
    for i in range(len(offsets) - 1):
        a, n = offsets[i], offsets[i + 1] - offsets[i]
        for v in range(limits.shape[1]):
            for j in range(n):
                reach = 1 if before[a + j, v] > 0 else 4  # what does not move itself is moved from farther away
                for c in range(-reach, reach + 1):
                    at, share = a + (j + c) % n, 1.0
                    if peaks[a + j, v] > most[i, v] or (bounds[a + j] > near and before[at, v] < LIMIT * near):
                        share = 0.0
                    elif bounds[a + j] > near:
                        share = CUT * near / bounds[a + j]
                    limits[at, v] = min(limits[at, v], share * before[at, v])
            for j in range(n):
                again[a + j, v] = limits[a + j, v] < before[a + j, v]
            for j in range(2 * n if again[a : a + n, v].any() else 0):  # round in both directions
                for at, beside in ((j % n, (j - 1) % n), (-j % n, (1 - j) % n)):
                    again[a + at, v] |= before[a + at, v] > 0 and again[a + beside, v]
    return again


@compiled
def fair(
    contours: CanonicalContours, trial: Trial, controls: FloatArray, knots: FloatArray, parameters: FloatArray,
    held: BoolArray, surplus: IntArray, limits: FloatArray, again: BoolArray, near: float, moved: FloatArray,
) -> None:  # fmt: skip
    """Write the new vertices of the curves of a trial; those of held control points stay.

    Args:
        controls: (n, 2 K). knots, parameters: of the splines, and of footpoints. held: (n,) vertices whose control
            points are held. surplus: (k, K) extrema beyond those that a contour has to have.
        limits: (n, K) largest distance of samples of each span from the outline; 0 where nothing moves.
        again: (n, K) the spans to be faired. near: the distance allowed, in font units.
        moved: (n, 2 K), which change beside these spans.
    """
    offsets, K = trial.offsets, limits.shape[1]
    for i in range(len(trial.which)):
        a, b = offsets[i], offsets[i + 1]
        n, own, ends = b - a, knots[a + i : b + i + 1], trial.ends[a + i : b + i + 1]
        intervals = np.empty(n + 4)
        for c in range(n + 4):
            intervals[c] = own[(c - 2) % n + 1] - own[(c - 2) % n]
        for v in range(K):
            if not again[a:b, v].any():
                continue
            outline, _ = in_master(contours, trial.which[i], v)
            P, normals, least = controls[a:b, 2 * v : 2 * v + 2].copy(), np.zeros((n, 2)), np.zeros(n)
            points, moving = moved[a:b, 2 * v : 2 * v + 2].copy(), np.zeros(n, dtype=np.bool_)
            for j in range(n):
                if again[a + j, v]:
                    least[j] = limits[a + j, v]
            for j in range(n):
                if again[a + j, v] or again[a + (j - 1) % n, v]:
                    points[j] = trial.points[a + j, 2 * v : 2 * v + 2]
                if least[j] > 0 and least[j - 1] > 0 and not held[a + j]:
                    _, _, _, dx, dy = _on_spline(P, own, intervals, parameters[a + j])
                    speed = np.sqrt(dx * dx + dy * dy)
                    normals[j, 0], normals[j, 1] = -dy / speed, dx / speed
                    for c in range(-2, 2):
                        moving[(j + c) % n] = True
            if moving.any():
                # A difference of curvature is significant that turns the contour by ``TURN``.
                significant = TURN * np.sqrt(K) / (own[n] - own[0])
                _fair(outline, ends, intervals, least, near, significant, normals, moving, surplus[i, v], P)
            for j in range(n):
                if not held[a + j] and (moving[j] or moving[j - 1]):
                    span, x, y, _, _ = _on_spline(P, own, intervals, parameters[a + j])
                    if moving[span]:
                        points[j, 0], points[j, 1] = x, y
            if np.isfinite(points).all():  # or else the curve has no speed somewhere, as where a contour collapses
                moved[a:b, 2 * v : 2 * v + 2] = points


@compiled
def _fair(
    outline: FloatArray, ends: FloatArray, intervals: FloatArray, limits: FloatArray, near: float, significant: float,
    normals: FloatArray, moving: BoolArray, surplus: int, controls: FloatArray,
) -> None:  # fmt: skip
    """Move control points of a contour in one master, until it has lost its surplus of extrema.

    Args:
        ends, limits: of the n spans. significant: see :func:`..curves.fairness.extrema_of`.
        normals: (n, 2), 0 where a control point stays. moving: (n,) spans of which some move.
        controls: (n, 2), which change.
    """
    n, first, M, unknowns = len(limits), 0, 0, 0
    while first < n and moving[first - 1]:
        first += 1
    # The spans that move, and behind each row of these one more; their four control points; and the rows of these in
    # the equations. Of a contour that moves as a whole, rows are folded, so that all neighbours are near.
    spans, four = np.empty(n, dtype=np.int64), np.empty((n, 4), dtype=np.int64)
    order, width = np.full(n, -1), BAND if first < n else CLOSED_BAND
    runs, run, shares = np.zeros(n, dtype=np.int64), np.zeros(n, dtype=np.int64), np.ones(n)
    for c in range(n):
        j = (first + c) % n
        if moving[j] or moving[j - 1]:
            spans[M] = j
            runs[M] = runs[M - 1] + (not moving[j - 1]) if M > 0 else 0
            for d in range(4):
                four[M, d] = (j + d - 1) % n
                run[four[M, d]] = runs[M]
            M += 1
        if normals[j, 0] != 0 or normals[j, 1] != 0:
            order[j] = unknowns
            unknowns += 1
    for j in range(n if first == n else 0):
        if order[j] >= 0:
            order[j] = 2 * order[j] if 2 * order[j] < unknowns else 2 * (unknowns - 1 - order[j]) + 1
    # Of each sample first and second derivative, in two coordinates, and theirs by the four control points.
    samples, by = np.empty((M * SAMPLES + 1, 4)), np.empty((M * SAMPLES + 1, 4, 4))
    # Of each point in spans that move: signed distance from the outline, that allowed, derivatives by the four control
    # points, and what a step adds.
    rows, of, basis = np.empty((M * POINTS, 7)), np.empty(M * POINTS, dtype=np.int64), np.empty((3, 4))
    point, s, count = np.empty((1, 1, 2)), 0, 0
    for m in range(M):
        at = spans[m]
        for k in range(SAMPLES if moving[at] else 1):
            x = k / SAMPLES
            _basis(intervals, at, x, basis)
            px = py = dx = dy = ax = ay = 0.0
            for c in range(4):
                i = four[m, c]
                x0, y0, nx, ny = controls[i, 0], controls[i, 1], normals[i, 0], normals[i, 1]
                px, py = px + basis[0, c] * x0, py + basis[0, c] * y0
                dx, dy = dx + basis[1, c] * x0, dy + basis[1, c] * y0
                ax, ay = ax + basis[2, c] * x0, ay + basis[2, c] * y0
                by[s, 0, c], by[s, 1, c] = basis[1, c] * nx, basis[1, c] * ny
                by[s, 2, c], by[s, 3, c] = basis[2, c] * nx, basis[2, c] * ny
            samples[s, 0], samples[s, 1], samples[s, 2], samples[s, 3] = dx, dy, ax, ay
            s += 1
            if k % (SAMPLES // POINTS) > 0 or not moving[at]:
                continue
            place = (1 - x) * ends[at] + x * ends[at + 1]
            on = int(np.floor(place))
            if k > 0:
                z = nearest(outline[on % len(outline)], 0.0, 1.0, place - on, px, py)
                place = on + z
                if z in (0.0, 1.0):  # it may lie in another segment
                    point[0, 0, 0], point[0, 0, 1] = px, py
                    place = near_place(1, outline, place, ends[at], ends[at + 1], point, 0)
                    on = int(np.floor(place))
            qx, qy, _, _, _, _ = jet(outline, on % len(outline), place - on)
            px, py, speed = px - qx, py - qy, np.sqrt(dx * dx + dy * dy)
            nx, ny, distance = -dy / speed, dx / speed, np.sqrt(px * px + py * py)
            if place == on and distance > 0.02 * near:  # a corner may be the nearest
                sign = 1.0 if px * nx + py * ny >= 0 else -1.0
                nx, ny = sign * px / distance, sign * py / distance
            row, of[count], count = rows[count], m, count + 1
            row[0] = px * nx + py * ny
            row[1] = max(limits[at], 1.02 * abs(row[0]) + 1e-9 * near)
            for c in range(4):
                row[2 + c] = basis[0, c] * (normals[four[m, c], 0] * nx + normals[four[m, c], 1] * ny)
    total, weight, flat, left = s, BARRIER, FLAT * significant, 0
    kappa, bend, found = np.empty(total + 1), np.empty((total + 1, 4)), np.empty(total + 1, dtype=np.int64)
    band, right = np.empty((unknowns + width, width + 1)), np.empty(unknowns + width)
    block, slope, row, delta = np.empty((4, 4)), np.empty(4), np.empty(4), np.zeros(n)
    for step in range(STEPS):
        for s in range(total):
            dx, dy, ax, ay = samples[s, 0], samples[s, 1], samples[s, 2], samples[s, 3]
            inverse = 1.0 / (dx * dx + dy * dy)
            cube = inverse * np.sqrt(inverse)
            kappa[s] = (dx * ay - dy * ax) * cube
            share = 3 * kappa[s] * inverse
            p, q, dx, dy = ay * cube - share * dx, -ax * cube - share * dy, dx * cube, dy * cube
            for c in range(4):
                bend[s, c] = by[s, 0, c] * p + by[s, 1, c] * q + by[s, 3, c] * dx - by[s, 2, c] * dy
        kappa[total], bend[total] = kappa[0], bend[0]
        extrema = swings(kappa, total, 0, total, 1.0, SHARE, significant, found)
        if step == 0:
            left = extrema - surplus
        elif extrema <= left:
            break
        band[:], right[:] = 0.0, 0.0
        s = count = 0
        for m in range(M):
            if not moving[spans[m]]:
                s += 1
                continue
            block[:], slope[:] = 0.0, 0.0
            for k in range(SAMPLES):
                change, size = kappa[s + 1] - kappa[s], max(max(abs(kappa[s]), abs(kappa[s + 1])), flat)
                w = 1.0 / (size * (abs(change) + SMALL * size))
                if k + 1 < SAMPLES:
                    for c in range(4):
                        row[c] = bend[s + 1, c] - bend[s, c]
                else:  # the next span's first three control points
                    row[0] = -bend[s, 0]
                    for c in range(3):
                        row[c + 1] = bend[s + 1, c] - bend[s, c + 1]
                change *= w
                s += 1
                for a in range(4):
                    slope[a] -= change * row[a]
                    for b in range(a, 4):
                        block[a, b] += w * row[a] * row[b]
            for _ in range(POINTS):
                own, unit = rows[count], 1.0 / rows[count, 1]
                z = own[0] * unit
                inside = 1 / (1 - z * z)
                change, w = 2 * weight * z * inside * unit, 2 * weight * (1 + z * z) * (inside * unit) ** 2
                count += 1
                for a in range(4):
                    slope[a] -= change * own[2 + a]
                    for b in range(a, 4):
                        block[a, b] += w * own[2 + a] * own[2 + b]
            for a in range(4):
                i = order[four[m, a]]
                if i >= 0:
                    right[i] += slope[a]
                    for b in range(a, 4):
                        j = order[four[m, b]]
                        if j >= 0:
                            band[min(i, j), abs(i - j)] += block[a, b]
        for i in range(unknowns):
            band[i, 0] += 1e-9 * band[i, 0] + 1e-3 / (near * near)
        _solve(band, right)
        for j in range(n):
            delta[j] = right[order[j]] if order[j] >= 0 else 0.0
        shares[:] = 1.0
        for i in range(count):
            own, m = rows[i], of[i]
            own[6] = 0.0
            for c in range(4):
                own[6] += own[2 + c] * delta[four[m, c]]
            room = own[1] - own[0] if own[6] > 0 else own[1] + own[0]
            if abs(own[6]) * shares[runs[m]] > 0.9 * room:
                shares[runs[m]] = 0.9 * room / abs(own[6])
        for i in range(count):
            rows[i, 0] += shares[runs[of[i]]] * rows[i, 6]
        s = 0
        for m in range(M):
            share = shares[runs[m]]
            d0, d1, d2, d3 = delta[four[m, 0]], delta[four[m, 1]], delta[four[m, 2]], delta[four[m, 3]]
            for _ in range(SAMPLES if moving[spans[m]] else 1):
                for d in range(4):
                    own = by[s, d]
                    samples[s, d] += share * (own[0] * d0 + own[1] * d1 + own[2] * d2 + own[3] * d3)
                s += 1
        for j in range(n):
            if order[j] >= 0:
                share = shares[run[j]] * delta[j]
                controls[j, 0] += share * normals[j, 0]
                controls[j, 1] += share * normals[j, 1]
        weight *= WEAKER


@compiled
def _solve(band: FloatArray, x: FloatArray) -> None:
    """Solve a positive definite system by elimination, in place; ``band[i, d]`` is its entry (i, i + d).

    Behind the last row there are as many more as there are diagonals beside the first, of zeros.
    """
    width = band.shape[1] - 1
    n = len(x) - width
    for i in range(n):
        row, inverse = band[i], 1.0 / band[i, 0]
        for r in range(1, width + 1):
            share, other = row[r] * inverse, band[i + r]
            if share != 0.0:
                x[i + r] -= share * x[i]
                for c in range(r, width + 1):
                    other[c - r] -= share * row[c]
    for i in range(n - 1, -1, -1):
        row, value = band[i], x[i]
        for r in range(1, width + 1):
            value -= row[r] * x[i + r]
        x[i] = value / row[0]


@compiled
def _on_spline(
    controls: FloatArray, knots: FloatArray, intervals: FloatArray, t: float
) -> tuple[int, float, float, float, float]:
    """The span of a closed spline at a parameter, position there, and first derivative."""
    n, basis, px, py, dx, dy = len(controls), np.empty((3, 4)), 0.0, 0.0, 0.0, 0.0
    t -= np.floor((t - knots[0]) / (knots[n] - knots[0])) * (knots[n] - knots[0])
    j = min(max(int(np.searchsorted(knots, t, side="right")) - 1, 0), n - 1)
    _basis(intervals, j, (t - knots[j]) / (knots[j + 1] - knots[j]), basis)
    for c in range(4):
        x, y = controls[(j + c - 1) % n]
        px, py = px + basis[0, c] * x, py + basis[0, c] * y
        dx, dy = dx + basis[1, c] * x, dy + basis[1, c] * y
    return j, px, py, dx, dy


@compiled
def _basis(intervals: FloatArray, j: int, x: float, out: FloatArray) -> None:
    """Write the basis functions of control points j - 1 to j + 2 of a closed spline on span j, and two derivatives.

    Args:
        intervals: lengths of all spans, from the last but one to the second after the last. x: in [0, 1], where on the
            span. out: (3, 4).
    """
    f, d, e, k, g = intervals[j], intervals[j + 1], intervals[j + 2], intervals[j + 3], intervals[j + 4]
    u, w, y = x * e, e - x * e, 1 - x
    before, after, first, middle, last = 1 / (d + e), 1 / (e + k), 1 / (f + d + e), 1 / (d + e + k), 1 / (e + k + g)
    # Functions of degrees 1 (x and y), 2 (a, b, c) and their derivatives.
    a, c = w * before * y, u * after * x
    b = 1 - a - c
    da, dc = -2 * before * y, 2 * after * x
    db = -da - dc
    out[0, 0], out[0, 3] = w * first * a, u * last * c
    out[0, 1] = (u + d + f) * first * a + (w + k) * middle * b
    out[0, 2] = (u + d) * middle * b + (w + k + g) * last * c
    out[1, 0], out[1, 1] = -3 * first * a, 3 * (first * a - middle * b)
    out[1, 2], out[1, 3] = 3 * (middle * b - last * c), 3 * last * c
    out[2, 0], out[2, 1] = -3 * first * da, 3 * (first * da - middle * db)
    out[2, 2], out[2, 3] = 3 * (middle * db - last * dc), 3 * last * dc
