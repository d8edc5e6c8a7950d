"""Many cubic polygons in one compiled call, variants 1 to 3, closed or open: arrays in, arrays out.

Part k of ``values`` with ``offsets`` is ``values[offsets[k]:offsets[k + 1]]``.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...intrinsics import borrowed, keep_alive
from ...types import FloatArray, IntArray
from ..method import SETTLED
from .anderson import NUMBERS, ROWS
from .blocks import (
    BLOCK, COUNT, END, HALO, INTERVALS, KNOT_UNIT, LANE, LANES, LIMIT, PAD, POLYGON, SCRATCH, SLOTS, STRIDE, TOTAL,
    UNIT, WIDTH, Found, Given, Group, place,
)  # fmt: skip
from .collocation import ROW
from .iteration import iterate
from .lemma2 import fill_intervals
from .vertices import knots_of, pad_intervals, prepare


@compiled
def run(
    k0: int, k1: int, points: FloatArray, offsets: IntArray, own_knots: FloatArray, tangents: FloatArray, closed: bool,
    variant: int, margin: float, exponent: float, peak_shares: FloatArray, tolerances: FloatArray, max_iterations: int,
    solve: bool, accelerate: bool, blocks: FloatArray, knots: FloatArray, controls: FloatArray, parameters: FloatArray,
    bounds: FloatArray, kept: IntArray, whole: IntArray, rates: FloatArray,
) -> FloatArray:  # fmt: skip
    """Interpolate polygons k0 to k1 - 1.

    Args:
        points: (N, 2); offsets: (K + 1,).
        own_knots: () or all polygons' own parameters one after another, n + 1 each if closed, n if open.
        tangents: (K, 2, 2) end tangents of open arcs, NaN for natural ends; (0, 2, 2) if closed.
        exponent: of the chord length in the knots; negative for ``own_knots``.
        peak_shares: (K,) of ``fallback="peak"``, 0 for "knot".
        tolerances: (K,) residual tolerances; NaN is replaced by the one of ``RELATIVE_TOLERANCE``.
        blocks: memory for the blocks of the largest polygon; a smaller array is ignored.
        knots, controls, parameters, bounds, kept, whole, rates: results. A polygon's knots begin at its offset, plus k
            if closed; its control points at its offset, plus 2 k if open.

    Returns:
        The residuals of all polygons one after another.
    """
    given = Given(
        borrowed(points), borrowed(offsets), borrowed(own_knots), borrowed(tangents), closed, variant, margin, exponent,
        borrowed(peak_shares), borrowed(tolerances), max_iterations, solve,
        accelerate,
    )  # fmt: skip
    found = Found(
        borrowed(knots), borrowed(controls), borrowed(parameters), borrowed(bounds), borrowed(kept), borrowed(whole),
        borrowed(rates),
    )  # fmt: skip
    most = LANES
    for k in range(k0, k1):
        most = max(most, offsets[k + 1] - offsets[k])
    if blocks.shape[0] < (most + LANES - 1) // LANES * BLOCK:
        blocks = np.empty((most + LANES - 1) // LANES * BLOCK)
    scratch, h = np.empty(SCRATCH * STRIDE + 2 * WIDTH), np.empty(2 * most + 8 * WIDTH)
    for j in range(scratch.shape[0]):
        scratch[j] = 0.0
    rows, numbers = np.empty((most + WIDTH if solve else 0, ROW)), np.empty((SLOTS, END + 4))
    table = np.empty((SLOTS, TOTAL + 1), dtype=np.int64)
    memory, mixing = np.empty((ROWS if accelerate else 0, 2 * most)), np.empty((SLOTS, NUMBERS))
    group = Group(
        borrowed(blocks), borrowed(scratch), borrowed(h), borrowed(rows), borrowed(table), borrowed(numbers),
        borrowed(memory), borrowed(mixing),
    )  # fmt: skip
    history, residuals = np.empty(64), np.empty(64)
    zero = k0 - k0  # of the type of a variable: functions would be compiled for the constant 0, and again for others
    used = slots = lane = at = zero
    for k in range(k0, k1 + 1):
        n, unit, knot_unit = prepare(given, found, k) if k < k1 else (zero, 1.0, 1.0)
        if k < k1 and n == 0:
            continue
        if slots > 0 and (k == k1 or lane + n + 2 * HALO > LANES + 2 * HALO):
            place(given, found, group, slots)
            fill_intervals(given, group, slots)
            history, residuals, used = iterate(given, found, group, slots, history, residuals, used)
            slots = lane = at = zero
        if k == k1:
            break
        enter(given, found, group, slots, k, n, lane, at, unit, knot_unit)
        slots, lane, at = slots + 1, lane + n + 2 * HALO, at + n + 2 * PAD
    keep_alive((blocks, scratch, h, rows, table, numbers, memory, mixing))
    return residuals[:used]


@compiled
def enter(
    given: Given, found: Found, group: Group, q: int, k: int, n: int, lane: int, at: int, unit: float, knot_unit: float
) -> None:
    """Make polygon k, of n vertices, number q of a group, at ``lane`` of the blocks and ``at`` of the intervals."""
    table, numbers, u = group.table, group.numbers, knots_of(given, found, k, n)
    pad_intervals(u, given.closed, knot_unit, group.h[at:])
    table[q, POLYGON], table[q, COUNT], table[q, LANE], table[q, INTERVALS] = k, n, lane, at
    settled = SETTLED * u[n - 1] / (n - 1) if given.solve else 0.0
    numbers[q, UNIT], numbers[q, KNOT_UNIT], numbers[q, LIMIT] = (
        unit, knot_unit, max(given.tolerances[k], settled) * unit,
    )  # fmt: skip
