"""Clamped open arcs, the paper's other open question: the study of Section 4 again, between two corners."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

import glyphspline as gs
from glyphspline.interpolation.intervals import basis_function
from glyphspline.plugins.experiments.style import COLOURS, GREY, INK, bare
from glyphspline.types import FloatArray

from .common import SEED, Run, draw_series, random_polygons
from .study import MAX_ITERATIONS, TOLERANCE
from .theorems import MARGIN, step_factors

COUNTS = (3, 5, 10, 20, 30, 60, 90)
VARIANTS = (1, 2, 3, 4)


def arcs(run: Run) -> None:
    """Random arcs with given end tangents and with natural ends, and arcs of a circle."""
    counts = COUNTS if not run.quick else (3, 5)
    means: dict[str, dict[str, float]] = {f"variant {v}": {} for v in VARIANTS}
    failures = dict.fromkeys(means, 0)
    natural = 0
    for n in counts:
        points = random_polygons(n, run.size(200, 2))
        for v in VARIANTS:
            results = [_arc(p, v) for p in points]
            means[f"variant {v}"][str(n)] = float(np.mean([r.iterations for r in results]))
            failures[f"variant {v}"] += sum(not r.converged for r in results)
        ends = gs.interpolate_many(points, 2, closed=False, residual_tolerance=TOLERANCE, max_iterations=MAX_ITERATIONS)
        natural += sum(not r.converged for r in ends)
    measured = {
        "arcs": len(counts) * run.size(200, 2),
        "mean iterations": means,
        "not converged": failures,
        "not converged, variant 2 with natural ends": natural,
        **_certificate(run),
        "three points, largest rate bound at c = 0": max(
            _arc(p, 2).rate_bound for p in random_polygons(3, run.size(200, 4))
        ),
        "smallest maximum of W_1 seen, random knots": _least_peak(run),
        "quarter circle, radius 100, largest deviation by points": circle_deviations(),
    }
    run.claim("beyond-arcs", measured, "proven for arcs of which every inner vertex has an interval", margin=MARGIN)
    run.save(_picture(means), "arcs", svg=True)


def _arc(points: FloatArray, variant: int, **options: float) -> gs.Interpolation:
    """An arc through the points, leaving along its first chord and arriving along its last one, turned by 0.5."""
    turn = np.array([[np.cos(0.5), -np.sin(0.5)], [np.sin(0.5), np.cos(0.5)]])
    first, last = points[1] - points[0], points[-1] - points[-2]
    tangents = (turn @ first / np.hypot(*first), turn @ last / np.hypot(*last))
    how: dict[str, Any] = {"residual_tolerance": TOLERANCE, "max_iterations": MAX_ITERATIONS, **options}
    return gs.interpolate(points, variant, closed=False, end_tangents=tangents, **how)


def _certificate(run: Run) -> dict[str, float]:
    results = [_arc(p, 2, margin=MARGIN) for p in random_polygons(20, run.size(200, 4))]
    certified = [r for r in results if r.rate_bound < 1 - 1e-9 and not r.fallbacks]
    return {
        "certified beforehand, %": 100 * len(certified) / len(results),
        "steps above the bound": int(sum((step_factors(r.residuals) > r.rate_bound + 1e-9).sum() for r in certified)),
    }


def _least_peak(run: Run) -> float:
    """The smallest maximum of W_1 = B_1 + (N_0 + N_1)/2 over knot intervals of very different scales."""
    h = np.exp(np.random.default_rng(SEED).normal(0, 4, (run.size(5000, 50), 3)))
    h[0] = 1.0, 1e-6, 1e-6  # next to the limit
    zero, u = np.zeros(len(h)), np.cumsum(h, axis=1).T
    low, high, W = zero, u[1], np.empty(0)
    for _ in range(5):  # W_1 rises, then falls
        t = low + np.linspace(0, 1, 21)[:, None] * (high - low)
        W = np.zeros(t.size)
        for knots, weight in (((0, 0, 1, 2, 3), 1.0), ((0, 0, 0, 0, 1), 0.5), ((0, 0, 0, 1, 2), 0.5)):
            window = np.stack([zero, *u])[list(knots)].T
            W += weight * basis_function(np.tile(window, (len(t), 1)), t.ravel())
        W = W.reshape(t.shape)
        best, rows = W.argmax(axis=0), np.arange(len(h))
        low, high = t[np.maximum(best - 1, 0), rows], t[np.minimum(best + 1, len(t) - 1), rows]
    return float(W.max(axis=0).min())


def circle_deviations() -> dict[str, float]:
    """How far arcs through points of a quarter circle of radius 100 stray from it."""
    found = {}
    for m in (3, 4, 6, 11):
        angle = np.pi / 2 * np.arange(m) / (m - 1)
        points = 100 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        r = gs.interpolate(points, 2, closed=False, end_tangents=((0, 1), (-1, 0)), residual_tolerance=1e-9)
        t = np.linspace(0, r.spline.knots[-1], 2001)
        found[str(m)] = float(np.abs(np.hypot(*r.spline(t).T) - 100).max())
    return found


def _picture(means: dict[str, dict[str, float]]) -> Figure:
    figure, axes = plt.subplots(1, 2, figsize=(7.4, 2.9), layout="constrained", width_ratios=(1.25, 1))
    draw_series(axes[0], means)
    axes[0].set(xlabel="points of the arc", ylabel="mean iterations", ylim=(0, None))
    axes[0].legend()
    points = random_polygons(6, 1)[0]
    r = _arc(points, 2)
    axes[1].plot(*points.T, color=GREY, lw=0.7, ls=(0, (4, 2)))
    axes[1].plot(*r.spline(np.linspace(0, r.spline.knots[-1], 400)).T, color=COLOURS["variant 2"])
    axes[1].plot(*r.spline.control_points.T, "s", color=GREY, ms=3, label="control points")
    axes[1].plot(*points.T, "o", color=INK, label="points")
    axes[1].legend(loc="lower center", bbox_to_anchor=(0.5, -0.12), ncols=2)
    bare(axes[1])
    return figure
