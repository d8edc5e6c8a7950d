"""Lines one below the other, or columns from right to left: where each glyph stands."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count
from math import pi

import numpy as np

from ..errors import OptionError
from ..readers import Source
from ..types import FloatArray
from .features import check
from .paragraph import Line, Paragraph
from .placed import Layout
from .setting import Setting, paragraphs
from .shaping import HarfBuzzShaper, PlainShaper, Shaper

WIDENED = frozenset(" \t\u00a0\u3000")
"""Spaces that justified lines widen."""


def placed(text: str, fonts: tuple[Source, ...], setting: Setting) -> Layout:
    """A text as :func:`.lay_out.layout` returns it."""
    check(setting.parsed_features, [source.shaper.face for source in fonts if source.shaper is not None])
    shapers, notes = _shapers(text, fonts, setting)
    set_lines: list[tuple[Paragraph, int, Line]] = []
    missing: dict[str, None] = {}
    for start, stop in paragraphs(text):
        paragraph = Paragraph(text[start:stop], shapers, setting, start)
        missing |= dict.fromkeys(paragraph.missing)
        set_lines += [(paragraph, start, line) for line in paragraph.lines(setting.width)]
    lengths = [paragraph.length(line) for paragraph, _, line in set_lines]
    measure = max(lengths) if setting.width is None else max(setting.width, *lengths)
    ascender, descender, gap = _extents(fonts[0], setting)
    height = setting.line_height or ascender - descender + gap
    columns: list[tuple[FloatArray, ...]] = []
    for k, (paragraph, start, line), length in zip(count(), set_lines, lengths, strict=False):
        columns += _columns(k, paragraph, start, line, length, measure, height, shapers, setting)
    empty = (
        np.empty(0),
        np.empty(0),
        np.empty(0),
        np.empty(0),
        np.empty((0, 2)),
        np.empty(0),
        np.empty(0),
        np.empty(0),
    )
    font, gid, cluster, number, origin, angle, advance, scale = (
        np.concatenate(column) for column in zip(*(columns or [empty]), strict=True)
    )
    below = (len(set_lines) - 1) * height
    if setting.vertical:
        box = (-below + descender, -measure, ascender, 0.0)
    else:
        box = (0.0, -below + descender, measure, ascender)
    whole = (column.astype(np.int64) for column in (font, gid, cluster, number))
    return Layout(text, fonts, *whole, origin + 0.0, angle, advance, box, tuple(missing), scale, tuple(notes))


def _shapers(text: str, fonts: Sequence[Source], setting: Setting) -> tuple[list[Shaper], list[str]]:
    shapers: list[Shaper] = []
    notes = []
    for source in fonts:
        scale = fonts[0].metrics.units_per_em / source.metrics.units_per_em
        if source.shaper is not None:
            shapers.append(HarfBuzzShaper(source, scale, setting.language, setting.parsed_features))
            continue
        if setting.vertical or setting.features:
            what = "vertical text" if setting.vertical else "features"
            raise OptionError(f"{source.path}: {what} needs a font file: {source.format} has no tables for shaping")
        plain = PlainShaper(source, scale)
        plain.prepare(text)
        shapers.append(plain)
        notes.append(f"{source.path.name} is not shaped: no kerning, ligatures or joined letters in {source.format}")
    return shapers, notes


def _extents(font: Source, setting: Setting) -> tuple[float, float, float]:
    """Ascender, descender and line gap of lines; of columns, to the right and left of their centre."""
    ascender, descender, gap = font.metrics.ascender, font.metrics.descender, 0.0
    if font.shaper is not None:
        found = font.shaper.get_font_extents(setting.direction if setting.vertical else "ltr")
        gap = float(found.line_gap)
        if setting.vertical:
            ascender, descender = float(found.ascender), float(found.descender)
    return ascender, descender, gap


def _columns(
    number: int,
    paragraph: Paragraph,
    start: int,
    line: Line,
    length: float,
    measure: float,
    height: float,
    shapers: Sequence[Shaper],
    setting: Setting,
) -> list[tuple[FloatArray, ...]]:
    """The columns of :class:`Layout` for the pieces of a line: font, glyph, cluster, line, origin, angle, advance, scale."""
    along = np.array([0.0, -1.0]) if setting.vertical else np.array([1.0, 0.0])
    align = "end" if paragraph.base % 2 and setting.align in ("start", "justify") else setting.align
    align = "start" if paragraph.base % 2 and setting.align == "end" else align
    room, extra = measure - length, 0.0
    if setting.align == "justify" and not line.last:
        text = paragraph.text
        spaces = sum(text[c] in WIDENED for piece in line.pieces for c in piece.glyphs.cluster.tolist())
        extra = room / spaces if spaces else 0.0
        room = 0.0 if spaces else room
    pen = along * {"center": room / 2, "end": room}.get(align, 0.0)
    pen += [-number * height, 0.0] if setting.vertical else [0.0, -number * height]
    found = []
    for piece in line.pieces:
        glyphs, run = piece.glyphs, piece.run
        advance = glyphs.advance
        if extra:
            widened = [paragraph.text[c] in WIDENED for c in glyphs.cluster.tolist()]
            advance = advance + np.outer(widened, along * extra)
        ends = pen + np.cumsum(advance, axis=0)
        n = len(glyphs.gid)
        angle = -pi / 2 if setting.vertical and not run.upright else 0.0
        origin = ends - advance + glyphs.offset
        pen = ends[-1] if n else pen
        same = (np.full(n, run.font), np.full(n, number), np.full(n, angle), np.full(n, shapers[run.font].scale))
        found.append((same[0], glyphs.gid, glyphs.cluster + start, same[1], origin, same[2], advance @ along, same[3]))
    return found
