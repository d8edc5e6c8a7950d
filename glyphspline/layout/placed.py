"""A text laid out: which glyphs stand where, and their results and outlines put there."""

from __future__ import annotations

from dataclasses import dataclass

from ..readers import Source
from ..types import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Layout:
    """A text laid out: n glyphs in visual order, line by line. Lengths are in font units of the first font, y is up.

    Attributes:
        text: what is laid out. fonts: the first, and those that stand in for glyphs it lacks.
        font: (n,) which of the fonts a glyph is of. gid: (n,) its index in that font.
        cluster: (n,) number of the first character of the text that the glyph stands for.
        line: (n,) which line it is on.
        origin: (n, 2) where its origin lies; the first baseline is at y = 0 and begins at x = 0.
        angle: (n,) radians by which it is turned about its origin, counter-clockwise.
        advance: (n,) length of the line that it takes.
        box: left, bottom, right, top of the lines' boxes, from descender to ascender.
        missing: characters that no font has, each once, in the order of the text.
    """

    text: str
    fonts: tuple[Source, ...]
    font: IntArray
    gid: IntArray
    cluster: IntArray
    line: IntArray
    origin: FloatArray
    angle: FloatArray
    advance: FloatArray
    box: tuple[float, float, float, float]
    missing: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.gid)
