"""Single fonts of a family, read together: the outlines of a glyph, matched, are masters of a design space."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from ...errors import FontError, GlyphsplineError
from ...outlines.masters import DesignAxis, Masters
from ...outlines.outline import Outline
from ...readers.source import Source
from .matching.match import match_masters

NAMES = {"wght": "Weight", "wdth": "Width", "opsz": "Optical Size", "slnt": "Slant", "ital": "Italic"}
"""Names of the registered axes."""


@dataclass(frozen=True)
class Unmatched:
    """A glyph that is not in all fonts, or whose outlines cannot be matched.

    Attributes:
        name: in the default font. error: the reason.
    """

    name: str
    error: GlyphsplineError


def axis_of(words: str, count: int) -> tuple[DesignAxis, list[float]]:
    """An axis and the fonts' values on it from "wght=300:700"; the first is the default's.

    Raises:
        FontError: the words are no such axis, or not one for ``count`` fonts.
    """
    tag, _, rest = words.partition("=")
    try:
        values = [float(part) for part in rest.split(":")]
    except ValueError:
        values = []
    if len(tag) != 4 or not tag.isascii() or len(values) < 2:
        raise FontError(f"an axis is like wght=300:700, a value a font, not {words!r}")
    if len(values) != count or len(set(values)) != count:
        raise FontError(f"{count} fonts have {count} different values on an axis, unlike {words!r}")
    return DesignAxis(tag, NAMES.get(tag, tag), min(values), values[0], max(values)), values


def masters_of_fonts(
    sources: Sequence[Source], axis: str, glyphs: Iterable[str] | None = None
) -> Iterator[Masters | Unmatched]:
    """The glyphs of single fonts, matched, one after the other.

    A glyph's partner in another font has its name, or else one of its code points.

    Args:
        sources: fonts, UFOs or drawings, the default first; of at least two. axis: like "wght=300:700", a value a font.
        glyphs: names in the default; None for all of them.

    Yields:
        Masters for each glyph, in the order asked for, and an :class:`Unmatched` in place of each that has none.

    Raises:
        FontError: the axis is none for these fonts.
    """
    design, values = axis_of(axis, len(sources))
    default = sources[0]
    for name in default.glyph_names if glyphs is None else glyphs:
        try:
            first = default.outline(name)
            others = [source.outline(_partner(first, source)) for source in sources[1:]]
            found: Masters | Unmatched = match_masters([first, *others], values, design)
        except GlyphsplineError as error:
            found = Unmatched(name, error.locate(glyph=name))
        yield found


def _partner(outline: Outline, source: Source) -> str:
    """The name of a glyph in another font."""
    if outline.name in source.glyph_names:
        return outline.name
    for code in outline.unicodes:
        if code in source.cmap:
            return source.cmap[code]
    codes = "".join([f" or U+{code:04X}" for code in outline.unicodes])
    raise FontError(f"there is no glyph {outline.name!r}{codes}", font=str(source.path), glyph=outline.name)
