"""A paragraph: cut into runs, shaped, and cut into lines."""

from __future__ import annotations

from bisect import bisect, bisect_left
from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import groupby, pairwise
from typing import NamedTuple

import numpy as np

from ...extras import need
from ...outlines.contour_arrays import offsets_of
from ...readers.characters import Run, Shaped, Shaper
from ...types import BoolArray, FloatArray, IntArray
from .bidi import embedding_levels, visual_order
from .scripts import scripts_of, upright_in_columns
from .setting import Setting

HANGING = frozenset(" \t\u1680\u2000\u2001\u2002\u2003\u2004\u2005\u2006\u2008\u2009\u200a\u200b\u205f\u3000")
"""Spaces that a line broken at ``width`` leaves out at its end."""

LONGEST_RUN = 20_000
"""Characters that are shaped at once. HarfBuzz gives up on longer texts: the more lookups a font has, the sooner."""

SOFT_HYPHEN, HYPHENS = "\u00ad", "\u2010-"
"""A line that ends after the first shows the first of the others that its font has."""


class Line(NamedTuple):
    """A line of a paragraph: its runs and their glyphs, in visual order, and whether it is the last one."""

    pieces: tuple[tuple[Run, Shaped], ...]
    last: bool


class Paragraph:
    """A paragraph of a text.

    Attributes:
        text: its characters. base: its level.
        missing: characters without a glyph.
    """

    def __init__(self, text: str, shapers: Sequence[Shaper], setting: Setting, origin: int) -> None:
        self.text, self._shapers, self._setting, self._origin = text, shapers, setting, origin
        self.codes = np.frombuffer(text.encode("utf-32-le"), dtype=np.uint32).tolist()
        if "\t" in text:
            self.codes = [0x20 if code == 9 else code for code in self.codes]
        self.missing: list[str] = []
        self.runs = self._runs()
        self._starts = [run.start for run in self.runs]
        self.shaped = [self._shape(self.codes, run) for run in self.runs]

    def lines(self, width: float | None) -> Iterator[Line]:
        """The lines: one, or as many as are needed for lines of that width."""
        if width is None or not self.text:
            yield self._line(0, len(self.text), True)
            return
        at = 0
        while at < len(self.text):
            line, at = self._fitting(at, width)
            yield line

    def _runs(self) -> list[Run]:
        text, setting = self.text, self._setting
        base = {"ltr": 0, "rtl": 1}.get(setting.direction or "")
        if setting.stacked:
            self.base = int(setting.direction == "btt")
            levels, upright = [self.base] * len(text), [True] * len(text)
        else:
            self.base, levels = embedding_levels(text, 0 if setting.vertical and base is None else base)
            upright = upright_in_columns(text, self._clusters.tolist()) if setting.vertical else [False] * len(text)
        scripts = [setting.script] * len(text) if setting.script else scripts_of(text)
        runs, start = [], 0
        for traits, those in groupby(zip(self._fonts(), scripts, levels, upright, strict=True)):
            stop = start + len(list(those))
            runs += [Run(a, b, *traits) for a, b in self._cut(start, stop)]
            start = stop
        return runs

    def _cut(self, start: int, stop: int) -> Iterator[tuple[int, int]]:
        """A run in parts that HarfBuzz has memory for, after a space if there is one, or between grapheme clusters."""
        while stop - start > LONGEST_RUN:
            cut = self.text.rfind(" ", start + LONGEST_RUN // 2, start + LONGEST_RUN) + 1
            cut = cut or int(self._clusters[np.searchsorted(self._clusters, start + LONGEST_RUN, side="right") - 1])
            cut = cut if cut > start else start + LONGEST_RUN  # a cluster longer than that
            yield start, cut
            start = cut
        yield start, stop

    def _fonts(self) -> list[int]:
        """Which font each character is of: by grapheme cluster, the first that has all of it, or has its beginning."""
        shapers, text = self._shapers, self.text
        if all(shapers[0].has(character) for character in set(text)):
            return [0] * len(text)
        found, known = [0] * len(text), dict[str, int]()
        for a, b in pairwise(self._clusters.tolist()):
            cluster = text[a:b]
            if cluster not in known:
                whole = (k for k, shaper in enumerate(shapers) if shaper.has(cluster))
                begun = (k for k, shaper in enumerate(shapers) if shaper.has(cluster[0]))
                known[cluster] = k = next(whole, next(begun, 0))
                self.missing += shapers[k].lacking(cluster)
            found[a:b] = [known[cluster]] * (b - a)
        return found

    @cached_property
    def _clusters(self) -> IntArray:
        return clusters(self.text)

    def _shape(self, codes: Sequence[int], run: Run) -> Shaped:
        directions = ("ttb", "btt") if run.upright else ("ltr", "rtl")
        glyphs = self._shapers[run.font].shape(codes, run, directions[run.level % 2], self._origin)
        vertical, spacing = self._setting.vertical, self._setting.letter_spacing
        if vertical and not run.upright:
            # Turned clockwise, with the middle between ascender and descender of the first font on the column's centre.
            metrics = self._shapers[0].source.metrics
            turned = glyphs.offset[:, ::-1] * [1.0, -1.0] - [(metrics.ascender + metrics.descender) / 2, 0.0]
            glyphs = glyphs._replace(advance=glyphs.advance[:, ::-1] * [1.0, -1.0], offset=turned)
        return glyphs.spaced(np.array([0.0, -spacing] if vertical else [spacing, 0.0])) if spacing else glyphs

    def _along(self, advances: FloatArray) -> FloatArray:
        """(n,) what advances (n, 2) are along a line."""
        return -advances[:, 1] if self._setting.vertical else advances[:, 0]

    def length(self, line: Line) -> float:
        """The length of a line's glyphs, without the letter spacing behind the last."""
        behind = self._setting.letter_spacing if line.pieces else 0.0
        return float(sum(self._along(glyphs.advance).sum() for _, glyphs in line.pieces)) - behind

    @cached_property
    def _ends(self) -> FloatArray:
        """(n + 1,) length of the text before each character, where the whole paragraph is one line."""
        clusters = np.concatenate([glyphs.cluster for glyphs in self.shaped])
        advances = np.concatenate([self._along(glyphs.advance) for glyphs in self.shaped])
        by_character = np.bincount(clusters, advances, len(self.text))
        return np.concatenate([[0.0], np.cumsum(by_character)])

    @cached_property
    def _breaks(self) -> tuple[IntArray, IntArray, FloatArray]:
        """(k,) where lines may end, where what is seen of them ends, and the length of the text before that."""
        text, places = self.text, line_ends(self.text)
        places = places[np.isin(places, self._clusters)]  # UAX #14 cuts some clusters, such as of emoji out of place
        hanging = np.array([character in HANGING for character in text])
        last_seen = np.maximum.accumulate(np.where(hanging, 0, np.arange(1, len(text) + 1)))
        seen = np.concatenate([[0], last_seen])[places]
        return places, seen, np.maximum.accumulate(self._ends[seen])

    def _fitting(self, at: int, width: float) -> tuple[Line, int]:
        """The longest line from a place on that is not longer than ``width``, and where the next begins."""
        places, seen, lengths = self._breaks
        first = int(np.searchsorted(places, at, side="right"))
        fits = width + self._ends[at] + 1e-6 + max(self._setting.letter_spacing, 0.0)
        for k in range(int(np.searchsorted(lengths, fits, side="right")) - 1, first - 1, -1):
            line = self._line(at, max(int(seen[k]), at), k == len(places) - 1)
            if self.length(line) <= width + 1e-6:
                return line, int(places[k])
        # No place to break: between grapheme clusters, at least one to a line.
        ends = self._clusters[slice(*np.searchsorted(self._clusters, [at, places[first]], side="right"))]
        count = max(int(np.searchsorted(self._ends[ends], fits, side="right")), 1)
        while True:
            stop = int(ends[count - 1])
            line = self._line(at, min(stop, int(max(seen[first], at + 1))), stop == len(self.text))
            if count == 1 or self.length(line) <= width + 1e-6:
                return line, stop
            count -= 1

    def _line(self, start: int, stop: int, last: bool) -> Line:
        """The characters from ``start`` up to ``stop`` as a line; runs that it cuts are shaped again."""
        inside = range(bisect(self._starts, start) - 1, bisect_left(self._starts, stop)) if stop > start else ()
        hyphen = None if last or not inside or self.text[stop - 1] != SOFT_HYPHEN else self._hyphen(stop)
        order = visual_order([self.runs[k].level for k in inside])
        pieces = []
        for k in (inside[i] for i in order):
            run, glyphs = self.runs[k], self.shaped[k]
            part = run._replace(start=max(run.start, start), stop=min(run.stop, stop))
            if hyphen and part.stop == stop:
                self.codes[stop - 1] = hyphen
                glyphs = self._shape(self.codes, part)
                self.codes[stop - 1] = ord(SOFT_HYPHEN)
            elif part != run:
                glyphs = self._shape(self.codes, part)
            pieces.append((part, glyphs))
        return Line(tuple(pieces), last)

    def _hyphen(self, stop: int) -> int:
        """The code point shown for the soft hyphen before ``stop``."""
        shaper = self._shapers[self.runs[bisect(self._starts, stop - 1) - 1].font]
        return ord(next((hyphen for hyphen in HYPHENS if shaper.has(hyphen)), SOFT_HYPHEN))


def clusters(text: str) -> IntArray:
    """(k + 1,) where the k extended grapheme clusters of a text begin, and its length."""
    return offsets_of([len(cluster) for cluster in need("text").graphemes(text, True)])


def line_ends(text: str) -> IntArray:
    """(k,) the places before which a new line may begin, ascending; the last is the length of the text."""
    places = np.array([place for place, _ in need("text").line_breaks(text)], dtype=np.int64)
    if text.isascii():
        return places
    units = np.frombuffer(text.encode(), dtype=np.uint8)
    begins: BoolArray = (units & 0xC0) != 0x80  # the first unit of each character, in UTF-8
    return np.concatenate([[0], np.cumsum(begins)])[places]
