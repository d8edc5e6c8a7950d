"""Curvature of a glyph along an axis: what is measured, against instances, and the pages of the atlas."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.ttLib import TTFont
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.plugins.masters.axis_pages import (
    axis_page,
    curves_of,
    energy_ratio,
    failures_page,
    turn_words,
    worst_inside,
)
from glyphspline.plugins.masters.convert_masters import MastersResult, convert_masters
from glyphspline.plugins.masters.kinks import along_axis, places_along
from glyphspline.plugins.masters.on_axes import by_rounding
from scripts.paper.measures import shape
from tests.places import FONTS
from tests.variable_fonts import quadratic, variable_font

POINTS = [(0, 0), (150, 0), (500, 300), (-300, 300), (-60, 0)]
BOLD = [(0, 0), (60, 30), (560, 340), (-330, 290), (-200, -100)]

runner = CliRunner()


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Glyph k has a joint at the origin that is smooth in both masters, and kinks between them."""
    glyph = quadratic(POINTS, [True, False, True, True, False])
    deltas = [(x - a, y - b) for (x, y), (a, b) in zip(BOLD, POINTS, strict=True)]
    path = tmp_path_factory.mktemp("fonts") / "v.ttf"
    return variable_font(path, {"k": glyph}, {"k": [({"wght": (0, 1, 1)}, deltas)]})


@pytest.fixture(scope="module")
def result(path: Path) -> MastersResult:
    return convert_masters(gs.open_font(path).masters("k"))


def test_energy_and_turn_are_those_of_instances(result: MastersResult) -> None:
    for masters in (result.masters, curves_of(result)):
        along = along_axis(masters, "wght")
        assert (along.axis.tag, along.values[0], along.values[-1]) == ("wght", 100, 900)
        for k in range(0, len(along.values), 9):
            cubics = masters.instance({"wght": float(along.values[k])}).contours[0].cubics()
            assert along.energies[k] == pytest.approx(1000 * shape(cubics).bending_energy, rel=1e-6)
    source, curve = along_axis(result.masters, "wght"), along_axis(curves_of(result), "wght")
    assert source.worst is not None
    assert source.turns.max() == source.worst.turn > 2
    assert max(turn for _, turn in source.worst.at_masters) < 1e-9
    inside = worst_inside(result, curve)
    assert inside is not None
    assert inside.turn < 1e-6
    values, ratio = energy_ratio(source, curve)
    k = int(np.argmin(np.abs(values - 650)))
    at = {"wght": float(values[k])}
    energies = [
        shape(o.contours[0].cubics()).bending_energy for o in (result.instance(at), result.masters.instance(at))
    ]
    assert ratio[k] == pytest.approx(energies[0] / energies[1], rel=1e-3)


def test_places_are_the_masters_the_worst_and_between(result: MastersResult) -> None:
    along = along_axis(result.masters, "wght")
    assert along.worst is not None
    found = places_along(along, 7)
    assert len(found) == 7
    assert found == sorted(found)
    assert {100, 400, 900, along.worst.location["wght"]} <= set(found)
    assert np.diff(found).max() <= 160
    few = places_along(along, 3)
    assert (len(few), few[0], few[-1]) == (3, 100, 900)


def test_the_page_says_the_worst(result: MastersResult) -> None:
    figure = axis_page(result, "wght", {}, 1 / 200, "Masters Regular")
    along = along_axis(result.masters, "wght")
    worst = along.worst
    assert worst is not None
    words = f"{worst.turn:.1f}° at wght {worst.location['wght']:.4g}, masters 0.0° and 0.0°"
    assert turn_words(worst) == words
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert any(title.startswith(f"source: {words}\nresult: below ") for title in titles)
    labels = [text.get_text() for text in figure.axes[0].texts]
    assert {"wght 400, master", "wght 900, master", f"wght {worst.location['wght']:.4g}, worst"} <= set(labels)
    assert {"source", "result"} <= set(labels)
    lines = {line.get_label(): line.get_xydata() for line in figure.axes[1].lines}
    assert lines["source"][:, 1].max() == worst.turn
    assert lines["result"][:, 1].max() < 1e-6


def test_the_atlas_along_an_axis_has_a_page_for_each_glyph(path: Path, tmp_path: Path) -> None:
    for name in ("a.pdf", "b.pdf"):
        run = runner.invoke(app, ["atlas", str(path), "--axis", "wght", "--all", "--out", str(tmp_path / name)])
        assert run.exit_code == 0, run.output
        assert "1 pages written" in run.output, "a glyph without contours has none"
    assert (tmp_path / "a.pdf").read_bytes() == (tmp_path / "b.pdf").read_bytes()
    assert {each.name for each in tmp_path.iterdir()} == {"a.pdf", "b.pdf"}


def test_glyphs_without_a_result_are_named_on_the_last_page() -> None:
    figure = failures_page([("broken", "no outline")] * 70, "Font")
    text = "\n".join(text.get_text() for text in figure.texts)
    assert text.count("broken: no outline") == 60
    assert "and 10 more" in text


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (["--axis", "wdth"], "no axis 'wdth': it has wght"),
        (["--axis", "wght", "--count", "12"], "give a tolerance"),
        (["--axis", "wght", "--profiles", "k"], "of an atlas without --axis"),
        (["--axis", "wght", "--comb", "source"], "which shows both combs"),
    ],
)
def test_what_cannot_be_drawn_along_an_axis(given: list[str], words: str, path: Path, tmp_path: Path) -> None:
    call: list[Any] = ["atlas", str(path), "--text", "k", *given, "--out", str(tmp_path / "a.pdf")]
    run = runner.invoke(app, call)
    assert run.exit_code == 2
    assert words in " ".join(run.output.split())
    assert not list(tmp_path.iterdir())


def test_an_axis_of_no_range_is_drawn_at_its_default(tmp_path: Path) -> None:
    font = TTFont(FONTS / "variable-cff2.otf")
    font["fvar"].axes[0].maxValue = 400
    font.save(tmp_path / "v.otf")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        call = [
            "atlas",
            str(tmp_path / "v.otf"),
            "--axis",
            "wght",
            "--all",
            "--jobs",
            "0",
            "-o",
            str(tmp_path / "a.pdf"),
        ]
        done = runner.invoke(app, call)
    assert done.exit_code == 0, done.output
    assert (tmp_path / "a.pdf").read_bytes().startswith(b"%PDF")


def test_rounding_turns_a_raised_quadratic_as_it_turns_the_quadratic() -> None:
    def turn(share: float, degree: int) -> float:
        controls = np.zeros((2, 4, 2))
        controls[:, 1] = np.rint(65536 * share * np.array([(10, 3), (-7, -2)])) / 65536
        return float(by_rounding(controls[None], controls[None], np.array([[degree, degree]]))[0])

    assert turn(2 / 3, 3) == pytest.approx(turn(2 / 3, 2), rel=1e-4)
    assert turn(2 / 3, 3) == pytest.approx(turn(1.0, 3), rel=1e-4)
    assert turn(2 / 3, 3) > 1
    assert turn(0.9, 3) == 0
