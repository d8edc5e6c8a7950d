"""Open paths: contours that go along a path and back, from sources with open contours and from single-line fonts."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.recordingPen import RecordingPen
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ufoLib import UFOWriter

import glyphspline as gs
from glyphspline.outlines.open_paths import are_open, paths, there_and_back
from glyphspline.outlines.outline import Contour, Outline
from glyphspline.readers import Source
from glyphspline.types import FloatArray

ARCH = [("moveTo", (0, 0)), ("curveTo", (0, 300), (200, 700), (400, 700)), ("lineTo", (600, 700))]
SQUARE = [(0, 0), (0, 400), (400, 400), (400, 0)]


def ufo(path: Path, glyphs: Mapping[str, Sequence[Sequence[tuple[str | None, int, int]]]]) -> Source:
    """A UFO of glyphs by name, each of contours of points: type, x, y."""
    writer = UFOWriter(path)
    writer.writeInfo(SimpleNamespace(unitsPerEm=1000, ascender=800, descender=-200, familyName="Open", styleName="One"))
    layer = writer.getGlyphSet()

    def drawn(contours: Any) -> Any:
        def draw(pen: Any) -> None:
            for contour in contours:
                pen.beginPath()
                for kind, x, y in contour:
                    pen.addPoint((x, y), kind)
                pen.endPath()

        return draw

    for k, (name, contours) in enumerate(glyphs.items()):
        layer.writeGlyph(name, SimpleNamespace(width=600, unicodes=[65 + k]), drawn(contours))
    layer.writeContents()
    writer.writeLayerContents(["public.default"])
    writer.close()
    return gs.open_source(path)


def stick_font(path: Path, glyphs: Mapping[str, Sequence[Sequence[tuple[int, int]]]], flavour: str = "ttf") -> Source:
    """A font of glyphs of lines by name, each of closed contours of points."""
    builder, order = FontBuilder(1000, isTTF=flavour == "ttf"), [".notdef", *glyphs]
    builder.setupGlyphOrder(order)
    builder.setupCharacterMap({65 + k: name for k, name in enumerate(glyphs)})
    made = {}
    for name in order:
        pen: Any = TTGlyphPen(None) if flavour == "ttf" else T2CharStringPen(600, None)
        for contour in glyphs.get(name, ()):
            pen.moveTo(contour[0])
            for point in contour[1:]:
                pen.lineTo(point)
            pen.closePath()
        made[name] = pen.glyph() if flavour == "ttf" else pen.getCharString(optimize=False)
    if flavour == "ttf":
        builder.setupGlyf(made)
    else:
        builder.setupCFF("Stick", {}, made, {})
    builder.setupHorizontalMetrics(dict.fromkeys(order, (600, 0)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupNameTable({"familyName": "Stick", "styleName": "Regular"})
    builder.setupOS2()
    builder.setupPost()
    builder.save(path)
    return gs.open_font(path)


@pytest.fixture
def arch() -> Outline:
    points = np.array([[0, 0], [0, 300], [200, 700], [400, 700], [600, 700]], dtype=np.float64)
    return Outline("arch", contours=[Contour(*there_and_back(points, np.array([3, 1])))])


def dense(segments: list[FloatArray], count: int = 400) -> FloatArray:
    """Points along segments, by de Casteljau."""
    found = []
    for segment in segments:
        t = np.linspace(0, 1, count)[:, None]
        level = [np.broadcast_to(point, (count, 2)) for point in segment]
        while len(level) > 1:
            level = [(1 - t) * a + t * b for a, b in pairwise(level)]
        found.append(level[0])
    return np.concatenate(found)


def farthest(one: FloatArray, other: FloatArray) -> float:
    return float(np.hypot(*(one[:, None] - other[None]).transpose(2, 0, 1)).min(axis=1).max())


@pytest.mark.parametrize("how", [{}, {"corners": "smooth"}, {"continuity": "g2"}])
def test_a_fit_is_within_the_tolerance_both_ways_and_keeps_the_ends(arch: Outline, how: Any) -> None:
    glyph = gs.convert(arch, gs.Options(tolerance=1.0, **how))
    (contour,) = glyph.contours
    both = contour.curve.rounded(glyph.options.precision).drawn(), arch.contours[0].drawn()
    assert contour.measures.deviation_bound is not None
    bound = contour.measures.deviation_bound + 0.02  # for points 0.2 apart
    assert all(farthest(dense(a), dense(b, 4000)) <= bound for a, b in (both, both[::-1]))
    source = dense(both[1])
    assert contour.measures.within_tolerance
    assert contour.polygon[[0, -1]].tolist() == [[0, 0], [600, 700]]
    assert contour.spline is not None
    assert not contour.spline.closed
    ends = contour.spline(contour.spline.knots[[0, -1]])
    assert np.allclose(ends, [[0, 0], [600, 700]])
    pieces = contour.spline.to_bezier()
    assert farthest(dense(list(pieces)), dense(contour.curve.drawn())) < 1.0
    assert contour.measures.length == pytest.approx(np.hypot(*np.diff(source, axis=0).T).sum(), rel=1e-3)
    assert contour.measures.segments == len(contour.curve.drawn())


def test_step_and_count_put_one_arc_through_the_path(arch: Outline) -> None:
    (contour,) = gs.convert(arch, gs.Options(count=9)).contours
    assert len(contour.polygon) == 9
    (arc,) = contour.interpolations
    assert arc.converged
    assert not arc.spline.closed
    assert np.allclose(arc.spline(arc.parameters), contour.polygon, atol=0.01)
    assert farthest(contour.polygon, dense(arch.contours[0].drawn())) < 1.5  # of chords
    (stepped,) = gs.convert(arch, gs.Options(step=100.0)).contours
    assert np.hypot(*np.diff(stepped.polygon, axis=0).T).max() < 150


def test_a_line_and_a_ring_that_is_left_open() -> None:
    line = Contour(*there_and_back(np.array([[0.0, 0.0], [0.0, 700.0]]), np.array([1])))
    ring = np.array([[0, 0], [0, 400], [400, 400], [400, 0], [0, 0]], dtype=np.float64)
    outline = Outline("both", contours=[line, Contour(*there_and_back(ring, np.ones(4, dtype=np.int64)))])
    text = gs.to_svg(gs.convert(outline), bare=True)
    assert 'd="M0 0v-700M0 0v-400h400V0H0"' in text


def test_closed_contours_beside_open_ones_are_fitted_as_if_alone(arch: Outline) -> None:
    square = Contour(np.array(SQUARE, dtype=np.float64), np.ones(4, dtype=np.int64))
    alone = gs.convert(Outline("a", contours=[square]))
    mixed = gs.convert(Outline("m", contours=[arch.contours[0], square]))
    assert [contour.curve.is_open for contour in mixed.contours] == [True, False]
    assert mixed.contours[1].measures == alone.contours[0].measures
    svg = gs.to_svg(mixed)
    filled, stroked = re.findall(r"<path[^>]*>", svg)
    assert 'd="M0 0v-400h400V0Z"' in filled
    assert "stroke" not in filled
    assert 'fill="none" stroke="currentColor" stroke-width="25"' in stroked
    assert "Z" not in stroked
    assert 'stroke="#d00" stroke-width="2"' in gs.to_svg(mixed, stroke="#d00", stroke_width="2").split("<path")[2]


def test_open_contours_of_a_ufo_stay_open(tmp_path: Path) -> None:
    path: list[tuple[str | None, int, int]] = [
        ("move", 0, 0),
        (None, 0, 300),
        (None, 200, 700),
        ("curve", 400, 700),
        ("line", 600, 700),
    ]
    square: list[tuple[str | None, int, int]] = [("line", x, y) for x, y in SQUARE]
    source = ufo(tmp_path / "open.ufo", {"A": [path], "B": [square, [("move", 9, 9)], path]})
    assert [are_open(source.outline(name).arrays).tolist() for name in "AB"] == [[True], [False, True]]
    pen = RecordingPen()
    source.outline("A").draw(pen)
    assert pen.value == [(name, tuple(points)) for name, *points in ARCH] + [("endPath", ())]


@pytest.mark.parametrize("flavour", ["ttf", "otf"])
def test_strokes_there_and_back_are_recognised(tmp_path: Path, flavour: str) -> None:
    vee = [(0, 0), (200, 700), (400, 0), (200, 700)]
    tee = [(200, 0), (200, 700), (0, 700), (200, 700), (400, 700), (200, 700)]
    from_the_middle = vee[1:] + vee[:1]
    font = stick_font(
        tmp_path / f"stick.{flavour}",
        {
            "V": [vee],
            "W": [from_the_middle],
            "T": [tee],
            "I": [[(0, 0), (0, 700)]],
            "D": [[(5, 5)], SQUARE],
            "S": [SQUARE],
        },
        flavour,
    )
    drawn = {name: [[*map(tuple, c.points[: len(c.points) // 2 + 1].tolist())] for c in font.outline(name).contours]
             for name in "VWTI"}  # fmt: skip
    assert drawn["V"] == [vee[:3]]
    assert drawn["W"] in ([vee[:3]], [vee[2::-1]])
    assert sorted(map(len, drawn["T"])) == [2, 3]
    assert drawn["I"] == [[(0, 0), (0, 700)]]
    assert not are_open(font.outline("D").arrays).any()
    assert len(font.outline("D").contours) == 1
    assert not are_open(font.outline("S").arrays).any()


def test_beside_ink_what_retraces_itself_is_left_out_as_no_program_shows_it(tmp_path: Path) -> None:
    eight, back = [(0, 0), (400, 400), (400, 0), (0, 400)], [(0, 0), (200, 700), (400, 0), (200, 700)]
    font = stick_font(tmp_path / "left.ttf", {"A": [eight], "B": [SQUARE, back]})
    assert are_open(font.outline("A").arrays).tolist() == [False]
    assert are_open(font.outline("B").arrays).tolist() == [False]
    assert font.outline("B").notes == ("contour 1 left out: it encloses nothing",)


def test_paths_have_the_way_there_and_a_line_back(arch: Outline) -> None:
    arrays = arch.arrays
    ways = paths(arrays, are_open(arrays))
    assert ways.points.tolist() == arrays.points[:5].tolist()
    assert ways.degrees.tolist() == [3, 1, 1]


def test_maps_json_and_pictures_draw_paths_once(arch: Outline) -> None:
    import json

    glyph = gs.convert(arch)
    svg = gs.to_curvature_svg(glyph)
    assert re.search(r'<path class="outline"[^>]* d="M0 0[^Z]*"', svg)
    (contour,) = json.loads(gs.to_json(glyph))["contours"]
    assert contour["spline"]["closed"] is False
    assert len(contour["source"]) == 2
    assert gs.Spline(**contour["spline"])
