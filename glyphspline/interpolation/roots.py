"""Footpoints as the paper finds them: by all zeros of a polynomial, with ``numpy.roots``."""

from __future__ import annotations

from functools import cache, reduce

import numpy as np

from ..curves.bezier import derivative_points
from ..curves.bspline import Spline
from ..types import FloatArray
from .method import TIE, TIE_DISTANCE

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
