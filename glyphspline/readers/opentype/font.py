"""TrueType and OpenType fonts: TTF, OTF, TTC, WOFF, WOFF2 and variable fonts."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from io import BytesIO
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import uharfbuzz as hb
from fontTools.ttLib import TTFont
from fontTools.ttLib.sfnt import readTTCHeader

from ...errors import FontError
from ..source import Head, OutlineOrError, Source, opening
from .careful import CarefulReader
from .containers import FORMATS, unpacked
from .harfbuzz import HarfBuzz
from .tables import Location, axes_of, instances_of, location_within, metrics_of, names_of

if TYPE_CHECKING:
    from .bulk import BulkReader

REQUIRED_TABLES = ("head", "hhea", "hmtx", "maxp")
OUTLINES = ("glyf", "CFF ", "CFF2")
PICTURES = ("EBDT", "CBDT", "sbix", "SVG ", "bdat")


class Font(Source):
    """One face of a font file at one location; made by :func:`open_font`.

    Attributes:
        path: the file, as given. face_index: which face of a collection. num_faces: number of faces.
        format: the kind of file.
        axes: of a variable font, else empty. instances: named instances, name to location.
        location: axis tag to user-space value, clamped to the axes' limits. Axes not in it are at their default.
        family, style: from the name table; by default the file's name and "Regular".
        metrics: units per em, ascender and descender (the typographic ones if the font says so), at the location.
        glyph_names: all glyphs in glyph index order, made unique where the font repeats a name or has none.
        num_glyphs: number of glyphs.
        cmap: code point to glyph name, from the best Unicode table; empty if there is none.
    """

    def __init__(self, path: Path, data: bytes, face_index: int, num_faces: int, location: Location) -> None:
        self._plain = plain = unpacked(data)
        tables = TTFont(BytesIO(plain), fontNumber=face_index, lazy=True)
        missing = [tag for tag in REQUIRED_TABLES if tag not in tables]
        if missing:
            raise FontError(f"a broken font: no table {', '.join(missing)}")
        if not any(tag in tables for tag in OUTLINES):
            pictures = [tag.strip() for tag in PICTURES if tag in tables]
            what = f"only pictures ({', '.join(pictures)})" if pictures else "no table glyf, CFF or CFF2"
            raise FontError(f"has no outlines: {what}")
        self._data = data
        self.path, self.face_index, self.num_faces = path, face_index, num_faces
        self.format = FORMATS[data[:4]]
        self.axes, self.instances = axes_of(tables), instances_of(tables)
        within = location_within(location, self.axes, self.instances, path)
        self.location = MappingProxyType(within)
        self.family, self.style = names_of(tables, path)
        self.metrics = metrics_of(tables)
        self.glyph_names = tuple(tables.getGlyphOrder())
        self.num_glyphs = len(self.glyph_names)
        mapped = (tables.getBestCmap() or {}).items()
        self.cmap = MappingProxyType({code: name for code, name in mapped if name in self._gids})
        face = HarfBuzz(hb.Blob(plain), face_index, self.location)
        if self.location:
            extents = face.font.get_font_extents("ltr")
            self.metrics = replace(self.metrics, ascender=float(extents.ascender), descender=float(extents.descender))
        self._careful = CarefulReader(face, tables, plain, face_index)

    def __reduce__(self) -> tuple[Any, ...]:
        return open_font, (self.path, self.face_index, dict(self.location))

    @cached_property
    def sha256(self) -> str:
        """Hash of the file's bytes, in hexadecimal."""
        return hashlib.sha256(self._data).hexdigest()

    def tables(self) -> TTFont:
        """A new copy of all tables, to be changed; those of a variable font are at the default and keep the axes."""
        return TTFont(BytesIO(self._plain), fontNumber=self.face_index, recalcTimestamp=False)

    def _read(self, heads: Sequence[Head]) -> list[OutlineOrError]:
        return self._bulk.outlines(heads, self.metrics)

    @cached_property
    def _bulk(self) -> BulkReader:
        from .bulk import BulkReader  # imports the compiler, which opening and selecting do not need

        return BulkReader(self.path, self.face_index, self.location, self._plain, self._careful)


def open_font(path: str | Path, face_index: int = 0, location: Location = None) -> Font:
    """Open a TTF, OTF, TTC, WOFF or WOFF2 file.

    Args:
        path: the file. face_index: which font of a collection (TTC).
        location: for a variable font, axis tag to value in user space, as in ``{"wght": 700}``. Values beyond an
            axis's limits are clamped with a warning. A string is the name of an instance: "Bold".

    Raises:
        FontError: the file cannot be read, is no font or broken, or has no such face, axis or instance.

    Example:
        >>> from glyphspline import open_font
        >>> font = open_font("fonts_test/kouzan-gyosho.ttf")
        >>> font
        <Font 'Kouzan Gyosho Subset Regular' from 'kouzan-gyosho.ttf': 18 glyphs, 17 characters, 1024 units per em>
        >>> font.select(text="龍好A")  # in the order of the text
        ('uni9F8D', 'uni597D', 'A')
        >>> font.outline("A")
        <Outline 'A' gid 4 U+0041: 2 contours, 34 segments, advance 515, 1024 units per em>
    """
    path = Path(path)
    with opening(path):
        data = path.read_bytes()
        if data[:4] not in FORMATS:
            raise FontError("not a TTF, OTF, TTC, WOFF or WOFF2 file")
        num_faces = readTTCHeader(BytesIO(data)).numFonts if data[:4] == b"ttcf" else 1
        if not 0 <= face_index < num_faces:
            raise FontError(f"no face {face_index}: the file has {num_faces}, counted from 0")
        return Font(path, data, face_index, num_faces, location)
