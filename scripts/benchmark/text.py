"""A page of text laid out, fitted and written as SVG, beside the same by uharfbuzz and fontTools' pens, in one run.

Times are of this process, from the opened font to the document, which is read: its outlines are counted. The least of
several rounds counts, as in :mod:`.batch`.
"""

from __future__ import annotations

from itertools import cycle, islice
from pathlib import Path
from time import perf_counter

import matplotlib

from .batch import FONT, least
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
    gs.to_svg(gs.layout(font, text[:500]).convert(gs.Options(corners="sharp")))  # nothing is compiled while it is timed
    sizes: list[int] = []

    def ours(_: int) -> float:
        start = perf_counter()
        placed = gs.layout(font, text, width=WIDTH * font.metrics.units_per_em)
        svg = gs.to_svg(placed.convert(gs.Options(corners="sharp")))
        seconds = perf_counter() - start
        sizes[:] = [svg.count("M"), len(svg)]
        return seconds

    def theirs(_: int) -> float:
        start = perf_counter()
        svg = by_pens(path, text)
        seconds = perf_counter() - start
        assert svg.count("M") > CHARACTERS / 2
        return seconds

    def lines(_: int) -> float:
        start = perf_counter()
        placed = gs.layout(font, text, width=WIDTH * font.metrics.units_per_em)
        seconds = perf_counter() - start
        assert len(placed) > CHARACTERS / 2
        return seconds

    own, pens, laid = least(ROUNDS, ours, theirs, lines)
    what = f"{CHARACTERS:,} characters of {path.name}"
    note = f"{sizes[0]:,} contours, {sizes[1] / 1e6:.1f} MB; by uharfbuzz and pens, unfitted: {in_words(pens)}"
    return [
        Row(f"page of {what}, fitted, as SVG", own, "s", 1.0, more=False, note=note),
        Row(f"layout alone of {what}", laid, "s", None, more=False),
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
