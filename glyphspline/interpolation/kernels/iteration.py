"""The iteration of a group of polygons: Algorithm 2 on cubics, and the frozen solve.

A pass applies the moves of the previous pass one block ahead of the block whose footpoints it computes, so that each
block is read into the cache once a pass. Results do not depend on the other polygons of a group. A polygon that is done
is stored, and the lanes of the others are compacted.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...intrinsics import select
from ...types import FloatArray
from .anderson import accelerate
from .blocks import (
    BLOCK, COUNT, DD, FALLBACKS, FOUR, HALO, HIGH, KNOT_UNIT, LANE, LANES, LARGEST, LEAST, LIMIT, LOW, ONE, ORDER,
    PASSES, POLYGON, PX, PY, SEARCHED, STATE, THREE, TOTAL, TWO, UNCERTIFIED, UNIT, Found, Given, Group, X, close_ranks,
    fill_halos, lanes_used, move, whole_vectors,
)  # fmt: skip
from .certificate import GIVEN_UP, flagged
from .certificate import SEARCHED as MARK
from .collocation import solve
from .newton_simd import BAD, seek
from .vertices import FALLEN_BACK, ITERATIONS, OK, STATUS, knots_of
from .vertices import SEARCHED as SEARCHES
from .vertices import UNCERTIFIED as GIVEN_UP_ON

RUNNING, SOLVED_ONCE, SOLVED, DONE = range(4)
"""States of a polygon."""

GO_ON, SOLVE, STORE = range(3)
"""What follows a pass."""

POLISHED = 1e-14
"""A frozen solve whose error is not below this share of the extent is done a second time, for its rounding errors."""

SPARSE = 0.75
"""Share of the lanes in use below which they are compacted. Copying all fields takes a quarter of a pass."""


@compiled
def largest(block: FloatArray, low: int, high: int) -> float:
    """The largest squared distance in lanes low to high - 1, by four, as each comparison waits for the one before."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    start, stop = DD + np.uint64(low), DD + np.uint64(high)
    quads = start + (stop - start) // FOUR * FOUR
    for j in range(start, quads, FOUR):
        w, x, y, z = block[j], block[j + ONE], block[j + TWO], block[j + THREE]
        a, b, c, d = select(w > a, w, a), select(x > b, x, b), select(y > c, y, c), select(z > d, z, d)
    for j in range(quads, stop):
        a = select(block[j] > a, block[j], a)
    a, c = select(b > a, b, a), select(d > c, d, c)
    return select(c > a, c, a)


@compiled
def pass_over(group: Group, block: FloatArray, S: FloatArray, marks: np.uint64, slots: int, b: int) -> None:
    """Note which polygons have an error in block b that is not finite: they are not searched.

    Args:
        marks: where in S the flags of the vertices begin.
    """
    table, numbers = group.table, group.numbers
    for q in range(slots):
        first, n = table[q, LANE] + HALO, min(LANES, table[q, COUNT] - b * LANES)
        for i in range(n):
            if not np.inf > block[DD + np.uint64(first + i)]:
                numbers[q, LARGEST] = np.inf
        if numbers[q, LARGEST] == np.inf:
            for i in range(n):
                S[marks + np.uint64(first + i)] = 0.0
            table[q, UNCERTIFIED] += n


@compiled
def take_in(
    given: Given, group: Group, block: FloatArray, S: FloatArray, marks: np.uint64, slots: int, b: int, searched: int
) -> None:
    """Each polygon's largest squared error so far, with those of block b, and its searches if any were ``searched``."""
    table, numbers = group.table, group.numbers
    count = (table[0, COUNT] + LANES - 1) // LANES
    for q in range(slots):
        first, n = table[q, LANE] + HALO, min(LANES, table[q, COUNT] - b * LANES)
        for i in range(n if searched > 0 else 0):
            mark = S[marks + np.uint64(first + i)]
            table[q, SEARCHED] += mark >= MARK
            table[q, UNCERTIFIED] += mark == GIVEN_UP
        open_end = 0 if given.closed else 1
        low = open_end if b == 0 else 0
        high = n - open_end if b + 1 == count else n
        D = largest(block, first + low, first + high) if high > low else 0.0
        numbers[q, LARGEST] = max(numbers[q, LARGEST], D)


@compiled
def _one_pass(given: Given, group: Group, slots: int) -> None:
    """Moves, then footpoints of all vertices; each polygon's largest squared error, inf if one is not finite."""
    S, table, numbers = group.scratch, group.table, group.numbers
    count = (table[0, COUNT] + LANES - 1) // LANES
    for q in range(slots):
        numbers[q, LARGEST] = 0.0
    moved = 0  # the first block of a closed polygon needs the last one moved
    for b in range(count):
        while moved < min(b + (3 if given.closed else 2), count):
            move(given, group, slots, (moved + count - 1) % count if given.closed else moved)
            moved += 1
        fill_halos(given, group, slots, b)
        block = group.blocks[b * BLOCK : (b + 1) * BLOCK]
        m = whole_vectors(lanes_used(group, slots, b))
        bad, wild = seek(block, S, m)
        if wild > 0:
            pass_over(group, block, S, BAD, slots, b)
        searched = flagged(block, S, m) if bad > 0 else 0
        take_in(given, group, block, S, BAD, slots, b, searched)
        if count > 1 and numbers[0, LARGEST] == np.inf:
            return


@compiled
def _store(given: Given, found: Found, group: Group, q: int) -> None:
    """Results of polygon q in the caller's units; its parameters are held from here on.

    Units are powers of two: multiplying rounds no more than dividing.
    """
    k, n, row = group.table[q, POLYGON], group.table[q, COUNT], group.numbers[q]
    start, first = given.offsets[k], given.offsets[k] if given.closed else given.offsets[k] + 2 * k + 1
    at = start + found.kept[start]
    size, x0, y0 = 1.0 / row[UNIT], given.points[at, 0], given.points[at, 1]
    for i in range(n):
        block, lane = group.blocks[i // LANES * BLOCK :], np.uint64(group.table[q, LANE] + i % LANES + HALO)
        found.controls[first + i, 0] = block[PX + lane] * size + x0
        found.controls[first + i, 1] = block[PY + lane] * size + y0
    if not given.closed:
        for axis in range(2):
            found.controls[first - 1, axis] = given.points[at, axis]
            found.controls[first + n, axis] = given.points[start + found.kept[start + n - 1], axis]
    store_rest(given, found, group, q)


@compiled
def store_rest(given: Given, found: Found, group: Group, q: int) -> None:
    """What does not depend on the dimension of the results of polygon q."""
    k, n, row = group.table[q, POLYGON], group.table[q, COUNT], group.numbers[q]
    start, u, length = given.offsets[k], knots_of(given, found, k, n), 1.0 / row[KNOT_UNIT]
    for i in range(n if group.table[q, STATE] == RUNNING else 0):
        block, lane = group.blocks[i // LANES * BLOCK :], np.uint64(group.table[q, LANE] + i % LANES + HALO)
        found.parameters[start + i] = u[i] + block[X + lane] * length
        found.bounds[start + i, 0] = u[i] + block[LOW + lane] * length
        found.bounds[start + i, 1] = u[i] + block[HIGH + lane] * length
        block[LOW + lane] = block[HIGH + lane] = block[X + lane]
    out = found.whole[k]
    out[STATUS], out[ITERATIONS], out[FALLEN_BACK] = OK, group.table[q, PASSES] - 1, group.table[q, FALLBACKS]
    out[SEARCHES], out[GIVEN_UP_ON] = group.table[q, SEARCHED], group.table[q, UNCERTIFIED]
    found.rates[k] = 2.0 * (1.0 - row[LEAST])


@compiled
def grown(array: FloatArray, size: int) -> FloatArray:
    """The array, or a larger one of at least ``size`` that begins with it."""
    if array.shape[0] >= size:
        return array
    larger = np.empty(2 * size)
    for i in range(array.shape[0]):
        larger[i] = array[i]
    return larger


@compiled
def judged(given: Given, group: Group, q: int, history: FloatArray, every: int) -> int:
    """Record the error of polygon q; whether it has another pass, is solved with its footpoints frozen, or is done."""
    table, n = group.table, group.table[q, COUNT]
    state, error = table[q, STATE], np.sqrt(group.numbers[q, LARGEST])
    if state == SOLVED_ONCE and not error < POLISHED:
        return SOLVE
    history[table[q, PASSES] * every + table[q, ORDER]] = error / group.numbers[q, UNIT]
    table[q, PASSES] += 1
    if state == RUNNING:
        finite = np.inf > error
        if finite and not error < group.numbers[q, LIMIT] and table[q, PASSES] <= given.max_iterations:
            return GO_ON
        if given.solve and finite and n > (0 if given.closed else 2):
            return SOLVE
    return STORE


@compiled
def settle(group: Group, q: int, good: bool, first: bool) -> None:
    """Note that the frozen system of polygon q is solved: it may be once more after the first time, if it was good."""
    group.table[q, STATE] = SOLVED_ONCE if good and first else SOLVED


@compiled
def mark_done(group: Group, q: int) -> None:
    """Note that polygon q is done."""
    table = group.table
    table[q, STATE], table[table[q, ORDER], TOTAL] = DONE, table[q, PASSES]


@compiled
def start_all(group: Group, slots: int) -> None:
    """All polygons of a group before their first pass."""
    for q in range(slots):
        group.table[q, STATE], group.table[q, ORDER] = RUNNING, q
        group.table[q, PASSES] = group.table[q, SEARCHED] = group.table[q, UNCERTIFIED] = 0


@compiled
def collected(
    group: Group, slots: int, history: FloatArray, residuals: FloatArray, used: int
) -> tuple[FloatArray, int]:
    """The residuals with those of a group after the first ``used``, polygon after polygon; how many these are then."""
    for q in range(slots):
        count = group.table[q, TOTAL]
        residuals = grown(residuals, used + count)
        for i in range(count):
            residuals[used + i] = history[i * slots + q]
        used += count
    return residuals, used


@compiled
def _after_pass(given: Given, found: Found, group: Group, q: int, history: FloatArray, every: int) -> bool:
    """Record the error of polygon q, prepare its next pass, or store it; whether it is done."""
    running = group.table[q, STATE] == RUNNING
    what = judged(given, group, q, history, every)
    if what == GO_ON and given.accelerate:
        error = np.sqrt(group.numbers[q, LARGEST])
        accelerate(group, q, given.closed, error, group.table[q, PASSES] == 1)
    if what == STORE or (what == SOLVE and running):
        _store(given, found, group, q)
    if what == SOLVE:
        settle(group, q, solve(group, q, given.closed), running)
    if what == STORE:
        mark_done(group, q)
    return what == STORE


@compiled
def iterate(
    given: Given, found: Found, group: Group, slots: int, history: FloatArray, residuals: FloatArray, used: int
) -> tuple[FloatArray, FloatArray, int]:
    """Iterate a group until all of its polygons are done, and store them.

    Args:
        history: room for errors; may be replaced by a larger array.
        residuals: the errors of every pass go there, polygon after polygon, from ``used`` on.

    Returns:
        History, residuals, and how many of these are used now.
    """
    table, every, left = group.table, slots, slots
    start_all(group, slots)
    while left > 0:
        _one_pass(given, group, slots)
        lanes = 0
        for q in range(slots):
            if table[q, STATE] == DONE:
                continue
            history = grown(history, (table[q, PASSES] + 1) * every)
            if _after_pass(given, found, group, q, history, every):
                left -= 1
            else:
                lanes += table[q, COUNT] + 2 * HALO
        if left < slots and lanes <= SPARSE * (table[slots - 1, LANE] + table[slots - 1, COUNT] + 2 * HALO):
            slots = close_ranks(group, slots, DONE)
    residuals, used = collected(group, every, history, residuals, used)
    return history, residuals, used
