"""Joints of segments: kinks, and jumps of curvature."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..curves.comb import size_of
from ..curves.cubics import directions, length
from ..outlines.contour_arrays import ContourArrays
from ..types import FloatArray, IntArray
from .kinds import JUMP, KINK, Limits

NO_HANDLE = 1e-6
"""Length in font units up to which a handle gives no tangent; the next control point then gives one."""

ROUNDING = np.sqrt(0.5)
"""How far rounding to whole units moves a point at most. It moves the two ends of a handle."""

CHANCE = 3 * np.sqrt(1 / 12)
"""Three standard deviations of a coordinate's rounding error: a smooth joint in 300 turns by more than this makes."""


COLUMNS = 6
WHAT, CONTOUR, PLACE, VALUE, DETAIL, OTHER = range(COLUMNS)
"""Columns of the table (n, 6) that compiled passes return: number of the kind; contour; place on it, segment and local
parameter; value in the kind's unit, curvatures in 1/unit; second number, or NaN; another contour, or -1."""


@compiled
def add(
    table: FloatArray, count: int, what: int, contour: int, place: float, value: float, detail: float, other: int
) -> FloatArray:
    """The table with one more row after ``count``; in a larger array if need be."""
    if count == len(table):
        longer = np.empty((2 * count + 16, COLUMNS))
        for i in range(count):
            for k in range(COLUMNS):
                longer[i, k] = table[i, k]
        table = longer
    row = table[count]
    row[WHAT], row[CONTOUR], row[PLACE] = what, contour, place
    row[VALUE], row[DETAIL], row[OTHER] = value, detail, other
    return table


@compiled
def joint_findings(cubics: FloatArray, contours: ContourArrays, limits: Limits) -> FloatArray:
    """(n, 6) kinks and jumps of curvature of contours; see ``COLUMNS``.

    A joint is smooth if it turns by less than a corner does, of two lines by less than their own limit. It kinks if it
    turns by more than the limit, and, where both handles are in whole units, by more than rounding may make. Curvature
    jumps are told where both sides are cubics: a chain of quadratics has them everywhere.

    Args:
        cubics: (m, 4, 2) segments of all contours. contours: their degrees and offsets.
    """
    table, count = np.empty((16, COLUMNS)), 0
    for c in range(len(contours.offsets) - 1):
        a, b = contours.offsets[c], contours.offsets[c + 1]
        for j in range(a, b):
            i = neighbour(cubics, a, b, j, -1)
            ax, ay = handle(cubics, contours.degrees, i, True)
            bx, by = handle(cubics, contours.degrees, j, False)
            turn = turn_of(ax, ay, bx, by)
            lines = contours.degrees[i] == 1 and contours.degrees[j] == 1
            if not abs(turn) < (limits.line_angle if lines else limits.corner_angle):
                continue
            if abs(turn) >= least_kink(ax, ay, bx, by, limits):
                table = add(table, count, KINK, c, j - a, abs(np.degrees(turn)), np.nan, -1)
                count += 1
            elif contours.degrees[i] == 3 and contours.degrees[j] == 3:
                before, after = end_curvature(cubics[i], True), end_curvature(cubics[j], False)
                jump, most = abs(after - before), max(abs(before), abs(after))
                if limits.jump <= jump < np.inf and jump >= limits.relative_jump * most:
                    table = add(table, count, JUMP, c, j - a, jump, jump / most, -1)
                    count += 1
    return table[:count]


@compiled
def neighbour(cubics: FloatArray, a: int, b: int, j: int, step: int) -> int:
    """The next segment of the contour of segments a to b, exclusive, from j in steps of 1 or -1, that has an extent.

    It is j itself if no other has.
    """
    i = j
    for _ in range(b - a):
        i = a + (i - a + step) % (b - a)
        if size_of(cubics, i) > NO_HANDLE:
            return i
    return j


@compiled
def handle(cubics: FloatArray, degrees: IntArray, j: int, last: bool) -> tuple[float, float]:
    """The first handle of a segment, or the last, in its direction and as long as it is before it is made a cubic."""
    ax, ay, bx, by = directions(cubics, j, NO_HANDLE)
    scale = 3 / degrees[j]
    return (scale * bx, scale * by) if last else (scale * ax, scale * ay)


@compiled
def turn_of(ax: float, ay: float, bx: float, by: float) -> float:
    """Angle from one vector to another, positive to the left; NaN if one has no length."""
    if (ax == 0.0 and ay == 0.0) or (bx == 0.0 and by == 0.0):
        return np.nan
    return np.arctan2(ax * by - ay * bx, ax * bx + ay * by)


@compiled
def least_kink(ax: float, ay: float, bx: float, by: float, limits: Limits) -> float:
    """From which turn between two handles on a joint kinks: the limit, or what rounding to whole units may make."""
    if not (is_whole(ax, ay) and is_whole(bx, by)):
        return limits.kink
    return max(limits.kink, rounding_turn(length(ax, ay), length(bx, by)))


@compiled
def rounding_turn(before: float, behind: float) -> float:
    """Radians by which rounding to whole units may turn a joint of two handles of these lengths; infinite for one of 0.

    The joint and the two other ends of the handles are rounded each, and the joint moves both handles.
    """
    first, second = 1 / before, 1 / behind
    return CHANCE * np.sqrt(first * first + second * second + (first + second) ** 2)


@compiled
def is_whole(x: float, y: float) -> bool:
    """Whether both coordinates are whole numbers, but for rounding errors."""
    return abs(x - np.rint(x)) < 1e-6 and abs(y - np.rint(y)) < 1e-6


@compiled
def end_curvature(cubic: FloatArray, last: bool) -> float:
    """Curvature at an end of a cubic (4, 2) in its direction; not finite where the handle has no length."""
    i, j, k = (3, 2, 1) if last else (0, 1, 2)
    ax, ay = cubic[j, 0] - cubic[i, 0], cubic[j, 1] - cubic[i, 1]
    bx, by = cubic[k, 0] - cubic[i, 0], cubic[k, 1] - cubic[i, 1]
    own = 2 / 3 * (ax * by - ay * bx) / length(ax, ay) ** 3
    return -own if last else own
