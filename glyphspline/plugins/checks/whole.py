"""What is seen of a glyph as a whole: open paths, quadratics beside cubics, points that miss a height others are at."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...outlines.contour_arrays import ContourArrays
from ...outlines.flaws.joints import rows
from ...outlines.flaws.kinds import MISS, MIXED, OPEN
from ...types import BoolArray, FloatArray, IntArray

MISSES = 2.0
"""Thousandths of an em up to which a point is off a height that it was to be at; overshoots are larger."""


def whole_findings(
    contours: ContourArrays, opened: BoolArray, glyphs: IntArray, heights: Sequence[float], unit: float
) -> FloatArray:
    """(n, 7) findings; see :mod:`...outlines.flaws.joints`.

    Args:
        opened: (C,) which contours are open paths. glyphs: (G + 1,) where the contours of each glyph begin.
        heights: of baseline, x-height and cap height, in font units. unit: a thousandth of an em.
    """
    which = np.flatnonzero(opened)
    owners = np.repeat(np.arange(len(glyphs) - 1), np.diff(glyphs))
    found = [rows(OPEN, which, 0.0, np.diff(contours.offsets)[which] // 2)]
    found += [_mixed(contours, owners), *(_misses(contours, owners, height, unit) for height in heights)]
    return np.concatenate(found)


def _mixed(contours: ContourArrays, owners: IntArray) -> FloatArray:
    """The first segment of a glyph that is a quadratic where another one is a cubic, or the reverse."""
    own = np.repeat(np.arange(contours.num_contours), np.diff(contours.offsets))
    curved = np.flatnonzero(contours.degrees > 1)
    _, first, which = np.unique(owners[own[curved]], return_index=True, return_inverse=True)
    unlike = np.flatnonzero(contours.degrees[curved] != contours.degrees[curved[first]][which])
    _, at = np.unique(which[unlike], return_index=True)
    counts, found = np.bincount(which[unlike])[np.unique(which[unlike])], curved[unlike[at]]
    return rows(MIXED, own[found], found - contours.offsets[own[found]], counts)


def _misses(contours: ContourArrays, owners: IntArray, height: float, unit: float) -> FloatArray:
    """Points of a glyph beside a height that others of it are at; or beside it at its top or bottom, on a flat line."""
    own = np.repeat(np.arange(contours.num_contours), np.diff(contours.offsets))
    y, glyph = contours.points[np.cumsum(contours.degrees) - contours.degrees, 1], owners[own]
    off, count = np.abs(y - height), len(owners) and int(owners[-1]) + 1
    others = np.bincount(glyph, off < 1e-9, count) > 0
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, glyph, y)
    np.maximum.at(high, glyph, y)
    before, after = np.arange(len(y)) - 1, np.arange(len(y)) + 1
    before[contours.offsets[:-1]], after[contours.offsets[1:] - 1] = contours.offsets[1:] - 1, contours.offsets[:-1]
    flat = ((contours.degrees == 1) & (y[after] == y)) | ((contours.degrees[before] == 1) & (y[before] == y))
    ends = flat & ((y == low[glyph]) | (y == high[glyph]))
    found = np.flatnonzero((off > 1e-9) & (off <= MISSES * unit) & (others[glyph] | ends))
    return rows(MISS, own[found], found - contours.offsets[own[found]], off[found], height)
