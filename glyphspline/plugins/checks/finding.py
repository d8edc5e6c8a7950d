"""A finding: what may be wrong at one place of a glyph, and how much; as a value, and as a row of columns."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice, repeat
from typing import NamedTuple

import numpy as np

from ...outlines.flaws.kinds import KINDS, LEVELS, Level
from ...types import FloatArray, IntArray

SMALLER_IS_WORSE = frozenset({"short", "straight", "leftover"})
"""Kinds whose smaller value is worse."""

_ORDER = {kind.name: k for k, kind in enumerate(KINDS)}


@dataclass(frozen=True)
class Finding:
    """What may be wrong at one place of a glyph.

    Attributes:
        kind: name of a :class:`.kinds.Kind`. level: "WARN" or "INFO".
        glyph, gid: which glyph. contour: number of the contour.
        segment: number of the segment that begins there, or that holds the place. parameter: 0 at its beginning, to 1.
        point: the place, in font units.
        value: how much, in ``unit``. detail: a second number; None if the kind has none.
        other: another contour concerned; None if there is none.
        sentence: what it is, for people.
        location: where on the axes it is worst, axis tag to user-space value; empty if the font has none.
        between: user-space values of the masters on both sides, of a finding between masters; None of any other.
        seen: how far a kink, turn or jump is seen, in font units: the length of the shorter segment beside it, times
            the turn as a share of a corner's, or the relative jump; None of other kinds.
    """

    kind: str
    level: Level
    glyph: str
    gid: int
    contour: int
    segment: int
    parameter: float
    point: tuple[float, float]
    value: float
    unit: str
    detail: float | None
    other: int | None
    sentence: str
    location: dict[str, float] = field(default_factory=dict)
    between: tuple[float, float] | None = None
    seen: float | None = None


class Measured(NamedTuple):
    """Findings of many glyphs in columns, the form in which passes and processes exchange them.

    Attributes:
        glyphs: (n,) which of the glyphs. contours: (n,) number of the contour in it. segments: (n,) of the contour.
        kinds: (n,) number of the kind.
        numbers: (n, 5) local parameter, value, second number or NaN, another contour of the glyph or -1, seen or NaN.
        points: (n, 2) where it is.
        locations: (n, A) user-space values of the axes where it is worst; A is 0 without axes.
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

    @classmethod
    def joined(cls, parts: Iterable[Measured], axes: int = 0) -> Measured:
        """The rows of all parts; ``axes``: number of axes of their locations."""
        none = np.zeros(0, dtype=np.int64)
        empty = cls(none, none, none, none, np.zeros((0, 5)), np.zeros((0, 2)), np.zeros((0, axes)), np.zeros((0, 2)))
        return cls._make([np.concatenate(columns) for columns in zip(*(list(parts) or [empty]), strict=True)])


def findings(glyphs: Sequence[tuple[str, int]], rows: Measured, tags: Sequence[str] = ()) -> Iterator[list[Finding]]:
    """What was measured of glyphs, names and glyph indices, as values of one glyph after the other.

    ``tags``: of the axes, if there are any.
    """
    rows = rows.chosen(np.argsort(rows.glyphs, kind="stable"))
    counts = np.bincount(rows.glyphs, minlength=len(glyphs)).tolist()
    columns = [*rows[1:4], *rows.numbers.T, *rows.points.T, *rows.between.T]  # lists of numbers, not of lists
    values = zip(*(column.tolist() for column in columns), strict=True)
    places = iter(rows.locations.tolist()) if tags else repeat(())
    for (name, gid), count in zip(glyphs, counts, strict=True):
        found = []
        for contour, segment, what, parameter, value, detail, other, seen, x, y, low, high in islice(values, count):
            kind = KINDS[what]
            second, another = None if detail != detail else detail, None if other < 0 else int(other)
            sentence = kind.sentence.replace("{value}", with_unit(value, kind.unit))
            if "{" in sentence:
                whom = "itself" if another is None else f"contour {another}"
                along = with_unit(seen / detail, "units") if detail > 0 else ""
                sentence = sentence.format(detail=second, other=whom, along=along)
            made = Finding.__new__(Finding)  # a font may have a million: each takes a quarter of the time so
            made.__dict__.update(
                kind=kind.name, level=kind.level, glyph=name, gid=gid, contour=contour, segment=segment,
                parameter=parameter, point=(x, y), value=value, unit=kind.unit, detail=second, other=another,
                sentence=sentence, location=dict(zip(tags, next(places), strict=True)),
                between=None if low != low else (low, high), seen=None if seen != seen else seen,
            )  # fmt: skip
            found.append(made)
        yield found


def with_unit(value: float, unit: str) -> str:
    """A value for people: "3.1°", "12 %", "4.2 /em"."""
    if unit == "%":
        return f"{100 * value:.3g} %"
    return f"{value:.3g}{unit}" if unit == "°" else f"{value:.3g} {unit}".strip()


def badness(finding: Finding) -> float:
    """A number that is larger for the worse of two findings of a kind."""
    if finding.kind == "jump" and finding.seen is not None:
        return finding.seen
    return -finding.value if finding.kind in SMALLER_IS_WORSE else finding.value


def severity(finding: Finding) -> tuple[float, ...]:
    """By which findings are sorted, the worst first: level, kind and value, and of equal ones their place."""
    return (
        -LEVELS.index(finding.level), _ORDER[finding.kind], -badness(finding), finding.gid, finding.contour,
        finding.segment, finding.parameter,
    )  # fmt: skip


def place_on_axes(finding: Finding, home: Mapping[str, float]) -> str:
    """Where a finding is on the axes, without those that are at ``home``: "wght 632 (400 to 900)"; else empty.

    Args:
        finding: of a font with axes, or not. home: user-space value of each axis where the font is open.
    """
    moved = ", ".join([f"{tag} {value:.4g}" for tag, value in finding.location.items() if value != home.get(tag)])
    if finding.between is None or not moved:
        return moved
    low, high = finding.between
    return f"{moved} ({'in a master' if low == high else f'{low:.4g} to {high:.4g}'})"
