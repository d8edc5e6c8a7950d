"""A piece of text becomes glyphs: by HarfBuzz, with OpenType features, or character by character where a source has no
tables for that."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
import uharfbuzz as hb

from ..errors import GlyphsplineError, OptionError, require
from ..types import FloatArray, IntArray
from .clusters import clusters, glyphs_of
from .source import Source

CONTEXT = 8
"""Characters before and after a run that HarfBuzz sees; it looks at five."""

FEATURE = re.compile(r"([+-]?)([ -~]{4})(?:\[(\d*)(?:(:)(\d*))?\])?(?:=(\d{1,9}|on|off))?")
END = 2**32 - 1
"""No character has a larger number: HarfBuzz's "to the end"."""


class Feature(NamedTuple):
    """A feature with its value, for the characters from ``start`` up to ``stop`` of the text."""

    tag: str
    value: int
    start: int
    stop: int


def parsed_features(features: str) -> tuple[Feature, ...]:
    """The features of a list with commas.

    Raises:
        OptionError: one is not written as HarfBuzz has it.
    """
    require(isinstance(features, str), "features are a string, such as 'liga,-kern,ss01=2'", features)
    found = []
    for entry in filter(None, map(str.strip, features.split(","))):
        match = FEATURE.fullmatch(entry)
        if not match or (match[1] == "-" and match[6]):
            raise OptionError(
                f"not a feature: {entry!r}; a feature is a tag of four characters with or without a sign, a range of"
                " characters or a value, as in 'liga', '-kern', 'ss01=2', 'smcp[0:5]'"
            )
        value = {"on": 1, "off": 0, None: int(match[1] != "-")}.get(match[6])
        start = int(match[3] or 0)
        stop = int(match[5] or END) if match[4] or match[3] is None else start + 1
        found.append(Feature(match[2], int(match[6]) if value is None else value, min(start, END), min(stop, END)))
    return tuple(found)


def check_features(features: Sequence[Feature], faces: Iterable[Any]) -> None:
    """Raise an OptionError for a feature that no face has.

    Args:
        features: as :func:`parsed_features`. faces: HarfBuzz's.
    """
    known: set[str] = set()
    for face in faces:
        tables = set(face.table_tags)
        if tables & {"morx", "mort", "kerx"}:  # Apple's, in which HarfBuzz finds features without names here
            return
        known |= {"kern"} & tables
        for table in ("GSUB", "GPOS"):
            for script in range(len(face.get_table_script_tags(table))):
                for language in [0xFFFF, *range(len(face.get_script_language_tags(table, script)))]:
                    known |= set(face.get_language_feature_tags(table, script, language))
    for feature in features:
        if feature.tag not in known:
            has = f"it has {', '.join(sorted(known))}" if known else "it has none"
            raise OptionError(f"the font has no feature {feature.tag!r}; {has}")


def for_buffer(features: Sequence[Feature], origin: int) -> dict[str, Any]:
    """The features as uharfbuzz takes them; ``origin``: number in the text of the buffer's first character."""
    found: dict[str, Any] = {}
    for tag, value, start, stop in features:
        if start == 0 and stop == END:
            found[tag] = value
        else:
            before = found.get(tag, [])
            found[tag] = [(0, END, before)] if isinstance(before, int) else before
            found[tag].append((max(start - origin, 0), stop if stop == END else max(stop - origin, 0), value))
    return found


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

    def has(self, cluster: str) -> bool:
        """Whether the font has glyphs for all of a grapheme cluster, or needs none."""
        return not self.lacking(cluster)

    def lacking(self, cluster: str) -> tuple[str, ...]:
        """The characters of a grapheme cluster that have no glyph."""
        if all(ord(character) in self.source.cmap for character in cluster):
            return ()
        return glyphs_of(self.source, cluster.replace("\t", " ")).missing


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


class PlainShaper(Shaper):
    """A source without tables for shaping, such as a UFO: the glyphs of each character, one after the other."""

    def __init__(self, source: Source, scale: float) -> None:
        super().__init__(source, scale)
        self._advances: dict[int, float] = {}

    def shape(self, codes: Sequence[int], run: Run, direction: str, origin: int) -> Shaped:
        """See :meth:`Shaper.shape`."""
        found, at = [], run.start
        for cluster in clusters("".join(map(chr, codes[run.start : run.stop]))):
            found += [(at, gid) for gid in self._gids(cluster)]
            at += len(cluster)
        glyphs = np.array(found if direction == "ltr" else found[::-1], dtype=np.int64).reshape(-1, 2)
        cluster_of, gid = glyphs[:, 0], glyphs[:, 1]
        advance, offset = np.zeros((2, len(gid), 2))
        advance[:, 0] = [each * self.scale for each in self._advances_of(gid.tolist())]
        return Shaped(gid, cluster_of, advance, offset)

    def _gids(self, cluster: str) -> list[int]:
        """The glyphs of a character, with .notdef, if there is one, for what is missing."""
        names, missing, _ = glyphs_of(self.source, cluster)
        if missing and len(cluster) > 1:
            return [gid for character in cluster for gid in self._gids(character)]
        gids = self.source.gids
        return [gids[name] for name in names or ([".notdef"] if missing else []) if name in gids]

    def _advances_of(self, gids: Sequence[int]) -> list[float]:
        unread = sorted(set(gids) - self._advances.keys())
        outlines = self.source.outlines(unread, errors="return")
        self._advances |= {gid: getattr(found, "advance", 0.0) for gid, found in zip(unread, outlines, strict=True)}
        return [self._advances[gid] for gid in gids]
