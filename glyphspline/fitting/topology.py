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
    pairs, counted = _crossing_pairs(written, glyphs)
    new = np.where(np.repeat(counted, np.diff(glyphs)), 0, -1)
    crossing = np.unique(np.searchsorted(glyphs, [c for c, _ in pairs], side="right") - 1)
    for g in crossing[counted[crossing]].tolist():
        a, b = glyphs[g : g + 2].tolist()
        known, _ = _crossing_pairs(source.part(a, b), np.array([0, b - a]))
        for (c, d), number in pairs.items():
            if a <= c < b:
                new[list({c, d})] += max(number - known[c - a, d - a], 0)
    before, now = _areas(source), _areas(written)
    # A contour whose area is less than this share of its source's, or of the other sign, has collapsed.
    collapsed = now * np.sign(before) < 0.25 * np.abs(before)
    for c in np.flatnonzero(collapsed).tolist():
        collapsed[c] = not _crossing_pairs(source.part(c, c + 1), np.array([0, 1]))[0]
    return np.stack([new, collapsed])


def _areas(contours: ContourArrays) -> FloatArray:
    """(C,) signed areas, positive of contours that run counter-clockwise: all at once, as calls take longer."""
    cubics, first = all_cubics(contours), contours.offsets[:-1]
    x, y = np.moveaxis(cubics - np.repeat(cubics[first, :1], np.diff(contours.offsets), axis=0), 2, 0)
    total = np.zeros(len(cubics))
    for i, j, weight in ((0, 1, 6), (0, 2, 3), (0, 3, 1), (1, 2, 3), (1, 3, 3), (2, 3, 6)):
        total += weight * (x[:, i] * y[:, j] - y[:, i] * x[:, j])
    areas: FloatArray = np.add.reduceat(total, first) / 20
    return areas


def _crossing_pairs(contours: ContourArrays, glyphs: IntArray) -> tuple[Counter[tuple[int, int]], BoolArray]:
    """Number of crossings by the numbers of the two contours; and (G,) whether a glyph's were counted."""
    found, counted = crossings(all_cubics(contours), contours.offsets, glyphs)
    return Counter(map(tuple, found[:, :2].astype(np.int64).tolist())), counted
