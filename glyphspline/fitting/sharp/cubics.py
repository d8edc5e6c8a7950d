"""Single cubics fitted to samples of an outline, and straight stretches of it."""

from __future__ import annotations

import numpy as np

from ...compiled import compiled, inlined
from ...curves.cubics import length, newton_step
from ...types import FloatArray, IntArray
from .corners import Joints
from .spline_curve import chord

SLIDE = 0.001
"""Weight of motion along the curve against motion across it: enough to keep the equations regular."""

HOPELESS = (1e3, 6.0, 2.0, 1.4, 1.2)
"""A fit is abandoned after round m if its error exceeds entry m, in tolerances. Lower values lose good fits."""


@compiled
def fit_cubic(
    Q: FloatArray, directions: FloatArray, free: tuple[bool, bool], tolerance: float, rounds: int, tangents: FloatArray
) -> float:
    """Fit one cubic to samples of an outline.

    Args:
        Q: (n, 2) samples in order, the ends being the arc's.
        directions: (2, 2) unit tangents at the ends, kept as directions unless these are free.
        tolerance: stop as soon as every sample is nearer than this.
        rounds: most Gauss-Newton steps.
        tangents: (2, 2) receives the end tangents of the best fit, derivatives by chord length.

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
    handles, third = np.empty((2, 2)), min(reach / chord, 3.0) / 3
    for end in range(2):
        for axis in range(2):
            handles[end, axis] = directions[end, axis] * third
    samples, c, A, g, first = Q[None], np.empty((3, 2)), np.empty((4, 4)), np.empty(4), np.zeros(4, dtype=np.int64)
    best = np.inf
    for m in range(rounds):
        for axis in range(2):  # the cubic about its first end: row k of c goes with the power k + 1
            p1, p3 = handles[0, axis] * chord, Q[n - 1, axis] - Q[0, axis]
            p2 = p3 - handles[1, axis] * chord
            c[0, axis], c[1, axis], c[2, axis] = 3 * p1, 3 * (p2 - 2 * p1), p3 - 3 * (p2 - p1)
        error = project(samples, samples, c[None], x, e)
        if error < best:
            best = error
            for end in range(2):
                for axis in range(2):
                    tangents[end, axis] = handles[end, axis] * 3
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
        _step(Q, c, x, weight, directions, free, A, g, first)
        for end in range(2):
            # The last handle runs from the inner point to the end, so it moves the other way.
            h, sign = handles[end], 1 - 2 * end
            x1, y1 = h[0] + sign * g[2 * end] / chord, h[1] + sign * g[2 * end + 1] / chord
            ux, uy, size = limited(h[0], h[1], x1, y1, 1 / 30, 4 / 3)
            if not free[end]:
                ux, uy = directions[end, 0], directions[end, 1]
            h[0], h[1] = ux * size, uy * size
    return best


@inlined
def limited(
    ax: float, ay: float, bx: float, by: float, shortest: float, longest: float
) -> tuple[float, float, float]:  # fmt: skip
    """The unit direction and length of a handle (bx, by) that was (ax, ay): it stays on its old side, and its length
    between two bounds.
    """
    old, new = length(ax, ay), length(bx, by)
    size = new
    if ax * bx + ay * by <= 0.1 * old * new:
        bx, by, new, size = ax, ay, old, old / 2
    return bx / new, by / new, min(max(size, shortest), longest)


@compiled
def project(Q: FloatArray, P: FloatArray, c: FloatArray, x: FloatArray, e: FloatArray) -> float:
    """Pair the inner samples with points of a cubic, in order, from the feet x on; the largest distance.

    In several masters these are at one place, which is the nearest in all of them together.

    Args:
        Q: (K, n, 2) samples in each master. P: (K, _, 2) begins where the cubic does. c: (K, 3, 2) its coefficients
            about there; row k goes with the power k + 1.
        x, e: (n,) places, and largest distances: in several masters those across the cubic.
    """
    K, n, worst, low = len(c), Q.shape[1], 0.0, 0.0
    for j in range(1, n - 1):
        t = max(x[j], low)
        for _ in range(4):  # Newton steps from the foot of the last round
            slope = speed = bend = 0.0
            for v in range(K):
                ax, bx, cx, ay, by, cy = c[v, 0, 0], c[v, 1, 0], c[v, 2, 0], c[v, 0, 1], c[v, 1, 1], c[v, 2, 1]
                px = ((cx * t + bx) * t + ax) * t - (Q[v, j, 0] - P[v, 0, 0])
                py = ((cy * t + by) * t + ay) * t - (Q[v, j, 1] - P[v, 0, 1])
                dx, dy = (3 * cx * t + 2 * bx) * t + ax, (3 * cy * t + 2 * by) * t + ay
                own = dx * dx + dy * dy
                slope, speed = slope + (px * dx + py * dy), speed + own
                bend = bend + own + px * (6 * cx * t + 2 * bx) + py * (6 * cy * t + 2 * by)
            if speed <= 0:
                break
            new = newton_step(t, slope, speed, bend, low, 1.0)
            move = abs(new - t)
            t = new
            if move < 1e-3:
                break
        low, x[j], e[j] = t, t, 0.0
        for v in range(K):
            ax, bx, cx, ay, by, cy = c[v, 0, 0], c[v, 1, 0], c[v, 2, 0], c[v, 0, 1], c[v, 1, 1], c[v, 2, 1]
            px = ((cx * t + bx) * t + ax) * t - (Q[v, j, 0] - P[v, 0, 0])
            py = ((cy * t + by) * t + ay) * t - (Q[v, j, 1] - P[v, 0, 1])
            away = length(px, py)
            if K > 1:
                dx, dy = (3 * cx * t + 2 * bx) * t + ax, (3 * cy * t + 2 * by) * t + ay
                size = length(dx, dy)
                away = abs(px * dy - py * dx) / size if size > 0.0 else away
            e[j] = max(e[j], away)
        worst = max(worst, e[j])
    return worst


@compiled
def _step(
    Q: FloatArray, c: FloatArray, x: FloatArray, weight: FloatArray, directions: FloatArray, free: tuple[bool, bool],
    A: FloatArray, g: FloatArray, first: IntArray,
) -> None:  # fmt: skip
    """One Gauss-Newton step on the distances along the normals: the moves of both inner points, into g."""
    for r in range(4):
        g[r] = A[r, 0] = A[r, 1] = A[r, 2] = A[r, 3] = 0.0
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
        if not free[end]:  # penalise motion across the direction
            r, dx, dy = 2 * end, directions[end, 0], directions[end, 1]
            A[r, r] += huge * dy * dy
            A[r + 1, r] -= huge * dx * dy
            A[r + 1, r + 1] += huge * dx * dx
    solve(A, g, first, 4)


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


@compiled
def is_straight(samples: FloatArray, a: int, b: int, tolerance: float) -> bool:
    """Whether samples a to b run along their chord, in order, within the tolerance in every master."""
    for v in range(len(samples)):
        Q = samples[v]
        x, y = Q[b, 0] - Q[a, 0], Q[b, 1] - Q[a, 1]
        size = np.hypot(x, y)
        if size <= tolerance:
            return False
        x, y = x / size, y / size
        reached = 0.0
        for j in range(a + 1, b):
            dx, dy = Q[j, 0] - Q[a, 0], Q[j, 1] - Q[a, 1]
            along, across = dx * x + dy * y, abs(dy * x - dx * y)
            if across > tolerance or along < reached - tolerance or along > size + tolerance:
                return False
            reached = max(reached, along)
    return True


@compiled
def fit_between(joints: Joints, i: int, j: int, tolerance: float, rounds: int, tangents: FloatArray) -> float:
    """A cubic from joint i to joint j, in each master by itself; tangents at corners are free to turn.

    Args:
        tolerance, rounds: see :func:`fit_cubic`. tangents: (K, 2, 2) receives the end tangents.

    Returns:
        The largest distance of a sample; infinite if there is no cubic.
    """
    a, b, masters, worst = joints.first[i], joints.first[j], len(tangents), 0.0
    directions, free = np.empty((2, 2)), (joints.corner[i], joints.corner[j])
    whole = chord(joints.samples, a, b)
    for v in range(masters):
        Q = joints.samples[v, a : b + 1]
        for axis in range(2):
            directions[0, axis], directions[1, axis] = joints.leaving[v, i, axis], joints.arriving[v, j, axis]
        worst = max(worst, fit_cubic(Q, directions, free, tolerance, rounds, tangents[v]))
        if worst == np.inf:
            break
        if masters > 1:
            own = length(Q[b - a, 0] - Q[0, 0], Q[b - a, 1] - Q[0, 1])
            for end in range(2):
                for axis in range(2):
                    tangents[v, end, axis] *= own / whole
    return worst
