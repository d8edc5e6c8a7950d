"""What outlines fill: by how much the ink of two of them differs, and which islands and counters only one has.

Filled is what contours wind around, by the nonzero rule, overlaps and crossings included; it is computed from polygons
(:mod:`.slabs`). Ink that hangs together is an *island*; white that does, and not with the white around, is a *counter*.
Ink that touches itself in a point hangs together there, or white does: what is lost or gained either way counts.

Strands nearer to each other than ``APART`` times the flatness of the polygons are one: contours that abut make one
island, and a spur has no ink.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..types import FloatArray
from .contour_arrays import ContourArrays
from .polygons import flattened
from .slabs import Regions, Slabs

APART = 2.0
"""Distance of strands that are told apart, in flatnesses: each may be off by one."""


class InkDifference(NamedTuple):
    """How the ink of two outlines differs.

    Attributes:
        area: of what only one of them fills, in square units. error: by which it may be more or less.
        lost: number of islands and counters of the first that the second has not; of several that become one, one is
            left. gained: the other way round. length: of the first outline, in font units.
    """

    area: float
    error: float
    lost: int
    gained: int
    length: float


def ink_difference(before: ContourArrays, after: ContourArrays, flatness: float) -> InkDifference:
    """Compare what two outlines fill.

    Args:
        before, after: contours of lines, quadratics and cubics. flatness: largest distance of the polygons that are
            compared from the curves, in font units; narrower islands and counters do not count.

    Raises:
        OptionError: the flatness is not positive, or too small; see :func:`.polygons.flattened`.
    """
    (lines, bound), (its_lines, its_bound) = (flattened(each, flatness) for each in (before, after))
    slabs = Slabs(lines, its_lines)
    if not slabs.differ:
        return InkDifference(0.0, 0.0, 0, 0, slabs.length)
    both = [slabs.stretches(which, APART * flatness) for which in range(2)]
    regions = [[each.regions(touching) for each in both] for touching in (True, False)]
    lost, gained = np.max([_unmatched(one, other, slabs.areas) for one, other in regions], axis=0).tolist()
    return InkDifference(slabs.area, max(bound, its_bound) * slabs.moved_length, lost, gained, slabs.length)


def _unmatched(one: Regions, other: Regions, areas: FloatArray) -> tuple[int, int]:
    """How many islands and counters of each have no partner, each sharing most with the other; ``areas``: (R,) rows."""
    size = len(one.inked), len(other.inked)
    pairs = one.of_rows * size[1] + other.of_rows
    shared = np.bincount(pairs, areas, size[0] * size[1]).astype(np.float64).reshape(size)
    shared[one.inked[:, None] != other.inked] = 0.0
    shared[one.around, other.around] = np.inf
    partner, its_partner = shared.argmax(axis=1), shared.argmax(axis=0)
    has = (its_partner[partner] == np.arange(size[0])) & (shared.max(axis=1) > 0) & other.counts[partner]
    its_has = (partner[its_partner] == np.arange(size[1])) & (shared.max(axis=0) > 0) & one.counts[its_partner]
    return int((one.counts & ~has).sum()), int((other.counts & ~its_has).sum())
