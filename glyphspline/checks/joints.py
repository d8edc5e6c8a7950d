"""Joints of segments: kinks, and jumps of curvature."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..curves.cubics import directions, length
from ..outlines.contour_arrays import ContourArrays
from ..types import FloatArray
from .kinds import JUMP, KINK, Limits
from .table import COLUMNS, add

NO_HANDLE = 1e-9
"""Share of the em up to which a handle gives no tangent."""

ROUNDING = np.sqrt(0.5)
"""How far rounding to whole units moves a point at most. It moves the two ends of a handle."""


@compiled
def joint_findings(cubics: FloatArray, contours: ContourArrays, limits: Limits) -> FloatArray:
    """(n, 6) kinks and jumps of curvature of contours; see :mod:`.table`.

    A joint is smooth if it turns by less than the corner angle. It kinks if it turns by more than the limit, and, where
    both handles are in whole units, by more than rounding may make. Curvature jumps are told where both sides are
    cubics: a chain of quadratics has them everywhere.

    Args:
        cubics: (m, 4, 2) segments of all contours. contours: their degrees and offsets.
    """
    table, count = np.empty((16, COLUMNS)), 0
    for c in range(len(contours.offsets) - 1):
        a, b = contours.offsets[c], contours.offsets[c + 1]
        for j in range(a, b):
            i = j - 1 if j > a else b - 1
            _, _, ax, ay = directions(cubics, i, NO_HANDLE)
            bx, by, _, _ = directions(cubics, j, NO_HANDLE)
            before, after = 3 / contours.degrees[i], 3 / contours.degrees[j]  # the segments are raised to cubics
            ax, ay, bx, by = before * ax, before * ay, after * bx, after * by
            first, second = length(ax, ay), length(bx, by)
            if first == 0.0 or second == 0.0:
                continue
            turn = np.arctan2(ax * by - ay * bx, ax * bx + ay * by)
            if abs(turn) >= limits.corner_angle:
                continue
            whole = is_whole(ax, ay) and is_whole(bx, by)
            if abs(turn) >= max(limits.kink, ROUNDING * (1 / first + 1 / second) if whole else 0.0):
                table = add(table, count, KINK, c, j - a, abs(np.degrees(turn)), np.nan, -1)
                count += 1
            elif contours.degrees[i] == 3 and contours.degrees[j] == 3:
                before, after = end_curvature(cubics[i], True), end_curvature(cubics[j], False)
                jump, most = abs(after - before), max(abs(before), abs(after))
                if limits.jump <= jump < np.inf and jump >= limits.relative_jump * most:
                    table = add(table, count, JUMP, c, j - a, jump, jump / most, -1)
                    count += 1
    return table[:count]


@compiled(internal=True)
def is_whole(x: float, y: float) -> bool:
    """Whether both coordinates are whole numbers, but for rounding errors."""
    return abs(x - np.rint(x)) < 1e-6 and abs(y - np.rint(y)) < 1e-6


@compiled(internal=True)
def end_curvature(cubic: FloatArray, last: bool) -> float:
    """Curvature at an end of a cubic (4, 2) in its direction; not finite where the handle has no length."""
    i, j, k = (3, 2, 1) if last else (0, 1, 2)
    ax, ay = cubic[j, 0] - cubic[i, 0], cubic[j, 1] - cubic[i, 1]
    bx, by = cubic[k, 0] - cubic[i, 0], cubic[k, 1] - cubic[i, 1]
    own = 2 / 3 * (ax * by - ay * bx) / length(ax, ay) ** 3
    return -own if last else own
