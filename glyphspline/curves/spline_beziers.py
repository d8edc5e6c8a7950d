"""Bézier form of many cubic splines, compiled."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..types import BoolArray, FloatArray, IntArray


@compiled
def spline_beziers(controls: FloatArray, knots: FloatArray, spans: IntArray, closed: BoolArray) -> FloatArray:
    """(n, K, 4, 2) Bézier points of cubic splines end to end, a piece a span; pieces meet in one point exactly.

    Args:
        controls: (N, K, 2) in K masters: of a closed spline as many as spans, where row i belongs to knot i; of one
            clamped at both ends three more.
        knots: one more than spans of each, none of them multiple. spans: (S,) of each. closed: (S,).
    """
    K, at, first, total = controls.shape[1], 0, 0, 0
    for n in spans:
        total += n
    cubics = np.empty((total, K, 4, 2))
    for q in range(len(spans)):
        n, ring = spans[q], closed[q]
        u, b = knots[at + q : at + q + n + 1], cubics[at : at + n]
        before = u[n] - u[n - 1] if ring else 0.0
        for k in range(n):
            h = u[k + 1] - u[k]
            i, j = (k, k + 1 if k + 1 < n else 0) if ring else (k + 1, k + 2)
            after = u[j + 1] - u[j] if ring else (u[j] - u[k + 1] if k + 1 < n else 0.0)
            whole = before + h + after
            low, high = before / whole, (before + h) / whole
            for v in range(K):
                for axis in range(2):
                    start, end = controls[first + i, v, axis], controls[first + j, v, axis]
                    b[k, v, 1, axis] = (1.0 - low) * start + low * end
                    b[k, v, 2, axis] = (1.0 - high) * start + high * end
            before = h
        before = u[n] - u[n - 1]
        for k in range(n):
            h = u[k + 1] - u[k]
            share = before / (before + h)
            for v in range(K):
                for axis in range(2):
                    joint = (1.0 - share) * b[k - 1, v, 2, axis] + share * b[k, v, 1, axis]
                    b[k, v, 0, axis] = b[k - 1, v, 3, axis] = joint
            before = h
        for v in range(0 if ring else K):
            for axis in range(2):
                b[0, v, 0, axis], b[n - 1, v, 3, axis] = controls[first, v, axis], controls[first + n + 2, v, axis]
        at, first = at + n, first + n + (0 if ring else 3)
    return cubics
