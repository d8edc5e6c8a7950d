"""One polygon through the compiled core and the plain reference, and how far apart they come out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

import glyphspline as gs
from glyphspline.interpolation.reference import interpolate_reference
from glyphspline.types import FloatArray

TOLERANCE = 1e-9
"""Of control points, in the polygon's extent."""

SETTINGS: list[dict[str, Any]] = [
    {"variant": 2},
    {"variant": 2, "margin": 0.02, "fallback": "peak"},
    {"variant": 1},
    {"variant": 2, "closed": False},
    {"variant": 3},
    {"variant": 2, "max_iterations": 60},
    {"variant": 4},
    {"variant": 2, "knots": "centripetal"},
    {"variant": 2, "closed": False, "end_tangents": ((1.0, 0.0), (0.6, 0.8))},
    {"variant": 2},
    {"variant": 2, "knots": "uniform"},
    {"variant": 0, "max_iterations": 30},
    {"variant": 4, "closed": False},
]


@dataclass(frozen=True)
class Agreement:
    """How two results differ.

    Attributes:
        difference: of control points, in the polygon's extent.
        iterations: compiled less reference.
        fallbacks: likewise.
        rate_bound: likewise.
    """

    difference: float
    iterations: int
    fallbacks: int
    rate_bound: float


def _options(points: FloatArray, number: int, most: int) -> tuple[float, dict[str, Any]]:
    extent = float(np.ptp(points, axis=0).max())
    options = {"residual_tolerance": 2e-7 * extent, **SETTINGS[number % len(SETTINGS)]}
    options["max_iterations"] = min(most, options.get("max_iterations", most))
    return extent, options


def compare(points: FloatArray, number: int, most: int = 120) -> Agreement:
    """Both results for a polygon, the settings going round with its number."""
    extent, options = _options(points, number, most)
    ours, plain = gs.interpolate(points, **options), interpolate_reference(points, **options)
    P, Q = ours.spline.control_points, plain.spline.control_points
    size = max(extent, float(np.abs(Q - Q.mean(axis=0)).max()))  # a variant that diverges leaves the polygon behind
    return Agreement(
        float(np.abs(P - Q).max()) / size,
        ours.iterations - plain.iterations,
        ours.fallbacks - plain.fallbacks,
        ours.rate_bound - plain.rate_bound,
    )


def spread(points: FloatArray, number: int, most: int = 120, runs: int = 8) -> tuple[float, int]:
    """How far the reference's control points move, and how many passes it makes more or less, by rounding alone.

    In every pass each coordinate of each control point is moved up or down, at random, by one rounding unit of the
    polygon's extent: what evaluating the curve costs at best. The largest differences of some runs from the reference
    as it is count.
    """
    extent, options = _options(points, number, most)
    plain = interpolate_reference(points, **options)
    P = plain.spline.control_points
    size = max(extent, float(np.abs(P - P.mean(axis=0)).max()))
    rng = np.random.default_rng(number)
    unit = np.finfo(np.float64).eps * extent
    difference, passes = 0.0, 0
    for _ in range(runs):
        other = interpolate_reference(
            points, **options, disturb=lambda free: free + unit * rng.choice([-1.0, 1.0], free.shape)
        )
        passes = max(passes, abs(other.iterations - plain.iterations))
        difference = max(difference, float(np.abs(other.spline.control_points - P).max()) / size)
    return difference, passes
