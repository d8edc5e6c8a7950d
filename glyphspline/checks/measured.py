"""Everything that is looked for, measured in contours end to end: one table from all compiled passes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..curves.bezier import evaluate
from ..outlines.contour_arrays import ContourArrays, joined, offsets_of
from ..outlines.segments import all_cubics
from .bends import bend_findings
from .enclosed import enclosed_findings
from .finding import Measured
from .joints import CONTOUR, OTHER, PLACE, VALUE, WHAT, joint_findings
from .kinds import KINDS, Thresholds
from .single_segments import segment_findings

PER_EM = [number for number, kind in enumerate(KINDS) if kind.unit == "/em"]
"""Kinds whose values compiled code has in 1/unit."""


def measured(
    outlines: Sequence[ContourArrays], thresholds: Thresholds, units_per_em: float, outer: int = 0
) -> Measured:
    """Measure the contours of glyphs of one em, all passes over all glyphs; ``outer`` as in :attr:`.Source.outer`."""
    limits = thresholds.limits(units_per_em, outer)
    contours = joined(outlines)
    glyphs = offsets_of([outline.num_contours for outline in outlines])
    cubics = all_cubics(contours)
    passes = (joint_findings, segment_findings, bend_findings)
    tables = [each(cubics, contours, limits) for each in passes]
    table = np.concatenate([*tables, enclosed_findings(cubics, contours, glyphs, limits)])
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
