"""Mended kinks: near the clean outline, nowhere along an axis, and nothing else is found or changed."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib import get_data_path
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.curves.bezier import split
from glyphspline.outlines.flaws.kinds import THRESHOLDS
from glyphspline.outlines.masters import DesignAxis, MasterContour
from glyphspline.outlines.outline import Contour
from glyphspline.plugins.checks.finding import Finding
from glyphspline.plugins.mending.joints import ContourLayout
from glyphspline.plugins.mending.shapes import with_nodes
from glyphspline.plugins.mending.state import Design, distances
from glyphspline.readers import open_source
from scripts.planted_faults import cubics_of, planted
from tests.places import FONTS, ROOT

SHAPE = [(0, 0), (0, 262), (161, 563), (300, 500), (424, 444), (600, 292), (600, 0)]
BOLD = [(0, 0), (0, 202), (193, 460), (300, 500), (415, 543), (600, 276), (600, 0)]
"""Two curves and a line; the joint at 300, 500 is smooth in both, and turns by 2.2° between them."""

ENOUGH = 5.0
"""Units by which curves may move there."""

WEIGHT = DesignAxis("wght", "Weight", 400, 400, 700)


def family_of(regular: object, bold: object) -> gs.Masters:
    """A glyph of two masters."""
    points = np.array([regular, bold], dtype=np.float64)
    contour = MasterContour(points, np.array([3, 3, 1]))
    return gs.Masters(
        "a", axes=(WEIGHT,), regions=np.array([[[0.0, 1.0, 1.0]]]), contours=[contour], advances=np.zeros(2)
    )


def turn_at(outline: gs.Outline) -> float:
    """Degrees at the joint of the shape."""
    a, b = np.diff(outline.contours[0].points[2:5], axis=0)
    return abs(float(np.degrees(np.arctan2(a[0] * b[1] - a[1] * b[0], a @ b))))


def kinds_of(found: list[Finding]) -> Counter[object]:
    return Counter((one.kind, one.contour, one.segment, one.other) for one in found)


def test_planted_kinks_come_back_to_the_clean_outline() -> None:
    font = gs.open_font(Path(get_data_path(), "fonts", "ttf", "DejaVuSans.ttf"))
    rng = np.random.default_rng(5)
    near = meant = 0
    for name in font.select(text="abcdeghmnopqrsuBCDGJOPQRS035689&@"):
        clean = cubics_of(font.outline(name))
        em = clean.metrics.units_per_em
        before = gs.check(clean)
        for fault in ("kink of 2°", "kink of 3°", "kink of 5°", "line into curve, 3°"):
            made = planted([list(c.segments()) for c in clean.contours], em, before, fault, rng)
            if made is None:
                continue
            outline = replace(clean, contours=[Contour.from_segments(segments) for segments in made[0]])
            mended, changes = gs.mend(outline, tolerance=em / 250)
            found = gs.check(outline)
            assert not kinds_of(gs.check(mended)) - kinds_of(found)
            own = [one for one in changes if np.allclose(one.point, made[1].point)]
            joint = [(one.contour, one.segment) for one in own]
            if not own or any((one.contour, one.segment) in joint for one in before):  # a jump that the kink hides
                continue
            meant += 1
            near += gs.compare(clean, mended).bound <= 2 * em / 1000 and own[0].is_mended
            for old, new in zip(outline.contours, mended.contours, strict=True):
                assert (old.degrees == new.degrees).all()
                assert (new.points == np.round(new.points)).all()
            assert gs.compare(outline, mended).seen <= em / 250
    assert meant >= 50
    assert near >= 0.9 * meant


def test_a_level_handle_stays_level() -> None:
    shape = [(0, 0), (0, 300), (140, 500), (300, 500), (455, 509), (600, 300), (600, 0)]
    outline = gs.Outline("n", contours=[Contour(np.array(shape), np.array([3, 3, 1]))])
    mended, (change,) = gs.mend(outline, tolerance=5)
    assert mended.contours[0].points[2:5, 1].tolist() == [500, 500, 500]
    assert change.is_mended
    assert change.after == 0
    assert change.before > 3
    assert not [one for one in gs.check(mended) if one.kind == "kink"]


ARC = [(0, 0), (0, 331), (269, 600), (600, 600), (931, 600), (1200, 331), (1200, 0), (600, -100)]


@pytest.mark.parametrize("handle", [2, 4, 8, 10])
@pytest.mark.parametrize("degrees", [4.0, -7.0])
def test_of_two_handles_the_one_that_was_moved_comes_back(handle: int, degrees: float) -> None:
    quarters = [np.array(ARC[start : start + 4], dtype=np.float64) for start in (0, 3)]
    halves = [np.round(part) for quarter in quarters for part in split(quarter, 0.5)]
    clean = Contour.from_segments([*halves, np.array(ARC[6:8]), np.array([ARC[7], ARC[0]])])
    assert not gs.check(gs.Outline("o", contours=[clean]))
    points, node = clean.points.copy(), clean.points[3 if handle < 6 else 9]
    way = complex(*(points[handle] - node)) * np.exp(1j * np.radians(degrees))
    points[handle] = np.round(node + np.array([way.real, way.imag]))
    outline = gs.Outline("o", contours=[Contour(points, clean.degrees)])
    mended, (change,) = gs.mend(outline, tolerance=12)
    assert change.is_mended
    assert np.abs(mended.contours[0].points - clean.points).max() <= 1
    assert [number for _, number, _, _ in change.moves] == [handle]


def test_a_node_of_quadratics_follows_a_control_point_that_is_levelled() -> None:
    clean = np.array([(0, 0), (0, 70), (22.5, 101.5), (45, 133), (99, 133), (200, 133), (200, 0)])
    points = np.round(clean)  # as a font stores it where the node is not midway any more
    points[1] = 3, 70
    contour = MasterContour(points[None], np.array([2, 2, 2, 1]))
    a, b, c = clean[1], clean[2], clean[3]
    numbers, places = with_nodes(contour, np.array([1]), clean[None, [1]], 1.0)
    assert numbers.tolist() == [1, 2]
    before, behind = places[0, 1] - a, c - places[0, 1]
    turn = np.degrees(np.arctan2(before[0] * behind[1] - before[1] * behind[0], before @ behind))
    assert abs(turn) < 1
    assert (places == np.round(places)).all()
    assert np.abs(places[0, 1] - b).max() <= 1


def test_a_slanted_line_goes_to_the_height_of_more_nodes() -> None:
    shape = [(0, 0), (0, 500), (300, 502), (300, 300), (600, 300), (600, 502), (900, 502), (900, 0)]
    outline = gs.Outline("u", contours=[Contour(np.array(shape), np.ones(8, dtype=np.int64))])
    mended, (change,) = gs.mend(outline, ["slanted"], 4)
    assert change.moves == ((0, 1, (0.0, 500.0), (0.0, 502.0)),)
    assert mended.contours[0].points[1].tolist() == [0, 502]


def test_handles_that_cross_are_cut_to_where_curvatures_meet() -> None:
    clean = [(0, 0), (0, 166), (134, 300), (300, 300), (466, 300), (600, 166), (600, 0)]
    shape = [*clean]
    shape[4] = (675, 300)
    outline = gs.Outline("n", contours=[Contour(np.array(shape), np.array([3, 3, 1]))])
    mended, (change,) = gs.mend(outline, ["handles"], 80)
    assert change.is_mended
    assert np.abs(mended.contours[0].points - clean).max() <= 1


def test_kinks_between_masters_are_gone_everywhere() -> None:
    masters = family_of(SHAPE, BOLD)
    assert turn_at(masters.instance({"wght": 550})) > 2
    mended, (change,) = gs.mend(masters, tolerance=ENOUGH)
    turns = [turn_at(mended.instance({"wght": float(w)})) for w in np.linspace(400, 700, 301)]
    assert max(turns) < 1
    assert change.after is not None
    assert max(turns) <= change.after + 1e-9
    assert change.distance is not None
    assert change.distance <= ENOUGH
    for weight in (400.0, 470.0, 550.0, 700.0):
        assert gs.compare(masters.instance({"wght": weight}), mended.instance({"wght": weight})).seen <= ENOUGH
    assert (mended.contours[0].points == np.round(mended.contours[0].points)).all()


def test_what_needs_more_than_the_tolerance_is_left_and_named() -> None:
    masters = family_of(SHAPE, BOLD)
    same, (change,) = gs.mend(masters, tolerance=0.2)
    assert same is masters
    assert not change.is_mended
    assert change.needs is not None
    assert change.needs > 0.2
    mended, (change,) = gs.mend(masters, tolerance=1.01 * change.needs)
    assert mended is not masters
    assert change.is_mended
    with pytest.raises(gs.OptionError, match="what can be mended"):
        gs.mend(masters, kinds=["sparkle"])


def sources(folder: Path) -> Path:
    """A designspace of two UFOs: a joint that kinks between them, with names and anchors, and a glyph without."""
    ufoLib2 = pytest.importorskip("ufoLib2")
    from fontTools.designspaceLib import DesignSpaceDocument

    document = DesignSpaceDocument()
    document.addAxisDescriptor(tag="wght", name="Weight", minimum=400, default=400, maximum=700)
    for style, weight, points in (("Regular", 400, SHAPE), ("Bold", 700, BOLD)):
        font = ufoLib2.Font()
        font.info.familyName, font.info.styleName, font.info.unitsPerEm = "Mine", style, 1000
        font.info.ascender, font.info.descender = 800, -200
        for name in ("a", "b"):
            glyph = font.newGlyph(name)
            glyph.width, glyph.unicodes = 600, [ord(name)]
            pen = glyph.getPen()
            pen.moveTo(points[0])
            if name == "a":
                pen.curveTo(*points[1:4])
                pen.curveTo(*points[4:7])
            else:
                pen.lineTo(points[3])
                pen.lineTo(points[6])
            pen.closePath()
        glyph = font["a"]
        glyph.contours[0].points[3].smooth = True
        glyph.contours[0].points[3].name = "top"
        glyph.appendAnchor({"name": "top", "x": 300, "y": 500})
        font.newGlyph("aa").getPen().addComponent("a", (1, 0, 0, 1, 20, 0))
        font.save(folder / f"{style}.ufo")
        document.addSourceDescriptor(
            path=str(folder / f"{style}.ufo"), styleName=style, familyName="Mine", location={"Weight": weight}
        )
    document.write(folder / "Mine.designspace")
    return folder / "Mine.designspace"


def glyphs_file(folder: Path) -> Path:
    """The same as a Glyphs file."""
    glyphsLib = pytest.importorskip("glyphsLib")
    pytest.importorskip("ufo2ft")
    from fontTools.designspaceLib import DesignSpaceDocument

    glyphsLib.to_glyphs(DesignSpaceDocument.fromfile(sources(folder))).save(str(folder / "Mine.glyphs"))
    return folder / "Mine.glyphs"


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def without_numbers(data: bytes) -> bytes:
    return re.sub(rb'(<point x="|y=")[-\d.]+', rb"\1", data)


def test_in_sources_only_coordinates_change(tmp_path: Path) -> None:
    path = sources(tmp_path)
    before = contents(tmp_path)
    run = CliRunner().invoke(app, ["mend", str(path), "--in-place", "-j", "1", "--json", "--tolerance", "5"])
    assert run.exit_code == 0, run.output
    (facts,) = json.loads(run.stdout)
    assert (facts["changed"], facts["before"], facts["after"], facts["glyphs"]) == (["a"], 1, 0, 3)
    after = contents(tmp_path)
    changed = [name for name in before if before[name] != after[name]]
    assert before.keys() == after.keys()
    assert set(changed) <= {"Regular.ufo/glyphs/a.glif", "Bold.ufo/glyphs/a.glif"}
    assert changed
    for name in changed:
        assert without_numbers(before[name]) == without_numbers(after[name])
    assert not [one for one in gs.kinks(open_source(path))[0] if one.turn >= 1]


def test_a_dry_run_writes_nothing_and_a_copy_leaves_the_source(tmp_path: Path) -> None:
    path = sources(tmp_path)
    before = contents(tmp_path)
    run = CliRunner().invoke(app, ["mend", str(path), "--dry-run", "-j", "1", "--tolerance", "5"])
    assert run.exit_code == 0
    assert "1 glyph of 3 would change, 1 finding before, 0 after" in run.output
    assert contents(tmp_path) == before
    run = CliRunner().invoke(app, ["mend", str(path), "--out", str(tmp_path / "out"), "-j", "1", "--tolerance", "5"])
    assert run.exit_code == 0, run.output
    (copy,) = (tmp_path / "out").rglob("*.designspace")
    assert not [one for one in gs.kinks(open_source(copy))[0] if one.turn >= 1]
    now = contents(tmp_path)
    assert {name: now[name] for name in before} == before
    run = CliRunner().invoke(app, ["mend", str(path), "--dry-run", "-j", "1", "--tolerance", "0.01"])
    assert run.exit_code == 1
    assert "left: a, contour 0" in run.output


def test_a_bare_layer_is_called_glyphspline(tmp_path: Path) -> None:
    path = sources(tmp_path)
    for options in (["--layer", "-j", "1"], ["-j", "1", "--layer"]):
        run = CliRunner().invoke(app, ["mend", str(path), "--tolerance", "5", *options])
        assert run.exit_code == 0, run.output
        assert (tmp_path / "Bold.ufo" / "glyphs.glyphspline" / "a.glif").exists() or (
            tmp_path / "Regular.ufo" / "glyphs.glyphspline" / "a.glif"
        ).exists()
    (new := tmp_path / "new").mkdir()
    sources(new)  # without the layer, which has what was mended with another tolerance
    run = CliRunner().invoke(
        app, ["refit", str(new / "Bold.ufo"), "--text", "a", "-o", str(tmp_path / "o"), "-j", "1", "--layer"]
    )
    assert run.exit_code == 0, run.output
    assert "layer glyphspline of Bold.ufo: new outlines of 0 glyphs, G2, as fonts store them" in run.output


@pytest.mark.parametrize("layer", [None, "mended"])
def test_a_glyphs_file_is_mended(layer: str | None, tmp_path: Path) -> None:
    path = glyphs_file(tmp_path)
    text = path.read_text()
    options = ["--in-place"] if layer is None else ["--layer", layer]
    run = CliRunner().invoke(app, ["mend", str(path), *options, "-j", "1", "--tolerance", "5"])
    assert run.exit_code == 0, run.output
    assert len(open_source(path).glyph_names) == 3
    left = [one for one in gs.kinks(open_source(path))[0] if one.turn >= 1]
    if layer is None:
        assert not left
        numbers = r"[-\d.]+ [-\d.]+ (?=LINE|CURVE|OFFCURVE)|\([-\d.]+,[-\d.]+,(?=[a-z])"
        assert re.sub(numbers, "", text) == re.sub(numbers, "", path.read_text())
    else:
        assert left
        assert layer in path.read_text()


def test_check_and_mend_know_the_same_findings(tmp_path: Path) -> None:
    path = sources(tmp_path)
    known = ["check", str(path), "-j", "0", "-q", "-e", "WARN"]
    run = CliRunner().invoke(app, [*known[:-2], "--json", "--write-baseline", str(tmp_path / "known.json")])
    found = json.loads(run.stdout)["fonts"][0]["findings"]
    run = CliRunner().invoke(app, ["mend", str(path), "--in-place", "-j", "1", "--json", "--tolerance", "5"])
    (facts,) = json.loads(run.stdout)
    keys = [
        {tuple(one[key] for key in ("glyph", "kind", "contour", "segment")) for one in each if one["kind"] == "kink"}
        for each in (found, facts["changes"])
    ]
    assert keys[0] == keys[1] != set()
    run = CliRunner().invoke(app, [*known, "--baseline", str(tmp_path / "known.json")])
    assert run.exit_code == 0, run.output
    run = CliRunner().invoke(app, known)
    assert run.exit_code == 0, run.output


def test_the_script_of_the_docs_lists_what_would_be_mended() -> None:
    script = ROOT / "docs" / "examples" / "mend.py"
    command = [sys.executable, str(script), str(ROOT / "fonts_test" / "variable.ttf"), str(FONTS / "kouzan-gyosho.otf")]
    run = subprocess.run(
        command, capture_output=True, text=True, check=True, env=os.environ | {"PYTHONPATH": str(ROOT)}
    )
    lines = run.stdout.splitlines()
    assert len(lines) > 20
    assert all(line.count("|") == 8 for line in lines)
    assert "# /// script" in script.read_text()


def test_points_go_from_a_ufo_and_all_else_stays(tmp_path: Path) -> None:
    ufoLib2 = pytest.importorskip("ufoLib2")
    font = ufoLib2.Font()
    font.info.unitsPerEm = 1000
    glyph = font.newGlyph("n")
    glyph.unicodes = [ord("n")]
    for shape in (
        [(0, 0), (0, 500), (0, 500), (298, 500), (300, 499), (300, 0)],
        [(550, 51), (550, 300), (350, 300), (350, 50)],
    ):
        pen = glyph.getPen()
        pen.moveTo(shape[0])
        for point in shape[1:]:
            pen.lineTo(point)
        pen.closePath()
    glyph.contours[0].points[1].name = "corner"
    font.save(tmp_path / "a.ufo")
    before = (tmp_path / "a.ufo/glyphs/n.glif").read_text()
    run = CliRunner().invoke(
        app, ["mend", str(tmp_path / "a.ufo"), "--in-place", "--kinds", "all", "--tolerance", "3", "-j", "1", "--json"]
    )
    assert run.exit_code == 0, run.output
    (facts,) = json.loads(run.stdout)
    assert {one["kind"]: one["gone"] for one in facts["changes"]} == {
        "repeated": 1, "short": 1, "direction": 0, "slanted": 0
    }  # fmt: skip
    after = (tmp_path / "a.ufo/glyphs/n.glif").read_text()
    assert after.count("<point") == before.count("<point") - 2
    assert after.count('name="corner"') == 1
    outline = open_source(tmp_path / "a.ufo").outline("n")
    assert not [one for one in gs.check(outline) if one.kind != "direction"]
    found = [contour.points.tolist() for contour in outline.contours]
    assert sorted(found[0]) == [[0, 0], [0, 500], [300, 0], [300, 500]]


@pytest.mark.parametrize(
    ("fault", "kinds", "tolerance"),
    [
        ("slanted", "slanted", 4), ("straight", "straight", 4), ("extreme point 2 units off level", "unlevel kink", 4),
        ("short segment", "short", 4), ("almost closed", "short", 4), ("extremum left out", "extremum", 16),
    ],
)  # fmt: skip
def test_other_faults_come_back_to_the_clean_outline(fault: str, kinds: str, tolerance: int) -> None:
    font = gs.open_font(Path(get_data_path(), "fonts", "ttf", "cmr10.ttf"))
    rng = np.random.default_rng(3)
    near = meant = 0
    for name in font.select(text="abcdefghkmnpqrstBCDEFGHPRS2345689"):
        clean = font.outline(name)
        if "extremum" not in fault:  # raised, curvature jumps beside most extrema: to mend them would bring that back
            clean = cubics_of(clean)
        em = clean.metrics.units_per_em
        made = planted([list(c.segments()) for c in clean.contours], em, gs.check(clean), fault, rng)
        if made is None or meant == 12:
            continue
        outline = replace(clean, contours=[Contour.from_segments(segments) for segments in made[0]])
        mended, changes = gs.mend(outline, kinds.split(), tolerance * em / 1000)
        own = [one for one in changes if one.contour == made[1].contour]
        if not own:
            continue
        meant += 1
        near += gs.compare(clean, mended).bound <= 2 * em / 1000 and all(one.is_mended for one in own)
        assert not Counter(one.kind for one in gs.check(mended)) - Counter(one.kind for one in gs.check(outline))
        assert gs.compare(outline, mended).seen <= tolerance * em / 1000
        assert len(mended.arrays.points) <= len(outline.arrays.points)
        for one in changes:
            assert one.is_mended or one.gone == one.moved == 0
    assert meant >= 5
    assert near >= 0.8 * meant


@pytest.mark.parametrize("axis", [0, 1])
def test_an_extreme_point_of_cubics_that_went_comes_back(axis: int) -> None:
    shape = np.array([(0, 250), (0, 388), (134, 500), (300, 500), (466, 500), (600, 388), (600, 250)], dtype=np.float64)
    curves = shape[[0, 1, 2, 3]], shape[[3, 4, 5, 6]]
    line = np.array([shape[-1], shape[0]])
    clean = gs.Outline("o", contours=[Contour.from_segments([part[:, :: 1 - 2 * axis] for part in (*curves, line)])])
    made = planted([list(clean.contours[0].segments())], 1000, [], "extremum left out", np.random.default_rng(1))
    assert made is not None
    outline = replace(clean, contours=[Contour.from_segments(segments) for segments in made[0]])
    (found,) = [one for one in gs.check(outline) if one.kind == "extremum"]
    mended, (change,) = gs.mend(outline, ["extremum"], 16.0)
    assert (change.segment, change.is_mended) == (found.segment, True)
    assert gs.compare(clean, outline).seen > 2
    assert gs.compare(clean, mended).bound < 1.5
    assert abs(mended.arrays.points.max(axis=0)[1 - axis] - 500) <= 1


def test_long_handles_are_cut_to_where_they_meet_in_all_masters() -> None:
    regular = [(0, 0), (0, 350), (90, 300), (400, 300), (400, 0)]
    bold = [(0, 0), (0, 340), (80, 300), (400, 300), (400, 0)]
    points = np.array([regular, bold], dtype=np.float64)
    masters = gs.Masters(
        "a", axes=(WEIGHT,), regions=np.array([[[0.0, 1.0, 1.0]]]),
        contours=[MasterContour(points, np.array([3, 1, 1]))], advances=np.zeros(2),
    )  # fmt: skip
    _, (left,) = gs.mend(masters, ["handles"], 1.0)
    assert left.needs is not None
    assert left.needs > 1
    mended, (change,) = gs.mend(masters, ["handles"], 18.0)
    assert change.is_mended
    assert change.distance is not None
    assert change.distance <= 18
    assert (mended.contours[0].points[:, 1, 1] <= 302).all()
    assert (mended.contours[0].points[:, 1, 0] == 0).all()


def test_short_segments_go_in_all_masters_and_numbers_are_those_of_check() -> None:
    regular = [(0, 0), (0, 300), (1, 301), (300, 301), (300, 2), (299, 0)]
    bold = [(0, 0), (0, 400), (1, 401), (300, 401), (300, 2), (299, 0)]
    points = np.array([regular, bold], dtype=np.float64)
    masters = gs.Masters(
        "a", axes=(WEIGHT,), regions=np.array([[[0.0, 1.0, 1.0]]]),
        contours=[MasterContour(points, np.ones(6, dtype=np.int64))], advances=np.zeros(2),
    )  # fmt: skip
    mended, changes = gs.mend(masters, ["short"], 3.0)
    assert {(one.segment, one.is_mended, one.gone) for one in changes} == {(1, True, 1), (4, True, 1)}
    assert mended.contours[0].points.shape == (2, 4, 2)
    assert not [one for k in (0, 1) for one in gs.check(mended.master(k)) if one.kind in ("short", "slanted")]


def test_curvatures_meet_where_they_jumped() -> None:
    shape = [(0, 0), (0, 300), (190, 500), (300, 500), (460, 500), (600, 300), (600, 0)]
    outline = gs.Outline("n", contours=[Contour(np.array(shape), np.array([3, 3, 1]))])
    assert [one.kind for one in gs.check(outline)] == ["jump"]
    mended, (change,) = gs.mend(outline, ["jump"], 12)
    assert change.is_mended
    assert not gs.check(mended)
    assert gs.compare(outline, mended).seen <= 12
    assert mended.contours[0].points[2:5, 1].tolist() == [500, 500, 500]
    same, (left,) = gs.mend(outline, ["jump"], 0.2)
    assert same is outline
    assert left.needs is not None
    assert left.needs > 0.2


@pytest.mark.parametrize("corner", [0.0, 9.0])
def test_bounds_hold_where_curves_slip_along_themselves(corner: float) -> None:
    masters = family_of(SHAPE, BOLD)
    old = masters.contours[0]
    points = old.points.copy()
    points[0, 4] += 0.2 * (points[0, 4] - points[0, 3])  # a handle is made longer
    points[1, 0, 0] += corner
    new = MasterContour(points, old.degrees)
    bounds = distances(old, new, Design.of(masters, 3.0, THRESHOLDS, None))
    for weight in np.linspace(0, 1, 21):
        one, other = (each.mixed(np.array([1 - weight, weight])) for each in (old, new))
        seen = gs.compare(gs.Outline("a", contours=[one]), gs.Outline("a", contours=[other])).seen
        assert seen <= bounds.max()
    assert bounds.max() < 8 + 2 * corner


def test_places_on_the_grid_are_tried_again_for_turns_that_rounding_makes() -> None:
    corners = [
        [(-64, -71), (-64, -18), (0, 0), (88, 24), (88, -300)],
        [(-112, -131), (-112, -125), (-102, -123), (9, -101), (9, -300)],
        [(-60, -122), (-60, -108), (-28, -103), (68, -90), (68, -300)],
        [(-80, -133), (-80, -128), (-71, -126), (75, -110), (75, -300)],
    ]
    contour = MasterContour(np.array(corners, dtype=np.float64), np.array([2, 1, 1, 1]))
    regions = np.array([[[0, 1, 1], [0, 0, 0]], [[0, 0, 0], [0, 1, 1]], [[0, 1, 1], [0, 1, 1]]], dtype=np.float64)
    axes = (DesignAxis("opsz", "Size", 9, 9, 144), WEIGHT)
    masters = gs.Masters("a", axes=axes, regions=regions, contours=[contour], advances=np.zeros(4))
    mended, (change,) = gs.mend(masters, tolerance=3.0)
    assert change.is_mended
    assert change.moved <= 3
    assert mended.contours[0].points.shape == contour.points.shape


def test_a_joint_with_a_short_handle_says_what_it_needs() -> None:
    bold = [*BOLD]
    bold[4] = (306, 503)
    (change,) = gs.mend(family_of(SHAPE, bold), tolerance=4.0)[1]
    assert change.why == "is beyond the tolerance"
    assert change.needs is not None
    assert gs.mend(family_of(SHAPE, bold), tolerance=1.01 * change.needs)[1][0].is_mended


def test_of_two_kinks_beside_each_other_the_one_that_can_be_mended_is() -> None:
    points = [(0, 0), (0, 150), (80, 300), (200, 300), (260, 304), (330, 330), (400, 330), (470, 344), (600, 200)]
    outline = gs.Outline("n", contours=[Contour(np.array([*points, (600, 0)]), np.array([3, 3, 3, 1]))])
    assert [(one.kind, one.segment) for one in gs.check(outline)] == [("kink", 2), ("kink", 1)]
    mended, changes = gs.mend(outline, tolerance=3)
    assert [(one.segment, one.is_mended) for one in changes] == [(2, True), (1, False)]
    assert [(one.kind, one.segment) for one in gs.check(mended)] == [("kink", 1)]


def test_a_short_handle_that_is_level_in_one_master_only_may_turn() -> None:
    regular = [(0, 0), (120, 40), (200, 66), (260, 86), (300, 60), (300, 0)]
    bold = [(0, 0), (240, 32), (246, 32), (254, 32), (300, 10), (300, 0)]
    contour = MasterContour(np.array([regular, bold], dtype=np.float64), np.array([1, 3, 1, 1]))
    assert not ContourLayout(contour).frozen[1, [1, 2]].all()
    level = MasterContour(contour.points * [1, 0] + [0, 7], contour.degrees)
    assert ContourLayout(level).frozen[:, [1, 2], 1].all()


def test_a_joint_that_slides_along_a_line_costs_what_curves_move() -> None:
    regular = [(0, 0), (300, 0), (400, 0), (420, 60), (420, 300)]
    bold = [(0, 40), (260, 14), (380, 2), (430, 90), (430, 300)]
    masters = gs.Masters(
        "a", axes=(WEIGHT,), regions=np.array([[[0.0, 1.0, 1.0]]]), advances=np.zeros(2),
        contours=[MasterContour(np.array([regular, bold], dtype=np.float64), np.array([1, 2, 1, 1]))],
    )  # fmt: skip
    old, at = masters.contours[0], np.array([0.3, 0.12])[:, None]
    points = old.points.copy()
    points[:, 1] += at * (old.points[:, 0] - old.points[:, 1])  # by 90 and 31 units
    points[:, 2] += 0.02 * (old.points[:, 1] - old.points[:, 2])
    new = MasterContour(points, old.degrees)
    seen = 0.0
    for weight in np.linspace(0, 1, 41):
        one, other = (each.mixed(np.array([1 - weight, weight])) for each in (old, new))
        seen = max(seen, gs.compare(gs.Outline("a", contours=[one]), gs.Outline("a", contours=[other])).seen)
    bounds = distances(old, new, Design.of(masters, 1.1 * seen, THRESHOLDS, None))
    assert seen <= bounds.max() <= 1.1 * seen
