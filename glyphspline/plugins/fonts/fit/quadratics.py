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

import numpy as np

from ....compiled import compiled
from ....curves.cubics import directions, length
from ....fitting.sharp.corners import NO_HANDLE, turn_between
from ....fitting.sharp.nearness import certified
from ....fitting.sharp.settings import Settings
from ....intrinsics import borrowed, keep_alive
from ....types import BoolArray, FloatArray, IntArray
from .chains import Quads, as_cubics, part, relax, set_nodes, set_tangents
from .gates import CORNER, KINK, mixed
from .grid import EXPLICIT, aim, is_kink, round_quads
from .harmony import end_jump
from .outlines import Given, Stored, is_ring, mean, read_contour, set_unit

NEAR = (0.7, 0.35, 0.35, 0.0)
"""Of the tolerance: how near a section of a source of quadratics on the grid is to be before it is rounded, on each
try; 0 keeps it."""

OTHERS, MORE = (0.7, 0.7, 0.5, 0.5, 0.7, 0.5, 0.35, 0.35, 0.35), (0, 1, 0, 1, 0, 1, 2, 4, 8)
"""The same for other sources, which have nothing to keep; and quadratics beyond the fewest."""

MOST = 4
"""Quadratics for a cubic, and twice as many for a section."""

ATTEMPTS = 10
"""Tries of a run."""

HOPELESS = 3.0
"""Of what is near enough: how far quadratics may be after two steps before one more is tried."""


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
    q.slack[:], q.slack[0], q.slack[R] = KINK, given.slack[a], given.slack[b]
    q.least[:], q.least[0], q.least[R] = KINK, given.least[a], given.least[b]
    q.own[:], q.own[0], q.own[R] = 0.0, given.own[a], given.own[b]
    q.reach[:], q.reach[0], q.reach[R] = 0.0, given.reach[1, a], given.reach[0, b]
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
    sizes, bends, at, total, turn = np.zeros(n), np.zeros(n + 1), np.zeros(n + 1), 0.0, 0.0
    for w in range(K):
        x_before = y_before = 0.0
        for k in range(n):
            x = samples[w, first + k + 1, 0] - samples[w, first + k, 0]
            y = samples[w, first + k + 1, 1] - samples[w, first + k, 1]
            sizes[k] += length(x, y)
            if k > 0:
                bends[k] += turn_between(x_before, y_before, x, y)
            x_before, y_before = x, y
    for k in range(n):
        total, turn = total + sizes[k], turn + bends[k]
    total, turn = max(total, 1e-12), max(turn, 1e-6)
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
        enough = max(near, off)
        if relax(own, samples, near / 2, HOPELESS * enough) <= enough:
            return count, True
    return most, False


@compiled
def assembled(given: Given, ends: IntArray, tries: IntArray, tolerance: float, known: IntArray) -> Quads:
    """The quadratics of the sections between the joints ``ends`` of a run, each as its tries say.

    Args:
        known: (S, 4) of each section, from call to call: the tries for which was found what follows, -1 at first; the
            number of quadratics; whether they are near enough, and begin or end along lines.
    """
    K, S, samples, stored = len(given.cubics), len(tries), given.joints.samples, given.stored
    room, R = MOST * (ends[S] - ends[0] + 2 * S) + MORE[-1] * S, 0
    made = Quads(
        np.empty((K, room, 2)), np.empty((K, room + 1, 2)), np.ones(room + 1, np.bool_), np.zeros((K, room + 1, 2)),
        np.zeros((K, room + 1, 2)), np.full(room + 1, KINK), np.full(room + 1, KINK), np.zeros(room + 1),
        np.zeros(room + 1), np.zeros((room, 2), np.bool_),
        np.zeros(room, np.bool_), np.zeros(room, np.bool_), np.empty(room, np.int64), np.empty(room + 1, np.int64),
    )  # fmt: skip
    q = borrowed(made)
    for f in range(S):
        a, b = ends[f], ends[f + 1]
        near, ready = (NEAR[tries[f]] if stored.known else OTHERS[tries[f]]) * tolerance, False
        if known[f, 0] != tries[f]:
            ready = find_fewest(q, R, given, a, b, near, tries[f], known[f])
        count, found, level = known[f, 1], known[f, 2] == 1, known[f, 3] == 1
        if stored.known and not found:
            keep = near == 0.0 or tries[f] > 0
            count = b - a
            own = part(q, R, R + count)
            own.tied[:], own.fixed[:], own.held[:] = False, keep, keep
            own.c[:], own.lo[:], own.implied[:] = stored.control[:, a:b], given.joints.first[a : b + 1], True
            own.T[:, 1:count] = given.joints.leaving[:, a + 1 : b]
            set_ends(own, given, a, b, False)
            if not keep:
                own.tied[0, 0], own.tied[count - 1, 1] = not given.joints.corner[a], not given.joints.corner[b]
            for k in range(count):
                if k == 0 or (keep and not stored.implied[a + k]):
                    own.implied[k], own.node[:, k] = False, stored.node[:, a + k]
            own.implied[count], own.node[:, count] = False, stored.node[:, b % len(given.line)]
        else:
            more = MORE[tries[f]] if found and not stored.known else 0
            if more > 0 or not ready:
                count += more
                while not begin(part(q, R, R + count), given, a, b, level):
                    count -= 1
                relax(part(q, R, R + count), samples, near / 2, np.inf)
        stay = f > 0 and max(tries[f], tries[f - 1]) >= EXPLICIT
        q.implied[R] = f > 0 and (not stay or stored.implied[a])
        q.owner[R : R + count] = f
        R += count
    set_nodes(part(q, 0, R))
    keep_alive(made)
    return part(made, 0, R)


@compiled
def find_fewest(
    q: Quads, R: int, given: Given, a: int, b: int, near: float, tries: int, known: IntArray
) -> bool:  # fmt: skip
    """Find the fewest quadratics from joint a to joint b, see :func:`assembled`; whether they are those in q from R."""
    most, count, level, found = b - a - 1 if given.stored.known else MOST * (b - a + 1), 0, False, False
    ready = near > 0.0
    if ready:
        count, ready = fewest(q, R, given, a, b, near, most, False)
        found = ready
        if tries < EXPLICIT and (given.level[a] or given.level[b]):
            own_count, level = fewest(q, R, given, a, b, near, min(count + 1, most), True)
            count, found, ready = (own_count, True, True) if level else (count, found, False)
    known[0], known[1], known[2], known[3] = tries, count, found, level
    return ready


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
        bad[s] = bad[s] or (np.abs(q.c[:, s] - np.rint(q.c[:, s])) > 1e-6).any()
        if s > 0 and not q.implied[s] and not (q.held[s] and q.held[s - 1]):
            before, behind = q.node[:, s] - q.c[:, s - 1], q.c[:, s] - q.node[:, s]
            for weights in mixes:
                (ax, ay), (bx, by) = mean(weights, before), mean(weights, behind)
                if turn_between(ax, ay, bx, by) > KINK:
                    bad[s] = bad[s - 1] = True
    for end in range(2):
        k, s = j if end else i, (R - 1) * end
        if q.held[s]:
            continue
        legs = (1 - 2 * end) * (q.c[:, s] - q.node[:, s + end])
        arriving, leaving = given.way[0, :, k], given.way[1, :, k]
        if is_ring(given.cuts, i, j):
            arriving, leaving = q.node[:, R] - q.c[:, R - 1], q.c[:, 0] - q.node[:, 0]
        share, worse, off = 1.0 if given.line[k % m] or given.line[k - 1] else 2.0, False, False
        for weights in mixes:
            (x, y), (ax, ay), (bx, by) = mean(weights, legs), mean(weights, arriving), mean(weights, leaving)
            if joints.corner[k]:  # what is beyond may turn as much, unless it is a line
                own = turn_between(x, y, ax, ay) if end else turn_between(x, y, bx, by)
                off = off or share * own > turn_between(ax, ay, bx, by) - CORNER
            else:
                turn = turn_between(x, y, bx, by) if end else turn_between(x, y, ax, ay)
                worse = worse or is_kink(q, s + end, turn, length(x, y))
        bad[s], kinks = bad[s] or off or worse, kinks + worse
    return bad, far.max(), kinks


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
    n, K, stored = j - i, len(given.cubics), given.stored
    own = n + 1 + np.count_nonzero(~stored.implied[i + 1 : j])
    samples, count, least, reached, done = given.joints.samples, 0, np.inf, np.inf, False
    # Sections end nowhere inside: extrema of all masters at one parameter are more than most have; then at extrema; and
    # where nothing is near enough, at all joints.
    for cut in range(1 if K == 1 else 0, 3):
        stops = given.upright[i : j + 1] & (cut == 1) | (cut == 2)
        stops[0] = stops[n] = True
        ends = i + np.flatnonzero(stops)
        if (cut == 1 and K > 1 and len(ends) == 2) or (cut == 2 and (stored.known or reached <= tolerance)):
            continue
        tries, known = np.full(len(ends) - 1, EXPLICIT if cut == 2 else 0), np.full((len(ends) - 1, 4), -1)
        for _ in range(0 if stored.known and (n == 1 or stored.stays[i:j].any()) else ATTEMPTS):
            made = assembled(given, ends, tries, tolerance, known)
            q = borrowed(made)
            relax(q, samples, 0.1 * tolerance, np.inf)
            if aim(q, tries, is_ring(given.cuts, i, j)):
                relax(q, samples, 0.1 * tolerance, np.inf)
            round_quads(q, samples, tolerance)
            bad, far, kinks = wrong_quads(q, given, i, j, tolerance)
            again = bad.any() and next_tries(q, bad, stored.known, tries)
            rank = kinks + (far / tolerance if far <= tolerance else 1e3 * far)
            if is_ring(given.cuts, i, j):
                q.implied[0] = (np.abs(q.c[:, 0] + q.c[:, -1] - 2 * q.node[:, 0]) < 1e-6).all()
            size = q.c.shape[1] + 1 + np.count_nonzero(~q.implied[1:-1])
            good = not bad.any() and not (done and size >= count)
            if good or (not stored.known and rank < least and not done and (cut < 2 or far <= tolerance)):
                least, reached, done = rank, far, done or good
                count = put_points(q.c, q.node, q.implied, points, on)
            keep_alive(made)
            if not again:
                break
    if count > 0 and (count < own or not stored.known):
        return count, reached
    kept = put_points(stored.control[:, i:j], stored.node[:, i:j], stored.implied[i:j], points, on)
    return kept, stored.drift


@compiled
def evenest_joint(cubics: FloatArray) -> int:
    """The joint of a contour (m, 4, 2) with long handles, and curvatures that are nearly alike: where a point midway
    between two control points has both near the outline. Ties go to the rightmost, then the uppermost."""
    best, most = 0, -1.0
    for j in range(len(cubics)):
        ax, ay, _, _ = directions(cubics, j, NO_HANDLE)
        _, _, bx, by = directions(cubics, j - 1, NO_HANDLE)
        even = 1.0 - min(end_jump(cubics[j - 1], cubics[j], 1e9), 1.0)
        score = np.rint(even * min(length(ax, ay), length(bx, by)) * 1e6)
        x_ahead, y_ahead = cubics[j, 0, 0] - cubics[best, 0, 0], cubics[j, 0, 1] - cubics[best, 0, 1]
        if score > most or (score == most and (x_ahead > 0 or (x_ahead == 0 and y_ahead > 0))):
            best, most = j, score
    return best


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
    k, given = 0, read_contour(cubics, degrees, settings, tolerance, stored, corners, mixes)
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
            k = evenest_joint(cubics[0])
    if k > 0:
        cubics, degrees = np.concatenate((cubics[:, k:], cubics[:, :k]), axis=1), np.roll(degrees, -k)
        node = np.concatenate((stored.node[:, k:], stored.node[:, :k]), axis=1)
        control = np.concatenate((stored.control[:, k:], stored.control[:, :k]), axis=1)
        implied, stays = np.roll(stored.implied, -k), np.roll(stored.stays, -k)
        stored = Stored(stored.known, node, control, implied, stored.drift, stays)
        given = read_contour(cubics, degrees, settings, tolerance, stored, corners, mixes)
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
    # What is on the grid but for rounding errors is on it: a writer may cut decimals off.
    points, whole = points[:, :count], np.rint(points[:, :count])
    return np.where(np.abs(points - whole) < 1e-6, whole, points), on[:count], reached
