"""Chains of quadratics as TrueType stores them, from an outline of such: as few points, most of them implied.

Between two corners or lines, a *run*, all points on the curve become implied: midway between control points. There is
no kink there then, wherever the grid has these. Horizontal and vertical extrema cut a run into *sections*; the legs
there stay horizontal or vertical, at the source's height. Each section gets the fewest control points that follow it;
all points of the run are then moved together, rounded together, and certified as rounded. A section that fails is tried
again with more points, then with its ends on the curve, and in the end stays as the source has it, as does a run that
would have more points.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import directions, length
from ...curves.nearest import near_place
from ...curves.pairing import pair_span, room_for
from ...types import BoolArray, FloatArray, IntArray
from .corners import NO_HANDLE, Joints, find_joints
from .cubics import project, solve
from .font_curves import set_upright
from .lattice import turn_cost
from .settings import Settings

NEAR = (0.7, 0.35, 0.35, 0.0)
"""Of the tolerance: how near a section is to be before it is moved and rounded, on each try; 0 keeps it."""

EXPLICIT = 2
"""Tries from which the ends of a section are on the curve, as the source has them."""

ROUNDS, SWEEPS = 5, 4
"""Gauss-Newton steps, and visits of all control points on the grid."""

STEEP = np.radians(1.5)
"""Turn of a joint from which it stays where it is, with the turn it has."""

WORSE = np.radians(0.48)
"""Turn of a joint that a result may have where the source's is smaller."""


class Quads(NamedTuple):
    """The R quadratics of a run or section.

    Attributes:
        c: (R, 2) control points. node: (R + 1, 2) where they meet. implied: (R + 1,) midway between control points.
        freedom: (R,) 0 where a control point stays, 1 where it moves along a line, 2 elsewhere. along: (R, 2) the line.
        held: (R,) those of the source. lo: (R + 1,) samples at which they meet.
    """

    c: FloatArray
    node: FloatArray
    implied: BoolArray
    freedom: IntArray
    along: FloatArray
    held: BoolArray
    lo: IntArray


@compiled
def set_nodes(q: Quads) -> None:
    """Put the implied nodes where control points have them."""
    for s in range(1, len(q.c)):
        if q.implied[s]:
            for axis in range(2):
                q.node[s, axis] = (q.c[s - 1, axis] + q.c[s, axis]) / 2


@compiled
def as_cubic(q: Quads, s: int, out: FloatArray) -> None:
    """Quadratic s as a cubic (4, 2)."""
    for axis in range(2):
        a, b, c = q.node[s, axis], q.c[s, axis], q.node[s + 1, axis]
        out[0, axis], out[3, axis] = a, c
        out[1, axis], out[2, axis] = a + (b - a) * (2 / 3), c + (b - c) * (2 / 3)


@compiled
def distances(q: Quads, s: int, Q: FloatArray, x: FloatArray, e: FloatArray, c: FloatArray, p: FloatArray) -> float:
    """Pair the samples Q of quadratic s with points of it; the largest distance."""
    as_cubic(q, s, p)
    for axis in range(2):
        c[0, axis] = 3 * (p[1, axis] - p[0, axis])
        c[1, axis] = 3 * (p[2, axis] - 2 * p[1, axis] + p[0, axis])
        c[2, axis] = 0.0
    return project(Q, p[0, 0], p[0, 1], c, x, e)


@compiled
def weights_of(q: Quads, s: int, t: float, B: FloatArray) -> None:
    """(3,) how a point of quadratic s moves with the control point before it, its own, and the one behind it."""
    z = 1 - t
    B[0] = z * z / 2 if q.implied[s] else 0.0
    B[2] = t * t / 2 if q.implied[s + 1] else 0.0
    B[1] = 2 * z * t + B[0] + B[2]


@compiled
def across(
    q: Quads, s: int, t: float, c: FloatArray, p: FloatArray, x: float, y: float, B: FloatArray, row: FloatArray
) -> float:
    """How far the point (x, y) is off quadratic s, across it at its place t; inf where the curve stands still.

    Args:
        c, p: of quadratic s, see :func:`distances`. B: room. row: (6,) how the curve's own distance moves with the
            coordinates of the three control points of :func:`weights_of`.
    """
    dx, dy = 2 * c[1, 0] * t + c[0, 0], 2 * c[1, 1] * t + c[0, 1]
    size = length(dx, dy)
    if size <= 0.0:
        return np.inf
    nx, ny = -dy / size, dx / size
    weights_of(q, s, t, B)
    for i in range(3):
        row[2 * i], row[2 * i + 1] = B[i] * nx, B[i] * ny
    gap = nx * (x - (c[1, 0] * t + c[0, 0]) * t - p[0, 0])
    return gap + ny * (y - (c[1, 1] * t + c[0, 1]) * t - p[0, 1])


@compiled
def relax(q: Quads, samples: FloatArray, tolerance: float) -> float:
    """Move the control points nearest to the samples (N, 2), by least squares; the largest distance left."""
    R = len(q.c)
    n = 2 * R
    A, g, first = np.zeros((n, n)), np.zeros(n), np.zeros(n, dtype=np.int64)
    for k in range(n):
        first[k] = max(0, 2 * (k // 2 - 2))
    x, e, weight = np.empty(len(samples)), np.zeros(len(samples)), np.ones(len(samples))
    c, p, B, row = np.empty((3, 2)), np.empty((4, 2)), np.empty(3), np.empty(6)
    for s in range(R):
        for k in range(q.lo[s], q.lo[s + 1] + 1):
            x[k] = (k - q.lo[s]) / max(q.lo[s + 1] - q.lo[s], 1)
    worst = np.inf
    for m in range(ROUNDS + 1):
        A[:], g[:], worst = 0.0, 0.0, 0.0
        for s in range(R):
            a, b = q.lo[s], q.lo[s + 1]
            own = distances(q, s, samples[a : b + 1], x[a : b + 1], e[a : b + 1], c, p)
            worst = max(worst, own)
            if q.held[s] or m == ROUNDS:
                continue
            scale = 1 / max(b - a - 1, 1)
            for k in range(a + 1, b):
                gap = across(q, s, x[k], c, p, samples[k, 0], samples[k, 1], B, row)
                if gap == np.inf:
                    continue
                if m > 0 and own > 0.0:
                    weight[k] *= 0.3 + e[k] / own
                w = scale * weight[k]
                for i in range(3):
                    u = s - 1 + i
                    if u < 0 or u >= R:
                        continue
                    for ia in range(2):
                        g[2 * u + ia] += w * row[2 * i + ia] * gap
                        for j in range(i + 1):
                            v = s - 1 + j
                            if v < 0:
                                continue
                            for ja in range(2):
                                if 2 * v + ja <= 2 * u + ia:
                                    A[2 * u + ia, 2 * v + ja] += w * row[2 * i + ia] * row[2 * j + ja]
        if m == ROUNDS or worst <= 0.1 * tolerance:
            break
        for s in range(R):
            # Motion across a line is dear; all motion costs a little.
            tx, ty = q.along[s, 0], q.along[s, 1]
            free = q.freedom[s]
            for axis in range(2):
                A[2 * s + axis, 2 * s + axis] += 1e-3 if free > 0 else 1e6
            if free == 1:
                A[2 * s, 2 * s] += 1e6 * ty * ty
                A[2 * s + 1, 2 * s] -= 1e6 * tx * ty
                A[2 * s + 1, 2 * s + 1] += 1e6 * tx * tx
        solve(A, g, first, n)
        most = 0.0
        for s in range(R):
            if q.freedom[s] == 0 or q.held[s]:
                continue
            dx, dy = g[2 * s], g[2 * s + 1]
            if q.freedom[s] == 1:
                along = dx * q.along[s, 0] + dy * q.along[s, 1]
                dx, dy = along * q.along[s, 0], along * q.along[s, 1]
            size = length(dx, dy)
            leg = 0.5 * length(q.node[s + 1, 0] - q.node[s, 0], q.node[s + 1, 1] - q.node[s, 1])
            share = min(1.0, leg / max(size, 1e-12))
            q.c[s, 0] += share * dx
            q.c[s, 1] += share * dy
            most = max(most, share * size)
        set_nodes(q)
        if most < 0.02 * tolerance and m < ROUNDS - 1:
            continue
    return worst


@compiled
def meeting(p: FloatArray, px: float, py: float, r: FloatArray, rx: float, ry: float, out: FloatArray) -> None:
    """Where the line from p along (px, py) meets that from r along (rx, ry); midway if nowhere near."""
    x, y = r[0] - p[0], r[1] - p[1]
    cross, size = px * ry - py * rx, length(x, y)
    out[0], out[1] = (p[0] + r[0]) / 2, (p[1] + r[1]) / 2
    if abs(cross) > 0.02:
        s, t = (x * ry - y * rx) / cross, (x * py - y * px) / cross
        if 0.0 < s < 2.0 * size and -2.0 * size < t < 0.0:
            out[0], out[1] = p[0] + s * px, p[1] + s * py


@compiled
def try_section(
    samples: FloatArray, a: int, b: int, T: FloatArray, corner: BoolArray, count: int, tolerance: float, c: FloatArray,
    lo: IntArray,
) -> float:  # fmt: skip
    """Follow samples a to b by ``count`` quadratics, implied where they meet; the largest distance of a sample.

    Args:
        T: (2, 2) unit tangents at the ends. corner: (2,) whether these may turn.
        c: (count, 2) receives the control points. lo: (count + 1,) the samples at which they meet.
    """
    n = b - a
    turning = np.zeros(n + 1)
    for k in range(1, n):
        ax, ay = samples[a + k, 0] - samples[a + k - 1, 0], samples[a + k, 1] - samples[a + k - 1, 1]
        bx, by = samples[a + k + 1, 0] - samples[a + k, 0], samples[a + k + 1, 1] - samples[a + k, 1]
        turning[k] = turning[k - 1] + abs(np.arctan2(ax * by - ay * bx, ax * bx + ay * by)) + 1e-4
    turning[n] = turning[n - 1] + 1e-4
    lo[0], lo[count] = a, b
    for s in range(1, count):
        k = np.searchsorted(turning, turning[n] * s / count)
        lo[s] = a + min(max(k, lo[s - 1] - a + 2), n - 2 * (count - s))
        if lo[s] <= lo[s - 1] + 1:
            return np.inf
    q = Quads(
        c[:count], np.empty((count + 1, 2)), np.ones(count + 1, dtype=np.bool_), np.full(count, 2),
        np.zeros((count, 2)), np.zeros(count, dtype=np.bool_), lo[: count + 1],
    )  # fmt: skip
    tangents = np.empty((count + 1, 2))
    tangents[0], tangents[count] = T[0], T[1]
    for s in range(count + 1):
        q.node[s] = samples[lo[s]]
        if 0 < s < count:
            x, y = samples[lo[s] + 1, 0] - samples[lo[s] - 1, 0], samples[lo[s] + 1, 1] - samples[lo[s] - 1, 1]
            size = max(length(x, y), 1e-12)
            tangents[s, 0], tangents[s, 1] = x / size, y / size
    for s in range(count):
        meeting(
            q.node[s], tangents[s, 0], tangents[s, 1], q.node[s + 1], tangents[s + 1, 0], tangents[s + 1, 1], q.c[s]
        )
    q.implied[0] = q.implied[count] = False
    for s, end in ((0, 0), (count - 1, 1)):
        if not corner[end]:
            q.freedom[s] -= 1
            q.along[s] = T[end]
            out = q.c[s]
            # On its tangent, ahead of the end.
            x, y = out[0] - q.node[count * end, 0], out[1] - q.node[count * end, 1]
            along = x * T[end, 0] + y * T[end, 1]
            least = 0.05 * length(samples[b, 0] - samples[a, 0], samples[b, 1] - samples[a, 1]) / count
            along = min(along, -least) if end else max(along, least)
            if count > 1 or corner[1 - end]:
                out[0], out[1] = q.node[count * end, 0] + along * T[end, 0], q.node[count * end, 1] + along * T[end, 1]
    set_nodes(q)
    return relax(q, samples, tolerance)


@compiled
def round_quads(q: Quads, samples: FloatArray, tolerance: float, T: FloatArray, corner: BoolArray) -> None:
    """Round control points to the grid, each to the neighbour that leaves the outline least; lines stay lines."""
    R = len(q.c)
    forms, pulls, exact = np.zeros((R, 6, 6)), np.zeros((R, 6)), q.c.copy()
    x, e, c, p, B, row = (
        np.empty(len(samples)),
        np.empty(len(samples)),
        np.empty((3, 2)),
        np.empty((4, 2)),
        np.empty(3),
        np.empty(6),
    )
    for s in range(R):
        if q.held[s]:
            continue
        a, b = q.lo[s], q.lo[s + 1]
        for k in range(a, b + 1):
            x[k] = (k - a) / max(b - a, 1)
        distances(q, s, samples[a : b + 1], x[a : b + 1], e[a : b + 1], c, p)
        w = 1 / (max(b - a - 1, 1) * tolerance * tolerance)
        for k in range(a + 1, b):
            gap = across(q, s, x[k], c, p, samples[k, 0], samples[k, 1], B, row)
            if gap == np.inf:
                continue
            for i in range(6):
                pulls[s, i] -= w * gap * row[i]
                for j in range(6):
                    forms[s, i, j] += w * row[i] * row[j]
    for s in range(R):
        if q.freedom[s] > 0 and not q.held[s]:
            q.c[s] = np.rint(q.c[s])
    for _ in range(SWEEPS):
        changed = False
        for s in range(R):
            if q.freedom[s] == 0 or q.held[s]:
                continue
            tx, ty = q.along[s, 0], q.along[s, 1]
            upright = q.freedom[s] == 1 and (tx == 0.0 or ty == 0.0)
            x0, y0 = q.c[s, 0], q.c[s, 1]
            best_x, best_y, least = x0, y0, cost_of(q, s, exact, forms, pulls, T, corner)
            for code in range(25 if q.freedom[s] == 1 and not upright else 9):
                if code < 9:
                    u, v = code % 3 - 1.0, code // 3 - 1.0
                else:
                    u, v = code % 5 - 2.0, code // 5 - 2.0
                if upright and ((tx == 0.0 and u != 0.0) or (ty == 0.0 and v != 0.0)):
                    continue
                q.c[s, 0], q.c[s, 1] = x0 + u, y0 + v
                cost = cost_of(q, s, exact, forms, pulls, T, corner)
                if cost < least - 1e-9:
                    best_x, best_y, least, changed = x0 + u, y0 + v, cost, True
            q.c[s, 0], q.c[s, 1] = best_x, best_y
        if not changed:
            break
    set_nodes(q)


@compiled
def cost_of(
    q: Quads, s: int, exact: FloatArray, forms: FloatArray, pulls: FloatArray, T: FloatArray, corner: BoolArray
) -> float:
    """What changes with control point s: squared distances of three quadratics, and turns at nodes that are stored."""
    R, total = len(q.c), 0.0
    for t in range(max(s - 1, 0), min(s + 2, R)):
        if q.held[t]:
            continue
        for i in range(6):
            u = t - 1 + i // 2
            if u < 0 or u >= R:
                continue
            move = q.c[u, i % 2] - exact[u, i % 2]
            if move == 0.0:
                continue
            part = 2 * pulls[t, i]
            for j in range(6):
                v = t - 1 + j // 2
                if 0 <= v < R:
                    part += forms[t, i, j] * (q.c[v, j % 2] - exact[v, j % 2])
            total += move * part
    for k in (s, s + 1):
        if q.implied[k] or (k == 0 and corner[0]) or (k == R and corner[1]):
            continue
        ax, ay = q.node[k, 0] - q.c[k - 1, 0] if k > 0 else 0.0, q.node[k, 1] - q.c[k - 1, 1] if k > 0 else 0.0
        bx, by = q.c[k, 0] - q.node[k, 0] if k < R else 0.0, q.c[k, 1] - q.node[k, 1] if k < R else 0.0
        if k == 0:
            ax, ay = T[0, 0], T[0, 1]
        if k == R:
            bx, by = T[1, 0], T[1, 1]
        if (ax == 0.0 and ay == 0.0) or (bx == 0.0 and by == 0.0):
            total += 1e6
        else:
            total += turn_cost(np.arctan2(ax * by - ay * bx, ax * bx + ay * by))
    return total


@compiled
def fit_run(
    cubics: FloatArray, line: BoolArray, joints: Joints, upright: BoolArray, i: int, j: int, tolerance: float,
    points: FloatArray, on: BoolArray, reached: FloatArray,
) -> int:  # fmt: skip
    """Points of the quadratics from joint i to joint j, without the last.

    Args:
        cubics: (m, 4, 2) the source. line: (m,) which of them are lines.
        points: (…, 2) receives them; on: whether they are on the curve.
        reached: (2,) the first receives the certified distance if it is larger.

    Returns:
        Their number, at most that of the source.
    """
    n, samples = j - i, joints.samples[0]
    controls, implied = np.empty((n, 2)), np.zeros(n + 1, dtype=np.bool_)
    for k in range(n):
        for axis in range(2):
            controls[k, axis] = np.rint((3 * cubics[i + k, 1, axis] - cubics[i + k, 0, axis]) / 2)
    own = 1
    for k in range(1, n):
        implied[k] = True
        for axis in range(2):
            middle = (controls[k - 1, axis] + controls[k, axis]) / 2
            implied[k] = implied[k] and abs(middle - cubics[i + k, 0, axis]) < 1e-6
        own += 0 if implied[k] else 1
    own += n
    ends = np.empty(n + 1, dtype=np.int64)
    ends[0], S = 0, 0
    for k in range(1, n + 1):
        if k == n or upright[i + k]:
            S += 1
            ends[S] = k
    tries, corner, T = np.zeros(S, dtype=np.int64), np.empty(2, dtype=np.bool_), np.empty((2, 2))
    outer, outer_T = np.empty(2, dtype=np.bool_), np.empty((2, 2))
    outer[0], outer[1] = joints.corner[i], joints.corner[j]
    outer_T[0], outer_T[1] = joints.leaving[0, i], joints.arriving[0, j]
    c, lo, room = np.empty((n + 2, 2)), np.empty(n + 3, dtype=np.int64), n + S + 2
    for _ in range(8 if n > 1 else 0):
        q = Quads(
            np.empty((room, 2)), np.empty((room + 1, 2)), np.ones(room + 1, dtype=np.bool_), np.full(room, 2),
            np.zeros((room, 2)), np.zeros(room, dtype=np.bool_), np.zeros(room + 1, dtype=np.int64),
        )  # fmt: skip
        owner, R = np.empty(room, dtype=np.int64), 0
        for f in range(S):
            a, b = ends[f], ends[f + 1]
            first, last = joints.first[i + a], joints.first[i + b]
            corner[0], corner[1] = outer[0] and f == 0, outer[1] and f == S - 1
            T[0], T[1] = joints.leaving[0, i + a], joints.arriving[0, i + b]
            near, count = NEAR[tries[f]] * tolerance, 1
            while near > 0.0 and count < b - a:
                if try_section(samples, first, last, T, corner, count, near, c, lo) <= near:
                    break
                count += 1
            start = R
            if near > 0.0 and (count < b - a or tries[f] < 1):
                if count == b - a:
                    for k in range(count):
                        c[k], lo[k] = controls[a + k], joints.first[i + a + k]
                    lo[count] = last
                for s in range(count):
                    q.c[R], q.lo[R], owner[R] = c[s], lo[s], f
                    if s > 0:
                        q.implied[R] = True
                    R += 1
                for s, end in ((start, 0), (R - 1, 1)):
                    if not corner[end]:
                        q.freedom[s] -= 1
                        q.along[s] = T[end]
                if start + 1 == R and q.freedom[start] == 0:
                    meeting(samples[first], T[0, 0], T[0, 1], samples[last], T[1, 0], T[1, 1], q.c[start])
            else:
                for k in range(a, b):
                    q.c[R], q.lo[R], owner[R], q.held[R], q.freedom[R] = controls[k], joints.first[i + k], f, True, 0
                    q.implied[R] = implied[k]
                    if not implied[k]:
                        q.node[R] = cubics[i + k, 0]
                    R += 1
            q.node[start] = samples[first]
            stay = f > 0 and (tries[f] >= EXPLICIT or tries[f - 1] >= EXPLICIT)
            q.implied[start] = f > 0 and (not stay or implied[a])
            q.lo[R], q.node[R], q.implied[R] = last, samples[last], False
        q = Quads(q.c[:R], q.node[: R + 1], q.implied[: R + 1], q.freedom[:R], q.along[:R], q.held[:R], q.lo[: R + 1])
        set_nodes(q)
        relax(q, samples, tolerance)
        round_quads(q, samples, tolerance, outer_T, outer)
        stored = R + 1
        for s in range(1, R):
            stored += 0 if q.implied[s] else 1
        bad = far_quads(q, cubics, joints, i, j, tolerance, reached)
        turned(q, cubics, line, joints, i, j, bad)
        for s in range(R):
            for axis in range(2):
                # Where two tangents meet is seldom on the grid.
                bad[s] = bad[s] or abs(q.c[s, axis] - np.rint(q.c[s, axis])) > 1e-6
                q.c[s, axis] = np.rint(q.c[s, axis])
        for s in range(1, R):
            if not q.implied[s]:
                ax, ay = q.node[s, 0] - q.c[s - 1, 0], q.node[s, 1] - q.c[s - 1, 1]
                bx, by = q.c[s, 0] - q.node[s, 0], q.c[s, 1] - q.node[s, 1]
                if abs(np.arctan2(ax * by - ay * bx, ax * bx + ay * by)) > WORSE and not (q.held[s] and q.held[s - 1]):
                    bad[s] = bad[s - 1] = True
        wrong = False
        for f in range(S):
            failed = False
            for s in range(R):
                failed = failed or (owner[s] == f and bad[s] and not q.held[s])
            if failed:
                tries[f], wrong = min(tries[f] + 1, len(NEAR) - 1), True
            moved = False
            for s in range(R):
                moved = moved or (owner[s] == f and bad[s] and q.held[s])
            if moved and tries[f] < EXPLICIT:
                tries[f], wrong = EXPLICIT, True
            elif moved:
                # What is implied in the source moves with the control point beyond: both stay.
                wrong = True
                for k in range(max(f - 1, 0), min(f + 2, S)):
                    tries[k] = len(NEAR) - 1
        if not wrong:
            if stored >= own:
                break
            reached[0] = max(reached[0], reached[1])
            at = 0
            for s in range(R):
                if s == 0 or not q.implied[s]:
                    points[at], on[at] = q.node[s], True
                    at += 1
                points[at], on[at] = q.c[s], False
                at += 1
            return at
    at = 0
    for k in range(n):
        if k == 0 or not implied[k]:
            points[at], on[at] = cubics[i + k, 0], True
            at += 1
        points[at], on[at] = controls[k], False
        at += 1
    return at


@compiled
def turned(q: Quads, cubics: FloatArray, line: BoolArray, joints: Joints, i: int, j: int, bad: BoolArray) -> None:
    """Mark the first and last quadratic of a run if the end turns more than it may, or is a corner no more."""
    R, m = len(q.c), len(cubics)
    for end in range(2):
        k, s = (j if end else i) % m, (R - 1) * end
        before, behind = cubics[k - 1], cubics[k]
        ax, ay = before[3, 0] - before[2, 0], before[3, 1] - before[2, 1]
        bx, by = behind[1, 0] - behind[0, 0], behind[1, 1] - behind[0, 1]
        old = abs(np.arctan2(ax * by - ay * bx, ax * bx + ay * by))
        tx, ty = (ax, ay) if end else (bx, by)
        if end:
            ax, ay = x, y = q.node[R, 0] - q.c[s, 0], q.node[R, 1] - q.c[s, 1]
        else:
            bx, by = x, y = q.c[s, 0] - q.node[s, 0], q.c[s, 1] - q.node[s, 1]
        new = abs(np.arctan2(ax * by - ay * bx, ax * bx + ay * by))
        wrong = new < min(old, np.radians(12.5)) if joints.corner[k] else new > max(old, WORSE)
        if not line[k] and not line[k - 1]:  # the run on the other side may turn as much
            own = abs(np.arctan2(tx * y - ty * x, tx * x + ty * y))
            wrong = own > WORSE / 2 and (not joints.corner[k] or old - 2 * own < np.radians(12.5))
        bad[s] = bad[s] or (wrong and not q.held[s])


@compiled
def far_quads(
    q: Quads, source: FloatArray, joints: Joints, i: int, j: int, tolerance: float, reached: FloatArray
) -> BoolArray:
    """(R,) which quadratics are not certified within the tolerance of the source (m, 4, 2)."""
    R = len(q.c)
    P, places, bad = np.empty((R, 4, 2)), np.empty(R + 1), np.zeros(R, dtype=np.bool_)
    work, marks, found = room_for(1)
    reached[1] = 0.0
    for s in range(R):
        as_cubic(q, s, P[s])
    for s in range(R + 1):
        places[s] = joints.places[q.lo[s]]
    places[0], places[R] = i, j
    hints = places.copy()
    for s in range(1, R):
        places[s] = near_place(1, source, hints[s], (hints[s - 1] + hints[s]) / 2, (hints[s] + hints[s + 1]) / 2, P, s)
    for s in range(R):
        found[:] = 0.0
        pair_span(
            1, P, s, 0.0, 1.0, source, places[s], places[s + 1], np.empty(0), True, tolerance, 0.02 * tolerance, work,
            marks, found,
        )  # fmt: skip
        bad[s], reached[1] = not found[0] <= 0.999 * tolerance, max(reached[1], found[0])
    return bad


@compiled
def fit_contour(
    cubics: FloatArray, degrees: IntArray, settings: Settings, tolerance: float
) -> tuple[FloatArray, BoolArray, float]:
    """The points of a contour (m, 4, 2) of lines and quadratics, whether they are on the curve, and how far it moved.

    None if there is neither a corner nor an extremum on the grid at which it could begin.
    """
    m, k, reached = len(cubics), 0, np.zeros(2)
    joints = find_joints(cubics.reshape(1, m, 4, 2), degrees, settings)
    cuts, upright = cut_joints(cubics, degrees, joints)
    while k < m and not cuts[k]:
        k += 1
    if k == m:
        k = 0
        while k < m and not (upright[k] and is_whole(cubics[k, 0])):
            k += 1
        if k == m:
            return np.empty((0, 2)), np.empty(0, dtype=np.bool_), 0.0
    if k > 0:
        cubics, degrees = np.concatenate((cubics[k:], cubics[:k])), np.roll(degrees, -k)
        joints = find_joints(cubics.reshape(1, m, 4, 2), degrees, settings)
        cuts, upright = cut_joints(cubics, degrees, joints)
    line = degrees == 1
    points, on, count, i = np.empty((2 * m, 2)), np.empty(2 * m, dtype=np.bool_), 0, 0
    while i < m:
        j = i + 1
        while j < m and not cuts[j]:
            j += 1
        if degrees[i] == 1:
            points[count], on[count] = cubics[i, 0], True
            count += 1
        else:
            count += fit_run(cubics, line, joints, upright, i, j, tolerance, points[count:], on[count:], reached)
        i = j
    return points[:count], on[:count], reached[0]


@compiled
def is_whole(p: FloatArray) -> bool:
    """Whether a point is on the grid."""
    return p[0] == np.rint(p[0]) and p[1] == np.rint(p[1])


@compiled
def cut_joints(cubics: FloatArray, degrees: IntArray, joints: Joints) -> tuple[BoolArray, BoolArray]:
    """(m + 1,) the joints at which runs end: corners, kinks, ends of lines; their tangents stay as they are.

    And the joints at which the outline has a horizontal or vertical extremum.
    """
    m = len(cubics)
    upright, cuts = set_upright(cubics, joints), joints.corner.copy()
    for j in range(m):
        bx, by, _, _ = directions(cubics, j, NO_HANDLE)
        _, _, ax, ay = directions(cubics, j - 1, NO_HANDLE)
        turn = abs(np.arctan2(ax * by - ay * bx, ax * bx + ay * by))
        cuts[j] = cuts[j] or degrees[j] == 1 or degrees[j - 1] == 1 or turn > STEEP
        if cuts[j]:
            one, two = length(ax, ay), length(bx, by)
            joints.arriving[0, j, 0], joints.arriving[0, j, 1] = ax / one, ay / one
            joints.leaving[0, j, 0], joints.leaving[0, j, 1] = bx / two, by / two
    cuts[m] = cuts[0]
    joints.arriving[0, m], joints.leaving[0, m] = joints.arriving[0, 0], joints.leaving[0, 0]
    return cuts, upright
