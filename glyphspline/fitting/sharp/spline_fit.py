"""Fitting one arc of k spans to a stretch of outline: vertices and end tangents that bring variant 2 nearest to it.

The vertices need not lie on the outline. Each round interpolates (variant 2), compares the curve with samples of the
outline, and moves vertices and end tangents by one Gauss-Newton step on the distances along the normals. Weights that
grow with the error turn the least squares towards the least maximum.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet, length, newton_step
from ...types import FloatArray, IntArray
from .clamped_arc import solve_arc

SLIDE = 0.001
"""Weight of motion along the curve against motion across it: enough to keep the equations regular."""

HOPELESS = (1e3, 6.0, 2.0, 1.4, 1.2)
"""Errors, in tolerances, at which a fit is given up after so many rounds. Smaller ones lose fits that would succeed."""

BAND = 8
"""Neighbouring control points are at most 3 apart, so unknowns at most 7."""


@compiled(internal=True)
def project(
    Q: FloatArray, n: int, b: FloatArray, k: int, known: bool, span: IntArray, x: FloatArray, e: FloatArray
) -> float:  # fmt: skip
    """Pair samples Q[:n] of the outline with points of the curve, in order; the largest distance.

    ``span``, ``x`` receive where on the curve, ``e`` the distances. The ends are paired with the ends. If
    ``known``, they hold the feet on a curve near this one, to begin from. A foot is the nearest point after the one
    before, by Newton's method over the pieces.
    """
    worst = 0.0
    for j in range(n):
        s, at = (k - 1, 1.0) if j > 0 else (0 * k, 0.0)
        if 0 < j < n - 1:
            s0, at0 = span[j - 1], x[j - 1]
            later = known and (span[j] > s0 or (span[j] == s0 and x[j] > at0))
            s, at = (span[j], x[j]) if later else (s0, at0)
            for _ in range(12):
                cx, cy, dx, dy, ax, ay = jet(b, s, at)
                speed = dx * dx + dy * dy
                slope = (cx - Q[j, 0]) * dx + (cy - Q[j, 1]) * dy
                bend = speed + (cx - Q[j, 0]) * ax + (cy - Q[j, 1]) * ay
                if speed <= 0:
                    at = min(at + 0.01, 1.0)
                    continue
                new = newton_step(at, slope, speed, bend, at - 0.5, at + 0.5)
                if new > 1.0:
                    if s + 1 < k:
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
        cx, cy, _, _, _, _ = jet(b, s, at)
        span[j], x[j] = s, at
        e[j] = length(Q[j, 0] - cx, Q[j, 1] - cy)
        worst = max(worst, e[j])
    return worst


@compiled(internal=True)
def _normal_equations(
    Q: FloatArray,
    n: int,
    weight: FloatArray,
    b: FloatArray,
    M: FloatArray,
    k: int,
    span: IntArray,
    x: FloatArray,
    A: FloatArray,
    rhs: FloatArray,
) -> None:
    """Accumulate A (banded, A[r, c - r + BAND - 1] for c ≤ r) and the right side for steps of all control points."""
    N = np.empty(4)
    for j in range(n):
        s, at = span[j], x[j]
        cx, cy, dx, dy, _, _ = jet(b, s, at)
        speed = length(dx, dy)
        if speed <= 0:
            continue
        tx, ty = dx / speed, dy / speed
        gap = -(Q[j, 0] - cx) * ty + (Q[j, 1] - cy) * tx
        y = 1 - at
        B0, B1, B2, B3 = y * y * y, 3 * y * y * at, 3 * y * at * at, at * at * at
        for c in range(4):
            N[c] = B0 * M[s, 0, c] + B1 * M[s, 1, c] + B2 * M[s, 2, c] + B3 * M[s, 3, c]
        w = weight[j]
        xx, xy, yy = w * ty * ty + SLIDE * tx * tx, (SLIDE - w) * tx * ty, w * tx * tx + SLIDE * ty * ty
        for c in range(4):
            r = 2 * (s + c)
            rhs[r] -= w * gap * N[c] * ty
            rhs[r + 1] += w * gap * N[c] * tx
            for d in range(c + 1):
                both = N[c] * N[d]
                q = 2 * (s + d)
                A[r, q - r + BAND - 1] += both * xx
                A[r + 1, q - r - 1 + BAND - 1] += both * xy
                A[r + 1, q - r + BAND - 1] += both * yy
                if d < c:
                    A[r, q + 1 - r + BAND - 1] += both * xy


@compiled(internal=True)
def solve_banded(A: FloatArray, rhs: FloatArray, size: int) -> None:
    """Cholesky of the banded matrix in place; rhs becomes the solution."""
    for r in range(size):
        for c in range(max(0, r - BAND + 1), r + 1):
            total = A[r, c - r + BAND - 1]
            for m in range(max(0, r - BAND + 1), c):
                total -= A[r, m - r + BAND - 1] * A[c, m - c + BAND - 1]
            if c < r:
                A[r, c - r + BAND - 1] = total / A[c, BAND - 1]
            else:
                A[r, BAND - 1] = np.sqrt(max(total, 1e-12))
    for r in range(size):
        for m in range(max(0, r - BAND + 1), r):
            rhs[r] -= A[r, m - r + BAND - 1] * rhs[m]
        rhs[r] /= A[r, BAND - 1]
    for r in range(size - 1, -1, -1):
        for m in range(r + 1, min(size, r + BAND)):
            rhs[r] -= A[m, r - m + BAND - 1] * rhs[m]
        rhs[r] /= A[r, BAND - 1]


@compiled(internal=True)
def gauss_newton(
    Q: FloatArray,
    n: int,
    weight: FloatArray,
    b: FloatArray,
    M: FloatArray,
    k: int,
    span: IntArray,
    x: FloatArray,
    start: FloatArray,
    end: FloatArray,
    free0: bool,
    free1: bool,
    A: FloatArray,
    rhs: FloatArray,
) -> None:
    """Steps (2 (k + 3),) of all control points into ``rhs``; the ends stay, fixed tangents keep their direction."""
    size = 2 * (k + 3)
    for r in range(size):
        rhs[r] = 0.0
        for c in range(BAND):
            A[r, c] = 0.0
    _normal_equations(Q, n, weight, b, M, k, span, x, A, rhs)
    total = 0.0
    for j in range(n):
        total += weight[j]
    damping = 1e-4 * total / (k + 3)
    for r in range(size):
        A[r, BAND - 1] += damping
    huge = 1e8 * max(total, 1.0)
    for last in range(2):
        r, v, free = (size - 4, end, free1) if last else (2, start, free0)
        corner = size - 2 if last else 0
        A[corner, BAND - 1] += huge
        A[corner + 1, BAND - 1] += huge
        if not free:
            l2 = v[0] * v[0] + v[1] * v[1]
            A[r, BAND - 1] += huge * v[1] * v[1] / l2
            A[r + 1, BAND - 2] -= huge * v[0] * v[1] / l2
            A[r + 1, BAND - 1] += huge * v[0] * v[0] / l2
    solve_banded(A, rhs, size)


@compiled(internal=True)
def place_vertices(Q: FloatArray, D: FloatArray, n: int, k: int, p: FloatArray) -> None:
    """Vertices p[: k + 1] on the outline at equal steps of the density's integral D."""
    j = 0
    for i in range(1, k):
        goal = D[0] + (D[n - 1] - D[0]) * i / k
        while j < n - 2 and D[j + 1] < goal:
            j += 1
        share = (goal - D[j]) / max(D[j + 1] - D[j], 1e-300)
        for axis in range(2):
            p[i, axis] = (1 - share) * Q[j, axis] + share * Q[j + 1, axis]
    for axis in range(2):
        p[0, axis], p[k, axis] = Q[0, axis], Q[n - 1, axis]


@compiled(internal=True)
def respace(
    b: FloatArray, u: FloatArray, k: int, e: FloatArray, span: IntArray, n: int, p: FloatArray, most: float
) -> None:
    """Move inner vertices along the curve so that spans with large errors shrink (error grows like h⁴)."""
    worst = np.empty(k)
    for s in range(k):
        worst[s] = 1e-3 * most
    for j in range(n):
        worst[span[j]] = max(worst[span[j]], e[j])
    mean = 0.0
    for s in range(k):
        mean += np.log(worst[s]) / k
    h = np.empty(k)
    total = 0.0
    for s in range(k):
        h[s] = (u[s + 1] - u[s]) * min(max(np.exp((mean - np.log(worst[s])) / 5), 0.7), 1.4)
        total += h[s]
    scale = u[k] / total
    at, s = 0.0, 0
    for i in range(1, k):
        at += h[i - 1] * scale
        while s < k - 1 and u[s + 1] < at:
            s += 1
        p[i, 0], p[i, 1], _, _, _, _ = jet(b, s, (at - u[s]) / (u[s + 1] - u[s]))


@compiled(internal=True)
def _is_graded(p: FloatArray, k: int, ratio: float) -> bool:
    """Whether adjacent chords stay within a ratio of each other."""
    before = np.hypot(p[1, 0] - p[0, 0], p[1, 1] - p[0, 1])
    for i in range(1, k):
        after = np.hypot(p[i + 1, 0] - p[i, 0], p[i + 1, 1] - p[i, 1])
        if not (after <= ratio * before and before <= ratio * after):
            return False
        before = after
    return True


@compiled(internal=True)
def _advance(
    p: FloatArray,
    k: int,
    u: FloatArray,
    M: FloatArray,
    P: FloatArray,
    t: FloatArray,
    step: FloatArray,
    start: FloatArray,
    end: FloatArray,
) -> None:
    """Move vertices and end tangents by the control points' steps; tangents keep at least a tenth of their length."""
    ax, ay = P[1, 0] + step[2] - p[0, 0], P[1, 1] + step[3] - p[0, 1]
    r = 2 * (k + 1)
    bx, by = p[k, 0] - P[k + 1, 0] - step[r], p[k, 1] - P[k + 1, 1] - step[r + 1]
    for i in range(1, k):
        s = i if t[i] >= 0 else i - 1
        x = t[i] if t[i] >= 0 else t[i] + 1
        y = 1 - x
        for c in range(4):
            N = y * y * (y * M[s, 0, c] + 3 * x * M[s, 1, c]) + x * x * (3 * y * M[s, 2, c] + x * M[s, 3, c])
            p[i, 0] += N * step[2 * (s + c)]
            p[i, 1] += N * step[2 * (s + c) + 1]
    h0 = np.hypot(p[1, 0] - p[0, 0], p[1, 1] - p[0, 1])
    h1 = np.hypot(p[k, 0] - p[k - 1, 0], p[k, 1] - p[k - 1, 1])
    _set_tangent(start, 3 * ax / h0, 3 * ay / h0)
    _set_tangent(end, 3 * bx / h1, 3 * by / h1)


@compiled(internal=True)
def _set_tangent(v: FloatArray, x: float, y: float) -> None:
    """A new end tangent, kept on the old one's side and between 0.1 and 4 in length."""
    old = np.hypot(v[0], v[1])
    new = np.hypot(x, y)
    if x * v[0] + y * v[1] <= 0.1 * old * new:
        factor = max(0.5, 0.1 / old)
        v[0], v[1] = factor * v[0], factor * v[1]
        return
    length = min(max(new, 0.1), 4.0)
    v[0], v[1] = x / new * length, y / new * length


@compiled(internal=True)
def fit_arc(
    Q: FloatArray,
    D: FloatArray,
    k: int,
    d0: FloatArray,
    free0: bool,
    d1: FloatArray,
    free1: bool,
    tolerance: float,
    margin: float,
    residual: float,
    rounds: int,
    p: FloatArray,
    start: FloatArray,
    end: FloatArray,
) -> float:
    """Fit k spans to samples of an outline.

    Args:
        Q: (n, 2) samples in order, the ends being the arc's. D: (n,) integral of the wanted vertex density there.
        k: number of spans, two or more (for one see :mod:`.bezier_fit`).
        d0, d1: (2,) unit tangents at the ends, kept as directions unless free0, free1.
        tolerance: stop as soon as every sample is nearer than this.
        margin, residual: of the interpolation. rounds: most Gauss-Newton steps.
        p, start, end: receive the (k + 1, 2) vertices and the end tangents of the best fit.

    Returns:
        The largest distance of a sample from the best fit; infinite if there is none.
    """
    n = len(Q)
    u, M, P, b, t = np.empty(k + 1), np.empty((k, 4, 4)), np.empty((k + 3, 2)), np.empty((k, 4, 2)), np.empty(k + 1)
    A, step = np.empty((2 * (k + 3), BAND)), np.empty(2 * (k + 3))
    span, x, e, weight = np.empty(n, dtype=np.int64), np.empty(n), np.empty(n), np.empty(n)
    q, v0, v1 = np.empty((k + 1, 2)), np.empty(2), np.empty(2)
    v0[0], v0[1], v1[0], v1[1] = d0[0], d0[1], d1[0], d1[1]
    for j in range(n):
        weight[j] = 1.0
    place_vertices(Q, D, n, k, q)
    best, since = np.inf, 0  # rounds since feet were last forgotten
    for m in range(rounds):
        left = solve_arc(q, k, v0, v1, margin, residual, u, M, P, b, t)
        if not left < 1.0:
            break
        error = project(Q, n, b, k, since > 0, span, x, e)
        since += 1
        if error < best and _is_graded(q, k, 4.0):
            best = error
            for axis in range(2):
                start[axis], end[axis] = v0[axis], v1[axis]
                for i in range(k + 1):
                    p[i, axis] = q[i, axis]
            if best <= tolerance:
                break
        if best > HOPELESS[min(m, len(HOPELESS) - 1)] * tolerance:
            break
        if m in (2, 5):
            respace(b, u, k, e, span, n, q, error)
            since = 0
            if m == 2:
                continue
        if m >= 1:
            total = 0.0
            for j in range(n):
                weight[j] *= 0.1 + e[j] / error
                total += weight[j]
            for j in range(n):
                weight[j] *= n / total
        gauss_newton(Q, n, weight, b, M, k, span, x, v0, v1, free0, free1, A, step)
        _advance(q, k, u, M, P, t, step, v0, v1)
    return best
