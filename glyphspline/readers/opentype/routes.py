"""The two ways to a glyph's outline: HarfBuzz, which is fast, and fontTools, which reports what is wrong with it."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from contextlib import suppress
from functools import cached_property
from io import BytesIO
from typing import Any

import uharfbuzz as hb
from fontTools.misc.roundTools import otRound
from fontTools.pens.transformPen import TransformPen
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import USE_MY_METRICS

from ...errors import GlyphsplineError
from ...outlines.outline import FontMetrics, Outline
from ...types import Head
from ..pens import drawn_by, enter_component

ELSEWHERE = ("SVG ", "COLR", "CBDT", "sbix", "EBDT")
"""Tables that may hold the ink of a glyph without contours: drawings, layers and pictures."""

MOST_MOVES = 4_000_000
"""Limit of points times variations of a glyph of ``glyf``: real ones have some 50,000, and fontTools lists them all."""


class Face:
    """A face at a location.

    Args:
        data: the file's bytes, without compression. face_index: which face of a collection.
        location: axis tag to user-space value, within the axes' limits.

    Attributes:
        face, font: HarfBuzz's own objects.
        normalized: axis tag to normalised coordinate, rounded to 1/16384 as in the format; empty at the default.
        has_records: whether glyphs are records of the ``glyf`` table; char strings otherwise.
    """

    def __init__(self, data: bytes, face_index: int, location: Mapping[str, float]) -> None:
        self._data, self._face_index = data, face_index
        self.face = hb.Face(hb.Blob(data), face_index)
        self.font = hb.Font(self.face)
        self.normalized: dict[str, float] = {}
        if location:
            self.font.set_variations(dict(location))
            tags = [axis.tag for axis in self.face.axis_infos]
            self.normalized = dict(zip(tags, self.font.get_var_coords_normalized(), strict=False))
        tags = self.face.table_tags
        self.has_records = "glyf" in tags and "loca" in tags and "VARC" not in tags
        self._failure: Exception | None = None

    def unread(self, gid: int) -> tuple[str, ...]:
        """Where the ink of a glyph without contours is, of which nothing is read; empty if it has none."""
        font, face = self.font, self.face
        found = {
            "SVG ": lambda: face.has_color_svg and len(face.get_glyph_color_svg(gid).data),
            "COLR": lambda: (
                (face.has_color_layers and face.get_glyph_color_layers(gid))
                or (face.has_color_paint and face.glyph_has_color_paint(gid))
            ),
            "CBDT": lambda: face.has_color_png and len(font.get_glyph_color_png(gid).data),
            "EBDT": lambda: self._has_pixels(gid),
        }
        found["sbix"] = found["CBDT"]
        tables = [tag for tag in self._elsewhere if found[tag]()]
        return tuple(f"its ink is in the {tag.strip()} table, which is not read" for tag in tables)

    def _has_pixels(self, gid: int) -> bool:
        """Whether a glyph has a bitmap of one colour that is not empty, which HarfBuzz does not read."""
        with suppress(Exception):  # a broken table shows nothing
            name, strikes = self._tables.getGlyphName(gid), self._tables["EBDT"].strikeData
            bitmaps = [strike[name] for strike in strikes if name in strike]
            return any(any(getattr(bitmap, "imageData", b"\1")) for bitmap in bitmaps)  # or it is made of others
        return False

    @cached_property
    def _elsewhere(self) -> list[str]:
        return [tag for tag in ELSEWHERE if tag in self.face.table_tags]

    @cached_property
    def _tables(self) -> TTFont:
        return TTFont(BytesIO(self._data), fontNumber=self._face_index, lazy=True)

    @cached_property
    def _glyphs(self) -> Any:
        """fontTools' glyph set, made when HarfBuzz fails on a glyph: it takes as long as opening a CJK face.

        Tables that fail as a whole fail once: a count in a hostile one can ask for gigabytes. The error drops its
        traceback, whose frames would keep them.
        """
        if self._failure is None:
            try:
                return self._tables.getGlyphSet(location=self.normalized or None, normalized=True)
            except Exception as error:
                self._failure = error
        raise self._failure.with_traceback(None) from None

    def by_fonttools(self, head: Head, metrics: FontMetrics) -> Outline:
        """Read a glyph by fontTools, whose exceptions pass through; ``metrics`` are those at the location.

        After one the tables are opened again: fontTools keeps tables and glyphs that are read in part, and the next
        reading of the same glyph would not find the fault.
        """
        try:
            name = self._tables.getGlyphName(head.gid)
            if self.normalized:
                check_variations(self._tables, name)
            glyph, shift = self._glyphs[name], (1, 0, 0, 1, self._shift(name), 0)
            pen = drawn_by(lambda to: glyph.draw(TransformPen(to, shift)), glyph_set=self._glyphs, glyph_name=name)
            advance = float(otRound(glyph.width))  # read last: drawing applies the variations of the width
            unread = () if pen.stacks else self.unread(head.gid)
            return Outline(*head, advance, pen.contours, metrics, pen.notes, pen.snapped, unread)
        except Exception:
            self.__dict__.pop("_tables", None)
            self.__dict__.pop("_glyphs", None)
            raise

    def _shift(self, name: str) -> float:
        """How far a composite glyph moves to its left side bearing: fontTools moves only simple glyphs there.

        Where it has the metrics of a component, it moves as that one does, as in rasterisers.
        """
        glyf = self._tables["glyf"] if "glyf" in self._tables and not self.normalized else None
        if glyf is None or not glyf[name].isComposite():
            return 0.0
        nesting: list[str | None] = [name]
        while glyf[name].isComposite():
            own = [part.glyphName for part in glyf[name].components if part.flags & USE_MY_METRICS]
            if not own:
                break
            nesting, name = enter_component(nesting, own[-1]), own[-1]
        return float(self._glyphs[name].lsb - getattr(glyf[name], "xMin", 0))


def check_variations(tables: TTFont, name: str) -> None:
    """Refuse a glyph of ``glyf`` that varies in too many ways for its points, before they are listed.

    Raises:
        GlyphsplineError: it does. What is cut short is left to fontTools.
    """
    with suppress(struct.error):
        data, gid = tables.reader["gvar"] if "gvar" in tables else b"", tables.getGlyphID(name)
        flags, start = struct.unpack_from(">HL", data, 14)
        if flags & 1:
            (at,) = struct.unpack_from(">L", data, 20 + 4 * gid)
        else:
            at = 2 * struct.unpack_from(">H", data, 20 + 2 * gid)[0]
        count = struct.unpack_from(">H", data, start + at)[0] & 0xFFF
        points = tables["gvar"].getNumPoints_(tables["glyf"][name])
        if count * points > MOST_MOVES:
            raise GlyphsplineError(f"{count} variations of {points} points, more than {MOST_MOVES} moves")
