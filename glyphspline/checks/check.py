"""Outlines checked: findings as values, from the tables of :mod:`.measured`."""

from __future__ import annotations

from collections.abc import Sequence

from ..outlines.outline import Outline
from .columns import Measured
from .finding import Finding
from .kinds import KINDS, Thresholds

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


def findings(glyphs: Sequence[tuple[str, int]], rows: Measured, tags: Sequence[str] = ()) -> list[list[Finding]]:
    """What was measured of glyphs, names and glyph indices, as values; ``tags`` of the axes, if there are any."""
    found: list[list[Finding]] = [[] for _ in glyphs]
    columns = (rows.glyphs, rows.contours, rows.segments, rows.kinds, rows.numbers, rows.points)
    where = (rows.locations.tolist(), rows.between.tolist())
    for g, contour, segment, what, (parameter, value, detail, other), (x, y), at, (low, high) in zip(
        *(column.tolist() for column in columns), *where, strict=True
    ):
        kind, (name, gid) = KINDS[what], glyphs[g]
        second, another = None if detail != detail else detail, None if other < 0 else int(other)
        whom = "itself" if another is None else f"contour {another}"
        sentence = kind.sentence.format(value=with_unit(value, kind.unit), detail=second, other=whom)
        place = contour, segment, parameter, (x, y)
        own = Finding(
            kind.name, kind.level, name, gid, *place, value, kind.unit, second, another, sentence,
            dict(zip(tags, at, strict=True)) if at else {}, None if low != low else (low, high),
        )  # fmt: skip
        found[g].append(own)
    return found


def with_unit(value: float, unit: str) -> str:
    """A value for people: "3.1°", "12 %", "4.2 /em"."""
    if unit == "%":
        return f"{100 * value:.3g} %"
    return f"{value:.3g}{unit}" if unit == "°" else f"{value:.3g} {unit}".strip()
