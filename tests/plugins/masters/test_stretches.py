"""Glyphs of variable fonts drawn anew arc by arc: no new kink, no more points, and what stays, stays as it was."""

from __future__ import annotations

import json
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._f_v_a_r import NamedInstance
from fontTools.varLib.iup import iup_delta
from typer.testing import CliRunner

from glyphspline import Options, open_font
from glyphspline.cli.app import app
from glyphspline.outlines.flaws.kinds import KINK, THRESHOLDS
from glyphspline.outlines.flaws.turns import joint_controls, turns_of
from glyphspline.outlines.masters import MasterContour, Masters
from glyphspline.plugins.fonts.tables.font_file import replace_family
from glyphspline.plugins.masters.convert_masters import convert_masters
from glyphspline.plugins.masters.job import redrawn_glyph
from glyphspline.plugins.masters.on_axes import on_axes
from glyphspline.plugins.masters.other_outlines import to_other_outlines
from glyphspline.plugins.masters.quadratic_masters import quadratic_masters
from glyphspline.plugins.masters.redrawn import Redrawn
from glyphspline.plugins.masters.stretches import ranges_of
from glyphspline.plugins.masters.variable_font import VariableSummary, to_variable_font
from glyphspline.readers import Font
from tests.places import FONTS
from tests.variable_fonts import quadratic, variable_font

AXES = (("wght", 100, 400, 900, "Weight"), ("wdth", 75, 100, 100, "Width"))
SUPPORTS = ({"wght": (0, 1, 1)}, {"wght": (-1, -1, 0)}, {"wdth": (-1, -1, 0)})
TOLERANCE = 1.0


def arch(rng: np.random.Generator) -> tuple[list[tuple[float, float]], list[bool]]:
    """Two slanted stems, whose lines go on as an arch of many points, and another arch inside."""
    lean, height, width = rng.integers(-8, 9) * 5, rng.integers(80, 100) * 5, rng.integers(60, 80) * 5
    left, right = np.array([lean, height]), np.array([width + lean, height])
    up = left / 5
    turn = np.linspace(np.pi, 0, 17)[1:-1]
    middle, half = (left + right) / 2 + up, width / 2
    bow = np.round(middle + np.stack([1.02 * half * np.cos(turn), 140 * np.sin(turn)], axis=1))
    points = [(0, 0), left, left + up, *bow, right + up, right, (width, 0), (width - 70, 0)]
    on = [True, True, *[False] * 17, True, True, True]
    inside = np.round((left + right) / 2 + np.stack([0.7 * half * np.cos(turn[::-1]), 90 * np.sin(turn)], axis=1))
    points += [right - [70, 0], *inside, (left[0] + 60, left[1]), (60, 0)]
    on += [True, *[False] * 15, True, True]
    return [(int(x), int(y)) for x, y in points], on


def drawn_font(folder: Path, seed: int) -> Font:
    """A glyph whose masters are drawn by the same rule, with other numbers, so that lines go on as arches in all."""
    shapes = [arch(np.random.default_rng([seed, k])) for k in range(4)]
    points, on = shapes[0]
    tuples = [
        (support, [(x - a, y - b) for (a, b), (x, y) in zip(points, other, strict=True)])
        for support, (other, _) in zip(SUPPORTS, shapes[1:], strict=True)
    ]
    return open_font(variable_font(folder / "arch.ttf", {"n": quadratic(points, on)}, {"n": tuples}, AXES))


def converted(masters: Masters, corners: str = "sharp", tolerance: float = TOLERANCE) -> Redrawn:
    options = Options(corners=corners, tolerance=tolerance, effort="fast")  # type: ignore[arg-type]
    return redrawn_glyph(convert_masters(masters, options))


def written(
    font: Font, redrawn: dict[str, Redrawn], flavour: str = "ttf", tolerance: float = TOLERANCE
) -> tuple[Font, VariableSummary]:
    data, summary = to_variable_font(font, redrawn, flavour, tolerance=tolerance)  # type: ignore[arg-type]
    return Font(font.path, data, 0, None), summary


def kinks(masters: Masters, least: float) -> list[tuple[np.ndarray, float]]:
    """Joints that turn by ``least`` to 12 degrees at masters or between: their places in all masters, and the turn."""
    grid = masters.grid()
    at = np.vstack([masters.peaks, np.random.default_rng(0).uniform(grid.min(0), grid.max(0), (60, grid.shape[1]))])
    found = []
    for contour in masters.contours:
        controls = joint_controls(contour)
        turns = np.abs(turns_of(np.tensordot(masters.weights_at(at), controls, axes=1))).max(axis=0)
        smooth = (np.abs(turns_of(controls)) < 12).all(axis=0)
        found += [(controls[:, j, 0, 0], turns[j]) for j in np.flatnonzero(smooth & (turns > least))]
    return found


def new_kinks(source: Masters, result: Masters) -> int:
    known = kinks(source, 0.0)
    return sum(
        not any(np.abs(place - there).max() < 1.5 and turn < before + 0.1 for there, before in known)
        for place, turn in kinks(result, 0.5)
    )


def points_of(font: Font, name: str) -> int:
    return len(font.tables()["glyf"][name].coordinates)


def test_no_kink_that_the_source_has_not(tmp_path: Path) -> None:
    made, fewer, anew = 0, 0, 0
    for seed in (*range(8), 49, 69, 89, 99, 128):  # few curves kink by themselves: of 130, the last five of these do
        font = drawn_font(tmp_path, seed)
        masters = font.masters("n")
        new = converted(masters, tolerance=TOLERANCE / 2)
        plain, _ = written(font, {"n": Redrawn(new.masters, new.contours, new.inner)})
        made += new_kinks(masters, plain.masters("n"))
        result, summary = written(font, {"n": new})
        assert new_kinks(masters, result.masters("n")) == 0
        assert points_of(result, "n") <= points_of(font, "n")
        fewer += points_of(result, "n") < points_of(font, "n")
        anew += len(summary.glyphs)
        for stored in summary.glyphs.values():
            assert stored.bound is not None
            assert stored.bound <= TOLERANCE
            assert stored.tally is not None
            assert stored.tally[0].tolist() == [points_of(font, "n"), points_of(result, "n")]
    assert made > 0, "the curves by themselves do kink"
    assert anew > 1
    assert fewer > 1


def test_quadratics_of_all_masters_follow_the_source_itself(tmp_path: Path) -> None:
    fewer, retreats = 0, 0
    for seed in range(8):
        font = drawn_font(tmp_path, seed)
        masters = font.masters("n")
        found = quadratic_masters(font, masters, Options(corners="sharp", continuity="g2", tolerance=TOLERANCE))
        result, summary = written(font, {"n": redrawn_glyph(found)})
        assert found.tally is not None
        assert all(contour.deviation_bound <= TOLERANCE for contour in found.contours)
        assert new_kinks(masters, result.masters("n")) == 0
        assert points_of(result, "n") <= points_of(font, "n")
        retreats += len(summary.left)
        for stored in summary.glyphs.values():
            assert found.tally[0].tolist() == [points_of(font, "n"), points_of(result, "n")]
            assert stored.tally is not None
            assert stored.tally[0].tolist() == [points_of(font, "n"), points_of(result, "n")]
            fewer += points_of(result, "n") < points_of(font, "n")
        for curve, drawn in zip([c.curve for c in found.contours], result.masters("n").contours, strict=True):
            assert curve.cubics() == pytest.approx(drawn.cubics(), abs=1e-6)
    assert fewer > 5
    assert retreats < 3


def test_cubics_of_all_masters_become_quadratics_without_a_new_kink(tmp_path: Path) -> None:
    for seed in range(4):
        data, _ = to_other_outlines(drawn_font(tmp_path, seed), {}, "otf", tolerance=TOLERANCE, rest=TOLERANCE)
        font, out = tmp_path / "cubic.otf", tmp_path / f"out{seed}"
        font.write_bytes(data)
        call = ["refit", str(font), "--masters", "--all", "--format", "ttf", "--jobs", "0", "--out", str(out)]
        assert CliRunner().invoke(app, call).exit_code == 0
        (file,) = out.glob("*.ttf")
        source, result = open_font(font).masters("n"), open_font(file).masters("n")
        assert new_kinks(source, result) == 0
        manifest = [json.loads(line) for line in (out / "manifest.jsonl").read_text().splitlines()]
        (stored,) = [line["stored"] for line in manifest if line["glyph"] == "n"]
        assert stored["within_tolerance"]


def test_an_arc_too_long_for_one_is_divided_where_it_is_level() -> None:
    """Waves of half circles between two lines, smooth at every joint, and higher in another master."""
    k, n = 4 / 3 * (np.sqrt(2) - 1), 13
    quarters = []
    for j in range(n):
        x, up = 100.0 * j, 1 if j % 2 == 0 else -1
        quarters += [(x, 50 * k * up), (x + 50 * (1 - k), 50 * up), (x + 50, 50 * up)]
        quarters += [(x + 50 * (1 + k), 50 * up), (x + 100, 50 * k * up), (x + 100, 0)]
    wave = np.array([(0.0, 0.0), *quarters, (100.0 * n, -400.0), (0.0, -400.0)])
    points = np.stack([wave, wave * [1.0, 1.1]])
    contour = MasterContour(points, np.array([*[3] * (2 * n), 1, 1, 1]))
    font = open_font(FONTS / "variable-cff2.otf")
    masters = replace(
        font.masters("l"), regions=font.masters("l").regions[:1], advances=np.zeros(2), contours=(contour,)
    )
    (made,) = quadratic_masters(font, masters, Options(tolerance=0.5)).contours
    turns = np.abs(turns_of(joint_controls(made.curve)))
    assert made.within_tolerance
    assert ((turns < 0.05) | (turns > 80)).all()


def test_a_cff2_glyph_has_no_more_segments(tmp_path: Path) -> None:
    font = open_font(FONTS / "variable-cff2.otf")
    names = [name for name in font.glyph_names if font.masters(name).contours]
    redrawn = {name: converted(font.masters(name), tolerance=8.0) for name in names}
    result, summary = written(font, redrawn, "otf")
    assert summary.glyphs
    for name in names:
        before, after = ([len(contour) for contour in each.masters(name).contours] for each in (font, result))
        assert sum(after) <= sum(before)
        assert new_kinks(font.masters(name), result.masters(name)) == 0
    loose = {name: replace(new, fewest=False) for name, new in redrawn.items()}
    _, summary = written(font, loose, "otf")
    tallies = [glyph.tally[0] for glyph in summary.glyphs.values() if glyph.tally is not None]
    assert any(after > before for before, after in tallies)


def own_segments(masters: Masters, inner: np.ndarray) -> Redrawn:
    """The source's own contour, with the joints given inside arcs, which are moved a little."""
    (contour,) = masters.contours
    points = contour.points.copy()
    points[:, (np.cumsum(contour.degrees) - contour.degrees)[inner]] += 0.01
    return Redrawn(masters, (MasterContour(points, contour.degrees),), (inner,), (0.01,), (0,), True)


def test_a_glyph_of_arcs_that_stay_keeps_its_bytes(tmp_path: Path) -> None:
    font = drawn_font(tmp_path, 1)
    masters = font.masters("n")
    result, summary = written(
        font, {"n": own_segments(masters, np.zeros(len(masters.contours[0]), dtype=bool))}, tolerance=0.011
    )
    assert "drawn anew" in summary.left["n"]
    for tag in ("glyf", "gvar", "loca", "hmtx", "maxp"):
        assert result.tables().reader[tag] == font.tables().reader[tag]


@pytest.mark.parametrize("shifted", [0, 3])
def test_stretches_that_stay_keep_their_points(tmp_path: Path, shifted: int) -> None:
    font = drawn_font(tmp_path, 1)
    tables = font.tables()
    glyph = tables["glyf"]["n"]
    if shifted:  # the contour begins elsewhere, at a control point
        places = np.roll(np.array(glyph.coordinates), shifted, axis=0)
        flags = np.roll(np.array(glyph.flags), shifted)
        glyph.coordinates[:] = [tuple(map(int, place)) for place in places]
        glyph.flags[:] = bytes(flags.tolist())
        for variation in tables["gvar"].variations["n"]:
            moved = variation.coordinates[:-4]
            variation.coordinates[:-4] = moved[-shifted:] + moved[:-shifted]
        file = BytesIO()
        tables.save(file)
        font = Font(font.path, file.getvalue(), 0, None)
    masters = font.masters("n")
    contour = masters.contours[0]
    # The arch outside is an arc of its own; all else stays.
    starts = contour.points[0, np.cumsum(contour.degrees) - contour.degrees]
    plain = drawn_font(tmp_path, 1).masters("n").contours[0].points[0]
    inner = np.array([(np.abs(plain[3:34:2] - start).max(axis=1) < 1e-6).any() for start in starts])
    assert inner.sum() == 16
    result, summary = written(font, {"n": own_segments(masters, inner)}, tolerance=3.0)
    (stored,) = summary.glyphs.values()
    assert stored.tally is not None
    assert stored.tally[0, 1] < stored.tally[0, 0]
    assert new_kinks(masters, result.masters("n")) == 0

    def rows(of: Font) -> set[tuple[int, ...]]:
        """Each point with all its deltas, and whether it is on the curve."""
        each: TTFont = of.tables()
        own = each["glyf"]["n"]
        places = [*own.coordinates, *[(0, 0)] * 4]
        tuples = [iup_delta(v.coordinates, places, own.endPtsOfContours)[:-4] for v in each["gvar"].variations["n"]]
        columns = [
            np.array(own.coordinates),
            *map(np.array, tuples),
            np.array([flag & 1 for flag in own.flags])[:, None],
        ]
        return set(map(tuple, np.concatenate(columns, axis=1).astype(int).tolist()))

    before, after = rows(font), rows(result)
    assert len(before & after) >= 8


def test_arcs_know_what_they_replace() -> None:
    corners = np.array([[0, 0], [100, 0], [100, 50], [100, 100], [0, 100]], dtype=float)
    source = MasterContour(corners[None], np.ones(5, dtype=np.int64))
    new = MasterContour(corners[None, [1, 3, 4, 0]], np.ones(4, dtype=np.int64))
    assert ranges_of(new, np.zeros(4, dtype=bool), source) == [range(1, 3), range(3, 4), range(4, 5), range(1)]
    away = MasterContour(corners[None, [1, 3, 4, 0]] + 1, np.ones(4, dtype=np.int64))
    assert ranges_of(away, np.zeros(4, dtype=bool), source) is None
    assert ranges_of(new, np.ones(4, dtype=bool), source) == [range(5)]


def test_what_is_stored_is_as_check_counts_it(tmp_path: Path) -> None:
    font = drawn_font(tmp_path, 2)
    call = ["refit", str(font.path), "--masters", "--glyphs", "n", "--corners", "sharp", "--effort", "fast"]
    out = tmp_path / "out"
    done = CliRunner().invoke(app, [*call, "--format", "ttf", "--jobs", "0", "--out", str(out)])
    assert done.exit_code == 0
    (file,) = out.glob("*.ttf")
    (line,) = [json.loads(line) for line in (out / "manifest.jsonl").read_text().splitlines()]
    stored = line["stored"]
    assert stored["within_tolerance"]
    assert stored["bound"] <= TOLERANCE
    result = open_font(file)
    assert stored["points"] == [points_of(font, "n"), points_of(result, "n")]
    before, after = stored["points"]
    assert f"points {before} → {after}, kinks at masters and along axes" in done.output.replace("\n", " ")
    tags = [axis.tag for axis in font.axes]
    for each, count in zip((font, result), stored["kinks"], strict=True):
        rows, _ = on_axes([each.masters("n")], {}, tags, 4, THRESHOLDS)
        assert (rows.kinds == KINK).sum() == count
    assert result.family == "Masters Spline"
    assert CliRunner().invoke(
        app, [*call, "--format", "ttf", "--jobs", "0", "--out", str(out), "--keep-name", "--restart"]
    )
    assert open_font(file).family == "Masters"


def test_a_new_family_name_is_in_all_names(tmp_path: Path) -> None:
    builder = FontBuilder(1000)
    builder.setupGlyphOrder([".notdef"])
    names = {
        "familyName": "Old Sans Light",
        "styleName": "Regular",
        "typographicFamily": "Old Sans",
        "psName": "OldSans-Light",
    }
    builder.setupNameTable({**names, "trademark": "Old Sans is a trademark", "licenseDescription": "OFL"})
    builder.setupFvar([("wght", 300, 300, 700, "Weight")], [])
    font = builder.font
    table = font["name"]
    for weight, style in ((300, "Light"), (700, "Bold")):
        instance = NamedInstance()
        instance.coordinates = {"wght": weight}
        instance.subfamilyNameID = table.addName(style)
        instance.postscriptNameID = table.addName(f"OldSans-{style}")
        font["fvar"].instances.append(instance)
    styles = [table.getDebugName(instance.subfamilyNameID) for instance in font["fvar"].instances]
    replace_family(font, "Old Sans Spline")
    texts = {record.nameID: record.toUnicode() for record in table.names}
    assert texts[1] == "Old Sans Spline Light"
    assert texts[16] == "Old Sans Spline"
    assert texts[13] == "OFL"
    assert 7 not in texts
    assert [table.getDebugName(instance.subfamilyNameID) for instance in font["fvar"].instances] == styles
    assert [texts[instance.postscriptNameID] for instance in font["fvar"].instances] == [
        "OldSansSpline-Light", "OldSansSpline-Bold",
    ]  # fmt: skip
    assert not any("OldSans-" in text for text in texts.values())
