"""What is seen as one character, and the glyphs that show it: one road for all that ask for characters."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain, pairwise
from pathlib import Path
from typing import Any, NamedTuple, Protocol
from unicodedata import category, normalize

import uharfbuzz as hb
from uharfbuzz import BufferFlags

from ..errors import GlyphsplineError

UNSEEN = frozenset("\u00ad\u034f\u061c\u200b\u200c\u200d\u200e\u200f\u2060\ufe0e\ufe0f\ufeff")
"""Characters that need no glyph; a selector of emoji or text is as often copied along as meant."""

JOINER, VIRAMAS = "\u200d", frozenset("\u094d\u09cd\u0acd\u0b4d\u0c4d\u0ccd\u0d4d\u1039\u17d2")
"""What links the letter behind to that before."""

RADICALS, JAMO = range(0x2E80, 0x2FE0), (range(0x1100, 0x1200), range(0xA960, 0xA980), range(0xD7B0, 0xD800))
"""Parts of Han characters, and of Hangul syllables, which look as characters do that are written."""

LETTERS_OF_HANGUL = range(0x3131, 0x318F)

LEADING, VOWELS = (*range(0x1100, 0x1160), *range(0xA960, 0xA97D)), (*range(0x1160, 0x11A8), *range(0xD7B0, 0xD7C7))
TRAILING, SYLLABLES = (*range(0x11A8, 0x1200), *range(0xD7CB, 0xD7FC)), range(0xAC00, 0xD7A4)
"""Parts of syllables of Hangul, those of old ones too, which no code point has as a whole, and whole ones."""

ALONE = (
    BufferFlags.BOT | BufferFlags.EOT | BufferFlags.REMOVE_DEFAULT_IGNORABLES | BufferFlags.DO_NOT_INSERT_DOTTED_CIRCLE
)
"""How HarfBuzz shapes what nothing stands beside."""


class Repertoire(Protocol):
    """What the way from characters to glyphs needs of a :class:`.Source`."""

    path: Path
    shaper: Any
    glyph_names: tuple[str, ...]
    cmap: Mapping[int, str]
    variations: Mapping[str, str]

    @property
    def gids(self) -> dict[str, int]:
        """Glyph name to glyph index."""

    @property
    def mapper(self) -> Any:
        """See :func:`mapper_of`."""

    def at_location(self, names: Sequence[str]) -> tuple[str, ...]:
        """The glyphs that stand for glyphs at the location."""


class Shown(NamedTuple):
    """How a source shows a character.

    Attributes:
        names: of its glyphs, in the order of its code points as far as they have one.
        missing: what of it the source has no glyph for.
        unvaried: bases with selectors of variations that the source does not have: it shows the bases.
    """

    names: tuple[str, ...]
    missing: tuple[str, ...] = ()
    unvaried: tuple[str, ...] = ()


def clusters(text: str) -> list[str]:
    """A text cut into what is seen as one character each; control characters and ends of lines are left out.

    A mark or a selector belongs to the letter before it, as do parts of emoji and of Hangul syllables, and what a
    virama or joiner links. A mark without a letter, at the beginning or after a space or another such mark, is by
    itself.
    """
    found: list[str] = []
    for character in text:
        if category(character) in ("Cc", "Zl", "Zp"):
            found.append("")
        elif found and found[-1] and _joins(found[-1], character):
            found[-1] += character
        else:
            found.append(character)
    return list(filter(None, found))


def _joins(before: str, character: str) -> bool:
    kind = category(character)[0]
    if kind == "M" or character == JOINER or "\U0001f3fb" <= character <= "\U0001f3ff" or is_tag(character):
        return category(before[0])[0] not in "ZM" or is_selector(character)
    if before[-1] == JOINER or (before[-1] in VIRAMAS and len(before) > 1):
        return kind == "L" or (before[-1] == JOINER and kind == "S")
    last, code = ord(before[-1]), ord(character)
    if code in TRAILING:  # behind a vowel that is not alone
        return last in SYLLABLES[::28] or (last in VOWELS and len(before) > 1)
    return (code in VOWELS and last in LEADING) or (is_regional(before) and is_regional(character))


def is_tag(character: str) -> bool:
    """Whether a character is one of those that spell the name of a flag."""
    return "\U000e0020" <= character <= "\U000e007f"


def is_regional(text: str) -> bool:
    """Whether a text is one of the letters that are a flag in pairs."""
    return len(text) == 1 and "\U0001f1e6" <= text <= "\U0001f1ff"


def is_selector(character: str) -> bool:
    """Whether a character selects a variation of the one before."""
    return "\ufe00" <= character <= "\ufe0f" or "\U000e0100" <= character <= "\U000e01ef"


def glyphs_of(source: Repertoire, cluster: str) -> Shown:
    """How a source shows one of :func:`clusters` where nothing stands beside it.

    A font shows what HarfBuzz makes of it with the features that are on by default, at the font's location. Any other
    source shows what HarfBuzz makes of its characters, composed and decomposed, after its rules for the location.
    """
    names = _shaped(source, cluster)
    if names is not None and len(cluster) == 1:
        return Shown(names)
    if names is not None:
        varied = [a + b for a, b in pairwise(cluster) if is_selector(b) and b not in UNSEEN]
        return Shown(names, (), tuple(each for each in varied if not _has_variation(source, each)))
    parts = [glyphs_of(source, each) for each in cluster if not is_selector(each)] if len(cluster) > 1 else []
    missing = chain.from_iterable(part.missing for part in parts)
    return Shown(tuple(chain.from_iterable(part.names for part in parts)), tuple(missing) or (cluster,))


def _shaped(source: Repertoire, cluster: str) -> tuple[str, ...] | None:
    """The glyphs that HarfBuzz shows; None: some of them are .notdef.

    The glyph of a single character stays where HarfBuzz would put it together from others, or hide it.
    """
    shaper = source.mapper if source.shaper is None else source.shaper
    buffer = hb.Buffer()
    buffer.add_codepoints(list(map(ord, cluster)))
    buffer.guess_segment_properties()
    buffer.language = "und"  # not the one that this process happens to run in
    buffer.flags = ALONE
    try:
        hb.shape(shaper, buffer)
    except MemoryError as error:
        words = f"HarfBuzz gives up on {cluster!r}: the font's tables grow it beyond measure"
        raise GlyphsplineError(words, font=str(source.path)) from error
    gids = [info.codepoint for info in buffer.glyph_infos]
    if len(gids) != 1 and len(cluster) == 1 and (name := source.cmap.get(ord(cluster))):
        extents = source.shaper and shaper.get_glyph_extents(source.gids[name])
        if not gids or source.shaper is None or (extents and extents.width and extents.height):
            return source.at_location([name])
    names, first = source.glyph_names, int(source.shaper is None)
    if not all(0 < gid < len(names) + first for gid in gids):
        return None
    return source.at_location([names[gid - first] for gid in (gids[::-1] if buffer.direction == "rtl" else gids)])


def mapper_of(cmap: Mapping[int, str], variations: Mapping[str, str], gids: Mapping[str, int]) -> Any:
    """HarfBuzz's font of characters alone, without tables. Its glyph 0 is what is missing, k + 1 is glyph k."""
    functions, font = hb.FontFuncs(), hb.Font(hb.Face(b""))
    functions.set_nominal_glyph_func(lambda font, code, data: gids.get(cmap.get(code, ""), -1) + 1)
    functions.set_variation_glyph_func(
        lambda font, code, selector, data: gids.get(variations.get(chr(code) + chr(selector), ""), -1) + 1
    )
    font.funcs = functions
    return font


def _has_variation(source: Repertoire, pair: str) -> bool:
    if source.shaper is None:
        return pair in source.variations
    return source.shaper.get_variation_glyph(ord(pair[0]), ord(pair[1])) is not None


def unified(codes: Iterable[int]) -> int:
    """The code point that a glyph is best called by, of one or more.

    It is the lowest of those that are neither radicals, compatibility forms nor private, as U+9F8D before U+2FD3
    (Kangxi), or else of all.
    """
    return min(codes, key=lambda code: (_strangeness(code), code))


def _strangeness(code: int) -> int:
    """0 for a character as it is written, 1 for a form or part of one, 2 for one that is private or not seen."""
    character = chr(code)
    if category(character)[0] == "C":
        return 2
    if code in RADICALS or any(code in each for each in JAMO):
        return 1
    same = normalize("NFKC", character)
    return int(len(same) == 1 and same != character and code not in LETTERS_OF_HANGUL)
