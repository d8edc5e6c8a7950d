"""Which mode suits a face: whether its outlines are mostly corners and lines, as type is, or mostly smooth."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from .contour_arrays import ContourArrays
from .outline import Outline
from .sampling_limits import CORNER_ANGLE


def share_of_corners(outlines: Iterable[Outline]) -> float:
    """The share of joints at which a contour turns by the corner angle, or a line begins or ends; 0 without joints."""
    counts = np.sum([_count(outline.arrays) for outline in outlines] or [(0, 0)], axis=0)
    return float(counts[0] / max(counts[1], 1))


def _count(contours: ContourArrays) -> tuple[int, int]:
    """Joints that are corners or ends of lines, and all joints."""
    hard = total = 0
    for c in range(contours.num_contours):
        own = contours.part(c, c + 1)
        points, degrees = own.points, own.degrees
        first = np.cumsum(degrees) - degrees
        leaving = points[(first + 1) % len(points)] - points[first]
        arriving = np.roll(points[(first + degrees) % len(points)] - points[first + degrees - 1], 1, axis=0)
        cross = arriving[:, 0] * leaving[:, 1] - arriving[:, 1] * leaving[:, 0]
        corner = np.abs(np.arctan2(cross, (arriving * leaving).sum(axis=1))) >= np.radians(CORNER_ANGLE)
        line = degrees == 1
        hard += int((corner | line | np.roll(line, 1)).sum())
        total += len(degrees)
    return hard, total
