"""A piece of text becomes glyphs: by HarfBuzz, or character by character where a source has no tables for that."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import NamedTuple
from unicodedata import normalize

import numpy as np
import uharfbuzz as hb

from ..errors import GlyphsplineError
from ..readers import Source
from ..types import FloatArray, IntArray
from .setting import Feature, for_buffer

CONTEXT = 8
"""Characters before and after a run that HarfBuzz sees; it looks at five."""

SPACES = frozenset("\t\u00a0\u2000\u2001\u2002\u2003\u2004\u2005\u2006\u2007\u2008\u2009\u200a\u202f\u205f\u3000")
"""What HarfBuzz makes of the space where a font lacks it."""


class Run(NamedTuple):
    """Characters of a paragraph, ``start`` to ``stop``, that are shaped together.

    Attributes:
        font: which of the fonts. script: by ISO 15924. level: of embedding; odd where text runs from right to left.
        upright: in a vertical line: not turned.
    """

    start: int
    stop: int
    font: int
    script: str
    level: int
    upright: bool


class Shaped(NamedTuple):
    """n glyphs in visual order, in units of the first font's em, as on the page.

    Attributes:
        gid: (n,). cluster: (n,) number in the paragraph of the first character that a glyph stands for.
        advance: (n, 2) by which a glyph moves the pen. offset: (n, 2) of its origin from the pen.
    """

    gid: IntArray
    cluster: IntArray
    advance: FloatArray
    offset: FloatArray

    def spaced(self, step: FloatArray) -> Shaped:
        """With a step (2,) of the pen more behind each cluster; marks stay on their letters."""
        cluster = np.concatenate([[0], np.cumsum(np.diff(self.cluster) != 0)])[: len(self.cluster)]
        wide = self.advance.any(axis=1)
        last = np.full(len(cluster), -1)
        np.maximum.at(last, cluster[wide], np.flatnonzero(wide))
        last = last[cluster]  # of each glyph's cluster, the last one with an advance
        own = np.arange(len(cluster))
        advance = self.advance + (own == last)[:, None] * step
        return self._replace(advance=advance, offset=self.offset - ((own > last) & (last >= 0))[:, None] * step)


class Shaper(ABC):
    """A font that shapes text.

    Attributes:
        source: the font. scale: em of the first font per em of this.
    """

    def __init__(self, source: Source, scale: float) -> None:
        self.source, self.scale = source, scale

    @abstractmethod
    def shape(self, codes: Sequence[int], run: Run, direction: str, origin: int) -> Shaped:
        """Shape a run.

        Args:
            codes: of the paragraph, which begins at character ``origin`` of the text. run: what of it.
            direction: "ltr", "rtl", "ttb" or "btt".

        Returns:
            Glyphs along a horizontal line, or, for "ttb" and "btt", a vertical one.
        """

    @abstractmethod
    def has(self, cluster: str) -> bool:
        """Whether the font has glyphs for all of a grapheme cluster, or needs none."""

    def lacking(self, cluster: str) -> list[str]:
        """The characters of a grapheme cluster that have no glyph."""
        return [] if self.has(cluster) else [character for character in cluster if not self.has(character)]


class HarfBuzzShaper(Shaper):
    """A font file, shaped by HarfBuzz with its own font object at the font's location."""

    def __init__(self, source: Source, scale: float, language: str | None, features: Sequence[Feature]) -> None:
        super().__init__(source, scale)
        self._language, self._features = language, features
        self._buffer = hb.Buffer()

    def shape(self, codes: Sequence[int], run: Run, direction: str, origin: int) -> Shaped:
        """See :meth:`Shaper.shape`."""
        first, last = max(run.start - CONTEXT, 0), min(run.stop + CONTEXT, len(codes))
        buffer = self._buffer
        buffer.reset()
        buffer.add_codepoints(codes[first:last], run.start - first, run.stop - run.start)
        buffer.direction, buffer.script = direction, run.script
        if self._language:
            buffer.language = self._language
        flags = hb.BufferFlags.BOT if run.start == 0 else hb.BufferFlags.DEFAULT
        buffer.flags = flags | hb.BufferFlags.EOT if run.stop == len(codes) else flags
        try:
            hb.shape(self.source.shaper, buffer, for_buffer(self._features, origin + first))
        except MemoryError as error:
            raise GlyphsplineError(
                "HarfBuzz gives up on the text: its tables grow it beyond measure", font=str(self.source.path)
            ) from error
        infos = [(info.codepoint, info.cluster) for info in buffer.glyph_infos]
        numbers = np.array(infos, dtype=np.int64).reshape(-1, 2)
        positions = np.array([p.position for p in buffer.glyph_positions], dtype=np.float64).reshape(-1, 4) * self.scale
        return Shaped(numbers[:, 0], numbers[:, 1] + first, positions[:, 2:], positions[:, :2])

    def has(self, cluster: str) -> bool:
        """See :meth:`Shaper.has`. HarfBuzz knows other forms of a cluster, and what a font may lack."""
        if all(ord(character) in self.source.cmap for character in cluster):
            return True
        self._buffer.reset()
        self._buffer.add_str(cluster.replace("\t", " "))
        self._buffer.guess_segment_properties()
        hb.shape(self.source.shaper, self._buffer)
        return all(info.codepoint for info in self._buffer.glyph_infos)


class PlainShaper(Shaper):
    """A source without tables for shaping, such as a UFO: a glyph a character, one after the other.

    Args:
        text: all that is going to be shaped.
    """

    def __init__(self, source: Source, scale: float, text: str) -> None:
        super().__init__(source, scale)
        gids = sorted({self._glyph(ord(character)) for character in text} - {-1})
        outlines = source.outlines(gids, errors="return")
        self._advances = {gid: getattr(outline, "advance", 0.0) for gid, outline in zip(gids, outlines, strict=True)}

    def shape(self, codes: Sequence[int], run: Run, direction: str, origin: int) -> Shaped:
        """See :meth:`Shaper.shape`."""
        found = [(i, gid) for i in range(run.start, run.stop) if (gid := self._glyph(codes[i])) >= 0]
        glyphs = np.array(found if direction == "ltr" else found[::-1], dtype=np.int64).reshape(-1, 2)
        cluster, glyph = glyphs[:, 0], glyphs[:, 1]
        advance, offset = np.zeros((2, len(glyph), 2))
        advance[:, 0] = [self._advances[number] * self.scale for number in glyph.tolist()]
        return Shaped(glyph, cluster, advance, offset)

    def _glyph(self, code: int) -> int:
        return self.source.gids.get(self._name(code) or ".notdef", -1)

    def _name(self, code: int) -> str | None:
        return self.source.cmap.get(code) or (self.source.cmap.get(0x20) if chr(code) in SPACES else None)

    def has(self, cluster: str) -> bool:
        """See :meth:`Shaper.has`; as it is, composed or decomposed."""
        forms = (cluster, normalize("NFC", cluster), normalize("NFD", cluster))
        return any(all(self._name(ord(character)) for character in form) for form in forms)
