"""Search intervals of footpoints: the five variants (Table 1), Lemma 2 and Remark 3, and the ends of arcs.

A basis function is given by its *window*, the degree + 2 knots of its support, for closed and open splines of odd and
even degree alike.

Row i of I - B has the absolute sum 2 (1 - B_i) on a closed curve. On an arc the control points at the ends do not move
with those of the vertices, and what their basis functions take leaves less for the row: its sum is 2 (1 - W_i) with
W_i = B_i + F_i/2, F_i the part of the curve that is fixed. There Lemma 2 holds of W_i: see :func:`arc_intervals`.

All of this is for reading, and for :mod:`.reference`, which the intervals of :mod:`.kernels.lemma2` have to agree with.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from ..curves.bspline import Spline
from ..types import FloatArray
from .method import END_MARGIN, PEAK_SHARE, Fallback

BISECTIONS = 64
"""Number of bisections, enough to reach neighbouring floats."""


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
    """The interval of every footpoint of a closed curve.

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


def arc_intervals(
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
