"""The method in its plainest form: NumPy, ``numpy.roots`` for the footpoints as in the paper, one vertex at a time.

It is for reading the algorithms, and slow: some 0.3 ms a footpoint. The kernels have to agree with it. What they do not
have is here alone: degrees other than 3, the matrices and the history of a run, and Algorithm 1. Nothing in the
algorithms or their proofs needs the plane: vertices may have d ≥ 2 coordinates.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..curves.bspline import Spline, full_knots
from ..errors import PolygonError
from ..types import FloatArray, IntArray
from .intervals import Intervals, arc_intervals, search_intervals
from .method import Method, Parametrisation, Tangents
from .polygon import as_tangents, clean_polygon, closed_knots, lengths, vertex_centres, vertex_parameters
from .result import Interpolation
from .roots import footpoint


@dataclass(frozen=True, eq=False)
class Problem:
    """A prepared polygon: free control points, and search intervals of footpoints.

    Attributes:
        points: (n, d) the vertices, duplicates merged.
        vertices: (f,) indices of the vertices with a free control point of their own.
        knots, degree, closed: of the spline.
        centres: (n,) parameters s_i of the vertices.
        intervals: of the vertices in ``vertices``.
        spread, fixed: the control points are ``spread @ free + fixed``; the identity and 0 if closed.
        merged: indices of vertices dropped as duplicates.
    """

    points: FloatArray
    vertices: IntArray
    knots: FloatArray
    degree: int
    closed: bool
    centres: FloatArray
    intervals: Intervals
    spread: FloatArray
    fixed: FloatArray
    merged: IntArray

    def spline(self, free: FloatArray) -> Spline:
        """The curve for given free control points (f, d)."""
        return Spline.trusted(self.spread @ free + self.fixed, self.knots, self.degree, self.closed)

    def matrix(self, t: FloatArray) -> FloatArray:
        """(f, f) B: how the curve at the footpoints (f,) depends on the free control points."""
        return self.spline(np.zeros((len(self.vertices), self.fixed.shape[1]))).basis(t) @ self.spread


def prepare(
    points: ArrayLike, method: Method, knots: ArrayLike | None = None, end_tangents: Tangents | None = None
) -> Problem:
    """Check the input and lay out knots, intervals and free control points; ``knots`` if the method has no rule."""
    degree, closed = method.degree, method.closed
    p, merged = clean_polygon(points, closed)
    rule: Any = method.knots
    s = vertex_parameters(p, rule or np.delete(np.asarray(knots, dtype=np.float64), merged), closed)
    if closed:
        u, centres, vertices = closed_knots(s, degree), vertex_centres(s, degree), np.arange(len(p))
        first = vertices - (degree + 1) // 2
        spread, fixed = np.eye(len(p)), np.zeros(p.shape)
    else:
        u, centres, vertices = s, s, np.arange(1, len(p) - 1)
        first = vertices - 2
        spread, fixed = np.zeros((len(p) + 2, len(vertices))), np.zeros((len(p) + 2, p.shape[1]))
        np.fill_diagonal(spread[2:-2], 1.0)
        natural, fixed[[1, -2]] = controls_beside_ends(p, np.diff(u), as_tangents([end_tangents], p.shape[1])[0])
        fixed[[0, -1]] = p[[0, -1]]
        if len(vertices):
            spread[[1, -2], [0, -1]] = natural
    windows = full_knots(u, degree + 2, closed)[degree + 2 + first[:, None] + np.arange(degree + 2)]
    intervals = (search_intervals if closed else partial(arc_intervals, u, spread))(
        windows, centres[vertices], method.variant, method.margin, method.fallback
    )
    return Problem(p, vertices, u, degree, closed, centres, intervals, spread, fixed, merged)


def controls_beside_ends(q: FloatArray, h: FloatArray, tangents: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Weights and rests of the control points beside the ends: base + weight times the free one next to them.

    With a tangent τ that of the first end is fixed at q_0 + h_0/3 τ. A natural end (C'' = 0) keeps it on the line from
    q_0 to the first free point, at h_0/(2 h_0 + h_1) of the way, as clamped knots have it.
    """
    natural, base = np.zeros(2), np.zeros((2, q.shape[1]))
    if len(h) > 1:
        natural = np.isnan(tangents).any(axis=1) * h[[0, -1]] / (2 * h[[0, -1]] + h[[1, -2]])
    for end, (near, beyond, sign) in enumerate(((0, 1, 1.0), (-1, -2, -1.0))):
        if not np.isnan(tangents[end]).any():
            base[end] = q[near] + sign * h[near] / 3 * tangents[end]
        elif len(q) == 2:
            base[end] = q[near] + (q[beyond] - q[near]) / 3
        else:
            base[end] = (1 - natural[end]) * q[near]
    return natural, base


History = list[tuple[FloatArray, FloatArray]]
"""The control points of every iteration, and the footpoints on their curve."""

Pass = Callable[[FloatArray], tuple[FloatArray, FloatArray, float]]
"""From control points to footpoints, control points after the update, and the largest error before it."""


class Iteration(NamedTuple):
    """The end of an iteration: control points, their footpoints, the error of every pass, and the history if kept."""

    controls: FloatArray
    footpoints: FloatArray
    residuals: list[float]
    history: History


def iterate(
    one_pass: Pass, controls: FloatArray, limit: float, max_iterations: int, at_once: bool = False, keep: bool = False
) -> Iteration:
    """Make passes until the error is below ``limit``, is not finite, or ``max_iterations`` updates have been made.

    Args:
        at_once: as in Algorithm 3, where the pass that reaches the limit has already updated the control points.
        keep: keep the control points and the footpoints of every pass.
    """
    residuals: list[float] = []
    history: History = []
    while True:
        footpoints, updated, error = one_pass(controls)
        residuals.append(error)
        if keep:
            history.append((controls, footpoints))
        if error < limit:
            return Iteration(updated if at_once else controls, footpoints, residuals, history)
        if len(residuals) > max_iterations or not np.isfinite(error):
            return Iteration(controls, footpoints, residuals, history)
        controls = updated


def interpolate_reference(
    points: ArrayLike,
    variant: int = 2,
    *,
    knots: Parametrisation | ArrayLike = "chord",
    end_tangents: Tangents | None = None,
    disturb: Callable[[FloatArray], FloatArray] | None = None,
    **options: Any,
) -> Interpolation:
    """Algorithms 2 and 3; the arguments and the result are those of :func:`glyphspline.interpolate`.

    ``disturb`` may change the free control points before each pass, to see how far rounding errors carry.
    """
    rule: Any = knots if isinstance(knots, str) else None
    method = Method(variant, knots=rule, **options)
    return interpolate_by(method, points, None if rule else knots, end_tangents, disturb)


def interpolate_by(
    method: Method,
    points: ArrayLike,
    knots: ArrayLike | None = None,
    end_tangents: Tangents | None = None,
    disturb: Callable[[FloatArray], FloatArray] | None = None,
) -> Interpolation:
    """:func:`interpolate_reference` by a method; ``knots`` if that has no rule."""
    problem = prepare(points, method, knots, end_tangents)
    tolerance = method.tolerance_for(float(np.ptp(problem.points, axis=0).max()))
    at_once = method.variant == 4

    def one_pass(free: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        return (sweep if at_once else step)(problem, disturb(free) if disturb else free)

    first = problem.points[problem.vertices].copy()
    run = iterate(one_pass, first, tolerance, method.max_iterations, at_once, method.diagnostics)
    parameters, bounds = problem.centres.copy(), np.stack([problem.centres, problem.centres], axis=1)
    parameters[problem.vertices], bounds[problem.vertices] = run.footpoints, problem.intervals.bounds
    observed: dict[str, Any] = {}
    if method.diagnostics:
        observed = diagnose(problem.matrix, run.history, at_once)
        observed["history"] = tuple((problem.spread @ free + problem.fixed, t) for free, t in run.history)
    return Interpolation(
        spline=problem.spline(run.controls),
        parameters=parameters,
        intervals=bounds,
        iterations=len(run.residuals) - 1,
        residuals=np.array(run.residuals),
        converged=run.residuals[-1] < tolerance,
        fallbacks=problem.intervals.fallbacks,
        rate_bound=problem.intervals.rate_bound,
        merged=problem.merged,
        **observed,
    )


def interpolate_one_vertex(points: ArrayLike, k: int, method: Method, whole_curve: bool) -> Interpolation:
    """Algorithm 1; see :func:`glyphspline.interpolate_vertex`."""
    problem = prepare(points, method)
    if not 0 <= k < len(problem.points):
        raise PolygonError(f"there is no vertex {k} among {len(problem.points)}")
    point, centre, T = problem.points[k], problem.centres[k], problem.knots[-1]
    interval = centre + np.array([-0.5, 0.5]) * T if whole_curve else problem.intervals.bounds[k]
    least = float(problem.spline(problem.points).basis(interval)[:, k].min())  # B_k has a single peak

    def one_pass(controls: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        spline = problem.spline(controls)
        t = np.array([footpoint(spline, point, interval, centre)])
        updated = controls.copy()
        updated[k] += point - spline(t)[0]
        return t, updated, float(lengths(updated[k] - controls[k]))

    tolerance = method.tolerance_for(float(np.ptp(problem.points, axis=0).max()))
    run = iterate(one_pass, problem.points, tolerance, method.max_iterations)
    return Interpolation(
        problem.spline(run.controls), run.footpoints, interval[None], len(run.residuals) - 1, np.array(run.residuals),
        run.residuals[-1] < tolerance, 0, 1.0 if whole_curve else 1 - least, problem.merged,
    )  # fmt: skip


def step(problem: Problem, free: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """One pass of Algorithm 2: footpoints of all vertices on one curve, then all updates at once."""
    spline = problem.spline(free)
    p = problem.points[problem.vertices]
    t = np.array([footpoint(spline, *args) for args in _searches(problem)])
    e = p - spline(t)
    return t, free + e, float(lengths(e).max(initial=0.0))


def sweep(problem: Problem, free: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """One sweep of Algorithm 3: each control point is updated before the next footpoint is computed."""
    free = free.copy()
    t = np.empty(len(free))
    error = 0.0
    for j, (point, interval, centre) in enumerate(_searches(problem)):
        spline = problem.spline(free)
        t[j] = footpoint(spline, point, interval, centre)
        e = point - spline(t[j])
        free[j] += e
        error = max(error, float(lengths(e)))
    return t, free, error


def _searches(problem: Problem) -> list[tuple[FloatArray, FloatArray, float]]:
    v = problem.vertices
    return list(zip(problem.points[v], problem.intervals.bounds, problem.centres[v], strict=True))


def diagnose(matrix: Callable[[FloatArray], FloatArray], history: History, at_once: bool) -> dict[str, Any]:
    """Error iteration matrices of a run: the largest row-sum norm, and the spectral radius of their product so far.

    In Algorithm 2 the factor of a step is I - Bᵐ (the paper's equation 3). In Algorithm 3, with L the part of B
    below the diagonal, the corrections of a sweep are (I + L)⁻¹ times the errors before it, so that the factor
    from one sweep's corrections to the next one's is I - (I + L)⁻¹ B.

    Args:
        matrix: from (f,) footpoints to the (f, f) matrix B of the free control points.
        at_once: whether the run is one of Algorithm 3.
    """
    factors = []
    for _, t in history[:-1]:
        B = matrix(t)
        identity = np.eye(len(B))
        factors.append(identity - (np.linalg.solve(identity + np.tril(B, -1), B) if at_once else B))
    radii, product = [], np.eye(len(history[0][1]))
    for factor in factors:
        product = factor @ product
        radii.append(float(np.abs(np.linalg.eigvals(product)).max(initial=0.0)))
    norms = [float(np.abs(factor).sum(axis=1).max(initial=0.0)) for factor in factors]
    return {
        "history": tuple(history),
        "rate_observed": max(norms, default=0.0),
        "spectral_radii": np.array(radii),
    }
