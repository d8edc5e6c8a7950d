"""Algorithms 2 and 3 for every degree, variant and kind of curve, a vertex at a time.

Cubic curves in variants 1 to 3 take the faster way of ``lanes``; this one does all the rest, and records histories.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np

from ...compiled import compiled
from ...curves.bspline import bezier_pieces, full_knots, span_controls
from ...types import FloatArray, IntArray
from .footpoint import WORK, search_piece


@dataclass(frozen=True, eq=False)
class Layout:
    """A polygon made ready for the compiled passes: origin at its first vertex, extent and mean knot interval near 1.

    Attributes:
        points: (f, 2) the vertices with a free control point; vertex j's is ``controls[first + j]``.
        bounds, centres: (f, 2), (f,) where footpoints are sought.
        spans: (f, 2) first and last span of each interval, counted on through the periods.
        starts: (spans,) left knots; period: T, 0 if open.
        matrices: (spans, degree + 1, degree + 1) from control points to coefficients by powers of t - start.
        indices: (spans, degree + 1) which control points.
        first: index of the first free control point.
        natural: (2,) weight of the first (last) free control point in the fixed one beside it.
        base: (2, 2) the rest of those two fixed ones.
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


def make_layout(
    points: FloatArray,
    first: int,
    bounds: FloatArray,
    centres: FloatArray,
    u: FloatArray,
    degree: int,
    closed: bool,
    natural: FloatArray,
    base: FloatArray,
) -> Layout:
    """Lay out a normalised polygon; points, bounds and centres are of the vertices whose control points are moved."""
    n_spans, T = len(u) - 1, float(u[-1])
    lap = np.floor(bounds / T) if closed else np.zeros_like(bounds)
    within = np.clip(np.searchsorted(u, bounds - lap * T, side="right") - 1, 0, n_spans - 1)
    return Layout(
        points=np.ascontiguousarray(points),
        bounds=bounds,
        centres=centres,
        spans=(lap * n_spans).astype(np.int64) + within,
        starts=u[:-1],
        period=T if closed else 0.0,
        matrices=power_matrices(u, degree, closed),
        indices=span_controls(n_spans, degree, closed).astype(np.int64),
        first=first,
        natural=natural,
        base=base,
    )


@compiled
def _coefficients(span, P, px, py, matrices, indices, c):
    """Coefficients of the piece about p: c[axis, k] of (t - start)^k."""
    order = matrices.shape[1]
    for k in range(order):
        x, y = 0.0, 0.0
        for j in range(order):
            weight = matrices[span, k, j]
            x += weight * (P[indices[span, j], 0] - px)
            y += weight * (P[indices[span, j], 1] - py)
        c[0, k] = x
        c[1, k] = y


@compiled
def follow_ends(P, count, natural, base):
    """The fixed control points beside natural ends, which follow the first and last free ones."""
    if count > 0:
        for axis in range(2):
            P[1, axis] = base[0, axis] + natural[0] * P[2, axis]
            P[count + 2, axis] = base[1, axis] + natural[1] * P[count + 1, axis]


@compiled
def one_pass(
    P, t, e, points, bounds, centres, spans, starts, period, matrices, indices, first, natural, base, at_once, tie
):
    """Footpoints of all vertices, into t, and the errors p - C(t), into e; the largest distance is returned.

    With ``at_once`` (Algorithm 3) each control point is moved before the next vertex is looked at; otherwise P stays.
    """
    n, d = starts.shape[0], matrices.shape[1] - 1
    c = np.empty((2, d + 1))
    work = np.empty(WORK)
    largest = 0.0
    for i in range(points.shape[0]):
        px, py = points[i, 0], points[i, 1]
        low, high = bounds[i, 0], bounds[i, 1]
        before, D = min(max(t[i], low), high), np.inf
        x = before
        here = spans[i, 0]
        for k in range(spans[i, 0], spans[i, 1] + 1):
            if starts[k % n] + (k // n) * period <= before:
                here = k
        for turn in range(spans[i, 1] - spans[i, 0] + 1):
            k = spans[i, 0] + (here - spans[i, 0] + turn) % (spans[i, 1] - spans[i, 0] + 1)
            lap, span = k // n, k % n
            origin = starts[span] + lap * period
            end = (starts[span + 1] if span + 1 < n else np.inf) + lap * period
            if span + 1 == n and period > 0.0:
                end = (lap + 1) * period
            a, b = max(low, origin) - origin, min(high, end) - origin
            if b < a:
                continue
            _coefficients(span, P, px, py, matrices, indices, c)
            x, D = search_piece(c, d, origin, a, b, centres[i], x, D, tie, work)
        for k in range(spans[i, 0], spans[i, 1] + 1):
            if starts[k % n] + (k // n) * period <= x or k == spans[i, 0]:
                here = k
        _coefficients(here % n, P, px, py, matrices, indices, c)
        y = x - (starts[here % n] + (here // n) * period)
        qx, qy = c[0, d], c[1, d]
        for k in range(d - 1, -1, -1):
            qx, qy = qx * y + c[0, k], qy * y + c[1, k]
        t[i], e[i, 0], e[i, 1] = x, -qx, -qy
        distance = np.hypot(qx, qy)
        if not np.isfinite(distance):
            return np.inf
        largest = max(largest, distance)
        if at_once:
            P[first + i, 0] -= qx
            P[first + i, 1] -= qy
            if period == 0.0:
                follow_ends(P, points.shape[0], natural, base)
    return largest


@compiled
def passes(
    P, t, e, points, bounds, centres, spans, starts, period, matrices, indices, first, natural, base, at_once, tie,
    limit, residuals,
):  # fmt: skip
    """Passes of Algorithm 2, or 3 with ``at_once``, until the error is below ``limit``; how many were made.

    At most ``len(residuals)`` passes are made, whose errors go there. What the last of them changed stays only if it
    passes.
    """
    before = P.copy()
    for made in range(residuals.shape[0]):
        if at_once:
            before[:] = P
        largest = one_pass(
            P, t, e, points, bounds, centres, spans, starts, period, matrices, indices, first, natural, base, at_once,
            tie,
        )  # fmt: skip
        residuals[made] = largest
        if largest < limit:
            return made + 1
        if made + 1 == residuals.shape[0] or not largest < np.inf:
            break
        if not at_once:
            move(P, e, first, period, natural, base)
    if at_once:
        P[:] = before
    return made + 1


@compiled
def move(P, e, first, period, natural, base):
    """P_i += p_i - C(t_i), all at once."""
    for i in range(e.shape[0]):
        P[first + i, 0] += e[i, 0]
        P[first + i, 1] += e[i, 1]
    if period == 0.0:
        follow_ends(P, e.shape[0], natural, base)
