"""One pass of Algorithm 2 or 3 for every degree, variant and kind of curve, a vertex at a time.

Cubic curves in variants 1 to 3 have the faster passes of :mod:`.newton_simd`.
"""

from __future__ import annotations

from math import comb
from typing import NamedTuple

import numpy as np

from ...compiled import compiled, inlined
from ...curves.bspline import bezier_pieces, full_knots
from ...types import FloatArray, IntArray
from ..method import TIE_DISTANCE
from .footpoint import WORK, reduce, search_piece

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


@inlined
def _coefficients(span: int, P: FloatArray, p: FloatArray, v: Layout, b: FloatArray) -> None:
    """Coefficients of the piece about p: b[k] of (t - start)^k."""
    order, size = b.shape
    for k in range(order):
        for axis in range(size):
            b[k, axis] = 0.0
            for j in range(order):
                b[k, axis] += v.matrices[span, k, j] * (P[v.indices[span, j], axis] - p[axis])


@inlined
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
            if size > d + 1:
                reduce(b, c)
            else:
                for axis in range(size):
                    for power in range(d + 1):
                        c[axis, power] = b[power, axis]
            x, D, whole = search_piece(c, d, origin, left, right, v.centres[i], x, D, TIED, work)
            certified &= whole
        uncertified += not certified
        for k in range(first, last + 1):
            if v.starts[k % n] + (k // n) * v.period <= x or k == first:
                here = k
        _coefficients(here % n, P, p, v, b)
        t[i], y, distance = x, x - (v.starts[here % n] + (here // n) * v.period), 0.0
        for axis in range(size):
            q = b[d, axis]
            for power in range(d - 1, -1, -1):
                q = q * y + b[power, axis]
            e[i, axis], distance = -q, np.hypot(distance, q)
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
