"""Certified nearest points: planted ones come back, and nothing found by dense sampling is nearer."""

from __future__ import annotations

import numpy as np
import pytest

from glyphspline.curves.bspline import Spline
from glyphspline.interpolation.batched import interpolate_batch
from glyphspline.interpolation.kernels.footpoint import WORK, search_piece
from glyphspline.interpolation.method import Method
from glyphspline.interpolation.reference import footpoint, prepare

from .polygons import smooth, uniform


def nearest(coefficients: np.ndarray, low: float, high: float, centre: float) -> tuple[float, float]:
    """The search on one piece from nothing."""
    degree = coefficients.shape[1] - 1
    return search_piece(coefficients, degree, 0.0, low, high, centre, centre, np.inf, 0.0, np.empty(WORK))


@pytest.mark.parametrize("degree", [2, 3, 4, 5, 6])
def test_no_sampled_point_is_nearer(degree: int) -> None:
    rng = np.random.default_rng(degree)
    x = np.linspace(0, 1, 2001)
    for _ in range(200):
        c = rng.standard_normal((2, degree + 1)) * rng.choice([1e-3, 1, 30], (1, degree + 1))
        y, D = nearest(c, 0.0, 1.0, 0.5)
        sampled = np.polyval(c[0, ::-1], x) ** 2 + np.polyval(c[1, ::-1], x) ** 2
        assert 0 <= y <= 1
        assert sampled.min() * (1 + 1e-9) >= D
        assert pytest.approx(np.polyval(c[0, ::-1], y) ** 2 + np.polyval(c[1, ::-1], y) ** 2, rel=1e-9, abs=1e-28) == D
        slope = np.polyadd(*(np.convolve(row[::-1], np.polyder(row[::-1])) for row in c))
        zeros = np.roots(slope)
        inside = zeros.real[(abs(zeros.imag) < 1e-9) & (zeros.real > 0) & (zeros.real < 1)]
        values = [np.polyval(c[0, ::-1], z) ** 2 + np.polyval(c[1, ::-1], z) ** 2 for z in [0, 1, *inside]]
        assert min(values) * (1 + 1e-9) + 1e-24 >= D


def test_a_tie_goes_to_the_centre() -> None:
    parabola = np.array([[-1.0, 2.0, 0.0], [2.0, -16.0, 16.0]])  # symmetric about 1/2, nearest to the origin twice
    left, a = nearest(parabola, 0.0, 1.0, 0.3)
    right, b = nearest(parabola, 0.0, 1.0, 0.7)
    assert left == pytest.approx(1 - right, abs=1e-12)
    assert left < 0.5 < right
    assert a == pytest.approx(b, rel=1e-12)


def test_planted_footpoints_come_back() -> None:
    """Step off along the normal by less than the radius of curvature."""
    rng = np.random.default_rng(6)
    spline = Spline(smooth(rng, 24), prepare(smooth(rng, 24)).knots)
    t = spline.period * rng.random(200)
    tangent = spline(t, derivative=1)
    normal = tangent[:, ::-1] * [-1, 1] / np.hypot(*tangent.T)[:, None]
    radius = 1 / np.abs(spline.curvature(t)).max()
    step = radius * rng.uniform(-0.9, 0.9, 200)
    for parameter, point in zip(t, spline(t) + step[:, None] * normal, strict=True):
        reach = 0.02 * spline.period
        found = footpoint(spline, point, np.array([parameter - reach, parameter + reach]), parameter)
        k = int(np.searchsorted(spline.knots, parameter, side="right")) - 1
        h = spline.knots[k + 1] - spline.knots[k]
        b = spline.to_bezier()[k] - point
        power = np.stack([b[0], 3 * (b[1] - b[0]), 3 * (b[2] - 2 * b[1] + b[0]), b[3] - 3 * b[2] + 3 * b[1] - b[0]])
        y, _ = nearest(np.ascontiguousarray(power.T), 0.0, 1.0, 0.5)
        assert spline.knots[k] + h * y == pytest.approx(parameter, abs=1e-9)
        assert found == pytest.approx(parameter, abs=1e-9)


@pytest.mark.parametrize("variant", [1, 2])
def test_one_pass_finds_what_the_reference_finds(variant: int) -> None:
    rng = np.random.default_rng(11)
    for n in (5, 12, 60):
        p = uniform(rng, n)
        result = interpolate_batch(p, np.array([0, n]), Method(variant, max_iterations=0))
        problem = prepare(p, variant)
        spline = problem.spline(p)
        for i in range(n):
            low, high = problem.intervals.bounds[i]
            t = footpoint(spline, p[i], problem.intervals.bounds[i], problem.centres[i])
            ours, plain = spline(result.parameters[i]), spline(t)
            assert np.hypot(*(ours - p[i])) <= np.hypot(*(plain - p[i])) * (1 + 1e-12) + 1e-14
            sampled = spline(np.linspace(low, high, 400))
            assert np.hypot(*(ours - p[i])) <= np.hypot(*(sampled - p[i]).T).min() + 1e-12
