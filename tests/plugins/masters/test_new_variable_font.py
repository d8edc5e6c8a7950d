"""Variable fonts built from single fonts whose points do not correspond, as HarfBuzz draws and fontTools reads them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from fontTools.feaLib.builder import addOpenTypeFeaturesFromString
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import Glyph, GlyphCoordinates, flagOverlapSimple
from fontTools.varLib.instancer import instantiateVariableFont

from glyphspline import FontError, GlyphsplineError, OutputError, open_font, open_source
from glyphspline.curves.integrals import area
from glyphspline.outlines.masters import MasterContour, Masters
from glyphspline.outlines.outline import Contour, Outline
from glyphspline.plugins.fonts.tables.font_file import to_font
from glyphspline.plugins.masters.new_designspace import write_designspace
from glyphspline.plugins.masters.new_variable_font import to_new_variable_font
from glyphspline.plugins.masters.redrawn import Redrawn
from glyphspline.plugins.masters.single_fonts import masters_of_fonts
from glyphspline.plugins.masters.variable_font import VariableSummary
from glyphspline.readers import Font, Source
from glyphspline.types import FloatArray
from tests.outlines.test_masters import composed
from tests.variable_drawings import Drawing, Shaper, apart, as_it_is, dense, refitted, turns_of
from tests.variable_fonts import polygon, quadratic, variable_font

AXIS = "wght=300:700"
SINGLE_PRECISION = 0.02
"""Units by which HarfBuzz's numbers and dense samples differ from exact ones."""

ADVANCES = {"o": (600, 655), "n": (610, 701), "u": (300, 333), "c": (600, 655), "e": (250, 281), "v": (600, 690)}
"""In the light and the bold font."""

FEATURES = "feature kern { pos o n -35; } kern; feature salt { sub o by u; } salt;"


@pytest.fixture(scope="module")
def single(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Light and bold as TrueType and CFF, of which no two have their points in the same places of a contour.

    "o" is smooth, "n" has corners, "u" is of lines; "c" is made of two components; "e" is empty; "v" is one component
    in the light font, two in the bold one, so that it has no masters.
    """
    folder = tmp_path_factory.mktemp("single")
    turn = np.arange(12) * 2 * np.pi / 12
    ring = np.stack([300 + 250 * np.cos(turn), 350 + 330 * np.sin(turn)], axis=1)[::-1]
    drop = [(120, 0), (120, 500), (180, 640), (330, 700), (480, 640), (540, 500), (540, 0), (500, 0), (500, 480)]
    drop += [(460, 600), (330, 660), (200, 600), (160, 480), (160, 0)]
    bar = [(40, 0), (40, 700), (140, 700), (140, 0)]
    empty = Glyph()
    empty.numberOfContours = 0
    glyphs = {
        "o": quadratic([tuple(map(round, p)) for p in ring], [False] * 12),
        "n": quadratic(drop, [True, True, *[False] * 3, *[True] * 4, *[False] * 3, True, True]),
        "u": polygon(*bar),
        "c": composed(("o", 0, 0), ("u", 30, 150)),
        "e": empty,
        "v": composed(("o", 10, 0)),
    }
    wider = ((0, 12), (0, 0), (-10, 0), (0, 0), (10, 0), (0, 0), (0, 0), (-70, 0), (-70, 0))
    deltas = {
        "o": [tuple(map(round, d)) for d in (ring - [300, 350]) * [0.12, -0.05] + [20, 0]],
        "n": [*wider, (-60, -50), (0, -60), (60, -50), (70, 0), (70, 0)],
        "u": [(-10, 0), (-10, 20), (40, 20), (40, 0)],
    }
    weight = (("wght", 300, 300, 700, "Weight"),)
    path = variable_font(
        folder / "variable.ttf", glyphs, {name: [({"wght": (0, 1, 1)}, each)] for name, each in deltas.items()}, weight
    )
    for k, (style, value, by) in enumerate((("Light", 300, 0), ("Medium", 500, 3), ("Bold", 700, 5))):
        font = instantiateVariableFont(TTFont(path, recalcTimestamp=False), {"wght": value})
        if style == "Bold":
            font["glyf"]["v"] = composed(("o", 10, 0), ("u", 0, 0))
        for name in ("o", "n", "u"):
            renumber(font["glyf"][name], by)
        for name, (light, bold) in ADVANCES.items():
            font["hmtx"][name] = (round((1 - k / 2) * light + k / 2 * bold), getattr(font["glyf"][name], "xMin", 0))
        font["hmtx"]["n"] = (font["hmtx"]["n"][0], font["glyf"]["n"].xMin + 7)  # rasterisers move it by 7 units
        if style == "Light":
            addOpenTypeFeaturesFromString(font, FEATURES)
        for name_id in (2, 17):
            font["name"].setName(style, name_id, 3, 1, 0x409)
        font.save(folder / f"{style}.ttf")
        data, _ = to_font(open_font(folder / f"{style}.ttf"), (), "otf", family="Masters")
        (folder / f"{style}.otf").write_bytes(data)
    return {path.name: path for path in folder.glob("[LMB]*")}


def renumber(glyph: Glyph, by: int) -> None:
    """Begin the glyph's one contour at another point."""
    points, flags = list(glyph.coordinates), bytes(glyph.flags)
    glyph.coordinates = GlyphCoordinates([*points[by:], *points[:by]])
    glyph.flags = bytearray(flags[by:] + flags[:by])


def matched(sources: Sequence[Source], axis: str = AXIS) -> tuple[dict[str, Redrawn], dict[str, str]]:
    redrawn, left = {}, {}
    for found in masters_of_fonts(sources, axis):
        if isinstance(found, Masters):
            redrawn[found.name] = as_it_is(found)
        else:
            left[found.name] = found.error.message
    return redrawn, left


def off(drawn: Drawing, gid: int, outline: Outline) -> float:
    """The largest distance between what is drawn and an outline's contours, from each to the nearest."""
    mine = [dense(contour, 64) for contour in drawn.contours(gid)]
    its = [dense(list(contour.cubics()), 64) for contour in outline.contours]
    assert len(mine) == len(its)
    there = [min(apart(one, other) for other in its) for one in mine]
    return max([*there, *[min(apart(other, one) for one in mine) for other in its]], default=0.0)


PAIRS = [("Light.ttf", "Bold.otf"), ("Light.otf", "Bold.ttf"), ("Light.ttf", "Bold.ttf")]


class Built(NamedTuple):
    """Two single fonts and what is built from them."""

    fonts: list[Font]
    data: bytes
    redrawn: dict[str, Redrawn]
    summary: VariableSummary


@pytest.fixture(scope="module", params=PAIRS, ids="-".join)
def built(request: pytest.FixtureRequest, single: dict[str, Path]) -> Built:
    fonts = [open_font(single[name]) for name in request.param]
    redrawn, left = matched(fonts)
    assert list(left) == ["v"]
    assert set(redrawn) == {".notdef", "o", "n", "u", "c", "e"}
    data, summary = to_new_variable_font(fonts, AXIS, redrawn, tolerance=0.5)
    assert set(summary.glyphs) == set(redrawn)
    assert not summary.left
    return Built(fonts, data, redrawn, summary)


def test_the_ends_are_the_single_fonts(built: Built) -> None:
    fonts, data, redrawn, summary = built
    drawing = Drawing(data)
    for x, font in zip((0.0, 1.0), fonts, strict=True):
        drawing.at(np.array([x]))
        for name in redrawn:
            gid, outline = fonts[0].outline(name).gid, font.outline(name)
            assert drawing.font.get_glyph_h_advance(gid) == outline.advance
            stored = summary.glyphs[name].distance
            assert stored < 1
            assert off(drawing, gid, outline) <= stored + SINGLE_PRECISION


def test_instances_in_the_middle_are_those_of_the_masters(built: Built) -> None:
    fonts, data, redrawn, summary = built
    drawing, away = Drawing(data), {}
    for x in (0.25, 0.5, 0.8):
        drawing.at(np.array([x]))
        for name, new in redrawn.items():
            outline = new.masters.instance({"wght": 300 + 400 * x})
            gid = fonts[0].outline(name).gid
            assert abs(drawing.font.get_glyph_h_advance(gid) - outline.advance) <= 0.5
            assert off(drawing, gid, outline) <= summary.glyphs[name].distance + SINGLE_PRECISION
            away[name] = off(drawing, gid, fonts[0].outline(name))
    assert away["o"] > 20  # it is another outline than the default's
    assert away["c"] > 20


def test_what_has_no_masters_is_the_default_s_everywhere(built: Built) -> None:
    fonts, data, _, _ = built
    font, drawing = TTFont(BytesIO(data)), Drawing(data)
    gid = font.getGlyphID("v")
    assert not font["gvar"].variations["v"]
    assert not font["glyf"]["v"].isComposite()  # or it would vary with its component
    for x in (0.0, 0.5, 1.0):
        drawing.at(np.array([x]))
        assert off(drawing, gid, fonts[0].outline("v")) <= 1  # a default with cubics is converted within a unit
        assert drawing.font.get_glyph_h_advance(gid) == ADVANCES["v"][0]


def test_kerning_and_features_are_the_default_s_everywhere(built: Built) -> None:
    _, data, _, _ = built
    font, shaper = TTFont(BytesIO(data)), Shaper(data)
    assert {record.FeatureTag for record in font["GSUB"].table.FeatureList.FeatureRecord} == {"salt"}
    for x, (light, bold) in ((0.0, (1, 0)), (0.5, (0.5, 0.5)), (1.0, (0, 1))):
        advances = [light * ADVANCES[name][0] + bold * ADVANCES[name][1] for name in "onn"]
        shaped = [each[2] for each in shaper.positions("onn", np.array([x]))]
        assert shaped == pytest.approx([advances[0] - 35, *advances[1:]], abs=0.5)


def test_axis_instances_and_names(built: Built, tmp_path: Path) -> None:
    _, data, _, _ = built
    path = tmp_path / "new.ttf"
    path.write_bytes(data)
    font, tables = open_font(path), TTFont(path)
    assert [(axis.tag, axis.name, axis.minimum, axis.default, axis.maximum) for axis in font.axes] == [
        ("wght", "Weight", 300, 300, 700)
    ]
    assert {name: dict(at) for name, at in font.instances.items()} == {"Light": {"wght": 300}, "Bold": {"wght": 700}}
    assert font.family == "Masters Spline"
    assert tables["OS/2"].usWeightClass == 300
    values = tables["STAT"].table.AxisValueArray.AxisValue
    assert [(tables["name"].getDebugName(v.ValueNameID), v.Value) for v in values] == [("Light", 300), ("Bold", 700)]
    assert not {"CFF ", "VORG", "cvt ", "fpgm", "prep", "loca "} & set(tables.keys())
    assert all(tables["glyf"][name].flags[0] & flagOverlapSimple for name in ("o", "n", "u", "c"))


def test_advances_without_reading_outlines(built: Built) -> None:
    """``HVAR`` says what the phantom points of ``gvar`` say."""
    _, data, redrawn, _ = built
    font = TTFont(BytesIO(data))
    del font["HVAR"]
    file = BytesIO()
    font.save(file)
    with_it, without = Drawing(data), Drawing(file.getvalue())
    for x in (0.0, 0.3, 1.0):
        with_it.at(np.array([x]))
        without.at(np.array([x]))
        for gid in map(font.getGlyphID, redrawn):
            assert with_it.font.get_glyph_h_advance(gid) == without.font.get_glyph_h_advance(gid)


def test_contours_have_ink_to_the_right(built: Built) -> None:
    _, data, redrawn, _ = built
    drawing, font = Drawing(data), TTFont(BytesIO(data))
    assert area(redrawn["o"].contours[0].cubics()[0]) > 0  # matched contours have it to the left
    for name in ("o", "n", "u", "v", "c"):
        for contour in drawing.contours(font.getGlyphID(name)):
            points = dense(contour, 8)
            assert (points[:, 0] * np.roll(points[:, 1], -1) - np.roll(points[:, 0], -1) * points[:, 1]).sum() < 0


def test_redrawn_arcs_have_no_kinks_between_the_ends(single: dict[str, Path]) -> None:
    fonts = [open_font(single[name]) for name in ("Light.ttf", "Bold.otf")]
    redrawn = {name: refitted(new.masters) for name, new in matched(fonts)[0].items() if name in "onu"}
    data, summary = to_new_variable_font(fonts, AXIS, redrawn, tolerance=0.5)
    assert max(glyph.distance for glyph in summary.glyphs.values()) < 1
    drawing, smooth = Drawing(data), 0
    for x in np.linspace(0, 1, 9):
        drawing.at(np.array([x]))
        for name, new in redrawn.items():
            gid, weights = fonts[0].outline(name).gid, new.masters.weights({"wght": 300 + 400 * float(x)})
            outline = Outline(name, contours=[contour.mixed(weights) for contour in new.contours])
            assert off(drawing, gid, outline) <= summary.glyphs[name].distance + SINGLE_PRECISION
            for contour, implied in zip(drawing.contours(gid), summary.glyphs[name].inner, strict=True):
                if implied.all():
                    smooth += 1
                    assert turns_of(contour).max() < 0.1
                else:
                    assert (turns_of(contour) > 30).sum() <= (~implied).sum()
    assert smooth == 9  # "o" everywhere


def test_three_fonts_with_the_default_in_the_middle(single: dict[str, Path]) -> None:
    fonts = [open_font(single[name]) for name in ("Medium.otf", "Light.ttf", "Bold.ttf")]
    axis = "wght=500:300:700"
    redrawn, _ = matched(fonts, axis)
    data, summary = to_new_variable_font(fonts, axis, redrawn, family="Three")
    tables, drawing = TTFont(BytesIO(data)), Drawing(data)
    (own,) = tables["fvar"].axes
    assert (own.minValue, own.defaultValue, own.maxValue) == (300, 500, 700)
    assert [at.coordinates["wght"] for at in tables["fvar"].instances] == [500, 300, 700]
    assert [value.Value for value in tables["STAT"].table.AxisValueArray.AxisValue] == [300, 500, 700]
    assert tables["name"].getDebugName(16) == "Three"
    for x, font in zip((0.0, -1.0, 1.0), fonts, strict=True):
        drawing.at(np.array([x]))
        for name in redrawn:
            gid = tables.getGlyphID(name)
            assert drawing.font.get_glyph_h_advance(gid) == font.outline(name).advance
            assert off(drawing, gid, font.outline(name)) <= summary.glyphs[name].distance + SINGLE_PRECISION


def test_a_glyph_that_cannot_be_written_does_not_vary(single: dict[str, Path]) -> None:
    fonts = [open_font(single[name]) for name in ("Light.ttf", "Bold.ttf")]
    redrawn, _ = matched(fonts)
    huge = replace(redrawn["n"].contours[0], points=redrawn["n"].contours[0].points * 100)
    redrawn["n"] = replace(redrawn["n"], contours=(huge,))
    data, summary = to_new_variable_font(fonts, AXIS, redrawn)
    assert set(summary.left) == {"n"}
    assert "do not fit into a font" in summary.left["n"]
    assert "n" not in summary.glyphs
    tables, drawing = TTFont(BytesIO(data)), Drawing(data)
    assert not tables["gvar"].variations["n"]
    drawing.at(np.array([1.0]))
    gid = tables.getGlyphID("n")
    assert off(drawing, gid, fonts[0].outline("n")) <= SINGLE_PRECISION
    assert drawing.font.get_glyph_h_advance(gid) == ADVANCES["n"][0]
    assert drawing.font.get_glyph_h_advance(tables.getGlyphID("o")) == ADVANCES["o"][1]


def test_ufos_become_a_variable_font(single: dict[str, Path], tmp_path: Path) -> None:
    fonts = [open_font(single[name]) for name in ("Light.ttf", "Bold.ttf")]
    write_designspace(fonts[0], {name: matched(fonts)[0][name] for name in "onu"}, tmp_path / "both")
    ufos = [open_source(path) for path in sorted((tmp_path / "both").glob("*.ufo"))]  # the default is first
    assert [ufo.style for ufo in ufos] == ["Default", "wght700"]
    redrawn, _ = matched(ufos)
    data, summary = to_new_variable_font(ufos, AXIS, redrawn)
    tables, drawing = TTFont(BytesIO(data)), Drawing(data)
    assert tables.getGlyphOrder() == [".notdef", "o", "n", "u"]
    for x, ufo in zip((0.0, 1.0), ufos, strict=True):
        drawing.at(np.array([x]))
        for name in "onu":
            gid = tables.getGlyphID(name)
            assert drawing.font.get_glyph_h_advance(gid) == ufo.outline(name).advance
            assert off(drawing, gid, ufo.outline(name)) <= summary.glyphs[name].distance + SINGLE_PRECISION


def test_fonts_of_one_style_are_told_apart_by_their_values(single: dict[str, Path]) -> None:
    fonts = [open_font(single["Light.ttf"]), open_font(single["Light.otf"])]
    data, _ = to_new_variable_font(fonts, AXIS, {name: matched(fonts)[0][name] for name in "ou"})
    tables = TTFont(BytesIO(data))
    names = [tables["name"].getDebugName(each.subfamilyNameID) for each in tables["fvar"].instances]
    assert names == ["Light 300", "Light 700"]


def test_the_same_bytes_each_time(single: dict[str, Path]) -> None:
    fonts = [open_font(single[name]) for name in ("Light.otf", "Bold.ttf")]
    redrawn, _ = matched(fonts)
    assert to_new_variable_font(fonts, AXIS, redrawn)[0] == to_new_variable_font(fonts, AXIS, redrawn)[0]


def test_what_cannot_be_built_is_refused(single: dict[str, Path]) -> None:
    fonts = [open_font(single[name]) for name in ("Light.ttf", "Bold.ttf")]
    redrawn, _ = matched(fonts)
    with pytest.raises(OutputError, match="no glyph varies"):
        to_new_variable_font(fonts, AXIS, {})
    with pytest.raises(OutputError, match="not along wdth alone"):
        to_new_variable_font(fonts, "wdth=75:100", redrawn)
    with pytest.raises(FontError, match="2 fonts have 2 different values"):
        to_new_variable_font(fonts, "wght=300:500:700", redrawn)
    with pytest.raises(GlyphsplineError, match="no such glyph"):
        to_new_variable_font(fonts, AXIS, {"q": redrawn["o"]})


def test_a_contour_backwards_is_the_same_curve() -> None:
    points: FloatArray = np.random.default_rng(0).normal(size=(2, 8, 2))
    degrees = np.array([3, 1, 2, 2])
    there = MasterContour(points, degrees)
    back = there.reversed()
    assert back.degrees.tolist() == [2, 2, 1, 3]
    for k in range(2):
        assert np.array_equal(back.cubics()[k], there.cubics()[k][::-1, ::-1])
        assert np.array_equal(back.points[k], Contour(points[k], degrees).reversed().points)
