"""What the public names say of themselves: one line each, and examples that run."""

from __future__ import annotations

import doctest
import sys

import numpy as np
import pytest

import glyphspline as gs
from tests.places import ROOT

FONT = ROOT / "fonts_test" / "kouzan-gyosho.ttf"

EXPLAINED = (
    "interpolate", "interpolate_many", "convert", "convert_many", "open_font", "Options", "sample", "to_svg",
    "to_curvature_svg", "Spline", "layout", "experiment",
)  # fmt: skip


@pytest.mark.parametrize("name", EXPLAINED)
def test_examples_in_docstrings_run(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    thing = getattr(gs, name)
    module = sys.modules[thing.__module__]
    tests = [test for test in doctest.DocTestFinder(recurse=False).find(thing, name, module, {}) if test.examples]
    assert len(tests) == 1, "an example"
    said: list[str] = []
    runner = doctest.DocTestRunner(optionflags=doctest.IGNORE_EXCEPTION_DETAIL)
    assert runner.run(tests[0], out=said.append).failed == 0, "".join(said)


def test_everything_says_itself_in_a_line() -> None:
    font = gs.open_font(FONT)
    outline = font.outline("uni9F8D")
    glyph = gs.convert(outline)
    contour = glyph.contours[0]
    arc = contour.interpolations[0]
    things = (font, outline, outline.contours[0], glyph, contour, contour.measures, arc, arc.spline, glyph.arrays)
    for thing in things:
        said = repr(thing)
        assert type(thing).__name__ in said
        assert "\n" not in said
        assert "array" not in said
        assert len(said) < (500 if thing is contour.measures else 130), said
    assert repr(font) == (
        "<Font 'Kouzan Gyosho Subset Regular' from 'kouzan-gyosho.ttf': 18 glyphs, 17 characters, 1024 units per em>"
    )
    assert f"{sum(each.measures.vertices for each in glyph.contours)} vertices" in repr(glyph)
    assert "certified within" in repr(glyph)
    assert repr(gs.Contour(np.empty((0, 2)), np.empty(0, dtype=np.int64))) == "<Contour: empty>"
    assert repr(gs.convert(font.outline("space"))) == "<GlyphResult 'space': 0 contours, 0 vertices, 0 segments>"
    assert "not converged" in repr(gs.interpolate(arc.spline.control_points, max_iterations=1))


def test_a_spline_is_defined_from_its_first_knot_to_its_last() -> None:
    points = [[0, 0], [4, 0], [5, 3], [2, 5]]
    closed, opened = gs.interpolate(points).spline, gs.interpolate(points, closed=False).spline
    np.testing.assert_allclose(closed(0.3 + closed.period), closed(0.3))
    np.testing.assert_allclose(opened([-1.0, 99.0]), [points[0], points[-1]])
