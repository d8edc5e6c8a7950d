"""Paths that text runs along: arc length, SVG shapes, letters upright to a path, and outlines bent along it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path as FilePath
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.spatial import cKDTree
from scipy.special import ellipe

import glyphspline as gs
from glyphspline.curves.bezier import derivative_points, evaluate
from glyphspline.errors import FontError, GlyphsplineError, OptionError
from glyphspline.outlines.joins import joins
from glyphspline.types import FloatArray
from glyphspline.typesetting.along_path import along, letters_of
from glyphspline.typesetting.bent import SHARE, bend
from glyphspline.typesetting.path import Path
from glyphspline.typesetting.path_file import open_path
from glyphspline.typesetting.placed import Layout
from glyphspline.typesetting.setting import Align
from tests.drawings import circle
from tests.places import FONTS
from tests.text_fonts import text_font

NAMESPACE = 'xmlns="http://www.w3.org/2000/svg"'
WAVE = np.array(
    [[[0, 0], [2000, 3000], [4000, 3000], [6000, 0]], [[6000, 0], [8000, -3000], [9000, -2000], [11000, 0]]]
)


def text(written: str = "agO龍") -> Layout:
    return gs.layout(gs.open_font(FONTS / "kouzan-gyosho.ttf"), written)


def placed(
    advances: Sequence[float], clusters: Sequence[int], offsets: Sequence[float] | None = None, said: str = ""
) -> Layout:
    """A line of glyphs of no font: marks have the offsets from their pens."""
    advance = np.array(advances, dtype=float)
    pens = np.cumsum(advance) - advance
    n, zero = len(advance), np.zeros(len(advance), dtype=np.int64)
    origin = np.stack([pens + np.array(offsets or 0.0), np.zeros(n)], axis=1)
    cluster = np.array(clusters)
    said = said or "abcdefghijklmnop"[: cluster.max() + 1]
    box = (0.0, -200.0, float(advance.sum()), 800.0)
    return Layout(said, (), zero, zero, cluster, zero, origin, np.zeros(n), advance, box)


def drawing(tmp_path: FilePath, content: str, name: str = "curve") -> str:
    (tmp_path / f"{name}.svg").write_text(f"<svg {NAMESPACE}>{content}</svg>", encoding="utf-8")
    return str(tmp_path / f"{name}.svg")


def dense(outline: gs.Outline, count: int = 64) -> list[FloatArray]:
    """Points of each contour, evenly spaced in the parameter."""
    places = [np.arange(len(contour) * count) / count for contour in outline.contours]
    return [contour.at(at) for contour, at in zip(outline.contours, places, strict=True)]


def distance(points: FloatArray, polygon: FloatArray) -> float:
    """The largest distance of points (k, 2) from a closed polygon (n, 2), or a little more.

    Of the polygon, the edges at the vertex nearest to each point count.
    """
    nearest = cKDTree(polygon).query(points)[1]
    found = np.full(len(points), np.inf)
    for step in (-1, 1):
        a, b = polygon[nearest], polygon[(nearest + step) % len(polygon)]
        arm, edge = points - a, b - a
        share = np.clip((arm * edge).sum(axis=1) / np.maximum((edge * edge).sum(axis=1), 1e-300), 0, 1)
        found = np.minimum(found, np.hypot(*(arm - share[:, None] * edge).T))
    return float(found.max())


def test_a_circle_has_its_length_and_exact_angles() -> None:
    path = Path.of(circle(1000, 64), closed=True)
    assert path.length == pytest.approx(2000 * np.pi, rel=1e-9)
    assert path.length_error <= 1e-6 * path.length
    s = np.linspace(-500, 8000, 999).reshape(27, 37)
    points, tangents = path.at(s)
    assert points.shape == (*s.shape, 2)
    angle = s / 1000
    np.testing.assert_allclose(points, 1000 * np.stack([np.cos(angle), np.sin(angle)], axis=-1), atol=1e-5)
    np.testing.assert_allclose(tangents, np.stack([-np.sin(angle), np.cos(angle)], axis=-1), atol=1e-8)
    np.testing.assert_allclose(path.frame(s).curvature, 1e-3, rtol=1e-4)


def test_an_ellipse_of_a_drawing_has_its_length(tmp_path: FilePath) -> None:
    path = open_path(drawing(tmp_path, '<ellipse rx="300" ry="100"/>'))
    exact = 4 * 300 * ellipe(1 - (100 / 300) ** 2)
    assert path.closed
    assert abs(path.length - exact) <= 1e-6 * exact
    assert path.at(0)[0].tolist() == [300, 0]
    assert path.at(path.length / 4)[0] == pytest.approx([0, -100], abs=1e-4)  # clockwise, as SVG has it


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.floats(-1000, 1000), st.floats(-1000, 1000)), min_size=4, max_size=4))
def test_arc_length_of_any_cubic_agrees_with_quadrature(corners: list[tuple[float, float]]) -> None:
    cubic = np.array([corners])
    if np.ptp(cubic, axis=1).max() < 1:
        return
    path = Path.of(cubic, closed=False)
    derivative = derivative_points(cubic)

    def speed(x: float) -> float:
        return float(np.hypot(*evaluate(derivative, np.array([x]))[0]))

    exact = sum(quad(speed, k / 32, (k + 1) / 32, epsabs=1e-12, limit=200)[0] for k in range(32))
    assert abs(path.length - exact) <= path.length_error + 1e-9 * exact
    assert path.length_error <= 2e-6 * path.length
    s = np.linspace(0, path.length, 300)
    chords = np.hypot(*np.diff(path.at(s)[0], axis=0).T)
    assert chords.max() <= s[1] * (1 + 1e-6)  # no chord is longer than the path between its ends
    reverse = path.reversed()
    np.testing.assert_allclose(reverse.at(path.length - s)[0], path.at(s)[0], atol=1e-6 * path.length)


def test_splines_contours_and_polylines_are_paths() -> None:
    round_square = gs.Spline(np.array([[0, 0], [100, 0], [100, 100], [0, 100.0]]), np.arange(5.0))
    assert Path.of(round_square).closed
    np.testing.assert_allclose(Path.of(round_square).at(0)[0], round_square(0))
    fifth = gs.Spline(round_square.control_points.repeat(2, axis=0) + np.arange(8)[:, None], np.arange(9.0), 5)
    t = np.linspace(0, 8, 4001)
    assert Path.of(fifth).length == pytest.approx(np.hypot(*np.diff(fifth(t), axis=0).T).sum(), rel=1e-5)
    square = gs.Contour(np.array([[0, 0], [10, 0], [10, 10], [0, 10.0]]), np.ones(4, dtype=np.int64))
    assert (Path.of(square).length, Path.of(square).closed) == (40, True)
    corner = Path.of([[0, 0], [30, 0], [30, 40]])
    assert (corner.length, corner.closed, corner.scaled(3).length) == (70, False, 210)
    assert corner.at([-5, 80])[0].tolist() == [[-5, 0], [30, 50]]  # straight on beyond its ends
    assert Path.of([[0, 0], [30, 0], [30, 40]], closed=True).length == 120
    assert Path.of(corner) is corner


@pytest.mark.parametrize(
    ("curve", "message"),
    [
        ([[0, 0], [np.nan, 1]], "not finite"),
        ([[0, 0], [np.inf, 1]], "not finite"),
        ([[3, 3], [3, 3]], "no length"),
        ([[3, 3]], "no length"),
        ([[0, 0], [1e-300, 0]], "no length"),
        ([[0, 0], [1e300, 0]], "above 1e"),
        ([], "polyline"),
        ([1, 2, 3], "polyline"),
        ([[[0, 0], [1, 0], [2, 0], [3, 0]], [[5, 0], [6, 0], [7, 0], [8, 0]]], "a gap of 2"),
    ],
)
def test_what_is_no_path_is_refused(curve: list[float], message: str) -> None:
    with pytest.raises(GlyphsplineError, match=message):
        Path.of(curve)


def test_arguments_of_a_path_are_checked() -> None:
    path = Path.of([[0, 0], [30, 0]])
    for bad in (0, -1, np.nan, np.inf):
        with pytest.raises(OptionError, match="scale"):
            path.scaled(bad)
    with pytest.raises(OptionError, match="finite"):
        path.at([0, np.nan])
    with pytest.raises(OptionError, match="plane"):
        Path.of(gs.Spline(np.ones((4, 4)), np.arange(5.0)))


@pytest.mark.parametrize(
    ("shape", "length", "closed", "start"),
    [
        ('<path id="c" d="M0 0H30V40"/>', 70, False, [0, 0]),
        ('<path id="c" d="M0 0H30V40Z"/>', 120, True, [0, 0]),
        ('<path id="c" d="M0 0H30V40L0 0"/>', 120, True, [0, 0]),
        ('<defs><path id="c" d="M0 0L3 4"/></defs>', 5, False, [0, 0]),
        ('<g transform="scale(2)"><path id="c" transform="translate(1 2)" d="M0 0L3 4"/></g>', 10, False, [2, -4]),
        ('<path id="c" style="display:none" d="m1 2q0 0 3 4"/>', 5, False, [1, -2]),
        ('<line id="c" x1="1" y1="2" x2="4" y2="6"/>', 5, False, [1, -2]),
        ('<polyline id="c" points="0,0 30,0 30,40"/>', 70, False, [0, 0]),
        ('<polygon id="c" points="0,0 30,0 30,40"/>', 120, True, [0, 0]),
        ('<rect id="c" x="5" width="30" height="40"/>', 140, True, [5, 0]),
        ('<circle id="c" cx="7" r="10"/>', 20 * np.pi, True, [17, 0]),
    ],
)
def test_shapes_are_found_by_their_id(
    tmp_path: FilePath, shape: str, length: float, closed: bool, start: list[float]
) -> None:
    file = drawing(tmp_path, '<path id="other" d="M0 0H1"/>' + shape)
    path = open_path(f"{file}#c")
    assert path.length == pytest.approx(length, rel=1e-8)
    assert path.closed is closed
    np.testing.assert_allclose(path.at(0)[0], start, atol=1e-12)
    assert open_path(drawing(tmp_path, shape, "alone")).length == path.length  # the only one needs no id


@pytest.mark.parametrize(
    ("content", "place", "message"),
    [
        ('<path id="a" d="M0 0H1"/><path id="b" d="M0 0H1"/>', "", "2 shapes, say which by #id: a, b"),
        ('<path id="a" d="M0 0H1"/>', "#x", "no shape has this id; there are: a"),
        ('<path d="M0 0H1"/>', "#x", "none has an id"),
        ('<path id="a" d="M0 0H1"/><path id="a" d="M0 0H1"/>', "#a", "2 shapes have this id"),
        ("<text>A</text>", "", "no shape"),
        ('<path id="a" d="M0 0H1M3 3H4"/>', "#a", "of 2 pieces"),
        ('<path id="a" d="M5 5"/>', "#a", "no length"),
        ('<path id="a" d="M5 5L5 5Z"/>', "#a", "no length"),
        ('<path id="a" d=""/>', "#a", "no length"),
        ('<path id="a" d="M0 0L1e999 1"/>', "#a", "not finite"),
        ('<path id="a" d="M0 0L nan 1"/>', "#a", "broken path"),
        ('<path id="a" d="M"/>', "#a", "begins nowhere"),
        ('<circle id="a" r="ten"/>', "#a", "broken path"),
    ],
)
def test_bad_paths_are_refused_by_file_and_id(tmp_path: FilePath, content: str, place: str, message: str) -> None:
    file = drawing(tmp_path, content)
    with pytest.raises(GlyphsplineError, match=message) as caught:
        open_path(file + place)
    assert f"{file}{place}: " in str(caught.value)


def test_files_that_are_no_drawings_are_refused(tmp_path: FilePath) -> None:
    with pytest.raises(FontError, match="cannot be read"):
        open_path(tmp_path / "none.svg#a")
    (tmp_path / "bad.svg").write_text(f'<!DOCTYPE svg [<!ENTITY a "M0 0h9">]><svg {NAMESPACE}><path d="&a;"/></svg>')
    with pytest.raises(FontError, match="entities"):
        open_path(tmp_path / "bad.svg")
    strange = drawing(tmp_path, '<path d="M0 0H1"/>', "a#b")
    assert open_path(strange).length == pytest.approx(1)  # a file with a # in its name is a file


def test_letters_stand_with_their_middles_on_a_circle() -> None:
    """Exactly, against the angles of a circle run clockwise: letters point outwards."""
    layout = placed([400, 600, 200], [0, 1, 2])
    path = Path.of(circle(1000, 64, turn=-1), closed=True)
    result = along(layout, path, offset=100)
    middle = np.array([200, 700, 1100]) + 100
    np.testing.assert_allclose(result.angle, (-np.pi / 2 - middle / 1000 + np.pi) % (2 * np.pi) - np.pi, atol=1e-8)
    on = 1000 * np.exp(-1j * middle / 1000)
    expected = on - layout.advance / 2 * np.exp(1j * result.angle)
    np.testing.assert_allclose(result.origin, np.stack([expected.real, expected.imag], axis=1), atol=1e-5)
    left, bottom, right, top = result.box
    corners = on[0] + np.exp(1j * result.angle[0]) * np.array([-200 - 200j, 200 + 800j, -200 + 800j, 200 - 200j])
    assert left <= corners.real.min()
    assert bottom <= corners.imag.min()
    assert right >= corners.real.max()
    assert top >= corners.imag.max()


def test_text_is_aligned_moved_and_reversed() -> None:
    layout = placed([400, 600], [0, 1])
    path = Path.of([[0, 0], [3000, 0]])
    aligned: tuple[tuple[Align, float], ...] = (("start", 0), ("center", 1000), ("end", 2000))
    for align, first in aligned:
        assert along(layout, path, align=align).origin[:, 0].tolist() == [first, first + 400]
    assert along(layout, path, offset=50, align="center").origin[0].tolist() == [1050, 0]
    other = along(layout, path, side="right")
    np.testing.assert_allclose(other.origin, [[3000, 0], [2600, 0]], atol=1e-9)
    np.testing.assert_allclose(np.abs(other.angle), np.pi)


def test_justified_letters_take_the_paths_length() -> None:
    layout = placed([400, 600, 500], [0, 1, 2])
    line = along(layout, Path.of([[0, 0], [2500, 0]]), align="justify")
    assert line.origin[:, 0].tolist() == [0, 900, 2000]
    assert along(layout, Path.of([[0, 0], [1500, 0]]), align="justify").origin[:, 0].tolist() == [0, 400, 1000]
    ring = Path.of(circle(1000, 64, turn=-1), closed=True)
    turns = np.diff(np.unwrap(along(layout, ring, align="justify").angle))
    gap = (ring.length - 1500) / 3
    np.testing.assert_allclose(-1000 * turns, [500 + gap, 550 + gap], rtol=1e-6)


@pytest.mark.parametrize(("at", "up"), [("top", 1), ("bottom", -1)])
def test_a_circle_begins_opposite_the_place_of_its_text(at: Any, up: int) -> None:
    path = Path.circle(2000, at)
    assert path.closed
    assert path.length == pytest.approx(2000 * np.pi, rel=1e-8)
    points, tangents = path.at([0, path.length / 2, 3 * path.length / 4])
    np.testing.assert_allclose(points[:2], [[0, -1000 * up], [0, 1000 * up]], atol=1e-4)
    np.testing.assert_allclose(tangents[1], [1, 0], atol=1e-8)
    np.testing.assert_allclose(np.hypot(*points.T), 1000, rtol=1e-7)
    for wrong in ((0, "top"), (2, "left")):
        with pytest.raises(OptionError):
            Path.circle(*wrong)


@pytest.mark.parametrize(
    ("attributes", "start", "end"),
    [
        ('width="200mm" height="200mm" viewBox="0 0 200 200"', (0, 0), (100, 0)),
        ('width="20cm" viewBox="10 0 200 100"', (-10, 0), (90, 0)),
        ('height="200mm" viewBox="0 0 100 100"', (0, 0), (200, 0)),
        ('width="400mm" height="200mm" viewBox="0 0 100 100"', (100, 0), (300, 0)),
        ('width="400mm" height="200mm" viewBox="0 0 100 100" preserveAspectRatio="xMinYMax"', (0, 0), (200, 0)),
        ('width="400mm" height="200mm" viewBox="0 0 100 100" preserveAspectRatio="none"', (0, 0), (400, 0)),
        ('width="400mm" height="200mm" viewBox="0 0 100 100" preserveAspectRatio="xMaxYMin slice"', (0, 0), (400, 0)),
        ('width="200mm" height="100%" viewBox="0 0 200 200" transform="scale(2)"', (0, 0), (200, 0)),
    ],
)
def test_view_box_and_units_of_a_drawing_are_read(
    tmp_path: FilePath, attributes: str, start: tuple[float, float], end: tuple[float, float]
) -> None:
    file = tmp_path / "curve.svg"
    file.write_text(f'<svg {NAMESPACE} {attributes}><path d="M0 0H100"/></svg>')
    points, _ = (path := open_path(file)).at([0, path.length])
    np.testing.assert_allclose(points * 25.4 / 96, [start, end], atol=1e-9)


def test_a_drawing_in_a_drawing_has_a_view_of_its_own(tmp_path: FilePath) -> None:
    inner = '<svg x="30" y="20" width="50" height="50" viewBox="0 0 100 100"><path id="p" d="M0 0H100"/></svg>'
    path = open_path(drawing(tmp_path, inner))
    np.testing.assert_allclose(path.at([0, path.length])[0], [[30, -20], [80, -20]], atol=1e-9)


def test_marks_stay_on_their_letters() -> None:
    """Left to right and right to left, in a cluster and beside it: marks have no advance of their own."""
    path = Path.of(circle(900, 64, turn=-1), closed=True)
    for advances, clusters, offsets, bases in (
        ([500, 0, 400], [0, 0, 2], [0, -300, 0], [0, 0, 2]),
        ([500, 0, 0, 400], [0, 1, 2, 3], [0, -300, -250, 0], [0, 0, 0, 3]),
        ([0, 500, 0, 400], [3, 2, 1, 0], [30, 0, 45, 0], [1, 1, 3, 3]),
        ([0, 500], [0, 0], [40, 0], [1, 1]),
    ):
        layout = placed(advances, clusters, offsets)
        result = along(layout, path)
        assert (result.angle == result.angle[bases]).all()
        turn = np.exp(-1j * result.angle)
        before, after = (line.origin @ [1, 1j] for line in (layout, result))
        np.testing.assert_allclose((after - after[bases]) * turn, before - before[bases], atol=1e-6)
        wide = np.array(advances) > 0
        middle = after[wide] + np.array(advances)[wide] / 2 / turn[wide]
        np.testing.assert_allclose(np.abs(middle), 900, atol=1e-5)


def test_a_cluster_of_several_wide_glyphs_turns_as_one() -> None:
    letters = letters_of(placed([300, 200, 500], [0, 0, 2]))
    assert letters.of.tolist() == [0, 0, 1]
    assert letters.middle.tolist() == [250, 750]
    alone = letters_of(placed([0], [0]))
    assert alone.middle.tolist() == [0]
    assert len(along(placed([300], [0]), Path.of([[0, 0], [1000, 0]]))) == 1


def test_a_closed_path_goes_round() -> None:
    path = Path.of(circle(1000, 64), closed=True)
    round_it = placed([500] * 12, list(range(12)))
    a, b = along(round_it, path), along(round_it, path, offset=path.length)
    np.testing.assert_allclose(a.origin, b.origin, atol=1e-6)
    with pytest.raises(GlyphsplineError, match=r"1 of 13 letters does not fit, 'm'"):
        along(placed([500] * 13, list(range(13))), path)


def test_text_that_is_too_long_says_how_many_letters_do_not_fit() -> None:
    path = replace(Path.of([[0, 0], [1000, 0]]), name="curve.svg#c")
    layout = placed([300] * 5, list(range(5)))
    with pytest.raises(GlyphsplineError, match=r"1500 units long and the path 1000: 2 of 5 letters do not fit, 'de'"):
        along(layout, path)
    with pytest.raises(GlyphsplineError, match=r"curve\.svg#c"):
        bend(layout, path, 0.1)
    along(placed([300] * 3 + [200], [0, 1, 2, 3]), path)  # the last one's middle is on the path
    along(placed([300] * 3 + [400], [0, 1, 2, 3], said="abc "), path)  # a space needs no path


def test_what_cannot_stand_on_a_path_is_refused() -> None:
    path, layout = Path.of([[0, 0], [9000, 0]]), placed([300, 300], [0, 1])
    with pytest.raises(GlyphsplineError, match="2 lines"):
        along(replace(layout, line=np.array([0, 1])), path)
    columns = replace(layout, vertical=True)
    with pytest.raises(GlyphsplineError, match="columns"):
        along(columns, path)
    for arguments in ({"offset": np.nan}, {"offset": "a"}, {"align": "middle"}, {"side": "top"}):
        with pytest.raises(OptionError):
            along(layout, path, **arguments)
    for tolerance in (0, -1, np.nan):
        with pytest.raises(OptionError, match="tolerance"):
            bend(layout, path, tolerance)


def test_on_a_straight_path_a_bend_is_the_identity() -> None:
    layout = text()
    flat = layout.outline()
    bent = bend(layout, Path.of([[100, 50], [6100, 50]]), 0.1)
    assert bent.snapped - flat.snapped < 1e-8
    assert len(bent.contours) == len(flat.contours)
    for a, b in zip(flat.contours, bent.contours, strict=True):
        np.testing.assert_allclose(a.cubics() + np.array([100, 50]), b.cubics(), atol=1e-8)
        assert ((a.degrees == 1) == (b.degrees == 1)).all()


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("tolerance", [1.0, 0.1, 0.01])
def test_on_a_circle_a_bend_is_the_polar_map_within_the_tolerance(turn: int, tolerance: float) -> None:
    """Distances both ways, of dense samples, for a circle run inside and outside."""
    radius, layout = 1600.0, text("Og")
    flat, bent = layout.outline(), bend(layout, Path.of(circle(radius, 64, turn=turn), closed=True), tolerance)
    assert flat.snapped < bent.snapped <= tolerance + 2 * flat.snapped
    seen = 0.0
    for points, found in zip(dense(flat), dense(bent), strict=True):
        polar = (radius - turn * points[:, 1]) * np.exp(1j * turn * points[:, 0] / radius)
        true = np.stack([polar.real, polar.imag], axis=1)
        seen = max(seen, distance(true, found), distance(found, true))
    assert seen <= bent.snapped + 2e-3  # samples are joined by chords


def test_a_larger_tolerance_takes_fewer_segments() -> None:
    layout, path = text("Og"), Path.of(circle(1600, 64), closed=True)
    counts = [sum(map(len, bend(layout, path, tolerance).contours)) for tolerance in (0.001, 0.1, 10)]
    assert counts[0] > counts[1] >= counts[2]
    assert counts[1] <= 1.3 * sum(map(len, layout.outline().contours))


@settings(max_examples=15, deadline=None)
@given(st.lists(st.floats(-250, 250), min_size=6, max_size=6), st.sampled_from([1.0, 0.1]))
def test_on_any_smooth_path_a_bend_is_within_its_bound(heights: list[float], tolerance: float) -> None:
    """Against the map itself, by the path's own frame, at dense samples."""
    across = np.stack([np.arange(8) * 1500.0, [0, *(4 * h for h in heights), 0]], axis=1)
    path = Path.of(gs.interpolate(across, closed=False).spline)
    layout = text("gO")
    try:
        bent = bend(layout, path, tolerance, align="center")
    except GlyphsplineError as error:
        refused = str(error)
    else:
        refused = ""
    if refused:
        assert "fold over" in refused or "bends too sharply" in refused
        return
    flat, start = layout.outline(), (path.length - layout.advance.sum()) / 2
    for points, found in zip(dense(flat), dense(bent), strict=True):
        on, tangent = path.at(points[:, 0] + start)
        true = on + points[:, 1:] * np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
        assert max(distance(true, found), distance(found, true)) <= bent.snapped + 5e-3


def test_smooth_joints_stay_smooth_and_corners_stay_corners() -> None:
    layout = text("O8a")
    flat, bent = layout.outline(), bend(layout, Path.of(circle(1500, 64), closed=True), 0.1)
    for before, after in zip(flat.contours, bent.contours, strict=True):
        turns = np.abs(joins(before).turns)
        found = np.abs(joins(after).turns)
        for least in (1e-3, 0.02, 0.2):  # the map turns the two arms of a corner by much the same
            assert (found > 2 * least).sum() <= (turns > least).sum() <= (found > least / 2).sum()
        smooth = np.sort(found)[: len(found) - int((turns > 1e-9).sum())]
        assert smooth.max(initial=0) < 1e-6


def test_where_curvature_jumps_the_map_is_followed() -> None:
    """A line and an arc that touch: slanted strokes get the corner that the map has, and the bound holds."""
    arc = circle(2000, 64)[:16]
    arc = np.stack([arc[..., 1], 2000 - arc[..., 0]], axis=-1)  # from (0, 0), to the right and up
    line = np.array([[[-300, 0], [-200, 0], [-100, 0], [0, 0]]])
    path = Path.of(np.concatenate([line, arc]))
    layout = text("Og")
    bent = bend(layout, path, 0.1)
    for points, found in zip(dense(layout.outline()), dense(bent), strict=True):
        x, y = points.T
        angle = np.maximum(x - 300, 0) / 2000
        true = np.stack(
            [(2000 - y) * np.sin(angle) + np.minimum(x - 300, 0), 2000 - (2000 - y) * np.cos(angle)], axis=1
        )
        assert distance(true, found) <= bent.snapped + 2e-3
        # Back to the line of text, where samples do not cut a corner off: that stretches by less than 2.
        x, y = found.T
        on_arc = 300 + 2000 * np.arctan2(x, 2000 - y)
        back = np.where(x < 0, [x + 300, y], [on_arc, 2000 - np.hypot(x, 2000 - y)]).T
        assert distance(back, points) <= 2 * bent.snapped + 2e-3


def test_small_kinks_are_rounded_and_corners_refused() -> None:
    layout = text("Og")
    kinked = Path.of([[0, 0], [500, 0], [1500, 20], [3000, 20]])
    bent = bend(layout, kinked, 0.1)
    (note,) = bent.notes
    assert "kinks of the path are rounded" in note
    rounded = kinked.rounded(4000)
    assert np.abs(rounded.joints[1]).max() < 1e-9
    assert 0 < rounded.moved < 1.0
    s = np.linspace(0, 1, 2000)
    ours, theirs = (path.at(s * path.length)[0] for path in (rounded, kinked))
    assert np.hypot(*(ours - theirs).T).max() <= rounded.moved + 0.01
    ring = Path.of(1000 * np.stack([np.cos(angles := np.arange(64) * np.pi / 32), np.sin(angles)], axis=1), closed=True)
    smooth = ring.rounded(1000)
    assert np.abs(smooth.joints[1]).max() < 1e-9
    assert np.abs(smooth.at(0)[0] - ring.at(0)[0]).max() <= smooth.moved < 3  # the sagitta is 1.2
    bend(layout, ring, 0.1, side="right", offset=-300)
    corner = replace(Path.of([[0, 0], [200, 0], [3000, 2000]]), name="curve.svg#c")
    with pytest.raises(GlyphsplineError, match=r"curve.svg#c: a corner of 35\.5 degrees at length 200, under 'O'"):
        bend(layout, corner, 0.1)
    assert along(layout, corner).angle[1] == pytest.approx(np.arctan2(2000, 2800))


def test_paths_with_cusps_and_many_points_are_measured_and_refused_or_bent() -> None:
    layout = text("Og")
    sampled = np.stack([np.linspace(0, 6000, 3000), 500 * np.sin(np.linspace(0, 6, 3000))], axis=1)
    assert bend(layout, Path.of(sampled), 0.1).snapped <= 0.11
    cusp = Path(np.array([[[0.0, 0], [3000, 3000], [0, 3000], [3000, 0]]]))
    assert cusp.length_error < 1e-6 * cusp.length
    for s in (0.5 * cusp.length, [0.5 * cusp.length - 1e-9]):
        assert np.isfinite(cusp.at(s)[1]).all()
    assert np.isfinite(along(layout, cusp, align="center").origin).all()
    with pytest.raises(GlyphsplineError, match=r"bends too sharply|fold over"):
        bend(text("O"), cusp, 0.1, align="center")


def test_outlines_that_would_fold_over_are_named() -> None:
    layout = text("Og")
    height = float(layout.outline().arrays.points[:, 1].max())
    path = replace(Path.of(circle(0.8 * height, 64), closed=True), name="tight.svg")
    with pytest.raises(GlyphsplineError, match=rf"tight.svg: .*radius of {0.8 * height:.4g}.*'O'.* would fold over"):
        bend(layout, path, 0.1)
    bend(layout, path, 0.1, side="right")  # on the other side there is room


def test_a_bent_text_is_fitted_within_the_whole_tolerance() -> None:
    layout, path, options = text("Og"), Path.of(WAVE), gs.Options(tolerance=1.0)
    bent = bend(layout, path, SHARE * options.tolerance_for(1024), align="center")
    result = gs.convert(bent, options)
    for contour in result.contours:
        assert contour.measures.within_tolerance
        assert contour.measures.deviation_bound is not None
        assert contour.measures.deviation_bound >= bent.snapped


def test_what_readers_snapped_and_said_goes_on(tmp_path: FilePath) -> None:
    layout = text("Og")
    flat = layout.outline()
    assert flat.snapped == max(outline.snapped for outline in layout.outlines() if isinstance(outline, gs.Outline))
    said = replace(layout, notes=("no tables for shaping",))
    assert "no tables for shaping" in bend(said, Path.of(WAVE), 0.1).notes


def test_text_without_ink_bends_to_nothing() -> None:
    assert len(bend(text(" "), Path.of(WAVE), 0.1).contours) == 0


def test_shaped_text_stands_on_a_path(tmp_path: FilePath) -> None:
    """Right to left with joined letters, marks, a ligature, and fonts of two sizes; columns are refused."""
    font = gs.open_font(text_font(tmp_path / "text.ttf"))
    other = gs.open_font(text_font(tmp_path / "other.ttf", em=2000, family="Double"))
    path = Path.of(circle(2000, 64, turn=-1), closed=True)
    arabic = gs.layout(font, "\u0628\u0633\u0628")
    on = along(arabic, path)
    assert (np.diff(arabic.cluster) < 0).all()
    assert (np.diff(on.angle) < 0).all()  # the last letter comes first
    marked = along(gs.layout(font, "ffia\u0301"), path)
    assert letters_of(gs.layout(font, "ffia\u0301")).of.tolist() == [0, 1, 2, 2]
    assert marked.angle[2] == marked.angle[3]
    mixed = gs.layout(other, "a\u3042", fallbacks=[font])
    np.testing.assert_allclose(np.abs(along(mixed, path).outline().arrays.points @ [1, 1j]).min(), 2000, atol=20)
    assert len(bend(mixed, path, 0.1).contours) == len(mixed.outline().contours)
    for direction in ("ttb", "btt"):
        with pytest.raises(GlyphsplineError, match="columns"):
            along(gs.layout(font, "\u3042\u3042\u300c", direction=direction), path)
    with pytest.raises(GlyphsplineError, match="2 lines"):
        bend(gs.layout(font, "a\na"), path, 0.1)


def test_a_text_on_a_path_is_fitted_and_written(tmp_path: FilePath) -> None:
    layout = along(text("Og"), Path.of(WAVE), align="center")
    result = layout.convert(gs.Options(corners="sharp"))
    assert all(contour.measures.within_tolerance for contour in result.contours)
    assert "<svg" in gs.to_svg(result)
