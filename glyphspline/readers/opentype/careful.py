"""The careful reader: reads single glyphs, with notes on contours left out and errors that say what is wrong."""

from __future__ import annotations

from fontTools.ttLib import TTFont

from ...outlines.outline import FontMetrics, Outline
from ..source import Head
from .fonttools import FontTools
from .glyf import GlyphRecords
from .harfbuzz import HarfBuzz


class CarefulReader:
    """Reads glyphs through HarfBuzz; those that HarfBuzz may not draw whole, through fontTools.

    Attributes:
        hb: the face in HarfBuzz.
    """

    def __init__(self, face: HarfBuzz, tables: TTFont, data: bytes, face_index: int) -> None:
        self.hb = face
        self._records = None
        if face.has_records:
            self._records = GlyphRecords(tables.reader["glyf"], tables["loca"].locations, tables.getGlyphOrder())
        self._fonttools = FontTools(data, face_index, face.normalized)

    def outline(self, head: Head, metrics: FontMetrics) -> Outline:
        """Read a glyph.

        Raises:
            GlyphsplineError: the glyph's components are nested in a loop, or it has too many parts.
            Exception: the glyph is broken; fontTools' exceptions pass through.
        """
        pen, advance = self.hb.draw(head.gid, self._records), self.hb.advance(head.gid)
        if pen is None:
            pen, advance = self._fonttools.draw(head.name)
        return Outline(*head, advance, pen.contours, metrics, pen.notes, pen.snapped)
