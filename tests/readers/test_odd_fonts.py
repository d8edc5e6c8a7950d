"""Colour fonts, fonts of pictures, empty glyphs, .notdef, glyphs of one point or two: what becomes of each."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import pytest
from fontTools.colorLib.builder import buildCOLR, buildCPAL
from fontTools.ttLib import TTFont, newTable
from fontTools.ttLib.tables.DefaultTable import DefaultTable

import glyphspline as gs
from glyphspline.errors import FontError
from glyphspline.fitting.options import Options
from glyphspline.plugins.fonts.spec import RefitSpec
from glyphspline.plugins.fonts.tables.font_file import to_font
from glyphspline.readers import open_font
from glyphspline.runs.convert import convert_font
from glyphspline.runs.folder import entries_of
from tests.places import FONTS
from tests.plugins.fonts.test_font import largest_distance


def with_pictures(path: Path, *, outlines: bool) -> Path:
    """The edge cases with a table of pictures; its content does not matter, since nothing here reads it."""
    font = TTFont(FONTS / "edge-cases.ttf", recalcTimestamp=False)
    font["CBDT"] = DefaultTable("CBDT")
    font["CBDT"].data = b"\0\3\0\0"
    if not outlines:
        del font["glyf"], font["loca"]
        font["maxp"].tableVersion = 0x00005000
    font.save(path)
    return path


def with_layers(path: Path) -> Path:
    """The edge cases with a glyph "A" of two coloured layers, which are glyphs themselves."""
    font = TTFont(FONTS / "edge-cases.ttf", recalcTimestamp=False)
    font["COLR"] = buildCOLR({"A": [("a", 0), ("overlap", 1)]}, version=0)
    font["CPAL"] = newTable("CPAL")
    font["CPAL"] = buildCPAL([[(1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0)]])
    font.save(path)
    return path


def test_a_font_of_pictures_alone_is_refused_by_what_it_has(tmp_path: Path) -> None:
    with pytest.raises(FontError, match=r"pictures\.ttf: has no outlines: only pictures \(CBDT\)"):
        open_font(with_pictures(tmp_path / "pictures.ttf", outlines=False))


def test_pictures_beside_outlines_are_not_read_and_leave_a_written_font(tmp_path: Path) -> None:
    font = open_font(with_pictures(tmp_path / "both.ttf", outlines=True))
    plain = open_font(FONTS / "edge-cases.ttf")
    assert largest_distance(font.outline("a"), plain.outline("a")) == 0
    data, _ = to_font(font, [gs.convert(font.outline("a"), Options(count=20))], "ttf")
    assert "CBDT" not in TTFont(BytesIO(data))


def test_a_colour_glyph_is_its_own_outline_and_its_layers_are_glyphs(tmp_path: Path) -> None:
    font = open_font(with_layers(tmp_path / "colour.ttf"))
    plain = open_font(FONTS / "edge-cases.ttf")
    assert largest_distance(font.outline("A"), plain.outline("A")) == 0
    data, _ = to_font(font, [gs.convert(font.outline("a"), Options(count=20))], "ttf")
    written = TTFont(BytesIO(data))
    assert [layer.name for layer in written["COLR"].ColorLayers["A"]] == ["a", "overlap"]
    assert "CPAL" in written


def test_empty_and_degenerate_glyphs_and_notdef_in_a_run(tmp_path: Path) -> None:
    font = open_font(FONTS / "edge-cases.ttf")
    names = font.select(glyphs=".notdef space hollow flat onepoint twopoints")
    spec = RefitSpec(Options(step=60), ("svg", "ufo", "otf", "ttf"))
    convert_font(font, names, tmp_path / "out", spec, jobs=0)
    status = {entry["glyph"]: (entry["status"], len(entry["contours"])) for entry in entries_of(tmp_path / "out")}
    assert status == {
        ".notdef": ("ok", 1),
        "space": ("empty", 0),
        "hollow": ("empty", 0),
        "flat": ("empty", 0),
        "onepoint": ("ok", 1),
        "twopoints": ("ok", 1),
    }
    for suffix in ("otf", "ttf"):
        written = open_font(next((tmp_path / "out").glob(f"*.{suffix}")))
        assert [len(written.outline(name).contours) for name in names] == [1, 0, 1, 1, 0, 0]
        assert [written.outline(name).advance for name in names] == [font.outline(name).advance for name in names]


def test_notdef_is_a_glyph_like_any_other_but_no_text_asks_for_it() -> None:
    font = open_font(FONTS / "edge-cases.ttf")
    assert font.select(gids=0) == (".notdef",)
    assert ".notdef" in font.select(all_glyphs=True)
    missing = font.select(text="aQ")
    assert (missing, missing.missing) == (("a",), ("U+0051",))
