"""Significant extrema of curvature, and how much curvature varies: known shapes, invariances, a plain count."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import glyphspline as gs
from glyphspline.curves import fairness
from glyphspline.curves.bezier import derivative_points, evaluate, signed_curvature, split
from glyphspline.curves.fairness import SHARE, TURN, extrema_of
from glyphspline.fitting.measures import CORNER, extrema_floor
from glyphspline.types import FloatArray
from scripts.paper.measures import shape
from tests.drawings import circle, polygon_contour
from tests.places import FONTS
from tests.polygons import circle_contour, square_contour

QUARTER_TURN = np.array([[0.0, 1], [-1, 0]])


def extrema_within(cubics: FloatArray, length: float, corner: float = CORNER) -> int:
    values, _, n = fairness.curvatures(cubics, length, corner)
    return int(extrema_of(values, n, TURN / length if length else np.inf))


def extrema(cubics: FloatArray) -> int:
    cubics = np.ascontiguousarray(cubics, dtype=float)
    return extrema_within(cubics, shape(cubics).length)


def line(a: object, b: object) -> FloatArray:
    return np.linspace(np.array(a, dtype=float), np.array(b, dtype=float), 4)


def chain(*segments: object) -> FloatArray:
    return np.array(segments, dtype=float)


def stadium(side: float = 200.0) -> FloatArray:
    """Two half circles of two cubics each, joined by two lines."""
    quarters, shift = circle(50.0, 4), np.array([side, 0.0])
    right = quarters[[3, 0]] + shift
    return np.array([line((0, -50), (side, -50)), *right, line((side, 50), (0, 50)), *quarters[[1, 2]]])


def squircle(handle: float) -> FloatArray:
    """Four quarters whose handles are this share of their sides."""
    quarter = 100 * np.array([[1, 0], [1, handle], [handle, 1], [0, 1]])
    return np.array([quarter @ np.linalg.matrix_power(QUARTER_TURN, k) for k in range(4)])


def through(points: FloatArray) -> FloatArray:
    return gs.interpolate(points, fallback="peak").spline.to_bezier()


def polar(wave: object, n: int = 96) -> FloatArray:
    """A closed spline through points around the origin whose distance from it is 100 + ``wave``."""
    angle = 2 * np.pi * np.arange(n) / n
    radius = 100 + np.asarray(wave(angle))  # type: ignore[operator]
    return through(radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def quadratic_circle(n: int) -> FloatArray:
    """A circle as TrueType has it: n quadratics that touch it where they meet."""
    angle = 2 * np.pi * np.arange(n + 1) / n
    on = 100 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    off = (on[:-1] + on[1:]) / 2 / np.cos(np.pi / n) ** 2
    return gs.Contour.from_segments(np.stack([on[:-1], off, on[1:]], axis=1)).cubics()


SHAPES = {
    "circle": (circle_contour().cubics(), 0),
    "circle of many pieces": (circle(100.0), 0),
    "ellipse": (circle(100.0, 4) * [2, 1], 4),
    "nearly a circle": (circle(100.0) * [1.02, 1], 0),
    "superellipse": (squircle(0.75), 8),
    "diamond": (squircle(0.3), 8),
    "square": (square_contour().cubics(), 0),
    "triangle": (polygon_contour(np.array([[0.0, 0], [90, 10], [20, 80]])).cubics(), 0),
    "round of short lines": (polygon_contour(circle(100.0, 64)[:, 0]).cubics(), 0),
    "stadium": (stadium(), 4),
    "lens": (np.concatenate([circle(100.0, 8)[:2], circle(100.0, 8)[1::-1, ::-1] @ [[0.0, 1], [1, 0]]]), 0),
    "lump": (polar(lambda a: 6 * np.exp(-(((a - 3) / 0.15) ** 2))), 4),
    "dent": (polar(lambda a: -6 * np.exp(-(((a - 3) / 0.15) ** 2))), 4),
    "ripple too low to count": (polar(lambda a: 0.02 * np.cos(9 * a)), 0),
    "three waves": (polar(lambda a: 5 * np.cos(3 * a)), 6),
    "circle of quadratics": (quadratic_circle(8), 16),
}


@pytest.mark.parametrize(("cubics", "expected"), SHAPES.values(), ids=SHAPES.keys())
def test_known_shapes(cubics: FloatArray, expected: int) -> None:
    assert extrema(cubics) == expected


def bowl() -> FloatArray:
    """The spine of an S: two bowls that turn opposite ways, the extrema of curvature in their middles."""
    return chain([[0, 0], [80, 0], [80, 60], [0, 60]], [[0, 60], [-80, 60], [-80, 120], [0, 120]])


def test_ends_at_corners_do_not_count() -> None:
    spine = bowl()
    back = line(spine[-1, 3], spine[0, 0])
    assert extrema(np.array([*spine, back])) == 2
    assert extrema(np.array([spine[0], line((0, 60), (0, 0))])) == 1
    # A quarter of an ellipse from its flat end to its sharp end has no extremum inside.
    quarter = circle(100.0, 4)[0] * [2, 1]
    assert extrema(np.array([quarter, line(quarter[3], (0, 0)), line((0, 0), quarter[0])])) == 0


def test_an_s_counts_on_both_sides() -> None:
    spine = bowl()
    other = spine[::-1, ::-1] + [30.0, 0]
    ends = line(spine[-1, 3], other[0, 0]), line(other[-1, 3], spine[0, 0])
    assert extrema(np.array([*spine, ends[0], *other, ends[1]])) == 4


def test_rounded_corners_are_peaks_and_curvature_returns_beside_them() -> None:
    assert extrema_floor(square_contour().cubics(), 400.0)[1] == 8
    assert extrema_floor(circle(100.0), 600.0)[1] == 0
    quarter = circle(100.0, 4)[0] * [2, 1]  # from its sharp end, behind a corner that turns right, to its flat one
    falls = np.array([quarter, line((0, 100), (0, -30)), line((0, -30), (300, -30)), line((300, -30), (200, 0))])
    assert extrema_floor(falls, shape(falls).length)[:2] == (0, 8)
    quarter = circle(100.0, 4)[0] * [1, 2]  # from its flat end to its sharp one, as the corners have it
    rises = np.array([quarter, line((0, 200), (0, -30)), line((0, -30), (200, -30)), line((200, -30), (100, 0))])
    assert extrema_floor(rises, shape(rises).length)[:2] == (0, 6)


def test_the_corner_angle_decides_what_is_a_corner() -> None:
    quarter = circle(100.0, 4)[:1] * [2, 1]
    leaf = np.concatenate([quarter, [200, 100] - quarter])
    length = shape(leaf).length
    assert [extrema_within(leaf, length, float(np.cos(np.radians(angle)))) for angle in (89, 91)] == [0, 4]


def test_jumps_at_smooth_joints_are_part_of_the_curvature() -> None:
    large, small = circle(100.0, 4), circle(40.0, 4)
    sides = line((-100, 0), (-100, -50)), line((-60, -90), (60, -90)), line((100, -50), (100, 0))
    arch = [*large[:2], sides[0], small[2] + [-60, -50], sides[1], small[3] + [60, -50], sides[2]]
    assert extrema(np.array(arch)) == 6


HARD = {
    "cusp": [[0, 0], [100, 100], [0, 100], [100, 0]],
    "nearly a cusp": [[0, 0], [100.0001, 100], [0, 100], [100, 0]],
    "nearly, and it loops": [[0, 0], [100.01, 100], [-0.01, 100], [100, 0]],
    "handle on its end": [[0, 0], [0, 0], [50, 100], [100, 0]],
    "both handles on their ends": [[0, 0], [0, 0], [100, 0], [100, 0]],
    "turns back on itself": [[0, 0], [100, 0], [0, 0], [100, 0]],
    "three points in one": [[0, 0], [0, 0], [0, 0], [100, 0]],
}
COUNTS = dict(zip(HARD, (1, 1, 1, 2, 0, 0, 0), strict=True))


@pytest.mark.parametrize("kind", HARD)
def test_cusps_and_lines_of_odd_handles(kind: str) -> None:
    hard = np.array(HARD[kind], dtype=float)
    sides = line((100, 0), (50, -80)), line((50, -80), (0, 0))
    assert extrema(np.array([hard, *sides])) == COUNTS[kind]
    assert extrema(np.array([hard[::-1], *[side[::-1] for side in sides[::-1]]])) == COUNTS[kind]


def test_pieces_of_no_length_change_nothing() -> None:
    for cubics, expected in SHAPES.values():
        points = [np.broadcast_to(cubic[3], (4, 2)) for cubic in cubics]
        assert extrema(np.stack([cubics, points], axis=1).reshape(-1, 4, 2)) == expected
        fuzz = 1e-13 * np.random.default_rng(0).standard_normal((len(cubics), 4, 2))
        assert extrema(np.stack([cubics, np.array(points) + fuzz], axis=1).reshape(-1, 4, 2)) == expected


def test_nothing_has_none() -> None:
    assert extrema_within(np.empty((0, 4, 2)), 0.0) == 0
    assert extrema_within(np.ones((3, 4, 2)), 0.0) == 0


def blob(numbers: list[int]) -> FloatArray:
    """A closed spline around the origin that may have near-cusps, with corners where lines are set in."""
    angle = 2 * np.pi * np.arange(len(numbers)) / len(numbers)
    radius = 20.0 + 10 * np.array(numbers)
    return through(radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))


numbers = st.lists(st.integers(0, 12), min_size=5, max_size=24)


@example([1, 8, 0, 8, 1, 12], 0, 0.0, 0.0, False)  # a spike whose end is nearly an extremum
@given(numbers, st.integers(0, 23), st.floats(-3, 3), st.floats(0, 6.3), st.booleans())
def test_start_direction_side_angle_place_scale_and_cuts_do_not_matter(
    radii: list[int], start: int, power: float, angle: float, cornered: bool
) -> None:
    cubics = blob(radii)
    if cornered:
        cubics[0] = line(cubics[0, 0], cubics[0, 3])
    expected = extrema(cubics)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    assert extrema(np.roll(cubics, start, axis=0)) == expected
    assert extrema(cubics[::-1, ::-1]) == expected
    assert extrema(cubics * [1, -1]) == expected
    assert extrema(cubics @ turn + [300, -70]) == expected
    assert extrema(cubics * 10**power) == expected
    assert extrema(np.stack(split(cubics), axis=1).reshape(-1, 4, 2)) == expected


def curvatures(cubics: FloatArray, steps: int) -> FloatArray:
    """Signed curvature at even parameters of each piece in order."""
    x = np.tile(np.linspace(0, 1, steps + 1), len(cubics))
    rows = np.repeat(np.arange(len(cubics)), steps + 1)
    return signed_curvature(*(evaluate(derivative_points(cubics, order)[rows], x) for order in (1, 2)))


def most_alternations(values: FloatArray, least: float) -> int:
    """The definition word for word, for every first place: the longest cyclic sequence that falls and rises."""
    n, most = len(values), 0
    sizes = np.abs(values)
    for start in range(n):
        v, size = np.roll(values, -start), np.roll(sizes, -start)
        high, low = np.zeros(n), np.full(n, -np.inf)  # the longest sequence from place 0 that ends high or low here
        high[1:] = -np.inf
        for i in range(1, n):
            enough = np.maximum(SHARE * np.maximum(size[:i], size[i]), least)
            low[i] = np.where(v[:i] - v[i] >= enough, high[:i] + 1, -np.inf).max()
            high[i] = np.where(v[i] - v[:i] >= enough, low[:i] + 1, -np.inf).max()
        closes = v[0] - v >= np.maximum(SHARE * np.maximum(size, size[0]), least)
        most = max(most, int(max(np.where(closes, low + 1, 0).max(), 0)))
    return most


@given(st.lists(st.integers(0, 8), min_size=5, max_size=7))
def test_agrees_with_the_longest_sequence_of_samples(radii: list[int]) -> None:
    cubics = blob(radii)
    found = most_alternations(curvatures(cubics, 12), TURN / shape(cubics).length)
    assert abs(extrema(cubics) - found) <= 2  # samples may miss a peak
    assert extrema(cubics) >= found


def test_measures_of_glyphs() -> None:
    """An 'o' of cubics and one of quadratics: each of those has a peak of its own."""
    for file, expected in (("variable-cff2.otf", 0), ("variable.ttf", 16)):
        font = gs.open_font(FONTS / file)
        outline = font.outline(font.select(text="o")[0])
        for options in (gs.Options(), gs.Options(corners="sharp")):
            for contour in gs.convert(outline, options).contours:
                assert contour.measures.source_curvature_extrema == expected
                assert contour.measures.curvature_extrema == extrema(contour.curve.cubics())


def test_not_computed_without_measuring() -> None:
    outline = gs.Outline("o", contours=(circle_contour(),))
    for measure in (False, True):
        measures = gs.convert(outline, gs.Options(count=8, measure=measure)).contours[0].measures
        assert measures.curvature_extrema == measures.source_curvature_extrema == (0 if measure else None)
