"""What a comb has to know of contours, compiled: on which side of each the ink is, and where they have corners."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled, inlined
from ..curves.cubics import jet, turns
from ..curves.integrals import area
from ..types import BoolArray, FloatArray, IntArray
from .contour_arrays import ContourArrays
from .segments import all_cubics, contour_cubics

CHORDS = 4
"""Chords a segment for which a point counts as inside or outside."""


@compiled
def ink_sides(contours: ContourArrays) -> FloatArray:
    """(C,) 1.0 where the ink is to the left of a contour, -1.0 where it is to the right.

    Curvature times this is positive where the ink is convex, whichever way a font draws its outer contours: TrueType
    clockwise, PostScript counter-clockwise. A contour that runs counter-clockwise has its ink to the left, unless it is
    the counter of a clockwise one, where the others wind the other way round it. That is looked at in the middle of one
    segment, whichever point the contour begins at: contours may share ends of segments.
    """
    count, offsets, cubics = len(contours.offsets) - 1, contours.offsets, all_cubics(contours)
    chords, known, sides = np.empty((CHORDS * len(cubics), 2)), np.zeros(count, dtype=np.bool_), np.empty(count)
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)  # corners of boxes around contours
    for c in range(count):
        for j in range(offsets[c], offsets[c + 1]):
            for k in range(4):
                for axis in range(2):
                    low[c, axis] = min(low[c, axis], cubics[j, k, axis])
                    high[c, axis] = max(high[c, axis], cubics[j, k, axis])
    for c in range(count):
        own = cubics[offsets[c] : offsets[c + 1]]
        sides[c] = -1.0 if area(own) < 0.0 else 1.0
        x = y = np.inf
        for j in range(len(own)):
            px, py, _, _, _, _ = jet(own, j, 0.5)
            if px + py < x + y:
                x, y = px, py
        around = 0
        for other in range(count):
            if other == c or not (low[other, 0] <= x <= high[other, 0] and low[other, 1] <= y <= high[other, 1]):
                continue
            first, last = CHORDS * offsets[other], CHORDS * offsets[other + 1]
            for i in range(last if known[other] else first, last):
                chords[i, 0], chords[i, 1], _, _, _, _ = jet(cubics, i // CHORDS, i % CHORDS / CHORDS)
            known[other] = True
            around += winding(chords[first:last], x, y)
        if around * sides[c] < 0.0:
            sides[c] = -sides[c]
    return sides


@inlined
def winding(polygon: FloatArray, x: float, y: float) -> int:
    """How often a closed polygon (n, 2) runs around a point, counter-clockwise."""
    found = 0
    for i in range(len(polygon)):
        ax, ay, bx, by = polygon[i - 1, 0] - x, polygon[i - 1, 1] - y, polygon[i, 0] - x, polygon[i, 1] - y
        if (ay <= 0.0) != (by <= 0.0):
            left = ax * by - ay * bx
            if by > ay and left > 0.0:
                found += 1
            elif by < ay and left < 0.0:
                found -= 1
    return found


@compiled
def corner_points(contours: ContourArrays, angle: float) -> tuple[FloatArray, IntArray]:
    """(k, 2) where the tangents turn by ``angle``, in radians, or more; (C + 1,) where those of each contour begin."""
    found, ends, k = np.empty((len(contours.degrees), 2)), np.zeros(len(contours.offsets), dtype=np.int64), 0
    for c in range(len(ends) - 1):
        if angle < np.inf and contours.offsets[c] < contours.offsets[c + 1]:
            cubics = contour_cubics(contours, c)
            turned = turns(cubics, 0.0)
            for j in range(len(turned)):
                if abs(turned[j]) >= angle:
                    found[k, 0], found[k, 1], k = cubics[j, 0, 0], cubics[j, 0, 1], k + 1
        ends[c + 1] = k
    return found[:k], ends


@compiled
def turned_about(corners: FloatArray, points: FloatArray, cut: BoolArray, near: float) -> BoolArray:
    """(n,) which points of a contour (n, 2) lie in the turn about one of its corners (k, 2).

    A curve turns about a corner if it has a point whose tooth would be ``cut`` within the distance ``near``; the turn
    is all that is within this distance.
    """
    inside, sharp, square = np.zeros(len(points), dtype=np.bool_), np.flatnonzero(cut), near * near
    for k in range(len(corners)):
        turns_here = False
        for j in sharp:
            x, y = points[j, 0] - corners[k, 0], points[j, 1] - corners[k, 1]
            turns_here = turns_here or x * x + y * y <= square
        for i in range(len(points) if turns_here else 0):
            x, y = points[i, 0] - corners[k, 0], points[i, 1] - corners[k, 1]
            inside[i] = inside[i] or x * x + y * y <= square
    return inside
