"""The paper's smaller statements: Lemmas 1 and 2, Corollary 1's convergence, Appendix A's formula, the tie rule."""

from __future__ import annotations

from fractions import Fraction
from math import prod

import numpy as np

import glyphspline as gs
from glyphspline.interpolation.intervals import basis_function, peaks
from glyphspline.types import FloatArray

from .common import SEED, Run, random_polygons, verdict
from .local import LocalMethod
from .study import TOLERANCE
from .theorems import step_factors

Matrix = np.ndarray
"""Of dtype object, whose entries are fractions: products are exact."""

OFFSETS = ((100, 26, -8, -58, 100), (-97, 20, 22, -22, -100))
"""Footpoints less their knots, in hundredths, of two steps on five uniform knots: within variant 1's intervals."""

LOOK = 201
"""Values of a basis function between the neighbouring knots."""


def appendix_a(u: list[Fraction], t: Fraction) -> Fraction:
    """Appendix A: the basis function on the knots u_{i-2} … u_{i+2} at t, branch by branch."""
    a, b, c, d, e = u
    if a <= t < b:
        return (t - a) ** 3 / ((d - a) * (c - a) * (b - a))
    if b <= t < c:
        first = (t - a) * (c - t) / ((c - a) * (c - b)) + (d - t) * (t - b) / ((d - b) * (c - b))
        return (t - a) / (d - a) * first + (e - t) / (e - b) * (t - b) ** 2 / ((d - b) * (c - b))
    if c <= t < d:
        second = (t - b) * (d - t) / ((d - b) * (d - c)) + (e - t) * (t - c) / ((e - c) * (d - c))
        return (t - a) / (d - a) * (d - t) ** 2 / ((d - c) * (d - b)) + (e - t) / (e - b) * second
    if d <= t <= e:
        return (e - t) ** 3 / ((e - d) * (e - c) * (e - b))
    return Fraction(0)


def divided_difference(u: list[Fraction], t: Fraction) -> Fraction:
    """The same by definition: (u_{i+2} - u_{i-2}) [u_{i-2} … u_{i+2}] (s - t)_+^3."""
    terms = [max(s - t, Fraction(0)) ** 3 / prod(s - r for r in u if r != s) for s in u]
    return (u[-1] - u[0]) * sum(terms, Fraction(0))


def error_matrix(offsets: tuple[int, ...]) -> Matrix:
    """I - B, exactly, on uniform knots, for footpoints at u_i + offset / 100."""
    n = len(offsets)
    found = np.eye(n, dtype=object)
    for i, o in enumerate(offsets):
        for j in range(-2, 3):
            knots = [Fraction(i + j + k) for k in range(-2, 3)]
            found[i, (i + j) % n] -= divided_difference(knots, i + Fraction(o, 100))
    return found


def characteristic(A: Matrix) -> list[Fraction]:
    """Coefficients, by descending powers, of det(λ - A): the method of Faddeev and Le Verrier."""
    one = np.eye(len(A), dtype=object)
    coefficients, M = [Fraction(1)], 0 * one
    for k in range(1, len(A) + 1):
        M = A @ M + coefficients[-1] * one
        coefficients.append(-np.trace(A @ M) / k)
    return coefficients


def all_inside(polynomial: list[Fraction], radius: Fraction) -> bool:
    """Whether all zeros lie inside the circle of this radius: the test of Schur and Cohn, without rounding."""
    n = len(polynomial) - 1
    a = [c * radius ** (n - k) for k, c in enumerate(polynomial)]
    while len(a) > 1:
        if abs(a[-1]) >= abs(a[0]):
            return False
        a = [a[0] * x - a[-1] * y for x, y in zip(a[:-1], a[:0:-1], strict=True)]
    return True


def lemma_1(run: Run) -> None:
    """Two matrices of spectral radius below 0.91 whose product has one above 1.5, decided in exact arithmetic."""
    A, B = map(error_matrix, OFFSETS)
    product = B @ A
    below, above = Fraction(91, 100), Fraction(3, 2)
    single = all(all_inside(characteristic(M), below) for M in (A, B))
    grows = not all_inside(characteristic(product), above)
    if not (single and grows):
        raise ArithmeticError("the example of Lemma 1 does not hold")
    floats = {name: M.astype(np.float64) for name, M in (("first", A), ("second", B), ("product", product))}
    measured = {
        "vertices": len(A),
        "spectral radius of each": {k: float(np.abs(np.linalg.eigvals(floats[k])).max()) for k in floats},
        "each below 0.91 and the product above 1.5, exactly": single and grows,
    }
    run.claim("lemma-1", measured, "differs")


def lemma_2(run: Run) -> None:
    """The intervals the program computes against a dense look at the basis functions."""
    c = 0.02
    count = run.size(50, 5)
    polygons = random_polygons(20, count)
    wrong = inside = vertices = 0
    for p, r in zip(polygons, gs.interpolate_many(polygons, 2, margin=c, max_iterations=0), strict=True):
        u = LocalMethod(p, 1).knots
        n = len(p)
        index = np.arange(n)[:, None] + np.arange(-2, 3)
        windows = u[index % n] + index // n * u[-1]
        top = peaks(windows)
        level = np.minimum(0.5 + c, basis_function(windows, top))
        x = np.linspace(windows[:, 1], windows[:, 3], LOOK, axis=1)
        near = 1e-9 * (windows[:, 4] - windows[:, 0])
        values = basis_function(np.repeat(windows, x.shape[1], axis=0), x.ravel()).reshape(x.shape)
        low, high = r.intervals.T
        has = basis_function(windows, top) > 0.5
        within = (x >= (low + near)[:, None]) & (x <= (high - near)[:, None])
        beyond = (x <= (low - near)[:, None]) | (x >= (high + near)[:, None])
        bad = (within & (values < level[:, None])) | (beyond & (values > level[:, None]))
        wrong += int(((bad.any(axis=1) | (top < low - near) | (top > high + near)) & has).sum())
        inside += int((((low <= u[:-1]) & (u[:-1] <= high)) & has).sum())
        vertices += int(has.sum())
    measured = {
        "c": c,
        "vertices": vertices,
        "intervals that are wrong": wrong,
        "u_i inside, %": 100 * inside / vertices,
    }
    run.claim("lemma-2", measured, verdict(wrong == 0), look=LOOK)


def corollary_1_converges(run: Run) -> None:
    """Uniform knots and c = 0: what Corollary 1 says, and Theorem 2 does not give."""
    groups = [random_polygons(n, run.size(200, 4), SEED + 3) for n in run.groups[:: run.size(2, 1)]]
    results = [r for g in groups for r in gs.interpolate_many(g, 2, knots="uniform", residual_tolerance=TOLERANCE)]
    measured = {
        "polygons": len(results),
        "not converged": sum(not r.converged for r in results),
        "largest factor of a step": max(step_factors(r.residuals).max(initial=0.0) for r in results),
        "most iterations": max(r.iterations for r in results),
    }
    run.claim("corollary-1-converges", measured, verdict(all(r.converged for r in results)))


def appendix_a_holds(run: Run) -> None:
    """Appendix A's four branches against the divided difference, in rational arithmetic."""
    rng = np.random.default_rng(SEED)
    count = run.size(1000, 100)
    equal = ends = 0
    for _ in range(count):
        h = [Fraction(int(x), 997) for x in rng.integers(1, 997, 4)]
        u = [sum(h[:k], Fraction(0)) for k in range(5)]
        t = u[-1] * Fraction(int(rng.integers(1, 991)), 991)
        equal += appendix_a(u, t) == divided_difference(u, t)
        ends += sum(appendix_a(u, x) == divided_difference(u, x) for x in u)
    measured = {"knot vectors": count, "equal inside": equal, "equal at knots, of five each": ends}
    run.claim("appendix-a", measured, verdict(equal == count and ends == 5 * count))


def tie_rule(run: Run) -> None:
    """How often two points of the curve are equally near: on random polygons, and on polygons with an axis."""
    count, steps = run.size(15, 2), 8
    measured = {}
    for kind, polygons, looked_at in (
        ("random polygons", random_polygons(10, count), range(10)),
        ("vertices on an axis of symmetry", symmetric_polygons(2 * count), (0, 5)),
    ):
        ties = {0: 0, 1: 0}
        for variant in ties:
            for p in polygons:
                method, P = LocalMethod(p, variant), p
                for _ in range(steps):
                    ties[variant] += sum(_tied(*method.candidates(P, i)) for i in looked_at)
                    P, _largest = method.sweep(P, [range(len(p))])
        measured[kind] = {
            "footpoints": len(polygons) * steps * len(looked_at),
            "ties, variant 0": ties[0],
            "ties, variant 1": ties[1],
        }
    run.claim("tie-rule", measured, "measured", steps=steps)


def _tied(parameters: FloatArray, deviations: FloatArray) -> bool:
    """Whether two different parameters share the least squared distance, which is not zero."""
    squared = (deviations**2).sum(axis=1)
    near = parameters[squared <= squared.min() * (1 + 1e-9)]
    return bool(squared.min() > 1e-20 and np.ptp(near) > 1e-6)


def symmetric_polygons(count: int) -> list[FloatArray]:
    """Polygons of ten vertices, two of them on the axis of symmetry."""
    rng = np.random.default_rng([SEED, 10])
    found = []
    for _ in range(count):
        half = rng.uniform(0, 5, (4, 2))
        axis = np.stack([np.zeros(2), rng.uniform(0, 5, 2)], axis=1)
        found.append(np.concatenate([axis[:1], half, axis[1:], half[::-1] * [-1, 1]]))
    return found
