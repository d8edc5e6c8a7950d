"""TrueType and OpenType fonts: TTF, OTF, TTC, WOFF, WOFF2 and variable fonts."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from functools import cached_property
from io import BytesIO
from pathlib import Path
from types import MappingProxyType
from typing import Any

from fontTools.ttLib import TTFont
from fontTools.ttLib.sfnt import readTTCHeader

from ...errors import FontError
from ...outlines.outline import FontMetrics, Outline
from ..base import NamedGlyphs, reason
from .containers import FORMATS, unpacked
from .routes import FontTools, HarfBuzz
from .tables import axes_of, instances_of, location_within, metrics_of, names_of

REQUIRED_TABLES = ("head", "hhea", "hmtx", "maxp")
OUTLINES = ("glyf", "CFF ", "CFF2")
PICTURES = ("EBDT", "CBDT", "sbix", "SVG ", "bdat")


class Font(NamedGlyphs):
    """One face of a font file at one place of its design space; made by :func:`open_font`.

    A :class:`..source.Source`. Pickling a font keeps only how it was opened, and opens it again.

    Attributes:
        path: the file, as given. face_index: which face of a collection. num_faces: how many it has.
        format: what kind of file it is, in words.
        axes: of a variable font, else empty. instances: its named instances, name to location.
        location: axis tag to user-space value, as given but within the axis's limits; axes not in it are at
            their default.
        family, style: from the name table, falling back on the file name and "Regular".
        metrics: units per em, ascender and descender (the typographic ones if the font asks for those), at the
            location.
        glyph_names: all glyphs in glyph index order, made unique where the font repeats a name or has none.
        num_glyphs: their number.
        cmap: code point to glyph name, from the best Unicode table; empty if there is none.
    """

    def __init__(
        self, path: Path, data: bytes, face_index: int, num_faces: int, location: Mapping[str, float] | str | None
    ) -> None:
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
        self.location: Mapping[str, float] = MappingProxyType(within)
        self.family, self.style = names_of(tables, path)
        self.metrics = metrics_of(tables)
        self.glyph_names: tuple[str, ...] = tuple(tables.getGlyphOrder())
        self.num_glyphs = len(self.glyph_names)
        mapped = (tables.getBestCmap() or {}).items()
        self.cmap: Mapping[int, str] = MappingProxyType({code: name for code, name in mapped if name in self._gids})
        self._fast = HarfBuzz(plain, face_index, tables, self.location)
        if self.location:
            self.metrics = FontMetrics(self.metrics.units_per_em, *self._fast.extents())
        self._careful = FontTools(tables, self._fast.normalized)

    def __reduce__(self) -> tuple[Any, ...]:
        return open_font, (self.path, self.face_index, dict(self.location))

    @cached_property
    def sha256(self) -> str:
        """Of the file's bytes, in hexadecimal."""
        return hashlib.sha256(self._data).hexdigest()

    def tables(self) -> TTFont:
        """All tables, to be changed at will; of a variable font they are the default's, and the axes are there."""
        return TTFont(BytesIO(self._plain), fontNumber=self.face_index, recalcTimestamp=False)

    def outline(self, name: str) -> Outline:
        """The glyph's contours, components decomposed, at the font's location.

        Read through HarfBuzz; where that leaves anything out, through fontTools, which knows what is wrong.

        Raises:
            FontError: the font has no glyph of that name.
            GlyphsplineError: the glyph's data is broken, or its components are nested in a loop.
        """
        gid = self._gid(name)
        with self._drawing(name):
            pen, advance = self._fast.draw(gid) or self._careful.draw(name)
        return Outline(
            name=name,
            gid=gid,
            unicodes=self._unicodes.get(name, ()),
            advance=advance,
            contours=tuple(pen.contours),
            metrics=self.metrics,
            notes=pen.notes,
        )


def open_font(path: str | Path, face_index: int = 0, location: Mapping[str, float] | str | None = None) -> Font:
    """Open a TTF, OTF, TTC, WOFF or WOFF2 file.

    Args:
        path: the file. face_index: which font of a collection (TTC).
        location: for a variable font, axis tag to value in user space, as in ``{"wght": 700}``; values beyond
            an axis's limits are brought back to them with a warning. A string is the name of an instance: "Bold".

    Raises:
        FontError: the file cannot be read, is no font or a broken one, or has no such face, axis or instance.
    """
    path = Path(path)
    try:
        data = path.read_bytes()
        if data[:4] not in FORMATS:
            raise FontError("not a TTF, OTF, TTC, WOFF or WOFF2 file")
        num_faces = readTTCHeader(BytesIO(data)).numFonts if data[:4] == b"ttcf" else 1
        if not 0 <= face_index < num_faces:
            raise FontError(f"no face {face_index}: the file has {num_faces}, counted from 0")
        return Font(path, data, face_index, num_faces, location)
    except FontError as error:
        error.locate(font=str(path))
        raise
    except OSError as error:
        raise FontError(f"cannot be read: {error.strerror or error}", font=str(path)) from error
    except Exception as error:  # as in outline
        raise FontError(f"a broken font: {reason(error)}", font=str(path)) from error
