"""Chains of quadratics as TrueType stores them: as few points as follow an outline, most of them implied.

Between two corners or lines, a *run*, all points on the curve become implied: midway between control points. There is
no kink there then, wherever the grid has these. Horizontal and vertical extrema cut a run into *sections*; the legs
there stay horizontal or vertical, at the source's height. Each section gets the fewest control points that follow it;
all points of the run are then moved together. Those that are to lie on the tangents at its ends take places on the grid
in that direction, the others are moved once more, rounded together, and certified as rounded.

A section that fails is tried again with more points. Where the source is one of quadratics on the grid, it is tried
with its ends on the curve too, and in the end stays as the source has it, as does a run that would have more points.

A contour in K masters has the same points in all of them, and samples have the same parameters in all, so that an
instance of the result follows the instance of the source. What turns is looked at in mixes of the masters too, and the
certificate holds in the whole design space. A single outline is a master with the weight 1.
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
from .font_curves import alone, set_upright
from .nearness import add_samples, certified, reweight, shared_feet, squares
from .run_gates import CORNER, mixed, turn_between
from .settings import Settings

NEAR = (0.7, 0.35, 0.35, 0.0)
"""Of the tolerance: how near a section of a source of quadratics on the grid is to be before it is rounded, on each
try; 0 keeps it."""

OTHERS, MORE = (0.7, 0.7, 0.5, 0.5, 0.7, 0.5, 0.35, 0.35, 0.35), (0, 1, 0, 1, 0, 1, 2, 4, 8)
"""The same for other sources, which have nothing to keep; and quadratics beyond the fewest."""

EXPLICIT, LOOSE = 2, 4
"""Tries from which the ends of a section are on the curve; and from which it may turn at the ends of its run, where the
grid has no control point near enough."""

MOST = 4
"""Quadratics for a cubic, and twice as many for a section."""

ROUNDS, SWEEPS = 5, 4
"""Gauss-Newton steps, and visits of all control points on the grid."""

ATTEMPTS = 10
"""Tries of a run."""

DAMPING = 0.03
"""Weight of control points' motion, as far as samples leave a choice: along the curve they would lose their order."""

STEEP = np.radians(1.5)
"""Turn of a joint from which it stays where it is, with the turn it has."""

WORSE = np.radians(0.48)
"""Turn of a joint that a result may have where the source's is smaller."""

FOLD = 1e3
"""What it costs if the order of control points is lost, in mean squares of distance at the tolerance."""

SLIP = 0.01
"""Weight of a distance along the curve against one across it, in several masters: instances mix what is at the same
parameter in these."""

PARALLEL = 1e-3
"""Sine of the angle between tangents in two masters up to which they have one direction."""

BLUNT = np.radians(20.0)
"""Turn from which a corner's sides may turn; less would soon be a kink."""


class Stored(NamedTuple):
    """What is stored of a contour of m quadratics and lines in K masters.

    Attributes:
        known: whether anything is, on the grid. node: (K, m, 2) where segments begin, whole but for those implied.
        control: (K, m, 2), implied: (m,) whether a segment begins midway between control points. drift: how far it is
            from the source, which may have the same numbers before they were rounded. stays: (m,) what is to.
    """

    known: bool
    node: FloatArray
    control: FloatArray
    implied: BoolArray
    drift: float
    stays: BoolArray


class Given(NamedTuple):
    """A contour of m segments in K masters.

    Attributes:
        cubics: (K, m, 4, 2). line: (m,). joints: of it. slack: (m + 1,) the largest turn of each that is no new kink,
            least: (m + 1,) its smallest turn in any mix. level: (m + 1,) whether a curve there is to begin or end along
            a line.
        way: (2, K, m + 1, 2) what arrives at joints, and leaves them.
        cuts: (m + 1,) the joints at which runs end: corners, kinks, ends of lines. upright: (m + 1,) those at which it
            has a horizontal or vertical extremum, in all masters.
        stored: what is of it. mixes: (M, K) weights of the masters with which joints are looked at. corners: (V, K)
            those at the corners of the design space's grid, and outline: (m V, 4, 2) the contour there.
    """

    cubics: FloatArray
    line: BoolArray
    joints: Joints
    slack: FloatArray
    least: FloatArray
    level: BoolArray
    way: FloatArray
    cuts: BoolArray
    upright: BoolArray
    stored: Stored
    mixes: FloatArray
    corners: FloatArray
    outline: FloatArray


class Quads(NamedTuple):
    """The R quadratics of a run or section, in K masters.

    Attributes:
        c: (K, R, 2) control points. node: (K, R + 1, 2) where they meet. implied: (R + 1,) midway between control
            points.
        T: (K, R + 1, 2) unit tangents at nodes. tied: (R, 2) whether a control point is on that of its start, or end.
        beyond: (K, R + 1, 2) where tied, what is beyond the node. slack, least: (R + 1,) turns from it as in
            :class:`Given`.
        fixed: (R,) control points that do not move. held: (R,) quadratics of the source.
        owner: (R,) their sections. lo: (R + 1,) samples at which they meet.
    """

    c: FloatArray
    node: FloatArray
    implied: BoolArray
    T: FloatArray
    beyond: FloatArray
    slack: FloatArray
    least: FloatArray
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
        q.c[:, a:b], q.node[:, a:n], q.implied[a:n], q.T[:, a:n], q.beyond[:, a:n], q.slack[a:n], q.least[a:n],
        q.tied[a:b], q.fixed[a:b], q.held[a:b], q.owner[a:b], q.lo[a:n],
    )  # fmt: skip


@compiled
def set_nodes(q: Quads) -> None:
    """Put the implied nodes where control points have them."""
    for v in range(len(q.c)):
        for s in range(1, q.c.shape[1]):
            if q.implied[s]:
                for axis in range(2):
                    q.node[v, s, axis] = (q.c[v, s - 1, axis] + q.c[v, s, axis]) / 2


@compiled
def as_cubics(q: Quads, s: int, out: FloatArray) -> None:
    """Quadratic s as a cubic (K, 4, 2)."""
    for v in range(len(q.c)):
        for axis in range(2):
            a, b, c = q.node[v, s, axis], q.c[v, s, axis], q.node[v, s + 1, axis]
            out[v, 0, axis], out[v, 3, axis] = a, c
            out[v, 1, axis], out[v, 2, axis] = a + (b - a) * (2 / 3), c + (b - c) * (2 / 3)


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
    """Move the control points nearest to the samples (K, N, 2), by least squares; the largest distance left.

    Args:
        enough: the distance that ends this.
    """
    K, R, N = len(q.c), q.c.shape[1], samples.shape[1]
    n = 2 * R
    A, g, first = np.zeros((K, n, n)), np.zeros((K, n)), np.zeros(n, dtype=np.int64)
    for k in range(n):
        first[k] = max(0, 2 * (k // 2 - 2))
    x, e, weight = np.empty(N), np.zeros(N), np.ones(N)
    c, p, J, own = np.empty((K, 3, 2)), np.empty((K, 4, 2)), np.empty((4, 2, 6)), np.empty((6, 7))
    for s in range(R):
        for k in range(q.lo[s], q.lo[s + 1] + 1):
            x[k] = (k - q.lo[s]) / max(q.lo[s + 1] - q.lo[s], 1)
    m, rounds = 0, ROUNDS if K == 1 else 2 * ROUNDS
    while True:
        A[:], g[:], worst = 0.0, 0.0, 0.0
        for s in range(R):
            a, b = q.lo[s], q.lo[s + 1] + 1
            as_cubics(q, s, p)
            far = shared_feet(p, samples[:, a:b], c, x[a:b], e[a:b])
            worst = max(worst, far)
            if q.held[s] or m == rounds:
                continue
            if m > 0 and far > 0.0:
                reweight(weight[a:b], e[a:b], far)
            set_moves(q, s, J)
            for w in range(K):
                own[:] = 0.0
                add_samples(p[w], c[w], samples[w, a:b], x[a:b], weight[a:b], J, 1.0, own, SLIP if K > 1 else 0.0)
                for u in range(6):
                    at = 2 * s - 2 + u
                    if 0 <= at < n:
                        g[w, at] += own[u, 6]
                        for v in range(max(0, 2 - 2 * s), u + 1):
                            A[w, at, at - u + v] += own[u, v]
        if m == rounds or worst <= enough:
            return worst
        for w in range(K):
            improve(q, w, A[w], g[w], first)
        set_nodes(q)
        for s in range(1, R):
            if not (q.held[s - 1] or q.held[s]):
                share_samples(q, s, samples, x)
        m += 1


@compiled
def improve(q: Quads, w: int, A: FloatArray, g: FloatArray, first: IntArray) -> None:
    """Move the control points of master w as the equations A, g say, as far as they keep their order."""
    R, c, node, T = q.c.shape[1], q.c[w], q.node[w], q.T[w]
    for s in range(R):
        # Motion across a tangent is dear; all motion costs a little.
        for axis in range(2):
            A[2 * s + axis, 2 * s + axis] += 1e6 if q.fixed[s] else DAMPING
        for end in range(2):
            if q.tied[s, end]:
                tx, ty = T[s + end]
                A[2 * s, 2 * s] += 1e6 * ty * ty
                A[2 * s + 1, 2 * s] -= 1e6 * tx * ty
                A[2 * s + 1, 2 * s + 1] += 1e6 * tx * tx
    solve(A, g, first, 2 * R)
    for s in range(R):
        if q.tied[s, 0] and q.tied[s, 1]:
            continue
        dx, dy = g[2 * s], g[2 * s + 1]
        leg = 0.5 * length(node[s + 1, 0] - node[s, 0], node[s + 1, 1] - node[s, 1])
        share = min(1.0, leg / max(length(dx, dy), 1e-12))
        push(q, w, s, share * dx, share * dy)
    for s in range(R + 1):
        if q.implied[s]:
            lack = (1.0 - ahead(c, T, s)) / 2
            if lack > 0.0:
                push(q, w, s - 1, -lack * T[s, 0], -lack * T[s, 1])
                push(q, w, s, lack * T[s, 0], lack * T[s, 1])
            continue
        for u, sign in ((s - 1, -1.0), (s, 1.0)):
            if 0 <= u < R:
                dx, dy = c[u, 0] - node[s, 0], c[u, 1] - node[s, 1]
                lack = 1.0 - sign * (dx * T[s, 0] + dy * T[s, 1])
                if lack > 0.0:
                    push(q, w, u, sign * lack * T[s, 0], sign * lack * T[s, 1])


@compiled
def push(q: Quads, w: int, s: int, dx: float, dy: float) -> None:
    """Move a control point in master w by as much of a vector as it may."""
    if q.fixed[s]:
        return
    for end in range(2):
        if q.tied[s, end]:
            tx, ty = q.T[w, s + end]
            along = dx * tx + dy * ty
            dx, dy = along * tx, along * ty
    q.c[w, s, 0] += dx
    q.c[w, s, 1] += dy


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
            k, o, near, other = q.lo[s], q.lo[s] + step, 0.0, 0.0
            for w in range(len(q.c)):
                near += length(samples[w, k, 0] - q.node[w, s, 0], samples[w, k, 1] - q.node[w, s, 1])
                other += length(samples[w, o, 0] - q.node[w, s, 0], samples[w, o, 1] - q.node[w, s, 1])
            if other >= near:
                break
            q.lo[s] = o
    if q.lo[s] != before:
        if not q.tied[s, 0]:
            set_tangents(q, s, samples)
        for k in range(a + 1, b):
            first, last = (a, q.lo[s]) if k < q.lo[s] else (q.lo[s], b)
            x[k] = (k - first) / (last - first)


@compiled
def set_tangents(q: Quads, s: int, samples: FloatArray) -> None:
    """Let node s have the tangents at its sample."""
    k = q.lo[s]
    for w in range(len(samples)):
        x, y = samples[w, k + 1, 0] - samples[w, k - 1, 0], samples[w, k + 1, 1] - samples[w, k - 1, 1]
        size = max(length(x, y), 1e-12)
        q.T[w, s, 0], q.T[w, s, 1] = x / size, y / size


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
def set_ends(q: Quads, given: Given, a: int, b: int, level: bool) -> None:
    """Give quadratics from joint a to joint b the tangents there, and what is beyond.

    Args:
        level: whether they begin and end along lines where they may.
    """
    joints, R = given.joints, q.c.shape[1]
    q.slack[:], q.slack[0], q.slack[R] = WORSE, given.slack[a], given.slack[b]
    q.least[:], q.least[0], q.least[R] = WORSE, given.least[a], given.least[b]
    q.T[:, 0], q.T[:, R] = joints.leaving[:, a], joints.arriving[:, b]
    q.beyond[:, 0], q.beyond[:, R] = given.way[0, :, a], given.way[1, :, b]
    if level and given.level[a]:
        q.T[:, 0] = joints.arriving[:, a]
    if level and given.level[b]:
        q.T[:, R] = joints.leaving[:, b]


@compiled
def begin(q: Quads, given: Given, a: int, b: int, level: bool) -> bool:
    """Begin with quadratics from joint a to joint b, as many as q has; False if samples are too few.

    Args:
        level: see :func:`set_ends`.
    """
    joints, samples, count = given.joints, given.joints.samples, q.c.shape[1]
    first, last = joints.first[a], joints.first[b]
    n, K = last - first, len(samples)
    # Quadratics are short where the outline turns, and none is much longer than its neighbours.
    sizes, bends, at = np.zeros(n), np.zeros(n + 1), np.zeros(n + 1)
    for w in range(K):
        x_before = y_before = 0.0
        for k in range(n):
            x = samples[w, first + k + 1, 0] - samples[w, first + k, 0]
            y = samples[w, first + k + 1, 1] - samples[w, first + k, 1]
            sizes[k] += length(x, y)
            if k > 0:
                bends[k] += turn_between(x_before, y_before, x, y)
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
    set_ends(q, given, a, b, level)
    q.tied[:], q.fixed[:], q.held[:], q.implied[:] = False, False, False, True
    q.implied[0] = q.implied[count] = False
    q.tied[0, 0], q.tied[count - 1, 1] = not joints.corner[a], not joints.corner[b]
    for s in range(1, count):
        set_tangents(q, s, samples)
    for w in range(K):
        c, node, T = q.c[w], q.node[w], q.T[w]
        for s in range(1, count):
            node[s] = samples[w, q.lo[s]]
        node[0] = np.rint(given.stored.node[w, a % len(given.line)])
        node[count] = np.rint(given.stored.node[w, b % len(given.line)])
        least = 0.05 * length(node[count, 0] - node[0, 0], node[count, 1] - node[0, 1]) / count
        for s in range(count):
            meeting(node[s], T[s], node[s + 1], T[s + 1], c[s])
        for s, end in ((0, 0), (count - 1, 1)):
            if q.tied[s, end] and not q.tied[s, 1 - end]:
                # On its tangent, ahead of the end.
                p, (tx, ty) = node[s + end], T[s + end]
                along = (c[s, 0] - p[0]) * tx + (c[s, 1] - p[1]) * ty
                along = min(along, -least) if end else max(along, least)
                c[s, 0], c[s, 1] = p[0] + along * tx, p[1] + along * ty
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
        samples, off = given.joints.samples, 0.0
        for w in range(len(samples)):  # what is on the grid is no nearer than this
            for k, s in ((own.lo[0], 0), (own.lo[count], count)):
                x, y = own.node[w, s] - samples[w, k]
                off = max(off, 1.05 * length(x, y))
        if relax(own, samples, near / 2) <= max(near, off):
            return count, True
    return most, False


@compiled
def assembled(given: Given, ends: IntArray, tries: IntArray, tolerance: float) -> Quads:
    """The quadratics of the sections between the joints ``ends`` of a run, each as its tries say."""
    K, S, samples, stored = len(given.cubics), len(tries), given.joints.samples, given.stored
    room, R = MOST * (ends[S] - ends[0] + 2 * S) + MORE[-1] * S, 0
    q = Quads(
        np.empty((K, room, 2)), np.empty((K, room + 1, 2)), np.ones(room + 1, np.bool_), np.zeros((K, room + 1, 2)),
        np.zeros((K, room + 1, 2)), np.full(room + 1, WORSE), np.full(room + 1, WORSE), np.zeros((room, 2), np.bool_),
        np.zeros(room, np.bool_), np.zeros(room, np.bool_), np.empty(room, np.int64), np.empty(room + 1, np.int64),
    )  # fmt: skip
    for f in range(S):
        a, b = ends[f], ends[f + 1]
        near, found = (NEAR[tries[f]] if stored.known else OTHERS[tries[f]]) * tolerance, False
        most, count, level = b - a - 1 if stored.known else MOST * (b - a + 1), 0, False
        if near > 0.0:
            count, found = fewest(q, R, given, a, b, near, most, False)
            if tries[f] < EXPLICIT and (given.level[a] or given.level[b]):
                own_count, level = fewest(q, R, given, a, b, near, min(count + 1, most), True)
                count, found = (own_count, True) if level else (count, found)
        if stored.known and not found:
            keep = near == 0.0 or tries[f] > 0
            count = b - a
            own = part(q, R, R + count)
            own.tied[:], own.fixed[:], own.held[:] = False, keep, keep
            own.c[:], own.lo[:], own.implied[:] = stored.control[:, a:b], given.joints.first[a : b + 1], True
            set_ends(own, given, a, b, False)
            if not keep:
                own.tied[0, 0], own.tied[count - 1, 1] = not given.joints.corner[a], not given.joints.corner[b]
            for k in range(count):
                if k == 0 or (keep and not stored.implied[a + k]):
                    own.implied[k], own.node[:, k] = False, stored.node[:, a + k]
            own.implied[count], own.node[:, count] = False, stored.node[:, b % len(given.line)]
        elif not stored.known:
            count += MORE[tries[f]] if found else 0
            while not begin(part(q, R, R + count), given, a, b, level):
                count -= 1
            relax(part(q, R, R + count), samples, near / 2)
        else:
            begin(part(q, R, R + count), given, a, b, level)
            relax(part(q, R, R + count), samples, near / 2)
        stay = f > 0 and max(tries[f], tries[f - 1]) >= EXPLICIT
        q.implied[R] = f > 0 and (not stay or stored.implied[a])
        q.owner[R : R + count] = f
        R += count
    whole = part(q, 0, R)
    set_nodes(whole)
    return whole


@compiled
def aim(q: Quads, tries: IntArray, ring: bool) -> bool:
    """Put control points on tangents that are not the axes' on the grid, as nearly in that direction; whether any.

    Args:
        ring: whether the last node is the first again: it becomes implied.
    """
    aimed, K, R = False, len(q.c), q.c.shape[1]
    wanted, best = np.empty(K), np.empty((K, 2))
    for s in range(R):
        both = q.tied[s, 0] and q.tied[s, 1]
        for end in range(2):
            if q.fixed[s] or not q.tied[s, end]:
                continue
            level = not both
            for axis in range(2):
                level = level and not (q.T[:, s + end, axis] == 0.0).all()
            if not both and not level:
                continue
            price = 0.5 if tries[q.owner[s]] >= LOOSE else 100.0
            set_lengths(q, s, end, tries[q.owner[s]] % 2 == 1 and not ring, wanted)
            for w in range(K):
                best[w] = aimed_at(q, w, s, end, wanted[w], price)
            if ring and 0 < s == R - 1 and q.fixed[0]:
                best[:] = 2 * q.node[:, R] - q.c[:, 0]
            q.c[:, s], q.fixed[s], aimed = best, True, True
    set_nodes(q)
    return aimed


@compiled
def set_lengths(q: Quads, s: int, end: int, alike: bool, wanted: FloatArray) -> None:
    """How long the leg of quadratic s at its end is in each master; in proportion to what is beyond where that does not
    have one direction in all, as else the joint turns between masters."""
    K, sign, one, size, turn = len(q.c), 1.0 - 2.0 * end, 0.0, 0.0, 0.0
    for w in range(K):
        (tx, ty), (bx, by), p = q.T[w, s + end], q.beyond[w, s + end], q.node[w, s + end]
        wanted[w] = max(sign * ((q.c[w, s, 0] - p[0]) * tx + (q.c[w, s, 1] - p[1]) * ty), 1.0)
        one, size = one + wanted[w] * length(bx, by), size + bx * bx + by * by
        turn = max(turn, abs(tx * q.T[0, s + end, 1] - ty * q.T[0, s + end, 0]))
    for w in range(K if alike and turn > PARALLEL else 0):
        wanted[w] = max(one / max(size, 1e-12) * length(q.beyond[w, s + end, 0], q.beyond[w, s + end, 1]), 1.0)


@compiled
def aimed_at(q: Quads, w: int, s: int, end: int, wanted: float, price: float) -> FloatArray:
    """The place (2,) on the grid for the control point of quadratic s in master w, in the direction of its tangent."""
    both, sign, (tx, ty), p = q.tied[s, 0] and q.tied[s, 1], 1.0 - 2.0 * end, q.T[w, s + end], q.node[w, s + end]
    tx, ty, c = sign * tx, sign * ty, q.c[w, s]
    steep = abs(ty) > abs(tx)
    main, other = (ty, tx) if steep else (tx, ty)
    least, best = np.inf, c.copy()
    for code in range(25 if both else int(2 * wanted) + 12):
        if both:
            x, y = np.rint(c[0]) - p[0] + code % 5 - 2, np.rint(c[1]) - p[1] + code // 5 - 2
        else:
            u, v = np.sign(main) * (code + 1), np.rint((code + 1) * other / abs(main))
            x, y = (v, u) if steep else (u, v)
        along = (x * tx + y * ty - wanted) / (0.3 * wanted + 1.0)
        cost = along * along + off_tangent(q, w, s + end, sign * x, sign * y, price)
        if both:
            r = q.node[w, s + 1]
            cost += off_tangent(q, w, s + 1, r[0] - p[0] - x, r[1] - p[1] - y, price)
        if cost < least:
            least, best[0], best[1] = cost, p[0] + x, p[1] + y
    return best


@compiled
def is_kink(q: Quads, s: int, turn: float) -> bool:
    """Whether a turn from what is beyond makes node s a kink that the source has not there."""
    return turn > q.slack[s] + 1e-9 or turn < CORNER < q.least[s]


@compiled
def off_tangent(q: Quads, w: int, s: int, x: float, y: float, price: float) -> float:
    """What a leg (x, y) beside the tangent at node s costs in master w; where it turns from what is beyond, the
    price."""
    T, beyond = q.T[w, s], q.beyond[w, s]
    off, turn = turn_between(x, y, T[0], T[1]), turn_between(x, y, beyond[0], beyond[1])
    return price * (0.005 * (off / WORSE) ** 2 + (max(turn, off) / WORSE if is_kink(q, s, turn) else 0.0))


@compiled
def round_quads(q: Quads, samples: FloatArray, tolerance: float) -> None:
    """Round control points to the grid, each to the neighbour that leaves the outline least; tangents that are axes
    stay so."""
    K, R = len(q.c), q.c.shape[1]
    # A row before the first control point, and one behind the last.
    points, own, rest = np.zeros((K, R + 2, 2)), np.zeros((K, R, 6, 7)), np.zeros((K, R))
    points[:, 1 : R + 1] = q.c
    exact, c, p, J = points.copy(), np.empty((K, 3, 2)), np.empty((K, 4, 2)), np.empty((4, 2, 6))
    for s in range(R):
        if not q.held[s]:
            a, n = q.lo[s], q.lo[s + 1] + 1 - q.lo[s]
            Q, x = samples[:, a : a + n], np.arange(n) / max(n - 1, 1)
            as_cubics(q, s, p)
            shared_feet(p, Q, c, x, np.empty(n))
            set_moves(q, s, J)
            for w in range(K):
                rest[w, s] = add_samples(
                    p[w], c[w], Q[w], x, np.ones(n), J, tolerance, own[w, s], SLIP if K > 1 else 0.0
                )
        if not q.fixed[s]:
            points[:, s + 1] = np.rint(points[:, s + 1])
    for w in range(K):
        for _ in range(SWEEPS):
            changed = False
            for s in range(R):
                changed = (not q.fixed[s] and moved_on_grid(q, w, s, points[w], exact[w], own[w], rest[w])) or changed
            if not changed:
                break
    q.c[:] = points[:, 1 : R + 1]
    set_nodes(q)


@compiled
def moved_on_grid(
    q: Quads, w: int, s: int, points: FloatArray, exact: FloatArray, own: FloatArray, rest: FloatArray
) -> bool:  # fmt: skip
    """Move the control point of quadratic s in master w to the neighbour on the grid that costs least; whether it has
    moved."""
    R, T = q.c.shape[1], q.T[w]
    still_x = (q.tied[s, 0] and T[s, 0] == 0.0) or (q.tied[s, 1] and T[s + 1, 0] == 0.0)
    still_y = (q.tied[s, 0] and T[s, 1] == 0.0) or (q.tied[s, 1] and T[s + 1, 1] == 0.0)
    x0, y0 = points[s + 1]
    best_x, best_y, least, changed = x0, y0, np.inf, False
    for code in range(9):
        u, v = (0.0, 1.0, -1.0)[code % 3], (0.0, 1.0, -1.0)[code // 3]
        if (still_x and u != 0.0) or (still_y and v != 0.0):
            continue
        points[s + 1, 0], points[s + 1, 1] = x0 + u, y0 + v
        cost = 0.0
        for t in (s, s + 1):
            if 0 < t < R and q.implied[t] and ahead(points[1:], T, t) < 0.5:
                cost += FOLD
        for t in range(max(s - 1, 0), min(s + 2, R)):
            if cost < least and not q.held[t]:
                cost += squares(points[t : t + 3], exact[t : t + 3], own[t], rest[t])
        if cost < least - 1e-9:
            best_x, best_y, least, changed = x0 + u, y0 + v, cost, changed or code > 0
    points[s + 1, 0], points[s + 1, 1] = best_x, best_y
    return changed


@compiled
def wrong_quads(q: Quads, given: Given, i: int, j: int, tolerance: float) -> tuple[BoolArray, float, int]:
    """(R,) which quadratics are too far from the source, or turn where they may not; their certified distance; and the
    number of new kinks."""
    K, R, joints, m, mixes = len(q.c), q.c.shape[1], given.joints, len(given.line), given.mixes
    P, p, stays = np.empty((K, R, 4, 2)), np.empty((K, 4, 2)), np.zeros(R + 1, dtype=np.bool_)
    for s in range(R):
        as_cubics(q, s, p)
        P[:, s] = p
    hints = joints.places[q.lo].copy()
    hints[0], hints[R], stays[0], V = i, j, True, len(given.corners)
    chain, skip = mixed(given.corners, P), np.zeros(R, np.bool_)
    arc = np.array([0.0, R, i, j]) if K > 1 else np.empty(0)
    far = certified(V, chain, hints, stays, skip, False, given.outline, arc, 0.999 * tolerance)
    bad, kinks = ~(far <= 0.999 * tolerance), 0
    for s in range(R):
        for end in range(2):
            # A control point on a node has no leg there whose turn is seen below.
            if not q.held[s] and (q.c[:, s] == q.node[:, s + end]).all():
                bad[s], kinks = True, kinks + 1
        for w in range(K):
            for axis in range(2):
                bad[s] = bad[s] or abs(q.c[w, s, axis] - np.rint(q.c[w, s, axis])) > 1e-6
        if s > 0 and not q.implied[s] and not (q.held[s] and q.held[s - 1]):
            before, behind = q.node[:, s] - q.c[:, s - 1], q.c[:, s] - q.node[:, s]
            for weights in mixes:
                (ax, ay), (bx, by) = mean(weights, before), mean(weights, behind)
                if turn_between(ax, ay, bx, by) > WORSE:
                    bad[s] = bad[s - 1] = True
    for end in range(2):
        k, s = j if end else i, (R - 1) * end
        if q.held[s]:
            continue
        legs = (1 - 2 * end) * (q.c[:, s] - q.node[:, s + end])
        arriving, leaving = given.way[0, :, k], given.way[1, :, k]
        if is_ring(given, i, j):
            arriving, leaving = q.node[:, R] - q.c[:, R - 1], q.c[:, 0] - q.node[:, 0]
        share, worse, off = 1.0 if given.line[k % m] or given.line[k - 1] else 2.0, False, False
        for weights in mixes:
            (x, y), (ax, ay), (bx, by) = mean(weights, legs), mean(weights, arriving), mean(weights, leaving)
            if joints.corner[k]:  # what is beyond may turn as much, unless it is a line
                own = turn_between(x, y, ax, ay) if end else turn_between(x, y, bx, by)
                off = off or share * own > turn_between(ax, ay, bx, by) - CORNER
            else:
                worse = worse or is_kink(q, s + end, turn_between(x, y, bx, by) if end else turn_between(x, y, ax, ay))
        bad[s], kinks = bad[s] or off or worse, kinks + worse
    return bad, far.max(), kinks


@compiled
def is_ring(given: Given, i: int, j: int) -> bool:
    """Whether a run is a whole contour without an end."""
    return i == 0 and j == len(given.line) and not given.cuts[0]


@compiled
def mean(weights: FloatArray, vectors: FloatArray) -> tuple[float, float]:
    """The mix of (K, 2) vectors."""
    x = y = 0.0
    for w in range(len(weights)):
        x, y = x + weights[w] * vectors[w, 0], y + weights[w] * vectors[w, 1]
    return x, y


@compiled
def next_tries(q: Quads, bad: BoolArray, stored: bool, tries: IntArray) -> bool:
    """Give sections with bad quadratics another try; whether there is one."""
    S, before = len(tries), tries.copy()
    failed, moved = np.zeros(S, dtype=np.bool_), np.zeros(S, dtype=np.bool_)
    for s in range(len(bad)):
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
        points: (K, …, 2) receives them; on: whether they are on the curve.

    Returns:
        Their number, at most that of a stored source; and their certified distance.
    """
    n, K, own, stored = j - i, len(given.cubics), j - i + 1, given.stored
    for k in range(i + 1, j):
        own += 0 if stored.implied[k] else 1
    samples, count, least, reached, done = given.joints.samples, 0, np.inf, np.inf, False
    # In several masters a run is tried without sections too: extrema of all at one parameter are more than most have.
    # Where nothing is near enough, each segment is a section.
    for cut in range(1 if K == 1 else 0, 3):
        ends = sections(given, i, j, cut)
        if (cut == 1 and K > 1 and len(ends) == 2) or (cut == 2 and (stored.known or reached <= tolerance)):
            continue
        tries = np.full(len(ends) - 1, EXPLICIT if cut == 2 else 0)
        for _ in range(0 if stored.known and (n == 1 or stored.stays[i:j].any()) else ATTEMPTS):
            q = assembled(given, ends, tries, tolerance)
            relax(q, samples, 0.1 * tolerance)
            if aim(q, tries, is_ring(given, i, j)):
                relax(q, samples, 0.1 * tolerance)
            round_quads(q, samples, tolerance)
            bad, far, kinks = wrong_quads(q, given, i, j, tolerance)
            again = bad.any() and next_tries(q, bad, stored.known, tries)
            rank = kinks + (far / tolerance if far <= tolerance else 1e3 * far)
            if is_ring(given, i, j):
                q.implied[0] = (np.abs(q.c[:, 0] + q.c[:, -1] - 2 * q.node[:, 0]) < 1e-6).all()
            size = q.c.shape[1] + 1 + np.count_nonzero(~q.implied[1:-1])
            good = not bad.any() and not (done and size >= count)
            if good or (not stored.known and rank < least and not done and (cut < 2 or far <= tolerance)):
                least, reached, done = rank, far, done or good
                count = put_points(q.c, q.node, q.implied, points, on)
            if not again:
                break
    if count > 0 and (count < own or not stored.known):
        return count, reached
    kept = put_points(stored.control[:, i:j], stored.node[:, i:j], stored.implied[i:j], points, on)
    return kept, stored.drift


@compiled
def sections(given: Given, i: int, j: int, cut: int) -> IntArray:
    """The joints at which sections of a run from joint i to joint j end: none inside, the extrema, or all."""
    ends, S = np.empty(j - i + 1, dtype=np.int64), 1
    ends[0] = i
    for k in range(i + 1, j):
        if cut == 2 or (cut == 1 and given.upright[k]):
            ends[S] = k
            S += 1
    ends[S] = j
    return ends[: S + 1]


@compiled
def put_points(c: FloatArray, node: FloatArray, implied: BoolArray, points: FloatArray, on: BoolArray) -> int:
    """Write what is stored of quadratics; the number of points."""
    at = 0
    for s in range(c.shape[1]):
        if not implied[s]:
            points[:, at], on[at] = node[:, s], True
            at += 1
        points[:, at], on[at] = c[:, s], False
        at += 1
    return at


@compiled
def read_contour(
    cubics: FloatArray, degrees: IntArray, settings: Settings, stored: Stored, corners: FloatArray, mixes: FloatArray
) -> Given:  # fmt: skip
    """A contour, its joints, and the tangents at these: at the ends of lines that are met smoothly, the lines'."""
    K, m = cubics.shape[:2]
    joints, line = find_joints(cubics, degrees, settings), degrees == 1
    upright, cuts, way = np.ones(m + 1, np.bool_), joints.corner.copy(), np.empty((2, K, m + 1, 2))
    for w in range(K):
        upright &= set_upright(cubics[w], alone(joints, w))
    slack, least, level = np.full(m + 1, WORSE), np.full(m + 1, WORSE), np.zeros(m + 1, dtype=np.bool_)
    for j in range(m):
        for w in range(K):
            _, _, way[0, w, j, 0], way[0, w, j, 1] = directions(cubics[w], j - 1, NO_HANDLE)
            way[1, w, j, 0], way[1, w, j, 1], _, _ = directions(cubics[w], j, NO_HANDLE)
        before, behind, most, fewest_turn = way[0, :, j], way[1, :, j], 0.0, np.inf
        for weights in mixes:
            (ax, ay), (bx, by) = mean(weights, before), mean(weights, behind)
            turn = turn_between(ax, ay, bx, by)
            most, fewest_turn = max(most, turn), min(fewest_turn, turn)
        cuts[j] = cuts[j] or line[j] or line[j - 1] or most > STEEP
        if not cuts[j]:
            way[0, :, j], way[1, :, j] = joints.arriving[:, j], joints.leaving[:, j]
            continue
        # Only beyond it is a corner still one when both sides have turned a little.
        joints.corner[j] = fewest_turn > BLUNT
        slack[j], least[j], level[j] = (
            max(most, WORSE),
            max(fewest_turn, WORSE),
            line[j] != line[j - 1] and most < SMOOTH_KINK,
        )
        for w in range(K):
            if line[j] or line[j - 1]:
                k, side = (j, 1) if line[j] else ((j - 1) % m, 0)
                here, there = stored.node[w, k], stored.node[w, (k + 1) % m]
                x, y = np.rint(there[0]) - np.rint(here[0]), np.rint(there[1]) - np.rint(here[1])
                if x != 0.0 or y != 0.0:
                    way[side, w, j, 0], way[side, w, j, 1] = x, y
            set_unit(way[0, w, j], joints.arriving[w, j])
            set_unit(way[1, w, j], joints.leaving[w, j])
    cuts[m], slack[m], least[m], level[m] = cuts[0], slack[0], least[0], level[0]
    joints.corner[m], way[:, :, m] = joints.corner[0], way[:, :, 0]
    joints.arriving[:, m], joints.leaving[:, m] = joints.arriving[:, 0], joints.leaving[:, 0]
    outline = mixed(corners, cubics)
    return Given(
        cubics, line, joints, slack, least, level, way, cuts, upright, stored, mixes, corners, outline
    )  # fmt: skip


@compiled
def set_unit(vector: FloatArray, out: FloatArray) -> None:
    """The direction of a vector."""
    size = max(length(vector[0], vector[1]), 1e-12)
    out[0], out[1] = vector[0] / size, vector[1] / size


@compiled
def fit_contour(
    cubics: FloatArray, degrees: IntArray, settings: Settings, tolerance: float, stored: Stored, corners: FloatArray,
    mixes: FloatArray,
) -> tuple[FloatArray, BoolArray, float]:  # fmt: skip
    """The points of a contour (K, m, 4, 2), whether they are on the curve, and how far it moved, certified.

    Args:
        stored: what is of it; nodes are given of any. None if it has neither a corner nor an extremum on the grid at
            which it could begin.
        corners, mixes: see :class:`Given`.
    """
    K, m = cubics.shape[:2]
    k, given = 0, read_contour(cubics, degrees, settings, stored, corners, mixes)
    while k < m and not given.cuts[k]:
        k += 1
    if k == m:
        k = 0
        while k < m and not (
            given.upright[k] and (not stored.known or (stored.node[:, k] == np.rint(stored.node[:, k])).all())
        ):
            k += 1
        if k == m and stored.known:
            return np.empty((K, 0, 2)), np.empty(0, dtype=np.bool_), 0.0
        if k == m:
            k = farthest_joint(cubics[0, :, 0])
    if k > 0:
        cubics, degrees = np.concatenate((cubics[:, k:], cubics[:, :k]), axis=1), np.roll(degrees, -k)
        node = np.concatenate((stored.node[:, k:], stored.node[:, :k]), axis=1)
        control = np.concatenate((stored.control[:, k:], stored.control[:, :k]), axis=1)
        implied, stays = np.roll(stored.implied, -k), np.roll(stored.stays, -k)
        stored = Stored(stored.known, node, control, implied, stored.drift, stays)
        given = read_contour(cubics, degrees, settings, stored, corners, mixes)
    room = 2 * (MOST * 3 + MORE[-1]) * m
    points, on, count, i, reached = np.empty((K, room, 2)), np.empty(room, dtype=np.bool_), 0, 0, 0.0
    joints, way = given.joints, given.way
    while i < m:
        j = i + 1
        while j < m and not given.cuts[j]:
            j += 1
        if given.line[i]:
            points[:, count], on[count] = np.rint(stored.node[:, i]), True
            for w in range(K):
                for end in (0, 3):
                    x, y = cubics[w, i, end] - np.rint(stored.node[w, (i + end // 3) % m])
                    reached = max(reached, length(x, y))
            count += 1
        else:
            more, far = fit_run(given, i, j, tolerance, points[:, count:], on[count:])
            # What follows meets what is written.
            if i == 0 and not given.line[m - 1]:
                way[1, :, m] = points[:, count + 1] - points[:, count]
            count, reached = count + more, max(reached, far)
            if j < m and not given.line[j]:
                way[0, :, j] = np.rint(stored.node[:, j]) - points[:, count - 1]
            for w in range(K):
                set_unit(way[1, w, m], joints.leaving[w, m])
                set_unit(way[0, w, j], joints.arriving[w, j])
        i = j
    return points[:, :count], on[:count], reached
