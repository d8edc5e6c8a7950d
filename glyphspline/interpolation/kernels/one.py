"""One polygon of a ragged list, from the caller's arrays into its blocks, and from its blocks into the results."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...compiled import compiled
from ..reference import SETTLED, TIE_DISTANCE
from . import blocks as fields
from .blocks import HALO, LANES
from .iteration import freeze
from .layout import (
    BAD_KNOTS,
    BAD_POLYGON,
    OK,
    PAD,
    chord_knots,
    fill_block,
    given_knots,
    merge,
    pad_intervals,
    power_of_two,
)
from .lemma2 import fill_intervals

PX, PY, QX, QY, LOW, HIGH, X = (
    np.uint64(k) for k in (fields.PX, fields.PY, fields.QX, fields.QY, fields.LOW, fields.HIGH, fields.X)
)

STATUS, COUNT, ITERATIONS, FALLBACKS, SEARCHED = range(5)
"""Columns of the whole numbers kept of each polygon; SEARCHED counts footpoints that took a full search."""


class Given(NamedTuple):
    """What is to be interpolated, and how; see ``ragged.run``."""

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
    """Results; see ``ragged.run``."""

    knots: Any
    controls: Any
    parameters: Any
    bounds: Any
    kept: Any
    whole: Any
    rates: Any


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
def lay_out(room, p, u, tangents, given, unit, knot_unit):
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
def knots_of(given, found, k, n):
    """Where the knots of polygon k go."""
    first = given.offsets[k] + (k if given.closed else 0)
    return found.knots[first : first + n + (1 if given.closed else 0)]


@compiled
def vertices_of(given, found, k, n):
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
def prepare(given, found, k, units):
    """Merge vertices of polygon k and find its knots; how many are left, 0 if it is refused. ``units``: its scales."""
    start, stop = given.offsets[k], given.offsets[k + 1]
    here = found.kept[start:stop]
    found.whole[k, STATUS], found.whole[k, ITERATIONS] = BAD_POLYGON, -1
    found.whole[k, FALLBACKS] = found.whole[k, SEARCHED] = 0
    n, extent = merge(given.points[start:stop], given.closed, here)
    found.whole[k, COUNT] = n
    if n < 0:
        return 0
    u = knots_of(given, found, k, n)
    if given.exponent < 0.0:
        first = start + k if given.closed else start
        own = given.knots[first : (stop + k + 1 if given.closed else stop)]
        good = given_knots(own, here, n, given.closed, stop - start - n, u)
    else:
        good = chord_knots(vertices_of(given, found, k, n), given.closed, given.exponent, u)
    if not good:
        found.whole[k, STATUS] = BAD_KNOTS
        return 0
    units[0], units[1] = power_of_two(extent), power_of_two(u[-1] / n)
    return n


@compiled
def limit(given, found, k, n, unit):
    """The distance to stop below, in the units of the blocks."""
    u = knots_of(given, found, k, n)
    return max(given.tolerances[k], SETTLED * u[n - 1] / (n - 1) if given.solve else 0.0) * unit


@compiled
def finish(given, found, room, blocks, k, n, units, residuals, used, passes):
    """Solve if wanted, and store; the residuals of the polygon, from ``used`` on, are scaled. How many there are."""
    p, u = vertices_of(given, found, k, n), knots_of(given, found, k, n)
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
