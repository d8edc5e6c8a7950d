"""The method in its plainest form: NumPy, ``numpy.roots`` for the footpoints as in the paper, one vertex at a time.

The compiled code has to agree with it. It is for reading the algorithms, and slow: some 0.3 ms a footpoint. Nothing in
the algorithms or their proofs needs the plane: vertices may have d ≥ 2 coordinates here, and are then (n, d) instead of
(n, 2).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, partial, reduce
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..curves.bezier import derivative_points
from ..curves.bspline import Spline, full_knots
from ..types import FloatArray, IntArray
from .driver import controls_beside_ends, diagnose, iterate
from .intervals import BISECTIONS, END_MARGIN, Intervals, search_intervals
from .method import PEAK_SHARE, SETTLED, TIE, TIE_DISTANCE, Fallback, Method, Parametrisation, Tangents
from .polygon import as_tangents, clean_polygon, closed_knots, lengths, vertex_centres, vertex_parameters
from .result import Interpolation

NEARLY_REAL = 0.05
"""A zero whose imaginary part (in spans) is below this is polished, as is one that is so little outside the span.

Rounding moves a zero of multiplicity m by some 1e-16 to the power 1/m: a fivefold one, the most there is, by 1e-3.
"""


def footpoint(spline: Spline, point: FloatArray, interval: FloatArray, centre: float) -> float:
    """Parameter of the point of the curve nearest to ``point`` on an interval: the global minimum.

    The candidates are the ends of the interval, the knots inside, and the zeros of the derivative of the
    squared distance on every piece. A tie goes to the candidate nearest ``centre``.
    """
    low, high = interval
    candidates = np.minimum(np.maximum([low, high, *_stationary(spline, point, low, high)], low), high)
    distance = ((spline(candidates) - point) ** 2).sum(axis=1)
    zero = (TIE_DISTANCE * np.ptp(spline.control_points, axis=0).max()) ** 2
    tied = candidates[distance <= distance.min() * (1 + TIE) + zero]
    return float(tied[np.argmin(np.abs(tied - centre))])


def _stationary(spline: Spline, point: FloatArray, low: float, high: float) -> list[float]:
    """Knots in [low, high], and the zeros of (C - p)·C' on the pieces that meet it.

    Zeros that are almost real count as real: they may be a double zero that rounding has split.
    """
    u, T = spline.knots, spline.period
    spans = len(u) - 1
    first, last = _span_of(spline, low), _span_of(spline, high)
    found: list[float] = []
    for k in range(first, last + 1):
        lap, piece = divmod(k, spans)
        start, h = u[piece] + lap * T, u[piece + 1] - u[piece]
        axes = (_power_basis(spline.degree) @ (spline._bezier[piece] - point)).T
        powers = np.arange(spline.degree, 0, -1)
        slope = reduce(np.add, [np.convolve(x, powers * x[:-1]) for x in axes])
        zeros = np.roots(slope)
        likely = (np.abs(zeros.imag) < NEARLY_REAL) & (np.abs(zeros.real - 0.5) < 0.5 + NEARLY_REAL)
        polished = [_newton(axes.tolist(), t) for t in zeros.real[likely].tolist()]
        found += [start, *(start + h * t for t in polished if 0 <= t <= 1)]
    return found


def _span_of(spline: Spline, t: float) -> int:
    """Index of the span that holds t, counted on through the periods of a closed curve."""
    u, T = spline.knots, spline.period
    lap = int(np.floor((t - u[0]) / T)) if spline.closed else 0
    within = int(np.searchsorted(u, t - lap * T, side="right")) - 1
    return lap * (len(u) - 1) + min(max(within, 0), len(u) - 2)


@cache
def _power_basis(degree: int) -> FloatArray:
    """From Bézier points to coefficients by descending powers of the local parameter, a matrix."""
    points = np.eye(degree + 1)
    rows = [points[0]]
    factor = 1.0
    for order in range(1, degree + 1):
        points = derivative_points(points)
        factor *= order
        rows.append(points[0] / factor)
    return np.array(rows[::-1])


def _newton(axes: list[list[float]], t: float) -> float:
    """Polish a zero of x x' + y y' + … that ``numpy.roots`` leaves a few digits short, until nothing improves.

    It evaluates the coordinates, as the product's coefficients lose half of the digits where the curve is near its
    vertex and slow. A start near a zero that is not polished would tie with it.
    """
    value, slope = _product(axes, t)
    for _ in range(12):
        if slope == 0:
            break
        better = t - value / slope
        left, slope = _product(axes, better)
        if not abs(left) < abs(value):
            break
        t, value = better, left
    return t


def _product(axes: list[list[float]], t: float) -> tuple[float, float]:
    """x x' + y y' + … at t and its derivative, for polynomials (coefficients by descending powers)."""
    value = slope = 0.0
    for polynomial in axes:
        a = b = c = 0.0
        for coefficient in polynomial:
            a, b, c = a * t + coefficient, b * t + a, c * t + b  # the value, its derivative, half of the second
        value, slope = value + a * b, slope + b * b + 2 * a * c
    return value, slope


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
    intervals = (search_intervals if closed else partial(_arc_intervals, u, spread))(
        windows, centres[vertices], method.variant, method.margin, method.fallback
    )
    return Problem(p, vertices, u, degree, closed, centres, intervals, spread, fixed, merged)


def _arc_intervals(
    u: FloatArray, spread: FloatArray, windows: FloatArray, centres: FloatArray, variant: int, margin: float,
    fallback: Fallback,
) -> Intervals:  # fmt: skip
    """:func:`search_intervals` for an arc, by W_i for the two vertices next to either end, as far as fixed functions
    reach.

    W_i takes the place of B_i where its level is not below 1/2, and c is ``END_MARGIN`` at least for the first and the
    last vertex, where W_i always rises above 5/8.
    """
    count, parts = len(windows), [Intervals(np.empty((0, 2)), 0, 0.0)]
    basis = Spline.trusted(np.zeros((len(spread), 2)), u, 3, False).basis
    alone = sorted({0, 1, 2, count - 2, count - 1, count} & set(range(count + 1)))
    for i, stop in pairwise(alone):
        part = search_intervals(windows[i:stop], centres[i:stop], variant, margin, fallback)
        if min(i, count - 1 - i) < 2:

            def dominance(t: FloatArray, i: int = i) -> FloatArray:
                rows = basis(t) @ spread
                found: FloatArray = rows[:, i] + (1 - rows.sum(axis=1)) / 2
                return found

            level = 0.5 + (max(margin, END_MARGIN) if i in (0, count - 1) else margin)
            share = PEAK_SHARE if fallback == "peak" else 1.0
            found = _level_interval(dominance, windows[i, 1:4], level, share) if variant in (2, 4) else None
            if variant == 3:
                part = replace(part, rate_bound=float(2 * (1 - dominance(centres[i:stop])[0])))
            elif found is not None:
                part = Intervals(found[None], 0, float(2 * (1 - dominance(found).min())))
        parts.append(part)
    bounds, fallbacks, rates = zip(*((part.bounds, part.fallbacks, part.rate_bound) for part in parts), strict=True)
    return Intervals(np.concatenate(bounds), sum(fallbacks), max(rates))


def _level_interval(f: Callable[[FloatArray], FloatArray], knots: FloatArray, level: float, share: float) -> Any:
    """(2,) where W_i ≥ level, or ``share`` of its maximum if that is lower; None if that is below 1/2.

    Args:
        f: W_i, at least 1/2 on a single interval between these. knots: (3,) u_{i-1}, u_i, u_{i+1}.
    """
    before, knot, after = knots
    candidates = np.concatenate([_critical(f, before, knot), _critical(f, knot, after)])
    values = f(candidates)
    peak, highest = candidates[values.argmax()], values.max()
    level = min(level, share * highest)
    if highest <= 0.5 or level < 0.5:
        return None
    if highest <= level:
        return np.array([peak, peak])
    ends = []
    for inside, outside in ((peak, before), (peak, after)):
        for _ in range(BISECTIONS):
            middle = (inside + outside) / 2
            inside, outside = (middle, outside) if f(middle[None])[0] >= level else (inside, middle)
        ends.append(inside)
    return np.array(ends)


def _critical(f: Callable[[FloatArray], FloatArray], start: float, stop: float) -> FloatArray:
    """The ends of a span and the zeros inside of the derivative of f, a cubic there."""
    x = np.arange(4) / 3
    zeros = np.roots(np.polyder(np.polyfit(x, f(start + x * (stop - start)), 3)))
    inside = zeros.real[(np.abs(zeros.imag) < 1e-9) & (zeros.real > 0) & (zeros.real < 1)]
    return start + np.concatenate([[0.0], inside, [1.0]]) * (stop - start)


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

    ``points`` may be (n, d), d ≥ 2. The spline of the result then has control points (n, d), and no curvature.

    ``disturb`` may change the free control points before each pass, to see how far rounding errors carry.
    """
    rule: Any = knots if isinstance(knots, str) else None
    method = Method(variant, knots=rule, **options)
    problem = prepare(points, method, None if rule else knots, end_tangents)
    tolerance = method.tolerance_for(float(np.ptp(problem.points, axis=0).max()))
    chords = np.diff(problem.centres) if len(problem.centres) > 1 else np.ones(1)
    settled = SETTLED * float(chords.mean()) if method.finish == "solve" else 0.0
    at_once = variant == 4

    def one_pass(free: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        return (_sweep if at_once else _step)(problem, disturb(free) if disturb else free)

    first = problem.points[problem.vertices].copy()
    run = iterate(one_pass, first, max(tolerance, settled), method.max_iterations, at_once, method.diagnostics)
    free, t, residuals = run.controls, run.footpoints, run.residuals
    if method.finish == "solve" and len(free):
        spline, p = problem.spline(np.zeros_like(free)), problem.points[problem.vertices]
        free = np.asarray(np.linalg.solve(problem.matrix(t), p - spline(t)), dtype=np.float64)
        residuals.append(float(lengths(p - problem.spline(free)(t)).max()))
    parameters, bounds = problem.centres.copy(), np.stack([problem.centres, problem.centres], axis=1)
    parameters[problem.vertices], bounds[problem.vertices] = t, problem.intervals.bounds
    observed: dict[str, Any] = {}
    if method.diagnostics:
        observed = diagnose(problem.matrix, run.history, at_once)
        observed["history"] = tuple((problem.spread @ free + problem.fixed, t) for free, t in run.history)
    return Interpolation(
        spline=problem.spline(free),
        parameters=parameters,
        intervals=bounds,
        iterations=len(residuals) - 1,
        residuals=np.array(residuals),
        converged=bool(residuals[-1] < tolerance),
        fallbacks=problem.intervals.fallbacks,
        rate_bound=problem.intervals.rate_bound,
        merged=problem.merged,
        **observed,
    )


def _step(problem: Problem, free: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """One pass of Algorithm 2: footpoints of all vertices on one curve, then all updates at once."""
    spline = problem.spline(free)
    p = problem.points[problem.vertices]
    t = np.array([footpoint(spline, *args) for args in _searches(problem)])
    e = p - spline(t)
    return t, free + e, float(lengths(e).max(initial=0.0))


def _sweep(problem: Problem, free: FloatArray) -> tuple[FloatArray, FloatArray, float]:
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
