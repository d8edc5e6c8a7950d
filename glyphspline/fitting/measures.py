"""Measures of contours, column-wise: those of the interpolation, and the geometry of source and result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..compiled import compiled
from ..curves.cubics import turns
from ..curves.fairness import TURN, curvatures, extrema_of
from ..curves.integrals import area, integrals
from ..curves.overshoot import overshoot
from ..curves.pairing import ROUNDING
from ..errors import GlyphsplineError
from ..interpolation.polygon import LARGEST, clean_polygon
from ..interpolation.result import BatchedInterpolation
from ..outlines.contour_arrays import ContourArrays
from ..outlines.sampling import CORNER_ANGLE
from ..outlines.segments import contour_cubics
from ..types import FloatArray, IntArray
from .options import Options
from .results import ConvertedContours

CORNER = float(np.cos(np.radians(CORNER_ANGLE)))
"""Cosine of the turn from which a joint is a corner and has no curvature, whatever the angle of a fit."""

Columns = dict[str, Sequence[Any]]
"""For each measure, its value for each contour."""


def check_coordinates(contours: ContourArrays, tolerance: float = np.inf) -> None:
    """Refuse coordinates that are not finite, or too large for numbers, or for distances up to the tolerance.

    Raises:
        GlyphsplineError: its ``contour`` is the index.
    """
    most = min(LARGEST / 4, tolerance / ROUNDING)
    if len(contours.points) == 0 or np.abs(contours.points).max() < most:
        return
    for k in range(contours.num_contours):
        points = contours.points[contours.starts[k] : contours.starts[k + 1]]
        if not (far := np.abs(points).max()) < most:
            try:
                if not np.isfinite(points).all():
                    raise GlyphsplineError("the outline has a coordinate that is not finite")
                clean_polygon(points)
                if tolerance < np.inf:
                    raise GlyphsplineError(
                        f"coordinates up to {far:.3g} are too large for a tolerance of {tolerance:g}"
                    )
            except GlyphsplineError as error:
                raise error.locate(contour=k) from None


def solved_columns(parts: Sequence[tuple[BatchedInterpolation, IntArray]]) -> Columns:
    """The measures of ``results.SOLVED`` for closed curves, one for each contour.

    Args:
        parts: results of a batch and the indices of the chosen polygons in it, in the order of the contours.
    """
    counts, iterations, fallbacks = np.concatenate([found.arrays.whole[which, 1:4] for found, which in parts]).T
    residuals = np.concatenate([found.last_residuals[which] for found, which in parts])
    tolerances = np.concatenate([found.arrays.tolerances[which] for found, which in parts])
    return {
        "vertices": counts.tolist(),
        "segments": counts.tolist(),
        "numbers": (2 * counts).tolist(),
        "iterations": iterations.tolist(),
        "residual": residuals.tolist(),
        "converged": (residuals < tolerances).tolist(),
        "rate_bound": np.concatenate([found.arrays.rates[which] for found, which in parts]).tolist(),
        "fallbacks": fallbacks.tolist(),
    }


def distance_columns(gaps: Sequence[float | None], bounds: Sequence[float], tolerance: float) -> Columns:
    """Measured distances and their certified bounds, compared with the tolerance, all in font units."""
    within = [bool(bound <= tolerance) for bound in bounds]
    return {"deviation": gaps, "deviation_bound": bounds, "within_tolerance": within}


def with_geometry(result: ConvertedContours, options: Options) -> ConvertedContours:
    """Results with length, area and curvature, as they are written, beside their sources'."""
    curves, polygons = result.curves, result.polygons
    found = geometry(curves, curves.rounded(options.precision), result.source, polygons.points, polygons.offsets)
    columns = {name: values.tolist() for name, values in found._asdict().items()}
    if options.corners == "sharp":  # no corner is rounded
        del columns["curvature_extrema_floor"]
    return replace(result, measures={**result.measures, **columns})


class Geometry(NamedTuple):
    """Measures of C contours, (C,) each; see :class:`.results.Measures`."""

    overshoot: FloatArray
    length: FloatArray
    area_change: FloatArray
    bending_energy: FloatArray
    max_curvature: FloatArray
    curvature_extrema: IntArray
    source_curvature_extrema: IntArray
    curvature_extrema_floor: IntArray


@compiled
def geometry(
    curves: ContourArrays, written: ContourArrays, source: ContourArrays, polygons: FloatArray, offsets: IntArray
) -> Geometry:
    """Measure contours as they are written; but the extrema of curvature as they are fitted.

    Args:
        curves: the curves; written: the same, rounded. source: the contours that they approximate.
        polygons: (n, 2) their vertices. offsets: (C + 1,) where each polygon begins.
    """
    C = len(offsets) - 1
    length, change, energy, curvature, beyond = np.empty(C), np.empty(C), np.empty(C), np.empty(C), np.empty(C)
    extrema, extrema_before, floor = np.empty((3, C), dtype=np.int64)
    for c in range(C):
        cubics, given = contour_cubics(written, c), contour_cubics(source, c)
        length[c], energy[c], curvature[c] = _bends(
            cubics, written.degrees[written.offsets[c] : written.offsets[c + 1]]
        )
        length_before, _, _ = _bends(given, source.degrees[source.offsets[c] : source.offsets[c + 1]])
        values, _, n = curvatures(contour_cubics(curves, c), length[c], CORNER)
        extrema[c] = extrema_of(values, n, TURN / length[c])
        extrema_before[c], floor[c], _, _ = extrema_floor(given, length_before)
        change[c] = area(cubics) - area(given)
        beyond[c] = overshoot(cubics, polygons[offsets[c] : offsets[c + 1]])
    return Geometry(beyond, length, change, energy, curvature, extrema, extrema_before, floor)


@compiled
def extrema_floor(given: FloatArray, length: float) -> tuple[int, int, FloatArray, FloatArray]:
    """Extrema of curvature of a contour (m, 4, 2) of a length; and with its corners rounded, as tightly as can be.

    Each corner is then a peak above all others. Curvature goes from peak to peak through that of the sides.

    Returns:
        The two numbers; and curvatures and places of :func:`.fairness.curvatures`, infinite at corners.
    """
    values, where, n = curvatures(given, length, CORNER)
    extrema, bends = extrema_of(values, n, TURN / length), turns(given, 0.0)
    for i in range(n):
        if np.isnan(values[i]):
            values[i] = np.copysign(np.inf, bends[int(where[i])])
    return extrema, extrema_of(values, n, TURN / length), values[:n], where[:n]


@compiled
def _bends(cubics: FloatArray, degrees: IntArray) -> tuple[float, float, float]:
    """Length, bending energy and largest absolute curvature of some segments; lines have no more than a length."""
    length = energy = curvature = 0.0
    for j in range(len(cubics)):
        if degrees[j] == 1:
            length += np.hypot(cubics[j, 3, 0] - cubics[j, 0, 0], cubics[j, 3, 1] - cubics[j, 0, 1])
            continue
        own_length, own_energy, own_curvature = integrals(cubics[j : j + 1])
        length += own_length
        energy += own_energy
        curvature = max(curvature, own_curvature)
    return length, energy, curvature
