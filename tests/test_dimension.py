"""The plain reference in R^d: nothing in the method needs the plane."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.interpolation.reference import interpolate_reference

from .polygons import random_polygon


@pytest.mark.parametrize(
    "options",
    [
        {}, {"variant": 1}, {"variant": 4}, {"degree": 4}, {"closed": False}, {"finish": "solve"},
        {"finish": "accelerate"},
    ],
)  # fmt: skip
def test_a_plane_in_space_has_the_curve_of_the_plane(options: dict[str, Any]) -> None:
    p = random_polygon(9, 1)
    frame = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 2)))[0]
    flat = interpolate_reference(p, residual_tolerance=1e-6, **options)
    space = interpolate_reference(p @ frame.T, residual_tolerance=1e-6, **options)
    assert space.iterations == flat.iterations
    np.testing.assert_allclose(space.parameters, flat.parameters, atol=1e-8)
    np.testing.assert_allclose(space.spline.control_points, flat.spline.control_points @ frame.T, atol=1e-8)
    assert space.spline([0.1, 0.2], derivative=1).shape == (2, 3)


@pytest.mark.parametrize("d", [3, 6])
def test_theorem_2_holds_in_any_dimension(d: int) -> None:
    p = np.random.default_rng(d).uniform(0, 5, (8, d))
    r = interpolate_reference(p, margin=0.02, residual_tolerance=1e-6)
    assert r.converged
    assert r.rate_bound < 1
    assert (r.residuals[1:] <= r.rate_bound * r.residuals[:-1] + 1e-12).all()
    np.testing.assert_allclose(r.spline(r.parameters), p, atol=1e-6)


def test_the_public_functions_stay_in_the_plane() -> None:
    with pytest.raises(gs.PolygonError, match=r"shape \(n, 2\)"):
        gs.interpolate(np.zeros((5, 3)))
    with pytest.raises(gs.PolygonError, match="shape"):
        interpolate_reference(np.zeros((5, 1)))
