"""Findings of many glyphs in columns: the form in which processes exchange them, which needs no compiled code."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..types import FloatArray, IntArray


class Measured(NamedTuple):
    """Findings in columns, those of a kind together, the largest value first.

    Attributes:
        glyphs: (n,) which of the glyphs. contours: (n,) number of the contour in it. segments: (n,) of the contour.
        kinds: (n,) number of the kind.
        numbers: (n, 4) local parameter, value, second number or NaN, another contour of the glyph or -1.
        points: (n, 2) where it is.
        locations: (n, A) user-space values of the axes where it is worst; A is 0 if the font is looked at as it is.
        between: (n, 2) user-space values of the masters on both sides, or NaN.
    """

    glyphs: IntArray
    contours: IntArray
    segments: IntArray
    kinds: IntArray
    numbers: FloatArray
    points: FloatArray
    locations: FloatArray
    between: FloatArray

    def chosen(self, rows: IntArray) -> Measured:
        """Some of the rows."""
        return Measured._make([column[rows] for column in self])


def nothing() -> Measured:
    """No findings."""
    none = np.zeros(0, dtype=np.int64)
    return Measured(none, none, none, none, np.zeros((0, 4)), np.zeros((0, 2)), np.zeros((0, 0)), np.zeros((0, 2)))
