"""Many cubic polygons in one compiled call, variants 1 to 3, closed or open: arrays in, arrays out.

A *ragged* array is ``values`` with ``offsets``: part k is ``values[offsets[k]:offsets[k + 1]]``.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...compiled import borrowed, compiled, keep_alive
from ..reference import TIE_DISTANCE
from .blocks import BLOCK, LANES, SCRATCH, STRIDE
from .collocation import ROW
from .iteration import grown, iterate
from .layout import PAD, fill_side_by_side, pad_intervals
from .lemma2 import fill_intervals_side_by_side
from .one import (
    FALLBACKS,
    ITERATIONS,
    SEARCHED,
    Found,
    Given,
    Room,
    finish,
    knots_of,
    lay_out,
    limit,
    prepare,
    vertices_of,
)
from .side_by_side import INTERVALS, iterate_together, place, places

FEW = (0, 0, 0, 0, 1, 0, 0, 0, 3)
"""So many polygons of a block of 4, or 8, are not worth going on with together: each goes on alone."""


class Company(NamedTuple):
    """Room for polygons side by side: their block, a block for each, intervals, and numbers of each."""

    block: Any
    alone: Any
    H: Any
    who: Any
    sizes: Any
    fallbacks: Any
    passes: Any
    searched: Any
    limits: Any
    least: Any


@compiled
def _alone(given, found, room, k, n, units, residuals, used):
    """Interpolate polygon k. Returns the residuals and how many of them are used now."""
    p, u = vertices_of(given, found, k, n), knots_of(given, found, k, n)
    tangents = room.base if given.closed else given.tangents[k]
    found.whole[k, FALLBACKS], found.rates[k] = lay_out(room, p, u, tangents, given, units[0], units[1])
    residuals, passes, found.whole[k, SEARCHED] = iterate(
        room.blocks, room.scratch, n, given.closed, room.natural, room.base, given.variant != 3,
        limit(given, found, k, n, units[0]), TIE_DISTANCE**2, given.max_iterations, residuals, used, 0,
    )  # fmt: skip
    return residuals, used + finish(given, found, room, room.blocks, k, n, units, residuals, used, passes)


@compiled
def _together(given, found, room, company, count, step, first, counts, units, at, residuals, used):
    """Interpolate the first ``count`` polygons of ``company.who`` side by side; the rest as for :func:`_alone`.

    Args:
        counts, units, at: of all polygons from ``first`` on: vertices, scales, and where residuals begin.
    """
    block, H, sizes, limits = company.block, company.H, company.sizes, company.limits
    block[:], H[:], sizes[:] = 0.0, 1.0, 0
    for j in range(count):
        k = company.who[step // 8, j]
        n, unit = counts[k - first], units[k - first]
        pad_intervals(knots_of(given, found, k, n), True, unit[1], room.h)
        place(block, H, step, j, vertices_of(given, found, k, n), n, unit[0], room.h)
        sizes[j], limits[j] = n, limit(given, found, k, n, unit[0])
    fill_side_by_side(block, np.uint64(step), np.uint64(sizes.max()), H)
    fill_intervals_side_by_side(
        block, room.scratch, step, sizes, H, given.variant, given.margin, given.peak_share, company.fallbacks,
        company.least,
    )  # fmt: skip
    search, tie, most = given.variant != 3, TIE_DISTANCE**2, given.max_iterations
    history = iterate_together(
        block, room.scratch, step, sizes, limits, search, tie, most, FEW[step], given.solve, company.alone,
        np.empty((64, 8)), company.passes, company.searched,
    )  # fmt: skip
    for j in range(count):
        k, n, made = company.who[step // 8, j], sizes[j], company.passes[j]
        blocks, at[k - first] = company.alone[j : j + 1], used
        passes = made if made > 0 else -1 - made
        residuals = grown(residuals, used + passes + 2)
        for i in range(passes):
            residuals[used + i] = history[i, j]
        found.whole[k, FALLBACKS], found.rates[k] = company.fallbacks[j], 2.0 * (1.0 - company.least[j])
        found.whole[k, SEARCHED] = company.searched[j]
        if made < 0:
            residuals, passes, more = iterate(
                blocks, room.scratch, n, True, room.natural, room.base, search, limits[j], tie, most, residuals, used,
                passes,
            )  # fmt: skip
            found.whole[k, SEARCHED] += more
        used += finish(given, found, room, blocks, k, n, units[k - first], residuals, used, passes)
    return residuals, used


@compiled
def _company(size):
    """Room for ``size`` polygons side by side, 8 or none."""
    return Company(
        np.empty(BLOCK if size else 0), np.empty((size, BLOCK)), np.empty(INTERVALS if size else 0),
        np.empty((2, size), dtype=np.int64), np.zeros(size, dtype=np.int64), np.zeros(size, dtype=np.int64),
        np.zeros(size, dtype=np.int64), np.zeros(size, dtype=np.int64), np.zeros(size), np.zeros(size),
    )  # fmt: skip


@compiled
def _in_order(residuals, at, iterations):
    """Residuals polygon by polygon: those that were side by side came later than their neighbours in the list."""
    ordered, used = np.empty_like(residuals), 0
    for k in range(len(at)):
        count = iterations[k] + 1
        ordered[used : used + count] = residuals[at[k] : at[k] + count]
        used += count
    return ordered


@compiled
def _all(k0, k1, given, found, room, company):
    """Polygons k0 to k1 - 1, alone or side by side; see :func:`run`."""
    gathered = np.zeros(2, dtype=np.int64)
    counts, units, at = np.zeros(k1 - k0, dtype=np.int64), np.empty((k1 - k0, 2)), np.zeros(k1 - k0, dtype=np.int64)
    residuals, used = np.empty(64), np.int64(0)  # a plain 0 would have ``iterate`` compiled for 0, and again for others
    for k in range(k0, k1 + 2):  # at the end those that still wait, in fours and eights
        n = step = 0
        if k < k1:
            counts[k - k0] = n = prepare(given, found, k, units[k - k0])
            step = places(n) if len(company.alone) > 0 else 1
        kind = k - k1 if k >= k1 else step // 8
        if k < k1 and n > 0 and step > 1:
            company.who[kind, gathered[kind]] = k
            gathered[kind] += 1
        if k < k1 and n > 0 and step == 1:
            at[k - k0] = used
            residuals, used = _alone(given, found, room, k, n, units[k - k0], residuals, used)
        elif gathered[kind] > 0 and (k >= k1 or gathered[kind] == step):
            residuals, used = _together(
                given, found, room, company, gathered[kind], 4 + 4 * kind, k0, counts, units, at, residuals, used
            )
            gathered[kind] = 0
    return _in_order(residuals[:used], at, found.whole[k0:k1, ITERATIONS])


@compiled
def run(
    k0, k1, points, offsets, own_knots, tangents, closed, variant, margin, exponent, peak_share, tolerances,
    max_iterations, solve, blocks, knots, controls, parameters, bounds, kept, whole, rates,
):  # fmt: skip
    """Interpolate polygons k0 to k1 - 1.

    Args:
        points: (N, 2); offsets: (K + 1,).
        own_knots: () or all polygons' own parameters one after another, n + 1 each if closed, n if open.
        tangents: (K, 2, 2) end tangents of open arcs, NaN for natural ends; (0, 2, 2) if closed.
        exponent: of the chord length in the knots; negative for ``own_knots``.
        tolerances: (K,) residual tolerances.
        blocks: room for the largest polygon; a smaller array will do, and is then not used.
        knots, controls, parameters, bounds, kept, whole, rates: results. A polygon's knots begin at its offset, plus k
            if closed; its control points at its offset, plus 2 k if open.

    Returns:
        The residuals of all polygons one after another.
    """
    given = Given(
        borrowed(points), borrowed(offsets), borrowed(own_knots), borrowed(tangents), borrowed(tolerances), closed,
        variant, margin, exponent, peak_share, max_iterations, solve,
    )  # fmt: skip
    found = Found(
        borrowed(knots),
        borrowed(controls),
        borrowed(parameters),
        borrowed(bounds),
        borrowed(kept),
        borrowed(whole),
        borrowed(rates),
    )
    most = 0
    for k in range(k0, k1):
        most = max(most, offsets[k + 1] - offsets[k])
    needed = (most + LANES - 1) // LANES
    if blocks.shape[0] < needed:
        blocks = np.empty((needed, BLOCK))
    scratch, h, rows = np.zeros(SCRATCH * STRIDE), np.zeros(most + 2 * PAD + 16), np.empty((most if solve else 0, ROW))
    natural, base, own = np.zeros(2), np.zeros((2, 2)), _company(8 if closed and k1 - k0 > FEW[8] else 0)
    room = Room(borrowed(blocks), borrowed(scratch), borrowed(h), borrowed(rows), borrowed(natural), borrowed(base))
    company = Company(
        borrowed(own.block), borrowed(own.alone), borrowed(own.H), borrowed(own.who), borrowed(own.sizes),
        borrowed(own.fallbacks), borrowed(own.passes), borrowed(own.searched), borrowed(own.limits),
        borrowed(own.least),
    )  # fmt: skip
    residuals = _all(k0, k1, given, found, room, company)
    keep_alive((blocks, scratch, h, rows, natural, base, own))  # as what was lent is not counted
    return residuals
