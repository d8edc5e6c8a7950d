"""Variant 2 in R^d: random polygons, and the masters of a variable outline interpolated as one polygon."""

from __future__ import annotations

from itertools import product

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

import glyphspline as gs
from glyphspline.interpolation.polygon import lengths
from glyphspline.types import FloatArray

from .common import SEED, SIDE, Run, draw_series
from .faces import FONTS
from .smooth_curves import nearest
from .study import MAX_ITERATIONS, TOLERANCE

DIMENSIONS = (2, 4, 8, 18, 48, 154)
VARIANTS = (2, 3)
GROUPS = (5, 20, 90)
SHOWN = 20
COUNT, MANY, FEWER = 200, 48, 60
"""Polygons of a size and dimension; from ``MANY`` dimensions on there are fewer."""

MASTERS = (1, 2, 3, 9)
FACE, SAMPLED = "kouzan-gyosho.ttf", 60


def dimensions(run: Run) -> None:
    """Iterations by dimension, and stacked masters beside the same masters one by one."""
    dimensions, groups = (DIMENSIONS, GROUPS) if not run.quick else ((2, 8), (5, SHOWN))
    mean: dict[int, dict[str, dict[str, float]]] = {v: {f"n = {n}": {} for n in groups} for v in VARIANTS}
    most: dict[int, dict[str, dict[str, float]]] = {v: {f"n = {n}": {} for n in groups} for v in VARIANTS}
    failures = dict.fromkeys(VARIANTS, 0)
    fallbacks, above, doubtful, ratios = 0, 0, 0, {}
    for n, d in product(groups, dimensions):
        count = run.size(COUNT if d < MANY else FEWER, 3)
        polygons = np.random.default_rng([SEED, n, d]).uniform(0, SIDE, (count, n, d))
        tolerance = TOLERANCE * float(np.sqrt(d / 2))
        for v in VARIANTS:
            results = gs.interpolate_many(polygons, v, residual_tolerance=tolerance, max_iterations=MAX_ITERATIONS)
            iterations = [r.iterations for r in results]
            mean[v][f"n = {n}"][str(d)], most[v][f"n = {n}"][str(d)] = float(np.mean(iterations)), max(iterations)
            failures[v] += sum(not r.converged for r in results)
            doubtful += sum(r.uncertified or 0 for r in results)
            if v == 2:
                fallbacks += sum(r.fallbacks for r in results)
                above += sum(int((r.residuals[1:] > r.rate_bound * r.residuals[:-1]).sum()) for r in results)
        if n == SHOWN:
            chords = lengths(np.roll(polygons, -1, axis=1) - polygons)
            ratios[str(d)] = float(np.mean(chords.max(axis=1) / chords.min(axis=1)))
    shown = {f"variant {v}": mean[v][f"n = {SHOWN}"] for v in VARIANTS}
    measured = {
        "polygons of a size and dimension": run.size(COUNT, 3),
        f"polygons from d = {MANY} on": run.size(FEWER, 3),
        **{f"not converged, variant {v}": failures[v] for v in VARIANTS},
        "footpoints not certified": doubtful,
        "vertices without an interval": fallbacks,
        "steps of variant 2 above the bound": above,
        **{f"variant {v}, mean iterations by d": mean[v] for v in VARIANTS},
        **{f"variant {v}, most iterations by d": most[v] for v in VARIANTS},
        f"mean ratio of the longest chord to the shortest by d, n = {SHOWN}": ratios,
    }
    run.claim("beyond-dimension", measured, "proven", side=SIDE, tolerance=TOLERANCE)
    run.claim("beyond-masters", _masters(run), "measured", face=FACE, sampled=SAMPLED)
    run.save(_picture(shown), "dimension", svg=True)


def stacked_masters(polygon: FloatArray, count: int) -> FloatArray:
    """(n, 2 count) the polygon and smoothly displaced copies of it, side by side: the same vertices in each master."""
    rng = np.random.default_rng(SEED)
    size = float(np.ptp(polygon, axis=0).max())
    masters = [polygon]
    for _ in range(count - 1):
        waves, phase = rng.normal(size=(3, 2)), rng.uniform(0, 2 * np.pi, 3)
        field = np.sin(polygon @ waves.T * (2 * np.pi / size) + phase) @ rng.normal(size=(3, 2))
        masters.append(polygon * rng.uniform(0.8, 1.2, 2) + 0.03 * size * field)
    return np.concatenate(masters, axis=1)


def _masters(run: Run) -> dict[str, dict[str, float]]:
    font = gs.open_font(FONTS / FACE)
    contours = font.outline(font.select(text="龍")[0]).contours
    polygon = gs.sample(max(contours, key=lambda c: len(c.points)), count=run.size(SAMPLED, 20))
    tolerance = 1e-6 * float(np.ptp(polygon, axis=0).max())
    found = {}
    for count in MASTERS if not run.quick else MASTERS[:2]:
        points = stacked_masters(polygon, count)
        together = gs.interpolate(points, 2, residual_tolerance=tolerance)
        alone = [gs.interpolate(points[:, k : k + 2], 2, residual_tolerance=tolerance) for k in range(0, 2 * count, 2)]
        blend = points.reshape(len(points), count, 2).mean(axis=1)
        curve = together.spline(together.parameters).reshape(len(points), count, 2).mean(axis=1)
        found[f"{count} masters, R^{2 * count}" if count > 1 else "1 master, R^2"] = {
            "vertices": len(points),
            "iterations": together.iterations,
            "iterations one by one": float(np.mean([r.iterations for r in alone])),
            "blend off its vertices": float(lengths(curve - blend).max()),
            "blend off, masters one by one": _blend_off([r.spline for r in alone], blend),
        }
    return found


def _blend_off(splines: list[gs.Spline], blend: FloatArray) -> float:
    """How far vertices lie from the mean of splines taken at equal shares of their knots, as fonts blend them."""
    knots = np.mean([s.knots / s.period for s in splines], axis=0)
    mean = gs.Spline(np.mean([s.control_points for s in splines], axis=0), knots)
    t = np.linspace(0, 1, 20 * len(blend), endpoint=False)
    return float(nearest(lambda t, k: mean(t, derivative=k), t, blend).max())


def _picture(iterations: dict[str, dict[str, float]]) -> Figure:
    figure, ax = plt.subplots(figsize=(4.2, 2.7), layout="constrained")
    draw_series(ax, iterations)
    dimensions = [int(d) for d in iterations["variant 2"]]
    ax.set(xlabel="dimension", ylabel=f"mean iterations, n = {SHOWN}", ylim=(0, None), xscale="log")
    ax.set_xticks(dimensions, [str(d) for d in dimensions])
    ax.minorticks_off()
    ax.legend()
    return figure
