"""The nearest point of a polynomial piece, certified to be the global one.

With the vertex p moved to the origin a piece is a plane polynomial q(y) of degree d, and D = |q|² is the squared
distance. Expand it about any y0, with x = y - y0:

    D(y) = e_0 + e_1 x + e_2 x² + … + e_2d x^2d        e_0 = D(y0),  e_1 = 2 q·q',  e_2 = |q'|² + q·q'', …
         = D(y0) + e_1 x + x² Q(x)                     Q a polynomial of degree 2d - 2.

**Certificate.** A polynomial is not below its smallest Bernstein coefficient on an interval. Let g be that of Q, on the
part to the left of y0 and on the part to its right. If g > 0 then D ≥ D(y0) - e_1²/4g there: at a zero of e_1, y0 is the
global minimum. At an end of the interval e_1 need not vanish: it is enough that e_1 + x Q(x), whose Bernstein
coefficients are e_1 + (j/m) L Q_{j-1} over a length L (m its degree), has the sign of x.

Counting sign changes of e_1's own Bernstein form looks simpler, but fails where the method spends its time: near
convergence D is almost 0 at y0, a nearly double zero, which D' then has almost twice in a row.

**Search.** An interval of which that cannot be shown is halved. Of all parts the one whose lower bound, the smallest
Bernstein coefficient of D, is least comes next. A part is dropped if its lower bound exceeds the best distance found, if
the certificate holds for its own local minimum, or if its lower bound is below the best distance by less than
``SLACK`` and ``tie``: then no point of it is nearer but for rounding. This is what ends the search where Q vanishes at
the nearest point (p is the centre of curvature, D' has a triple zero), as D is flat there. The ends and the middle of
each part are candidates too: there Newton's method may stop far from the minimum.

**What is certified.** No point of the interval is nearer than the one returned by more than 1e-12 of the size of the
piece, the largest distance of its Bézier points from p. The shares of it: squared distances that differ by less than
``EQUAL`` of them, or by less than ``tie``, count as equal, and the parameter nearest the vertex's own, ``centre``, is
taken; this may happen twice, to a nearer parameter and to a smaller distance. A part may be dropped with a point in it
that is nearer by ``SLACK`` of the squared distance. Together that is 0.55e-12 of the distance. Rounding of q, some 1e-15
of the size, is as good as another curve so near to this one. Rounding of products of q counts against the certificate:
``ROUNDING`` of the summands is taken from every lower bound. ``scripts/adversarial_footpoints.py`` looks for cases in
which this does not hold. Where D is flat the parameter is only as good as the problem lets it be. A search that runs out
of parts (``MOST_PARTS``), or halves one down to ``SHORTEST`` of the interval, returns the best of its candidates as not
certified.
"""

from __future__ import annotations

from math import comb

import numpy as np

from ...compiled import compiled
from ...types import FloatArray
from ..method import TIE

GUARD = 1e-12
"""Share of its size that Q has to exceed in :mod:`.newton_simd`, which takes e_1 for 0 at a zero that it has computed."""

ROUNDING = 1e-14
"""More than the rounding error of a Bernstein coefficient, as a share of the sum of its summands' sizes."""

EQUAL = 0.5 * TIE
"""Share by which squared distances that count as equal may differ, up or down."""

SLACK = 0.1 * TIE
"""Share of the squared distance by which a point of a dropped part may be nearer."""

SHORTEST = 1e-12
NEWTON_STEPS = 24
MOST_PARTS = 128
MAX_DEGREE = 6

BERNSTEIN = np.zeros((2 * MAX_DEGREE + 1, 2 * MAX_DEGREE + 1, 2 * MAX_DEGREE + 1))
"""[m, j, k]: weight of the k-th power's coefficient in Bernstein coefficient j of degree m on [0, 1]."""
for _m in range(2 * MAX_DEGREE + 1):
    for _j in range(_m + 1):
        for _k in range(_j + 1):
            BERNSTEIN[_m, _j, _k] = comb(_j, _k) / comb(_m, _k)
PRODUCTS = np.zeros((MAX_DEGREE + 1, MAX_DEGREE + 1, MAX_DEGREE + 1))
"""[d, i, j]: weight of the product of Bézier points i and j of degree d in a Bernstein coefficient of degree 2d."""
for _d in range(MAX_DEGREE + 1):
    for _i in range(_d + 1):
        for _j in range(_d + 1):
            PRODUCTS[_d, _i, _j] = comb(_d, _i) * comb(_d, _j) / comb(2 * _d, _i + _j)

WORK = (8, MOST_PARTS + 2)
"""Shape of the scratch array: shifted x and y, squared distance, Bézier points, and ends and lower bounds of parts."""


@compiled(internal=True)
def shift(c: FloatArray, d: int, y: float, work: FloatArray) -> None:
    """Coefficients of q about y into work[0], work[1]."""
    for axis in range(2):
        s = work[axis]
        for k in range(d + 1):
            s[k] = c[axis, k]
        for k in range(d):
            for i in range(d - 1, k - 1, -1):
                s[i] += y * s[i + 1]


@compiled(internal=True)
def expand(c: FloatArray, d: int, y: float, work: FloatArray) -> None:
    """Coefficients of q about y into work[0], work[1], and those of |q|² into work[2]."""
    shift(c, d, y, work)
    for k in range(2 * d + 1):
        total = 0.0
        for i in range(max(0, k - d), min(k, d) + 1):
            total += work[0, i] * work[0, k - i] + work[1, i] * work[1, k - i]
        work[2, k] = total


@compiled(internal=True)
def lower_bound(c: FloatArray, d: int, a: float, b: float, work: FloatArray) -> tuple[float, float, float]:
    """A lower bound of D on [a, b], and D at a and at b.

    The Bernstein coefficients of D are sums of products of the Bézier points of q; those from powers of y would carry
    the rounding errors of the largest power.
    """
    shift(c, d, a, work)
    L = b - a
    x, y = work[3], work[4]
    for j in range(d + 1):
        x[j], y[j], power = 0.0, 0.0, 1.0
        for k in range(j + 1):
            x[j] += BERNSTEIN[d, j, k] * work[0, k] * power
            y[j] += BERNSTEIN[d, j, k] * work[1, k] * power
            power *= L
    least = np.inf
    for k in range(2 * d + 1):
        value, size = 0.0, 0.0
        for i in range(max(0, k - d), min(k, d) + 1):
            xx, yy, weight = x[i] * x[k - i], y[i] * y[k - i], PRODUCTS[d, i, k - i]
            value += weight * (xx + yy)
            size += weight * (abs(xx) + abs(yy))
        least = min(least, value - ROUNDING * size)
    return least, x[0] * x[0] + y[0] * y[0], x[d] * x[d] + y[d] * y[d]


@compiled(internal=True)
def proven(work: FloatArray, d: int, L: float, allowed: float) -> bool:
    """Whether D ≥ D(y0) - allowed between 0 and L (either sign), for the expansion about y0 in ``work``."""
    if L == 0.0:
        return True
    e, slope, m = work[2], work[2, 1], 2 * d - 1
    size, power = 0.0, 1.0
    for k in range(d + 1):
        size += (abs(work[0, k]) + abs(work[1, k])) * power
        power *= abs(L)
    q0, q1 = abs(work[0, 0]) + abs(work[1, 0]), (abs(work[0, 1]) + abs(work[1, 1])) * abs(L)
    rounding = ROUNDING * ((size - q0) * (size - q0) + 2.0 * q0 * max(size - q0 - q1, 0.0)) / (L * L)
    least, rises = np.inf, slope * L > 0.0
    for j in range(m):
        value, power = 0.0, 1.0
        for k in range(j + 1):
            value += BERNSTEIN[m - 1, j, k] * e[2 + k] * power
            power *= L
        value -= rounding
        least = min(least, value)
        rises &= abs(slope) + (j + 1) / m * abs(L) * value > 0.0
    return rises or (least > 0.0 and slope * slope <= 4.0 * least * allowed)


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
    if new_D < D * (1 - EQUAL) - tie:
        return new_x, new_D
    if new_D <= D * (1 + EQUAL) + tie and abs(new_x - centre) < abs(x - centre):
        return new_x, min(D, new_D)
    return x, D


@compiled
def search_piece(
    c: FloatArray, d: int, origin: float, low: float, high: float, centre: float, x: float, D: float, tie: float,
    work: FloatArray,
) -> tuple[float, float, bool]:  # fmt: skip
    """Improve the candidate (x, D) by all that the piece has on [low, high].

    Args:
        c: (2, d + 1) coefficients of q by ascending powers of y; parameters are ``origin + y``.
        x, D: the best so far, D = inf if there is none.

    Returns:
        The best now, and whether it is certified (see the module).
    """
    if D < np.inf and lower_bound(c, d, low, high, work)[0] > D * (1 + EQUAL) + tie:
        return x, D, True
    start = min(max(x - origin, low), high)
    y = local_minimum(c, d, low, high, start)
    expand(c, d, y, work)
    x, D = better(x, D, origin + y, work[2, 0], centre, tie)
    allowed = SLACK * work[2, 0] + tie
    if proven(work, d, high - y, allowed) and proven(work, d, low - y, allowed):
        return x, D, True
    bound, D_low, D_high = lower_bound(c, d, low, high, work)
    x, D = better(x, D, origin + low, D_low, centre, tie)
    x, D = better(x, D, origin + high, D_high, centre, tie)
    shift(c, d, start, work)
    probe, D_probe = start, work[0, 0] * work[0, 0] + work[1, 0] * work[1, 0]  # not a local minimum: loses ties
    left, right, bounds = work[5], work[6], work[7]
    left[0], right[0], bounds[0] = low, high, bound
    count, parts, certified = 1, 0, True
    while count > 0:
        next_part = 0
        for k in range(1, count):
            if bounds[k] < bounds[next_part]:
                next_part = k
        a, b, bound = left[next_part], right[next_part], bounds[next_part]
        best = min(D, D_probe)
        if bound > best * (1 + EQUAL) + tie:
            break
        count -= 1
        left[next_part], right[next_part], bounds[next_part] = left[count], right[count], bounds[count]
        if parts > 0:
            y = local_minimum(c, d, a, b, 0.5 * (a + b))
            expand(c, d, y, work)
            x, D = better(x, D, origin + y, work[2, 0], centre, tie)
            best = min(D, D_probe)
            allowed = SLACK * work[2, 0] + tie
            if proven(work, d, b - y, allowed) and proven(work, d, a - y, allowed):
                continue
        nearest = best - SLACK * best - tie
        if bound >= nearest:
            continue
        parts += 1
        if parts > MOST_PARTS or not b - a > SHORTEST * (high - low):
            certified &= nearest <= 0.0
            continue
        middle = 0.5 * (a + b)
        first, _, D_middle = lower_bound(c, d, a, middle, work)
        second, _, _ = lower_bound(c, d, middle, b, work)
        if D_middle < D_probe:
            probe, D_probe = middle, D_middle
        left[count], right[count], bounds[count] = a, middle, first
        left[count + 1], right[count + 1], bounds[count + 1] = middle, b, second
        count += 2
    if D_probe < D * (1 - EQUAL) - tie:
        x, D = origin + probe, D_probe
    return x, D, certified
