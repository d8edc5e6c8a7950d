"""Intervals of the footpoints for B-splines of every degree, a basis function at a time, from the knots it lives on.

The rules, and the halvings, of ``intervals.py``, which explains them; there they are written for NumPy.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ..intervals import BISECTIONS
from .footpoint import MAX_DEGREE

KNOTS = MAX_DEGREE + 2
"""The most knots a basis function lives on."""


@compiled
def basis_value(w, first, spans, t, N):
    """B(t) on its knots w[first] … w[first + spans], by Cox and de Boor; each span is closed at its left end.

    The last span of positive length is closed at both. N is room for KNOTS numbers.
    """
    end = w[first + spans]
    for k in range(spans):
        u, v = w[first + k], w[first + k + 1]
        N[k] = 1.0 if (u <= t < v) or (v > u and v == end and t == end) else 0.0
    for width in range(1, spans):
        for k in range(spans - width):
            rising = w[first + k + width] - w[first + k]
            falling = w[first + k + width + 1] - w[first + k + 1]
            value = 0.0
            if rising > 0.0:
                value = (t - w[first + k]) / rising * N[k]
            if falling > 0.0:
                value += (1.0 - (t - w[first + k + 1]) / falling) * N[k + 1]
            N[k] = value
    return N[0]


@compiled
def _rises(w, spans, t, N):
    """Whether B' is positive at t: the difference of the two basis functions of one degree less."""
    slope = 0.0
    if w[spans - 1] > w[0]:
        slope = basis_value(w, 0, spans - 1, t, N) / (w[spans - 1] - w[0])
    if w[spans] > w[1]:
        slope -= basis_value(w, 1, spans - 1, t, N) / (w[spans] - w[1])
    return slope > 0.0


@compiled
def _peak(w, spans, N):
    """Where B is largest."""
    low, high = w[0], w[spans]
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        if middle in (low, high):
            break
        if _rises(w, spans, middle, N):
            low = middle
        else:
            high = middle
    return (low + high) / 2


@compiled
def _crossing(w, spans, inside, outside, level, N):
    """The last parameter on the way from the peak to an end of the support at which B ≥ level."""
    for _ in range(BISECTIONS):
        middle = (inside + outside) / 2
        if middle in (inside, outside):
            break
        if basis_value(w, 0, spans, middle, N) >= level:
            inside = middle
        else:
            outside = middle
    return inside


@compiled
def search_bounds(windows, centres, variant, margin, peak_share, bounds):
    """Where each footpoint is sought, into ``bounds``; the fallbacks, and the least value of a B_i on its interval.

    Args:
        windows: (n, degree + 2) the knots of each basis function.
        centres: (n,) the parameter of each vertex.
        peak_share: of ``fallback="peak"``, else 0.
    """
    N = np.empty(KNOTS)
    spans = windows.shape[1] - 1
    fallbacks, least = 0, 1.0
    for i in range(windows.shape[0]):
        w = windows[i]
        if variant == 0:
            low, high = w[0], w[spans]
        elif variant == 1:
            low, high = w[1], w[spans - 1]
        elif variant == 3:
            low = high = centres[i]
        else:
            peak = _peak(w, spans, N)
            highest = basis_value(w, 0, spans, peak, N)
            fallbacks += highest <= 0.5
            level = min(0.5 + margin, peak_share * highest if peak_share > 0.0 else highest)
            low = high = peak
            if peak_share == 0.0 and highest <= 0.5:
                low = high = centres[i]
            elif highest > level:
                low, high = _crossing(w, spans, peak, w[0], level, N), _crossing(w, spans, peak, w[spans], level, N)
            if peak_share > 0.0 or highest > 0.5:
                low = min(max(low, w[1]), w[spans - 1])
                high = min(max(high, w[1]), w[spans - 1])
        bounds[i, 0], bounds[i, 1] = low, high
        least = min(least, basis_value(w, 0, spans, low, N), basis_value(w, 0, spans, high, N))
    return fallbacks, least
