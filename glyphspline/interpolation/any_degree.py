"""Algorithms 1, 2 and 3 for any degree, variant and dimension, one polygon at a time, with the history of all passes.

The passes are compiled (:mod:`.kernels.any_degree_pass`); the loop is in :mod:`.driver`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..curves.bspline import Spline, full_knots, span_controls
from ..curves.parameters import closed_knots, lengths, vertex_centres, vertex_parameters
from ..errors import PolygonError
from ..types import FloatArray, IntArray
from .diagnostics import diagnose
from .driver import Anderson, iterate
from .intervals import Intervals
from .method import SETTLED, Method, Tangents
from .polygon import as_tangent, clean_polygon
from .result import Interpolation

NO_INTERVALS = np.empty(0)


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
    keep_history |= method.diagnostics
    degree, closed = method.degree, method.closed
    p, merged = clean_polygon(points, closed)
    rule: Any = method.knots
    s = vertex_parameters(p, rule or np.delete(np.asarray(knots, dtype=np.float64), merged), closed)
    u = closed_knots(s, degree) if closed else s
    centres = vertex_centres(s, degree) if closed else s
    free = np.arange(len(p)) if closed else np.arange(1, len(p) - 1)
    first = free - ((degree + 1) // 2 if closed else 2)
    windows = full_knots(u, degree + 2, closed)[degree + 2 + first[:, None] + np.arange(degree + 2)]
    tangents = end_tangents or (None, None)
    intervals = _intervals(windows, centres[free], method, NO_INTERVALS if closed else np.diff(u), tangents)
    problem = Scaled(p, u, centres, free, intervals, method, tangents)
    tolerance = method.tolerance_for(float(np.ptp(p, axis=0).max()))
    settled = SETTLED * float(np.diff(centres).mean()) if method.finish == "solve" else 0.0
    at_once = method.variant == 4
    limit = max(tolerance, settled) * problem.unit
    rows = slice(problem.layout.first, problem.layout.first + len(free))
    anderson = Anderson(rows) if method.finish == "accelerate" else None
    run = iterate(problem.one_pass, problem.P, limit, method.max_iterations, at_once, keep_history, anderson)
    controls, t, residuals = run.controls, run.footpoints, np.array(run.residuals) / problem.unit
    if method.finish == "solve" and len(free):
        controls, left = problem.solve(controls, t)
        residuals = np.append(residuals, left)
    parameters, bounds = centres.copy(), np.stack([centres, centres], axis=1)
    parameters[free] = t / problem.knot_unit
    bounds[free] = intervals.bounds
    observed: dict[str, Any] = {}
    if method.diagnostics:
        observed = diagnose(problem.matrix, run.history, at_once)
    if keep_history:
        observed["history"] = tuple((problem.points_of(P), t / problem.knot_unit) for P, t in run.history)
    spline, converged = Spline(problem.points_of(controls), u, degree, closed), bool(residuals[-1] < tolerance)
    return Interpolation(
        spline, parameters, bounds, len(residuals) - 1, residuals, converged, intervals.fallbacks,
        intervals.rate_bound, merged, problem.uncertified, **observed,
    )  # fmt: skip


def interpolate_any_vertex(points: ArrayLike, k: int, method: Method, whole_curve: bool) -> Interpolation:
    """Algorithm 1; see :func:`glyphspline.interpolate_vertex`."""
    p, merged = clean_polygon(points)
    if not 0 <= k < len(p):
        raise PolygonError(f"there is no vertex {k} among {len(p)}")
    u = vertex_parameters(p)
    windows = full_knots(u, 5, True)[5 + k - 2 + np.arange(5)][None]
    intervals = _intervals(windows, u[k : k + 1], method)
    rate_bound = intervals.rate_bound / 2
    if whole_curve:
        intervals, rate_bound = Intervals(u[k] + np.array([[-0.5, 0.5]]) * u[-1], 0, 1.0), 1.0
    problem = Scaled(p, u, u[:-1], np.array([k]), intervals, method, (None, None))
    tolerance = method.tolerance_for(float(np.ptp(p, axis=0).max()))
    run = iterate(problem.one_pass, problem.P, tolerance * problem.unit, method.max_iterations)
    controls, residuals = p.copy(), np.array(run.residuals) / problem.unit
    controls[k] = problem.points_of(run.controls[k])
    return Interpolation(
        Spline(controls, u), run.footpoints / problem.knot_unit, intervals.bounds, len(residuals) - 1, residuals,
        bool(residuals[-1] < tolerance), 0, rate_bound, merged, problem.uncertified,
    )  # fmt: skip


def _intervals(
    windows: FloatArray,
    centres: FloatArray,
    method: Method,
    h: FloatArray = NO_INTERVALS,
    tangents: Tangents = (None, None),
) -> Intervals:
    """The compiled equivalent of :func:`.intervals.search_intervals`; h are an arc's knot intervals."""
    from .kernels.any_degree_pass import search_bounds

    bounds = np.empty((len(centres), 2))
    padded, natural = np.pad(h, 2) if len(h) else h, _natural_weights(h, tangents)
    fallbacks, least = search_bounds(
        windows, centres, method.variant, float(method.margin), method.peak_share, padded, natural, bounds
    )
    return Intervals(bounds, fallbacks, 2 * (1 - least))


class Scaled:
    """A polygon in the units of the compiled passes: origin at p_0, extent and mean knot interval near 1.

    Attributes:
        P: the first control points. unit, knot_unit: factors of lengths and of parameters, powers of two.
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
        tangents: Tangents,
    ) -> None:
        from .kernels.any_degree_pass import Layout, power_matrices

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

    def solve(self, controls: FloatArray, t: FloatArray) -> tuple[FloatArray, float]:
        """Control points for which the curve passes through every vertex at its footpoint, and the error left."""
        v = self.layout
        P = controls.copy()
        B = Spline(P, self.knots * self.knot_unit, self.degree, self.closed).basis(t)
        A, free = self.matrix(t), slice(v.first, v.first + len(t))
        solvable = np.linalg.matrix_rank(A) == len(t)  # variants 0 and 1 may bring two footpoints together
        for _ in range(2 if solvable else 0):
            P[free] += np.linalg.solve(A, v.points - B @ P)
            if not self.closed:
                P[[1, -2]] = v.base + v.natural[:, None] * P[[2, -3]]
        e = v.points - B @ P
        return P, float(lengths(e).max() / self.unit)


def _ends(q: FloatArray, h: FloatArray, tangents: list[FloatArray | None]) -> tuple[FloatArray, FloatArray]:
    """Weights and rests of the control points beside the ends: base + weight times the free one next to them."""
    natural, base = _natural_weights(h, tangents), np.zeros((2, q.shape[1]))
    for end, (near, beyond, sign) in enumerate(((0, 1, 1.0), (-1, -2, -1.0))):
        tangent = tangents[end]
        if tangent is not None:
            base[end] = q[near] + sign * h[near] / 3 * tangent
        elif len(q) == 2:
            base[end] = q[near] + (q[beyond] - q[near]) / 3
        else:
            base[end] = (1 - natural[end]) * q[near]
    return natural, base


def _natural_weights(h: FloatArray, tangents: Sequence[Any]) -> FloatArray:
    """(2,) weights of the first (last) free control point of an arc in the one beside it; 0 at ends with a tangent.

    With them the curve has no curvature there.
    """
    weights = np.zeros(2)
    for end, (near, beyond) in enumerate(((0, 1), (-1, -2)) if len(h) > 1 else ()):
        if tangents[end] is None:
            weights[end] = h[near] / (2 * h[near] + h[beyond])
    return weights
