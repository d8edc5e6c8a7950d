"""The compiled driver of Algorithm 2: many cubic polygons in R^d in one call, variants 1 to 3, closed or open.

Short polygons are iterated in groups, side by side in one block (:mod:`.blocks`). The passes over a block are
:mod:`.newton_simd` in the plane and :mod:`.gram_simd` in space. A pass reads control points from P and writes the next
ones to N; then P and N change places. Results do not depend on the other polygons of a group. A polygon that is done is
stored; its lanes go on until the group is done, at parameters that stay.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...arrays import grown
from ...compiled import compiled, inlined
from ...intrinsics import borrowed, keep_alive
from ...types import FloatArray, IntArray
from ..method import RELATIVE_TOLERANCE
from ..polygon import LARGEST as LARGEST_EXTENT
from ..polygon import SAME_VERTEX
from ..polygon import SMALLEST as SMALLEST_EXTENT
from ..result import Found
from .blocks import (
    BAD, BLOCK, COUNT, DD, FALLBACKS, FINISHED, HALO, HIGH, INTERVALS, KNOT_UNIT, LANE, LANES, LARGEST, LEAST, LIMIT,
    LOW, NATURAL, PAD, PAIR, PASSES, POLYGON, SCRATCH, SEARCHED, SLOTS, STRIDE, TABLE, UNCERTIFIED, UNIT, WIDTH,
    Coordinates, Given, Group, X, fill_edges, lanes_used, place,
)  # fmt: skip
from .certificate import GIVEN_UP, flagged
from .certificate import SEARCHED as MARK
from .gram_simd import seek_space
from .lemma2 import fill_intervals
from .newton_simd import seek

OK, BAD_POLYGON, BAD_KNOTS = 0, 1, 2
"""Status codes. A refused polygon is checked again in Python to build the error message."""

STATUS, KEPT, ITERATIONS, FALLEN_BACK, SEARCHES, GIVEN_UP_ON = range(6)
"""Columns of ``Found.whole``."""


@compiled
def run(
    k0: int, k1: int, of_given: tuple[Any, ...], of_found: tuple[Any, ...], memory: FloatArray
) -> FloatArray:  # fmt: skip
    """Interpolate polygons k0 to k1 - 1; returns their residuals end to end.

    Args:
        of_given, of_found: the values of :class:`Given` and of :class:`Found`: plain tuples, whose types Numba finds
            in a fraction of the time.
        memory: for the blocks of the largest polygon: ``BLOCK`` numbers for each, and three arrays of coordinates.
    """
    given, found = borrowed(Given(*of_given)), borrowed(Found(*of_found))
    d, closed = given.points.shape[1], given.closed
    size = (d + 1) // 2 * PAIR
    count = memory.shape[0] // (BLOCK + 3 * size)
    owned = Group(
        size, memory[: count * BLOCK], np.zeros(SCRATCH * STRIDE + 2 * WIDTH), np.empty(2 * count * LANES + 8 * WIDTH),
        np.empty((SLOTS, TABLE), dtype=np.int64), np.empty((SLOTS, NATURAL + 2)), np.zeros((4 * SLOTS, d)),
    )  # fmt: skip
    first, second, third = count * BLOCK, count * (BLOCK + size), count * (BLOCK + 2 * size)
    at = borrowed(Coordinates(memory[first:second], memory[second:third], memory[third : third + count * size]))
    group = borrowed(owned)
    history, residuals, used = np.empty(64), np.empty(64), 0
    slots, lane, interval = 0, 0, 0
    for k in range(k0, k1):
        n, unit, knot_unit = prepare(given, found, k)
        if n == 0:
            continue
        if slots > 0 and lane + n > LANES:
            history, residuals, used = _iterate(given, found, group, at, slots, history, residuals, used)
            slots, lane, interval = 0, 0, 0
        row, own, u = group.table[slots], group.numbers[slots], knots_of(given, found, k, n)
        h, spans = group.h[interval:], u.shape[0] - 1
        for i in range(spans):  # h[PAD + i] is the knot interval from u_i on, continued periodically, or by zeros
            h[PAD + i] = (u[i + 1] - u[i]) * knot_unit
        for i in range(PAD):  # one after another: fewer spans than PAD repeat more than once
            h[PAD - 1 - i] = h[PAD + spans - 1 - i] if closed else 0.0
        for i in range(PAD + 2):
            h[PAD + spans + i] = h[PAD + i] if closed else 0.0
        row[POLYGON], row[COUNT], row[LANE], row[INTERVALS], row[FINISHED] = k, n, lane, interval, 0
        row[PASSES] = row[SEARCHED] = row[UNCERTIFIED] = 0
        limit = max(given.tolerances[k], given.settled * u[n - 1] / (n - 1))
        own[UNIT], own[KNOT_UNIT], own[LIMIT] = unit, knot_unit, limit * unit
        slots, lane, interval = slots + 1, lane + n + 2 * HALO, interval + n + 2 * PAD
    if slots > 0:
        history, residuals, used = _iterate(given, found, group, at, slots, history, residuals, used)
    keep_alive(owned)
    return residuals[:used]


@compiled
def _iterate(
    given: Given, found: Found, group: Group, at: Coordinates, slots: int, history: FloatArray, residuals: FloatArray,
    used: int,
) -> tuple[FloatArray, FloatArray, int]:  # fmt: skip
    """Iterate a group until all of its polygons are done, and store them.

    Args:
        history: room for errors; may be replaced by a larger array.
        residuals: the errors of every pass go there, polygon after polygon, from ``used`` on.

    Returns:
        History, residuals, and how many of these are used now.
    """
    place(given, found, group, at, slots)
    fill_intervals(given, found, group, slots)
    table, numbers, left = group.table, group.numbers, slots
    while left > 0:
        at = Coordinates(at.N, at.Q, at.P)
        _one_pass(given, found, group, at, slots)
        for q in range(slots):
            if table[q, FINISHED]:
                continue
            row, error = table[q], np.sqrt(numbers[q, LARGEST])
            history = grown(history, (row[PASSES] + 1) * slots)
            history[row[PASSES] * slots + q] = error / numbers[q, UNIT]
            row[PASSES] += 1
            if np.inf > error and not error < numbers[q, LIMIT] and row[PASSES] <= given.max_iterations:
                continue
            row[FINISHED] = 1
            _store(given, found, group, at.P, q)
            left -= 1
    for q in range(slots):
        count = table[q, PASSES]
        residuals = grown(residuals, used + count)
        for i in range(count):
            residuals[used + i] = history[i * slots + q]
        used += count
    return history, residuals, used


@compiled
def _one_pass(given: Given, found: Found, group: Group, at: Coordinates, slots: int) -> None:
    """Footpoints of all vertices; each polygon's largest squared error, inf if one is not finite, and its searches."""
    S, numbers, d = group.scratch, group.numbers, given.points.shape[1]
    count, size, open_end = -(-group.table[0, COUNT] // LANES), group.size, 0 if given.closed else 1
    for q in range(slots):
        numbers[q, LARGEST] = 0.0
    fill_edges(given, group, at.P, slots)
    for b in range(count):
        block, here, stop = group.blocks[b * BLOCK : (b + 1) * BLOCK], b * size, (b + 1) * size
        P, Q, N = at.P[here:stop], at.Q[here:stop], at.N[here:stop]
        m = lanes_used(group, slots, b)
        bad, wild = seek(block, P, Q, N, S, m) if d == 2 else seek_space(block, P, Q, N, S, d, m)
        for q in range(slots if wild > 0 else 0):  # polygons with an error that is not finite are not searched
            first, n = group.table[q, LANE] + HALO, min(LANES, group.table[q, COUNT] - b * LANES)
            for i in range(n):
                if not np.inf > block[DD + np.uint64(first + i)]:
                    numbers[q, LARGEST] = np.inf
            if numbers[q, LARGEST] == np.inf:
                for i in range(n):
                    S[BAD + np.uint64(first + i)] = 0.0
                group.table[q, UNCERTIFIED] += n
        searched = flagged(block, P, Q, N, S, d, m) if bad > 0 else 0
        for q in range(slots):
            first, n = group.table[q, LANE] + HALO, min(LANES, group.table[q, COUNT] - b * LANES)
            start = given.offsets[group.table[q, POLYGON]]
            for i in range(n if given.held.shape[0] > 0 else 0):  # control points of held vertices stay at them
                if given.held[start + found.kept[start + b * LANES + i]]:
                    for axis in range(d):
                        N[first + i + axis * STRIDE] = Q[first + i + axis * STRIDE]
                    block[DD + np.uint64(first + i)] = 0.0
            for i in range(n if searched > 0 else 0):
                mark = S[BAD + np.uint64(first + i)]
                group.table[q, SEARCHED] += mark >= MARK
                group.table[q, UNCERTIFIED] += mark == GIVEN_UP
            low = open_end if b == 0 else 0
            high = n - open_end if b + 1 == count else n
            for j in range(np.uint64(first + low), np.uint64(first + max(high, low))):
                numbers[q, LARGEST] = max(numbers[q, LARGEST], block[DD + j])
        if count > 1 and numbers[0, LARGEST] == np.inf:
            return


@compiled
def _store(given: Given, found: Found, group: Group, P: FloatArray, q: int) -> None:
    """Results of polygon q in the caller's units; its parameters are held from here on.

    Units are powers of two: multiplying rounds no more than dividing.
    """
    row, numbers, d = group.table[q], group.numbers[q], given.points.shape[1]
    k, n = row[POLYGON], row[COUNT]
    start, first = given.offsets[k], given.offsets[k] if given.closed else given.offsets[k] + 2 * k + 1
    kept, points, u = found.kept[start:], given.points[start:], knots_of(given, found, k, n)
    size, lane0, unit, length = group.size, row[LANE] + HALO, 1.0 / numbers[UNIT], 1.0 / numbers[KNOT_UNIT]
    for i in range(n):
        block, lane = group.blocks[i // LANES * BLOCK :], np.uint64(lane0 + i % LANES)
        for axis in range(d):
            value = P[i // LANES * size + lane0 + i % LANES + axis * STRIDE]
            found.controls[first + i, axis] = value * unit + points[kept[0], axis]
        found.parameters[start + i] = u[i] + block[X + lane] * length
        found.bounds[start + i, 0] = u[i] + block[LOW + lane] * length
        found.bounds[start + i, 1] = u[i] + block[HIGH + lane] * length
        block[LOW + lane] = block[HIGH + lane] = block[X + lane]
    if not given.closed:
        for axis in range(d):
            found.controls[first - 1, axis] = points[kept[0], axis]
            found.controls[first + n, axis] = points[kept[n - 1], axis]
    out = found.whole[k]
    out[STATUS], out[ITERATIONS], out[FALLEN_BACK] = OK, row[PASSES] - 1, row[FALLBACKS]
    out[SEARCHES], out[GIVEN_UP_ON] = row[SEARCHED], row[UNCERTIFIED]
    found.rates[k] = 2.0 * (1.0 - numbers[LEAST])


@inlined
def distance(p: FloatArray, i: int, j: int) -> float:
    """Distance of two vertices. Squares do not overflow within the limits of extents; ``hypot`` doubles the time."""
    squared = (p[i, 0] - p[j, 0]) * (p[i, 0] - p[j, 0]) + (p[i, 1] - p[j, 1]) * (p[i, 1] - p[j, 1])
    for axis in range(2, p.shape[1]):
        squared += (p[i, axis] - p[j, axis]) * (p[i, axis] - p[j, axis])
    return np.sqrt(squared)


@compiled
def _merge(points: FloatArray, closed: bool, kept: IntArray) -> tuple[int, float]:
    """Write the indices of the vertices that are kept; returns their number, -1 for a bad polygon, and the extent."""
    n = points.shape[0]
    if n == 0:
        return -1, 0.0
    x0 = x1 = points[0, 0]
    y0 = y1 = points[0, 1]
    for i in range(n):
        x, y = points[i, 0], points[i, 1]
        if not (np.isfinite(x) and np.isfinite(y)):
            return -1, 0.0
        x0, x1, y0, y1 = min(x0, x), max(x1, x), min(y0, y), max(y1, y)
    extent = max(x1 - x0, y1 - y0)
    for axis in range(2, points.shape[1]):
        x0 = x1 = points[0, axis]
        for i in range(n):
            if not np.isfinite(points[i, axis]):
                return -1, 0.0
            x0, x1 = min(x0, points[i, axis]), max(x1, points[i, axis])
        extent = max(extent, x1 - x0)
    if not SMALLEST_EXTENT <= extent <= LARGEST_EXTENT:
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


@inlined
def knots_of(given: Given, found: Found, k: int, n: int) -> FloatArray:
    """The knots of polygon k."""
    first = given.offsets[k] + (k if given.closed else 0)
    return found.knots[first : first + n + (1 if given.closed else 0)]


@compiled
def prepare(given: Given, found: Found, k: int) -> tuple[int, float, float]:
    """Merge vertices of polygon k and compute its knots, by the rules of ``polygon.py``.

    Returns the number kept, 0 if refused, and two scales, of lengths and of parameters: powers of two that bring extent
    and mean knot interval near 1.
    """
    start, stop, closed = given.offsets[k], given.offsets[k + 1], given.closed
    points, kept = given.points[start:stop], found.kept[start:stop]
    row = found.whole[k]
    row[STATUS], row[ITERATIONS], row[FALLEN_BACK], row[SEARCHES], row[GIVEN_UP_ON] = BAD_POLYGON, -1, 0, 0, 0
    n, extent = _merge(points, closed, kept)
    row[KEPT] = n
    if n < 0:
        return 0, 1.0, 1.0
    if np.isnan(given.tolerances[k]):
        given.tolerances[k] = RELATIVE_TOLERANCE * extent
    u = knots_of(given, found, k, n)
    own = given.knots[start + (k if closed else 0) : stop + (k + 1 if closed else 0)]  # nothing, if there is a rule
    u[0] = 0.0
    for i in range(1, n + 1 if closed else n):
        if given.exponent < 0.0:
            value = own[kept[i] if i < n else own.shape[0] - 1] - own[kept[0]]
        else:
            chord = 1.0 if given.exponent == 0.0 else distance(points, kept[i - 1], kept[i if i < n else 0])
            value = u[i - 1] + (np.sqrt(chord) if given.exponent == 0.5 else chord)
        if not np.inf > value or not value > u[i - 1]:
            row[STATUS] = BAD_KNOTS
            return 0, 1.0, 1.0
        u[i] = value
    return n, math.ldexp(1.0, 1 - math.frexp(extent)[1]), math.ldexp(1.0, 1 - math.frexp(u[-1] / n)[1])
