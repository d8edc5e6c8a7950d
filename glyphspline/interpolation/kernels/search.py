"""Vertices whose footpoints the pass does not certify at once: a second look, then a search in full.

On the main side the certificate may hold in smaller parts. Where none holds, the spans that the interval meets are
searched (:mod:`.footpoint`), from the best point so far on. On random polygons two vertices in a hundred are looked at
again and few of them are searched, on contours of glyphs one in a thousand.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...types import FloatArray
from ..method import TIE_DISTANCE
from .footpoint import reduce, search_piece
from .passes import BLOCK, ELSE, FAILED, FREE, HIGH, LANES, LOW, MAIN, SIGN, WILD, X, guard_for

FINE, SEARCHED, GIVEN_UP = 0, 1, 2
"""What a second look comes to: the point was the nearest; the nearest one was searched; and is not certified."""

TIED = TIE_DISTANCE * TIE_DISTANCE

LOST = 5e-14
"""Share of a piece's size by which another point may be nearer where D' is not quite 0 at y.

The size is that of all terms together, up to some 12 times the largest distance of a Bézier point.
"""

CUT = 0.125
DEEPEST = 6


class SearchedCurve(NamedTuple):
    """Control points and vertices (d, …), and knot intervals: h[j] is the one after knot j."""

    P: FloatArray
    p: FloatArray
    h: FloatArray


class SearchRoom(NamedTuple):
    """Scratch for a second look: (4, d), (min(d, 4), 4); (d,), the curve's point less the vertex; and ``WORK``."""

    b: FloatArray
    c: FloatArray
    e: FloatArray
    work: FloatArray


@compiled
def settle(
    curve: SearchedCurve, N: FloatArray, blocks: FloatArray, start: int, stop: int, wide: bool, room: SearchRoom
) -> tuple[float, int, int]:
    """What :func:`.passes.one_pass` has left; the largest squared error, inf if one is not finite, and counts.

    These are of the footpoints that took a full search, and of those that are not certified.

    Args:
        wide: intervals are whole supports (variant 0), and all vertices are searched; ``blocks`` have the inner spans.
    """
    P, h, largest, searched, uncertified = curve.P, curve.h, 0.0, 0, 0
    for i in range(start, stop):
        at = (i - start) // LANES * BLOCK + (i - start) % LANES
        fails, low, high = blocks[FAILED + at], blocks[LOW + at], blocks[HIGH + at]
        if fails >= WILD:
            largest, uncertified = np.inf, uncertified + 1
        elif fails > 0.0 or wide:
            if wide:
                low, high, fails = low - h[i - 2], high + h[i + 1], WILD
            x, squared, outcome = look_again(curve, i, blocks[SIGN + at], blocks[X + at], low, high, fails, room)
            searched += 1 if outcome != FINE else 0
            uncertified += 1 if outcome == GIVEN_UP else 0
            blocks[X + at], largest = x, max(largest, blocks[FREE + at] * squared)
            for axis in range(P.shape[0]):
                N[axis, i] = P[axis, i] - blocks[FREE + at] * room.e[axis]
    return largest, searched, uncertified


@compiled
def look_again(
    curve: SearchedCurve, i: int, side: float, x: float, low: float, high: float, fails: float, room: SearchRoom
) -> tuple[float, float, int]:
    """The nearest point of an interval about knot i: its parameter, its squared distance, and what was done.

    Args:
        side, x: sign of the main side, and the best point on it. low, high: the interval.
        fails: which certificates, see :mod:`.passes`; ``WILD``: all spans are searched.
    """
    (P, p, h), (b, c, e, work), guard = curve, room, guard_for(curve.P.shape[0])
    near, far = max(low if side > 0.0 else -high, 0.0), high if side > 0.0 else -low
    expand(P, p, h, i, i, side > 0.0, b)
    squared, certified, at, right = point_at(b, side * x, e), True, i, side > 0.0
    main_fine = fails == ELSE or (fails < WILD and holds_in_parts(b, side * x, near, far, guard))
    if main_fine and fails == MAIN:
        return x, squared, FINE
    for s in range(-2, 2):  # spans, from two before the knot to the second one after it
        if main_fine and s == (0 if side > 0.0 else -1):
            continue
        knot, sign = i + (1 if s > 0 else (-1 if s < -1 else 0)), 1.0 if s >= 0 else -1.0
        origin = 0.0 if s in (-1, 0) else (h[i] if s > 0 else h[i - 1])
        first, last = max(low if s >= 0 else -high, origin), min(high if s >= 0 else -low, origin + h[i + s])
        if not last > first:
            continue
        expand(P, p, h, i, knot, s >= 0, b)
        if b.shape[1] > 4:
            reduce(b, c)
        else:
            for axis in range(b.shape[1]):
                for k in range(4):
                    c[axis, k] = b[k, axis]
        start = sign * x - origin  # the span's own parameters begin at its knot
        new, distance, whole = search_piece(c, 3, first - origin, last - origin, -origin, start, squared, TIED, work)
        certified = certified and whole
        if distance < squared or new != start:
            x, squared, at, right = sign * (origin + new), distance, knot, s >= 0
    expand(P, p, h, i, at, right, b)
    origin = 0.0 if at == i else (h[i] if right else h[i - 1])
    return x, point_at(b, (x if right else -x) - origin, e), SEARCHED if certified else GIVEN_UP


@compiled
def expand(P: FloatArray, p: FloatArray, h: FloatArray, i: int, k: int, right: bool, b: FloatArray) -> None:
    """Rows E, V, W and Z (4, d) of the curve to the right or, outwards, to the left of knot k, vertex i the origin."""
    r0, r1 = 3.0 / (h[k - 2] + h[k - 1] + h[k]), 3.0 / (h[k - 1] + h[k] + h[k + 1])
    s = 1.0 / (h[k - 1] + h[k])
    share = h[k - 1] * s
    ahead, behind = share * h[k - 1] / 3.0, (1.0 - share) * h[k] / 3.0
    if right:
        r2, s2, third = 3.0 / (h[k] + h[k + 1] + h[k + 2]), 1.0 / (h[k] + h[k + 1]), 1.0 / (3.0 * h[k])
    else:
        r2, s2, third = 3.0 / (h[k - 3] + h[k - 2] + h[k - 1]), 1.0 / (h[k - 2] + h[k - 1]), 1.0 / (3.0 * h[k - 1])
    for axis in range(P.shape[0]):
        x = P[axis]
        d0, d1 = r0 * (x[k] - x[k - 1]), r1 * (x[k + 1] - x[k])
        v, w = d0 + share * (d1 - d0), s * (d1 - d0)
        beyond = s2 * (r2 * (x[k + 2] - x[k + 1]) - d1) if right else s2 * (d0 - r2 * (x[k - 1] - x[k - 2]))
        b[0, axis] = (x[k] - p[axis, i]) + ahead * d1 - behind * d0
        b[1, axis], b[2, axis], b[3, axis] = (v if right else -v), w, third * (beyond - w)


@compiled
def point_at(b: FloatArray, y: float, e: FloatArray) -> float:
    """The point of a piece at y, into e, and its squared distance from the origin."""
    squared = 0.0
    for axis in range(b.shape[1]):
        q = b[0, axis] + y * (b[1, axis] + y * (b[2, axis] + y * b[3, axis]))
        e[axis] = q
        squared += q * q
    return squared


@compiled
def holds_in_parts(b: FloatArray, y: float, near: float, far: float, share: float) -> bool:
    """Whether the certificate holds between ``near`` and ``far`` after all, in parts, for rows E, V, W and Z (4, d).

    D' at y may cost ``LOST`` of the size of the piece.
    """
    qq = qp = qa = qz = pp = pa = pz = aa = az = zz = 0.0
    for axis in range(b.shape[1]):
        z = b[3, axis]
        a = b[2, axis] + 3.0 * y * z
        p = b[1, axis] + y * (b[2, axis] + a)
        q = b[0, axis] + y * (b[1, axis] + y * (b[2, axis] + y * z))
        qq, qp, qa, qz = qq + q * q, qp + q * p, qa + q * a, qz + q * z
        pp, pa, pz, aa, az, zz = pp + p * p, pa + p * a, pz + p * z, aa + a * a, az + a * z, zz + z * z
    L = far - near
    lost = LOST * (np.sqrt(qq) + L * (np.sqrt(pp) + L * (np.sqrt(aa) + L * np.sqrt(zz))))
    allowed = lost * (lost + 2.0 * np.sqrt(qq))
    if not allowed > 0.0:
        return False
    guard = max(share * (pp + L * L * (aa + L * L * zz)), qp * qp / allowed)
    c0, c1, c2, c3 = 2.0 * qa + pp, 2.0 * (qz + pa), 2.0 * pz + aa, 2.0 * az
    return cut_holds(c0, c1, c2, c3, zz, far - y, guard) and cut_holds(c0, c1, c2, c3, zz, near - y, guard)


@compiled
def cut_holds(c0: float, c1: float, c2: float, c3: float, c4: float, L: float, guard: float) -> bool:
    """Whether c0 + c1 x + … + c4 x⁴ exceeds a guard between 0 and L, by its Bernstein coefficients in parts.

    Near a cusp Q falls from a small value at the footpoint before it rises, over a small part of the way. It is cut at
    an eighth, again and again towards the footpoint.
    """
    k1, k2, k3, k4 = c1 * L, c2 * (L * L), c3 * (L * L * L), c4 * (L * L * L * L)
    b1, b2, b3 = c0 + 0.25 * k1, c0 + 0.5 * k1 + 1 / 6 * k2, c0 + 0.75 * k1 + 0.5 * k2 + 0.25 * k3
    b4 = c0 + k1 + k2 + k3 + k4
    for _ in range(DEEPEST):
        if c0 > guard and b1 > guard and b2 > guard and b3 > guard and b4 > guard:
            return True
        p0, p1, p2, p3 = c0 + CUT * (b1 - c0), b1 + CUT * (b2 - b1), b2 + CUT * (b3 - b2), b3 + CUT * (b4 - b3)
        q0, q1, q2 = p0 + CUT * (p1 - p0), p1 + CUT * (p2 - p1), p2 + CUT * (p3 - p2)
        r0, r1 = q0 + CUT * (q1 - q0), q1 + CUT * (q2 - q1)
        s0 = r0 + CUT * (r1 - r0)
        if not (s0 > guard and r1 > guard and q2 > guard and p3 > guard and b4 > guard):
            return False
        b1, b2, b3, b4 = p0, q0, r0, s0
    return False
