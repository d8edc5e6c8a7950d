"""Open paths in sources that are put back, and in fonts, which have none."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import glyphspline as gs
from glyphspline.outlines.open_paths import are_open
from tests.outlines.test_open_paths import SQUARE, stick_font, ufo

PATH: list[tuple[str | None, int, int]] = [
    ("move", 0, 0),
    (None, 0, 300),
    (None, 200, 700),
    ("curve", 400, 700),
    ("line", 600, 700),
]


@pytest.mark.parametrize("name", ["otf", "ttf"])
def test_fonts_refuse_open_paths_by_name_and_other_glyphs_go_on(tmp_path: Path, name: str) -> None:
    square: list[tuple[str | None, int, int]] = [("line", x, y) for x, y in SQUARE]
    source = ufo(tmp_path / "a.ufo", {"A": [square, PATH], "B": [square]})
    summary = gs.refit(source, tmp_path / "out", formats=(name,))
    lines = map(json.loads, (tmp_path / "out" / "manifest.jsonl").read_text().splitlines())
    errors = {line["glyph"]: line["error"] for line in lines}
    assert errors == {"A": "contour 1: an open path, which fonts would fill or not draw", "B": None}
    assert summary.statuses["failed"] == 1
    (font,) = (tmp_path / "out").glob(f"*.{name}")
    assert len(gs.open_font(font).outline("B").contours) == 1


def test_a_source_keeps_open_contours_as_they_are(tmp_path: Path) -> None:
    wave: list[tuple[str | None, int, int]] = [
        ("curve", 0, 0),
        (None, 0, 100),
        (None, 90, 200),
        ("curve", 200, 201),
        (None, 300, 200),
        (None, 400, 100),
    ]
    source = ufo(tmp_path / "a.ufo", {"A": [PATH, [*wave, ("curve", 400, 0)]]})
    before = (tmp_path / "a.ufo" / "glyphs" / "A_.glif").read_text()
    summary = gs.refit(source, in_place=True, options=gs.Options(tolerance=30.0, corners="sharp", continuity="g2"))
    after = (tmp_path / "a.ufo" / "glyphs" / "A_.glif").read_text()
    first = slice(before.index("<contour>"), before.index("</contour>"))
    assert after[first] == before[first]
    assert "A: contour 0 is open, and stays as it was" in summary.remarks


def test_a_single_line_font_becomes_a_ufo_of_open_contours(tmp_path: Path) -> None:
    font = stick_font(tmp_path / "stick.ttf", {"V": [[(0, 0), (200, 700), (400, 0), (200, 700)]]})
    gs.refit(font, tmp_path / "out", formats=("ufo",))
    (made,) = (tmp_path / "out").glob("*.ufo")
    outline = gs.open_source(made).outline("V")
    assert are_open(outline.arrays).tolist() == [True]
    assert [segment.tolist() for segment in outline.contours[0].drawn()] == [
        [[0, 0], [200, 700]],
        [[200, 700], [400, 0]],
    ]
