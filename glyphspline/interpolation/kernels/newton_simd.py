"""One pass of Algorithm 2 on a cubic, variants 1 to 3: straight-line code over blocks of vertices, for SIMD.

About its knot u_i the curve, with p_i as the origin, is q(x) = E + V x + W x² + Z x³, where Z is one of two, for the
spans to the right and to the left. All of it comes from differences of control points, through d_i, the control points
of C', and w_i = C''(u_i)/2:

    d_i = 3 (P_i - P_{i-1}) / (u_{i+1} - u_{i-2})       w_i = (d_{i+1} - d_i) / (u_{i+1} - u_{i-1})
    λ = h_{i-1} / (h_{i-1} + h_i)                       E = P_i - p_i + (λ h_{i-1} d_{i+1} - (1-λ) h_i d_i) / 3
    V = (1-λ) d_i + λ d_{i+1}                           W = w_i
    Z = (w_{i+1} - w_i) / (3 h_i) to the right, likewise to the left

The *main side* is the one on which the distance falls at u_i (or on which the whole interval lies), and y ≥ 0 runs
along it. Newton's method with Chebyshev's third-order term goes from the last footpoint to a local minimum y*. The
certificate of ``footpoint`` then has two parts: about y* over the main side, and about u_i over the other side, which
shows D ≥ D(u_i) ≥ D(y*) there. A vertex that fails either is flagged, and left to ``flagged``.

The certificate takes e_1 for 0 at y*. By the rule that ends Newton's method e_1 is at most some 2e-14 Q(y*) L, with L
the length of the side. Each Bernstein coefficient b_j of Q has to exceed ``GUARD`` of |C'|² and of the squares of the
higher terms. Then Q ≥ b_0 (1 - x/L)⁴ over the first half of the side, and x² Q outgrows e_1 x over the rest: no point
is nearer by more than some 1e-13 of the extent. ``GUARD`` also covers the rounding errors of the b_j, some 1e-16 of
these squares; where Q(y*) is much larger than they are, so is D, and the same shares are shares of D.

No value depends on another lane, and no floating-point reassociation is allowed, so results do not depend on the
width of the vectors.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled, inlined
from ...intrinsics import fma, select, wide_vectors
from ...types import FloatArray
from .blocks import (
    BAD, DD, DONE, FOUR, HALF, HIGH, LAMBDA, LOW, MOVE_A, MOVE_B, ONE, OTHER, OWN, RATE, SECOND, SHI, SIDE, SLO, STRIDE,
    SY, THIRD, THREE, TWO, X,
)  # fmt: skip

# Indices are unsigned: a signed one might be negative and count from the end, which keeps a loop from becoming SIMD.
# Own fields of the scratch block: d and W, the same on both sides; E, V and Z on the main side; Z on the other.
DX, DY, SWX, SWY, SEX, SEY, SVX, SVY, SZX, SZY, OZX, OZY = (np.uint64((OWN + k) * STRIDE) for k in range(12))

GUARD = 1e-13
"""Share of |q'|² + |q''|² L²/4 + |q'''|² L⁴/36 that Q has to exceed, for rounding errors and the e_1 left at y*."""

NEWTON_PASSES = 8
SETTLED_STEP = 1e-6
"""A step this small (share of the side's length) may be the last: third-order convergence leaves its cube."""

LEFT = 1e-14
"""It is the last if it leaves so little: about c² of the step, where c is the share of it that the correction adds.

Near a cusp c is not small until steps are much smaller than above. Gauss and Newton's step has no correction, and may
leave as much as it is itself.
"""


@inlined
def dot(ax: float, ay: float, bx: float, by: float) -> float:
    """a · b"""
    return fma(ax, bx, ay * by)


@inlined
def cubic(e: float, v: float, w: float, z: float, y: float) -> float:
    """e + v y + w y² + z y³"""
    return fma(fma(fma(z, y, w), y, v), y, e)


@inlined
def expanded(e: float, v: float, w: float, z: float, y: float) -> tuple[float, float, float]:
    """Coefficients of e + v x + w x² + z x³, one coordinate of q, about y but for the last, which stays z."""
    a = fma(3.0 * y, z, w)
    return cubic(e, v, w, z, y), fma(a + w, y, v), a


@inlined
def quartic(
    qx: float, qy: float, px: float, py: float, ax: float, ay: float, zx: float, zy: float
) -> tuple[float, float, float, float, float, float]:
    """c0 to c4 of |q + p x + a x² + z x³|² = |q|² + 2 q·p x + x² (c0 + c1 x + … + c4 x⁴), and |p|²."""
    speed = dot(px, py, px, py)
    c0 = fma(2.0, dot(qx, qy, ax, ay), speed)
    c1 = 2.0 * (dot(qx, qy, zx, zy) + dot(px, py, ax, ay))
    c2 = fma(2.0, dot(px, py, zx, zy), dot(ax, ay, ax, ay))
    c3 = 2.0 * dot(ax, ay, zx, zy)
    return c0, c1, c2, c3, dot(zx, zy, zx, zy), speed


@inlined
def bernstein(c0: float, c1: float, c2: float, c3: float, c4: float, L: float) -> tuple[float, float, float, float]:
    """The Bernstein coefficients of c0 + c1 x + … + c4 x⁴ between 0 and L, but for the first, which is c0."""
    squared = L * L
    k1, k2, k3, k4 = c1 * L, c2 * squared, c3 * (squared * L), c4 * (squared * squared)
    b1 = fma(0.25, k1, c0)
    b2 = fma(1 / 6, k2, fma(0.5, k1, c0))
    b3 = fma(0.25, k3, fma(0.5, k2, fma(0.75, k1, c0)))
    return b1, b2, b3, c0 + k1 + k2 + k3 + k4


@inlined
def least_quartic(c0: float, c1: float, c2: float, c3: float, c4: float, L: float) -> float:
    """Smallest Bernstein coefficient of c0 + c1 x + … + c4 x⁴ between 0 and L."""
    b1, b2, b3, b4 = bernstein(c0, c1, c2, c3, c4, L)
    least = select(c0 < b1, c0, b1)
    rest = select(b2 < b3, b2, b3)
    least = select(least < rest, least, rest)
    return select(least < b4, least, b4)


@inlined
def least_rise(slope: float, c0: float, c1: float, c2: float, c3: float, c4: float, L: float) -> float:
    """Smallest of the last five Bernstein coefficients of slope + x (c0 + … + c4 x⁴) between 0 and L > 0."""
    b1, b2, b3, b4 = bernstein(c0, c1, c2, c3, c4, L)
    r1, r2, r3, r4 = 0.2 * c0, 0.4 * b1, 0.6 * b2, 0.8 * b3
    least = select(r1 < r2, r1, r2)
    rest = select(r3 < r4, r3, r4)
    least = select(least < rest, least, rest)
    least = select(least < b4, least, b4)
    return fma(L, least, slope)


@inlined
def step(S: FloatArray, j: int, slope: float, speed: float, bend: float, third: float) -> int:
    """Newton's next estimate of a vertex that has not converged, with Chebyshev's term where the distance is convex.

    Returns 1 if it still has not.

    Args:
        slope, bend, third: half the first and second, and a quarter of the third derivative of the squared distance.
        speed: the square of it.
    """
    y, low, high, frozen = S[SY + j], S[SLO + j], S[SHI + j], S[DONE + j] > 0.0
    convex = bend > 0.05 * speed
    steep = select(convex, bend, speed)
    steep = select(steep > 0.0, steep, 1.0)
    inverse = 1.0 / steep
    plain = slope * inverse
    correction = plain * third * inverse
    correction = select(correction < 0.5, correction, 0.5)
    correction = select(correction > -0.5, correction, -0.5)
    left = select(convex, correction * correction, 1.0)
    correction = select(convex, correction, 0.0)
    new = y - fma(plain, correction, plain)
    new = select(new > low, new, low)
    new = select(new < high, new, high)
    moved = new - y
    moved = select(moved > 0.0, moved, -moved)
    length = high - low
    settled = frozen | ((moved <= SETTLED_STEP * length) & (left * moved <= LEFT * length))
    S[SY + j] = select(frozen, y, new)
    S[DONE + j] = select(settled, 1.0, 0.0)
    return select(settled, 0, 1)


@inlined
def squares(speed: float, ax: float, ay: float, c4: float, L: float) -> float:
    """``GUARD`` of the squares of the terms of q over a length L, which the coefficients of Q do not exceed by much."""
    squared = L * L
    return GUARD * fma(squared, fma(squared, c4, dot(ax, ay, ax, ay)), speed)


@compiled
def _taylor(B: FloatArray, P: FloatArray, Q: FloatArray, S: FloatArray, m: int) -> None:
    """Derivatives at the knots from control points (see the module), main side chosen, into the scratch block."""
    wide_vectors()
    for j in range(ONE, np.uint64(m) + FOUR):
        r = B[RATE + j]
        S[DX + j] = r * (P[j] - P[j - ONE])
        S[DY + j] = r * (P[SECOND + j] - P[SECOND + j - ONE])
    for j in range(ONE, np.uint64(m) + THREE):
        s = B[HALF + j]
        S[SWX + j] = s * (S[DX + j + ONE] - S[DX + j])
        S[SWY + j] = s * (S[DY + j + ONE] - S[DY + j])
    for j in range(TWO, np.uint64(m) + TWO):
        a, b, lam = B[MOVE_A + j], B[MOVE_B + j], B[LAMBDA + j]
        ex = fma(a, S[DX + j + ONE], fma(-b, S[DX + j], P[j] - Q[j]))
        ey = fma(a, S[DY + j + ONE], fma(-b, S[DY + j], P[SECOND + j] - Q[SECOND + j]))
        vx = fma(lam, S[DX + j + ONE] - S[DX + j], S[DX + j])
        vy = fma(lam, S[DY + j + ONE] - S[DY + j], S[DY + j])
        low, high = B[LOW + j], B[HIGH + j]
        falling = dot(ex, ey, vx, vy) <= 0.0
        forward = (low >= 0.0) | ((high > 0.0) & falling)
        side = select(forward, 1.0, -1.0)
        S[SEX + j], S[SEY + j], S[SVX + j], S[SVY + j] = ex, ey, side * vx, side * vy
        near = select(forward, low, -high)
        far = select(forward, high, -low)
        near0 = select(near > 0.0, near, 0.0)
        S[OTHER + j] = select(near < 0.0, -near, 0.0)
        S[SLO + j], S[SHI + j], S[SIDE + j] = near0, far, side
        y = side * B[X + j]
        y = select(y > near0, y, near0)
        S[SY + j] = select(y < far, y, far)
        S[DONE + j] = select(far <= near0, 1.0, 0.0)
    for j in range(TWO, np.uint64(m) + TWO):  # one loop with the above would not become SIMD
        wx, wy = S[SWX + j], S[SWY + j]
        right, left = B[THIRD + j], B[THIRD + j - ONE]
        rx, ry = (S[SWX + j + ONE] - wx) * right, (S[SWY + j + ONE] - wy) * right
        lx, ly = (S[SWX + j - ONE] - wx) * left, (S[SWY + j - ONE] - wy) * left
        forward = S[SIDE + j] > 0.0
        S[SZX + j] = select(forward, rx, lx)
        S[SZY + j] = select(forward, ry, ly)
        S[OZX + j] = select(forward, lx, rx)
        S[OZY + j] = select(forward, ly, ry)


@compiled
def _newton(S: FloatArray, m: int) -> int:
    """One step for every vertex that has not converged; returns the number of those that still have not."""
    wide_vectors()
    pending = 0
    for j in range(TWO, np.uint64(m) + TWO):
        y = S[SY + j]
        vx, vy, wx, wy, zx, zy = S[SVX + j], S[SVY + j], S[SWX + j], S[SWY + j], S[SZX + j], S[SZY + j]
        qx, px, ax = expanded(S[SEX + j], vx, wx, zx, y)
        qy, py, ay = expanded(S[SEY + j], vy, wy, zy, y)
        speed = dot(px, py, px, py)
        bend = fma(2.0, dot(qx, qy, ax, ay), speed)
        third = 3.0 * (dot(px, py, ax, ay) + dot(qx, qy, zx, zy))
        pending += step(S, j, dot(qx, qy, px, py), speed, bend, third)
    return pending


@compiled
def _certify(B: FloatArray, P: FloatArray, N: FloatArray, S: FloatArray, m: int) -> tuple[int, int]:
    """Write footpoints, squared distances and next control points; returns counts of flagged, not finite."""
    wide_vectors()
    bad, wild = 0, 0
    for j in range(TWO, np.uint64(m) + TWO):
        y, low, high = S[SY + j], S[SLO + j], S[SHI + j]
        ex, ey, vx, vy, wx, wy = S[SEX + j], S[SEY + j], S[SVX + j], S[SVY + j], S[SWX + j], S[SWY + j]
        zx, zy = S[SZX + j], S[SZY + j]
        qx, px, ax = expanded(ex, vx, wx, zx, y)
        qy, py, ay = expanded(ey, vy, wy, zy, y)
        # Q = c0 + c1 x + … about y, and its Bernstein coefficients to the far and to the near end
        c0, c1, c2, c3, c4, speed = quartic(qx, qy, px, py, ax, ay, zx, zy)
        ahead = least_quartic(c0, c1, c2, c3, c4, high - y)
        behind = least_quartic(c0, c1, c2, c3, c4, low - y)
        least = select(ahead < behind, ahead, behind)
        guard = squares(speed, ax, ay, c4, high - low)
        # the other side, about the knot: 2 E·V outwards, then its Q
        L, ox, oy = S[OTHER + j], S[OZX + j], S[OZY + j]
        slope = -2.0 * dot(ex, ey, vx, vy)
        o0, o1, o2, o3, o4, start = quartic(ex, ey, -vx, -vy, wx, wy, ox, oy)
        rise = least_rise(slope, o0, o1, o2, o3, o4, L)
        D = dot(qx, qy, qx, qy)
        main = (S[DONE + j] == 0.0) | ((least <= guard) & (high > low))
        other = (rise <= L * squares(start, wx, wy, o4, L)) & (L > 0.0)
        fails = main | other
        S[BAD + j] = select(main, 1.0, 0.0) + select(other, 2.0, 0.0)
        bad += select(fails, 1, 0)
        wild += select(np.inf > D, 0, 1)
        B[X + j], B[DD + j] = S[SIDE + j] * y, D
        N[j], N[SECOND + j] = P[j] - qx, P[SECOND + j] - qy
    return bad, wild


@compiled
def seek(B: FloatArray, P: FloatArray, Q: FloatArray, N: FloatArray, S: FloatArray, m: int) -> tuple[int, int]:
    """Write footpoints to m lanes of a block, and control points to N; returns counts of flagged and not finite ones.

    Where both ends of an interval are the same, the footpoint is that parameter.

    Args:
        B: the block's weights, intervals and footpoints; P, Q, N: its coordinates; S: scratch.
    """
    _taylor(B, P, Q, S, m)
    for _ in range(NEWTON_PASSES):
        if _newton(S, m) == 0:
            break
    return _certify(B, P, N, S, m)
