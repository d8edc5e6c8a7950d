"""What differs between two outlines of one glyph, as plain data."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any, Literal

from ...outlines.outline_distance import EVEN

Side = Literal["old", "new"]
SIDES: tuple[Side, Side] = ("old", "new")

Point = tuple[float, float]

PER_EM = 1e-3
"""The tolerance without another, as a share of the old em."""


@dataclass(frozen=True)
class Apart:
    """Where two outlines are farthest from each other.

    Attributes:
        outline: which of them the point is on. contour: number of the contour. point: the point.
        nearest: the nearest point of the other outline.
    """

    outline: Side
    contour: int
    point: Point
    nearest: Point


@dataclass(frozen=True)
class Turn:
    """A kink of one of two outlines.

    Attributes:
        contour, segment: numbers of the contour, and of its segment that begins there. point: the place.
        degrees: by how much the tangent turns.
    """

    contour: int
    segment: int
    point: Point
    degrees: float


@dataclass(frozen=True)
class Ink:
    """How the ink of two outlines differs: what contours wind around, by the nonzero rule.

    Attributes:
        changed: area of what only one of them fills, in square units. error: by which it may be more or less.
        area, new_area: what each of them fills.
        lost: number of islands and counters that the new one has not, or that it has in one with others. gained: the
            other way round. Those narrower than a quarter of the comparison's tolerance do not count.
        depth: certified: a point of changed ink is as far as that from both outlines, and none is farther by more than
            a quarter. deepest: the point.
    """

    changed: float
    error: float
    area: float
    new_area: float
    lost: int
    gained: int
    depth: float
    deepest: Point

    @property
    def share(self) -> str:
        """What changed, of what the old one fills, for people."""
        return f"{100 * self.changed / self.area:.3g} %" if self.area else "all"


@dataclass(frozen=True)
class Difference:
    """What differs between two outlines of one glyph. Lengths and points are in units of the old one's em.

    Attributes:
        glyph, gid: name and index in the old font. new_glyph, new_gid: in the new one.
        unicodes: code points of either, ascending.
        identical: the contours are the same numbers in the same order. All that follows is 0, empty or None then, but
            for the advances.
        bound: certified: no point of either outline is farther from the other. Infinite if one of them is empty.
        seen: certified: some point of either outline is as far as that from the other; the largest such distance that
            was found. ``bound`` exceeds it by no more than 1 %, or 0.01 thousandths of the em, and the tolerance of the
            comparison is not between them, unless the outlines are not known as closely as that.
        worst: where that is; None if the outlines are identical, or one is empty.
        advance, new_advance: advances. scale: by which the new one was multiplied, to have the same em.
        contours_gone: numbers of old contours without a partner in the new outline, but for those that are no wider
            than two tolerances of the comparison. contours_new: and the other way.
        kinks_gone: kinks of the old outline that the new one does not have. kinks_new: and the other way.
        ink: how the ink differs, if by more than the tolerance of the comparison explains. None otherwise, and where it
            was not measured, as the outlines are seen beyond the tolerance. ink_known: whether nothing was left open,
            for outlines in which it would take minutes to tell.
    """

    glyph: str
    gid: int
    new_glyph: str
    new_gid: int
    unicodes: tuple[int, ...]
    identical: bool
    bound: float
    seen: float
    worst: Apart | None
    advance: float
    new_advance: float
    scale: float
    contours_gone: tuple[int, ...] = ()
    contours_new: tuple[int, ...] = ()
    kinks_gone: tuple[Turn, ...] = ()
    kinks_new: tuple[Turn, ...] = ()
    ink: Ink | None = None
    ink_known: bool = True

    @property
    def is_none(self) -> bool:
        """Whether outlines and advances are the same."""
        return self.identical and self.advance == self.new_advance

    def is_beyond(self, tolerance: float) -> bool:
        """Whether the outlines are seen farther apart, the advance changes by more, contours came or went, or ink did
        that is deeper."""
        limit, moved = tolerance * (1 + EVEN), abs(self.new_advance - self.advance)
        deep = self.ink is not None and self.ink.depth > limit
        return self.seen > limit or moved > limit or deep or bool(self.contours_gone or self.contours_new)

    def is_undecided(self, tolerance: float) -> bool:
        """Whether nothing is seen beyond the tolerance, and distance and ink are not certified to be within it.

        That is for outlines that are not known as closely as the tolerance asks, or that would take minutes; and for
        another tolerance than that of the comparison.
        """
        certified = self.bound <= tolerance * (1 + EVEN) and self.ink_known
        return not certified and not self.is_beyond(tolerance)

    def facts(self) -> dict[str, Any]:
        """As JSON data; an infinite distance is null."""
        from dataclasses import asdict

        found = asdict(self) | {"unicodes": [f"U+{code:04X}" for code in self.unicodes]}
        return found | {name: None for name in ("bound", "seen") if found[name] == inf}
