"""The compiled driver: cubic polygons in R^d one after another in one call, in all variants, closed or open."""

from __future__ import annotations

import math

import numpy as np

from ...arrays import cut, grown, put
from ...compiled import compiled, inlined
from ...intrinsics import borrowed, keep_alive
from ...types import BoolArray, FloatArray, IntArray
from ..method import RELATIVE_TOLERANCE
from ..polygon import LARGEST as LARGEST_EXTENT
from ..polygon import SAME_VERTEX, Polygons
from ..polygon import SMALLEST as SMALLEST_EXTENT
from ..found import Found, Rule, laid_out, rule_of
from .footpoint import WORK
from .lemma2 import LEAST, MISSING, ROOM, TOGETHER, arc_interval, set_intervals
from .passes import AXIS, BLOCK, FREE, HIGH, LANES, LOW, SCRATCH, SUMS, WHOLE, X, clear, one_pass, set_weights
from .search import SearchedCurve, SearchRoom, settle

OK, BAD_POLYGON, BAD_KNOTS = 0, 1, 2
"""Status codes. A refused polygon is checked again in Python to build the error message."""

STATUS, KEPT, ITERATIONS, FALLBACKS, SEARCHES, UNCERTIFIED = range(6)
"""Columns of ``Found.whole``."""

PAD = 4
"""Knot intervals and control points kept before the first vertex and behind the last one: around a closed curve again,
or beyond the ends of an arc.
"""


@compiled
def interpolate(
    k0: int, k1: int, points: FloatArray, offsets: IntArray, knots: FloatArray, tangents: FloatArray, held: BoolArray,
    by_knot: BoolArray, rule_in_numbers: FloatArray, numbers: FloatArray, whole: IntArray,
) -> FloatArray:  # fmt: skip
    """Interpolate polygons k0 to k1 - 1 into the arrays of :func:`.room_for`; returns their residuals end to end.

    The fields of :class:`.Polygons` come one by one, the rule as :attr:`.Method.numbers`: Numba would take named tuples
    apart in the time of three passes over 20 vertices.
    """
    polygons = borrowed(Polygons(points, offsets, knots, tangents, held, by_knot))
    rule = rule_of(borrowed(rule_in_numbers))
    found = laid_out(
        borrowed(numbers), borrowed(whole), points.shape[0], offsets.shape[0] - 1, rule.closed, points.shape[1]
    )
    prepare(k0, k1, polygons, rule, found)
    return iterate(k0, k1, polygons, rule, found)


@compiled
def prepare(k0: int, k1: int, polygons: Polygons, rule: Rule, found: Found) -> None:
    """Merge the vertices of polygons k0 to k1 - 1, compute knots and search intervals, relative to the knots yet."""
    points, offsets, held, by_knot = polygons.points, polygons.offsets, polygons.held, polygons.by_knot
    knots, bounds, kept, closed, most = found.knots, found.bounds, found.kept, rule.closed, 0
    for k in range(k0, k1):
        most = max(most, offsets[k + 1] - offsets[k])
    room = np.empty(ROOM + 10 + most + 2 * PAD)
    R, rest = cut(borrowed(room), ROOM)
    natural, rest = cut(rest, 2)
    ends, h = cut(rest, 8)
    sides = ends.reshape((2, 4))
    for k in range(k0, k1):
        first, last, shift = offsets[k], offsets[k + 1], k if closed else 0
        q, own, row = points[first:last], kept[first:last], found.whole[k]
        u, given = knots[first + shift : last + shift + closed], polygons.knots[first + shift : last + shift + closed]
        row[STATUS], row[ITERATIONS], row[FALLBACKS], row[SEARCHES], row[UNCERTIFIED] = BAD_POLYGON, -1, 0, 0, 0
        n, extent = merge(q, closed, own)
        row[KEPT] = n
        if n < 0:
            continue
        found.tolerances[k] = RELATIVE_TOLERANCE * extent if np.isnan(rule.tolerance) else rule.tolerance
        if not set_knots(q, own, n, closed, rule.exponent, given, u):
            row[STATUS] = BAD_KNOTS
            continue
        row[STATUS] = OK
        set_steps(u, n, closed, 1.0, h)
        if not closed:
            set_natural(polygons.tangents[k], n, h, natural)
        least, peak_share = 1.0, 0.0 if by_knot.shape[0] > 0 and by_knot[k] else rule.peak_share
        start, stop = (0, n) if closed else (1, n - 1)
        bounds[first, 0] = bounds[first, 1] = bounds[first + n - 1, 0] = bounds[first + n - 1, 1] = 0.0
        for begin in range(start, stop, TOGETHER):
            part = bounds[first + begin : first + min(begin + TOGETHER, stop)]
            set_intervals(h, PAD + begin, rule, peak_share, part, R)
            for j in range(part.shape[0]):
                i = begin + j
                if not closed and rule.variant > 1 and not 2 < i < n - 3:  # where fixed functions of an arc reach
                    low, high, value, stands = arc_interval(h, PAD + i, i, n, rule, peak_share, natural, sides)
                    if stands:
                        part[j, 0], part[j, 1], R[LEAST + j], R[MISSING + j] = low, high, value, 0.0
                if held.shape[0] > 0 and held[first + own[i]]:
                    part[j, 0] = part[j, 1] = 0.0
                else:
                    least = min(least, R[LEAST + j])
                    row[FALLBACKS] += 1 if R[MISSING + j] > 0.0 else 0
        found.rates[k] = 2.0 * (1.0 - least)
    keep_alive(room)


@compiled
def iterate(k0: int, k1: int, polygons: Polygons, rule: Rule, found: Found) -> FloatArray:
    """Iterate polygons k0 to k1 - 1 that :func:`prepare` has prepared; returns their residuals end to end."""
    points, offsets, tangents, held = polygons.points, polygons.offsets, polygons.tangents, polygons.held
    knots, bounds, kept, closed, variant = found.knots, found.bounds, found.kept, rule.closed, rule.variant
    d, most, residuals, used = points.shape[1], 0, np.empty(64), 0
    for k in range(k0, k1):
        most = max(most, offsets[k + 1] - offsets[k])
    size, narrow, count = most + 2 * PAD + WHOLE, min(d, 4), (most + LANES - 1) // LANES
    line = np.empty(SCRATCH + 2 + d + 4 * narrow + d * AXIS + size + count * BLOCK)
    tables, corners, work = np.zeros((3, d, size)), np.zeros((2, 4, d)), np.empty(WORK)
    S, rest = cut(borrowed(line), SCRATCH)
    natural, rest = cut(rest, 2)
    e, rest = cut(rest, d)
    c, rest = cut(rest, 4 * narrow)
    T, rest = cut(rest, d * AXIS)
    h, blocks = cut(rest, size)
    p, P, N = borrowed(tables)[0], borrowed(tables)[1], borrowed(tables)[2]
    ends, b = borrowed(corners)[0], borrowed(corners)[1]
    room = SearchRoom(b, c.reshape((narrow, 4)), e, borrowed(work))
    clear(S[SUMS:], SCRATCH - SUMS, min(most, LANES))
    for k in range(k0, k1):
        first, last, shift, row = offsets[k], offsets[k + 1], k if closed else 0, found.whole[k]
        n = row[KEPT]
        if row[STATUS] != OK:
            continue
        q, own, u = points[first:last], kept[first:last], knots[first + shift : last + shift + closed]
        unit, knot_unit = place(q, own, n, u, closed, h, p, P)
        if not closed:
            set_natural(tangents[k], n, h, natural)
            set_ends(tangents[k], unit / knot_unit, n, h, p, natural, ends)
        start, stop = (PAD, PAD + n) if closed else (PAD + 1, PAD + n - 1)
        set_weights(h, start, stop, blocks)
        set_bounds(bounds[first:last], held[first:last], own, n, knot_unit, h, start, blocks)
        passes, limit, width = 0, found.tolerances[k] * unit, 1 if variant == 4 else n
        while True:
            fill_edges(P, n, closed, ends, natural)
            largest, now = 0.0, P
            if variant == 4:  # each vertex sees those before it moved
                put(P, N)
                now = N
            for i in range(start, stop, width):
                part, behind = blocks[(i - start) // LANES * BLOCK + (i - start) % LANES :], min(i + width, stop)
                squared, left = one_pass(now, N, p, part, S, T, i, behind)
                largest = max(largest, squared)
                if left > 0 or variant == 0:
                    squared, searched, uncertified = settle(
                        SearchedCurve(now, p, h), N, part, i, behind, variant == 0, room
                    )
                    largest = max(largest, squared)
                    row[SEARCHES] += searched
                    row[UNCERTIFIED] += uncertified
                if variant == 4:
                    fill_edges(N, n, closed, ends, natural)
            error = np.sqrt(largest)
            residuals = grown(residuals, used + 1)
            residuals[used] = error / unit
            used, passes, done = used + 1, passes + 1, error < limit
            if done and variant == 4:  # the moves of the sweep stand
                P, N = N, P
            if done or not np.inf > error or passes > rule.max_iterations:
                break
            P, N = N, P
        row[ITERATIONS] = passes - 1
        store(q, own, n, u, closed, 1.0 / unit, P, found.controls[first if closed else first + 2 * k :])
        store_footpoints(u, n, 1.0 / knot_unit, start, blocks, found.parameters[first:last], bounds[first:last])
    keep_alive((line, tables, corners, work))
    return residuals[:used]


@compiled
def set_knots(
    q: FloatArray, kept: IntArray, n: int, closed: bool, exponent: float, given: FloatArray, u: FloatArray
) -> bool:
    """Write the knots of a polygon by the rules of ``polygon.py``; whether they are finite and increase."""
    u[0] = 0.0
    for i in range(1, n + 1 if closed else n):
        if exponent < 0.0:
            value = given[kept[i] if i < n else given.shape[0] - 1] - given[kept[0]]
        else:
            chord = 1.0 if exponent == 0.0 else distance(q, kept[i - 1], kept[i if i < n else 0])
            value = u[i - 1] + (np.sqrt(chord) if exponent == 0.5 else chord)
        if not np.inf > value or not value > u[i - 1]:
            return False
        u[i] = value
    return True


@inlined
def distance(p: FloatArray, i: int, j: int) -> float:
    """Distance of two vertices. Squares do not overflow within the limits of extents; ``hypot`` doubles the time."""
    squared = (p[i, 0] - p[j, 0]) * (p[i, 0] - p[j, 0]) + (p[i, 1] - p[j, 1]) * (p[i, 1] - p[j, 1])
    for axis in range(2, p.shape[1]):
        squared += (p[i, axis] - p[j, axis]) * (p[i, axis] - p[j, axis])
    return np.sqrt(squared)


@compiled
def merge(points: FloatArray, closed: bool, kept: IntArray) -> tuple[int, float]:
    """Write the indices of the vertices that are kept; returns their number, -1 for a bad polygon, and the extent."""
    n, extent = points.shape[0], 0.0
    for axis in range(points.shape[1]):
        low, high = np.inf, -np.inf
        for i in range(n):
            if not np.isfinite(points[i, axis]):
                return -1, 0.0
            low, high = min(low, points[i, axis]), max(high, points[i, axis])
        extent = max(extent, high - low)
    if n == 0 or not SMALLEST_EXTENT <= extent <= LARGEST_EXTENT:
        return -1, extent
    apart = SAME_VERTEX * extent
    count, last = 1, 0
    kept[0] = 0
    for i in range(1, n):
        if distance(points, i, last) > apart:
            kept[count] = last = i
            count += 1
    while closed and count > 1:
        last = kept[count - 1]
        if distance(points, last, 0) > apart:
            break
        count -= 1
    if count < 2 or not closed:
        return (count if count >= (3 if closed else 2) else -1), extent
    a, b = kept[0], kept[1]
    for i in range(2, count):
        c = kept[i]
        if distance(points, c, a) > 0.0 and distance(points, c, b) > 0.0:
            return count, extent
    return -1, extent


@compiled
def set_steps(u: FloatArray, n: int, closed: bool, unit: float, h: FloatArray) -> None:
    """Write the knot intervals of n vertices, with those before and behind them: h[PAD + i] is the one after u_i."""
    spans = n if closed else n - 1
    for i in range(spans):
        h[PAD + i] = (u[i + 1] - u[i]) * unit
    for i in range(PAD):  # one after another: fewer spans than PAD repeat more than once
        h[PAD - 1 - i] = h[PAD + spans - 1 - i] if closed else 0.0
    for i in range(n + PAD - spans):
        h[PAD + spans + i] = h[PAD + i] if closed else 0.0


@compiled
def set_natural(tangents: FloatArray, n: int, h: FloatArray, natural: FloatArray) -> None:
    """Write the weights (2,) of the first and the last free control point of an arc in those beside its ends.

    With them the curve has no curvature there; they are 0 at ends with a tangent (2, d), which is not NaN.
    """
    for end in range(2):
        near, beyond = (PAD, PAD + 1) if end == 0 else (PAD + n - 2, PAD + n - 3)
        natural[end] = h[near] / (2.0 * h[near] + h[beyond]) if np.isnan(tangents[end, 0]) and n > 2 else 0.0


@compiled
def unit_of(size: float) -> float:
    """The power of two that brings a size near 1."""
    return math.ldexp(1.0, 1 - math.frexp(size)[1])


@compiled
def place(
    q: FloatArray, kept: IntArray, n: int, u: FloatArray, closed: bool, h: FloatArray, p: FloatArray, P: FloatArray
) -> tuple[float, float]:
    """Write knot intervals, vertices and first control points in units near 1, the first vertex the origin.

    Returns the units of lengths and of parameters: powers of two.
    """
    unit, extent, knot_unit = 1.0, 0.0, unit_of(u[n if closed else n - 1] / n)
    set_steps(u, n, closed, knot_unit, h)
    for axis in range(q.shape[1]):
        low, high = q[kept[0], axis], q[kept[0], axis]
        for i in range(n):
            low, high = min(low, q[kept[i], axis]), max(high, q[kept[i], axis])
        extent = max(extent, high - low)
    unit = unit_of(extent)
    for axis in range(q.shape[1]):
        for i in range(n):
            p[axis, PAD + i] = P[axis, PAD + i] = (q[kept[i], axis] - q[kept[0], axis]) * unit
    return unit, knot_unit


@compiled
def set_ends(
    tangents: FloatArray, scale: float, n: int, h: FloatArray, p: FloatArray, natural: FloatArray, ends: FloatArray
) -> None:
    """Write the control points at the ends of an arc, rows 2 and 3 of (4, d), and what is fixed of those beside them.

    Args:
        tangents: (2, d), NaN for a natural end; scale: of derivatives. natural: see :func:`set_natural`.
    """
    for end in range(2):
        at, other, near, sign = (0, 1, 0, 1.0) if end == 0 else (n - 1, n - 2, n - 2, -1.0)
        for axis in range(p.shape[0]):
            here, tau = p[axis, PAD + at], tangents[end, axis] * scale
            if not np.isnan(tau):
                ends[end, axis] = here + sign * h[PAD + near] / 3.0 * tau
            elif n == 2:
                ends[end, axis] = here + (p[axis, PAD + other] - here) / 3.0
            else:
                ends[end, axis] = (1.0 - natural[end]) * here
            ends[2 + end, axis] = here


@compiled
def set_bounds(
    bounds: FloatArray, held: BoolArray, kept: IntArray, n: int, unit: float, h: FloatArray, start: int,
    blocks: FloatArray,
) -> None:  # fmt: skip
    """Write intervals to the blocks, their inner spans if they are wider, and which vertices are held."""
    first = start - PAD
    for i in range(first, n - first):
        at = (i - first) // LANES * BLOCK + (i - first) % LANES
        low, high = bounds[i, 0] * unit, bounds[i, 1] * unit
        blocks[LOW + at], blocks[HIGH + at] = max(low, -h[PAD + i - 1]), min(high, h[PAD + i])
        if held.shape[0] > 0 and held[kept[i]]:
            blocks[FREE + at] = 0.0


@compiled
def fill_edges(P: FloatArray, n: int, closed: bool, ends: FloatArray, natural: FloatArray) -> None:
    """Write the control points before the first vertex and behind the last one, and those of the ends of an arc."""
    for axis in range(P.shape[0]):
        x = P[axis]
        for k in range(PAD if closed else 0):  # one after another: fewer than PAD repeat more than once
            x[PAD - 1 - k] = x[PAD - 1 - k + n]
            x[PAD + n + k] = x[PAD + k]
        if not closed:
            x[PAD] = ends[0, axis] + natural[0] * x[PAD + 1]
            x[PAD + n - 1] = ends[1, axis] + natural[1] * x[PAD + n - 2]
            x[PAD - 1], x[PAD + n] = ends[2, axis], ends[3, axis]


@compiled
def store(
    q: FloatArray, kept: IntArray, n: int, u: FloatArray, closed: bool, unit: float, P: FloatArray, controls: FloatArray
) -> None:
    """Write control points in the caller's units: powers of two, so that multiplying rounds no more than dividing."""
    shift = 0 if closed else 1
    for axis in range(q.shape[1]):
        origin = q[kept[0], axis]
        for i in range(n):
            controls[shift + i, axis] = P[axis, PAD + i] * unit + origin
        if not closed:
            controls[0, axis], controls[n + 1, axis] = origin, q[kept[n - 1], axis]


@compiled
def store_footpoints(
    u: FloatArray, n: int, unit: float, start: int, blocks: FloatArray, parameters: FloatArray, bounds: FloatArray
) -> None:
    """Write footpoints and intervals in the caller's units, no longer relative to the knots."""
    first = start - PAD
    for i in range(n):
        x = 0.0
        if first <= i < n - first:
            x = blocks[X + (i - first) // LANES * BLOCK + (i - first) % LANES]
        parameters[i], bounds[i, 0], bounds[i, 1] = u[i] + x * unit, u[i] + bounds[i, 0], u[i] + bounds[i, 1]
