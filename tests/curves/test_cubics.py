"""The compiled toolbox of cubics against plain NumPy and closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.compiled import compiled
from glyphspline.curves.bezier import evaluate, split
from glyphspline.curves.cubics import bernstein, length_table, section, turns
from glyphspline.curves.cubics import split as cut
from glyphspline.curves.nearest import near_place, search_place
from glyphspline.curves.spline_beziers import spline_beziers
from glyphspline.types import FloatArray
from tests.polygons import circle_contour, random_polygon, square_contour

CUBICS = np.random.default_rng(4).uniform(-100, 100, (5, 4, 2))


@compiled
def parts(cubic: FloatArray, x: float, y: float) -> FloatArray:
    """Both parts at x, and the section from x to y."""
    found = np.empty((3, 4, 2))
    for k in range(4):
        found[1, k, 0], found[1, k, 1] = cubic[k, 0], cubic[k, 1]
    cut(found[1], x, found[0])
    section(cubic, x, y, found[2])
    return found


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("n", [3, 4, 11])
def test_the_bezier_form_is_that_of_the_spline(closed: bool, n: int) -> None:
    spline = gs.interpolate(random_polygon(n, n), closed=closed).spline
    other = gs.interpolate(random_polygon(7, n), closed=not closed).spline
    both, kinds = (other, spline), np.array([not closed, closed])
    controls, knots = (np.concatenate(each) for each in zip(*((s.control_points, s.knots) for s in both), strict=True))
    pieces = [s.to_bezier() for s in both]
    form = spline_beziers(controls[:, None], knots, np.array([len(each) for each in pieces]), kinds)
    np.testing.assert_allclose(form[:, 0], np.concatenate(pieces), atol=1e-11)


@pytest.mark.parametrize("x", [0.0, 0.3, 1.0])
def test_parts_and_sections_are_pieces_of_the_cubic(x: float) -> None:
    for cubic in CUBICS:
        first, second, middle = parts(cubic, x, 0.8)
        expected = split(cubic, x)
        np.testing.assert_allclose([first, second], expected, atol=1e-12)
        t = np.linspace(0, 1, 5)
        there = evaluate(np.broadcast_to(cubic, (5, 4, 2)), x + (0.8 - x) * t)
        np.testing.assert_allclose(evaluate(np.broadcast_to(middle, (5, 4, 2)), t), there, atol=1e-11)


def test_the_nearest_place_is_as_near_as_any_within_its_segment() -> None:
    circle = circle_contour(100).cubics()
    places = np.linspace(0, 4, 4001)[:-1]
    points = evaluate(circle[places.astype(int)], places % 1)
    compared = 0
    for x, y in np.random.default_rng(1).uniform(-150, 150, (60, 2)):
        at = search_place(1, circle, 0.0, 4.0, np.array([[[x, y]]]), 0, 0)
        own = np.hypot(*(evaluate(circle[[int(at) % 4]], np.array([at % 1]))[0] - (x, y)))
        distances = np.hypot(*(points - (x, y)).T)
        assert own <= distances[::125].min()  # coarse places
        if 0.1 < places[distances.argmin()] % 1 < 0.9:
            assert own <= distances.min()
            compared += 1
    assert compared > 30


def test_turns_are_those_of_the_tangents_whatever_handles_have_no_length() -> None:
    np.testing.assert_allclose(turns(square_contour(10).cubics(), 0.0), np.pi / 2)
    np.testing.assert_allclose(turns(circle_contour(10).cubics(), 0.0), 0, atol=1e-12)
    np.testing.assert_allclose(turns(circle_contour(10).reversed().cubics(), 0.0), 0, atol=1e-12)
    bent = square_contour(10).cubics()
    bent[:, 1], bent[:, 2] = bent[:, 0], bent[:, 3]
    np.testing.assert_allclose(turns(bent, 0.0), np.pi / 2)
    np.testing.assert_allclose(turns(bent[::-1, ::-1].copy(), 0.0), -np.pi / 2)


def test_lengths_add_up_to_the_circumference() -> None:
    table = length_table(circle_contour(100).cubics(), bernstein(64))
    assert len(table) == 4 * 64 + 1
    assert table[-1] == pytest.approx(200 * np.pi, rel=1e-3)
    assert (np.diff(table) > 0).all()


def test_inside_a_corner_the_same_side_is_the_nearest_wherever_it_lies() -> None:
    forward = set()
    for shift in ((0, 0), (37, -112), (1024, 2048), (333, -77), (-0.25, 0.1)):
        square = square_contour().cubics() + np.array(shift)
        for k in range(1, 4):
            inward = np.sign(square[:, 0].mean(axis=0) - square[k, 0])
            for depth in (0.11, 0.5, 0.87, 0.93):
                point = np.round(square[k, 0] + depth * inward, 2)
                place = near_place(1, square, float(k), k - 0.5, k + 0.5, np.tile(point, (1, 4, 1)), 0)
                assert abs(abs(place - k) * 100 - depth) < 1e-6
                forward.add(place > k)
    assert forward == {True}
