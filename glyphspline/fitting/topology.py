"""What the contours of a glyph enclose: whether the written result crosses and turns as its source does.

A distance does not tell. Two strands that are nearer to each other than the tolerance may cross, and a hairline may
lose its area, while the result is within the tolerance. So the written curves of a glyph, all its contours together,
are compared with its source.
"""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import numpy as np

from ..compiled import compiled
from ..curves.crossings import crossings
from ..curves.integrals import area
from ..outlines.contour_arrays import ContourArrays
from ..outlines.segments import all_cubics, contour_cubics
from ..types import BoolArray, FloatArray, IntArray

COLLAPSED = 0.25
"""A contour whose area is less than this share of its source's, or of the other sign, has collapsed."""

UNCOUNTED = 1_000
"""For how many crossings those count that are not counted."""


class Changes(NamedTuple):
    """What changed in C contours, or in V instances of them: then all arrays are (V, C).

    Attributes:
        new_crossings: (C,) crossings of the contour that its source does not have, with itself and with others of the
            glyph; -1 where strands lie on each other in such numbers that crossings are not counted.
        collapsed: (C,) whether the area of a contour that does not cross itself has gone, or changed its sign.
    """

    new_crossings: IntArray
    collapsed: BoolArray

    @property
    def number(self) -> int:
        """Number of changes: a crossing of two contours counts twice, and crossings that are not counted as many."""
        return int(np.where(self.new_crossings < 0, UNCOUNTED, self.new_crossings).sum() + self.collapsed.sum())

    @property
    def crosses(self) -> BoolArray:
        """(C,) whether there are crossings that the source does not have."""
        return self._of_contours(self.new_crossings > 0)

    @property
    def any(self) -> BoolArray:
        """(C,) whether there is a change that a closer fit may undo."""
        return self._of_contours((self.new_crossings > 0) | self.collapsed)

    @staticmethod
    def _of_contours(changed: BoolArray) -> BoolArray:
        """(C,) whether a contour changed in any instance."""
        found: BoolArray = np.logical_or.reduce(changed.reshape(-1, changed.shape[-1]))
        return found

    def copy(self) -> Changes:
        """The same in arrays of their own."""
        return Changes(self.new_crossings.copy(), self.collapsed.copy())

    def part(self, first: int, last: int) -> Changes:
        """Those of the contours from ``first`` up to ``last``, as views."""
        return Changes(self.new_crossings[..., first:last], self.collapsed[..., first:last])

    def put(self, first: int, last: int, found: Changes) -> None:
        """Replace those of the contours from ``first`` up to ``last``."""
        for values, new in zip(self, found, strict=True):
            values[..., first:last] = new


def changes(source: ContourArrays, written: ContourArrays, glyphs: IntArray) -> Changes:
    """Compare contours with their sources.

    Args:
        source, written: C contours each. glyphs: (G + 1,) where the contours of each glyph begin.
    """
    pairs, counted = _crossing_pairs(written, glyphs)
    new = np.where(np.repeat(counted, np.diff(glyphs)), 0, -1)
    crossing = np.unique(np.searchsorted(glyphs, [c for c, _ in pairs], side="right") - 1)
    for g in crossing[counted[crossing]].tolist():
        a, b = glyphs[g : g + 2].tolist()
        known, _ = _crossing_pairs(source.part(a, b), np.array([0, b - a]))
        for (c, d), number in pairs.items():
            if a <= c < b:
                new[list({c, d})] += max(number - known[c - a, d - a], 0)
    before, now = areas(source), areas(written)
    collapsed = now * np.sign(before) < COLLAPSED * np.abs(before)
    for c in np.flatnonzero(collapsed).tolist():
        collapsed[c] = not _crossing_pairs(source.part(c, c + 1), np.array([0, 1]))[0]
    return Changes(new, collapsed)


def _crossing_pairs(contours: ContourArrays, glyphs: IntArray) -> tuple[Counter[tuple[int, int]], BoolArray]:
    """Number of crossings by the numbers of the two contours; and (G,) whether a glyph's were counted."""
    found, counted = crossings(all_cubics(contours), contours.offsets, glyphs)
    return Counter(map(tuple, found[:, :2].astype(np.int64).tolist())), counted


@compiled
def areas(contours: ContourArrays) -> FloatArray:
    """(C,) signed area of each contour."""
    found = np.empty(len(contours.offsets) - 1)
    for c in range(len(found)):
        found[c] = area(contour_cubics(contours, c))
    return found
