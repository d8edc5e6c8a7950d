"""Whether two outlines run beside each other in order: then the ink is the same but for what lies between them.

Contours that follow each other are paired from the nearest place of one segment's beginning to that of the next, and
each stretch is bounded as for the certificate of a fit (:mod:`..curves.pairing`). While one contour is moved to the
other along the pairs, straight and all at once, no point farther from them than the bound is swept, so none of these
changes its winding number. The swept area is at most the bound times the mean of both lengths.
"""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..curves.integrals import area
from ..curves.pairing import SHARPNESS, pair_instances
from ..types import FloatArray, IntArray
from .outline_distance import Chains

BACK = 0.1
"""Share of a contour by which the next place may lie back: a rounded corner has the same nearest place for both its
ends, or one that is a little off."""


def follow(old: Chains, new: Chains, nearest: FloatArray, tolerance: float) -> bool:
    """Whether contours follow each other within the tolerance, one by one, all in their direction or all against it.

    Args:
        nearest: (m, 2) segments of the new outline, and parameters on them, nearest to where the m old ones begin.
    """
    if len(old.offsets) != len(new.offsets):
        return False
    segments = nearest[:, 0].astype(np.int64)
    partners, places, offsets, cubics = new.owners[segments], segments + nearest[:, 1], new.offsets, new.cubics
    if areas(old) * areas(new) < 0:
        cubics, last = np.ascontiguousarray(cubics[::-1, ::-1]), len(offsets) - 2
        partners, places, offsets = last - partners, len(cubics) - places, len(cubics) - offsets[::-1]
    return in_order(old.cubics, old.offsets, cubics, offsets, partners, places - offsets[partners], tolerance)


@compiled
def areas(chains: Chains) -> float:
    """The sum of the contours' signed areas."""
    total = 0.0
    for c in range(len(chains.offsets) - 1):
        total += area(chains.cubics[chains.offsets[c] : chains.offsets[c + 1]])
    return total


@compiled
def in_order(
    old: FloatArray, old_offsets: IntArray, new: FloatArray, new_offsets: IntArray, partners: IntArray,
    places: FloatArray, tolerance: float,
) -> bool:  # fmt: skip
    """Whether each old contour and its partner run beside each other in order, and each new one is a partner once.

    Args:
        old: (m, 4, 2) and new: (n, 4, 2), with offsets of contours.
        partners: (m,) the new contour nearest to each old segment's beginning, and places: (m,) where on it.
    """
    taken = np.zeros(len(new_offsets) - 1, dtype=np.bool_)
    for c in range(len(old_offsets) - 1):
        first, last = old_offsets[c], old_offsets[c + 1]
        partner, m = partners[first], last - first
        begin, n = new_offsets[partner], new_offsets[partner + 1] - new_offsets[partner]
        if taken[partner]:
            return False
        taken[partner] = True
        anchors = np.empty((m + 1, 2))
        at = places[first] % n
        anchors[0, 0], anchors[0, 1], anchors[m, 0], anchors[m, 1] = 0.0, at, m, at + n
        for k in range(1, m):
            if partners[first + k] != partner:
                return False
            ahead = (places[first + k] - at) % n
            at += ahead - n if ahead > (1.0 - BACK) * n else ahead
            anchors[k, 0], anchors[k, 1] = k, max(anchors[k - 1, 1], at)
        if at > anchors[m, 1] or anchors[m - 1, 1] > anchors[m, 1]:
            return False
        bounds, gaps = np.full(m, np.nan), np.empty(m)
        ends, its_ends, no_arcs = np.array([0, m]), np.array([0, n]), np.empty((0, 4))
        chain, other = old[first:last], new[begin : begin + n]
        for sharpness in (0.5 * tolerance, SHARPNESS * tolerance):  # few need the second
            pair_instances(
                1, chain, ends, other, its_ends, anchors, np.array([0, m + 1]), no_arcs, sharpness, tolerance, bounds,
                gaps,
            )  # fmt: skip
            beyond = bounds > tolerance
            if not np.any(beyond):
                break
            bounds[beyond] = np.nan
        if np.any(np.isnan(bounds)):
            return False
    return True
