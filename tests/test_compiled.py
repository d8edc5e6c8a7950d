"""The compiled core: agreement with the plain reference, invariances, awkward input."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import glyphspline as gs
from glyphspline.interpolation.batch import interpolate_batch
from glyphspline.interpolation.method import Method
from glyphspline.interpolation.polygon import Polygons
from glyphspline.interpolation.reference import prepare
from glyphspline.interpolation.roots import footpoint

from .agreement import TOLERANCE, compare
from .polygons import KINDS, polygon, smooth, uniform

MORE = [range(first, first + 79) for first in range(26, 500, 79)]


@pytest.mark.parametrize("numbers", [range(26), *(pytest.param(part, marks=pytest.mark.long) for part in MORE)])
def test_agrees_with_the_reference(numbers: range) -> None:
    """Kinds of polygons and settings take turns."""
    for number in numbers:
        kind, points = polygon(number)
        found = compare(points, number, most=12)
        assert found.iterations == 0, (kind, number)
        assert found.difference <= TOLERANCE, (kind, number)
        assert found.fallbacks == 0
        assert abs(found.rate_bound) < 1e-9


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("closed", [True, False])
def test_collocation_gives_the_data_back(kind: str, closed: bool) -> None:
    points = KINDS[kind][0](np.random.default_rng(5), 17)
    extent = float(np.ptp(points, axis=0).max())
    r = gs.interpolate(points, margin=0.02, fallback="peak", closed=closed, residual_tolerance=1e-9 * extent)
    assert r.converged
    kept = np.delete(points, r.merged, axis=0)
    assert np.abs(r.spline(r.parameters) - kept).max() <= 1.0001e-9 * extent
    assert r.max_error <= 1e-9 * extent
    assert np.isfinite(r.spline.control_points).all()


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("n", [3, 4, 5, 6, 7, 20, 63, 64, 65, 80, 81, 128, 129, 300])
def test_polygons_of_any_number_of_vertices_are_interpolated_to_rounding(n: int, closed: bool) -> None:
    points = uniform(np.random.default_rng(n), n)
    r = gs.interpolate(points, closed=closed, residual_tolerance=1e-13)
    assert r.converged
    assert np.abs(r.spline(r.parameters) - points).max() < 2e-13


@pytest.mark.parametrize("n", [7, 64, 129, 260])
def test_start_vertex_direction_place_and_scale_do_not_matter(n: int) -> None:
    points = smooth(np.random.default_rng(1), n)
    P = gs.interpolate(points, residual_tolerance=1e-9).spline.control_points
    turned = gs.interpolate(np.roll(points, 5, axis=0), residual_tolerance=1e-9).spline.control_points
    assert_allclose(np.roll(turned, -5, axis=0), P, atol=1e-11)
    back = gs.interpolate(points[::-1], residual_tolerance=1e-9).spline.control_points
    assert_allclose(back[::-1], P, atol=1e-11)
    moved = gs.interpolate(1024 * points + [3, -7], residual_tolerance=1024e-9).spline.control_points
    assert_allclose((moved - [3, -7]) / 1024, P, atol=1e-11)


@given(
    st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=1, max_size=14),
    st.sampled_from([0, 1, 2, 3, 4]),
    st.booleans(),
    st.sampled_from(["knot", "peak"]),
    st.sampled_from([1.0, 1e-80, 1e80]),
)
def test_nan_never_comes_out(
    points: list[tuple[int, int]], variant: int, closed: bool, fallback: Any, scale: float
) -> None:
    p = scale * np.array(points, dtype=np.float64)
    try:
        r = gs.interpolate(
            p,
            variant,
            closed=closed,
            fallback=fallback,
            max_iterations=40,
            residual_tolerance=1e-6 * scale,
        )
    except gs.PolygonError:
        kept = [a for a, b in zip(points, points[-1:] + points, strict=False) if a != b]
        assert len(set(kept)) < (3 if closed else 2)
        return
    for array in (r.spline.control_points, r.parameters, r.intervals, r.residuals, r.spline.knots):
        assert np.isfinite(array).all()
    low, high = r.intervals.T
    slack = 1e-12 * r.spline.knots[-1]
    assert ((r.parameters >= low - slack) & (r.parameters <= high + slack)).all()


def test_merged_vertices_and_own_knots() -> None:
    p = uniform(np.random.default_rng(2), 9)
    doubled = np.insert(p, 4, p[3], axis=0)
    plain, merged = gs.interpolate(p), gs.interpolate(doubled)
    assert merged.merged.tolist() == [4]
    assert_allclose(merged.spline.control_points, plain.spline.control_points, atol=0)
    own = gs.interpolate(p, knots=np.append(plain.spline.knots, [])[: len(p) + 1])
    assert_allclose(own.spline.control_points, plain.spline.control_points, atol=1e-14)


@pytest.mark.parametrize(
    ("points", "words"),
    [
        ([[0, 0], [1, 0], [np.nan, 1]], "not finite"),
        ([[0, 0], [1, 0], [0, 0]], "2 distinct"),
        ([[0], [1], [2]], "shape"),
        ([[0, 0], [1e200, 0], [0, 1]], "spread"),
        (["a", "b"], "numbers"),
    ],
)
def test_bad_polygons_are_refused_in_words(points: object, words: str) -> None:
    with pytest.raises(gs.PolygonError, match=words):
        gs.interpolate(points)  # type: ignore[arg-type]
    good = uniform(np.random.default_rng(0), 8)
    with pytest.raises(gs.PolygonError, match=words) as caught:
        gs.interpolate_many([good, points])  # type: ignore[list-item]
    assert caught.value.contour == 1
    found = gs.interpolate_many([points, good], errors="return")  # type: ignore[call-overload]
    assert isinstance(found[0], gs.PolygonError)
    assert found[1].converged


def test_a_batch_of_open_arcs_is_those_one_by_one() -> None:
    rng = np.random.default_rng(8)
    arcs = [uniform(rng, n) for n in (2, 3, 4, 9, 130)]
    tangents = rng.standard_normal((5, 2, 2))
    tangents[3, 1] = np.nan
    offsets = np.cumsum([0, *map(len, arcs)])
    found = interpolate_batch(Polygons(np.concatenate(arcs), offsets, tangents=tangents), Method(closed=False))
    for k, arc in enumerate(arcs):
        pair: Any = tuple(None if np.isnan(t[0]) else t for t in tangents[k])
        one = gs.interpolate(arc, closed=False, end_tangents=pair)
        assert_allclose(found.results()[k].spline.control_points, one.spline.control_points, atol=0)
        ends = one.spline(one.spline.knots[[0, -1]], derivative=1)
        assert_allclose(ends[0], tangents[k, 0], atol=1e-12)


@pytest.mark.parametrize("whole_curve", [False, True])
def test_one_vertex_alone_is_algorithm_1_by_the_roots_of_polynomials(whole_curve: bool) -> None:
    for number in range(20):
        kind, p = polygon(number)
        k, tolerance, problem = number % 3, 2e-7 * np.ptp(p, axis=0).max(), prepare(p, Method(1))
        centre, half = problem.centres[k], np.array([-0.5, 0.5]) * problem.knots[-1]
        interval = centre + half if whole_curve else problem.intervals.bounds[k]
        controls, errors = problem.points.copy(), [np.inf]
        while errors[-1] >= tolerance and len(errors) <= 31:
            spline = problem.spline(controls)
            e = problem.points[k] - spline(footpoint(spline, problem.points[k], interval, centre))
            errors.append(np.hypot(*e))
            if errors[-1] >= tolerance and len(errors) <= 31:
                controls[k] += e
        least = problem.spline(controls).basis(interval)[:, k].min()  # B_k has a single peak
        ours = gs.interpolate_vertex(p, k, whole_curve=whole_curve, residual_tolerance=tolerance, max_iterations=30)
        assert ours.iterations == len(errors) - 2, (kind, number)
        assert ours.rate_bound == pytest.approx(1.0 if whole_curve else 1 - least, abs=1e-9)
        difference = ours.spline.control_points - controls
        assert np.abs(difference).max() <= TOLERANCE * np.ptp(p, axis=0).max(), (kind, number)
