"""Remark 3's weakness: t_i = u_i where the peak is not above 1/2, on very uneven chords; and the cure."""

from __future__ import annotations

from typing import Any

import numpy as np

import glyphspline as gs
from glyphspline.types import FloatArray

from .common import SEED, Run
from .study import MAX_ITERATIONS, TOLERANCE

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
    run.claim(
        "beyond-remark-3",
        "Remark 3",
        "Setting t_i = u_i where the peak is not above 1/2 makes the algorithm more robust.",
        "said of rare cases",
        {
            "polygons a row": count,
            "vertices without an interval, %": share,
            "failures": failures,
            "mean iterations of those that converge": random,
        },
        "differs" if failures["Remark 3"][max(failures["Remark 3"], key=float)] > 0 else "reproduced",
        f"Polygons of {VERTICES} vertices with lognormal chords, by σ. B_i(u_i) may be near 0 on uneven knots, and the "
        "update then hardly moves the curve at its footpoint. Taking {B_i ≥ min(1/2 + c, 0.9 max B_i)} instead "
        '(fallback="peak") cures it.',
        "remark3",
    )
