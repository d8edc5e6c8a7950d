"""Fairing within the tolerance: vertices leave the outline so that curvature rises and falls less often.

Control points move along the curve's normals at their footpoints, which is how variant 2 moves them: from the places
that the footpoints move to, it finds the same curve again but for small terms of second order. What is minimized is the
total variation of curvature, each change as a share of the curvature there, by Newton steps of reweighted least
squares; a logarithmic barrier keeps samples of the curve near the outline. Each of several masters is faired alone.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet
from ...curves.fairness import TURN, curvatures, extrema_of
from ...curves.nearest import near_place
from ...types import BoolArray, FloatArray, IntArray
from ..measures import CORNER, extrema_floor
from .canonical_contours import CanonicalContours, in_master

SAMPLES = 3
"""Samples of curvature and distance in a span."""

STEPS = 6
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
def floors(contours: CanonicalContours, which: IntArray) -> tuple[IntArray, FloatArray]:
    """(k, K) the fewest extrema of curvature of C2 curves near contours in each master, see
    :class:`..results.Measures`; and their lengths."""
    K = len(contours.cubics) // len(contours.turns)
    found, lengths = np.empty((len(which), K), dtype=np.int64), np.empty((len(which), K))
    for i in range(len(which)):
        for v in range(K):
            outline, lengths[i, v] = in_master(contours, which[i], v)
            _, found[i, v] = extrema_floor(outline, lengths[i, v])
    return found, lengths


@compiled
def bends(lengths: FloatArray, offsets: IntArray, pieces: FloatArray) -> tuple[IntArray, FloatArray]:
    """(k, K) extrema of curvature of ragged curves, and (n, K) the largest curvature of each span.

    Args:
        lengths: (k, K) of the contours. pieces: (n, K, 4, 2).
    """
    extrema, peaks = np.empty(lengths.shape, dtype=np.int64), np.zeros(pieces.shape[:2])
    for i in range(len(lengths)):
        for v in range(lengths.shape[1]):
            curve = pieces[offsets[i] : offsets[i + 1], v].copy()
            values, where, n = curvatures(curve, lengths[i, v], CORNER)
            extrema[i, v] = extrema_of(values, n, TURN / lengths[i, v])
            for j in range(n):
                span = offsets[i] + min(int(where[j]), len(curve) - 1)
                peaks[span, v] = max(peaks[span, v], abs(values[j]))
    return extrema, peaks


@compiled
def lowered(
    limits: FloatArray, offsets: IntArray, bounds: FloatArray, near: float, peaks: FloatArray, most: FloatArray
) -> FloatArray:
    """Ragged limits (n, K), lower in the spans whose bounds are too large, and in those beside them.

    They are 0, and nothing moves, where a span misses again, or its peak is above that allowed for its contour.

    Args:
        bounds: (n,). peaks: (n, K). most: (k, K) those allowed.
    """
    after = limits.copy()
    for i in range(len(offsets) - 1):
        a, n = offsets[i], offsets[i + 1] - offsets[i]
        for j in range(n):
            for c in range(-1, 2):
                at = a + (j + c) % n
                for v in range(limits.shape[1]):
                    if peaks[a + j, v] > most[i, v] or (bounds[a + j] > near and limits[at, v] < LIMIT * near):
                        after[at, v] = 0.0
                    elif bounds[a + j] > near:
                        after[at, v] = min(after[at, v], CUT * near / bounds[a + j] * limits[at, v])
    return after


@compiled
def faired(
    contours: CanonicalContours, which: IntArray, offsets: IntArray, places: FloatArray, points: FloatArray,
    ends: FloatArray, pieces: FloatArray, knots: FloatArray, parameters: FloatArray, held: BoolArray,
    limits: FloatArray, near: float, some: BoolArray,
) -> FloatArray:  # fmt: skip
    """New vertices (n, 2 K) of the contours that are among ``some``; those of held control points stay.

    Args:
        which: (k,) contours, with ragged vertices: places on the outline, points, ends of spans on it (see
            :class:`.steps.Trial`), Bézier pieces, knots, footpoints' parameters, and whether they are held.
        limits: (n, K) largest distance of samples of each span from the outline; 0 where nothing moves.
        near: the distance allowed, in font units.
    """
    moved = points.copy()
    for i in range(len(which)):
        a, b = offsets[i], offsets[i + 1]
        for v in range(pieces.shape[1] if some[i] else 0):
            own = points[a:b, 2 * v : 2 * v + 2].copy()
            outline, _ = in_master(contours, which[i], v)
            _fair(
                outline, pieces[a:b, v].copy(), knots[a + i : b + i + 1], parameters[a:b], held[a:b],
                ends[a + i : b + i + 1], limits[a:b, v].copy(), near, np.sqrt(pieces.shape[1]), own,
            )  # fmt: skip
            if np.isfinite(own).all():  # or else the curve has no speed somewhere, as where a contour collapses
                moved[a:b, 2 * v : 2 * v + 2] = own
    return moved


@compiled
def _fair(
    outline: FloatArray, pieces: FloatArray, knots: FloatArray, parameters: FloatArray, held: BoolArray,
    ends: FloatArray, limits: FloatArray, near: float, unit: float, points: FloatArray,
) -> None:  # fmt: skip
    """Write the new vertices of one contour in one master; ``unit``: of the knots, about, in font units."""
    n = len(pieces)
    m, length, basis = n * SAMPLES, knots[n] - knots[0], _span_basis(knots)
    spans, local, normals = np.empty(n, dtype=np.int64), np.empty(n), np.zeros((n + 3, 2))
    for i in range(n):
        t = parameters[i] - np.floor((parameters[i] - knots[0]) / length) * length
        j = min(max(np.searchsorted(knots, t, side="right") - 1, 0), n - 1)
        spans[i], local[i] = j, (t - knots[j]) / (knots[j + 1] - knots[j])
        if not held[i] and min(limits[i - 1], limits[i]) > 0:
            _, _, dx, dy, _, _ = jet(pieces, j, local[i])
            speed = np.sqrt(dx * dx + dy * dy)
            normals[i + 1, 0], normals[i + 1, 1] = -dy / speed, dx / speed
    normals[0], normals[n + 1], normals[n + 2] = normals[n], normals[1], normals[2]  # row c of span j is j + c
    order, unknowns = _order(normals)
    # Spans that move, and those whose first sample is compared with the last one of a span that does.
    moving = np.empty(n, dtype=np.bool_)
    for j in range(n):
        moving[j] = np.abs(normals[j : j + 4]).max() > 0
    # Each sample's derivatives, those of these by the four control points, and the same of its distance.
    jets, first, second = np.empty((m, 4)), np.empty((m, 4, 2)), np.empty((m, 4, 2))
    away, most, slopes, point = np.empty(m), np.empty(m), np.empty((m, 4)), np.empty((1, 1, 2))
    for j in range(n):
        for k in range(SAMPLES if moving[j] else 1):
            s, x = j * SAMPLES + k, k / SAMPLES
            px, py, dx, dy, bx, by = jet(pieces, j, x)
            jets[s, 0], jets[s, 1], jets[s, 2], jets[s, 3] = dx, dy, bx, by
            ex = ey = 0.0
            if moving[j]:
                point[0, 0, 0], point[0, 0, 1] = px, py
                away[s], ex, ey = _distance(outline, point, j, x, ends, near, dx, dy)
                most[s] = max(limits[j], 1.02 * abs(away[s]) + 1e-9 * near)
            for c in range(4):
                value, slope, bend = _cubic(basis, j, c, x)
                nx, ny = normals[j + c, 0], normals[j + c, 1]
                first[s, c, 0], first[s, c, 1] = slope * nx, slope * ny
                second[s, c, 0], second[s, c, 1] = bend * nx, bend * ny
                slopes[s, c] = value * (nx * ex + ny * ey)
    moves, delta, steps, weight = np.zeros(n + 3), np.zeros(n + 3), np.zeros(m), BARRIER
    for _ in range(STEPS):
        band, right = _equations(
            jets, first, second, away, most, slopes, moving, order, unknowns, FLAT * unit / length, near, weight
        )
        _solve(band, right)
        for c in range(n + 3):
            delta[c] = right[order[c]] if order[c] >= 0 else 0.0
        share = 1.0
        for s in range(m):
            j = s // SAMPLES
            if not moving[j]:
                continue
            steps[s] = 0.0
            for c in range(4):
                steps[s] += slopes[s, c] * delta[j + c]
            room = most[s] - away[s] if steps[s] > 0 else most[s] + away[s]
            if abs(steps[s]) * share > 0.9 * room:
                share = 0.9 * room / abs(steps[s])
        for c in range(n + 3):
            delta[c] *= share
            moves[c] += delta[c]
        for s in range(m):
            j = s // SAMPLES
            for c in range(4 if moving[j] or s % SAMPLES == 0 else 0):
                d = delta[j + c]
                jets[s, 0] += d * first[s, c, 0]
                jets[s, 1] += d * first[s, c, 1]
                jets[s, 2] += d * second[s, c, 0]
                jets[s, 3] += d * second[s, c, 1]
            away[s] += share * steps[s]
        weight *= WEAKER
    for i in range(n):
        if not held[i]:
            j = spans[i]
            points[i, 0], points[i, 1], _, _, _, _ = jet(pieces, j, local[i])
            for c in range(4):
                value, _, _ = _cubic(basis, j, c, local[i])
                points[i, 0] += value * moves[j + c] * normals[j + c, 0]
                points[i, 1] += value * moves[j + c] * normals[j + c, 1]


@compiled
def _distance(
    outline: FloatArray, point: FloatArray, j: int, x: float, ends: FloatArray, near: float, dx: float, dy: float
) -> tuple[float, float, float]:
    """Signed distance from the outline of a point (1, 1, 2) on span j, at x, and the direction in which it grows."""
    place = ends[j]
    if x > 0:
        place = near_place(1, outline, (1 - x) * ends[j] + x * ends[j + 1], ends[j], ends[j + 1], point, 0)
    s = int(np.floor(place))
    qx, qy, _, _, _, _ = jet(outline, s % len(outline), place - s)
    ex, ey, speed = point[0, 0, 0] - qx, point[0, 0, 1] - qy, np.sqrt(dx * dx + dy * dy)
    nx, ny, d = -dy / speed, dx / speed, np.sqrt(ex * ex + ey * ey)
    if place == s and d > 0.02 * near:  # a corner may be the nearest
        sign = 1.0 if ex * nx + ey * ny >= 0 else -1.0
        nx, ny = sign * ex / d, sign * ey / d
    return ex * nx + ey * ny, nx, ny


@compiled
def _equations(
    jets: FloatArray, first: FloatArray, second: FloatArray, away: FloatArray, most: FloatArray, slopes: FloatArray,
    moving: BoolArray, order: IntArray, unknowns: int, flat: float, near: float, weight: float,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """The matrix of a Newton step, its upper band for :func:`_solve`, and the right side."""
    m = len(jets)
    n = m // SAMPLES
    kappa, by = np.empty(m), np.empty((m, 4))
    for s in range(m):
        if not moving[s // SAMPLES] and s % SAMPLES > 0:
            continue
        dx, dy, ax, ay = jets[s, 0], jets[s, 1], jets[s, 2], jets[s, 3]
        inverse = 1.0 / (dx * dx + dy * dy)
        cube = inverse * np.sqrt(inverse)
        kappa[s] = (dx * ay - dy * ax) * cube
        whole = 3 * kappa[s] * inverse
        p, q = ay * cube - whole * dx, -ax * cube - whole * dy
        for c in range(4):
            by[s, c] = p * first[s, c, 0] + q * first[s, c, 1] + (dx * second[s, c, 1] - dy * second[s, c, 0]) * cube
    cyclic, right = np.zeros((n + 4, 5)), np.zeros(n + 4)  # row i of control point i - 1, and entries to the right
    row = np.empty(5)
    for j in range(n):
        for k in range(SAMPLES if moving[j] else 0):
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
            unit = 1.0 / most[s]
            z = away[s] * unit
            inside = 1 / (1 - z * z)
            slope, bend = 2 * weight * z * inside * unit, 2 * weight * (1 + z * z) * (inside * unit) ** 2
            for a in range(4):
                right[j + a] -= slope * slopes[s, a]
                for b in range(a, 4):
                    cyclic[j + a, b - a] += bend * slopes[s, a] * slopes[s, b]
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
def _cubic(basis: FloatArray, j: int, c: int, x: float) -> tuple[float, float, float]:
    """Value, first and second derivative of a basis function on span j."""
    y, a, b, d, e = 1 - x, basis[j, c, 0], basis[j, c, 1], basis[j, c, 2], basis[j, c, 3]
    value = y * y * (y * a + 3 * x * b) + x * x * (3 * y * d + x * e)
    slope = 3 * (y * y * (b - a) + 2 * x * y * (d - b) + x * x * (e - d))
    return value, slope, 6 * (y * (d - 2 * b + a) + x * (e - 2 * d + b))


@compiled
def _span_basis(knots: FloatArray) -> FloatArray:
    """(n, 4, 4) Bézier coefficients on span j of the basis functions of control points j - 1 to j + 2."""
    n = len(knots) - 1
    basis = np.zeros((n, 4, 4))
    for j in range(n):
        e = knots[j + 1] - knots[j]
        d, k = knots[(j - 1) % n + 1] - knots[(j - 1) % n], knots[(j + 1) % n + 1] - knots[(j + 1) % n]
        f, g = knots[(j - 2) % n + 1] - knots[(j - 2) % n], knots[(j + 2) % n + 1] - knots[(j + 2) % n]
        whole, b = d + e + k, basis[j]
        b[1, 1], b[2, 1], b[1, 2], b[2, 2] = (e + k) / whole, d / whole, k / whole, (d + e) / whole
        s = d / (d + e)
        b[0, 0], b[2, 0] = (1 - s) * e / (f + d + e), s * b[2, 1]
        b[1, 0] = 1 - b[0, 0] - b[2, 0]
        s = e / (e + k)
        b[3, 3], b[1, 3] = s * e / (e + k + g), (1 - s) * b[1, 2]
        b[2, 3] = 1 - b[3, 3] - b[1, 3]
    return basis
