"""What a file holds, as data."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from fontTools.ttLib import TTFont
from typer.testing import CliRunner

from glyphspline.cli.app import app
from glyphspline.errors import FontError
from glyphspline.readers import Font, open_source
from glyphspline.readers.open import file_facts
from glyphspline.runs.deep_facts import add_glyph_facts
from glyphspline.runs.schedule import workers
from tests.places import FONTS
from tests.readers.test_bulk import build, simple


def deep_facts(path: Path, jobs: int = 0) -> dict[str, Any]:
    facts = file_facts(path)
    with workers(jobs, 60.0) as executor:
        add_glyph_facts(path, facts, executor)
    return facts


def test_a_variable_font_has_axes_and_instances() -> None:
    facts = file_facts(FONTS / "variable-cff2.otf", location="bold")
    (font,) = facts["fonts"]
    assert (facts["format"], facts["faces"]) == ("OpenType (CFF)", 1)
    assert [axis["tag"] for axis in font["axes"]] == ["wght", "wdth"]
    assert font["instances"]["Bold Condensed"] == {"wght": 700, "wdth": 75}
    assert font["location"] == {"wght": 700, "wdth": 100}
    assert (font["ascender"], font["units_per_em"]) == (830, 1000)  # MVAR: 800 to 850 over wght 400 to 900
    assert (font["glyphs"], font["characters"]) == (5, 4)
    assert json.loads(json.dumps(facts)) == facts


def test_overlaps_and_degenerate_contours_are_named() -> None:
    (font,) = deep_facts(FONTS / "edge-cases.ttf")["fonts"]
    assert font["degenerate"] == ["onepoint", "twopoints", "flat"]
    assert font["overlaps"] == ["overlap", "eight", "loop", "twice"]
    assert font["broken"] == []


def test_points_and_contours_that_a_reader_leaves_out_are_counted(tmp_path: Path) -> None:
    square, once_more = [(0, 0, 1), (300, 0, 1), (300, 300, 1), (0, 300, 1)], (300, 0, 1)
    glyphs = {
        "plain": simple(square),
        "doubled": simple([*square[:2], once_more, *square[2:]], [*square[:2], once_more, once_more, *square[2:]]),
        "leftover": simple([square[0], (120, 0, 1), *square[1:]]),
        "anchored": simple([(5, 5, 1)], square, [(0, 0, 1), (90, 30, 1)]),
    }
    build(tmp_path / "dropped.ttf", glyphs)
    (font,) = deep_facts(tmp_path / "dropped.ttf")["fonts"]
    assert (font["doubled_points"], font["leftover_points"], font["contours_left_out"]) == (3, 1, 2)
    assert font["degenerate"] == ["anchored"]
    command = CliRunner().invoke(app, ["info", str(tmp_path / "dropped.ttf"), "--deep"])
    lines = command.stdout.splitlines()
    assert "  3 points that are there more than once" in lines
    assert "  1 points on a line between two others" in lines
    assert "  2 contours that enclose nothing: of one or two points, or on a line" in lines


def test_all_faces_of_a_collection_or_one() -> None:
    assert [font["family"] for font in file_facts(FONTS / "kouzan.ttc")["fonts"]] == [
        "Kouzan Gyosho Subset",
        "Kouzan Kaisho Subset",
    ]
    facts = file_facts(FONTS / "kouzan.ttc", 1)
    assert facts["format"] == "collection"
    assert [font["face_index"] for font in facts["fonts"]] == [1]


def test_an_instance_that_is_not_there_is_an_error_that_lists_those_that_are() -> None:
    with pytest.raises(FontError, match="no named instance 'Black': it has Regular, Bold, Bold Condensed"):
        file_facts(FONTS / "variable-cff2.otf", location="Black")
    with pytest.raises(FontError, match="it has none"):
        file_facts(FONTS / "kouzan-gyosho.otf", location="Bold")


@pytest.mark.parametrize("path", sorted(FONTS.glob("*.*t*")), ids=lambda path: path.name)
def test_numbers_from_tables_are_those_of_the_opened_font(path: Path) -> None:
    for font in file_facts(path)["fonts"]:
        source = open_source(path, font["face_index"])
        assert (font["glyphs"], font["characters"]) == (len(source.glyph_names), len(source.cmap))
        assert (font["family"], font["style"], font["ascender"]) == (
            source.family, source.style, source.metrics.ascender)  # fmt: skip


def test_contours_are_counted_by_workers_on_request() -> None:
    path = FONTS / "kouzan.ttc"
    here, there = deep_facts(path), deep_facts(path, 2)
    assert here == there
    assert "contours" not in file_facts(path)["fonts"][0]
    for font in here["fonts"]:
        source = open_source(path, font["face_index"])
        assert font["contours"] == sum(len(outline.contours) for outline in source.outlines(source.glyph_names))


def test_a_font_without_characters_has_none_to_count(tmp_path: Path) -> None:
    font = TTFont(FONTS / "kouzan-gyosho.ttf")
    del font["cmap"]
    font.save(tmp_path / "none.ttf")
    assert file_facts(tmp_path / "none.ttf")["fonts"][0]["characters"] == 0
    assert len(open_source(tmp_path / "none.ttf").cmap) == 0


def test_info_reads_no_glyphs_and_imports_no_compiler() -> None:
    code = (
        "import sys; from glyphspline.cli.app import app; from typer.testing import CliRunner\n"
        f"assert '18 glyphs' in CliRunner().invoke(app, ['info', {str(FONTS / 'kouzan-gyosho.ttf')!r}]).stdout\n"
        "print(*sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"numba", "scipy", "matplotlib", "glyphspline.runs.pool"} & set(run.stdout.split())


def test_a_font_that_cannot_be_opened_is_not_opened_for_each_of_its_glyphs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    data = bytearray((FONTS / "kouzan-gyosho.otf").read_bytes())
    tables = TTFont(FONTS / "kouzan-gyosho.otf").reader.tables
    data[tables["CFF "].offset] = 9  # its version
    data[tables["maxp"].offset + 4 : tables["maxp"].offset + 6] = b"\xff\xff"  # its glyphs
    (tmp_path / "many.otf").write_bytes(data)
    opened, begin = [], Font.__init__

    def counted(self: Font, *given: Any, **named: Any) -> None:
        opened.append(given)
        begin(self, *given, **named)

    monkeypatch.setattr(Font, "__init__", counted)
    (font,) = deep_facts(tmp_path / "many.otf")["fonts"]
    assert font["broken_glyphs"] == 65_535
    assert 0 < len(opened) < 1_000
