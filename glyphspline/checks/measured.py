"""Everything that is looked for, measured in contours end to end: one table from all compiled passes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..curves.bezier import evaluate
from ..outlines.contour_arrays import ContourArrays, joined, offsets_of
from ..outlines.segments import all_cubics
from ..types import FloatArray, IntArray
from .bends import bend_findings
from .joints import joint_findings
from .kinds import Limits
from .single_segments import segment_findings
from .table import CONTOUR, OTHER, PLACE, VALUE, WHAT


class Measured(NamedTuple):
    """Findings in columns, those of a kind together, the largest value first.

    Attributes:
        glyphs: (n,) which of the glyphs. contours: (n,) number of the contour in it. segments: (n,) of the contour.
        kinds: (n,) number of the kind.
        numbers: (n, 4) local parameter, value, second number or NaN, another contour of the glyph or -1.
        points: (n, 2) where it is.
    """

    glyphs: IntArray
    contours: IntArray
    segments: IntArray
    kinds: IntArray
    numbers: FloatArray
    points: FloatArray


def measured(outlines: Sequence[ContourArrays], limits: Limits) -> Measured:
    """Measure the contours of glyphs, all passes over all glyphs."""
    contours = joined(outlines)
    glyphs = offsets_of([outline.num_contours for outline in outlines])
    cubics = all_cubics(contours)
    passes = (joint_findings, segment_findings, bend_findings)
    table = np.concatenate([each(cubics, contours, limits) for each in passes])
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
    )  # fmt: skip
