"""The page of what was mended: before and after at a place of an axis, and a table of what moved."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from glyphspline.cli.app import app

from ..variable_fonts import quadratic, variable_font

POINTS = [(0, 0), (161, 430), (300, 500), (439, 570), (600, 900), (700, -20)]
DELTAS = [(0, 0), (32, -37), (0, 0), (-89, -20), (0, 0), (0, 0)]
ON = [True, False, True, False, True, True]
"""A joint that kinks between the masters."""


@pytest.fixture(scope="module")
def mended(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A variable font with two glyphs that kink, mended; one of them needs more than the tolerance."""
    out = tmp_path_factory.mktemp("mended")
    far = [(5 * x, 5 * y) for x, y in POINTS]
    glyphs = {"a": quadratic(POINTS, ON), "<b>": quadratic(far, ON)}
    deltas = [(5 * x, 5 * y) for x, y in DELTAS]
    font = variable_font(
        out / "a.ttf", glyphs, {"a": [({"wght": (0, 1, 1)}, DELTAS)], "<b>": [({"wght": (0, 1, 1)}, deltas)]}
    )
    run = CliRunner().invoke(
        app,
        [
            "mend",
            str(font),
            "--out",
            str(out / "new"),
            "--html",
            str(out / "page.html"),
            "--tolerance",
            "4",
            "-j",
            "1",
        ],
    )
    assert run.exit_code == 1, run.output
    return out / "page.html"


def opened(page: Any, path: Path) -> Any:
    page.goto(path.as_uri())
    page.wait_for_selector("body[data-ready]")
    page.wait_for_function("() => document.querySelectorAll('.card .result').length > 0")
    return page


def test_before_and_after_are_drawn_where_it_was_worst(page: Any, mended: Path) -> None:
    opened(page, mended)
    assert page.locator("#count").inner_text() == "1 of 2 findings mended"
    card = page.locator(".card")
    assert card.count() == 1
    assert "a kink 3.46°" in card.inner_text()
    assert "wght 7" in card.locator(".comb-scale").inner_text()
    paths = [card.locator(f".{side}").first.get_attribute("d") for side in ("source", "result")]
    assert paths[0] != paths[1]
    assert card.locator(".source-comb path").count() > 1
    assert card.locator(".comb path").count() > 1
    colours = "(paths) => [...new Set(paths.map((path) => getComputedStyle(path).stroke))]"
    assert len(card.locator(".source-comb path:not(.tips, .cut)").evaluate_all(colours)) == 1, (
        "not those of the result's"
    )
    assert card.locator(".moves").get_attribute("d").count("M") >= 1
    assert page.locator("#rows tr").count() == 2
    assert "is beyond the tolerance: it takes" in page.locator("#rows tr").nth(1).inner_text()


def test_the_slider_moves_all_along_the_axis(page: Any, mended: Path) -> None:
    opened(page, mended)
    source = page.locator(".card .source").first
    worst = source.get_attribute("d")
    page.locator("#place").fill("0")
    assert not page.locator("#worst").is_checked()
    assert page.locator("#value").inner_text() == "wght 100"
    default = source.get_attribute("d")
    assert default != worst
    assert "M0 0Q161 -430 300 -500" in default.replace("-0 ", "0 ").replace("M0 -0", "M0 0")
    page.locator("#place").fill("99")
    assert source.get_attribute("d") not in (worst, default)
    page.locator("#worst").check()
    assert source.get_attribute("d") == worst


def test_layers_kinds_and_names_are_chosen(page: Any, mended: Path) -> None:
    opened(page, mended)
    card = page.locator(".card")
    page.locator("label:has([data-layer='source'])").click()
    assert not card.locator(".source").first.is_visible()
    page.locator("label:has([data-layer='comb'])").click()
    assert not card.locator(".comb").first.is_visible()
    before = card.locator("svg").get_attribute("viewBox")
    card.get_by_role("button", name="Zoom in").click()
    near = card.locator("svg").get_attribute("viewBox")
    assert float(near.split()[2]) == pytest.approx(float(before.split()[2]) / 1.6, abs=0.02)
    card.locator("> button").click()
    assert float(card.locator("svg").get_attribute("viewBox").split()[2]) > float(before.split()[2]), "the whole glyph"
    page.fill("#words", "b")
    page.wait_for_function("() => document.querySelectorAll('#rows tr').length === 1")
    assert page.locator("#rows td").first.inner_text() == "<b>"
    page.fill("#words", "")
    page.locator("label:has([data-kind])").click()
    page.wait_for_function("() => document.querySelectorAll('#rows tr').length === 0")
    assert page.locator("#none").is_visible()
