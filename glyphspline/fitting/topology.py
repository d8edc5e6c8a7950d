"""What the contours of a glyph enclose: whether the written result crosses and turns as its source does.

A distance does not tell. Two strands that are nearer to each other than the tolerance may cross, and a hairline may
lose its area, while the result is within the tolerance. So the written curves of a glyph, all its contours together,
are compared with its source. A curve within the tolerance goes a little to both sides of its source, so that of two
strands that touch each other some crossing may be left however closely they are fitted.
"""

from __future__ import annotations

from collections import Counter
from typing import TypeAlias

import numpy as np

from ..curves.crossings import crossings
from ..curves.integrals import areas
from ..outlines.contour_arrays import ContourArrays
from ..outlines.segments import all_cubics
from ..types import BoolArray, FloatArray, IntArray

Changes: TypeAlias = IntArray
"""What changed in C contours, (2, C), or in V instances of them, (2, V, C): first the number of crossings that the
source does not have, with the contour itself and with others of the glyph, -1 where strands lie on each other in such
numbers that crossings are not counted; then 1 where the area of a contour that does not cross itself has gone, or
changed its sign."""


def changed(found: Changes) -> BoolArray:
    """(C,) whether a contour has a change, in any instance, that a closer fit may undo; of ``found[:1]``, crossings."""
    wrong: BoolArray = np.logical_or.reduce((found > 0).reshape(-1, found.shape[-1]))
    return wrong


def changes(source: ContourArrays, written: ContourArrays, glyphs: IntArray) -> Changes:
    """Compare contours with their sources.

    Args:
        source, written: C contours each. glyphs: (G + 1,) where the contours of each glyph begin.
    """
    cubics = all_cubics(written)
    pairs, counted = _crossing_pairs(cubics, written.offsets, glyphs)
    new = np.where(np.repeat(counted, np.diff(glyphs)), 0, -1)
    crossing = np.unique(np.searchsorted(glyphs, [c for c, _ in pairs], side="right") - 1)
    for g in crossing[counted[crossing]].tolist():
        a, b = glyphs[g : g + 2].tolist()
        known = _crossings_of(source.part(a, b))
        for (c, d), number in pairs.items():
            if a <= c < b:
                new[list({c, d})] += max(number - known[c - a, d - a], 0)
    before, now = areas(all_cubics(source), source.offsets), areas(cubics, written.offsets)
    # A contour whose area is less than this share of its source's, or of the other sign, has collapsed.
    collapsed = now * np.sign(before) < 0.25 * np.abs(before)
    for c in np.flatnonzero(collapsed).tolist():
        collapsed[c] = not _crossings_of(source.part(c, c + 1))
    return np.stack([new, collapsed])


def _crossings_of(glyph: ContourArrays) -> Counter[tuple[int, int]]:
    """Number of crossings in a glyph by the numbers of the two contours."""
    return _crossing_pairs(all_cubics(glyph), glyph.offsets, np.array([0, glyph.num_contours]))[0]


def _crossing_pairs(
    cubics: FloatArray, offsets: IntArray, glyphs: IntArray
) -> tuple[Counter[tuple[int, int]], BoolArray]:  # fmt: skip
    """Number of crossings by the numbers of the two contours; and (G,) whether a glyph's were counted."""
    found, counted = crossings(cubics, offsets, glyphs)
    return Counter(map(tuple, found[:, :2].astype(np.int64).tolist())), counted
