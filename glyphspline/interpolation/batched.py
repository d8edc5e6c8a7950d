"""Interpolation of many cubic polygons laid end to end, by the compiled driver or, one by one, by the plain one."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..curves.parameters import vertex_parameters
from ..errors import PolygonError
from ..types import BoolArray, FloatArray, IntArray
from .compiled_batch import BatchedInterpolation, empty_results, filled, over_threads, run_batch
from .driver import interpolate_any_degree
from .method import Method
from .polygon import clean_polygon


def interpolate_batch(
    points: FloatArray,
    offsets: IntArray,
    method: Method,
    *,
    knots: FloatArray | None = None,
    end_tangents: FloatArray | None = None,
    by_knot: BoolArray | None = None,
    residual_tolerances: FloatArray | None = None,
    threads: int | None = None,
) -> BatchedInterpolation:
    """Cubic interpolation of many polygons laid end to end. A bad polygon has a status and raises no exception.

    Args:
        points: (N, d) float64, contiguous, d ≥ 2; offsets: (K + 1,) int64, where each polygon begins, and N.
        method: of degree 3, without diagnostics.
        knots: given parameters of all polygons end to end (n + 1 each if closed, n if open), unless the method has a
            rule.
        end_tangents: (K, 2, d) of open arcs, NaN for natural ends; None: all are natural.
        by_knot: (K,) polygons with ``fallback="knot"`` instead of the method's.
        residual_tolerances: (K,) in place of the method's.
        threads: number of threads; None for one a core. Results do not depend on it.
    """
    peak_shares = filled(len(offsets) - 1, method.peak_share)
    if by_knot is not None:
        peak_shares[by_knot] = 0.0
    if method.stepwise:
        return _gathered(points, offsets, method, peak_shares, knots, end_tangents, residual_tolerances, threads)
    return run_batch(
        points, offsets, method, peak_shares=peak_shares, knots=knots, end_tangents=end_tangents,
        residual_tolerances=residual_tolerances, threads=threads,
    )  # fmt: skip


def _gathered(
    points: FloatArray, offsets: IntArray, method: Method, peak_shares: FloatArray, knots: FloatArray | None,
    end_tangents: FloatArray | None, residual_tolerances: FloatArray | None, threads: int | None,
) -> BatchedInterpolation:  # fmt: skip
    """A batch by the passes of any variant and dimension, one polygon at a time."""
    (total, d), count, closed = points.shape, len(offsets) - 1, method.closed
    out = empty_results(total, count, closed, d)
    u, P, parameters, bounds, kept, whole, rates = out
    whole[:] = np.array([1, 0, -1, 0, 0, 0])
    tolerances, residuals = np.zeros(count), [np.empty(0)] * count

    def one(k: int) -> None:
        a, b = offsets[k : k + 2].tolist()
        own = replace(method, fallback="peak" if peak_shares[k] > 0.0 else "knot")
        if residual_tolerances is not None:
            own = replace(own, residual_tolerance=float(residual_tolerances[k]))
        given = None if knots is None or method.knots else knots[a + k * closed : b + (k + 1) * closed]
        tangents: Any = None
        if end_tangents is not None and not closed:
            tangents = tuple(None if np.isnan(each).any() else each for each in end_tangents[k])
        try:
            r = interpolate_any_degree(points[a:b], own, given, tangents)
        except PolygonError:
            return
        n, first, start = len(r.parameters), a + k * closed, a + 2 * k * (not closed)
        u[first : first + n + closed], P[start : start + n + 2 * (not closed)] = r.spline.knots, r.spline.control_points
        parameters[a : a + n], bounds[a : a + n] = r.parameters, r.intervals
        kept[a : a + n] = np.delete(np.arange(b - a), r.merged)
        whole[k, :4], whole[k, 5] = (0, n, r.iterations, r.fallbacks), r.uncertified
        rates[k], residuals[k] = r.rate_bound, r.residuals
        tolerances[k] = own.tolerance_for(float(np.ptp(points[a:b], axis=0).max()))

    over_threads(one, range(count), threads)
    joined = np.concatenate([*residuals, np.empty(0)])
    return BatchedInterpolation(offsets, u, P, parameters, bounds, kept, whole, rates, joined, tolerances, closed)


def explain(points: ArrayLike, knots: Any, closed: bool) -> PolygonError:
    """The error that says why the compiled kernels refused a polygon."""
    try:
        p, merged = clean_polygon(points, closed)
        if not isinstance(knots, str):
            knots = np.delete(np.asarray(knots, dtype=np.float64), merged)
        vertex_parameters(p, knots, closed)
    except PolygonError as error:
        return error
    return PolygonError(
        "neighbouring vertices are so close, beside the polygon's length, that their knots fall together"
    )
