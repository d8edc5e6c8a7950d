"""Measures of contours, column-wise: what the interpolation knows, and the geometry of source and result."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..compiled import compiled
from ..curves.crossings import crossings_and_overshoot
from ..curves.integrals import integrals
from ..errors import GlyphsplineError
from ..interpolation.batched import BatchedInterpolation
from ..interpolation.polygon import LARGEST, clean_polygon
from ..interpolation.result import Interpolation
from ..outlines.contour_arrays import ContourArrays, Polylines
from ..outlines.segments import contour_cubics
from ..types import FloatArray, IntArray

Columns = dict[str, Sequence[Any]]
"""By measure its value for each contour."""


def check_coordinates(contours: ContourArrays) -> None:
    """Refuse coordinates that are not finite, or too large.

    Raises:
        GlyphsplineError: its ``contour`` is the index.
    """
    if len(contours.points) == 0 or np.abs(contours.points).max() < LARGEST / 4:
        return
    for k in range(contours.num_contours):
        points = contours.points[contours.starts[k] : contours.starts[k + 1]]
        if not np.abs(points).max() < LARGEST / 4:
            try:
                if not np.isfinite(points).all():
                    raise GlyphsplineError("the outline has a coordinate that is not finite")
                clean_polygon(points)
            except GlyphsplineError as error:
                raise error.locate(contour=k) from None


def solved_columns(parts: Sequence[tuple[BatchedInterpolation, IntArray]]) -> Columns:
    """What the interpolation itself knows of closed curves, one a contour: the measures of ``results.SOLVED``.

    Args:
        parts: in the order of the contours, results of a batch, and the numbers in it of the polygons chosen.
    """
    counts, iterations, fallbacks = np.concatenate([found.whole[which, 1:4] for found, which in parts]).T
    residuals = np.concatenate([found.residuals[found.residual_offsets[which + 1] - 1] for found, which in parts])
    tolerances = np.concatenate([found.tolerances[which] for found, which in parts])
    return {
        "vertices": counts.tolist(),
        "segments": counts.tolist(),
        "numbers": (2 * counts).tolist(),
        "iterations": iterations.tolist(),
        "residual": residuals.tolist(),
        "converged": (residuals < tolerances).tolist(),
        "rate_bound": np.concatenate([found.rates[which] for found, which in parts]).tolist(),
        "fallbacks": fallbacks.tolist(),
    }


def distance_columns(gaps: Sequence[float], bounds: Sequence[float], tolerance: float) -> Columns:
    """Distances seen, and certified bounds of them, against the tolerance, all in font units."""
    within = [bound <= tolerance for bound in bounds]
    return {"deviation": gaps, "deviation_bound": bounds, "within_tolerance": within}


def certified_rate(arc: Interpolation) -> float:
    """Factor a step by Theorem 2, or by Theorem 1 for an arc of two spans, whose one free vertex moves alone."""
    alone = not arc.spline.closed and len(arc.parameters) == 3
    return arc.rate_bound / 2 if alone else arc.rate_bound


def geometric_columns(result: ContourArrays, source: ContourArrays, polygons: Polylines) -> Columns:
    """Length, area, curvature and crossings of results, compared with their sources."""
    found = survey(result, source, polygons.points, polygons.offsets)
    return {
        "overshoot": found.overshoot.tolist(),
        "length": found.length.tolist(),
        "area_change": found.area_change.tolist(),
        "bending_energy": found.bending_energy.tolist(),
        "max_curvature": found.max_curvature.tolist(),
        "new_crossings": np.maximum(found.crossings - found.source_crossings, 0).tolist(),
    }


class Survey(NamedTuple):
    """Measures of C contours, (C,) each; see :class:`.results.Measures`. Crossings are those of the result and of the
    source, each by itself.
    """

    length: FloatArray
    area_change: FloatArray
    bending_energy: FloatArray
    max_curvature: FloatArray
    overshoot: FloatArray
    crossings: IntArray
    source_crossings: IntArray


@compiled
def survey(result: ContourArrays, source: ContourArrays, polygons: FloatArray, offsets: IntArray) -> Survey:
    """Measure contours.

    Args:
        result: the curves; source: what they were fitted to.
        polygons: (n, 2) their vertices; offsets: (C + 1,) where each contour's begin.
    """
    C = len(offsets) - 1
    length, change, energy, curvature, beyond = np.empty(C), np.empty(C), np.empty(C), np.empty(C), np.empty(C)
    crossings, before = np.empty(C, dtype=np.int64), np.empty(C, dtype=np.int64)
    for c in range(C):
        cubics, given = contour_cubics(result, c), contour_cubics(source, c)
        length[c], energy[c], curvature[c] = 0.0, 0.0, 0.0
        for j in range(len(cubics)):
            if result.degrees[result.offsets[c] + j] == 1:
                length[c] += np.hypot(cubics[j, 3, 0] - cubics[j, 0, 0], cubics[j, 3, 1] - cubics[j, 0, 1])
                continue
            own_length, _, own_energy, own_curvature = integrals(cubics[j : j + 1])
            length[c] += own_length
            energy[c] += own_energy
            curvature[c] = max(curvature[c], own_curvature)
        change[c] = _area(cubics) - _area(given)
        crossings[c], beyond[c] = crossings_and_overshoot(cubics, polygons[offsets[c] : offsets[c + 1]])
        before[c], _ = crossings_and_overshoot(given, polygons[:0])
    return Survey(length, change, energy, curvature, beyond, crossings, before)


@compiled
def _area(cubics: FloatArray) -> float:
    """Signed area of a closed chain, lines among it, exactly: the integral of its Bézier points' products."""
    total = 0.0
    for b in cubics:
        for i, j, weight in ((0, 1, 6), (0, 2, 3), (0, 3, 1), (1, 2, 3), (1, 3, 3), (2, 3, 6)):
            total += weight * (b[i, 0] * b[j, 1] - b[i, 1] * b[j, 0])
    return total / 20
