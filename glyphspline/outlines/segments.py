"""The segments of contours end to end, compiled."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..curves.cubics import raised
from ..types import FloatArray, IntArray
from .contour_arrays import ContourArrays


@compiled
def contour_cubics(contours: ContourArrays, c: int) -> FloatArray:
    """(m, 4, 2) the segments of contour c as cubics."""
    points = contours.points[contours.starts[c] : contours.starts[c + 1]]
    return raised(points, contours.degrees[contours.offsets[c] : contours.offsets[c + 1]])


@compiled
def all_cubics(contours: ContourArrays) -> FloatArray:
    """(m, 4, 2) the segments of all contours as cubics; those of contour c begin at ``offsets[c]``."""
    cubics = np.empty((len(contours.degrees), 4, 2))
    for c in range(len(contours.offsets) - 1):
        own, first = contour_cubics(contours, c), contours.offsets[c]
        for j in range(len(own)):
            for k in range(4):
                cubics[first + j, k, 0], cubics[first + j, k, 1] = own[j, k, 0], own[j, k, 1]
    return cubics


@compiled
def lasting(cubics: FloatArray) -> IntArray:
    """Indices of the cubics (m, 4, 2) whose points are not all the same."""
    found, count = np.empty(len(cubics), dtype=np.int64), 0
    for j in range(len(cubics)):
        b = cubics[j]
        for k in range(1, 4):
            if b[k, 0] != b[0, 0] or b[k, 1] != b[0, 1]:
                found[count] = j
                count += 1
                break
    return found[:count]
