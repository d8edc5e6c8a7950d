"""Finding a glyph by characters, code point, index or name."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import islice
from typing import Any

from ..readers import Font

SHOWN = 120
"""Maximum number of glyphs listed."""


def search(font: Font, words: str) -> dict[str, Any]:
    """The first glyphs that match; without words, the first that have a character."""
    found = list(islice(_matches(font, words.strip()), SHOWN))
    names = dict.fromkeys(found, "")
    for code, name in font.cmap.items():
        if name in names:
            names[name] = names[name] or chr(code)
    listed = [{"name": name, "text": text} for name, text in names.items()]
    return {"glyphs": listed, "more": len(found) == SHOWN}


def _matches(font: Font, words: str) -> Iterator[str]:
    cmap, names = font.cmap, font.glyph_names
    if not words:
        mapped = set(cmap.values())
        yield from (name for name in names if name in mapped or not mapped)
        return
    code = re.fullmatch(r"(?:U\+|0x)([0-9a-f]{1,6})", words, re.IGNORECASE)
    if code and int(code[1], 16) in cmap:
        yield cmap[int(code[1], 16)]
    index = re.fullmatch(r"(?:gid ?)?(\d{1,7})", words, re.IGNORECASE)
    if index and int(index[1]) < len(names):
        yield names[int(index[1])]
    if words in names:
        yield words
    if len(words) == 1 or not words.isascii():  # several letters of ASCII are a name, as in the gallery
        yield from (cmap[ord(character)] for character in words if not character.isspace() and ord(character) in cmap)
    yield from (name for name in names if words.lower() in name.lower())
