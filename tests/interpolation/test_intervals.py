"""Lemma 2, its corollary and Remark 3."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import BSpline

from glyphspline.interpolation.intervals import basis_function, level_interval, peaks, search_intervals
from glyphspline.types import FloatArray


def windows(count: int, degree: int = 3, spread: float = 1.0, seed: int = 0) -> FloatArray:
    """Random knots of basis functions, their spans lognormal."""
    h = np.exp(np.random.default_rng(seed).normal(0, spread, (count, degree + 1)))
    return np.concatenate([np.zeros((count, 1)), np.cumsum(h, axis=1)], axis=1)


@pytest.mark.parametrize("degree", range(2, 7))
def test_basis_function_and_its_peak_are_scipys(degree: int) -> None:
    for window in windows(20, degree):
        t = np.linspace(window[0], window[-1], 1001)
        oracle = BSpline.basis_element(window, extrapolate=False)(t)
        ours = basis_function(np.repeat(window[None], len(t), axis=0), t)
        np.testing.assert_allclose(ours, oracle, atol=1e-13)
        at = peaks(window[None])
        assert abs(at[0] - t[oracle.argmax()]) <= t[1]
        assert basis_function(window[None], at)[0] >= oracle.max()


def test_uniform_knots_give_the_interval_of_corollary_1() -> None:
    found = search_intervals(np.arange(-2.0, 3.0)[None], np.zeros(1), 2)
    np.testing.assert_allclose(found.bounds, [[-0.46617815, 0.46617815]], atol=5e-9)
    assert found.fallbacks == 0
    assert found.rate_bound == pytest.approx(1.0)


@pytest.mark.parametrize("margin", [0.0, 0.01, 0.05, 0.3])
def test_the_interval_is_where_the_basis_function_is_high_enough(margin: float) -> None:
    w = windows(300, spread=0.5)
    bounds = search_intervals(w, w[:, 2], 2, margin).bounds
    peak = peaks(w)
    highest = basis_function(w, peak)
    level = np.minimum(0.5 + margin, highest)
    high = highest > 0.5
    inside = bounds[:, :1] + np.linspace(0, 1, 9) * (bounds[:, 1:] - bounds[:, :1])
    for t in inside.T:
        assert (basis_function(w, t)[high] >= level[high] - 1e-12).all()
    for side, away in ((0, -1e-6), (1, 1e-6)):
        clipped = np.isin(bounds[:, side], w[:, [1, 3]])
        outside = basis_function(w, bounds[:, side] + away)
        assert (outside[high & ~clipped] < level[high & ~clipped]).all()
    assert (bounds[:, 0] <= peak + 1e-12)[high].all()
    assert (bounds[:, 1] >= peak - 1e-12)[high].all()
    assert (bounds >= w[:, [1]]).all()
    assert (bounds <= w[:, [3]]).all()


def test_remark_3_takes_the_knot_only_where_the_peak_is_low() -> None:
    w = windows(3000, spread=2.0)
    highest = basis_function(w, peaks(w))
    found = search_intervals(w, w[:, 2], 2, 0.02)
    low = highest <= 0.5
    assert low.any()
    assert found.fallbacks == low.sum()
    np.testing.assert_array_equal(found.bounds[low], np.stack([w[low, 2]] * 2, axis=1))


def test_peak_fallback_never_runs_empty_and_bounds_the_basis_from_below() -> None:
    w = windows(3000, spread=2.0)
    highest = basis_function(w, peaks(w))
    found = search_intervals(w, w[:, 2], 2, 0.02, "peak")
    level = np.minimum(0.52, 0.9 * highest)
    for side in (0, 1):
        assert (basis_function(w, found.bounds[:, side]) >= level - 1e-12).all()
    assert (found.bounds[:, 1] > found.bounds[:, 0]).all()


def test_rate_bound_is_theorem_2s() -> None:
    w = windows(40, spread=0.1)
    found = search_intervals(w, w[:, 2], 2, 0.05)
    least = min(basis_function(w, found.bounds[:, side]).min() for side in (0, 1))
    assert found.rate_bound == pytest.approx(2 * (1 - least))
    assert found.rate_bound == pytest.approx(0.9)


def test_the_other_variants_take_support_inner_spans_and_centre() -> None:
    w = windows(5)
    np.testing.assert_array_equal(search_intervals(w, w[:, 2], 0).bounds, w[:, [0, 4]])
    np.testing.assert_array_equal(search_intervals(w, w[:, 2], 1).bounds, w[:, [1, 3]])
    np.testing.assert_array_equal(search_intervals(w, w[:, 2], 3).bounds, w[:, [2, 2]])


def test_adjacent_knot_intervals_within_4_keep_every_peak_above_one_half() -> None:
    rng = np.random.default_rng(5)
    ratio = np.exp(rng.uniform(-np.log(4), np.log(4), (20000, 3)))
    h = np.cumprod(np.concatenate([np.ones((20000, 1)), ratio], axis=1), axis=1)
    w = np.concatenate([np.zeros((20000, 1)), np.cumsum(h, axis=1)], axis=1)
    assert basis_function(w, peaks(w)).min() > 0.525


def test_level_above_the_peak_gives_the_peak_alone() -> None:
    w = windows(10)
    peak = peaks(w)
    np.testing.assert_array_equal(level_interval(w, peak, np.ones(10)), np.stack([peak, peak], axis=1))


def test_clamped_windows_of_an_open_arc() -> None:
    w = np.array([[0.0, 0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0, 2.0, 2.0]])
    t = np.linspace(0, 3, 301)
    oracle = BSpline.basis_element(w[0], extrapolate=False)(t)
    np.testing.assert_allclose(basis_function(np.repeat(w[:1], 301, axis=0), t), np.nan_to_num(oracle), atol=1e-13)
    assert basis_function(w[1:], np.array([2.0]))[0] == pytest.approx(0.0)
    assert basis_function(np.array([[0.0, 1, 1, 1, 1]]), np.array([1.0]))[0] == pytest.approx(1.0)
