"""The public interpolation functions: what the paper promises, invariances, and bad input."""

from __future__ import annotations

import pickle
from dataclasses import fields
from typing import Any

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.types import FloatArray
from tests.polygons import ellipse, random_polygon

every_variant = pytest.mark.parametrize("variant", range(5))
convergent = pytest.mark.parametrize("variant", [1, 2, 3, 4])


@convergent
@pytest.mark.parametrize("n", [3, 4, 5, 12])
def test_the_curve_passes_through_every_vertex(variant: int, n: int) -> None:
    p = random_polygon(n, 1)
    r = gs.interpolate(p, variant, residual_tolerance=1e-6)
    assert r.converged
    assert np.hypot(*(r.spline(r.parameters) - p).T).max() < 1e-6
    assert r.residuals.shape == (r.iterations + 1,)
    assert r.max_error == r.residuals[-1] < 1e-6 <= r.residuals[:-1].min()


@every_variant
def test_footpoints_lie_in_their_intervals(variant: int) -> None:
    r = gs.interpolate(random_polygon(10, 2), variant, max_iterations=30)
    assert (r.parameters >= r.intervals[:, 0]).all()
    assert (r.parameters <= r.intervals[:, 1]).all()


@pytest.mark.parametrize("variant", [1, 2, 3])
def test_collocation_at_the_footpoints_gives_the_data_back(variant: int) -> None:
    p = random_polygon(15, 3)
    r = gs.interpolate(p, variant, residual_tolerance=1e-10)
    np.testing.assert_allclose(r.spline.basis(r.parameters) @ r.spline.control_points, p, atol=1e-10)


def test_the_first_step_moves_each_control_point_by_its_deviation() -> None:
    """Equation (2), with the footpoints found by brute force on a fine grid."""
    p = random_polygon(8, 4)
    r = gs.interpolate(p, 2, max_iterations=1)
    start = gs.Spline(p, r.spline.knots)
    for i, (low, high) in enumerate(r.intervals):
        t = np.linspace(low, high, 20001)
        nearest = start(t[np.hypot(*(start(t) - p[i]).T).argmin()])
        np.testing.assert_allclose(r.spline.control_points[i], p[i] + (p[i] - nearest), atol=1e-4)


def test_a_margin_certifies_the_rate_before_it_is_run() -> None:
    """Theorem 2: the largest error shrinks by ``rate_bound`` or better at every step."""
    p = ellipse(24) + 0.03 * random_polygon(24, 5)
    r = gs.interpolate(p, 2, margin=0.05, residual_tolerance=1e-11, diagnostics=True)
    assert r.rate_bound == pytest.approx(0.9)
    assert r.rate_observed is not None
    assert r.rate_observed <= r.rate_bound + 1e-12
    assert (r.residuals[1:] <= r.rate_bound * r.residuals[:-1] + 1e-14).all()


def test_diagnostics_hold_every_iteration() -> None:
    p = random_polygon(7, 6)
    r = gs.interpolate(p, 2, diagnostics=True)
    assert r.history is not None
    assert r.spectral_radii is not None
    assert len(r.history) == r.iterations + 1
    for (P, t), error in zip(r.history, r.residuals, strict=True):
        assert np.hypot(*(gs.Spline(P, r.spline.knots)(t) - p).T).max() == pytest.approx(error, rel=1e-9)
    assert r.spectral_radii.shape == (r.iterations,)
    assert (r.spectral_radii[3:] < r.spectral_radii[:1]).all()
    plain = gs.interpolate(p, 2)
    assert (plain.history, plain.rate_observed, plain.spectral_radii) == (None, None, None)


@pytest.mark.parametrize("variant", [2, 3, 4])
def test_not_converging_is_a_result(variant: int) -> None:
    r = gs.interpolate(random_polygon(9, 7), variant, max_iterations=2)
    assert not r.converged
    assert r.iterations == 2
    assert len(r.residuals) == 3
    assert np.isfinite(r.spline.control_points).all()


def test_no_iterations_leave_the_polygon_as_control_polygon() -> None:
    p = random_polygon(9, 7)
    r = gs.interpolate(p, 2, max_iterations=0)
    np.testing.assert_allclose(r.spline.control_points, p, rtol=1e-15, atol=1e-15)


@pytest.mark.parametrize("degree", [2, 3, 4, 5, 6])
def test_degrees(degree: int) -> None:
    p = ellipse(14)
    r = gs.interpolate(p, 2, degree=degree, residual_tolerance=1e-6)
    assert r.converged
    assert r.spline.degree == degree
    assert np.hypot(*(r.spline(r.parameters) - p).T).max() < 1e-6
    on_ellipse = r.spline(np.linspace(0, r.spline.period, 500))
    assert np.abs(np.hypot(on_ellipse[:, 0] / 2, on_ellipse[:, 1]) - 1).max() < 0.02


@convergent
@pytest.mark.parametrize("shift", [1, 4])
def test_the_start_vertex_does_not_matter(variant: int, shift: int) -> None:
    """For Algorithm 3 the order of a sweep changes, and with it the curve by the order of the tolerance."""
    p = random_polygon(10, 8)
    a = gs.interpolate(p, variant, residual_tolerance=1e-9)
    b = gs.interpolate(np.roll(p, -shift, axis=0), variant, residual_tolerance=1e-9)
    if variant == 4:
        assert a.converged
        assert b.converged
    else:
        np.testing.assert_allclose(np.roll(a.spline.control_points, -shift, axis=0), b.spline.control_points, atol=1e-9)


@pytest.mark.parametrize("variant", [1, 2, 3])
@pytest.mark.parametrize(
    "matrix",
    [[[1, 0], [0, 1]], [[-1, 0], [0, 1]], [[0.6, -0.8], [0.8, 0.6]], [[1e3, 0], [0, 1e3]], [[1e-4, 0], [0, 1e-4]]],
    ids=["shift", "mirror", "rotation", "up", "down"],
)
def test_similarities_carry_the_curve_along(variant: int, matrix: list[list[float]]) -> None:
    p = random_polygon(10, 9)
    M = np.array(matrix)
    scale = np.sqrt(abs(np.linalg.det(M)))
    shift = np.array([3.0, -7.0]) * scale
    a = gs.interpolate(p, variant, residual_tolerance=1e-6)
    b = gs.interpolate(p @ M.T + shift, variant, residual_tolerance=1e-6 * scale)
    assert a.iterations == b.iterations
    np.testing.assert_allclose(a.spline.control_points @ M.T + shift, b.spline.control_points, atol=1e-8 * scale)


@pytest.mark.parametrize("variant", [1, 2, 3])
def test_the_direction_does_not_matter(variant: int) -> None:
    p = random_polygon(10, 10)
    a, b = gs.interpolate(p, variant), gs.interpolate(p[::-1], variant)
    np.testing.assert_allclose(a.spline.control_points[::-1], b.spline.control_points, atol=1e-8)


def test_ties_go_to_the_parameter_nearest_the_knot() -> None:
    """A regular polygon: by symmetry the footpoint of every vertex is its knot."""
    r = gs.interpolate(ellipse(8, 1, 1), 2)
    np.testing.assert_allclose(r.parameters, r.spline.knots[:-1], atol=1e-7)


def test_duplicates_are_merged_and_reported() -> None:
    p = random_polygon(6, 11)
    doubled = np.concatenate([p[:2], p[1:4], p[3:], p[:1]])
    r = gs.interpolate(doubled, 2)
    np.testing.assert_array_equal(r.merged, [2, 5, 8])
    np.testing.assert_allclose(r.spline.control_points, gs.interpolate(p, 2).spline.control_points, atol=1e-12)


def test_knots_given_for_duplicates_are_merged_with_them() -> None:
    p = random_polygon(5, 12)
    with_duplicate = np.insert(p, 2, p[1], axis=0)
    r = gs.interpolate(with_duplicate, 2, knots=[0, 1, 1.5, 2, 3, 4, 5])
    np.testing.assert_allclose(r.spline.knots, [0, 1, 2, 3, 4, 5])


BAD = {
    "nan": ([[0, 0], [1, float("nan")], [1, 1]], "vertex 1 is not finite"),
    "infinite": ([[0, 0], [1, 0], [float("inf"), 1]], "vertex 2 is not finite"),
    "two": ([[0, 0], [1, 1]], "2 distinct vertices"),
    "two distinct": ([[0, 0], [1, 1], [0, 0], [1, 1]], "2 distinct vertices"),
    "one": ([[2, 2]] * 5, "1 distinct vert"),
    "empty": (np.empty((0, 2)), "0 distinct vertices"),
    "space": (np.zeros((5, 1)), "shape"),
    "flat": (np.zeros(6), "shape"),
    "words": ("polygon", "array of numbers"),
    "huge": ([[0, 0], [1e200, 0], [0, 1e200]], "spread"),
    "tiny": ([[0, 0], [1e-200, 0], [0, 1e-200]], "spread"),
}


@pytest.mark.parametrize(("points", "message"), BAD.values(), ids=BAD.keys())
def test_bad_polygons_are_refused_by_name(points: Any, message: str) -> None:
    with pytest.raises(gs.PolygonError, match=message):
        gs.interpolate(points)
    with pytest.raises(gs.PolygonError, match=message) as caught:
        gs.interpolate_many([random_polygon(5, 1), points])
    assert caught.value.contour == 1


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"variant": 5}, "variant is 0 to 4, not 5"),
        ({"variant": True}, "variant"),
        ({"variant": 2.0}, "variant"),
        ({"variant": [2]}, "variant"),
        ({"degree": 7}, "degree is 2 to 6, not 7"),
        ({"margin": -0.1}, "margin"),
        ({"margin": float("nan")}, "margin"),
        ({"margin": "0.1"}, "margin"),
        ({"fallback": "none"}, "fallback"),
        ({"residual_tolerance": 0.0}, "residual_tolerance"),
        ({"residual_tolerance": float("inf")}, "residual_tolerance"),
        ({"residual_tolerance": float("nan")}, "residual_tolerance"),
        ({"max_iterations": -1}, "max_iterations"),
        ({"max_iterations": 2.5}, "max_iterations"),
        ({"closed": 1}, "closed"),
        ({"diagnostics": "yes"}, "diagnostics"),
        ({"end_tangents": ((1, 0), (1, 0))}, "end_tangents belong to an open arc"),
        ({"closed": False, "degree": 4}, "an open arc is cubic"),
        ({"knots": "chords"}, "knots are chord, centripetal, uniform or an array"),
    ],
    ids=lambda value: f"{value}" if isinstance(value, dict) else "",
)
def test_options_out_of_range_are_refused(options: dict[str, Any], words: str) -> None:
    with pytest.raises(gs.OptionError, match=words):
        gs.interpolate(random_polygon(5, 1), **options)
    if "end_tangents" not in options:
        with pytest.raises(ValueError, match=words):
            gs.interpolate_many([random_polygon(5, 1)], **options)


def test_options_of_a_list_are_refused_in_words() -> None:
    p = random_polygon(5, 1)
    with pytest.raises(gs.OptionError, match="for each polygon of the list"):
        gs.interpolate_many([p, p], knots=[range(6)])
    with pytest.raises(gs.OptionError, match="errors is"):
        gs.interpolate_many([p], errors="ignore")  # type: ignore[call-overload]
    with pytest.raises(gs.PolygonError, match="5 vertices need 6 knots"):
        gs.interpolate(p, knots=[0, 1, 2])
    with pytest.raises(gs.PolygonError, match="array of numbers"):
        gs.interpolate(p, knots=[[0], [1, 2]])


@pytest.mark.parametrize("variant", [0, 2, 4])
@pytest.mark.parametrize("radius", [1e-6, 1.0, 1e6])
def test_the_default_tolerance_is_relative_to_the_extent(radius: float, variant: int) -> None:
    p = radius * ellipse(8, 1, 1)
    r = gs.interpolate(p, variant)
    assert r.converged
    assert r.max_error < 1e-6 * float(np.ptp(p, axis=0).max())
    assert r.iterations == gs.interpolate(ellipse(8, 1, 1), variant).iterations > 0
    assert gs.interpolate_vertex(p, 3).iterations == gs.interpolate_vertex(ellipse(8, 1, 1), 3).iterations > 0


@pytest.mark.parametrize("knots", ["uniform", "centripetal"])
def test_diagnostics_of_a_polygon_with_duplicates_are_those_without(knots: Any) -> None:
    p = random_polygon(9, 4)
    plain = gs.interpolate(p, knots=knots, diagnostics=True)
    doubled = gs.interpolate(np.insert(p, 4, p[3], axis=0), knots=knots, diagnostics=True)
    assert doubled.merged.tolist() == [4]
    assert doubled.rate_observed == plain.rate_observed
    np.testing.assert_array_equal(doubled.spectral_radii, plain.spectral_radii)


def test_a_result_is_a_plain_value() -> None:
    r = gs.interpolate(random_polygon(6, 2))
    copy = pickle.loads(pickle.dumps(r))
    np.testing.assert_array_equal(copy.spline.control_points, r.spline.control_points)
    assert (copy.iterations, copy.converged, copy.max_error) == (r.iterations, r.converged, r.max_error)
    with pytest.raises(AttributeError):
        r.iterations = 3  # type: ignore[misc]
    with pytest.raises(AttributeError, match="no attribute 'knots'"):
        r.knots  # type: ignore[attr-defined] # noqa: B018


def test_results_of_a_list_are_made_when_read_and_leave_the_others_behind() -> None:
    polygons = [random_polygon(6, seed) for seed in range(40)]
    many = gs.interpolate_many(polygons)
    assert "spline" not in vars(many[3])
    assert len(pickle.dumps(many[3])) < 2 * len(pickle.dumps(gs.interpolate(polygons[3])))
    assert set(vars(many[3])) == {field.name for field in fields(many[3])} - {
        "history",
        "rate_observed",
        "spectral_radii",
    }
    assert pickle.loads(pickle.dumps(many[5])).rate_bound == gs.interpolate(polygons[5]).rate_bound


@pytest.mark.parametrize("degree", [3, 5])
def test_results_have_their_vertices_without_duplicates(degree: int) -> None:
    given = np.array([[0, 0], [4, 0], [4, 0], [5, 3], [2, 5]], dtype=np.float64)
    many = gs.interpolate_many([given, given[::-1], [[0, 0]]], degree=degree, errors="return")
    for found, points in zip(many, (given[[0, 1, 3, 4]], given[[4, 3, 2, 0]]), strict=False):
        assert isinstance(found, gs.Interpolation)
        np.testing.assert_array_equal(found.points, points)
    given[:] = 0.0
    assert many[0].points.any()  # type: ignore[union-attr]


def test_many_give_what_each_gives() -> None:
    polygons = [random_polygon(n, n) for n in (5, 3, 17, 8)]
    for p, r in zip(polygons, gs.interpolate_many(polygons, 2, margin=0.01), strict=True):
        alone = gs.interpolate(p, 2, margin=0.01)
        np.testing.assert_array_equal(r.spline.control_points, alone.spline.control_points)
        assert r.iterations == alone.iterations


def test_one_vertex_alone_converges_at_theorem_1s_rate() -> None:
    """Remark 1: on uniform knots the rate is at most 5/6."""
    p = ellipse(12, 1, 1)
    r = gs.interpolate_vertex(p, 3)
    assert r.converged
    assert r.rate_bound == pytest.approx(5 / 6)
    assert (r.residuals[1:] <= r.rate_bound * r.residuals[:-1]).all()
    others = np.delete(r.spline.control_points, 3, axis=0)
    np.testing.assert_array_equal(others, np.delete(p, 3, axis=0))
    assert np.hypot(*(r.spline(r.parameters)[0] - p[3])) < 1e-6
    with pytest.raises(gs.PolygonError, match="no vertex 12"):
        gs.interpolate_vertex(p, 12)


def quarter_circle(m: int) -> FloatArray:
    angle = np.linspace(0, np.pi / 2, m)
    return 100 * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def test_open_arc_with_end_tangents_returns_a_quarter_circle() -> None:
    p = quarter_circle(6)
    r = gs.interpolate(p, 2, closed=False, end_tangents=((0, 1), (-1, 0)), residual_tolerance=1e-8)
    assert r.spline.control_points.shape == (8, 2)
    radius = np.hypot(*r.spline(np.linspace(0, r.spline.period, 1001)).T)
    assert np.abs(radius - 100).max() < 0.01
    ends = r.spline(np.array([0, r.spline.period]), derivative=1)
    np.testing.assert_allclose(ends, [[0, 1], [-1, 0]], atol=1e-12)


@every_variant
@pytest.mark.parametrize("m", [2, 3, 4, 9])
def test_natural_ends_have_no_curvature(variant: int, m: int) -> None:
    p = random_polygon(m, 14)
    r = gs.interpolate(p, variant, closed=False, max_iterations=200, residual_tolerance=1e-6)
    ends = np.array([0, r.spline.period])
    np.testing.assert_allclose(r.spline(ends), p[[0, -1]], atol=1e-12)
    np.testing.assert_allclose(r.spline(ends, derivative=2), 0, atol=1e-10)
    if variant:
        assert r.converged
        np.testing.assert_allclose(r.spline(r.parameters), p, atol=1e-6)


def test_theorem_2_carries_over_to_open_arcs() -> None:
    p = quarter_circle(12) + 0.4 * random_polygon(12, 15)
    r = gs.interpolate(p, 2, closed=False, margin=0.05, end_tangents=((0, 1), None), diagnostics=True)
    assert r.rate_observed is not None
    assert r.rate_observed <= r.rate_bound + 1e-12
    assert r.rate_bound < 1
    assert (r.residuals[1:] <= r.rate_bound * r.residuals[:-1] + 1e-12).all()


def test_even_spacing_on_an_ellipse_is_fourth_order() -> None:
    errors = []
    for n in (24, 48):
        r = gs.interpolate(ellipse(n, 2, 1.7), 2, residual_tolerance=1e-12)
        q = r.spline(np.linspace(0, r.spline.period, 4001))
        errors.append(np.abs(np.hypot(q[:, 0] / 2, q[:, 1] / 1.7) - 1).max())
    assert errors[0] / errors[1] > 10


@pytest.mark.parametrize("n", [5, 20, 90])
def test_random_polygons_converge_as_the_paper_reports(n: int) -> None:
    """Figs. 2 and 3 in small: variants 1, 2 and 4 on all polygons, variant 3 on almost all and more slowly."""
    polygons = [random_polygon(n, seed) for seed in range(20)]
    runs = {variant: gs.interpolate_many(polygons, variant, residual_tolerance=1e-6) for variant in (1, 2, 3, 4)}
    steps = {variant: np.mean([r.iterations for r in results]) for variant, results in runs.items()}
    for variant in (1, 2, 4):
        assert all(r.converged for r in runs[variant])
    assert sum(r.converged for r in runs[3]) >= 18
    assert steps[4] < steps[2] < steps[3]
    assert steps[2] == pytest.approx({5: 29, 20: 34, 90: 40}[n], abs=5)


def test_variant_0_seldom_converges_on_many_vertices() -> None:
    runs = gs.interpolate_many([random_polygon(40, seed) for seed in range(4)], 0, max_iterations=60)
    assert sum(r.converged for r in runs) <= 1


def test_an_option_is_wrong_whatever_the_polygons_are() -> None:
    with pytest.raises(gs.OptionError, match="end_tangents belong to an open arc"):
        gs.interpolate_many([[[0, 0]]], end_tangents=[((1, 0), None)], errors="return")
