"""Interpolation in R^d: nothing in the method needs the plane."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.interpolation.batch import interpolate_batch
from glyphspline.interpolation.kernels.footpoint import WORK, reduce, search_piece
from glyphspline.interpolation.method import Method
from glyphspline.interpolation.polygon import Polygons
from glyphspline.interpolation.reference import interpolate_reference
from glyphspline.types import FloatArray
from tests.polygons import random_polygon

DIMENSIONS = (2, 3, 4, 6, 18)
OPTIONS: list[dict[str, Any]] = [
    {}, {"variant": 0, "max_iterations": 20}, {"variant": 1}, {"variant": 3}, {"variant": 4}, {"closed": False},
    {"closed": False, "variant": 1}, {"closed": False, "variant": 3}, {"closed": False, "variant": 4},
    {"margin": 0.02, "fallback": "peak"}, {"knots": "centripetal"},
]  # fmt: skip


def polygon(n: int, d: int, seed: int = 0) -> FloatArray:
    """Vertices uniform in [0, 5]^d."""
    return np.random.default_rng([n, d, seed]).uniform(0, 5, (n, d))


def isometry(d: int) -> FloatArray:
    """(2, d) the plane turned into R^d."""
    return np.linalg.qr(np.random.default_rng(d).normal(size=(d, 2)))[0].T


@pytest.mark.parametrize("d", DIMENSIONS)
@pytest.mark.parametrize("options", OPTIONS)
def test_it_agrees_with_the_reference(options: dict[str, Any], d: int) -> None:
    p = polygon(9, d)
    ours, plain = gs.interpolate(p, **options), interpolate_reference(p, **options)
    assert ours.iterations == plain.iterations
    assert ours.fallbacks == plain.fallbacks
    assert ours.uncertified == 0
    assert ours.spline.control_points.shape == plain.spline.control_points.shape
    np.testing.assert_allclose(ours.spline.control_points, plain.spline.control_points, rtol=0, atol=5e-10)
    np.testing.assert_allclose(ours.rate_bound, plain.rate_bound, rtol=0, atol=1e-9)


@pytest.mark.parametrize("d", DIMENSIONS)
def test_arcs_with_end_tangents_agree_with_the_reference(d: int) -> None:
    p = polygon(8, d, 1)
    tangents = np.random.default_rng(d).normal(size=(2, d))
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    for pair in ((tangents[0], tangents[1]), (None, tangents[1])):
        for v in range(1, 5):
            ours = gs.interpolate(p, v, closed=False, end_tangents=pair)
            plain = interpolate_reference(p, v, closed=False, end_tangents=pair)
            assert ours.iterations == plain.iterations
            np.testing.assert_allclose(ours.spline.control_points, plain.spline.control_points, rtol=0, atol=5e-10)
    np.testing.assert_allclose(ours.spline(ours.spline.knots[-1], derivative=1), tangents[1], atol=1e-12)


@pytest.mark.parametrize("d", [3, 7, 40])
@pytest.mark.parametrize("options", OPTIONS)
def test_a_plane_in_space_has_the_curve_of_the_plane(options: dict[str, Any], d: int) -> None:
    p, into = random_polygon(9, 1), isometry(d)
    options = {"residual_tolerance": 1e-6, **options}
    flat, space = gs.interpolate(p, **options), gs.interpolate(p @ into, **options)
    assert space.iterations == flat.iterations
    assert space.uncertified == 0
    np.testing.assert_allclose(space.parameters, flat.parameters, atol=1e-8)
    np.testing.assert_allclose(space.spline.control_points, flat.spline.control_points @ into, atol=1e-8)


@pytest.mark.parametrize("d", [3, 6, 18])
@pytest.mark.parametrize("variant", [1, 2, 3, 4])
def test_every_footpoint_is_certified(variant: int, d: int) -> None:
    found = gs.interpolate_many([polygon(n, d, seed) for n in (5, 20, 60) for seed in range(10)], variant)
    assert sum(r.uncertified or 0 for r in found) == 0
    assert all(r.converged for r in found)


@pytest.mark.parametrize("d", [3, 6])
def test_theorem_2_holds_in_any_dimension(d: int) -> None:
    p = polygon(8, d)
    r = gs.interpolate(p, margin=0.02, residual_tolerance=1e-6)
    assert r.converged
    assert r.rate_bound < 1
    assert (r.residuals[1:] <= r.rate_bound * r.residuals[:-1] + 1e-12).all()
    np.testing.assert_allclose(r.spline(r.parameters), p, atol=1e-6)


@pytest.mark.parametrize(("degree", "size"), [(2, 5), (3, 6), (3, 50), (6, 9)])
def test_the_reduction_keeps_inner_products(degree: int, size: int) -> None:
    b = np.random.default_rng(size).normal(size=(degree + 1, size))
    for given in (b, b * [[0.0], *[[1.0]] * degree], b[[0] * (degree + 1)], b * 1e-9 + b[:1]):
        c = np.full((degree + 1, degree + 1), np.nan)
        reduce(given.copy(), c)
        np.testing.assert_allclose(c.T @ c, given @ given.T, rtol=0, atol=1e-14 * (given**2).sum())
        y = 0.7 ** np.arange(degree + 1)
        np.testing.assert_allclose(np.linalg.norm(c @ y), np.linalg.norm(y @ given), atol=1e-14 * np.abs(given).sum())


def test_a_distance_of_almost_nothing_keeps_its_digits() -> None:
    """A curve through the vertex: as a sum of inner products its squared distance would be wrong by 1e-16."""
    rng = np.random.default_rng(0)
    b = rng.normal(size=(4, 30))
    b[0] = -(0.3 * b[1] + 0.09 * b[2] + 0.027 * b[3]) + 1e-12 * rng.normal(size=30)
    c = np.empty((4, 4))
    reduce(b.copy(), c)
    y, D, certified = search_piece(c, 3, 0.0, 1.0, 0.0, 0.5, np.inf, 1e-28, np.empty(WORK))
    assert certified
    assert y == pytest.approx(0.3, abs=1e-11)
    assert np.sqrt(D) == pytest.approx(np.linalg.norm(y ** np.arange(4) @ b), abs=4e-15)


def test_batches_are_of_one_dimension() -> None:
    polygons = [polygon(n, 6) for n in (5, 9, 14)]
    offsets = np.array([0, 5, 14, 28])
    for closed in (True, False):
        batch = interpolate_batch(Polygons(np.concatenate(polygons), offsets), Method(closed=closed))
        many = gs.interpolate_many(polygons, closed=closed)
        for k, p in enumerate(polygons):
            alone = gs.interpolate(p, closed=closed)
            for r in (many[k], batch.results()[k]):
                assert r.iterations == alone.iterations
                np.testing.assert_array_equal(r.spline.control_points, alone.spline.control_points)
                np.testing.assert_array_equal(r.parameters, alone.parameters)
    good, bad = gs.interpolate_many([polygons[0], random_polygon(5, 0)], errors="return")
    assert isinstance(good, gs.Interpolation)
    assert isinstance(bad, gs.PolygonError)
    assert "2 coordinates a vertex" in bad.message


@pytest.mark.parametrize("d", [3, 5, 18])
@pytest.mark.parametrize("closed", [True, False])
def test_a_list_agrees_with_the_reference(closed: bool, d: int) -> None:
    """Polygons of all sizes, in a list and by the reference."""
    sizes = [3, 4, 5, 7, 12, 20, 12, 33]
    polygons = [polygon(n, d, 2) for n in sizes]
    polygons[5][:, 1:] *= 1e-9  # almost a line, seen from the first coordinate
    polygons[6] = polygons[6].round()
    for options in ({}, {"variant": 1}, {"variant": 3}, {"margin": 0.02, "fallback": "peak"}):
        many = gs.interpolate_many(polygons, closed=closed, max_iterations=3, **options)
        for p, found in zip(polygons, many, strict=True):
            alone = interpolate_reference(p, closed=closed, max_iterations=3, **options)
            assert found.iterations == alone.iterations
            assert found.fallbacks == alone.fallbacks
            assert found.uncertified == 0
            np.testing.assert_allclose(found.rate_bound, alone.rate_bound, atol=1e-9)
            np.testing.assert_allclose(found.residuals, alone.residuals, rtol=1e-8, atol=1e-13)
            np.testing.assert_allclose(found.intervals, alone.intervals, atol=1e-8)
            np.testing.assert_allclose(found.spline.control_points, alone.spline.control_points, rtol=0, atol=5e-10)


def test_cusps_and_repeated_places_are_certified() -> None:
    """Curves with almost no speed, and places twice the same."""
    rng = np.random.default_rng(4)
    searched = 0
    for seed in range(12):
        p = polygon(12, 3 + seed % 4, seed).round()
        p[4:8] = p[[4, 5, 4, 5]] + 10.0 ** rng.uniform(-9, -1) * rng.normal(size=(4, p.shape[1]))
        batch = interpolate_batch(Polygons(p, np.array([0, len(p)])), Method(1, max_iterations=25))
        plain = interpolate_reference(p, 1, max_iterations=25)
        searched += int(batch.arrays.whole[0, 4])
        assert batch.results()[0].uncertified == 0
        assert batch.results()[0].iterations == plain.iterations
        np.testing.assert_allclose(batch.results()[0].residuals, plain.residuals, rtol=1e-6, atol=1e-9)
    assert searched > 0


def test_results_depend_neither_on_threads_nor_on_the_other_polygons() -> None:
    polygons = [polygon(n, 6, 1) for n in range(5, 70)] * 3
    one, two = (gs.interpolate_many(polygons, threads=threads) for threads in (1, 2))
    for p, a, b in zip(polygons, one, two, strict=True):
        alone = gs.interpolate(p)
        for r in (a, b):
            np.testing.assert_array_equal(r.spline.control_points, alone.spline.control_points)


def test_batches_take_knots_tangents_and_tolerances() -> None:
    polygons = [polygon(n, 5) for n in (5, 9)]
    knots = [np.cumsum(np.random.default_rng(len(p)).uniform(1, 2, len(p))) for p in polygons]
    tangents: list[Any] = [(np.ones(5), None), (None, None)]
    many = gs.interpolate_many(polygons, closed=False, knots=knots, end_tangents=tangents, residual_tolerance=1e-4)
    ends = np.array([[np.ones(5), np.full(5, np.nan)], np.full((2, 5), np.nan)])
    laid_out = Polygons(np.concatenate(polygons), np.array([0, 5, 14]), np.concatenate(knots), ends)
    batch = interpolate_batch(laid_out, Method(knots=None, closed=False, residual_tolerance=1e-4))
    for k, (p, u) in enumerate(zip(polygons, knots, strict=True)):
        plain = interpolate_reference(p, closed=False, knots=u, end_tangents=tangents[k], residual_tolerance=1e-4)
        for r in (many[k], batch.results()[k]):
            assert r.iterations == plain.iterations
            assert r.max_error < 1e-4
            np.testing.assert_allclose(r.spline.control_points, plain.spline.control_points, rtol=0, atol=1e-9)


def test_one_vertex_in_space() -> None:
    p, into = random_polygon(9, 3), isometry(8)
    flat, space = gs.interpolate_vertex(p, 4), gs.interpolate_vertex(p @ into, 4, residual_tolerance=5e-6)
    assert space.converged
    np.testing.assert_allclose(space.spline(space.parameters)[0], p[4] @ into, atol=5e-6)
    np.testing.assert_allclose(space.rate_bound, flat.rate_bound)


def test_diagnostics_in_space() -> None:
    r = gs.interpolate(polygon(7, 5), diagnostics=True)
    assert r.history is not None
    assert r.history[0][0].shape == (7, 5)
    assert r.rate_observed is not None
    assert r.rate_observed < 1


def test_a_spline_in_space() -> None:
    masters = np.random.default_rng(1).uniform(0, 5, (3, 7, 2))
    r = gs.interpolate(np.concatenate(masters, axis=1))
    spline, t = r.spline, np.linspace(0, 20, 50)
    assert repr(spline).startswith("<Spline: closed, in R^6, degree 3")
    assert spline(t, derivative=1).shape == (50, 6)
    assert spline.to_bezier().shape == (7, 4, 6)
    np.testing.assert_allclose(spline.to_scipy()(t), spline(t), atol=1e-12)
    np.testing.assert_allclose(spline.basis(r.parameters) @ spline.control_points, spline(r.parameters), atol=1e-12)
    for weights in np.vstack([np.eye(3), [0.2, -0.5, 1.3]]):
        blend = spline.project(weights)
        np.testing.assert_allclose(blend(t), spline(t).reshape(50, 3, 2).transpose(0, 2, 1) @ weights, atol=1e-12)
        assert blend.curvature(t).shape == (50,)
        np.testing.assert_allclose(blend(r.parameters), np.tensordot(weights, masters, 1), atol=3e-5)


def test_curvature_and_torsion_of_a_screw() -> None:
    t, radius, rise = np.linspace(0, 8, 200), 3.0, 2.0
    screw = np.stack([radius * np.cos(t), radius * np.sin(t), rise * t], axis=1)
    curve = gs.interpolate(screw, closed=False, residual_tolerance=1e-10).spline
    at = np.linspace(0.2, 0.8, 50) * curve.period
    square = radius**2 + rise**2
    np.testing.assert_allclose(curve.curvature(at), radius / square, rtol=1e-3)
    np.testing.assert_allclose(curve.torsion(at), rise / square, rtol=0.05)
    mirrored = gs.Spline(curve.control_points * (1, 1, -1), curve.knots, closed=False)
    np.testing.assert_allclose(mirrored.torsion(at), -curve.torsion(at))
    flat = gs.Spline(curve.control_points * (1, 1, 0), curve.knots, closed=False)
    plane = gs.Spline(curve.control_points[:, :2], curve.knots, closed=False)
    np.testing.assert_allclose(flat.curvature(at), np.abs(plane.curvature(at)))
    assert (flat.torsion(at) == 0).all()
    still = gs.Spline(np.zeros((4, 3)), np.array([0.0, 1]), closed=False)
    assert np.isinf(still.curvature(0.5))


def test_what_needs_the_plane_says_so() -> None:
    spline = gs.interpolate(polygon(7, 5)).spline
    with pytest.raises(gs.OptionError, match=r"torsion needs a spline in R\^3, not in R\^5"):
        spline.torsion(0.0)
    with pytest.raises(gs.OptionError, match="drawing needs a spline in the plane"):
        spline.draw(None)
    for given in ([1.0, 0.0], np.ones(5)):
        with pytest.raises(gs.OptionError, match=r"R\^2K is projected by K finite weights"):
            spline.project(given)
    with pytest.raises(gs.OptionError, match="finite weights"):
        gs.interpolate(polygon(7, 4)).spline.project([np.nan, 1.0])


def test_wrong_shapes_are_refused() -> None:
    for bad in (np.zeros((5, 1)), np.zeros(6), np.zeros((3, 2, 2))):
        with pytest.raises(gs.PolygonError, match=r"shape \(n, d\) with d >= 2"):
            gs.interpolate(bad)
    with pytest.raises(gs.PolygonError, match=r"end tangent of a polygon \(n, 4\) has shape \(4,\), not \(2,\)"):
        gs.interpolate(polygon(5, 4), closed=False, end_tangents=((1.0, 0.0), None))
    with pytest.raises(gs.PolygonError, match="vertex 2 is not finite"):
        gs.interpolate(np.where(np.arange(20).reshape(5, 4) == 9, np.nan, polygon(5, 4)))
    with pytest.raises(gs.PolygonError, match="distinct vertices"):
        gs.interpolate(np.zeros((5, 4)))
