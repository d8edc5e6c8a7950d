"""Blocks: consecutive vertices of polygons in memory, field after field, for loops that become SIMD.

A polygon of n ≤ LANES vertices has n + 4 consecutive lanes of a block: two lanes of halo, its vertices, two lanes of
halo. Several polygons lie end to end in one block; a longer polygon has a row of blocks, LANES vertices in each. A halo
repeats the two vertices beyond either end, so that a loop over all lanes needs no test for the end of a polygon; its
results in the halos are not used. The stride of a field is constant, which proves to the compiler that fields do not
overlap.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled, inlined
from ...intrinsics import select
from ...types import FloatArray, IntArray

LANES = 128
HALO = 2
STRIDE = 136
"""At least LANES + 2 HALO, and such that the fields of a lane fall into different sets of a cache."""

WIDTH = 8
"""Loops run over multiples of this number of lanes: whole vectors. Lanes beyond the last polygon are zero."""

SLOTS = (LANES + 2 * HALO) // (2 + 2 * HALO)
"""Maximum number of polygons in a block."""

# The fields of a vertex, kept between passes: control point, vertex, rates and weights of newton_simd.py, interval and
# footpoint (relative to its knot), error p - C(t) and its square.
PX, PY, QX, QY, RATE, LAMBDA, MOVE_A, MOVE_B, HALF, THIRD, LOW, HIGH, X, EX, EY, DD = (
    np.uint64(k * STRIDE) for k in range(16)
)
FIELDS = 16
BLOCK = FIELDS * STRIDE
SCRATCH = 21
"""Number of fields of the scratch block, determined by ``lemma2``."""

PAD = 4
"""Knot intervals kept before the first and after the last one."""

POLYGON, COUNT, LANE, INTERVALS, STATE, PASSES, SEARCHED, UNCERTIFIED, FALLBACKS, ORDER, TOTAL = range(11)
"""Columns of ``Group.table``: index of the polygon, vertices, first lane, where in ``Group.h`` its intervals begin,
state, passes, full searches, those not certified, fallbacks, its first row; and the passes in all of the polygon that
had this row at first.
"""

UNIT, KNOT_UNIT, LIMIT, LEAST, LARGEST, NATURAL, BASE, END = 0, 1, 2, 3, 4, 5, 7, 11
"""Columns of ``Group.numbers``: scales of lengths and parameters, the error to stop below, the least B_i on its
interval, the largest squared error; of both ends of an open arc the weight of the free control point in the one beside
the end, the rest of that one (x and y), and the end itself.
"""

ONE, TWO, THREE, FOUR, EIGHT = (np.uint64(k) for k in (1, 2, 3, 4, 8))


class Given(NamedTuple):
    """Input; see :func:`.run.run`."""

    points: FloatArray
    offsets: IntArray
    knots: FloatArray
    tangents: FloatArray
    closed: bool
    variant: int
    margin: float
    exponent: float
    peak_shares: FloatArray
    tolerances: FloatArray
    max_iterations: int
    solve: bool
    accelerate: bool


class Found(NamedTuple):
    """Results; see :func:`.run.run`."""

    knots: FloatArray
    controls: FloatArray
    parameters: FloatArray
    bounds: FloatArray
    kept: IntArray
    whole: IntArray
    rates: FloatArray


class Group(NamedTuple):
    """The polygons that are iterated together: several short ones in one block, or a long one in a row of blocks.

    Attributes:
        blocks, scratch: see the module. h: knot intervals of all of them, each with PAD more at either end.
        rows: (n, ...) the frozen system. table, numbers: a row for each polygon; columns as above.
        memory, mixing: of :mod:`.anderson`; empty if nothing is accelerated.
    """

    blocks: FloatArray
    scratch: FloatArray
    h: FloatArray
    rows: FloatArray
    table: IntArray
    numbers: FloatArray
    memory: FloatArray
    mixing: FloatArray


@inlined
def whole_vectors(count: int) -> int:
    """``count``, rounded up to a multiple of ``WIDTH``."""
    return (count + WIDTH - 1) // WIDTH * WIDTH


@compiled
def lanes_used(group: Group, slots: int, b: int) -> int:
    """Lanes of block b from the first vertex to the last one."""
    table = group.table
    if table[0, COUNT] > LANES:
        return min(LANES, table[0, COUNT] - b * LANES)
    return table[slots - 1, LANE] + table[slots - 1, COUNT]


@compiled
def place(given: Given, found: Found, group: Group, slots: int) -> None:
    """Vertices, first control points, rates and weights of a group's polygons into their blocks."""
    clear(group)
    for q in range(slots):
        k, n, unit = group.table[q, POLYGON], group.table[q, COUNT], group.numbers[q, UNIT]
        start = given.offsets[k]
        x0, y0 = given.points[start + found.kept[start], 0], given.points[start + found.kept[start], 1]
        for b in range((n + LANES - 1) // LANES):
            block, inside = group.blocks[b * BLOCK : (b + 1) * BLOCK], min(LANES, n - b * LANES)
            first = group.table[q, LANE]
            for i in range(inside):
                at, lane = start + found.kept[start + b * LANES + i], np.uint64(first + i + HALO)
                x, y = (given.points[at, 0] - x0) * unit, (given.points[at, 1] - y0) * unit
                block[QX + lane] = block[PX + lane] = x
                block[QY + lane] = block[PY + lane] = y
                block[EX + lane] = block[EY + lane] = 0.0
        place_weights(group, q)
        if not given.closed:
            _place_ends(given, group, q)


@compiled
def clear(group: Group) -> None:
    """Zeros in the first and the last block, which have lanes that no vertex uses."""
    count = (group.table[0, COUNT] + LANES - 1) // LANES
    for b in range(0, count, max(count - 1, 1)):
        for j in range(b * BLOCK, (b + 1) * BLOCK):
            group.blocks[j] = 0.0


@compiled
def place_weights(group: Group, q: int) -> None:
    """Rates and weights of polygon q."""
    n, first = group.table[q, COUNT], group.table[q, LANE]
    for b in range((n + LANES - 1) // LANES):
        block, inside = group.blocks[b * BLOCK : (b + 1) * BLOCK], min(LANES, n - b * LANES)
        h = group.h[group.table[q, INTERVALS] + b * LANES :]
        _weights(block, h, np.uint64(first), np.uint64(inside))


@compiled
def _weights(block: FloatArray, h: FloatArray, first: np.uint64, inside: np.uint64) -> None:
    """Rates and weights (see newton_simd.py) from one lane before the vertices to two behind them."""
    for i in range(ONE, inside + FOUR):
        a, b, c = h[i], h[i + ONE], h[i + TWO]
        lane = first + i
        three, two = a + b + c, b + c
        half = select(two > 0.0, 1.0 / two, 0.0)
        lam = b * half
        block[RATE + lane] = select(three > 0.0, 3.0 / three, 0.0)
        block[HALF + lane] = half
        block[THIRD + lane] = select(c > 0.0, 1.0 / (3.0 * c), 0.0)
        block[LAMBDA + lane] = lam
        block[MOVE_A + lane] = lam * b / 3.0
        block[MOVE_B + lane] = (1.0 - lam) * c / 3.0


@compiled
def _place_ends(given: Given, group: Group, q: int) -> None:
    """The ends of an open arc: fixed points, and the control points beside them, by tangent or natural."""
    k, n, first = group.table[q, POLYGON], group.table[q, COUNT], group.table[q, LANE] + HALO
    row = group.numbers[q]
    scale = row[UNIT] / row[KNOT_UNIT]
    h = group.h[group.table[q, INTERVALS] + PAD :]
    for end in range(2):
        at, near, beyond, other = (0, 0, 1, 1) if end == 0 else (n - 1, n - 2, n - 3, n - 2)
        row[NATURAL + end] = 0.0
        for axis in range(2):
            field = QX if axis == 0 else QY
            here = group.blocks[field + np.uint64(at // LANES * BLOCK + first + at % LANES)]
            there = group.blocks[field + np.uint64(other // LANES * BLOCK + first + other % LANES)]
            tau = given.tangents[k, end, axis] * scale
            rest = here
            if not np.isnan(tau):
                rest = here + (1.0 if end == 0 else -1.0) * h[near] / 3.0 * tau
            elif n == 2:
                rest = here + (there - here) / 3.0
            else:
                row[NATURAL + end] = h[near] / (2.0 * h[near] + h[beyond])
                rest = (1.0 - row[NATURAL + end]) * here
            row[BASE + 2 * end + axis], row[END + 2 * end + axis] = rest, here


@compiled
def move(given: Given, group: Group, slots: int, b: int) -> None:
    """P_i += p_i - C(t_i) for the control points of block b; those beside the ends of open arcs follow.

    The values in the halos are replaced by :func:`fill_halos`.
    """
    block = group.blocks[b * BLOCK : (b + 1) * BLOCK]
    for lane in range(TWO, np.uint64(whole_vectors(lanes_used(group, slots, b))) + TWO):
        block[PX + lane] += block[EX + lane]
        block[PY + lane] += block[EY + lane]
    if given.closed:
        return
    for q in range(slots):
        n, first, row = group.table[q, COUNT], group.table[q, LANE], group.numbers[q]
        for end in range(2):
            at, free, out = (0, 1, -1) if end == 0 else (n - 1, n - 2, 1)
            if at // LANES != b:
                continue
            end_lane, next_lane = first + at % LANES + HALO, first + at % LANES + HALO + out
            beside, outer, beyond = np.uint64(end_lane), np.uint64(next_lane), np.uint64(next_lane + out)
            other = group.blocks[free // LANES * BLOCK : (free // LANES + 1) * BLOCK]
            by = np.uint64(first + free % LANES + HALO)
            block[PX + beside] = row[BASE + 2 * end] + row[NATURAL + end] * other[PX + by]
            block[PY + beside] = row[BASE + 2 * end + 1] + row[NATURAL + end] * other[PY + by]
            block[PX + outer], block[PY + outer] = row[END + 2 * end], row[END + 2 * end + 1]
            block[PX + beyond], block[PY + beyond] = 0.0, 0.0


@compiled
def repeated(i: int, n: int, closed: bool) -> int:
    """The vertex that a halo repeats in the place of vertex i; negative if there is none.

    An open arc has one control point more, n, kept beyond the last vertex in its block.
    """
    if closed:
        return i + n if i < 0 else (i - n if i >= n else i)
    return i if i <= n else -1


@compiled
def fill_halos(given: Given, group: Group, slots: int, b: int) -> None:
    """Copy control points beyond either end of each polygon's vertices in block b, in a ring if closed."""
    block = group.blocks[b * BLOCK : (b + 1) * BLOCK]
    for q in range(slots):
        n, first = group.table[q, COUNT], group.table[q, LANE]
        inside = min(LANES, n - b * LANES)
        for k in range(4):
            to = first + (k if k < 2 else inside + k)
            i = repeated(b * LANES + to - first - HALO, n, given.closed)
            if i < 0:
                continue
            owner = min(i, n - 1)
            source = group.blocks
            at = np.uint64(owner // LANES * BLOCK + first + owner % LANES + HALO + i - owner)
            block[PX + np.uint64(to)], block[PY + np.uint64(to)] = source[PX + at], source[PY + at]


@compiled
def close_ranks(group: Group, slots: int, done: int) -> int:
    """Move the polygons that are not ``done`` to the front of their block, in order; returns their number."""
    block, table, numbers = group.blocks, group.table, group.numbers
    left, to = 0, 0
    end = table[slots - 1, LANE] + table[slots - 1, COUNT] + 2 * HALO
    for q in range(slots):
        if table[q, STATE] == done:
            continue
        lane, size = table[q, LANE], table[q, COUNT] + 2 * HALO
        for field in range(0, BLOCK, STRIDE):
            back = np.uint64(lane - to)
            for j in range(np.uint64(field + to), np.uint64(field + to + size)):
                block[j] = block[j + back]
        for c in range(TOTAL):
            table[left, c] = table[q, c]
        for c in range(numbers.shape[1]):
            numbers[left, c] = numbers[q, c]
        table[left, LANE] = to
        left, to = left + 1, to + size
    for field in range(0, BLOCK, STRIDE):
        for j in range(np.uint64(field + to), np.uint64(field + end)):
            block[j] = 0.0
    return left
