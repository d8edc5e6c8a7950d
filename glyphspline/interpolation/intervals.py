"""Search intervals of footpoints: the five variants (Table 1), Lemma 2 and Remark 3, and the ends of arcs.

A basis function is given by its *window*, the degree + 2 knots of its support, for closed and open splines of odd and
even degree alike.

Row i of I - B has the absolute sum 2 (1 - B_i) on a closed curve. On an arc the control points at the ends do not move
with those of the vertices, and what their basis functions take leaves less for the row: its sum is 2 (1 - W_i) with
W_i = B_i + F_i/2, F_i the part of the curve that is fixed. There Lemma 2 holds of W_i: see :mod:`.kernels.lemma2`, and
:mod:`.reference`. Here every vertex counts as one of a closed curve.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..types import FloatArray
from .method import PEAK_SHARE, Fallback

BISECTIONS = 64
"""Number of bisections, enough to reach neighbouring floats."""

END_MARGIN = 1 / 16
"""Least margin of the first and the last vertex of an arc.

With c = 0 their intervals would begin at the end of the arc, where nothing moves. The largest W_i is above 5/8 for all
knots, and 9/16 is also ``PEAK_SHARE`` of that.
"""


@dataclass(frozen=True, eq=False)
class Intervals:
    """The search interval of each footpoint.

    Attributes:
        bounds: (n, 2) the intervals.
        fallbacks: number of vertices where Lemma 2 gives no interval, as B_i (beside the ends of an arc W_i) nowhere
            exceeds 1/2.
        rate_bound: max 2 (1 - min B_i over i's interval), Theorem 2's factor a step.
    """

    bounds: FloatArray
    fallbacks: int
    rate_bound: float


def basis_function(windows: FloatArray, t: FloatArray) -> FloatArray:
    """B_i(t_i) on its own knots, by Cox and de Boor: (n, degree + 2) windows and (n,) parameters give (n,).

    A window may begin or end with repeated knots (clamped ends). Each span is closed at its left end, the
    last one of positive length at both.
    """
    t = t[:, None]
    left, right = windows[:, :-1], windows[:, 1:]
    last = (right == windows[:, -1:]) & (right > left) & (t == right)
    N = (((left <= t) & (t < right)) | last).astype(np.float64)
    spans = windows.shape[1] - 1
    for width in range(1, spans):
        u, v = windows[:, :-width], windows[:, width:]
        length = v - u
        rise = np.where(length > 0, (t - u) / np.where(length > 0, length, 1), 0)
        N = rise[:, :-1] * N[:, :-1] + np.where(length > 0, 1 - rise, 0)[:, 1:] * N[:, 1:]
    return N[:, 0]


def _derivative_sign(windows: FloatArray, t: FloatArray) -> FloatArray:
    """Sign of B_i'(t): the difference of the two basis functions of one degree less."""
    degree = windows.shape[1] - 2
    halves = [windows[:, :-1], windows[:, 1:]]
    lengths = [half[:, degree] - half[:, 0] for half in halves]
    rise, fall = (
        np.where(length > 0, basis_function(half, t) / np.where(length > 0, length, 1), 0)
        for half, length in zip(halves, lengths, strict=True)
    )
    return np.sign(rise - fall)


def peaks(windows: FloatArray) -> FloatArray:
    """(n,) the parameter t_max at which each B_i is largest. B_i rises before it and falls after it."""
    low, high = windows[:, 0].copy(), windows[:, -1].copy()
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        rising = _derivative_sign(windows, middle) > 0
        low, high = np.where(rising, middle, low), np.where(rising, high, middle)
    return (low + high) / 2


def level_interval(windows: FloatArray, peak: FloatArray, level: FloatArray) -> FloatArray:
    """(n, 2) the interval around the peak on which B_i ≥ level; the peak alone if it is not higher."""
    ends = []
    higher = basis_function(windows, peak) > level
    for outside in (windows[:, 0], windows[:, -1]):
        inside, outside = peak.copy(), outside.copy()
        for _ in range(BISECTIONS):
            middle = (inside + outside) / 2
            enough = basis_function(windows, middle) >= level
            inside, outside = np.where(enough, middle, inside), np.where(enough, outside, middle)
        ends.append(np.where(higher, inside, peak))
    return np.stack(ends, axis=1)


def search_intervals(
    windows: FloatArray,
    centres: FloatArray,
    variant: int,
    margin: float = 0.0,
    fallback: Fallback = "knot",
) -> Intervals:
    """The interval of every footpoint.

    Args:
        windows: (n, degree + 2) the knots of each basis function.
        centres: (n,) the parameter of each vertex, u_i for cubics.
        variant: 0 the whole support; 1 the support less a span at each end; 2, 4 Lemma 2; 3 the centre alone.
        margin: c of Lemma 2, the interval being {B_i ≥ 1/2 + min(c, max B_i - 1/2)}, clipped to that of variant 1.
        fallback: where B_i nowhere exceeds 1/2, "knot" takes the centre (Remark 3). "peak" instead takes, for every
            vertex, {B_i ≥ min(1/2 + c, 0.9 max B_i)}, which is never empty.
    """
    support = windows[:, [0, -1]]
    inner = windows[:, [1, -2]]
    peak, highest = np.empty(0), np.empty(0)
    if variant in (2, 4):
        peak = peaks(windows)
        highest = basis_function(windows, peak)
    low = highest <= 0.5
    if variant == 0:
        bounds = support
    elif variant == 1:
        bounds = inner
    elif variant == 3:
        bounds = np.stack([centres, centres], axis=1)
    else:
        level = np.minimum(0.5 + margin, PEAK_SHARE * highest if fallback == "peak" else highest)
        bounds = np.clip(level_interval(windows, peak, level), inner[:, :1], inner[:, 1:])
        if fallback == "knot":
            bounds = np.where(low[:, None], centres[:, None], bounds)
    least = np.minimum(basis_function(windows, bounds[:, 0]), basis_function(windows, bounds[:, 1]))
    return Intervals(bounds, int(low.sum()), float(2 * (1 - least.min(initial=1.0))))
