"""Splines against SciPy, against closed forms, and against their own Bézier form."""

from __future__ import annotations

import numpy as np
import pytest
from fontTools.pens.recordingPen import RecordingPen

import glyphspline as gs
from glyphspline.curves.bezier import derivative_points, evaluate
from glyphspline.interpolation.polygon import closed_knots, vertex_centres, vertex_parameters
from glyphspline.types import FloatArray
from tests.polygons import ellipse, random_polygon


def some_spline(degree: int, closed: bool, n: int = 9) -> gs.Spline:
    rng = np.random.default_rng([degree, closed, n])
    knots = np.concatenate([[0.0], np.cumsum(rng.uniform(0.1, 2, n))])
    return gs.Spline(rng.normal(size=(n if closed else n + degree, 2)), knots, degree, closed)


every_kind = pytest.mark.parametrize(("degree", "closed"), [(d, c) for d in range(2, 7) for c in (True, False)])


@every_kind
def test_values_and_derivatives_are_scipys(degree: int, closed: bool) -> None:
    s = some_spline(degree, closed)
    t = np.linspace(0, s.period * (1 - 1e-9), 200)
    oracle = s.to_scipy()
    for order in range(degree):
        scale = np.abs(oracle(t, order)).max()
        np.testing.assert_allclose(s(t, derivative=order), oracle(t, order), atol=1e-12 * scale)


@every_kind
def test_bezier_pieces_are_the_curve(degree: int, closed: bool) -> None:
    s = some_spline(degree, closed)
    pieces = s.to_bezier()
    x = np.linspace(0, 1, 11)[1:-1]
    for piece, a, b in zip(pieces, s.knots, s.knots[1:], strict=False):
        on_piece = evaluate(np.repeat(piece[None], len(x), axis=0), x)
        np.testing.assert_allclose(on_piece, s(a + x * (b - a)), atol=1e-13)


@every_kind
def test_pieces_join_with_all_derivatives_but_the_last(degree: int, closed: bool) -> None:
    s = some_spline(degree, closed)
    step = 1e-7 * s.period
    joins = s.knots[:-1] if closed else s.knots[1:-1]
    for order in range(degree):
        jump = s(joins + step, derivative=order) - s(joins - step, derivative=order)
        slope = np.abs(s(np.linspace(0, s.period, 300), derivative=order + 1)).max()
        assert np.abs(jump).max() <= 4 * step * slope


def with_multiple_knots(degree: int, seam: int) -> gs.Spline:
    """A closed spline with knots of all multiplicities; ``seam`` of those at 0 stand at the end."""
    rng = np.random.default_rng([degree, seam])
    breaks = np.concatenate([[0.0], np.cumsum(rng.uniform(0.2, 2, degree + 2))])
    times = [max(seam + 1, 2), *range(1, degree + 1), 1]
    knots = np.concatenate([np.repeat(breaks[:-1], times)[seam:], np.full(seam + 1, breaks[-1])])
    return gs.Spline(rng.normal(size=(sum(times), 2)), knots, degree)


@pytest.mark.parametrize(("degree", "seam"), [(d, s) for d in range(2, 7) for s in range(d)])
def test_multiple_knots_from_both_sides(degree: int, seam: int) -> None:
    s = with_multiple_knots(degree, seam)
    clamped, oracle, pieces = s.clamped(), s.to_scipy(), s.to_bezier()
    breaks = np.unique(s.knots)
    t = np.concatenate([np.linspace(0, s.period, 200, endpoint=False), breaks[:-1]])
    assert len(pieces) == len(breaks) - 1
    np.testing.assert_allclose(s.basis(t) @ s.control_points, s(t), atol=1e-12)
    for order in range(degree + 1):
        scale = np.abs(oracle(t, order)).max()
        np.testing.assert_allclose(s(t, order), oracle(t, order), atol=1e-11 * scale)
        np.testing.assert_allclose(clamped(t, order), s(t, order), atol=1e-10 * scale)
        of_pieces = derivative_points(pieces, order) / np.diff(breaks)[:, None, None] ** order
        np.testing.assert_allclose(s(breaks[:-1], order), of_pieces[:, 0], atol=1e-11 * scale)
        np.testing.assert_allclose(s(breaks[1:], order, side="left"), of_pieces[:, -1], atol=1e-11 * scale)
        np.testing.assert_allclose(s(0.0, order, side="left"), of_pieces[-1, -1], atol=1e-11 * scale)
        for at in breaks[:-1]:  # degree - multiplicity derivatives are continuous
            times = np.count_nonzero(s.knots[:-1] == at) + (np.count_nonzero(s.knots == s.period) - 1) * (at == 0)
            jump = np.abs(s(at, order) - s(at, order, side="left")).max()
            assert (jump < 1e-10 * scale) == (order <= degree - times)


def test_the_control_point_of_a_triple_knot_is_on_the_curve() -> None:
    square = [[0, 0], [1, 0], [2, 0], [3, 0], [3, 1], [3, 2], [3, 3], [2, 3], [1, 3], [0, 3], [0, 2], [0, 1]]
    s = gs.Spline(np.array(square), np.array([0, 0, 3, 3, 3, 6, 6, 6, 9, 9, 9, 12, 12.0]))
    assert s([0, 3, 6, 9]).tolist() == [[0, 0], [3, 0], [3, 3], [0, 3]]
    assert s(3, 1).tolist() == [0, 1]
    assert s(3, 1, side="left").tolist() == [1, 0]
    assert s.curvature([0, 1, 3]).tolist() == [0, 0, 0]
    pen = RecordingPen()
    s.draw(pen)
    assert len(pen.value) == 6
    with pytest.raises(gs.OptionError, match="left or right"):
        s(0, side="up")  # type: ignore[arg-type]


def test_closed_curve_wraps_and_open_curve_ends_on_its_control_points() -> None:
    s = some_spline(3, True)
    np.testing.assert_allclose(s(np.array([-0.3, 0.4]) + 2 * s.period), s(np.array([-0.3, 0.4])), atol=1e-12)
    o = some_spline(3, False)
    np.testing.assert_allclose(o(np.array([0, o.period])), o.control_points[[0, -1]], atol=1e-14)


@pytest.mark.parametrize("n", [3, 4])
def test_basis_sums_its_wraps_on_few_vertices(n: int) -> None:
    s = some_spline(3, True, n)
    t = np.linspace(0, s.period, 50)
    basis = s.basis(t)
    np.testing.assert_allclose(basis.sum(axis=1), 1)
    np.testing.assert_allclose(basis @ s.control_points, s(t), atol=1e-13)


def test_curvature_of_a_circle_is_one_over_its_radius_and_positive_to_the_left() -> None:
    for r in (0.5, 40.0):
        circle = gs.interpolate(ellipse(200, r, r), residual_tolerance=1e-12 * r)
        t = np.linspace(0, circle.spline.period, 333)
        np.testing.assert_allclose(circle.spline.curvature(t), 1 / r, rtol=2e-3)
        clockwise = gs.interpolate(ellipse(200, r, r)[::-1], residual_tolerance=1e-12 * r)
        np.testing.assert_allclose(clockwise.spline.curvature(t), -1 / r, rtol=2e-3)


def test_curvature_where_the_curve_stands_still_is_infinite_not_nan() -> None:
    cusp = gs.Spline(np.array([[0, 0], [1, 1], [1, 1], [1, 1], [2, 0]], dtype=float), np.arange(6.0), 3)
    t = np.linspace(0, 5, 51)
    assert not np.isnan(cusp.curvature(t)).any()
    assert np.isinf(cusp.curvature(2.0))


@pytest.mark.parametrize("closed", [True, False])
def test_drawing_degree_2_and_3_is_exact(closed: bool) -> None:
    for degree, operator in ((2, "qCurveTo"), (3, "curveTo")):
        s = some_spline(degree, closed)
        pen = RecordingPen()
        s.draw(pen)
        start, *curves, end = pen.value
        assert start[0] == "moveTo"
        assert end[0] == ("closePath" if closed else "endPath")
        assert {name for name, _ in curves} == {operator}
        drawn = np.array([points for _, points in curves])
        np.testing.assert_array_equal(drawn[:-1], s.to_bezier()[:-1, 1:])
        np.testing.assert_allclose(drawn[-1], s.to_bezier()[-1, 1:], atol=1e-14)
        if closed:
            assert curves[-1][1][-1] == start[1][0]


@pytest.mark.parametrize("degree", [4, 5, 6])
def test_drawing_higher_degrees_stays_within_the_stated_error(degree: int) -> None:
    s = some_spline(degree, True)
    for tolerance in (1e-1, 1e-3, 1e-5):
        pen = RecordingPen()
        s.draw(pen, tolerance)
        on_curve = [pen.value[0][1][0]] + [points[-1] for name, points in pen.value[1:-1]]
        cubics = np.array([[a, *points] for a, (_, points) in zip(on_curve, pen.value[1:-1], strict=False)])
        x = np.linspace(0, 1, 9)
        drawn = evaluate(np.repeat(cubics, len(x), axis=0), np.tile(x, len(cubics)))
        assert distance_to_curve(s, drawn).max() <= tolerance + 1e-6  # sagitta of the dense polyline


def distance_to_curve(s: gs.Spline, points: FloatArray) -> FloatArray:
    dense = s(np.linspace(0, s.period, 20001))
    chords = np.diff(dense, axis=0)
    found = []
    for p in points:
        along = np.clip(((p - dense[:-1]) * chords).sum(axis=1) / (chords**2).sum(axis=1), 0, 1)
        found.append(np.hypot(*(dense[:-1] + along[:, None] * chords - p).T).min())
    return np.array(found)


def test_wrong_shapes_and_degrees_are_refused() -> None:
    with pytest.raises(ValueError, match="control points"):
        gs.Spline(np.zeros((4, 2)), np.arange(4.0))
    with pytest.raises(ValueError, match="degree"):
        gs.Spline(np.zeros((7, 2)), np.arange(8.0), 7)
    for knots in ([0, 1, 1, 1, 1, 2], [0, 1, 2, 1, 3, 4], [0, 1, 2, np.nan, 3, 4], [0, 0, 1, 2, 2, 2], [0.0] * 6):
        with pytest.raises(ValueError, match="knots are finite, do not decrease, and have multiplicity 3 at most"):
            gs.Spline(np.zeros((5, 2)), np.array(knots))
    with pytest.raises(ValueError, match="multiplicity"):  # an end has multiplicity 4 as it is
        gs.Spline(np.zeros((7, 2)), np.array([0, 0, 1, 2, 3.0]), 3, closed=False)


@pytest.mark.parametrize(("name", "power"), [("chord", 1.0), ("centripetal", 0.5), ("uniform", 0.0)])
def test_parametrisations(name: str, power: float) -> None:
    p = random_polygon(7, 1)
    s = vertex_parameters(p, name)
    chords = np.hypot(*(np.roll(p, -1, axis=0) - p).T)
    np.testing.assert_allclose(np.diff(s), chords**power)
    assert s[0] == 0


@pytest.mark.parametrize("degree", range(2, 7))
def test_every_basis_function_is_centred_on_its_vertex(degree: int) -> None:
    """On evenly spaced vertices B_i is symmetric about s_i, for odd and even degrees alike."""
    s = vertex_parameters(ellipse(12), "uniform")
    spline = gs.Spline(np.zeros((12, 2)), closed_knots(s, degree), degree)
    centres = vertex_centres(s, degree)
    for offset in (0.0, 0.3, 0.8):
        left, right = spline.basis(centres - offset).diagonal(), spline.basis(centres + offset).diagonal()
        np.testing.assert_allclose(left, right)
    assert (spline.basis(centres).argmax(axis=1) == np.arange(12)).all()


def test_bad_knots_are_refused() -> None:
    p = random_polygon(5, 1)
    for bad in ([0, 1, 2, 3, 4], [0, 1, 2, 2, 3, 4], [0, 1, 2, np.nan, 4, 5]):
        with pytest.raises(gs.PolygonError):
            vertex_parameters(p, bad)
    with pytest.raises(gs.PolygonError, match="chord"):
        vertex_parameters(p, "chords")
