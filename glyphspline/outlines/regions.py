"""What outlines fill: by how much the ink of two of them differs, and which islands and counters only one has.

Filled is what contours wind around, by the nonzero rule, overlaps and crossings included. Both outlines become
polygons. Horizontals through all corners and crossings cut the plane into *slabs*: in none of them sides cross, so
that their order there says between which two of them there is ink. Ink that hangs together is an *island*; white that
does, and not with the white around, is a *counter*.

Strands nearer to each other than ``APART`` times the flatness of the polygons are one: contours that abut make one
island, and a spur has no ink.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..types import BoolArray, FloatArray, IntArray
from .contour_arrays import ContourArrays, Polylines
from .polygons import box_pairs, flattened

APART = 2.0
"""Distance of strands that are told apart, in flatnesses: each may be off by one."""


class InkDifference(NamedTuple):
    """How the ink of two outlines differs.

    Attributes:
        area: of what only one of them fills, in square units. error: by which it may be more or less.
        lost: number of islands and counters of the first that the second has not; one of several that become one is
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
    (one, bound), (other, its_bound) = (flattened(each, flatness) for each in (before, after))
    length = float(np.hypot(*_sides(one)[:, 1].T - _sides(one)[:, 0].T).sum()) if len(one.points) else 0.0
    slabs = Slabs(one, other)
    if not slabs.differ:
        return InkDifference(0.0, 0.0, 0, 0, length)
    lost, gained = slabs.unmatched(APART * flatness)
    return InkDifference(slabs.area, max(bound, its_bound) * slabs.moved_length, lost, gained, length)


def _sides(lines: Polylines) -> FloatArray:
    """(n, 2, 2) the sides of closed polygons, from point to point."""
    follows = np.arange(1, len(lines.points) + 1)
    some = np.diff(lines.offsets) > 0
    follows[lines.offsets[1:][some] - 1] = lines.offsets[:-1][some]
    return np.stack([lines.points, lines.points[follows]], axis=1) + 0.0


class _Regions(NamedTuple):
    """The parts of the plane that an outline fills or leaves white, each hanging together.

    Attributes:
        of_rows: (R,) the region to the right of each row. inked: (P,) whether it is filled. counts: (P,) whether it is
            an island or a counter. around: the region around all.
    """

    of_rows: IntArray
    inked: BoolArray
    counts: BoolArray
    around: int


class Slabs:
    """The sides of two outlines, cut by the horizontals through all their corners and crossings.

    A *row* is a side in a slab. The rows go from slab to slab upwards, and from left to right in each, which begins
    with its *margin*, a row far to the left. There is a slab below all sides, and one above.

    Attributes:
        turns: (R, 2) by how much the winding numbers of both outlines grow to the right of each row. slab: (R,).
        places: (3, R) where the row is at the bottom, in the middle and at the top of its slab.
        heights: (R,) of its slab. is_margin: (R,). far: to the right of everything.
    """

    def __init__(self, one: Polylines, other: Polylines) -> None:
        sides = np.concatenate([_sides(one), _sides(other)])
        turns = np.zeros((len(sides), 2), dtype=np.int64)
        way = np.sign(sides[:, 0, 1] - sides[:, 1, 1]).astype(np.int64)
        turns[: len(one.points), 0], turns[len(one.points) :, 1] = way[: len(one.points)], way[len(one.points) :]
        sides = np.where((way > 0)[:, None, None], sides[:, ::-1], sides)  # upwards
        self.low, self.high, self._turns = _merged(sides[way != 0], turns[way != 0])
        self.levels = np.unique(np.concatenate([self.low[:, 1], self.high[:, 1], *self._crossings()]))
        first, last = (np.searchsorted(self.levels, ends[:, 1]) for ends in (self.low, self.high))
        side = np.repeat(np.arange(len(self.low)), last - first)
        slab = np.arange(len(side)) - np.repeat(np.cumsum(last - first) - last, last - first)
        bottom, top = self.levels[slab], self.levels[slab + 1]
        places = np.stack([self._at(side, y) for y in (bottom, (bottom + top) / 2, top)])
        left, self.far = float(places.min(initial=0.0)), float(places.max(initial=0.0))
        self.width = 4.0 * max(self.far - left, 1e-300)
        self.left, self.far = left - self.width / 4, self.far + self.width / 4
        margins = max(len(self.levels) + 1, 2)
        slab = np.concatenate([np.arange(margins), slab + 1])
        places = np.concatenate([np.full((3, margins), self.left), places], axis=1)
        order = np.lexsort((places[1], slab))
        self.slab, self.places, self.is_margin = slab[order], places[:, order], order < margins
        self.turns = np.concatenate([np.zeros((margins, 2), dtype=np.int64), self._turns[side]])[order]
        self.heights = np.concatenate([[0.0], np.diff(self.levels), [0.0, 0.0]])[self.slab]

    def _at(self, side: IntArray, y: FloatArray) -> FloatArray:
        """(n,) where sides are at heights that they reach."""
        (x, low), (to, high) = self.low[side].T, self.high[side].T
        share = (y - low) / (high - low)
        return np.where(share >= 1.0, to, x + share * (to - x))

    def _crossings(self) -> list[FloatArray]:
        """The heights at which sides cross."""
        found = []
        for i, j in box_pairs(np.minimum(self.low, self.high), np.maximum(self.low, self.high)):
            bottom, top = np.maximum(self.low[i, 1], self.low[j, 1]), np.minimum(self.high[i, 1], self.high[j, 1])
            below, above = (self._at(i, y) - self._at(j, y) for y in (bottom, top))
            cross = (below < 0) & (above > 0) | (below > 0) & (above < 0)
            share = below[cross] / (below[cross] - above[cross])
            found.append(bottom[cross] + share * (top - bottom)[cross])
        return found

    @property
    def differ(self) -> bool:
        """Whether there is a side that only one of the outlines has."""
        return bool((self._turns[:, 0] != self._turns[:, 1]).any())

    @property
    def moved_length(self) -> float:
        """Length of the sides that only one of the outlines has."""
        only = self._turns[:, 0] != self._turns[:, 1]
        return float(np.hypot(*(self.high - self.low)[only].T).sum())

    @cached_property
    def inked(self) -> BoolArray:
        """(R, 2) whether the outlines fill what is to the right of each row."""
        return np.cumsum(self.turns, axis=0) != 0

    @cached_property
    def areas(self) -> FloatArray:
        """(R,) of the part of its slab from each row to the next one, or to the end."""
        ends = np.append(np.where(self.is_margin[1:], self.far, self.places[1, 1:]), self.far)
        return (ends - self.places[1]) * self.heights

    @property
    def area(self) -> float:
        """Of what only one of the outlines fills."""
        return float(self.areas[self.inked[:, 0] != self.inked[:, 1]].sum())

    def unmatched(self, apart: float) -> tuple[int, int]:
        """How many islands and counters each of the two has that the other one has not.

        Two belong together if none shares more area with either.
        """
        one, other = (self._regions(which, apart) for which in range(2))
        size = len(one.inked), len(other.inked)
        shared = np.bincount(one.of_rows * size[1] + other.of_rows, self.areas, size[0] * size[1]).reshape(size)
        shared[one.inked[:, None] != other.inked] = 0.0
        shared[one.around, other.around] = np.inf
        its, own = shared.argmax(axis=1), shared.argmax(axis=0)
        has = (own[its] == np.arange(size[0])) & (shared.max(axis=1) > 0) & other.counts[its]
        its_has = (its[own] == np.arange(size[1])) & (shared.max(axis=0) > 0) & one.counts[own]
        return int((one.counts & ~has).sum()), int((other.counts & ~its_has).sum())

    def _regions(self, which: int, apart: float) -> _Regions:
        """The regions of an outline, of which strands nearer than ``apart`` are one."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        own = np.flatnonzero((self.turns[:, which] != 0) | self.is_margin)
        begins = self.is_margin[own] | (np.diff(self.places[1, own], prepend=-np.inf) > apart)
        starts = np.flatnonzero(begins)
        groups, slab = np.arange(len(starts)), self.slab[own[starts]]
        inked = np.add.reduceat(self.turns[own, which], starts).cumsum() != 0
        left = np.maximum.reduceat(self.places[:, own], starts, axis=1)
        right = np.minimum.reduceat(self.places[:, own], starts, axis=1)
        is_last = np.append(slab[1:] != slab[:-1], True)
        right = np.where(is_last, self.far, np.roll(right, -1, axis=1))
        margins = np.flatnonzero(self.is_margin[own[starts]])
        beside = np.flatnonzero(~is_last[:-1] & (inked[1:] == inked[:-1]))
        # Of neighbouring slabs those are linked that share a stretch of the horizontal between them.
        shift = self.width * slab
        first = np.searchsorted(shift + right[0], shift + self.width + left[2], side="right")
        counts = np.maximum(np.searchsorted(shift + left[0], shift + self.width + right[2]) - first, 0)
        below = np.repeat(groups, counts)
        above = np.arange(len(below)) + np.repeat(first - np.cumsum(counts) + counts, counts)
        shared = np.minimum(right[2, below], right[0, above]) - np.maximum(left[2, below], left[0, above])
        linked = (shared > apart) & (inked[below] == inked[above])
        white = np.concatenate([margins, groups[is_last]])
        ends = np.concatenate([
            [beside, beside + 1], [below[linked], above[linked]], [white, np.zeros_like(white)]
        ], axis=1)  # fmt: skip
        graph = coo_array((np.ones(ends.shape[1]), tuple(ends)), shape=(len(groups), len(groups)))
        count, labels = connected_components(graph, directed=False)
        of_rows = np.full(len(self.slab), -1)
        of_rows[own[starts]] = groups
        of_rows = labels[np.maximum.accumulate(of_rows)]
        region_inked = np.zeros(count, dtype=np.bool_)
        region_inked[labels] = inked
        areas = np.bincount(labels, (right[1] - left[1]) * self.heights[own[starts]], count)
        thick = areas > apart * self._extents(labels, count, left, right, slab)
        thick[labels[0]] = False
        return _Regions(of_rows, region_inked, thick, int(labels[0]))

    def _extents(self, labels: IntArray, count: int, left: FloatArray, right: FloatArray, slab: IntArray) -> FloatArray:
        """(count,) the larger of the width and the height of regions, from their stretches in slabs."""
        levels = np.concatenate([self.levels[:1], self.levels, self.levels[-1:]])
        low, high = np.full((2, count), np.inf), np.full((2, count), -np.inf)
        np.minimum.at(low[0], labels, left.min(axis=0))
        np.maximum.at(high[0], labels, right.max(axis=0))
        np.minimum.at(low[1], labels, levels[slab])
        np.maximum.at(high[1], labels, levels[slab + 1])
        return np.asarray((high - low).max(axis=0))


def _merged(sides: FloatArray, turns: IntArray) -> tuple[FloatArray, FloatArray, IntArray]:
    """Lower and upper ends of sides (n, 2, 2), those in one place as one, and their turns; none without turns."""
    order = np.lexsort(sides.reshape(-1, 4).T)
    sides, turns = sides[order], turns[order]
    starts = np.flatnonzero(np.append(True, (sides[1:] != sides[:-1]).any(axis=(1, 2)))[: len(sides)])
    summed = np.add.reduceat(turns, starts, axis=0) if len(starts) else turns
    kept = summed.any(axis=1)
    return sides[starts[kept], 0], sides[starts[kept], 1], summed[kept]
