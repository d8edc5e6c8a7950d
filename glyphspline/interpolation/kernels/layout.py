"""What a polygon is before its iteration starts: duplicates merged, knots, Lemma 2's intervals, blocks filled.

The same rules, to rounding, as ``polygon.py``, ``knots.py`` and ``intervals.py`` have for NumPy, which explain them.
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import compiled, inlined, select
from ..polygon import LARGEST, SAME_VERTEX, SMALLEST
from . import blocks as fields
from .blocks import HALO

OK, BAD_POLYGON, BAD_KNOTS = 0, 1, 2
"""What became of a polygon. Words for it are found by the plain modules, which look at it again."""

RATE, LAMBDA, MOVE_A, MOVE_B, HALF, THIRD = (
    np.uint64(k) for k in (fields.RATE, fields.LAMBDA, fields.MOVE_A, fields.MOVE_B, fields.HALF, fields.THIRD)
)
ONE, TWO, FOUR, EIGHT = (np.uint64(k) for k in (1, 2, 4, 8))

PAD = 4
"""Knot intervals kept before the first and after the last one."""


@compiled
def distance(p, i, j):
    """Of two vertices. Extents are such that squares do not overflow, and ``hypot`` would take as long as all else."""
    x, y = p[i, 0] - p[j, 0], p[i, 1] - p[j, 1]
    return np.sqrt(x * x + y * y)


@compiled
def merge(points, closed, kept):
    """Indices of the vertices that are kept, into ``kept``; how many, or -1 if no curve can be put through them."""
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
    if not SMALLEST <= extent <= LARGEST:
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
    return (count if _distinct(points, kept, count) >= (3 if closed else 2) else -1), extent


@compiled
def _distinct(points, kept, count):
    """The number of different vertices, as far as three."""
    if count < 2:
        return count
    ax, ay = points[kept[0], 0], points[kept[0], 1]
    bx, by = points[kept[1], 0], points[kept[1], 1]
    for i in range(2, count):
        x, y = points[kept[i], 0], points[kept[i], 1]
        if (x != ax or y != ay) and (x != bx or y != by):
            return 3
    return 2


@compiled
def chord_knots(p, closed, exponent, u):
    """Knots from 0 by sums of chord lengths to a power, into u. False if two of them fall together."""
    n = p.shape[0]
    total = 0.0
    u[0] = 0.0
    for i in range(n if closed else n - 1):
        j = i + 1 if i + 1 < n else 0
        chord = distance(p, i, j)
        if exponent == 0.0:
            chord = 1.0
        elif exponent == 0.5:
            chord = np.sqrt(chord)
        before = total
        total += chord
        if not total > before:
            return False
        u[i + 1] = total
    return True


@compiled
def given_knots(given, kept, count, closed, merged, u):
    """The caller's parameters, those of merged vertices left out, into u. False if not finite and increasing."""
    for i in range(count):
        u[i] = given[kept[i]]
    if closed:
        u[count] = given[given.shape[0] - 1]
    last = count if closed else count - 1
    first = u[0]
    for i in range(last + 1):
        u[i] -= first
        if not np.isfinite(u[i]) or (i > 0 and not u[i] > u[i - 1]):
            return False
    return True


@compiled
def power_of_two(x):
    """The power of two that brings x > 0 between 1 and 2."""
    return math.ldexp(1.0, 1 - math.frexp(x)[1])


@compiled
def pad_intervals(u, closed, unit, h):
    """Knot intervals times ``unit``: h[PAD + i] is that from u_i on, continued periodically, or by zeros."""
    spans = u.shape[0] - 1
    for i in range(spans):
        h[PAD + i] = (u[i + 1] - u[i]) * unit
    for k in range(PAD):  # one after another, so that fewer spans than PAD are gone round more than once
        h[PAD - 1 - k] = h[PAD + spans - 1 - k] if closed else 0.0
    for k in range(PAD + 2):
        h[PAD + spans + k] = h[PAD + k] if closed else 0.0


@inlined
def _fill(block, h, shift, low, high, step):
    """Rates and weights (see lanes.py) of lanes low to high - 1; h[lane + shift] is the interval from a knot on."""
    for lane in range(low, high):
        i = lane + shift
        a, b, c = h[i - TWO * step], h[i - step], h[i]
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
def fill_block(block, first, count, h):
    """Rates and weights of the block of a long polygon that begins with its vertex ``first``."""
    _fill(block, h, np.uint64(first + PAD - HALO), ONE, np.uint64(count + 4), ONE)


@compiled
def fill_side_by_side(block, step, rows, h):
    """Rates and weights of a block of ``step`` polygons; ``rows`` vertices of each, whose intervals lie as they do."""
    if step == FOUR:
        _fill(block, h, np.uint64(PAD - HALO) * FOUR, FOUR, (rows + FOUR) * FOUR, FOUR)
    else:
        _fill(block, h, np.uint64(PAD - HALO) * EIGHT, EIGHT, (rows + FOUR) * EIGHT, EIGHT)
