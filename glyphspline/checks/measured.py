"""Everything that is looked for, measured in contours end to end: one table from all compiled passes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..curves.bezier import evaluate
from ..outlines.contour_arrays import ContourArrays, joined, offsets_of
from ..outlines.segments import all_cubics
from ..types import FloatArray, IntArray
from .enclosed import enclosed_findings
from .joints import joint_findings
from .kinds import KINDS, Thresholds
from .table import CONTOUR, OTHER, PLACE, VALUE, WHAT

PER_EM = [number for number, kind in enumerate(KINDS) if kind.unit == "/em"]
"""Kinds whose values compiled code has in 1/unit."""


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


def measured(outlines: Sequence[ContourArrays], thresholds: Thresholds, units_per_em: float) -> Measured:
    """Measure the contours of glyphs of one em, all passes over all glyphs."""
    limits = thresholds.limits(units_per_em)
    contours = joined(outlines)
    glyphs = offsets_of([outline.num_contours for outline in outlines])
    cubics = all_cubics(contours)
    table = np.concatenate(
        [joint_findings(cubics, contours, limits), enclosed_findings(cubics, contours, glyphs, limits)]
    )
    table[np.isin(table[:, WHAT], PER_EM), VALUE] *= units_per_em
    table = table[np.lexsort((-table[:, VALUE], table[:, WHAT]))]
    numbers = table[:, PLACE:].copy()
    contour = table[:, CONTOUR].astype(np.int64)
    segments = np.floor(table[:, PLACE]).astype(np.int64)
    numbers[:, 0] -= segments
    owners = np.searchsorted(glyphs, contour, side="right") - 1
    numbers[:, OTHER - PLACE] = np.where(table[:, OTHER] < 0, -1, table[:, OTHER] - glyphs[owners])
    return Measured(
        owners, contour - glyphs[owners], segments, table[:, WHAT].astype(np.int64), numbers,
        evaluate(cubics[contours.offsets[contour] + segments], numbers[:, 0]),
        np.empty((len(table), 0)), np.full((len(table), 2), np.nan),
    )  # fmt: skip


def nothing() -> Measured:
    """No findings."""
    none = np.zeros(0, dtype=np.int64)
    return Measured(none, none, none, none, np.zeros((0, 4)), np.zeros((0, 2)), np.zeros((0, 0)), np.zeros((0, 2)))
