"""Certified nearest points: planted ones come back, and nothing found by dense sampling is nearer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.curves.bspline import Spline
from glyphspline.interpolation.batch import interpolate_batch
from glyphspline.interpolation.kernels.footpoint import WORK, search_piece
from glyphspline.interpolation.method import Method
from glyphspline.interpolation.polygon import Polygons
from glyphspline.interpolation.reference import prepare
from glyphspline.interpolation.roots import footpoint
from scripts.adversarial_footpoints import BOUND, attack, attacks
from tests.polygons import smooth, uniform


def nearest(coefficients: np.ndarray, low: float, high: float, centre: float) -> tuple[float, float]:
    """The search on one piece from nothing."""
    degree = coefficients.shape[1] - 1
    y, D, certified = search_piece(coefficients, degree, low, high, centre, centre, np.inf, 0.0, np.empty(WORK))
    assert certified
    return y, D


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


def test_an_end_beyond_a_flat_stretch_is_found() -> None:
    """D' has nearly a triple zero inside, where Newton's method stops; the end of the piece is nearer by 5.4e-3."""
    c = np.array(
        [
            [1.15354338, 4.65577381, 0.104907544, -0.459386038],
            [7.23251355, -0.731768856, -1.62569386, -0.00154457925],
        ]
    )
    x, D, certified = search_piece(c, 3, 0.0, 1.0, 0.0, 0.385849890658987, np.inf, 1e-28, np.empty(WORK))
    assert certified
    assert x == 1.0
    assert pytest.approx(np.hypot(*c.sum(axis=1)), rel=1e-14) == np.sqrt(D)


def test_on_the_evolute_the_search_ends_at_once() -> None:
    """p is the centre of curvature of a parabola's apex, y = x²: D = 1/4 + x⁴, and no certificate holds near 0."""
    c = np.array([[0.0, 1.0, 0.0], [-0.5, 0.0, 1.0]])
    for low, high in ((-1.0, 1.0), (-0.3, 1.0), (0.0, 1.0), (-1.0, 0.0)):
        x, D = nearest(c, low, high, 0.9)
        assert D <= 0.25 * (1 + 1e-12)
        assert abs(x) < 2e-3


@pytest.mark.parametrize(
    ("name", "degree"), [(name, degree) for name, degree, *_ in attacks(100, 100, 0)], ids=lambda value: str(value)
)
def test_adversarial_cases_are_within_the_bound(name: str, degree: int) -> None:
    """A seeded share of what ``make check-reference`` tries."""
    found = attack(name, degree, 40_000, 16, seed=7)
    assert found.uncertified == 0
    assert max(found.miss, found.sampled) <= BOUND, found


def test_a_search_that_gives_up_says_so() -> None:
    """Where the curve is not finite nothing is certified, and the result counts it."""
    *_, certified = search_piece(np.full((2, 4), np.nan), 3, 0.0, 1.0, 0.5, 0.5, np.inf, 0.0, np.empty(WORK))
    assert not certified


@pytest.mark.parametrize(
    "options", [{"variant": 2}, {"variant": 1}, {"variant": 0, "max_iterations": 5}, {"variant": 4}]
)
def test_footpoints_of_a_result_are_certified(options: dict[str, int]) -> None:
    result = gs.interpolate(uniform(np.random.default_rng(3), 20), **options)  # type: ignore[arg-type]
    assert result.uncertified == 0
    assert "uncertified" not in repr(result)
    assert "2 uncertified footpoints" in repr(replace(result, uncertified=2))


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
    spline = Spline(smooth(rng, 24), prepare(smooth(rng, 24), Method()).knots)
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
        result = interpolate_batch(Polygons(p, np.array([0, n])), Method(variant, max_iterations=0))
        problem = prepare(p, Method(variant))
        spline = problem.spline(p)
        for i in range(n):
            low, high = problem.intervals.bounds[i]
            t = footpoint(spline, p[i], problem.intervals.bounds[i], problem.centres[i])
            ours, plain = spline(result.arrays.parameters[i]), spline(t)
            assert np.hypot(*(ours - p[i])) <= np.hypot(*(plain - p[i])) * (1 + 1e-12) + 1e-14
            sampled = spline(np.linspace(low, high, 400))
            assert np.hypot(*(ours - p[i])) <= np.hypot(*(sampled - p[i]).T).min() + 1e-12
