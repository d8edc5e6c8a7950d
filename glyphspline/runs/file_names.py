"""Names of glyphs' files, the same whatever is selected, and of folders: safe everywhere, unlike in any case."""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from itertools import count as count_from
from pathlib import Path

from ..types import Names

LONGEST_NAME = 150
"""Bytes of a file name before its suffix. File systems take 255; the rest is for clash numbers and suffixes."""

_RESERVED = frozenset(
    ["con", "prn", "aux", "nul", "clock$", *(f"{port}{k}" for port in ("com", "lpt") for k in range(1, 10))]
)
"""Devices of Windows."""

_PLAIN = re.compile(r"[A-Za-z0-9_-](?:[A-Za-z0-9_.-]{0,72}[A-Za-z0-9_-])?")
"""Names that are taken as they are, unless a part of them between dots is the name of a device of Windows."""

_NOT_TEXT = re.compile("[\x7f-\x9f\ud800-\udfff]")


def file_names(
    glyph_names: Sequence[str],
    names: Names = "glyph",
    cmap: Mapping[int, str] | None = None,
    chosen: Sequence[int] | None = None,
) -> list[str]:
    """A file name, without suffix, for each chosen glyph; no two of a font are alike without regard to case.

    They depend on all glyphs of the font, in order, not on which of them are chosen.

    Args:
        glyph_names: of all glyphs of the font.
        names: "glyph", the glyph's name; "unicode", its first code point, as in ``uni9F8D``; "gid", its index; "char",
            its first character. Glyphs without a code point keep their names.
        cmap: code point to glyph name.
        chosen: glyph indices; None: all.
    """
    chosen = range(len(glyph_names)) if chosen is None else chosen
    if names == "gid":
        return [f"{gid:05}" for gid in chosen]
    wanted = list(glyph_names)
    if names != "glyph" and cmap is not None:
        first = {cmap[code]: code for code in sorted(cmap, reverse=True)}
        named = _uni if names == "unicode" else _char
        wanted = [named(first[name]) if name in first else name for name in wanted]
    # Names that can be taken as they are stay so; of the others, and of those that clash, the UFO rule makes names.
    keys = list(map(_key, wanted))
    counts = Counter(keys)

    def stays(gid: int) -> bool:
        return counts[keys[gid]] == 1 and _is_plain(wanted[gid], keys[gid])

    if not all(map(stays, chosen)):  # then names depend on what is taken, and on those made before
        staying = list(map(stays, range(len(wanted))))
        taken = {key for key, stay in zip(keys, staying, strict=True) if stay}
        wanted = [name if stay else _by_rule(name, taken) for name, stay in zip(wanted, staying, strict=True)]
    return [wanted[gid] for gid in chosen]


def _key(name: str) -> str:
    """What file systems compare: some ignore case, some how accents are composed."""
    return name.lower() if name.isascii() else unicodedata.normalize("NFKC", name).casefold()


def _is_plain(name: str, key: str) -> bool:
    if _PLAIN.fullmatch(name) is not None:
        return key not in _RESERVED and ("." not in key or _RESERVED.isdisjoint(key.split(".")))
    return not name.isascii() and len(name) == 1 and _is_seen(name)


def _is_seen(character: str) -> bool:
    return unicodedata.category(character)[0] in "LNPS"


def _by_rule(name: str, taken: set[str]) -> str:
    """The file name by the UFO rule, an underscore after each capital, which is added to ``taken``."""
    from fontTools.ufoLib.filenames import userNameToFileName  # takes as long to import as a glyph to convert

    # The UFO rule makes no valid name of one that is too long in bytes, empty, or has lone surrogates.
    clipped = _NOT_TEXT.sub("_", name).encode()[: LONGEST_NAME // 2]  # capitals take two characters under the rules
    tame = clipped.decode(errors="ignore").rstrip(". ") or "_"
    return _free(userNameToFileName(tame, taken), "_", taken)


def _free(stem: str, hyphen: str, taken: set[str]) -> str:
    """The name, or if there is one like it already, with the least number that there is none with; it is taken then."""
    numbered = (f"{stem}{hyphen}{count}" for count in count_from(2))
    name = next(name for name in chain([stem], numbered) if _key(name) not in taken)
    taken.add(_key(name))
    return name


def _uni(code: int) -> str:
    """The name of a code point as in glyph names: ``uni9F8D``, ``u2000B``."""
    return f"uni{code:04X}" if code <= 0xFFFF else f"u{code:X}"


def _char(code: int) -> str:
    """The character, or the name of its code point if file names cannot have it or it is invisible."""
    character = chr(code)
    return character if _is_seen(character) and character not in '."*/:<>?[\\]|' else _uni(code)


def folders_for(fonts: Iterable[Path]) -> list[str]:
    """A folder name for each font from its file name; the names differ in more than case."""
    taken, found = set(_RESERVED), []
    for font in fonts:
        clipped = re.sub(r"[^\w-]", "-", font.name).encode()[:LONGEST_NAME].decode(errors="ignore")
        found.append(_free(clipped.strip("-") or "font", "-", taken))
    return found
