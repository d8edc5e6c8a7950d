"""The driver of Algorithms 1, 2 and 3 in NumPy: any degree, variant and dimension, one polygon at a time.

It can keep the history of all passes. The pass over the vertices is compiled (:mod:`.kernels.any_degree_pass`). Many
cubic polygons at once, in variants 1 to 3, are for :mod:`.kernels.driver`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..curves.bspline import Spline, full_knots, span_controls
from ..curves.parameters import closed_knots, vertex_centres, vertex_parameters
from ..errors import PolygonError
from ..types import FloatArray, IntArray
from .compiled_batch import as_tangents, filled, run_batch
from .diagnostics import History, diagnose
from .intervals import Intervals, arc_ends, search_intervals
from .method import SETTLED, Method, Tangents
from .polygon import as_tangent, clean_polygon
from .result import NOTHING_MERGED, Interpolation

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
    end_tangents: Tangents | None = None,
    *,
    keep_history: bool = False,
) -> Interpolation:
    """Interpolate one polygon (n, d); ``knots`` are its parameters if the method has no rule.

    ``keep_history`` keeps the passes without the norms and spectral radii of ``method.diagnostics``.
    """
    problem = Problem.of(points, method, knots, end_tangents)
    keep, at_once = keep_history or method.diagnostics, method.variant == 4
    return problem.result(iterate(problem.one_pass, problem.P, problem.limit, method.max_iterations, at_once, keep))


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
    run = iterate(problem.one_pass, problem.P, problem.limit, method.max_iterations)
    controls, residuals = p.copy(), np.array(run.residuals) / problem.unit
    controls[k] = problem.points_of(run.controls[k])
    return Interpolation(
        Spline(controls, u), run.footpoints / problem.knot_unit, intervals.bounds, len(residuals) - 1, residuals,
        bool(residuals[-1] < problem.tolerance), 0, rate_bound, merged, problem.uncertified,
    )  # fmt: skip


def _intervals(
    p: FloatArray, u: FloatArray, centres: FloatArray, free: IntArray, method: Method, tangents: Tangents
) -> Intervals:
    """Search intervals: those of the compiled driver for cubics in the variants that it has, which is faster."""
    if method.degree == 3 and method.variant:
        same = replace(
            method, variant=2 if method.variant == 4 else method.variant, knots=None,
            max_iterations=0, diagnostics=False,
        )  # fmt: skip
        ends = None if method.closed else as_tangents([tangents], p.shape[1])
        shares = filled(1, method.peak_share)
        found = run_batch(p, np.array((0, len(p))), same, peak_shares=shares, knots=u, end_tangents=ends)
        return Intervals(found.bounds[free], int(found.whole[0, 3]), float(found.rates[0]))
    first = free - ((method.degree + 1) // 2 if method.closed else 2)
    order = method.degree + 2
    windows = full_knots(u, order, method.closed)[order + first[:, None] + np.arange(order)]
    arc = None if method.closed else arc_ends(u, natural_weights(np.diff(u), tangents))
    return search_intervals(windows, centres[free], method.variant, method.margin, method.fallback, arc)


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
        tangents: Tangents = (None, None),
        merged: IntArray = NOTHING_MERGED,
    ) -> None:
        """Lay out vertices (n, d) with knots, parameters and the indices of those with a free control point."""
        from .kernels.any_degree_pass import Layout, power_matrices

        self.centres, self.free, self.intervals, self.method, self.merged = centres, free, intervals, method, merged
        self.origin = p[0].copy()
        self.unit = 0.5 ** np.floor(np.log2(np.ptp(p, axis=0).max()))
        self.knot_unit = 0.5 ** np.floor(np.log2(u[-1] / len(p)))
        self.knots, self.degree, self.closed, self.at_once = u, method.degree, method.closed, method.variant == 4
        q = (p - self.origin) * self.unit
        natural, base = np.zeros(2), np.zeros((2, p.shape[1]))
        if self.closed:
            self.P = q.copy()
        else:
            scale = self.unit / self.knot_unit
            slopes = [None if t is None else as_tangent(t, q.shape[1]) * scale for t in tangents]
            natural, base = _ends(q, np.diff(u) * self.knot_unit, slopes)
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
    def of(cls, points: ArrayLike, method: Method, knots: ArrayLike | None, end_tangents: Tangents | None) -> Problem:
        """A polygon (n, d), checked and without duplicates; ``knots`` are its parameters if the method has no rule."""
        degree, closed = method.degree, method.closed
        p, merged = clean_polygon(points, closed)
        rule: Any = method.knots
        s = vertex_parameters(p, rule or np.delete(np.asarray(knots, dtype=np.float64), merged), closed)
        u = closed_knots(s, degree) if closed else s
        centres = vertex_centres(s, degree) if closed else s
        free = np.arange(len(p)) if closed else np.arange(1, len(p) - 1)
        tangents = end_tangents or (None, None)
        return cls(p, u, centres, free, _intervals(p, u, centres, free, method, tangents), method, tangents, merged)

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


def _ends(q: FloatArray, h: FloatArray, tangents: list[FloatArray | None]) -> tuple[FloatArray, FloatArray]:
    """Weights and rests of the control points beside the ends: base + weight times the free one next to them."""
    natural, base = natural_weights(h, tangents), np.zeros((2, q.shape[1]))
    for end, (near, beyond, sign) in enumerate(((0, 1, 1.0), (-1, -2, -1.0))):
        tangent = tangents[end]
        if tangent is not None:
            base[end] = q[near] + sign * h[near] / 3 * tangent
        elif len(q) == 2:
            base[end] = q[near] + (q[beyond] - q[near]) / 3
        else:
            base[end] = (1 - natural[end]) * q[near]
    return natural, base


def natural_weights(h: FloatArray, tangents: Sequence[Any]) -> FloatArray:
    """(2,) weights of the first (last) free control point of an arc in the one beside it; 0 at ends with a tangent.

    With them the curve has no curvature there.
    """
    weights = np.zeros(2)
    for end, (near, beyond) in enumerate(((0, 1), (-1, -2)) if len(h) > 1 else ()):
        if tangents[end] is None:
            weights[end] = h[near] / (2 * h[near] + h[beyond])
    return weights
