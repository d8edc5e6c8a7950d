"""Any degree and variant, one polygon at a time, every step open to inspection: the shell of ``core.general``."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ..curves.bspline import Spline, full_knots
from ..curves.parameters import Parametrisation, closed_knots, vertex_centres, vertex_parameters
from ..errors import PolygonError
from ..types import FloatArray
from .intervals import PEAK_SHARE, Fallback, Intervals
from .polygon import clean_polygon
from .reference import SETTLED, TIE_DISTANCE, Tangents, diagnose, prepare
from .result import Interpolation

PASSES = 1000
"""Passes in one compiled call, after which Ctrl-C is heard; with diagnostics each is a call of its own."""

History = list[tuple[FloatArray, FloatArray]]


def interpolate_stepwise(
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
    """Algorithms 2 and 3; the arguments and the result are those of :func:`glyphspline.interpolate`."""
    p, merged = clean_polygon(points, closed)
    if len(merged) and not isinstance(knots, str):
        knots = np.delete(np.asarray(knots, dtype=np.float64), merged)
    s = vertex_parameters(p, knots, closed)
    u = closed_knots(s, degree) if closed else s
    centres = vertex_centres(s, degree) if closed else s
    free = np.arange(len(p)) if closed else np.arange(1, len(p) - 1)
    first = free - ((degree + 1) // 2 if closed else 2)
    windows = full_knots(u, degree + 2, closed)[degree + 2 + first[:, None] + np.arange(degree + 2)]
    intervals = _intervals(windows, centres[free], variant, margin, fallback)
    run = _Run(p, u, centres, free, intervals, degree, closed, end_tangents or (None, None))
    settled = SETTLED * float(np.diff(centres).mean()) if finish == "solve" else 0.0
    residuals, history = run.iterate(variant, max(residual_tolerance, settled), max_iterations, diagnostics)
    if finish == "solve" and len(free):
        residuals = np.append(residuals, run.solve())
    parameters, bounds = centres.copy(), np.stack([centres, centres], axis=1)
    parameters[free] = run.parameters
    bounds[free] = intervals.bounds
    observed: dict[str, Any] = {}
    if history is not None:
        problem = prepare(
            points, variant, degree=degree, margin=margin, knots=knots if not len(merged) else "chord",
            fallback=fallback, closed=closed, end_tangents=end_tangents,
        )  # fmt: skip
        observed = diagnose(problem, history, variant)
    return Interpolation(
        spline=Spline(run.controls, u, degree, closed),
        parameters=parameters,
        intervals=bounds,
        iterations=len(residuals) - 1,
        residuals=residuals,
        converged=bool(residuals[-1] < residual_tolerance),
        fallbacks=intervals.fallbacks,
        rate_bound=intervals.rate_bound,
        merged=merged,
        **observed,
    )


def _intervals(windows: FloatArray, centres: FloatArray, variant: int, margin: float, fallback: Fallback) -> Intervals:
    """What ``search_intervals`` gives, compiled."""
    from .kernels.windows import search_bounds

    bounds = np.empty((len(centres), 2))
    share = PEAK_SHARE if fallback == "peak" else 0.0
    fallbacks, least = search_bounds(windows, centres, variant, float(margin), share, bounds)
    return Intervals(bounds, fallbacks, 2 * (1 - least))


class _Run:
    """The iteration of one polygon, in the core's units: origin at p_0, extent and mean knot interval near 1."""

    def __init__(
        self,
        p: FloatArray,
        u: FloatArray,
        centres: FloatArray,
        free: Any,
        intervals: Intervals,
        degree: int,
        closed: bool,
        tangents: Tangents,
    ) -> None:
        from .kernels.any_degree_pass import make_layout

        self.origin = p[0].copy()
        self.unit = 0.5 ** np.floor(np.log2(np.ptp(p, axis=0).max()))
        self.knot_unit = 0.5 ** np.floor(np.log2(u[-1] / len(p)))
        self.knots, self.degree, self.closed = u, degree, closed
        q = (p - self.origin) * self.unit
        natural, base = np.zeros(2), np.zeros((2, 2))
        if closed:
            self.P = q.copy()
        else:
            slopes = [None if t is None else np.asarray(t) * (self.unit / self.knot_unit) for t in tangents]
            natural, base = _ends(q, np.diff(u) * self.knot_unit, slopes)
            beside = base + natural[:, None] * q[[1, -2]]
            self.P = np.concatenate([q[:1], beside[:1], q[1:-1], beside[1:], q[-1:]])
        alone = len(free) == 1 and closed  # Algorithm 1
        vertices, first = (q[free], int(free[0])) if alone else (q if closed else q[1:-1], 0 if closed else 2)
        scaled = self.knot_unit * intervals.bounds, self.knot_unit * centres[free]
        self.layout = make_layout(vertices, first, *scaled, self.knot_unit * u, degree, closed, natural, base)
        self.t = self.layout.centres.copy()

    @property
    def controls(self) -> FloatArray:
        return self.P / self.unit + self.origin

    @property
    def parameters(self) -> FloatArray:
        return self.t / self.knot_unit

    def _arguments(self, variant: int) -> tuple[Any, ...]:
        v = self.layout
        return (
            v.points, v.bounds, v.centres, v.spans, v.starts, v.period, v.matrices, v.indices, v.first, v.natural,
            v.base, variant == 4, TIE_DISTANCE**2,
        )  # fmt: skip

    def iterate(
        self, variant: int, tolerance: float, max_iterations: int, record: bool
    ) -> tuple[FloatArray, History | None]:
        """Residuals, and the history if it is wanted: control points before, footpoints in each pass."""
        from .kernels.any_degree_pass import move, passes

        v = self.layout
        errors = np.zeros(v.points.shape)
        found: list[FloatArray] = []
        history: History | None = [] if record else None
        left = max_iterations + 1
        while True:
            before = self.P.copy()
            room = np.empty(1 if record else min(left, PASSES))
            arguments = (*self._arguments(variant), tolerance * self.unit, room)
            made = passes(self.P, self.t, errors, *arguments)
            found.append(room[:made])
            left -= made
            if history is not None:
                history.append((before / self.unit + self.origin, self.parameters))
            if room[made - 1] < tolerance * self.unit or left == 0 or not np.isfinite(room[made - 1]):
                return np.concatenate(found) / self.unit, history
            move(self.P, errors, v.first, v.period, v.natural, v.base)

    def solve(self) -> float:
        """Control points for which the curve passes through every vertex at its footpoint; what error is left."""
        v = self.layout
        u = self.knots * self.knot_unit
        count = len(self.t)
        B = Spline(self.P, u, self.degree, self.closed).basis(self.t)
        free = slice(v.first, v.first + count)
        A = B[:, free].copy()
        if not self.closed:
            A[:, 0] += v.natural[0] * B[:, 1]
            A[:, -1] += v.natural[1] * B[:, -2]
        if np.linalg.matrix_rank(A) < count:  # variants 0 and 1 may bring two footpoints together
            return float(np.hypot(*(v.points - B @ self.P).T).max() / self.unit)
        for _ in range(2):
            self.P[free] += np.linalg.solve(A, v.points - B @ self.P)
            if not self.closed:
                self.P[[1, -2]] = v.base + v.natural[:, None] * self.P[[2, -3]]
        e = v.points - B @ self.P
        return float(np.hypot(*e.T).max() / self.unit)


def interpolate_vertex_compiled(
    points: ArrayLike, k: int, *, whole_curve: bool, residual_tolerance: float, max_iterations: int
) -> Interpolation:
    """Algorithm 1; the arguments and the result are those of :func:`glyphspline.interpolate_vertex`."""
    p, merged = clean_polygon(points)
    if not 0 <= k < len(p):
        raise PolygonError(f"there is no vertex {k} among {len(p)}")
    u = vertex_parameters(p)
    windows = full_knots(u, 5, True)[5 + k - 2 + np.arange(5)][None]
    interval = _intervals(windows, u[k : k + 1], 1, 0.0, "knot")
    rate_bound = interval.rate_bound / 2
    if whole_curve:
        interval, rate_bound = Intervals(u[k] + np.array([[-0.5, 0.5]]) * u[-1], 0, 1.0), 1.0
    run = _Run(p, u, u[:-1], np.array([k]), interval, 3, True, (None, None))
    residuals, _ = run.iterate(1, residual_tolerance, max_iterations, False)
    controls = p.copy()
    controls[k] = run.controls[k]
    return Interpolation(
        spline=Spline(controls, u),
        parameters=run.parameters,
        intervals=interval.bounds,
        iterations=len(residuals) - 1,
        residuals=residuals,
        converged=bool(residuals[-1] < residual_tolerance),
        fallbacks=0,
        rate_bound=rate_bound,
        merged=merged,
    )


def _ends(q: FloatArray, h: FloatArray, tangents: list[FloatArray | None]) -> tuple[FloatArray, FloatArray]:
    """Weights and rests of the control points beside the ends: base + weight times the free one next to them."""
    natural, base = np.zeros(2), np.zeros((2, 2))
    for end, (near, beyond, sign) in enumerate(((0, 1, 1.0), (-1, -2, -1.0))):
        tangent = tangents[end]
        if tangent is not None:
            base[end] = q[near] + sign * h[near] / 3 * tangent
        elif len(q) == 2:
            base[end] = q[near] + (q[beyond] - q[near]) / 3
        else:
            natural[end] = h[near] / (2 * h[near] + h[beyond])
            base[end] = (1 - natural[end]) * q[near]
    return natural, base
