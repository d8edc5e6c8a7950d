"""The nearest point of a polynomial piece, certified to be the global one.

With the vertex p moved to the origin a piece is a polynomial q(y) = Σ c_k y^k of degree d, in the plane or in space of
any dimension, and D = |q|² is the squared distance. Expand it about any y0, with x = y - y0:

    D(y) = e_0 + e_1 x + e_2 x² + … + e_2d x^2d        e_0 = D(y0),  e_1 = 2 q·q',  e_2 = |q'|² + q·q'', …
         = D(y0) + e_1 x + x² Q(x)                     Q a polynomial of degree 2d - 2.

**Certificate.** A polynomial is not below its smallest Bernstein coefficient on an interval. Let g be that of Q, on
the part to the left of y0 and on the part to its right. If g > 0 then D ≥ D(y0) - e_1²/4g there: at a zero of e_1, y0
is the global minimum. At an end of the interval e_1 need not vanish: it is enough that e_1 + x Q(x), whose Bernstein
coefficients are e_1 + (j/m) L Q_{j-1} over a length L (m its degree), has the sign of x.

Counting sign changes of e_1's own Bernstein form looks simpler, but fails where the method spends its time: near
convergence D is almost 0 at y0, a nearly double zero, which D' then has almost twice in a row.

**Search.** An interval for which that cannot be shown is halved. Of all parts the one with the least lower bound, the
smallest Bernstein coefficient of D, comes next. A part is dropped if its lower bound exceeds the best distance found,
if the certificate holds for its own local minimum, or if its lower bound is below the best distance by less than
``SLACK`` and ``tie``: then no point of it is nearer but for rounding. This is what ends the search where Q vanishes at
the nearest point (p is the centre of curvature, D' has a triple zero), as D is flat there. The ends and the middle of
each part are candidates too: there Newton's method may stop far from the minimum.

**Any dimension.** D depends on the coefficient vectors c_0, …, c_d only through their inner products, so that any
isometry leaves all of this as it is. The d + 1 vectors span at most d + 1 dimensions. In a space of more
:func:`reduce` turns them into R^(d+1) by an orthogonal reduction, as in a QR decomposition; the search has m ≤ d + 1
coordinates then, whatever the dimension. The inner products themselves would not do: D as a sum of them loses half of
the digits where it is almost 0. The reduced vectors have rounding errors like those of the coordinates.

**What is certified.** No point of the interval is nearer than the one returned by more than 1e-12 of the size of the
piece, the largest distance of its Bézier points from p. Squared distances that differ by less than ``EQUAL`` of them,
or by less than ``tie``, count as equal, and the parameter nearest the vertex's own, ``centre``, is taken: a nearer
parameter may cost that much, and a smaller distance that is not taken as much again. A part may be dropped with a point
in it that is nearer by ``SLACK`` of the squared distance. Together that is 0.55e-12 of the distance. Rounding of q,
some 1e-15 of the size, is as good as another curve so near to this one. Rounding of products of q counts against the
certificate: ``ROUNDING`` of the summands is taken from every lower bound. ``scripts/adversarial_footpoints.py`` looks
for cases in which this does not hold. Where D is flat the parameter is only as good as the problem lets it be. A search
that runs out of parts (``MOST_PARTS``), or halves one down to ``SHORTEST`` of the interval, returns the best of its
candidates as not certified.
"""

from __future__ import annotations

from math import comb

import numpy as np

from ...compiled import compiled, inlined
from ...types import FloatArray
from ..method import TIE

ROUNDING = 1e-14
"""More than the rounding error of a Bernstein coefficient, as a share of the largest of its summands."""

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
"""[d, i, j]: weight of the products of Bézier points i ≤ j of degree d in a Bernstein coefficient of degree 2d."""
for _d in range(MAX_DEGREE + 1):
    for _j in range(_d + 1):
        for _i in range(_j + 1):
            PRODUCTS[_d, _i, _j] = (1 + (_i < _j)) * comb(_d, _i) * comb(_d, _j) / comb(2 * _d, _i + _j)

MOST_COORDINATES = MAX_DEGREE + 1

SQUARED, SCALED, LEFT, RIGHT, BOUNDS, SHIFTED, BEZIER = 0, 1, 2, 3, 4, 5, 5 + MOST_COORDINATES
WORK = (5 + 2 * MOST_COORDINATES, MOST_PARTS + 2)
"""Shape of the scratch array. Its rows: coefficients of D about y, those of Q scaled to a length; ends and lower bounds
of parts; the shifted coordinates of q, from ``SHIFTED`` on; those of its Bézier points, from ``BEZIER`` on.
"""


@inlined
def _product(rows: FloatArray, i: int, j: int, m: int) -> float:
    """The inner product of columns i and j of m ≥ 2 rows."""
    total = rows[0, i] * rows[0, j] + rows[1, i] * rows[1, j]
    for axis in range(2, m):
        total += rows[axis, i] * rows[axis, j]
    return total


@compiled
def reduce(b: FloatArray, c: FloatArray) -> None:
    """Turn d + 1 coefficient vectors, the rows of b (d + 1, more than d + 1), into the columns of c (d + 1, d + 1).

    By Gram and Schmidt's orthogonalisation in its modified form, c_0 last, so that b is destroyed. Whether the vectors
    are independent or not, inner products of the result are those of vectors within some 1e-16 of the given ones.
    """
    order, size = b.shape
    for step in range(order):
        k = step + 1 if step + 1 < order else 0
        squared = 0.0
        for axis in range(size):
            squared += b[k, axis] * b[k, axis]
        length = np.sqrt(squared)
        for row in range(order):
            c[row, k] = c[row, k] if row < step else 0.0
        c[step, k] = length
        inverse = 1.0 / length if length > 0.0 else 0.0
        for axis in range(size):
            b[k, axis] *= inverse
        for later in range(step + 1, order):
            other = later + 1 if later + 1 < order else 0
            along = 0.0
            for axis in range(size):
                along += b[k, axis] * b[other, axis]
            c[step, other] = along
            for axis in range(size):
                b[other, axis] -= along * b[k, axis]


@compiled
def shift(c: FloatArray, d: int, y: float, work: FloatArray) -> None:
    """Coefficients of q about y into the rows of ``work`` from ``SHIFTED`` on."""
    for axis in range(c.shape[0]):
        u = work[SHIFTED + axis]
        for k in range(d + 1):
            u[k] = c[axis, k]
        for k in range(d):
            for i in range(d - 1, k - 1, -1):
                u[i] += y * u[i + 1]


@inlined
def expand(c: FloatArray, d: int, y: float, work: FloatArray) -> None:
    """Coefficients of q about y, and those of |q|², into their rows of ``work``."""
    shift(c, d, y, work)
    out = work[SQUARED]
    for k in range(2 * d + 1):
        out[k] = 0.0
        for i in range(max(0, k - d), k // 2 + 1):
            out[k] += (2.0 if 2 * i < k else 1.0) * _product(work[SHIFTED:], i, k - i, c.shape[0])


@compiled
def lower_bound(c: FloatArray, d: int, a: float, b: float, work: FloatArray) -> tuple[float, float, float]:
    """A lower bound of D on [a, b], and D at a and at b.

    The Bernstein coefficients of D are sums of products of the Bézier points of q; those from powers of y would carry
    the rounding errors of the largest power.
    """
    shift(c, d, a, work)
    points, m, largest, least = work[BEZIER:], c.shape[0], 0.0, np.inf
    for axis in range(m):
        u, x, power = work[SHIFTED + axis], points[axis], 1.0
        for k in range(1, d + 1):
            power *= b - a
            u[k] *= power
        for j in range(d + 1):
            x[j] = u[0]
            for k in range(1, j + 1):
                x[j] += BERNSTEIN[d, j, k] * u[k]
    for j in range(d + 1):
        largest = max(largest, _product(points, j, j, m))
    for k in range(2 * d + 1):
        value = 0.0
        for i in range(max(0, k - d), k // 2 + 1):
            value += PRODUCTS[d, i, k - i] * _product(points, i, k - i, m)
        least = min(least, value)
    return least - ROUNDING * largest, _product(points, 0, 0, m), _product(points, d, d, m)


@compiled
def proven(work: FloatArray, d: int, coordinates: int, L: float, allowed: float) -> bool:
    """Whether D ≥ D(y0) - allowed between 0 and L (either sign), for the expansion about y0 in ``work``.

    Rounding errors of the coefficients of Q are a share of |q'|², |q''|² L², … or of D(y0)/L². The latter are as good
    as equal distances.
    """
    if L == 0.0:
        return True
    e, scaled, rows, m = work[SQUARED], work[SCALED], work[SHIFTED:], 2 * d - 1
    slope = e[1]
    power = 1.0
    for k in range(m):
        scaled[k] = e[2 + k] * power
        power *= L
    squares, power = 0.0, ROUNDING
    for k in range(1, d + 1):
        squares += _product(rows, k, k, coordinates) * power
        power *= L * L
    least, rises = np.inf, slope * L > 0.0
    for j in range(m):
        value = scaled[0] - squares
        for k in range(1, j + 1):
            value += BERNSTEIN[m - 1, j, k] * scaled[k]
        least = min(least, value)
        if not (abs(slope) + (j + 1) / m * abs(L) * value if rises else value) > 0.0:
            return False
    return rises or slope * slope <= 4.0 * least * allowed


@compiled
def local_minimum(c: FloatArray, d: int, low: float, high: float, y: float) -> float:
    """Newton's method for q·q' = 0, kept inside [low, high]; Gauss and Newton's step where D is not convex."""
    for _ in range(NEWTON_STEPS):
        slope = speed = lever = 0.0
        for axis in range(c.shape[0]):
            x0, x1, x2 = c[axis, d], 0.0, 0.0
            for k in range(d - 1, -1, -1):
                x2, x1, x0 = x2 * y + x1, x1 * y + x0, x0 * y + c[axis, k]
            slope += x0 * x1
            speed += x1 * x1
            lever += x0 * x2
        bend = speed + 2 * lever
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


@inlined
def better(x: float, D: float, new_x: float, new_D: float, centre: float, tie: float) -> tuple[float, float]:
    """The nearer of two candidates (parameter, squared distance); in a tie the one nearer ``centre``."""
    if new_D < D * (1 - EQUAL) - tie:
        return new_x, new_D
    if new_D <= D * (1 + EQUAL) + tie and abs(new_x - centre) < abs(x - centre):
        return new_x, min(D, new_D)
    return x, D


@compiled
def search_piece(
    c: FloatArray, d: int, low: float, high: float, centre: float, x: float, D: float, tie: float, work: FloatArray
) -> tuple[float, float, bool]:
    """Improve the candidate (x, D) by all that the piece has on [low, high].

    Args:
        c: (m, d + 1) coefficients of q by ascending powers of y, 2 ≤ m ≤ d + 1.
        x, D: the best so far, D = inf if there is none.

    Returns:
        The best now, and whether it is certified (see the module).
    """
    if np.inf > D and lower_bound(c, d, low, high, work)[0] > D * (1 + EQUAL) + tie:
        return x, D, True
    start = min(max(x, low), high)
    y = local_minimum(c, d, low, high, start)
    expand(c, d, y, work)
    x, D = better(x, D, y, work[SQUARED, 0], centre, tie)
    allowed, m = SLACK * work[SQUARED, 0] + tie, c.shape[0]
    if proven(work, d, m, high - y, allowed) and proven(work, d, m, low - y, allowed):
        return x, D, True
    shift(c, d, start, work)
    probe, D_probe = start, _product(work[SHIFTED:], 0, 0, m)  # not a local minimum: loses ties
    left, right, bounds = work[LEFT], work[RIGHT], work[BOUNDS]
    left[0], right[0], bounds[0] = low, high, -np.inf
    count, parts, certified = 1, 0, True
    while count > 0:
        part = 0
        for k in range(1, count):
            if bounds[k] < bounds[part]:
                part = k
        a, b, bound = left[part], right[part], bounds[part]
        if bound > min(D, D_probe) * (1 + EQUAL) + tie:
            break
        count -= 1
        left[part], right[part], bounds[part] = left[count], right[count], bounds[count]
        if parts > 0:
            y = local_minimum(c, d, a, b, 0.5 * (a + b))
            expand(c, d, y, work)
            x, D = better(x, D, y, work[SQUARED, 0], centre, tie)
            if bound >= min(D, D_probe) * (1 - SLACK) - tie:
                continue
            allowed = SLACK * work[SQUARED, 0] + tie
            if proven(work, d, m, b - y, allowed) and proven(work, d, m, a - y, allowed):
                continue
        parts += 1
        if parts > MOST_PARTS or not b - a > SHORTEST * (high - low):
            certified &= min(D, D_probe) <= tie
            continue
        middle = 0.5 * (a + b)
        first, D_a, D_middle = lower_bound(c, d, a, middle, work)
        second, _, D_b = lower_bound(c, d, middle, b, work)
        if parts == 1:
            x, D = better(x, D, low, D_a, centre, tie)
            x, D = better(x, D, high, D_b, centre, tie)
        if D_middle < D_probe:
            probe, D_probe = middle, D_middle
        left[count], right[count], bounds[count] = a, middle, first
        left[count + 1], right[count + 1], bounds[count + 1] = middle, b, second
        count += 2
    if D_probe < D * (1 - EQUAL) - tie:
        x, D = probe, D_probe
    return x, D, certified and np.inf > D
