"""Newton steps that fair one contour in one master: see :mod:`.fairing`.

Curvature is sampled in the spans that move, and distance from the outline in some of these samples. Derivatives of both
by the moves of control points are computed once, as the moves are small; curvature itself after each step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled, inlined
from ...curves.cubics import jet
from ...curves.fairness import SHARE, TURN, swings
from ...curves.nearest import near_place
from ...types import BoolArray, FloatArray, IntArray

SAMPLES, POINTS = 4, 2
"""Samples of curvature in a span, from its first end; and of distance, among these."""

STEPS = 6
"""Newton steps at most; there are fewer where the samples have lost all extrema that need not be. With four, a tenth
more of these is left in 200 glyphs of Noto Serif CJK."""


class Moves(NamedTuple):
    """The control points of a contour that move along normals, and the spans that move with them.

    Attributes:
        normals: (n, 2), 0 where a control point stays. moving: (n,) spans of which some move.
        order: (n,) row of each control point's move in the equations, -1 where it stays; unknowns: their number.
        width: diagonals of the equations beside the first.
        spans: (M,) the spans that move, and behind each row of these one more. four: (M, 4) their control points.
        runs: (M,), run: (n,) the row of spans that each of them, and each control point, belongs to.
    """

    normals: FloatArray
    moving: BoolArray
    order: IntArray
    unknowns: int
    width: int
    spans: IntArray
    four: IntArray
    runs: IntArray
    run: IntArray


class Sampled(NamedTuple):
    """Samples of a curve and their derivatives by the moves of the four control points of their spans.

    Attributes:
        jets: (S, 4) first and second derivative, in two coordinates; by: (S, 4, 4) theirs by the moves.
        kappa: (S + 1,) curvature, the first again at the end; bend: (S + 1, 4) its derivatives.
        rows: (R, 7) of each point in spans that move: signed distance from the outline, that allowed, derivatives by
            the moves, and what a step adds. of: (R,) its span, as a row of ``Moves.spans``.
    """

    jets: FloatArray
    by: FloatArray
    kappa: FloatArray
    bend: FloatArray
    rows: FloatArray
    of: IntArray


class Beside(NamedTuple):
    """The outline that a curve of n spans stays near: where on it each span begins, how far a span's samples may be
    from it, and the distance allowed."""

    outline: FloatArray
    ends: FloatArray
    limits: FloatArray
    near: float


@compiled
def move_controls(
    beside: Beside, intervals: FloatArray, significant: float, normals: FloatArray, moving: BoolArray, surplus: int,
    controls: FloatArray,
) -> None:  # fmt: skip
    """Move control points of a contour in one master, until it has lost its surplus of extrema.

    Args:
        intervals: see :func:`_basis`. significant: see :func:`..curves.fairness.extrema_of`.
        normals, moving: see :class:`Moves`. controls: (n, 2), which change.
    """
    moves = _numbered(normals, moving)
    at = _sampled(beside, intervals, moves, controls)
    total, kappa, bend, by, weight, left = len(at.jets), at.kappa, at.bend, at.by, 0.2, 0
    found, delta = np.empty(total + 1, dtype=np.int64), np.zeros(len(beside.limits))
    for step in range(STEPS):
        for s in range(total):  # curvature of all samples and its derivatives by the moves
            dx, dy, ax, ay = at.jets[s, 0], at.jets[s, 1], at.jets[s, 2], at.jets[s, 3]
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
        _newton(moves, at, weight, 10 * TURN * significant, beside.near, delta)
        _advance(moves, at, delta, controls)
        weight *= 0.5  # of the barrier


@compiled
def _numbered(normals: FloatArray, moving: BoolArray) -> Moves:
    """Number the control points that move, from the first span of a row of such on.

    Of a contour that moves as a whole, the rows of the equations are folded, so that all neighbours are near: twice as
    far apart as others. A span has four control points, and so the equations three diagonals beside the first.
    """
    n, first, M, unknowns = len(moving), 0, 0, 0
    while first < n and moving[first - 1]:
        first += 1
    spans, four = np.empty(n, dtype=np.int64), np.empty((n, 4), dtype=np.int64)
    order, runs, run = np.full(n, -1), np.zeros(n, dtype=np.int64), np.zeros(n, dtype=np.int64)
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
    width = 3 if first < n else 6
    return Moves(normals, moving, order, unknowns, width, spans[:M], four[:M], runs[:M], run)


@compiled
def _sampled(beside: Beside, intervals: FloatArray, moves: Moves, controls: FloatArray) -> Sampled:
    """Samples of the spans that move, before any move; arguments as of :func:`move_controls`."""
    (outline, ends, limits, near), M, basis, s, count = beside, len(moves.spans), np.empty((3, 4)), 0, 0
    jets, by = np.empty((M * SAMPLES, 4)), np.empty((M * SAMPLES, 4, 4))
    rows, of, point = np.empty((M * POINTS, 7)), np.empty(M * POINTS, dtype=np.int64), np.empty((1, 1, 2))
    for m in range(M):
        at = moves.spans[m]
        for k in range(SAMPLES if moves.moving[at] else 1):
            x = k / SAMPLES
            _basis(intervals, at, x, basis)
            px = py = dx = dy = ax = ay = 0.0
            for c in range(4):
                i = moves.four[m, c]
                x0, y0, nx, ny = controls[i, 0], controls[i, 1], moves.normals[i, 0], moves.normals[i, 1]
                px, py = px + basis[0, c] * x0, py + basis[0, c] * y0
                dx, dy = dx + basis[1, c] * x0, dy + basis[1, c] * y0
                ax, ay = ax + basis[2, c] * x0, ay + basis[2, c] * y0
                by[s, 0, c], by[s, 1, c] = basis[1, c] * nx, basis[1, c] * ny
                by[s, 2, c], by[s, 3, c] = basis[2, c] * nx, basis[2, c] * ny
            jets[s, 0], jets[s, 1], jets[s, 2], jets[s, 3] = dx, dy, ax, ay
            s += 1
            if k % (SAMPLES // POINTS) > 0 or not moves.moving[at]:
                continue
            place = (1 - x) * ends[at] + x * ends[at + 1]
            if k > 0:
                point[0, 0, 0], point[0, 0, 1] = px, py
                place = near_place(1, outline, place, ends[at], ends[at + 1], point, 0)
            # The direction in which the curve leaves the outline, on its left, and its signed distance from there. At a
            # joint, which may be a corner, the direction is that of the point, if this is far enough to have one.
            on = int(np.floor(place))
            qx, qy, _, _, _, _ = jet(outline, on % len(outline), place - on)
            ex, ey, speed = px - qx, py - qy, np.sqrt(dx * dx + dy * dy)
            nx, ny, distance = -dy / speed, dx / speed, np.sqrt(ex * ex + ey * ey)
            if place == on and distance > 0.02 * near:
                sign = 1.0 if ex * nx + ey * ny >= 0 else -1.0
                nx, ny = sign * ex / distance, sign * ey / distance
            distance = ex * nx + ey * ny
            row, of[count], count = rows[count], m, count + 1
            row[0], row[1] = distance, max(limits[at], 1.02 * abs(distance) + 1e-9 * near)
            for c in range(4):
                normal = moves.normals[moves.four[m, c]]
                row[2 + c] = basis[0, c] * (normal[0] * nx + normal[1] * ny)
    kappa, bend = np.empty(s + 1), np.empty((s + 1, 4))
    return Sampled(jets[:s], by[:s], kappa, bend, rows[:count], of[:count])


@compiled
def _newton(moves: Moves, at: Sampled, weight: float, flat: float, near: float, delta: FloatArray) -> None:
    """The moves of one Newton step, into ``delta`` (n,).

    Args:
        weight: of the barrier. flat: curvature below which changes count as if it were this.
    """
    kappa, bend, order, width, s, count = at.kappa, at.bend, moves.order, moves.width, 0, 0
    band, right = np.zeros((moves.unknowns + width, width + 1)), np.zeros(moves.unknowns + width)
    block, slope, row = np.empty((4, 4)), np.empty(4), np.empty(4)
    for m in range(len(moves.spans)):
        if not moves.moving[moves.spans[m]]:
            s += 1
            continue
        block[:], slope[:] = 0.0, 0.0
        for k in range(SAMPLES):
            change, size = kappa[s + 1] - kappa[s], max(max(abs(kappa[s]), abs(kappa[s + 1])), flat)
            # Changes up to 0.3 of the curvature are squared; larger ones cost their size. With less, steps stall.
            w = 1.0 / (size * (abs(change) + 0.3 * size))
            if k + 1 < SAMPLES:
                for c in range(4):
                    row[c] = bend[s + 1, c] - bend[s, c]
            else:  # the next span's first three control points
                row[0] = -bend[s, 0]
                for c in range(3):
                    row[c + 1] = bend[s + 1, c] - bend[s, c + 1]
            _add_square(row, change * w, w, slope, block)
            s += 1
        for _ in range(POINTS):
            own, unit = at.rows[count], 1.0 / at.rows[count, 1]
            z = own[0] * unit
            inside = 1 / (1 - z * z)
            steep = inside * unit
            change, w = 2 * weight * z * steep, 2 * weight * (1 + z * z) * steep * steep
            _add_square(own[2:], change, w, slope, block)
            count += 1
        for a in range(4):
            i = order[moves.four[m, a]]
            if i >= 0:
                right[i] += slope[a]
                for b in range(a, 4):
                    j = order[moves.four[m, b]]
                    if j >= 0:
                        band[min(i, j), abs(i - j)] += block[a, b]
    for i in range(moves.unknowns):
        band[i, 0] += 1e-9 * band[i, 0] + 1e-3 / (near * near)
    _solve(band, right)
    for j in range(len(delta)):
        delta[j] = right[order[j]] if order[j] >= 0 else 0.0


@inlined
def _add_square(row: FloatArray, first: float, second: float, slope: FloatArray, block: FloatArray) -> None:
    """Add a term of a sum to be minimized, with these derivatives by what ``row`` is the derivative of."""
    for a in range(4):
        slope[a] -= first * row[a]
        for b in range(a, 4):
            block[a, b] += second * row[a] * row[b]


@compiled
def _advance(moves: Moves, at: Sampled, delta: FloatArray, controls: FloatArray) -> None:
    """Move control points, and samples with them, by the largest share of a step that leaves points some room.

    Each row of spans has a share of its own.
    """
    rows, shares, s = at.rows, np.ones(len(controls)), 0
    for i in range(len(rows)):
        own, m = rows[i], at.of[i]
        own[6] = 0.0
        for c in range(4):
            own[6] += own[2 + c] * delta[moves.four[m, c]]
        room = own[1] - own[0] if own[6] > 0 else own[1] + own[0]
        if abs(own[6]) * shares[moves.runs[m]] > 0.9 * room:
            shares[moves.runs[m]] = 0.9 * room / abs(own[6])
    for i in range(len(rows)):
        rows[i, 0] += shares[moves.runs[at.of[i]]] * rows[i, 6]
    for m in range(len(moves.spans)):
        share, four = shares[moves.runs[m]], moves.four[m]
        d0, d1, d2, d3 = delta[four[0]], delta[four[1]], delta[four[2]], delta[four[3]]
        for _ in range(SAMPLES if moves.moving[moves.spans[m]] else 1):
            for d in range(4):
                own = at.by[s, d]
                at.jets[s, d] += share * (own[0] * d0 + own[1] * d1 + own[2] * d2 + own[3] * d3)
            s += 1
    for j in range(len(controls)):
        if moves.order[j] >= 0:
            share = shares[moves.run[j]] * delta[j]
            controls[j, 0] += share * moves.normals[j, 0]
            controls[j, 1] += share * moves.normals[j, 1]


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
def on_spline(
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
