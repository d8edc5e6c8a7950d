"""Chains of cubics as fonts store them: the fewest nodes, on the grid, with one tangent and one curvature at each.

``continuity="g2"``. A contour is cut at corners and long lines. The *run* between two cuts is a chain of segments;
nodes are chosen among its joints, one cubic fitted between each node and the next (:func:`chosen_nodes`). Then all
cubics of the run are moved together until curvatures meet (:mod:`.harmony`), rounded together (:mod:`.lattice`), and
certified as rounded. Where a cubic fails, its stretch is fitted again more closely, and in the end stays as the source
has it, to the byte. So does a run in which nothing is gained.

A contour in K masters has the same nodes in all of them, and is fitted in each by itself. What a joint turns by is
looked at in mixes of the masters too, and the certificate holds in the whole design space.

Lengths here are in steps of the grid, on which points have whole coordinates.
"""

from __future__ import annotations

import numpy as np

from ....compiled import compiled
from ....curves.cubics import directions, hidden_extrema, length
from ....fitting.sharp.corners import NO_HANDLE, SMOOTH_KINK, Joints
from ....fitting.sharp.cubics import fit_between, is_straight
from ....fitting.sharp.spline_curve import chord
from ....intrinsics import borrowed, keep_alive
from ....types import BoolArray, FloatArray, IntArray
from .gates import (
    Limits,
    crosses_handles,
    joint_turn,
    jumps_of,
    mark_joints,
    mark_turns,
    misses,
    on_grid,
    passes,
)
from .harmony import AXIS, FIXED, FREE, HELD, Run, end_jump, harmonise
from .lattice import meet, round_run

UPRIGHT = np.sin(np.radians(1.5))
"""Sine of the angle to an axis up to which the tangent at an extremum is the axis."""

SHARES = (0.95, 0.8, 0.5, 0.2, 0.2, 0.0, 0.0)
"""Of the tolerance: how near a cubic is to be before it is moved and rounded, on each try of its stretch. With 0 it is
of one segment."""

EASE = (1.0, 0.2, 0.1, 0.03, 0.0, 0.0, 0.0)
"""Weight of the curvatures at its ends, likewise."""

KEPT = len(SHARES) - 2
"""Tries after which a stretch stays as the source has it; one of quadratics, which as cubics are not on the grid, is
tried there once more."""

ATTEMPTS = 20
"""Tries of a run before it stays as it is. With 10, EB Garamond has 5 more curves, in the same time."""

SEEN = 6
"""How many fits of single cubics are kept from each joint on; most cubics cover fewer segments."""

REACH = 1
"""How many cubics on either side of those that are tried again move with them."""

WAYS = ((0, False), (1, False), (2, False), (1, True), (2, True))
"""How curvatures are let meet at a node, one way after the other: how many cubics on either side of it are moved
together (none: nearby places alone), and whether other nodes are held to the jumps they have. Without the last two, 69
of 1,074 jumps of EB Garamond are left instead of 60, and 129 of 1,122 of its Italic instead of 111."""

OTHERS = 0.03
"""Weight of other nodes at which curvatures jump, where they are not held to that: with 0, more joints jump by more
than the source's, and those of round letters stay."""

SLACK = 0.06
"""Jump of curvature that may stay at the node, where others are held to theirs: to this much less than they have, which
leaves room for rounding."""

HOPELESS = 1.7, 0.5
"""Distance, in tolerances, and jump of curvature beyond which cubics that are not rounded yet are given up."""

BEYOND = 0.3e-3
"""Of the em: how far a cubic may pass the ends of its span before it is rounded, where the source's segments do not."""

STRAIGHT = 0.6e-3
"""Of the em: how far from its chord a stretch with a line is at least if a curve takes its place."""

PRICE_OF_LINE = 0.1
"""Of a line that stays, in cubics."""


@compiled
def alone(joints: Joints, v: int) -> Joints:
    """The joints of one master, which share their arrays with those of all."""
    return Joints(
        joints.samples[v : v + 1], joints.places, joints.first, joints.spacing, joints.corner, joints.hard,
        joints.arriving[v : v + 1], joints.leaving[v : v + 1], joints.tied, joints.line,
    )  # fmt: skip


@compiled
def cut_at(joints: Joints) -> BoolArray:
    """(m + 1,) the joints at which runs end: corners, and the ends of long lines."""
    m = len(joints.line)
    found = joints.corner.copy()
    for j in range(m):
        found[j] = found[j] or joints.line[j] or joints.line[j - 1]
    found[m] = found[0]
    return found


@compiled
def set_upright(cubics: FloatArray, joints: Joints) -> BoolArray:
    """(m + 1,) at which smooth joints of one master the outline is horizontal or vertical.

    Their tangents become the axis.
    """
    m = len(cubics)
    found = np.zeros(m + 1, dtype=np.bool_)
    for j in range(m):
        if joints.corner[j] or joints.line[j] or joints.line[j - 1]:
            continue
        x, y = joints.leaving[0, j]
        _, _, bx, by = directions(cubics, j - 1, NO_HANDLE)
        ax, ay, _, _ = directions(cubics, j, NO_HANDLE)
        flat = ay == 0.0 or by == 0.0
        upright = ax == 0.0 or bx == 0.0
        if (flat or upright) and min(abs(x), abs(y)) < UPRIGHT:
            x, y = (np.sign(x), 0.0) if abs(x) > abs(y) else (0.0, np.sign(y))
            joints.leaving[0, j, 0], joints.leaving[0, j, 1] = x, y
            joints.arriving[0, j, 0], joints.arriving[0, j, 1] = x, y
            found[j] = True
    joints.leaving[:, m], joints.arriving[:, m], found[m] = joints.leaving[:, 0], joints.arriving[:, 0], found[0]
    return found


@compiled
def between(joints: Joints, a: int, b: int, near: float, rounds: int, cubic: FloatArray) -> float:
    """Fit one cubic (K, 4, 2) from joint a to joint b in each master; the largest distance of a sample."""
    tangents = np.empty((len(cubic), 2, 2))
    error = fit_between(joints, a, b, near, rounds, tangents)
    if error < np.inf:
        i, j = joints.first[a], joints.first[b]
        third = chord(joints.samples, i, j) / 3
        for v in range(len(cubic)):
            p, q = joints.samples[v, i], joints.samples[v, j]
            cubic[v, 0], cubic[v, 3] = p, q
            cubic[v, 1], cubic[v, 2] = p + third * tangents[v, 0], q - third * tangents[v, 1]
    return error


@compiled
def chosen_nodes(
    cubics: FloatArray, degrees: IntArray, joints: Joints, i: int, j: int, share: FloatArray, limits: Limits,
    known: FloatArray, fits: FloatArray, places: IntArray, P: FloatArray,
) -> int:  # fmt: skip
    """Cover the segments from joint i to joint j by the fewest cubics, the same in all masters.

    Args:
        share: (n,) of each segment: of the tolerance that its cubic may use; 0 keeps it.
        known, fits: (n, SEEN, 2), (n, SEEN, K, 4, 2) single cubics of earlier calls, of two segments and more from each
            joint on: how near they were to be and are, and the cubics. Those fitted now are added.
        places: (n + 1,) receives the nodes, as numbers of segments from i. P: (K, n, 4, 2) receives the cubics.

    Returns:
        Their number.
    """
    n, masters, flat = j - i, len(cubics), STRAIGHT * limits.em
    price, following, past = np.zeros(n + 1), np.empty(n, dtype=np.int64), np.empty(masters)
    found, cubic = np.empty((n, masters, 4, 2)), np.empty((masters, 4, 2))
    for a in range(n - 1, -1, -1):
        price[a] = (PRICE_OF_LINE if degrees[i + a] == 1 else 1.0) + price[a + 1]
        following[a] = a + 1
        least, misses, lines = share[a], 0, degrees[i + a] == 1
        past[:] = BEYOND * limits.em
        for v in range(masters):
            found[a, v] = cubics[v, i + a]
            past[v] = max(past[v], passes(cubics[v, i + a]))
        for b in range(a + 2, n + 1):
            least = min(least, share[b - 1])
            for v in range(masters):
                past[v] = max(past[v], passes(cubics[v, i + b - 1]))
            if least == 0.0 or misses > 1:
                break
            lines = lines or degrees[i + b - 1] == 1
            straight = lines and is_straight(joints.samples, joints.first[i + a], joints.first[i + b], flat)
            if 1.0 + price[b] >= price[a] or straight:
                continue
            near = least * limits.tolerance
            slot = min(b - a - 2, SEEN - 1)
            if slot < SEEN - 1 and known[a, slot, 0] == near:
                error, cubic[:] = known[a, slot, 1], fits[a, slot]
            else:
                error = between(joints, i + a, i + b, near, limits.rounds, cubic)
                known[a, slot, 0], known[a, slot, 1], fits[a, slot] = near, error, cubic
            good = error <= near
            for v in range(masters):
                good = good and passes(cubic[v]) <= past[v] and not crosses_handles(cubic[v])
            if not good:
                misses += 1 if error < 2.0 * near else 2
                continue
            misses = 0
            cost = 1.0 + 0.05 * error / near + price[b]
            if cost < price[a]:
                price[a], following[a], found[a] = cost, b, cubic
    a = r = 0
    while a < n:
        places[r], P[:, r] = a, found[a]
        a, r = following[a], r + 1
    places[r] = n
    return r


@compiled
def as_run(
    cubics: FloatArray, degrees: IntArray, joints: Joints, upright: BoolArray, i: int, closed: bool, r: int,
    places: IntArray, P: FloatArray, stays: BoolArray, ease: FloatArray, settled: BoolArray,
) -> Run:  # fmt: skip
    """The r cubics of a run with what their nodes may do.

    Cubics that are settled are held, and those of a segment that stays.
    """
    held, kind, T = np.zeros(r, dtype=np.bool_), np.full(r + 1, FREE), np.empty((r + 1, 2))
    extrema = np.zeros(r, dtype=np.int64)
    for s in range(r):
        for k in range(i + places[s], i + places[s + 1]):
            extrema[s] += hidden_extrema(cubics[k % len(cubics)])
        one = places[s + 1] - places[s] == 1
        held[s] = settled[s] or (one and (stays[places[s]] or degrees[i + places[s]] == 1))
    for s in range(r + 1):
        k = i + places[s]
        T[s] = joints.leaving[0, k]
        if not closed and s in (0, r):
            kind[s] = FIXED if joints.corner[k] else HELD
            T[s] = joints.leaving[0, k] if s == 0 else joints.arriving[0, k]
            continue
        before, behind = s - 1 if s > 0 else r - 1, s if s < r else 0
        if held[before] or held[behind]:
            kind[s] = HELD
            q = P[before : before + 1] if held[before] else P[behind : behind + 1]
            ax, ay, bx, by = directions(q, 0, NO_HANDLE)
            x, y = (bx, by) if held[before] else (ax, ay)
            size = max(length(x, y), 1e-12)
            T[s, 0], T[s, 1] = x / size, y / size
        elif upright[k]:
            kind[s] = AXIS
    return Run(
        P[:r].copy(), held, kind, T, places[: r + 1].copy(), extrema, ease[places[: r + 1]], np.zeros(r + 1), closed
    )  # fmt: skip


@compiled
def take_settled(
    P: FloatArray, r: int, places: IntArray, closed: bool, done: FloatArray, until: IntArray
) -> BoolArray:  # fmt: skip
    """(r,) which cubics of a run stay as the last try left them: good, and away from all that is fitted again."""
    settled = np.ones(r, dtype=np.bool_)
    for s in range(r):
        if until[places[s]] != places[s + 1]:
            for away in range(-REACH, REACH + 1):
                if closed or 0 <= s + away < r:
                    settled[(s + away) % r] = False
    for s in range(r):
        if settled[s]:
            P[:, s] = done[:, places[s]]
    for s in range(r):
        q = (s + 1) % r
        if settled[s] == settled[q] or (q == 0 and not closed):
            continue
        move = P[:, s, 3] - P[:, q, 0]
        for k in range(2):
            if settled[s]:
                P[:, q, k] += move
            else:
                P[:, s, 3 - k] -= move
    return settled


@compiled
def fit_run(
    cubics: FloatArray, degrees: IntArray, joints: Joints, upright: BoolArray, i: int, j: int, closed: bool,
    start: IntArray, limits: Limits,
) -> tuple[FloatArray, IntArray]:  # fmt: skip
    """The segments from joint i to joint j as fewer cubics, or with curvatures that meet; or as they are.

    Args:
        cubics: (K, m, 4, 2). upright: (K, m + 1). start: (m,) tries of each segment that were in vain.

    Returns:
        (K, r, 4, 2) the cubics, and (r + 1,) the nodes: numbers of joints.
    """
    n, masters, em = j - i, len(cubics), limits.em
    share, tries = np.empty(n), start[i:j].copy()
    places, P, ease = np.empty(n + 1, np.int64), np.empty((masters, n, 4, 2)), np.ones(n + 1)
    for k in range(n):
        share[k] = SHARES[tries[k]]
        ease[k] = min(ease[k], EASE[tries[k]])
        ease[k + 1] = EASE[tries[k]]
    source = cubics[:, i:j].copy()
    before, whole = jumps_of(source, degrees[i:j], closed, em), on_grid(source, degrees[i:j], closed)
    last, ends, most = source, np.arange(n + 1), KEPT + (not whole and (degrees[i:j] == 2).any())
    known, fits = np.zeros((n, SEEN, 2)), np.empty((n, SEEN, masters, 4, 2))
    done, until = np.empty((masters, n, 4, 2)), np.zeros(n, np.int64)
    for _ in range(ATTEMPTS):
        r = chosen_nodes(cubics, degrees, joints, i, j, share, limits, known, fits, places, P)
        if r == n and before == 0 and whole:
            break
        settled = take_settled(P, r, places, closed, done, until)
        found, bad = np.empty((masters, r, 4, 2)), np.zeros(r, dtype=np.bool_)
        for v in range(masters):
            own = alone(joints, v)
            owned = as_run(
                cubics[v], degrees, own, upright[v], i, closed, r, places, P[v], tries >= most, ease, settled
            )  # fmt: skip
            run = borrowed(owned)
            harmonise(run, own, i, limits.tolerance, em)
            round_run(run, own, i, limits.tolerance, em)
            mark_joints(run, cubics[v], i, em, (tries >= KEPT) & (most > KEPT), bad)
            found[v] = run.P
        mark_turns(found, run, cubics, joints, i, limits.mixes, bad)
        bad |= misses(found, run, cubics, i, limits, 0.98)
        good = True
        until[:] = 0
        for s in range(r):
            if not bad[s]:
                done[:, places[s]], until[places[s]] = found[:, s], places[s + 1]
            if bad[s] and not run.held[s]:
                good = False
                for k in range(places[s], places[s + 1]):
                    tries[k] = min(tries[k] + 1, most)
                    share[k] = SHARES[tries[k]]
                for k in (places[s], places[s + 1]):
                    ease[k] = EASE[tries[places[s]]]
        if closed:
            ease[0] = ease[n] = min(ease[0], ease[n])
        if good:
            if r < n or not whole or jumps_of(found, degrees[i:j], closed, em) < before:
                last, ends = found, places[: r + 1]
            break
        keep_alive(owned)
    kinds = np.array([degrees[i + ends[s]] if ends[s + 1] == ends[s] + 1 else 3 for s in range(len(ends) - 1)])
    if masters == 1 and on_grid(last, kinds, closed):
        let_meet(last, cubics, degrees, joints, upright, i, closed, ends, start, limits)
    return last, i + ends


@compiled
def let_meet(
    P: FloatArray, cubics: FloatArray, degrees: IntArray, joints: Joints, upright: BoolArray, i: int, closed: bool,
    places: IntArray, start: IntArray, limits: Limits,
) -> None:  # fmt: skip
    """Let curvatures meet at single nodes of a run on the grid, (1, r, 4, 2), where that is certified.

    Each node is tried in all :data:`WAYS`, and once more if cubics near it have changed. Fewer curvatures jump in the
    run then, and none by more than a try of it allows.
    """
    r, m = P.shape[1], cubics.shape[1]
    stays, none, ones = np.zeros(r, np.bool_), np.zeros(len(start), np.bool_), np.ones(len(start) + 1)
    room = np.empty((2, 2025, 8))
    for s in range(r):
        k = (i + places[s]) % m
        # What a check found something in as often as KEPT may meet still, but where it is put on the grid for that.
        stays[s] = start[k] + (degrees[k] == 2) > KEPT or (places[s + 1] == places[s] + 1 and degrees[k] == 1)
    waiting = np.ones(r, np.bool_)
    for node in range(2 * r):
        q = node % r
        if (q == 0 and not closed) or r == 1 or stays[q - 1] or stays[q] or not waiting[q]:
            continue
        if joint_turn(P[0, q - 1 : q] if q > 0 else P[0, r - 1 :], P[0, q : q + 1]) > SMOOTH_KINK:
            continue
        for wide, held in WAYS:
            if end_jump(P[0, q - 1], P[0, q], limits.em) <= 0.1:
                break
            settled = away_from(q, max(wide, 1), stays, closed)
            owned = as_run(
                cubics[0], degrees, joints, upright[0], i, closed, r, places, P[0], none, ones, settled
            )  # fmt: skip
            run = borrowed(owned)
            if meets(run, q, wide, held, P, settled, cubics, joints, i, limits, room):
                P[0] = run.P
                # Its cubics have changed as far as the widest way reaches, and as far beyond nodes depend on them.
                for away in range(-2 * WAYS[-1][0], 2 * WAYS[-1][0] + 1):
                    waiting[(q + away) % r] = True
            keep_alive(owned)
        waiting[q] = False


@compiled
def away_from(q: int, wide: int, stays: BoolArray, closed: bool) -> BoolArray:
    """(r,) the cubics of a run that do not move for node q: those more than so many away, or beyond one that stays."""
    r = len(stays)
    settled = np.ones(r, np.bool_)
    for side in range(2):
        for away in range(wide):
            s = q + away if side else q - 1 - away
            if (not closed and not 0 <= s < r) or stays[s % r]:
                break
            settled[s % r] = False
    return settled


@compiled
def meets(
    run: Run, q: int, wide: int, held: bool, P: FloatArray, settled: BoolArray, cubics: FloatArray, joints: Joints,
    i: int, limits: Limits, room: FloatArray,
) -> bool:  # fmt: skip
    """Move the cubics of a run so that curvatures meet at node q; whether it is better then than P (1, r, 4, 2).

    Args:
        wide, held: see :data:`WAYS`. settled: (r,) those that do not move. room: of :func:`.lattice.meet`.
    """
    r, em, kinds = len(run.P), limits.em, np.full(len(run.P), 3)
    if wide > 0 and not moved_together(run, q, held, P, settled, cubics, joints, i, limits):
        return False
    for s in range(0 if run.closed else 1, r):
        jumped = s != q and end_jump(P[0, s - 1], P[0, s], em) > 0.1
        if not jumped and not settled[s - 1] and not settled[s] and end_jump(run.P[s - 1], run.P[s], em) > 0.1:
            meet(run, s, joints, i, limits.tolerance, em, room)
    new, bad = run.P.copy().reshape((1, r, 4, 2)), np.zeros(r, np.bool_)
    if jumps_of(new, kinds, run.closed, em) >= jumps_of(P, kinds, run.closed, em):
        return False
    if wide > 0:
        mark_joints(run, cubics[0], i, em, np.zeros(run.places[r], np.bool_), bad)
    for s in range(r):
        bad[s] = bad[s] or (crosses_handles(run.P[s]) and not crosses_handles(P[0, s]))
    mark_turns(new, run, cubics, joints, i, limits.mixes, bad)
    bad |= misses(new, run, cubics, i, limits, 0.999)
    return not (bad & ~settled).any()


@compiled
def moved_together(
    run: Run, q: int, held: bool, P: FloatArray, settled: BoolArray, cubics: FloatArray, joints: Joints, i: int,
    limits: Limits,
) -> bool:  # fmt: skip
    """Move the cubics beside node q together and round them; False where that is given up. See :func:`meets`."""
    r, em = len(run.P), limits.em
    for s in range(0 if run.closed else 1, r):
        jump = end_jump(P[0, s - 1], P[0, s], em)
        if held:
            run.slack[s] = SLACK if s == q else max(jump - SLACK, SLACK / 2)
        elif s != q and jump > 0.1:
            run.ease[s] = OTHERS
    run.ease[r], run.slack[r] = run.ease[0], run.slack[0]
    harmonise(run, joints, i, limits.tolerance, em)
    far = misses(run.P.copy().reshape((1, r, 4, 2)), run, cubics, i, limits, HOPELESS[0])
    if (far & ~settled).any() or end_jump(run.P[q - 1], run.P[q], em) > HOPELESS[1]:
        return False
    round_run(run, joints, i, limits.tolerance, em)
    return True


@compiled
def fit_contour(
    cubics: FloatArray, degrees: IntArray, joints: Joints, start: IntArray, limits: Limits, fresh: BoolArray,
    last: FloatArray, last_nodes: IntArray,
) -> tuple[FloatArray, IntArray, IntArray, BoolArray]:  # fmt: skip
    """A contour (K, m, 4, 2) that begins at a cut, if it has any.

    Args:
        fresh: (m,) segments that are to be fitted. Runs without any are those of ``last`` (K, r', 4, 2), which begin at
            the joints ``last_nodes``, in order.

    Returns:
        (K, r, 4, 2) its lines and cubics; (r,) their degrees; (r + 1,) the joints at which they begin and end; (r,)
        whether one begins inside a run.
    """
    masters, m = cubics.shape[:2]
    cuts, upright = cut_at(joints), np.empty((masters, m + 1), dtype=np.bool_)
    for v in range(masters):
        upright[v] = set_upright(cubics[v], alone(joints, v))
    found, nodes, kinds, count = np.empty((masters, m, 4, 2)), np.empty(m + 1, np.int64), np.empty(m, np.int64), 0
    inner = np.zeros(m, dtype=np.bool_)
    i = 0
    while i < m:
        j = i + 1
        while j < m and not cuts[j]:
            j += 1
        closed, source = i == 0 and j == m and not cuts[0], cubics[:, i:j].copy()
        if j == i + 1 and not closed and (degrees[i] == 1 or on_grid(source, degrees[i:j], closed)):
            run, own = source, np.array([i, j])
        elif not fresh[i:j].any():
            a, b = np.searchsorted(last_nodes, i), np.searchsorted(last_nodes, j)
            run, own = last[:, a:b].copy(), np.append(last_nodes[a:b], j)
        else:
            run, own = fit_run(cubics, degrees, joints, upright, i, j, closed, start, limits)
        end = count + run.shape[1]
        found[:, count:end], nodes[count:end], inner[count:end], inner[count] = run, own[:-1], True, closed
        kinds[count:end] = np.where((np.diff(own) == 1) & (degrees[own[:-1]] == 1), 1, 3)
        i, count = j, end
    nodes[count] = m
    return found[:, :count].copy(), kinds[:count], nodes[: count + 1], inner[:count]
