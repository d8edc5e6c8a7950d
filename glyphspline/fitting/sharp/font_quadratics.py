"""Chains of quadratics as TrueType stores them: as few points as follow an outline, most of them implied.

Between two corners or lines, a *run*, all points on the curve become implied: midway between control points. There is
no kink there then, wherever the grid has these. Horizontal and vertical extrema cut a run into *sections*; the legs
there stay horizontal or vertical, at the source's height. Each section gets the fewest control points that follow it;
all points of the run are then moved together. Those that are to lie on the tangents at its ends take places on the grid
in that direction, the others are moved once more, rounded together, and certified as rounded.

A section that fails is tried again with more points. Where the source is one of quadratics on the grid, it is tried
with its ends on the curve too, and in the end stays as the source has it, as does a run that would have more points.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import directions, length
from ...outlines.segments import farthest_joint
from ...types import BoolArray, FloatArray, IntArray
from .corners import NO_HANDLE, SMOOTH_KINK, Joints, find_joints
from .cubics import solve
from .font_curves import CORNER, set_upright, turn_between
from .nearness import add_samples, certified, feet, reweight, squares
from .settings import Settings

NEAR = (0.7, 0.35, 0.35, 0.0)
"""Of the tolerance: how near a section of a source of quadratics on the grid is to be before it is rounded, on each
try; 0 keeps it."""

OTHERS, MORE = (0.7, 0.7, 0.5, 0.5, 0.7, 0.5, 0.35), (0, 1, 0, 1, 0, 1, 2)
"""The same for other sources, which have nothing to keep; and quadratics beyond the fewest."""

EXPLICIT, LOOSE = 2, 4
"""Tries from which the ends of a section are on the curve; and from which it may turn at the ends of its run, where the
grid has no control point near enough."""

MOST = 4
"""Quadratics for a cubic, and twice as many for a section."""

ROUNDS, SWEEPS = 5, 4
"""Gauss-Newton steps, and visits of all control points on the grid."""

ATTEMPTS = 8
"""Tries of a run."""

DAMPING = 0.03
"""Weight of control points' motion, as far as samples leave a choice: along the curve they would lose their order."""

STEEP = np.radians(1.5)
"""Turn of a joint from which it stays where it is, with the turn it has."""

WORSE = np.radians(0.48)
"""Turn of a joint that a result may have where the source's is smaller."""

FOLD = 1e3
"""What it costs if the order of control points is lost, in mean squares of distance at the tolerance."""

BLUNT = np.radians(20.0)
"""Turn from which a corner's sides may turn; less would soon be a kink."""


class Given(NamedTuple):
    """A contour of m segments.

    Attributes:
        cubics: (m, 4, 2). line: (m,). joints: of it. slack: (m + 1,) the turn of each that is no new kink. level:
            (m + 1,) whether a curve there is to begin or end along a line.
        cuts: (m + 1,) the joints at which runs end: corners, kinks, ends of lines. upright: (m + 1,) those at which it
            has a horizontal or vertical extremum.
        stored: whether it is of quadratics on the grid. controls: (m, 2), implied: (m,) whether a joint is midway.
    """

    cubics: FloatArray
    line: BoolArray
    joints: Joints
    slack: FloatArray
    level: BoolArray
    cuts: BoolArray
    upright: BoolArray
    stored: bool
    controls: FloatArray
    implied: BoolArray


class Quads(NamedTuple):
    """The R quadratics of a run or section.

    Attributes:
        c: (R, 2) control points. node: (R + 1, 2) where they meet. implied: (R + 1,) midway between control points.
        T: (R + 1, 2) unit tangents at nodes. tied: (R, 2) whether a control point is on that of its start, or end.
        beyond: (R + 1, 2) where tied, unit tangents beyond the node. slack: (R + 1,) turn from these that is no kink.
        fixed: (R,) control points that do not move. held: (R,) quadratics of the source.
        owner: (R,) their sections. lo: (R + 1,) samples at which they meet.
    """

    c: FloatArray
    node: FloatArray
    implied: BoolArray
    T: FloatArray
    beyond: FloatArray
    slack: FloatArray
    tied: BoolArray
    fixed: BoolArray
    held: BoolArray
    owner: IntArray
    lo: IntArray


@compiled
def part(q: Quads, a: int, b: int) -> Quads:
    """Quadratics a to b - 1 of some."""
    n = b + 1
    return Quads(
        q.c[a:b], q.node[a:n], q.implied[a:n], q.T[a:n], q.beyond[a:n], q.slack[a:n], q.tied[a:b], q.fixed[a:b],
        q.held[a:b], q.owner[a:b], q.lo[a:n],
    )  # fmt: skip


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
def set_moves(q: Quads, s: int, J: FloatArray) -> None:
    """How the control points before, of and behind quadratic s move the points of its cubic: J (4, 2, 6)."""
    a, b = 0.5 if q.implied[s] else 0.0, 0.5 if q.implied[s + 1] else 0.0
    J[:] = 0.0
    for axis in range(2):
        one, two, three = axis, 2 + axis, 4 + axis
        J[0, axis, one], J[0, axis, two] = a, a
        J[1, axis, one], J[1, axis, two] = a / 3, (a + 2) / 3
        J[2, axis, two], J[2, axis, three] = (b + 2) / 3, b / 3
        J[3, axis, two], J[3, axis, three] = b, b


@compiled
def relax(q: Quads, samples: FloatArray, enough: float) -> float:
    """Move the control points nearest to the samples (N, 2), by least squares; the largest distance left.

    Args:
        enough: the distance that ends this.
    """
    R, N = len(q.c), len(samples)
    n = 2 * R
    A, g, first = np.zeros((n, n)), np.zeros(n), np.zeros(n, dtype=np.int64)
    for k in range(n):
        first[k] = max(0, 2 * (k // 2 - 2))
    x, e, weight = np.empty(N), np.zeros(N), np.ones(N)
    c, p, J, own = np.empty((3, 2)), np.empty((4, 2)), np.empty((4, 2, 6)), np.empty((6, 7))
    for s in range(R):
        for k in range(q.lo[s], q.lo[s + 1] + 1):
            x[k] = (k - q.lo[s]) / max(q.lo[s + 1] - q.lo[s], 1)
    m = 0
    while True:
        A[:], g[:], worst = 0.0, 0.0, 0.0
        for s in range(R):
            a, b = q.lo[s], q.lo[s + 1] + 1
            as_cubic(q, s, p)
            far = feet(p, samples[a:b], c, x[a:b], e[a:b])
            worst = max(worst, far)
            if q.held[s] or m == ROUNDS:
                continue
            if m > 0 and far > 0.0:
                reweight(weight[a:b], e[a:b], far)
            set_moves(q, s, J)
            own[:] = 0.0
            add_samples(p, c, samples[a:b], x[a:b], weight[a:b], J, 1.0, own)
            for u in range(6):
                at = 2 * s - 2 + u
                if 0 <= at < n:
                    g[at] += own[u, 6]
                    for v in range(max(0, 2 - 2 * s), u + 1):
                        A[at, at - u + v] += own[u, v]
        if m == ROUNDS or worst <= enough:
            return worst
        for s in range(R):
            # Motion across a tangent is dear; all motion costs a little.
            for axis in range(2):
                A[2 * s + axis, 2 * s + axis] += 1e6 if q.fixed[s] else DAMPING
            for end in range(2):
                if q.tied[s, end]:
                    tx, ty = q.T[s + end]
                    A[2 * s, 2 * s] += 1e6 * ty * ty
                    A[2 * s + 1, 2 * s] -= 1e6 * tx * ty
                    A[2 * s + 1, 2 * s + 1] += 1e6 * tx * tx
        solve(A, g, first, n)
        for s in range(R):
            if q.tied[s, 0] and q.tied[s, 1]:
                continue
            dx, dy = g[2 * s], g[2 * s + 1]
            leg = 0.5 * length(q.node[s + 1, 0] - q.node[s, 0], q.node[s + 1, 1] - q.node[s, 1])
            share = min(1.0, leg / max(length(dx, dy), 1e-12))
            push(q, s, share * dx, share * dy)
        for s in range(R + 1):
            if q.implied[s]:
                lack = (1.0 - ahead(q.c, q.T, s)) / 2
                if lack > 0.0:
                    push(q, s - 1, -lack * q.T[s, 0], -lack * q.T[s, 1])
                    push(q, s, lack * q.T[s, 0], lack * q.T[s, 1])
                continue
            for u, sign in ((s - 1, -1.0), (s, 1.0)):
                if 0 <= u < R:
                    dx, dy = q.c[u, 0] - q.node[s, 0], q.c[u, 1] - q.node[s, 1]
                    lack = 1.0 - sign * (dx * q.T[s, 0] + dy * q.T[s, 1])
                    if lack > 0.0:
                        push(q, u, sign * lack * q.T[s, 0], sign * lack * q.T[s, 1])
        set_nodes(q)
        for s in range(1, R):
            if not (q.held[s - 1] or q.held[s]):
                share_samples(q, s, samples, x)
        m += 1


@compiled
def push(q: Quads, s: int, dx: float, dy: float) -> None:
    """Move a control point by as much of a vector as it may."""
    if q.fixed[s]:
        return
    for end in range(2):
        if q.tied[s, end]:
            tx, ty = q.T[s + end]
            along = dx * tx + dy * ty
            dx, dy = along * tx, along * ty
    q.c[s, 0] += dx
    q.c[s, 1] += dy


@compiled
def ahead(c: FloatArray, T: FloatArray, s: int) -> float:
    """How far control point s is ahead of the one before it, along the tangent between them."""
    return (c[s, 0] - c[s - 1, 0]) * T[s, 0] + (c[s, 1] - c[s - 1, 1]) * T[s, 1]


@compiled
def share_samples(q: Quads, s: int, samples: FloatArray, x: FloatArray) -> None:
    """Let the quadratics before and behind node s meet at the sample nearest to it, and their feet be even again."""
    before, a, b = q.lo[s], q.lo[s - 1], q.lo[s + 1]
    for step in (-1, 1):
        while a + 2 <= q.lo[s] + step <= b - 2:
            k, o = q.lo[s], q.lo[s] + step
            near = length(samples[k, 0] - q.node[s, 0], samples[k, 1] - q.node[s, 1])
            if length(samples[o, 0] - q.node[s, 0], samples[o, 1] - q.node[s, 1]) >= near:
                break
            q.lo[s] = o
    if q.lo[s] != before:
        k = q.lo[s]
        if not q.tied[s, 0]:
            set_tangent(samples, k, q.T[s])
        for k in range(a + 1, b):
            first, last = (a, q.lo[s]) if k < q.lo[s] else (q.lo[s], b)
            x[k] = (k - first) / (last - first)


@compiled
def set_tangent(samples: FloatArray, k: int, out: FloatArray) -> None:
    """The unit tangent at a sample."""
    x, y = samples[k + 1, 0] - samples[k - 1, 0], samples[k + 1, 1] - samples[k - 1, 1]
    size = max(length(x, y), 1e-12)
    out[0], out[1] = x / size, y / size


@compiled
def meeting(p: FloatArray, a: FloatArray, r: FloatArray, b: FloatArray, out: FloatArray) -> None:
    """Where the line from p along a meets that from r along b; midway if nowhere near."""
    x, y = r[0] - p[0], r[1] - p[1]
    cross, size = a[0] * b[1] - a[1] * b[0], length(x, y)
    out[0], out[1] = (p[0] + r[0]) / 2, (p[1] + r[1]) / 2
    if abs(cross) > 0.02:
        s, t = (x * b[1] - y * b[0]) / cross, (x * a[1] - y * a[0]) / cross
        if 0.0 < s < 2.0 * size and -2.0 * size < t < 0.0:
            out[0], out[1] = p[0] + s * a[0], p[1] + s * a[1]


@compiled
def set_ends(q: Quads, given: Given, a: int, b: int) -> None:
    """Give quadratics from joint a to joint b the tangents there, and beyond."""
    arriving, leaving, R = given.joints.arriving[0], given.joints.leaving[0], len(q.c)
    q.slack[:], q.slack[0], q.slack[R] = WORSE, given.slack[a], given.slack[b]
    q.T[0], q.beyond[0], q.T[R], q.beyond[R] = leaving[a], arriving[a], arriving[b], leaving[b]


@compiled
def begin(q: Quads, given: Given, a: int, b: int, level: bool) -> bool:
    """Begin with quadratics from joint a to joint b, as many as q has; False if samples are too few.

    Args:
        level: whether they begin and end along lines where they may.
    """
    joints, samples, count = given.joints, given.joints.samples[0], len(q.c)
    first, last = joints.first[a], joints.first[b]
    n = last - first
    # Quadratics are short where the outline turns, and none is much longer than its neighbours.
    x_before = y_before = 0.0
    sizes, bends, at = np.empty(n), np.zeros(n + 1), np.zeros(n + 1)
    for k in range(n):
        x, y = samples[first + k + 1, 0] - samples[first + k, 0], samples[first + k + 1, 1] - samples[first + k, 1]
        sizes[k] = length(x, y)
        if k > 0:
            bends[k] = turn_between(x_before, y_before, x, y)
        x_before, y_before = x, y
    total, turn = max(sizes.sum(), 1e-12), max(bends.sum(), 1e-6)
    for k in range(n):
        share = sizes[k] / total
        at[k + 1] = at[k] + np.sqrt((bends[k] + bends[k + 1]) / 2 / turn * share) + 0.1 * share
    q.lo[0], q.lo[count] = first, last
    for s in range(1, count):
        k = np.searchsorted(at, at[n] * s / count)
        q.lo[s] = first + min(max(k, q.lo[s - 1] - first + 2), n - 2 * (count - s))
        if q.lo[s] <= q.lo[s - 1] + 1:
            return False
    set_ends(q, given, a, b)
    if level and given.level[a]:
        q.T[0] = q.beyond[0]
    if level and given.level[b]:
        q.T[count] = q.beyond[count]
    q.tied[:], q.fixed[:], q.held[:], q.implied[:] = False, False, False, True
    q.implied[0] = q.implied[count] = False
    q.tied[0, 0], q.tied[count - 1, 1] = not joints.corner[a], not joints.corner[b]
    for s in range(count + 1):
        k = q.lo[s]
        q.node[s] = samples[k]
        if 0 < s < count:
            set_tangent(samples, k, q.T[s])
    q.node[0], q.node[count] = np.rint(q.node[0]), np.rint(q.node[count])
    least = 0.05 * length(q.node[count, 0] - q.node[0, 0], q.node[count, 1] - q.node[0, 1]) / count
    for s in range(count):
        meeting(q.node[s], q.T[s], q.node[s + 1], q.T[s + 1], q.c[s])
    for s, end in ((0, 0), (count - 1, 1)):
        if q.tied[s, end] and not q.tied[s, 1 - end]:
            # On its tangent, ahead of the end.
            p, (tx, ty) = q.node[s + end], q.T[s + end]
            along = (q.c[s, 0] - p[0]) * tx + (q.c[s, 1] - p[1]) * ty
            along = min(along, -least) if end else max(along, least)
            q.c[s, 0], q.c[s, 1] = p[0] + along * tx, p[1] + along * ty
    set_nodes(q)
    return True


@compiled
def fewest(
    q: Quads, R: int, given: Given, a: int, b: int, near: float, most: int, level: bool
) -> tuple[int, bool]:  # fmt: skip
    """The number of quadratics, at most ``most``, that follow joints a to b; and whether they are so near."""
    for count in range(1, most + 1):
        own = part(q, R, R + count)
        if not begin(own, given, a, b, level):
            return count - 1, False
        if relax(own, given.joints.samples[0], near / 2) <= near:
            return count, True
    return most, False


@compiled
def assembled(given: Given, ends: IntArray, tries: IntArray, tolerance: float) -> Quads:
    """The quadratics of the sections between the joints ``ends`` of a run, each as its tries say."""
    S, samples = len(tries), given.joints.samples[0]
    room, R = MOST * (ends[S] - ends[0] + 2 * S), 0
    q = Quads(
        np.empty((room, 2)), np.empty((room + 1, 2)), np.ones(room + 1, np.bool_), np.zeros((room + 1, 2)),
        np.zeros((room + 1, 2)), np.full(room + 1, WORSE), np.zeros((room, 2), np.bool_), np.zeros(room, np.bool_),
        np.zeros(room, np.bool_), np.empty(room, np.int64), np.empty(room + 1, np.int64),
    )  # fmt: skip
    for f in range(S):
        a, b = ends[f], ends[f + 1]
        near, found = (NEAR[tries[f]] if given.stored else OTHERS[tries[f]]) * tolerance, False
        most, count, level = b - a - 1 if given.stored else MOST * (b - a + 1), 0, False
        if near > 0.0:
            count, found = fewest(q, R, given, a, b, near, most, False)
            if tries[f] < EXPLICIT and (given.level[a] or given.level[b]):
                own_count, level = fewest(q, R, given, a, b, near, min(count + 1, most), True)
                count, found = (own_count, True) if level else (count, found)
        if given.stored and not found:
            keep = near == 0.0 or tries[f] > 0
            count = b - a
            own = part(q, R, R + count)
            own.tied[:], own.fixed[:], own.held[:] = False, keep, keep
            own.c[:], own.lo[:], own.implied[:] = given.controls[a:b], given.joints.first[a : b + 1], True
            set_ends(own, given, a, b)
            if not keep:
                own.tied[0, 0], own.tied[count - 1, 1] = not given.joints.corner[a], not given.joints.corner[b]
            for k in range(count):
                if k == 0 or (keep and not given.implied[a + k]):
                    own.implied[k], own.node[k] = False, given.cubics[a + k, 0]
            own.implied[count], own.node[count] = False, given.cubics[b - 1, 3]
        elif not given.stored:
            count += MORE[tries[f]] if found else 0
            while not begin(part(q, R, R + count), given, a, b, level):
                count -= 1
            relax(part(q, R, R + count), samples, near / 2)
        else:
            begin(part(q, R, R + count), given, a, b, level)
            relax(part(q, R, R + count), samples, near / 2)
        stay = f > 0 and max(tries[f], tries[f - 1]) >= EXPLICIT
        q.implied[R] = f > 0 and (not stay or given.implied[a])
        q.owner[R : R + count] = f
        R += count
    q = part(q, 0, R)
    set_nodes(q)
    return q


@compiled
def aim(q: Quads, tries: IntArray) -> bool:
    """Put control points on tangents that are not the axes' on the grid, as nearly in that direction; whether any."""
    aimed = False
    for s in range(len(q.c)):
        both = q.tied[s, 0] and q.tied[s, 1]
        for end in range(2):
            if q.fixed[s] or not q.tied[s, end]:
                continue
            sign, (tx, ty), p = 1.0 - 2.0 * end, q.T[s + end], q.node[s + end]
            if (tx == 0.0 or ty == 0.0) and not both:
                continue
            tx, ty = sign * tx, sign * ty
            steep = abs(ty) > abs(tx)
            wanted = max((q.c[s, 0] - p[0]) * tx + (q.c[s, 1] - p[1]) * ty, 1.0)
            main, other = (ty, tx) if steep else (tx, ty)
            least, best_x, best_y = np.inf, q.c[s, 0], q.c[s, 1]
            for code in range(25 if both else int(2 * wanted) + 12):
                if both:
                    x, y = np.rint(q.c[s, 0]) - p[0] + code % 5 - 2, np.rint(q.c[s, 1]) - p[1] + code // 5 - 2
                else:
                    v, w = np.sign(main) * (code + 1), np.rint((code + 1) * other / abs(main))
                    x, y = (w, v) if steep else (v, w)
                along = (x * tx + y * ty - wanted) / (0.3 * wanted + 1.0)
                price = 0.5 if tries[q.owner[s]] >= LOOSE else 100.0
                cost = along * along + off_tangent(q, s + end, sign * x, sign * y, price)
                if both:
                    r = q.node[s + 1]
                    cost += off_tangent(q, s + 1, r[0] - p[0] - x, r[1] - p[1] - y, price)
                if cost < least:
                    least, best_x, best_y = cost, p[0] + x, p[1] + y
            q.c[s, 0], q.c[s, 1], q.fixed[s], aimed = best_x, best_y, True, True
    set_nodes(q)
    return aimed


@compiled
def is_kink(q: Quads, s: int, x: float, y: float) -> bool:
    """Whether a leg (x, y) makes node s a kink that the source has not there."""
    turn = turn_between(x, y, q.beyond[s, 0], q.beyond[s, 1])
    return turn > q.slack[s] + 1e-9 or turn < CORNER < q.slack[s]


@compiled
def off_tangent(q: Quads, s: int, x: float, y: float, price: float) -> float:
    """What a leg (x, y) beside the tangent at node s costs; where it turns from what is beyond, the price."""
    off, turn = turn_between(x, y, q.T[s, 0], q.T[s, 1]), turn_between(x, y, q.beyond[s, 0], q.beyond[s, 1])
    return price * (0.005 * (off / WORSE) ** 2 + (max(turn, off) / WORSE if is_kink(q, s, x, y) else 0.0))


@compiled
def round_quads(q: Quads, samples: FloatArray, tolerance: float) -> None:
    """Round control points to the grid, each to the neighbour that leaves the outline least; tangents that are axes
    stay so."""
    R = len(q.c)
    # A row before the first control point, and one behind the last.
    points, own, rest = np.zeros((R + 2, 2)), np.zeros((R, 6, 7)), np.zeros(R)
    points[1 : R + 1] = q.c
    exact, c, p, J = points.copy(), np.empty((3, 2)), np.empty((4, 2)), np.empty((4, 2, 6))
    for s in range(R):
        if not q.held[s]:
            a, n = q.lo[s], q.lo[s + 1] + 1 - q.lo[s]
            Q, x = samples[a : a + n], np.arange(n) / max(n - 1, 1)
            as_cubic(q, s, p)
            feet(p, Q, c, x, np.empty(n))
            set_moves(q, s, J)
            rest[s] = add_samples(p, c, Q, x, np.ones(n), J, tolerance, own[s])
        if not q.fixed[s]:
            points[s + 1] = np.rint(points[s + 1])
    for _ in range(SWEEPS):
        changed = False
        for s in range(R):
            if q.fixed[s]:
                continue
            still_x = (q.tied[s, 0] and q.T[s, 0] == 0.0) or (q.tied[s, 1] and q.T[s + 1, 0] == 0.0)
            still_y = (q.tied[s, 0] and q.T[s, 1] == 0.0) or (q.tied[s, 1] and q.T[s + 1, 1] == 0.0)
            x0, y0 = points[s + 1]
            best_x, best_y, least = x0, y0, np.inf
            for code in range(9):
                u, v = (0.0, 1.0, -1.0)[code % 3], (0.0, 1.0, -1.0)[code // 3]
                if (still_x and u != 0.0) or (still_y and v != 0.0):
                    continue
                points[s + 1, 0], points[s + 1, 1] = x0 + u, y0 + v
                cost = 0.0
                for t in (s, s + 1):
                    if 0 < t < R and q.implied[t] and ahead(points[1:], q.T, t) < 0.5:
                        cost += FOLD
                for t in range(max(s - 1, 0), min(s + 2, R)):
                    if cost < least and not q.held[t]:
                        cost += squares(points[t : t + 3], exact[t : t + 3], own[t], rest[t])
                if cost < least - 1e-9:
                    best_x, best_y, least, changed = x0 + u, y0 + v, cost, changed or code > 0
            points[s + 1, 0], points[s + 1, 1] = best_x, best_y
        if not changed:
            break
    q.c[:] = points[1 : R + 1]
    set_nodes(q)


@compiled
def wrong_quads(q: Quads, given: Given, i: int, j: int, tolerance: float) -> tuple[BoolArray, float, int]:
    """(R,) which quadratics are too far from the source, or turn where they may not; their certified distance; and the
    number of new kinks."""
    R, joints, m = len(q.c), given.joints, len(given.cubics)
    P, stays = np.empty((R, 4, 2)), np.zeros(R + 1, dtype=np.bool_)
    for s in range(R):
        as_cubic(q, s, P[s])
    hints = joints.places[q.lo].copy()
    hints[0], hints[R], stays[0] = i, j, True
    far = certified(1, P, hints, stays, np.zeros(R, np.bool_), False, given.cubics, np.empty(0), 0.999 * tolerance)
    bad = ~(far <= 0.999 * tolerance)
    for s in range(R):
        for axis in range(2):
            bad[s] = bad[s] or abs(q.c[s, axis] - np.rint(q.c[s, axis])) > 1e-6
        if s > 0 and not q.implied[s] and not (q.held[s] and q.held[s - 1]):
            ax, ay = q.node[s, 0] - q.c[s - 1, 0], q.node[s, 1] - q.c[s - 1, 1]
            if turn_between(ax, ay, q.c[s, 0] - q.node[s, 0], q.c[s, 1] - q.node[s, 1]) > WORSE:
                bad[s] = bad[s - 1] = True
    kinks = 0
    for end in range(2):
        k, s = j if end else i, (R - 1) * end
        if q.held[s]:
            continue
        sign, here = 1 - 2 * end, joints.arriving[0, k] if end else joints.leaving[0, k]
        x, y = sign * (q.c[s, 0] - q.node[s + end, 0]), sign * (q.c[s, 1] - q.node[s + end, 1])
        own = turn_between(x, y, here[0], here[1])
        if joints.corner[k]:  # what is beyond may turn as much, unless it is a line
            a, b = joints.arriving[0, k], joints.leaving[0, k]
            share = 1.0 if given.line[k % m] or given.line[k - 1] else 2.0
            bad[s] = bad[s] or share * own > turn_between(a[0], a[1], b[0], b[1]) - CORNER
        elif is_kink(q, s + end, x, y):
            bad[s], kinks = True, kinks + 1
    return bad, far.max(), kinks


@compiled
def next_tries(q: Quads, bad: BoolArray, stored: bool, tries: IntArray) -> bool:
    """Give sections with bad quadratics another try; whether there is one."""
    S, before = len(tries), tries.copy()
    failed, moved = np.zeros(S, dtype=np.bool_), np.zeros(S, dtype=np.bool_)
    for s in range(len(q.c)):
        if bad[s] and q.held[s]:
            moved[q.owner[s]] = True
        elif bad[s]:
            failed[q.owner[s]] = True
    for f in range(S):
        if failed[f]:
            tries[f] = min(tries[f] + 1, (len(NEAR) if stored else len(OTHERS)) - 1)
        if moved[f] and tries[f] < EXPLICIT:
            tries[f] = EXPLICIT
        elif moved[f]:
            # What is implied in the source moves with the control point beyond: both stay.
            for k in range(max(f - 1, 0), min(f + 2, S)):
                tries[k] = len(NEAR) - 1
    return (tries != before).any()


@compiled
def fit_run(
    given: Given, i: int, j: int, tolerance: float, points: FloatArray, on: BoolArray
) -> tuple[int, float]:  # fmt: skip
    """Points of the quadratics from joint i to joint j, without the last.

    Args:
        points: (…, 2) receives them; on: whether they are on the curve.

    Returns:
        Their number, at most that of a stored source; and their certified distance.
    """
    n, S, own = j - i, 1, j - i + 1
    ends = np.empty(n + 1, dtype=np.int64)
    ends[0] = i
    for k in range(i + 1, j):
        own += 0 if given.implied[k] else 1
        if given.upright[k]:
            ends[S] = k
            S += 1
    ends[S] = j
    tries = np.zeros(S, dtype=np.int64)
    samples, count, least, reached = given.joints.samples[0], 0, np.inf, np.inf
    for _ in range(ATTEMPTS if n > 1 or not given.stored else 0):
        q = assembled(given, ends[: S + 1], tries, tolerance)
        relax(q, samples, 0.1 * tolerance)
        if aim(q, tries):
            relax(q, samples, 0.1 * tolerance)
        round_quads(q, samples, tolerance)
        bad, far, kinks = wrong_quads(q, given, i, j, tolerance)
        again = bad.any() and next_tries(q, bad, given.stored, tries)
        rank = kinks + (far / tolerance if far <= tolerance else 1e3 * far)
        if (not given.stored and rank < least) or not bad.any():
            least, reached = rank, far
            count = put_points(q.c, q.node, q.implied, points, on)
        if not again:
            break
    if count > 0 and (count < own or not given.stored):
        return count, reached
    nodes = given.cubics[i:j, 0]
    return put_points(given.controls[i:j], nodes, given.implied[i:j], points, on), 0.0


@compiled
def put_points(c: FloatArray, node: FloatArray, implied: BoolArray, points: FloatArray, on: BoolArray) -> int:
    """Write what is stored of quadratics, the first node too; the number of points."""
    at = 0
    for s in range(len(c)):
        if s == 0 or not implied[s]:
            points[at], on[at] = node[s], True
            at += 1
        points[at], on[at] = c[s], False
        at += 1
    return at


@compiled
def read_contour(cubics: FloatArray, degrees: IntArray, settings: Settings, stored: bool) -> Given:
    """A contour, its joints, and the tangents at these: at the ends of lines that are met smoothly, the lines'."""
    m = len(cubics)
    joints, line = find_joints(cubics.reshape(1, m, 4, 2), degrees, settings), degrees == 1
    upright, cuts = set_upright(cubics, joints), joints.corner.copy()
    slack, level = np.full(m + 1, WORSE), np.zeros(m + 1, dtype=np.bool_)
    controls, implied = np.rint((3 * cubics[:, 1] - cubics[:, 0]) / 2), np.zeros(m, dtype=np.bool_)
    for j in range(m):
        _, _, ax, ay = directions(cubics, j - 1, NO_HANDLE)
        bx, by, _, _ = directions(cubics, j, NO_HANDLE)
        turn = turn_between(ax, ay, bx, by)
        cuts[j] = cuts[j] or line[j] or line[j - 1] or turn > STEEP
        implied[j] = stored and not line[j] and not line[j - 1]
        for axis in range(2):
            middle = (controls[j - 1, axis] + controls[j, axis]) / 2
            implied[j] = implied[j] and abs(middle - cubics[j, 0, axis]) < 1e-6
        if not cuts[j]:
            continue
        # Only beyond it is a corner still one when both sides have turned a little.
        joints.corner[j] = turn > BLUNT
        slack[j], level[j] = max(turn, WORSE), line[j] != line[j - 1] and turn < SMOOTH_KINK
        if line[j] or line[j - 1]:
            k = j if line[j] else j - 1
            x, y = (
                np.rint(cubics[k, 3, 0]) - np.rint(cubics[k, 0, 0]),
                np.rint(cubics[k, 3, 1]) - np.rint(cubics[k, 0, 1]),
            )
            if line[j] and (x != 0.0 or y != 0.0):
                bx, by = x, y
            elif x != 0.0 or y != 0.0:
                ax, ay = x, y
        one, two = max(length(ax, ay), 1e-12), max(length(bx, by), 1e-12)
        joints.arriving[0, j, 0], joints.arriving[0, j, 1] = ax / one, ay / one
        joints.leaving[0, j, 0], joints.leaving[0, j, 1] = bx / two, by / two
    cuts[m], slack[m], level[m], joints.corner[m] = cuts[0], slack[0], level[0], joints.corner[0]
    joints.arriving[0, m], joints.leaving[0, m] = joints.arriving[0, 0], joints.leaving[0, 0]
    return Given(cubics, line, joints, slack, level, cuts, upright, stored, controls, implied)


@compiled
def fit_contour(
    cubics: FloatArray, degrees: IntArray, settings: Settings, tolerance: float, stored: bool
) -> tuple[FloatArray, BoolArray, float]:
    """The points of a contour (m, 4, 2), whether they are on the curve, and how far it moved, certified.

    Args:
        stored: whether it is of lines and quadratics on the grid. None if it has neither a corner nor an extremum there
            at which it could begin.
    """
    m, k = len(cubics), 0
    given = read_contour(cubics, degrees, settings, stored)
    while k < m and not given.cuts[k]:
        k += 1
    if k == m:
        k = 0
        while k < m and not (given.upright[k] and (not stored or (cubics[k, 0] == np.rint(cubics[k, 0])).all())):
            k += 1
        if k == m and stored:
            return np.empty((0, 2)), np.empty(0, dtype=np.bool_), 0.0
        if k == m:
            k = farthest_joint(cubics[:, 0])
    if k > 0:
        cubics, degrees = np.concatenate((cubics[k:], cubics[:k])), np.roll(degrees, -k)
        given = read_contour(cubics, degrees, settings, stored)
    room = 2 * MOST * 3 * m
    points, on, count, i, reached = np.empty((room, 2)), np.empty(room, dtype=np.bool_), 0, 0, 0.0
    while i < m:
        j = i + 1
        while j < m and not given.cuts[j]:
            j += 1
        if given.line[i]:
            points[count], on[count] = np.rint(cubics[i, 0]), True
            for end in (0, 3):
                x, y = cubics[i, end]
                reached = max(reached, length(np.rint(x) - x, np.rint(y) - y))
            count += 1
        else:
            more, far = fit_run(given, i, j, tolerance, points[count:], on[count:])
            # What follows meets what is written.
            p, joints = points[count + 1] - points[count], given.joints
            if i == 0 and not given.line[m - 1]:
                joints.leaving[0, m] = p / max(length(p[0], p[1]), 1e-12)
            count, reached = count + more, max(reached, far)
            p = np.rint(cubics[j - 1, 3]) - points[count - 1]
            if j < m and not given.line[j]:
                joints.arriving[0, j] = p / max(length(p[0], p[1]), 1e-12)
        i = j
    return points[:count], on[:count], reached
