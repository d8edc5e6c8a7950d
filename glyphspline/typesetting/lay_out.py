"""A text laid out: cut into paragraphs, runs and lines, shaped, and put in place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..errors import require
from .setting import Align, Direction, Orientation, Setting

if TYPE_CHECKING:
    from ..readers import Source
    from .placed import Layout


def layout(
    font: Source,
    text: str,
    *,
    fallbacks: Sequence[Source] = (),
    features: str = "",
    script: str | None = None,
    language: str | None = None,
    direction: Direction | None = None,
    width: float | None = None,
    align: Align = "start",
    line_height: float | None = None,
    orientation: Orientation = "mixed",
) -> Layout:
    """Lay out a text: HarfBuzz shapes it, and lines are broken by the Unicode rules (UAX #14).

    Text of both directions is ordered by the bidirectional algorithm (UAX #9). A new line of the text begins a
    paragraph. A source without tables for shaping, such as a UFO, has a glyph for each character, with a note.

    Args:
        font: an opened font. text: up to a million characters; a tab is a space.
        fallbacks: fonts for what ``font`` lacks. A grapheme cluster is set in the first font that has all of it.
        features: as HarfBuzz writes them: "liga,-kern,ss01=2,smcp[0:5]", where a range counts characters of the text.
        script: of all text, by ISO 15924 ("Latn"); None: each character's own.
        language: a tag of BCP 47 ("de"), for forms that depend on it.
        direction: "ltr" or "rtl", of the paragraphs; None: of each paragraph's first letter. "ttb": lines are columns
            from top to bottom, the first at the right. "btt": columns from bottom to top, all characters upright.
        width: length of the lines, in units of the first font; None: only new lines of the text begin lines. Spaces at
            the end of a broken line are dropped. A word longer than the line is broken between grapheme clusters.
        align: of lines within ``width``, or the longest: "start", "center", "end", or "justify", which widens the
            spaces of all lines of a paragraph but the last.
        line_height: distance of baselines, in units of the first font; None: the font's own.
        orientation: of characters in columns: "mixed" turns those that are not written upright, such as Latin;
            "upright" turns none.

    Raises:
        OptionError: the text is empty, too long, or has control characters or halves of surrogate pairs; an argument
            has no such value; no font has a feature; or a vertical text in a source without tables for shaping.

    Example:
        >>> import glyphspline as gs
        >>> font = gs.open_font("fonts_test/kouzan-gyosho.ttf")
        >>> gs.layout(font, "龍好")
        <Layout '龍好': 2 glyphs, 1 line, 2048 by 1024 units>
    """
    from ..readers import Source
    from .lines import placed
    from .setting import check_text

    setting = Setting(features, script, language, direction, width, align, line_height, orientation)
    check_text(text)
    fonts = (font, *fallbacks)
    for each in fonts:
        require(isinstance(each, Source), "a font is a source that open_font or open_source returns", each)
    return placed(text, fonts, setting)
