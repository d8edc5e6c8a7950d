"""What the paper's page says beyond the paper: approximation order, the PIA family, stacked masters."""

from __future__ import annotations

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.interpolation.polygon import vertex_parameters
from scripts.paper.common import random_polygons
from scripts.paper.dimension import stacked_masters
from scripts.paper.order import greville_start, local_error, reparametrised
from scripts.paper.pia import LINEAR, SALSPIA, exact_fairness, family, least_squares
from scripts.paper.smooth_curves import ELLIPSE, TREFOIL, Sampling, Waves, distance, order, steps

COUNTS = (32, 64, 128)


def vertices(curve: Waves, n: int, sampling: Sampling) -> np.ndarray:
    return np.asarray(curve(curve.angles(steps(n, sampling))))


def fitted(curve: Waves, sampling: Sampling, variant: int) -> float:
    errors = []
    for n in COUNTS:
        r = gs.interpolate(vertices(curve, n, sampling), variant, residual_tolerance=1e-11)
        assert r.converged
        errors.append(distance(curve, r.spline))
    return order(COUNTS, errors, COUNTS[0])


def test_distance_of_concentric_circles() -> None:
    angle = 2 * np.pi * np.arange(64) / 64
    r = gs.interpolate(np.stack([np.cos(angle), np.sin(angle)], axis=1), residual_tolerance=1e-12)
    assert distance(Waves({1: 1.25}), r.spline) == pytest.approx(0.25, abs=1e-5)
    assert distance(Waves({1: 0.5}), r.spline) == pytest.approx(0.5, abs=1e-5)


@pytest.mark.parametrize("curve", [ELLIPSE, TREFOIL])
def test_even_and_graded_chords_give_the_fourth_order(curve: Waves) -> None:
    for variant in (2, 3):
        assert fitted(curve, "even", variant) > 3.6
        assert fitted(curve, "graded", variant) > 3.6


def test_alternating_chords_give_the_second_order_with_the_predicted_constant() -> None:
    assert fitted(TREFOIL, "alternating", 2) == pytest.approx(2, abs=0.1)
    assert fitted(TREFOIL, "alternating", 3) > 3.6
    n = 256
    p = vertices(ELLIPSE, n, "alternating")
    r = gs.interpolate(p, residual_tolerance=1e-11)
    angle, length = ELLIPSE.lengths()
    unit = np.abs(ELLIPSE.curvature(angle)).max() * (length[-1] / (1.5 * n)) ** 2
    first = local_error((1.0, 2.0))
    assert distance(ELLIPSE, r.spline) / unit == pytest.approx(first.error, rel=0.02)
    assert np.abs(r.parameters - r.spline.knots[:-1]).max() / (length[-1] / (1.5 * n)) == pytest.approx(
        first.offset, rel=0.02
    )
    again = local_error((1.0, 2.0), first.intervals)
    assert distance(ELLIPSE, reparametrised(p, r).spline) / unit == pytest.approx(again.error, rel=0.02)
    assert distance(ELLIPSE, greville_start(p)) < 0.02 * distance(ELLIPSE, r.spline)
    assert local_error((1.0, 1.0)).error < 1e-9


def test_the_pia_family_has_the_limit_of_variant_3() -> None:
    p = random_polygons(8, 1)[0]
    r = gs.interpolate(p, 3, residual_tolerance=1e-6)
    u = vertex_parameters(p)
    A = r.spline.basis(u[:-1])
    limit = np.linalg.solve(A, p)
    for name in LINEAR:
        found = family(A, p, name)
        assert found.converged, name
        np.testing.assert_allclose(found.controls, limit, atol=1e-4)
    assert family(A, p, "PIA").iterations == r.iterations


def test_least_squares_on_the_analytic_curve() -> None:
    q = SALSPIA(2 * np.pi * np.arange(400) / 400)
    radius = 2 + 4 * np.cos(2 * 0.3 + np.pi / 4) + np.cos(3 * 0.3 + np.pi / 4)
    np.testing.assert_allclose(SALSPIA(np.array([0.3]))[0], [radius * np.cos(0.3), radius * np.sin(0.3)])
    spline, _ = least_squares(q, 5)
    s = vertex_parameters(q)
    B = spline.basis(s[:-1])
    assert np.abs(B.T @ (q - B @ spline.control_points)).max() < 1e-5
    assert exact_fairness(Waves({1: 2.0}))["∫κ² ds"] == pytest.approx(np.pi)


def test_masters_keep_the_vertices_of_the_first() -> None:
    p = random_polygons(9, 1)[0]
    points = stacked_masters(p, 3)
    assert points.shape == (9, 6)
    assert np.array_equal(points[:, :2], p)
