"""The page on which points are clicked: on a glyph and on a picture, and the file that it saves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import glyphspline as gs
from glyphspline.plugins.experiments.polygons import read_clicked
from tests.places import GYOSHO

AT = [(0.2, 0.2), (0.6, 0.25), (0.7, 0.7), (0.3, 0.8)]
"""Places of the sheet, in shares of its width and height."""


@pytest.fixture
def clicking(page: Any, viewer: str) -> Any:
    page.goto(f"{viewer}static/clicking.html")
    page.wait_for_selector("body[data-ready]")
    return page


def click(page: Any, places: list[tuple[float, float]]) -> np.ndarray:
    """Click on the sheet; (n, 2) where that is, in font units, by the box that it shows."""
    box = page.locator("#sheet").bounding_box()
    for x, y in places:
        page.mouse.click(box["x"] + x * box["width"], box["y"] + y * box["height"])
    left, top, width, height = map(float, page.locator("#sheet").get_attribute("viewBox").split())
    scale = min(box["width"] / width, box["height"] / height)
    middle = np.array([left + width / 2, -(top + height / 2)])
    away = (np.array(places) - 0.5) * (box["width"], box["height"]) / scale
    return middle + away * (1, -1)


def saved(page: Any, folder: Path) -> Path:
    with page.expect_download() as download:
        page.locator("#save").click()
    download.value.save_as(folder / "points.csv")
    return folder / "points.csv"


def test_points_of_a_glyph_become_the_polygons_of_an_experiment(clicking: Any, tmp_path: Path) -> None:
    first = click(clicking, AT)
    clicking.keyboard.press("Enter")
    second = click(clicking, [(0.45, 0.4), (0.5, 0.5), (0.4, 0.5), (0.1, 0.1)])[:3]
    clicking.keyboard.press("Backspace")
    assert "龍: 4 + 3 points" in clicking.locator("#words").inner_text()
    found = read_clicked(saved(clicking, tmp_path))["龍"]
    for points, own in zip(found, (first, second), strict=True):
        np.testing.assert_allclose(points, own, atol=1.5)
    outline = gs.open_font(GYOSHO).outline("uni9F8D")
    made = gs.experiment(outline, (2,), polygons=found, peers=False)
    assert [row["vertices"] for row in made.rows] == [4, 3]


@pytest.mark.parametrize("width", range(500, 1000, 100))
def test_the_sheet_stays_where_it_is_while_the_words_grow(clicking: Any, width: int) -> None:
    clicking.set_viewport_size({"width": width, "height": 800})
    before = clicking.locator("#sheet").bounding_box()
    for _ in range(12):
        click(clicking, AT[:3])
        clicking.keyboard.press("Enter")
    assert clicking.locator("#words").inner_text().endswith("3 + 3 points")
    assert clicking.locator("#sheet").bounding_box() == before


def test_a_picture_is_clicked_on(clicking: Any, tmp_path: Path) -> None:
    picture = tmp_path / "scan.png"
    Image.new("L", (300, 200), 200).save(picture)
    clicking.set_input_files("#picture", picture)
    clicking.wait_for_selector("#behind[href^='data:image/png']", state="attached")
    assert not clicking.locator("#outline").get_attribute("d")
    places = click(clicking, AT)
    (found,) = read_clicked(saved(clicking, tmp_path))["龍"]
    np.testing.assert_allclose(found, places, atol=1.5)
    assert float(clicking.locator("#behind").get_attribute("width")) == pytest.approx(1.5 * 1024)
