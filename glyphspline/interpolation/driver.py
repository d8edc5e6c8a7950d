"""The driver of Algorithms 1, 2 and 3 in NumPy: any degree, variant and dimension, one polygon at a time.

It can keep the history of all passes, and has what else is done one by one: the matrices of a run, and the end of
``finish="solve"``. The pass over the vertices is compiled (:mod:`.kernels.any_degree_pass`). Many cubic polygons at
once, in variants 1 to 3, are for :mod:`.kernels.driver`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..curves.bspline import Spline, full_knots, span_controls
from ..errors import PolygonError
from ..types import FloatArray, IntArray
from .batch import run_batch
from .intervals import Intervals, search_intervals
from .method import SETTLED, Method
from .polygon import clean_polygon, closed_knots, lengths, vertex_centres, vertex_parameters
from .result import NOTHING_MERGED, Interpolation

History = list[tuple[FloatArray, FloatArray]]
"""The control points of every iteration, and the footpoints on their curve."""

Pass = Callable[[FloatArray], tuple[FloatArray, FloatArray, float]]
"""From control points to footpoints, control points after the update, and the largest error before it."""


class Run(NamedTuple):
    """The end of an iteration: control points, their footpoints, the error of every pass, and the history if kept."""

    controls: FloatArray
    footpoints: FloatArray
    residuals: list[float]
    history: History


def iterate(
    one_pass: Pass, controls: FloatArray, limit: float, max_iterations: int, at_once: bool = False, keep: bool = False
) -> Run:
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
            return Run(updated if at_once else controls, footpoints, residuals, history)
        if len(residuals) > max_iterations or not np.isfinite(error):
            return Run(controls, footpoints, residuals, history)
        controls = updated


def interpolate_any_degree(
    points: ArrayLike,
    method: Method,
    knots: ArrayLike | None = None,
    end_tangents: FloatArray | None = None,
    *,
    keep_history: bool = False,
) -> Interpolation:
    """Interpolate one polygon (n, d).

    Args:
        knots: its parameters if the method has no rule.
        end_tangents: (2, d) of an arc, NaN for a natural end; None: both are natural.
        keep_history: keep the passes without the norms and spectral radii of ``method.diagnostics``.
    """
    problem = Problem.of(points, method, knots, end_tangents)
    return problem.result(problem.iterate(keep_history or method.diagnostics))


def interpolate_any_vertex(points: ArrayLike, k: int, method: Method, whole_curve: bool) -> Interpolation:
    """Algorithm 1; see :func:`glyphspline.interpolate_vertex`."""
    p, merged = clean_polygon(points)
    if not 0 <= k < len(p):
        raise PolygonError(f"there is no vertex {k} among {len(p)}")
    u = vertex_parameters(p)
    windows = full_knots(u, 5, True)[5 + k - 2 + np.arange(5)][None]
    intervals = search_intervals(windows, u[k : k + 1], method.variant)
    rate_bound = intervals.rate_bound / 2
    if whole_curve:
        intervals, rate_bound = Intervals(u[k] + np.array([[-0.5, 0.5]]) * u[-1], 0, 1.0), 1.0
    problem = Problem(p, u, u[:-1], np.array([k]), intervals, method)
    run = problem.iterate()
    controls, residuals = p.copy(), np.array(run.residuals) / problem.unit
    controls[k] = problem.points_of(run.controls[k])
    return Interpolation(
        Spline(controls, u), run.footpoints / problem.knot_unit, intervals.bounds, len(residuals) - 1, residuals,
        bool(residuals[-1] < problem.tolerance), 0, rate_bound, merged, problem.uncertified,
    )  # fmt: skip


def _intervals(
    p: FloatArray, u: FloatArray, centres: FloatArray, free: IntArray, method: Method, tangents: FloatArray
) -> Intervals:
    """Search intervals: those of the compiled driver for cubics in the variants that it has, which is faster."""
    if method.degree == 3 and method.variant:
        variant = 2 if method.variant == 4 else method.variant
        same = replace(method, variant=variant, knots=None, max_iterations=0, diagnostics=False)
        shares = np.full(1, method.peak_share)
        found = run_batch(p, np.array((0, len(p))), same, shares, np.full(1, np.nan), u, tangents[None]).arrays
        return Intervals(found.bounds[free], int(found.whole[0, 3]), float(found.rates[0]))
    first = free - ((method.degree + 1) // 2 if method.closed else 2)
    order = method.degree + 2
    windows = full_knots(u, order, method.closed)[order + first[:, None] + np.arange(order)]
    return search_intervals(windows, centres[free], method.variant, method.margin, method.fallback)


class Problem:
    """A polygon in the units of the compiled passes: origin at p_0, extent and mean knot interval near 1.

    Attributes:
        P: the first control points. unit, knot_unit: factors of lengths and of parameters, powers of two.
        tolerance, limit: the residual tolerance, and the error to stop below in the units of the passes.
        uncertified: number of footpoints, over all passes so far, that are not certified.
    """

    def __init__(
        self,
        p: FloatArray,
        u: FloatArray,
        centres: FloatArray,
        free: IntArray,
        intervals: Intervals,
        method: Method,
        tangents: FloatArray | None = None,
        merged: IntArray = NOTHING_MERGED,
    ) -> None:
        """Lay out vertices (n, d) with knots, parameters and the indices of those with a free control point."""
        from .kernels.any_degree_pass import Layout, power_matrices

        self.centres, self.free, self.intervals, self.method, self.merged = centres, free, intervals, method, merged
        self.origin = p[0].copy()
        self.unit = 0.5 ** np.floor(np.log2(np.ptp(p, axis=0).max()))
        self.knot_unit = 0.5 ** np.floor(np.log2(u[-1] / len(p)))
        self.knots, self.degree, self.closed, self.at_once = u, method.degree, method.closed, method.variant == 4
        self.P = q = (p - self.origin) * self.unit
        natural, base = np.zeros(2), np.zeros((2, p.shape[1]))
        if tangents is not None and not self.closed:
            natural, base = controls_beside_ends(
                q, np.diff(u) * self.knot_unit, tangents * (self.unit / self.knot_unit)
            )
            beside = base + natural[:, None] * q[[1, -2]]
            self.P = np.concatenate([q[:1], beside[:1], q[1:-1], beside[1:], q[-1:]])
        spans, bounds, u = len(u) - 1, self.knot_unit * intervals.bounds, self.knot_unit * u
        T = float(u[-1])
        lap = np.floor(bounds / T) if self.closed else np.zeros_like(bounds)
        within = np.clip(np.searchsorted(u, bounds - lap * T, side="right") - 1, 0, spans - 1)
        self.layout = Layout(
            points=q[free],
            bounds=bounds,
            centres=self.knot_unit * centres[free],
            spans=(lap * spans).astype(np.int64) + within,
            starts=u[:-1],
            period=T if self.closed else 0.0,
            matrices=power_matrices(u, self.degree, self.closed),
            indices=span_controls(spans, self.degree, self.closed).astype(np.int64),
            first=int(free[0]) if self.closed else 2,
            natural=natural,
            base=base,
        )
        self.t = self.layout.centres.copy()
        self.uncertified = 0
        self.tolerance = method.tolerance_for(float(np.ptp(p, axis=0).max()))
        settled = SETTLED * float(np.diff(centres).mean()) if method.finish == "solve" else 0.0
        self.limit = max(self.tolerance, settled) * self.unit

    @classmethod
    def of(
        cls, points: ArrayLike, method: Method, knots: ArrayLike | None = None, end_tangents: FloatArray | None = None
    ) -> Problem:
        """A polygon (n, d), checked and without duplicates; arguments as for :func:`interpolate_any_degree`."""
        degree, closed = method.degree, method.closed
        p, merged = clean_polygon(points, closed)
        rule: Any = method.knots
        s = vertex_parameters(p, rule or np.delete(np.asarray(knots, dtype=np.float64), merged), closed)
        u, centres, free = s, s, np.arange(1, len(p) - 1)
        if closed:
            u, centres, free = closed_knots(s, degree), vertex_centres(s, degree), np.arange(len(p))
        tangents = np.full((2, p.shape[1]), np.nan) if end_tangents is None else end_tangents
        return cls(p, u, centres, free, _intervals(p, u, centres, free, method, tangents), method, tangents, merged)

    def iterate(self, keep: bool = False) -> Run:
        """Passes from the polygon on; see :func:`iterate`."""
        return iterate(self.one_pass, self.P, self.limit, self.method.max_iterations, self.at_once, keep)

    def result(self, run: Run) -> Interpolation:
        """The result of a run in the caller's units, with the history if the run has kept it."""
        residuals = np.array(run.residuals) / self.unit
        parameters, bounds = self.centres.copy(), np.stack([self.centres, self.centres], axis=1)
        parameters[self.free], bounds[self.free] = run.footpoints / self.knot_unit, self.intervals.bounds
        observed: dict[str, Any] = {}
        if self.method.diagnostics:
            observed = diagnose(self.matrix, run.history, self.at_once)
        if run.history:
            observed["history"] = tuple((self.points_of(P), t / self.knot_unit) for P, t in run.history)
        return Interpolation(
            Spline(self.points_of(run.controls), self.knots, self.degree, self.closed), parameters, bounds,
            len(residuals) - 1, residuals, bool(residuals[-1] < self.tolerance), self.intervals.fallbacks,
            self.intervals.rate_bound, self.merged, self.uncertified, **observed,
        )  # fmt: skip

    def points_of(self, controls: FloatArray) -> FloatArray:
        """Control points in the caller's units."""
        return controls / self.unit + self.origin

    def one_pass(self, controls: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        """Footpoints on the curve of the control points, these after the update, and the largest error before it."""
        from .kernels.any_degree_pass import one_pass

        updated = controls.copy()
        largest, uncertified = one_pass(updated, self.t, self.layout, self.at_once)
        self.uncertified += uncertified
        return self.t.copy(), updated, largest

    def matrix(self, t: FloatArray) -> FloatArray:
        """(f, f) how the curve at the footpoints (f,) depends on the free control points."""
        v = self.layout
        B = Spline(self.P, self.knots * self.knot_unit, self.degree, self.closed).basis(t)
        A = B[:, v.first : v.first + len(t)].copy()
        if not self.closed:
            A[:, 0] += v.natural[0] * B[:, 1]
            A[:, -1] += v.natural[1] * B[:, -2]
        return A


def controls_beside_ends(q: FloatArray, h: FloatArray, tangents: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Weights and rests of the control points beside the ends: base + weight times the free one next to them.

    With a tangent τ that of the first end is fixed at q_0 + h_0/3 τ. A natural end (C'' = 0) keeps it on the line from
    q_0 to the first free point, at h_0/(2 h_0 + h_1) of the way, as clamped knots have it.
    """
    natural, base = natural_weights(h, tangents), np.zeros((2, q.shape[1]))
    for end, (near, beyond, sign) in enumerate(((0, 1, 1.0), (-1, -2, -1.0))):
        if not np.isnan(tangents[end]).any():
            base[end] = q[near] + sign * h[near] / 3 * tangents[end]
        elif len(q) == 2:
            base[end] = q[near] + (q[beyond] - q[near]) / 3
        else:
            base[end] = (1 - natural[end]) * q[near]
    return natural, base


def natural_weights(h: FloatArray, tangents: FloatArray) -> FloatArray:
    """(2,) weights of the first (last) free control point of an arc in the one beside it; 0 at ends with a tangent.

    With them the curve has no curvature there.
    """
    if len(h) < 2:
        return np.zeros(2)
    return np.isnan(tangents).any(axis=1) * h[[0, -1]] / (2 * h[[0, -1]] + h[[1, -2]])


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


def solved(
    found: Interpolation, points: FloatArray, end_tangents: FloatArray | None, tolerance: float
) -> Interpolation:
    """A result with the control points whose curve passes through every vertex at its present parameter.

    The control points stay as they are where that is impossible: variants 0, 1 and 4 may bring two footpoints together.

    Args:
        points: (n, d) the polygon as it was given. end_tangents: as :func:`interpolate_any_degree` has them.
    """
    spline, t = found.spline, found.parameters
    if not np.isfinite(found.max_error) or not (spline.closed or len(t) > 2):
        return found
    p = np.delete(points, found.merged, axis=0)
    natural = np.zeros(2)
    if not spline.closed:
        tangents = np.full((2, 2), np.nan) if end_tangents is None else end_tangents
        natural = natural_weights(np.diff(spline.knots), tangents)
    best, error = spline, found.max_error
    for _ in range(2):  # the second time for the rounding errors of the first
        better = _corrected(best, t, p - best(t), natural)
        left = float(lengths(p - better(t)).max())
        if left < error:
            best, error = better, left
    residuals = np.append(found.residuals, error)
    return replace(
        found, spline=best, residuals=residuals, iterations=found.iterations + 1, converged=error < tolerance
    )


def _corrected(spline: Spline, t: FloatArray, e: FloatArray, natural: FloatArray) -> Spline:
    """The spline moved by e (n, d) at its vertices' parameters (n,); NaN or infinite if the system is singular."""
    from scipy.sparse import csc_array, identity
    from scipy.sparse.linalg import splu

    columns, weights = spline.basis_rows(t)
    n, P, inner = len(t), spline.control_points, slice(None)
    rows, spread = np.repeat(np.arange(n), columns.shape[1]), identity(n, format="csc")
    matrix = csc_array((weights.ravel(), (rows, columns.ravel())), shape=(n, len(P)))
    if not spline.closed:  # control points beside natural ends follow their neighbours, others at the ends are fixed
        shares, points, inner = np.ones(n), np.arange(1, n + 1), slice(1, -1)
        shares[[0, -1]] = natural
        spread = csc_array((shares, (points, (points - 2).clip(0, n - 3))), shape=(n + 2, n - 2))
    try:
        moves = splu((matrix @ spread)[inner]).solve(e[inner])
    except RuntimeError:  # exactly singular
        moves = np.full((spread.shape[1], e.shape[1]), np.nan)
    return Spline(P + spread @ moves, spline.knots, spline.degree, spline.closed)
