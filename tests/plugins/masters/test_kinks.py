"""Kinks along axes: planted ones whose worst place is known, against dense sampling, and what the command says."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.ttLib import TTFont
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.outlines.joins import joins
from glyphspline.plugins.masters.kinks import AxisKinks, kinks_along
from glyphspline.writers.svg.path_data import path_data
from tests.places import FONTS
from tests.variable_fonts import WEIGHT, polygon, quadratic, variable_font

HANDLES = (40, 80, 90, 45)
"""Of the joint at the origin: arriving and leaving at the default, where both are level, and in the bold, upright."""

runner = CliRunner()


def kinked(path: Path, handles: tuple[int, int, int, int] = HANDLES) -> Path:
    """Glyph k has one smooth joint, whose tangents turn from level to upright; glyph b is a box."""
    p, q, r, s = handles
    points = [(0, 0), (q, 0), (400, 300), (-300, 300), (-p, 0)]
    bold = [(0, 0), (0, s), (400, 300), (-300, 300), (0, -r)]
    deltas = [(x - a, y - b) for (x, y), (a, b) in zip(bold, points, strict=True)]
    glyphs = {
        "k": quadratic(points, [True, False, True, True, False]),
        "b": polygon((0, 0), (300, 0), (300, 200), (0, 200)),
    }
    return variable_font(path, glyphs, {"k": [({"wght": (0, 1, 1)}, deltas)]})


def expected(handles: tuple[int, int, int, int] = HANDLES) -> tuple[float, float]:
    """The largest turn, and where: tan of the directions are u r / p and u s / q, where u = x / (1 - x)."""
    p, q, r, s = handles
    u = np.sqrt(p * q / (r * s))
    turn = np.degrees(np.arctan(u * r / p) - np.arctan(u * s / q))
    return float(abs(turn)), 400 + 500 * float(u / (1 + u))


def test_a_planted_kink_is_found_where_it_is(tmp_path: Path) -> None:
    font = gs.open_font(kinked(tmp_path / "v.ttf"))
    report = gs.kinks(font)
    assert (report.glyphs, report.failed, len(report)) == (3, (), 1)
    (of_axis,) = report
    assert len(of_axis) == 1  # all other joints are corners
    kink = of_axis[0]
    turn, at = expected()
    assert kink.turn == pytest.approx(turn, abs=1e-9)
    assert kink.location == {"wght": pytest.approx(at, abs=1e-6)}
    assert kink.made == pytest.approx(turn, abs=1e-9)
    assert kink.between == (400, 900)
    assert kink.at_masters == ((400, 0), (900, 0))
    assert (kink.glyph, kink.gid, kink.contour, kink.joint, kink.axis) == ("k", 1, 0, 0, "wght")
    assert kink.point == (0, 0)
    assert of_axis.positions == (400, 900)
    assert of_axis.profile[:, 1].max() == kink.turn
    assert (np.diff(of_axis.profile[:, 0]) >= 0).all()


def test_a_font_without_kinks() -> None:
    report = gs.kinks(gs.open_font(FONTS / "variable.ttf"))
    assert len(report[0]) > 20
    assert report[0].turns.max() < 1e-9
    assert report[0].made.max() < 1e-9


def test_joints_that_are_corners_in_any_master_are_not_measured(tmp_path: Path) -> None:
    font = gs.open_font(kinked(tmp_path / "v.ttf"))
    assert [len(gs.kinks(font, corner_angle=angle)[0]) for angle in (12, 80, 180)] == [1, 1, 7]
    (of_axis,) = gs.kinks(font, ["b"], corner_angle=91)
    assert (of_axis.turns == 90).all()
    assert (of_axis.made == 0).all()


def varied(path: Path) -> Path:
    """Round contours whose points move at random along two axes, with intermediate masters, handles lost among them."""
    rng = np.random.default_rng(11)
    axes = (WEIGHT, ("wdth", 50, 100, 200, "Width"))
    around = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    glyphs: dict[str, Any] = {}
    variations: dict[str, Any] = {}
    for name in "abcdefgh":
        radii = rng.uniform(200, 260, 12)
        points = np.rint(np.column_stack([300 + radii * np.cos(around), 300 + radii * np.sin(around)]))
        on = [k % 3 == 0 for k in range(12)]
        points[0] = np.rint((points[11] + points[1]) / 2)
        if name == "a":
            points[1] = points[0]  # a handle that there is in the bold only
        glyphs[name] = quadratic([(int(x), int(y)) for x, y in points], on)
        supports: list[Mapping[str, tuple[float, float, float]]] = [
            {"wght": (0, 0.5, 1)}, {"wght": (0.5, 1, 1)}, {"wdth": (-1, -1, 0)}, {"wdth": (0, 1, 1)},
            {"wght": (0, 1, 1), "wdth": (0, 1, 1)},
        ]  # fmt: skip
        variations[name] = [
            (support, [(int(x), int(y)) for x, y in rng.normal(0, 25, (12, 2))]) for support in supports
        ]
    return variable_font(path, glyphs, variations, axes)


@pytest.mark.parametrize("location", [{}, {"wght": 750, "wdth": 130}])
def test_nothing_between_the_masters_turns_more(location: dict[str, float], tmp_path: Path) -> None:
    """Against the joins of instances, densely; corners of up to 170 degrees are taken in, to have many joints."""
    path = varied(tmp_path / "v.ttf")
    report = gs.kinks(gs.open_font(path, location=location), corner_angle=170)
    count = 0
    for of_axis in report:
        axis = of_axis.axis
        values = np.union1d(np.linspace(axis.minimum, axis.maximum, 401), axis.default)
        for name in "abcdefgh":
            masters = gs.open_font(path).masters(name)
            found = [joins(masters.instance({**location, axis.tag: value}).contours[0]) for value in values.tolist()]
            turns = np.degrees(np.abs([of_value.turns for of_value in found]))
            for kink in [kink for kink in of_axis if kink.glyph == name]:
                sampled = float(turns[:, kink.joint].max())
                assert sampled - 1e-6 <= kink.turn <= sampled + 0.05
                at_masters = [turns[np.abs(values - value).argmin(), kink.joint] for value, _ in kink.at_masters]
                assert [turn for _, turn in kink.at_masters] == pytest.approx(at_masters, abs=1e-6)
                assert kink.made == pytest.approx(max(0.0, kink.turn - max(at_masters)), abs=1e-6)
                there = masters.instance(kink.location).contours[0]
                assert kink.point == pytest.approx(tuple(joins(there).points[kink.joint]))
                count += 1
    assert count > 60


def test_the_largest_jump_of_curvature_is_refined(tmp_path: Path) -> None:
    path = varied(tmp_path / "v.ttf")
    (of_axis,) = gs.kinks(gs.open_font(path), axis="wght", corner_angle=170)
    masters = {name: gs.open_font(path).masters(name) for name in "bcdefgh"}
    values = np.linspace(100, 900, 161)
    chosen = [kink for kink in of_axis if kink.glyph in masters]
    assert len(chosen) > 20
    for kink in chosen:
        jumps = []
        for value in [*values.tolist(), kink.jump_location["wght"]]:
            cubics = masters[kink.glyph].instance({"wght": value}).contours[0].cubics()
            before, after = (curvature(*three) for three in (cubics[kink.joint - 1][:0:-1], cubics[kink.joint][:3]))
            jumps.append(abs(after + before) / max(abs(after), abs(before)))
        assert kink.jump == pytest.approx(jumps[-1], abs=1e-6)
        assert kink.jump >= max(jumps[:-1]) - 1e-3


def curvature(a: Any, b: Any, c: Any) -> float:
    """At the first of a cubic's control points."""
    (ux, uy), (vx, vy) = b - a, c - b
    return float(2 / 3 * (ux * vy - uy * vx) / np.hypot(ux, uy) ** 3)


def test_the_size_of_batches_does_not_matter(tmp_path: Path) -> None:
    font = gs.open_font(varied(tmp_path / "v.ttf"))
    glyphs = [font.masters(name) for name in font.glyph_names]
    whole = kinks_along(glyphs, font.axes, {}, [0, 1], 12.0)
    threes = [kinks_along(glyphs[k : k + 3], font.axes, {}, [0, 1], 12.0) for k in range(0, len(glyphs), 3)]
    assert len(threes) > 1
    for one, *parts in zip(whole, *threes, strict=True):
        other = AxisKinks.joined(parts)
        assert one[:] == other[:]
        assert (one.profile == other.profile).all()


def test_glyphs_that_cannot_be_measured_are_named() -> None:
    font = gs.open_font(FONTS / "variable.ttf")
    report = gs.kinks(font, ["o", "nothing"])
    assert report.glyphs == 1
    assert report.failed == (("nothing", "the font has no such glyph"),)


@pytest.mark.parametrize(
    ("path", "how", "words"),
    [
        ("variable.ttf", {"axis": "wdth"}, "no axis 'wdth': it has wght"),
        ("kouzan-gyosho.ttf", {}, "not a variable font"),
        ("variable.ttf", {"corner_angle": 0}, "corner_angle is above 0 and up to 180 degrees, not 0"),
    ],
)
def test_what_cannot_be_asked(path: str, how: dict[str, Any], words: str) -> None:
    with pytest.raises(gs.GlyphsplineError, match=words):
        gs.kinks(gs.open_font(FONTS / path), **how)


def test_check_lists_kinks(tmp_path: Path) -> None:
    path = kinked(tmp_path / "v.ttf")
    result = runner.invoke(app, ["check", str(path), "--axis", "wght"])
    assert result.exit_code == 0, result.output
    turn, at = expected()
    (row,) = [line for line in result.stdout.splitlines() if line.lstrip().startswith("k ")]
    cells = [cell.strip() for cell in row.split(" | ")]
    assert [*cells[:2], *cells[3:6]] == ["k", "WARN", "0", "0", "0, 0"]
    assert cells[6] == f"kink: turns by {turn:.3g}° at a joint meant to be smooth"
    assert cells[7] == f"wght {at:.4g} (400 to 900)"


def test_check_as_json(tmp_path: Path) -> None:
    path = kinked(tmp_path / "v.ttf")
    result = runner.invoke(app, ["check", str(path), "--json", "--kinds", "kink"])
    (facts,) = json.loads(result.stdout)["fonts"]
    assert facts["axes"] == [{
        "axis": "wght", "joints": 1, "masters": [400, 900], "largest_turn": pytest.approx(expected()[0]),
        "largest_turn_at_masters": 0, "largest_made": pytest.approx(expected()[0]), "turns_over_1": 1, "made_over_1": 1,
        "jumps_over_10_percent": 1,
    }]  # fmt: skip
    (finding,) = facts["findings"]
    turn, at = expected()
    assert (finding["kind"], finding["value"]) == ("kink", pytest.approx(turn))
    assert finding["detail"] == pytest.approx(turn)  # made by interpolation
    assert (finding["location"], finding["between"]) == ({"wght": pytest.approx(at)}, [400, 900])
    (none,) = json.loads(runner.invoke(app, ["check", str(path), "--json", "--kinds", "kink", "--text", "b"]).stdout)[
        "fonts"
    ]
    assert (none["findings"], none["axes"][0]["largest_turn"]) == ([], None)


def test_a_finding_between_masters_is_drawn_where_it_is(tmp_path: Path) -> None:
    path = kinked(tmp_path / "v.ttf")
    result = runner.invoke(app, ["check", str(path), "--kinds", "kink", "--html", str(tmp_path / "a.html")])
    assert result.exit_code == 0, result.output
    setup = re.search(r'id="setup">(.*?)</script>', (tmp_path / "a.html").read_text(), re.DOTALL)
    assert setup
    page = json.loads(setup[1])
    (row,) = page["rows"]
    turn, at = expected()
    assert row[9] == f"wght {at:.4g} (400 to 900)"
    font = gs.open_font(path, location={"wght": at})
    assert page["outlines"] == [path_data(font.outline("k").contours, 2)]
    # the path's own handles at the joint make the turn
    first, *_, last = font.outline("k").contours[0].cubics()
    leaving, arriving = first[1] - first[0], last[3] - last[2]
    angle = np.arctan2(arriving[0] * leaving[1] - arriving[1] * leaving[0], arriving @ leaving)
    assert abs(np.degrees(angle)) == pytest.approx(turn, abs=0.5)


@pytest.mark.parametrize(("suffix", "start"), [("svg", b"<?xml"), ("png", b"\x89PNG"), ("pdf", b"%PDF")])
def test_check_draws(suffix: str, start: bytes, tmp_path: Path) -> None:
    path, plots = kinked(tmp_path / "v.ttf"), [tmp_path / f"{k}.{suffix}" for k in range(2)]
    for plot in plots:
        result = runner.invoke(app, ["check", str(path), "--plot", str(plot)])
        assert result.exit_code == 0, result.output
    assert plots[0].read_bytes().startswith(start)
    assert plots[0].read_bytes() == plots[1].read_bytes()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--axis", "opsz"], "no axis 'opsz': it has wght"),
        (["--plot", "turns.gif"], "--plot is a file of png, pdf, svg, not turns.gif"),
        (["--text", "Z"], "none of the glyphs asked for is in the font"),
        (["--glyphs", "k", "--corner-angle", "0"], "corner_angle is above 0"),
    ],
)
def test_calls_of_check_that_cannot_be_followed(arguments: list[str], words: str, tmp_path: Path) -> None:
    result = runner.invoke(app, ["check", str(kinked(tmp_path / "v.ttf")), *arguments])
    assert result.exit_code == 2
    assert words in result.stderr


@pytest.mark.parametrize("largest", [400, 132])
def test_an_axis_of_no_range_has_its_default_alone(largest: int, tmp_path: Path) -> None:
    """Also where its values are not in order."""
    font = TTFont(FONTS / "variable-cff2.otf")
    font["fvar"].axes[0].maxValue = largest
    font.save(tmp_path / "v.otf")
    assert [(axis.minimum, axis.maximum) for axis in gs.open_font(tmp_path / "v.otf").axes] == [(400, 400), (75, 100)]
    checked = runner.invoke(app, ["check", str(tmp_path / "v.otf"), "--jobs", "0", "--json"])
    assert checked.exit_code == 0
    assert [face["failed"] for face in json.loads(checked.stdout)["fonts"]] == [[]]
