"""The study of Section 4: all variants on the 2200 random polygons. Figs. 2 and 3 read from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

import glyphspline as gs
from glyphspline.types import BoolArray, FloatArray, IntArray

from .common import Run

TOLERANCE = 1e-6
MAX_ITERATIONS = 1000


@dataclass(frozen=True, eq=False)
class Group:
    """What a variant did on the polygons of one group.

    Attributes:
        iterations, converged, error: (polygons,) updates made, whether below the tolerance, the last error.
        without_interval: (polygons,) vertices for which Lemma 2 has no interval.
        control_points: of every result, to tell whether two variants came to the same curve.
    """

    iterations: IntArray
    converged: BoolArray
    error: FloatArray
    without_interval: IntArray
    control_points: list[FloatArray]

    @property
    def fallbacks(self) -> int:
        """Vertices of all polygons for which Lemma 2 has no interval."""
        return int(self.without_interval.sum())


def study_group(polygons: list[FloatArray], variant: int, **options: Any) -> Group:
    """Interpolate all polygons of a group. Polygons that do not converge count with all iterations made."""
    results = gs.interpolate_many(
        polygons, variant, residual_tolerance=TOLERANCE, max_iterations=MAX_ITERATIONS, **options
    )
    return Group(
        np.array([r.iterations for r in results]),
        np.array([r.converged for r in results]),
        np.array([r.max_error for r in results]),
        np.array([r.fallbacks for r in results]),
        [r.spline.control_points for r in results],
    )


def study(run: Run, variant: int) -> dict[int, Group]:
    """All groups for one variant, computed once a run."""
    key = f"study {variant}"
    if key not in run.cache:
        run.cache[key] = {n: study_group(polygons, variant) for n, polygons in run.polygons().items()}
    return dict(run.cache[key])


def mean_iterations(groups: dict[int, Group]) -> dict[str, float]:
    """{"5": mean, …}"""
    return {str(n): float(np.mean(g.iterations)) for n, g in groups.items()}


def share_converged(groups: dict[int, Group]) -> dict[str, float]:
    """{"5": percent, …}"""
    return {str(n): 100.0 * float(np.mean(g.converged)) for n, g in groups.items()}


def all_converged(groups: dict[int, Group]) -> bool:
    """Whether every polygon of every group came below the tolerance."""
    return all(bool(g.converged.all()) for g in groups.values())
