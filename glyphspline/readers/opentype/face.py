"""What the tables of a font file's face say of it without its glyphs; this takes milliseconds."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from types import MappingProxyType

import uharfbuzz as hb
from fontTools.ttLib import TTFont
from fontTools.ttLib.sfnt import readTTCHeader

from ...errors import FontError
from ...outlines.outline import FontMetrics
from ..source import opening
from .containers import FORMATS, unpacked
from .tables import Location, axes_of, instances_of, location_within, metrics_of, names_of

REQUIRED_TABLES = ("head", "hhea", "hmtx", "maxp")
OUTLINES = ("glyf", "CFF ", "CFF2")
PICTURES = ("EBDT", "CBDT", "sbix", "SVG ", "bdat")

UNICODE_CMAPS = frozenset({(3, 10), (3, 1), *((0, encoding) for encoding in (0, 1, 2, 3, 4, 6))})
"""Platforms and encodings of the tables of characters that a font is read by."""


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


class Face:
    """One face of a font file at one location, without its glyphs.

    Attributes:
        path: the file, as given. face_index: which face of a collection. num_faces: number of faces.
        format: the kind of file.
        axes: of a variable font, else empty; their mappings are known to :meth:`Font.masters`.
        instances: named instances, name to location.
        location: axis tag to user-space value, clamped to the axes' limits. Axes not in it are at their default.
        family, style: from the name table; by default the file's name and "Regular".
        shaper: HarfBuzz's font at the location.
        metrics: units per em, ascender and descender (the typographic ones if the font says so), at the location.
    """

    path: Path
    face_index: int
    num_faces: int
    location: Mapping[str, float]
    metrics: FontMetrics
    outer: int

    def __init__(
        self, path: Path, format: str, plain: bytes, face_index: int, num_faces: int, location: Location
    ) -> None:
        tables = TTFont(BytesIO(plain), fontNumber=face_index, lazy=True)
        missing = [tag for tag in REQUIRED_TABLES if tag not in tables]
        if missing:
            raise FontError(f"a broken font: no table {', '.join(missing)}")
        if not any(tag in tables for tag in OUTLINES):
            pictures = [tag.strip() for tag in PICTURES if tag in tables]
            what = f"only pictures ({', '.join(pictures)})" if pictures else "no table glyf, CFF or CFF2"
            raise FontError(f"has no outlines: {what}")
        self.path, self.face_index, self.num_faces = path, face_index, num_faces
        self.format = format
        self.outer = -1 if "glyf" in tables else 1
        self.axes, self.instances = axes_of(tables), instances_of(tables)
        within = location_within(location, self.axes, self.instances, path)
        self.location = MappingProxyType(within)
        self.family, self.style = names_of(tables, path)
        self.metrics = metrics_of(tables)
        self._tables, self._hb = tables, HarfBuzz(hb.Blob(plain), face_index, self.location)
        self.shaper = self._hb.font
        if self.location:
            extents = self._hb.font.get_font_extents("ltr")
            self.metrics = replace(self.metrics, ascender=float(extents.ascender), descender=float(extents.descender))

    def counts(self) -> tuple[int, int]:
        """The numbers of glyphs and of characters."""
        cmap = self._tables.reader["cmap"] if "cmap" in self._tables else bytes(4)
        tables = {struct.unpack_from(">HH", cmap, 4 + 8 * k) for k in range(struct.unpack_from(">H", cmap, 2)[0])}
        return self._hb.face.glyph_count, len(self._hb.face.unicodes) if tables & UNICODE_CMAPS else 0


def open_faces(path: str | Path, face_index: int | None = None, location: Location = None) -> Iterator[Face]:
    """The faces of a font file, or the one that is asked for.

    Raises:
        FontError: as in :func:`.font.open_font`.
    """
    path = Path(path)
    with opening(path):
        data, num_faces = read_file(path, face_index or 0)
        plain = unpacked(data)
        for index in range(num_faces) if face_index is None else [face_index]:
            yield Face(path, FORMATS[data[:4]], plain, index, num_faces, location)


def read_file(path: Path, face_index: int) -> tuple[bytes, int]:
    """The bytes of a font file, and its number of faces.

    Raises:
        FontError: it is no font, or has no such face.
    """
    data = path.read_bytes()
    if data[:4] not in FORMATS:
        raise FontError("not a TTF, OTF, TTC, WOFF or WOFF2 file")
    num_faces = readTTCHeader(BytesIO(data)).numFonts if data[:4] == b"ttcf" else 1
    if not 0 <= face_index < num_faces:
        raise FontError(f"no face {face_index}: the file has {num_faces}, counted from 0")
    return data, num_faces
