"""The careful reader: one glyph at a time, with notes on what is left out and errors that say what is wrong."""

from __future__ import annotations

from pathlib import Path

from fontTools.ttLib import TTFont

from ...outlines.outline import FontMetrics, Outline
from ..source import Head, drawing
from .fonttools import FontTools
from .glyf import GlyphRecords
from .harfbuzz import HarfBuzz


class CarefulReader:
    """Reads glyphs through HarfBuzz; those that HarfBuzz may not draw whole, through fontTools.

    Attributes:
        hb: the face in HarfBuzz.
    """

    def __init__(self, path: Path, face: HarfBuzz, tables: TTFont, data: bytes, face_index: int) -> None:
        self.hb = face
        self._path = path
        self._records = None
        if "glyf" in tables and "loca" in tables and "VARC" not in tables:
            self._records = GlyphRecords(tables.reader["glyf"], tables["loca"].locations, tables.getGlyphOrder())
        self._fonttools = FontTools(data, face_index, face.normalized)

    def outline(self, head: Head, metrics: FontMetrics) -> Outline:
        """Read a glyph.

        Raises:
            GlyphsplineError: the glyph is broken, or its components are nested in a loop.
        """
        name, gid, unicodes = head
        with drawing(self._path, name):
            pen, advance = self.hb.draw(gid, self._records), self.hb.advance(gid)
            if pen is None:
                pen, advance = self._fonttools.draw(name)
        return Outline(name, gid, unicodes, advance, pen.contours, metrics, pen.notes)
