"""HarfBuzz and fontTools give the same outlines, over whole fonts; and what only one of them can read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import USE_MY_METRICS, GlyphComponent

from glyphspline.errors import GlyphsplineError
from glyphspline.outlines.outline import Contour
from glyphspline.readers import open_font
from glyphspline.types import FloatArray, Head
from tests.places import FACES, FONTS


def from_leftmost(contour: Contour) -> FloatArray:
    """All segments as cubics, begun at the lowest of the leftmost ends: the routes may begin a contour elsewhere."""
    cubics = contour.cubics()
    starts = cubics[:, 0].round(2)
    first = int(np.lexsort(starts.T[::-1])[0])
    return np.roll(cubics, -first, axis=0)


@pytest.mark.parametrize("most", [200, pytest.param(1 << 16, marks=pytest.mark.long)])
@pytest.mark.parametrize(("file", "face_index", "location"), FACES)
def test_both_routes_give_the_same_outline(
    file: str | Path, face_index: int, location: dict[str, float], most: int
) -> None:
    font = open_font(FONTS / file, face_index, location)
    for outline in font.outlines(font.glyph_names[:: -(-len(font.glyph_names) // most)]):
        other = font._face.by_fonttools(Head(outline.name, outline.gid), font.metrics)
        assert outline.advance == other.advance
        assert outline.notes == other.notes
        assert len(outline.contours) == len(other.contours)
        for a, b in zip(outline.contours, other.contours, strict=True):
            assert sorted(a.degrees) == sorted(b.degrees)
            np.testing.assert_allclose(from_leftmost(a), from_leftmost(b), atol=2e-3 if location else 0)


def test_normalised_coordinates_are_rounded_as_the_format_has_them() -> None:
    font = open_font(FONTS / "variable.ttf", location={"wght": 777})
    assert font._face.normalized == {"wght": round(0.754 * 16384) / 16384}


def test_a_component_attached_by_point_matching_is_in_its_place(tmp_path: Path) -> None:
    font = with_matched_point()
    font.save(tmp_path / "matched.ttf")
    square, mark = open_font(tmp_path / "matched.ttf").outline("both").contours
    assert square.points.max(axis=0).tolist() == [600, 500]
    assert mark.points.min(axis=0).tolist() == [600, 500]


def with_matched_point() -> TTFont:
    """A glyph "both": a square, and a smaller one whose first point is put on the square's upper right corner."""
    builder = FontBuilder(1000, isTTF=True)
    builder.setupGlyphOrder([".notdef", "square", "mark", "both"])
    glyphs = {name: pen.glyph() for name, pen in ((n, TTGlyphPen(None)) for n in (".notdef",))}
    for name, side in (("square", 500), ("mark", 100)):
        pen = TTGlyphPen(None)
        pen.moveTo((100, 0))
        for point in ((100, side), (100 + side, side), (100 + side, 0)):
            pen.lineTo(point)
        pen.closePath()
        glyphs[name] = pen.glyph()
    pen = TTGlyphPen(dict.fromkeys(glyphs))
    pen.addComponent("square", (1, 0, 0, 1, 0, 0))
    both = pen.glyph()
    component = GlyphComponent()
    component.glyphName, component.flags, component.firstPt, component.secondPt = "mark", 0, 2, 0
    both.components.append(component)
    glyphs["both"] = both
    builder.setupGlyf(glyphs, calcGlyphBounds=False)
    for glyph in glyphs.values():
        glyph.recalcBounds(builder.font["glyf"])
    builder.setupHorizontalMetrics({name: (700, getattr(glyph, "xMin", 0)) for name, glyph in glyphs.items()})
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupCharacterMap({})
    builder.setupPost()
    return builder.font


def test_a_composite_moves_as_the_component_whose_metrics_it_has(tmp_path: Path) -> None:
    font = with_matched_point()
    both = font["glyf"]["both"]
    both.components = both.components[:1]
    both.components[0].flags |= USE_MY_METRICS
    font["hmtx"].metrics |= {"square": (700, 117), "both": (700, 93)}
    font.save(tmp_path / "metrics.ttf")
    opened = open_font(tmp_path / "metrics.ttf")
    outline = opened.outline("both")
    assert outline.contours[0].points[:, 0].min() == 117
    other = opened._face.by_fonttools(Head("both", outline.gid), opened.metrics)
    np.testing.assert_array_equal(other.contours[0].points, outline.contours[0].points)


def test_a_broken_char_string_is_an_error_and_other_glyphs_still_read(tmp_path: Path) -> None:
    data = (FONTS / "kouzan-gyosho.otf").read_bytes()
    string = TTFont(FONTS / "kouzan-gyosho.otf")["CFF "].cff[0].CharStrings["A"].bytecode
    assert data.count(string) == 1
    half = len(string) // 2
    (tmp_path / "cut.otf").write_bytes(data.replace(string, string[:half] + bytes([10]) * (len(string) - half)))
    font = open_font(tmp_path / "cut.otf")
    assert font.outline("uni9F8D").contours
    with pytest.raises(GlyphsplineError, match="glyph 'A'"):
        font.outline("A")
