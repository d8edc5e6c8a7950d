"""The worst fonts that are known, built here: each asks for far more time, memory or disk than its file has bytes."""

from __future__ import annotations

import struct
from array import array
from collections.abc import Sequence
from pathlib import Path

import brotli
import numpy as np
from fontTools.cffLib import SubrsIndex
from fontTools.fontBuilder import FontBuilder
from fontTools.misc.psCharStrings import T2CharString
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import Glyph, GlyphCoordinates
from fontTools.ttLib.tables.DefaultTable import DefaultTable
from fontTools.ttLib.tables.ttProgram import Program

Points = Sequence[tuple[float, float]]

SQUARE = ((0, 0), (0, 500), (500, 500), (500, 0))


def built(glyphs: dict[str, object], *, cff: bool = False) -> FontBuilder:
    """A font of glyphs; "a", "b", … are their characters."""
    builder = FontBuilder(1000, isTTF=not cff)
    builder.font.recalcBBoxes = False
    builder.setupGlyphOrder(list(glyphs))
    builder.setupCharacterMap({ord("a") + k: name for k, name in enumerate(glyphs) if k < 26})
    if cff:
        builder.setupCFF("Worst", {}, glyphs, {})
    else:
        builder.setupGlyf(glyphs, calcGlyphBounds=False)
    builder.setupHorizontalMetrics(dict.fromkeys(glyphs, (600, 0)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupNameTable({"familyName": "Worst", "styleName": "Regular"})
    builder.setupPost(keepGlyphNames=not cff)
    return builder


def record(contours: Sequence[Points]) -> Glyph:
    """A glyph of ``glyf`` of polygons."""
    glyph = Glyph()
    points = [point for contour in contours for point in contour]
    glyph.numberOfContours = len(contours)
    glyph.endPtsOfContours = (np.cumsum([len(contour) for contour in contours]) - 1).tolist()
    glyph.coordinates = GlyphCoordinates(points)
    glyph.flags = array("B", [1] * len(points))
    glyph.program = Program()
    glyph.program.fromBytecode(b"")
    glyph.xMin = glyph.yMin = glyph.xMax = glyph.yMax = 0
    return glyph


def composite(*parts: str) -> Glyph:
    """A glyph of ``glyf`` of others."""
    pen = TTGlyphPen(dict.fromkeys(parts))
    for part in parts:
        pen.addComponent(part, (1, 0, 0, 1, 0, 0))
    glyph = pen.glyph()
    glyph.xMin = glyph.yMin = glyph.xMax = glyph.yMax = 0
    return glyph


def string(*contours: Points) -> T2CharString:
    """A char string of polygons."""
    pen = T2CharStringPen(600, None)
    for first, *others in contours:
        pen.moveTo(first)
        for point in others:
            pen.lineTo(point)
        pen.closePath()
    return pen.getCharString()


def triangles(count: int) -> list[Points]:
    """So many contours, on a grid."""
    corners = [(k % 256 * 4, k // 256 * 4) for k in range(count)]
    return [((x, y), (x + 3, y), (x, y + 3)) for x, y in corners]


def tangle(count: int) -> Points:
    """A contour of so many random points, whose segments cross each other by the million."""
    return [(float(x), float(y)) for x, y in np.random.default_rng(1).integers(0, 1000, (count, 2))]


def truetype(path: Path) -> None:
    """A variable font, of which "a", "b" and "c" are sound glyphs.

    Components of components, 10¹⁰ squares at last; two that contain themselves; as many contours and points as a record
    can have, varying in 4,000 regions, and three times these; and contours that cross themselves by the thousand.
    """
    most = record(triangles(21_845))
    glyphs: dict[str, object] = {".notdef": record([SQUARE]), "sound": record([SQUARE]), "laugh0": record([SQUARE])}
    for k in range(10):
        glyphs[f"laugh{k + 1}"] = composite(*[f"laugh{k}"] * 10)
    glyphs |= {"self": composite("self"), "loop": composite("pool"), "pool": composite("sound", "loop")}
    glyphs |= {"tangle": record([tangle(3000)]), "thrice": composite(*["most"] * 3), "most": most}
    builder = built(glyphs)
    builder.setupFvar([("wght", 0, 0, 1000, "Weight")], [{"location": {"wght": 500}, "stylename": "Half"}])
    last, count = len(glyphs) - 1, 4000
    zeros = bytes([0x80 | 63]) * 1024 + bytes([0x80 | 2])  # of 65,535 points and four of the metrics
    data = b"\0" + 2 * zeros  # for all points
    heads = b"".join(struct.pack(">HHhhh", len(data), 0xE000, 2 + 4 * k, 1 + 4 * k, 3 + 4 * k) for k in range(count))
    one = struct.pack(">HH", count, 4 + len(heads)) + heads + data * count
    gvar = DefaultTable("gvar")
    gvar.data = struct.pack(">HHHHLHHL", 1, 0, 1, 0, 20 + 4 * (last + 2), last + 1, 1, 20 + 4 * (last + 2))
    gvar.data += struct.pack(f">{last + 2}L", *[0] * (last + 1), len(one)) + one
    save_with(builder, path, gvar)


def postscript(path: Path) -> None:
    """A font of char strings, of which "a" and "b" are sound.

    Subroutines that each call the next a hundred times, down to where something is drawn; one that calls itself; 65,535
    contours; and a contour of 250,000 lines.
    """
    bias = 107
    inner = T2CharString(program=[1, 1, "rlineto"] * 8 + ["return"])
    calls = [T2CharString(program=[k + 1 - bias, "callsubr"] * 100 + ["return"]) for k in range(8)]
    own = T2CharString(program=[9 - bias, "callsubr", "return"])
    glyphs = {
        ".notdef": string(SQUARE),
        "sound": string(SQUARE),
        "nested": T2CharString(program=[600, 0, 0, "rmoveto", -bias, "callsubr", "endchar"]),
        "self": T2CharString(program=[600, 0, 0, "rmoveto", 9 - bias, "callsubr", "endchar"]),
        "most": string(*triangles(65_535)),
        "long": string([(k % 700, (k * k) % 900) for k in range(250_000)]),
    }
    builder = built(glyphs, cff=True)
    private = builder.font["CFF "].cff.topDictIndex[0].Private
    private.Subrs = SubrsIndex()
    for subroutine in [*calls, inner, own]:
        private.Subrs.append(subroutine)
    builder.save(path)


def save_with(builder: FontBuilder, path: Path, table: DefaultTable) -> None:
    """Save a font with a table as it is."""
    builder.save(path)
    font = TTFont(path, recalcBBoxes=False)
    font[table.tableTag] = table
    font.save(path)


def plain(path: Path) -> FontBuilder:
    """A font of one square, which is saved."""
    builder = built({".notdef": record([SQUARE]), "plain": record([SQUARE])})
    builder.save(path)
    return builder


def with_characters(path: Path, subtable: bytes) -> None:
    """A font of one square, with a subtable of characters."""
    cmap = DefaultTable("cmap")
    cmap.data = struct.pack(">HHHHL", 0, 1, 3, 10 if subtable[:2] != b"\0\4" else 1, 12) + subtable
    save_with(plain(path), path, cmap)


def groups(*all_groups: tuple[int, int, int]) -> bytes:
    """A subtable of format 12: first and last code point, and the first glyph."""
    data = b"".join(struct.pack(">LLL", *group) for group in all_groups)
    return struct.pack(">HHLLL", 12, 0, 16 + len(data), 0, len(all_groups)) + data


def all_characters(path: Path) -> None:
    """All 1,114,112 code points have the same glyph."""
    with_characters(path, struct.pack(">H", 13) + groups((0, 0x10FFFF, 1))[2:])


def more_characters(path: Path) -> None:
    """Four milliards of code points, in a group."""
    with_characters(path, groups((0, 0xFFFFFFFF, 0)))


def many_groups(path: Path) -> None:
    """A thousand groups of all code points each."""
    with_characters(path, groups(*[(0, 0x10FFFF, 0)] * 1000))


def many_segments(path: Path) -> None:
    """8,000 segments of format 4, of 65,535 code points each."""
    n = 8000
    words = [struct.pack(f">{n}H", *[value] * n) for value in (0xFFFE, 0, 0, 0)]
    body = struct.pack(">HHHH", 2 * n, 0, 0, 0) + words[0] + b"\0\0" + b"".join(words[1:])
    with_characters(path, struct.pack(">HHH", 4, (6 + len(body)) & 0xFFFF, 0) + body)


def inflating(path: Path, length: int) -> None:
    """A WOFF2 of a kilobyte whose only table has a gigabyte; its directory says that it has ``length`` bytes."""
    packer, chunk = brotli.Compressor(quality=5), bytes(1 << 24)
    packed = b"".join([packer.process(chunk) for _ in range(64)]) + packer.finish()
    digits = [length >> shift & 0x7F for shift in (28, 21, 14, 7, 0)]
    while len(digits) > 1 and not digits[0]:
        del digits[0]
    directory = b"\x3fJUNK" + bytes([digit | 0x80 for digit in digits[:-1]] + digits[-1:])
    size = 48 + len(directory) + len(packed)
    head = struct.pack(">4s4sLHHLLHHLLLLL", b"wOF2", b"\0\1\0\0", size, 1, 0, 28, len(packed), 1, 0, 0, 0, 0, 0, 0)
    path.write_bytes(head + directory + packed)


def many_faces(path: Path) -> None:
    """A collection of 60,000 faces, all of them the same."""
    plain(path)
    count, font = 60_000, path.read_bytes()
    start = 12 + 4 * count
    tables = struct.unpack_from(">H", font, 4)[0]
    moved = bytearray(font)
    for k in range(tables):
        (offset,) = struct.unpack_from(">L", font, 12 + 16 * k + 8)
        struct.pack_into(">L", moved, 12 + 16 * k + 8, offset + start)
    path.write_bytes(b"ttcf" + struct.pack(">HHL", 1, 0, count) + struct.pack(">L", start) * count + bytes(moved))
