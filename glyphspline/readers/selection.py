"""Selection of glyphs by text, code points, names or indices, as in the fontTools subsetter."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple, TypeAlias

from ..errors import GlyphsplineError
from .clusters import Repertoire, clusters, glyphs_of

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
    ``"U+845B U+E0100"`` (a variation), ``"glyph foo"``, ``"gid 70000"``. A range is missing if the font has no item of
    it. ``asked`` has the arguments that were given, as plain data.
    ``characters`` has for a glyph the character that was asked for and that it shows alone; ``composed`` for a
    character the glyphs that show it together.
    """

    missing: tuple[str, ...]
    asked: Mapping[str, Any]
    characters: Mapping[str, str]
    composed: Mapping[str, tuple[str, ...]]

    def __new__(
        cls,
        names: Iterable[str] = (),
        missing: Iterable[str] = (),
        asked: Mapping[str, Any] | None = None,
        characters: Mapping[str, str] | None = None,
        composed: Mapping[str, tuple[str, ...]] | None = None,
    ) -> Selection:
        """Make a selection of ``names``, which are in order."""
        selection = super().__new__(cls, names)
        selection.missing = tuple(missing)
        selection.asked, selection.characters = dict(asked or {}), dict(characters or {})
        selection.composed = dict(composed or {})
        return selection

    def __reduce__(self) -> tuple[Any, ...]:
        return Selection, (tuple(self), self.missing, self.asked, self.characters, self.composed)


def select(
    source: Repertoire,
    text: str | None,
    unicodes: Request | None,
    glyphs: str | Iterable[str] | None,
    gids: Request | None,
    all_glyphs: bool,
) -> Selection:
    """The union of the glyphs that each argument selects: those of the text in its order, then by glyph index.

    Args:
        source: the font.
        text: every character of it, cut by :func:`.clusters.clusters` and found by :func:`.clusters.glyphs_of`.
        unicodes: code points, hexadecimal in strings, with or without ``U+``, each found as a character of a text; of
            a range, those that the font maps; ``"*"`` is every one mapped.
        glyphs: names, or one string of names between commas or spaces; ``"*"`` is every glyph.
        gids: glyph indices, decimal in strings; ``"*"`` is every glyph.
        all_glyphs: every glyph.

    Raises:
        GlyphsplineError: a string is not a list of numbers, or no argument is given.
    """
    if not all_glyphs and all(argument is None for argument in (text, unicodes, glyphs, gids)):
        raise GlyphsplineError("no glyphs asked for: give text, unicodes, glyphs, gids or all_glyphs")
    code_points, indices = _written(unicodes, UNICODES), _written(gids, GIDS)
    glyph_names, index = source.glyph_names, source.gids
    found: set[str] = set(glyph_names) if all_glyphs else set()
    missing: list[str] = []

    def take(names: Iterable[str], phrase: str) -> None:
        known = [name for name in names if name in index]
        found.update(known)
        if not known:
            missing.append(phrase)

    of_text = Characters(source, dict.fromkeys(clusters(text or "")))
    ranges = list(_ranges(code_points, UNICODES))
    single = Characters(source, dict.fromkeys(chr(first) for first, last in ranges if first == last))
    missing += [*of_text.missing, *single.missing]
    found.update(single.names)
    for first, last in ranges:
        if first < last:
            mapped = Characters(source, map(chr, _within(source.cmap, first, last)))
            take(mapped.names, f"U+{first:04X}-{last:04X}")
    names = glyphs.replace(",", " ").split() if isinstance(glyphs, str) else None if glyphs is None else list(glyphs)
    for name in names or ():
        take(glyph_names if name == "*" else [name], f"glyph {name}")
    for first, last in _ranges(indices, GIDS):
        take(glyph_names[first : last + 1], f"gid {first}" if first == last else f"gid {first}-{last}")
    given = {"text": text, "unicodes": code_points, "glyphs": names, "gids": indices}
    asked = {name: value for name, value in given.items() if value is not None} | ({"all": True} if all_glyphs else {})
    rest = sorted(found.difference(of_text.names), key=index.__getitem__)
    return Selection(
        [*of_text.names, *rest], dict.fromkeys(missing), asked, single.alone | of_text.alone,
        single.composed | of_text.composed,
    )  # fmt: skip


class Characters:
    """The glyphs of characters that are asked for.

    Attributes:
        names: of all of them, in order, without repeats. missing: phrases for what the source does not have.
        alone: glyph name to the first character that it shows alone. composed: character to several glyphs.
    """

    def __init__(self, source: Repertoire, asked: Iterable[str]) -> None:
        self.names: dict[str, None] = {}
        self.missing: list[str] = []
        self.alone: dict[str, str] = {}
        self.composed: dict[str, tuple[str, ...]] = {}
        for cluster in asked:
            shown = glyphs_of(source, cluster)
            for name in shown.names:
                self.names[name] = None
            for one in shown.missing + shown.unvaried:
                self.missing.append(" ".join([f"U+{ord(character):04X}" for character in one]))
            if len(shown.names) == 1:
                self.alone.setdefault(shown.names[0], cluster)
            elif shown.names and not shown.missing:
                self.composed[cluster] = shown.names


def _within(cmap: Mapping[int, str], first: int, last: int) -> list[int]:
    """Code points that are mapped, from first to last; the loop runs over the shorter of the range and the map."""
    if last - first < len(cmap):
        return [code for code in range(first, last + 1) if code in cmap]
    return [code for code in cmap if first <= code <= last]


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
