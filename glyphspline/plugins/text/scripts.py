"""Scripts of characters as runs need them (UAX #24), and which are upright in vertical lines (UAX #50)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, lru_cache
from itertools import pairwise

from fontTools.unicodedata import script, script_extension

from .bidi import CLOSING

COMMON = frozenset({"Zyyy", "Zinh", "Zzzz"})
"""Common, inherited and unknown: such characters take the script of their neighbours."""

PAIRS = {**CLOSING, "«": "»", "‹": "›", "“": "”", "‘": "’"}
"""Opening to closing bracket or quotation mark."""

JOINED = {
    "Adlm", "Arab", "Aran", "Beng", "Chrs", "Deva", "Guru", "Mand", "Mani", "Mong", "Nkoo", "Ougr", "Phag", "Phlp",
    "Rohg", "Sogd", "Syrc", "Tirh",
}  # fmt: skip
"""Scripts whose letters join, by a stroke or a headline."""

UPRIGHT = """
A7 A9 AE B1 BC-BE D7 F7 2EA-2EB 1100-11FF 1401-167F 18B0-18F5 2016 2020-2021 2030-2031 203B-203C 2042 2047-2049 2051
20DD-20E0 20E2-20E4 2100-2101 2103-2109 210F 2113-2114 2116-2117 211E-2123 2125 2127 2129 212E 2135-213F 2145-214A
214C-214D 214F-2189 221E 2234-2235 2300-2307 230C-231F 2324-232B 237D-239A 23BE-23CD 23CF 23D1-23DB 23E2-2422 2424-24FF
25A0-2619 2620-2767 2776-2793 2B12-2B2F 2B50-2B59 2B97 2BB8-2BD1 2BD3-2BEB 2BF0-2BFF 2E50-2E51 2E80-A4C6 A960-A97C
AC00-D7FB E000-FAD9 FE10-FE19 FE30-FE48 FE50-FE57 FE59-FE62 FE68-FE6B FF01-FF0C FF0E-FF1B FF1F-FF60 FFE0-FFE6 FFFC-FFFD
10980-1099F 11580-115DD 11A00-11ABF 13000-14646 16FE0-1B2FB 1CF00-1D1EA 1D2E0-1D378 1D800-1DAAF 1F000-1F7F0 1F900-1FAF6
20000-3134A F0000-10FFFD
"""
"""The code points whose Vertical_Orientation is not R, in Unicode 15; gaps that no character is in are closed."""


@lru_cache(maxsize=4096)
def _script(character: str) -> tuple[str, frozenset[str]]:
    """The script of a character, and the scripts it is used with; none for what is used with all."""
    return script(character), frozenset(script_extension(character)) - COMMON


def scripts_of(text: str) -> list[str]:
    """The script of each character, by ISO 15924.

    Characters common to several scripts take that of the characters before them, or of those after them at the
    beginning, if they are used with it. A closing bracket or quotation mark takes that of the opening one.
    """
    known = {character: _script(character) for character in set(text)}
    strong = {own for own, _ in known.values()} - COMMON
    if len(strong) < 2 and all(own not in COMMON or with_ <= strong for own, with_ in known.values()):
        return [next(iter(strong), "Zyyy")] * len(text)
    found, brackets = [""] * len(text), list[tuple[str, str]]()
    current = next((known[character][0] for character in text if known[character][0] not in COMMON), "Zyyy")
    for i, character in enumerate(text):
        own, with_ = known[character]
        if own not in COMMON:
            current = own
        elif with_ and current not in with_:
            # A prolonged sound mark after a Chinese character belongs to the kana that follow, for instance.
            later = (known[other][0] for other in text[i + 1 : i + 32])
            after = next((other for other in later if other not in COMMON), "")
            current = after if after in with_ else min(with_)
        elif character in PAIRS:
            brackets.append((PAIRS[character], current))
        elif any(character == closing for closing, _ in brackets[-8:]):
            while brackets[-1][0] != character:
                brackets.pop()
            current = brackets.pop()[1]
        found[i] = current
    return found


def upright_in_columns(text: str, clusters: Sequence[int]) -> list[bool]:
    """Whether each character is upright in a vertical line; others are turned with their line, clockwise.

    A grapheme cluster is set as its first character.
    """
    stands = {character: _stands(character) for character in set(text)}
    found = [False] * len(text)
    for a, b in pairwise(clusters):
        found[a:b] = [stands[text[a]]] * (b - a)
    return found


@cache
def _stands(character: str) -> bool:
    ends = (entry.split("-") for entry in UPRIGHT.split())
    return any(int(pair[0], 16) <= ord(character) <= int(pair[-1], 16) for pair in ends)
