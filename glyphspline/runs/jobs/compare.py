"""Pairs of glyphs compared: pairs to outlines to differences."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from ...errors import GlyphsplineError
from ..engine import Item, Job, reason
from ..places import Head, Side, readers
from ..spec import Limits

if TYPE_CHECKING:
    from ...comparing.difference import Difference
    from ...outlines.outline import Outline
    from ...readers.source import OutlineOrError

MOST = Limits().segments
"""Segments of one outline."""


class Pair(NamedTuple):
    """A glyph of both sources."""

    old: Head
    new: Head


class Unread(NamedTuple):
    """A glyph that could not be compared: its name in the old font, and why."""

    glyph: str
    gid: int
    error: str


Found: TypeAlias = "list[Difference | Unread]"


@dataclass(frozen=True)
class CompareJob(Job[Pair, Found]):
    """Both sources, and the tolerance in units of the old em."""

    old: Side
    new: Side
    tolerance: float

    budget = 20_000
    """Segments of both fonts compared at once."""

    def read(self, tasks: Sequence[Pair]) -> list[Item | Exception]:
        """The outlines of both glyphs."""
        old, new = readers(self.old, self.new)
        return list(map(_item, old([pair.old for pair in tasks]), new([pair.new for pair in tasks])))

    def together(self, tasks: Sequence[Pair], contents: Sequence[Any]) -> Found:
        """The differences of a batch."""
        from ...comparing.compare import compare_many

        return [*compare_many([one for one, _ in contents], [other for _, other in contents], self.tolerance)]

    def failed(self, task: Pair, error: Exception) -> Found:
        """Why a glyph was not compared."""
        return [Unread(*task.old[:2], reason(error))]

    def failures(self, result: Found) -> int:
        """Number of glyphs that were not compared."""
        return sum(isinstance(each, Unread) for each in result)


def _item(old: OutlineOrError, new: OutlineOrError) -> Item | GlyphsplineError:
    try:
        pair = _accepted(old, "old"), _accepted(new, "new")
    except GlyphsplineError as error:
        return error
    return Item(pair, sum(len(outline.arrays.degrees) for outline in pair))


def _accepted(outline: OutlineOrError, which: str) -> Outline:
    """An outline that can be compared.

    Raises:
        GlyphsplineError: it could not be read, or is too large.
    """
    if isinstance(outline, GlyphsplineError):
        raise GlyphsplineError(f"{which}: {reason(outline)}")
    if len(outline.arrays.degrees) > MOST:
        raise GlyphsplineError(f"{which}: {len(outline.arrays.degrees)} segments, more than the {MOST} allowed")
    return outline
