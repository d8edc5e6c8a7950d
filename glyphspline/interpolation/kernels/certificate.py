"""Vertices that ``newton_simd`` flags: the certificate in parts, then a full search.

On the main side the certificate may hold in smaller parts. All of the other side may be farther away than y*, by the
Bernstein coefficients of the squared distance. One vertex in a hundred is flagged, so this is done one by one.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled, inlined
from ...intrinsics import select
from ...types import FloatArray
from ..method import TIE_DISTANCE
from .blocks import DD, SECOND, TWO, X
from .footpoint import ROUNDING, WORK, search_piece
from .newton_simd import (
    BAD, DONE, OTHER, OZX, OZY, SEX, SEY, SHI, SIDE, SLO, SVX, SVY, SWX, SWY, SY, SZX, SZY, bernstein,
    cubic, expanded, quartic, squares,
)  # fmt: skip

BEYOND = 1 + 1e-9
CUT = 0.125
SEARCHED = 9.0
"""Mark of a vertex that took a full search, in the field ``BAD``."""

GIVEN_UP = 10.0
"""Mark of one whose search ended without a certificate."""


@inlined
def _less_rounding(x: float, y: float) -> float:
    """x + y less what it may be too large by."""
    return x + y - ROUNDING * (abs(x) + abs(y))


@compiled
def _least_distance(
    ex: float, ey: float, vx: float, vy: float, wx: float, wy: float, zx: float, zy: float, L: float
) -> float:
    """Smallest Bernstein coefficient of |q|², q = e + v x + w x² + z x³, between 0 and L, less its rounding error."""
    ax, ay = ex + vx * L / 3.0, ey + vy * L / 3.0
    bx, by = ex + (2.0 * vx + wx * L) * L / 3.0, ey + (2.0 * vy + wy * L) * L / 3.0
    cx, cy = ex + ((zx * L + wx) * L + vx) * L, ey + ((zy * L + wy) * L + vy) * L
    least = ex * ex + ey * ey
    d = _less_rounding(ex * ax, ey * ay)
    least = select(d < least, d, least)
    d = (2.0 * _less_rounding(ex * bx, ey * by) + 3.0 * (ax * ax + ay * ay)) * 0.2
    least = select(d < least, d, least)
    d = (_less_rounding(ex * cx, ey * cy) + 9.0 * _less_rounding(ax * bx, ay * by)) * 0.1
    least = select(d < least, d, least)
    d = (2.0 * _less_rounding(ax * cx, ay * cy) + 3.0 * (bx * bx + by * by)) * 0.2
    least = select(d < least, d, least)
    d = _less_rounding(bx * cx, by * cy)
    least = select(d < least, d, least)
    d = cx * cx + cy * cy
    return select(d < least, d, least)


@compiled
def proven_in_parts(c0: float, c1: float, c2: float, c3: float, c4: float, L: float, guard: float) -> bool:
    """Whether the quartic exceeds ``guard`` between 0 and L: cut at an eighth, again and again towards 0.

    Near a cusp Q falls from a small value at the footpoint before it rises, over a small part of the way.
    """
    b1, b2, b3, b4 = bernstein(c0, c1, c2, c3, c4, L)
    for _ in range(6):
        if min(c0, b1, b2, b3, b4) > guard:
            return True
        p0, p1, p2, p3 = c0 + CUT * (b1 - c0), b1 + CUT * (b2 - b1), b2 + CUT * (b3 - b2), b3 + CUT * (b4 - b3)
        q0, q1, q2 = p0 + CUT * (p1 - p0), p1 + CUT * (p2 - p1), p2 + CUT * (p3 - p2)
        r0, r1 = q0 + CUT * (q1 - q0), q1 + CUT * (q2 - q1)
        s0 = r0 + CUT * (r1 - r0)
        if not min(s0, r1, q2, p3, b4) > guard:
            return False
        b1, b2, b3, b4 = p0, q0, r0, s0
    return False


@compiled
def _second_look(S: FloatArray, j: int) -> bool:
    """Whether the certificate holds on the main side after all, in parts."""
    y, zx, zy = S[SY + j], S[SZX + j], S[SZY + j]
    qx, px, ax = expanded(S[SEX + j], S[SVX + j], S[SWX + j], zx, y)
    qy, py, ay = expanded(S[SEY + j], S[SVY + j], S[SWY + j], zy, y)
    c0, c1, c2, c3, c4, speed = quartic(qx, qy, px, py, ax, ay, zx, zy)
    guard = squares(speed, ax, ay, c4, S[SHI + j] - S[SLO + j])
    return proven_in_parts(c0, c1, c2, c3, c4, S[SHI + j] - y, guard) and proven_in_parts(
        c0, c1, c2, c3, c4, S[SLO + j] - y, guard
    )


@compiled
def _search(
    B: FloatArray, P: FloatArray, N: FloatArray, S: FloatArray, j: int, main_side: bool, other_side: bool, D: float,
    c: FloatArray, work: FloatArray,
) -> bool:  # fmt: skip
    """Search the main side, the other one, or both in full; whether the answer is certified there.

    D: the best so far, inf if that does not count. c, work: scratch arrays.
    """
    side, x, certified = S[SIDE + j], S[SIDE + j] * S[SY + j], True
    ex = -cubic(S[SEX + j], S[SVX + j], S[SWX + j], S[SZX + j], S[SY + j])
    ey = -cubic(S[SEY + j], S[SVY + j], S[SWY + j], S[SZY + j], S[SY + j])
    for turn in range(2):
        main = turn == 0
        if not (main_side if main else other_side):
            continue
        sign = side if main else -side
        low = S[SLO + j] if main else 0.0
        high = S[SHI + j] if main else S[OTHER + j]
        c[0, 0], c[1, 0] = S[SEX + j], S[SEY + j]
        c[0, 1], c[1, 1] = side * sign * S[SVX + j], side * sign * S[SVY + j]
        c[0, 2], c[1, 2] = S[SWX + j], S[SWY + j]
        c[0, 3], c[1, 3] = (S[SZX + j], S[SZY + j]) if main else (S[OZX + j], S[OZY + j])
        y, D_new, whole = search_piece(c, 3, 0.0, low, high, 0.0, sign * x, D, TIE_DISTANCE**2, work)
        certified &= whole
        if D_new < D or y != sign * x:
            x, D = sign * y, D_new
            ex = -(((c[0, 3] * y + c[0, 2]) * y + c[0, 1]) * y + c[0, 0])
            ey = -(((c[1, 3] * y + c[1, 2]) * y + c[1, 1]) * y + c[1, 0])
    B[X + j], B[DD + j] = x, ex * ex + ey * ey
    N[j], N[SECOND + j] = P[j] + ex, P[SECOND + j] + ey
    return certified


@compiled
def flagged(B: FloatArray, P: FloatArray, N: FloatArray, S: FloatArray, m: int) -> int:
    """A second look at the vertices that were flagged, then a search in full; the number of those searched.

    These are marked ``SEARCHED`` in the field BAD, or ``GIVEN_UP``.
    """
    searched, c, work = 0, np.empty((2, 4)), np.empty(WORK)
    for j in range(TWO, np.uint64(m) + TWO):
        flag = S[BAD + j]
        if flag == 0.0:
            continue
        D = B[DD + j]
        main_side = flag != 2.0 and (S[DONE + j] == 0.0 or not _second_look(S, j))
        other_side = flag >= 2.0 and _least_distance(
            S[SEX + j], S[SEY + j], -S[SVX + j], -S[SVY + j], S[SWX + j], S[SWY + j], S[OZX + j], S[OZY + j],
            S[OTHER + j],
        ) <= BEYOND * D  # fmt: skip
        other_side = other_side or (main_side and S[OTHER + j] > 0.0)
        if not (main_side or other_side):
            continue
        searched += 1
        certified = _search(B, P, N, S, j, main_side, other_side, np.inf if main_side else D, c, work)
        S[BAD + j] = select(certified, SEARCHED, GIVEN_UP)
    return searched
