"""Glyphs files and packages: glyphsLib turns one into a designspace with its UFOs, and applies corner components."""

from __future__ import annotations

import re
import tempfile
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from ...errors import FontError
from ...extras import need
from ...readers.open import UTF8, Reader
from ...readers.source import Location
from ...readers.ufo import folder_bytes
from .designspace import Designspace

HINTS_KEY, ORDER_KEY = "com.schriftgestaltung.hints", "com.schriftgestaltung.fontMasterOrder"
APPLIED, UNAPPLIED = "CORNER", {"CAP": "cap components", "SEGMENT": "segment components", "BRUSH": "brush components"}
"""Parts that Glyphs stores as hints: those that glyphsLib applies, and what the others are called."""


class GlyphsFile(Designspace):
    """A Glyphs file at one location, which needs the extra ``sources``.

    Its UFOs are in a folder among the temporary files, which lasts as long as the source.
    """

    format, kind = "Glyphs", "Glyphs file"

    def __init__(self, path: Path, location: Location = None) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="glyphspline-")
        made = need("sources").build_masters(
            path, self._folder.name, minimal=True, write_skipexportglyphs=True, designspace_path=None
        )
        parts = _parts(made.ufos.values())
        if corners := {name for name, kinds in parts.items() if APPLIED in kinds}:
            _apply_corners(made.ufos, Path(self._folder.name))
        self.others = dict.fromkeys(corners, "has corner components, which are applied in the outline")
        self._unread = {name: tuple(UNAPPLIED[kind] for kind in UNAPPLIED if kind in parts[name]) for name in parts}
        super().__init__(path, location, Path(made.designspace_path))

    def _bytes(self) -> Iterable[bytes]:
        return folder_bytes(self.path) if self.path.is_dir() else (self.path.read_bytes(),)

    def master_ids(self, ids: Sequence[str]) -> dict[Path, str]:
        """The id of the master that each UFO was made of; ``ids`` are those of the file, in its order."""
        return {ufo.path: ids[ufo.lib.get(ORDER_KEY, 0)] for ufo in self._ufos}

    def text_edit(self, layer: str | None) -> Any:
        """See :meth:`.EditableSource.text_edit`."""
        from .glyphs_edit import GlyphsEdit

        if self.path.is_dir():
            raise FontError("a Glyphs package takes no outlines back: save it as a file", font=str(self.path))
        return GlyphsEdit(self.path, self.master_ids, layer)


def is_glyphs(head: bytes) -> bool:
    """Whether a file that begins so is a Glyphs file: a property list in braces."""
    return re.match(rb'\s*\{\s*"?\.?\w+"?\s*=', head.removeprefix(UTF8)) is not None


def _parts(ufos: Iterable[Any]) -> Mapping[str, set[str]]:
    """The kinds of hints that each glyph has in any layer."""
    found = defaultdict[str, set[str]](set)
    for glyph in (glyph for ufo in ufos for layer in ufo.layers for glyph in layer if HINTS_KEY in glyph.lib):
        found[glyph.name].update(str(hint.get("type")).upper() for hint in glyph.lib[HINTS_KEY])
    return found


def _apply_corners(ufos: Mapping[str, Any], folder: Path) -> None:
    """Apply the corner components of all layers, and write the UFOs again."""
    from glyphsLib.filters.cornerComponents import CornerComponentsFilter

    for name, ufo in ufos.items():
        for layer in ufo.layers:
            CornerComponentsFilter()(ufo, {glyph.name: glyph for glyph in layer})
        ufo.save(folder / name, overwrite=True)


def is_package(path: Path) -> bool:
    """Whether a folder is a Glyphs package, which has the file's glyphs in files of their own."""
    return (path / "order.plist").is_file() and (path / "glyphs").is_dir()


READER = Reader(lambda path, head: is_glyphs(head) or is_package(path), GlyphsFile.opened, has_axes=True)
