"""Bulk reading gives what the careful reader gives, glyph by glyph: points, degrees, advances, notes and errors."""

from __future__ import annotations

import struct
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import matplotlib
import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.ttLib import TTFont

from glyphspline.errors import FontError, GlyphsplineError
from glyphspline.outlines.outline import Outline
from glyphspline.readers import Font, open_font, open_source
from glyphspline.readers.opentype import bulk
from glyphspline.readers.opentype.bulk import BulkReader
from glyphspline.readers.opentype.careful import CarefulReader
from glyphspline.readers.source import Head, attempt

from .test_broken_fonts import with_components

FONTS = Path(__file__).parents[1] / "fonts_test"
DEJAVU = Path(matplotlib.get_data_path()) / "fonts/ttf/DejaVuSans.ttf"

FACES: list[tuple[str | Path, int, dict[str, float]]] = [
    ("kouzan-gyosho.ttf", 0, {}),
    ("kouzan-gyosho.otf", 0, {}),
    ("kouzan-gyosho.woff2", 0, {}),
    ("kouzan-kaisho.ttf", 0, {}),
    ("kouzan.ttc", 0, {}),
    ("kouzan.ttc", 1, {}),
    ("edge-cases.ttf", 0, {}),
    ("variable.ttf", 0, {}),
    ("variable.ttf", 0, {"wght": 650}),
    ("variable.ttf", 0, {"wght": 900}),
    ("variable-cff2.otf", 0, {}),
    ("variable-cff2.otf", 0, {"wght": 777, "wdth": 90}),
    ("variable-cff2.otf", 0, {"wght": 400, "wdth": 75}),
    (DEJAVU, 0, {}),
]


def heads_of(font: Font) -> list[Head]:
    codes: dict[str, list[int]] = {}
    for code, name in sorted(font.cmap.items()):
        codes.setdefault(name, []).append(code)
    return [Head(name, gid, tuple(codes.get(name, ()))) for gid, name in enumerate(font.glyph_names)]


def read_carefully(font: Font, head: Head) -> Outline | GlyphsplineError:
    return attempt(font.path, head.name, lambda: font._careful.outline(head, font.metrics))


def assert_same(found: Outline | GlyphsplineError, expected: Outline | GlyphsplineError) -> None:
    if isinstance(expected, GlyphsplineError):
        assert (type(found), str(found)) == (type(expected), str(expected))
        return
    assert isinstance(found, Outline), found
    assert (found.name, found.gid, found.unicodes, found.advance) == (
        expected.name, expected.gid, expected.unicodes, expected.advance
    )  # fmt: skip
    assert (found.metrics, found.notes) == (expected.metrics, expected.notes)
    for own, other in zip(found.arrays, expected.arrays, strict=True):
        assert (own.dtype, own.shape, own.tobytes()) == (other.dtype, other.shape, other.tobytes()), found.name


def assert_all_same(font: Font, glyphs: int | None = None) -> int:
    """Compare all glyphs, read by the font and by a bulk reader of its own; how many have an error."""
    heads = heads_of(font)[:glyphs]
    by_font = font.outlines([head.name for head in heads], errors="return")
    alone = BulkReader(font.path, font.face_index, font.location).outlines(heads, font.metrics)
    for head, *both in zip(heads, by_font, alone, strict=True):
        expected = read_carefully(font, head)
        for found in both:
            assert_same(found, expected)
    return sum(isinstance(found, GlyphsplineError) for found in by_font)


@pytest.mark.parametrize(("file", "face_index", "location"), FACES)
def test_every_glyph_is_as_the_careful_reader_has_it(
    file: str | Path, face_index: int, location: dict[str, float]
) -> None:
    assert assert_all_same(open_font(FONTS / file, face_index, location)) == 0


def counting(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The names of glyphs that the careful reader reads from now on."""
    read: list[str] = []
    careful = CarefulReader.outline

    def outline(self: CarefulReader, head: Head, metrics: object) -> Outline:
        read.append(head.name)
        return careful(self, head, metrics)  # type: ignore[arg-type]

    monkeypatch.setattr(CarefulReader, "outline", outline)
    return read


@pytest.mark.parametrize(("file", "face_index", "location"), FACES)
def test_usual_glyphs_and_spaces_need_no_careful_reader(
    file: str | Path, face_index: int, location: dict[str, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    read = counting(monkeypatch)
    font = open_font(FONTS / file, face_index, location)
    found = font.outlines(font.glyph_names)
    assert read == [outline.name for outline in found if outline.notes]


def test_contours_are_views_of_arrays_that_the_glyphs_share() -> None:
    font = open_font(FONTS / "kouzan-gyosho.otf")
    first, second = font.outlines(["uni9F8D", "A"])
    assert first.arrays.points.base is second.arrays.points.base is not None
    assert first.contours[0].points.base is first.arrays.points.base


@pytest.mark.parametrize("size", [1 << 8, 1 << 10, 1 << 12])
def test_glyphs_that_fill_the_buffer_are_read_in_several_passes(size: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bulk, "BUFFER_SIZE", size)
    for file in ("kouzan-gyosho.otf", "edge-cases.ttf"):
        assert assert_all_same(open_font(FONTS / file)) == 0


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
    """A table ``loca`` that leads beyond the end of ``glyf``."""
    data = bytearray((FONTS / "edge-cases.ttf").read_bytes())
    tables = TTFont(FONTS / "edge-cases.ttf").reader.tables
    at = tables["loca"].offset + tables["loca"].length - 2
    data[at : at + 2] = b"\xff\xff"
    path.write_bytes(data)


def test_a_broken_glyph_has_the_same_error_whenever_it_is_read(tmp_path: Path) -> None:
    cut_record(tmp_path / "cut.ttf")
    short_table(tmp_path / "short.ttf")
    for file in ("cut.ttf", "short.ttf"):
        font = open_font(tmp_path / file)
        once, again = (font.outlines(font.glyph_names, errors="return") for _ in range(2))
        assert any(isinstance(found, GlyphsplineError) for found in once)
        for found, expected in zip(again, once, strict=True):
            assert_same(found, expected)


@pytest.mark.parametrize(("damage", "broken"), [(cut_record, 1), (cut_char_string, 1), (loops, 3)])
def test_a_broken_glyph_costs_itself_alone(damage: Callable[[Path], None], broken: int, tmp_path: Path) -> None:
    damage(tmp_path / "broken.font")
    assert assert_all_same(open_font(tmp_path / "broken.font")) == broken


def test_a_glyph_too_large_for_the_buffer_is_read_carefully(tmp_path: Path) -> None:
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
    assert len(font.outline(font.glyph_names[1]).contours[0]) > 80_000
