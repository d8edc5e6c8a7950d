"""Lemma 2's interval of a single vertex, and what the fixed control points at the ends of an arc add to its row.

:mod:`.lemma2` has the intervals of whole blocks. This is for the few vertices next to the ends of arcs, whose row of
I - B has the absolute sum 2 (1 - W_i) with W_i = B_i + F_i/2 (:mod:`..intervals`), and for fits.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...types import FloatArray
from ..intervals import END_MARGIN


@compiled
def near_end(i: int, n: int) -> bool:
    """Whether a fixed function of an arc of n vertices reaches the interval of vertex i, an inner one."""
    return i <= 2 or i >= n - 3


@compiled
def add_fixed(
    h: FloatArray, at: int, i: int, n: int, first: float, last: float, before: FloatArray, after: FloatArray
) -> None:
    """Make W_i of B_i, for inner vertex i of an arc of n vertices.

    Args:
        h: knot intervals; h[at] is the one before u_i.
        first, last: weights of the first and the last free control point in those beside them; 0 for end tangents.
        before, after: (4,) Bernstein coefficients on the spans before and after u_i.
    """
    if i == 1:
        a, b, c = end_shares(h[at], h[at + 1], 1.0 + first)
        before[0] += 0.5
        before[1] += a
        before[2] += b
        before[3] += c
        after[0] += c
    if i == 2:
        before[0] += end_shares(h[at - 1], h[at], 1.0 - first)[2]
    if i == n - 2:
        a, b, c = end_shares(h[at + 1], h[at], 1.0 + last)
        after[3] += 0.5
        after[2] += a
        after[1] += b
        after[0] += c
        before[3] += c
    if i == n - 3:
        after[3] += end_shares(h[at + 2], h[at + 1], 1.0 - last)[2]


@compiled
def end_shares(nearest: float, beyond: float, weight: float) -> tuple[float, float, float]:
    """Bernstein coefficients 1 to 3, on the span at an end of an arc, of half the function beside that of the end.

    Args:
        nearest, beyond: the knot intervals at the end. weight: of the function in F_i.
    """
    half, share = 0.5 * weight, beyond / (nearest + beyond)
    return half, half * share, half * share * share


@compiled
def margin_at(i: int, n: int, margin: float) -> float:
    """The margin of vertex i of an arc: ``END_MARGIN`` at least for the first and the last of the inner ones."""
    return max(margin, END_MARGIN) if i in (1, n - 2) else margin


@compiled
def one_interval(a: FloatArray, b: FloatArray, margin: float, share: float) -> tuple[float, float, float, bool]:
    """Lemma 2 for one vertex: where its function is at least 1/2 + c, or as high as it gets if that is lower.

    Args:
        a, b: (4,) Bernstein coefficients of the function on the span before u_i and on the span after it.
        margin: c of the lemma.
        share: of the peak, a bound on the level (``fallback="peak"``); 1 is ``fallback="knot"``.

    Returns:
        The interval's ends, each as a signed share of its span (-1 is u_{i-1}, +1 is u_{i+1}), the least value on it,
        and whether that is an interval of the lemma: 0, 0, the value at u_i and False where the function does not rise
        above 1/2, or the level is below.
    """
    right = b[1] > b[0]
    c = b if right else a
    peak = _hump(b[0], b[1], b[2], b[3]) if right else -_hump(a[3], a[2], a[1], a[0])
    top = _bernstein(c[0], c[1], c[2], c[3], peak if right else peak + 1)
    level = min(0.5 + margin, share * top)
    if top <= 0.5 or level < 0.5:
        return 0.0, 0.0, b[0], False
    if top <= level:
        return peak, peak, top, True
    low, high = -1.0, 1.0
    if a[0] < level:
        before = a[3] >= level or not right  # the function rises to the level on the span before u_i
        c = a if before else b
        stop = 1.0 if a[3] >= level and right else (peak if right else peak + 1)
        low = _crossing(c[0], c[1], c[2], c[3], level, 0.0, stop) - (1.0 if before else 0.0)
    if b[3] < level:
        after = b[0] >= level or right
        c = b if after else a
        start = 0.0 if b[0] >= level and not right else (peak if right else peak + 1)
        high = _crossing(c[0], c[1], c[2], c[3], level, start, 1.0) - (0.0 if after else 1.0)
    return low, high, min(max(a[0], level), max(b[3], level)), True


@compiled
def _hump(c0: float, c1: float, c2: float, c3: float) -> float:
    """Where a cubic on [0, 1] that rises at 0 has its first maximum; 0 if it does not rise, 1 if it does not fall.

    Fixed functions may raise its end again, where W_i is below 1/2.
    """
    d0, d1, d2 = c1 - c0, c2 - c1, c3 - c2
    square = d1 * d1 - d0 * d2
    if d0 <= 0.0:
        return 0.0
    if square < 0.0 or (d1 >= 0.0 and d2 > 0.0):
        return 1.0
    return d0 / (d0 - d1 + np.sqrt(square))


@compiled
def _bernstein(c0: float, c1: float, c2: float, c3: float, x: float) -> float:
    y = 1 - x
    return y * y * (y * c0 + 3 * x * c1) + x * x * (3 * y * c2 + x * c3)


@compiled
def _crossing(c0: float, c1: float, c2: float, c3: float, level: float, low: float, high: float) -> float:
    """Where a cubic takes a value between those at ``low`` and ``high``, which it does only once between them."""
    rising = _bernstein(c0, c1, c2, c3, high) > _bernstein(c0, c1, c2, c3, low)
    x = (low + high) / 2
    for _ in range(60):
        f = _bernstein(c0, c1, c2, c3, x) - level
        if (f > 0) == rising:
            high = x
        else:
            low = x
        y = 1 - x
        slope = 3 * (y * y * (c1 - c0) + 2 * x * y * (c2 - c1) + x * x * (c3 - c2))
        new = x - f / slope if slope != 0 else (low + high) / 2
        if not low < new < high:
            new = (low + high) / 2
        if abs(new - x) < 1e-12:
            return new
        x = new
    return x
