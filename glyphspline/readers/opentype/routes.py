"""Two routes from a font's tables to a pen: HarfBuzz, fast and hardened, and fontTools, which says what is wrong."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import uharfbuzz as hb
from fontTools.misc.roundTools import otRound
from fontTools.pens.transformPen import TransformPen
from fontTools.ttLib import TTFont

from ..pens import ContourPen
from .glyf import GlyphRecords


class HarfBuzz:
    """Outlines through HarfBuzz.

    Attributes:
        normalized: axis tag to normalised coordinate, rounded to 1/16384 as the format has it; empty at the default.
    """

    def __init__(self, data: bytes, face_index: int, tables: TTFont, location: Mapping[str, float]) -> None:
        self._font = hb.Font(hb.Face(hb.Blob(data), face_index))
        self.normalized: dict[str, float] = {}
        if location:
            self._font.set_variations(dict(location))
            tags = [axis.axisTag for axis in tables["fvar"].axes]
            self.normalized = dict(zip(tags, self._font.get_var_coords_normalized(), strict=False))
        self._records = None
        if "glyf" in tables and "loca" in tables and "VARC" not in tables:
            names = tables.getGlyphOrder()
            self._records = GlyphRecords(tables.reader["glyf"], tables["loca"].locations, names)

    def extents(self) -> tuple[float, float]:
        """Ascender and descender at the location."""
        extents = self._font.get_font_extents("ltr")
        return float(extents.ascender), float(extents.descender)

    def draw(self, gid: int) -> tuple[ContourPen, float] | None:
        """The glyph's contours and advance; None if it is not sure that HarfBuzz has drawn all of it.

        Raises:
            GlyphsplineError: components in a loop, or a flood of them or of segments.
        """
        pen = ContourPen()
        if self._records is None:
            self._font.draw_glyph_with_pen(gid, pen)
            pen.finish()
            whole = self._font.get_glyph_extents(gid) is not None  # None if a char string breaks off
        else:
            parts = self._records.parts(gid)
            if parts is None:
                return None
            pen.numbers = [k for k, points in enumerate(parts.contours) if points > 1]
            pen.left_out = [k for k, points in enumerate(parts.contours) if points == 1]  # HarfBuzz passes over them
            self._font.draw_glyph_with_pen(gid, pen)
            pen.finish()
            whole = pen.drawn == len(pen.numbers)
        return (pen, float(self._font.get_glyph_h_advance(gid))) if whole else None


class FontTools:
    """Outlines through fontTools, at a location in normalised coordinates."""

    def __init__(self, tables: TTFont, normalized: Mapping[str, float]) -> None:
        self._tables, self._normalized = tables, normalized

    @cached_property
    def _glyphs(self) -> Any:
        """Made when HarfBuzz has failed on a glyph: of a CJK face it takes as long as all else in opening it."""
        return self._tables.getGlyphSet(location=dict(self._normalized) or None, normalized=True)

    @cached_property
    def _static_glyf(self) -> Any:
        return self._tables["glyf"] if "glyf" in self._tables and not self._normalized else None

    def draw(self, name: str) -> tuple[ContourPen, float]:
        """The glyph's contours and advance; whatever is broken is raised as fontTools raises it."""
        pen = ContourPen(self._glyphs, name)
        glyph = self._glyphs[name]
        glyph.draw(TransformPen(pen, (1, 0, 0, 1, self._shift(name), 0)))
        pen.finish()
        return pen, float(otRound(glyph.width))  # known only now: variations of the width are applied in drawing

    def _shift(self, name: str) -> float:
        """How far a composite glyph moves to have its left side bearing. Rasterisers do so, as with simple glyphs,
        where fontTools does it itself.
        """
        glyph = self._static_glyf[name] if self._static_glyf is not None else None
        return self._glyphs[name].lsb - glyph.xMin if glyph is not None and glyph.isComposite() else 0.0
