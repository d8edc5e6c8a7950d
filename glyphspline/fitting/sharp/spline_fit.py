"""Fitting one arc of k spans to a stretch of outline by variant 2: the unknowns are vertices and end tangents.

The vertices need not lie on the outline. Each round interpolates (variant 2), compares the curve with samples of the
outline, and moves vertices and end tangents by one Gauss-Newton step on the distances along the normals. Weights that
grow with the error turn the least-squares fit into a minimax fit.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet, length, newton_step
from ...types import FloatArray, IntArray
from .clamped_arc import Arc, solve_arc

SLIDE = 0.001
"""Weight of motion along the curve against motion across it: enough to keep the equations regular."""

HOPELESS = (1e3, 6.0, 2.0, 1.4, 1.2)
"""A fit is abandoned after round m if its error exceeds entry m, in tolerances. Lower values lose good fits."""


class Feet(NamedTuple):
    """Where on a curve the samples of the outline have their nearest points: span, local parameter, distance."""

    span: IntArray
    x: FloatArray
    e: FloatArray


@compiled(internal=True)
def project(Q: FloatArray, b: FloatArray, known: bool, feet: Feet) -> float:
    """Pair samples Q of the outline with points of the curve b, in order; the largest distance.

    The ends are paired with the ends. Every other foot is the nearest point after the previous foot, by Newton's method
    across the pieces. If ``known``, ``feet`` holds the feet on a similar curve, as initial guesses; it receives the
    result.
    """
    n, k = len(Q), len(b)
    span, x, e = feet
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
def _normal_equations(Q: FloatArray, weight: FloatArray, arc: Arc, feet: Feet, A: FloatArray, rhs: FloatArray) -> None:
    """Accumulate the lower half of A and the right side for steps of all control points."""
    b, M, span, x = arc.b, arc.M, feet.span, feet.x
    N = np.empty(4)
    for j in range(len(Q)):
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
                A[r, q] += both * xx
                A[r + 1, q] += both * xy
                A[r + 1, q + 1] += both * yy
                if d < c:
                    A[r, q + 1] += both * xy


@compiled(internal=True)
def solve(A: FloatArray, rhs: FloatArray) -> None:
    """Cholesky factor of the lower half of A in place; ``rhs`` becomes the solution."""
    n = len(rhs)
    for r in range(n):
        for c in range(r + 1):
            total = A[r, c]
            for m in range(c):
                total -= A[r, m] * A[c, m]
            A[r, c] = np.sqrt(max(total, 1e-12)) if c == r else total / A[c, c]
        for m in range(r):
            rhs[r] -= A[r, m] * rhs[m]
        rhs[r] /= A[r, r]
    for r in range(n - 1, -1, -1):
        for m in range(r + 1, n):
            rhs[r] -= A[m, r] * rhs[m]
        rhs[r] /= A[r, r]


@compiled(internal=True)
def gauss_newton(
    Q: FloatArray, weight: FloatArray, arc: Arc, feet: Feet, free0: bool, free1: bool, A: FloatArray, rhs: FloatArray
) -> None:
    """Steps (2 (k + 3),) of all control points into ``rhs``; the ends stay, fixed tangents keep their direction."""
    size = len(rhs)
    for r in range(size):
        rhs[r] = 0.0
        for c in range(size):
            A[r, c] = 0.0
    _normal_equations(Q, weight, arc, feet, A, rhs)
    total = 0.0
    for j in range(len(Q)):
        total += weight[j]
    damping = 1e-4 * total / len(arc.P)
    for r in range(size):
        A[r, r] += damping
    huge = 1e8 * max(total, 1.0)
    for last in range(2):
        r, v, free = (size - 4, arc.end, free1) if last else (2, arc.start, free0)
        corner = size - 2 if last else 0
        A[corner, corner] += huge
        A[corner + 1, corner + 1] += huge
        if not free:
            l2 = v[0] * v[0] + v[1] * v[1]
            A[r, r] += huge * v[1] * v[1] / l2
            A[r + 1, r] -= huge * v[0] * v[1] / l2
            A[r + 1, r + 1] += huge * v[0] * v[0] / l2
    solve(A, rhs)


@compiled(internal=True)
def place_vertices(Q: FloatArray, D: FloatArray, p: FloatArray) -> None:
    """Vertices p on the outline at equal steps of the density's integral D."""
    n, k, j = len(Q), len(p) - 1, 0
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
def respace(arc: Arc, feet: Feet, most: float) -> None:
    """Move inner vertices along the curve so that spans with large errors shrink (error grows like h⁴)."""
    u, span, e, k = arc.u, feet.span, feet.e, len(arc.b)
    worst = np.empty(k)
    for s in range(k):
        worst[s] = 1e-3 * most
    for j in range(len(e)):
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
        arc.p[i, 0], arc.p[i, 1], _, _, _, _ = jet(arc.b, s, (at - u[s]) / (u[s + 1] - u[s]))


@compiled(internal=True)
def _is_graded(p: FloatArray, ratio: float) -> bool:
    """Whether adjacent chords stay within a ratio of each other."""
    before = np.hypot(p[1, 0] - p[0, 0], p[1, 1] - p[0, 1])
    for i in range(1, len(p) - 1):
        after = np.hypot(p[i + 1, 0] - p[i, 0], p[i + 1, 1] - p[i, 1])
        if not (after <= ratio * before and before <= ratio * after):
            return False
        before = after
    return True


@compiled(internal=True)
def _advance(arc: Arc, step: FloatArray) -> None:
    """Move vertices and end tangents by the control points' steps; tangents keep at least a tenth of their length."""
    p, P, M, t, k = arc.p, arc.P, arc.M, arc.t, len(arc.b)
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
    _set_tangent(arc.start, 3 * ax / h0, 3 * ay / h0)
    _set_tangent(arc.end, 3 * bx / h1, 3 * by / h1)


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
    Q: FloatArray, D: FloatArray, k: int, d0: FloatArray, free0: bool, d1: FloatArray, free1: bool, tolerance: float,
    margin: float, residual: float, rounds: int, p: FloatArray, tangents: FloatArray,
) -> float:  # fmt: skip
    """Fit k spans to samples of an outline.

    Args:
        Q: (n, 2) samples in order, the ends being the arc's. D: (n,) integral of the wanted vertex density there.
        k: number of spans, two or more (for one see :mod:`.bezier_fit`).
        d0, d1: (2,) unit tangents at the ends, kept as directions unless free0, free1.
        tolerance: stop as soon as every sample is nearer than this.
        margin, residual: of the interpolation. rounds: most Gauss-Newton steps.
        p, tangents: receive the (k + 1, 2) vertices and the (2, 2) end tangents of the best fit.

    Returns:
        The largest distance of a sample from the best fit; infinite if there is none.
    """
    n = len(Q)
    arc = Arc(
        np.empty((k + 1, 2)), d0.copy(), d1.copy(), np.empty(k + 1), np.empty((k + 3, 2)), np.empty((k, 4, 2)),
        np.empty((k, 4, 4)), np.empty(k + 1),
    )  # fmt: skip
    feet, weight = Feet(np.empty(n, dtype=np.int64), np.empty(n), np.empty(n)), np.ones(n)
    A, step = np.empty((2 * (k + 3), 2 * (k + 3))), np.empty(2 * (k + 3))
    place_vertices(Q, D, arc.p)
    best, since = np.inf, 0  # rounds since feet were last forgotten
    for m in range(rounds):
        if not solve_arc(arc, margin, residual) < 1.0:
            break
        error = project(Q, arc.b, since > 0, feet)
        since += 1
        if error < best and _is_graded(arc.p, 4.0):
            best = error
            for axis in range(2):
                tangents[0, axis], tangents[1, axis] = arc.start[axis], arc.end[axis]
                for i in range(k + 1):
                    p[i, axis] = arc.p[i, axis]
            if best <= tolerance:
                break
        if best > HOPELESS[min(m, len(HOPELESS) - 1)] * tolerance:
            break
        if m in (2, 5):
            respace(arc, feet, error)
            since = 0
            if m == 2:
                continue
        if m >= 1:
            total = 0.0
            for j in range(n):
                weight[j] *= 0.1 + feet.e[j] / error
                total += weight[j]
            for j in range(n):
                weight[j] *= n / total
        gauss_newton(Q, weight, arc, feet, free0, free1, A, step)
        _advance(arc, step)
    return best
