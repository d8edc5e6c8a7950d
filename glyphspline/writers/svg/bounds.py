"""The tight box around Bézier segments, compiled."""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...types import FloatArray, IntArray


@compiled
def grow(box: FloatArray, points: FloatArray, degrees: IntArray) -> None:
    """Widen a box (left, bottom, right, top) by one closed contour: ``points`` (N, 2), ``degrees`` (m,)."""
    at = 0
    for degree in degrees:
        for axis in range(2):
            box[axis] = min(box[axis], points[at, axis])
            box[axis + 2] = max(box[axis + 2], points[at, axis])
        at += degree
    n, at = at, 0
    for degree in degrees:
        end = at + degree if at + degree < n else 0
        for axis in range(2 if degree > 1 else 0):
            p0, p1, p3 = points[at, axis], points[at + 1, axis], points[end, axis]
            p2 = points[at + degree - 1, axis]
            if min(p1, p2) < box[axis] or max(p1, p2) > box[axis + 2]:
                if degree == 2:
                    p1, p2 = p0 + (p1 - p0) * (2 / 3), p3 + (p1 - p3) * (2 / 3)
                for value in _extrema(p0, p1, p2, p3):
                    box[axis], box[axis + 2] = min(box[axis], value), max(box[axis + 2], value)
        at += degree


@compiled
def _extrema(p0: float, p1: float, p2: float, p3: float) -> tuple[float, float]:
    """Both values of a cubic where its derivative is zero, or at an end where there is no such place."""
    a, half_b, c = p3 - 3.0 * p2 + 3.0 * p1 - p0, p2 - 2.0 * p1 + p0, p1 - p0
    root = np.sqrt(max(half_b * half_b - a * c, 0.0))
    # The stable pair q/a and c/q: neither loses digits when a is small, as on a line or a quadratic raised.
    q = -(half_b - root if half_b < 0.0 else half_b + root)
    return _at(p0, p1, p2, p3, q, a), _at(p0, p1, p2, p3, c, q)


@compiled
def _at(p0: float, p1: float, p2: float, p3: float, numerator: float, denominator: float) -> float:
    """The cubic at a quotient, if that is between 0 and 1, or else at the nearer end."""
    x = numerator / denominator if abs(denominator) > abs(numerator) else 0.0
    x = min(max(x, 0.0), 1.0)
    y = 1.0 - x
    return y * y * y * p0 + 3.0 * y * y * x * p1 + 3.0 * y * x * x * p2 + x * x * x * p3
