"""TrueType and OpenType fonts: TTF, OTF, TTC, WOFF, WOFF2 and variable fonts."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from io import BytesIO
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
import uharfbuzz as hb
from fontTools.ttLib import TTFont
from fontTools.ttLib.sfnt import readTTCHeader

from ... import hooks
from ...errors import FontError
from ...outlines.masters import DesignAxis, Masters
from ...outlines.outline import FontMetrics
from ...types import Head
from ..source import Location, OutlineOrError, Source, opening
from .containers import FORMATS, unpacked
from .routes import Face

if TYPE_CHECKING:
    from .bulk import BulkReader

REQUIRED_TABLES = ("head", "hhea", "hmtx", "maxp")
OUTLINES = ("glyf", "CFF ", "CFF2")
PICTURES = ("EBDT", "CBDT", "sbix", "SVG ", "bdat")

FAMILY, STYLE = (21, 16, 1), (22, 17, 2)
"""Entries of the name table, the best first."""

MOST_FACES = 1000
"""Limit of faces of a collection: each takes four bytes of a hostile file, and the time of a font."""

SYMBOLS, MAC_ROMAN = (3, 0), (1, 0)
UNICODE_CMAPS = ((3, 10), (0, 6), (0, 4), (3, 1), (0, 3), (0, 2), (0, 1), (0, 0))
"""Platforms and encodings of the tables of characters that a font is read by: as HarfBuzz, by the one of symbols where
there is one, or else the best for Unicode, or else the one of the Macintosh."""


class Font(Source):
    """One face of a font file at one location; made by :func:`open_font`.

    Attributes: those of :class:`.Source`, and
        location: clamped to the axes' limits. Axes not in it are at their default.
        family, style: from the name table; by default the file's name and "Regular".
        metrics: units per em, ascender and descender (the typographic ones if the font says so), at the location.
        glyph_names: all glyphs in glyph index order, made unique where the font repeats a name or has none.
        cmap: code point to glyph name, from the table that HarfBuzz reads; of a symbol font, from U+F000 on.
    """

    def __init__(self, path: Path, data: bytes, face_index: int, location: Location) -> None:
        """Open a face; names and characters of its glyphs, which take longest, are read when they are asked for."""
        if data[:4] not in FORMATS:
            raise FontError("not a TTF, OTF, TTC, WOFF or WOFF2 file")
        self.path, self.face_index, self.format, self._data = path, face_index, FORMATS[data[:4]], data
        self.num_faces = readTTCHeader(BytesIO(data)).numFonts if data[:4] == b"ttcf" else 1
        if self.num_faces > MOST_FACES:
            raise FontError(f"a collection of {self.num_faces} faces, more than the {MOST_FACES} allowed")
        if not 0 <= face_index < self.num_faces:
            raise FontError(f"no face {face_index}: the file has {self.num_faces}, counted from 0")
        self._plain = unpacked(data)
        self._tables = tables = TTFont(BytesIO(self._plain), fontNumber=face_index, lazy=True)
        missing = [tag for tag in REQUIRED_TABLES if tag not in tables]
        if missing:
            raise FontError(f"a broken font: no table {', '.join(missing)}")
        if not any(tag in tables for tag in OUTLINES):
            pictures = [tag.strip() for tag in PICTURES if tag in tables]
            what = f"only pictures ({', '.join(pictures)})" if pictures else "no table glyf, CFF or CFF2"
            raise FontError(f"has no outlines: {what}")
        self.outer = -1 if "glyf" in tables else 1
        names = hb.Face(hb.Blob(self._plain), face_index)
        self.family = printable(name_of(names, *FAMILY)) or path.stem
        self.style = printable(name_of(names, *STYLE)) or "Regular"
        if variations := tables.get("fvar"):
            if not all(isinstance(axis.axisTag, str) for axis in variations.axes):
                raise FontError("has an axis whose tag is not of ASCII characters")
            self.axes = tuple(
                DesignAxis(
                    a.axisTag, name_of(names, a.axisNameID) or a.axisTag,
                    min(a.minValue, a.defaultValue), a.defaultValue, max(a.maxValue, a.defaultValue),  # as HarfBuzz
                )
                for a in variations.axes
            )  # fmt: skip
            instances = [(name_of(names, instance.subfamilyNameID), instance) for instance in variations.instances]
            self.instances = {name: dict(instance.coordinates) for name, instance in instances if name}
        self.location = self.clamped(location)
        self.metrics = self._default_metrics = metrics_of(tables)
        self._face = Face(self._plain, face_index, self.location)
        self.shaper = self._face.font
        if self.location:
            extents = self.shaper.get_font_extents("ltr")
            self.metrics = replace(self.metrics, ascender=float(extents.ascender), descender=float(extents.descender))

    @cached_property
    def glyph_names(self) -> tuple[str, ...]:  # type: ignore[override]
        """All glyphs in glyph index order."""
        with opening(self.path):
            order = self._tables.getGlyphOrder()
            if not all(map(str.isprintable, order)):  # neither a UFO nor an SVG can have such names
                taken = set(order)
                order = [name if name.isprintable() else unused(f"glyph{k:05}", taken) for k, name in enumerate(order)]
                self._tables.setGlyphOrder(order)
            return tuple(order)

    @cached_property
    def cmap(self) -> Mapping[int, str]:  # type: ignore[override]
        """Code point to glyph name."""
        names, tables = self.gids, self._tables
        with opening(self.path):
            check_characters(tables.reader["cmap"] if "cmap" in tables else b"")
            return MappingProxyType({code: name for code, name in characters_of(tables).items() if name in names})

    @property
    def num_glyphs(self) -> int:
        """Number of glyphs."""
        return len(self.glyph_names)

    def __reduce__(self) -> tuple[Any, ...]:
        return open_font, (self.path, self.face_index, dict(self.location))

    def counts(self) -> tuple[int, int]:
        """The numbers of glyphs and of characters, without their names.

        Raises:
            FontError: the table of characters is cut short.
        """
        with opening(self.path):
            cmap = self._tables.reader["cmap"] if "cmap" in self._tables else bytes(4)
            tables = {struct.unpack_from(">HH", cmap, 4 + 8 * k) for k in range(struct.unpack_from(">H", cmap, 2)[0])}
        has_unicodes = tables & {SYMBOLS, *UNICODE_CMAPS}
        return self._face.face.glyph_count, len(self._face.face.unicodes) if has_unicodes else len(self.cmap)

    def _bytes(self) -> Iterable[bytes]:
        return (self._data,)

    def tables(self) -> TTFont:
        """A new copy of all tables, to be changed; those of a variable font are at the default and keep the axes."""
        return TTFont(BytesIO(self._plain), fontNumber=self.face_index, recalcTimestamp=False)

    def read(self, heads: Sequence[Head]) -> list[OutlineOrError]:
        """See :meth:`.Source.read`; names and characters of other glyphs are not needed."""
        return self._bulk.outlines(heads, self.metrics)

    def _masters(self, head: Head) -> Masters:
        return self._variations.masters(head) if self.axes else super()._masters(head)

    @cached_property
    def _variations(self) -> Any:
        return hooks.service("variations")(self.tables(), self.axes, self._default_metrics)

    @cached_property
    def _bulk(self) -> BulkReader:
        from .bulk import BulkReader  # imports the compiler, which opening and selecting do not need

        return BulkReader(self.path, self._face)


def name_of(face: hb.Face, *ids: int) -> str:
    """The first of some entries of the name table that a face has, in English or else in any language; "": it has none.

    HarfBuzz reads them, as importing fontTools' name table takes longer than opening a font.
    """
    for name_id in ids:
        languages = [entry.language for entry in face.list_names() if entry.name_id == name_id]
        if languages:
            return face.get_name(name_id, "en" if "en" in languages else languages[0]) or ""
    return ""


def printable(text: str) -> str:
    """A text without control characters, which XML cannot have."""
    return "".join(filter(str.isprintable, text))


def unused(name: str, taken: set[str]) -> str:
    """A name that no glyph has, added to those taken."""
    while name in taken:
        name += "_"
    taken.add(name)
    return name


def characters_of(tables: TTFont) -> Mapping[int, str]:
    """Code point to glyph name, from the table that HarfBuzz reads; that of the Macintosh has bytes for characters."""
    if "cmap" not in tables:
        return {}
    best = tables["cmap"].getBestCmap(cmapPreferences=(SYMBOLS, *UNICODE_CMAPS))
    if best is None and (mac := tables["cmap"].getcmap(*MAC_ROMAN)):
        best = {ord(bytes([byte]).decode("mac_roman")): name for byte, name in mac.cmap.items() if byte < 256}
    return best or {}


def check_characters(data: bytes) -> None:
    """Refuse a table of characters whose segments hold more code points than there are, some of them over and over.

    Raises:
        FontError: a subtable of the bytes ``data`` does. What is cut short is left to fontTools.
    """
    for at in range(8, len(data) - 3, 8)[: int.from_bytes(data[2:4], "big")]:
        with suppress(struct.error, ValueError):
            # Limit of code points in the segments of a table of characters: as many as there are. fontTools lists them
            # all.
            if _code_points(data, *struct.unpack_from(">L", data, at)) > 0x110000:
                raise FontError("a broken font: its table of characters has more code points than there are")


def _code_points(data: bytes, offset: int) -> int:
    """How many code points the segments of a subtable hold, each as often as it occurs."""
    kind = int.from_bytes(data[offset : offset + 2], "big")
    if kind in (12, 13):
        (count,) = struct.unpack_from(">L", data, offset + 12)
        first, last, _ = np.frombuffer(data, ">u4", 3 * count, offset + 16).reshape(-1, 3).T.astype(np.int64)
    elif kind == 4:
        count = int.from_bytes(data[offset + 6 : offset + 8], "big") // 2
        last, _, first = np.split(np.frombuffer(data, ">u2", 2 * count + 1, offset + 14), [count, count + 1])
    else:
        return 0
    return int((last.astype(np.int64) - first + 1).clip(0).sum())


def metrics_of(tables: TTFont) -> FontMetrics:
    """Units per em, ascender and descender; the typographic ones if the font says so."""
    units_per_em = tables["head"].unitsPerEm
    if units_per_em < 1:
        raise FontError(f"units per em cannot be {units_per_em}")
    ascender, descender = tables["hhea"].ascent, tables["hhea"].descent
    os2 = tables.get("OS/2")
    if os2 is not None and (os2.fsSelection & (1 << 7) or ascender == descender == 0):
        ascender, descender = os2.sTypoAscender, os2.sTypoDescender
    return FontMetrics(float(units_per_em), float(ascender), float(descender))


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
    (font,) = open_faces(path, face_index, location)
    _ = font.cmap  # and names: what is broken is an error here, not later
    return font


def open_faces(path: str | Path, face_index: int | None = None, location: Location = None) -> Iterator[Font]:
    """The faces of a font file, or the one that is asked for; names and characters of glyphs are not read yet.

    Raises:
        FontError: as in :func:`open_font`.
    """
    path = Path(path)
    with opening(path):
        data = path.read_bytes()
        yield (first := Font(path, data, face_index or 0, location))
        for index in range(1, first.num_faces if face_index is None else 0):
            yield Font(path, data, index, location)
