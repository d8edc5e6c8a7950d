"""The statements of docs/proofs.md in numbers: a seeded part of each computer-assisted step, and of what is seen."""

from __future__ import annotations

import itertools
import re
from fractions import Fraction
from functools import partial

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.curves.bspline import Spline
from glyphspline.interpolation.intervals import basis_function
from scripts.paper.certified import (
    POLYNOMIALS,
    Constraint,
    certify,
    corners_of,
    crossing,
    peak_values,
    root,
    threshold,
    windows_of,
    worst_corner,
)
from scripts.paper.common import is_verdict, random_polygons
from scripts.paper.lemmas import (
    OFFSETS,
    all_inside,
    appendix_a,
    characteristic,
    divided_difference,
    error_matrix,
)
from scripts.paper.local import LocalMethod, order_of
from scripts.paper.rates import (
    observed_rate,
    predicted_rate,
    random_order,
    reversible_weights,
    spectral_radius,
    zigzag,
)
from tests.places import ROOT

PAGE = ROOT / "docs" / "proofs.md"


@pytest.mark.parametrize(("constraint", "expected"), [("box", 10.258047469), ("adjacent", 6.159191247)])
def test_thresholds_of_cubics(constraint: Constraint, expected: float) -> None:
    found = threshold(3, constraint)
    assert found is not None
    assert found.ratio == pytest.approx(expected, abs=1e-9)
    # The worst intervals with a plain, independent evaluation: 1/2 there, and below it when they are more uneven.
    for h, low, high in (
        (np.array(found.intervals), 0.4999999, 0.5000001),
        (np.array(found.intervals) ** 1.01, 0, 0.5),
    ):
        t = np.linspace(0, h.sum(), 20_001)
        peak = basis_function(np.repeat(windows_of(h[None]), len(t), axis=0), t).max()
        assert low < peak < high


@pytest.mark.parametrize(("degree", "constraint"), sorted(POLYNOMIALS))
def test_closed_forms_of_thresholds(degree: int, constraint: Constraint) -> None:
    ratio = crossing(degree, constraint)
    assert worst_corner(degree, ratio, constraint)[0] == pytest.approx(0.5, abs=1e-13)
    low, high = root(POLYNOMIALS[degree, constraint], ratio)
    assert low < ratio < high
    with pytest.raises(ArithmeticError):
        root(POLYNOMIALS[degree, constraint], ratio + 1e-6)
    assert max(x.real for x in np.roots(POLYNOMIALS[degree, constraint])) == pytest.approx(ratio, rel=1e-12)


def test_trigonometric_forms() -> None:
    assert crossing(4, "box") == pytest.approx(4 * np.cos(np.pi / 9), rel=1e-13)
    assert crossing(5, "box") == pytest.approx(2 * np.cos(np.pi / 9), rel=1e-13)


@pytest.mark.parametrize("constraint", ["box", "adjacent"])
def test_discriminants_of_the_worst_corners(constraint: Constraint) -> None:
    """N - 1/2 on the span of the peak, at more integers than the rational functions have degrees: an identity."""
    for x in map(Fraction, range(2, 100)):
        if constraint == "box":
            h, denominator = [Fraction(1), x, Fraction(1), Fraction(1)], x * (x + 1) ** 4 * (x + 2) ** 4
        else:
            h, denominator = [x, x * x, x, Fraction(1)], x**7 * ((x + 1) * (x + 2) * (x * x + x + 1)) ** 2
        u = [sum(h[:k], Fraction(0)) for k in range(5)]
        at = [u[1] + Fraction(k, 3) * h[1] for k in range(4)]
        a, b, c, d = _cubic_through(at, [divided_difference(u, t) - Fraction(1, 2) for t in at])
        discriminant = b * b * c * c - 4 * a * c**3 - 4 * b**3 * d - 27 * a * a * d * d + 18 * a * b * c * d
        polynomial = sum(k * x ** (3 - i) for i, k in enumerate(POLYNOMIALS[3, constraint]))
        assert discriminant == -27 * polynomial / (4 * denominator)


def _cubic_through(t: list[Fraction], y: list[Fraction]) -> list[Fraction]:
    """Coefficients by descending powers of the cubic through four points (Lagrange)."""
    total = [Fraction(0)] * 4
    for i in range(4):
        roots = [t[j] for j in range(4) if j != i]
        scale = y[i] / ((t[i] - roots[0]) * (t[i] - roots[1]) * (t[i] - roots[2]))
        p, q, r = roots
        for k, c in enumerate((Fraction(1), -(p + q + r), p * q + p * r + q * r, -p * q * r)):
            total[k] += scale * c
    return total


def test_a_box_that_holds_a_lower_peak_is_not_settled() -> None:
    ratio = 2
    check = partial(certify, 3, ratio, "adjacent", most=150)
    least = worst_corner(3, ratio, "adjacent")[0]
    assert check(least - 1e-6) is not None
    assert check(least + 1e-6) is None
    assert check(least + 1e-6, corners=True) is None
    assert check(least, corners=True) is not None
    assert corners_of(3, ratio, "adjacent")[1].min() == least


def test_no_peak_is_below_four_ninths() -> None:
    h = np.exp(np.random.default_rng(1).uniform(-12, 12, (4000, 4)))
    assert peak_values(h).min() > 4 / 9
    s = np.array([0.5, 0.6, 0.9, 0.999])
    tiny = np.full_like(s, 1e-10)
    assert peak_values(np.stack([tiny, s, 1 - s, tiny], axis=1)) == pytest.approx(4 * s / (1 + 2 * s) ** 2, abs=1e-9)


def test_lemma_1_example_exactly() -> None:
    A, B = (error_matrix(o) for o in OFFSETS)
    product = B @ A
    for M in (A, B):
        assert all(sum(row) == 0 for row in M)
        assert all_inside(characteristic(M), Fraction(91, 100))
        assert not all_inside(characteristic(M), Fraction(89, 100))
    assert not all_inside(characteristic(product), Fraction(3, 2))
    assert all_inside(characteristic(product), Fraction(8, 5))
    # The same by the program's own basis functions and floating point.
    curve = Spline(np.zeros((5, 2)), np.arange(6.0))
    floats = [np.eye(5) - curve.basis(np.arange(5) + np.array(o) / 100) for o in OFFSETS]
    np.testing.assert_allclose(np.array(product, dtype=float), floats[1] @ floats[0], atol=1e-14)
    assert spectral_radius(floats[1] @ floats[0]) > 1.53
    assert all(abs(o) <= 100 for offsets in OFFSETS for o in offsets)


def test_the_test_of_schur_and_cohn() -> None:
    rng = np.random.default_rng(2)
    for _ in range(200):
        zeros = rng.normal(size=3) * 0.7
        polynomial = [Fraction(c) for c in np.poly(zeros).tolist()]
        assert all_inside(polynomial, Fraction(1)) == bool((np.abs(zeros) < 1).all())


def test_appendix_a_exactly() -> None:
    u = [Fraction(k) for k in (0, 1, 3, 4, 9)]
    for t in [Fraction(k, 7) for k in range(64)]:
        assert appendix_a(u, t) == divided_difference(u, t)
    assert appendix_a(u, Fraction(1)) == Fraction(1, 12)


@pytest.mark.parametrize("sigma", [0.0, 1.0, 3.0])
def test_variant_3_is_a_reversible_chain(sigma: float) -> None:
    rng = np.random.default_rng(3)
    for n in (4, 5, 12, 30):
        h = np.exp(rng.normal(0, sigma, n))
        knots = np.concatenate([[0.0], np.cumsum(h)])
        B = Spline(np.zeros((n, 2)), knots).basis(knots[:-1])
        flow = reversible_weights(h)[:, None] * B
        scale = np.sqrt(np.outer(np.diag(flow), np.diag(flow)))
        assert np.abs(flow - flow.T).max() <= 1e-7 * flow.max()
        assert (np.abs(flow - flow.T) / scale).max() < 1e-7
        values = np.linalg.eigvals(B)
        assert np.abs(values.imag).max() < 1e-9
        assert values.real.min() > 0
        assert values.real.max() <= 1 + 1e-9


def test_inequalities_of_the_proof_at_margin_zero() -> None:
    """B_i(u_{i+1}) ≥ 1/2 only if h_{i+1} > h_{i-1}, so that never B_{i+1}(u_i) ≥ 1/2 as well."""
    rng = np.random.default_rng(4)
    reached = 0
    for h in np.exp(rng.normal(0, 3, (500, 5))):
        u = np.concatenate([[0.0], np.cumsum(h)])
        right = basis_function(u[None, :5], u[None, 3])[0]  # B_i(u_{i+1}), i being the third knot
        left = basis_function(u[None, 1:], u[None, 2])[0]  # B_{i+1}(u_i)
        assert right == pytest.approx(h[3] ** 2 / ((h[2] + h[3]) * (h[1] + h[2] + h[3])), rel=1e-6)
        assert left == pytest.approx(h[1] ** 2 / ((h[1] + h[2]) * (h[1] + h[2] + h[3])), rel=1e-6)
        assert right < 0.5 or h[3] > h[1]
        assert not (right >= 0.5 and left >= 0.5)
        reached += right >= 0.5
    assert reached > 20


@pytest.mark.parametrize("variant", [2, 4])
def test_the_asymptotic_rate_is_that_of_the_matrix(variant: int) -> None:
    runs = gs.interpolate_many(random_polygons(8, 12, 9), variant, residual_tolerance=1e-12, max_iterations=3000)
    gaps = [abs(observed_rate(r) - predicted_rate(r, variant == 4)) for r in runs]
    assert np.median(gaps) < 2e-3
    # Without the products of normals, or with the other algorithm's matrix, it is not.
    bare = [spectral_radius(np.eye(8) - r.spline.basis(r.parameters)) for r in runs]
    other = [predicted_rate(r, variant != 4) for r in runs]
    for wrong in (bare, other):
        assert np.median([abs(observed_rate(r) - w) for r, w in zip(runs, wrong, strict=True)]) > 0.02


@pytest.mark.parametrize("margin", [0.0, 0.05])
def test_any_fixed_order_of_blocks_contracts(margin: float) -> None:
    rng = np.random.default_rng(5)
    for p in random_polygons(8, 4, 11):
        method = LocalMethod(p, 2, margin=margin)
        corrections = np.array(method.run(random_order(8, rng))[1])
        assert corrections[-1] < 1e-6
        assert (corrections[1:] <= method.rate_bound * corrections[:-1] * (1 + 1e-9)).all()


def test_random_orders_hold_every_vertex_once() -> None:
    rng = np.random.default_rng(6)
    orders = [random_order(7, rng) for _ in range(50)]
    assert all(sorted(itertools.chain(*order)) == list(range(7)) for order in orders)
    assert {len(order) for order in orders} > {2, 3}


@pytest.mark.parametrize("variant", [1, 2, 3, 4])
def test_the_plain_way_is_the_method(variant: int) -> None:
    for p in random_polygons(7, 2, 12):
        P, corrections = LocalMethod(p, variant).run(order_of(variant, 7))
        r = gs.interpolate(p, variant, residual_tolerance=1e-6)
        assert len(corrections) - 1 == r.iterations
        np.testing.assert_allclose(corrections, r.residuals, rtol=1e-6, atol=1e-12)
        # Of Algorithm 3's last sweep the program keeps the updates.
        np.testing.assert_allclose(P, r.spline.control_points, atol=1e-9 if variant != 4 else 1e-6)


def test_theorem_2_is_sharp_for_free_knots() -> None:
    points, knots = zigzag(400)
    r = gs.interpolate(points, 2, knots=knots, margin=0.05, max_iterations=3)
    factors = r.residuals[1:] / r.residuals[:-1]
    assert r.rate_bound == pytest.approx(0.9, abs=1e-6)
    assert 0.8999 < factors.max() <= r.rate_bound + 1e-9


def test_a_proof_is_for_a_hypothesis() -> None:
    assert is_verdict("proven for cubics")
    assert is_verdict("differs")
    assert not is_verdict("proven, nearly")


def test_every_claim_that_the_proofs_name_is_made() -> None:
    made = set()
    for file in (ROOT / "scripts" / "paper").glob("*.py"):
        made |= set(re.findall(r'"((?:beyond|theorem|lemma)-[a-z0-9-]+)"', file.read_text(encoding="utf-8")))
    named = set(re.findall(r"`((?:beyond|theorem|lemma)-[a-z0-9-]+)`", PAGE.read_text(encoding="utf-8")))
    assert named
    assert named <= made
