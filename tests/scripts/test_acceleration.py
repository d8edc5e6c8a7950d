"""Accelerated passes of the paper's page: fewer of them, the certificate kept by the safeguard."""

from __future__ import annotations

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.types import FloatArray
from scripts.paper.acceleration import FALL, accelerated, taken_back
from tests.polygons import random_polygon


def uneven(n: int, seed: int) -> FloatArray:
    """A walk of steps of very different lengths, on which accelerated steps are taken back."""
    rng = np.random.default_rng([n, seed])
    return np.cumsum(rng.normal(size=(n, 2)) * np.exp(rng.normal(0, 1.5, (n, 1))), axis=0)


@pytest.mark.parametrize("n", [10, 40, 127, 128, 129, 300])
@pytest.mark.parametrize("closed", [True, False])
def test_takes_half_the_passes_to_another_curve_through_the_vertices(n: int, closed: bool) -> None:
    p = random_polygon(n, 1)
    plain, fast = gs.interpolate(p, closed=closed), accelerated(p, closed=closed)
    assert fast.converged
    assert 2 * fast.iterations <= plain.iterations
    np.testing.assert_allclose(fast.spline(fast.parameters), p, atol=5e-6)
    assert np.abs(fast.spline.control_points - plain.spline.control_points).max() > 1e-3


def test_every_step_that_stands_keeps_the_certificate() -> None:
    certified = 0
    for seed in range(200):
        p = random_polygon(9, seed)
        r = accelerated(p, margin=0.02)
        assert r.converged
        if r.rate_bound < 1:
            certified += 1
            stands = np.delete(r.residuals, taken_back(r.residuals))
            assert (stands[1:] <= max(FALL, r.rate_bound) * stands[:-1]).all()
    assert certified > 100


def test_variant_3_takes_steps_back_and_still_converges() -> None:
    """Its limit is one curve, whatever the way to it; its largest error may grow in a step."""
    met = 0
    for seed in range(60):
        p = uneven(8, seed)
        plain, fast = (each(p, 3, max_iterations=10**5) for each in (gs.interpolate, accelerated))
        if plain.converged and fast.converged:
            met += bool(taken_back(fast.residuals))
            limit = np.linalg.solve(fast.spline.basis(fast.parameters), p)
            error = np.abs(fast.spline.control_points - limit).max()
            assert error <= 10 * np.abs(plain.spline.control_points - limit).max() + 1e-4 * np.ptp(p)
    assert met > 10
