"""How the ink of two outlines differs, and how deep inside what changed a point is.

Ink is what contours wind around, by the nonzero rule. While outlines are moved by no more than the tolerance, only
points that near to them can change from white to ink. So a point of changed ink that is farther from both, its *depth*,
shows that there is more to it. The deepest one is sought in boxes, which are left out where the distance of their
middles from the outlines says that no point in them is much deeper, or that nothing in them changed; others are halved.
That is measured on the curves; the areas are those of polygons (:mod:`..outlines.regions`).
"""

from __future__ import annotations

import numpy as np

from ...arrays import grown
from ...compiled import compiled
from ...curves.cubics import length
from ...outlines.contour_arrays import NO_CONTOURS, ContourArrays
from ...outlines.outline_distance import STACK, Searched, nearest_of_outline
from ...outlines.regions import ink_difference
from ...outlines.winding import MOST_HALVINGS, winding
from ...types import FloatArray
from .difference import Ink

LEAST = 1e-4
"""The smallest tolerance that explains changes of ink, as a share of the em."""

SHARP = 0.25
"""Share of the depth, or of the tolerance, by which a point may be deeper and be missed."""

MISS = 0.01
"""Share of the tolerance by which distances from the outlines may be less than what is found."""

MOST_BOXES = 500_000
"""Boxes of a glyph that are looked at, a second's work."""

FLATNESS = 0.125
"""Of the polygons, in tolerances."""


def changed_ink(old: ContourArrays, new: ContourArrays, deepest: FloatArray, tolerance: float) -> Ink:
    """How the ink of two outlines differs of which the :func:`deepest_point` is known."""
    found = ink_difference(old, new, FLATNESS * tolerance)
    area, new_area = (ink_difference(NO_CONTOURS, each, FLATNESS * tolerance).area for each in (old, new))
    depth, x, y = deepest.tolist()
    return Ink(found.area, found.error, area, new_area, found.lost, found.gained, depth, (x, y))


@compiled
def deepest_point(old: Searched, new: Searched, boxes: FloatArray, tolerance: float, found: FloatArray) -> bool:
    """The depth of a point of changed ink, and the point, into an array (3,) of zeros, if it is beyond the tolerance.

    Args:
        boxes: (k, 4) left, bottom, right, top: where it is sought.

    Returns:
        Whether the search came to its end: none is deeper than that, or the tolerance, by more than ``SHARP``.
    """
    places, pieces = np.empty((STACK, 2)), np.empty((MOST_HALVINGS + 1, 4, 2))
    miss, looked = MISS * tolerance, 0
    s, z, r, w = 0, 0.5, 0, 0.5
    stack = np.empty((64, 4))
    for k in range(len(boxes)):
        stack[0] = boxes[k]
        top = 0
        while top >= 0 and looked < MOST_BOXES:
            looked += 1
            left, bottom, right, high = stack[top, 0], stack[top, 1], stack[top, 2], stack[top, 3]
            top -= 1
            x, y = (left + right) / 2, (bottom + high) / 2
            reach, limit = length(right - x, high - y), max(tolerance, found[0])
            s, z, near = nearest_of_outline(old, x, y, s, z, (miss, 0.0), places)
            if near + reach <= (1.0 + SHARP) * limit:
                continue
            r, w, its_near = nearest_of_outline(new, x, y, r, w, (miss, 0.0), places)
            if its_near + reach <= (1.0 + SHARP) * limit:
                continue
            depth = min(near, its_near) - miss
            if depth > min(limit, reach):
                filled = winding(old.cubics, 0, len(old.cubics), x, y, pieces) != 0
                its_filled = winding(new.cubics, 0, len(new.cubics), x, y, pieces) != 0
                if filled == its_filled and depth > reach:
                    continue
                if filled != its_filled and depth > limit:
                    found[0], found[1], found[2] = depth, x, y
            stack = grown(stack, top + 3)
            stack[top + 1] = stack[top + 2] = left, bottom, right, high
            across = 0 if right - left > high - bottom else 1
            stack[top + 1, across] = stack[top + 2, 2 + across] = x if across == 0 else y
            top += 2
    return looked < MOST_BOXES
