"""Joints and single segments of contours. Points and vectors are complex numbers: (a* b).imag is the cross product."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...compiled import compiled, inlined
from ...curves.bezier import AT_END
from ...types import ComplexArray, FloatArray, IntArray
from ..contour_arrays import ContourArrays
from .kinds import (
    EXTREMUM,
    HANDLES,
    INFLECTION,
    JUMP,
    KINK,
    LEFTOVER,
    RETRACTED,
    SHORT,
    SLANTED,
    STRAIGHT,
    TURN,
    UNLEVEL,
    Limits,
)  # fmt: skip
from .turns import NO_HANDLE

ROUNDING = np.sqrt(0.5)
"""How far rounding to whole units moves a point at most. It moves the two ends of a handle."""

DEVIATION = np.sqrt(1 / 12)
"""Standard deviation of a coordinate's rounding error. A smooth joint in 300 turns by more than three of them make."""

LEVEL = np.tan(np.radians(10.0))
"""Slope from which a handle is not meant to be level."""

WHAT, CONTOUR, PLACE, VALUE, DETAIL, OTHER, SEEN = range(7)
"""Columns of the table (n, 7) that passes return: number of the kind; contour; place on it, segment and local
parameter; value in the kind's unit, curvatures in 1/unit; second number, or NaN; another contour, or -1; how far it is
seen, see :class:`.Finding`, or NaN."""


def rows(
    what: ArrayLike, contour: ArrayLike, place: ArrayLike, value: ArrayLike, detail: ArrayLike = np.nan,
    other: ArrayLike = -1,
) -> FloatArray:  # fmt: skip
    """(n, 7) rows of the table; see ``WHAT``. A number counts for all rows."""
    columns = np.broadcast_arrays(what, contour, place, value, detail, other, np.nan)
    return np.stack([column.astype(np.float64) for column in columns], axis=1)


class Segments(NamedTuple):
    """The m segments of contours.

    Attributes:
        points: (m, 4) as cubics. degrees: (m,) in the font. offsets: (C + 1,) first segment of each contour, and m.
        before, behind: (m,) the neighbours of some extent; a segment itself if there are none.
        first, last: (m,) handles, in the segment's direction and as long as they are in the font; 0 without extent.
    """

    points: ComplexArray
    degrees: IntArray
    offsets: IntArray
    before: IntArray
    behind: IntArray
    first: ComplexArray
    last: ComplexArray

    @classmethod
    def of(cls, cubics: FloatArray, contours: ContourArrays) -> Segments:
        """The segments of contours; ``cubics`` (m, 4, 2): all of them."""
        points, degrees, m = cubics.view(np.complex128)[..., 0], contours.degrees, len(cubics)
        handles = []
        for arms in (points[:, 1:] - points[:, :1], points[:, 3:] - points[:, 2::-1]):
            long = np.abs(arms.real) + np.abs(arms.imag) > NO_HANDLE
            handles.append(np.where(long.any(axis=1), 3 / degrees * arms[np.arange(m), long.argmax(axis=1)], 0))
        own = np.flatnonzero(handles[0])
        contour, k = np.searchsorted(contours.offsets, own, side="right"), np.arange(len(own))
        first, last = np.searchsorted(contour, contour), np.searchsorted(contour, contour, side="right") - 1
        before, behind = np.arange(m), np.arange(m)
        before[own] = own[np.where(k == first, last, k - 1)]
        behind[own] = own[np.where(k == last, first, k + 1) % max(len(own), 1)]
        return cls(points, degrees, contours.offsets, before, behind, *handles)


@compiled
def put(table: FloatArray, count: int, what: int, contour: int, place: float, value: float) -> int:
    """Write a row of the table, without detail, after ``count`` others; return the number of rows.

    Numba takes a default of NaN in code out of a file for another one, and finds no such function.
    """
    row = table[count]
    row[WHAT], row[CONTOUR], row[PLACE], row[VALUE], row[OTHER] = what, contour, place, value, -1
    row[DETAIL] = row[SEEN] = np.nan
    return count + 1


@compiled
def joint_findings(segments: Segments, limits: Limits) -> FloatArray:
    """(n, 7) what may be wrong with smooth joints; see ``WHAT``.

    A joint is smooth if it turns by less than a corner does, of two lines by less than their own limit. It kinks if it
    turns by more than the limit, and, where both handles are in whole units, by more than rounding may make, and if
    that moves the far end of the shorter segment beside it. Other turns have a limit of their own, and those of two
    lines the limit of kinks: strokes and serifs taper so on purpose, too. Curvature jumps are reported where both sides
    are cubics, as a chain of quadratics has them everywhere, and where all points are in whole units only those larger
    than what rounding may make.
    """
    points, degrees, offsets, before, _, first, last = segments
    table, count = np.empty((3 * len(points), 7)), 0
    for c in range(len(offsets) - 1):
        for j in range(offsets[c], offsets[c + 1]):
            i, place = before[j], j - offsets[c]
            turn = abs(turn_of(last[i], first[j]))
            lines = degrees[i] == 1 and degrees[j] == 1
            if not turn < (limits.line_angle if lines else limits.corner_angle):
                continue
            p, q = points[i], points[j]
            kinks = turn >= least_kink(last[i], first[j], limits.kink, limits.rounding)
            if kinks or (turn >= limits.turn and not lines):
                tapers, arm = kinks and lines, min(arc(p), arc(q))
                kinks = kinks and not lines and turn * arm >= limits.kink_height and not ends_stroke(segments, i, j)
                if kinks or tapers or turn >= limits.turn:
                    what, seen = KINK if kinks else TURN, turn / limits.corner_angle * arm
                    count = put(table, count, what, c, place, np.degrees(turn))
                    table[count - 1, SEEN] = seen
            elif lines:
                chord = q[3] - p[0]
                off = abs((chord.conjugate() * (q[0] - p[0])).imag) / length(chord)
                if off <= limits.leftover:
                    count = put(table, count, LEFTOVER, c, place, off)
            if degrees[i] == 3 and degrees[j] == 3 and not kinks:
                arriving, leaving = -end_curvature(p[3], p[2], p[1]), end_curvature(q[0], q[1], q[2])
                jump, most = abs(leaving - arriving), max(abs(arriving), abs(leaving))
                if limits.jump <= jump < np.inf and jump >= limits.relative_jump * most:
                    by_rounding = 0.0
                    whole = is_whole(p[1]) and is_whole(p[2]) and is_whole(p[3]) and is_whole(q[1]) and is_whole(q[2])
                    if whole:
                        by_rounding = rounding_variance(p[3], p[2], p[1]) + rounding_variance(q[0], q[1], q[2])
                    if jump > limits.rounding * np.sqrt(by_rounding):
                        share = jump / most
                        count = put(table, count, JUMP, c, place, jump)
                        table[count - 1, DETAIL], table[count - 1, SEEN] = share, share * min(arc(p), arc(q))
            if degrees[i] > 1 and degrees[j] > 1 and not kinks:
                off = off_level(last[i], first[j], p[0] - q[0], q[3] - q[0])
                if limits.unlevel <= off <= limits.unlevel_most:
                    count = put(table, count, UNLEVEL, c, place, off)
    return table[:count]


@compiled
def ends_stroke(segments: Segments, i: int, j: int) -> bool:
    """Whether a curve turns into the straight end of a stroke between segments i and j, and so does the other side.

    The end is three lines with two corners. Both sides turn as the stroke does, one to the left and one to the right.
    """
    _, degrees, _, before, behind, first, last = segments
    if degrees[i] > 1 and degrees[j] == 1:
        a, b, c = j, behind[j], behind[behind[j]]
        curve = behind[c]
        here, there = turn_of(last[i], first[j]), turn_of(last[c], first[curve])
    elif degrees[i] == 1 and degrees[j] > 1:
        a, b, c = before[before[i]], before[i], i
        curve = before[a]
        here, there = turn_of(last[i], first[j]), turn_of(last[curve], first[a])
    else:
        return False
    if degrees[a] > 1 or degrees[b] > 1 or degrees[c] > 1 or degrees[curve] == 1:
        return False
    one, two = turn_of(last[a], first[b]), turn_of(last[b], first[c])
    low, high = min(abs(here), abs(there)), max(abs(here), abs(there))
    # The lesser turn of the two sides is half of the other one at least, or one side that kinks would be passed over.
    return one * two > 0 and min(abs(one), abs(two)) > np.pi / 4 and here * there < 0 and low >= 0.5 * high


@compiled
def segment_findings(segments: Segments, limits: Limits) -> FloatArray:
    """(n, 7) what may be wrong with single segments; see ``WHAT``. What concerns a segment as a whole is at its middle.

    A very short segment has no other finding, and a segment whose handles reach too far does not count as bending back:
    that is what such handles do.
    """
    degrees, offsets = segments.degrees, segments.offsets
    table, count = np.empty((6 * len(degrees), 7)), 0  # four extrema, a handle of no length, and one more
    for c in range(len(offsets) - 1):
        for j in range(offsets[c], offsets[c + 1]):
            cubic, place = segments.points[j], j - offsets[c] + 0.5
            chord = cubic[3] - cubic[0]
            size = length(chord)
            if size < limits.short:
                short = arc(cubic)
                if short < limits.short:
                    count = put(table, count, SHORT, c, place, short)
                    continue
            if degrees[j] == 1:
                along, off = max(abs(chord.real), abs(chord.imag)), min(abs(chord.real), abs(chord.imag))
                angle = np.arctan2(off, along)
                # One unit is all that rounding may make of a line in whole units: it counts where the line is long.
                rounded = off < 1.5 and along < limits.slanted_length and is_whole(chord)
                if off >= limits.slanted_offset and angle < limits.slanted and not rounded:
                    count = put(table, count, SLANTED, c, place, np.degrees(angle))
                continue
            for p in (cubic.real, cubic.imag):
                first, second, third = p[1] - p[0], p[2] - p[1], p[3] - p[2]
                for t in quadratic_roots(first - 2 * second + third, 2 * (second - first), first):
                    s = 1 - t
                    at = s * s * (s * p[0] + 3 * t * p[1]) + t * t * (3 * s * p[2] + t * p[3])
                    beyond = max(at - max(p[0], p[3]), min(p[0], p[3]) - at)
                    if beyond > limits.extremum:
                        count = put(table, count, EXTREMUM, c, j - offsets[c] + t, beyond)
            if size >= limits.straight_length:
                off = off_line(segments, j, chord, limits)
                if off < limits.straight:
                    count = put(table, count, STRAIGHT, c, place, off)
                    continue
            if min(length(cubic[1] - cubic[0]), length(cubic[3] - cubic[2])) <= NO_HANDLE:
                count = put(table, count, RETRACTED, c, place, size)
            if degrees[j] == 3:
                reach, alone = reaches_beyond(cubic, limits)
                if reach > 0 and not alone:
                    count = put(table, count, HANDLES, c, place, reach)
                    continue
                back, other, t = bends_back(segments, j, limits)
                if reach > 0 and back > 0:
                    count = put(table, count, HANDLES, c, place, reach)
                # Of its larger turn, up to which the turn the other way is not meant: an S turns both ways alike.
                elif reach == 0 and 0 < back <= 0.25 * other:
                    count = put(table, count, INFLECTION, c, j - offsets[c] + t, np.degrees(back))
    return table[:count]


@compiled
def length(a: complex) -> float:
    """Length of a vector: in a third of the time of ``hypot``."""
    return np.sqrt(a.real * a.real + a.imag * a.imag)


@compiled
def arc(cubic: ComplexArray) -> float:
    """About how long a cubic is: midway between its chord and its control polygon."""
    legs = length(cubic[1] - cubic[0]) + length(cubic[2] - cubic[1]) + length(cubic[3] - cubic[2])
    return (length(cubic[3] - cubic[0]) + legs) / 2


@compiled
def turn_of(a: complex, b: complex) -> float:
    """Angle from one vector to another, positive to the left; NaN if one has no length."""
    both = a.conjugate() * b
    return np.arctan2(both.imag, both.real) if a != 0 and b != 0 else np.nan


@inlined
def least_kink(a: complex, b: complex, limit: float, deviations: float) -> float:
    """From which turn between two handles on a joint kinks: the limit, or what rounding to whole units may make."""
    return max(limit, deviations * rounding_turn(length(a), length(b))) if is_whole(a) and is_whole(b) else limit


@compiled
def rounding_turn(before: float, behind: float) -> float:
    """Standard deviation of the radians by which rounding to whole units turns a joint of two handles of these lengths.

    It is infinite for one of 0. The joint and the two other ends of the handles are rounded each, and the joint moves
    both handles.
    """
    first, second = 1 / before, 1 / behind
    both = first + second
    return DEVIATION * np.sqrt(first * first + second * second + both * both)


def rounding_turns(before: FloatArray, behind: FloatArray) -> FloatArray:
    """(n,) standard deviations of the turns of joints, see :func:`rounding_turn`."""
    return np.array([rounding_turn(a, b) for a, b in zip(before, behind, strict=True)])


@compiled
def rounding_variance(a: complex, b: complex, c: complex) -> float:
    """Variance of :func:`end_curvature` where rounding to whole units moves the three points.

    A level handle is level by design: both its ends are rounded alike.
    """
    own = b - a
    d = length(own)
    along = (own.conjugate() * (c - a)).real / (d * d)
    ends = 1.0 if own.real == 0 or own.imag == 0 else along * along + (1 - along) * (1 - along)
    height = 4 / 9 * (1 + ends) / (d * d * d * d)
    turn = end_curvature(a, b, c) / d
    return DEVIATION * DEVIATION * (height + 8 * turn * turn)


@inlined
def off_level(a: complex, b: complex, before: complex, behind: complex) -> float:
    """How far the handles of an extreme point are off level, the farther one; 0 if it is none.

    A point is extreme in x or y if both handles are nearly level, and the curve goes to one side of it.

    Args:
        a, b: handles in the contour's direction. before, behind: from the point to the ends of both curves.
    """
    for turned in range(2):
        if turned:
            a, b, before, behind = 1j * a, 1j * b, 1j * before, 1j * behind
        off = max(abs(a.imag), abs(b.imag))
        level = abs(a.imag) < LEVEL * abs(a.real) and abs(b.imag) < LEVEL * abs(b.real) and a.real * b.real > 0
        if level and before.imag * behind.imag > 0 and min(abs(before.imag), abs(behind.imag)) > off:
            return off
    return 0.0


@compiled
def is_whole(a: complex) -> bool:
    """Whether both coordinates are whole numbers, but for rounding errors."""
    return abs(a.real - np.rint(a.real)) < 1e-6 and abs(a.imag - np.rint(a.imag)) < 1e-6


@compiled
def end_curvature(a: complex, b: complex, c: complex) -> float:
    """Curvature of a cubic at the first of its first three points; not finite where the handle has no length."""
    own = b - a
    d = length(own)
    return 2 / 3 * (own.conjugate() * (c - a)).imag / (d * d * d)


@compiled
def quadratic_roots(a: float, b: float, c: float) -> tuple[float, float]:
    """The roots of a t² + b t + c inside (0, 1), ascending; NaN for those that there are not. None at a double root."""
    square = b * b - 4 * a * c
    if not square > 0:
        return np.nan, np.nan
    q = -0.5 * (b + (np.sqrt(square) if b >= 0 else -np.sqrt(square)))
    first, second = c / q, q / a  # one is infinite where the equation is linear
    first = first if AT_END < first < 1 - AT_END else np.nan
    second = second if AT_END < second < 1 - AT_END else np.nan
    return (second, first) if np.isnan(first) or second < first else (first, second)


@compiled
def off_line(segments: Segments, j: int, chord: complex, limits: Limits) -> float:
    """How far a segment leaves its chord; infinite if a line in its place kinks where it joins smoothly."""
    cubic, d = segments.points[j], length(chord)
    way = complex(chord.real / d, chord.imag / d)  # NumPy divides complex numbers otherwise than compiled code does
    first, second = (way.conjugate() * (cubic[1] - cubic[0])).imag, (way.conjugate() * (cubic[2] - cubic[0])).imag
    most = 0.0
    for t in quadratic_roots(3 * (first - second), 2 * second - 4 * first, first):
        if not np.isnan(t):
            most = max(most, abs(3 * t * (1 - t) * ((1 - t) * first + t * second)))
    if most >= limits.straight:
        return most
    arriving, leaving = segments.last[segments.before[j]], segments.first[segments.behind[j]]
    for other, own in ((arriving, segments.first[j]), (leaving, segments.last[j])):
        smooth = abs(turn_of(other, own)) < limits.corner_angle
        if smooth and abs(turn_of(other, chord)) >= least_kink(other, chord, limits.kink, limits.rounding):
            return np.inf
    return most


@compiled
def reaches_beyond(cubic: ComplexArray, limits: Limits) -> tuple[float, bool]:
    """Share by which a handle of a cubic reaches beyond where both handles meet, or beyond the other end; else 0.

    And whether only one handle does, and only the former: the cubic then has one inflection, and no cusp or loop.

    Where all points are in whole units, the handle's end and the meeting point may both be off by the rounding.
    """
    u, v, chord = cubic[1] - cubic[0], cubic[2] - cubic[3], cubic[3] - cubic[0]
    first, second, size = length(u), length(v), length(chord)
    if first == 0 or second == 0 or size == 0:
        return 0.0, False
    whole = is_whole(cubic[0]) and is_whole(cubic[1]) and is_whole(cubic[2]) and is_whole(cubic[3])
    rounding = 2 * ROUNDING if whole else 0.0
    most, alone = 0.0, False
    cross = (u.conjugate() * v).imag
    sine = abs(cross) / (first * second)
    if sine > limits.kink:
        s, r = (chord.conjugate() * v).imag / cross, (chord.conjugate() * u).imag / cross
        if s > 0 and r > 0:
            for own, share in ((first, s), (second, r)):
                if own * (1 - share) > rounding / sine:
                    most = max(most, 1 / share - 1)
            alone = (s < 1) != (r < 1)
    for beyond in ((u.conjugate() * chord).real, -(v.conjugate() * chord).real):
        if beyond - size * size > rounding * size:
            most, alone = max(most, beyond / (size * size) - 1), False
    return (most, alone) if most >= limits.handles else (0.0, False)


@compiled
def bends_back(segments: Segments, j: int, limits: Limits) -> tuple[float, float, float]:
    """Radians by which a cubic turns back, by which it turns the other way, and where the former begins or ends; or 0.

    A turn back at an end is meant if the neighbour, smoothly joined, bends that way too: their bend ends inside this
    segment. Where all points are in whole units, the corner of the control polygon that turns back must be more than
    rounding may make.
    """
    cubic = segments.points[j]
    a, b, c = cubic[1] - cubic[0], cubic[2] - cubic[1], cubic[3] - cubic[2]
    before, after = (a.conjugate() * b).imag, (b.conjugate() * c).imag
    both = (a.conjugate() * c).imag
    # The cross product of velocity and acceleration: (1-t)² before + t (1-t) both + t² after, but for a factor.
    low, high = quadratic_roots(before - both + after, both - 2 * before, before)
    if np.isnan(low):
        return 0.0, 0.0, 0.0
    left = right = 0.0
    turns = np.zeros(3)
    cuts = (0.0, low, 1.0 if np.isnan(high) else high, 1.0)
    last = 1 if np.isnan(high) else 2
    for k in range(last + 1):
        tangent = 0j
        for i in range(3):
            t = cuts[k] + (cuts[k + 1] - cuts[k]) * i / 2
            s = 1 - t
            turn, tangent = tangent.conjugate(), s * s * a + 2 * s * t * b + t * t * c
            turn *= tangent
            turns[k] += np.arctan2(turn.imag, turn.real) if i else 0.0
        left, right = left + max(turns[k], 0.0), right + max(-turns[k], 0.0)
    sign = 1.0 if left < right else -1.0  # of the smaller turn
    back, other = min(left, right), max(left, right)
    if back < limits.inflection:
        return 0.0, 0.0, 0.0
    if turns[1] * sign > 0 and last == 2:
        return back, other, (low + high) / 2
    at_start = turns[0] * sign > turns[last] * sign
    if is_whole(cubic[0]) and is_whole(cubic[1]) and is_whole(cubic[2]) and is_whole(cubic[3]):
        corner = turn_of(a, b) if at_start else turn_of(b, c)
        if sign * corner < ROUNDING * (1 / length(b) + 1 / length(a if at_start else c)):
            return 0.0, 0.0, 0.0
    i = segments.before[j] if at_start else segments.behind[j]
    own, beside = (segments.first[j], segments.last[i]) if at_start else (segments.last[j], segments.first[i])
    p = segments.points[i]
    bend = -end_curvature(p[3], p[2], p[1]) if at_start else end_curvature(p[0], p[1], p[2])
    if abs(turn_of(beside, own)) < limits.corner_angle and segments.degrees[i] > 1 and sign * bend > 0:
        return 0.0, 0.0, 0.0
    return back, other, low if at_start or np.isnan(high) else high
