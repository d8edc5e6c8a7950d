"""Lines one below the other, or columns from right to left: where each glyph stands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import count
from math import pi
from typing import NamedTuple

import numpy as np

from ..errors import OptionError
from ..readers import Source
from ..types import FloatArray, IntArray
from .features import check
from .paragraph import Line, Paragraph
from .placed import Layout
from .setting import Setting, paragraphs
from .shaping import HarfBuzzShaper, PlainShaper, Run, Shaped, Shaper

WIDENED = frozenset(" \t\u00a0\u3000")
"""Spaces that justified lines widen."""


def placed(text: str, fonts: tuple[Source, ...], setting: Setting) -> Layout:
    """A text as :func:`.lay_out.layout` returns it."""
    shapers, notes = _shapers(text, fonts, setting)
    check(setting.parsed_features, [source.shaper.face for source in fonts if source.shaper is not None])
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
    found = [
        piece
        for k, (paragraph, start, line), length in zip(count(), set_lines, lengths, strict=False)
        for piece in _pieces(k, paragraph, start, line, measure - length, height, setting)
    ]
    font = _whole([np.full(len(piece.glyphs.gid), piece.run.font) for piece in found])
    number = _whole([np.full(len(piece.glyphs.gid), piece.line) for piece in found])
    origin = np.concatenate([np.empty((0, 2)), *(piece.origin for piece in found)])
    turned = [setting.vertical and not piece.run.upright for piece in found]
    angle = np.repeat(np.array(turned, dtype=np.float64) * (-pi / 2), [len(piece.glyphs.gid) for piece in found])
    advance = np.concatenate([np.empty(0), *(piece.advance for piece in found)])
    scale = np.array([shaper.scale for shaper in shapers])[font]
    below = (len(set_lines) - 1) * height
    if setting.vertical:
        box = (-below + descender, -measure, ascender, 0.0)
    else:
        box = (0.0, -below + descender, measure, ascender)
    gid, cluster = _whole([piece.glyphs.gid for piece in found]), _whole([piece.cluster for piece in found])
    columns = font, gid, cluster, number, origin + 0.0, angle + 0.0, advance
    return Layout(text, fonts, *columns, box, tuple(missing), scale, tuple(notes))


class PlacedPiece(NamedTuple):
    """Glyphs of one run in a line, with what is said of them in :class:`Layout`."""

    run: Run
    glyphs: Shaped
    line: int
    cluster: IntArray
    origin: FloatArray
    advance: FloatArray


def _whole(parts: Sequence[IntArray]) -> IntArray:
    """Integers end to end."""
    return np.concatenate([np.empty(0, dtype=np.int64), *parts])


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


def _pieces(
    number: int, paragraph: Paragraph, start: int, line: Line, room: float, height: float, setting: Setting
) -> Iterator[PlacedPiece]:
    """The pieces of a line in place.

    Args:
        number: of the line. start: of the paragraph in the text. room: by how much the line is shorter than all lines
            may be. height: distance of baselines.
    """
    along = np.array([0.0, -1.0]) if setting.vertical else np.array([1.0, 0.0])
    backward, text, extra = paragraph.base % 2, paragraph.text, 0.0
    before = {"center": 0.5, "end": 1.0 - backward}.get(setting.align, backward) * room
    if setting.align == "justify" and not line.last:
        spaces = sum(text[c] in WIDENED for piece in line.pieces for c in piece.glyphs.cluster.tolist())
        extra, before = (room / spaces, 0.0) if spaces else (0.0, before)
    pen = along * before - ([number * height, 0.0] if setting.vertical else [0.0, number * height])
    for run, glyphs in line.pieces:
        advance = glyphs.advance
        if extra:
            advance = advance + np.outer([text[c] in WIDENED for c in glyphs.cluster.tolist()], along * extra)
        ends = pen + np.cumsum(advance, axis=0)
        origin = ends - advance + glyphs.offset
        pen = ends[-1] if len(ends) else pen
        yield PlacedPiece(run, glyphs, number, glyphs.cluster + start, origin, advance @ along)
