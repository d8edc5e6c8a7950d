"""Convergence where the paper proves none: margin zero, and Algorithm 3."""

from __future__ import annotations

import numpy as np

import glyphspline as gs

from .common import Run, random_polygons
from .study import TOLERANCE
from .theorems import MARGIN, step_factors

HYPOTHESIS = "proven for cubics, n ≥ 4, every peak above 1/2"


def convergence(run: Run) -> None:
    """Observed factors beside the proofs."""
    polygons = [p for n in run.groups for p in random_polygons(n, run.size(50, 3))]
    run.claim(
        "beyond-margin-zero",
        "Theorem 2",
        "With c = 0, as in all of the paper's experiments, Algorithm 2 still converges, at a linear rate.",
        "assumed; Theorem 2 needs c > 0",
        _factors(polygons, 2, 0.0),
        HYPOTHESIS,
        "Factors are those of the largest error, over one step and over two; polygons with a fallback are left out.",
        "convergence",
    )
    run.claim(
        "beyond-algorithm-3",
        "Section 3",
        "Algorithm 3 converges under the same condition as Algorithm 2.",
        "examples only",
        {"c = 0": _factors(polygons, 4, 0.0), f"c = {MARGIN}": _factors(polygons, 4, MARGIN)},
        HYPOTHESIS,
        "With c > 0 the bound is the same 1 - 2c a sweep, for any degree; with c = 0 the error falls at a linear rate, "
        "which the proof does not name.",
        "convergence",
    )


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
