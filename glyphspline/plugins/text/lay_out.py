"""A text laid out: cut into paragraphs, runs and lines, shaped, and put in place."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import chain
from math import pi
from unicodedata import category

import numpy as np

from ...errors import OptionError, require
from ...readers import Source
from ...readers.characters import END, Feature, HarfBuzzShaper, PlainShaper, Run, Shaped, Shaper, check_features
from ...readers.clusters import clusters, glyphs_of, is_selector
from ...types import FloatArray
from .paragraph import Line, Paragraph
from .placed import Layout
from .setting import Align, Direction, Orientation, Setting

LONGEST = 1_000_000
"""Characters of the longest text."""

PARAGRAPH = re.compile("\r\n|[\n\r\x85\u2028\u2029]")
"""What ends a line of the text."""

APART = tuple(Feature(tag, 0, 0, END) for tag in ("liga", "clig"))
"""Ligatures of which spaced letters are none."""

WIDENED = frozenset(" \t\u00a0\u3000")
"""Spaces that justified lines widen."""


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
    letter_spacing: float = 0.0,
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
        letter_spacing: added between grapheme clusters, in units of the first font; letters that join come apart, and
            optional ligatures are not made unless ``features`` ask for them.

    Raises:
        OptionError: the text is empty, too long, or has control characters or halves of surrogate pairs; an argument
            has no such value; no font has a feature; or a vertical text in a source without tables for shaping.

    Example:
        >>> import glyphspline as gs
        >>> font = gs.open_font("fonts_test/kouzan-gyosho.ttf")
        >>> gs.layout(font, "龍好")
        <Layout '龍好': 2 glyphs, 1 line, 2048 by 1024 units>
    """
    setting = Setting(features, script, language, direction, width, align, line_height, orientation, letter_spacing)
    check_text(text)
    fonts = (font, *fallbacks)
    for each in fonts:
        require(isinstance(each, Source), "a font is a source that open_font or open_source returns", each)
    shapers, notes = _shapers(fonts, setting)
    check_features(setting.parsed_features, [source.shaper.face for source in fonts if source.shaper is not None])
    lines: list[tuple[Paragraph, int, Line]] = []
    unvaried = _unvaried(text, fonts)
    missing: dict[str, None] = {}
    for start, stop in paragraphs(text):
        paragraph = Paragraph(text[start:stop], shapers, setting, start)
        missing |= dict.fromkeys(paragraph.missing)
        lines += [(paragraph, start, line) for line in paragraph.lines(setting.width)]
    lengths = [paragraph.length(line) for paragraph, _, line in lines]
    measure = max(lengths) if setting.width is None else max(setting.width, *lengths)
    ascender, descender, gap = _extents(font, setting)
    height = setting.line_height or ascender - descender + gap
    none = np.empty(0, dtype=np.int64)
    columns = [(none, none, none, none, np.empty((0, 2)), np.empty(0), np.empty(0))]
    for k, ((paragraph, start, line), length) in enumerate(zip(lines, lengths, strict=True)):
        for run, glyphs, origin, advance in _pieces(k, paragraph, line, measure - length, height, setting):
            n, angle = len(glyphs.gid), -pi / 2 if setting.vertical and not run.upright else 0.0
            fixed = np.full(n, run.font), glyphs.gid, glyphs.cluster + start, np.full(n, k)
            columns.append((*fixed, origin + 0.0, np.full(n, angle), advance))
    of_font, gid, cluster, number, origin, angles, advance = (np.concatenate(c) for c in zip(*columns, strict=True))
    below = (len(lines) - 1) * height
    box = (0.0, -below + descender, measure, ascender)
    if setting.vertical:
        box = (-below + descender, -measure, ascender, 0.0)
    scale = np.array([shaper.scale for shaper in shapers])[of_font]
    return Layout(
        text, fonts, of_font, gid, cluster, number, origin, angles, advance, box, tuple(missing), scale, tuple(notes),
        setting.vertical, letter_spacing=letter_spacing, unvaried=unvaried,
    )  # fmt: skip


def check_text(text: str) -> None:
    """Raise an OptionError for a text that cannot be laid out."""
    require(isinstance(text, str), "text is a string", text)
    require(bool(text), "text has at least one character", text)
    if len(text) > LONGEST:
        raise OptionError(f"text has {len(text):,} characters, more than {LONGEST:,}")
    for character in sorted(set(text)):
        kind = category(character)
        if kind == "Cs" or (kind == "Cc" and character != "\t" and not PARAGRAPH.fullmatch(character)):
            what = "half of a surrogate pair" if kind == "Cs" else "a control character"
            raise OptionError(f"text has {what}, U+{ord(character):04X}, as character {text.index(character)}")


def paragraphs(text: str) -> Sequence[tuple[int, int]]:
    """First and last (exclusive) character of each paragraph; what ends a paragraph is in none of them."""
    ends = [match.span() for match in PARAGRAPH.finditer(text)]
    if ends and ends[-1][1] == len(text):  # a file's last line ends too
        text = text[: ends.pop()[0]]
    starts = [0, *(stop for _, stop in ends)]
    stops = [*(start for start, _ in ends), len(text)]
    return list(zip(starts, stops, strict=True))


def _shapers(fonts: Sequence[Source], setting: Setting) -> tuple[list[Shaper], list[str]]:
    shapers: list[Shaper] = []
    notes = []
    features = (*(APART if setting.letter_spacing else ()), *setting.parsed_features)
    for source in fonts:
        scale = fonts[0].metrics.units_per_em / source.metrics.units_per_em
        if source.shaper is not None:
            shapers.append(HarfBuzzShaper(source, scale, setting.language, features))
            continue
        if setting.vertical or setting.features:
            what = "vertical text" if setting.vertical else "features"
            raise OptionError(f"{source.path}: {what} needs a font file: {source.format} has no tables for shaping")
        shapers.append(PlainShaper(source, scale))
        notes.append(f"{source.path.name} is not shaped: no kerning, ligatures or joined letters in {source.format}")
    return shapers, notes


def _unvaried(text: str, fonts: Sequence[Source]) -> tuple[str, ...]:
    """Bases with selectors of variations that no font has."""
    chosen = dict.fromkeys(clusters(text) if any(map(is_selector, text)) else ())
    found = [[glyphs_of(source, cluster).unvaried for source in fonts] for cluster in chosen]
    return tuple(dict.fromkeys(chain.from_iterable(of_first for of_first, *rest in found if of_first and all(rest))))


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
    number: int, paragraph: Paragraph, line: Line, room: float, height: float, setting: Setting
) -> Iterator[tuple[Run, Shaped, FloatArray, FloatArray]]:
    """The pieces of a line with the origins of their glyphs (n, 2), and their advances along the line (n,).

    Args:
        number: of the line. room: by how much it is shorter than all lines may be. height: distance of baselines.
    """
    along = np.array([0.0, -1.0]) if setting.vertical else np.array([1.0, 0.0])
    backward, text, extra = paragraph.base % 2, paragraph.text, 0.0
    before = {"center": 0.5, "end": 1.0 - backward}.get(setting.align, backward) * room
    if setting.align == "justify" and not line.last:
        spaces = sum(text[c] in WIDENED for _, glyphs in line.pieces for c in glyphs.cluster.tolist())
        extra, before = (room / spaces, 0.0) if spaces else (0.0, before)
    pen = along * before - ([number * height, 0.0] if setting.vertical else [0.0, number * height])
    for run, glyphs in line.pieces:
        advance = glyphs.advance
        if extra:
            advance = advance + np.outer([text[c] in WIDENED for c in glyphs.cluster.tolist()], along * extra)
        ends = pen + np.cumsum(advance, axis=0)
        yield run, glyphs, ends - advance + glyphs.offset, advance @ along
        pen = ends[-1] if len(ends) else pen
