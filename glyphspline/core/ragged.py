"""Many cubic polygons in one compiled call, variants 1 to 3, closed or open: arrays in, arrays out.

A *ragged* array is ``values`` with ``offsets``: part k is ``values[offsets[k]:offsets[k + 1]]``.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..reference import SETTLED, TIE_DISTANCE
from . import fields
from .fields import BLOCK, HALO, LANES, SCRATCH, STRIDE
from .footpoint import compiled
from .layout import (
    BAD_KNOTS,
    BAD_POLYGON,
    OK,
    PAD,
    chord_knots,
    fill_block,
    fill_side_by_side,
    given_knots,
    merge,
    pad_intervals,
    power_of_two,
)
from .lemma2 import fill_intervals, fill_intervals_side_by_side
from .lend import hold, lend
from .passes import freeze, grown, iterate
from .side_by_side import INTERVALS, iterate_together, place, places
from .solve import ROW

PX, PY, QX, QY, LOW, HIGH, X = (
    np.uint64(k) for k in (fields.PX, fields.PY, fields.QX, fields.QY, fields.LOW, fields.HIGH, fields.X)
)

STATUS, COUNT, ITERATIONS, FALLBACKS, SEARCHED = range(5)
"""Columns of the whole numbers kept of each polygon; SEARCHED counts footpoints that took a full search."""


FEW = (0, 0, 0, 0, 1, 0, 0, 0, 3)
"""So many polygons of a block of 4, or 8, are not worth going on with together: each goes on alone."""


class Given(NamedTuple):
    """What is to be interpolated, and how; see :func:`run`."""

    points: Any
    offsets: Any
    knots: Any
    tangents: Any
    tolerances: Any
    closed: Any
    variant: Any
    margin: Any
    exponent: Any
    peak_share: Any
    max_iterations: Any
    solve: Any


class Found(NamedTuple):
    """Results; see :func:`run`."""

    knots: Any
    controls: Any
    parameters: Any
    bounds: Any
    kept: Any
    whole: Any
    rates: Any


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


class Room(NamedTuple):
    """Room to work in: blocks of a polygon, scratch, knot intervals, the frozen system, the ends of an open arc."""

    blocks: Any
    scratch: Any
    h: Any
    rows: Any
    natural: Any
    base: Any


@compiled
def _place_points(blocks, p, unit, h, tangents, knot_unit, closed, natural, base):
    """Vertices and first control points, about the first in units of 1/unit; the ends of an open arc."""
    n = p.shape[0]
    for b in range((n + LANES - 1) // LANES):
        block = blocks[b]
        for k in range(min(LANES, n - b * LANES)):
            i, lane = b * LANES + k, np.uint64(k + HALO)
            x, y = (p[i, 0] - p[0, 0]) * unit, (p[i, 1] - p[0, 1]) * unit
            block[QX + lane] = block[PX + lane] = x
            block[QY + lane] = block[PY + lane] = y
    if closed:
        return
    for end in range(2):
        at, sign, near, beyond = (0, 1.0, PAD, PAD + 1) if end == 0 else (n - 1, -1.0, PAD + n - 2, PAD + n - 3)
        other = 1 if end == 0 else n - 2
        for axis in range(2):
            here = (p[at, axis] - p[0, axis]) * unit
            there = (p[other, axis] - p[0, axis]) * unit
            tau = tangents[end, axis] * (unit / knot_unit)
            if not np.isnan(tau):
                natural[end], base[end, axis] = 0.0, here + sign * h[near] / 3.0 * tau
            elif n == 2:
                natural[end], base[end, axis] = 0.0, here + (there - here) / 3.0
            else:
                natural[end] = h[near] / (2.0 * h[near] + h[beyond])
                base[end, axis] = (1.0 - natural[end]) * here
            # the clamped end itself lies one lane further out; beside it the point that the tangent fixes
            edge = blocks[0] if end == 0 else blocks[at // LANES]
            outer = 1 if end == 0 else at % LANES + HALO + 1
            inner = blocks[at // LANES]
            if axis == 0:
                edge[fields.PX + outer] = here
                inner[fields.PX + at % LANES + HALO] = base[end, axis] + natural[end] * there
            else:
                edge[fields.PY + outer] = here
                inner[fields.PY + at % LANES + HALO] = base[end, axis] + natural[end] * there


@compiled
def _lay_out(room, p, u, tangents, given, unit, knot_unit):
    """Everything of a polygon into its blocks; the fallbacks and the rate bound."""
    n, blocks, closed = p.shape[0], room.blocks, given.closed
    pad_intervals(u, closed, knot_unit, room.h)
    count = (n + LANES - 1) // LANES
    blocks[0, :] = blocks[count - 1, :] = 0.0
    for b in range(count):
        fill_block(blocks[b], b * LANES, min(LANES, n - b * LANES), room.h)
    first, last = (0, n) if closed else (1, n - 1)
    _place_points(blocks, p, unit, room.h, tangents, knot_unit, closed, room.natural, room.base)
    fallbacks, least = fill_intervals(
        blocks, room.scratch, n, first, last, room.h, given.variant, given.margin, given.peak_share
    )
    return fallbacks, 2.0 * (1.0 - least)


@compiled
def _store(blocks, n, p, u, unit, knot_unit, closed, controls, parameters, bounds):
    """Results in the caller's units. These are powers of two, so that multiplying rounds no more than dividing."""
    size, length, x0, y0, shift = 1.0 / unit, 1.0 / knot_unit, p[0, 0], p[0, 1], 0 if closed else 1
    for b in range((n + LANES - 1) // LANES):
        block = blocks[b]
        for k in range(min(LANES, n - b * LANES)):
            i, lane = b * LANES + k, np.uint64(k + HALO)
            controls[i + shift, 0] = block[PX + lane] * size + x0
            controls[i + shift, 1] = block[PY + lane] * size + y0
            parameters[i] = u[i] + block[X + lane] * length
            bounds[i, 0] = u[i] + block[LOW + lane] * length
            bounds[i, 1] = u[i] + block[HIGH + lane] * length
    if not closed:
        controls[0] = p[0]
        controls[n + 1] = p[n - 1]


@compiled
def _knots(given, found, k, n):
    """Where the knots of polygon k go."""
    first = given.offsets[k] + (k if given.closed else 0)
    return found.knots[first : first + n + (1 if given.closed else 0)]


@compiled
def _vertices(given, found, k, n):
    """The vertices of polygon k that were kept."""
    start, stop = given.offsets[k], given.offsets[k + 1]
    p = given.points[start : start + n]
    if n < stop - start:
        p = np.empty((n, 2))
        for i in range(n):
            j = start + found.kept[start + i]
            p[i, 0], p[i, 1] = given.points[j, 0], given.points[j, 1]
    return p


@compiled
def _prepare(given, found, k, units):
    """Merge vertices of polygon k and find its knots; how many are left, 0 if it is refused. ``units``: its scales."""
    start, stop = given.offsets[k], given.offsets[k + 1]
    here = found.kept[start:stop]
    found.whole[k, STATUS], found.whole[k, ITERATIONS] = BAD_POLYGON, -1
    found.whole[k, FALLBACKS] = found.whole[k, SEARCHED] = 0
    n, extent = merge(given.points[start:stop], given.closed, here)
    found.whole[k, COUNT] = n
    if n < 0:
        return 0
    u = _knots(given, found, k, n)
    if given.exponent < 0.0:
        first = start + k if given.closed else start
        own = given.knots[first : (stop + k + 1 if given.closed else stop)]
        good = given_knots(own, here, n, given.closed, stop - start - n, u)
    else:
        good = chord_knots(_vertices(given, found, k, n), given.closed, given.exponent, u)
    if not good:
        found.whole[k, STATUS] = BAD_KNOTS
        return 0
    units[0], units[1] = power_of_two(extent), power_of_two(u[-1] / n)
    return n


@compiled
def _limit(given, found, k, n, unit):
    """The distance to stop below, in the units of the blocks."""
    u = _knots(given, found, k, n)
    return max(given.tolerances[k], SETTLED * u[n - 1] / (n - 1) if given.solve else 0.0) * unit


@compiled
def _finish(given, found, room, blocks, k, n, units, residuals, used, passes):
    """Solve if wanted, and store; the residuals of the polygon, from ``used`` on, are scaled. How many there are."""
    p, u = _vertices(given, found, k, n), _knots(given, found, k, n)
    if given.solve and np.inf > residuals[used + passes - 1] and n > (0 if given.closed else 2):
        pad_intervals(u, given.closed, units[1], room.h)
        residuals[used + passes] = freeze(
            blocks, room.scratch, n, given.closed, room.h, room.natural, room.base, TIE_DISTANCE**2, room.rows
        )
        passes += 1
    for i in range(used, used + passes):
        residuals[i] /= units[0]
    found.whole[k, STATUS], found.whole[k, ITERATIONS] = OK, passes - 1
    start = given.offsets[k]
    first_control = start if given.closed else start + 2 * k
    _store(
        blocks, n, p, u, units[0], units[1], given.closed, found.controls[first_control:], found.parameters[start:],
        found.bounds[start:],
    )  # fmt: skip
    return passes


@compiled
def _alone(given, found, room, k, n, units, residuals, used):
    """Interpolate polygon k. Returns the residuals and how many of them are used now."""
    p, u = _vertices(given, found, k, n), _knots(given, found, k, n)
    tangents = room.base if given.closed else given.tangents[k]
    found.whole[k, FALLBACKS], found.rates[k] = _lay_out(room, p, u, tangents, given, units[0], units[1])
    residuals, passes, found.whole[k, SEARCHED] = iterate(
        room.blocks, room.scratch, n, given.closed, room.natural, room.base, given.variant != 3,
        _limit(given, found, k, n, units[0]), TIE_DISTANCE**2, given.max_iterations, residuals, used, 0,
    )  # fmt: skip
    return residuals, used + _finish(given, found, room, room.blocks, k, n, units, residuals, used, passes)


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
        pad_intervals(_knots(given, found, k, n), True, unit[1], room.h)
        place(block, H, step, j, _vertices(given, found, k, n), n, unit[0], room.h)
        sizes[j], limits[j] = n, _limit(given, found, k, n, unit[0])
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
        used += _finish(given, found, room, blocks, k, n, units[k - first], residuals, used, passes)
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
            counts[k - k0] = n = _prepare(given, found, k, units[k - k0])
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
        lend(points), lend(offsets), lend(own_knots), lend(tangents), lend(tolerances), closed, variant, margin,
        exponent, peak_share, max_iterations, solve,
    )  # fmt: skip
    found = Found(lend(knots), lend(controls), lend(parameters), lend(bounds), lend(kept), lend(whole), lend(rates))
    most = 0
    for k in range(k0, k1):
        most = max(most, offsets[k + 1] - offsets[k])
    needed = (most + LANES - 1) // LANES
    if blocks.shape[0] < needed:
        blocks = np.empty((needed, BLOCK))
    scratch, h, rows = np.zeros(SCRATCH * STRIDE), np.zeros(most + 2 * PAD + 16), np.empty((most if solve else 0, ROW))
    natural, base, own = np.zeros(2), np.zeros((2, 2)), _company(8 if closed and k1 - k0 > FEW[8] else 0)
    room = Room(lend(blocks), lend(scratch), lend(h), lend(rows), lend(natural), lend(base))
    company = Company(
        lend(own.block), lend(own.alone), lend(own.H), lend(own.who), lend(own.sizes), lend(own.fallbacks),
        lend(own.passes), lend(own.searched), lend(own.limits), lend(own.least),
    )  # fmt: skip
    residuals = _all(k0, k1, given, found, room, company)
    hold((blocks, scratch, h, rows, natural, base, own))  # as what was lent is not counted
    return residuals
