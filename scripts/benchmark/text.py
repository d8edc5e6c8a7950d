"""A page of text laid out, fitted and written as SVG, beside the same by uharfbuzz and fontTools' pens, in one run.

Times are of this process, from the opened font to the document. The least of several rounds counts, as in
:mod:`.batch`.
"""

from __future__ import annotations

from itertools import cycle, islice
from pathlib import Path

import matplotlib

from .batch import FONT, least, seconds
from .measure import Row, in_words

LATIN = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSerif.ttf"
WORDS = "The quick brown fox jumps over the lazy dog. Sphinx of black quartz, judge my vow! (0123456789) "
HAN = "天地玄黄宇宙洪荒日月盈昃辰宿列張寒來暑往秋收冬藏閏餘成歳律呂調陽，雲騰致雨露結爲霜。"
CHARACTERS = 10_000
WIDTH = 60.0
"""Length of the lines in em."""

ROUNDS = 3


def rows() -> list[Row]:
    """The table of what a page costs."""
    found = []
    for path, words in ((LATIN, WORDS), (FONT, HAN)):
        if path.exists():
            found += page(path, "".join(islice(cycle(words), CHARACTERS)))
    return found


def page(path: Path, text: str) -> list[Row]:
    """Seconds of a page: with all steps, and laid out only."""
    import glyphspline as gs

    font = gs.open_font(path)

    def laid() -> gs.Layout:
        return gs.layout(font, text, width=WIDTH * font.metrics.units_per_em)

    def drawn() -> str:
        return gs.to_svg(laid().convert(gs.Options(corners="sharp")))

    svg, plain = drawn(), by_pens(path, text)  # nothing is compiled while it is timed
    assert min(plain.count("M"), len(laid())) > CHARACTERS / 2
    own, pens, lines = least(ROUNDS, seconds(drawn), seconds(lambda: by_pens(path, text)), seconds(laid))
    what = f"{CHARACTERS:,} characters of {path.name}"
    note = f"{svg.count('M'):,} contours, {len(svg) / 1e6:.1f} MB; by uharfbuzz and pens, unfitted: {in_words(pens)}"
    return [
        Row(f"page of {what}, fitted, as SVG", own, "s", 1.0, more=False, note=note),
        Row(f"layout alone of {what}", lines, "s", None, more=False),
    ]


def by_pens(path: Path, text: str) -> str:
    """The text on one line as path data, as it is written by hand: HarfBuzz shapes it, pens draw each glyph."""
    import uharfbuzz as hb
    from fontTools.pens.svgPathPen import SVGPathPen
    from fontTools.pens.transformPen import TransformPen
    from fontTools.ttLib import TTFont

    face = hb.Face(hb.Blob.from_file_path(str(path)))
    font = TTFont(path, fontNumber=0, lazy=True)
    glyphs, order = font.getGlyphSet(), font.getGlyphOrder()
    buffer = hb.Buffer()
    buffer.add_str(text)
    buffer.guess_segment_properties()
    hb.shape(hb.Font(face), buffer)
    x, pen = 0, SVGPathPen(glyphs)
    for info, place in zip(buffer.glyph_infos, buffer.glyph_positions, strict=True):
        glyphs[order[info.codepoint]].draw(TransformPen(pen, (1, 0, 0, -1, x + place.x_offset, -place.y_offset)))
        x += place.x_advance
    return str(pen.getCommands())
