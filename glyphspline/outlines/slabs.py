"""The plane cut into slabs by the horizontals through all corners and crossings of two outlines' polygons.

In no slab sides cross, so that their order there says between which of them each outline fills what, by the nonzero
rule. Areas are sums over slabs. *Stretches* are what is filled, or white, between two sides of a slab; those of
neighbouring slabs that share a part of the horizontal between them hang together, and make regions.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..types import BoolArray, FloatArray, IntArray
from .contour_arrays import Polylines, offsets_of


class Regions(NamedTuple):
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
        heights: (R,) of its slab. is_margin: (R,). levels: the heights between slabs. width: more than that of all
        rows. far: to the right of everything. length: of the first outline.
    """

    def __init__(self, one: Polylines, other: Polylines) -> None:
        sides = np.concatenate([_sides(one), _sides(other)])
        self.length = float(np.hypot(*(sides[: len(one.points), 1] - sides[: len(one.points), 0]).T).sum())
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

    def stretches(self, which: int, apart: float) -> Stretches:
        """Those of an outline, of which sides nearer than ``apart`` are one."""
        own = np.flatnonzero((self.turns[:, which] != 0) | self.is_margin)
        begins = self.is_margin[own] | (np.diff(self.places[1, own], prepend=-np.inf) > apart)
        starts = np.flatnonzero(begins)
        rows = own[starts]
        inked = np.add.reduceat(self.turns[own, which], starts).cumsum() != 0
        left = np.maximum.reduceat(self.places[:, own], starts, axis=1)
        right = np.minimum.reduceat(self.places[:, own], starts, axis=1)
        is_last = np.append(self.is_margin[rows[1:]], True)
        return Stretches(self, rows, inked, left, np.where(is_last, self.far, np.roll(right, -1, axis=1)), apart)


class Stretches:
    """What an outline fills, and what it leaves white, in each slab: parts in the order of rows.

    Attributes:
        rows: (S,) the row to whose right each begins. inked: (S,) whether it is filled. left, right: (3, S) its ends at
            the bottom, in the middle and at the top of the slab. apart: distance of sides that are told apart.
    """

    def __init__(
        self, slabs: Slabs, rows: IntArray, inked: BoolArray, left: FloatArray, right: FloatArray, apart: float
    ) -> None:
        self.slabs, self.rows, self.inked, self.left, self.right, self.apart = slabs, rows, inked, left, right, apart

    @cached_property
    def _pairs(self) -> tuple[IntArray, IntArray, FloatArray]:
        """Stretches and those above them, and how much of the horizontal between them they share.

        If it is negative they are so far apart, and nearer than sides that are told apart.
        """
        left, right, apart = self.left, self.right, self.apart
        shift = self.slabs.width * self.slabs.slab[self.rows]
        above_it = shift + self.slabs.width
        first = np.searchsorted(shift + right[0], above_it + left[2] - apart, side="right")
        counts = np.maximum(np.searchsorted(shift + left[0], above_it + right[2] + apart) - first, 0)
        below = np.repeat(np.arange(len(counts)), counts)
        above = np.arange(len(below)) + np.repeat(first - np.cumsum(counts) + counts, counts)
        alike = self.inked[below] == self.inked[above]
        below, above = below[alike], above[alike]
        return below, above, np.minimum(right[2, below], right[0, above]) - np.maximum(left[2, below], left[0, above])

    def regions(self, touching: bool) -> Regions:
        """The regions; ``touching``: islands that touch each other in a point are one, else white that does."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        below, above, shared = self._pairs
        linked = shared > np.where(self.inked[below] == touching, -self.apart, self.apart)
        is_margin = self.slabs.is_margin[self.rows]
        is_last = np.append(is_margin[1:], True)
        beside = np.flatnonzero(~is_last[:-1] & (self.inked[1:] == self.inked[:-1]))
        around = np.flatnonzero(is_margin | is_last)
        one = np.concatenate([beside, below[linked], around])
        other = np.concatenate([beside + 1, above[linked], np.zeros_like(around)])
        size = len(self.rows)
        graph = coo_array((np.ones(len(one)), (one, other)), shape=(size, size))
        count, labels = connected_components(graph, directed=False)
        of_rows = np.zeros(len(self.slabs.slab), dtype=np.int64)
        of_rows[self.rows[1:]] = 1
        inked = np.zeros(count, dtype=np.bool_)
        inked[labels] = self.inked
        return Regions(labels[of_rows.cumsum()], inked, self._thick(labels, count), int(labels[0]))

    def _thick(self, labels: IntArray, count: int) -> BoolArray:
        """(count,) which regions, other than the one around all, are wider than sides that are told apart."""
        slab = self.slabs.slab[self.rows]
        levels = np.concatenate([self.slabs.levels[:1], self.slabs.levels, self.slabs.levels[-1:]])
        low, high = np.full((2, count), np.inf), np.full((2, count), -np.inf)
        for axis, ends in enumerate(
            ((self.left.min(axis=0), self.right.max(axis=0)), (levels[slab], levels[slab + 1]))
        ):
            np.minimum.at(low[axis], labels, ends[0])
            np.maximum.at(high[axis], labels, ends[1])
        areas = np.bincount(labels, (self.right[1] - self.left[1]) * self.slabs.heights[self.rows], count)
        thick: BoolArray = areas > self.apart * (high - low).max(axis=0)
        thick[labels[0]] = False
        return thick


def box_pairs(low: FloatArray, high: FloatArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Pairs of boxes that overlap or touch, each once, a million candidates at a time; of their corners (n, 2)."""
    order = np.argsort(low[:, 0], kind="stable")
    counts = np.searchsorted(low[order, 0], high[order, 0], side="right") - np.arange(len(order)) - 1
    for part in np.array_split(np.arange(len(order)), 1 + int(counts.sum()) // 1_000_000):
        first = np.repeat(part, counts[part])
        behind = np.arange(len(first)) - np.repeat(offsets_of(counts[part])[:-1], counts[part])
        i, j = order[first], order[first + 1 + behind]
        near = (low[i, 1] <= high[j, 1]) & (low[j, 1] <= high[i, 1])
        yield i[near], j[near]


def _sides(lines: Polylines) -> FloatArray:
    """(n, 2, 2) the sides of closed polygons, from point to point."""
    follows = np.arange(1, len(lines.points) + 1)
    some = np.diff(lines.offsets) > 0
    follows[lines.offsets[1:][some] - 1] = lines.offsets[:-1][some]
    return np.stack([lines.points, lines.points[follows]], axis=1) + 0.0


def _merged(sides: FloatArray, turns: IntArray) -> tuple[FloatArray, FloatArray, IntArray]:
    """Lower and upper ends of sides (n, 2, 2), those in one place as one, and their turns; none without turns."""
    order = np.lexsort(sides.reshape(-1, 4).T)
    sides, turns = sides[order], turns[order]
    starts = np.flatnonzero(np.append(True, (sides[1:] != sides[:-1]).any(axis=(1, 2)))[: len(sides)])
    summed = np.add.reduceat(turns, starts, axis=0) if len(starts) else turns
    kept = summed.any(axis=1)
    return sides[starts[kept], 0], sides[starts[kept], 1], summed[kept]
