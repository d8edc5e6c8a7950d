"""Where two outlines run beside each other in order: there the ink is the same but for what lies between them.

Contours that follow each other are paired from the nearest place of one segment's beginning to that of the next, and
each stretch is bounded as for the certificate of a fit (:mod:`..curves.pairing`). While one contour is moved to the
other along the pairs, straight and all at once, no point farther from them than the bound is swept, so none of these
changes its winding number. The swept area is at most the bound times the mean of both lengths.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.integrals import area
from ...curves.pairing import SHARPNESS, pair_instances
from ...outlines.outline_distance import Searched
from ...types import FloatArray, IntArray

BACK = 0.1
"""Share of a contour by which the next place may lie back: a rounded corner has the same nearest place for both its
ends, or one that is a little off."""


def unfollowed(old: Searched, new: Searched, nearest: FloatArray, tolerance: float) -> FloatArray:
    """(k, 4) boxes around the contours of both outlines that do not run beside one of the other within the tolerance.

    Contours belong together in pairs that run in one direction; or that run against each other, all of them.

    Args:
        nearest: (m, 2) segments of the new outline, and parameters on them, nearest to where the m old ones begin.
    """
    segments = nearest[:, 0].astype(np.int64)
    partners, places, offsets, cubics = new.owners[segments], segments + nearest[:, 1], new.offsets, new.cubics
    if areas(old) * areas(new) < 0:
        cubics, last = np.ascontiguousarray(cubics[::-1, ::-1]), len(offsets) - 2
        partners, places, offsets = last - partners, len(cubics) - places, len(cubics) - offsets[::-1]
    own = followers(old.cubics, old.offsets, cubics, offsets, partners, places, tolerance)
    alone = np.ones(len(offsets) - 1, dtype=np.bool_)
    alone[own[own >= 0]] = False
    boxes = np.concatenate([boxes_of(old.cubics, old.offsets), boxes_of(cubics, offsets)])
    return boxes[np.concatenate([own < 0, alone])]


def boxes_of(cubics: FloatArray, offsets: IntArray) -> FloatArray:
    """(C, 4) left, bottom, right and top of contours' Bézier points."""
    low, high = (which.reduceat(cubics, offsets[:-1]) for which in (np.minimum, np.maximum))
    return np.concatenate([low.min(axis=1), high.max(axis=1)], axis=1)


@compiled
def areas(chains: Searched) -> float:
    """The sum of the contours' signed areas."""
    total = 0.0
    for c in range(len(chains.offsets) - 1):
        total += area(chains.cubics[chains.offsets[c] : chains.offsets[c + 1]])
    return total


@compiled
def followers(
    old: FloatArray, old_offsets: IntArray, new: FloatArray, new_offsets: IntArray, partners: IntArray,
    places: FloatArray, tolerance: float,
) -> IntArray:  # fmt: skip
    """(C,) the new contour that runs beside each old one, and beside no other before it; -1 if none does.

    Args:
        old: (m, 4, 2) and new: (n, 4, 2), with offsets of contours.
        partners: (m,) the new contour nearest to where each old segment begins, and places: (m,) where on it, counted
            from the first contour on.
    """
    found = np.full(len(old_offsets) - 1, -1)
    taken = np.zeros(len(new_offsets) - 1, dtype=np.bool_)
    for c in range(len(found)):
        first, last, partner = old_offsets[c], old_offsets[c + 1], partners[old_offsets[c]]
        if taken[partner] or np.any(partners[first:last] != partner):
            continue
        begin, end = new_offsets[partner], new_offsets[partner + 1]
        anchors = anchors_of(places[first:last] - begin, end - begin)
        if len(anchors) and runs_beside(old[first:last], new[begin:end], anchors, tolerance):
            found[c], taken[partner] = partner, True
    return found


@compiled
def anchors_of(places: FloatArray, n: int) -> FloatArray:
    """(m + 1, 2) places of a contour of m segments, where each begins, and of one of n segments, where they go once
    round it in order; or (0, 2)."""
    m = len(places)
    anchors = np.empty((m + 1, 2))
    at = places[0] % n
    anchors[0, 0], anchors[0, 1], anchors[m, 0], anchors[m, 1] = 0.0, at, m, at + n
    for k in range(1, m):
        ahead = (places[k] - at) % n
        at += ahead - n if ahead > (1.0 - BACK) * n else ahead
        anchors[k, 0], anchors[k, 1] = k, max(anchors[k - 1, 1], at)
    return anchors if anchors[m - 1, 1] <= anchors[m, 1] else anchors[:0]


@compiled
def runs_beside(chain: FloatArray, other: FloatArray, anchors: FloatArray, tolerance: float) -> bool:
    """Whether two closed chains of cubics are certified to be within the tolerance of each other, in order."""
    m = len(chain)
    bounds, gaps, no_arcs = np.full(m, np.nan), np.empty(m), np.empty((0, 4))
    ends, its_ends, all_anchors = np.array([0, m]), np.array([0, len(other)]), np.array([0, m + 1])
    for sharpness in (0.5 * tolerance, SHARPNESS * tolerance):  # few need the second
        pair_instances(
            1, (chain, ends), (other, its_ends), (anchors, all_anchors), no_arcs, sharpness, tolerance, bounds, gaps
        )
        beyond = bounds > tolerance
        if not np.any(beyond):
            return True
        bounds[beyond] = np.nan
    return False
