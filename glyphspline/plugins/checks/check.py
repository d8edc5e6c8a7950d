"""Outlines checked: all passes over all glyphs of a batch, and what they find as values."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...outlines.contour_arrays import joined, offsets_of
from ...outlines.flaws.kinds import JUMP, LUMP, REPEATED, THRESHOLDS, Thresholds
from ...outlines.outline import Outline
from .finding import Finding, Measured, findings


def check(outline: Outline, thresholds: Thresholds = THRESHOLDS, *, outer: int = 0) -> list[Finding]:
    """What may be wrong with an outline, the worst of each kind first, kinks before all. Nothing is fitted.

    Args:
        outline: as its font has it; see :meth:`glyphspline.Font.outline`. thresholds: from which values on it counts.
        outer: direction of outer contours, the font's ``outer``; 0 for that of most of the glyph's.

    Example:
        >>> import glyphspline as gs
        >>> font = gs.open_font("fonts_test/kouzan-gyosho.ttf")
        >>> found = gs.check(font.outline(font.select(text="龍")[0]))
    """
    return check_many([outline], thresholds, outer=outer)[0]


def check_many(
    outlines: Sequence[Outline], thresholds: Thresholds = THRESHOLDS, *, outer: int = 0
) -> list[list[Finding]]:
    """As :func:`check`, of many outlines of one font at once; the result of one does not depend on the others."""
    if not outlines:
        return []
    rows = measured([outline.contours for outline in outlines], thresholds, outlines[0].metrics.units_per_em, outer)
    return list(findings([(outline.name, outline.gid) for outline in outlines], rows))


def measured(glyphs: Sequence[Any], thresholds: Thresholds, units_per_em: float, outer: int = 0) -> Measured:
    """Measure :class:`.Contours` of glyphs of one em; ``outer`` as in :attr:`.Source.outer`."""
    from ...curves.bezier import evaluate
    from ...outlines.flaws.bends import bend_findings
    from ...outlines.flaws.joints import (
        CONTOUR,
        OTHER,
        PLACE,
        SEEN,
        VALUE,
        WHAT,
        Segments,
        joint_findings,
        rows,
        segment_findings,
    )
    from ...outlines.segments import all_cubics  # imports the compiler
    from .enclosed import enclosed_findings

    limits = thresholds.limits(units_per_em)
    contours = joined([glyph.arrays for glyph in glyphs])
    firsts = offsets_of([len(glyph) for glyph in glyphs])
    cubics = all_cubics(contours)
    segments = Segments.of(cubics, contours)
    repeats = np.concatenate([glyph.repeats for glyph in glyphs])  # of points, which readers leave out
    points = np.flatnonzero(repeats)
    again = np.searchsorted(contours.offsets, points, side="right") - 1
    table = np.concatenate([
        joint_findings(segments, limits),
        segment_findings(segments, limits),
        rows(LUMP, *bend_findings(cubics, contours, limits.lump, limits.lump_height, limits.corner_angle).T),
        enclosed_findings(cubics, segments, firsts, limits, units_per_em / 1000, outer),
        rows(REPEATED, again, points - contours.offsets[again], repeats[points]),
    ])  # fmt: skip
    jumps = table[:, WHAT] == JUMP
    table[jumps, VALUE] *= units_per_em
    table = table[np.lexsort((-table[:, VALUE], -np.where(jumps, table[:, SEEN], 0.0), table[:, WHAT]))]
    numbers = table[:, PLACE:].copy()
    contour = table[:, CONTOUR].astype(np.int64)
    places = np.floor(table[:, PLACE]).astype(np.int64)
    numbers[:, 0] -= places
    owners = np.searchsorted(firsts, contour, side="right") - 1
    numbers[:, OTHER - PLACE] = np.where(table[:, OTHER] < 0, -1, table[:, OTHER] - firsts[owners])
    return Measured(
        owners, contour - firsts[owners], places, table[:, WHAT].astype(np.int64), numbers,
        evaluate(cubics[contours.offsets[contour] + places], numbers[:, 0]),
        np.empty((len(table), 0)), np.full((len(table), 2), np.nan),
    )  # fmt: skip
