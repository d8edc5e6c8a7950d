"""Progressive iterative approximation (PIA) and its relatives beside variants 1 to 4, on the same polygons.

All of them are linear iterations P += M (p - A P) with the collocation matrix A at the knots, where the vertices have
their parameters: M is the identity in PIA, which is variant 3; ω in WPIA; D⁻¹ (D the diagonal of A) in Jacobi's and
(D + L)⁻¹ (L below it) in Gauss and Seidel's; μ Aᵀ in LSPIA, which may have more data than control points.
"""

from __future__ import annotations

from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

import glyphspline as gs
from glyphspline.curves.bspline import Spline
from glyphspline.interpolation.polygon import vertex_parameters
from glyphspline.plugins.experiments.measures import curvature_variation
from glyphspline.plugins.experiments.style import COLOURS, GREY, INK, MARKERS
from glyphspline.types import FloatArray

from .common import Run, random_polygons
from .fairness import curve_of, quality
from .measures import shape
from .smooth_curves import Waves, distance, polar
from .study import MAX_ITERATIONS, TOLERANCE

SALSPIA = polar((2.0, 0, 0.0), (4.0, 2, np.pi / 4), (1.0, 3, np.pi / 4))
"""r(θ) = 2 + 4 cos(2θ + π/4) + cos(3θ + π/4): Example 4.1 of the SaLSPIA code, its one closed plane analytic curve.

X. Peng and Y. Li, “Spectral Adaptivity for Iterative Least-Squares B-Spline Curve and Surface Fitting”,
https://github.com/Lily11898/SaLSPIA-Reproducibility, ``experiments/run_table3_curve_comparison.m``.
"""

DATA, CONTROLS = 1500, 300
"""A tenth of the numbers there, and the spline closed instead of clamped."""

COUNT = 40
MOST = 10_000
VARIANTS = (1, 2, 3, 4)
LINEAR = ("PIA", "WPIA", "Jacobi-PIA", "Gauss-Seidel-PIA", "LSPIA")
LINES = dict(zip(LINEAR, ("-", (0, (5, 1.5)), (0, (3, 1.5)), (0, (1, 1)), (0, (6, 1.5, 1, 1.5))), strict=True))


@dataclass(frozen=True, eq=False)
class Linear:
    """A linear iteration: what it came to, its passes, the largest error of each, whether that met the tolerance."""

    controls: FloatArray
    iterations: int
    errors: list[float]
    converged: bool


def family(A: FloatArray, p: FloatArray, name: str, most: int = MAX_ITERATIONS) -> Linear:
    """Iterate from the data, as many as there are control points, until the curve is within the tolerance of them."""
    M: FloatArray = np.eye(len(A))
    if name == "WPIA":
        M *= 2 / (1 + np.linalg.eigvals(A).real.min())  # the best weight, as the largest eigenvalue is 1
    elif name == "Jacobi-PIA":
        M = np.diag(1 / np.diag(A))
    elif name == "Gauss-Seidel-PIA":
        M = np.asarray(np.linalg.inv(np.tril(A)), dtype=np.float64)
    elif name == "LSPIA":
        M = least_squares_weight(A) * A.T
    P, errors = p.copy(), []
    while True:
        e = p - A @ P
        errors.append(float(np.hypot(*e.T).max()))
        if errors[-1] < TOLERANCE or len(errors) > most or not np.isfinite(errors[-1]):
            return Linear(P, len(errors) - 1, errors, errors[-1] < TOLERANCE)
        P = P + M @ e


def least_squares_weight(A: FloatArray) -> float:
    """LSPIA's best weight: 2 over the sum of the extreme eigenvalues of AᵀA."""
    extremes = np.linalg.eigvalsh(A.T @ A)[[0, -1]]
    return float(2 / extremes.sum())


def pia(run: Run) -> None:
    """Iterations on random polygons, fairness of the limits, and the analytic curve of SaLSPIA."""
    names = [*LINEAR, *(f"variant {v}" for v in VARIANTS)]
    means: dict[str, dict[str, float]] = {name: {} for name in names}
    failures = dict.fromkeys(names, 0)
    for n in run.groups:
        polygons = random_polygons(n, run.size(COUNT, 2))
        found: dict[str, list[tuple[int, bool]]] = {name: [] for name in names}
        for p in polygons:
            u = vertex_parameters(p)
            A = Spline(p, u).basis(u[:-1])
            for name in LINEAR:
                linear = family(A, p, name)
                found[name].append((linear.iterations, linear.converged))
        for v in VARIANTS:
            for r in gs.interpolate_many(polygons, v, residual_tolerance=TOLERANCE, max_iterations=MAX_ITERATIONS):
                found[f"variant {v}"].append((r.iterations, r.converged))
        for name, each in found.items():
            means[name][str(n)] = float(np.mean([iterations for iterations, _ in each]))
            failures[name] += sum(not converged for _, converged in each)
    measured = {
        "polygons a row": run.size(COUNT, 2),
        "mean iterations": means,
        "not converged": failures,
        "growth": {name: series[str(n)] / series[str(run.groups[0])] for name, series in means.items()},
    }
    run.claim("beyond-pia-iterations", measured, "measured", tolerance=TOLERANCE, max_iterations=MAX_ITERATIONS)
    _fairness(run)
    figure_errors = _analytic(run)
    run.save(_picture(means, figure_errors), "pia", svg=True)


def _fairness(run: Run) -> None:
    """Medians over polygons of the measures of the limits of variants 1, 2 and 4, relative to the PIA family's."""
    polygons = random_polygons(30 if not run.quick else 8, run.size(COUNT, 2))
    measures = ("∫κ² ds", "∫(dκ/ds)² ds", "max |κ|", "bulge")
    ratios: dict[str, dict[str, list[float]]] = {f"variant {v}": {m: [] for m in measures} for v in (1, 2, 4)}
    results = {v: gs.interpolate_many(polygons, v, residual_tolerance=TOLERANCE) for v in VARIANTS}
    for k, p in enumerate(polygons):
        base = quality(*curve_of(results[3][k]), p)
        for v in (1, 2, 4):
            q = quality(*curve_of(results[v][k]), p)
            for m in measures:
                ratios[f"variant {v}"][m].append(q[m] / base[m])
    medians = {name: {m: float(np.median(x)) for m, x in table.items()} for name, table in ratios.items()}
    run.claim("beyond-pia-fairness", medians, "measured", polygons=len(polygons), vertices=len(polygons[0]))


def _analytic(run: Run) -> dict[str, list[float]]:
    data, controls = run.size(DATA, 300), run.size(CONTROLS, 60)
    every = data // controls
    q = SALSPIA(2 * np.pi * np.arange(data) / data)
    p = q[::every]
    u = vertex_parameters(p)
    A = Spline(p, u).basis(u[:-1])
    table: dict[str, dict[str, float]] = {}
    errors: dict[str, list[float]] = {}
    true = exact_fairness(SALSPIA)
    for name in LINEAR:
        linear = family(A, p, name, MOST)
        table[name] = _row(SALSPIA, Spline(linear.controls, u), linear.iterations, true)
        errors[name] = linear.errors
    for v in VARIANTS:
        r = gs.interpolate(p, v, residual_tolerance=TOLERANCE, max_iterations=MOST)
        table[f"variant {v}"] = _row(SALSPIA, r.spline, r.iterations, true)
        errors[f"variant {v}"] = list(r.residuals)
    spline, iterations = least_squares(q, every)
    table[f"LSPIA, {data} data"] = _row(SALSPIA, spline, iterations, true)
    measured = {"control points": controls, **table}
    run.claim(
        "beyond-pia-analytic", measured, "measured", data=data, controls=controls, every=every, tolerance=TOLERANCE
    )
    return errors


def least_squares(q: FloatArray, every: int) -> tuple[Spline, int]:
    """LSPIA of a closed cubic with a knot at every so many-th of the data, at their chord-length parameters."""
    s = vertex_parameters(q)
    u = np.append(s[:-1:every], s[-1])
    B = Spline(q[::every], u).basis(s[:-1])
    limit = np.linalg.lstsq(B, q, rcond=None)[0]
    weight, normal, right = least_squares_weight(B), B.T @ B, B.T @ q
    P, count = q[::every].copy(), 0
    while np.hypot(*(P - limit).T).max() >= TOLERANCE and count < MOST:
        P, count = P + weight * (right - normal @ P), count + 1
    return Spline(P, u), count


def exact_fairness(curve: Waves) -> dict[str, float]:
    """∫κ² ds, ∫(dκ/ds)² ds and max |κ| of the analytic curve."""
    angle = np.linspace(0, 2 * np.pi, 100_000, endpoint=False)
    speed, bend = np.hypot(*curve(angle, 1).T), curve.curvature(angle)
    change = np.gradient(bend, angle) / speed
    return {
        "∫κ² ds": 2 * np.pi * float(np.mean(bend**2 * speed)),
        "∫(dκ/ds)² ds": 2 * np.pi * float(np.mean(change**2 * speed)),
        "max |κ|": float(np.abs(bend).max()),
    }


def _row(curve: Waves, spline: Spline, iterations: int, true: dict[str, float]) -> dict[str, float]:
    pieces = spline.to_bezier()
    measured = shape(pieces)
    return {
        "iterations": iterations,
        "distance": distance(curve, spline),
        "∫κ² ds": measured.bending_energy / true["∫κ² ds"],
        "∫(dκ/ds)² ds": curvature_variation(pieces) / true["∫(dκ/ds)² ds"],
        "max |κ|": measured.max_curvature / true["max |κ|"],
    }


def _picture(means: dict[str, dict[str, float]], errors: dict[str, list[float]]) -> Figure:
    figure, axes = plt.subplots(1, 2, figsize=(7.4, 3.4), layout="constrained")
    for name, series in means.items():
        linear = name in LINEAR
        style = {"color": INK, "ls": LINES[name]} if linear else {"color": COLOURS[name], "marker": MARKERS[name]}
        axes[0].plot([int(n) for n in series], list(series.values()), label=name, **style)
        style.pop("marker", None)
        axes[1].semilogy(np.maximum(errors[name], 1e-9), **style)
    axes[0].set(xlabel="vertices", ylabel="mean iterations", yscale="log")
    axes[0].set_yticks([10, 20, 50, 100, 200, 500, 1000], ["10", "20", "50", "100", "200", "500", "1000"])
    axes[0].minorticks_off()
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", fontsize=7, ncols=5)
    axes[1].set(xlabel="iteration, analytic curve", ylabel="largest error", xlim=(0, 40))
    axes[1].axhline(TOLERANCE, color=GREY, lw=0.7)
    return figure
