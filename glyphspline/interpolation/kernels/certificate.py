"""Vertices that the SIMD passes flag: a second look by coordinates, then a full search, in the plane as in space.

On the main side the certificate may hold in smaller parts. All of the other side may be farther away than y*, by the
Bernstein coefficients of the squared distance. One vertex in a hundred is flagged, so this is done one by one.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...intrinsics import fma
from ...types import FloatArray
from ..method import TIE_DISTANCE
from .blocks import (
    BAD, DD, DONE, HALF, LAMBDA, MOVE_A, MOVE_B, ONE, OTHER, RATE, SHI, SIDE, SLO, STRIDE, SY, THIRD, TWO, X,
)  # fmt: skip
from .footpoint import WORK, lower_bound, reduce, search_piece
from .newton_simd import GUARD, bernstein, expanded

SEARCHED = 9.0
"""Mark of a vertex that took a full search, in the field ``BAD``."""

GIVEN_UP = 10.0
"""Mark of one whose search ended without a certificate."""

LOST = 5e-13
"""Share of the size of a piece by which another point may be nearer, as inner products have rounding errors."""

CUT = 0.125


@compiled
def _second_look(b: FloatArray, y: float, low: float, high: float) -> bool:
    """Whether the certificate holds between ``low`` and ``high`` after all, in parts, for rows E, V, W and Z (4, d).

    The derivative of D at y may cost ``LOST`` of the size of the piece, as y may come from inner products.
    """
    qq, qp, qa, qz, pp, pa, pz, aa, az, zz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for axis in range(b.shape[1]):
        z = b[3, axis]
        q, p, a = expanded(b[0, axis], b[1, axis], b[2, axis], z, y)
        qq, qp, qa, qz = qq + q * q, qp + q * p, qa + q * a, qz + q * z
        pp, pa, pz, aa, az, zz = pp + p * p, pa + p * a, pz + p * z, aa + a * a, az + a * z, zz + z * z
    c0, c1, c2, c3, L = 2.0 * qa + pp, 2.0 * (qz + pa), 2.0 * pz + aa, 2.0 * az, high - low
    share = LOST * (np.sqrt(qq) + L * (np.sqrt(pp) + L * (np.sqrt(aa) + L * np.sqrt(zz))))
    guard = max(GUARD * (pp + L * L * (aa + L * L * zz)), qp * qp / (share * (share + 2.0 * np.sqrt(qq))))
    # Near a cusp Q falls from a small value at the footpoint before it rises, over a small part of the way. It is cut
    # at an eighth, again and again towards y.
    for length in (high - y, low - y):
        b1, b2, b3, b4 = bernstein(c0, c1, c2, c3, zz, length)
        for _ in range(6):
            if min(c0, b1, b2, b3, b4) > guard:
                break
            p0, p1, p2, p3 = c0 + CUT * (b1 - c0), b1 + CUT * (b2 - b1), b2 + CUT * (b3 - b2), b3 + CUT * (b4 - b3)
            q0, q1, q2 = p0 + CUT * (p1 - p0), p1 + CUT * (p2 - p1), p2 + CUT * (p3 - p2)
            r0, r1 = q0 + CUT * (q1 - q0), q1 + CUT * (q2 - q1)
            s0 = r0 + CUT * (r1 - r0)
            if not min(s0, r1, q2, p3, b4) > guard:
                return False
            b1, b2, b3, b4 = p0, q0, r0, s0
        else:
            return False
    return True


@compiled
def _vectors(B: FloatArray, P: FloatArray, Q: FloatArray, j: int, right: bool, b: FloatArray) -> None:
    """Rows E, V outwards, W and Z (4, d) of the curve to the right or to the left of the knot of a lane."""
    r0, r1, lam, s0 = B[RATE + j], B[RATE + j + ONE], B[LAMBDA + j], B[HALF + j]
    for axis in range(b.shape[1]):
        c = P[axis * STRIDE : (axis + 1) * STRIDE]
        d0, d1 = r0 * (c[j] - c[j - ONE]), r1 * (c[j + ONE] - c[j])
        w = s0 * (d1 - d0)
        if right:
            beyond = B[HALF + j + ONE] * (B[RATE + j + TWO] * (c[j + TWO] - c[j + ONE]) - d1)
            b[3, axis] = (beyond - w) * B[THIRD + j]
        else:
            beyond = B[HALF + j - ONE] * (d0 - B[RATE + j - ONE] * (c[j - ONE] - c[j - TWO]))
            b[3, axis] = (beyond - w) * B[THIRD + j - ONE]
        v = fma(lam, d1 - d0, d0)
        b[0, axis] = fma(B[MOVE_A + j], d1, fma(-B[MOVE_B + j], d0, c[j] - Q[np.uint64(axis * STRIDE) + j]))
        b[1, axis], b[2, axis] = (v if right else -v), w


@compiled
def flagged(B: FloatArray, P: FloatArray, Q: FloatArray, N: FloatArray, S: FloatArray, d: int, m: int) -> int:
    """A second look at the flagged vertices of m lanes, then a search in full; the number of those searched.

    These are marked ``SEARCHED`` in the field BAD, or ``GIVEN_UP``.
    """
    searched, b, c, work = 0, np.empty((4, d)), np.empty((min(d, 4), 4)), np.empty(WORK)
    for j in range(TWO, np.uint64(m) + TWO):
        flag = S[BAD + j]
        if flag == 0.0:
            continue
        main_side, other_side = flag != 2.0, flag >= 2.0
        if main_side and S[DONE + j] > 0.0:
            _vectors(B, P, Q, j, S[SIDE + j] > 0.0, b)
            main_side = not _second_look(b, S[SY + j], S[SLO + j], S[SHI + j])
        other_side = other_side or (main_side and S[OTHER + j] > 0.0)
        x, D, certified, anything = S[SIDE + j] * S[SY + j], (np.inf if main_side else B[DD + j]), True, main_side
        for turn in range(2):
            main = turn == 0
            if not (main_side if main else other_side):
                continue
            right = (S[SIDE + j] > 0.0) == main
            sign = 1.0 if right else -1.0
            low, high = (S[SLO + j], S[SHI + j]) if main else (0.0, S[OTHER + j])
            _vectors(B, P, Q, j, right, b)
            if d > 4:
                reduce(b, c)
                _vectors(B, P, Q, j, right, b)
            else:
                for k in range(4):
                    for axis in range(d):
                        c[axis, k] = b[k, axis]
            # The other side is not searched if all of it is farther than the footpoint by this factor, in squared
            # distances.
            if not main_side and lower_bound(c, 3, low, high, work)[0] > (1 + 1e-9) * D:
                continue
            anything = True
            y, D_new, whole = search_piece(c, 3, 0.0, low, high, 0.0, sign * x, D, TIE_DISTANCE**2, work)
            certified &= whole
            if D_new < D or y != sign * x:
                x, D = sign * y, D_new
                squared = 0.0
                for axis in range(d):
                    error = -(((b[3, axis] * y + b[2, axis]) * y + b[1, axis]) * y + b[0, axis])
                    lane = np.uint64(axis * STRIDE) + j
                    N[lane] = P[lane] + error
                    squared += error * error
                B[DD + j] = squared
        if anything:
            searched += 1
            B[X + j] = x
            S[BAD + j] = SEARCHED if certified else GIVEN_UP
    return searched
