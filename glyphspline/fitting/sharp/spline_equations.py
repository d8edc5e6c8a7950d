"""The equations of one step of a fit: distances of samples, ratios of chords and wobble, by the moves of vertices.

The vertices need not lie on the outline. Every pass of variant 2 moves a control point along the normal at the
footpoint of its vertex, so in the limit *the vertex is the foot of its control point*: across the curve the two move
together, and along the curve the vertex takes its knot with it. A step has these two unknowns a vertex and two for each
free end tangent. The equations are those of Gauss and Newton, with Levenberg and Marquardt's damping, on the distances
of the samples along the normals. Weights that grow with the distance turn least squares towards the least maximum.

Each master has unknowns and equations of its own. They share the knots: a step along the curve counts as if it were
taken in all masters, each as far as its chords are long.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled, inlined
from ...curves.cubics import jet, length
from ...types import FloatArray, IntArray
from .cubics import solve
from .feet import EXTRA, Rows
from .spline_curve import FREE, TIED, Curve, span_weights, wrapped

LARGEST_RATIO = 4.0
"""Bound on the ratio of adjacent chords: up to 4 Lemma 2 has an interval everywhere."""

BAND = 8
"""Unknowns that meet in one equation: those of four slots."""


class System(NamedTuple):
    """The equations of a step, for a curve of k spans in K masters of which ``width`` slots move.

    Attributes:
        frames: (K, k + 1, 4) normal and tangent of each vertex at its footpoint.
        moves: (K, k, 8, 8) derivatives of the coordinates of each span's Bézier points by the unknowns of its four
            slots: across and along the curve; along, a vertex takes its knot with it.
        gram: (K, k, 9, 8) equations of each span.
        A: the equations of one master. first: (2 width,) where each of its rows begins. step: (K, 2 width).
        place: (k + 3,) which of the slots that move each slot i is, in entry i + 1; -1 if it does not move.
        longer: (K, 2) by how much the handles of tied ends become longer; NaN while that is open.
    """

    frames: FloatArray
    moves: FloatArray
    gram: FloatArray
    A: FloatArray
    step: FloatArray
    first: IntArray
    place: IntArray
    longer: FloatArray


@compiled
def system_of(masters: int, k: int, closed: int, i: int, reach: int) -> System:
    """A system for moving the vertices up to ``reach`` on either side of vertex i."""
    slots, width, start = k + 1 - closed, 2 * reach, 0
    if width >= slots:
        width = slots
    else:
        start = i - reach if closed else min(max(i - reach, 0), slots - width)
    place = np.full(k + 3, -1)
    for n in range(width):
        place[(start + n) % slots + 1] = n
    if closed:
        place[0], place[k + 1], place[k + 2] = place[k], place[1], place[2]
    return System(
        np.empty((masters, k + 1, 4)), np.empty((masters, k, 8, 8)), np.empty((masters, k, 9, 8)),
        np.empty((2 * width, 2 * width)), np.empty((masters, 2 * width)), np.empty(2 * width, dtype=np.int64), place,
        np.full((masters, 2), np.nan),
    )  # fmt: skip


@compiled
def differentiate(curve: Curve, system: System) -> None:
    """The frames of all vertices, and the derivatives of the Bézier points by the unknowns.

    Those by the knots are differences; a knot's influence beyond two spans to either side is small and left out.
    """
    k, closed, h = curve.k, curve.closed, curve.h
    for v in range(len(curve.X)):
        X, frames, moves = curve.X[v], system.frames[v], system.moves[v]
        for i in range(k + 1 - closed):
            if i in (0, k) and not closed:
                tip, end = (1, 0) if i == 0 else (k + 1, k + 2)
                dx, dy = X[tip, 0] - X[end, 0], X[tip, 1] - X[end, 1]
            else:
                s, at = (i, curve.t[i]) if curve.t[i] >= 0 else (wrapped(i - 1, k), curve.t[i] + 1)
                _, _, dx, dy, _, _ = jet(curve.b[v], s, at)
            speed = max(length(dx, dy), 1e-12)
            frames[i, 0], frames[i, 1], frames[i, 2], frames[i, 3] = -dy / speed, dx / speed, dx / speed, dy / speed
        for s in range(k):
            for c in range(4):
                i = wrapped(s - 1 + c, k) if closed else s - 1 + c
                exists = 0 <= i <= k
                for r in range(4):
                    for axis in range(2):
                        moves[s, 2 * r + axis, 2 * c] = curve.W[s, r, c] * frames[i, axis] if exists else 0.0
                        moves[s, 2 * r + axis, 2 * c + 1] = curve.W[s, r, c] * frames[i, 2 + axis] if exists else 0.0
    W, share = np.empty((4, 4)), np.empty(len(curve.X))
    for i in range(1 - closed, k):
        delta = 1e-4 * min(h[i + 1], h[i + 2])
        for v in range(len(share)):
            share[v] = knots_per_step(curve, v, i)
        shift_knot(curve, i, delta)
        for c in range(4):
            s = wrapped(i + 1 - c, k) if closed else i + 1 - c
            if 0 <= s < k:
                span_weights(h, s, W)
                for v in range(len(curve.X)):
                    X, b, moves = curve.X[v], curve.b[v], system.moves[v]
                    for r in range(4):
                        for axis in range(2):
                            total = W[r, 0] * X[s, axis] + W[r, 1] * X[s + 1, axis]
                            total += W[r, 2] * X[s + 2, axis] + W[r, 3] * X[s + 3, axis]
                            moves[s, 2 * r + axis, 2 * c + 1] += share[v] * (total - b[s, r, axis]) / delta
        shift_knot(curve, i, -delta)


@compiled
def knots_per_step(curve: Curve, v: int, i: int) -> float:
    """How far knot i moves with a step of its vertex along the curve in master v, if the other masters do the same.

    It is at most four times as far as the vertex: the chords of a master may vanish.
    """
    if len(curve.p) == 1:
        return 1.0
    p, k = curve.p[v], curve.k
    last, after = i - 1 if i > 0 else k - 1, i + 1 if i + 1 < k or not curve.closed else 0
    own = length(p[i, 0] - p[last, 0], p[i, 1] - p[last, 1]) + length(p[after, 0] - p[i, 0], p[after, 1] - p[i, 1])
    both = curve.h[i + 1] + curve.h[i + 2]
    return both / own if own * 4.0 > both else 4.0


@inlined
def shift_knot(curve: Curve, i: int, delta: float) -> None:
    """Move knot i of the intervals, and of their repetition around a closed curve."""
    k, h = curve.k, curve.h
    h[wrapped(i - 1, k) + 2] += delta
    h[i + 2] -= delta
    for n in range(2 if curve.closed else 0):
        h[n], h[k + 2 + n] = h[k + n], h[2 + n]


@compiled
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
        for v in range(8):  # both halves of the matrix, so that none is copied from the other
            gram[u, v] += scaled * J[v]


@compiled
def add_rows(
    rows: Rows, beziers: FloatArray, h: FloatArray, system: System, scale: float, minimax: bool, wobble: float
) -> None:  # fmt: skip
    """The equations of all rows by spans, in units of ``scale``: matrices (8, 8), and right sides in their row 8."""
    k, B, J = system.gram.shape[1], np.empty(4), np.empty(8)
    for v in range(len(system.gram)):
        gram, moves, b, lever = system.gram[v], system.moves[v], beziers[v], rows.lever[v]
        span, xs, e, nx, ny, slip = rows.span[v], rows.x[v], rows.e[v], rows.nx[v], rows.ny[v], rows.slip[v]
        for s in range(k):
            for u in range(9):
                for w in range(8):
                    gram[s, u, w] = 0.0
        for r in range(rows.used[v, 0]):
            s, x = wrapped(span[r], k), xs[r]
            y = 1 - x
            B[0], B[1], B[2], B[3] = y * y * y, 3 * y * y * x, 3 * y * x * x, x * x * x
            own = e[r] / scale
            weight = (2 * (own * own) + 0.02 if minimax else 1.0) / (scale * scale)
            _add_row(gram[s], J, moves[s], B, nx[r], ny[r], e[r], weight)
            if r < len(slip):
                own, share = lever[r] * slip[r] / scale, lever[r] / scale
                weight = (2 * (own * own) + 0.02 if minimax else 1.0) * (share * share)
                _add_row(gram[s], J, moves[s], B, ny[r], -nx[r], slip[r], weight)
        B[0], B[1], B[2], B[3] = -6.0, 18.0, -18.0, 6.0
        for s in range(k):
            x, y, third, fifth = bending(b[s], h[s + 2])
            _add_row(gram[s], J, moves[s], B, x, y, -third, wobble / fifth)


@inlined
def ratio_excess(curve: Curve, s: int) -> float:
    """By how much the logarithm of the ratio of intervals s and s - 1 exceeds what is allowed, with its sign."""
    # Ratios above this share of the bound are held back. Few of them are, and logarithms take long.
    ratio, allowed = curve.h[s + 2] / curve.h[s + 1], np.log(0.85 * LARGEST_RATIO)
    ratio = np.log(ratio) if ratio > 3.0 or ratio < 1 / 3.0 else 0.0
    return ratio - allowed if ratio > allowed else (ratio + allowed if ratio < -allowed else 0.0)


@compiled
def objective(curve: Curve, rows: Rows, scale: float, minimax: bool, wobble: float) -> float:
    """What a step has to lower: squares (``minimax``: fourth powers) of the distances, ratios of chords and wobble.

    Args:
        scale: unit of the distances. wobble: weight of the integral of (dκ/ds)², as knots run by arc length.
    """
    total = 0.0
    for v in range(len(rows.used)):
        for r in range(rows.used[v, 0]):
            own = rows.e[v, r] / scale
            square = own * own
            total += square * square + 0.02 * square if minimax else square
        for r in range(rows.slip.shape[1]):
            own = rows.lever[v, r] * rows.slip[v, r] / scale
            square = own * own
            total += square * square + 0.02 * square if minimax else square
    for s in range(1 - curve.closed, curve.k):
        excess = ratio_excess(curve, s)
        total += rows.e.size / (1 + EXTRA) * (excess * excess)
    thirds = 0.0  # the integral of the squared third derivative across the curve
    for v in range(len(curve.b)):
        b = curve.b[v]
        for s in range(curve.k):
            _, _, third, fifth = bending(b[s], curve.h[s + 2])
            thirds += third * third / fifth
    return total + wobble * thirds


@inlined
def bending(b: FloatArray, h: float) -> tuple[float, float, float, float]:
    """Of a cubic (4, 2): the unit normal at its middle, the third derivative by its own parameter along that, and the
    fifth power of the knot interval: the product that compiled code makes of ``h ** 5``; Python asks the C library.
    """
    dx, dy = b[3, 0] - b[0, 0] + b[2, 0] - b[1, 0], b[3, 1] - b[0, 1] + b[2, 1] - b[1, 1]
    size = max(length(dx, dy), 1e-12)
    nx, ny = -dy / size, dx / size
    x, y = b[3, 0] - b[0, 0] - 3 * (b[2, 0] - b[1, 0]), b[3, 1] - b[0, 1] - 3 * (b[2, 1] - b[1, 1])
    return nx, ny, 6 * (x * nx + y * ny), h * (h * h * (h * h))


@compiled
def solve_step(
    curve: Curve, system: System, damping: float, weight: int, directions: FloatArray, free: IntArray
) -> None:  # fmt: skip
    """The step in all masters; handles of tied ends get one factor in all of them.

    Args:
        weight: of the ratios of chords. directions, free: see :class:`.feet.Samples`.
    """
    for v in range(len(system.longer)):
        system.longer[v, 0] = system.longer[v, 1] = np.nan
    agreed = tied = True
    while agreed:
        for v in range(len(system.step)):
            equations(curve, system, v, damping, weight, free)
            solve(system.A, system.step[v], system.first, system.step.shape[1])
        agreed = tied and agree_on_handles(curve.k, curve.closed, system, directions, free)
        tied = False


@compiled
def equations(curve: Curve, system: System, v: int, damping: float, weight: int, free: IntArray) -> None:
    """The equations in master v of one step: of the rows, of ratios, damping.

    Ratios of adjacent chords are brought back to what is allowed; their weight is the number of samples.
    """
    A, g, first, place = system.A, system.step[v], system.first, system.place
    k, closed, h, n = curve.k, curve.closed, curve.h, len(system.first)
    for r in range(n):
        g[r], first[r] = 0.0, r
        for c in range(0 if closed and r >= n - BAND else max(r - BAND, 0), r + 1):
            A[r, c] = 0.0
    index = np.empty(8, dtype=np.int64)
    for s in range(k):
        for c in range(4):
            index[2 * c], index[2 * c + 1] = 2 * place[s + c], 2 * place[s + c] + 1
        _scatter(A, g, first, index, system.gram[v, s], 8)
    slope, gram = np.empty(3), np.empty((4, 3))
    for s in range(1 - closed, k):
        excess = ratio_excess(curve, s)
        if excess == 0.0:
            continue
        J = (1 / h[s + 1], -1 / h[s + 1] - 1 / h[s + 2], 1 / h[s + 2])
        for c in range(3):
            i = wrapped(s - 1 + c, k) if closed else s - 1 + c
            at = place[s + c] if closed or 0 < i < k else -1
            index[c] = 2 * at + 1
            slope[c] = J[c] * knots_per_step(curve, v, i) if at >= 0 else J[c]
        for c in range(3):
            gram[3, c] = -weight * slope[c] * excess
            for d in range(3):
                gram[c, d] = weight * slope[c] * slope[d]
        _scatter(A, g, first, index, gram, 3)
    mean = 0.0
    for r in range(n):
        mean += A[r, r] / n
    for r in range(n):
        A[r, r] += damping * mean * (1.0 if r % 2 else 0.01) + 1e-12 * mean
    for end, i in ((0, 0), (1, k)):
        r = 2 * place[i + 1]
        if not closed and r >= 0:
            A[r, r] += damping * mean + (0.0 if free[end] == FREE else 1e9 * max(mean, 1.0))
            if not np.isnan(system.longer[v, end]):
                A[r + 1, r + 1] += 1e6 * max(mean, 1.0)
                g[r + 1] += 1e6 * max(mean, 1.0) * system.longer[v, end]


@compiled
def _scatter(A: FloatArray, g: FloatArray, first: IntArray, index: IntArray, gram: FloatArray, n: int) -> None:
    """Add equations of n unknowns, the right side in row n of ``gram``, to all; negative indices are left out."""
    for u in range(n):
        r = index[u]
        if r < 0:
            continue
        g[r] += gram[n, u]
        for w in range(n):
            c = index[w]
            if 0 <= c <= r:
                A[r, c] += gram[u, w]
                first[r] = min(first[r], c)


@compiled
def agree_on_handles(k: int, closed: int, system: System, directions: FloatArray, free: IntArray) -> bool:
    """Give the handles of tied ends one factor, the mean of what the masters ask for; whether any end is tied."""
    tied = False
    for end, i in ((0, 0), (1, k)):
        r = 2 * system.place[i + 1]
        if closed or free[end] != TIED or r < 0:
            continue
        tied, along, whole = True, 0.0, 0.0
        for v in range(len(system.step)):
            size = length(directions[v, end, 0], directions[v, end, 1])
            along += system.step[v, r + 1] * size
            whole += size * size
        for v in range(len(system.step)):
            size = length(directions[v, end, 0], directions[v, end, 1])
            system.longer[v, end] = along / whole * size
    return tied
