"""The nearest point of a polynomial piece, certified to be the global one.

With the vertex p moved to the origin a piece is a plane polynomial q(y) of degree d, and D = |q|² is the squared
distance. Expand it about any y0, with x = y - y0:

    D(y) = e_0 + e_1 x + e_2 x² + … + e_2d x^2d        e_0 = D(y0),  e_1 = 2 q·q',  e_2 = |q'|² + q·q'', …
         = D(y0) + e_1 x + x² Q(x)                     Q a polynomial of degree 2d - 2.

**Certificate.** Let y0 be a zero of e_1 in an interval. If Q ≥ 0 there then D ≥ D(y0): y0 is the global minimum. A
polynomial is not below its smallest Bernstein coefficient on an interval, so it is enough that those of Q are not
negative, on the part to the left of y0 and on the part to its right. At an end of the interval e_1 need not vanish: it
is enough that e_1 + x Q(x), whose Bernstein coefficients are e_1 + (j/m) L Q_{j-1} over a length L (m its degree),
has the sign of x.

Counting sign changes of e_1's own Bernstein form looks simpler, but fails where the method spends its time: near
convergence D is almost 0 at y0, a nearly double zero, which D' then has almost twice in a row.

**Search.** An interval of which that cannot be shown is halved. A part is dropped when the smallest Bernstein
coefficient of D on it exceeds the best distance found, or when the certificate holds for its own local minimum.

**What floating point leaves open.** The coefficients carry rounding errors of some 1e-15 of the size of the summands,
so the certificate asks Q for ``GUARD`` = 1e-12 of its size instead of 0. e_1 is not exactly 0 at a computed zero;
what that can hide is a point nearer by e_1²/4 min Q, the square of a rounding error. Where q·q'' = -|q'|² at the
nearest point (p is the centre of curvature) Q vanishes and nothing is certified; halving then ends at ``SHORTEST`` of
the piece, or after ``MOST_PARTS`` of them, and distances are right to rounding while the parameter is only as good as
the problem lets it be. Squared distances that differ by less than ``TIE`` of them, or by less than ``tie``, count as
equal: the parameter nearest the vertex's own, ``centre``, is taken.
"""

from __future__ import annotations

from math import comb

import numpy as np

from ...compiled import compiled
from ...types import FloatArray
from ..method import TIE

GUARD = 1e-12
SHORTEST = 1e-12
NEWTON_STEPS = 24
MOST_PARTS = 4000
MAX_DEGREE = 6

BERNSTEIN = np.zeros((2 * MAX_DEGREE + 1, 2 * MAX_DEGREE + 1, 2 * MAX_DEGREE + 1))
"""[m, j, k]: weight of the k-th power's coefficient in Bernstein coefficient j of degree m on [0, 1]."""
for _m in range(2 * MAX_DEGREE + 1):
    for _j in range(_m + 1):
        for _k in range(_j + 1):
            BERNSTEIN[_m, _j, _k] = comb(_j, _k) / comb(_m, _k)

WORK = (5, 64)
"""Shape of the scratch array: shifted x and y, squared distance, and the two ends of the parts to do."""


@compiled(internal=True)
def expand(c: FloatArray, d: int, y: float, work: FloatArray) -> None:
    """Coefficients of q about y into work[0], work[1], and those of |q|² into work[2]."""
    for axis in range(2):
        s = work[axis]
        for k in range(d + 1):
            s[k] = c[axis, k]
        for k in range(d):
            for i in range(d - 1, k - 1, -1):
                s[i] += y * s[i + 1]
    for k in range(2 * d + 1):
        total = 0.0
        for i in range(max(0, k - d), min(k, d) + 1):
            total += work[0, i] * work[0, k - i] + work[1, i] * work[1, k - i]
        work[2, k] = total


@compiled(internal=True)
def bernstein_range(e: FloatArray, first: int, m: int, L: float) -> tuple[float, float]:
    """Least and largest (absolute) Bernstein coefficient of Σ e[first + k] x^k, degree m, between 0 and L."""
    least, most = np.inf, 0.0
    for j in range(m + 1):
        value, power = 0.0, 1.0
        for k in range(j + 1):
            value += BERNSTEIN[m, j, k] * e[first + k] * power
            power *= L
        least = min(least, value)
        most = max(most, abs(value))
    return least, most


@compiled(internal=True)
def proven(e: FloatArray, d: int, L: float, slope: float) -> bool:
    """Whether D ≥ e[0] between 0 and L (either sign), where D = e[0] + slope x + x² Q(x)."""
    if L == 0.0:
        return True
    if slope * L > 0.0:
        m = 2 * d - 1
        for j in range(1, m + 1):
            value, power = 0.0, 1.0
            for k in range(j):
                value += BERNSTEIN[m - 1, j - 1, k] * e[2 + k] * power
                power *= L
            if abs(slope) + j / m * abs(L) * value <= 0.0:
                return False
        return True
    if slope != 0.0:
        return False
    least, most = bernstein_range(e, 2, 2 * d - 2, L)
    return least > GUARD * most


@compiled(internal=True)
def local_minimum(c: FloatArray, d: int, low: float, high: float, y: float) -> float:
    """Newton's method for q·q' = 0, kept inside [low, high]; Gauss and Newton's step where D is not convex."""
    for _ in range(NEWTON_STEPS):
        x0, x1, x2, y0, y1, y2 = c[0, d], 0.0, 0.0, c[1, d], 0.0, 0.0
        for k in range(d - 1, -1, -1):
            x2, x1, x0 = x2 * y + x1, x1 * y + x0, x0 * y + c[0, k]
            y2, y1, y0 = y2 * y + y1, y1 * y + y0, y0 * y + c[1, k]
        slope = x0 * x1 + y0 * y1
        speed = x1 * x1 + y1 * y1
        bend = speed + 2 * (x0 * x2 + y0 * y2)
        if not bend > 0.05 * speed:
            bend = speed
        if not bend > 0.0:
            break
        new = min(max(y - slope / bend, low), high)
        moved = abs(new - y)
        y = new
        if moved <= 1e-15 * (high - low):
            break
    return y


@compiled(internal=True)
def better(x: float, D: float, new_x: float, new_D: float, centre: float, tie: float) -> tuple[float, float]:
    """The nearer of two candidates (parameter, squared distance); in a tie the one nearer ``centre``."""
    if new_D < D * (1 - TIE) - tie:
        return new_x, new_D
    if new_D <= D * (1 + TIE) + tie and abs(new_x - centre) < abs(x - centre):
        return new_x, min(D, new_D)
    return x, D


@compiled
def search_piece(
    c: FloatArray, d: int, origin: float, low: float, high: float, centre: float, x: float, D: float, tie: float,
    work: FloatArray,
) -> tuple[float, float]:  # fmt: skip
    """Improve the candidate (x, D) by all that the piece has on [low, high].

    Args:
        c: (2, d + 1) coefficients of q by ascending powers of y; parameters are ``origin + y``.
        x, D: the best so far, D = inf if there is none.
    """
    shortest = SHORTEST * (high - low)
    work[3, 0], work[4, 0] = low, high
    top, parts = 1, 0
    while top > 0:
        top -= 1
        a, b = work[3, top], work[4, top]
        parts += 1
        expand(c, d, a, work)
        if bernstein_range(work[2], 0, 2 * d, b - a)[0] > D * (1 + TIE) + tie:
            continue
        y = local_minimum(c, d, a, b, min(max(x - origin, a), b) if parts == 1 else 0.5 * (a + b))
        expand(c, d, y, work)
        e = work[2]
        x, D = better(x, D, origin + y, e[0], centre, tie)
        slope = e[1]
        if slope * slope <= 1e-24 * e[0] * e[2] or (a < y < b and abs(slope) <= 1e-12 * abs(e[2]) * (b - a)):
            slope = 0.0
        if proven(e, d, b - y, slope) and proven(e, d, a - y, slope):
            continue
        if b - a > shortest and parts < MOST_PARTS:
            middle = 0.5 * (a + b)
            work[3, top], work[4, top] = middle, b
            work[3, top + 1], work[4, top + 1] = a, middle
            top += 2
    return x, D
