"""Names of glyphs' files, the same whatever is selected, and of folders: safe everywhere, unlike in any case."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import chain
from itertools import count as count_from
from pathlib import Path
from types import MappingProxyType
from unicodedata import category, normalize

from ..readers.clusters import unified
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
    asked: Mapping[str, str] = MappingProxyType({}),
    held: Mapping[int, str] = MappingProxyType({}),
) -> list[str]:
    """A file name, without suffix, for each chosen glyph; no two of a font are alike without regard to case.

    They depend on all glyphs of the font, in order, not on which of them are chosen; but a glyph that was asked for by
    another character than the one it is usually called by is called by that.

    Args:
        glyph_names: of all glyphs of the font.
        names: "glyph", the glyph's name; "unicode", its code point, as in ``uni9F8D``; "gid", its index; "char", its
            character. Glyphs without a code point keep their names; of several it is :func:`.clusters.unified`.
        cmap: code point to glyph name.
        chosen: glyph indices; None: all.
        asked: glyph name to the character that was asked for. Another glyph that has its code point, and does not show
            it where the font is read, keeps its name.
        held: names that glyphs have already, by glyph index.
    """
    chosen = range(len(glyph_names)) if chosen is None else chosen
    if names == "gid":
        return [f"{gid:05}" for gid in chosen]
    wanted, ahead = list(glyph_names), set[int]()
    if names != "glyph" and cmap is not None:
        wanted, ahead = _by_character(glyph_names, _uni if names == "unicode" else _char, cmap, asked)
    # Names that can be taken as they are stay so; of the others, and of those that clash, the UFO rule makes names.
    keys = list(map(_key, wanted))
    counts, counts_ahead = Counter(keys), Counter([keys[gid] for gid in ahead])

    def stays(gid: int) -> bool:
        return (counts_ahead if gid in ahead else counts)[keys[gid]] == 1 and _is_plain(wanted[gid], keys[gid])

    if not all(map(stays, chosen)):  # then names depend on what is taken, and on those made before
        staying = list(map(stays, range(len(wanted))))
        taken = {key for key, stay in zip(keys, staying, strict=True) if stay}
        wanted = [name if stay else _by_rule(name, taken) for name, stay in zip(wanted, staying, strict=True)]
    if not held:
        return [wanted[gid] for gid in chosen]
    taken = set(map(_key, held.values()))
    return [held.get(gid) or _free(wanted[gid], "_", taken) for gid in chosen]


def _by_character(
    glyph_names: Sequence[str], named: Callable[[int], str], cmap: Mapping[int, str], asked: Mapping[str, str]
) -> tuple[list[str], set[int]]:
    """The names that glyphs are to have by their characters; which of them have another than the unified one."""
    codes: dict[str, list[int]] = {}
    for code, name in cmap.items():
        codes.setdefault(name, []).append(code)
    usual = {name: chr(of_name[0] if len(of_name) == 1 else unified(of_name)) for name, of_name in codes.items()}
    other = {name: one for name, c in asked.items() if (one := normalize("NFC", c)) != usual.get(name)}
    seen = {character: name for name, character in other.items()}
    characters = usual | other
    wanted = list(glyph_names)
    for gid, name in enumerate(glyph_names):
        if (character := characters.get(name)) and seen.get(character, name) == name:
            wanted[gid] = "-".join([named(ord(each)) for each in character])
    return wanted, {gid for gid, name in enumerate(glyph_names) if name in other}


def _key(name: str) -> str:
    """What file systems compare: some ignore case, some how accents are composed."""
    return name.lower() if name.isascii() else normalize("NFC", name).casefold()


def _is_plain(name: str, key: str) -> bool:
    if _PLAIN.fullmatch(name) is not None:
        return key not in _RESERVED and ("." not in key or _RESERVED.isdisjoint(key.split(".")))
    return not name.isascii() and len(name) == 1 and _is_seen(name)


def _is_seen(character: str) -> bool:
    return category(character)[0] in "LNPS"


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
