"""Fonts written with interpolated outlines: opened again, every glyph within tolerance of its source, the rest kept."""

from __future__ import annotations

from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import uharfbuzz as hb
from fontTools.feaLib.builder import addOpenTypeFeaturesFromString
from fontTools.pens.boundsPen import BoundsPen, ControlBoundsPen
from fontTools.pens.recordingPen import RecordingPen
from fontTools.ttLib import TTFont, newTable
from fontTools.ttLib.tables.ttProgram import Program

import glyphspline as gs
from glyphspline.curves.integrals import area
from glyphspline.errors import GlyphsplineError
from glyphspline.outlines.outline import Outline
from glyphspline.plugins.fonts.tables.font_file import FontSummary, share_subroutines, to_font, write_font
from glyphspline.plugins.fonts.tables.font_glyphs import (
    Flavour,
    char_string,
    cut_alone,
    distinct,
    fitting_tolerance,
    oriented,
)
from glyphspline.readers import Source, open_font, open_source
from tests.drawings import L_SHAPE, circle, polygon_contour, result
from tests.places import FONTS
from tests.readers.test_fonts import two_sided_distance

TOLERANCE = 4.0
FLAVOURS: list[Flavour] = ["otf", "ttf"]
SOURCES: list[tuple[str, dict[str, float]]] = [
    ("kouzan-gyosho.ttf", {}),
    ("kouzan-gyosho.otf", {}),
    ("variable.ttf", {"wght": 700}),
    ("variable-cff2.otf", {"wght": 777, "wdth": 90}),
]


@cache
def converted(file: str, location: tuple[tuple[str, float], ...], flavour: Flavour) -> tuple[Any, ...]:
    """The source, every second of its glyphs converted, and the font written of them."""
    source = open_font(FONTS / file, location=dict(location))
    options = gs.Options(tolerance=fitting_tolerance(TOLERANCE, flavour))
    results = [gs.convert(source.outline(name), options) for name in source.glyph_names[1::2][:5]]
    data, summary = to_font(source, results, flavour, tolerance=TOLERANCE)
    return source, results, data, summary


def reopened(data: bytes, tmp_path: Path, suffix: str = "otf") -> Source:
    (tmp_path / f"written.{suffix}").write_bytes(data)
    return open_source(tmp_path / f"written.{suffix}")


def largest_distance(one: Outline, other: Outline) -> float:
    """Contours are compared each with each: both files have them in the same order."""
    assert len(one.contours) == len(other.contours)
    return max((two_sided_distance(a, b) for a, b in zip(one.contours, other.contours, strict=True)), default=0.0)


def total_area(outline: Outline) -> float:
    return sum(area(contour.cubics()) for contour in outline.contours)


@pytest.mark.parametrize("flavour", FLAVOURS)
@pytest.mark.parametrize(("file", "location"), SOURCES)
def test_every_glyph_is_within_tolerance_of_its_source(
    file: str, location: dict[str, float], flavour: Flavour, tmp_path: Path
) -> None:
    source, results, data, summary = converted(file, tuple(location.items()), flavour)
    written = reopened(data, tmp_path)
    assert summary.replaced == len(results) > 1
    assert summary.beyond == ()
    assert 0 < summary.largest_error <= TOLERANCE
    replaced = {glyph.outline.name for glyph in results}
    for name, new_name in zip(source.glyph_names, written.glyph_names, strict=True):
        old, new = source.outline(name), written.outline(new_name)
        assert new.advance == old.advance
        assert new.unicodes == old.unicodes
        distance = largest_distance(old, new)
        # Samples are a quarter of a unit apart at most: none is farther from the other's than by 0.01 too much.
        assert distance <= (summary.largest_error + 0.01 if name in replaced else 1.25)
        if name in replaced and old.contours and name != "space":
            assert distance > 0
        if abs(total_area(old)) > 1:
            assert (total_area(new) > 0) == (flavour == "otf")


@pytest.mark.parametrize("flavour", FLAVOURS)
@pytest.mark.parametrize(("file", "location"), SOURCES)
def test_both_libraries_read_the_written_font_alike(
    file: str, location: dict[str, float], flavour: Flavour, tmp_path: Path
) -> None:
    _, results, data, _ = converted(file, tuple(location.items()), flavour)
    new = {glyph.outline.gid for glyph in results}
    font, face = TTFont(BytesIO(data)), hb.Face(data)
    assert font.sfntVersion == ("OTTO" if flavour == "otf" else "\0\1\0\0")
    assert face.glyph_count == len(font.getGlyphOrder())
    assert all(font[tag] is not None for tag in font.keys())  # noqa: SIM118 - reads every table
    head = font["head"]
    boxes = []
    for gid in range(face.glyph_count):
        pen = BoundsPen(None) if flavour == "otf" else ControlBoundsPen(None)  # TrueType counts points off the curve
        hb.Font(face).draw_glyph_with_pen(gid, pen)
        if pen.bounds is not None:
            boxes.append(pen.bounds)
            if gid in new:
                assert font["hmtx"][font.getGlyphName(gid)][1] == pytest.approx(pen.bounds[0], abs=1)
    found = np.array(boxes, dtype=float)
    assert head.xMin == pytest.approx(found[:, 0].min(), abs=1)
    assert head.yMax == pytest.approx(found[:, 3].max(), abs=1)
    assert not {"fpgm", "prep", "cvt ", "fvar", "gvar", "CFF2", "STAT"} & set(font.keys())


@pytest.mark.parametrize("flavour", FLAVOURS)
def test_the_same_input_gives_the_same_bytes(flavour: Flavour) -> None:
    source, results, data, _ = converted("kouzan-gyosho.ttf", (), flavour)
    assert to_font(source, iter(results), flavour, tolerance=TOLERANCE)[0] == data


def test_kept_glyphs_of_the_same_format_are_the_very_same(tmp_path: Path) -> None:
    for flavour in FLAVOURS:
        file = f"kouzan-gyosho.{flavour}"
        source, results, data, _ = converted(file, (), flavour)
        written = reopened(data, tmp_path)
        kept = set(source.glyph_names) - {glyph.outline.name for glyph in results}
        assert len(kept) > 5
        for name in kept:
            for a, b in zip(source.outline(name).contours, written.outline(name).contours, strict=True):
                np.testing.assert_array_equal(a.points, b.points)


def test_alignment_zones_stay_for_hinters(tmp_path: Path) -> None:
    font = TTFont(FONTS / "kouzan-gyosho.otf")
    font["CFF "].cff.topDictIndex[0].Private.BlueValues = [-12, 0, 700, 712]
    font["CFF "].cff.topDictIndex[0].Private.StdVW = 80
    font.save(tmp_path / "zones.otf")
    source = open_font(tmp_path / "zones.otf")
    data, _ = to_font(source, [gs.convert(source.outline(source.glyph_names[1]), gs.Options(count=12))], "otf")
    private = TTFont(BytesIO(data))["CFF "].cff.topDictIndex[0].Private
    assert (private.BlueValues, private.StdVW) == ([-12, 0, 700, 712], 80)


def test_composites_of_replaced_glyphs_look_as_before(tmp_path: Path) -> None:
    source = open_font(FONTS / "edge-cases.ttf")
    data, _ = to_font(source, [gs.convert(source.outline("a"), gs.Options(count=12))], "ttf")
    written = reopened(data, tmp_path)
    assert largest_distance(source.outline("a"), written.outline("a")) > 0.5
    assert largest_distance(source.outline("twice"), written.outline("twice")) == 0
    assert not TTFont(BytesIO(data))["glyf"]["twice"].isComposite()
    data, _ = to_font(source, [gs.convert(source.outline("A"), gs.Options(count=12))], "ttf")
    assert TTFont(BytesIO(data))["glyf"]["twice"].isComposite()


def test_a_composite_that_is_replaced_leaves_its_parts(tmp_path: Path) -> None:
    source = open_font(FONTS / "variable.ttf", location={"wght": 500})
    data, summary = to_font(source, [gs.convert(source.outline("i"), gs.Options(tolerance=2.0))], "ttf")
    written = reopened(data, tmp_path)
    assert summary.replaced == 1
    assert 0 < largest_distance(source.outline("i"), written.outline("i")) < 3
    for name in ("stem", "dot", "ii", "mirror"):
        assert largest_distance(source.outline(name), written.outline(name)) < 1


def with_layout(tmp_path: Path) -> Path:
    """The brush font with kerning, a substitution, instructions and a date that must not change."""
    font = TTFont(FONTS / "kouzan-gyosho.ttf", recalcTimestamp=False)
    addOpenTypeFeaturesFromString(
        font, "feature kern { pos A O -77; } kern; feature salt { sub A by B; } salt;", tables=["GSUB", "GPOS"]
    )
    font["fpgm"] = newTable("fpgm")
    font["fpgm"].program = Program()
    font["fpgm"].program.fromAssembly(["PUSHB[ ] 0", "POP[ ]"])
    font.save(tmp_path / "layout.ttf")
    return tmp_path / "layout.ttf"


@pytest.mark.parametrize("flavour", FLAVOURS)
def test_kerning_and_features_work_in_the_written_font(flavour: Flavour, tmp_path: Path) -> None:
    source = open_font(with_layout(tmp_path))
    data, _ = to_font(source, [gs.convert(source.outline("A"), gs.Options(tolerance=4.0))], flavour)
    for features, expected in (({}, ("A", -77)), ({"salt": True, "kern": False}, ("B", 0))):
        shaped = []
        for content in (Path(source.path).read_bytes(), data):
            font, buffer = hb.Font(hb.Face(content)), hb.Buffer()
            buffer.add_str("AO")
            buffer.guess_segment_properties()
            hb.shape(font, buffer, features)
            advances = [position.x_advance for position in buffer.glyph_positions]
            shaped.append(([info.codepoint for info in buffer.glyph_infos], advances))
        assert shaped[0] == shaped[1]
        name, kern = expected
        assert source.glyph_names[shaped[1][0][0]] == name
        assert shaped[1][1][0] == source.outline(name).advance + kern


def test_a_written_font_does_not_pass_for_its_source() -> None:
    source, _, data, summary = converted("kouzan-gyosho.otf", (), "otf")
    font = TTFont(BytesIO(data))
    old = TTFont(FONTS / "kouzan-gyosho.otf")
    assert summary.family == font["name"].getBestFamilyName() == f"{source.family} Spline"
    assert font["name"].getDebugName(0) == old["name"].getDebugName(0)
    for name_id in (1, 3, 4, 6):
        assert font["name"].getDebugName(name_id) != old["name"].getDebugName(name_id)
    assert font["CFF "].cff.fontNames == [font["name"].getDebugName(6)] == ["KouzanGyoshoSubsetSpline-Regular"]
    data, _ = to_font(source, [], "otf", family="Other & 名")
    font = TTFont(BytesIO(data))
    assert font["name"].getBestFamilyName() == "Other & 名"
    assert font["name"].getDebugName(6).isascii()


def test_without_room_for_whole_units_cff_has_fractions_and_truetype_says_so() -> None:
    source = open_font(FONTS / "kouzan-gyosho.otf")
    glyph = gs.convert(source.outline("O"), gs.Options(corners="smooth", tolerance=fitting_tolerance(0.5, "otf")))
    data, summary = to_font(source, [glyph], "otf", tolerance=0.5)
    assert summary.beyond == ()
    assert summary.largest_error is not None
    assert summary.largest_error <= 0.5
    fractional = hb.Font(hb.Face(data))
    points: list[float] = []
    functions = hb.DrawFuncs()
    functions.set_move_to_func(lambda x, y, user: points.extend((x, y)))
    fractional.draw_glyph(source.glyph_names.index("O"), functions)
    assert any(value % 1 for value in points)
    _, summary = to_font(source, [glyph], "ttf", tolerance=0.5)
    assert summary.beyond == ("O",)


def test_glyphs_without_measured_deviation_make_no_promise() -> None:
    source = open_font(FONTS / "kouzan-gyosho.otf")
    _, summary = to_font(source, [gs.convert(source.outline("O"), gs.Options(count=40))], "otf")
    assert summary == FontSummary(f"{source.family} Spline", 1, None, (), summary.extrema)


def test_outer_contours_run_as_each_format_has_them() -> None:
    ring = [gs.Contour.from_segments(circle(200, 8, centre=(300, 300), turn=turn)) for turn in (1, -1)]
    for turn in (0, 1):
        contours = [ring[turn], polygon_contour(L_SHAPE / 10)]
        assert sum(area(c.cubics()) for c in oriented(contours, "otf")) > 0
        assert sum(area(c.cubics()) for c in oriented(contours, "ttf")) < 0


@pytest.mark.parametrize("flavour", FLAVOURS)
def test_drawings_become_a_font(flavour: Flavour, tmp_path: Path) -> None:
    for name, code in (("a", 0x61), ("b", 0x62)):
        glyph = result(polygon_contour(L_SHAPE), name=name, gid=code, unicodes=(code,))
        (tmp_path / f"{name}.svg").write_text(gs.to_svg(glyph), encoding="utf-8")
    source = open_source(tmp_path)
    summary = write_font(
        source,
        [gs.convert(source.outline("a"), gs.Options(corners="smooth", tolerance=2.0))],
        tmp_path / f"new.{flavour}",
    )
    assert summary.replaced == 1
    font = open_font(tmp_path / f"new.{flavour}")
    assert font.cmap == {0x61: "a", 0x62: "b"}
    assert font.glyph_names == (".notdef", "a", "b")
    assert font.family == f"{tmp_path.name} Spline"
    assert font.metrics == source.metrics
    assert largest_distance(source.outline("b"), font.outline("b")) < 1e-9
    assert 0 < largest_distance(source.outline("a"), font.outline("a")) < 3
    assert font.outline("b").advance == 600


def test_the_suffix_says_which_format(tmp_path: Path) -> None:
    source = open_font(FONTS / "variable.ttf")
    with pytest.raises(GlyphsplineError, match=r"\.otf or \.ttf"):
        write_font(source, [], tmp_path / "font.woff")


@pytest.mark.parametrize("flavour", FLAVOURS)
@pytest.mark.parametrize("shape", [L_SHAPE * 100, 30000.0 * np.array([[-1.0, 0.0], [1.0, 0.0], [1.0, 1.0]])])
def test_a_glyph_with_coordinates_or_steps_that_no_font_can_hold_is_not_replaced(
    shape: Any, flavour: Flavour, caplog: pytest.LogCaptureFixture
) -> None:
    source = open_font(FONTS / "edge-cases.ttf")
    glyph = result(polygon_contour(shape), name="A", gid=source.glyph_names.index("A"))
    data, summary = to_font(source, [glyph], flavour)
    assert summary.replaced == 0
    assert "glyph 'A': coordinates beyond 32767 do not fit into a font: not replaced" in caplog.text
    assert len(TTFont(BytesIO(data)).getGlyphOrder()) == len(source.glyph_names)


def test_a_glyph_of_a_cff_table_that_cannot_be_drawn_costs_only_itself(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    font = TTFont(FONTS / "kouzan-gyosho.otf")
    name = font.getGlyphOrder()[3]
    strings = font["CFF "].cff.topDictIndex[0].CharStrings
    strings[name].setProgram([5, "callsubr", "endchar"])
    font.recalcBBoxes = False
    font.save(tmp_path / "broken.otf")
    source = open_font(tmp_path / "broken.otf")
    whole = gs.convert(source.outline(source.glyph_names[5]), gs.Options(tolerance=TOLERANCE))
    data, summary = to_font(source, [whole], "otf")
    written = reopened(data, tmp_path)
    assert summary.replaced == 1
    assert f"glyph '{name}' cannot be drawn" in caplog.text
    assert [len(written.outline(glyph).contours) for glyph in written.glyph_names[3:5]] == [
        0,
        len(source.outline(source.glyph_names[4]).contours),
    ]


def test_points_that_rounding_puts_together_are_stored_once() -> None:
    small = polygon_contour([(0, 0), (40, 0), (40.2, 0.1), (40.4, 0.3), (40, 30), (0.3, 30), (0, 29.8), (0, 0.4)])
    glyph = cut_alone([small, polygon_contour([(9.6, 9.6), (10.4, 9.6), (10, 10.4)])], 0.3, "dots")
    assert [*glyph.coordinates] == [(0, 0), (40, 0), (40, 30), (0, 30), (10, 10)]
    assert glyph.endPtsOfContours == [3, 4]


@pytest.mark.parametrize(
    ("on", "kept"),
    [([1, 1, 1, 1], [0, 2, 3]), ([1, 0, 1, 1], [0, 2, 3]), ([0, 1, 1, 1], [1, 2, 3]), ([0, 0, 1, 1], [0, 1, 2, 3])],
)
def test_of_two_points_in_one_place_the_one_on_the_curve_stays(on: list[int], kept: list[int]) -> None:
    points = np.array([[0, 0], [0, 0], [9, 0], [9, 9]])
    assert distinct(points, np.array(on, dtype=np.bool_)).tolist() == kept


def test_a_char_string_leaves_the_line_back_to_the_start_to_the_end_of_the_contour() -> None:
    square = gs.Contour(np.array([[0.0, 0.0], [90.0, 0.0], [90.0, 80.0], [0.0, 80.0]]), np.ones(4, dtype=np.int64))
    stored = char_string([square], None, 1, "square")
    assert stored.program == [0, "hmoveto", 90, 80, -90, "hlineto", "endchar"]


def test_char_strings_store_what_they_have_in_common_once() -> None:
    source, shape = open_font(FONTS / "kouzan-gyosho.ttf"), polygon_contour(np.round(circle(400.0, 24)[:, 0]))
    names = source.glyph_names[1:9]

    def table(count: int) -> TTFont:
        """Of a font in which so many glyphs have one outline, and the others none."""
        glyphs = [result(*[shape] * (k < count), name=name, gid=k + 1) for k, name in enumerate(names)]
        return TTFont(BytesIO(to_font(source, glyphs, "otf", tolerance=TOLERANCE)[0]))

    one, eight = table(1), table(8)
    assert eight.reader.tables["CFF "].length - one.reader.tables["CFF "].length < 7 * 24
    strings = eight["CFF "].cff.topDictIndex[0].CharStrings
    pens = [BoundsPen(None) for _ in names]
    for name, pen in zip(names, pens, strict=True):
        strings[name].draw(pen)
    assert {pen.bounds for pen in pens} == {pens[0].bounds}


def test_tables_that_are_broken_inside_are_an_error_that_names_the_font(tmp_path: Path) -> None:
    data = bytearray((FONTS / "kouzan-gyosho.ttf").read_bytes())
    entry = data.index(b"hmtx")
    data[entry + 12 : entry + 16] = (4).to_bytes(4, "big")
    (tmp_path / "broken.ttf").write_bytes(data)
    source = open_font(tmp_path / "broken.ttf")
    with pytest.raises(GlyphsplineError, match=r"broken\.ttf: a broken font: "):
        to_font(source, [], "ttf")


def test_char_strings_with_decimals_keep_them_beside_shared_subroutines() -> None:
    def drawings(font: TTFont) -> list[Any]:
        strings = list(font["CFF "].cff.topDictIndex[0].CharStrings.values())
        pens = [RecordingPen() for _ in strings]
        for string, pen in zip(strings, pens, strict=True):
            string.draw(pen)
        return [(string.width, pen.value) for string, pen in zip(strings, pens, strict=True)]

    def saved(font: TTFont) -> TTFont:
        font.save(file := BytesIO())
        return TTFont(file)

    font = TTFont(FONTS / "kouzan-gyosho.otf")
    font["CFF "].cff.desubroutinize()
    strings = font["CFF "].cff.topDictIndex[0].CharStrings
    stated, implied = font.getGlyphOrder()[1:3]
    for name, width in ((stated, [7]), (implied, [])):
        shape = [10.00390625, 20, "rmoveto", *[30.0078125, 5, -4.001953125, 60, 50, 9] * 2, "rrcurveto", "endchar"]
        strings[name].setProgram([*width, *shape])
        private = strings[name].private
        advance = private.nominalWidthX + width[0] if width else private.defaultWidthX
        font["hmtx"][name] = (advance, font["hmtx"][name][1])
    before = saved(font)
    expected, size = drawings(before), before.reader.tables["CFF "].length
    assert share_subroutines(font)
    after = saved(font)
    assert drawings(after) == expected
    assert after.reader.tables["CFF "].length < size
