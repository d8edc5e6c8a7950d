"""TrueType and OpenType fonts: TTF, OTF, TTC, WOFF, WOFF2 and variable fonts."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from functools import cached_property
from io import BytesIO
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from fontTools.ttLib import TTFont

from ...outlines.masters import Masters
from ..source import Head, OutlineOrError, Source, opening
from .containers import FORMATS, unpacked
from .face import Face, read_file
from .tables import Location, metrics_of

if TYPE_CHECKING:
    from .bulk import BulkReader
    from .variations import Variations


class Font(Face, Source):
    """One face of a font file at one location; made by :func:`open_font`.

    Attributes: those of :class:`.face.Face`, and
        glyph_names: all glyphs in glyph index order, made unique where the font repeats a name or has none.
        num_glyphs: number of glyphs.
        cmap: code point to glyph name, from the best Unicode table; empty if there is none.
    """

    def __init__(self, path: Path, data: bytes, face_index: int, num_faces: int, location: Location) -> None:
        self._plain = unpacked(data)
        super().__init__(path, FORMATS[data[:4]], self._plain, face_index, num_faces, location)
        self._data = data
        self.glyph_names = tuple(self._tables.getGlyphOrder())
        self.num_glyphs = len(self.glyph_names)
        mapped = (self._tables.getBestCmap() or {}).items()
        self.cmap = MappingProxyType({code: name for code, name in mapped if name in self._gids})

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

    def _masters(self, head: Head) -> Masters:
        return self._variations.masters(head) if self.axes else super()._masters(head)

    @cached_property
    def _variations(self) -> Variations:
        from .variations import Variations

        return Variations(self.tables(), metrics_of(self._tables))

    @cached_property
    def _bulk(self) -> BulkReader:
        from .bulk import BulkReader  # imports the compiler, which opening and selecting do not need

        return BulkReader(self.path, self.face_index, self.location, self._plain, self._hb)


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
        data, num_faces = read_file(path, face_index)
        return Font(path, data, face_index, num_faces, location)
