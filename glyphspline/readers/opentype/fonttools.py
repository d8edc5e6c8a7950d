"""Outlines through fontTools, which reports what is wrong with a glyph."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

from fontTools.misc.roundTools import otRound
from fontTools.pens.transformPen import TransformPen
from fontTools.ttLib import TTFont

from ..pens import ContourPen


class FontTools:
    """Outlines at a location in normalised coordinates."""

    def __init__(self, tables: TTFont, normalized: Mapping[str, float]) -> None:
        self._tables, self._normalized = tables, normalized

    @cached_property
    def _glyphs(self) -> Any:
        """The glyph set, made when HarfBuzz fails on a glyph: it takes as long as opening a CJK face."""
        return self._tables.getGlyphSet(location=dict(self._normalized) or None, normalized=True)

    @cached_property
    def _static_glyf(self) -> Any:
        return self._tables["glyf"] if "glyf" in self._tables and not self._normalized else None

    def draw(self, name: str) -> tuple[ContourPen, float]:
        """Draw the contours of a glyph; also its advance. fontTools' exceptions pass through."""
        pen = ContourPen(self._glyphs, name)
        glyph = self._glyphs[name]
        glyph.draw(TransformPen(pen, (1, 0, 0, 1, self._shift(name), 0)))
        pen.finish()
        return pen, float(otRound(glyph.width))  # read last: drawing applies the variations of the width

    def _shift(self, name: str) -> float:
        """How far a composite glyph moves to its left side bearing.

        Rasterisers move every glyph there; fontTools moves simple glyphs only.
        """
        glyph = self._static_glyf[name] if self._static_glyf is not None else None
        return self._glyphs[name].lsb - glyph.xMin if glyph is not None and glyph.isComposite() else 0.0
