"""Variant 1 on polygons of 300 vertices, where the paper saw it fail."""

from __future__ import annotations

import numpy as np

import glyphspline as gs

from .common import Run, random_polygons, verdict
from .study import MAX_ITERATIONS, TOLERANCE, study_group

MANY, COUNT, LAST = 300, 2000, 200


def many_vertices(run: Run) -> None:
    """How many runs fail, and where their error hovers."""
    polygons = random_polygons(run.size(MANY, 40), run.size(COUNT, 3))
    group, other = study_group(polygons, 1), study_group(polygons, 2)
    failed = np.flatnonzero(~group.converged)
    medians = [_hovers_at(polygons[k]) for k in failed]
    measured: dict[str, float] = {
        "polygons": len(polygons),
        "variant 1 fails": len(failed),
        "variant 2 fails": int((~other.converged).sum()),
        "most iterations, variant 1": int(group.iterations.max()),
        "most iterations, variant 2": int(other.iterations.max()),
    }
    if medians:
        measured |= {"least median error of a failure": min(medians), "greatest": max(medians)}
    run.claim(
        "section-4.1-variant-1-fluctuates",
        "Section 4.1",
        "With 300 vertices variant 1 fails on some polygons, its error fluctuating around 1e-4.",
        "“some abortive cases”; about 1e-4",
        measured,
        verdict(max(medians) < 1e-2) if medians else "not decidable",
        f"Medians are over the last {LAST} errors of a run that fails. The paper gives no count, and nothing rules "
        "such runs out: where a footpoint may lie at B_i below 1/2 the row-sum bound exceeds 1, and some limits repel "
        "(beyond-fixed-points). A search that misses a nearly double root, as a test for real roots of roots() can, "
        "would fluctuate as well.",
        "many",
    )


def _hovers_at(polygon: np.ndarray) -> float:
    """Median of the last errors."""
    r = gs.interpolate(polygon, 1, residual_tolerance=TOLERANCE, max_iterations=MAX_ITERATIONS)
    return float(np.median(r.residuals[-LAST:]))
