"""Geometric interpolation of a polygon (Xiong, Li and Mao 2012): the public functions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import accumulate
from typing import Any, Literal, overload

import numpy as np
from numpy.typing import ArrayLike

from ..errors import OptionError, PolygonError, require_choice
from ..types import FloatArray
from .batch import interpolate_batch
from .method import Fallback, Method, Parametrisation, Tangents, method_of
from .polygon import NO_KNOTS, NO_TANGENTS, Polygons, as_points, as_tangents, explain
from .result import Interpolation

OF_ARCS = "end_tangents belong to an open arc (closed=False)"

__all__ = ["Interpolation", "interpolate", "interpolate_many", "interpolate_vertex"]


def interpolate(
    points: ArrayLike,
    variant: int = 2,
    *,
    degree: int = 3,
    margin: float = 0.0,
    knots: Parametrisation | ArrayLike = "chord",
    fallback: Fallback = "knot",
    residual_tolerance: float | None = None,
    max_iterations: int = 1000,
    closed: bool = True,
    end_tangents: Tangents | None = None,
    diagnostics: bool = False,
) -> Interpolation:
    """Put a B-spline curve through the vertices of a polygon by geometric interpolation.

    The polygon is the first control polygon. Each control point is moved again and again by the deviation of
    its vertex from its footpoint, the nearest point of the current curve on an interval around its knot.

    Args:
        points: (n, d) vertices in order, d ≥ 2, the first not repeated at the end. Consecutive duplicates are merged.
            Nothing in the method or its proofs needs the plane. Polygons with as many vertices, as the masters of a
            variable outline are, can be interpolated as one, side by side: they share knots and footpoints then.
        variant: where footpoints are sought (Table 1): 0 (u_{i-2}, u_{i+2}); 1 (u_{i-1}, u_{i+1}); 2 the interval
            of Lemma 2, which guarantees convergence; 3 only u_i; 4 as 2, but each control point is updated at
            once (Algorithm 3 instead of 2).
        degree: 2 to 6. An open arc is cubic. Other degrees than 3 take some 0.3 ms a footpoint.
        margin: c ≥ 0 of Lemma 2. With c > 0 the largest error shrinks at least by 1 - 2c a step (Theorem 2), unless a
            basis function stays below 1/2 + c: see ``rate_bound`` of the result. The first and the last inner vertex of
            an arc have c = 1/16 at least, whatever the knots.
        knots: "chord" (length), "uniform", "centripetal", or the vertices' parameters: increasing, n + 1 of them
            if closed, the last one closing the period, and n if open.
        fallback: what to do where B_i nowhere exceeds 1/2. "knot" is the paper's Remark 3, t_i = u_i, and may not
            converge on very uneven chords. "peak" takes {B_i ≥ min(1/2 + c, 0.9 max B_i)} for every vertex.
        residual_tolerance: distance, in the units of ``points``, that the largest error has to fall below; None for
            1e-6 of the polygon's extent (the larger of its width and height, or the largest of all d ranges).
        max_iterations: maximum number of updates.
        closed: a closed curve, or an arc from the first vertex to the last, clamped at both.
        end_tangents: of an open arc, the derivatives (τ_0, τ_1) by chord length at its ends, (d,) unit vectors as a
            rule; None for a natural end (no curvature there).
        diagnostics: also keep every iteration, and compute the norms and spectral radii of Section 3 (O(n³) a step), as
            slowly.

    Raises:
        PolygonError: the polygon or its knots cannot be interpolated; the message says why.
        OptionError: an option out of its range. Both are ValueErrors.

    Example:
        >>> from glyphspline import interpolate
        >>> found = interpolate([[0, 0], [4, 0], [5, 3], [2, 5], [-1, 3]], margin=0.02)
        >>> found.converged, found.max_error < 1e-5
        (True, True)
        >>> found.spline
        <Spline: closed, degree 3, 5 control points, t from 0 to 17.5357>
        >>> found.spline(found.parameters).round(3).tolist()[1]  # it passes through the vertices
        [4.0, 0.0]
    """
    own = not isinstance(knots, str)
    method = method_of(
        variant, degree, margin, None if own else knots, fallback, residual_tolerance, max_iterations, closed,
        diagnostics,
    )  # fmt: skip
    if closed and end_tangents is not None:
        raise OptionError(OF_ARCS)
    p = as_points(points)
    given = _as_knots(knots, p, closed) if own else NO_KNOTS
    ends = NO_TANGENTS if end_tangents is None else as_tangents([end_tangents], p.shape[1])
    if method.readable:
        return _readable(p, method, given if own else None, end_tangents)
    found = interpolate_batch(Polygons(p, np.array((0, len(p))), given, ends), method, 1).first(p.copy())
    if found is None:
        raise explain(p, given if own else knots, closed)
    return found


@overload
def interpolate_many(
    polygons: Iterable[ArrayLike], variant: int = 2, *, errors: Literal["raise"] = "raise", **options: Any
) -> list[Interpolation]: ...
@overload
def interpolate_many(
    polygons: Iterable[ArrayLike], variant: int = 2, *, errors: Literal["return"], **options: Any
) -> list[Interpolation | PolygonError]: ...
def interpolate_many(
    polygons: Iterable[ArrayLike],
    variant: int = 2,
    *,
    knots: Parametrisation | Sequence[ArrayLike] = "chord",
    end_tangents: Sequence[Tangents | None] | None = None,
    threads: int | None = None,
    errors: Literal["raise", "return"] = "raise",
    **options: Any,
) -> list[Any]:
    """Interpolate each polygon of a list, over threads; other options, and the results, are as for :func:`interpolate`.

    Args:
        polygons: K arrays (n, d), d the same for all.
        variant: as for one polygon.
        knots: a rule, or an array for each polygon.
        end_tangents: of open arcs, a pair for each polygon.
        threads: number of threads, None for one a core. Results do not depend on it.
        errors: "return" returns PolygonErrors in place of bad polygons.
        options: ``degree``, ``margin``, …

    Raises:
        PolygonError: as for :func:`interpolate`; its ``contour`` is the index in the list.
        OptionError: as for :func:`interpolate`.

    Example:
        >>> from glyphspline import interpolate_many
        >>> triangle, square = [[0, 0], [4, 0], [2, 3]], [[0, 0], [1, 0], [1, 1], [0, 1]]
        >>> [len(found.parameters) for found in interpolate_many([triangle, square])]
        [3, 4]
        >>> interpolate_many([triangle, [[0, 0]]], errors="return")[1].contour
        1
    """
    everything = list(polygons)
    own = None if isinstance(knots, str) else knots
    rule: Any = knots if own is None else None
    require_choice("errors", errors, ("raise", "return"))
    if any(each is not None and len(each) != len(everything) for each in (own, end_tangents)):
        raise OptionError("knots and end_tangents are given for each polygon of the list, or for none")
    results: list[Any] = interpolate_each(
        everything, Method(variant, knots=rule, **options), own, end_tangents, threads, keep_points=True
    )
    for k, result in enumerate(results):
        if isinstance(result, PolygonError):
            result.locate(contour=k)
            if errors == "raise":
                raise result
    return results


def interpolate_each(
    polygons: Sequence[ArrayLike],
    method: Method,
    own_knots: Sequence[ArrayLike] | None,
    tangents: Sequence[Tangents | None] | None,
    threads: int | None,
    keep_points: bool = False,
) -> list[Interpolation | PolygonError]:
    """A result or an error for each polygon, in order; arguments as of the functions above.

    Args:
        keep_points: whether results have a copy of their ``points``.
    """
    if method.closed and tangents is not None and any(pair is not None for pair in tangents):
        raise OptionError(OF_ARCS)
    results: list[Any] = [None] * len(polygons)
    good: list[int] = []
    parts: list[FloatArray] = []
    given: list[FloatArray] = []
    for k, points in enumerate(polygons):
        try:
            p = as_points(points)
            if parts and p.shape[1] != parts[0].shape[1]:
                raise PolygonError(f"{p.shape[1]} coordinates a vertex, where those before have {parts[0].shape[1]}")
            if own_knots is not None:
                given.append(_as_knots(own_knots[k], p, method.closed))
        except PolygonError as error:
            results[k] = error
            continue
        good.append(k)
        parts.append(p)
    if not good:
        return results
    if method.readable:
        for j, k in enumerate(good):
            try:
                results[k] = _readable(parts[j], method, given[j] if given else None, tangents[k] if tangents else None)
            except PolygonError as error:
                results[k] = error
        return results
    together = Polygons(
        np.concatenate(parts), np.array([0, *accumulate(map(len, parts))]),
        np.concatenate(given) if given else NO_KNOTS,
        as_tangents([tangents[k] for k in good], parts[0].shape[1]) if tangents else NO_TANGENTS,
    )  # fmt: skip
    found = interpolate_batch(together, method, threads).results(together.points if keep_points else None)
    for j, k in enumerate(good):
        results[k] = found[j] or explain(parts[j], given[j] if given else method.knots, method.closed)
    return results


def _readable(p: FloatArray, method: Method, knots: FloatArray | None, tangents: Tangents | None) -> Interpolation:
    from .reference import interpolate_by  # not needed for what the kernels have

    result = interpolate_by(method, p, knots, tangents)
    return replace(result, points=np.delete(p, result.merged, axis=0))


def _as_knots(knots: ArrayLike, p: FloatArray, closed: bool) -> FloatArray:
    try:
        given = np.ascontiguousarray(knots, dtype=np.float64)
    except (TypeError, ValueError) as cause:
        raise PolygonError("knots are an array of numbers") from cause
    if given.shape != (len(p) + closed,):
        raise explain(p, given, closed)
    return given


def interpolate_vertex(
    points: ArrayLike,
    k: int,
    *,
    whole_curve: bool = False,
    residual_tolerance: float | None = None,
    max_iterations: int = 1000,
) -> Interpolation:
    """Algorithm 1: move control point k only until the closed cubic passes through p_k (Theorem 1).

    The footpoint is sought in [u_{k-1}, u_{k+1}], where each step multiplies the error by at most
    ``rate_bound`` = 1 - min B_k. ``parameters`` and ``intervals`` of the result have the one row of p_k.

    Args:
        points: (n, d) the polygon.
        k: which vertex; duplicates are merged before counting.
        whole_curve: seek the footpoint on the whole curve, which may fail to converge (Remark 2).
        residual_tolerance: distance that the error has to fall below; None for 1e-6 of the polygon's extent.
        max_iterations: maximum number of updates.

    Raises:
        PolygonError: the polygon cannot be interpolated, or has no vertex k.
        OptionError: an option out of its range.
    """
    from .reference import interpolate_one_vertex

    method = Method(1, residual_tolerance=residual_tolerance, max_iterations=max_iterations)
    return interpolate_one_vertex(points, k, method, whole_curve)
