"""Start point and direction from a contour's shape, so that the fit does not depend on how the font stores it."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..types import FloatArray


@compiled
def farthest_joint(joints: FloatArray) -> int:
    """Index of the joint (m, 2) farthest from the mean of all; ties go to the rightmost, then the uppermost."""
    m = len(joints)
    x = y = 0.0
    for j in range(m):
        x += joints[j, 0]
        y += joints[j, 1]
    x, y = x / m, y / m
    best, reached = 0, -1.0
    for j in range(m):
        reach = np.rint(np.hypot(joints[j, 0] - x, joints[j, 1] - y) * 1e6)
        x_ahead, y_ahead = joints[j, 0] - joints[best, 0], joints[j, 1] - joints[best, 1]
        if reach > reached or (reach == reached and (x_ahead > 0 or (x_ahead == 0 and y_ahead > 0))):
            best, reached = j, reach
    return best


@compiled
def directed(cubics: FloatArray) -> tuple[FloatArray, bool]:
    """A closed chain of cubics (m, 4, 2) in the direction in which it is fitted, and whether it was reversed.

    The sign of a sum over the segments' chords decides. It changes with the direction, but not with the start point,
    nor with shift, rotation or reflection of the contour.
    """
    m = len(cubics)
    total = 0.0
    before = np.hypot(cubics[0, 3, 0] - cubics[0, 0, 0], cubics[0, 3, 1] - cubics[0, 0, 1])
    for j in range(m):
        k = (j + 1) % m
        after = np.hypot(cubics[k, 3, 0] - cubics[k, 0, 0], cubics[k, 3, 1] - cubics[k, 0, 1])
        total += before * after * (before - after)
        before = after
    if not total < 0:
        return cubics, False
    flipped = np.empty((m, 4, 2))
    for j in range(m):
        for k in range(4):
            for axis in range(2):
                flipped[j, k, axis] = cubics[m - 1 - j, 3 - k, axis]
    return flipped, True


@compiled
def begun_at(cubics: FloatArray, first: int) -> FloatArray:
    """A closed chain of cubics (m, 4, 2) from joint ``first`` on."""
    m = len(cubics)
    turned = np.empty((m, 4, 2))
    for j in range(m):
        for k in range(4):
            for axis in range(2):
                turned[j, k, axis] = cubics[(first + j) % m, k, axis]
    return turned
