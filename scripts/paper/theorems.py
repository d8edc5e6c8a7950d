"""Corollary 1, Theorems 1 and 2 and the Remarks: the proven bounds against what is observed, also where c is 0."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

import glyphspline as gs
from glyphspline.plugins.experiments.style import COLOURS, GREY, INK, bare, draw_closed
from glyphspline.types import FloatArray

from .common import SEED, Run, curve_points, random_polygons, verdict
from .local import LocalMethod
from .study import MAX_ITERATIONS, TOLERANCE

PAPER_HALF_WIDTH = 0.466178
MARGIN = 0.05


def corollary_1(run: Run) -> None:
    """Half width of {B ≥ 1/2} for uniform knots, as the program computes its intervals."""
    angle = 2 * np.pi * np.arange(12) / 12
    r = gs.interpolate(np.stack([np.cos(angle), np.sin(angle)], axis=1), 2, knots="uniform")
    half_width = float(np.mean(np.diff(r.intervals, axis=1)) / 2)
    root = min(x.real for x in np.roots([0.5, -1, 0, 1 / 6]) if abs(x.imag) < 1e-12 and x.real > 0)
    agrees = abs(half_width - PAPER_HALF_WIDTH) < 5e-7 and abs(half_width - root) < 1e-9
    run.claim("corollary-1", half_width, verdict(agrees), digits=10)


def equilateral_polygon(n: int, rng: np.random.Generator) -> FloatArray:
    """A random polygon of n (even) unit chords, in opposite pairs, shuffled: its knots are uniform."""
    angle = rng.uniform(0, 2 * np.pi, n // 2)
    steps = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.cumsum(rng.permutation(np.concatenate([steps, -steps])), axis=0)


def theorem_1(run: Run) -> None:
    """Algorithm 1: the factor of every step against 1 - B_k, and 5/6 for uniform knots."""
    rng = np.random.default_rng(SEED)
    count = run.size(60, 12)
    uniform = [gs.interpolate_vertex(equilateral_polygon(12, rng), 3) for _ in range(count)]
    general = [gs.interpolate_vertex(p, 3) for p in random_polygons(12, count)]
    # Uniform knots, whatever the chords.
    local = [LocalMethod(p, 1, "uniform").run([[3]], 1e-6, 99) for p in random_polygons(12, count, SEED + 2)]
    even = [step_factors(np.array(corrections)) for _, corrections in local]
    excess = max((step_factors(r.residuals) - r.rate_bound).max(initial=-1) for r in [*uniform, *general])
    failures = sum(not r.converged for r in general)
    bound = max(r.rate_bound for r in uniform)
    measured = {"polygons": count, "not converged": failures, "largest factor less its bound": excess}
    run.claim("theorem-1", measured, verdict(failures == 0 and excess < 1e-9))
    largest = max(f.max(initial=0) for f in even)
    factors = {
        "bound": bound,
        "largest factor, equal chords": max(step_factors(r.residuals).max() for r in uniform),
        "largest factor, uniform knots": largest,
        "mean factor, uniform knots": float(np.mean(np.concatenate(even))),
    }
    run.claim("remark-1", factors, verdict(abs(bound - 5 / 6) < 1e-9 and largest <= 5 / 6 + 1e-9))


def step_factors(residuals: FloatArray) -> FloatArray:
    """Each error divided by the one before, while that is well above rounding."""
    before = residuals[:-1]
    return residuals[1:][before > 1e-12] / before[before > 1e-12]


def remark_2(run: Run) -> None:
    """Algorithm 1 with the footpoint on the whole curve: shown failing, with a picture of one failure."""
    polygons = random_polygons(10, run.size(80, 12), SEED + 1)
    results = [gs.interpolate_vertex(p, 0, whole_curve=True, max_iterations=200) for p in polygons]
    failed = [k for k, r in enumerate(results) if not r.converged]
    confined = [gs.interpolate_vertex(polygons[k], 0, max_iterations=200).converged for k in failed]
    measured = {
        "polygons": len(polygons),
        "not converged": len(failed),
        "of these, converged within a span": sum(confined),
    }
    run.claim("remark-2", measured, verdict(len(failed) > 0 and all(confined)))
    if failed:
        run.save(_picture_of_failure(polygons[failed[0]]), "remark-2", svg=True)


def _picture_of_failure(polygon: FloatArray) -> Figure:
    figure, axes = plt.subplots(1, 2, figsize=(6.4, 3.1), layout="constrained")
    for ax, whole, title in (
        (axes[0], False, "footpoint within a span"),
        (axes[1], True, "footpoint on the whole curve"),
    ):
        draw_closed(ax, polygon, color=GREY, lw=0.7, ls=(0, (4, 2)))
        for steps, shade in ((0, 0.3), (2, 0.55), (5, 1.0)):
            r = gs.interpolate_vertex(polygon, 0, whole_curve=whole, max_iterations=steps)
            draw_closed(
                ax, curve_points(r.spline), color=COLOURS["variant 2" if not whole else "variant 0"], alpha=shade
            )
        ax.plot(*r.spline(r.parameters).T, "o", color=INK, mfc="white", ms=5, label="footpoint after 5 steps")
        ax.plot(*polygon[0], "o", color=INK, ms=4, label="vertex to reach")
        ax.set_title(title)
        bare(ax)
    axes[0].legend(loc="upper center", bbox_to_anchor=(0.5, 0.02), ncols=2, fontsize=7.5)
    return figure


def theorem_2(run: Run) -> None:
    """The certified factor a step, 1 - 2c where all peaks allow it, against the factors observed."""
    polygons = [p for n in run.groups for p in random_polygons(n, run.size(40, 3))]
    everything = gs.interpolate_many(polygons, 2, margin=MARGIN, residual_tolerance=TOLERANCE)
    results = [r for r in everything if not r.fallbacks]
    worst = np.array([step_factors(r.residuals).max(initial=0) for r in results])
    mean = np.array([(r.residuals[-1] / r.residuals[0]) ** (1 / max(r.iterations, 1)) for r in results])
    bound = np.array([r.rate_bound for r in results])
    certified = bound < 1 - 1e-9
    measured = {
        "c": MARGIN,
        "polygons": len(results),
        "certified beforehand, %": 100 * certified.mean(),
        "steps above the bound": int((worst > bound + 1e-9).sum()),
        "median bound": np.median(bound),
        "median of the worst factor": np.median(worst),
        "median of the mean factor": np.median(mean),
        "not converged": sum(not r.converged for r in results),
    }
    run.claim("theorem-2", measured, verdict(bool((worst <= bound + 1e-9).all()) and all(r.converged for r in results)))
    run.save(_picture_of_rates(bound, worst, mean), "theorem-2", svg=not run.quick)


def _picture_of_rates(bound: FloatArray, worst: FloatArray, mean: FloatArray) -> Figure:
    figure, axes = plt.subplots(figsize=(4.2, 3.2), layout="constrained")
    axes.plot(bound, worst, ".", color=COLOURS["variant 1"], ms=3, label="worst step", alpha=0.7)
    axes.plot(bound, mean, ".", color=COLOURS["variant 2"], ms=3, label="mean of a run", alpha=0.7)
    low = float(bound.min()) - 0.01
    axes.plot([low, 1], [low, 1], color=INK, lw=0.7)
    axes.text(low + 0.004, low + 0.012, "bound", fontsize=7.5, va="bottom")
    axes.set(xlabel="certified factor a step", ylabel="observed factor", ylim=(0, 1.02), xlim=(low, 1.002))
    axes.legend(loc="lower right")
    return figure


HYPOTHESIS = "proven for cubics, n ≥ 4, every peak above 1/2"


def convergence(run: Run) -> None:
    """Observed factors beside the proofs."""
    polygons = [p for n in run.groups for p in random_polygons(n, run.size(50, 3))]
    run.claim("beyond-margin-zero", _factors(polygons, 2, 0.0), HYPOTHESIS)
    measured = {"c = 0": _factors(polygons, 4, 0.0), f"c = {MARGIN}": _factors(polygons, 4, MARGIN)}
    run.claim("beyond-algorithm-3", measured, HYPOTHESIS)


def _factors(polygons: list[np.ndarray], variant: int, margin: float) -> dict[str, float]:
    everything = gs.interpolate_many(polygons, variant, margin=margin, residual_tolerance=TOLERANCE)
    results = [r for r in everything if not r.fallbacks]
    one = [step_factors(r.residuals).max(initial=0.0) for r in results]
    two = [(r.residuals[2:] / r.residuals[:-2]).max(initial=0.0) for r in results]
    above = [(step_factors(r.residuals) > r.rate_bound + 1e-9).sum() for r in results]
    return {
        "polygons": len(results),
        "not converged": sum(not r.converged for r in results),
        "largest factor of a step": max(one),
        "largest factor of two steps": max(two),
        "steps above the bound": int(sum(above)),
    }


SIGMAS = (0.5, 1.0, 1.5, 2.0, 2.5)
VERTICES = 30
RULES: dict[str, dict[str, Any]] = {
    "Remark 3": {"fallback": "knot", "margin": 0.0},
    "peak, c = 0": {"fallback": "peak", "margin": 0.0},
    "peak, c = 0.02": {"fallback": "peak", "margin": 0.02},
    "peak, c = 0.05": {"fallback": "peak", "margin": 0.05},
}


def uneven_polygons(sigma: float, count: int) -> list[FloatArray]:
    """Random directions, chord lengths lognormal with this σ, closed by spreading the gap over all chords."""
    rng = np.random.default_rng([SEED, round(100 * sigma)])
    polygons = []
    for _ in range(count):
        length = rng.lognormal(0, sigma, VERTICES)
        angle = rng.uniform(0, 2 * np.pi, VERTICES)
        steps = length[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        steps -= length[:, None] / length.sum() * steps.sum(axis=0)
        polygon = np.cumsum(steps, axis=0)
        polygons.append(5 * (polygon - polygon.min(axis=0)) / np.ptp(polygon, axis=0).max())
    return polygons


def remark_3(run: Run) -> None:
    """How many polygons fail under each rule, and what it costs."""
    failures: dict[str, dict[str, float]] = {rule: {} for rule in RULES}
    iterations: dict[str, dict[str, float]] = {rule: {} for rule in RULES}
    share: dict[str, float] = {}
    count = run.size(500, 6)
    for sigma in SIGMAS[:: run.size(1, 3)]:
        polygons = uneven_polygons(sigma, count)
        for rule, options in RULES.items():
            results = gs.interpolate_many(
                polygons, 2, residual_tolerance=TOLERANCE, max_iterations=MAX_ITERATIONS, **options
            )
            done = [r.iterations for r in results if r.converged]
            failures[rule][str(sigma)] = count - len(done)
            iterations[rule][str(sigma)] = float(np.mean(done)) if done else float("nan")
        share[str(sigma)] = 100 * sum(r.fallbacks for r in results) / (count * VERTICES)
    random = {r: {k: v for k, v in iterations[r].items() if v == v} for r in RULES}
    measured = {
        "polygons a row": count,
        "vertices without an interval, %": share,
        "failures": failures,
        "mean iterations of those that converge": random,
    }
    agrees = failures["Remark 3"][max(failures["Remark 3"], key=float)] == 0
    run.claim("beyond-remark-3", measured, verdict(agrees), vertices=VERTICES)
