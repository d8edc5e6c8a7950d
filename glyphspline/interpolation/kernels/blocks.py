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
from ...types import BoolArray, FloatArray, IntArray
from ..result import Found

LANES = 128
HALO = 2
STRIDE = 136
"""At least LANES + 2 HALO, and such that the fields of a lane fall into different sets of a cache."""

WIDTH = 8
"""Loops run over multiples of this number of lanes: whole vectors. Lanes beyond the last polygon are zero."""

SLOTS = (LANES + 2 * HALO) // (2 + 2 * HALO)
"""Maximum number of polygons in a block."""

# The fields of a vertex, kept between passes: rates and weights of newton_simd.py, interval and footpoint (relative to
# its knot), squared distance from the footpoint.
RATE, LAMBDA, MOVE_A, MOVE_B, HALF, THIRD, LOW, HIGH, X, DD = (np.uint64(k * STRIDE) for k in range(10))
BLOCK = 10 * STRIDE

SECOND = np.uint64(STRIDE)
PAIR = 2 * STRIDE
"""Lanes of two coordinates, the second ``SECOND`` after the first."""

# The first fields of the scratch block, of both passes: the interval on the main side and the footpoint there, the sign
# of that side, whether Newton's method has converged, the length of the other side, and what has to be searched: 1 the
# main side, 2 the other, 3 both.
SLO, SHI, SY, SIDE, DONE, OTHER, BAD = (np.uint64(k * STRIDE) for k in range(7))
OWN = 7
"""Index of the first field that a pass uses in its own way."""

SCRATCH = OWN + 27
"""Number of fields of the scratch block, determined by ``gram_simd``."""

PAD = 4
"""Knot intervals kept before the first and after the last one."""

TABLE = 9
POLYGON, COUNT, LANE, INTERVALS, FINISHED, PASSES, SEARCHED, UNCERTIFIED, FALLBACKS = range(TABLE)
"""Columns of ``Group.table``: index of the polygon, vertices, first lane, where in ``Group.h`` its intervals begin,
whether it is done, passes, full searches, those not certified, fallbacks.
"""

UNIT, KNOT_UNIT, LIMIT, LEAST, LARGEST, NATURAL = 0, 1, 2, 3, 4, 5
"""Columns of ``Group.numbers``: scales of lengths and parameters, the error to stop below, the least B_i on its
interval, the largest squared error; for both ends of an open arc the weight of the free control point in the one beside
the end.
"""

BESIDE, LAST = 0, 2
"""Rows of a polygon in ``Group.ends``: for both ends of an open arc the rest of the control point beside it, and the
end itself.
"""

ONE, TWO, THREE, FOUR, EIGHT = (np.uint64(k) for k in (1, 2, 3, 4, 8))


class Given(NamedTuple):
    """The polygons and how they are interpolated.

    Attributes:
        points, offsets: (N, d), (K + 1,) polygons end to end; part k of ``points`` is ``offsets[k]:offsets[k + 1]``.
        knots: () or all polygons' own parameters end to end, n + 1 each if closed, n if open.
        tangents: (K, 2, d) end tangents of open arcs, NaN for natural ends; (0, 2, d) if closed.
        exponent: of the chord length in the knots; negative for own ``knots``.
        peak_shares: (K,) of ``fallback="peak"``, 0 for "knot".
        tolerances: (K,) residual tolerances; NaN is replaced by the one of ``RELATIVE_TOLERANCE``.
        settled: share of the mean chord below which the error need not fall; 0 for none.
        held: (N,) whether a vertex of a closed polygon is held: its control point stays at it, and the curve need not
            pass through it; () where none is.
    """

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
    settled: float
    held: BoolArray


class Group(NamedTuple):
    """The polygons that are iterated together: several short ones in one block, or a long one in a row of blocks.

    Attributes:
        size: numbers in an array of coordinates for a block.
        blocks, scratch: see the module. h: knot intervals of all of them, each with PAD more at either end.
        table, numbers: a row for each polygon; columns as above. ends: (4 SLOTS, d) four rows for each.
    """

    size: int
    blocks: FloatArray
    scratch: FloatArray
    h: FloatArray
    table: IntArray
    numbers: FloatArray
    ends: FloatArray


class Coordinates(NamedTuple):
    """The coordinates of a group: arrays with a ``PAIR`` for every two coordinates, a zero beside the last if d is odd,
    for every block.

    Attributes:
        P, Q: control points and vertices. N: the next control points, P_i + p_i - C(t_i).
    """

    P: FloatArray
    Q: FloatArray
    N: FloatArray


@inlined
def whole_vectors(count: int) -> int:
    """``count``, rounded up to a multiple of ``WIDTH``."""
    return (count + WIDTH - 1) // WIDTH * WIDTH


@inlined
def lanes_used(group: Group, slots: int, b: int) -> int:
    """Lanes of block b from the first vertex to the last one, in whole vectors."""
    used = group.table[slots - 1, LANE] + group.table[slots - 1, COUNT]
    if group.table[0, COUNT] > LANES:
        used = min(LANES, group.table[0, COUNT] - b * LANES)
    return whole_vectors(used)


@compiled
def place(given: Given, found: Found, group: Group, at: Coordinates, slots: int) -> None:
    """Vertices, first control points, rates and weights of a group's polygons into their blocks; controls into N."""
    d, size, count = given.points.shape[1], group.size, -(-group.table[0, COUNT] // LANES)
    for b in range(0, count, max(count - 1, 1)):  # the first and the last have lanes that no vertex uses
        for j in range(b * BLOCK, (b + 1) * BLOCK):
            group.blocks[j] = 0.0
    for j in range(count * size):
        at.P[j] = at.Q[j] = at.N[j] = 0.0
    for q in range(slots):
        k, n, unit = group.table[q, POLYGON], group.table[q, COUNT], group.numbers[q, UNIT]
        kept, first = found.kept[given.offsets[k] :], group.table[q, LANE]
        points = given.points[given.offsets[k] :]
        for i in range(n):
            lane, p = np.uint64(i // LANES * size + first + HALO + i % LANES), points[kept[i]]
            for axis in range(d):
                at.N[lane] = at.Q[lane] = (p[axis] - points[kept[0], axis]) * unit
                lane += SECOND
        for b in range((n + LANES - 1) // LANES):
            block, h = group.blocks[b * BLOCK : (b + 1) * BLOCK], group.h[group.table[q, INTERVALS] + b * LANES :]
            _weights(block, h, np.uint64(first), np.uint64(min(LANES, n - b * LANES)))
        if not given.closed:
            _place_ends(given, found, group, q)


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
def _place_ends(given: Given, found: Found, group: Group, q: int) -> None:
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
            group.ends[4 * q + BESIDE + end, axis], group.ends[4 * q + LAST + end, axis] = rest, here


@compiled
def fill_edges(given: Given, group: Group, P: FloatArray, slots: int) -> None:
    """Control points beyond either end of each polygon's vertices in every block, and those of the ends of arcs.

    On a closed curve they repeat those around it. An open arc has one control point more, n, kept beyond the last
    vertex in its block; those beside its ends follow their neighbours.
    """
    d, size, table = given.points.shape[1], group.size, group.table
    for q in range(slots):
        n, first = table[q, COUNT], table[q, LANE]
        for end in range(0 if given.closed else 2):
            at, free, out = (0, 1, -1) if end == 0 else (n - 1, n - 2, 1)
            here, by = (
                at // LANES * size + first + at % LANES + HALO,
                free // LANES * size + first + free % LANES + HALO,
            )
            for axis in range(d):
                step = axis * STRIDE
                beside, weight = group.ends[4 * q + BESIDE + end, axis], group.numbers[q, NATURAL + end]
                P[step + here] = beside + weight * P[step + by]
                P[step + here + out] = group.ends[4 * q + LAST + end, axis]
                P[step + here + 2 * out] = 0.0
        for b in range(-(-n // LANES)):
            inside = min(LANES, n - b * LANES)
            for k in range(4):
                to = first + (k if k < 2 else inside + k)
                i = b * LANES + to - first - HALO
                if given.closed:
                    i += n * (int(i < 0) - int(i >= n))
                elif not 0 <= i <= n:
                    continue
                owner = min(i, n - 1)
                at = owner // LANES * size + first + owner % LANES + HALO + i - owner
                for step in range(0, d * STRIDE, STRIDE):
                    P[b * size + to + step] = P[at + step]
