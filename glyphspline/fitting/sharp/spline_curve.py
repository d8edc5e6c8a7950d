"""Small cubic splines of variant 2 that a fit moves: arcs clamped at both ends, and closed curves.

A spline follows K *masters* of one outline at once: it is a curve in R^{2K}; master v has the coordinates 2v
and 2v + 1. Lengths there are the root mean squares of those in the masters. An outline by itself is its only master.

Arcs and closed curves have the same form. Knot interval ``s`` runs from vertex s to vertex s + 1; outside of an arc
the intervals have no length, around a closed curve they begin again. *Slot* i is the control point of vertex i. Those
of an arc are its inner control points and, for its two ends, the control points next to them; the ends themselves lie
before the first slot and after the last. The cubic of span s depends on slots s - 1 to s + 2.

Newton's method finds the footpoints from the last ones, without the certificate of the interpolation. A fit keeps only
the vertices and end tangents; :func:`glyphspline.interpolate` computes the curve that is written from them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import cut, put
from ...compiled import compiled, inlined
from ...curves.cubics import newton_step
from ...interpolation.kernels.lemma2 import add_fixed, one_interval
from ...interpolation.kernels.passes import along
from ...types import FloatArray, IntArray

SHORT = 0.01
"""Share of a span below which Newton's step to a footpoint, of a vertex or of a sample, is the last."""

SHORTEST_HANDLE, LONGEST_HANDLE = 1 / 8, 4 / 3
"""Lengths between which the end handles of an arc are kept, in chords of their end: shorter ones end in a spike of
curvature."""

SHARES = 1.108, 2.32
"""Shares of their errors by which control points move in turn, where all that counts is that a curve is near.

They are Chebyshev's for eigenvalues from 1/3 to 1, as cubic B-splines have at even knots: two passes leave a seventh of
an error, where two plain ones leave four ninths. Fits of a round face need a third fewer passes.
"""

HELD, FREE, TIED = 0, 1, 2
"""What the tangent at an end may do: see :class:`.feet.Samples`."""


class Curve(NamedTuple):
    """A cubic spline of k spans and its vertices in K masters.

    Attributes:
        k: the number of spans. closed: 1 for a closed curve, or else 0.
        p: (K, n, 2) the vertices, of an arc k + 1, of a closed curve k.
        X: (K, k + 3, 2) the control points: slot i in row i + 1.
        h: (k + 5,) the knot intervals: that of span s in entry s + 2.
        W: (k, 4, 4) Bézier weights: the Bézier points of span s are ``W[s] @ X[v, s : s + 4]``.
        b: (K, k, 4, 2) the Bézier points. c: (K, k, 4, 2) the same by powers of the local parameter: :func:`jet_of`.
        t: (k + 1,) footpoints of the vertices, as signed shares of the span before or after them.
        bounds: (k + 1, 2) the ends of their intervals (Lemma 2), likewise.
        e: (K, k + 1, 2) vertices less footpoints. d: (K, 2) derivatives at the last footpoint looked at.
    """

    k: int
    closed: int
    p: FloatArray
    X: FloatArray
    h: FloatArray
    W: FloatArray
    b: FloatArray
    c: FloatArray
    t: FloatArray
    bounds: FloatArray
    e: FloatArray
    d: FloatArray


@compiled
def copy_points(source: Curve, target: Curve) -> None:
    """Copy the vertices, control points and footpoints of a curve into the arrays of another one of as many spans."""
    put(source.p, target.p)
    put(source.X, target.X)
    put(source.t, target.t)
    put(source.bounds, target.bounds)


@compiled
def chord(p: FloatArray, i: int, j: int) -> float:
    """Distance of vertices i and j of p, (K, n, 2): the root mean square of those in the masters."""
    total = 0.0
    for v in range(len(p)):
        x, y = p[v, j, 0] - p[v, i, 0], p[v, j, 1] - p[v, i, 1]
        total += x * x + y * y
    return np.sqrt(total / len(p))


class Tried(NamedTuple):
    """A curve that a search tries: views of one array, as Numba takes as long for each array that it hands over.

    Attributes:
        p: (K, n, 2) its vertices. tips: (K, 2, 2) of an arc's end handles; undefined for a closed curve.
        c, h: as of :class:`Curve`, and errors: (k,) the largest distance in each span, once the vertices have moved.
    """

    p: FloatArray
    tips: FloatArray
    c: FloatArray
    h: FloatArray
    errors: FloatArray


@inlined
def numbers_for(masters: int, k: int, closed: int) -> FloatArray:
    """The array of which :func:`tried_in` makes views."""
    return np.empty(masters * (2 * (k + 1 - closed) + 4 + 8 * k) + 2 * k + 5)


@inlined
def tried_in(numbers: FloatArray, masters: int, k: int, closed: int) -> Tried:
    """The curve of k spans in K masters that is in an array."""
    p, rest = cut(numbers, 2 * masters * (k + 1 - closed))
    tips, rest = cut(rest, 4 * masters)
    c, rest = cut(rest, 8 * masters * k)
    h, errors = cut(rest, k + 5)
    return Tried(
        p.reshape((masters, k + 1 - closed, 2)), tips.reshape((masters, 2, 2)), c.reshape((masters, k, 4, 2)), h, errors
    )


@inlined
def jet_of(c: FloatArray, s: int, x: float) -> tuple[float, float, float, float, float, float]:
    """As :func:`.curves.cubics.jet`, by powers of the local parameter: half as many products."""
    px, dx, ax = along(c[s, 0, 0], c[s, 1, 0], c[s, 2, 0], c[s, 3, 0], x)
    py, dy, ay = along(c[s, 0, 1], c[s, 1, 1], c[s, 2, 1], c[s, 3, 1], x)
    return px, py, dx, dy, 2 * ax, 2 * ay


@inlined
def wrapped(s: int, k: int) -> int:
    """The span of a closed curve that span s is, up to a lap before the first one and two laps after it."""
    if s >= k:
        s -= k
    if s >= k:
        s -= k
    return s if s >= 0 else s + k


@compiled
def curve_of(p: FloatArray, tips: FloatArray, closed: int) -> Curve:
    """A curve with vertices (K, n, 2), and if it is an arc with the tips (K, 2, 2) of its end handles."""
    masters, k = p.shape[0], p.shape[1] - 1 + closed
    curve = Curve(
        k, closed, p.copy(), np.empty((masters, k + 3, 2)), np.zeros(k + 5), np.empty((k, 4, 4)),
        np.empty((masters, k, 4, 2)), np.empty((masters, k, 4, 2)), np.zeros(k + 1), np.empty((k + 1, 2)),
        np.empty((masters, k + 1, 2)), np.empty((masters, 2)),
    )  # fmt: skip
    for v in range(0 if closed else masters):
        X = curve.X[v]
        for axis in range(2):
            X[0, axis], X[k + 2, axis] = p[v, 0, axis], p[v, k, axis]
            X[1, axis], X[k + 1, axis] = tips[v, 0, axis], tips[v, 1, axis]
    return curve


@compiled
def set_tips(p: FloatArray, tangents: FloatArray, tips: FloatArray) -> None:
    """Write the tips of an arc's end handles from its end tangents (K, 2, 2), derivatives by chord length."""
    k = p.shape[1] - 1
    first, last = chord(p, 0, 1) / 3, chord(p, k - 1, k) / 3
    for v in range(len(p)):
        for axis in range(2):
            tips[v, 0, axis] = p[v, 0, axis] + first * tangents[v, 0, axis]
            tips[v, 1, axis] = p[v, k, axis] - last * tangents[v, 1, axis]


@compiled
def hold_tied(curve: Curve, directions: FloatArray, free: IntArray) -> None:
    """Make the handles of tied ends the directions (K, 2, 2) times one number; ``free``: see :class:`.feet.Samples`."""
    k, X = curve.k, curve.X
    for end in range(2):
        if curve.closed or free[end] != TIED:
            continue
        at, tip = (0, 1) if end == 0 else (k + 2, k + 1)
        along = whole = 0.0
        for v in range(len(X)):
            for axis in range(2):
                along += (X[v, tip, axis] - X[v, at, axis]) * directions[v, end, axis]
                whole += directions[v, end, axis] * directions[v, end, axis]
        for v in range(len(X)):
            for axis in range(2):
                X[v, tip, axis] = X[v, at, axis] + along / whole * directions[v, end, axis]


@compiled
def set_knots(curve: Curve) -> bool:
    """Knot intervals from the chords, and the Bézier weights; False if a chord has no length."""
    k, closed, p, h = curve.k, curve.closed, curve.p, curve.h
    least = np.inf
    for s in range(k):
        e = s + 1 if s + 1 < k or not closed else 0
        h[s + 2] = chord(p, s, e)
        least = min(least, h[s + 2])
    for n in range(2):
        h[n], h[k + 2 + n] = (h[k + n], h[2 + n]) if closed else (0.0, 0.0)
    for s in range(k):
        span_weights(h, s, curve.W[s])
    return least > 0.0


@compiled
def span_weights(h: FloatArray, s: int, W: FloatArray) -> None:
    """The Bézier weights (4, 4) of span s, from knot intervals as :class:`Curve` has them."""
    h0, h1, h2, h3, h4 = h[s], h[s + 1], h[s + 2], h[s + 3], h[s + 4]
    before, own, after = h0 + h1 + h2, h1 + h2 + h3, h2 + h3 + h4
    low, high = h2 / (h1 + h2), h2 / (h2 + h3)
    a, c, d, e = h1 / own, (h1 + h2) / own, (h0 + h1) / before, h2 / after
    for r in range(4):
        for j in range(4):
            W[r, j] = 0.0
    W[0, 0], W[0, 1], W[0, 2] = low * (1 - d), low * d + (1 - low) * (1 - a), (1 - low) * a
    W[1, 1], W[1, 2] = 1 - a, a
    W[2, 1], W[2, 2] = 1 - c, c
    W[3, 1], W[3, 2], W[3, 3] = (1 - high) * (1 - c), (1 - high) * c + high * (1 - e), high * e


@compiled
def iterate(curve: Curve, tolerance: float, most: int, eager: bool) -> float:
    """Variant 2 (Algorithm 2) from the present control points, in at most ``most`` passes; the largest error left.

    Args:
        eager: whether control points move by ``SHARES`` of the errors, instead of by the errors.
    """
    k, closed, X, e, masters = curve.k, curve.closed, curve.X, curve.e, len(curve.X)
    error = 0.0
    for n in range(most + 1):
        for v in range(masters):
            W, b, c, own = curve.W, curve.b[v], curve.c[v], X[v]
            for axis in range(2 if closed else 0):
                own[0, axis], own[k + 1, axis], own[k + 2, axis] = own[k, axis], own[1, axis], own[2, axis]
            for axis in range(2):
                begin = W[0, 0, 0] * own[0, axis] + W[0, 0, 1] * own[1, axis] + W[0, 0, 2] * own[2, axis]
                for s in range(k):  # each span begins where the last one ends; the other weights are 0
                    x, y = own[s + 1, axis], own[s + 2, axis]
                    b[s, 0, axis], b[s, 1, axis] = begin, W[s, 1, 1] * x + W[s, 1, 2] * y
                    b[s, 2, axis] = W[s, 2, 1] * x + W[s, 2, 2] * y
                    begin = W[s, 3, 1] * x + W[s, 3, 2] * y + W[s, 3, 3] * own[s + 3, axis]
                    b[s, 3, axis] = begin
                    first, last = b[s, 1, axis] - b[s, 0, axis], begin - b[s, 2, axis]
                    middle = b[s, 2, axis] - b[s, 1, axis]
                    c[s, 0, axis], c[s, 1, axis] = b[s, 0, axis], 3 * first
                    c[s, 2, axis], c[s, 3, axis] = 3 * (middle - first), (last - middle) - (middle - first)
        if n == most:
            break
        error = 0.0
        for i in range(1 - closed, k):
            find_footpoint(curve, i)
            square = 0.0
            for v in range(masters):
                square += e[v, i, 0] * e[v, i, 0] + e[v, i, 1] * e[v, i, 1]
            error = max(error, square)
        error = np.sqrt(error / masters)
        if error < tolerance or not error < 1e9:
            break
        share = SHARES[n % 2] if eager else 1.0
        for v in range(masters):
            for i in range(1 - closed, k):
                X[v, i + 1, 0] += share * e[v, i, 0]
                X[v, i + 1, 1] += share * e[v, i, 1]
    return error


@compiled
def find_footpoint(curve: Curve, i: int) -> None:
    """The footpoint of vertex i, as a signed share of the span before or after u_i, and the vertex less that point.

    Where Newton's last step is short, it is the part across the curve at the point before it.
    """
    before, after, e, d = curve.h[i + 1], curve.h[i + 2], curve.e, curve.d
    last = i - 1 if i > 0 else curve.k - 1
    low, high, t = curve.bounds[i, 0], curve.bounds[i, 1], curve.t[i]
    for step in range(3):
        ahead = t >= 0
        s, h = (i, after) if ahead else (last, before)
        speed = slope = bend = 0.0
        for v in range(len(e)):
            cx, cy, dx, dy, ax, ay = jet_of(curve.c[v], s, t if ahead else t + 1)
            ex, ey = curve.p[v, i, 0] - cx, curve.p[v, i, 1] - cy
            e[v, i, 0], e[v, i, 1], d[v, 0], d[v, 1] = ex, ey, dx, dy
            own = dx * dx + dy * dy
            speed += own
            slope += -ex * dx - ey * dy
            bend += own - ex * ax - ey * ay
        if step == 2 or speed <= 0:
            break
        new = newton_step(t * h, slope * h, speed, bend, -before, after)
        old, t = t, min(max(new / after if new >= 0 else new / before, low), high)
        if abs(t - old) < SHORT and low < t < high:
            for v in range(len(e)):
                e[v, i, 0] -= -slope / speed * d[v, 0]
                e[v, i, 1] -= -slope / speed * d[v, 1]
            break
    curve.t[i] = t


@compiled
def interpolate_cold(curve: Curve, margin: float, tolerance: float, eager: bool) -> tuple[float, bool]:
    """Variant 2 from the vertices, as the interpolation runs it if it is not eager.

    It begins from the vertices as control points, and from footpoints at the knots where Lemma 2 allows them.

    Returns:
        The largest error left, infinite without a curve, and whether Lemma 2 has an interval for every vertex.
    """
    if not set_knots(curve):
        return np.inf, False
    k, closed, found = curve.k, curve.closed, True
    before, after = np.empty(4), np.empty(4)
    for i in range(1 - closed, k):
        for v in range(len(curve.X)):
            curve.X[v, i + 1, 0], curve.X[v, i + 1, 1] = curve.p[v, i, 0], curve.p[v, i, 1]
        last = i - 1 if i > 0 else k - 1
        for r in range(4):
            before[r], after[r] = curve.W[last, r, 2], curve.W[i, r, 1]
        c = margin
        if not closed:
            c = add_fixed(curve.h, i + 1, i, k + 1, 0.0, 0.0, margin, before, after)
        low, high, _, _ = one_interval(before, after, c, 0.0)
        curve.bounds[i, 0], curve.bounds[i, 1] = low, high
        curve.t[i] = min(max(0.0, low), high)
        found = found and low < high
    # Passes of variant 2 before a curve counts as lost.
    return iterate(curve, tolerance, 200, eager), found
