"""Outlines checked: findings as values, from the tables of :mod:`.measured`."""

from __future__ import annotations

from collections.abc import Sequence

from ..outlines.outline import Outline
from .finding import Finding, findings
from .kinds import Thresholds

THRESHOLDS = Thresholds()


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
    from .measured import measured  # imported here, so that the package opens without a compiler

    if not outlines:
        return []
    rows = measured([outline.arrays for outline in outlines], thresholds, outlines[0].metrics.units_per_em, outer)
    return findings([(outline.name, outline.gid) for outline in outlines], rows)
