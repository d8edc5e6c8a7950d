"""Bends, from inflection to inflection: lumps, where curvature swells once more than the bend needs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.comb import control_length
from ...curves.cubics import jet, length
from ...curves.fairness import MOST, TURN, curvatures, swings
from ...types import FloatArray
from ..contour_arrays import ContourArrays
from .turns import NO_HANDLE

SLACK = np.radians(10.0)
"""Turn beyond whole quarters that needs no further maximum."""

STEPS = 8
"""Chords of a segment along which its turn is summed."""


class Bend(NamedTuple):
    """A stretch of a contour between two places, the sign of its curvature, and whether it is the whole contour."""

    begin: float
    end: float
    sign: float
    whole: bool


@compiled
def bend_findings(
    cubics: FloatArray, contours: ContourArrays, least_share: float, least_height: float, corner_angle: float
) -> FloatArray:
    """(n, 4) lumps of contours: contour, place, share, and how far a lump moves the curve, in units.

    A bend goes from an inflection, a corner or a line to the next. The maxima of its absolute curvature are those of
    :func:`..curves.fairness.swings`, with the least share. Contours with quadratics are passed over: each quadratic
    has a peak of its own.

    Args:
        cubics: (m, 4, 2) segments of all contours. contours: their degrees and offsets.
        least_share, least_height: of a lump. corner_angle: in radians.
    """
    table, count = np.empty((MOST * len(cubics), 4)), 0
    share, corner = least_share / (1 + least_share), np.cos(corner_angle)
    for c in range(len(contours.offsets) - 1):
        a, b = contours.offsets[c], contours.offsets[c + 1]
        degrees, own = contours.degrees[a:b], cubics[a:b]
        if (degrees == 2).any() or not (degrees == 3).any():
            continue
        extent = control_length(own)
        values, where, n = curvatures(own, extent, corner)
        if n == 0:
            continue
        for i in range(n):
            if degrees[min(int(where[i]), b - a - 1)] == 1 and where[i] % 1 == 0 and values[i] == 0.0:
                values[i] = np.nan
        least = TURN / extent
        found, at, sizes = np.empty(n + 2, dtype=np.int64), np.empty(n + 2), np.empty(n + 2)
        # From a curvature between bends, or else from behind an inflection: the first of another sign than the last.
        start, last = int(np.argmax(values[:n])), 0.0
        whole = not np.isnan(values[start])
        for i in range(start, start + (n if whole else 0)):
            value = values[i % n]
            if abs(value) >= least:
                if value * last < 0:
                    start, whole = i, False
                    break
                last = value
        first, sign = start, 0.0
        for i in range(start, start + n + 1):
            value = values[i % n]
            ends = np.isnan(value) or value * sign <= -least or i == start + n
            if ends and sign != 0.0:
                before = first - 1 if not np.isnan(values[(first - 1) % n]) and not whole else first
                behind = i if np.isnan(value) else i + 1
                number = swings(values, n, before, behind, sign, share, least, found)
                for k in range(number + 1):
                    at[k], sizes[k] = where[found[k] % n], sign * values[found[k] % n]
                bend = Bend(where[before % n], where[(behind - 1) % n], sign, whole)
                for lump in lumps_of(own, bend, at[: number + 1], sizes[: number + 1], least, least_height):
                    table[count, 0] = c
                    table[count, 1], table[count, 2], table[count, 3] = lump[0], lump[1], lump[2]
                    count += 1
            if ends:
                first, sign = i, 0.0
            if np.isnan(value):
                first = i + 1
            elif sign == 0.0 and abs(value) >= least:
                sign = 1.0 if value > 0 else -1.0
    return table[:count]


@compiled
def lumps_of(
    cubics: FloatArray, bend: Bend, at: FloatArray, sizes: FloatArray, least: float, least_height: float
) -> FloatArray:
    """(k, 3) the lumps of one bend: place, share, and how far each moves the curve.

    Of two maxima too close together the lesser is a lump; then the least of all, until there are no more than the bend
    needs. The lesser one is that which exceeds the minima beside it by the smaller share.

    Args:
        at, sizes: places and absolute curvatures of the significant extrema, and the end.
    """
    begin, end, sign, whole = bend
    number, first = len(at) - 1, 0 if whole else 1
    if number - first < 3:
        return np.empty((0, 3))
    rows, peaks, size, count = np.empty((number, 3)), np.empty((number, 3)), 0, 0
    for k in range(first, number):
        i, j = k - 1 if k else number - 1, (k + 1) % number if whole else k + 1
        beside = max(sizes[i], sizes[j])
        if sizes[k] > beside:
            s, r = min(int(at[i]), len(cubics) - 1), min(int(at[j]), len(cubics) - 1)
            (x0, y0, _, _, _, _), (x1, y1, _, _, _, _) = jet(cubics, s, at[i] - s), jet(cubics, r, at[j] - r)
            # A wave of curvature moves the curve to each side by its height times the square of its length, divided by
            # this.
            x, y = x1 - x0, y1 - y0
            height = (sizes[k] - beside) * (x * x + y * y) / (8 * np.pi * np.pi)
            if height >= least_height:
                peaks[size, 0], peaks[size, 1], peaks[size, 2] = at[k], sizes[k] / max(beside, least) - 1, height
                size += 1
    # A bend has one maximum of curvature for each quarter of a turn: a superelliptic o has four.
    needed = max(1, int(np.ceil((turned(cubics, begin, end, sign, whole) - SLACK) / (np.pi / 2))))
    while size > 1:
        worst, close = 0, False
        for k in range(size if whole else size - 1):
            other = (k + 1) % size
            # Between two maxima that both belong to the bend's shape it turns by half a quarter.
            if turned(cubics, peaks[k, 0], peaks[other, 0], sign, False) < np.pi / 4:
                lesser = k if peaks[k, 1] < peaks[other, 1] else other
                worst = worst if close and peaks[worst, 1] <= peaks[lesser, 1] else lesser
                close = True
        if not close:
            if size <= needed:
                break
            worst = int(peaks[:size, 1].argmin())
        rows[count, 0] = peaks[worst, 0] % len(cubics)
        rows[count, 1], rows[count, 2] = peaks[worst, 1], peaks[worst, 2]
        count, size = count + 1, size - 1
        for k in range(worst, size):
            peaks[k, 0], peaks[k, 1], peaks[k, 2] = peaks[k + 1, 0], peaks[k + 1, 1], peaks[k + 1, 2]
    return rows[:count]


@compiled
def turned(cubics: FloatArray, first: float, last: float, sign: float, whole: bool) -> float:
    """By how many radians a closed chain turns to one side, 1 or -1, between two places: the most on the way.

    From a place to itself is all the way round: a bend may begin and end at the only inflection of its sign.
    """
    m = len(cubics)
    if whole or last <= first:
        last += m
    total = low = most = px = py = 0.0
    for s in range(int(first), int(np.ceil(last))):
        j = s % m
        a, b = max(first - s, 0.0), min(last - s, 1.0)
        for k in range(STEPS + 1):
            t = a + (b - a) * k / STEPS
            _, _, x, y, _, _ = jet(cubics, j, t)
            if length(x, y) <= NO_HANDLE:
                continue
            if px != 0.0 or py != 0.0:
                total += sign * np.arctan2(px * y - py * x, px * x + py * y)
                low = min(low, total)
                most = max(most, total - low)
            px, py = x, y
    return most
