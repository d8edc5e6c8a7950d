"""Open arcs: Lemma 2 by the row sums of the free control points, at ends of every kind and for all knots."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.interpolation.intervals import basis_function
from glyphspline.interpolation.method import END_MARGIN, Method
from glyphspline.interpolation.reference import interpolate_reference, prepare
from glyphspline.types import FloatArray
from tests.polygons import random_polygon

Tangents: TypeAlias = "tuple[FloatArray | None, FloatArray | None]"

ENDS = ["tangents", "natural", "tangent and natural"]


def tangents(kind: str, seed: int) -> Tangents:
    first, last = np.random.default_rng(seed).standard_normal((2, 2))
    first, last = first / np.hypot(*first), last / np.hypot(*last)
    return {"tangents": (first, last), "natural": (None, None), "tangent and natural": (first, None)}[kind]


def uneven_ends(n: int, ratio: float, seed: int) -> FloatArray:
    """Points with chords of lengths 1 to 2 in random directions; the first and last are ``ratio`` times as long."""
    rng = np.random.default_rng(seed)
    angle, chords = rng.normal(0, 0.7, n - 1).cumsum(), rng.uniform(1, 2, n - 1)
    chords[[0, -1]] *= ratio
    steps = chords[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])


def largest_w1(s: Fraction, t: Fraction) -> Fraction:
    """B_1 + (N_0 + N_1)/2 on the knots 0, 0, 0, 0, s, 1, 1."""
    if t <= s:
        return Fraction(1, 2) + t**2 * (3 - (3 + 1 / s) * t) / (2 * s)
    return (1 - t) ** 2 * (2 * t + (t - s) / (1 - s) + (1 - t) / 2) / (1 - s)


def test_the_formula_of_the_proof_is_that_of_the_basis_functions() -> None:
    for s in np.random.default_rng(1).uniform(0.01, 0.99, 20):
        t = np.linspace(0.01, 0.99, 50)
        rows = [np.tile(np.array(w, dtype=float), (50, 1)) for w in ([0, 0, s, 1, 1], [0, 0, 0, 0, s], [0, 0, 0, s, 1])]
        values = basis_function(rows[0], t) + (basis_function(rows[1], t) + basis_function(rows[2], t)) / 2
        ours = [float(largest_w1(Fraction(s), Fraction(x))) for x in t]
        np.testing.assert_allclose(values, ours, atol=1e-12)


def test_the_three_cases_of_the_proof_keep_w1_above_five_eighths() -> None:
    """In exact arithmetic; the infimum is approached for s → 1."""
    for s in (Fraction(k, 500) for k in range(1, 500)):
        t = Fraction(1, 5) if 5 * s <= 1 else (s if 3 * s <= 1 else 2 * s / (1 + 3 * s))
        assert largest_w1(s, t) > Fraction(5, 8)
    near = Fraction(10**6 - 1, 10**6)
    assert max(largest_w1(near, Fraction(k, 2000)) for k in range(2001)) < Fraction(5, 8) + Fraction(1, 10**5)


@pytest.mark.parametrize("kind", ENDS)
def test_the_end_vertices_have_an_interval_with_a_margin_of_an_eighth_for_all_knots(kind: str) -> None:
    rng = np.random.default_rng(2)
    for seed in range(60):
        points = np.zeros((3 + seed % 2, 2))
        points[1:, 0] = np.cumsum(np.exp(rng.normal(0, 3, len(points) - 1)))
        points[1::2, 1] = rng.normal()
        r = gs.interpolate(points, 2, closed=False, end_tangents=tangents(kind, seed), margin=0.125)
        assert r.fallbacks == 0
        assert r.rate_bound <= 0.75 + 1e-12


@pytest.mark.parametrize("kind", ENDS)
@pytest.mark.parametrize("n", [3, 4, 5, 9])
@pytest.mark.parametrize("margin", [0.0, 0.02, 0.1])
def test_rows_of_free_control_points_add_up_to_at_most_1_minus_2c_on_the_intervals(
    kind: str, n: int, margin: float
) -> None:
    for seed in range(2):
        p = random_polygon(n, seed)
        problem = prepare(p, Method(2, margin=margin, closed=False), end_tangents=tangents(kind, seed))
        low, high = problem.intervals.bounds.T
        sums = []
        for share in np.linspace(0, 1, 21):
            B = problem.matrix(low + share * (high - low))
            sums.append(np.abs(np.eye(len(B)) - B).sum(axis=1))
        largest = np.max(sums, axis=0)
        assert largest.max() <= problem.intervals.rate_bound + 1e-12
        allowed = np.full(len(largest), 1 - 2 * margin)
        allowed[[0, -1]] = 1 - 2 * max(margin, END_MARGIN)
        if problem.intervals.fallbacks == 0 and problem.intervals.rate_bound <= allowed.max() + 1e-12:
            assert (largest <= allowed + 1e-9).all()
        # The intervals go as far as they may: a little beyond their ends inside of the curve the row is longer.
        for end, sign in ((low, -1), (high, 1)):
            beyond = np.clip(end + sign * 1e-5 * (problem.knots[-1]), problem.centres[:-2], problem.centres[2:])
            B = problem.matrix(beyond)
            moved = np.abs(beyond - end) > 0.9e-5 * problem.knots[-1]
            assert (np.abs(np.eye(len(B)) - B).sum(axis=1)[moved] > allowed[moved] - 1e-9).all()


@pytest.mark.parametrize("kind", ENDS)
def test_three_points_are_certified_by_default_and_converge_step_by_step(kind: str) -> None:
    for seed in range(40):
        p = random_polygon(3, seed) * ([1.0, 50.0] if seed % 2 else [1.0, 1.0])
        r = gs.interpolate(p, 2, closed=False, end_tangents=tangents(kind, seed), max_iterations=300)
        assert r.fallbacks == 0
        assert r.rate_bound <= 1 - 2 * END_MARGIN + 1e-12
        assert r.converged
        assert (r.residuals[1:] <= r.rate_bound * r.residuals[:-1] + 1e-12 * np.ptp(p)).all()


@pytest.mark.parametrize("kind", ENDS)
@pytest.mark.parametrize("ratio", [0.01, 0.1, 10, 100, 1000])
def test_chords_of_any_ratio_at_the_ends_are_certified(kind: str, ratio: float) -> None:
    for seed in range(6):
        p = uneven_ends(3 + 3 * seed, ratio, seed)
        r = gs.interpolate(
            p, closed=False, end_tangents=tangents(kind, seed), margin=0.02, max_iterations=400, diagnostics=seed < 2
        )
        assert r.fallbacks == 0
        assert r.rate_bound <= 0.96 + 1e-12
        assert r.converged
        assert (r.residuals[1:] <= r.rate_bound * r.residuals[:-1] + 1e-12 * np.ptp(p)).all()
        if r.rate_observed is not None:
            assert r.rate_observed <= r.rate_bound + 1e-12


def test_the_bound_is_that_of_the_rows_with_fixed_knots_too() -> None:
    """Variant 3: the rate bound is the norm of I - B at the knots, or above it away from the ends."""
    for seed, kind in enumerate(ENDS * 3):
        p = random_polygon(3 + seed, seed)
        problem = prepare(p, Method(3, closed=False), end_tangents=tangents(kind, seed))
        B = problem.matrix(problem.centres[problem.vertices])
        norm = np.abs(np.eye(len(B)) - B).sum(axis=1).max()
        assert problem.intervals.rate_bound == pytest.approx(norm, abs=1e-12)


@pytest.mark.parametrize("kind", ENDS)
@pytest.mark.parametrize(
    "options",
    [{}, {"margin": 0.02}, {"margin": 0.05, "fallback": "peak"}, {"margin": 0.3, "fallback": "peak"}, {"margin": 0.3}],
)
def test_compiled_intervals_are_those_of_the_reference(kind: str, options: dict[str, Any]) -> None:
    """On knots of very different intervals as well."""
    rng = np.random.default_rng(9)
    for n in (3, 4, 7):
        for spread in (0.3, 2.0):
            p = np.cumsum(rng.standard_normal((n, 2)) * np.exp(rng.normal(0, spread, (n, 1))), axis=0)
            given: dict[str, Any] = {"closed": False, "end_tangents": tangents(kind, n), **options}
            r, plain = (each(p, 2, max_iterations=0, **given) for each in (gs.interpolate, interpolate_reference))
            np.testing.assert_allclose(r.intervals, plain.intervals, atol=1e-7 * r.spline.knots[-1])
            assert r.rate_bound == pytest.approx(plain.rate_bound, abs=1e-9)
            assert r.fallbacks == plain.fallbacks


def test_ends_of_a_long_arc_have_the_intervals_of_a_short_one() -> None:
    for n in (65, 131):
        p = random_polygon(n, n)
        long, short = (gs.interpolate(q, 2, closed=False, max_iterations=0) for q in (p, p[-9:]))
        T = short.spline.knots[-1]
        np.testing.assert_allclose(
            long.intervals[-4:] - long.spline.knots[-1], short.intervals[-4:] - T, atol=1e-9 * long.spline.knots[-1]
        )
