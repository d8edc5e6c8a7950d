"""Single segments: curves that bend back, are straight, pass their ends or have long handles; lines a little off."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..curves.cubics import length
from ..outlines.contour_arrays import ContourArrays
from ..types import FloatArray, IntArray
from .joints import COLUMNS, ROUNDING, add, end_curvature, handle, is_whole, least_kink, neighbour, turn_of
from .kinds import EXTREMUM, HANDLES, INFLECTION, SHORT, SLANTED, STRAIGHT, Limits

BACK = 0.25
"""Share of a segment's larger turn up to which the turn the other way is not meant: an S turns both ways alike."""

MIDDLE = 0.5
"""Local parameter at which a finding lies that concerns a segment as a whole."""

AT_END = 1e-9
"""Parameter distance within which a root is an end of its segment."""


@compiled
def segment_findings(cubics: FloatArray, contours: ContourArrays, limits: Limits) -> FloatArray:
    """(n, 6) what may be wrong with single segments of contours; see :mod:`.joints`.

    A very short segment has no other finding, and a segment whose handles reach too far is not said to bend back: that
    is what such handles do.

    Args:
        cubics: (m, 4, 2) segments of all contours. contours: their degrees and offsets.
    """
    table, count = np.empty((16, COLUMNS)), 0
    degrees = contours.degrees
    for c in range(len(contours.offsets) - 1):
        a, b = contours.offsets[c], contours.offsets[c + 1]
        for j in range(a, b):
            cubic, place = cubics[j], j - a + MIDDLE
            x, y = cubic[3, 0] - cubic[0, 0], cubic[3, 1] - cubic[0, 1]
            chord = length(x, y)
            if chord < limits.short:
                extent = (chord + control_polygon(cubic)) / 2
                if extent < limits.short:
                    table = add(table, count, SHORT, c, place, extent, np.nan, -1)
                    count += 1
                    continue
            if degrees[j] == 1:
                angle = off_axes(x, y, limits)
                if angle > 0.0:
                    table = add(table, count, SLANTED, c, place, np.degrees(angle), np.nan, -1)
                    count += 1
                continue
            for axis in range(2):
                for t in turning_points(cubic, axis):
                    beyond = passes(cubic, axis, t)
                    if beyond > limits.extremum:
                        table = add(table, count, EXTREMUM, c, j - a + t, beyond, np.nan, -1)
                        count += 1
            if chord >= limits.straight_length:
                off = leaves_chord(cubic, x / chord, y / chord)
                if off < limits.straight and line_would_do(cubics, degrees, a, b, j, limits):
                    table = add(table, count, STRAIGHT, c, place, off, np.nan, -1)
                    count += 1
                    continue
            if degrees[j] == 3:
                reach, alone = reaches_beyond(cubic, limits)
                if alone:
                    alone = bends_back(cubics, degrees, a, b, j, 1.0, limits)[0] == 0.0
                if reach > 0.0:
                    if not alone:
                        table = add(table, count, HANDLES, c, place, reach, np.nan, -1)
                        count += 1
                    continue
                back, t = bends_back(cubics, degrees, a, b, j, BACK, limits)
                if back > 0.0:
                    table = add(table, count, INFLECTION, c, j - a + t, np.degrees(back), np.nan, -1)
                    count += 1
    return table[:count]


@compiled
def control_polygon(cubic: FloatArray) -> float:
    """Length of the control polygon."""
    total = 0.0
    for k in range(3):
        total += length(cubic[k + 1, 0] - cubic[k, 0], cubic[k + 1, 1] - cubic[k, 1])
    return total


@compiled
def all_whole(cubic: FloatArray) -> bool:
    """Whether all control points are in whole units."""
    whole = True
    for k in range(4):
        whole = whole and is_whole(cubic[k, 0], cubic[k, 1])
    return whole


@compiled
def off_axes(x: float, y: float, limits: Limits) -> float:
    """Angle of a line that is nearly horizontal or vertical with that direction; 0 of one that is exactly, or is not.

    One unit is all that rounding may make of a line in whole units: it counts where the line is long.
    """
    along, off = max(abs(x), abs(y)), min(abs(x), abs(y))
    angle = np.arctan2(off, along)
    if off < limits.slanted_offset or angle >= limits.slanted:
        return 0.0
    return 0.0 if off < 1.5 and along < limits.slanted_length and is_whole(x, y) else angle


@compiled
def quadratic_roots(a: float, b: float, c: float) -> tuple[float, float]:
    """The roots of a t² + b t + c inside (0, 1), ascending; NaN for those that there are not. None at a double root."""
    first = second = np.nan
    square = b * b - 4 * a * c
    if square > 0.0:
        q = -0.5 * (b + (np.sqrt(square) if b >= 0 else -np.sqrt(square)))
        first, second = c / q, q / a  # one is infinite where the equation is linear
        if not AT_END < first < 1 - AT_END:
            first = np.nan
        if not AT_END < second < 1 - AT_END:
            second = np.nan
        if np.isnan(first) or second < first:
            first, second = second, first
    return first, second


@compiled
def turning_points(cubic: FloatArray, axis: int) -> tuple[float, float]:
    """The parameters inside a cubic where one coordinate is stationary; NaN for those that there are not."""
    a, b = cubic[1, axis] - cubic[0, axis], cubic[2, axis] - cubic[1, axis]
    c = cubic[3, axis] - cubic[2, axis]
    if (a >= 0.0 and b >= 0.0 and c >= 0.0) or (a <= 0.0 and b <= 0.0 and c <= 0.0):
        return np.nan, np.nan
    return quadratic_roots(a - 2 * b + c, 2 * (b - a), a)


@compiled
def passes(cubic: FloatArray, axis: int, t: float) -> float:
    """How far one coordinate at t is beyond those of both ends; NaN at NaN."""
    s = 1 - t
    first, last = cubic[0, axis], cubic[3, axis]
    value = s * s * (s * first + 3 * t * cubic[1, axis]) + t * t * (3 * s * cubic[2, axis] + t * last)
    return max(value - max(first, last), min(first, last) - value)


@compiled
def leaves_chord(cubic: FloatArray, x: float, y: float) -> float:
    """How far a cubic leaves its chord, of which (x, y) is the direction."""
    first = x * (cubic[1, 1] - cubic[0, 1]) - y * (cubic[1, 0] - cubic[0, 0])
    second = x * (cubic[2, 1] - cubic[0, 1]) - y * (cubic[2, 0] - cubic[0, 0])
    most = 0.0
    for t in quadratic_roots(3 * (first - second), 2 * second - 4 * first, first):
        if not np.isnan(t):
            most = max(most, abs(3 * t * (1 - t) * ((1 - t) * first + t * second)))
    return most


@compiled
def line_would_do(cubics: FloatArray, degrees: IntArray, a: int, b: int, j: int, limits: Limits) -> bool:
    """Whether a line in a segment's place makes no kink where the segment joins its neighbours smoothly."""
    x, y = cubics[j, 3, 0] - cubics[j, 0, 0], cubics[j, 3, 1] - cubics[j, 0, 1]
    for end in range(2):
        own_x, own_y = handle(cubics, degrees, j, end == 1)
        other_x, other_y = handle(cubics, degrees, neighbour(cubics, a, b, j, 1 if end else -1), end == 0)
        if abs(turn_of(other_x, other_y, own_x, own_y)) >= limits.corner_angle:
            continue
        if abs(turn_of(other_x, other_y, x, y)) >= least_kink(other_x, other_y, x, y, limits):
            return False
    return True


@compiled
def reaches_beyond(cubic: FloatArray, limits: Limits) -> tuple[float, bool]:
    """Share by which a handle of a cubic reaches beyond where both handles meet, or beyond the other end; else 0.

    And whether only one handle does, and only the former: the cubic then has one inflection, and no cusp or loop.

    Where all points are in whole units, the handle's end and the meeting point may both be off by the rounding.
    """
    ux, uy = cubic[1, 0] - cubic[0, 0], cubic[1, 1] - cubic[0, 1]
    vx, vy = cubic[2, 0] - cubic[3, 0], cubic[2, 1] - cubic[3, 1]
    x, y = cubic[3, 0] - cubic[0, 0], cubic[3, 1] - cubic[0, 1]
    first, second, chord = length(ux, uy), length(vx, vy), length(x, y)
    if first == 0.0 or second == 0.0 or chord == 0.0:
        return 0.0, False
    rounding = 2 * ROUNDING if all_whole(cubic) else 0.0
    most, alone = 0.0, False
    cross = ux * vy - uy * vx
    sine = abs(cross) / (first * second)
    if sine > limits.kink:
        s, r = (x * vy - y * vx) / cross, (x * uy - y * ux) / cross
        if s > 0.0 and r > 0.0:
            if first * (1 - s) > rounding / sine:
                most = max(most, 1 / s - 1)
            if second * (1 - r) > rounding / sine:
                most = max(most, 1 / r - 1)
            alone = (s < 1.0) != (r < 1.0)
    for beyond in (ux * x + uy * y, -vx * x - vy * y):
        if beyond - chord * chord > rounding * chord:
            most, alone = max(most, beyond / (chord * chord) - 1), False
    return (most, alone) if most >= limits.handles else (0.0, False)


@compiled
def bends_back(
    cubics: FloatArray, degrees: IntArray, a: int, b: int, j: int, share: float, limits: Limits
) -> tuple[float, float]:
    """By how many radians a cubic bends back that else bends one way, and where that begins or ends; else 0.

    An S that turns both ways is meant. So is a turn back at an end if the neighbour, smoothly joined, bends that way
    too: their bend ends inside this segment. Where all points are in whole units, the corner of the control polygon
    that turns back must be more than rounding may make.

    Args:
        share: of the larger turn, up to which the smaller is not meant.
    """
    cubic = cubics[j]
    ax, ay = cubic[1, 0] - cubic[0, 0], cubic[1, 1] - cubic[0, 1]
    bx, by = cubic[2, 0] - cubic[1, 0], cubic[2, 1] - cubic[1, 1]
    cx, cy = cubic[3, 0] - cubic[2, 0], cubic[3, 1] - cubic[2, 1]
    before, both, after = ax * by - ay * bx, ax * cy - ay * cx, bx * cy - by * cx
    # The cross product of velocity and acceleration: (1-t)² before + t (1-t) both + t² after, but for a factor.
    low, high = quadratic_roots(before - both + after, both - 2 * before, before)
    if np.isnan(low):
        return 0.0, 0.0
    left = right = 0.0
    turns = np.zeros(3)
    cuts = (0.0, low, 1.0 if np.isnan(high) else high, 1.0)
    for k in range(2 if np.isnan(high) else 3):
        px = py = 0.0
        for i in range(3):
            t = cuts[k] + (cuts[k + 1] - cuts[k]) * i / 2
            s = 1 - t
            qx, qy = s * s * ax + 2 * s * t * bx + t * t * cx, s * s * ay + 2 * s * t * by + t * t * cy
            if i:
                turns[k] += np.arctan2(px * qy - py * qx, px * qx + py * qy)
            px, py = qx, qy
        left, right = left + max(turns[k], 0.0), right + max(-turns[k], 0.0)
    sign = 1.0 if left < right else -1.0  # of the smaller turn
    back = min(left, right)
    if back < limits.inflection or back > share * max(left, right):
        return 0.0, 0.0
    last = 1 if np.isnan(high) else 2
    if turns[1] * sign > 0 and last == 2:
        return back, (low + high) / 2
    at_start = turns[0] * sign > turns[last] * sign
    if all_whole(cubic):
        la, lb, lc = length(ax, ay), length(bx, by), length(cx, cy)
        corner = np.arctan2(before, ax * bx + ay * by) if at_start else np.arctan2(after, bx * cx + by * cy)
        if sign * corner < ROUNDING * (1 / lb + (1 / la if at_start else 1 / lc)):
            return 0.0, 0.0
    i = neighbour(cubics, a, b, j, -1 if at_start else 1)
    own_x, own_y = handle(cubics, degrees, j, not at_start)
    other_x, other_y = handle(cubics, degrees, i, at_start)
    smooth = abs(turn_of(other_x, other_y, own_x, own_y)) < limits.corner_angle
    if smooth and degrees[i] > 1 and sign * end_curvature(cubics[i], at_start) > 0:
        return 0.0, 0.0
    return back, low if at_start or np.isnan(high) else high
