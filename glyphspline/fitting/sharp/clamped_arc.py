"""Variant 2 on small clamped arcs, compiled, for each arc that the sharp fit tries.

Newton's method finds footpoints from the last ones, without the certificate of the interpolation. A fit keeps only the
vertices and end tangents; :func:`glyphspline.interpolate` computes the curve that is written from them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet, newton_step, spline_beziers
from ...types import FloatArray

PEAK_SHARE = 0.9
"""Required share of a basis function's peak in arcs of two spans, whose one free vertex peaks at 1/2 at most.

Lemma 2 has no interval there and needs none: each step multiplies the error of a single vertex by 1 - B_i < 1.
"""


class Arc(NamedTuple):
    """A clamped cubic spline of k spans.

    Attributes:
        p: (k + 1, 2) vertices. start, end: (2,) derivatives by chord length at the ends.
        u: (k + 1,) knots. P: (k + 3, 2) control points. b: (k, 4, 2) Bézier points.
        M: (k, 4, 4) Bézier weights: the Bézier points of span s are ``M[s] @ P[s : s + 4]``.
        t: (k + 1,) footpoints as signed shares of the neighbouring span.
    """

    p: FloatArray
    start: FloatArray
    end: FloatArray
    u: FloatArray
    P: FloatArray
    b: FloatArray
    M: FloatArray
    t: FloatArray


@compiled(internal=True)
def bezier_weights(u: FloatArray, M: FloatArray) -> None:
    """Compute the Bézier weights M of an :class:`Arc` with knots u."""
    k = len(M)
    for s in range(k):
        before = u[s] - u[s - 1] if s > 0 else 0.0
        h = u[s + 1] - u[s]
        after = u[s + 2] - u[s + 1] if s + 1 < k else 0.0
        w1, w2 = before / (before + h + after), (before + h) / (before + h + after)
        for r in range(4):
            for j in range(4):
                M[s, r, j] = 0.0
        M[s, 1, 1], M[s, 1, 2] = 1 - w1, w1
        M[s, 2, 1], M[s, 2, 2] = 1 - w2, w2
    for s in range(k + 1):
        # The Bézier point at knot s lies between the inner points on either side of it.
        if s == 0:
            M[0, 0, 0] = 1.0
        elif s == k:
            M[k - 1, 3, 3] = 1.0
        else:
            weight = (u[s] - u[s - 1]) / (u[s + 1] - u[s - 1])
            for j in range(3):
                left, right = M[s - 1, 2, j + 1], M[s, 1, j]
                M[s - 1, 3, j + 1] = (1 - weight) * left + weight * right
                M[s, 0, j] = (1 - weight) * left + weight * right


@compiled(internal=True)
def _bernstein(c0: float, c1: float, c2: float, c3: float, x: float) -> float:
    y = 1 - x
    return y * y * (y * c0 + 3 * x * c1) + x * x * (3 * y * c2 + x * c3)


@compiled(internal=True)
def _within(x: float, f: float, slope: float, low: float, high: float) -> float:
    """Newton's next estimate of a zero between ``low`` and ``high``, or their middle where that leads out of them."""
    new = x - f / slope if slope != 0 else (low + high) / 2
    return new if low < new < high else (low + high) / 2


@compiled(internal=True)
def _crossing(c0: float, c1: float, c2: float, c3: float, level: float, low: float, high: float) -> float:
    """Where a cubic that is monotone on [low, high] takes a value between those at the ends."""
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
        new = _within(x, f, slope, low, high)
        if abs(new - x) < 1e-12:
            return new
        x = new
    return x


@compiled(internal=True)
def _top(c0: float, c1: float, c2: float, c3: float) -> float:
    """Local parameter of the maximum of a cubic whose derivative changes sign once on [0, 1]."""
    low, high = 0.0, 1.0
    x = 0.5
    for _ in range(40):
        y = 1 - x
        slope = y * y * (c1 - c0) + 2 * x * y * (c2 - c1) + x * x * (c3 - c2)
        if slope > 0:
            low = x
        else:
            high = x
        bend = 2 * (y * ((c2 - c1) - (c1 - c0)) + x * ((c3 - c2) - (c2 - c1)))
        new = _within(x, slope, bend, low, high)
        if abs(new - x) < 1e-12:
            return new
        x = new
    return x


@compiled(internal=True)
def lemma2_interval(a: FloatArray, b: FloatArray, margin: float, share: float) -> tuple[float, float]:
    """Lemma 2 for one vertex: where B_i ≥ 1/2 + c, or all of its peak if that is lower.

    Args:
        a, b: (4,) Bernstein coefficients of B_i on the span before u_i and on the span after it.
        margin: c of the lemma.
        share: below 1, limit the level to this share of the peak (``fallback="peak"``); 1 is ``fallback="knot"``.

    Returns:
        The interval's ends, each as a signed share of its span (-1 is u_{i-1}, +1 is u_{i+1}).
    """
    right = b[1] > b[0]
    c = b if right else a
    x = _top(c[0], c[1], c[2], c[3])
    peak, top = x - (0.0 if right else 1.0), _bernstein(c[0], c[1], c[2], c[3], x)
    if share == 1.0 and top <= 0.5:
        return 0.0, 0.0
    level = min(0.5 + margin, share * top)
    low, high = -1.0, 1.0
    if a[0] < level:
        before = a[3] >= level or not right  # B_i rises to the level on the span before u_i
        c = a if before else b
        stop = 1.0 if a[3] >= level and right else (peak if right else peak + 1)
        low = _crossing(c[0], c[1], c[2], c[3], level, 0.0, stop) - (1.0 if before else 0.0)
    if b[3] < level:
        after = b[0] >= level or right
        c = b if after else a
        start = 0.0 if b[0] >= level and not right else (peak if right else peak + 1)
        high = _crossing(c[0], c[1], c[2], c[3], level, start, 1.0) - (0.0 if after else 1.0)
    return low, high


@compiled(internal=True)
def solve_arc(arc: Arc, margin: float, tolerance: float) -> float:
    """Variant 2 on a clamped arc (Algorithm 2): from vertices and end tangents, compute the rest of the arc.

    Args:
        margin: c of Lemma 2. tolerance: iterate until the largest error is below it.

    Returns:
        The largest error left.
    """
    p, start, end, u, P, b, M, t = arc
    k = len(b)
    u[0] = 0.0
    for i in range(k):
        u[i + 1] = u[i] + np.hypot(p[i + 1, 0] - p[i, 0], p[i + 1, 1] - p[i, 1])
    bezier_weights(u, M)
    for c in range(2):
        P[0, c], P[k + 2, c] = p[0, c], p[k, c]
        P[1, c] = p[0, c] + (u[1] - u[0]) / 3 * start[c]
        P[k + 1, c] = p[k, c] - (u[k] - u[k - 1]) / 3 * end[c]
    bounds = np.empty((k + 1, 2))
    for i in range(1, k):
        P[i + 1, 0], P[i + 1, 1] = p[i, 0], p[i, 1]
        low, high = lemma2_interval(M[i - 1, :, 2], M[i, :, 1], margin, PEAK_SHARE if k == 2 else 1.0)
        bounds[i, 0], bounds[i, 1] = low, high
        t[i] = min(max(0.0, low), high)
    error = 0.0
    e = np.empty((k + 1, 2))
    for _ in range(200):
        spline_beziers(P, u, False, b)
        error = 0.0
        for i in range(1, k):
            e[i, 0], e[i, 1], t[i] = _foot_error(b, u, i, p[i, 0], p[i, 1], t[i], bounds[i, 0], bounds[i, 1])
            error = max(error, e[i, 0] * e[i, 0] + e[i, 1] * e[i, 1])
        error = np.sqrt(error)
        if error < tolerance or not error < 1e9:
            break
        for i in range(1, k):
            P[i + 1, 0] += e[i, 0]
            P[i + 1, 1] += e[i, 1]
    return error


@compiled(internal=True)
def _foot_error(
    b: FloatArray, u: FloatArray, i: int, x: float, y: float, t: float, low: float, high: float
) -> tuple[float, float, float]:
    """Vertex less its footpoint, and the footpoint, as a signed share of the span before or after u_i."""
    before, after = u[i] - u[i - 1], u[i + 1] - u[i]
    cx = cy = 0.0
    for step in range(3):
        s = i if t >= 0 else i - 1
        h = after if t >= 0 else before
        cx, cy, dx, dy, ax, ay = jet(b, s, t if t >= 0 else t + 1)
        speed = dx * dx + dy * dy
        if step == 2 or speed <= 0:
            break
        slope = (cx - x) * dx + (cy - y) * dy
        bend = speed + (cx - x) * ax + (cy - y) * ay
        ahead = newton_step(t * h, slope * h, speed, bend, -before, after)
        t = min(max(ahead / after if ahead >= 0 else ahead / before, low), high)
    return x - cx, y - cy, t
