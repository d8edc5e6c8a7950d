"""A finding: what may be wrong at one place of a glyph, and how much."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .kinds import KINDS, LEVELS, Level

SMALLER_IS_WORSE = frozenset({"short", "straight"})
"""Kinds of which the smaller value is the worse."""

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


def badness(finding: Finding) -> float:
    """A number that is larger for the worse of two findings of a kind."""
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
