"""Letters on a path stand where Chromium's ``textPath`` puts them."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.typesetting.along_path import along, letters_of
from glyphspline.typesetting.path_file import open_path
from tests.places import FONTS

POSITIONS = """() => {
  const text = document.querySelector("text");
  return [...Array(text.getNumberOfChars()).keys()].map(i => {
    const at = text.getStartPositionOfChar(i);
    return [at.x, at.y, text.getRotationOfChar(i)];
  });
}"""


@pytest.mark.parametrize(
    ("data", "share", "degrees"),
    [
        ("M500 2000L2000 500L4000 1500L4500 4000", 1e-4, 0.01),
        ("M500 2000C2000 -1500 3000 4500 6000 2000", 1e-3, 0.2),  # Chromium takes the lengths of chords for a curve's
    ],
)
@pytest.mark.parametrize("offset", [0, 700])
def test_letters_stand_where_chromium_puts_them(
    page: Any, tmp_path: Path, data: str, share: float, degrees: float, offset: float
) -> None:
    file, written = FONTS / "kouzan-gyosho.ttf", "agO8龍"
    font = gs.open_font(file)
    em = font.metrics.units_per_em  # of as many pixels, so that advances are whole pixels
    encoded = base64.b64encode(file.read_bytes()).decode()
    svg = (
        f'<svg xmlns="http://www.w3.org/2000/svg"><defs><path id="p" d="{data}"/></defs>'
        f'<text font-family="F" font-size="{em}">'
        f'<textPath href="#p" startOffset="{offset}">{written}</textPath></text></svg>'
    )
    (tmp_path / "curve.svg").write_text(svg, encoding="utf-8")
    page.set_content(f"<style>@font-face{{font-family:F;src:url(data:font/ttf;base64,{encoded})}}</style>{svg}")
    page.evaluate("async () => { await document.fonts.load('20px F', 'agO8龍'); }")
    theirs = np.array(page.evaluate(POSITIONS))
    path = open_path(tmp_path / "curve.svg#p")
    layout = gs.layout(font, written)
    ours = along(layout, path, offset=offset)
    assert letters_of(layout).of.tolist() == list(range(len(written)))
    np.testing.assert_allclose(ours.origin * [1, -1], theirs[:, :2], atol=share * path.length)
    np.testing.assert_allclose(-np.degrees(ours.angle), theirs[:, 2], atol=degrees)
