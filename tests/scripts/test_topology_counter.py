"""The counter of crossings on paths whose crossings are known."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from fontTools.pens.areaPen import AreaPen
from fontTools.ttLib import TTFont

from glyphspline.types import FloatArray
from tests.places import FONTS
from tests.topology import Drawing, Piece, area, crossings, defects, font_contours, parameters, path_contours, power


def circle(x: float, y: float, r: float) -> str:
    k = round(0.5522847 * r, 6)
    return (
        f"M{x + r} {y}c0 {k} {k - r} {r} {-r} {r}c{-k} 0 {-r} {k - r} {-r} {-r}"
        f"c0 {-k} {r - k} {-r} {r} {-r}c{k} 0 {r} {r - k} {r} {r}Z"
    )


SQUARE = "M0 0H20V20H0Z"
SPLIT_LOOP = "M0 0C50 50 37.5 75 25 75C12.5 75 0 50 50 0Z"
"""The two halves of C100 100 -50 100 50 0, whose double point is in neither."""

KNOWN: list[tuple[str, str, dict[tuple[int, int], int]]] = [
    ("figure eight of lines", "M0 0L10 10L10 0L0 10Z", {(0, 0): 1}),
    ("figure eight through a joint", "M0 0C40 40 80 40 80 0S40-40 0 0C-40 40-80 40-80 0S-40-40 0 0Z", {(0, 0): 1}),
    ("two leaves that touch", "M0 0C40 40 80 40 80 0S40-40 0 0C-40-40-80-40-80 0S-40 40 0 0Z", {}),
    (
        "a strand dips a thousandth",
        "M0 0L100 0L100 50L0 50Z M0-50L100-50L100-.001C60 .002 40 .002 0-.001Z",
        {(0, 1): 2},
    ),
    ("a strand dips a thousandth of itself", "M0 0L100 0L120 30L100-.001C60 .002 40 .002 0-.001L-20 30Z", {(0, 0): 2}),
    ("a strand only touches", "M0 0L100 0L100 50L0 50Z M0-50L100-50L100-3C60 1 40 1 0-3Z", {}),
    ("loop of a cubic", "M0 0C100 100-50 100 50 0Z", {(0, 0): 1}),
    ("loop of a cubic in two pieces", SPLIT_LOOP, {(0, 0): 1}),
    ("small loop of a cubic", "M0 0C100.1 100-.1 100 100 0L50-20Z", {(0, 0): 1}),
    ("nearly a cusp", "M0 0C99.9 100 .1 100 100 0L50-20Z", {}),
    ("small loop at a fold of lines", "M0 0H100L100.1-.05L100-.1L0 50Z", {(0, 0): 1}),
    ("small loop at a fold", "M0 0C30 0 70 0 100 0C100.1 0 100.1-.1 100-.1C70 15 30 40 0 50Z", {(0, 0): 1}),
    ("no loop at a fold", "M0 0C30 0 70 0 100 0C100.1 0 100.1.1 100 .1C70 15 30 40 0 50Z", {}),
    ("cusp", "M0 0C100 100 0 100 100 0L50-20Z", {}),
    ("circles cross", circle(0, 0, 1) + circle(1, 0, 1), {(0, 1): 2}),
    ("circles touch", circle(0, 0, 1) + circle(2, 0, 1), {}),
    ("circles touch inside", circle(0, 0, 1) + circle(0.5, 0, 0.5), {}),
    ("curves touch at an irrational parameter", "M0 0Q6 0 12 48V60H0Z M0-3C3 1 7 12 12 36V-9H0Z", {}),
    ("and are shifted a little", "M0 0Q6 0 12 48V60H0Z M0-2.999C3 1.001 7 12.001 12 36.001V-9H0Z", {(0, 1): 2}),
    ("nested circles", circle(0, 0, 1) + circle(0, 0, 0.5), {}),
    ("the same twice", circle(0, 0, 3) * 2, {}),
    ("the same twice, in other pieces", SQUARE + "M5 0H20V3V20H2H0V10V0Z", {}),
    ("squares side by side", SQUARE + "M20 0H30V20H20Z M20 5H25V8H20Z", {}),
    ("squares cross", SQUARE + "M10 10H30V30H10Z", {(0, 1): 2}),
    ("a corner on a side", SQUARE + "M10 0L5-5H15Z", {}),
    ("a corner on a side, through it", SQUARE + "M10 0L5 5L8-5Z", {(0, 1): 2}),
    ("joint through joint", "M0 0H10H20V20H0Z M5-5L10 0L15 5L25-10Z", {(0, 1): 2}),
    ("joint touches joint", "M0 0H10H20V20H0Z M5-5L10 0L15-5Z", {}),
    ("crosses itself at a joint", "M0 0L10 10L20 20H0L10 10L20 0Z", {(0, 0): 1}),
    ("touches itself at a joint", "M0 0L10 10L0 20H20L10 10L20 0Z", {}),
    ("a curve through a joint", "M0 0Q20 0 20 20H0Z M15 5L25-5H0Z", {(0, 1): 2}),
    ("a curve crosses its tangent", "M-1-1C-.333333 1 .333333-1 1 1V-3H-1Z M-2 0H2V5H-2Z", {(0, 1): 2}),
    ("a curve of the third order crosses a line", "M-9-9C-3 9 3-9 9 9V-30H-9Z M-20 0H20V50H-20Z", {(0, 1): 2}),
    ("contact of the third order", "M-3-1C-1 1 1-1 3 1V-9H-3Z M-9 0H9V9H-9Z", {(0, 1): 2}),
    ("contact of the third order at joints", "M0 0C1 0 2 0 3 1V-9H-3V-1C-2 0-1 0 0 0Z M0 0H9V9H-9V0Z", {(0, 1): 2}),
    ("contact of the second order at joints", "M0 0C1 0 2 0 3-1V-9H-3V-1C-2 0-1 0 0 0Z M0 0H9V9H-9V0Z", {}),
    ("parabolas touch at a joint", "M0 0Q2 0 4 4V-9H-4V4Q-2 0 0 0Z M0 0Q2 0 4 5V9H-4V5Q-2 0 0 0Z", {}),
    ("parabolas cross at a joint", "M0 0Q2 0 4 5L6-9H-4V4Q-2 0 0 0Z M0 0Q2 0 4 4L3 9H-4V5Q-2 0 0 0Z", {(0, 1): 2}),
    ("there and back", "M0 0H90Z", {}),
    ("a single point", "M5 5Z" + SQUARE, {}),
]


@pytest.mark.parametrize(("path", "expected"), [pytest.param(p, e, id=name) for name, p, e in KNOWN])
def test_known_crossings(path: str, expected: dict[tuple[int, int], int]) -> None:
    drawing = path_contours(path)
    expected = {pair: count for pair, count in expected.items() if count}
    assert crossings(drawing) == expected
    for turn in (lambda x, y: (y, x), lambda x, y: (3 * x - 4 * y, 4 * x + 3 * y), lambda x, y: (x + 10**9, y - 10**9)):
        other = [[tuple(turn(x, y) for x, y in piece) for piece in contour] for contour in drawing.contours]
        back = [[piece[::-1] for piece in contour[::-1]] for contour in other]
        assert crossings(Drawing(1, other)) == crossings(Drawing(1, back)) == expected


def test_random_curves_cross_as_often_as_fine_polygons_along_them() -> None:
    rng = np.random.default_rng(7)
    counted = 0
    for _ in range(40):
        contours = []
        for _ in range(2):
            joints = [tuple(p) for p in rng.integers(-300, 300, (rng.integers(3, 6), 2)).tolist()]
            ends = zip(joints, [*joints[1:], joints[0]], strict=True)
            handles = [rng.integers(-300, 300, (rng.integers(0, 3), 2)).tolist() for _ in joints]
            contours.append([(a, *map(tuple, h), b) for (a, b), h in zip(ends, handles, strict=True)])
        drawing = Drawing(1, contours)
        found = crossings(drawing)
        for i, j in ((0, 0), (0, 1), (1, 1)):
            for fineness in (100, 600):  # few have loops so small that the first polygon has none
                p, q = (polygon(contours[k], fineness) for k in (i, j))
                count = polygon_crossings(p, q, i == j)
                if found.get((i, j), 0) == count:
                    break
            else:
                pytest.fail(f"{found.get((i, j), 0)} crossings, not {count}: {contours}")
            counted += count
    assert counted > 400


def polygon(contour: list[Piece], fineness: int) -> FloatArray:
    """Vertices on a contour, at other parameters on each piece, so that hardly any two sides are in line."""
    points = []
    for number, piece in enumerate(contour):
        t = np.arange(fineness + number) / (fineness + number) if len(piece) > 2 else np.zeros(1)
        points.append(np.stack([np.polynomial.polynomial.polyval(t, np.array(c, float)) for c in power(piece)], axis=1))
    return np.concatenate(points)


def polygon_crossings(p: FloatArray, q: FloatArray, same: bool) -> int:
    """Pairs of sides of two polygons that cross, neighbours apart."""

    def apart(p: FloatArray, q: FloatArray) -> Any:
        side, away = np.roll(p, -1, axis=0) - p, q[None] - p[:, None]
        left = side[:, None, 0] * away[..., 1] - side[:, None, 1] * away[..., 0] >= 0
        return left != np.roll(left, -1, axis=1)

    cross = apart(p, q) & apart(q, p).T
    if same:
        cross = np.triu(cross, 2)
        cross[0, -1] = False
    return int(cross.sum())


def test_path_data_of_every_command() -> None:
    plain = path_contours("M1.5-2.25L3 4L10 4L10 6C11 7 12 8 13 6C14 4 15 5 16 6Q18 8 20 6Q22 4 24 6L1.5-2.25Z")
    short = path_contours("m1.5-2.25 1.5 6.25h7v2c1 1 2 2 3 0s2-1 3 0q2 2 4 0t4 0z")
    assert plain == short
    assert plain.unit == 100
    assert plain.contours[0][0] == ((150, 225), (300, -400))
    two = path_contours("M0 0l.5.5-1 0Zl-.5-.5h2zm1 1h1v1")
    assert two == path_contours("M0 0L.5.5L-.5.5ZM0 0L-.5-.5H1.5ZM1 1H2V2Z")


@pytest.mark.parametrize(("path", "expected"), [(SQUARE, -400), ("M0 0V1.5H1Z", "0.75"), ("M0 0Q3 6 6 0Z", 12)])
def test_area(path: str, expected: Any) -> None:
    assert area(path_contours(path), 0) == Fraction(expected)


def test_area_of_a_circle() -> None:
    assert float(area(path_contours(circle(3, 4, 100)), 0)) == pytest.approx(-np.pi * 1e4, rel=1e-3)


def test_defects_are_crossings_beyond_the_source_and_contours_without_area_or_turned() -> None:
    source = path_contours(SQUARE + "M30 0L40 10L40 0L30 10Z" + "M50 0H60V10H50Z" + "M70 0H80V10H70Z")
    written = path_contours("M0 0L20 20L20 0L0 20Z" + "M10 0L40 10L40 0L30 10Z" + "M50 0V10H60V0Z" + "M70 0H80Z")
    found, collapsed = defects(written, source)
    assert found == {(0, 0): 1, (0, 1): 4}
    assert collapsed == [0, 2, 3]
    assert defects(source, source) == ({}, [])
    with pytest.raises(ValueError, match="3 contours are written, of 4"):
        defects(Drawing(1, written.contours[:3]), source)


@pytest.mark.parametrize("name", ["kouzan-gyosho.ttf", "kouzan-gyosho.otf", "edge-cases.ttf", "variable-cff2.otf"])
def test_outlines_of_fonts_have_the_areas_that_fonttools_finds(name: str) -> None:
    font = TTFont(FONTS / name)
    glyphs, seen = font.getGlyphSet(), 0
    for glyph in font.getGlyphOrder()[:40]:
        try:
            pen = AreaPen(glyphs)
            glyphs[glyph].draw(pen)
        except Exception:
            continue  # what fontTools cannot draw
        drawing = font_contours(glyphs, glyph)
        total = sum(float(area(drawing, k)) for k in range(len(drawing.contours)))
        assert total == pytest.approx(pen.value, rel=1e-6, abs=1e-3)
        seen += bool(drawing.contours)
    assert seen > 3


class Dots:
    """A glyph without points on its curve."""

    def draw(self, pen: Any) -> None:
        pen.qCurveTo((0, 0), (10, 0), (10, 10), (0, 10), None)
        pen.closePath()
        pen.moveTo((3, 3))
        pen.lineTo((5, 3))
        pen.closePath()


def test_contour_without_points_on_the_curve() -> None:
    drawing = font_contours({"dots": Dots()}, "dots")
    assert drawing == path_contours("M0-5Q0 0 5 0T10-5T5-10T0-5Z")


def test_parameters_of_points() -> None:
    loop = path_contours("M0 0C10 10-5 10 5 0Z").contours[0][0]
    assert parameters(loop, loop[0]) == [0]
    assert parameters(((0, 0), (4, 0), (4, 4)), (3, 1)) == [Fraction(1, 2)]
    assert parameters(((0, 0), (9, 3)), (3, 1)) == [Fraction(1, 3)]
    assert parameters(((0, 0), (9, 3)), (12, 4)) == []
