"""Fitting one cubic to a stretch of outline: its two inner control points are free."""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import length, newton_step
from ...types import FloatArray, IntArray

SLIDE = 0.001
"""Weight of motion along the curve against motion across it: enough to keep the equations regular."""

HOPELESS = (1e3, 6.0, 2.0, 1.4, 1.2)
"""A fit is abandoned after round m if its error exceeds entry m, in tolerances. Lower values lose good fits."""

STEPS = 4
"""Newton steps to a foot, from the foot of the last round."""

LONGEST, SHORTEST = 4.0, 0.1
"""Lengths between which end tangents are kept, in chords."""


@compiled
def fit_cubic(
    Q: FloatArray, d0: FloatArray, free0: bool, d1: FloatArray, free1: bool, tolerance: float, rounds: int,
    start: FloatArray, end: FloatArray,
) -> float:  # fmt: skip
    """Fit one cubic to samples of an outline.

    Args:
        Q: (n, 2) samples in order, the ends being the arc's.
        d0, d1: (2,) unit tangents at the ends, kept as directions unless free0, free1.
        tolerance: stop as soon as every sample is nearer than this.
        rounds: most Gauss-Newton steps.
        start, end: receive the end tangents of the best fit, derivatives by chord length.

    Returns:
        The largest distance of a sample from the best fit; infinite if there is none.
    """
    n = len(Q)
    chord = length(Q[n - 1, 0] - Q[0, 0], Q[n - 1, 1] - Q[0, 1])
    if chord == 0:
        return np.inf
    x, e, weight = np.empty(n), np.empty(n), np.ones(n)
    x[0] = 0.0
    for j in range(1, n):
        x[j] = x[j - 1] + length(Q[j, 0] - Q[j - 1, 0], Q[j, 1] - Q[j - 1, 1])
    reach = x[n - 1]
    for j in range(n):
        x[j] /= reach
    # Handles in chords: the first inner point less the first end, the last end less the last inner point.
    handles, third = np.empty(4), min(reach / chord, 3.0) / 3
    for axis in range(2):
        handles[axis], handles[2 + axis] = d0[axis] * third, d1[axis] * third
    c, A, g, first = np.empty((3, 2)), np.empty((4, 4)), np.empty(4), np.zeros(4, dtype=np.int64)
    best = np.inf
    for m in range(rounds):
        _coefficients(Q, handles, chord, c)
        error = _project(Q, c, x, e)
        if error < best:
            best = error
            for axis in range(2):
                start[axis], end[axis] = handles[axis] * 3, handles[2 + axis] * 3
        if best <= tolerance or best > HOPELESS[min(m, len(HOPELESS) - 1)] * tolerance or m == rounds - 1:
            break
        if m >= 1:
            # Weights grow with the error, their mean staying 1: least squares turn towards the least maximum.
            total = 0.0
            for j in range(1, n - 1):
                weight[j] *= 0.1 + e[j] / error
                total += weight[j]
            for j in range(1, n - 1):
                weight[j] *= (n - 2) / total
        _step(Q, c, x, weight, d0, free0, d1, free1, chord, handles, A, g, first)
    return best


@compiled
def _coefficients(Q: FloatArray, handles: FloatArray, chord: float, c: FloatArray) -> None:
    """The cubic by powers of its parameter, about its first end: row k goes with the power k + 1."""
    last = len(Q) - 1
    for axis in range(2):
        p3 = Q[last, axis] - Q[0, axis]
        p1, p2 = handles[axis] * chord, p3 - handles[2 + axis] * chord
        c[0, axis], c[1, axis], c[2, axis] = 3 * p1, 3 * (p2 - 2 * p1), p3 - 3 * (p2 - p1)


@compiled
def _project(Q: FloatArray, c: FloatArray, x: FloatArray, e: FloatArray) -> float:
    """Pair the inner samples with points of the cubic, in order, from the feet x on; the largest distance."""
    ax, bx, cx = c[0, 0], c[1, 0], c[2, 0]
    ay, by, cy = c[0, 1], c[1, 1], c[2, 1]
    worst, low = 0.0, 0.0
    for j in range(1, len(Q) - 1):
        qx, qy = Q[j, 0] - Q[0, 0], Q[j, 1] - Q[0, 1]
        t = max(x[j], low)
        for _ in range(STEPS):
            px, py = ((cx * t + bx) * t + ax) * t - qx, ((cy * t + by) * t + ay) * t - qy
            dx, dy = (3 * cx * t + 2 * bx) * t + ax, (3 * cy * t + 2 * by) * t + ay
            speed = dx * dx + dy * dy
            if speed <= 0:
                break
            bend = speed + px * (6 * cx * t + 2 * bx) + py * (6 * cy * t + 2 * by)
            new = newton_step(t, px * dx + py * dy, speed, bend, low, 1.0)
            move = abs(new - t)
            t = new
            if move < 1e-3:
                break
        low = x[j] = t
        e[j] = length(((cx * t + bx) * t + ax) * t - qx, ((cy * t + by) * t + ay) * t - qy)
        worst = max(worst, e[j])
    return worst


@compiled
def _step(
    Q: FloatArray, c: FloatArray, x: FloatArray, weight: FloatArray,
    d0: FloatArray, free0: bool, d1: FloatArray, free1: bool, chord: float, handles: FloatArray,
    A: FloatArray, g: FloatArray, first: IntArray,
) -> None:  # fmt: skip
    """One Gauss-Newton step of both handles on the distances along the normals; the unknowns are both inner points."""
    for r in range(4):
        g[r] = 0.0
        for s in range(4):
            A[r, s] = 0.0
    total = 0.0
    for j in range(1, len(Q) - 1):
        t, w = x[j], weight[j]
        y = 1 - t
        dx, dy = (3 * c[2, 0] * t + 2 * c[1, 0]) * t + c[0, 0], (3 * c[2, 1] * t + 2 * c[1, 1]) * t + c[0, 1]
        speed = length(dx, dy)
        if speed <= 0:
            continue
        tx, ty = dx / speed, dy / speed
        px = ((c[2, 0] * t + c[1, 0]) * t + c[0, 0]) * t + Q[0, 0]
        py = ((c[2, 1] * t + c[1, 1]) * t + c[0, 1]) * t + Q[0, 1]
        gap = w * ((Q[j, 1] - py) * tx - (Q[j, 0] - px) * ty)
        xx, xy, yy = w * ty * ty + SLIDE * tx * tx, (SLIDE - w) * tx * ty, w * tx * tx + SLIDE * ty * ty
        n1, n2 = 3 * y * y * t, 3 * y * t * t
        g[0] -= n1 * gap * ty
        g[1] += n1 * gap * tx
        g[2] -= n2 * gap * ty
        g[3] += n2 * gap * tx
        A[0, 0] += n1 * n1 * xx
        A[1, 0] += n1 * n1 * xy
        A[1, 1] += n1 * n1 * yy
        A[2, 0] += n1 * n2 * xx
        A[2, 1] += n1 * n2 * xy
        A[3, 1] += n1 * n2 * yy
        A[2, 2] += n2 * n2 * xx
        A[3, 2] += n2 * n2 * xy
        A[3, 3] += n2 * n2 * yy
        total += w
    A[3, 0] = A[2, 1]
    for r in range(4):
        A[r, r] += 2.5e-5 * total
    huge = 1e8 * max(total, 1.0)
    for end in range(2):
        if not (free1 if end else free0):
            r, d = 2 * end, d1 if end else d0  # penalise motion across the direction
            A[r, r] += huge * d[1] * d[1]
            A[r + 1, r] -= huge * d[0] * d[1]
            A[r + 1, r + 1] += huge * d[0] * d[0]
    solve(A, g, first, 4)
    for end in range(2):
        # The last handle runs from the inner point to the end, so it moves the other way.
        r, sign, direction, free = (2, -1.0, d1, free1) if end else (0, 1.0, d0, free0)
        _set_handle(handles[r : r + 2], sign * g[r] / chord, sign * g[r + 1] / chord, direction, free)


@compiled
def _set_handle(handle: FloatArray, x: float, y: float, direction: FloatArray, free: bool) -> None:
    """Move a handle by (x, y); it stays on its old side, and its tangent between SHORTEST and LONGEST."""
    old = length(handle[0], handle[1])
    x, y = handle[0] + x, handle[1] + y
    new = length(x, y)
    size = min(max(new, SHORTEST / 3), LONGEST / 3)
    if x * handle[0] + y * handle[1] <= 0.1 * old * new:
        x, y, new, size = handle[0], handle[1], old, max(old / 2, SHORTEST / 3)
    elif not free:
        x, y, new = direction[0], direction[1], 1.0
    handle[0], handle[1] = x / new * size, y / new * size


@compiled
def solve(A: FloatArray, rhs: FloatArray, first: IntArray, n: int) -> None:
    """Solve n symmetric, positive definite equations by Cholesky's method; ``rhs`` becomes the solution.

    Only the lower half of A counts, and of row r only the columns from ``first[r]`` on: a band, and around a closed
    curve a border.
    """
    for r in range(n):
        for c in range(first[r], r + 1):
            total = A[r, c]
            for m in range(max(first[r], first[c]), c):
                total -= A[r, m] * A[c, m]
            A[r, c] = np.sqrt(max(total, 1e-12)) if c == r else total / A[c, c]
        for m in range(first[r], r):
            rhs[r] -= A[r, m] * rhs[m]
        rhs[r] /= A[r, r]
    for r in range(n - 1, -1, -1):
        rhs[r] /= A[r, r]
        for m in range(first[r], r):
            rhs[m] -= A[r, m] * rhs[r]
