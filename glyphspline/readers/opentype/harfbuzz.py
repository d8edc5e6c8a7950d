"""Outlines through HarfBuzz, glyph by glyph, with a check that the drawing is whole."""

from __future__ import annotations

from collections.abc import Mapping

import uharfbuzz as hb

from ..pens import ContourPen
from .glyf import GlyphRecords


class HarfBuzz:
    """A face at a location.

    Attributes:
        face, font: HarfBuzz's own objects.
        normalized: axis tag to normalised coordinate, rounded to 1/16384 as in the format; empty at the default.
        has_records: whether glyphs are records of the ``glyf`` table; char strings otherwise.
    """

    def __init__(self, blob: hb.Blob, face_index: int, location: Mapping[str, float]) -> None:
        self.face = hb.Face(blob, face_index)
        self.font = hb.Font(self.face)
        self.normalized: dict[str, float] = {}
        if location:
            self.font.set_variations(dict(location))
            tags = [axis.tag for axis in self.face.axis_infos]
            self.normalized = dict(zip(tags, self.font.get_var_coords_normalized(), strict=False))
        tags = self.face.table_tags
        self.has_records = "glyf" in tags and "loca" in tags and "VARC" not in tags

    def advance(self, gid: int) -> float:
        """The horizontal advance of a glyph."""
        return float(self.font.get_glyph_h_advance(gid))

    def is_whole(self, gid: int) -> bool:
        """Whether HarfBuzz interprets a char string to its end; it draws the part before a fault without an error."""
        return self.font.get_glyph_extents(gid) is not None

    def draw(self, gid: int, records: GlyphRecords | None) -> ContourPen | None:
        """Draw the contours of a glyph; None if HarfBuzz may have left out some of it.

        Args:
            gid: which glyph. records: of the ``glyf`` table if there is one.

        Raises:
            GlyphsplineError: components in a loop, or too many components or segments.
        """
        parts = None if records is None else records.parts(gid)
        if records is not None and parts is None:
            return None
        pen = ContourPen()
        self.font.draw_glyph_with_pen(gid, pen)
        pen.finish()
        whole = self.is_whole(gid) if parts is None else pen.drawn == parts.contours
        return pen if whole else None
