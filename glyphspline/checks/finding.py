"""A finding: what may be wrong at one place of a glyph, and how much."""

from __future__ import annotations

from dataclasses import dataclass, field

from .kinds import Level


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
