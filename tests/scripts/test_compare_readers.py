"""The comparison of HarfBuzz and fontTools over faces: what it counts, and that it sees a difference."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from glyphspline.readers import open_font
from glyphspline.readers.opentype.routes import HarfBuzz
from scripts.compare_readers import compared, kind_of, look
from tests.places import FONTS


@pytest.mark.parametrize("file", ["kouzan.ttc", "edge-cases.ttf", "variable.ttf", "variable-cff2.otf"])
def test_the_test_fonts_are_read_alike(file: str) -> None:
    counts, lines = look(FONTS / file, 1)
    assert counts["faces"] >= 1
    assert counts["variable"] >= file.startswith("variable")
    assert sum(number for kind, number in counts.items() if kind.startswith("equal")) > 5
    assert not counts["differs"], lines


def test_a_difference_is_seen() -> None:
    font = open_font(FONTS / "edge-cases.ttf")
    (outline,) = font.outlines(["a"])
    pen, advance = HarfBuzz(font.path, 0, {}).fonttools.draw("a")
    assert [kind for _, kind in compared(font, ["a"])] == ["equal"]
    assert kind_of(outline, pen, advance + 2).startswith("differs: advance")
    moved = [replace(contour, points=contour.points + np.array([1, 0])) for contour in outline.contours]
    assert kind_of(replace(outline, contours=tuple(moved)), pen, advance) == "differs: by 1 units"
    assert kind_of(replace(outline, contours=()), pen, advance) == "differs: 0 contours, 2"
