"""How much curvature varies: known shapes, and its derivative by differences."""

from __future__ import annotations

import numpy as np
import pytest

from glyphspline.curves.bezier import derivative_points, evaluate
from glyphspline.plugins.experiments.measures import curvature_variation
from tests.drawings import circle
from tests.fitting.test_fairness import curvatures, stadium
from tests.polygons import square_contour


def test_variation_of_an_ellipse_and_of_lines() -> None:
    a, b = 200.0, 100.0
    t = 2 * np.pi * np.arange(4096) / 4096
    speed = np.sqrt((a * np.sin(t)) ** 2 + (b * np.cos(t)) ** 2)
    slope = -3 * a * b * (a**2 - b**2) * np.sin(t) * np.cos(t) / speed**6
    expected = (slope**2 * speed).mean() * 2 * np.pi
    assert curvature_variation(circle(100.0, 64) * [2, 1]) == pytest.approx(expected, rel=1e-3)
    assert curvature_variation(1e3 * circle(100.0, 64) * [2, 1]) == pytest.approx(expected / 1e9, rel=1e-3)
    assert curvature_variation(square_contour().cubics()) == 0.0
    assert curvature_variation(stadium()) == pytest.approx(curvature_variation(circle(50.0, 4)))  # without the jumps


def test_variation_is_the_derivative_of_curvature() -> None:
    cubics = np.array([[[0.0, 0], [120, 90], [210, -20], [330, 60]]])
    x = np.linspace(0, 1, 20001)
    velocity = evaluate(np.broadcast_to(derivative_points(cubics, 1), (len(x), 3, 2)), x)
    slope = np.gradient(curvatures(cubics, 20000), x) / np.hypot(*velocity.T)
    expected = np.trapezoid(slope**2 * np.hypot(*velocity.T), x)
    assert curvature_variation(cubics) == pytest.approx(expected, rel=1e-4)
