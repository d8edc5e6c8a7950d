"""Closed curves through several polygons under a glyph's options."""

from __future__ import annotations

import numpy as np

from ..interpolation.batched import BatchedInterpolation, explain, interpolate_batch
from ..interpolation.method import Fallback, Method, method_of
from ..types import FloatArray, IntArray
from .options import Options
from .smooth.insertion import graded_polygons

CERTAIN_RATIO = 6.0
"""Basis functions rise above 1/2 as long as adjacent knot intervals are within 6.15 of each other."""


def method_for(options: Options, fallback: Fallback | None = None, closed: bool = True) -> Method:
    """How a glyph's options interpolate, with another fallback if one is given."""
    return method_of(
        options.variant, 3, options.margin, "chord", fallback or options.fallback, options.solver_tolerance,
        options.max_iterations, closed, "iterate", False,
    )  # fmt: skip


def interpolated(points: FloatArray, offsets: IntArray, options: Options) -> BatchedInterpolation:
    """Interpolate closed polygons.

    Lemma 2 has an interval everywhere on graded polygons, which need no fallback; others have that of the options.

    Args:
        points: (n, 2) end to end, with offsets.

    Raises:
        PolygonError: one that cannot be interpolated; its ``contour`` is the number of the polygon.
    """
    even = graded_polygons(points, offsets, min(options.max_ratio, CERTAIN_RATIO) * (1 + 1e-9))
    found = interpolate_batch(points, offsets, method_for(options), by_knot=even, threads=1)
    for k in np.flatnonzero(found.whole[:, 0]).tolist():
        raise explain(points[offsets[k] : offsets[k + 1]], "chord", True).locate(contour=k)
    return found
