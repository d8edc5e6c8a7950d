"""One pass of Algorithm 2 or 3 for every degree, variant and kind of curve, a vertex at a time.

Cubic curves in variants 1 to 3 have the faster passes of :mod:`.newton_simd`.
"""

from __future__ import annotations

from math import comb
from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.bspline import bezier_pieces, full_knots
from ...types import FloatArray, IntArray
from ..intervals import BISECTIONS
from ..method import TIE_DISTANCE
from .footpoint import MAX_DEGREE, WORK, reduce, search_piece
from .one_interval import end_interval, near_end, value_at_knot

KNOTS = MAX_DEGREE + 2
"""Maximum number of knots in the support of a basis function."""

TIED = TIE_DISTANCE**2


class Layout(NamedTuple):
    """A polygon in the units of the compiled passes: origin at its first vertex, extent and mean knot interval near 1.

    Attributes:
        points: (f, d) the vertices with a free control point; vertex j's is ``controls[first + j]``.
        bounds, centres: (f, 2), (f,) search intervals of the footpoints.
        spans: (f, 2) first and last span of each interval; numbers continue through the periods.
        starts: (spans,) left knots; period: T, 0 if open.
        matrices: (spans, degree + 1, degree + 1) from control points to coefficients by powers of t - start.
        indices: (spans, degree + 1) which control points.
        first: index of the first free control point.
        natural: (2,) weight of the first (last) free control point in the fixed one beside it.
        base: (2, d) the rest of those two fixed ones.
    """

    points: FloatArray
    bounds: FloatArray
    centres: FloatArray
    spans: IntArray
    starts: FloatArray
    period: float
    matrices: FloatArray
    indices: IntArray
    first: int
    natural: FloatArray
    base: FloatArray


def power_matrices(u: FloatArray, degree: int, closed: bool) -> FloatArray:
    """(spans, degree + 1, degree + 1) the map from a span's control points to its coefficients by powers of t - u_k."""
    h = np.diff(u)
    identity = np.broadcast_to(np.eye(degree + 1), (len(h), degree + 1, degree + 1))
    differences = bezier_pieces(full_knots(u, degree, closed), identity)
    rows = []
    for k in range(degree + 1):
        rows.append(comb(degree, k) * differences[:, 0] / h[:, None] ** k)
        differences = np.diff(differences, axis=1)
    return np.stack(rows, axis=1)


@compiled
def _coefficients(span: int, P: FloatArray, p: FloatArray, v: Layout, b: FloatArray) -> None:
    """Coefficients of the piece about p: b[k] of (t - start)^k."""
    order, size = b.shape
    for k in range(order):
        x, y = 0.0, 0.0
        for axis in range(2, size):
            b[k, axis] = 0.0
        for j in range(order):
            weight, i = v.matrices[span, k, j], v.indices[span, j]
            x += weight * (P[i, 0] - p[0])
            y += weight * (P[i, 1] - p[1])
            for axis in range(2, size):
                b[k, axis] += weight * (P[i, axis] - p[axis])
        b[k, 0], b[k, 1] = x, y


@compiled
def _for_search(b: FloatArray, c: FloatArray) -> None:
    """The coefficients as :func:`search_piece` takes them, c[axis, k]; of many coordinates as few as have to be.

    Overwrites b.
    """
    order, size = b.shape
    if size > order:
        reduce(b, c)
        return
    for k in range(order):
        for axis in range(size):
            c[axis, k] = b[k, axis]


@compiled
def _error(b: FloatArray, y: float, e: FloatArray) -> float:
    """Write minus the piece's value at y to e; returns its length."""
    d, size = b.shape[0] - 1, b.shape[1]
    squares = 0.0
    for axis in range(size):
        q = b[d, axis]
        for k in range(d - 1, -1, -1):
            q = q * y + b[k, axis]
        e[axis] = -q
        if axis > 1:
            squares += q * q
    distance = np.hypot(e[0], e[1])
    return np.hypot(distance, np.sqrt(squares)) if size > 2 else distance


@compiled
def _follow_ends(P: FloatArray, count: int, v: Layout) -> None:
    """The fixed control points beside natural ends, which follow the first and last free ones."""
    if count > 0 and v.period == 0.0:
        for axis in range(P.shape[1]):
            P[1, axis] = v.base[0, axis] + v.natural[0] * P[2, axis]
            P[count + 2, axis] = v.base[1, axis] + v.natural[1] * P[count + 1, axis]


@compiled
def one_pass(P: FloatArray, t: FloatArray, v: Layout, at_once: bool) -> tuple[float, int]:
    """Write the footpoints to t and update P_i += p_i - C(t_i).

    With ``at_once`` (Algorithm 3) each control point is moved before the next footpoint is computed. Returns the
    largest error before the update, and the number of footpoints that are not certified: all, if one is not finite.
    """
    n, d, (count, size) = v.starts.shape[0], v.matrices.shape[1] - 1, v.points.shape
    b, c, work = np.empty((d + 1, size)), np.empty((min(size, d + 1), d + 1)), np.empty(WORK)
    e = np.empty((count, size))
    largest, uncertified = 0.0, 0
    for i in range(count):
        p = v.points[i]
        low, high = v.bounds[i, 0], v.bounds[i, 1]
        before, D = min(max(t[i], low), high), np.inf
        x, certified = before, True
        first, last = v.spans[i, 0], v.spans[i, 1]
        here = first
        for k in range(first, last + 1):
            if v.starts[k % n] + (k // n) * v.period <= before:
                here = k
        for turn in range(last - first + 1):
            k = first + (here - first + turn) % (last - first + 1)
            lap, span = k // n, k % n
            origin = v.starts[span] + lap * v.period
            end = (v.starts[span + 1] if span + 1 < n else np.inf) + lap * v.period
            if span + 1 == n and v.period > 0.0:
                end = (lap + 1) * v.period
            left, right = max(low, origin) - origin, min(high, end) - origin
            if right < left:
                continue
            _coefficients(span, P, p, v, b)
            _for_search(b, c)
            x, D, whole = search_piece(c, d, origin, left, right, v.centres[i], x, D, TIED, work)
            certified &= whole
        uncertified += not certified
        for k in range(first, last + 1):
            if v.starts[k % n] + (k // n) * v.period <= x or k == first:
                here = k
        _coefficients(here % n, P, p, v, b)
        t[i], distance = x, _error(b, x - (v.starts[here % n] + (here // n) * v.period), e[i])
        if not np.isfinite(distance):
            return np.inf, count
        largest = max(largest, distance)
        if at_once:
            for axis in range(size):
                P[v.first + i, axis] += e[i, axis]
            _follow_ends(P, count, v)
    if not at_once:
        for i in range(count):
            for axis in range(size):
                P[v.first + i, axis] += e[i, axis]
        _follow_ends(P, count, v)
    return largest, uncertified


@compiled
def _basis_value(w: FloatArray, spans: int, t: float, N: FloatArray) -> float:
    """B(t) on its knots w[0] … w[spans], by Cox and de Boor; each span is closed at its left end.

    The last span of positive length is closed at both. N: scratch of KNOTS numbers.
    """
    end = w[spans]
    for k in range(spans):
        u, v = w[k], w[k + 1]
        N[k] = 1.0 if (u <= t < v) or (v > u and v == end and t == end) else 0.0
    for width in range(1, spans):
        for k in range(spans - width):
            rising = w[k + width] - w[k]
            falling = w[k + width + 1] - w[k + 1]
            value = 0.0
            if rising > 0.0:
                value = (t - w[k]) / rising * N[k]
            if falling > 0.0:
                value += (1.0 - (t - w[k + 1]) / falling) * N[k + 1]
            N[k] = value
    return N[0]


@compiled
def _bisected(w: FloatArray, spans: int, inside: float, outside: float, level: float, N: FloatArray) -> float:
    """The last parameter between ``inside`` and ``outside`` at which B ≥ level; with level < 0 that at which B' > 0.

    B' is the difference of the two basis functions of one degree less.
    """
    for _ in range(BISECTIONS):
        middle = (inside + outside) / 2
        if middle in (inside, outside):
            break
        if level >= 0.0:
            enough = _basis_value(w, spans, middle, N) >= level
        else:
            slope = 0.0
            if w[spans - 1] > w[0]:
                slope = _basis_value(w, spans - 1, middle, N) / (w[spans - 1] - w[0])
            if w[spans] > w[1]:
                slope -= _basis_value(w[1:], spans - 1, middle, N) / (w[spans] - w[1])
            enough = slope > 0.0
        if enough:
            inside = middle
        else:
            outside = middle
    return inside if level >= 0.0 else (inside + outside) / 2


@compiled
def search_bounds(
    windows: FloatArray, centres: FloatArray, variant: int, margin: float, peak_share: float, h: FloatArray,
    natural: FloatArray, bounds: FloatArray,
) -> tuple[int, float]:  # fmt: skip
    """Write the search interval of each footpoint to ``bounds``, by the rules and bisections of ``intervals.py``.

    Returns the number of fallbacks and the least value of a B_i on its interval.

    Args:
        windows: (n, degree + 2) the knots of each basis function.
        centres: (n,) the parameter of each vertex.
        peak_share: of ``fallback="peak"``, else 0.
        h: knot intervals of an arc between two of no length at either end; () of a closed curve.
        natural: (2,) weights of an arc's natural ends, 0 for end tangents.
    """
    N = np.empty(KNOTS)
    spans, n = windows.shape[1] - 1, windows.shape[0] + 2
    fallbacks, least, share = 0, 1.0, peak_share if peak_share > 0.0 else 1.0
    for i in range(windows.shape[0]):
        w = windows[i]
        if len(h) > 0 and variant > 1 and near_end(i + 1, n):
            if variant == 3:
                bounds[i, 0] = bounds[i, 1] = centres[i]
                least = min(least, value_at_knot(h, i + 2, i + 1, n, natural[0], natural[1]))
                continue
            left, right, value, found = end_interval(h, i + 2, i + 1, n, natural[0], natural[1], margin, share)
            if found:
                bounds[i, 0] = w[2] + left * (w[2] - w[1] if left < 0.0 else w[3] - w[2])
                bounds[i, 1] = w[2] + right * (w[2] - w[1] if right < 0.0 else w[3] - w[2])
                least = min(least, value)
                continue
        if variant == 0:
            low, high = w[0], w[spans]
        elif variant == 1:
            low, high = w[1], w[spans - 1]
        elif variant == 3:
            low = high = centres[i]
        else:
            peak = _bisected(w, spans, w[0], w[spans], -1.0, N)
            highest = _basis_value(w, spans, peak, N)
            fallbacks += highest <= 0.5
            level = min(0.5 + margin, peak_share * highest if peak_share > 0.0 else highest)
            low = high = peak
            if peak_share == 0.0 and highest <= 0.5:
                low = high = centres[i]
            elif highest > level:
                low = _bisected(w, spans, peak, w[0], level, N)
                high = _bisected(w, spans, peak, w[spans], level, N)
            if peak_share > 0.0 or highest > 0.5:
                low = min(max(low, w[1]), w[spans - 1])
                high = min(max(high, w[1]), w[spans - 1])
        bounds[i, 0], bounds[i, 1] = low, high
        least = min(least, _basis_value(w, spans, low, N), _basis_value(w, spans, high, N))
    return fallbacks, least
