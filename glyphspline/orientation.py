"""A start and a direction that belong to a contour's shape, so that how it is given makes no difference to its fit."""

from __future__ import annotations

import numpy as np

from .arrays import FloatArray
from .outline import Contour


def farthest_joint(joints: FloatArray) -> int:
    """Index of the joint (m, 2) farthest from the middle of all; of several, that farthest right, then up."""
    reach = np.hypot(*(joints - joints.mean(axis=0)).T)
    return int(max(range(len(joints)), key=lambda j: (round(reach[j], 6), *joints[j])))


def runs_backwards(cubics: FloatArray) -> bool:
    """Whether to fit a chain of cubics (m, 4, 2) the other way round.

    Told by the chords of its segments: the sum changes its sign with the direction, is the same from every start,
    and knows no shift, turn or mirror.
    """
    h = np.hypot(*(cubics[:, 3] - cubics[:, 0]).T)
    after = np.roll(h, -1)
    return bool((h * after * (h - after)).sum() < 0)


def flip(cubics: FloatArray) -> FloatArray:
    """The same chain of cubics run the other way, beginning at the same point."""
    return np.ascontiguousarray(cubics[::-1, ::-1])


def canonical(contour: Contour) -> tuple[Contour, bool]:
    """The contour begun at its farthest joint and run in the direction of its shape, and whether that flipped it."""
    flipped = runs_backwards(contour.cubics())
    if flipped:
        contour = contour.reversed()
    k = farthest_joint(contour.points[contour.offsets])
    return Contour(np.roll(contour.points, -contour.offsets[k], axis=0), np.roll(contour.degrees, -k)), flipped
