"""What went wrong with the topology of a written glyph is in its measures: counted apart from the package."""

from __future__ import annotations

from functools import cache
from itertools import product
from typing import Any

import numpy as np
import pytest
from fontTools.ttLib import TTFont

import glyphspline as gs
from scripts.topology import hard
from tests.places import FONTS
from tests.topology import Drawing, defects, font_contours, path_contours, unflagged

WAYS: list[tuple[Any, Any]] = list(product(("smooth", "sharp"), ("fast", "best")))
TEARDROP = path_contours("M0 0C150 .1 300 .15 450 .15S750 .1 900 0C750-.1 600-.15 450-.15S150-.1 0 0Z")
"""900 units long and 0.3 high: a straight line there and back is within a quarter of a unit of it."""


@cache
def sources() -> dict[str, tuple[gs.Outline, Drawing]]:
    """Glyphs spread over two brush faces."""
    found = {}
    for name in ("kouzan-gyosho.ttf", "kouzan-kaisho.ttf"):
        path = FONTS / name
        font, tables = gs.open_font(path), TTFont(path)
        glyphs = [glyph for glyph in tables.getGlyphOrder() if tables["glyf"][glyph].numberOfContours]
        for glyph in glyphs[:: max(1, len(glyphs) // 15)][:15]:
            found[f"{name} {glyph}"] = font.outline(glyph), font_contours(tables.getGlyphSet(), glyph)
    return found


@pytest.mark.parametrize(("corners", "effort"), WAYS)
def test_new_crossings_and_collapses_are_in_the_measures(corners: Any, effort: Any) -> None:
    options = gs.Options(corners=corners, effort=effort)
    silent = {}
    for name, (outline, source) in sources().items():
        result = gs.convert(outline, options)
        words = unflagged(*defects(gs.to_svg(result), source), [c.measures for c in result.contours])
        if words:
            silent[name] = words
    assert silent == {}
    assert len(sources()) == 30


@pytest.mark.parametrize("effort", ["fast", "best"])
def test_a_contour_that_becomes_a_line_is_in_the_measures(effort: Any) -> None:
    points = np.array([point for piece in TEARDROP.contours[0] for point in piece[:3]]) / TEARDROP.unit
    outline = gs.Outline("teardrop", contours=(gs.Contour(points, np.array([3, 3, 3, 3])),))
    result = gs.convert(outline, gs.Options(corners="sharp", effort=effort, tolerance=0.25))
    assert unflagged(*defects(gs.to_svg(result), TEARDROP), [c.measures for c in result.contours]) == []


@pytest.mark.parametrize("numbers", [(0, 1, 3, 5, 9, 17, 266), pytest.param(range(20), marks=pytest.mark.long)])
def test_new_crossings_of_contours_thinner_than_the_tolerance_and_of_tangles_are_in_the_measures(numbers: Any) -> None:
    """A short form of ``make check-topology``, with contours that went wrong once."""
    found = [glyph for number in numbers for glyph in hard(number)]
    assert [(glyph.character, glyph.way, glyph.silent) for glyph in found if glyph.silent] == []
    assert sum(any(glyph.wrong) for glyph in found) > 1
    assert {glyph.face for glyph in found} == {"tangle", "ring", "loop", "hair", "back", "lens"}
