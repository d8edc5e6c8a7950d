"""Two outlines compared, and two fonts: certified distances against dense sampling, pairs, and the command."""

from __future__ import annotations

import json
from dataclasses import replace
from math import hypot, inf
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.curves.bezier import evaluate, split
from glyphspline.plugins.comparing.job import compare_fonts, pairs_of
from glyphspline.plugins.drawings.svg import SvgDrawings
from glyphspline.runs.folder import entries_of
from tests.drawings import result
from tests.places import FONTS
from tests.polygons import square_contour
from tests.readers.test_broken_fonts import with_components

GYOSHO, KAISHO = FONTS / "kouzan-gyosho.ttf", FONTS / "kouzan-kaisho.ttf"
runner = CliRunner()


@pytest.fixture(scope="module")
def dragon() -> gs.Outline:
    return gs.open_font(FONTS / "kouzan-gyosho.otf").outline("uni9F8D")


@pytest.fixture(scope="module")
def letter() -> gs.Outline:
    return gs.open_font(FONTS / "kouzan-gyosho.otf").outline("g")


def of(*polygons: list[tuple[float, float]], name: str = "A", advance: float = 600.0) -> gs.Outline:
    """An outline of straight lines."""
    contours = [gs.Contour(np.array(points, dtype=float), np.ones(len(points), dtype=np.int64)) for points in polygons]
    return gs.Outline(name, advance=advance, contours=contours)


def moved(outline: gs.Outline, x: float, y: float) -> gs.Outline:
    return replace(outline, contours=[gs.Contour(c.points + np.array([x, y]), c.degrees) for c in outline.contours])


def farthest(one: gs.Outline, other: gs.Outline, steps: int = 24) -> float:
    """The largest distance of points of one outline from the chords of the other: by sampling alone."""
    dense = []
    for outline in (one, other):
        cubics = np.concatenate([contour.cubics() for contour in outline.contours])
        t = np.arange(steps + 1) / steps
        dense.append(evaluate(np.repeat(cubics, steps + 1, axis=0), np.tile(t, len(cubics))).reshape(-1, steps + 1, 2))
    points, chords = dense[0].reshape(-1, 2), dense[1]
    a, u = chords[:, :-1].reshape(-1, 2), np.diff(chords, axis=1).reshape(-1, 2)
    squares = np.maximum((u * u).sum(axis=1), 1e-12)
    most = 0.0
    for some in np.array_split(points, max(len(points) // 200, 1)):
        away = some[:, None] - a
        share = np.clip((away * u).sum(axis=2) / squares, 0, 1)
        most = max(most, float(np.hypot(*np.moveaxis(away - share[:, :, None] * u, 2, 0)).min(axis=1).max()))
    return most


def sampled(one: gs.Outline, other: gs.Outline) -> float:
    return max(farthest(one, other), farthest(other, one))


def agrees(found: gs.Difference, true: float, slack: float = 0.0) -> bool:
    """Whether a bound is one, and within 1 % or 0.01 units; ``slack``: what sampling may miss or add."""
    return true - slack <= found.bound <= true + max(0.01 * true, 0.01) + slack


@pytest.mark.parametrize("vector", [(3.0, 4.0), (0.0, -0.2), (-60.0, 25.0)])
def test_an_outline_moved_is_as_far_as_it_was_moved(dragon: gs.Outline, vector: tuple[float, float]) -> None:
    found = gs.compare(dragon, moved(dragon, *vector))
    assert agrees(found, hypot(*vector), 1e-9)
    assert found.worst is not None
    assert found.seen <= found.bound
    assert hypot(*np.subtract(found.worst.point, found.worst.nearest)) == pytest.approx(found.seen)
    assert (found.contours_gone, found.contours_new) == ((), ())
    if hypot(*vector) < 0.01 * dragon.metrics.units_per_em:
        assert (found.kinks_gone, found.kinks_new) == ((), ())


@pytest.mark.parametrize("seed", range(12))
def test_one_point_moved(letter: gs.Outline, seed: int) -> None:
    rng = np.random.default_rng(seed)
    contours = list(letter.contours)
    c = int(rng.integers(len(contours)))
    points = contours[c].points.copy()
    points[rng.integers(len(points))] += rng.normal(size=2) * 10.0 ** rng.uniform(-1, 2)
    contours[c] = gs.Contour(points, contours[c].degrees)
    changed = replace(letter, contours=contours)
    assert agrees(gs.compare(letter, changed), sampled(letter, changed), 0.02)


@pytest.mark.parametrize("character", "永a")
def test_different_drawings_of_one_character(character: str) -> None:
    one, other = (font.outline(font.select(text=character)[0]) for font in map(gs.open_font, (GYOSHO, KAISHO)))
    found, back = gs.compare(one, other), gs.compare(other, one)
    true = sampled(one, other)
    assert agrees(found, true, 0.3)
    assert agrees(back, true, 0.3)


def test_known_distances() -> None:
    outer = [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)]
    inner = [(10.0, 10.0), (90.0, 10.0), (90.0, 90.0), (10.0, 90.0)]
    assert agrees(gs.compare(of(outer), of(inner)), hypot(10, 10))
    # the middle of the mouth's back is as far from both lips, and nearest to neither end of its segment
    lips = [(100.0, 40.0), (50.0, 40.0), (50.0, 60.0), (100.0, 60.0)]
    mouth = [*outer[:2], *lips, *outer[2:]]
    assert agrees(gs.compare(of(outer), of(mouth)), 50.0)
    bar = [(0.0, 0.0), (300.0, 0.0), (300.0, 1.0), (0.0, 1.0)]
    assert agrees(gs.compare(of(bar), of([(0.0, 0.0), (300.0, 0.0), (300.0, 40.0), (0.0, 40.0)])), 39.0)


def test_start_direction_and_order_do_not_matter(dragon: gs.Outline) -> None:
    turned = []
    for k, contour in enumerate(reversed(dragon.contours)):
        segments = list(contour.segments())
        turned.append(gs.Contour.from_segments(segments[k + 1 :] + segments[: k + 1]).reversed())
    found = gs.compare(dragon, replace(dragon, contours=turned))
    assert not found.identical
    assert found.bound < 1e-6
    assert (found.contours_gone, found.contours_new, found.kinks_gone, found.kinks_new) == ((), (), (), ())
    assert not found.is_beyond(0.001)


def test_where_segments_are_cut_does_not_matter(dragon: gs.Outline) -> None:
    cut = []
    for contour in dragon.contours:
        cubics = np.stack(split(contour.cubics(), 0.3), axis=1).reshape(-1, 4, 2)
        cut.append(gs.Contour(cubics[:, :3].reshape(-1, 2), np.full(len(cubics), 3)))
    found = gs.compare(dragon, replace(dragon, contours=cut))
    assert found.bound < 0.01 * dragon.metrics.units_per_em / 1000
    assert (found.contours_gone, found.contours_new) == ((), ())


def test_equal_arrays_are_identical(dragon: gs.Outline) -> None:
    found = gs.compare(dragon, moved(dragon, 0.0, 0.0))
    assert found.identical
    assert found.is_none
    assert (found.bound, found.seen, found.worst) == (0.0, 0.0, None)


def test_a_contour_that_went(letter: gs.Outline) -> None:
    k = len(letter.contours) - 1
    less = replace(letter, contours=[contour for j, contour in enumerate(letter.contours) if j != k])
    found = gs.compare(letter, less)
    assert (found.contours_gone, found.contours_new) == ((k,), ())
    assert found.is_beyond(1e6)
    assert agrees(found, sampled(letter, less), 0.02)
    back = gs.compare(less, letter)
    assert (back.contours_gone, back.contours_new) == ((), (k,))


def test_an_advance_that_changed(dragon: gs.Outline) -> None:
    found = gs.compare(dragon, replace(dragon, advance=dragon.advance + 2))
    assert found.identical
    assert not found.is_none
    assert found.is_beyond(1.0)
    assert not found.is_beyond(2.0)


def test_another_em_is_scaled(dragon: gs.Outline) -> None:
    double = replace(
        dragon, advance=2 * dragon.advance, metrics=gs.FontMetrics(2 * dragon.metrics.units_per_em),
        contours=[gs.Contour(2 * c.points + [6, 8], c.degrees) for c in dragon.contours],
    )  # fmt: skip
    found = gs.compare(dragon, double)
    assert found.scale == 0.5
    assert found.new_advance == dragon.advance
    assert agrees(found, 5.0, 1e-9)


def test_an_outline_that_is_empty(dragon: gs.Outline) -> None:
    empty = replace(dragon, contours=())
    found = gs.compare(dragon, empty)
    assert found.bound == inf
    assert found.worst is None
    assert found.contours_gone == tuple(range(len(dragon.contours)))
    assert found.facts()["bound"] is None
    assert gs.compare(empty, empty).is_none


def test_kinks_that_came_and_went() -> None:
    def arch(lean: float) -> gs.Outline:
        points = [[0, 0], [0, 110], [90 - 50, 200 - lean], [90, 200], [140, 200], [180, 110], [180, 0]]
        return gs.Outline("n", contours=[gs.Contour(np.array(points, dtype=float), np.array([3, 3, 1]))])

    smooth, kinked = arch(0), arch(3)
    found = gs.compare(smooth, kinked)
    assert found.kinks_gone == ()
    (kink,) = found.kinks_new
    assert (kink.contour, kink.segment, kink.point) == (0, 1, (90.0, 200.0))
    assert kink.degrees == pytest.approx(np.degrees(np.arctan2(3, 50)))
    assert gs.compare(kinked, smooth).kinks_gone == (kink,)
    assert gs.compare(kinked, moved(kinked, 0.5, 0)).kinks_new == ()


@pytest.mark.parametrize("far", [1e14, 9e149, np.inf, np.nan])
def test_coordinates_too_large_to_be_compared_are_refused(dragon: gs.Outline, far: float) -> None:
    contour = dragon.contours[0]
    points = contour.points.copy()
    points[0, 0] = far
    broken = replace(dragon, contours=[replace(contour, points=points)])
    for pair in ((dragon, broken), (broken, dragon)):
        with pytest.raises(gs.GlyphsplineError, match=r"coordinates up to .* are too large to be compared"):
            gs.compare(*pair)


def test_the_tolerance_is_positive(dragon: gs.Outline) -> None:
    with pytest.raises(gs.OptionError):
        gs.compare(dragon, dragon, tolerance=0)


def test_two_fonts_and_any_number_of_workers() -> None:
    old, new = gs.open_source(GYOSHO), gs.open_source(KAISHO)
    found = compare_fonts(old, new, jobs=0)
    assert len(found.differences) + found.identical == len(found.glyphs.pairs)
    assert found.is_beyond
    assert compare_fonts(old, new, jobs=2).facts() == found.facts()
    gids = [each.gid for each in found.differences]
    assert gids == sorted(gids)


def test_a_broken_glyph_costs_only_itself(tmp_path: Path) -> None:
    font = with_components(tmp_path, {"tiny": ["tiny"]})
    found = compare_fonts(gs.open_source(FONTS / "edge-cases.ttf"), font, jobs=0)
    assert [each.glyph for each in found.unread] == ["tiny"]
    assert found.unread[0].error.startswith("new: ")
    assert found.identical == len(font.glyph_names) - 1
    assert found.is_beyond


def drawings(folder: Path, glyphs: dict[str, int]) -> SvgDrawings:
    """A folder of drawings: squares, by name with their code points."""
    folder.mkdir()
    for gid, (name, code) in enumerate(glyphs.items()):
        drawn = result(square_contour(10.0 * (code - 60)), name=name, gid=gid, unicodes=(code,))
        (folder / f"{name}.svg").write_text(gs.to_svg(drawn), encoding="utf-8")
    return SvgDrawings.opened(folder)


def test_glyphs_are_paired_by_name_then_by_code_point(tmp_path: Path) -> None:
    old = drawings(tmp_path / "old", {"A": 65, "B": 66, "C": 67, "D": 68})
    new = drawings(tmp_path / "new", {"alpha": 65, "B": 67, "C": 66, "E": 69})
    pairs = pairs_of(old, new)
    assert set(pairs.renamed) == {("A", "alpha"), ("B", "C"), ("C", "B")}
    assert (pairs.only_old, pairs.only_new) == (("D",), ("E",))
    found = compare_fonts(old, new, pairs, jobs=0)
    assert (found.identical, found.differences) == (3, [])
    assert found.is_beyond
    assert not compare_fonts(old, new, pairs_of(old, new, ["A"], []), jobs=0).is_beyond


def test_a_font_and_the_drawings_written_of_it(tmp_path: Path) -> None:
    out = tmp_path / "out"
    arguments = [
        "--text",
        "龍好O",
        "--corners",
        "sharp",
        "--format",
        "svg",
        "--tolerance",
        "2",
        "--out",
        str(out),
        "--jobs",
        "0",
    ]
    assert runner.invoke(app, ["convert", str(GYOSHO), *arguments]).exit_code == 0
    bounds = {
        entry["glyph"]: tuple(max(c[name] for c in entry["contours"]) for name in ("deviation", "deviation_bound"))
        for entry in entries_of(out)
    }
    said = runner.invoke(
        app, ["diff", str(GYOSHO), str(out / "svg"), "--text", "龍好O", "--tolerance", "2", "--json", "--jobs", "0"]
    )
    assert said.exit_code == 0, said.output
    glyphs = {each["glyph"]: each for each in json.loads(said.stdout)["glyphs"]}
    assert glyphs.keys() == bounds.keys()
    for name, (deviation, bound) in bounds.items():
        # The manifest's bound pairs every point in order, ours takes the nearest ones: it is never the larger one.
        assert glyphs[name]["seen"] <= bound
        assert 0.8 * deviation <= glyphs[name]["bound"] <= bound + max(0.01 * bound, 0.01)
        assert not glyphs[name]["contours_gone"] + glyphs[name]["contours_new"]
    assert runner.invoke(
        app, ["diff", str(GYOSHO), str(out / "svg"), "--text", "龍好O", "--tolerance", "0.1", "--jobs", "0"]
    ).exit_code == 1  # fmt: skip


def test_the_table_the_page_and_the_exit_status(tmp_path: Path) -> None:
    page = tmp_path / "diff.html"
    call = ["diff", str(GYOSHO), str(KAISHO), "--jobs", "0", "--rows", "2", "--html", str(page)]
    said = runner.invoke(app, call)
    assert said.exit_code == 1, said.output
    assert len(said.stdout.splitlines()) == 4
    assert "distance" in said.stdout
    text = page.read_text(encoding="utf-8")
    assert text.endswith("</html>\n")
    assert text.count("<article") == len(
        compare_fonts(gs.open_source(GYOSHO), gs.open_source(KAISHO), jobs=0).differences
    )
    assert "http" not in text.replace("http-equiv", "")
    same = runner.invoke(app, ["diff", str(GYOSHO), str(GYOSHO), "--jobs", "0"])
    assert (same.exit_code, same.stdout) == (0, "")
    assert "identical" in same.stderr


@pytest.mark.parametrize(
    "arguments",
    [["--tolerance", "0"], ["--text", "\U0001f600"], ["--face-index", "3"], ["--location", "wght=700"]],
)
def test_calls_that_cannot_be(arguments: list[str]) -> None:
    said = runner.invoke(app, ["diff", str(GYOSHO), str(KAISHO), "--jobs", "0", *arguments])
    assert said.exit_code == 2, said.output
    assert said.stderr.startswith("glyphspline: ")


def test_a_location_is_for_what_has_axes(tmp_path: Path) -> None:
    variable = str(FONTS / "variable.ttf")
    plain = runner.invoke(app, ["diff", variable, variable, "--location", "wght=700", "--jobs", "0", "--json"])
    assert plain.exit_code == 0, plain.output
    assert json.loads(plain.stdout)["old"]["location"] == {"wght": 700}


def test_the_json_has_its_names() -> None:
    said = runner.invoke(app, ["diff", str(GYOSHO), str(KAISHO), "--text", "善", "--jobs", "0", "--json"])
    data = json.loads(said.stdout)
    assert list(data) == [
        "format", "old", "new", "tolerance", "scale", "beyond_tolerance", "compared", "identical", "beyond",
        "undecided", "only_old", "only_new", "renamed", "glyphs", "failed",
    ]  # fmt: skip
    (glyph,) = data["glyphs"]
    assert list(glyph) == [
        "beyond_tolerance", "undecided", "glyph", "gid", "new_glyph", "new_gid", "unicodes", "identical", "bound",
        "seen", "worst", "advance", "new_advance", "scale", "contours_gone", "contours_new", "kinks_gone", "kinks_new",
        "ink", "ink_known",
    ]  # fmt: skip
    assert list(glyph["worst"]) == ["outline", "contour", "point", "nearest"]
    assert glyph["unicodes"] == ["U+5584"]
