"""Many cubic polygons in one compiled call, variants 1 to 3, closed or open: arrays in, arrays out.

A *ragged* array is ``values`` with ``offsets``: part k is ``values[offsets[k]:offsets[k + 1]]``.
"""

from __future__ import annotations

import numpy as np

from ..reference import SETTLED, TIE_DISTANCE
from . import fields
from .fields import FIELDS, HALO, LANES, STRIDE
from .footpoint import compiled
from .lanes import SCRATCH
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
)
from .lemma2 import fill_intervals
from .passes import iterate
from .solve import ROW

PX, PY, QX, QY, LOW, HIGH, X = (
    np.uint64(k) for k in (fields.PX, fields.PY, fields.QX, fields.QY, fields.LOW, fields.HIGH, fields.X)
)

STATUS, COUNT, ITERATIONS, FALLBACKS, SEARCHED = range(5)
"""Columns of the whole numbers kept of each polygon; SEARCHED counts footpoints that took a full search."""


@compiled
def _place_points(blocks, p, origin, unit, h, tangents, knot_unit, closed, natural, base):
    """Vertices and first control points, about ``origin`` in units of 1/unit; the ends of an open arc."""
    n = p.shape[0]
    for b in range((n + LANES - 1) // LANES):
        block = blocks[b]
        for k in range(min(LANES, n - b * LANES)):
            i, lane = b * LANES + k, np.uint64(k + HALO)
            x, y = (p[i, 0] - origin[0]) * unit, (p[i, 1] - origin[1]) * unit
            block[QX + lane] = block[PX + lane] = x
            block[QY + lane] = block[PY + lane] = y
    if closed:
        return
    for end in range(2):
        at, sign, near, beyond = (0, 1.0, PAD, PAD + 1) if end == 0 else (n - 1, -1.0, PAD + n - 2, PAD + n - 3)
        other = 1 if end == 0 else n - 2
        for axis in range(2):
            here = (p[at, axis] - origin[axis]) * unit
            there = (p[other, axis] - origin[axis]) * unit
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
def _lay_out(
    blocks, scratch, p, u, h, tangents, closed, variant, margin, peak_share, unit, knot_unit, origin, natural, base
):
    """Everything of a polygon into its blocks; the fallbacks and the rate bound."""
    n = p.shape[0]
    pad_intervals(u, closed, knot_unit, h)
    count = (n + LANES - 1) // LANES
    blocks[count - 1, :] = 0.0
    for b in range(count):
        fill_block(blocks[b], b * LANES, min(LANES, n - b * LANES), h)
    first, last = (0, n) if closed else (1, n - 1)
    _place_points(blocks, p, origin, unit, h, tangents, knot_unit, closed, natural, base)
    fallbacks, least = fill_intervals(blocks, scratch, n, first, last, h, variant, margin, peak_share)
    return fallbacks, 2.0 * (1.0 - least)


@compiled
def _store(blocks, n, p, u, unit, knot_unit, origin, closed, controls, parameters, bounds):
    """Results in the caller's units. These are powers of two, so that multiplying rounds no more than dividing."""
    size, length, x0, y0, shift = 1.0 / unit, 1.0 / knot_unit, origin[0], origin[1], 0 if closed else 1
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
def run(
    k0, k1, points, offsets, given, tangents, closed, variant, margin, exponent, peak_share, tolerances, max_iterations,
    solve, knots, controls, parameters, bounds, kept, whole, rates,
):  # fmt: skip
    """Interpolate polygons k0 to k1 - 1.

    Args:
        points: (N, 2); offsets: (K + 1,).
        given: () or all polygons' own parameters one after another, n + 1 each if closed, n if open.
        tangents: (K, 2, 2) end tangents of open arcs, NaN for natural ends; (0, 2, 2) if closed.
        exponent: of the chord length in the knots; negative for ``given``.
        tolerances: (K,) residual tolerances.
        knots, controls, parameters, bounds, kept, whole, rates: results. A polygon's knots begin at its offset, plus k
            if closed; its control points at its offset, plus 2 k if open.

    Returns:
        The residuals of all polygons one after another.
    """
    most = 0
    for k in range(k0, k1):
        most = max(most, offsets[k + 1] - offsets[k])
    blocks = np.zeros(((most + LANES - 1) // LANES, FIELDS * STRIDE))
    scratch = np.zeros(SCRATCH * STRIDE)
    h = np.zeros(most + 2 * PAD + 16)
    rows = np.empty((most if solve else 0, ROW))
    residuals, used = np.empty(64), np.int64(0)  # a plain 0 would have ``iterate`` compiled for 0, and again for others
    natural, base, origin = np.zeros(2), np.zeros((2, 2)), np.zeros(2)
    for k in range(k0, k1):
        start, stop = offsets[k], offsets[k + 1]
        here = kept[start:stop]
        whole[k, STATUS], whole[k, ITERATIONS] = BAD_POLYGON, -1
        n, extent = merge(points[start:stop], closed, here)
        whole[k, COUNT] = n
        if n < 0:
            continue
        p = points[start : start + n]
        if n < stop - start:
            p = np.empty((n, 2))
            for i in range(n):
                p[i, 0], p[i, 1] = points[start + here[i], 0], points[start + here[i], 1]
        first_knot = start + k if closed else start
        u = knots[first_knot : first_knot + n + (1 if closed else 0)]
        if exponent < 0.0:
            good = given_knots(
                given[first_knot : (stop + k + 1 if closed else stop)], here, n, closed, stop - start - n, u
            )
        else:
            good = chord_knots(p, closed, exponent, u)
        if not good:
            whole[k, STATUS] = BAD_KNOTS
            continue
        unit = 0.5 ** np.floor(np.log2(extent))
        knot_unit = 0.5 ** np.floor(np.log2(u[-1] / n))
        origin[0], origin[1] = p[0, 0], p[0, 1]
        whole[k, FALLBACKS], rates[k] = _lay_out(
            blocks, scratch, p, u, h, tangents[k] if not closed else base, closed, variant, margin, peak_share, unit,
            knot_unit, origin, natural, base,
        )  # fmt: skip
        limit = max(tolerances[k], SETTLED * u[n - 1] / (n - 1) if solve else 0.0) * unit
        residuals, passes, whole[k, SEARCHED] = iterate(
            blocks, scratch, n, closed, h, natural, base, variant != 3, limit, TIE_DISTANCE**2, max_iterations, solve,
            rows, residuals, used,
        )  # fmt: skip
        for i in range(used, used + passes):
            residuals[i] /= unit
        used += passes
        whole[k, STATUS], whole[k, ITERATIONS] = OK, passes - 1
        first_control = start if closed else start + 2 * k
        _store(
            blocks, n, p, u, unit, knot_unit, origin, closed, controls[first_control:], parameters[start:],
            bounds[start:],
        )  # fmt: skip
    return residuals[:used]
