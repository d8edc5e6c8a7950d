"""Geometric interpolation of a polygon (Xiong, Li and Mao 2012): the public functions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ..curves.bspline import DEGREES
from ..curves.parameters import CHORD_EXPONENT, Parametrisation
from ..errors import PolygonError
from ..types import FloatArray
from .any_degree import interpolate_stepwise, interpolate_vertex_compiled
from .batched import NO_TANGENTS, explain, interpolate_one, interpolate_ragged, over_threads
from .intervals import Fallback
from .reference import Tangents
from .result import Interpolation

__all__ = ["Interpolation", "interpolate", "interpolate_many", "interpolate_vertex"]

STEPWISE = (0, 4)
"""Variants that do not go through the fast passes of cubics."""

DEFAULTS: dict[str, Any] = {
    "degree": 3,
    "margin": 0.0,
    "fallback": "knot",
    "residual_tolerance": 1e-6,
    "max_iterations": 1000,
    "closed": True,
    "finish": "iterate",
    "diagnostics": False,
}


def interpolate(
    points: ArrayLike,
    variant: int = 2,
    *,
    degree: int = 3,
    margin: float = 0.0,
    knots: Parametrisation | ArrayLike = "chord",
    fallback: Fallback = "knot",
    residual_tolerance: float = 1e-6,
    max_iterations: int = 1000,
    closed: bool = True,
    end_tangents: Tangents | None = None,
    finish: Literal["iterate", "solve"] = "iterate",
    diagnostics: bool = False,
) -> Interpolation:
    """Put a B-spline curve through the vertices of a polygon by geometric interpolation.

    The polygon is the first control polygon. Each control point is moved again and again by the deviation of
    its vertex from its footpoint, the nearest point of the current curve on an interval around its knot.

    Args:
        points: (n, 2) vertices in order, the first not repeated at the end. Consecutive duplicates are merged.
        variant: where footpoints are sought (Table 1): 0 (u_{i-2}, u_{i+2}); 1 (u_{i-1}, u_{i+1}); 2 the interval
            of Lemma 2, which guarantees convergence; 3 only u_i; 4 as 2, but each control point is renewed at
            once (Algorithm 3 instead of 2).
        degree: 2 to 6. An open arc is cubic.
        margin: c ≥ 0 of Lemma 2. With c > 0 the largest error shrinks at least by 1 - 2c a step (Theorem 2), unless a
            basis function stays below 1/2 + c: see ``rate_bound`` of the result.
        knots: "chord" (length), "uniform", "centripetal", or the vertices' parameters: increasing, n + 1 of them
            if closed, the last one closing the period, and n if open.
        fallback: what to do where B_i nowhere exceeds 1/2. "knot" is the paper's Remark 3, t_i = u_i, and may not
            converge on very uneven chords. "peak" takes {B_i ≥ min(1/2 + c, 0.9 max B_i)} for every vertex.
        residual_tolerance: distance, in the units of ``points``, that the largest error has to fall below.
        max_iterations: give up after so many updates.
        closed: a closed curve, or an arc from the first vertex to the last, clamped at both.
        end_tangents: of an open arc, the derivatives (τ_0, τ_1) by chord length at its ends, unit vectors as a rule;
            None for a natural end (no curvature there).
        finish: "iterate" is the paper's limit. "solve" freezes the footpoints once the largest error is below 3/1000 of
            the mean chord and solves for the control points: another curve through the same vertices, beside the first
            by some 5e-4 of the mean chord.
        diagnostics: also keep every iteration, and compute the norms and spectral radii of Section 3 (O(n³) a step).

    Raises:
        PolygonError: the polygon or its knots cannot be interpolated; the message says why.
        ValueError: an option out of its range.
    """
    check_options(variant, degree, margin, fallback, residual_tolerance, max_iterations, closed, end_tangents, finish)
    if degree != 3 or variant in STEPWISE or diagnostics:
        return interpolate_stepwise(
            points, variant, degree=degree, margin=margin, knots=knots, fallback=fallback,
            residual_tolerance=residual_tolerance, max_iterations=max_iterations, closed=closed,
            end_tangents=end_tangents, finish=finish, diagnostics=diagnostics,
        )  # fmt: skip
    p = _as_points(points)
    if not isinstance(knots, str):
        knots = _as_knots(knots, p, closed)
    elif knots not in CHORD_EXPONENT:
        raise explain(p, knots, closed)
    result = interpolate_one(
        p, variant, float(margin), knots, fallback, float(residual_tolerance), max_iterations, closed,
        NO_TANGENTS if closed else _as_tangents([end_tangents]), finish,
    )  # fmt: skip
    if result is None:
        raise explain(p, knots, closed)
    return result


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
        polygons: K arrays (n, 2).
        variant: as for one polygon.
        knots: a rule, or an array for each polygon.
        end_tangents: of open arcs, a pair for each polygon.
        threads: as many at once, None for one a core. The result has the same bits whatever the number.
        errors: "return" puts the PolygonError of a bad polygon in its place in the list, and goes on.
        options: ``degree``, ``margin``, …

    Raises:
        PolygonError: as for :func:`interpolate`; its ``contour`` is the index in the list.
    """
    everything = list(polygons)
    own_knots: Sequence[Any] = [knots] * len(everything) if isinstance(knots, str) else knots
    own_tangents: Sequence[Any] = [None] * len(everything) if end_tangents is None else end_tangents
    if len(own_knots) != len(everything) or len(own_tangents) != len(everything):
        raise ValueError("knots and end_tangents are given for each polygon of the list, or for none")
    together = options.get("degree", 3) == 3 and variant not in STEPWISE and not options.get("diagnostics")
    results: list[Any]
    if together:
        results = _together(everything, variant, knots, own_knots, own_tangents, threads, options)
    else:

        def one(k: int) -> Any:
            try:
                return interpolate(everything[k], variant, knots=own_knots[k], end_tangents=own_tangents[k], **options)
            except PolygonError as error:
                return error

        results = over_threads(one, range(len(everything)), threads)
    for k, result in enumerate(results):
        if isinstance(result, PolygonError):
            result.locate(contour=k)
            if errors == "raise":
                raise result
    return results


def _together(
    polygons: list[ArrayLike],
    variant: int,
    knots: Any,
    own_knots: Sequence[Any],
    own_tangents: Sequence[Tangents | None],
    threads: int | None,
    options: dict[str, Any],
) -> list[Any]:
    """One ragged call for all polygons that are arrays of the right shape; results or errors, in order."""
    settings = {**DEFAULTS, **options}
    closed = settings["closed"]
    if isinstance(knots, str) and knots not in CHORD_EXPONENT:
        raise PolygonError(f"knots are {', '.join(CHORD_EXPONENT)} or an array, not {knots!r}")
    check_options(variant, **settings, end_tangents=next((t for t in own_tangents if t is not None), None))
    results: list[Any] = [None] * len(polygons)
    parts: list[FloatArray] = []
    given: list[FloatArray] = []
    try:  # all at once: most lists have nothing wrong with them
        parts = [_as_points(points) for points in polygons]
        given = [] if isinstance(knots, str) else [_as_knots(*of, closed) for of in zip(own_knots, parts, strict=True)]
        good: Sequence[int] = range(len(polygons))
    except PolygonError:
        good, parts, given = _sorted_out(polygons, own_knots, closed, results)
    if not good:
        return results
    offsets = np.zeros(len(good) + 1, dtype=np.int64)
    np.cumsum([len(p) for p in parts], out=offsets[1:])
    del settings["degree"], settings["diagnostics"]
    found = interpolate_ragged(
        np.concatenate(parts), offsets, variant, knots=knots if isinstance(knots, str) else np.concatenate(given),
        end_tangents=None if closed else _as_tangents([own_tangents[k] for k in good]), threads=threads, **settings,
    )  # fmt: skip
    if len(good) == len(polygons) and not found.whole[:, 0].any():  # all is well, as in most lists
        return found.results()
    status = found.whole[:, 0].tolist()
    for j, k in enumerate(good):
        results[k] = found.result(j) if status[j] == 0 else explain(parts[j], own_knots[k], closed)
    return results


def _sorted_out(
    polygons: list[ArrayLike], own_knots: Sequence[Any], closed: bool, results: list[Any]
) -> tuple[list[int], list[FloatArray], list[FloatArray]]:
    """Which polygons are arrays of the right shape, those, and their own knots; errors go to ``results``."""
    good: list[int] = []
    parts: list[FloatArray] = []
    given: list[FloatArray] = []
    for k, points in enumerate(polygons):
        try:
            p = _as_points(points)
            if not isinstance(own_knots[k], str):
                given.append(_as_knots(own_knots[k], p, closed))
        except PolygonError as error:
            results[k] = error
            continue
        good.append(k)
        parts.append(p)
    return good, parts, given


def _as_points(points: ArrayLike) -> FloatArray:
    try:
        p = np.ascontiguousarray(points, dtype=np.float64)
    except (TypeError, ValueError):
        raise explain(points, "chord", True) from None
    if p.ndim != 2 or p.shape[1] != 2:
        raise explain(p, "chord", True)
    return p


def _as_knots(knots: ArrayLike, p: FloatArray, closed: bool) -> FloatArray:
    given = np.ascontiguousarray(knots, dtype=np.float64)
    if given.shape != (len(p) + closed,):
        raise explain(p, given, closed)
    return given


def _as_tangents(tangents: Sequence[Tangents | None]) -> FloatArray:
    """(K, 2, 2), NaN for natural ends."""
    array = np.full((len(tangents), 2, 2), np.nan)
    for k, pair in enumerate(tangents):
        for end, tangent in enumerate(pair or ()):
            if tangent is not None:
                array[k, end] = tangent
    return array


def interpolate_vertex(
    points: ArrayLike,
    k: int,
    *,
    whole_curve: bool = False,
    residual_tolerance: float = 1e-6,
    max_iterations: int = 1000,
) -> Interpolation:
    """Algorithm 1: move control point k alone until the closed cubic passes through p_k (Theorem 1).

    The footpoint is sought in [u_{k-1}, u_{k+1}], where each step multiplies the error by at most
    ``rate_bound`` = 1 - min B_k. ``parameters`` and ``intervals`` of the result have the one row of p_k.

    Args:
        points: (n, 2) the polygon.
        k: which vertex; duplicates are merged before counting.
        whole_curve: seek the footpoint on the whole curve, which may fail to converge (Remark 2).
        residual_tolerance: distance that the error has to fall below.
        max_iterations: give up after so many updates.

    Raises:
        PolygonError: the polygon cannot be interpolated, or has no vertex k.
    """
    return interpolate_vertex_compiled(
        points, k, whole_curve=whole_curve, residual_tolerance=residual_tolerance, max_iterations=max_iterations
    )


def check_options(
    variant: int,
    degree: int,
    margin: float,
    fallback: str,
    residual_tolerance: float,
    max_iterations: int,
    closed: bool,
    end_tangents: Tangents | None,
    finish: str,
    diagnostics: bool = False,
) -> None:
    """Options that are wrong whatever the polygon."""
    if variant not in range(5):
        raise ValueError(f"variant is 0 to 4, not {variant!r}")
    if degree not in DEGREES:
        raise ValueError(f"degree is 2 to 6, not {degree!r}")
    if not 0 <= margin <= 0.5:
        raise ValueError(f"margin is 0 to 0.5, not {margin!r}")
    if fallback not in ("knot", "peak"):
        raise ValueError(f'fallback is "knot" or "peak", not {fallback!r}')
    if not residual_tolerance > 0:
        raise ValueError(f"residual_tolerance is a positive distance, not {residual_tolerance!r}")
    if max_iterations < 0:
        raise ValueError(f"max_iterations is 0 or more, not {max_iterations!r}")
    if finish not in ("iterate", "solve"):
        raise ValueError(f'finish is "iterate" or "solve", not {finish!r}')
    if closed and end_tangents is not None:
        raise ValueError("end_tangents belong to an open arc (closed=False)")
    if not closed and degree != 3:
        raise ValueError("an open arc is cubic (degree=3)")
