"""Damage done to fonts, UFOs and drawings: bytes, tables, outlines, words of texts, and parts of other files.

A source is one file or a folder. A mutant is a source of which one file was changed; a recipe says how, by its edits.
"""

from __future__ import annotations

import random
import re
import struct
import time
from collections.abc import Callable, Mapping, Sequence
from difflib import SequenceMatcher
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

from fontTools.ttLib import TTFont

from tests.places import FONTS

Files = Mapping[str, bytes]
"""Contents by path; the first part of all paths is what a command is given."""

EXTREMES = [0, 1, 0x7F, 0x80, 0xFF, 0x7FFF, 0x8000, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF]
COORDINATES = [-32768, -16384, -1, 0, 1, 2, 16384, 32767]
WORDS = b"0 -0 1 -1 0.5 nan inf 1e9 -1e9 1e308 1e-308 1e400 65536 4294967296 M m Z A C L Q T curve line x ..".split()
ENOUGH = 1 << 16
"""Bytes of a file that is not lengthened any more."""


class Mutant(NamedTuple):
    """A damaged source.

    Attributes:
        files: all of it. alone: the glyph whose data alone differ; None if others may.
    """

    files: Files
    alone: str | None = None


# Sources


@cache
def sources() -> dict[str, Files]:
    """What is damaged, by name: the test fonts, and the UFO, designspace and drawings beside this module."""
    paths = [path for path in sorted(FONTS.iterdir()) if path.suffix in (".ttf", ".otf", ".ttc", ".woff2")]
    found: dict[str, dict[str, bytes]] = {}
    for path in [*paths, *sorted((Path(__file__).parent / "sources").iterdir())]:
        files = sorted(path.rglob("*.*")) if path.is_dir() else [path]
        found[path.name] = {str(f.relative_to(path.parent)): f.read_bytes() for f in files if f.is_file()}
    return dict(found)


def given(files: Files) -> str:
    """The path that a command is given for a source."""
    return next((path for path in files if path.endswith(".designspace")), next(iter(files)).partition("/")[0])


# Damage


def mutant(rng: random.Random, files: Files) -> Mutant:
    """These files, one of them damaged."""
    path = rng.choice(sorted(files))
    data, alone = bytearray(files[path]), _glyph_of(path)
    if path.endswith((".plist", ".glif", ".designspace", ".svg")):
        for _ in range(rng.choice([1, 1, 2, 4])):
            data = rng.choice([words, words, words, lines, flip])(data, rng)
    elif rng.random() < 0.3:
        data, alone = outlines(data, rng)
    else:
        ways = [flip, extreme, directory, within_table, within_table, contents, cut, splice, swap]
        for _ in range(rng.choice([1, 1, 2, 4])):
            data = rng.choice(ways)(data, rng)
        if rng.random() < 0.5:
            data = repaired(data)
    return Mutant({**files, path: bytes(data)}, alone)


def _glyph_of(path: str) -> str | None:
    """The glyph that a file of a folder holds alone. The first drawing has the metrics of all."""
    name = re.fullmatch(r"(?:drawings/|Small\.ufo/glyphs/)(.)_?\.(?:svg|glif)", path)
    return name[1] if name and path != "drawings/A.svg" else None


def flip(data: bytearray, rng: random.Random) -> bytearray:
    """Change some bytes anywhere."""
    for _ in range(rng.choice([1, 8, 64])):
        data[rng.randrange(len(data))] = rng.randrange(256)
    return data


def extreme(data: bytearray, rng: random.Random) -> bytearray:
    """Write a number at the edge of its range, where a length or an offset may be."""
    size, code = rng.choice([(1, "B"), (2, "H"), (4, "I")])
    at = rng.randrange(max(1, len(data) - size))
    data[at : at + size] = struct.pack(f">{code}", rng.choice(EXTREMES) & (2 ** (8 * size) - 1))
    return data


def directory(data: bytearray, rng: random.Random) -> bytearray:
    """Change an entry of the table directory: tag, checksum, offset or length."""
    at = 12 + 16 * rng.randrange(12) + 4 * rng.randrange(4)
    if at + 4 <= len(data):
        data[at : at + 4] = struct.pack(">I", rng.choice([*EXTREMES, rng.randrange(2 * len(data))]))
    return data


def tables(data: bytes | bytearray) -> list[tuple[int, bytes, int, int]]:
    """Tables that lie in a font: where its directory has the entry, tag, offset and length."""
    count = struct.unpack_from(">H", data, 4)[0] if data[:4] in (b"\0\1\0\0", b"OTTO") and len(data) > 12 else 0
    found = []
    for at in range(12, min(12 + 16 * count, len(data) - 15), 16):
        tag, _, offset, length = struct.unpack_from(">4sIII", data, at)
        if length > 0 and offset + length <= len(data):
            found.append((at, tag, offset, length))
    return found


def within_table(data: bytearray, rng: random.Random) -> bytearray:
    """Change numbers of a table: extremes, or a little; most near its beginning, where its counts are."""
    if found := tables(data):
        _, _, offset, length = rng.choice(found)
        for _ in range(rng.choice([1, 1, 3])):
            at = offset + min(2 * rng.randrange(rng.choice([4, 24, 200, 1 + length // 2])), max(length - 2, 0))
            number = int.from_bytes(data[at : at + 2], "big") + rng.choice([-2, -1, 1, 2])
            data[at : at + 2] = struct.pack(">H", rng.choice([number, *EXTREMES]) & 0xFFFF)
    return data


def contents(data: bytearray, rng: random.Random) -> bytearray:
    """Give a table the contents of one of another font, or of another table."""
    other = rng.choice([files[name] for name, files in sources().items() if name in files and name != "a.svg"])
    mine, theirs = tables(data), tables(other)
    if mine and theirs and len(data) < ENOUGH:
        at, tag, _, _ = rng.choice(mine)
        same = [each for each in theirs if each[1] == tag]
        _, _, offset, length = rng.choice(same if same and rng.random() < 0.8 else theirs)
        data += bytes(-len(data) % 4)
        data[at + 8 : at + 16] = struct.pack(">II", len(data), length)
        data += other[offset : offset + length]
    return data


def repaired(data: bytearray) -> bytearray:
    """The same with the checksums of its tables."""
    for at, tag, offset, length in tables(data):
        if tag != b"head":
            words = data[offset : offset + length] + bytes(-length % 4)
            data[at + 4 : at + 8] = struct.pack(">I", sum(struct.unpack(f">{len(words) // 4}I", words)) & 0xFFFFFFFF)
    return data


def cut(data: bytearray, rng: random.Random) -> bytearray:
    """Keep only the beginning."""
    return data[: rng.randrange(4, len(data) + 1)] if len(data) > 4 else data


def splice(data: bytearray, rng: random.Random) -> bytearray:
    """Put a piece of another source somewhere."""
    other = rng.choice([part for files in sources().values() for part in files.values()])
    size = rng.choice([4, 32, 512, 4096])
    start, at = rng.randrange(len(other)), rng.randrange(len(data))
    data[at : at + size] = other[start : start + size]
    return data


def swap(data: bytearray, rng: random.Random) -> bytearray:
    """Let two entries of the table directory change places in all but their tags."""
    a, b = (16 + 16 * rng.randrange(10) for _ in range(2))
    if max(a, b) + 12 <= len(data):
        data[a : a + 12], data[b : b + 12] = data[b : b + 12], data[a : a + 12]
    return data


def words(data: bytearray, rng: random.Random) -> bytearray:
    """Put another word or number in place of one of a text, or of some."""
    found = list(re.finditer(rb"[-+]?[0-9.]+(?:e[-+]?\d+)?|\w+", data))
    for _ in range(rng.choice([1, 1, 5]) if found else 0):
        one = rng.choice(found)
        new = rng.choice([rng.choice(found)[0], rng.choice(WORDS), b"", one[0] * rng.choice([2, 50])])
        data[one.start() : one.end()] = new.ljust(one.end() - one.start())
    return data if len(data) < ENOUGH else data[:ENOUGH]


def lines(data: bytearray, rng: random.Random) -> bytearray:
    """Leave out lines of a text, repeat them or let them change places."""
    parts = bytes(data).splitlines(keepends=True) or [b""]
    a, b = (rng.randrange(len(parts)) for _ in range(2))
    way = rng.randrange(3)
    if way == 0:
        del parts[a : a + rng.choice([1, 1, 3])]
    elif way == 1 and len(data) < ENOUGH:
        parts[b:b] = parts[a : a + 2] * rng.choice([1, 1, 2, 300])
    else:
        parts[a], parts[b] = parts[b], parts[a]
    return bytearray(b"".join(parts) or b" ")


def outlines(data: bytearray, rng: random.Random) -> tuple[bytearray, str | None]:
    """Change the drawing of a glyph, as fontTools reads and writes it: coordinates, flags, ends, deltas, axes.

    Returns:
        The font, and the glyph if other glyphs stay as they are. Unchanged if fontTools cannot read or write it.
    """
    try:
        font = TTFont(BytesIO(bytes(data)), recalcBBoxes=False, recalcTimestamp=False, fontNumber=0, lazy=False)
        name = rng.choice(font.getGlyphOrder())
        if "fvar" in font and rng.random() < 0.3:
            axis = rng.choice(font["fvar"].axes)
            setattr(axis, rng.choice(["minValue", "defaultValue", "maxValue"]), rng.choice([-32768, 0, 400.5, 32767]))
        elif "gvar" in font and font["gvar"].variations.get(name) and rng.random() < 0.5:
            deltas = rng.choice(font["gvar"].variations[name]).coordinates
            deltas[rng.randrange(len(deltas))] = rng.choice([None, (rng.choice(COORDINATES), rng.choice(COORDINATES))])
        elif "glyf" in font:
            points(font["glyf"][name], rng)
        else:
            top = font["CFF " if "CFF " in font else "CFF2"].cff.topDictIndex[0]
            string = top.CharStrings[name]
            string.decompile()
            charstring(string.program, rng)
        font.flavor, out = None, BytesIO()
        font.save(out)
    except Exception:  # the font may be broken already
        return data, None
    return bytearray(out.getvalue()), None if "fvar" in font else name


def points(glyph: Any, rng: random.Random) -> None:
    """Change points of a TrueType glyph, or components."""
    if glyph.isComposite():
        part = rng.choice(glyph.components)
        part.x, part.y = rng.choice(COORDINATES), rng.choice(COORDINATES)
        part.transform = [[rng.choice([-2, -1, 0, 0.5, 1.99]) for _ in range(2)] for _ in range(2)]
        return
    many = len(getattr(glyph, "coordinates", ()))
    for _ in range(rng.choice([1, 2, 2 * many]) if many else 0):
        k, way = rng.randrange(many), rng.randrange(5)
        x, y = glyph.coordinates[k]
        if way == 0:
            glyph.coordinates[k] = rng.choice(COORDINATES), rng.choice(COORDINATES)
        elif way == 1:
            glyph.coordinates[k] = glyph.coordinates[rng.randrange(many)]
        elif way == 2:
            glyph.coordinates[k] = x + rng.choice([-1, 0, 1]), y + rng.choice([-1, 0, 1])
        elif way == 3:
            glyph.flags[k] ^= 1
        else:
            ends = glyph.endPtsOfContours
            ends[rng.randrange(len(ends))] = rng.randrange(many)
            glyph.endPtsOfContours = [*sorted(ends)[:-1], many - 1]


def charstring(program: list[Any], rng: random.Random) -> None:
    """Change numbers and operators of a CFF glyph's program."""
    for _ in range(rng.choice([1, 2, len(program)])):
        k = rng.randrange(len(program))
        if isinstance(program[k], int | float):
            program[k] = rng.choice([*COORDINATES, program[k] + 1, -program[k]])
        elif rng.random() < 0.5 and isinstance(program[k], str):
            program[k] = rng.choice(
                ["rlineto", "rrcurveto", "rmoveto", "hhcurveto", "vvcurveto", "flex", "endchar", "callsubr"]
            )


# Recipes

Edit = tuple[str, int, int, str]
"""In a file, at a place, so many bytes are replaced by these, in hexadecimal."""


def edits_of(name: str, files: Files) -> list[Edit]:
    """The edits that make files of a source."""
    found: list[Edit] = []
    for path, before in sources()[name].items():
        after = files[path]
        if len(before) == len(after):
            found += [(path, k, 1, after[k : k + 1].hex()) for k in range(len(after)) if before[k] != after[k]]
        else:
            blocks = SequenceMatcher(None, before, after, autojunk=False).get_opcodes()
            found += [(path, a, b - a, after[c:d].hex()) for way, a, b, c, d in blocks if way != "equal"]
    return found


def made(name: str, edits: Sequence[Sequence[Any]]) -> Files:
    """A source with edits made."""
    files = {path: bytearray(data) for path, data in sources()[name].items()}
    for path, at, length, new in sorted(edits, key=lambda edit: edit[1], reverse=True):
        files[path][at : at + length] = bytes.fromhex(new)
    return {path: bytes(data) for path, data in files.items()}


def reduced(edits: list[Edit], still: Callable[[list[Edit]], bool], patience: float = 120.0) -> list[Edit]:
    """Leave out halves, quarters and so on of edits while the fault stays, for no longer than ``patience`` seconds."""
    end, parts = time.monotonic() + patience, 2
    while len(edits) > 1 and time.monotonic() < end:
        size = -(-len(edits) // parts)
        rests = [edits[:k] + edits[k + size :] for k in range(0, len(edits), size)]
        fewer = next((rest for rest in rests if time.monotonic() < end and still(rest)), None)
        if fewer is None and size == 1:
            break
        edits, parts = (edits, min(2 * parts, len(edits))) if fewer is None else (fewer, max(parts - 1, 2))
    return edits
