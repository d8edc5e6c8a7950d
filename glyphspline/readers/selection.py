"""Selection of glyphs by text, code points, names or indices, as in the fontTools subsetter."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from typing import Any, NamedTuple, TypeAlias

from ..errors import GlyphsplineError

Request: TypeAlias = int | str | Iterable[int | str]
"""Numbers: one or several ints, or strings of numbers and ranges such as ``"U+4E00-4E10,9F8D"`` or ``"5,10-20"``."""


class Numbers(NamedTuple):
    """How numbers and ranges of one kind are written."""

    pattern: str
    base: int
    last: int
    form: str
    hint: str


UNICODES = Numbers(
    r"(?:U\+|0x)?([0-9A-F]{1,6})", 16, 0x10FFFF, "U+{:04X}", "code point or range of them, as in U+4E00-4E10"
)
GIDS = Numbers("([0-9]{1,7})", 10, 0xFFFFFF, "{}", "glyph index or range of them, as in 10-20")
"""The last glyph index is the largest of any table format."""


class Selection(tuple[str, ...]):
    """Glyph names, unique: those of a text in its order, then the others in glyph index order.

    ``missing`` has one phrase for each item that the font does not have, in the order of the arguments: ``"U+9F99"``,
    ``"glyph foo"``, ``"gid 70000"``. A range is missing if the font has no item of it. ``asked`` has the arguments that
    were given, as plain data.
    """

    missing: tuple[str, ...]
    asked: Mapping[str, Any]

    def __new__(
        cls, names: Iterable[str] = (), missing: Iterable[str] = (), asked: Mapping[str, Any] | None = None
    ) -> Selection:
        """Make a selection of ``names``, which are in order."""
        selection = super().__new__(cls, names)
        selection.missing = tuple(missing)
        selection.asked = dict(asked or {})
        return selection

    def __reduce__(self) -> tuple[Any, ...]:
        return Selection, (tuple(self), self.missing, self.asked)


def select(
    glyph_names: Sequence[str],
    cmap: Mapping[int, str],
    text: str | None,
    unicodes: Request | None,
    glyphs: str | Iterable[str] | None,
    gids: Request | None,
    all_glyphs: bool,
) -> Selection:
    """The union of the glyphs that each argument selects: those of the text in its order, then by glyph index.

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
    code_points, indices = _written(unicodes, UNICODES), _written(gids, GIDS)
    index = {name: gid for gid, name in enumerate(glyph_names)}
    found: set[str] = set(glyph_names) if all_glyphs else set()
    missing: list[str] = []

    def take(names: Iterable[str], phrase: str) -> None:
        known = [name for name in names if name in index]
        found.update(known)
        if not known:
            missing.append(phrase)

    codes = [ord(character) for character in dict.fromkeys(text or "") if unicodedata.category(character) != "Cc"]
    for first, last in chain(zip(codes, codes, strict=True), _ranges(code_points, UNICODES)):
        take(_within(cmap, first, last), f"U+{first:04X}" if first == last else f"U+{first:04X}-{last:04X}")
    names = glyphs.replace(",", " ").split() if isinstance(glyphs, str) else None if glyphs is None else list(glyphs)
    for name in names or ():
        take(glyph_names if name == "*" else [name], f"glyph {name}")
    for first, last in _ranges(indices, GIDS):
        take(glyph_names[first : last + 1], f"gid {first}" if first == last else f"gid {first}-{last}")
    given = {"text": text, "unicodes": code_points, "glyphs": names, "gids": indices}
    asked = {name: value for name, value in given.items() if value is not None} | ({"all": True} if all_glyphs else {})
    ahead = dict.fromkeys(cmap[code] for code in codes if cmap.get(code) in index)
    rest = sorted(found.difference(ahead), key=index.__getitem__)
    return Selection([*ahead, *rest], dict.fromkeys(missing), asked)


def _within(cmap: Mapping[int, str], first: int, last: int) -> list[str]:
    """Names of the code points first to last; the loop runs over the shorter of the range and the map."""
    if last - first < len(cmap):
        return [cmap[code] for code in range(first, last + 1) if code in cmap]
    return [name for code, name in cmap.items() if first <= code <= last]


def _written(request: Request | None, kind: Numbers) -> list[str] | None:
    """A request as a list of strings, as which numbers are kept and can be asked for again."""
    parts = [request] if isinstance(request, int | str) else request
    return None if parts is None else [kind.form.format(part) if isinstance(part, int) else part for part in parts]


def _ranges(parts: Iterable[str] | None, kind: Numbers) -> Iterator[tuple[int, int]]:
    """First and last of each number or range."""
    for item in " ".join(parts or ()).replace(",", " ").split():
        match = re.fullmatch(f"{kind.pattern}(?:-{kind.pattern})?", item, re.IGNORECASE)
        first, last = (int(match[1], kind.base), int(match[2] or match[1], kind.base)) if match else (1, 0)
        if item == "*":
            first, last = 0, kind.last
        if not first <= last <= kind.last:
            raise GlyphsplineError(f"{item!r} is no {kind.hint}")
        yield first, last
