"""Points moved in fonts: the records of glyphs change, and nothing else."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.designspaceLib import DesignSpaceDocument
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.ttLib import TTFont
from fontTools.varLib import build
from matplotlib import get_data_path
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.plugins.fonts.back.programs import unflexed
from glyphspline.plugins.mending.job import into_of
from glyphspline.plugins.mending.mend import mended
from glyphspline.plugins.mending.state import Tally
from tests.places import FONTS
from tests.variable_drawings import changed_tables
from tests.variable_fonts import quadratic, variable_font

DEJAVU = Path(get_data_path(), "fonts", "ttf", "DejaVuSans.ttf")
REGULAR = [(0, 0), (0, 262), (161, 563), (300, 500), (424, 444), (600, 292), (600, 0)]
BOLD = [(0, 0), (0, 202), (193, 460), (300, 500), (415, 543), (600, 276), (600, 0)]
"""Two cubics and a line that kink only between the masters."""


def mend(path: Path, out: Path, *options: str) -> dict[str, Any]:
    """Run the command; its facts."""
    run = CliRunner().invoke(app, ["mend", str(path), "--out", str(out), "-j", "1", "--json", *options])
    assert run.exit_code in (0, 1), run.output
    (facts,) = json.loads(run.stdout)
    return dict(facts)


def same_points(one: gs.Masters, other: gs.Masters) -> bool:
    pairs = zip(one.contours, other.contours, strict=True)
    return all(np.array_equal(a.points, b.points) and np.array_equal(a.degrees, b.degrees) for a, b in pairs)


@pytest.mark.parametrize("name", ["kouzan-gyosho.ttf", "kouzan-gyosho.otf", "kouzan-gyosho.woff2"])
def test_only_outlines_change_in_a_static_font(name: str, tmp_path: Path) -> None:
    path, new = FONTS / name, tmp_path / name
    facts = mend(path, tmp_path, "--tolerance", "2")
    assert facts["changed"]
    old, now = gs.open_font(path), gs.open_font(new)
    assert now.format == old.format
    changed = [glyph for glyph in old.glyph_names if not same_points(old.masters(glyph), now.masters(glyph))]
    assert changed == facts["changed"]
    for glyph in old.glyph_names:
        one, other = old.outline(glyph), now.outline(glyph)
        kinds = [sorted((each.kind, each.contour, each.segment) for each in gs.check(o)) for o in (one, other)]
        assert set(kinds[1]) <= set(kinds[0])
        assert one.advance == other.advance
        if glyph in changed:
            assert gs.compare(one, other).bound <= 2.001
            mended_here = {
                (c["contour"], c["segment"]) for c in facts["changes"] if c["glyph"] == glyph and not c["why"]
            }
            assert not mended_here & {(each[1], each[2]) for each in kinds[1] if each[0] == "kink"}
    if not name.endswith("woff2"):
        assert changed_tables(path.read_bytes(), new.read_bytes()) <= {"glyf", "loca", "CFF ", "head"}


def test_hints_stay_in_glyphs_that_change(tmp_path: Path) -> None:
    facts = mend(DEJAVU, tmp_path, "--tolerance", "6", "--text", "abcdeghmnopqrsSBCGJ0369&")
    assert facts["changed"]
    old, new = (TTFont(path)["glyf"] for path in (DEJAVU, tmp_path / DEJAVU.name))
    for name in facts["changed"]:
        assert old[name].program.getBytecode() == new[name].program.getBytecode() != b""
        assert old[name].flags == new[name].flags
        assert old[name].coordinates != new[name].coordinates
    name = "H"
    assert old[name].compile(old) == new[name].compile(new)


@pytest.mark.parametrize("inferred", [False, True])
def test_deltas_change_in_a_variable_font_of_quadratics(inferred: bool, tmp_path: Path) -> None:
    points = [(0, 0), (161, 430), (300, 500), (439, 570), (600, 900), (700, -20)]
    deltas: list[Any] = [(0, 0), (32, -37), (0, 0), (-89, -20), (0, 0), (None if inferred else (0, 0))]
    on = [True, False, True, False, True, True]
    font = variable_font(tmp_path / "a.ttf", {"a": quadratic(points, on)}, {"a": [({"wght": (0, 1, 1)}, deltas)]})
    before = gs.kinks(gs.open_font(font))[0]
    assert max(one.turn for one in before) > 2
    facts = mend(font, tmp_path / "out", "--tolerance", "10")
    assert (facts["changed"], facts["after"]) == (["a"], 0)
    new = tmp_path / "out" / "a.ttf"
    assert max(one.turn for one in gs.kinks(gs.open_font(new))[0]) < 0.8
    assert changed_tables(font.read_bytes(), new.read_bytes()) <= {"glyf", "loca", "gvar", "head"}
    old, now = gs.open_font(font).masters("a"), gs.open_font(new).masters("a")
    assert not same_points(old, now)
    for one, other in zip(old.contours, now.contours, strict=True):
        assert (one.points[:, [0, -1]] == other.points[:, [0, -1]]).all()


def test_points_that_are_there_more_than_once_stay_so(tmp_path: Path) -> None:
    points = [(0, 0), (0, 0), (161, 430), (300, 500), (300, 500), (439, 570), (600, 900), (700, -20), (0, 0)]
    moves = [(0, 0), (0, 0), (32, -37), (0, 0), (0, 0), (-89, -20), (0, 0), (0, 0), (0, 0)]
    on = [True, True, False, True, True, False, True, True, True]
    font = variable_font(tmp_path / "a.ttf", {"a": quadratic(points, on)}, {"a": [({"wght": (0, 1, 1)}, moves)]})
    old = gs.open_font(font).masters("a")
    assert old.repeats is not None
    facts = mend(font, tmp_path / "out", "--tolerance", "10")
    assert (facts["changed"], facts["after"]) == (["a"], 0)
    now = gs.open_font(tmp_path / "out" / "a.ttf").masters("a")
    assert not same_points(old, now)
    assert now.repeats is not None
    assert now.repeats.tolist() == old.repeats.tolist()
    stored = TTFont(tmp_path / "out" / "a.ttf")["glyf"]["a"].coordinates
    assert len(stored) == len(points)
    assert stored[3] == stored[4]


def variable_cff2(folder: Path) -> Path:
    """A variable font of the two masters, with a hint."""
    document = DesignSpaceDocument()
    document.addAxisDescriptor(tag="wght", name="Weight", minimum=400, default=400, maximum=700)
    for weight, points in ((400, REGULAR), (700, BOLD)):
        builder = FontBuilder(1000, isTTF=False)
        builder.setupGlyphOrder([".notdef", "a"])
        builder.setupCharacterMap({97: "a"})
        pen = T2CharStringPen(600, None)
        pen.moveTo(points[0])
        pen.curveTo(*points[1:4])
        pen.curveTo(*points[4:7])
        pen.closePath()
        string = pen.getCharString()
        string.program = [*string.program[:1], 0, 20, "hstem", *string.program[1:]]
        empty = T2CharStringPen(600, None).getCharString()
        builder.setupCFF("Mine", {"FullName": "Mine"}, {".notdef": empty, "a": string}, {})
        builder.setupHorizontalMetrics({".notdef": (600, 0), "a": (600, 0)})
        builder.setupHorizontalHeader(ascent=800, descent=-200)
        builder.setupNameTable({"familyName": "Mine", "styleName": "Regular"})
        builder.setupOS2()
        builder.setupPost()
        document.addSourceDescriptor(font=builder.font, location={"Weight": weight})
    font, _, _ = build(document)
    font.save(folder / "a.otf")
    return folder / "a.otf"


def test_blends_change_in_a_variable_font_of_cubics(tmp_path: Path) -> None:
    font = variable_cff2(tmp_path)
    assert "CFF2" in TTFont(font)
    facts = mend(font, tmp_path / "out", "--tolerance", "5")
    assert (facts["changed"], facts["before"], facts["after"]) == (["a"], 1, 0)
    new = tmp_path / "out" / "a.otf"
    assert changed_tables(font.read_bytes(), new.read_bytes()) <= {"CFF2", "head"}
    assert max(one.turn for one in gs.kinks(gs.open_font(new))[0]) < 1.0  # what rounding may leave of it
    strings = TTFont(new)["CFF2"].cff.topDictIndex[0].CharStrings
    strings["a"].decompile()
    assert "hstem" in strings["a"].program
    masters = gs.open_font(font).masters("a")
    state, into = Tally.of(masters, gs.Thresholds(), 1), into_of(gs.open_font(font), masters)
    expected, _ = mended(masters, state, ["kink"], 5.0, gs.Thresholds(), 1, into)
    assert np.allclose(expected.contours[0].points, gs.open_font(new).masters("a").contours[0].points, atol=1e-4)


def test_a_font_changes_in_place_only_if_asked(tmp_path: Path) -> None:
    path = tmp_path / "a.ttf"
    data = (FONTS / "kouzan-gyosho.ttf").read_bytes()
    path.write_bytes(data)
    call = ["mend", str(path), "--tolerance", "2", "-j", "1", "-q"]
    assert CliRunner().invoke(app, call).exit_code == 2
    CliRunner().invoke(app, [*call, "--dry-run"])
    assert path.read_bytes() == data
    run = CliRunner().invoke(app, [*call, "--layer", "x"])
    assert "no layers" in run.output
    CliRunner().invoke(app, [*call, "--in-place"])
    assert path.read_bytes() != data
    run = CliRunner().invoke(app, ["mend", str(FONTS / "kouzan.ttc"), "--dry-run", "-j", "1"])
    assert "collection" in run.output


def test_points_of_fonts_never_go(tmp_path: Path) -> None:
    facts = mend(FONTS / "kouzan-gyosho.ttf", tmp_path, "--kinds", "all", "--tolerance", "2")
    going = [c for c in facts["changes"] if c["kind"] in ("short", "straight", "repeated", "direction")]
    assert going
    assert all("points" in c["why"] for c in going)
    assert any(c["why"] is None and c["kind"] not in ("kink",) for c in facts["changes"])


def test_a_flex_is_two_curves() -> None:
    assert unflexed("hflex", [10, 20, 5, 30, 31, 21, 11]) == [
        ("rrcurveto", [10, 0, 20, 5, 30, 0]), ("rrcurveto", [31, 0, 21, -5, 11, 0])
    ]  # fmt: skip
    assert unflexed("hflex1", [1, 2, 3, 4, 5, 6, 7, 8, 9]) == [
        ("rrcurveto", [1, 2, 3, 4, 5, 0]), ("rrcurveto", [6, 0, 7, 8, 9, -14])
    ]  # fmt: skip
    assert unflexed("flex1", [10, 1, 10, 1, 10, 1, 10, -1, 10, -1, 12])[1] == ("rrcurveto", [10, -1, 10, -1, 12, -1])
    assert unflexed("rlineto", [1, 2]) == [("rlineto", [1, 2])]
