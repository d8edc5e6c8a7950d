"""Selection of glyphs by text, code points, names or indices, as in the fontTools subsetter."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TypeAlias

from ..errors import GlyphsplineError

Request: TypeAlias = int | str | Iterable[int | str]
"""Numbers: one or several ints, or strings of numbers and ranges such as ``"U+4E00-4E10,9F8D"`` or ``"5,10-20"``."""

LAST_UNICODE = 0x10FFFF
LAST_GID = 0xFFFFFF  # the largest glyph index of any table format


class Selection(tuple[str, ...]):
    """Glyph names, unique, in glyph index order.

    ``missing`` has one phrase for each item that the font does not have, in the order of the arguments: ``"U+9F99"``,
    ``"glyph foo"``, ``"gid 70000"``. A range is missing if the font has no item of it.
    """

    missing: tuple[str, ...]

    def __new__(cls, names: Iterable[str] = (), missing: Iterable[str] = ()) -> Selection:
        """Make a selection of ``names``, which are in order."""
        selection = super().__new__(cls, names)
        selection.missing = tuple(missing)
        return selection


def select(
    glyph_names: Sequence[str],
    cmap: Mapping[int, str],
    *,
    text: str | None = None,
    unicodes: Request | None = None,
    glyphs: str | Iterable[str] | None = None,
    gids: Request | None = None,
    all_glyphs: bool = False,
) -> Selection:
    """The union of the glyphs that each argument selects.

    Args:
        glyph_names: all names in glyph index order. cmap: code point to name.
        text: every character but line ends and other control characters.
        unicodes: code points, hexadecimal in strings, with or without ``U+``; ``"*"`` is every one mapped.
        glyphs: names, or one string of names between commas or spaces; ``"*"`` is every glyph.
        gids: glyph indices, decimal in strings; ``"*"`` is every glyph.
        all_glyphs: every glyph.

    Raises:
        GlyphsplineError: a string is not a list of numbers, or no argument is given.
    """
    if not all_glyphs and all(argument is None for argument in (text, unicodes, glyphs, gids)):
        raise GlyphsplineError("no glyphs asked for: give text, unicodes, glyphs, gids or all_glyphs")
    index = {name: gid for gid, name in enumerate(glyph_names)}
    found: set[str] = set(glyph_names) if all_glyphs else set()
    missing: list[str] = []

    def take(names: Iterable[str], phrase: str) -> None:
        known = [name for name in names if name in index]
        found.update(known)
        if not known:
            missing.append(phrase)

    for character in dict.fromkeys(text or ""):
        if unicodedata.category(character) != "Cc":
            take(_within(cmap, ord(character), ord(character)), _unicode_phrase(ord(character), ord(character)))
    for first, last in _ranges(unicodes, _unicode_range, (0, LAST_UNICODE)):
        take(_within(cmap, first, last), _unicode_phrase(first, last))
    for name in _names(glyphs):
        take(glyph_names if name == "*" else [name], f"glyph {name}")
    for first, last in _ranges(gids, _gid_range, (0, LAST_GID)):
        take(glyph_names[first : last + 1], f"gid {first}" if first == last else f"gid {first}-{last}")
    return Selection(sorted(found, key=index.__getitem__), dict.fromkeys(missing))


def _within(cmap: Mapping[int, str], first: int, last: int) -> list[str]:
    """Names of the code points first to last; the loop runs over the shorter of the range and the map."""
    if last - first < len(cmap):
        return [cmap[code] for code in range(first, last + 1) if code in cmap]
    return [name for code, name in cmap.items() if first <= code <= last]


def _names(glyphs: str | Iterable[str] | None) -> list[str]:
    if glyphs is None:
        return []
    return glyphs.replace(",", " ").split() if isinstance(glyphs, str) else list(glyphs)


def _ranges(
    request: Request | None, parse: Callable[[str], tuple[int, int]], everything: tuple[int, int]
) -> Iterator[tuple[int, int]]:
    """First and last of each number or range."""
    if request is None:
        return
    for part in [request] if isinstance(request, int | str) else request:
        if isinstance(part, str):
            for item in part.replace(",", " ").split():
                yield everything if item == "*" else parse(item)
        elif 0 <= part <= everything[1]:
            yield part, part
        else:
            raise GlyphsplineError(f"{part} is not between 0 and {everything[1]}")


def _unicode_range(item: str) -> tuple[int, int]:
    match = re.fullmatch(r"(?:U\+|0x)?([0-9A-F]{1,6})(?:-(?:U\+|0x)?([0-9A-F]{1,6}))?", item, re.IGNORECASE)
    first, last = _ends(match, 16)
    if match is None or not first <= last <= LAST_UNICODE:
        raise GlyphsplineError(f"{item!r} is no code point or range of them, as in U+4E00-4E10")
    return first, last


def _gid_range(item: str) -> tuple[int, int]:
    match = re.fullmatch(r"([0-9]{1,7})(?:-([0-9]{1,7}))?", item, re.ASCII)
    first, last = _ends(match, 10)
    if match is None or not first <= last <= LAST_GID:
        raise GlyphsplineError(f"{item!r} is no glyph index or range of them, as in 10-20")
    return first, last


def _ends(match: re.Match[str] | None, base: int) -> tuple[int, int]:
    """The numbers of a match; an impossible range if there is none."""
    if match is None:
        return 1, 0
    return int(match[1], base), int(match[2] or match[1], base)


def _unicode_phrase(first: int, last: int) -> str:
    return f"U+{first:04X}" if first == last else f"U+{first:04X}-{last:04X}"
