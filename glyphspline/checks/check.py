"""Outlines checked: all passes over all glyphs of a batch, and what they find as values."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..outlines.contour_arrays import ContourArrays, joined, offsets_of
from ..outlines.outline import Outline
from ..types import FloatArray, IntArray
from .finding import Finding, Measured, findings
from .kinds import JUMP, REPEATED, THRESHOLDS, Thresholds


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
    arrays, repeats = [outline.arrays for outline in outlines], [outline.repeats for outline in outlines]
    rows = measured(arrays, thresholds, outlines[0].metrics.units_per_em, outer, repeats)
    return findings([(outline.name, outline.gid) for outline in outlines], rows)


def measured(
    outlines: Sequence[ContourArrays], thresholds: Thresholds, units_per_em: float, outer: int = 0,
    repeats: Sequence[IntArray | None] = (),
) -> Measured:  # fmt: skip
    """Measure the contours of glyphs of one em; ``outer`` as in :attr:`.Source.outer`, ``repeats`` as in Contours."""
    from ..curves.bezier import evaluate
    from ..outlines.segments import all_cubics  # imports the compiler
    from .bends import bend_findings
    from .enclosed import enclosed_findings
    from .segments import CONTOUR, OTHER, PLACE, SEEN, VALUE, WHAT, Segments, joint_findings, segment_findings

    limits = thresholds.limits(units_per_em)
    contours = joined(outlines)
    glyphs = offsets_of([outline.num_contours for outline in outlines])
    cubics = all_cubics(contours)
    segments = Segments.of(cubics, contours)
    table = np.concatenate([
        joint_findings(segments, limits),
        segment_findings(segments, limits),
        bend_findings(cubics, contours, limits.lump, limits.lump_height, limits.corner_angle),
        enclosed_findings(cubics, segments, glyphs, limits, units_per_em / 1000, outer),
        _repeated(outlines, contours.offsets, repeats),
    ])  # fmt: skip
    jumps = table[:, WHAT] == JUMP
    table[jumps, VALUE] *= units_per_em
    table = table[np.lexsort((-table[:, VALUE], -np.where(jumps, table[:, SEEN], 0.0), table[:, WHAT]))]
    numbers = table[:, PLACE:].copy()
    contour = table[:, CONTOUR].astype(np.int64)
    places = np.floor(table[:, PLACE]).astype(np.int64)
    numbers[:, 0] -= places
    owners = np.searchsorted(glyphs, contour, side="right") - 1
    numbers[:, OTHER - PLACE] = np.where(table[:, OTHER] < 0, -1, table[:, OTHER] - glyphs[owners])
    return Measured(
        owners, contour - glyphs[owners], places, table[:, WHAT].astype(np.int64), numbers,
        evaluate(cubics[contours.offsets[contour] + places], numbers[:, 0]),
        np.empty((len(table), 0)), np.full((len(table), 2), np.nan),
    )  # fmt: skip


def _repeated(outlines: Sequence[ContourArrays], offsets: IntArray, repeats: Sequence[IntArray | None]) -> FloatArray:
    """(n, 7) points that the font has more than once, which readers leave out; see :mod:`.segments`.

    Args:
        offsets: (C + 1,) first segment of each contour of all glyphs, and their number. repeats: of each glyph.
    """
    if all(own is None for own in repeats):
        return np.empty((0, 7))
    every = np.concatenate([
        np.zeros(len(outline.degrees), dtype=np.int64) if own is None else own
        for outline, own in zip(outlines, repeats, strict=True)
    ])  # fmt: skip
    at = np.flatnonzero(every)
    rows = np.full((len(at), 7), np.nan)
    contour = np.searchsorted(offsets, at, side="right") - 1
    rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3], rows[:, 5] = REPEATED, contour, at - offsets[contour], every[at], -1
    return rows
