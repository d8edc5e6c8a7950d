"""How the ink of two outlines differs, and how deep inside what changed a point is.

Ink is what contours wind around, by the nonzero rule. Its area, islands and counters come from polygons
(:mod:`..outlines.regions`). Whether a tolerance explains the change does not: while outlines are moved by no more than
it, only points that near to them can change from white to ink. So a point of changed ink that is farther from both, its
*depth*, shows that there is more to it. The deepest one is sought in boxes, which are left out where the distance of
their middles from the outlines says that no point in them is much deeper, or that nothing in them changed; others are
halved. All this is measured on the curves.
"""

from __future__ import annotations

import numpy as np

from ..arrays import grown
from ..checks.enclosed import MOST_HALVINGS, winding
from ..compiled import compiled
from ..outlines.contour_arrays import ContourArrays
from ..outlines.polygons import flattened
from ..outlines.regions import unmatched
from ..outlines.slabs import Slabs
from ..types import FloatArray
from .difference import Ink
from .outline_distance import STACK, Chains, chains_of, nearest_of_outline

FLATTER, LEAST = 0.125, 1e-4
"""Flatness of the polygons, in tolerances. The smallest tolerance that explains changes, as a share of the em."""

SHARP = 0.25
"""Share of the depth, or of the tolerance, by which a point may be deeper and be missed."""

MISS = 0.01
"""Share of the tolerance by which distances from the outlines may be less than what is found."""

MOST_BOXES = 500_000
"""Boxes that are looked at, a second's work: others take hundreds."""


def ink_difference(old: ContourArrays, new: ContourArrays, tolerance: float, em: float) -> Ink:
    """What changed in the ink of two outlines that are not empty.

    Args:
        tolerance: depths up to it are not sought; islands and counters that are narrower than twice that do not count.
    """
    tolerance = max(tolerance, LEAST * em)
    (one, bound), (other, its_bound) = (flattened(each, FLATTER * tolerance) for each in (old, new))
    slabs = Slabs(one, other)
    area, new_area = (float(slabs.areas[slabs.inked[:, k]].sum()) for k in range(2))
    if not slabs.differ:
        return Ink(0.0, 0.0, area, new_area)
    lost, gained = unmatched(slabs, 2 * tolerance)
    deepest = np.zeros(3)
    boxes = changed_boxes(slabs, 2 * tolerance)
    complete = deepest_point(chains_of(old), chains_of(new), boxes, tolerance, deepest)
    depth, x, y = deepest.tolist()
    error = float(max(bound, its_bound) * slabs.moved_length)
    return Ink(slabs.area, error, area, new_area, lost, gained, depth, (x, y) if depth else None, complete)


def changed_boxes(slabs: Slabs, least: float) -> FloatArray:
    """(k, 4) left, bottom, right, top of what only one of two outlines fills in each slab, where it is as wide."""
    changed = slabs.inked[:, 0] != slabs.inked[:, 1]
    before = np.concatenate([[False], changed[:-1]])
    begin, end = np.flatnonzero(changed & ~before), np.flatnonzero(before & ~changed)  # a slab ends unchanged
    left, right = slabs.places[:, begin].min(axis=0), slabs.places[:, end].max(axis=0)
    slab = slabs.slab[begin]
    boxes = np.stack([left, slabs.levels[slab - 1], right, slabs.levels[slab]], axis=1)
    return np.ascontiguousarray(boxes[right - left > least])


@compiled
def deepest_point(old: Chains, new: Chains, boxes: FloatArray, tolerance: float, found: FloatArray) -> bool:
    """The depth of a point of changed ink, and the point, into an array (3,) of zeros, if it is beyond the tolerance.

    Args:
        boxes: (k, 4) in which it is sought.

    Returns:
        Whether none is deeper than that, or the tolerance, by more than ``SHARP``.
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
            s, z, near = nearest_of_outline(old, x, y, s, z, (miss, 0.0), places)
            r, w, its_near = nearest_of_outline(new, x, y, r, w, (miss, 0.0), places)
            depth, reach = min(near, its_near) - miss, np.hypot(right - x, high - y)
            limit = max(tolerance, found[0])
            if depth + miss + reach <= (1.0 + SHARP) * limit:
                continue
            if depth > min(limit, reach):
                filled = winding(old.cubics, 0, len(old.cubics), x, y, pieces) != 0
                its_filled = winding(new.cubics, 0, len(new.cubics), x, y, pieces) != 0
                if filled == its_filled and depth > reach:
                    continue
                if filled != its_filled and depth > limit:
                    found[0], found[1], found[2] = depth, x, y
                    if depth + miss + reach <= (1.0 + SHARP) * depth:
                        continue
            stack = grown(stack, top + 3)
            stack[top + 1] = stack[top + 2] = left, bottom, right, high
            across = 0 if right - left > high - bottom else 1
            stack[top + 1, across] = stack[top + 2, 2 + across] = x if across == 0 else y
            top += 2
    return looked < MOST_BOXES
