"""Glyphs converted one by one for the pages of an atlas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from ...fitting.options import Options
from ..engine import Job, reason
from ..places import Place, sources

if TYPE_CHECKING:
    from ...fitting.convert_masters import MastersResult
    from ...fitting.results import GlyphResult

Converted: TypeAlias = "GlyphResult | MastersResult | tuple[str, str]"
"""A result, or a glyph's name and why it could not be converted."""


@dataclass(frozen=True)
class AtlasJob(Job[str, Converted]):
    """Glyphs by name, converted where their font is open, or in all masters."""

    place: Place
    options: Options
    masters: bool = False

    chunk = 1
    budget = 1.0

    def together(self, tasks: Sequence[str], contents: Sequence[Any]) -> Converted:
        """Convert one glyph."""
        from ...fitting.convert import convert
        from ...fitting.convert_masters import convert_masters

        (name,), (source,) = tasks, sources(self.place)
        if self.masters:
            return convert_masters(source.masters(name), self.options)
        return convert(source.outline(name), self.options)

    def failed(self, task: str, error: Exception) -> Converted:
        """Why a glyph could not be converted."""
        return task, reason(error)

    def failures(self, result: Converted) -> int:
        """Whether the glyph failed."""
        return int(isinstance(result, tuple))
