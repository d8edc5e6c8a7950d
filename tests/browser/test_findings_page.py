from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from glyphspline.cli.app import app
from tests.places import FONTS

from ..faulty_drawings import drawings, turning


@pytest.fixture(scope="module")
def findings(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Findings of two fonts: a folder of drawings with faults, and a brush face."""
    out = tmp_path_factory.mktemp("findings")
    font = drawings(out / "font", {"two": turning(2), "five": turning(5), "jump": turning(0), "<b>&": turning(3)})
    arguments = ["check", str(font), str(FONTS / "kouzan-gyosho.otf"), "--html", str(out / "page.html"), "-j", "0"]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    return out / "page.html"


def opened(page: Any, path: Path) -> Any:
    page.goto(path.as_uri())
    page.wait_for_selector("body[data-ready]")
    return page


def choose_drawings(page: Any) -> None:
    """Only the findings of the drawings: fonts come in the order of their paths, which differs between machines."""
    (label,) = [label for label in page.locator("#font option").all_inner_texts() if Path(label).name == "font"]
    page.select_option("#font", label=label)


def names(page: Any) -> list[str]:
    return [str(name) for name in page.locator("#cards b").all_inner_texts()]


def test_the_worst_come_first_and_each_place_is_drawn(page: Any, findings: Path) -> None:
    opened(page, findings)
    choose_drawings(page)
    assert names(page) == ["five", "<b>&", "two", "jump"]
    assert page.locator("#count").inner_text().startswith("4 of ")
    card = page.locator(".card").first
    assert "turns by 5° at a joint meant to be smooth" in card.inner_text()
    page.wait_for_function("() => document.querySelectorAll('.card .source').length === 4")
    assert card.locator(".mark").get_attribute("d") == "M500 500L500 500"
    left, top, width, height = map(float, card.locator("svg").get_attribute("viewBox").split())
    assert left + width / 2 == top + height / 2 == 500
    assert width == height < 200
    assert card.locator(".source-comb path").count() > 2
    assert card.locator(".tangents").get_attribute("d").count("M") == 2
    assert page.locator(".card").nth(3).locator(".tangents").get_attribute("d") == ""
    for part in ("mark", "vertices", "source"):  # inside what is seen, and not only in the document
        assert card.locator(f".{part}").bounding_box()["width"] > 0


def test_a_click_shows_the_whole_glyph_and_another_the_place(page: Any, findings: Path) -> None:
    opened(page, findings)
    choose_drawings(page)
    picture = page.locator(".card svg").first
    page.wait_for_function("() => document.querySelector('.card svg').hasAttribute('viewBox')")
    near = picture.get_attribute("viewBox")
    picture.click()
    left, top, width, height = map(float, picture.get_attribute("viewBox").split())
    assert left <= 200
    assert left + width >= 900
    assert top <= 500
    assert top + height >= 800
    picture.click()
    assert picture.get_attribute("viewBox") == near


def test_kinds_fonts_and_names_are_chosen(page: Any, findings: Path) -> None:
    opened(page, findings)
    every = int(page.locator("#count").inner_text().split()[0])
    kinks = int(page.locator("label:has([data-kind='0']) span").inner_text())
    page.locator("label:has([data-kind='0'])").click()
    assert page.locator("#count").inner_text() == f"{every - kinks} of {every} findings"
    assert page.locator("#cards .kind.WARN").count() == 0
    page.locator("label:has([data-kind='0'])").click()
    page.fill("#words", "FIVE")
    page.wait_for_function("() => document.querySelectorAll('#cards b').length < 10")
    assert "five" in names(page)
    assert page.locator("#rows tr").count() == len(names(page))
    page.fill("#words", "no such glyph")
    page.wait_for_selector("#none:not([hidden])")
    assert names(page) == []


def test_long_lists_are_shown_piece_by_piece(page: Any, findings: Path) -> None:
    opened(page, findings)
    every = int(page.locator("#count").inner_text().split()[0])
    shown = page.locator("#rows tr").count()
    assert shown == min(every, 300)
    cards = page.locator(".card").count()
    assert cards == min(every, 120) < every
    page.locator("#more-cards").click()
    page.wait_for_function("n => document.querySelectorAll('.card').length === n", arg=min(every, 240))


def test_light_and_dark(page: Any, findings: Path) -> None:
    opened(page, findings)
    colour = "() => getComputedStyle(document.body).backgroundColor"
    light = page.evaluate(colour)
    page.locator("#theme").click()
    assert page.evaluate(colour) != light
