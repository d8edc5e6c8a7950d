"""One pass of Algorithm 2, or of Algorithm 3, on a cubic in R^d: the footpoints of all vertices, and the updates.

About its knot u_i the curve, with p_i as the origin, is q(x) = E + V x + W x² + Z x³, where Z is one of two, for the
spans to the right and to the left. All of it comes from differences of control points, through d_i, the control points
of C', and w_i = C''(u_i)/2:

    d_i = 3 (P_i - P_{i-1}) / (u_{i+1} - u_{i-2})       w_i = (d_{i+1} - d_i) / (u_{i+1} - u_{i-1})
    λ = h_{i-1} / (h_{i-1} + h_i)                       E = P_i - p_i + (λ h_{i-1} d_{i+1} - (1-λ) h_i d_i) / 3
    V = (1-λ) d_i + λ d_{i+1}                           W = w_i
    Z = (w_{i+1} - w_i) / (3 h_i) to the right, likewise to the left

The *main side* is the one on which the distance falls at u_i (or on which the whole interval lies), and y ≥ 0 runs
along it; V is turned with it.

Newton's method with Chebyshev's third-order term goes from the last footpoint to a local minimum y*. The certificate of
:mod:`.footpoint` then has two parts: about y* over the main side, and about u_i over the other side, which shows
D ≥ D(u_i) ≥ D(y*) there. A vertex that fails either is looked at again by itself (:mod:`.search`).

The certificate takes e_1 for 0 at y*. By the rule that ends Newton's method e_1 is at most some 2e-14 Q(y*) L, with L
the length of the side. Each Bernstein coefficient b_j of Q has to exceed a share, ``guard``, of |C'|² and of the
squares of the higher terms. Then Q ≥ b_0 (1 - x/L)⁴ over the first half of the side, and x² Q outgrows e_1 x over the
rest: no point is nearer by more than some 1e-13 of the extent. The guard also covers the rounding errors of the b_j,
some 1e-16 of these squares for each coordinate; where Q(y*) is much larger than they are, so is D, and the same shares
are shares of D.

Vertices are taken ``LANES`` at a time, one stage after another. No value depends on another vertex, nothing branches,
and the rows of a stage are a constant apart: so that a compiler can do with several vertices what is written for one.
Sums over the coordinates have the first two in a register, and the rest in a row, which is 0 in the plane.
:mod:`..plain` has the same stages in NumPy, from the same formulas.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled, inlined
from ...types import FloatArray, Real

LANES, STRIDE = 64, 68
"""Vertices taken together, and the distance of their rows: room for those beside them, and no power of two, with which
rows would share sets of a cache.
"""

WHOLE = 8
"""Stages run over a multiple of this number of vertices, for whole vectors; what lies beyond the last is not used."""

# Rows of a block of numbers: 3 / (u_{i+1} - u_{i-2}), 1 / (u_{i+1} - u_{i-1}) and 1 / (3 h_i), from the vertex before
# the first on; of each vertex λ, λ h_{i-1} / 3 and (1-λ) h_i / 3, the interval relative to the knot, 0 for a control
# point that is held, else 1; the footpoint relative to the knot, the sign of the main side, and what fails.
RATE, HALF, THIRD, SHARE, AHEAD, BEHIND, LOW, HIGH, FREE, X, SIGN, FAILED = (k * STRIDE for k in range(12))
BLOCK = 12 * STRIDE

# Rows of scratch: w and d from the vertex before the first on, in this order, as loads of one vertex further from a row
# below that of the stores would keep a loop from SIMD; of each vertex E·V, the interval on the main side, the length of
# the other side, y, whether it has converged, the squared distance, the share of the error that moves the point.
C, D, EV, NEAR, FAR, OTHER, Y, DONE, SQUARED, MOVE = (k * STRIDE for k in range(10))

# Rows of scratch for sums over the coordinates from the third on, which bear the names of their factors.
SUMS = 10 * STRIDE
QQ, QP, PP, QA, PA_QZ, PZ, AA, AZ, ZZ, VV, EW, EO_VW, VO, WW, WO, OO = (k * STRIDE for k in range(10, 26))
SCRATCH = 26 * STRIDE

# Rows of each coordinate: E, V, W, Z on the main side and on the other one.
E, V, W, Z, O = (k * STRIDE for k in range(5))  # noqa: E741
AXIS = 5 * STRIDE

NEWTON_STEPS = 8
SETTLED_STEP = 1e-6
"""A step this small (share of the side's length) may be the last: third-order convergence leaves its cube."""

LEFT = 1e-14
"""It is the last if it leaves so little: about c² of the step, where c is the share of it that the correction adds.

Near a cusp c is not small until steps are much smaller than above. Gauss and Newton's step has no correction, and may
leave as much as it is itself.
"""

MAIN, ELSE, WILD = 1.0, 2.0, 4.0
"""What fails, added up: the certificate on the main side, that on the other side, and that the curve is finite."""


@compiled
def guard_for(d: int) -> float:
    """The guard of the certificate in R^d."""
    return 1e-13 + 1e-15 * d


@compiled
def at_knot(gap: Real, d0: Real, d1: Real, share: Real, ahead: Real, behind: Real) -> tuple[Real, Real]:
    """A coordinate of E and V, from P_i - p_i, d_i and d_{i+1}; the rest: as rows of a block."""
    return gap + ahead * d1 - behind * d0, d0 + share * (d1 - d0)


@compiled
def along(e: Real, v: Real, w: Real, z: Real, y: Real) -> tuple[Real, Real, Real]:
    """A coordinate of q, q' and q''/2 at y."""
    a = w + 3.0 * y * z
    return e + y * (v + y * (w + y * z)), v + y * (w + a), a


@compiled
def holds(c0: Real, c1: Real, c2: Real, c3: Real, c4: Real, L: Real, guard: Real) -> Real:
    """Whether the Bernstein coefficients of c0 + c1 x + … + c4 x⁴ between 0 and L all exceed a guard."""
    squared = L * L
    k1, k2, k3, k4 = c1 * L, c2 * squared, c3 * (squared * L), c4 * (squared * squared)
    first = (c0 > guard) & (c0 + 0.25 * k1 > guard) & (c0 + 0.5 * k1 + 1 / 6 * k2 > guard)
    return first & (c0 + 0.75 * k1 + 0.5 * k2 + 0.25 * k3 > guard) & (c0 + k1 + k2 + k3 + k4 > guard)


@compiled
def rises(slope: Real, c0: Real, c1: Real, c2: Real, c3: Real, c4: Real, L: Real, guard: Real) -> Real:
    """Whether the last five Bernstein coefficients of slope + x (c0 + … + c4 x⁴) between 0 and L exceed a guard."""
    squared = L * L
    k1, k2, k3, k4 = c1 * L, c2 * squared, c3 * (squared * L), c4 * (squared * squared)
    start = slope - guard
    b2, b3 = c0 + 0.5 * k1 + 1 / 6 * k2, c0 + 0.75 * k1 + 0.5 * k2 + 0.25 * k3
    first = (start + 0.2 * L * c0 > 0.0) & (start + 0.4 * L * (c0 + 0.25 * k1) > 0.0) & (start + 0.6 * L * b2 > 0.0)
    return first & (start + 0.8 * L * b3 > 0.0) & (start + L * (c0 + k1 + k2 + k3 + k4) > 0.0)


@inlined
def clear(rows: FloatArray, size: int, count: int) -> None:
    """Write zeros where stages over ``count`` vertices read, in rows of ``size`` numbers together.

    What lies beyond is not touched: of few vertices all scratch fits in the nearest cache, with much else.
    """
    width = min(count + WHOLE, STRIDE)
    for row in range(0, size, STRIDE):
        for j in range(row, row + width):
            rows[j] = 0.0


@compiled
def set_weights(h: FloatArray, start: int, stop: int, blocks: FloatArray) -> None:
    """Write the weights of the vertices from ``start`` on to their blocks; h[j] is the interval after knot j."""
    for first in range(start, stop, LANES):
        row, count = blocks[(first - start) // LANES * BLOCK :], min(LANES, stop - first)
        clear(row, BLOCK, count)
        for j in range(count + 3):
            i = first - 1 + j
            row[RATE + j] = 3.0 / (h[i - 2] + h[i - 1] + h[i])
        for j in range(count + 2):
            row[HALF + j] = 1.0 / (h[first - 2 + j] + h[first - 1 + j])
        for j in range(count + 1):
            row[THIRD + j] = 1.0 / (3.0 * h[first - 1 + j])
        for j in range(count):
            before, after = h[first - 1 + j], h[first + j]
            share = before * row[HALF + j + 1]
            row[SHARE + j], row[AHEAD + j], row[BEHIND + j] = share, share * before / 3.0, (1.0 - share) * after / 3.0
            row[FREE + j] = 1.0


@compiled
def _expand(P: FloatArray, p: FloatArray, k: int, blocks: FloatArray, S: FloatArray, T: FloatArray, m: int) -> None:
    """E, V, W and Z of the m vertices from k on; their main sides; y."""
    d = P.shape[0]
    for axis in range(d):
        x, q, t = P[axis, k - 2 :], p[axis, k:], T[axis * AXIS :]
        for j in range(m + 3):
            S[D + j] = blocks[RATE + j] * (x[j + 1] - x[j])
        for j in range(m + 2):
            S[C + j] = blocks[HALF + j] * (S[D + j + 1] - S[D + j])
        for j in range(m):
            t[W + j] = S[C + j + 1]
            e, v = at_knot(
                x[j + 2] - q[j], S[D + j + 1], S[D + j + 2], blocks[SHARE + j], blocks[AHEAD + j], blocks[BEHIND + j]
            )
            right = blocks[THIRD + j + 1] * (S[C + j + 2] - S[C + j + 1])
            left = blocks[THIRD + j] * (S[C + j] - S[C + j + 1])  # it runs outwards
            t[E + j], t[V + j], t[Z + j], t[O + j] = e, v, right, left
    for j in range(m):
        S[EV + j] = T[E + j] * T[V + j] + T[AXIS + E + j] * T[AXIS + V + j]
    for axis in range(2, d):
        t = T[axis * AXIS :]
        for j in range(m):
            S[EV + j] += t[E + j] * t[V + j]
    for j in range(m):
        low, high = blocks[LOW + j], blocks[HIGH + j]
        right = (low >= 0.0) | ((high > 0.0) & (S[EV + j] <= 0.0))
        side, near, far = (1.0 if right else -1.0), (low if right else -high), (high if right else -low)
        S[OTHER + j] = -near if near < 0.0 else 0.0
        near = near if near > 0.0 else 0.0
        y = side * blocks[X + j]
        y = y if y > near else near
        blocks[SIGN + j], S[NEAR + j], S[FAR + j], S[Y + j] = side, near, far, (y if y < far else far)
        S[DONE + j] = 1.0 if far <= near else 0.0
    for axis in range(d):
        t = T[axis * AXIS :]
        for j in range(m):
            side, right, left = blocks[SIGN + j], t[Z + j], t[O + j]
            t[V + j] *= side
            t[Z + j], t[O + j] = (right if side > 0.0 else left), (left if side > 0.0 else right)


@compiled
def _sum_at_knots(S: FloatArray, T: FloatArray, d: int, m: int) -> None:
    """Sums over the coordinates from the third on that do not depend on y."""
    for j in range(ZZ, SCRATCH):
        S[j] = 0.0
    for axis in range(2, d):
        t = T[axis * AXIS :]
        for j in range(m):
            e, v, w, z, o = t[E + j], t[V + j], t[W + j], t[Z + j], t[O + j]
            S[ZZ + j] += z * z
            S[VV + j] += v * v
            S[EW + j] += e * w
            S[EO_VW + j] += e * o - v * w
            S[VO + j] += v * o
            S[WW + j] += w * w
            S[WO + j] += w * o
            S[OO + j] += o * o


@compiled
def _sum_along(S: FloatArray, T: FloatArray, d: int, m: int) -> None:
    """Sums over the coordinates from the third on at y."""
    for j in range(QQ, ZZ):
        S[j] = 0.0
    for axis in range(2, d):
        t = T[axis * AXIS :]
        for j in range(m):
            z = t[Z + j]
            q, p, a = along(t[E + j], t[V + j], t[W + j], z, S[Y + j])
            S[QQ + j] += q * q
            S[QP + j] += q * p
            S[PP + j] += p * p
            S[QA + j] += q * a
            S[PA_QZ + j] += p * a + q * z
            S[PZ + j] += p * z
            S[AA + j] += a * a
            S[AZ + j] += a * z


@compiled
def _newton(S: FloatArray, T: FloatArray, d: int, m: int) -> int:
    """One step for every vertex that has not converged, with Chebyshev's term where the distance is convex.

    Returns the number of those that still have not.
    """
    if d > 2:
        _sum_along(S, T, d, m)
    pending = 0
    for j in range(m):
        y, near, far, frozen = S[Y + j], S[NEAR + j], S[FAR + j], S[DONE + j] > 0.0
        zx, zy = T[Z + j], T[AXIS + Z + j]
        qx, px, ax = along(T[E + j], T[V + j], T[W + j], zx, y)
        qy, py, ay = along(T[AXIS + E + j], T[AXIS + V + j], T[AXIS + W + j], zy, y)
        speed = px * px + py * py + S[PP + j]
        bend = speed + 2.0 * (qx * ax + qy * ay + S[QA + j])
        convex = bend > 0.05 * speed
        steep = bend if convex else speed
        inverse = 1.0 / (steep if steep > 0.0 else 1.0)
        plain = (qx * px + qy * py + S[QP + j]) * inverse
        correction = 3.0 * ((px * ax + qx * zx) + (py * ay + qy * zy) + S[PA_QZ + j]) * inverse * plain
        correction = correction if correction < 0.5 else 0.5
        correction = correction if correction > -0.5 else -0.5
        left = correction * correction if convex else 1.0
        new = y - (plain + plain * (correction if convex else 0.0))
        new = new if new > near else near
        new = new if new < far else far
        moved, length = abs(new - y), far - near
        settled = frozen | ((moved <= SETTLED_STEP * length) & (left * moved <= LEFT * length))
        S[Y + j] = y if frozen else new
        S[DONE + j] = 1.0 if settled else 0.0
        pending += 0 if settled else 1
    return pending


@compiled
def _certify(blocks: FloatArray, S: FloatArray, T: FloatArray, d: int, m: int, guard: float) -> None:
    """Write footpoints, squared distances, what fails, and the shares of the errors by which control points move."""
    if d > 2:
        _sum_along(S, T, d, m)
        _sum_at_knots(S, T, d, m)
    for j in range(m):
        y, near, far, zx, zy = S[Y + j], S[NEAR + j], S[FAR + j], T[Z + j], T[AXIS + Z + j]
        qx, px, ax = along(T[E + j], T[V + j], T[W + j], zx, y)
        qy, py, ay = along(T[AXIS + E + j], T[AXIS + V + j], T[AXIS + W + j], zy, y)
        pp, aa, c4 = px * px + py * py + S[PP + j], ax * ax + ay * ay + S[AA + j], zx * zx + zy * zy + S[ZZ + j]
        c0 = 2.0 * (qx * ax + qy * ay + S[QA + j]) + pp
        c1 = 2.0 * ((px * ax + qx * zx) + (py * ay + qy * zy) + S[PA_QZ + j])
        c2, c3 = 2.0 * (px * zx + py * zy + S[PZ + j]) + aa, 2.0 * (ax * zx + ay * zy + S[AZ + j])
        length = far - near
        squared, D = length * length, qx * qx + qy * qy + S[QQ + j]
        least = guard * (pp + squared * (aa + squared * c4))
        found = holds(c0, c1, c2, c3, c4, far - y, least) & holds(c0, c1, c2, c3, c4, near - y, least)
        fine = (S[DONE + j] > 0.0) & (found | (length <= 0.0))
        S[SQUARED + j] = D
        blocks[X + j] = blocks[SIGN + j] * y
        blocks[FAILED + j] = (0.0 if fine else MAIN) + (0.0 if np.inf > D else WILD)
    for j in range(m):
        L, slope = S[OTHER + j], -2.0 * blocks[SIGN + j] * S[EV + j]
        ex, vx, wx, ox = T[E + j], T[V + j], T[W + j], T[O + j]
        ey, vy, wy, oy = T[AXIS + E + j], T[AXIS + V + j], T[AXIS + W + j], T[AXIS + O + j]
        vv, ww, c4 = vx * vx + vy * vy + S[VV + j], wx * wx + wy * wy + S[WW + j], ox * ox + oy * oy + S[OO + j]
        c0 = 2.0 * (ex * wx + ey * wy + S[EW + j]) + vv
        c1 = 2.0 * ((ex * ox - vx * wx) + (ey * oy - vy * wy) + S[EO_VW + j])
        c2, c3 = ww - 2.0 * (vx * ox + vy * oy + S[VO + j]), 2.0 * (wx * ox + wy * oy + S[WO + j])
        squared = L * L
        least = L * (guard * (vv + squared * (ww + squared * c4)))
        fine = rises(slope, c0, c1, c2, c3, c4, L, least) | (L <= 0.0)
        fails = blocks[FAILED + j] + (0.0 if fine else ELSE)
        blocks[FAILED + j] = fails
        S[MOVE + j] = blocks[FREE + j] if fails == 0.0 else 0.0


@compiled
def one_pass(
    P: FloatArray, N: FloatArray, p: FloatArray, blocks: FloatArray, S: FloatArray, T: FloatArray, start: int, stop: int
) -> tuple[float, int]:
    """Write footpoints to ``blocks``, and the next control points P_i + p_i - C(t_i) to N; of one vertex N may be P.

    Vertices of which something fails are left to :func:`.search.settle`.

    Args:
        P, N, p: (d, …) control points and vertices; P is filled before and behind those that move, which go from
            ``start`` to ``stop``.
        blocks: as :func:`set_weights` makes them, with intervals.
        S: ``SCRATCH`` numbers, zeros in the plane from ``SUMS`` on; T: ``AXIS`` numbers a coordinate.

    Returns:
        The largest squared error before the update, and the number of vertices that are left.
    """
    d, guard, largest, left = P.shape[0], guard_for(P.shape[0]), 0.0, 0
    for k in range(start, stop, LANES):
        count = min(LANES, stop - k)
        m = (count + WHOLE - 1) // WHOLE * WHOLE if count > 1 else 1
        row = blocks[(k - start) // LANES * BLOCK :]
        _expand(P, p, k, row, S, T, m)
        for _ in range(NEWTON_STEPS):
            if _newton(S, T, d, m) == 0:
                break
        _certify(row, S, T, d, m, guard)
        for j in range(count):
            squared = S[MOVE + j] * S[SQUARED + j]
            largest = squared if squared > largest else largest
            left += 1 if row[FAILED + j] > 0.0 else 0
        for axis in range(d):
            x, target, t = P[axis, k:], N[axis, k:], T[axis * AXIS :]
            for j in range(count):
                q, _, _ = along(t[E + j], t[V + j], t[W + j], t[Z + j], S[Y + j])
                target[j] = x[j] - S[MOVE + j] * q
    return largest, left
