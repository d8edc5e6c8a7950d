"""Fonts as TTF and OTF turn nowhere where their sources do not, by a count that shares nothing with the package."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont

import glyphspline as gs
from glyphspline.fitting.convert import unfitted
from glyphspline.plugins.fonts.fit.points import quadratic_points
from glyphspline.plugins.fonts.tables.font_file import write_font
from tests.rounded_font import rounded_font
from tests.turns import Turn, new_turns, turns

OPTIONS = gs.Options(continuity="g2")

NEAR = 1.75
"""Units from a turn of the source: the tolerance of an em of 1,000, and what rounding moves a node by."""


@pytest.mark.parametrize("kind", ["otf", "ttf"])
def test_rounded_strokes_have_no_new_turn_as_ttf(kind: str, tmp_path: Path) -> None:
    """Beside arcs of a few units the grid has no place in the direction of most lines."""
    source, made = rounded_font(tmp_path / f"source.{kind}", 50, seed=50), tmp_path / "made.ttf"
    font = gs.open_font(source)
    names = [name for name in font.glyph_names if name != ".notdef"]
    results: Any = unfitted([*font.outlines(names)], OPTIONS)
    write_font(font, results, made, tolerance=1.0)
    before, after = (TTFont(path).getGlyphSet() for path in (source, made))
    seen = {name: turns(before, name) for name in names}
    assert sum(map(len, seen.values())) > 100, "the source turns by rounding"
    found = {name: new_turns(seen[name], turns(after, name), NEAR) for name in names}
    assert {name: new for name, new in found.items() if new} == {}


def test_points_of_quadratics_are_whole(tmp_path: Path) -> None:
    """A writer may cut decimals off: -15 less a rounding error became -14."""
    font = gs.open_font(rounded_font(tmp_path / "source.ttf", 12, seed=7))
    for outline in font.outlines(font.glyph_names):
        for points, _ in quadratic_points(outline.arrays, OPTIONS, 1.0, 1000.0)[0] if outline.contours else ():
            np.testing.assert_array_equal(points, np.rint(points))


def test_turns_are_seen_where_they_are(tmp_path: Path) -> None:
    """On the curve, where a contour is closed, and in those without a point on the curve; implied ones are smooth."""
    pen = TTGlyphPen(None)
    pen.moveTo((0, 0))
    pen.lineTo((200, 0))
    pen.qCurveTo((300, 10), (300, 200))  # turns by 5.7 degrees at (200, 0)
    pen.qCurveTo((300, 300), (200, 300), (0, 300))
    pen.closePath()
    pen.qCurveTo((500, 0), (700, 0), (700, 200), (500, 200), None)
    pen.closePath()
    builder = FontBuilder(1000, isTTF=True)
    builder.setupGlyphOrder([".notdef"])
    builder.setupGlyf({".notdef": pen.glyph()})
    builder.setupHorizontalMetrics({".notdef": (1000, 0)})
    builder.setupHorizontalHeader()
    builder.save(tmp_path / "drawn.ttf")
    found = turns(TTFont(tmp_path / "drawn.ttf").getGlyphSet(), ".notdef")
    assert [(each.x, each.y, round(each.size, 1)) for each in found] == [(0, 0, 90), (200, 0, 5.7), (0, 300, 90)]


def test_a_turn_of_the_source_counts_for_one() -> None:
    source = [Turn(0, 0, 3.0), Turn(100, 0, 90.0)]
    assert new_turns(source, [Turn(1, 0, 3.9), Turn(100, 0, 89.0)], NEAR) == []
    more, again, beside, elsewhere = Turn(0, 0, 4.1), Turn(1, 1, 2.0), Turn(101, 0, 5.0), Turn(50, 0, 0.6)
    assert new_turns(source, [more], NEAR) == [more]
    assert new_turns(source, [Turn(0, 0, 3.0), again], NEAR) == [again]
    assert new_turns(source, [Turn(100, 0, 90.0), beside], NEAR) == [beside]
    assert new_turns(source, [elsewhere, Turn(60, 0, 13.0)], NEAR) == [elsewhere]
