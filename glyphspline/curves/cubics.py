"""Small clamped arcs in compiled code: the variant 2 spline of few vertices, and its Bézier form.

This is the inner loop of the frugal fit, which tries thousands of arcs a glyph. Footpoints are found by Newton's
method from the last ones, without the certificate of :mod:`.footpoint`: what is kept of a fit are only its vertices
and end tangents, through which :func:`glyphspline.interpolate` then puts the curve that is written.
"""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..types import FloatArray, IntArray

PEAK_SHARE = 0.9
"""As in :mod:`..interpolation.intervals`, for arcs of two spans, whose one free vertex has a peak of 1/2 at most.

Lemma 2 has no interval there, but does not need one: alone, a vertex has its error multiplied by 1 - B_i < 1.
"""


@compiled
def length(x: float, y: float) -> float:
    """Length of a vector whose square neither over- nor underflows: in a third of the time of ``hypot``."""
    return np.sqrt(x * x + y * y)


@compiled
def bezier_weights(u: FloatArray, k: int, M: FloatArray) -> None:
    """M[s]: the Bézier points of span s are ``M[s] @ P[s : s + 4]`` for a clamped cubic with breaks u[: k + 1]."""
    for s in range(k):
        before = u[s] - u[s - 1] if s > 0 else 0.0
        h = u[s + 1] - u[s]
        after = u[s + 2] - u[s + 1] if s + 1 < k else 0.0
        w1, w2 = before / (before + h + after), (before + h) / (before + h + after)
        M[s] = 0.0
        M[s, 1, 1], M[s, 1, 2] = 1 - w1, w1
        M[s, 2, 1], M[s, 2, 2] = 1 - w2, w2
    for s in range(k + 1):
        # The point at break s lies between the last inner point of the span before and the first of the span after.
        if s == 0:
            M[0, 0, 0] = 1.0
        elif s == k:
            M[k - 1, 3, 3] = 1.0
        else:
            weight = (u[s] - u[s - 1]) / (u[s + 1] - u[s - 1])
            for j in range(3):
                left, right = M[s - 1, 2, j + 1], M[s, 1, j]
                M[s - 1, 3, j + 1] = (1 - weight) * left + weight * (M[s, 1, j])
                M[s, 0, j] = (1 - weight) * left + weight * right


@compiled
def bezier_points(M: FloatArray, P: FloatArray, k: int, b: FloatArray) -> None:
    """b[s]: the (4, 2) Bézier points of each of the k spans."""
    for s in range(k):
        for r in range(4):
            x = y = 0.0
            for j in range(4):
                x += M[s, r, j] * P[s + j, 0]
                y += M[s, r, j] * P[s + j, 1]
            b[s, r, 0], b[s, r, 1] = x, y


@compiled
def raised(points: FloatArray, degrees: IntArray) -> FloatArray:
    """(m, 4, 2) the segments of a contour as cubics; see :class:`..outlines.outline.Contour`."""
    m, n = len(degrees), len(points)
    cubics = np.empty((m, 4, 2))
    at = 0
    for s in range(m):
        d = degrees[s]
        for c in range(2):
            a, b = points[at, c], points[(at + d) % n, c]
            cubics[s, 0, c], cubics[s, 3, c] = a, b
            if d == 3:
                cubics[s, 1, c], cubics[s, 2, c] = points[at + 1, c], points[at + 2, c]
            elif d == 2:
                q = points[at + 1, c]
                cubics[s, 1, c], cubics[s, 2, c] = a + (q - a) * (2 / 3), b + (q - b) * (2 / 3)
            else:
                cubics[s, 1, c], cubics[s, 2, c] = a + (b - a) / 3, b + (a - b) / 3
        at += d
    return cubics


@compiled
def jet(b: FloatArray, s: int, x: float) -> tuple[float, float, float, float, float, float]:
    """Position, first and second derivative by the local parameter of piece s."""
    y = 1 - x
    ax, ay = b[s, 1, 0] - b[s, 0, 0], b[s, 1, 1] - b[s, 0, 1]
    bx, by = b[s, 2, 0] - b[s, 1, 0], b[s, 2, 1] - b[s, 1, 1]
    cx, cy = b[s, 3, 0] - b[s, 2, 0], b[s, 3, 1] - b[s, 2, 1]
    lx, ly = y * ax + x * bx, y * ay + x * by
    rx, ry = y * bx + x * cx, y * by + x * cy
    dx, dy = 3 * (y * lx + x * rx), 3 * (y * ly + x * ry)
    y3, x3 = y * y * y, x * x * x
    px = y3 * b[s, 0, 0] + 3 * y * y * x * b[s, 1, 0] + 3 * y * x * x * b[s, 2, 0] + x3 * b[s, 3, 0]
    py = y3 * b[s, 0, 1] + 3 * y * y * x * b[s, 1, 1] + 3 * y * x * x * b[s, 2, 1] + x3 * b[s, 3, 1]
    return px, py, dx, dy, 6 * (rx - lx), 6 * (ry - ly)


@compiled
def _bernstein(c0: float, c1: float, c2: float, c3: float, x: float) -> float:
    y = 1 - x
    return y * y * (y * c0 + 3 * x * c1) + x * x * (3 * y * c2 + x * c3)


@compiled
def _within(x: float, f: float, slope: float, low: float, high: float) -> float:
    """Newton's next estimate of a zero between ``low`` and ``high``, or their middle where that leads out of them."""
    new = x - f / slope if slope != 0 else (low + high) / 2
    return new if low < new < high else (low + high) / 2


@compiled
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


@compiled
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


@compiled
def lemma2_interval(a: FloatArray, b: FloatArray, margin: float, share: float) -> tuple[float, float, float]:
    """Lemma 2 for one vertex: where B_i ≥ 1/2 + c, or all of its peak if that is lower.

    Args:
        a, b: (4,) Bernstein coefficients of B_i on the span before u_i and on the span after it.
        margin: c of the lemma.
        share: below 1, ask for no more than this share of the peak, ``fallback="peak"``; 1 is ``fallback="knot"``.

    Returns:
        The interval's ends, each as a signed share of its span (-1 is u_{i-1}, +1 is u_{i+1}), and the least value
        of B_i on it.
    """
    right = b[1] > b[0]
    if right:
        x = _top(b[0], b[1], b[2], b[3])
        peak, top = x, _bernstein(b[0], b[1], b[2], b[3], x)
    else:
        x = _top(a[0], a[1], a[2], a[3])
        peak, top = x - 1, _bernstein(a[0], a[1], a[2], a[3], x)
    if share == 1.0 and top <= 0.5:
        return 0.0, 0.0, top
    level = min(0.5 + margin, share * top)
    if a[0] >= level:
        low = -1.0
    elif a[3] >= level:
        low = _crossing(a[0], a[1], a[2], a[3], level, 0.0, 1.0 if right else peak + 1) - 1
    else:
        low = (
            _crossing(b[0], b[1], b[2], b[3], level, 0.0, peak)
            if right
            else _crossing(a[0], a[1], a[2], a[3], level, 0.0, peak + 1) - 1
        )
    if b[3] >= level:
        high = 1.0
    elif b[0] >= level:
        high = _crossing(b[0], b[1], b[2], b[3], level, peak if right else 0.0, 1.0)
    else:
        high = (
            _crossing(a[0], a[1], a[2], a[3], level, peak + 1, 1.0) - 1
            if not right
            else _crossing(b[0], b[1], b[2], b[3], level, peak, 1.0)
        )
    return low, high, min(level, min(a[0] if low == -1.0 else level, 9.0))


@compiled
def solve_arc(
    p: FloatArray,
    k: int,
    start: FloatArray,
    end: FloatArray,
    margin: float,
    tolerance: float,
    u: FloatArray,
    M: FloatArray,
    P: FloatArray,
    b: FloatArray,
    t: FloatArray,
) -> float:
    """Variant 2 on a clamped arc with vertices p[: k + 1] and end derivatives ``start``, ``end`` (Algorithm 2).

    Args:
        p: (k + 1, 2) or more rows; k: number of spans.
        start, end: (2,) derivatives by chord length at the ends.
        margin: c of Lemma 2.
        tolerance: the largest error has to fall below it.
        u, M, P, b, t: results of at least k + 1, k, k + 3, k, k + 1 rows: knots, Bézier weights, control points,
            Bézier points, and the footpoints as signed shares of the neighbouring span.

    Returns:
        The largest error left.
    """
    u[0] = 0.0
    for i in range(k):
        u[i + 1] = u[i] + np.hypot(p[i + 1, 0] - p[i, 0], p[i + 1, 1] - p[i, 1])
    bezier_weights(u, k, M)
    for c in range(2):
        P[0, c], P[k + 2, c] = p[0, c], p[k, c]
        P[1, c] = p[0, c] + (u[1] - u[0]) / 3 * start[c]
        P[k + 1, c] = p[k, c] - (u[k] - u[k - 1]) / 3 * end[c]
    bounds = np.empty((k + 1, 2))
    for i in range(1, k):
        P[i + 1] = p[i]
        low, high, _ = lemma2_interval(M[i - 1, :, 2], M[i, :, 1], margin, PEAK_SHARE if k == 2 else 1.0)
        bounds[i, 0], bounds[i, 1] = low, high
        t[i] = min(max(0.0, low), high)
    error = 0.0
    e = np.empty((k + 1, 2))
    for _ in range(200):
        bezier_points(M, P, k, b)
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


@compiled
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
        if step == 2:
            break
        speed = dx * dx + dy * dy
        slope = (cx - x) * dx + (cy - y) * dy
        bend = speed + (cx - x) * ax + (cy - y) * ay
        move = -slope / (bend if bend > 0.1 * speed else speed) * h if speed > 0 else 0.0
        length = (t * h) + move
        new = length / after if length >= 0 else length / before
        t = min(max(new, low), high)
    return x - cx, y - cy, t
