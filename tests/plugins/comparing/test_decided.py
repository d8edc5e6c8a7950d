"""What is within a tolerance, beyond it, or undecided: against dense sampling, and what ``convert`` certifies."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fontTools import subset
from fontTools.ttLib import TTFont
from tests.comparing.test_compare import moved, of, sampled
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.cli.tables import difference_lines, differences_table
from glyphspline.plugins.comparing.job import FontDifference, Pair, Pairs, compare_fonts
from glyphspline.runs.folder import entries_of
from glyphspline.types import Head
from tests.places import DEJAVU, FONTS

GARAMOND = Path("/usr/share/fonts/opentype/ebgaramond/EBGaramond12-Regular.otf")
CLOSE = ["Lambda", "uni041B.alt", "uni026C", "Sigma.sc", "T_h", "uni1EB4", "W.sups", "mu", "ampersand.ordn", "A", "g"]
"""Glyphs of it whose results are certified just within the tolerance, or lose a speck."""

runner = CliRunner()


@pytest.fixture(scope="module")
def letter() -> gs.Outline:
    return gs.open_font(FONTS / "kouzan-gyosho.otf").outline("g")


def one_point_moved(outline: gs.Outline, seed: int) -> gs.Outline:
    rng = np.random.default_rng(seed)
    contours = list(outline.contours)
    c = int(rng.integers(len(contours)))
    points = contours[c].points.copy()
    points[rng.integers(len(points))] += rng.normal(size=2) * 10.0 ** rng.uniform(-1, 1.5)
    contours[c] = gs.Contour(points, contours[c].degrees)
    return replace(outline, contours=contours)


@pytest.mark.parametrize("seed", range(10))
def test_every_tolerance_divides_the_seen_from_the_certified(letter: gs.Outline, seed: int) -> None:
    changed = one_point_moved(letter, seed)
    true = sampled(letter, changed)
    slack = 0.02 + 1e-4 * true  # what sampling may miss or add
    for tolerance in true * np.array([0.5, 0.99, 0.999, 1.0, 1.001, 1.003, 1.01, 2.0]):
        found = gs.compare(letter, changed, float(tolerance))
        assert found.seen <= true + slack
        assert found.bound >= true - slack
        assert not found.is_undecided(tolerance)
        assert found.is_beyond(tolerance) == (found.seen > tolerance * (1 + 1e-6))
        if abs(tolerance - true) > slack:
            assert found.is_beyond(tolerance) == (true > tolerance)
        if not found.is_beyond(tolerance):
            assert found.bound <= tolerance * (1 + 1e-6)


@pytest.mark.parametrize("vector", [(1.0, 0.0), (0.0, -0.3), (0.6, 0.8), (7.0, 24.0), (0.01, 0.0)])
@pytest.mark.parametrize("em", [1000.0, 16384.0])
def test_what_moved_by_the_tolerance_is_within_it(letter: gs.Outline, vector: tuple[float, float], em: float) -> None:
    tolerance = float(np.hypot(*vector))
    for one in (letter, of([(0.0, 0.0), (em, 0.0), (em, em), (0.0, em)])):
        found = gs.compare(one, moved(one, *vector), tolerance)
        assert not found.is_beyond(tolerance)
        assert not found.is_undecided(tolerance)
        assert gs.compare(one, moved(one, *vector), 0.99 * tolerance).is_beyond(0.99 * tolerance)


def test_an_advance_that_changed_by_the_tolerance_is_within_it(letter: gs.Outline) -> None:
    third = replace(letter, advance=letter.advance + 1 / 3, contours=moved(letter, 0.1, 0).contours)
    assert not gs.compare(letter, third, 1 / 3).is_beyond(1 / 3)
    assert gs.compare(letter, third, 0.33).is_beyond(0.33)


def test_outlines_that_are_not_known_closely_enough_are_undecided(letter: gs.Outline) -> None:
    other = replace(moved(letter, 1.0, 0.0), snapped=0.1)
    for tolerance, beyond, undecided in (
        (0.8, True, False),
        (0.95, False, True),
        (1.05, False, True),
        (1.2, False, False),
    ):
        found = gs.compare(letter, other, tolerance)
        assert (found.is_beyond(tolerance), found.is_undecided(tolerance)) == (beyond, undecided)


def test_undecided_glyphs_are_named_and_have_no_status(letter: gs.Outline) -> None:
    other = replace(moved(letter, 1.0, 0.0), snapped=0.1)
    pairs = Pairs((Pair(Head("g", 0), Head("g", 0)),), (), ())
    found = FontDifference(1.05, 1.0, pairs, differences=[gs.compare(letter, other, 1.05)])
    assert not found.is_beyond
    assert found.facts()["undecided"] == 1
    said = list(difference_lines(found, 5))
    assert said[0].endswith("0 within the tolerance of 1.05, 0 beyond, 1 undecided")
    assert said[1].startswith("undecided: 1 glyph: g (0.9 to 1.1")
    assert differences_table(found.worst_first(), 5, 1.05).splitlines()[2].startswith(" ? | g")


def test_a_contour_no_wider_than_two_tolerances_neither_comes_nor_goes(letter: gs.Outline) -> None:
    x, y = letter.contours[0].points[0]
    speck = of([(x, y), (x + 1.9, y), (x, y + 1.9)]).contours[0]
    both = replace(letter, contours=[*letter.contours, speck])
    assert gs.compare(letter, both, 2.0).contours_new == ()
    assert gs.compare(both, letter, 2.0).contours_gone == ()
    assert gs.compare(letter, both, 0.5).contours_new == (len(letter.contours),)


def some_of(font: Path, glyphs: list[str], out: Path) -> Path:
    """A font of some glyphs of a font: the others would be written too."""
    options = subset.Options(glyph_names=True, layout_features=[], drop_tables=["FFTM"], notdef_outline=True)
    small = subset.Subsetter(options)
    small.populate(glyphs=glyphs)
    with TTFont(font) as whole:
        small.subset(whole)
        whole.save(out)
    return out


def converted(font: Path, kind: str, tolerance: float | None, out: Path) -> None:
    """Convert a font into another kind, and compare: nothing that is certified within the tolerance is beyond it."""
    asked = [] if tolerance is None else ["--tolerance", str(tolerance)]
    call = ["refit", str(font), "--format", kind, *asked, "--out", str(out), "--jobs", "0"]
    status = runner.invoke(app, call).exit_code
    missed = {
        entry["glyph"]
        for entry in entries_of(out)
        if any(contour["within_tolerance"] is False for contour in entry["contours"] or [])
    }
    assert status == (1 if missed else 0)
    (written,) = out.glob(f"*.{kind}")
    found = compare_fonts(gs.open_source(font), gs.open_source(written), tolerance=tolerance, jobs=0)
    assert len(found.differences) > 7
    assert {each.glyph for each in found.beyond} <= missed
    assert found.undecided == []


@pytest.mark.parametrize("tolerance", [None, 0.5, 2.0])
@pytest.mark.parametrize(("name", "kind"), [("kouzan-gyosho.otf", "ttf"), ("kouzan-gyosho.ttf", "otf")])
def test_a_font_written_within_a_tolerance_is_not_beyond_it(
    name: str, kind: str, tolerance: float | None, tmp_path: Path
) -> None:
    converted(FONTS / name, kind, tolerance, tmp_path / "out")


@pytest.mark.parametrize("tolerance", [0.5, 2.0])
def test_quadratics_written_as_cubics_are_not_beyond_their_tolerance(tolerance: float, tmp_path: Path) -> None:
    font = some_of(DEJAVU, list("aegsBQRS"), tmp_path / "some.ttf")
    converted(font, "otf", tolerance, tmp_path / "out")


@pytest.mark.skipif(not GARAMOND.exists(), reason="EB Garamond 12 is not installed")
def test_results_that_are_certified_just_within_the_tolerance(tmp_path: Path) -> None:
    converted(some_of(GARAMOND, CLOSE, tmp_path / "some.otf"), "ttf", 1.0, tmp_path / "out")
