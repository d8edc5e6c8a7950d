"""What the rooms after this one rely on, whatever kind of file the outlines come from."""

# The properties are described in the class's docstring.
# ruff: noqa: D102

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Protocol

from ..outlines.outline import FontMetrics, Outline
from .selection import Request, Selection


class Source(Protocol):
    """A file of glyphs, opened: a font, a UFO, a folder of SVG drawings.

    A source is opened in each worker anew rather than sent to it, by what is kept here: ``path``,
    ``face_index`` and ``location``.

    Attributes:
        path: the file as it was named by the caller. sha256: of the bytes read, in hexadecimal.
        face_index: which font of a collection; 0 otherwise.
        location: where in the design space, axis tag to user-space value; empty at the default.
        family, style: names for people, never empty.
        metrics: units per em, ascender and descender.
        glyph_names: every glyph, unique, in glyph index order.
        cmap: code point to glyph name.
    """

    @property
    def path(self) -> Path: ...
    @property
    def sha256(self) -> str: ...
    @property
    def face_index(self) -> int: ...
    @property
    def location(self) -> Mapping[str, float]: ...
    @property
    def family(self) -> str: ...
    @property
    def style(self) -> str: ...
    @property
    def metrics(self) -> FontMetrics: ...
    @property
    def glyph_names(self) -> tuple[str, ...]: ...
    @property
    def cmap(self) -> Mapping[int, str]: ...

    def select(
        self,
        *,
        text: str | None = None,
        unicodes: Request | None = None,
        glyphs: str | Iterable[str] | None = None,
        gids: Request | None = None,
        all_glyphs: bool = False,
    ) -> Selection:
        """Names of the glyphs asked for, each once, in glyph index order; see :func:`.selection.select`."""
        ...

    def outline(self, name: str) -> Outline:
        """The glyph's outline.

        Raises:
            FontError: there is no glyph of that name.
            GlyphsplineError: the glyph is broken; the error names file and glyph.
        """
        ...
