"""Bulk reading gives what the pen gives, glyph by glyph: points, degrees, advances, notes and errors."""

from __future__ import annotations

import struct
from array import array
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import accumulate
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import Glyph, GlyphCoordinates
from fontTools.ttLib.tables.ttProgram import Program

from glyphspline.errors import FontError, GlyphsplineError
from glyphspline.outlines.outline import FontMetrics, Outline
from glyphspline.plugins.checks.check import check
from glyphspline.readers import Font, open_font, open_source
from glyphspline.readers.opentype import bulk
from glyphspline.readers.opentype.bulk import BulkReader
from glyphspline.readers.opentype.routes import Face
from glyphspline.readers.pens import ContourPen
from glyphspline.readers.source import attempt
from glyphspline.types import Head
from tests.places import FACES, FONTS
from tests.readers.test_broken_fonts import with_components


def heads_of(font: Font) -> list[Head]:
    codes: dict[str, list[int]] = {}
    for code, name in sorted(font.cmap.items()):
        codes.setdefault(name, []).append(code)
    return [Head(name, gid, tuple(codes.get(name, ()))) for gid, name in enumerate(font.glyph_names)]


def read_carefully(font: Font, head: Head) -> Outline | GlyphsplineError:
    """A glyph drawn with the pen: through HarfBuzz, or fontTools where a number of contours says that some are lost."""

    def read() -> Outline:
        _, (expected,) = font._bulk._draw([head.gid])
        pen, advance = ContourPen(), float(font.shaper.get_glyph_h_advance(head.gid))
        font.shaper.draw_glyph_with_pen(head.gid, pen)
        pen.finish()
        if expected == bulk.UNUSUAL or (expected >= 0 and pen.drawn != expected):
            return font._face.by_fonttools(head, font.metrics)
        return Outline(*head, advance, pen.contours, font.metrics, pen.notes, pen.snapped)

    return attempt(font.path, head.name, read)


def assert_same(found: Outline | GlyphsplineError, expected: Outline | GlyphsplineError) -> None:
    if isinstance(expected, GlyphsplineError):
        assert (type(found), str(found)) == (type(expected), str(expected))
        return
    assert isinstance(found, Outline), found
    assert (found.name, found.gid, found.unicodes, found.advance) == (
        expected.name, expected.gid, expected.unicodes, expected.advance
    )  # fmt: skip
    assert (found.metrics, found.notes) == (expected.metrics, expected.notes)
    repeats, others = (each.repeats.tolist() for each in (found, expected))
    assert repeats == others, found.name
    for own, other in zip(found.arrays, expected.arrays, strict=True):
        assert (own.dtype, own.shape, own.tobytes()) == (other.dtype, other.shape, other.tobytes()), found.name


def assert_all_same(font: Font, glyphs: int | None = None, size: int = bulk.PASS) -> int:
    """Compare all glyphs, read by the font and by a reader of its own; how many have an error."""
    heads = heads_of(font)[:glyphs]
    by_font = font.outlines([head.name for head in heads], errors="return")
    alone = BulkReader(font.path, font._face, size).outlines(heads, font.metrics)
    for head, *both in zip(heads, by_font, alone, strict=True):
        expected = read_carefully(font, head)
        for found in both:
            assert_same(found, expected)
    return sum(isinstance(found, GlyphsplineError) for found in by_font)


@pytest.mark.parametrize(("file", "face_index", "location"), FACES)
def test_every_glyph_is_as_the_pen_has_it(file: str | Path, face_index: int, location: dict[str, float]) -> None:
    assert assert_all_same(open_font(FONTS / file, face_index, location)) == 0


@pytest.mark.parametrize(("file", "face_index", "location"), FACES)
def test_callbacks_of_plain_python_draw_the_same(
    file: str | Path, face_index: int, location: dict[str, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bulk, "_are_compiled", lambda: False)
    assert_all_same(open_font(FONTS / file, face_index, location), 40)


def test_a_callback_that_raises_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """HarfBuzz's bindings print what a callback raises, and go on with half a glyph."""
    font, record = open_font(FONTS / "kouzan-gyosho.otf"), bulk._record

    def failing(buffer: Any, kind: int, coordinates: Any) -> None:
        if kind == 3 and buffer[bulk.USED] > 40:
            raise ZeroDivisionError("of all things")
        record(buffer, kind, coordinates)

    expected = font.outline("A")
    monkeypatch.setattr(bulk, "_are_compiled", lambda: False)
    monkeypatch.setattr(bulk, "_record", failing)
    with pytest.raises(ZeroDivisionError, match="of all things"):
        font.outline("A")
    monkeypatch.setattr(bulk, "_record", record)
    assert_same(font.outline("A"), expected)


def counting(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The names of glyphs that are drawn again from now on."""
    read: list[str] = []
    by_fonttools = Face.by_fonttools

    def counted(self: Face, head: Head, metrics: FontMetrics) -> Outline:
        read.append(head.name)
        return by_fonttools(self, head, metrics)

    monkeypatch.setattr(Face, "by_fonttools", counted)
    return read


@pytest.mark.parametrize(("file", "face_index", "location"), FACES)
def test_usual_glyphs_and_spaces_are_drawn_once(
    file: str | Path, face_index: int, location: dict[str, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    read = counting(monkeypatch)
    font = open_font(FONTS / file, face_index, location)
    found = font.outlines(font.glyph_names)
    assert read == []
    assert len(found) == font.num_glyphs


Points: TypeAlias = list[tuple[int, int, int]]
"""Of a contour: x, y, and 1 for a point on the curve, 0 for one off it."""

SQUARE: Points = [(0, 0, 1), (300, 0, 1), (300, 300, 1), (0, 300, 1)]
ROUND: Points = [(400, 0, 0), (600, 0, 0), (600, 200, 0), (400, 200, 0)]
ON, OFF, LINE = [(50, 60, 1)], [(70, 80, 0)], [(0, 0, 1), (40, 40, 1)]


def simple(*contours: Points) -> Glyph:
    glyph, points = Glyph(), [point for contour in contours for point in contour]
    glyph.numberOfContours = len(contours)
    glyph.endPtsOfContours = [k - 1 for k in accumulate(map(len, contours))]
    glyph.coordinates = GlyphCoordinates([point[:2] for point in points])
    glyph.flags = array("B", [point[2] for point in points])
    glyph.program = Program()
    glyph.program.fromBytecode(b"")
    return glyph


def composite(*parts: tuple[str, tuple[float, ...]]) -> Glyph:
    pen = TTGlyphPen(dict.fromkeys(name for name, _ in parts))
    for name, transform in parts:
        pen.addComponent(name, transform)
    return pen.glyph()


PLAIN, MOVED, HALF = (1, 0, 0, 1, 0, 0), (1, 0, 0, 1, 30, -20), (0.5, 0, 0.25, 0.5, 10, 10)
ANCHORED: dict[str, tuple[Glyph, tuple[int, ...]]] = {
    "first": (simple(ON, SQUARE, ROUND), (0,)),
    "middle": (simple(SQUARE, OFF, ROUND), (1,)),
    "last": (simple(SQUARE, ROUND, ON), (2,)),
    "many": (simple(ON, OFF, SQUARE, ON, ON, ROUND, OFF), (0, 1, 3, 4, 6)),
    "only": (simple(OFF), (0,)),
    "pair": (simple(ON, ON), (0, 1)),
    "twice": (simple([(5, 5, 1), (5, 5, 1), (5, 5, 1)], SQUARE), (0,)),
    "plain": (simple(SQUARE), ()),
    "composed": (composite(("first", PLAIN), ("plain", MOVED), ("middle", HALF)), (0, 5)),
    "nested": (composite(("composed", MOVED), ("only", HALF), ("last", PLAIN)), (0, 5, 7, 10)),
    "lines": (simple(LINE, ON, SQUARE, LINE, ROUND, LINE), (0, 1, 3, 5)),
    "there and back": (simple(SQUARE, [(0, 0, 1), (90, 30, 0), (300, 100, 1), (30, 10, 1)]), (1,)),
}
"""Glyphs with contours that are flat, mainly single points; and the numbers of those left out."""


def with_anchors(path: Path) -> None:
    build(path, {name: glyph for name, (glyph, _) in ANCHORED.items()})


def build(path: Path, glyphs: dict[str, Glyph]) -> None:
    glyphs = {".notdef": simple(SQUARE)} | glyphs
    builder = FontBuilder(1000, isTTF=True)
    builder.setupGlyphOrder(list(glyphs))
    builder.setupCharacterMap({})
    builder.setupGlyf(glyphs)
    builder.setupHorizontalMetrics({name: (700 + k, 20) for k, name in enumerate(glyphs)})
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupPost()
    builder.save(path)


def test_flat_contours_are_left_out_and_noted_in_bulk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with_anchors(tmp_path / "anchors.ttf")
    font = open_font(tmp_path / "anchors.ttf")
    assert assert_all_same(font) == 0
    read = counting(monkeypatch)
    found = {outline.name: outline for outline in font.outlines(list(ANCHORED))}
    assert read == []
    for name, (_, left_out) in ANCHORED.items():
        assert found[name].notes == tuple(f"contour {k} left out: it encloses nothing" for k in left_out), name
    assert [len(found[name].contours) for name in ("first", "only", "composed", "nested")] == [2, 0, 5, 7]


def test_points_that_are_there_more_than_once_are_kept_in_mind(tmp_path: Path) -> None:
    again = [*SQUARE[:2], SQUARE[1], *SQUARE[2:]]
    glyphs = {
        "middle": simple(again), "thrice": simple(ROUND, [*again[:2], *again[1:]]),
        "start": simple([SQUARE[0], *SQUARE]), "end": simple([*SQUARE, SQUARE[0]]),
    }  # fmt: skip
    glyphs["composed"] = composite(("plain", PLAIN), ("middle", HALF), ("thrice", MOVED))
    build(tmp_path / "again.ttf", {"plain": simple(SQUARE)} | glyphs)
    font = open_font(tmp_path / "again.ttf")
    assert assert_all_same(font) == 0
    assert not font.outline("plain").repeats.any()
    expected = {"middle": [(0, 1, 1)], "thrice": [(1, 1, 2)], "start": [(0, 0, 1)], "end": [(0, 0, 1)]}
    expected["composed"] = [(1, 1, 1), (3, 1, 2)]
    for name, places in expected.items():
        outline = font.outline(name)
        assert list_of(outline.repeats, outline.arrays.offsets) == places, name
        masters = font.masters(name)
        assert list_of(masters.repeats, outline.arrays.offsets) == places, name
        found = [(each.contour, each.segment, each.value) for each in check(outline) if each.kind == "repeated"]
        assert sorted(found) == places


def list_of(repeats: Any, offsets: Any) -> list[tuple[int, int, int]]:
    """Contour, segment and count of points that are there more than once."""
    found = [(int(np.searchsorted(offsets, j, side="right")) - 1, int(j)) for j in np.flatnonzero(repeats)]
    return [(contour, j - int(offsets[contour]), int(repeats[j])) for contour, j in found]


def test_one_rule_says_which_contours_are_flat(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    heights = {"flat": 4, "below": 15, "above": 18, "wide": 80}  # times 1/16384 of a unit
    glyphs = {f"high {name}": simple([(0, 0, 1), (200, 0, 1), (100, y, 1)]) for name, y in heights.items()}
    glyphs |= {name: composite((f"high {name}", (1, 0, 0, 2**-14, 0, 0))) for name in heights}
    build(tmp_path / "slivers.ttf", glyphs)
    font = open_font(tmp_path / "slivers.ttf")
    assert assert_all_same(font) == 0
    read = counting(monkeypatch)
    found = font.outlines(list(heights))
    assert read == []
    assert [len(outline.contours) for outline in found] == [0, 0, 1, 1]


def test_flat_contours_are_those_that_fonttools_draws_flat(tmp_path: Path) -> None:
    with_anchors(tmp_path / "anchors.ttf")
    font = open_font(tmp_path / "anchors.ttf")
    for outline in font.outlines(list(ANCHORED)):
        other = font._face.by_fonttools(Head(outline.name, outline.gid), font.metrics)
        assert (outline.notes, outline.advance) == (other.notes, other.advance)
        assert len(outline.contours) == len(other.contours)
        for own, its in zip(outline.contours, other.contours, strict=True):
            np.testing.assert_array_equal(own.degrees, its.degrees)
            np.testing.assert_allclose(own.points, its.points, rtol=0, atol=0.5)  # fontTools rounds components


def test_contours_are_views_of_arrays_that_the_glyphs_share() -> None:
    font = open_font(FONTS / "kouzan-gyosho.otf")
    first, second = font.outlines(["uni9F8D", "A"])
    assert first.arrays.points.base is second.arrays.points.base is not None
    assert first.contours[0].points.base is first.arrays.points.base


@pytest.mark.parametrize("size", [1 << 8, 1 << 10, 1 << 12])
def test_glyphs_that_fill_the_buffer_are_read_in_several_passes(size: int) -> None:
    for file in ("kouzan-gyosho.otf", "edge-cases.ttf"):
        assert assert_all_same(open_font(FONTS / file), size=size) == 0


def test_no_glyphs_give_no_outlines() -> None:
    assert open_font(FONTS / "edge-cases.ttf").outlines([]) == []


@pytest.mark.parametrize("path", ["kouzan-gyosho.otf", "edge-cases.ttf"])
def test_glyphs_are_asked_for_by_name_or_index_in_any_order(path: str) -> None:
    font = open_font(FONTS / path)
    last = font.num_glyphs - 1
    found = font.outlines([last, font.glyph_names[2], 0, font.glyph_names[2]])
    assert [outline.gid for outline in found] == [last, 2, 0, 2]


@pytest.mark.parametrize("glyph", ["nosuch", 19, -1])
def test_a_glyph_that_does_not_exist_is_an_error_in_its_place(glyph: str | int) -> None:
    font = open_font(FONTS / "edge-cases.ttf")
    before, error, after = font.outlines(["a", glyph, "A"], errors="return")
    assert isinstance(before, Outline)
    assert isinstance(error, FontError)
    assert (error.glyph, error.message) == (str(glyph), "the font has no such glyph")
    assert isinstance(after, Outline)
    with pytest.raises(FontError, match=f"glyph '{glyph}'"):
        font.outlines(["a", glyph])


def test_drawings_are_read_by_the_same_call(tmp_path: Path) -> None:
    for name in "AB":
        (tmp_path / f"{name}.svg").write_text('<svg viewBox="0 0 10 10"><path d="M0 0H5V5Z"/></svg>')
    source = open_source(tmp_path)
    a, error, b = source.outlines(["A", "C", 1], errors="return")
    assert isinstance(error, FontError)
    assert isinstance(a, Outline)
    assert isinstance(b, Outline)
    assert (a.name, b.name, b.unicodes, len(b.contours)) == ("A", "B", (66,), 1)


def test_several_threads_read_the_same_font() -> None:
    font = open_font(FONTS / "kouzan-gyosho.otf")
    names = [name for name in font.glyph_names for _ in range(20)]
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(font.outline, names))
    for outline in found:
        assert_same(outline, read_carefully(font, Head(outline.name, outline.gid, outline.unicodes)))


def cut_record(path: Path) -> None:
    """A glyph whose first contour ends at more points than there is data."""
    data = bytearray((FONTS / "kouzan-kaisho.ttf").read_bytes())
    tables = TTFont(FONTS / "kouzan-kaisho.ttf")
    at = tables.reader.tables["glyf"].offset + tables["loca"][tables.getGlyphID("uni9F8D")]
    data[at + 10 : at + 12] = struct.pack(">H", 0xFFFF)
    path.write_bytes(data)


def cut_char_string(path: Path) -> None:
    """A char string that calls subroutines without end half way through."""
    data = (FONTS / "kouzan-gyosho.otf").read_bytes()
    string = TTFont(FONTS / "kouzan-gyosho.otf")["CFF "].cff[0].CharStrings["A"].bytecode
    half = len(string) // 2
    path.write_bytes(data.replace(string, string[:half] + bytes([10]) * (len(string) - half)))


def loops(path: Path) -> None:
    """Components in loops, beside some that are not."""
    with_components(
        path.parent, {"twice": ["hollow"], "hollow": ["overlap", "twice"], "tiny": ["tiny"], "A": ["a", "a"]}
    )
    (path.parent / "composed.ttf").rename(path)


def short_table(path: Path) -> None:
    """A record as :func:`cut_record` cuts it, and a table ``loca`` that leads beyond the end of ``glyf``."""
    cut_record(path)
    data = bytearray(path.read_bytes())
    tables = TTFont(path).reader.tables
    at = tables["loca"].offset + tables["loca"].length - 2
    data[at : at + 2] = b"\xff\xff"
    path.write_bytes(data)


def test_a_broken_glyph_has_the_same_error_whenever_it_is_read(tmp_path: Path) -> None:
    cut_record(tmp_path / "cut.ttf")
    short_table(tmp_path / "short.ttf")
    for file, what in (("cut.ttf", "list index out of range"), ("short.ttf", "not enough 'glyf' table data")):
        font = open_font(tmp_path / file)
        once, again = (font.outlines(font.glyph_names, errors="return") for _ in range(2))
        assert [what in str(found) for found in once if isinstance(found, GlyphsplineError)] == [True]
        for found, expected in zip(again, once, strict=True):
            assert_same(found, expected)


@pytest.mark.parametrize(("damage", "broken"), [(cut_record, 1), (cut_char_string, 1), (loops, 3)])
def test_a_broken_glyph_costs_itself_alone(damage: Callable[[Path], None], broken: int, tmp_path: Path) -> None:
    damage(tmp_path / "broken.font")
    assert assert_all_same(open_font(tmp_path / "broken.font")) == broken


def test_a_glyph_larger_than_a_pass_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pen, plain = T2CharStringPen(600, None), T2CharStringPen(600, None)
    pen.moveTo((0, 0))
    for k in range(90_000):
        pen.lineTo((k % 700, (k * k) % 900))
    pen.closePath()
    plain.moveTo((0, 0))
    plain.curveTo((0, 300), (300, 300), (300, 0))
    plain.closePath()
    builder = FontBuilder(1000, isTTF=False)
    builder.setupGlyphOrder([".notdef", "large", "plain"])
    builder.setupCharacterMap({})
    strings = {".notdef": plain.getCharString(), "large": pen.getCharString(), "plain": plain.getCharString()}
    builder.setupCFF("Large", {}, strings, {})
    builder.setupHorizontalMetrics(dict.fromkeys(strings, (600, 0)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupPost(keepGlyphNames=False)
    builder.save(tmp_path / "large.otf")
    font = open_font(tmp_path / "large.otf")
    assert assert_all_same(font) == 0
    read = counting(monkeypatch)
    assert len(font.outline(font.glyph_names[1]).contours[0]) > 80_000
    assert read == []
    monkeypatch.setattr(bulk, "SIZE", 1 << 12)
    assert isinstance(BulkReader(font.path, font._face, 1 << 11).outlines(heads_of(font), font.metrics)[1], Outline)
    assert read == [font.glyph_names[1]]
