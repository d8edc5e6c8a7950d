"""Outlines checked: all passes over all glyphs of a batch, and what they find as values."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...outlines.contour_arrays import joined, members_of, offsets_of
from ...outlines.flaws.kinds import JUMP, LUMP, REPEATED, THRESHOLDS, Thresholds
from ...outlines.open_paths import are_open
from ...outlines.outline import Outline
from .finding import Finding, Measured, findings


def check(
    outline: Outline, thresholds: Thresholds = THRESHOLDS, *, outer: int = 0, heights: Sequence[float] = ()
) -> list[Finding]:
    """What may be wrong with an outline, the worst of each kind first, kinks before all. Nothing is fitted.

    Args:
        outline: as its font has it; see :meth:`glyphspline.Font.outline`. thresholds: from which values on it counts.
        outer: direction of outer contours, the font's ``outer``; 0 for that of most of the glyph's.
        heights: at which points are aligned, as 0, the font's ``x_height`` and ``cap_height``.

    Example:
        >>> import glyphspline as gs
        >>> font = gs.open_font("fonts_test/kouzan-gyosho.ttf")
        >>> found = gs.check(font.outline(font.select(text="龍")[0]))
    """
    return check_many([outline], thresholds, outer=outer, heights=heights)[0]


def check_many(
    outlines: Sequence[Outline], thresholds: Thresholds = THRESHOLDS, *, outer: int = 0,
    heights: Sequence[float] = (),
) -> list[list[Finding]]:  # fmt: skip
    """As :func:`check`, of many outlines of one font at once; the result of one does not depend on the others."""
    if not outlines:
        return []
    em = outlines[0].metrics.units_per_em
    rows = measured([outline.contours for outline in outlines], thresholds, em, outer, heights)
    return list(findings([(outline.name, outline.gid) for outline in outlines], rows))


def measured(
    glyphs: Sequence[Any], thresholds: Thresholds, units_per_em: float, outer: int = 0,
    heights: Sequence[float] = (),
) -> Measured:  # fmt: skip
    """Measure :class:`.Contours` of glyphs of one em; ``outer`` as in :attr:`.Source.outer`, ``heights`` as above.

    Open paths are named, and nothing else is looked for in them.
    """
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
    from .whole import whole_findings

    limits = thresholds.limits(units_per_em)
    every = joined([glyph.arrays for glyph in glyphs])
    firsts, opened = offsets_of([len(glyph) for glyph in glyphs]), are_open(every)
    closed = np.flatnonzero(~opened)
    contours, ends = every.chosen(closed), np.searchsorted(closed, firsts)
    cubics = all_cubics(contours)
    segments = Segments.of(cubics, contours)
    repeats = np.concatenate([glyph.repeats for glyph in glyphs])  # of points, which readers leave out
    repeats = repeats[members_of(every.offsets, closed)[0]]
    points = np.flatnonzero(repeats)
    again = np.searchsorted(contours.offsets, points, side="right") - 1
    table = np.concatenate([
        joint_findings(segments, limits),
        segment_findings(segments, limits),
        rows(LUMP, *bend_findings(cubics, contours, limits.lump, limits.lump_height, limits.corner_angle).T),
        enclosed_findings(cubics, segments, ends, limits, units_per_em / 1000, outer),
        rows(REPEATED, again, points - contours.offsets[again], repeats[points]),
    ])  # fmt: skip
    table[:, CONTOUR] = closed[table[:, CONTOUR].astype(np.int64)]
    others = np.flatnonzero(table[:, OTHER] >= 0)
    table[others, OTHER] = closed[table[others, OTHER].astype(np.int64)]
    table = np.concatenate([table, whole_findings(every, opened, firsts, heights, units_per_em / 1000)])
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
        evaluate((all_cubics(every) if opened.any() else cubics)[every.offsets[contour] + places], numbers[:, 0]),
        np.empty((len(table), 0)), np.full((len(table), 2), np.nan),
    )  # fmt: skip
