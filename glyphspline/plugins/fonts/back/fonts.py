"""Points moved in a TTF or OTF, static or variable: the glyphs' own records change, and nothing else in the font.

Flags, instructions, hints and all other points stay. Bounds follow, and left side bearings where a glyph's left edge
moved.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from fontTools.ttLib.tables._g_l_y_f import Glyph
from fontTools.ttLib.tables.DefaultTable import DefaultTable

from ....errors import OutputError
from ....files import write_whole
from ....outlines.masters import Masters
from ....readers import Font
from ..tables.font_file import drop_signature, saved, stored_names
from ..tables.variable_glyf import Gvar, placed_by_points, put_glyphs
from .char_strings import CharStringContours, char_strings
from .glyf_contours import GlyfContours
from .programs import share
from .stored import StoredContours

OUTLINES = ("glyf", "loca", "gvar", "CFF ", "CFF2")
BOUNDS = ("head", "hmtx", "vmtx", "hhea", "vhea", "maxp")
"""Tables that hold outlines, and those that follow where bounds change."""


def editable(source: Font) -> None:
    """Raise an OutputError if the points of a font cannot be moved."""
    if source.num_faces > 1:
        raise OutputError("is one of a collection of fonts, which are not mended", font=str(source.path))


@lru_cache(maxsize=1)
def edit_of(source: Font) -> FontEdit:
    """The edit of a font, opened once in a process."""
    return FontEdit(source)


class FontEdit:
    """A font whose points are moved, glyph by glyph.

    Raises:
        OutputError: it is one of a collection.
    """

    def __init__(self, source: Font) -> None:
        editable(source)
        self.source = source
        self.font = font = source.tables()
        font.recalcBBoxes = False
        self._names = stored_names(source, font)
        self._new: dict[str, Glyph] = {}
        self._strings: list[Any] = []
        if "glyf" in font:
            self._gvar = Gvar(font) if "gvar" in font else None
            self._counted = placed_by_points(font)

    def stored(self, glyph: Masters) -> StoredContours:
        """The contours of a glyph, as it was read, in the font."""
        name, font = self._names[glyph.name], self.font
        if "glyf" not in font:
            return CharStringContours(font, name, glyph)
        record = font["glyf"][name]
        if record.isComposite() or not record.numberOfContours:
            return StoredContours()
        found = GlyfContours(font, name, glyph, self._gvar)
        if name in self._counted:
            why = f"has points by which {self._counted[name]} is composed"
            found.why = dict.fromkeys(range(len(glyph.contours)), why)
        return found

    def components(self) -> dict[str, set[str]]:
        """The names of the components that each composite has itself."""
        if "glyf" not in self.font:
            return {}
        glyf, names = self.font["glyf"], {stored: name for name, stored in self._names.items()}
        return {
            names[name]: {names[part] for part in glyf[name].getComponentNames(glyf) if part in names}
            for name in self.font.getGlyphOrder()
            if glyf.glyphs[name].isComposite()
        }

    def put(self, old: Masters, new: Masters) -> None:
        """Put a glyph in, with other points than it was read with."""
        self.stored(old).put(new)
        name, font = self._names[old.name], self.font
        if "glyf" in font:
            self._new[name] = font["glyf"][name]
        else:
            self._strings.append(char_strings(font)[name])

    def written(self) -> bytes:
        """The font as a file's bytes; tables that hold no outlines are as they were."""
        font, source = self.font, self.source
        is_glyf = "glyf" in font
        follows = put_glyphs(font, self._new) if is_glyf else False
        if is_glyf and self._gvar is not None:
            self._gvar.store(font)
        share(self._strings)
        drop_signature(font)
        for tag in font.reader.keys() if font.reader else ():
            if tag in font.tables and tag not in OUTLINES and not (tag == "head" or (follows and tag in BOUNDS)):
                raw = DefaultTable(tag)
                raw.data = font.reader[tag]
                font.tables[tag] = raw
        font.flavor = {"WOFF": "woff", "WOFF2": "woff2"}.get(source.format)
        return saved(font)


def write_points(
    source: Font, glyphs: Sequence[tuple[Masters, Masters]], *, copy: Path | None = None, dry: bool = False
) -> list[str]:
    """Write glyphs of which points moved, as they were and as they are, into a font or a copy of it.

    Args:
        copy: the file of the copy; None writes into the font itself. dry: write nothing.

    Returns:
        The names of glyphs that changed.

    Raises:
        OutputError: the font is one of a collection. OSError: it cannot be written.
    """
    editable(source)
    if not dry and (glyphs or copy is not None):
        edit = FontEdit(source)
        for old, new in glyphs:
            edit.put(old, new)
        write_whole(str(copy or source.path), edit.written(), durable=True)
    return [new.name for _, new in glyphs]
