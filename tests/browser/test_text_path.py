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
    const end = text.getEndPositionOfChar(i);
    return [at.x, at.y, text.getRotationOfChar(i), end.x, end.y];
  });
}"""


CASES = (
    ("dejavu/DejaVuSerif.ttf", "Ñandú fiévre AV Çelik ÅÖ x"),
    ("dejavu/DejaVuSans.ttf", "q\u0301\u0323 x\u0302 e\u0301 combined"),
    ("../opentype/fonts-hosny-amiri/Amiri-Regular.ttf", "بِسْمِ ٱللَّٰهِ ٱلرَّحْمَٰنِ"),
    ("noto/NotoSansHebrew-Regular.ttf", "שָׁלוֹם עֲלֵיכֶם"),
    ("noto/NotoSansDevanagari-Regular.ttf", "क्षत्रिय हिन्दी श्रृंगार"),
    ("../opentype/noto/NotoSerifCJK-Regular.ttc", "横書きのテスト"),
)
"""Texts in fonts below /usr/share/fonts/truetype."""


def set_by_chromium(page: Any, folder: Path, file: Path, written: str, data: str, offset: float = 0) -> Any:
    """(n, 5) of each character x, y and angle where it begins, and x and y where it ends; the path is in a drawing.

    A pixel is a font unit, so that no advance is rounded.
    """
    em = gs.open_font(file).metrics.units_per_em
    encoded = base64.b64encode(file.read_bytes()).decode()
    svg = (
        f'<svg xmlns="http://www.w3.org/2000/svg"><defs>{data}</defs><text font-family="F" font-size="{em}">'
        f'<textPath href="#p" startOffset="{offset}">{written}</textPath></text></svg>'
    )
    (folder / "curve.svg").write_text(svg, encoding="utf-8")
    page.set_content(f"<style>@font-face{{font-family:F;src:url(data:font/ttf;base64,{encoded})}}</style>{svg}")
    page.evaluate("async text => { await document.fonts.load('20px F', text); }", written)
    return np.array(page.evaluate(POSITIONS))


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
    theirs = set_by_chromium(page, tmp_path, file, written, f'<path id="p" d="{data}"/>', offset)
    path = open_path(tmp_path / "curve.svg#p")
    layout = gs.layout(gs.open_font(file), written)
    ours = along(layout, path, offset=offset)
    assert letters_of(layout).of.tolist() == list(range(len(written)))
    np.testing.assert_allclose(ours.origin * [1, -1], theirs[:, :2], atol=share * path.length)
    np.testing.assert_allclose(-np.degrees(ours.angle), theirs[:, 2], atol=degrees)


@pytest.mark.parametrize(
    ("data", "share"), [("M0 0L3 -1.5L11 .5L15 4.5L30 5", 2e-5), ("M0 4C4 -4 8 -4 12 4S20 10 24 4", 5e-4)]
)
@pytest.mark.parametrize(("name", "written"), CASES)
def test_letters_of_six_scripts_stand_where_chromium_puts_them(
    page: Any, tmp_path: Path, name: str, written: str, data: str, share: float
) -> None:
    """Their middles; ligatures are one letter here and as many as their characters there: they are left out."""
    file = Path("/usr/share/fonts/truetype", name)
    if not file.exists():
        pytest.skip(f"{file.name} is not installed")
    layout = gs.layout(gs.open_font(file), written)
    em, letters = layout.fonts[0].metrics.units_per_em, letters_of(layout)
    found = set_by_chromium(page, tmp_path, file, written, f'<path id="p" transform="scale({em})" d="{data}"/>')
    begin, end = found[letters.character, :2] * [1, -1], found[letters.character, 3:] * [1, -1]
    points, _ = open_path(tmp_path / "curve.svg#p").at(letters.middle - letters.left.min())
    alike = np.abs(np.hypot(*(end - begin).T) - (letters.right - letters.left)) < 1e-3 * em
    assert alike.sum() > 6
    np.testing.assert_allclose(((begin + end) / 2)[alike], points[alike], atol=share * em)
