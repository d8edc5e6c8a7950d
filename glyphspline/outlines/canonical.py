"""A start and a direction that belong to a contour's shape, so that how it is given makes no difference to its fit."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..types import FloatArray


@compiled
def farthest_joint(joints: FloatArray) -> int:
    """Index of the joint (m, 2) farthest from the middle of all; of several, that farthest right, then up."""
    m = len(joints)
    x, y = joints[:, 0].sum() / m, joints[:, 1].sum() / m
    best, reached = 0, -1.0
    for j in range(m):
        reach = np.rint(np.hypot(joints[j, 0] - x, joints[j, 1] - y) * 1e6)
        x_ahead, y_ahead = joints[j, 0] - joints[best, 0], joints[j, 1] - joints[best, 1]
        if reach > reached or (reach == reached and (x_ahead > 0 or (x_ahead == 0 and y_ahead > 0))):
            best, reached = j, reach
    return best


@compiled
def runs_backwards(cubics: FloatArray) -> bool:
    """Whether to fit a chain of cubics (m, 4, 2) the other way round.

    Told by the chords of its segments: the sum changes its sign with the direction, is the same from every start,
    and knows no shift, turn or mirror.
    """
    m = len(cubics)
    h = np.hypot(cubics[:, 3, 0] - cubics[:, 0, 0], cubics[:, 3, 1] - cubics[:, 0, 1])
    total = 0.0
    for j in range(m):
        after = h[(j + 1) % m]
        total += h[j] * after * (h[j] - after)
    return total < 0


@compiled
def flip(cubics: FloatArray) -> FloatArray:
    """The same chain of cubics run the other way, beginning at the same point."""
    return cubics[::-1, ::-1].copy()


@compiled
def directed(cubics: FloatArray) -> tuple[FloatArray, bool]:
    """A chain of cubics in the direction in which it is fitted, and whether that is not its own."""
    flipped = runs_backwards(cubics)
    return flip(cubics) if flipped else cubics, flipped


@compiled
def direction(cubic: FloatArray, at_end: bool, least: float) -> tuple[float, float, float]:
    """Where a cubic (4, 2) goes at an end: a vector along it and its length, all 0 if there is none.

    Handles of length ``least`` or less are passed over.
    """
    for j in range(1, 4):
        if at_end:
            x, y = cubic[3, 0] - cubic[3 - j, 0], cubic[3, 1] - cubic[3 - j, 1]
        else:
            x, y = cubic[j, 0] - cubic[0, 0], cubic[j, 1] - cubic[0, 1]
        length = np.hypot(x, y)
        if length > least:
            return x, y, length
    return 0.0, 0.0, 0.0


@compiled
def turn(ax: float, ay: float, bx: float, by: float) -> float:
    """Angle between two directions, 0 to pi."""
    return abs(np.arctan2(ax * by - ay * bx, ax * bx + ay * by))
