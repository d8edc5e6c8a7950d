"""Fonts that cannot be read, wholly or in part: what is said, and that nothing else escapes."""

from __future__ import annotations

import random
import struct
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables.DefaultTable import DefaultTable

from glyphspline.errors import FontError, GlyphsplineError
from glyphspline.readers import Font, open_font
from glyphspline.readers.open import file_facts
from glyphspline.readers.pens import MAX_SEGMENTS, ContourPen
from tests.places import FONTS


@pytest.mark.parametrize(
    ("file", "arguments", "message"),
    [
        ("no-such-font.ttf", {}, "cannot be read"),
        ("README.md", {}, "not a TTF"),
        (".", {}, "cannot be read"),
        ("variable.ttf", {"face_index": 1}, "no face 1"),
        ("kouzan.ttc", {"face_index": 2}, "no face 2: the file has 2"),
        ("kouzan.ttc", {"face_index": -1}, "no face -1"),
        ("variable.ttf", {"location": {"wdth": 80}}, "no axis 'wdth': it has wght"),
        ("variable.ttf", {"location": {"wght": float("nan")}}, "cannot be at nan"),
        ("kouzan-gyosho.otf", {"location": {"wght": 700}}, "not a variable font"),
    ],
)
def test_an_unusable_font_is_named_and_the_fault_said(file: str, arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(FontError) as caught:
        open_font(FONTS / file, **arguments)
    assert str(FONTS / file) in str(caught.value)
    assert message in str(caught.value)


def test_an_unknown_glyph_is_named() -> None:
    with pytest.raises(FontError, match=r"variable\.ttf, glyph 'nosuch'"):
        open_font(FONTS / "variable.ttf").outline("nosuch")


def with_components(folder: Path, components: dict[str, list[str]], source: str = "edge-cases.ttf") -> Font:
    """The font with some glyphs redrawn as composites of the named ones, whatever these lead to."""
    tables = TTFont(FONTS / source, recalcBBoxes=False)
    for name, parts in components.items():
        pen = TTGlyphPen(dict.fromkeys(tables.getGlyphOrder()))
        for part in parts:
            pen.addComponent(part, (1, 0, 0, 1, 0, 0))
        glyph = pen.glyph()
        glyph.xMin = glyph.yMin = glyph.xMax = glyph.yMax = 0
        tables["glyf"][name] = glyph
    tables.save(folder / "composed.ttf")
    return open_font(folder / "composed.ttf")


def test_components_in_a_loop_are_an_error_and_other_glyphs_still_read(tmp_path: Path) -> None:
    font = with_components(tmp_path, {"twice": ["hollow"], "hollow": ["overlap", "twice"], "tiny": ["tiny"]})
    with pytest.raises(GlyphsplineError, match=r"composed\.ttf, glyph 'twice': .*twice > hollow > twice"):
        font.outline("twice")
    with pytest.raises(GlyphsplineError, match="tiny > tiny"):
        font.outline("tiny")
    assert len(font.outline("a").contours) == 2


def test_components_in_a_loop_of_a_variable_font_are_an_error(tmp_path: Path) -> None:
    with_components(tmp_path, {"i": ["stem", "ii"]}, "variable.ttf")
    font = open_font(tmp_path / "composed.ttf", location={"wght": 700})
    with pytest.raises(GlyphsplineError, match="glyph 'ii'"):
        font.outline("ii")


@pytest.mark.parametrize("innermost", ["a", "space"])
def test_a_flood_of_nested_components_is_cut_off(innermost: str, tmp_path: Path) -> None:
    chain = [*open_font(FONTS / "edge-cases.ttf").glyph_names[3:], innermost]
    font = with_components(tmp_path, {name: [below] * 100 for name, below in pairwise(chain)})
    with pytest.raises(GlyphsplineError, match=r"glyph 'A': more than [0-9]+ components"):
        font.outline(chain[0])


def test_a_flood_of_segments_is_cut_off() -> None:
    pen = ContourPen()
    pen.moveTo((0, 0))
    with pytest.raises(GlyphsplineError, match=r"more than [0-9]+ segments"):
        pen.qCurveTo(*[(k % 1000, k // 1000) for k in range(MAX_SEGMENTS + 2)])


def test_a_font_without_the_tables_needed_is_an_error(tmp_path: Path) -> None:
    tables = TTFont(FONTS / "edge-cases.ttf")
    for tag in ("glyf", "hhea"):
        del tables[tag]
        tables.save(tmp_path / f"{tag}.ttf")
        with pytest.raises(FontError, match="no outlines" if tag == "glyf" else "no table hhea"):
            open_font(tmp_path / f"{tag}.ttf")


def test_code_points_mapped_to_glyphs_that_do_not_exist_are_missing(tmp_path: Path) -> None:
    tables = TTFont(FONTS / "edge-cases.ttf")
    for table in tables["cmap"].tables:
        table.cmap[ord("B")] = "glyph09999"
    tables.save(tmp_path / "mapped.ttf")
    assert TTFont(tmp_path / "mapped.ttf").getBestCmap()[ord("B")] == "glyph09999"
    font = open_font(tmp_path / "mapped.ttf")
    assert ord("B") not in font.cmap
    assert font.select(text="aB").missing == ("U+0042",)


def test_a_glyph_cut_short_is_an_error_that_keeps_its_cause(tmp_path: Path) -> None:
    data = bytearray((FONTS / "kouzan-kaisho.ttf").read_bytes())
    tables = TTFont(FONTS / "kouzan-kaisho.ttf")
    name = "uni9F8D"
    at = tables.reader.tables["glyf"].offset + tables["loca"][tables.getGlyphID(name)]
    data[at + 10 : at + 12] = struct.pack(">H", 0xFFFF)  # the first contour's end: more points than there is data
    (tmp_path / "cut.ttf").write_bytes(data)
    font = open_font(tmp_path / "cut.ttf")
    with pytest.raises(GlyphsplineError, match=r"cut\.ttf, glyph 'uni9F8D'") as caught:
        font.outline(name)
    assert caught.value.__cause__ is not None
    assert font.outline("A").contours


@pytest.mark.parametrize("file", ["kouzan-gyosho.otf", "variable.ttf", "kouzan.ttc", "kouzan-gyosho.woff2"])
def test_damaged_fonts_raise_nothing_but_our_own_errors(file: str, tmp_path: Path) -> None:
    original, rng = (FONTS / file).read_bytes(), random.Random(file)
    blamed: set[bool] = set()
    for trial in range(60):
        data = bytearray(original)
        for _ in range(rng.choice([1, 4, 16])):
            data[rng.randrange(4, len(data))] = rng.randrange(256)
        damaged = tmp_path / f"{trial}.font"
        damaged.write_bytes(data if trial % 4 else data[: rng.randrange(len(data))])
        try:
            font = open_font(damaged, location={"wght": 700} if file == "variable.ttf" else None)
            for name in font.glyph_names[:20]:
                font.outline(name)
        except GlyphsplineError as error:
            blamed.add(error.font == str(damaged))
    assert blamed == {True}


@pytest.mark.parametrize("cmap", [b"", b"\0\0", b"\0\0\0\5\0\3\0\1\0\0"])
def test_a_table_of_characters_cut_short_is_an_error_for_facts_too(cmap: bytes, tmp_path: Path) -> None:
    tables = TTFont(FONTS / "edge-cases.ttf")
    tables["cmap"] = DefaultTable("cmap")
    tables["cmap"].data = cmap
    tables.save(tmp_path / "cut.ttf")
    for read in (open_font, file_facts):
        with pytest.raises(FontError, match=r"cut\.ttf: a broken font: "):
            read(tmp_path / "cut.ttf")


def test_axes_with_tags_of_other_characters_are_an_error(tmp_path: Path) -> None:
    data = (FONTS / "variable.ttf").read_bytes()
    (tmp_path / "tag.ttf").write_bytes(data.replace(b"wght", b"wg\0\x80"))
    with pytest.raises(FontError, match=r"tag\.ttf: has an axis whose tag is not of ASCII"):
        open_font(tmp_path / "tag.ttf")
