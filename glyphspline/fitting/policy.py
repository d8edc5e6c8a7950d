"""Closed curves through several polygons under a glyph's options, and the same curves run the other way."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from ..curves.bspline import Spline
from ..errors import PolygonError
from ..interpolation.api import STEPWISE, interpolate
from ..interpolation.batched import Ragged, explain, interpolate_ragged
from ..interpolation.result import Interpolation
from ..types import FloatArray, IntArray
from .options import Options
from .smooth.insertion import graded_polygons

CERTAIN_RATIO = 6.0
"""Basis functions rise above 1/2 as long as adjacent knot intervals are within 6.15 of each other."""


def interpolated(points: FloatArray, offsets: IntArray, options: Options) -> Ragged:
    """Interpolate closed polygons.

    Graded ones are run by Lemma 2's own rule, which then has an interval everywhere, others with the fallback that the
    options name.

    Args:
        points: ragged (n, 2), with offsets.

    Raises:
        PolygonError: one that cannot be interpolated; its ``contour`` is the number of the polygon.
    """
    even = graded_polygons(points, offsets, min(options.max_ratio, CERTAIN_RATIO) * (1 + 1e-9))
    if options.variant not in STEPWISE and (even.all() or options.fallback == "knot"):
        found = interpolate_ragged(
            points, offsets, options.variant, margin=options.margin, fallback="knot",
            residual_tolerance=options.solver_tolerance, max_iterations=options.max_iterations, threads=1,
        )  # fmt: skip
        for k in np.flatnonzero(found.whole[:, 0]).tolist():
            raise explain(points[offsets[k] : offsets[k + 1]], "chord", True).locate(contour=k)
        return found
    results = []
    for k, (a, b) in enumerate(pairwise(offsets.tolist())):
        try:
            results.append(
                interpolate(
                    points[a:b], options.variant, margin=options.margin,
                    fallback="knot" if even[k] else options.fallback, residual_tolerance=options.solver_tolerance,
                    max_iterations=options.max_iterations,
                )
            )  # fmt: skip
        except PolygonError as error:
            raise error.locate(contour=k) from None
    return _gathered(results, offsets, options)


def _gathered(results: list[Interpolation], offsets: IntArray, options: Options) -> Ragged:
    """Results of single polygons as one of many."""
    total, count = int(offsets[-1]), len(results)
    found = Ragged(
        offsets, np.empty(total + count), np.empty((total, 2)), np.empty(total), np.empty((total, 2)),
        np.empty(total, dtype=np.int64), np.zeros((count, 5), dtype=np.int64),
        np.array([r.rate_bound for r in results]), np.concatenate([r.residuals for r in results]),
        np.cumsum([0] + [len(r.residuals) for r in results]), np.full(count, options.solver_tolerance), True,
    )  # fmt: skip
    for k, r in enumerate(results):
        a, n = int(offsets[k]), len(r.parameters)
        found.knots[a + k : a + k + n + 1], found.controls[a : a + n] = r.spline.knots, r.spline.control_points
        found.parameters[a : a + n], found.bounds[a : a + n] = r.parameters, r.intervals
        found.kept[a : a + n] = np.delete(np.arange(offsets[k + 1] - a), r.merged)
        found.whole[k, 1:4] = n, r.iterations, r.fallbacks
    return found


class Backwards:
    """A result of many as it is for the polygon run the other way from its first vertex: the same curve, exactly."""

    def __init__(self, found: Ragged) -> None:
        self.found = found

    def read(self, k: int) -> dict[str, Any]:
        """The attributes of polygon k's :class:`..interpolation.result.Interpolation`."""
        given = self.found.read(k)
        spline, t, ends = given["spline"], given["parameters"], given["intervals"]
        period = spline.knots[-1]
        parameters, intervals = turned(period - t), turned(period - ends[:, ::-1])
        parameters[0], intervals[0] = -t[0], -ends[0, ::-1]
        knots = period - spline.knots[::-1]
        return given | {
            "spline": Spline.trusted(turned(spline.control_points), knots, 3, True),
            "parameters": parameters,
            "intervals": intervals,
        }


def turned(rows: FloatArray) -> FloatArray:
    """What belongs to a ring of vertices, in the order in which the other direction comes by, from the same first."""
    return np.concatenate([rows[:1], rows[:0:-1]])
