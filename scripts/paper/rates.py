"""How fast the iteration converges in the end, what its limits are, variant 3, and how sharp Theorem 2 is."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

import glyphspline as gs
from glyphspline.curves.bspline import Spline
from glyphspline.types import BoolArray, FloatArray

from .common import SEED, Run, random_polygons
from .local import LocalMethod
from .study import TOLERANCE
from .theorems import MARGIN

TIGHT = 1e-12
"""Residual tolerance of runs whose last factors are measured."""

TAIL = 30
"""Last steps over which the mean factor of a run is taken."""


def spectral_radius(A: FloatArray) -> float:
    """The largest modulus of an eigenvalue."""
    return float(np.abs(np.linalg.eigvals(A)).max())


def at_an_end(r: gs.Interpolation) -> BoolArray:
    """(n,) footpoints at an end of their interval."""
    low, high = r.intervals.T
    near = 1e-9 * (high - low)
    return np.asarray((r.parameters <= low + near) | (r.parameters >= high - near))


def unit_normals(spline: Spline, t: FloatArray) -> FloatArray:
    """(n, 2) normals of the curve at t."""
    tangent = spline(t, derivative=1)
    return np.stack([-tangent[:, 1], tangent[:, 0]], axis=1) / np.hypot(*tangent.T)[:, None]


def predicted_rate(r: gs.Interpolation, in_turn: bool) -> float:
    """The asymptotic factor at a limit: of I - B∘G, with 2 × 2 blocks for footpoints at an end of their interval.

    Args:
        in_turn: of a sweep of Algorithm 3 instead of a step of Algorithm 2.
    """
    B = r.spline.basis(r.parameters)
    n = len(B)
    N = unit_normals(r.spline, r.parameters)
    onto = np.where(at_an_end(r)[:, None, None], np.eye(2), N[:, :, None] * N[:, None, :])
    blocks = np.zeros((n, 2, n, 2))
    blocks[np.arange(n), :, np.arange(n), :] = onto
    Q = blocks.reshape(2 * n, 2 * n)
    A = Q @ np.kron(B, np.eye(2)) @ Q
    if not in_turn:
        return spectral_radius(Q - A)
    before = np.kron(np.tri(n, n, -1), np.ones((2, 2))) * A
    sweep = np.linalg.solve(np.eye(2 * n) + before, Q - (A - before))
    return spectral_radius(np.asarray(sweep, dtype=np.float64))


def observed_rate(r: gs.Interpolation) -> float:
    """Mean factor of the last steps."""
    k = min(TAIL, r.iterations // 2)
    return float((r.residuals[-1] / r.residuals[-1 - k]) ** (1 / k))


def asymptotic_rate(run: Run) -> None:
    """The factor read off a run's last steps against the spectral radius at its limit."""
    polygons = [p for n in (5, 10, 20, 30) for p in random_polygons(n, run.size(50, 3), SEED + 4)]
    measured = {}
    for v in (2, 4):
        runs = gs.interpolate_many(polygons, v, residual_tolerance=TIGHT, max_iterations=5000)
        inside = np.array([not at_an_end(r).any() for r in runs])
        predicted = np.array([predicted_rate(r, v == 4) for r in runs])
        gap = np.abs(np.array([observed_rate(r) for r in runs]) - predicted)
        measured[f"variant {v}"] = {
            "runs": len(runs),
            "all footpoints inside": int(inside.sum()),
            "median predicted": float(np.median(predicted)),
            "greatest predicted": float(predicted.max()),
            "median difference": float(np.median(gap)),
            "90 % below": float(np.quantile(gap, 0.9)),
            "greatest difference": float(gap.max()),
        }
    run.claim(
        "beyond-rate",
        measured,
        "proven for limits with C′ ≠ 0 at the footpoints, these inside their intervals and their only ones",
        tail=TAIL,
        tight=TIGHT,
    )


def rate_at_knots(run: Run) -> None:
    """ρ(I - B∘G) with all footpoints at their knots, for random normals."""
    rng = np.random.default_rng(SEED)
    even, excess = 0.0, -1.0
    count = run.size(2000, 50)
    for _ in range(count):
        n = int(rng.integers(4, 20))
        angle = rng.uniform(0, 2 * np.pi, n)
        G = np.cos(angle[:, None] - angle)
        even = max(even, spectral_radius(np.eye(n) - _at_knots(np.ones(n)) * G))
        B = _at_knots(np.exp(rng.normal(0, 1, n)))
        excess = max(excess, spectral_radius(np.eye(n) - B * G) - spectral_radius(np.eye(n) - B))
    measured = {"knot vectors of each kind": count, "greatest, uniform": even, "greatest excess over variant 3": excess}
    run.claim("beyond-rate-at-knots", measured, "proven for t_i = u_i")


def _at_knots(h: FloatArray) -> FloatArray:
    """(n, n) B with t_i = u_i, for intervals h_i = u_{i+1} - u_i, from the formulas of docs/proofs.md."""
    n = len(h)
    before, after = np.roll(h, 1), np.roll(h, -1)
    total = before + h + after
    up, down = before**2 / ((before + h) * total), after**2 / ((h + after) * total)
    i, j = np.arange(n), (np.arange(n) + 1) % n
    B = np.zeros((n, n))
    B[i, j], B[j, i] = up, down
    B[i, i] = 1 - up - np.roll(down, 1)
    return B


def family_of_limits(run: Run) -> None:
    """Limits come in families; which one is met depends on the order, and some of variant 1's repel."""
    polygons = random_polygons(10, run.size(100, 4), SEED + 5)
    runs = {v: gs.interpolate_many(polygons, v, residual_tolerance=TIGHT, max_iterations=5000) for v in (2, 4)}
    free = [len(p) == _rank(r) for p, r in zip(polygons, runs[2], strict=True)]
    gap = [
        float(np.abs(a.spline.control_points - b.spline.control_points).max())
        for a, b in zip(runs[2], runs[4], strict=True)
    ]
    rng = np.random.default_rng(SEED)
    repelling = {"variant 1": 0.0, "Lemma 2, c = 0": 0.0}
    half_width = float(brentq(lambda x: x**3 / 2 - x**2 + 1 / 6, 0.4, 0.5))
    count = run.size(1500, 200)
    for _ in range(count):
        for name, reach in (("variant 1", 1.0), ("Lemma 2, c = 0", half_width)):
            repelling[name] = max(repelling[name], _rate_of_random_limit(rng, reach))
    measured = {
        "limits": len(free),
        "of these, with a family around": sum(free),
        "least distance of the limits of variants 2 and 4": min(gap),
        "median distance": float(np.median(gap)),
        "greatest ρ(I - B∘G) at a limit, uniform knots": {"limits tried": count, **repelling},
    }
    run.claim("beyond-fixed-points", measured, "proven for limits as in beyond-rate with ρ(I - B∘G) < 1")


def _rank(r: gs.Interpolation) -> int:
    """Rank of the derivative of the normal errors by the control points: n where limits are a manifold."""
    N = unit_normals(r.spline, r.parameters)
    J = r.spline.basis(r.parameters)[:, :, None] * N[:, None, :]
    return int(np.linalg.matrix_rank(J.reshape(len(N), -1), tol=1e-6))


def _rate_of_random_limit(rng: np.random.Generator, reach: float, n: int = 6) -> float:
    """ρ(I - B∘G) for the curve on uniform knots through random points at random parameters; 0 if there is none."""
    t = np.arange(n) + rng.uniform(-reach, reach, n)
    knots = np.arange(n + 1.0)
    B = Spline(np.zeros((n, 2)), knots).basis(t)
    if np.linalg.cond(B) > 1e6:
        return 0.0
    spline = Spline(np.asarray(np.linalg.solve(B, rng.uniform(0, 5, (n, 2))), dtype=np.float64), knots)
    N = unit_normals(spline, t)
    return spectral_radius(np.eye(n) - B * (N @ N.T))


def reversible_weights(h: FloatArray) -> FloatArray:
    """(n,) π_i = (h_{i-1} + h_i) / (h_{i-1} h_i)²: π_i b_ij = π_j b_ji where all footpoints are at the knots."""
    before = np.roll(h, 1)
    return np.asarray((before + h) / (before * h) ** 2)


def variant_3(run: Run) -> None:
    """The reversible chain in numbers, and the fall of the weighted error in runs."""
    rng = np.random.default_rng(SEED)
    count = run.size(2000, 50)
    asymmetry, least, formula = 0.0, 1.0, 0.0
    for k in range(count):
        h = np.exp(rng.normal(0, 4 * k / count, int(rng.integers(4, 31))))
        knots = np.concatenate([[0.0], np.cumsum(h)])
        B = Spline(np.zeros((len(h), 2)), knots).basis(knots[:-1])
        formula = max(formula, float(np.abs(B - _at_knots(h)).max()))
        w = np.sqrt(reversible_weights(h))
        S = w[:, None] * _at_knots(h) / w
        asymmetry = max(asymmetry, float(np.abs(S - S.T).max()))
        least = min(least, float(np.linalg.eigvalsh((S + S.T) / 2).min()))
    rises, excess, runs = 0, -1.0, 0
    for p in random_polygons(20, run.size(100, 4)):
        h = np.hypot(*(np.roll(p, -1, axis=0) - p).T)
        B, pi = _at_knots(h), reversible_weights(h)
        rate = spectral_radius(np.eye(len(h)) - B)
        e = p - B @ p
        runs += 1
        for _ in range(50):
            after = e - B @ e
            factor = float(np.sqrt((pi @ (after**2).sum(axis=1)) / (pi @ (e**2).sum(axis=1))))
            rises, excess = rises + (factor >= 1), max(excess, factor - rate)
            e = after
    measured = {
        "knot vectors": count,
        "largest asymmetry of B in the weighted norm": asymmetry,
        "largest difference of the formula from the basis functions": formula,
        "least eigenvalue of B": least,
        "runs": runs,
        "steps in which the weighted error rises": rises,
        "largest factor of a step less ρ(I - B)": excess,
    }
    run.claim(
        "beyond-variant-3", measured, "proven for cubics, every closed knot vector of 4 or more simple knots", digits=3
    )


def sharpness(run: Run) -> None:
    """Polygons, with knots of their own, on which a step comes as near to 1 - 2c as one likes."""
    measured = {}
    for n in (100, 400, 1600):
        points, knots = zigzag(n)
        r = gs.interpolate(points, 2, knots=knots, margin=MARGIN, max_iterations=3, residual_tolerance=1e-12)
        factors = r.residuals[1:] / r.residuals[:-1]
        measured[str(n)] = {
            "certified factor": r.rate_bound,
            "largest factor of a step": float(factors.max()),
            "room below the certificate": r.rate_bound - float(factors.max()),
        }
    gaps = [m["room below the certificate"] for m in measured.values()]
    if not (min(gaps) > -1e-9 and gaps == sorted(gaps, reverse=True)):
        raise ArithmeticError("the example of sharpness does not hold")
    run.claim("theorem-2-sharp", measured, "measured", margin=MARGIN)


def zigzag(n: int) -> tuple[FloatArray, FloatArray]:
    """(n, 2) polygon and (n + 1,) knots on which a step with c = ``MARGIN`` is nearly as slow as certified."""

    def excess(x: float) -> float:
        return 0.5 - 1 / ((1 + x) * (2 + x)) - x**2 / ((1 + x) * (1 + 2 * x)) - MARGIN - 1e-9

    x = float(brentq(excess, 1, 1e3))
    h = np.where(np.arange(n) % 2 == 0, 1.0, x)
    arcs = h**2 * (np.roll(h, 1) + h + np.roll(h, -1))
    angle = 2 * np.pi * np.concatenate([[0.0], np.cumsum(arcs)[:-1]]) / arcs.sum()
    radius = arcs.sum() / (2 * np.pi) + 0.01 * arcs.min() * (-1.0) ** np.arange(n)
    points = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return points, np.concatenate([[0.0], np.cumsum(h)])


def random_order(n: int, rng: np.random.Generator) -> list[list[int]]:
    """The vertices in random order, cut into blocks at random places."""
    cuts = np.flatnonzero(rng.uniform(size=n - 1) < rng.uniform()) + 1
    return [block.tolist() for block in np.split(rng.permutation(n), cuts)]


def any_order(run: Run) -> None:
    """Sweeps in random fixed orders of random blocks."""
    rng = np.random.default_rng(SEED)
    measured = {}
    for c in (0.0, MARGIN):
        largest, failures, above, count = 0.0, 0, 0, 0
        for p in random_polygons(10, run.size(40, 3), SEED + 6):
            method = LocalMethod(p, 2, margin=c)
            if method.rate_bound > 1:
                continue
            corrections = np.array(method.run(random_order(len(p), rng))[1])
            factors = corrections[1:] / corrections[:-1]
            count += 1
            failures += int(corrections[-1] >= TOLERANCE)
            largest = max(largest, float(factors.max()))
            above += int((factors > method.rate_bound + 1e-9).sum())
        measured[f"c = {c:g}"] = {
            "polygons": count,
            "not converged": failures,
            "largest factor of a sweep": largest,
            "sweeps above the bound": above,
        }
    run.claim(
        "beyond-any-order", measured, "proven for cubics, n ≥ 4, every peak above 1/2, the same order in every sweep"
    )
