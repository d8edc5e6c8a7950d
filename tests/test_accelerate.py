"""``finish="accelerate"``: fewer passes, the certificate kept by the safeguard, the same result every time."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.interpolation.driver import FALL
from glyphspline.interpolation.reference import interpolate_reference
from glyphspline.types import FloatArray

from .polygons import random_polygon


def uneven(n: int, seed: int) -> FloatArray:
    """A walk of steps of very different lengths, on which accelerated steps are taken back."""
    rng = np.random.default_rng([n, seed])
    return np.cumsum(rng.normal(size=(n, 2)) * np.exp(rng.normal(0, 1.5, (n, 1))), axis=0)


def taken_back(residuals: FloatArray) -> list[int]:
    """Passes whose error has not fallen by the factor, from the error of the last pass that stands."""
    passes, error, back = [], residuals[0], False
    for k, e in enumerate(residuals[1:], 1):
        back = not back and k > 1 and not e <= FALL * error
        if back:
            passes.append(k)
        else:
            error = e
    return passes


@pytest.mark.parametrize("variant", [1, 2, 3, 4])
@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("n", [4, 5, 11])
def test_agrees_with_the_reference(variant: int, closed: bool, n: int) -> None:
    for p in (random_polygon(n, 7), uneven(n, 7)):
        options: dict[str, Any] = {"closed": closed, "finish": "accelerate", "fallback": "peak", "max_iterations": 30}
        ours, plain = gs.interpolate(p, variant, **options), interpolate_reference(p, variant, **options)
        assert ours.iterations == plain.iterations
        np.testing.assert_allclose(ours.spline.control_points, plain.spline.control_points, atol=1e-7 * np.ptp(p))


@pytest.mark.parametrize("n", [10, 40, 127, 128, 129, 300])
@pytest.mark.parametrize("closed", [True, False])
def test_takes_half_the_passes_to_another_curve_through_the_vertices(n: int, closed: bool) -> None:
    p = random_polygon(n, 1)
    plain, fast = gs.interpolate(p, closed=closed), gs.interpolate(p, closed=closed, finish="accelerate")
    assert fast.converged
    assert 2 * fast.iterations <= plain.iterations
    np.testing.assert_allclose(fast.spline(fast.parameters), p, atol=5e-6)
    assert np.abs(fast.spline.control_points - plain.spline.control_points).max() > 1e-3


@pytest.mark.parametrize("closed", [True, False])
def test_a_polygon_among_many_has_the_bits_it_has_alone(closed: bool) -> None:
    polygons = [random_polygon(n, n) for n in (5, 6, 40, 300, 12, 9, 130, 7)] + [uneven(9, k) for k in range(20)]
    for variant in (2, 3):
        many = gs.interpolate_many(polygons, variant, closed=closed, finish="accelerate", threads=2)
        for p, r in zip(polygons, many, strict=True):
            alone = gs.interpolate(p, variant, closed=closed, finish="accelerate")
            assert np.array_equal(alone.spline.control_points, r.spline.control_points)
            assert np.array_equal(alone.residuals, r.residuals)


def test_every_step_that_stands_keeps_the_certificate() -> None:
    certified = 0
    for seed in range(200):
        p = random_polygon(9, seed)
        r = gs.interpolate(p, margin=0.02, finish="accelerate")
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
        plain, fast = (gs.interpolate(p, 3, finish=f, max_iterations=10**5) for f in ("iterate", "accelerate"))
        if plain.converged and fast.converged:
            met += bool(taken_back(fast.residuals))
            limit = np.linalg.solve(fast.spline.basis(fast.parameters), p)
            error = np.abs(fast.spline.control_points - limit).max()
            assert error <= 10 * np.abs(plain.spline.control_points - limit).max() + 1e-4 * np.ptp(p)
    assert met > 10


def test_diagnostics_are_of_plain_steps() -> None:
    with pytest.raises(gs.OptionError, match="plain steps"):
        gs.interpolate(random_polygon(6, 1), finish="accelerate", diagnostics=True)
