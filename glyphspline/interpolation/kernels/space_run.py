"""Many cubic polygons in R^d, d > 2, in one compiled call: what :mod:`.run` and :mod:`.iteration` do in the plane.

Knots, intervals and weights are those of a plane polygon, in the same blocks of vertices. The coordinates are beside
them, in arrays of all blocks, coordinate after coordinate: P, Q and N of :mod:`.gram_simd`. Each pass writes the next
control points to N, and P and N change places: so each is read and written as seldom as can be.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...intrinsics import borrowed, keep_alive
from ...types import FloatArray, IntArray
from .blocks import (
    BLOCK, COUNT, END, EX, EY, HALO, INTERVALS, KNOT_UNIT, LANE, LANES, LARGEST, NATURAL, PAD, PASSES,
    POLYGON, SLOTS, STATE, STRIDE, TOTAL, UNIT, WIDTH, Found, Given, Group, clear, close_ranks,
    lanes_used, place_weights, repeated, whole_vectors,
)  # fmt: skip
from .collocation import ROW, solve
from .footpoint import WORK
from .gram_simd import BAD, PAIR, SECOND, SPACE_SCRATCH, flagged_space, seek_space
from .iteration import (
    DONE, RUNNING, SOLVE, SPARSE, STORE, collected, grown, judged, mark_done, pass_over, settle, start_all, store_rest,
    take_in,
)  # fmt: skip
from .lemma2 import fill_intervals
from .run import enter
from .vertices import prepare

BESIDE, LAST = 0, 2
"""Rows of a polygon's ends (4, d): of both ends of an open arc the rest of the control point beside it, and the end."""


@compiled
def _size(d: int) -> int:
    """Numbers in ``space`` for a block."""
    return (d + 1) // 2 * PAIR


@compiled
def _place(
    given: Given, found: Found, group: Group, N: FloatArray, Q: FloatArray, ends: FloatArray, slots: int
) -> None:
    """Vertices and first control points of a group's polygons, beside their weights."""
    d, size = given.points.shape[1], _size(given.points.shape[1])
    count = (group.table[0, COUNT] + LANES - 1) // LANES
    clear(group)
    for j in range(count * size):
        N[j] = Q[j] = 0.0
    for q in range(slots):
        k, n, unit = group.table[q, POLYGON], group.table[q, COUNT], group.numbers[q, UNIT]
        kept, first = found.kept[given.offsets[k] :], group.table[q, LANE] + HALO
        points = given.points[given.offsets[k] :]
        for i in range(n):
            at, p = np.uint64(i // LANES * size + first + i % LANES), points[kept[i]]
            for axis in range(d):
                N[at] = Q[at] = (p[axis] - points[kept[0], axis]) * unit
                at += np.uint64(STRIDE)
        place_weights(group, q)
        if not given.closed:
            _place_ends(given, found, group, ends[4 * q : 4 * q + 4], q)


@compiled
def _place_ends(given: Given, found: Found, group: Group, ends: FloatArray, q: int) -> None:
    """The ends of an open arc: fixed points, and the control points beside them, by tangent or natural."""
    k, n, row = group.table[q, POLYGON], group.table[q, COUNT], group.numbers[q]
    points, kept = given.points[given.offsets[k] :], found.kept[given.offsets[k] :]
    h = group.h[group.table[q, INTERVALS] + PAD :]
    for end in range(2):
        at, near, beyond, other = (0, 0, 1, 1) if end == 0 else (n - 1, n - 2, n - 3, n - 2)
        row[NATURAL + end] = 0.0
        if np.isnan(given.tangents[k, end, 0]) and n > 2:
            row[NATURAL + end] = h[near] / (2.0 * h[near] + h[beyond])
        for axis in range(points.shape[1]):
            origin = points[kept[0], axis]
            here = (points[kept[at], axis] - origin) * row[UNIT]
            there = (points[kept[other], axis] - origin) * row[UNIT]
            tau = given.tangents[k, end, axis] * row[UNIT] / row[KNOT_UNIT]
            if not np.isnan(tau):
                rest = here + (1.0 if end == 0 else -1.0) * h[near] / 3.0 * tau
            elif n == 2:
                rest = here + (there - here) / 3.0
            else:
                rest = (1.0 - row[NATURAL + end]) * here
            ends[BESIDE + end, axis], ends[LAST + end, axis] = rest, here


@compiled
def _surround(given: Given, group: Group, P: FloatArray, ends: FloatArray, slots: int) -> None:
    """The control points beside the ends of open arcs, which follow their neighbours; then those in the halos."""
    d, size, table = given.points.shape[1], _size(given.points.shape[1]), group.table
    count = (table[0, COUNT] + LANES - 1) // LANES
    for q in range(slots):
        n, first = table[q, COUNT], table[q, LANE] + HALO
        for end in range(0 if given.closed else 2):
            at, free, out = (0, 1, -1) if end == 0 else (n - 1, n - 2, 1)
            here, by = at // LANES * size + first + at % LANES, free // LANES * size + first + free % LANES
            for axis in range(d):
                step = axis * STRIDE
                P[step + here] = ends[4 * q + end, axis] + group.numbers[q, NATURAL + end] * P[step + by]
                P[step + here + out] = ends[4 * q + LAST + end, axis]
                P[step + here + 2 * out] = 0.0
    for b in range(count):
        for q in range(slots):
            n, first = table[q, COUNT], table[q, LANE]
            inside = min(LANES, n - b * LANES)
            for k in range(4):
                to = first + (k if k < 2 else inside + k)
                i = repeated(b * LANES + to - first - HALO, n, given.closed)
                if i < 0:
                    continue
                owner = min(i, n - 1)
                at = owner // LANES * size + first + owner % LANES + HALO + i - owner
                to += b * size
                for axis in range(0, d * STRIDE, STRIDE):
                    P[to + axis] = P[at + axis]


@compiled
def _one_pass(
    given: Given, group: Group, P: FloatArray, Q: FloatArray, N: FloatArray, ends: FloatArray, slots: int,
    b4: FloatArray, c: FloatArray, work: FloatArray,
) -> None:  # fmt: skip
    """Footpoints of all vertices; each polygon's largest squared error, inf if one is not finite."""
    S, table, numbers, d = group.scratch, group.table, group.numbers, given.points.shape[1]
    count, size = (table[0, COUNT] + LANES - 1) // LANES, _size(d)
    for q in range(slots):
        numbers[q, LARGEST] = 0.0
    _surround(given, group, P, ends, slots)
    for b in range(count):
        block, at, to = group.blocks[b * BLOCK : (b + 1) * BLOCK], b * size, (b + 1) * size
        m = whole_vectors(lanes_used(group, slots, b))
        bad, wild = seek_space(block, P[at:to], Q[at:to], N[at:to], S, d, m)
        if wild > 0:
            pass_over(group, block, S, BAD, slots, b)
        searched = 0
        if bad > 0:
            searched = flagged_space(block, P[at:to], Q[at:to], N[at:to], S, d, m, b4, c, work)
        take_in(given, group, block, S, BAD, slots, b, searched)
        if count > 1 and numbers[0, LARGEST] == np.inf:
            return


@compiled
def _store(given: Given, found: Found, group: Group, P: FloatArray, q: int) -> None:
    """Results of polygon q in the caller's units."""
    k, n, row, d = group.table[q, POLYGON], group.table[q, COUNT], group.numbers[q], given.points.shape[1]
    start, first = given.offsets[k], given.offsets[k] if given.closed else given.offsets[k] + 2 * k + 1
    at, size, lane, unit = start + found.kept[start], _size(d), group.table[q, LANE] + HALO, 1.0 / row[UNIT]
    for i in range(n):
        for axis in range(d):
            value = P[i // LANES * size + lane + i % LANES + axis * STRIDE]
            found.controls[first + i, axis] = value * unit + given.points[at, axis]
    if not given.closed:
        for axis in range(d):
            found.controls[first - 1, axis] = given.points[at, axis]
            found.controls[first + n, axis] = given.points[start + found.kept[start + n - 1], axis]
    store_rest(given, found, group, q)


@compiled
def _solve(given: Given, group: Group, P: FloatArray, N: FloatArray, q: int) -> bool:
    """The frozen system of polygon q for all coordinates, two at a time: N = P + its solution. False if singular."""
    d, size, n, first = given.points.shape[1], _size(given.points.shape[1]), group.table[q, COUNT], group.table[q, LANE]
    good = True
    for axis in range(0, d, 2):
        for back in range(2):
            if back == 1:
                good &= solve(group, q, given.closed)
            for i in range(n):
                lane = np.uint64(first + HALO + i % LANES)
                block, x = group.blocks[i // LANES * BLOCK :], np.uint64(i // LANES * size + axis * STRIDE) + lane
                y = x + SECOND
                if back == 0:
                    block[EX + lane], block[EY + lane] = N[x] - P[x], N[y] - P[y]
                else:
                    N[x], N[y] = P[x] + block[EX + lane], P[y] + block[EY + lane]
    return good


@compiled
def _after_pass(
    given: Given, found: Found, group: Group, P: FloatArray, N: FloatArray, q: int, history: FloatArray, every: int
) -> bool:
    """Record the error of polygon q, prepare its next pass, or store it; whether it is done."""
    running = group.table[q, STATE] == RUNNING
    what = judged(given, group, q, history, every)
    if what == STORE or (what == SOLVE and running):
        _store(given, found, group, P, q)
    if what == SOLVE:
        settle(group, q, _solve(given, group, P, N, q), running)
    if what == STORE:
        mark_done(group, q)
    return what == STORE


@compiled
def _close_ranks(group: Group, P: FloatArray, Q: FloatArray, ends: FloatArray, d: int, slots: int) -> int:
    """Move the polygons that are not done to the front of their block, in order; returns their number."""
    left, to = 0, 0
    for q in range(slots):
        if group.table[q, STATE] == DONE:
            continue
        lane, size = group.table[q, LANE], group.table[q, COUNT] + 2 * HALO
        for field in range(0, d * STRIDE, STRIDE):
            for j in range(size):
                P[field + to + j], Q[field + to + j] = P[field + lane + j], Q[field + lane + j]
        ends[4 * left : 4 * left + 4] = ends[4 * q : 4 * q + 4]
        left, to = left + 1, to + size
    return close_ranks(group, slots, DONE)


@compiled
def _iterate(
    given: Given, found: Found, group: Group, P: FloatArray, Q: FloatArray, N: FloatArray, ends: FloatArray,
    slots: int, history: FloatArray, residuals: FloatArray, used: int,
) -> tuple[FloatArray, FloatArray, int]:  # fmt: skip
    """As :func:`.iteration.iterate`. The first control points are those in N."""
    table, every, left, d = group.table, slots, slots, given.points.shape[1]
    b, c, work = np.empty((4, d)), np.empty((min(d, 4), 4)), np.empty(WORK)
    start_all(group, slots)
    while left > 0:
        P, N = N, P
        _one_pass(given, group, P, Q, N, ends, slots, b, c, work)
        lanes = 0
        for q in range(slots):
            if table[q, STATE] == DONE:
                continue
            history = grown(history, (table[q, PASSES] + 1) * every)
            if _after_pass(given, found, group, P, N, q, history, every):
                left -= 1
            else:
                lanes += table[q, COUNT] + 2 * HALO
        if left < slots and lanes <= SPARSE * (table[slots - 1, LANE] + table[slots - 1, COUNT] + 2 * HALO):
            slots = _close_ranks(group, N, Q, ends, d, slots)
    residuals, used = collected(group, every, history, residuals, used)
    return history, residuals, used


@compiled
def run_space(
    k0: int, k1: int, points: FloatArray, offsets: IntArray, own_knots: FloatArray, tangents: FloatArray, closed: bool,
    variant: int, margin: float, exponent: float, peak_shares: FloatArray, tolerances: FloatArray, max_iterations: int,
    solve: bool, knots: FloatArray, controls: FloatArray, parameters: FloatArray, bounds: FloatArray, kept: IntArray,
    whole: IntArray, rates: FloatArray,
) -> FloatArray:  # fmt: skip
    """Interpolate polygons k0 to k1 - 1; arguments and result are those of :func:`.run.run`, with points (N, d).

    There is no Anderson acceleration here.
    """
    d = points.shape[1]
    given = Given(
        borrowed(points), borrowed(offsets), borrowed(own_knots), borrowed(tangents), closed, variant, margin, exponent,
        borrowed(peak_shares), borrowed(tolerances), max_iterations, solve, False,
    )  # fmt: skip
    found = Found(
        borrowed(knots), borrowed(controls), borrowed(parameters), borrowed(bounds), borrowed(kept), borrowed(whole),
        borrowed(rates),
    )  # fmt: skip
    most = LANES
    for k in range(k0, k1):
        most = max(most, offsets[k + 1] - offsets[k])
    count = (most + LANES - 1) // LANES
    blocks, coordinates = np.empty(count * BLOCK), np.zeros(3 * count * _size(d))
    scratch, h = np.zeros(SPACE_SCRATCH * STRIDE + 2 * WIDTH), np.empty(2 * most + 8 * WIDTH)
    rows, numbers = np.empty((most + WIDTH if solve else 0, ROW)), np.empty((SLOTS, END + 4))
    table, ends = np.empty((SLOTS, TOTAL + 1), dtype=np.int64), np.zeros((4 * SLOTS, d))
    nothing = np.empty((0, 0))
    group = Group(
        borrowed(blocks), borrowed(scratch), borrowed(h), borrowed(rows), borrowed(table), borrowed(numbers),
        borrowed(nothing), borrowed(nothing),
    )  # fmt: skip
    fixed, all_three, third = borrowed(ends), borrowed(coordinates), count * _size(d)
    P, Q, N = all_three[:third], all_three[third : 2 * third], all_three[2 * third :]
    history, residuals = np.empty(64), np.empty(64)
    zero = k0 - k0  # of the type of a variable: functions would be compiled for the constant 0, and again for others
    used = slots = lane = at = zero
    for k in range(k0, k1 + 1):
        n, unit, knot_unit = prepare(given, found, k) if k < k1 else (zero, 1.0, 1.0)
        if k < k1 and n == 0:
            continue
        if slots > 0 and (k == k1 or lane + n + 2 * HALO > LANES + 2 * HALO):
            _place(given, found, group, N, Q, fixed, slots)
            fill_intervals(given, group, slots)
            history, residuals, used = _iterate(given, found, group, P, Q, N, fixed, slots, history, residuals, used)
            slots = lane = at = zero
        if k == k1:
            break
        enter(given, found, group, slots, k, n, lane, at, unit, knot_unit)
        slots, lane, at = slots + 1, lane + n + 2 * HALO, at + n + 2 * PAD
    keep_alive((blocks, coordinates, scratch, h, rows, table, numbers, nothing, ends))
    return residuals[:used]
