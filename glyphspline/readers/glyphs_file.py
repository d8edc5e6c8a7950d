"""Glyphs files, which glyphsLib turns into a designspace with its UFOs."""

from __future__ import annotations

import hashlib
import tempfile
from functools import cached_property
from pathlib import Path
from typing import Any

from ..extras import need
from .designspace import Designspace
from .opentype.tables import Location
from .source import opening


class GlyphsFile(Designspace):
    """A Glyphs file at one location; made by :func:`open_glyphs`.

    Its UFOs are in a folder among the temporary files, which lasts as long as the source.
    """

    format = "Glyphs"

    def __init__(self, path: Path, location: Location) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="glyphspline-")
        made = need("sources").build_masters(
            path, self._folder.name, minimal=True, write_skipexportglyphs=True, designspace_path=None
        )
        super().__init__(path, location, Path(made.designspace_path))

    def __reduce__(self) -> tuple[Any, ...]:
        return open_glyphs, (self.path, dict(self.location))

    @cached_property
    def sha256(self) -> str:
        """Hash of the file's bytes, in hexadecimal."""
        return hashlib.sha256(self.path.read_bytes()).hexdigest()


def open_glyphs(path: str | Path, location: Location = None) -> GlyphsFile:
    """Open a Glyphs file; this needs the extra ``sources``.

    Args:
        path: the file. location: as in :func:`.opentype.font.open_font`.

    Raises:
        FontError: the file cannot be read, or has no such axis or instance.
        GlyphsplineError: the extra is not installed.
    """
    path = Path(path)
    need("sources")
    with opening(path, "Glyphs file"):
        return GlyphsFile(path, location)
