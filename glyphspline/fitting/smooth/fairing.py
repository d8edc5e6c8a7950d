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

SAMPLES = 3
"""Samples of curvature in a span, from its first end."""

POINTS, MORE, LONG = 2, 4, 2.0
"""Samples of distance in a span, from its first end; and in one longer than this times one beside it."""

STEPS = 5
"""Newton steps."""

SMALL = 0.3
"""Share of the curvature up to which its changes are squared; larger ones cost their size. With less, steps stall."""

FLAT = 10 * TURN
"""Over the length of the contour, the curvature below which changes count as if it were this."""

STRAIGHT = 0.1 * TURN
"""Over the length of the contour, the curvature up to which a span is straight."""

BARRIER, WEAKER = 0.2, 0.5
"""The barrier's first weight, and its share from step to step."""

LIMIT, CUT = 0.9, 0.8
"""Share of the distance allowed that samples keep to at first, as they are few; share of what a span that then fails
should have had."""

TRIES = 5
"""How often contours are faired before they stay as they were: each time nearer to the outline where they failed."""

PEAK = 1.2
"""Largest factor by which the largest curvature may grow."""

FEWEST = 9
"""Vertices of a contour from which the bands of its equations do not overlap."""

BAND = 9
"""Diagonals of the equations, in the order of :func:`_order`."""


@compiled
def bends(
    contours: CanonicalContours, trial: Trial, pieces: FloatArray, keep: BoolArray, mark: bool
) -> tuple[IntArray, FloatArray, BoolArray]:
    """How often the curves of a trial bend, and where more often than they have to.

    Args:
        pieces: (n, K, 4, 2). keep: (k,) the contours that count. mark: whether to look for the spans.

    Returns:
        (k, K) extrema of curvature; (n, K) the largest curvature of each span; and (n, K) the spans to be faired: those
        that bend, between corners where they need not so often, of contours with more extrema than needed (see
        :class:`..results.Measures`).
    """
    offsets, K = trial.offsets, pieces.shape[1]
    extrema = np.zeros((len(keep), K), dtype=np.int64)
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
                if extrema[i, v] > fewest:
                    _mark(given, corners, values[:n], where[:n], trial.places[a:b], TURN / length, uneven[a:b, v])
                for j in range(a, b):
                    uneven[j, v] = uneven[j, v] and peaks[j, v] > STRAIGHT / length
    return extrema, peaks, uneven


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
    held: BoolArray, limits: FloatArray, again: BoolArray, near: float, moved: FloatArray,
) -> None:  # fmt: skip
    """Write the new vertices of the curves of a trial; those of held control points stay.

    Args:
        controls: (n, 2 K). knots, parameters: of the splines, and of footpoints. held: (n,) vertices whose control
            points are held.
        limits: (n, K) largest distance of samples of each span from the outline; 0 where nothing moves.
        again: (n, K) the spans to be faired. near: the distance allowed, in font units.
        moved: (n, 2 K), which change beside these spans.
    """
    which, offsets, points = trial.which, trial.offsets, trial.points
    for i in range(len(which)):
        a, b = offsets[i], offsets[i + 1]
        for v in range(limits.shape[1]):
            own, least = moved[a:b, 2 * v : 2 * v + 2].copy(), limits[a:b, v].copy()
            for j in range(b - a):
                if again[a + j, v] or again[a + (j - 1) % (b - a), v]:
                    own[j, 0], own[j, 1] = points[a + j, 2 * v], points[a + j, 2 * v + 1]
                if not again[a + j, v]:
                    least[j] = 0.0
            if not again[a:b, v].any():
                continue
            outline, _ = in_master(contours, which[i], v)
            P = controls[a:b, 2 * v : 2 * v + 2]
            _fair(
                outline, np.concatenate((P[-1:], P, P[:2])), knots[a + i : b + i + 1], parameters[a:b],
                held[a:b], trial.ends[a + i : b + i + 1], least, near, np.sqrt(limits.shape[1]), own,
            )  # fmt: skip
            if np.isfinite(own).all():  # or else the curve has no speed somewhere, as where a contour collapses
                moved[a:b, 2 * v : 2 * v + 2] = own


@compiled
def _fair(
    outline: FloatArray, controls: FloatArray, knots: FloatArray, parameters: FloatArray, held: BoolArray,
    ends: FloatArray, limits: FloatArray, near: float, unit: float, points: FloatArray,
) -> None:  # fmt: skip
    """Write the new vertices of one contour in one master.

    Args:
        controls: (n + 3, 2) control points, from the last to the second after it; they change, and row j + c is number
            c of span j. unit: of the knots, about, in font units.
    """
    n = len(held)
    length, basis, normals = knots[n] - knots[0], np.zeros((n, 4, 4)), np.zeros((n + 3, 2))
    spans, local, reached = np.empty(n, dtype=np.int64), np.empty(n), np.zeros(n, dtype=np.bool_)
    for j in range(n):
        reached[j] = max(max(limits[j], limits[j - 1]), max(limits[j - 2], limits[(j + 1) % n])) > 0
        if reached[j]:
            _span_basis(knots, j, basis[j])
    for i in range(n):
        if reached[i]:
            t = parameters[i] - np.floor((parameters[i] - knots[0]) / length) * length
            j = min(max(np.searchsorted(knots, t, side="right") - 1, 0), n - 1)
            spans[i], local[i] = j, (t - knots[j]) / (knots[j + 1] - knots[j])
            if not held[i] and limits[i] > 0 and limits[i - 1] > 0:
                _, _, dx, dy = _jet(basis[j], controls, j, local[i])
                speed = np.sqrt(dx * dx + dy * dy)
                normals[i + 1, 0], normals[i + 1, 1] = -dy / speed, dx / speed
    normals[0], normals[n + 1], normals[n + 2] = normals[n], normals[1], normals[2]
    order, unknowns = _order(normals)
    # Samples in each span: of those that move, and the first one of that behind, which is compared with their last.
    # Runs of spans that move are independent of each other.
    moving, samples, runs = np.empty(n, dtype=np.bool_), np.empty(n, dtype=np.int64), np.zeros(n, dtype=np.int64)
    for j in range(n):
        moving[j] = np.abs(normals[j : j + 4]).max() > 0
        runs[j] = runs[j - 1] + (not moving[j]) if j > 0 else 0
    for j in range(n):
        samples[j] = SAMPLES if moving[j] else int(moving[j - 1])
        if runs[j] == runs[n - 1] and moving[n - 1]:  # the last run goes on from the first span
            runs[j] = 0
    # Each sample's first and second derivative by the four control points.
    first, second = np.empty((n * SAMPLES, 4)), np.empty((n * SAMPLES, 4))
    for j in range(n):
        for k in range(samples[j]):
            for c in range(4):
                _, first[j * SAMPLES + k, c], second[j * SAMPLES + k, c] = _cubic(basis[j], c, k / SAMPLES)
    # Points in spans that move: signed distance from the outline, that allowed, derivatives by the four control points,
    # and what a step adds.
    rows, of, count, point = np.empty((n * MORE, 7)), np.empty(n * MORE, dtype=np.int64), 0, np.empty((1, 1, 2))
    for j in range(n):
        before, after = (j - 1) % n, (j + 1) % n
        beside = min(knots[before + 1] - knots[before], knots[after + 1] - knots[after])
        parts = MORE if knots[j + 1] - knots[j] > LONG * beside else POINTS
        for k in range(parts if moving[j] else 0):
            x, row = k / parts, rows[count]
            px, py, dx, dy = _jet(basis[j], controls, j, x)
            place = (1 - x) * ends[j] + x * ends[j + 1]
            s = int(np.floor(place))
            if x > 0:
                z = nearest(outline[s % len(outline)], 0.0, 1.0, place - s, px, py)
                place = s + z
                if z in (0.0, 1.0):  # it may lie in another segment
                    point[0, 0, 0], point[0, 0, 1] = px, py
                    place = near_place(1, outline, place, ends[j], ends[j + 1], point, 0)
                    s = int(np.floor(place))
            qx, qy, _, _, _, _ = jet(outline, s % len(outline), place - s)
            px, py, speed = px - qx, py - qy, np.sqrt(dx * dx + dy * dy)
            nx, ny, d = -dy / speed, dx / speed, np.sqrt(px * px + py * py)
            if place == s and d > 0.02 * near:  # a corner may be the nearest
                sign = 1.0 if px * nx + py * ny >= 0 else -1.0
                nx, ny = sign * px / d, sign * py / d
            row[0], of[count], count = px * nx + py * ny, j, count + 1
            row[1] = max(limits[j], 1.02 * abs(row[0]) + 1e-9 * near)
            for c in range(4):
                value, _, _ = _cubic(basis[j], c, x)
                row[2 + c] = value * (normals[j + c, 0] * nx + normals[j + c, 1] * ny)
    rows, of = rows[:count], of[:count]
    delta, shares, weight = np.zeros(n + 3), np.empty(n + 1), BARRIER
    for _ in range(STEPS):
        band, right = _equations(
            controls, normals, first, second, samples, rows, of, order, unknowns, FLAT * unit / length, near, weight
        )
        _solve(band, right)
        for c in range(n + 3):
            delta[c] = right[order[c]] if order[c] >= 0 else 0.0
        shares[:] = 1.0
        for i in range(count):
            row, j = rows[i], of[i]
            row[6] = row[2] * delta[j] + row[3] * delta[j + 1] + row[4] * delta[j + 2] + row[5] * delta[j + 3]
            room = row[1] - row[0] if row[6] > 0 else row[1] + row[0]
            if abs(row[6]) * shares[runs[j]] > 0.9 * room:
                shares[runs[j]] = 0.9 * room / abs(row[6])
        for i in range(count):
            rows[i, 0] += shares[runs[of[i]]] * rows[i, 6]
        for c in range(n + 3):
            step = shares[runs[(c - 1) % n]] * delta[c]
            controls[c, 0] += step * normals[c, 0]
            controls[c, 1] += step * normals[c, 1]
        weight *= WEAKER
    for i in range(n):
        if not held[i] and np.abs(normals[i : i + 3]).max() > 0:
            points[i, 0], points[i, 1], _, _ = _jet(basis[spans[i]], controls, spans[i], local[i])


@compiled
def _jet(basis: FloatArray, controls: FloatArray, j: int, x: float) -> tuple[float, float, float, float]:
    """Position on span j and first derivative."""
    px = py = dx = dy = 0.0
    for c in range(4):
        value, slope, _ = _cubic(basis, c, x)
        px, py = px + value * controls[j + c, 0], py + value * controls[j + c, 1]
        dx, dy = dx + slope * controls[j + c, 0], dy + slope * controls[j + c, 1]
    return px, py, dx, dy


@compiled
def _equations(
    controls: FloatArray, normals: FloatArray, first: FloatArray, second: FloatArray, samples: IntArray,
    rows: FloatArray, of: IntArray, order: IntArray, unknowns: int, flat: float, near: float, weight: float,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """The matrix of a Newton step, its upper band for :func:`_solve`, and the right side."""
    m, n = len(first), len(samples)
    kappa, by = np.empty(m), np.empty((m, 4))
    for j in range(n):
        for s in range(j * SAMPLES, j * SAMPLES + samples[j]):
            dx = dy = ax = ay = 0.0
            for c in range(4):
                x, y = controls[j + c, 0], controls[j + c, 1]
                dx, dy = dx + first[s, c] * x, dy + first[s, c] * y
                ax, ay = ax + second[s, c] * x, ay + second[s, c] * y
            inverse = 1.0 / (dx * dx + dy * dy)
            cube = inverse * np.sqrt(inverse)
            kappa[s] = (dx * ay - dy * ax) * cube
            whole = 3 * kappa[s] * inverse
            p, q, dx, dy = ay * cube - whole * dx, -ax * cube - whole * dy, dx * cube, dy * cube
            for c in range(4):
                x, y = normals[j + c, 0], normals[j + c, 1]
                by[s, c] = first[s, c] * (p * x + q * y) + second[s, c] * (dx * y - dy * x)
    cyclic, right = np.zeros((n + 4, 5)), np.zeros(n + 4)  # row i of control point i - 1, and entries to the right
    row = np.empty(5)
    for j in range(n):
        for k in range(SAMPLES if samples[j] == SAMPLES else 0):
            s = j * SAMPLES + k
            after = s + 1 if s + 1 < m else 0
            scale = 1.0 / max(max(abs(kappa[s]), abs(kappa[after])), flat)
            change = (kappa[after] - kappa[s]) * scale
            w = 1.0 / (abs(change) + SMALL)
            row[4] = 0.0
            for c in range(4):
                row[c] = -by[s, c] * scale
            for c in range(4):
                row[c + (k == SAMPLES - 1)] += by[after, c] * scale
            for a in range(5):
                right[j + a] -= w * change * row[a]
                for b in range(a, 5):
                    cyclic[j + a, b - a] += w * row[a] * row[b]
    for i in range(len(rows)):
        own, j, unit = rows[i], of[i], 1.0 / rows[i, 1]
        z = own[0] * unit
        inside = 1 / (1 - z * z)
        slope, bend = 2 * weight * z * inside * unit, 2 * weight * (1 + z * z) * (inside * unit) ** 2
        for a in range(4):
            right[j + a] -= slope * own[2 + a]
            for b in range(a, 4):
                cyclic[j + a, b - a] += bend * own[2 + a] * own[2 + b]
    band, folded = np.zeros((unknowns + BAND, BAND + 1)), np.zeros(unknowns + BAND)
    for j in range(n + 4):
        i = order[j]
        if i >= 0:
            folded[i] += right[j]
            for a in range(min(5, n + 4 - j)):
                k = order[j + a]
                if k >= 0:
                    band[min(i, k), abs(i - k)] += cyclic[j, a]
    for i in range(unknowns):
        band[i, 0] += 1e-9 * band[i, 0] + 1e-3 / (near * near)
    return band, folded


@compiled
def _order(normals: FloatArray) -> tuple[IntArray, int]:
    """The row in the equations of each control point, from the last to the third after it, and how many rows there are.

    Those without a normal have none, -1. The cycle of the others is folded, so that all neighbours are near.
    """
    n = len(normals) - 3
    order, count = np.full(n + 4, -1), 0
    for c in range(1, n + 1):
        if normals[c, 0] != 0 or normals[c, 1] != 0:
            order[c] = count
            count += 1
    for c in range(1, n + 1):
        i = order[c]
        if i >= 0:
            order[c] = 2 * i if 2 * i < count else 2 * (count - 1 - i) + 1
    order[0], order[n + 1 :] = order[n], order[1:4]
    return order, count


@compiled
def _solve(band: FloatArray, x: FloatArray) -> None:
    """Solve a positive definite system by elimination, in place; ``band[i, d]`` is its entry (i, i + d).

    Behind the last row there are BAND more, of zeros.
    """
    n = len(x) - BAND
    for i in range(n):
        row, inverse = band[i], 1.0 / band[i, 0]
        for r in range(1, BAND + 1):
            share, other = row[r] * inverse, band[i + r]
            if share != 0.0:
                x[i + r] -= share * x[i]
                for c in range(r, BAND + 1):
                    other[c - r] -= share * row[c]
    for i in range(n - 1, -1, -1):
        row, value = band[i], x[i]
        for r in range(1, BAND + 1):
            value -= row[r] * x[i + r]
        x[i] = value / row[0]


@compiled
def _cubic(basis: FloatArray, c: int, x: float) -> tuple[float, float, float]:
    """Value, first and second derivative of basis function c of a span."""
    y, a, b, d, e = 1 - x, basis[c, 0], basis[c, 1], basis[c, 2], basis[c, 3]
    value = y * y * (y * a + 3 * x * b) + x * x * (3 * y * d + x * e)
    slope = 3 * (y * y * (b - a) + 2 * x * y * (d - b) + x * x * (e - d))
    return value, slope, 6 * (y * (d - 2 * b + a) + x * (e - 2 * d + b))


@compiled
def _span_basis(knots: FloatArray, j: int, b: FloatArray) -> None:
    """Write Bézier coefficients of the basis functions of control points j - 1 to j + 2 on span j, to (4, 4) zeros."""
    n = len(knots) - 1
    e = knots[j + 1] - knots[j]
    d, k = knots[(j - 1) % n + 1] - knots[(j - 1) % n], knots[(j + 1) % n + 1] - knots[(j + 1) % n]
    f, g = knots[(j - 2) % n + 1] - knots[(j - 2) % n], knots[(j + 2) % n + 1] - knots[(j + 2) % n]
    whole = d + e + k
    b[1, 1], b[2, 1], b[1, 2], b[2, 2] = (e + k) / whole, d / whole, k / whole, (d + e) / whole
    s = d / (d + e)
    b[0, 0], b[2, 0] = (1 - s) * e / (f + d + e), s * b[2, 1]
    b[1, 0] = 1 - b[0, 0] - b[2, 0]
    s = e / (e + k)
    b[3, 3], b[1, 3] = s * e / (e + k + g), (1 - s) * b[1, 2]
    b[2, 3] = 1 - b[3, 3] - b[1, 3]
