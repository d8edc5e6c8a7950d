"""One pass of Algorithm 2 on a cubic in R^d, d > 2, variants 1 to 3: what :mod:`.newton_simd` does in the plane.

Newton's method and the certificate need the curve q(x) = E + V x + W x² + Z x³ about a knot only through inner products
of E, V, W and Z. These are combinations of those of D_{i-1}, …, D_{i+2}, D_i = P_i - P_{i-1}, and F = P_i - p_i: eight
sums over the coordinates, which is all that depends on the dimension, but for the errors p - C(t) at the end. A sum of
inner products has no digits left where the curve almost passes through the vertex, so the errors, and the distance,
come from the coordinates; the zeros of D' lose nothing.

**Rounding.** A sum over d coordinates is off by at most ρ = (d + ``ROUNDINGS``) 2^-53 of the product of the lengths.
Let e, v, w, z be the lengths of E, V, W and Z with those of F and of the derivatives d_i in place of the vectors, all
taken as positive, and M(x) = e + v x + w x² + z x³, M² = Σ m_k x^k.

- A Bernstein coefficient of Q on a side of length L is off by at most ρ Σ_k≥2 2^k m_k L^(k-2), which is added to the
  guard of ``newton_simd``.
- D' is off by at most s = 2 ρ M M' at L, so that D may be too large by s²/4Q. Of the distance that is less than
  ``LOST`` M if s²/4Q ≤ a (a + 2 √D), a = ``LOST`` M.

A vertex where one of these fails is flagged, and looked at by coordinates.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled, inlined
from ...intrinsics import fma, select, wide_vectors
from ...types import FloatArray
from .blocks import (
    BAD, DD, DONE, FOUR, HALF, HIGH, LAMBDA, LOW, MOVE_A, MOVE_B, ONE, OTHER, OWN, PAIR, RATE, SECOND, SHI, SIDE, SLO,
    STRIDE, SY, THIRD, THREE, TWO, X,
)  # fmt: skip
from .certificate import LOST
from .newton_simd import GUARD, NEWTON_PASSES, least_quartic, least_rise, step

# Own fields of the scratch block: products of D_{i-1} with itself and the next two, of F with itself and with D_{i-1}
# to D_{i+2}; coefficients of D'/2 along the main side, and of |q'|²; the guard of rounding, and s²; what D_{i-1} to
# D_{i+2} have to be multiplied by for C(t) - P_i; M; the least Bernstein coefficient of Q.
(
    G0, G1, G2, FF, FM, F0, F1, F2, H0, H1, H2, H3, H4, H5, VV, VW, WW, VZ, WZ, ROUGH, LOSS, KM, K0, K1, K2, REACH,
    LEAST,
) = (np.uint64((OWN + k) * STRIDE) for k in range(27))  # fmt: skip

ROUNDINGS = 40
"""More than the number of roundings in a coefficient beside those of the sums over coordinates."""


@inlined
def _rough(e: float, v: float, w: float, z: float, L: float) -> float:
    """Σ 2^k m_k L^(k-2), k = 2 to 6 (see the module)."""
    squared = L * L
    low = 4.0 * fma(2.0 * e, w, v * v) + 16.0 * L * fma(e, z, v * w)
    return fma(squared, 16.0 * fma(2.0 * v, z, w * w) + L * (64.0 * w * z) + 64.0 * squared * (z * z), low)


@compiled
def _products(P: FloatArray, Q: FloatArray, S: FloatArray, pairs: int, m: int) -> None:
    """The sums over the coordinates."""
    wide_vectors()
    for field in range(8):
        for j in range(np.uint64((OWN + field) * STRIDE), np.uint64((OWN + field) * STRIDE + m + 6)):
            S[j] = 0.0
    for pair in range(pairs):
        p, q = P[pair * PAIR : (pair + 1) * PAIR], Q[pair * PAIR : (pair + 1) * PAIR]
        for j in range(TWO, np.uint64(m) + TWO + FOUR):
            i = SECOND + j
            x, y, xa, ya, xb, yb = p[j], p[i], p[j - ONE], p[i - ONE], p[j + ONE], p[i + ONE]
            fx, fy, mx, my = x - q[j], y - q[i], xa - p[j - TWO], ya - p[i - TWO]
            x0, y0, x1, y1, x2, y2 = x - xa, y - ya, xb - x, yb - y, p[j + TWO] - xb, p[i + TWO] - yb
            S[G0 + j] = fma(mx, mx, fma(my, my, S[G0 + j]))
            S[G1 + j] = fma(mx, x0, fma(my, y0, S[G1 + j]))
            S[G2 + j] = fma(mx, x1, fma(my, y1, S[G2 + j]))
            S[FF + j] = fma(fx, fx, fma(fy, fy, S[FF + j]))
            S[FM + j] = fma(fx, mx, fma(fy, my, S[FM + j]))
            S[F0 + j] = fma(fx, x0, fma(fy, y0, S[F0 + j]))
            S[F1 + j] = fma(fx, x1, fma(fy, y1, S[F1 + j]))
            S[F2 + j] = fma(fx, x2, fma(fy, y2, S[F2 + j]))


@compiled
def _expand(B: FloatArray, S: FloatArray, m: int, rho: float) -> None:
    """Main side, coefficients of D' on it, and the certificate of the other side, whose flag goes into BAD."""
    wide_vectors()
    for j in range(TWO, np.uint64(m) + TWO):
        rm, r0, r1, r2 = B[RATE + j - ONE], B[RATE + j], B[RATE + j + ONE], B[RATE + j + TWO]
        gmm, g00, g11, g22 = S[G0 + j], S[G0 + j + ONE], S[G0 + j + TWO], S[G0 + j + THREE]
        gmm, g00, g11, g22 = rm * rm * gmm, r0 * r0 * g00, r1 * r1 * g11, r2 * r2 * g22
        gm0, g01, g12 = rm * r0 * S[G1 + j], r0 * r1 * S[G1 + j + ONE], r1 * r2 * S[G1 + j + TWO]
        gm1, g02 = rm * r1 * S[G2 + j], r0 * r2 * S[G2 + j + ONE]
        fm, f0, f1, f2 = rm * S[FM + j], r0 * S[F0 + j], r1 * S[F1 + j], r2 * S[F2 + j]
        a, b, lam = B[MOVE_A + j], B[MOVE_B + j], B[LAMBDA + j]
        sm, s0, sp = B[HALF + j - ONE], B[HALF + j], B[HALF + j + ONE]
        tl, tr = B[THIRD + j - ONE], B[THIRD + j]
        # k = d_1 - d_0, and the same at the knots before and after
        dk, kk = g01 - g00, (g11 - g01) - (g01 - g00)
        before_k, after_k = (g01 - g00) - (gm1 - gm0), (g12 - g11) - (g02 - g01)
        before2, after2 = (g00 - gm0) - (gm0 - gmm), (g22 - g12) - (g12 - g11)
        d_before, d_after = g00 - gm0, g02 - g01
        vk, v_before, v_after = fma(lam, kk, dk), fma(lam, before_k, d_before), fma(lam, after_k, d_after)
        dv = fma(lam, dk, g00)
        vv = fma(lam, vk, dv)
        shift = a - b
        ev = fma(shift, dv, fma(a, vk, fma(lam, f1 - f0, f0)))
        ek = fma(shift, dk, fma(a, kk, f1 - f0))
        e_before = fma(shift, d_before, fma(a, before_k, f0 - fm))
        e_after = fma(shift, d_after, fma(a, after_k, f2 - f1))
        low, high = B[LOW + j], B[HIGH + j]
        forward = (low >= 0.0) | ((high > 0.0) & (ev <= 0.0))
        side = select(forward, 1.0, -1.0)
        near, far = select(forward, low, -high), select(forward, high, -low)
        near0 = select(near > 0.0, near, 0.0)
        L = select(near < 0.0, -near, 0.0)
        y = side * B[X + j]
        y = select(y > near0, y, near0)
        S[SLO + j], S[SHI + j], S[SIDE + j], S[OTHER + j] = near0, far, side, L
        S[SY + j] = select(y < far, y, far)
        S[DONE + j] = select(far <= near0, 1.0, 0.0)
        ev, vw, ew, ww = side * ev, side * s0 * vk, s0 * ek, s0 * s0 * kk
        # Z = t (s (d_2 - d_1) - s0 k) on the main side, likewise on the other
        s, t = select(forward, sp, sm), select(forward, tr, tl)
        ez = t * (s * select(forward, e_after, e_before) - s0 * ek)
        vz = side * t * (s * select(forward, v_after, v_before) - s0 * vk)
        kn, nn = select(forward, after_k, before_k), select(forward, after2, before2)
        wz = s0 * t * (s * kn - s0 * kk)
        zz = t * t * (s * (s * nn - s0 * kn) - s0 * (s * kn - s0 * kk))
        S[H0 + j], S[H1 + j], S[H2 + j] = ev, fma(2.0, ew, vv), 3.0 * (ez + vw)
        S[H3 + j], S[H4 + j], S[H5 + j] = 2.0 * fma(2.0, vz, ww), 5.0 * wz, 3.0 * zz
        S[VV + j], S[VW + j], S[WW + j], S[VZ + j], S[WZ + j] = vv, vw, ww, vz, wz
        s_, t_ = select(forward, sm, sp), select(forward, tl, tr)
        oez = t_ * (s_ * select(forward, e_before, e_after) - s0 * ek)
        ovz = side * t_ * (s_ * select(forward, v_before, v_after) - s0 * vk)
        okn, onn = select(forward, before_k, after_k), select(forward, before2, after2)
        owz = s0 * t_ * (s_ * okn - s0 * kk)
        ozz = t_ * t_ * (s_ * (s_ * onn - s0 * okn) - s0 * (s_ * okn - s0 * kk))
        # lengths, for the rounding errors
        nm, n0, n1, n2 = np.sqrt(gmm), np.sqrt(g00), np.sqrt(g11), np.sqrt(g22)
        le, lv, lw = np.sqrt(S[FF + j]) + a * n1 + b * n0, fma(lam, n1 - n0, n0), s0 * (n0 + n1)
        lz_before, lz_after = tl * fma(sm, nm + n0, lw), tr * fma(sp, n1 + n2, lw)
        lz, oz = select(forward, lz_after, lz_before), select(forward, lz_before, lz_after)
        S[ROUGH + j] = rho * _rough(le, lv, lw, lz, far)
        reach = fma(fma(fma(lz, far, lw), far, lv), far, le)
        error = 2.0 * rho * reach * fma(fma(3.0 * lz, far, 2.0 * lw), far, lv)
        S[LOSS + j], S[REACH + j] = error * error, reach
        o1, o2, o3 = 2.0 * (oez - vw), ww - 2.0 * ovz, 2.0 * owz
        rise = least_rise(-2.0 * ev, fma(2.0, ew, vv), o1, o2, o3, ozz, L)
        squared = L * L
        guard = GUARD * fma(squared, fma(squared, ozz, ww), vv) + rho * _rough(le, lv, lw, oz, L)
        S[BAD + j] = select((rise <= fma(L, guard, 2.0 * rho * le * lv)) & (L > 0.0), 2.0, 0.0)


@compiled
def _newton(S: FloatArray, m: int) -> int:
    """One step for every vertex that has not converged; returns the number of those that still have not."""
    wide_vectors()
    pending = 0
    for j in range(TWO, np.uint64(m) + TWO):
        y = S[SY + j]
        h1, h2, h3, h4, h5 = S[H1 + j], S[H2 + j], S[H3 + j], S[H4 + j], S[H5 + j]
        h = fma(fma(fma(fma(fma(h5, y, h4), y, h3), y, h2), y, h1), y, S[H0 + j])
        bend = fma(fma(fma(fma(5.0 * h5, y, 4.0 * h4), y, 3.0 * h3), y, 2.0 * h2), y, h1)
        third = fma(fma(fma(10.0 * h5, y, 6.0 * h4), y, 3.0 * h3), y, h2)
        wz = S[WZ + j]
        speed = fma(fma(fma(3.0 * h5, y, 12.0 * wz), y, fma(6.0, S[VZ + j], 4.0 * S[WW + j])), y, 4.0 * S[VW + j])
        speed = fma(speed, y, S[VV + j])
        pending += step(S, j, h, speed, bend, third)
    return pending


@compiled
def _certify(B: FloatArray, S: FloatArray, m: int) -> None:
    """Write footpoints to the block, the factors of the D_i at them, and flags."""
    wide_vectors()
    for j in range(TWO, np.uint64(m) + TWO):
        y, low, high = S[SY + j], S[SLO + j], S[SHI + j]
        h2, h3, h4, h5, wz, L = S[H2 + j], S[H3 + j], S[H4 + j], S[H5 + j], S[WZ + j], high - low
        # Q about y, from D''/2, D'''/6, …
        c0 = fma(fma(fma(fma(5.0 * h5, y, 4.0 * h4), y, 3.0 * h3), y, 2.0 * h2), y, S[H1 + j])
        c1 = fma(fma(fma(10.0 * h5, y, 6.0 * h4), y, 3.0 * h3), y, h2) * (2.0 / 3.0)
        c2 = fma(fma(10.0 * h5, y, 4.0 * h4), y, h3) * 0.5
        c3, c4 = fma(5.0 * h5, y, h4) * 0.4, h5 * (1.0 / 3.0)
        speed = fma(fma(fma(3.0 * h5, y, 12.0 * wz), y, fma(6.0, S[VZ + j], 4.0 * S[WW + j])), y, 4.0 * S[VW + j])
        squared, bent = L * L, fma(fma(3.0 * h5, y, 6.0 * wz), y, S[WW + j])
        guard = fma(GUARD, fma(squared, fma(squared, c4, bent), fma(speed, y, S[VV + j])), S[ROUGH + j])
        ahead = least_quartic(c0, c1, c2, c3, c4, high - y)
        behind = least_quartic(c0, c1, c2, c3, c4, low - y)
        least = select(ahead < behind, ahead, behind)
        main = (S[DONE + j] == 0.0) | ((least <= guard) & (high > low))
        S[BAD + j] += select(main, 1.0, 0.0)
        S[LEAST + j] = select(main | (high <= low), np.inf, least)
    for j in range(TWO, np.uint64(m) + TWO):
        x = S[SIDE + j] * S[SY + j]
        B[X + j] = x
        right = x > 0.0
        lam, s0 = B[LAMBDA + j], B[HALF + j]
        s, t = select(right, B[HALF + j + ONE], B[HALF + j - ONE]), select(right, B[THIRD + j], -B[THIRD + j - ONE])
        cube = x * x * x * t
        common = fma(x * x, s0, -s0 * cube)
        k0, k1 = fma(x, 1.0 - lam, -B[MOVE_B + j]) - common, fma(x, lam, B[MOVE_A + j]) + common
        beyond = s * cube
        S[KM + j] = select(right, 0.0, -beyond) * B[RATE + j - ONE]
        S[K0 + j] = select(right, k0, k0 + beyond) * B[RATE + j]
        S[K1 + j] = select(right, k1 - beyond, k1) * B[RATE + j + ONE]
        S[K2 + j] = select(right, beyond, 0.0) * B[RATE + j + TWO]


@compiled
def _errors(
    B: FloatArray, P: FloatArray, Q: FloatArray, N: FloatArray, S: FloatArray, pairs: int, m: int
) -> tuple[int, int]:
    """Write the next control points, squared distances and the last flags; returns counts of flagged, not finite."""
    wide_vectors()
    for j in range(TWO, np.uint64(m) + TWO):
        B[DD + j] = 0.0
    for pair in range(pairs):
        p, q = P[pair * PAIR : (pair + 1) * PAIR], Q[pair * PAIR : (pair + 1) * PAIR]
        following = N[pair * PAIR : (pair + 1) * PAIR]
        for j in range(TWO, np.uint64(m) + TWO):
            i = SECOND + j
            km, k0, k1, k2 = S[KM + j], S[K0 + j], S[K1 + j], S[K2 + j]
            x, y, xa, ya, xb, yb = p[j], p[i], p[j - ONE], p[i - ONE], p[j + ONE], p[i + ONE]
            ex = fma(k2, xb - p[j + TWO], fma(km, p[j - TWO] - xa, fma(k0, xa - x, q[j] - x)))
            ey = fma(k2, yb - p[i + TWO], fma(km, p[i - TWO] - ya, fma(k0, ya - y, q[i] - y)))
            ex, ey = fma(k1, x - xb, ex), fma(k1, y - yb, ey)
            following[j], following[i] = x + ex, y + ey
            B[DD + j] = fma(ex, ex, fma(ey, ey, B[DD + j]))
    bad, wild = 0, 0
    for j in range(TWO, np.uint64(m) + TWO):
        D, share = B[DD + j], LOST * S[REACH + j]
        lost = S[LOSS + j] > 4.0 * S[LEAST + j] * share * (share + 2.0 * np.sqrt(D))
        flag = S[BAD + j] + select(lost, 1.0, 0.0)
        S[BAD + j] = flag
        bad += select(flag > 0.0, 1, 0)
        wild += select(np.inf > D, 0, 1)
    return bad, wild


@compiled
def seek_space(
    B: FloatArray, P: FloatArray, Q: FloatArray, N: FloatArray, S: FloatArray, d: int, m: int
) -> tuple[int, int]:
    """Write footpoints to m lanes of a block, and control points to N; returns counts of flagged and not finite ones.

    Where both ends of an interval are the same, the footpoint is that parameter.

    Args:
        B: the block's weights, intervals and footpoints; P, Q, N: its coordinates; S: scratch.
    """
    pairs = (d + 1) // 2
    _products(P, Q, S, pairs, m)
    _expand(B, S, m, (d + ROUNDINGS) * 2.0**-53)
    for _ in range(NEWTON_PASSES):
        if _newton(S, m) == 0:
            break
    _certify(B, S, m)
    return _errors(B, P, Q, N, S, pairs, m)
