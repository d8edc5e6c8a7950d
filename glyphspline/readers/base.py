"""What all sources do alike, once they know their glyph names and code points."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path

from ..errors import FontError, GlyphsplineError
from .selection import Request, Selection, select


class NamedGlyphs:
    """Glyphs in order, by name and by code point; the base of every :class:`.source.Source`."""

    path: Path
    glyph_names: tuple[str, ...]
    cmap: Mapping[int, str]

    @cached_property
    def _gids(self) -> dict[str, int]:
        return {name: gid for gid, name in enumerate(self.glyph_names)}

    @cached_property
    def _unicodes(self) -> dict[str, tuple[int, ...]]:
        codes = defaultdict(list)
        for code in sorted(self.cmap):
            codes[self.cmap[code]].append(code)
        return {name: tuple(of_name) for name, of_name in codes.items()}

    def _gid(self, name: str) -> int:
        if name not in self._gids:
            raise FontError("the font has no such glyph", font=str(self.path), glyph=name)
        return self._gids[name]

    @contextmanager
    def _drawing(self, name: str) -> Iterator[None]:
        """Whatever goes wrong within while a glyph is drawn is a GlyphsplineError that names font and glyph."""
        try:
            yield
        except GlyphsplineError as error:
            error.locate(font=str(self.path), glyph=name)
            raise
        except Exception as error:  # broken data shows as any of a dozen types, AssertionError among them
            message = f"cannot be drawn: {reason(error)}"
            raise GlyphsplineError(message, font=str(self.path), glyph=name) from error

    def select(
        self,
        *,
        text: str | None = None,
        unicodes: Request | None = None,
        glyphs: str | Iterable[str] | None = None,
        gids: Request | None = None,
        all_glyphs: bool = False,
    ) -> Selection:
        """Names of the glyphs asked for, unique, in glyph index order; see :func:`.selection.select`.

        Returns:
            A tuple of names whose ``missing`` says what was asked for and is not in the font.

        Raises:
            FontError: nothing was asked for, or a string is no list of numbers.
        """
        try:
            return select(
                self.glyph_names,
                self.cmap,
                text=text,
                unicodes=unicodes,
                glyphs=glyphs,
                gids=gids,
                all_glyphs=all_glyphs,
            )
        except GlyphsplineError as error:
            raise FontError(error.message, font=str(self.path)) from error


def reason(error: Exception) -> str:
    """What a library's exception says, or failing words what it is."""
    if isinstance(error, RecursionError):
        return "components or subroutines nested without end"
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
