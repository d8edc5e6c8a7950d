"""The outline paired with a curve, in order: the foot of every sample on it, and how far the two are apart."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled, inlined
from ...curves.cubics import length, newton_step
from ...types import FloatArray, IntArray
from .spline_curve import SHORT, jet_of, tried_in, wrapped

EXTRA = 6
"""Most points of the curve between two feet that count as rows of their own."""


class Samples(NamedTuple):
    """The stretch of outline that a curve follows.

    Attributes:
        Q: (K, n, 2) points in order, in each master; the ends of an arc are the first and the last.
        places: (n,) their places on the contour.
        D: (n,) integral of the wanted vertex density up to each.
        directions: (K, 2, 2) unit tangents at the ends of an arc. free: (2,) whether these may turn (FREE), or keep
            their directions (HELD) and, besides, the ratio of their lengths in the masters (TIED).
        lap: how far the places count on around a closed contour: its number of segments.
    """

    Q: FloatArray
    places: FloatArray
    D: FloatArray
    directions: FloatArray
    free: IntArray
    lap: float


class Rows(NamedTuple):
    """Points of a curve and their signed distances from the outline: the samples' feet, then others between them.

    Each master has rows of its own: what the curve is near is the outline as a whole, not its parametrisation.

    Attributes:
        used: (K, 1) rows in use; the others are (K, room). span, x: span and local parameter; spans count on around a
            closed curve.
        e: distance from the curve to the outline, along the normal (nx, ny).
        slip: (K, samples) how far a sample's foot in a master is ahead, along the curve, of the place that is nearest
            to the sample in all masters together. lever: what a unit of it may cost, in between, across the curve.
            Both have no columns if there is one master.
    """

    used: IntArray
    span: IntArray
    x: FloatArray
    e: FloatArray
    nx: FloatArray
    ny: FloatArray
    slip: FloatArray
    lever: FloatArray


@compiled
def empty_rows(masters: int, samples: int) -> Rows:
    """Arrays for the rows of ``samples`` samples."""
    room, apart = (masters, (1 + EXTRA) * samples), (masters, samples if masters > 1 else 0)
    return Rows(
        np.zeros((masters, 1), dtype=np.int64), np.empty(room, dtype=np.int64), np.empty(room), np.empty(room),
        np.empty(room), np.empty(room), np.zeros(apart), np.zeros(apart),
    )  # fmt: skip


@compiled
def measure(
    samples: FloatArray, powers: FloatArray, h: FloatArray, closed: int, near: float,
    known: tuple[bool, IntArray, FloatArray], rows: Rows,
) -> float:  # fmt: skip
    """Pair the outline with a curve, in order and in every master by itself; the largest distance.

    Each foot is the nearest point after the foot before it, by Newton's method across the spans.

    Args:
        samples: (K, n, 2), see :class:`Samples`. powers, h, closed: ``c`` and others of :class:`.spline_curve.Curve`.
        near: the tolerance. known: whether there are first guesses, and spans and parameters of these, (K, n).
        rows: receives the feet and distances.
    """
    k, n, worst = powers.shape[1], samples.shape[1], 0.0
    for v in range(len(samples)):
        Q, c = samples[v], powers[v]
        span, x, e, nx, ny = rows.span[v], rows.x[v], rows.e[v], rows.nx[v], rows.ny[v]
        for j in range(n):
            s, at = (k - 1, 1.0) if j > 0 else (0, 0.0)
            if closed or 0 < j < n - 1:
                s0, at0 = (span[j - 1], x[j - 1]) if j > 0 else (-k, 0.0)
                s, at = (s0, at0) if j > 0 else (0, 0.0)
                if known[0]:
                    if known[1][v, j] > s0 or (known[1][v, j] == s0 and known[2][v, j] > at0):
                        s, at = known[1][v, j], known[2][v, j]
                elif j > 0:  # as far on as the samples are apart
                    at += length(Q[j, 0] - Q[j - 1, 0], Q[j, 1] - Q[j - 1, 1]) / h[wrapped(s, k) + 2]
                    at = min(at, 1.0)
                end = k if not closed else (span[0] + k + 1 if j > 0 else k)
                span[j], x[j], e[j], nx[j], ny[j] = _foot(c, k, s, at, s0, at0, end, Q[j, 0], Q[j, 1])
            else:
                span[j], x[j] = s, at
                e[j], nx[j], ny[j] = _distance(c, k, s, at, Q[j, 0], Q[j, 1])
            worst = max(worst, abs(e[j]))
        worst = max(worst, _add_between(Q, c, h, k, closed, near, v, rows))
    if len(samples) > 1:
        worst = max(worst, _measure_slip(powers, h, k, rows))
    return worst


@compiled
def _add_between(
    Q: FloatArray, c: FloatArray, h: FloatArray, k: int, closed: int, near: float, v: int, rows: Rows
) -> float:  # fmt: skip
    """Add rows of master v between the feet of its samples; returns the largest distance of these.

    The curve is measured in several places between feet that are far apart on it: from loops, and from humps of short
    spans, no sample is far.
    """
    n, worst = len(Q), 0.0
    span, x, e, nx, ny, count = rows.span[v], rows.x[v], rows.e[v], rows.nx[v], rows.ny[v], n
    for j in range(n if closed else n - 1):
        i = j + 1 if j + 1 < n else 0
        last, step_x, step_y = span[i] + (k if i == 0 else 0), Q[i, 0] - Q[j, 0], Q[i, 1] - Q[j, 1]
        spans, own = (last + x[i]) - (span[j] + x[j]), (x[i] - x[j]) * h[wrapped(span[j], k) + 2]
        if last != span[j]:
            own = x[i] * h[wrapped(last, k) + 2] - x[j] * h[wrapped(span[j], k) + 2]
            for s in range(span[j], last):
                own += h[wrapped(s, k) + 2]
        square = step_x * step_x + step_y * step_y
        if square == 0.0 or own <= 0.0 or (spans <= 0.25 and own * own <= 4 * square):
            continue
        chord = np.sqrt(square)
        wanted = max(4 * spans, own / (chord + near)) if spans > 0.25 or own > 2 * chord + 2 * near else 0.0
        pieces = min(int(wanted) + 2, EXTRA + 1)
        for r in range(1, pieces):
            s, whole = span[j], h[wrapped(span[j], k) + 2]
            left = own * r / pieces + x[j] * whole
            while left > whole:
                left -= whole
                s += 1
                whole = h[wrapped(s, k) + 2]
            at = left / whole
            cx, cy, _, _, _, _ = jet_of(c, wrapped(s, k), at)
            along = min(max(((cx - Q[j, 0]) * step_x + (cy - Q[j, 1]) * step_y) / square, 0.0), 1.0)
            ex, ey = Q[j, 0] + along * step_x - cx, Q[j, 1] + along * step_y - cy
            away = length(ex, ey)
            # Points of the curve between two feet count from this share of the tolerance on.
            if away > 0.5 * near:
                span[count], x[count], e[count] = s, at, away
                nx[count], ny[count] = ex / away, ey / away
                count += 1
                worst = max(worst, away)
    rows.used[v, 0] = count
    return worst


@compiled
def _measure_slip(c: FloatArray, h: FloatArray, k: int, rows: Rows) -> float:
    """How far the feet of a sample are apart along the curve, and the largest distance that this may make in between.

    Between the masters, points of the curve are mixed that lie at one parameter. Where the feet are apart and the
    masters run in different directions, or bend, the mixture is off; what it is off by, to first order, counts as
    distance. Where they run side by side it costs nothing, and the masters need not agree on a parametrisation.
    """
    masters, n = len(rows.used), rows.slip.shape[1]
    knots = np.zeros(k + 1)
    for s in range(k):
        knots[s + 1] = knots[s] + h[s + 2]
    at, speed, bend, worst = np.empty(masters), np.empty(masters), np.empty(masters), 0.0
    for j in range(n):
        mean = total = nx = ny = 0.0
        for v in range(masters):
            s, x = rows.span[v, j], rows.x[v, j]
            own = wrapped(s, k)
            _, _, dx, dy, ax, ay = jet_of(c[v], own, x)
            at[v] = knots[own] + x * h[own + 2] + (s - own) // k * knots[k]
            size = length(dx, dy)
            speed[v] = size / h[own + 2]
            own_size = max(size, 1e-9)
            bend[v] = abs(dx * ay - dy * ax) / (own_size * own_size * own_size)
            mean += speed[v] * speed[v] * at[v]
            total += speed[v] * speed[v]
            nx += speed[v] * rows.nx[v, j]
            ny += speed[v] * rows.ny[v, j]
        size = max(length(nx, ny), 1e-12)
        for v in range(masters):
            slip = (at[v] - mean / total) * speed[v] if total > 0.0 else 0.0
            aside = abs(nx * rows.ny[v, j] - ny * rows.nx[v, j]) / size
            # What a unit of slip costs across the curve, by the sine of a master's angle to the others and by its bend.
            lever = min((1 - 1 / masters) * aside + 0.5 * bend[v] * abs(slip), 2.0)
            rows.slip[v, j], rows.lever[v, j] = slip, lever
            worst = max(worst, abs(rows.e[v, j]) + lever * abs(slip))
    return worst


@compiled
def _foot(
    c: FloatArray, k: int, s: int, at: float, s0: int, at0: float, end: int, qx: float, qy: float
) -> tuple[int, float, float, float, float]:
    """The nearest point to (qx, qy) from span s, parameter ``at``; not before (s0, at0), nor from span ``end`` on.

    Returns:
        Span, parameter, and as :func:`_distance`. Where Newton's last step is short, its normal and distance are those
        of the point before it: the distance changes by the square of the step.
    """
    for _ in range(12):
        cx, cy, dx, dy, ax, ay = jet_of(c, wrapped(s, k), at)
        speed = dx * dx + dy * dy
        if speed <= 0:
            at = min(at + 0.01, 1.0)
            continue
        slope = (cx - qx) * dx + (cy - qy) * dy
        bend = speed + (cx - qx) * ax + (cy - qy) * ay
        new = newton_step(at, slope, speed, bend, at - 0.5, at + 0.5)
        if new > 1.0:
            if s + 1 < end:
                s, at = s + 1, min(new - 1, 0.5)
                continue
            new = 1.0
        elif new < 0.0:
            if s > s0:
                s, at = s - 1, max(1 + new, 0.5)
                continue
            new = 0.0
        moved = abs(new - at)
        at = new
        if moved < SHORT:
            if 0.0 < at < 1.0 and (s > s0 or at > at0):
                size = np.sqrt(speed)
                nx, ny = -dy / size, dx / size
                return s, at, (qx - cx) * nx + (qy - cy) * ny, nx, ny
            break
    if s < s0 or (s == s0 and at < at0):
        s, at = s0, at0
    e, nx, ny = _distance(c, k, s, at, qx, qy)
    return s, at, e, nx, ny


@inlined
def _distance(c: FloatArray, k: int, s: int, at: float, qx: float, qy: float) -> tuple[float, float, float]:
    """The distance of (qx, qy) from a point of the curve, positive on its left, and the normal there."""
    cx, cy, dx, dy, _, _ = jet_of(c, wrapped(s, k), at)
    ex, ey, speed = qx - cx, qy - cy, max(length(dx, dy), 1e-12)
    nx, ny, away = -dy / speed, dx / speed, length(ex, ey)
    return (away if ex * nx + ey * ny > 0 else -away), nx, ny


@compiled
def set_errors(rows: Rows, limit: float, errors: FloatArray) -> int:
    """Write the largest distance in each span; returns the number of those beyond a limit."""
    k, beyond = len(errors), 0
    for s in range(k):
        errors[s] = 0.0
    for v in range(len(rows.used)):
        for r in range(rows.used[v, 0]):
            s = wrapped(rows.span[v, r], k)
            error = abs(rows.e[v, r])
            if r < rows.slip.shape[1]:
                error += rows.lever[v, r] * abs(rows.slip[v, r])
            errors[s] = max(errors[s], error)
    for s in range(k):
        beyond += 1 if errors[s] > limit else 0
    return beyond


@compiled
def places_beside(
    samples: FloatArray, known: FloatArray, lap: float, numbers: FloatArray, k: int, closed: int, near: float
) -> tuple[float, FloatArray, FloatArray, FloatArray]:  # fmt: skip
    """The largest distance of a curve; (K, n, 2) its vertices; the places of the outline beside its knots, from the
    feet of the samples in the first master; and (K, 2, 2) the end tangents of an arc, derivatives by chord length.

    Args:
        samples, near: see :func:`measure`. known, lap: the places of samples, see :class:`Samples`.
        numbers: of the curve of k spans, see :func:`.spline_curve.tried_in`.
    """
    rows, n = empty_rows(len(samples), samples.shape[1]), samples.shape[1]
    p, tips, powers, h, _ = tried_in(numbers, len(samples), k, closed)
    worst = measure(samples, powers, h, closed, near, (False, rows.span, rows.x), rows)
    places, feet, own = np.empty(k + 1 - closed), np.empty(n + 1), np.empty(n + 1)
    for j in range(n):
        feet[j], own[j] = rows.span[0, j] + rows.x[0, j], known[j]
    feet[n], own[n] = feet[0] + k, own[0] + lap
    for i in range(k + 1 - closed):
        knot = i + k if closed and i < feet[0] else i
        j = int(np.searchsorted(feet[:n], knot, side="right")) - 1
        gap = feet[j + 1] - feet[j]
        places[i] = own[j] + ((knot - feet[j]) / gap if gap > 0 else 0.0) * (own[j + 1] - own[j])
    tangents = np.zeros((len(samples), 2, 2))
    if not closed:
        places[k] = own[n - 1]
        for v in range(len(samples)):
            for axis in range(2):
                tangents[v, 0, axis] = 3 * (tips[v, 0, axis] - p[v, 0, axis]) / h[2]
                tangents[v, 1, axis] = 3 * (p[v, k, axis] - tips[v, 1, axis]) / h[k + 1]
        return worst, p, places, tangents
    for i in range(1, k):
        if places[i] < places[0]:
            places[i] += lap
    back = lap if places[0] >= lap else 0.0
    for i in range(k):
        places[i] -= back
    return worst, p, places, tangents
