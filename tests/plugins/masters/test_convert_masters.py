"""One curve for all masters: certified everywhere, smooth in every instance, written and read back."""

from __future__ import annotations

import json
import weakref
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.ttLib import TTFont
from scipy.spatial import cKDTree
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.curves.comb import end_curvatures
from glyphspline.curves.cubics import turns
from glyphspline.curves.pairing import pair_instances
from glyphspline.curves.slip import regular
from glyphspline.fitting.measures import geometry
from glyphspline.outlines.masters import DesignAxis, MasterContour, Masters
from glyphspline.outlines.outline import Contours
from glyphspline.plugins.masters.convert_masters import MastersContourResult, changes_at
from glyphspline.plugins.masters.job import STORED, redrawn_glyph
from glyphspline.plugins.masters.new_designspace import write_designspace
from glyphspline.plugins.masters.new_variable_font import to_new_variable_font
from glyphspline.plugins.masters.redrawn import Redrawn
from glyphspline.plugins.masters.single_fonts import masters_of_fonts
from glyphspline.plugins.masters.summary import MastersSummary
from glyphspline.plugins.masters.variable_font import to_variable_font
from glyphspline.readers import Font
from glyphspline.runs.result_text import from_text, to_text
from glyphspline.types import BoolArray, FloatArray, MadeOnDemand
from glyphspline.writers.svg.path_data import path_data
from tests import topology
from tests.places import FONTS

CFF2 = FONTS / "variable-cff2.otf"

AXES = (DesignAxis("wght", "Weight", 100, 100, 900), DesignAxis("wdth", "Width", 50, 50, 100))
PLACES = np.random.default_rng(4).uniform(0, 1, (25, 2))


def oval(width: float, height: float, tension: float, turn: float = 0.0) -> FloatArray:
    """(12, 2) points of an oval of four cubics."""
    a, b = width * tension, height * tension
    corners = [(width, 0, 0, b), (0, height, -a, 0), (-width, 0, 0, -b), (0, -height, a, 0)]
    points = []
    for (x, y, dx, dy), (u, v, du, dv) in zip(corners, corners[1:] + corners[:1], strict=True):
        points += [(x, y), (x + dx, y + dy), (u - du, v - dv)]
    c, s = np.cos(turn), np.sin(turn)
    return np.array(points) @ np.array([[c, s], [-s, c]])


def masters_of(*points: FloatArray, degrees: list[int] | None = None) -> Masters:
    """Masters at the corners of two axes: two, or four."""
    regions = np.array([[[0, 1, 1], [0, 0, 0]], [[0, 0, 0], [0, 1, 1]], [[0, 1, 1], [0, 1, 1]]], dtype=float)
    contour = MasterContour(np.array(points), np.array(degrees or [3] * (len(points[0]) // 3)))
    return Masters(
        "o", axes=AXES, regions=regions[: len(points) - 1], contours=(contour,), advances=np.ones(len(points))
    )


OVALS = masters_of(oval(200, 350, 0.5), oval(300, 340, 0.62), oval(120, 350, 0.55), oval(220, 350, 0.7, 0.2))


def sampled(cubics: FloatArray) -> FloatArray:
    """Samples of a chain, less than a tenth of a unit apart."""
    x = np.linspace(0, 1, 40_000 // len(cubics))[:, None]
    y = 1 - x
    parts = [y**3 * b[0] + 3 * y * y * x * b[1] + 3 * y * x * x * b[2] + x**3 * b[3] for b in cubics]
    return np.concatenate(parts)


def apart(a: FloatArray, b: FloatArray) -> float:
    """The two-sided distance of two chains, from samples."""
    p, q = sampled(a), sampled(b)
    return float(max(cKDTree(p).query(q)[0].max(), cKDTree(q).query(p)[0].max()))


@pytest.mark.parametrize("corners", ["smooth", "sharp"])
@pytest.mark.parametrize("tolerance", [1.0, 0.2])
def test_every_instance_is_near_its_source_and_curvature_continuous(corners: str, tolerance: float) -> None:
    result = gs.convert_masters(OVALS, gs.Options(corners=corners, tolerance=tolerance))  # type: ignore[arg-type]
    contour = result.contours[0]
    assert contour.within_tolerance
    assert contour.regular
    assert contour.kept == 0
    assert contour.inner.all()
    for at in PLACES:
        weights = OVALS.weights_at(at)
        ours, source = contour.curve.mixed(weights).cubics(), contour.source.mixed(weights).cubics()
        assert apart(ours, source) <= tolerance + 0.01
        assert np.abs(turns(ours, 1e-9)).max() < 1e-9
        curvature = end_curvatures(ours)
        np.testing.assert_allclose(curvature[:, 0], np.roll(curvature[:, 1], 1), rtol=1e-6)


def test_masters_that_agree_give_the_curve_of_one() -> None:
    points = oval(200, 350, 0.55)
    alone = gs.convert_masters(masters_of(points), gs.Options(corners="sharp"))
    twice = gs.convert_masters(masters_of(points, points), gs.Options(corners="sharp"))
    plain = gs.convert(OVALS.master(0), gs.Options(corners="sharp"))
    np.testing.assert_allclose(twice.contours[0].curve.points[0], alone.contours[0].curve.points[0], atol=1e-6)
    np.testing.assert_array_equal(twice.contours[0].curve.points[0], twice.contours[0].curve.points[1])
    assert len(plain.contours[0].curve) == len(gs.convert_masters(masters_of(oval(200, 350, 0.5))).contours[0].curve)


def brush(text: str) -> Iterator[tuple[gs.Outline, Masters]]:
    """Characters of a running hand in two masters: as they are, and wider, slanted and curved otherwise."""
    font = gs.open_font(FONTS / "kouzan-gyosho.otf")
    for outline in font.outlines(font.select(text=text)):
        wide = [np.rint(c.points @ [[1.15, 0.0], [0.06, 0.95]] + 4e-5 * c.points**2) for c in outline.contours]
        contours = [
            MasterContour(np.stack([c.points, other]), c.degrees)
            for c, other in zip(outline.contours, wide, strict=True)
        ]
        regions = np.array([[[0.0, 1.0, 1.0]]])
        yield outline, Masters(outline.name, 0, (), AXES[:1], regions, contours, np.ones(2), outline.metrics)


def kinks(cubics: FloatArray, lines: BoolArray) -> int:
    """The number of joints that turn by 0.5 to 12 degrees, but for those of two lines."""
    turning = np.degrees(np.abs(turns(cubics, 1e-6)))
    return int(np.count_nonzero((turning >= 0.5) & (turning < 12.0) & ~(lines & np.roll(lines, 1))))


def test_masters_as_fonts_store_them_have_fewer_curves_and_no_new_kink_at_any_location() -> None:
    before = after = 0
    for _, masters in brush("永好"):
        result = gs.convert_masters(masters, gs.Options(continuity="g2"))
        for contour in result.contours:
            assert contour.within_tolerance
            np.testing.assert_array_equal(contour.curve.points, np.rint(contour.curve.points))
            before, after = before + len(contour.source), after + len(contour.curve)
            for wght in np.linspace(0, 1, 12):
                weights = np.array([1 - wght, wght])
                ours, source = contour.curve.mixed(weights).cubics(), contour.source.mixed(weights).cubics()
                assert apart(ours, source) <= contour.deviation_bound + 0.05
                old = kinks(source, contour.source.degrees == 1)
                assert kinks(ours, contour.curve.degrees == 1) <= old, (masters.name, wght)
    assert after < 0.95 * before


def test_one_master_gets_the_curves_of_its_outline() -> None:
    for outline, _ in brush("永"):
        result = gs.convert_masters(Masters.of(outline), gs.Options(continuity="g2"))
        plain = gs.convert(outline, gs.Options(continuity="g2"))
        for one, other in zip(result.contours, plain.contours, strict=True):
            np.testing.assert_array_equal(one.curve.points[0], other.curve.points)
            assert one.deviation_bound == other.measures.deviation_bound


def test_masters_that_agree_are_stored_alike() -> None:
    points = np.rint(oval(200, 350, 0.5))
    result = gs.convert_masters(masters_of(points, points), gs.Options(continuity="g2", tolerance=5.0))
    curve = result.contours[0].curve
    np.testing.assert_array_equal(curve.points[0], curve.points[1])


def test_an_arc_that_ends_on_a_slanted_line_has_no_kink_there_in_any_instance() -> None:
    def bow(slant: float, handle: float) -> FloatArray:
        """A slanted line, then an arc that leaves it in its direction, and two more lines."""
        top = np.array([100 + slant, 500.0])
        way = np.array([slant, 500.0]) / np.hypot(slant, 500)
        return np.array([[100, 0], top, top + handle * way, [500, 650], [500, 400], [500, 0]], dtype=float)

    masters = masters_of(bow(0, 200), bow(120, 90), degrees=[1, 3, 1, 1])
    result = gs.convert_masters(masters, gs.Options(corners="sharp"))
    contour = result.contours[0]
    assert contour.within_tolerance
    assert contour.kept == 0
    for share in np.linspace(0, 1, 11):
        outline = contour.curve.mixed(np.array([1 - share, share]))
        joint = int(np.argmin(np.hypot(*(outline.cubics()[:, 0] - [100 + 120 * share, 500]).T)))
        assert np.degrees(abs(turns(outline.cubics(), 1e-9)[joint])) < 1e-6


def test_a_kink_between_masters_is_gone_and_its_price_is_said() -> None:
    def leaf(before: float, after: float) -> FloatArray:
        """Two arcs that meet smoothly, with handles of these lengths."""
        d = np.array([0.8, 0.6])
        joint = np.array([300.0, 300])
        return np.array([[0, 0], [100, 250], joint - before * d, joint, joint + after * d, [600, 500], [700, 0]], float)

    turned, angle = leaf(30, 120), np.radians(12)
    c, s = np.cos(angle), np.sin(angle)
    turned[2:5] = (turned[2:5] - 300) @ np.array([[c, s], [-s, c]]) + 300
    masters = masters_of(leaf(120, 30), turned, degrees=[3, 3, 1])
    middle = masters.contours[0].mixed(np.array([0.5, 0.5])).cubics()
    assert np.degrees(np.abs(turns(middle, 1e-9))[1]) > 4
    assert np.degrees(np.abs(turns(masters.contours[0].mixed(np.array([1.0, 0])).cubics(), 1e-9))[1]) < 1e-9
    result = gs.convert_masters(masters)
    assert result.contours[0].within_tolerance
    assert result.contours[0].kept == 0
    assert result.turn({"wght": 500}) < 1e-6
    ratio = result.energy_ratio({"wght": 500})
    assert ratio is not None
    assert ratio > 1.05


def test_the_slip_bound_holds_in_between_and_is_not_the_plain_one() -> None:
    """Two instances whose sections slip apart along straight-ish chains: the bound is far below the slip."""
    line = np.array([[0.0, 0], [100, 2], [200, 2], [300, 0]])
    other = line * [1.2, 1.0]
    sources = np.array(
        [[line, [[300.0, 0], [200, -90], [100, -90], [0, 0]]], [other, [[360.0, 0], [240, -90], [120, -90], [0, 0]]]]
    )
    results = sources.copy()
    results[0, 0] = np.array([[0.0, 0], [80, 1.9], [180, 2.2], [300, 0]])
    results[1, 0] = np.array([[0.0, 0], [140, 2.1], [260, 1.9], [360, 0]])
    anchors, bounds = np.array([[0.0, 0], [1, 1], [2, 2]]), np.full(2, np.nan)
    arcs, two, three = np.array([[0.0, 1, 0, 1], [1, 2, 1, 2]]), np.array([0, 2]), np.array([0, 3])
    chains = [each.swapaxes(0, 1).reshape(-1, 4, 2) for each in (results, sources)]
    pair_instances(2, (chains[0], two), (chains[1], two), (anchors, three), arcs, 0.0, 0.5, bounds, np.zeros(2))
    assert bounds[1] < 1e-9
    assert np.abs(results - sources).max() > 15
    assert bounds[0] <= 0.5
    for w in np.linspace(0, 1, 21):
        a, b = (w * each[0] + (1 - w) * each[1] for each in (results, sources))
        assert apart(a, b) <= bounds[0] + 0.01
    assert regular(results.swapaxes(0, 1)).all()


def test_a_cusp_in_between_is_not_called_regular() -> None:
    there = oval(200, 300, 0.55)
    mirrored = there * [-1.0, 1.0]  # in the middle the oval is a line run through twice
    result = gs.convert_masters(masters_of(there, mirrored))
    assert not result.contours[0].regular


def stem(width: float, bow: float) -> FloatArray:
    """An arc on three lines, all joints corners."""
    return np.array([[0, 0], [0, 500], [width / 3, 500 + bow], [2 * width / 3, 500 + bow], [width, 500], [width, 0]])


def test_smooth_masters_of_corners_keep_no_segment() -> None:
    masters = masters_of(stem(100, 60), stem(220, 120), degrees=[1, 3, 1, 1])
    result = gs.convert_masters(masters, gs.Options(corners="smooth", tolerance=1.0))
    contour = result.contours[0]
    assert (contour.kept, contour.within_tolerance, result.notes) == (0, True, ())
    assert contour.inner.all()
    for share in np.linspace(0, 1, 5):
        assert np.abs(turns(contour.curve.mixed(np.array([1 - share, share])).cubics(), 1e-9)).max() < 1e-9


def bends_beyond_the_floor(contour: MastersContourResult, weights: FloatArray) -> int:
    """Extrema of curvature of an instance beyond the fewest that a smooth curve can have."""
    ours, source = (Contours([each.mixed(weights)]).arrays for each in (contour.curve, contour.source))
    found = geometry(ours, ours, source, np.zeros((3, 2)), np.array([0, 3]))
    return int(found.curvature_extrema[0] - found.curvature_extrema_floor[0])


def test_corners_of_smooth_masters_have_no_rings_in_any_instance() -> None:
    masters = masters_of(stem(100, 60), stem(220, 120), degrees=[1, 3, 1, 1])
    held, passed = (
        gs.convert_masters(masters, gs.Options(corners="smooth", hold_corners=hold)).contours[0]
        for hold in (True, False)
    )
    for share in np.linspace(0, 1, 5):
        weights = np.array([1 - share, share])
        assert bends_beyond_the_floor(held, weights) == 0
        assert bends_beyond_the_floor(passed, weights) > 4
        assert apart(held.curve.mixed(weights).cubics(), held.source.mixed(weights).cubics()) <= 1.01


def test_a_corner_that_opens_in_one_master_is_rounded_in_all() -> None:
    """A square one of whose corners is a straight joint in the other master."""
    square = np.array([[0.0, 0.0], [400.0, 0.0], [400.0, 400.0], [0.0, 400.0]])
    triangle = np.array([[0.0, 0.0], [400.0, 0.0], [200.0, 200.0], [0.0, 400.0]])
    result = gs.convert_masters(masters_of(square, triangle, degrees=[1] * 4), gs.Options(corners="smooth"))
    contour = result.contours[0]
    assert (contour.within_tolerance, contour.kept, contour.new_crossings) == (True, 0, 0)
    for share in np.linspace(0, 1, 5):
        weights = np.array([1 - share, share])
        assert apart(contour.curve.mixed(weights).cubics(), contour.source.mixed(weights).cubics()) <= 1.01
        assert bends_beyond_the_floor(contour, weights) <= 0


def test_smooth_masters_that_agree_need_no_more_than_one() -> None:
    shape, options = stem(150, 80), gs.Options(corners="smooth")
    alone, twice = (
        gs.convert_masters(masters_of(*[shape] * k, degrees=[1, 3, 1, 1]), options).contours[0] for k in (1, 2)
    )
    np.testing.assert_array_equal(twice.curve.points[0], twice.curve.points[1])
    assert len(twice.curve) <= len(alone.curve)
    assert apart(twice.curve.cubics()[0], alone.curve.cubics()[0]) <= 1


def test_lines_that_stay_in_a_smooth_fit_are_counted_and_said() -> None:
    """So closely no closed curve is certified, and the contour stays as it is: lines and corners too."""
    masters = masters_of(stem(100, 60), stem(220, 120), degrees=[1, 3, 1, 1])
    result = gs.convert_masters(masters, gs.Options(corners="smooth", tolerance=1e-8))
    for ours, own in zip(result.contours[0].curve.points, masters.contours[0].points, strict=True):
        assert sorted(ours.round(6).tolist()) == sorted(own.round(6).tolist())
    assert result.contours[0].kept == 4
    assert "4 segments of contour 0 stay as the source has them" in result.notes


def test_errors_say_what_is_wrong() -> None:
    with pytest.raises(gs.OptionError, match="by tolerance"):
        gs.convert_masters(OVALS, gs.Options(count=20))
    bad = oval(200, 350, 0.5)
    bad[3, 0] = np.nan
    with pytest.raises(gs.GlyphsplineError, match=r"'o', contour 0: master 1: .*not finite"):
        gs.convert_masters(masters_of(oval(200, 350, 0.5), bad))


def test_a_stored_result_is_read_back_as_it_was() -> None:
    result = gs.convert_masters(OVALS)
    again = from_text(to_text(result), gs.MastersResult, STORED)
    np.testing.assert_array_equal(again.contours[0].curve.points, result.contours[0].curve.points)
    assert again.contours[0].inner.dtype == np.bool_
    assert repr(again) == repr(result)


def test_the_command_writes_a_variable_font_and_a_designspace(tmp_path: Path) -> None:
    call = ["refit", str(CFF2), "--masters", "--all", "--corners", "sharp", "--format", "otf,ufo", "--jobs", "0"]
    done = CliRunner().invoke(app, [*call, "--out", str(tmp_path / "out")])
    assert done.exit_code == 0, done.output
    lines = [json.loads(line) for line in (tmp_path / "out" / "manifest.jsonl").read_text().splitlines()]
    assert [line["glyph"] for line in lines] == list(gs.open_font(CFF2).glyph_names)
    assert all(c["within_tolerance"] for line in lines for c in line["contours"])
    written = next((tmp_path / "out").glob("*.otf"))
    before, after = TTFont(CFF2), TTFont(written)
    assert set(before.keys()) == set(after.keys())
    source, font = gs.open_font(CFF2), gs.open_font(written)
    for name in ("o", "n"):
        assert font.outline(name).advance == source.outline(name).advance
    data = written.read_bytes()
    again = CliRunner().invoke(app, [*call, "--out", str(tmp_path / "again"), "--jobs", "2"])
    assert again.exit_code == 0
    assert next((tmp_path / "again").glob("*.otf")).read_bytes() == data
    assert list((tmp_path / "out").rglob("*.designspace"))


def test_single_fonts_become_a_variable_one(tmp_path: Path) -> None:
    from fontTools.varLib.instancer import instantiateVariableFont

    source = FONTS / "variable.ttf"
    for value in (400, 900):
        instantiateVariableFont(TTFont(source), {"wght": value}).save(tmp_path / f"{value}.ttf")
    call = ["refit", str(tmp_path / "400.ttf"), str(tmp_path / "900.ttf"), "--axis", "wght=400:900"]
    call += ["--glyphs", "o,stem,space", "--jobs", "0"]
    for more in ([], ["--format", "ttf,ufo", "--continuity", "c2"]):
        out = tmp_path / f"out{len(more)}"
        done = CliRunner().invoke(app, [*call, "--out", str(out), *more])
        assert done.exit_code == 0, done.output
        font = gs.open_font(next(out.glob("*.ttf")), location={"wght": 900})
        bold = gs.open_font(source, location={"wght": 900})
        for name in ("o", "stem", "space"):
            assert font.outline(name).advance == bold.outline(name).advance
        ours, theirs = (np.concatenate([c.cubics() for c in f.outline("o").contours]) for f in (font, bold))
        assert apart(ours, theirs) < 1.5
        assert bool(list(out.rglob("*.designspace"))) == bool(more)
    refused = CliRunner().invoke(app, [*call, "--out", str(tmp_path / "both"), "--format", "ttf,ufo"])
    assert refused.exit_code == 2
    assert "--continuity c2" in refused.output + (refused.stderr if refused.stderr_bytes else "")


def test_the_default_master_is_drawn_and_a_page_has_all(tmp_path: Path) -> None:
    call = ["refit", str(CFF2), "--masters", "--glyphs", "o,space", "--out", str(tmp_path), "--jobs", "0"]
    call += ["--format", "svg,curvature,gallery", "--continuity", "c2"]
    assert CliRunner().invoke(app, call).exit_code == 0
    result = gs.convert_masters(gs.open_font(CFF2).masters("o"))
    contours = result.instance({}).contours
    assert f'd="{path_data(contours, 1)}"' in (tmp_path / "svg" / "o.svg").read_text()
    lines = [json.loads(line) for line in (tmp_path / "manifest.jsonl").read_text().splitlines()]
    assert [sorted(line["files"]) for line in lines] == [["results"], ["curvature", "gallery", "results", "svg"]]
    assert [line["advance"] for line in lines] == [gs.open_font(CFF2).outline(n).advance for n in ("space", "o")]
    text = (tmp_path / "gallery" / "o.glyph.js").read_text()
    masters = json.loads(text.removeprefix("glyphsplineData(").removesuffix(");\n"))["masters"]
    assert [axis["tag"] for axis in masters["axes"]] == ["wght", "wdth"]
    peak = result.masters.scalars(result.masters.peaks)
    for (degrees, mixed), contour in zip(masters["result"], result.contours, strict=True):
        assert degrees == contour.curve.degrees.tolist()
        np.testing.assert_allclose((peak @ mixed).reshape(contour.curve.points.shape), contour.curve.points, atol=2e-3)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    assert CliRunner().invoke(app, [*call, "--resume"]).exit_code == 0
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before


def test_masters_refuse_formats_that_are_not_theirs(tmp_path: Path) -> None:
    call = ["refit", str(CFF2), "--masters", "--all", "--format", "parquet", "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, [*call, "--jobs", "0"])
    assert done.exit_code == 2
    assert "glyphspline convert FONT --format parquet" in done.output + (done.stderr if done.stderr_bytes else "")


@pytest.fixture(scope="module")
def weights_of_blobs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A light and a bold single font."""
    from fontTools.varLib.instancer import instantiateVariableFont

    folder = tmp_path_factory.mktemp("single")
    for value in (400, 900):
        instantiateVariableFont(TTFont(FONTS / "variable.ttf"), {"wght": value}).save(folder / f"{value}.ttf")
    return folder / "400.ttf", folder / "900.ttf"


def from_call(light: Path, bold: Path, out: Path, glyphs: str) -> list[str]:
    call = ["refit", str(light), str(bold), "--axis", "wght=400:900", "--glyphs", glyphs]
    return [*call, "--format", "ttf", "--jobs", "0", "--out", str(out)]


def test_a_run_over_single_fonts_is_resumed_and_refused_if_one_of_them_changed(
    weights_of_blobs: tuple[Path, Path], tmp_path: Path
) -> None:
    light, bold = weights_of_blobs
    out = tmp_path / "out"
    assert CliRunner().invoke(app, from_call(light, bold, out, "o")).exit_code == 0
    run = json.loads((out / "run.json").read_text())
    assert run["axis"] == "wght=400:900"
    assert [font["sha256"] for font in run["from"]] == [gs.open_font(bold).sha256]
    assert "refit 400.ttf 900.ttf --axis wght=400:900" in run["command"]
    first = (out / "results" / "o.json").stat()
    again = CliRunner().invoke(app, from_call(light, bold, out, "o,stem"))
    assert again.exit_code == 0, again.output
    assert (out / "results" / "o.json").stat().st_mtime_ns == first.st_mtime_ns
    assert [json.loads(line)["glyph"] for line in (out / "manifest.jsonl").read_text().splitlines()] == ["o", "stem"]

    other = tmp_path / "900.ttf"
    font = TTFont(bold)
    font["head"].fontRevision = 7.0
    font.save(other)
    refused = CliRunner().invoke(app, from_call(light, other, out, "o"))
    assert refused.exit_code == 2
    assert "from.1.sha256" in refused.output + (refused.stderr if refused.stderr_bytes else "")


def masters_call(out: Path, glyphs: str, *more: str) -> list[str]:
    call = ["refit", str(CFF2), "--masters", "--glyphs", glyphs, "--corners", "sharp", "--format", "otf"]
    return [*call, "--jobs", "0", "--out", str(out), *more]


def manifest_of(out: Path) -> dict[str, Any]:
    lines = [json.loads(line) for line in (out / "manifest.jsonl").read_text().splitlines()]
    return {line["glyph"]: line for line in lines}


def test_a_run_goes_on_with_its_glyphs_and_a_restart_has_none_of_the_old_results(tmp_path: Path) -> None:
    def first_points(name: str) -> FloatArray:
        text = (tmp_path / "results" / f"{name}.json").read_text()
        return from_text(text, gs.MastersResult, STORED).contours[0].curve.points

    smooth = ("--corners", "smooth")
    assert CliRunner().invoke(app, masters_call(tmp_path, "o", *smooth)).exit_code == 0
    old, written = first_points("o"), (tmp_path / "results" / "o.json").stat()
    assert CliRunner().invoke(app, masters_call(tmp_path, "n", *smooth)).exit_code == 0
    assert list(manifest_of(tmp_path)) == ["o", "n"]
    assert (tmp_path / "results" / "o.json").stat().st_mtime_ns == written.st_mtime_ns
    font, source = gs.open_font(next(tmp_path.glob("*.otf"))), gs.open_font(CFF2)
    for name, line in manifest_of(tmp_path).items():  # the font has both, as far as there is anything new
        same = font.outline(name).arrays.points.shape == source.outline(name).arrays.points.shape
        assert same == (line["kept"] is not None)
    assert manifest_of(tmp_path)["o"]["kept"] is None
    done = CliRunner().invoke(app, masters_call(tmp_path, "o", *smooth, "--tolerance", "0.1", "--restart"))
    assert done.exit_code == 0
    assert list(manifest_of(tmp_path)) == ["o"]
    assert first_points("o").shape != old.shape
    assert not (tmp_path / "results" / "n.json").exists()


def test_a_font_is_written_with_one_result_in_memory_at_a_time(
    weights_of_blobs: tuple[Path, Path], tmp_path: Path
) -> None:
    alive: list[weakref.ref[Redrawn]] = []

    def read(masters: Masters) -> Redrawn:
        assert sum(each() is not None for each in alive) <= 2  # the one before, until its name is bound anew
        result = redrawn_glyph(gs.convert_masters(masters))
        alive.append(weakref.ref(result))
        return result

    font = gs.open_font(CFF2)
    assert isinstance(font, Font)
    cff2 = MadeOnDemand(font.glyph_names, lambda name: read(font.masters(name)))
    to_variable_font(font, cff2, "otf")
    write_designspace(font, cff2, tmp_path / "folder")
    pair = [gs.open_font(path) for path in weights_of_blobs]
    glyphs = {glyph.name: glyph for glyph in masters_of_fonts(pair, "wght=400:900") if isinstance(glyph, Masters)}
    to_new_variable_font(pair, "wght=400:900", MadeOnDemand(glyphs, lambda name: read(glyphs[name])))
    assert len(alive) > 8


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--location", "wght=600"], "--location wght=600 is not for --masters"),
        (["--jobs", "tcp://localhost:1"], "--jobs tcp://localhost:1 is not for --masters"),
        (["--axis", "wght=400:900"], "one font has masters of its own"),
        ([str(CFF2)], "become masters on --axis"),
        ([str(CFF2), "--axis", "wght=400", "--format", "ttf"], "an axis is like"),
        (["--format", "ttf,otf"], "--continuity c2"),
    ],
)
def test_options_that_clash_with_masters_are_refused(more: list[str], said: str, tmp_path: Path) -> None:
    done = CliRunner().invoke(app, masters_call(tmp_path / "out", "o", *more))
    assert done.exit_code == 2
    assert said in done.output + (done.stderr if done.stderr_bytes else "")
    assert not (tmp_path / "out" / "run.json").exists()


def test_the_summary_of_masters_as_json(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, masters_call(tmp_path / "out", "o", "--quiet", "--json"))
    assert done.exit_code == 0
    facts = json.loads(done.stdout)
    assert (facts["glyphs"], facts["failed"], facts["outside"]) == (1, {}, [])
    assert 0 < facts["bound"] <= 1
    assert [path.name for path in (tmp_path / "out" / "results").iterdir()] == ["o.json"]
    empty = CliRunner().invoke(app, masters_call(tmp_path / "empty", "space", "--quiet", "--json"))
    assert json.loads(empty.stdout)["bound"] is None


def test_a_glyph_that_fails_is_named_with_the_font_that_lacks_it(
    weights_of_blobs: tuple[Path, Path], tmp_path: Path
) -> None:
    from fontTools.subset import Subsetter

    light, bold = weights_of_blobs
    font = TTFont(bold)
    cut = Subsetter()
    cut.populate(text="o")
    cut.subset(font)
    font.save(tmp_path / "few.ttf")
    done = CliRunner().invoke(app, from_call(light, tmp_path / "few.ttf", tmp_path / "out", "o,stem"))
    assert done.exit_code == 1
    lines = manifest_of(tmp_path / "out")
    assert lines["o"]["status"] == "ok"
    assert lines["stem"]["error"] == "few.ttf: there is no glyph 'stem' or U+006C"
    assert "failed: stem: few.ttf: there is no glyph" in done.output + (done.stderr if done.stderr_bytes else "")


def test_one_master_is_certified_as_several_are() -> None:
    good, options = oval(200, 350, 0.55), gs.Options(precision=0, tolerance=3.0)
    alone, twice = (gs.convert_masters(masters_of(*[good] * k), options).contours[0] for k in (1, 2))
    assert alone.regular
    # As it is, not rounded to whole units.
    assert alone.deviation_bound == pytest.approx(twice.deviation_bound, rel=1e-3)
    assert apart(alone.curve.cubics()[0], alone.source.cubics()[0]) <= alone.deviation_bound + 0.01


def test_a_glyph_without_contours_claims_no_bound() -> None:
    assert repr(gs.convert_masters(Masters("space"))) == "<MastersResult 'space': 1 master, 0 contours, 0 segments>"


def rings(gap: float) -> Masters:
    """Two circles of different radius, whose vertices are not at the same angles, in a master and a wider one."""
    outer, inner = oval(300, 300, 0.5523), np.roll(oval(300 - gap, 300 - gap, 0.5523, np.pi / 4)[::-1], 1, axis=0)
    wider = [1.2, 1.0]
    contours = [MasterContour(np.array([points, points * wider]), np.full(4, 3)) for points in (outer, inner)]
    return replace(masters_of(outer, outer), contours=tuple(contours))


def exact_crossings(outline: gs.Outline) -> dict[tuple[int, int], int]:
    """Crossings by whole numbers, with the curves rounded to 1/10000 unit."""
    path = []
    for contour in outline.contours:
        cubics = np.round(contour.cubics(), 4)
        numbers = [" ".join(f"{x:.4f}" for x in cubic[1:].ravel()) for cubic in cubics]
        path.append(f"M{cubics[0, 0, 0]:.4f} {cubics[0, 0, 1]:.4f}" + "".join(f"C{each}" for each in numbers) + "Z")
    return topology.crossings(topology.path_contours("".join(path)))


@pytest.mark.parametrize("corners", ["smooth", "sharp"])
def test_contours_that_would_cross_in_a_master_are_fitted_more_closely(corners: str) -> None:
    masters, options = rings(1), gs.Options(tolerance=10, corners=corners)  # type: ignore[arg-type]
    result = gs.convert_masters(masters, options)
    assert [(c.new_crossings, c.collapsed) for c in result.contours] == [(0, False)] * 2
    assert not result.notes
    one_by_one = [gs.convert_masters(replace(masters, contours=(c,)), options) for c in masters.contours]
    by_themselves = replace(result, contours=tuple(each.contours[0] for each in one_by_one))
    for weights in np.eye(2):
        assert not exact_crossings(result.mixed(weights))
        assert exact_crossings(by_themselves.mixed(weights))[0, 1] == 8  # so there was something to mend


def test_contours_that_still_cross_are_named_with_the_place() -> None:
    result = gs.convert_masters(rings(1), gs.Options(tolerance=20))
    counts = [exact_crossings(result.mixed(weights)) for weights in np.eye(2)]
    assert [c.new_crossings for c in result.contours] == [max(found[0, 1] for found in counts)] * 2
    assert "contour 0 crosses itself or others, 8 times more than its source, at 2 of 2 corners" in result.notes[0]
    assert result.notes[0].endswith(("as at wght=100,wdth=50", "as at wght=900,wdth=50"))
    summary = MastersSummary()
    good = {"segments": 4, "source_segments": 4, "deviation_bound": 1.0, "within_tolerance": True, "regular": True}
    measures = [{**good, "source_segments_kept": 0, "new_crossings": 8, "collapsed": False}] * 2
    summary.add({"glyph": "o", "status": "ok", "contours": measures, "error": None})
    assert "cross where the source does not: o" in list(summary.lines())


def test_a_contour_that_turns_round_in_one_master_has_collapsed_there() -> None:
    result = gs.convert_masters(rings(100))
    first, second = result.contours
    points = second.curve.points.copy()
    points[1] *= [-1.0, 1.0]
    wrong = replace(second, curve=MasterContour(points, second.curve.degrees))
    found = changes_at(np.eye(2), [first, wrong])
    assert found[1].tolist() == [[0, 0], [0, 1]]
    assert not changes_at(np.eye(2), result.contours).any()
