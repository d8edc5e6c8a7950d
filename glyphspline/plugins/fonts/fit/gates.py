"""What a rounded run is refused for: it is too far from its source, turns or jumps more, or hides extrema."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....compiled import compiled
from ....curves.cubics import directions, length
from ....fitting.sharp.corners import NO_HANDLE, turn_between
from ....types import BoolArray, FloatArray, IntArray
from ..extrema import hidden_extrema
from .harmony import end_jump
from .nearness import certified

CORNER = np.radians(12.5)
"""Turn that a corner keeps."""

KINK = np.radians(0.48)
"""Turn of a joint that a result may have where the source's is smaller."""

MORE, SINGLE = 0.02, 0.5
"""By how much more curvatures may jump where they do in the source: of cubics, and of single segments off the grid."""


DISTANCE, TURNS, ALL = range(3)
"""Gates: the certified distance; that and turns; those, jumps of curvature, extrema and handles."""


class FitLimits(NamedTuple):
    """How runs are fitted, in steps of the grid: the tolerance, the em, and the rounds of a cubic's fit.

    Attributes:
        corners: (V, K) weights of the masters at the corners of the design space's grid. mixes: (M, K) weights with
            which joints are looked at. A single outline is a master with the weight 1.
    """

    tolerance: float
    em: float
    rounds: int
    corners: FloatArray
    mixes: FloatArray


@compiled
def mixed(weights: FloatArray, cubics: FloatArray) -> FloatArray:
    """(m V, 4, 2) instances of segments (K, m, 4, 2) in K masters, with weights (V, K): segment j in rows j V on."""
    K, m = cubics.shape[:2]
    V = len(weights)
    found = np.zeros((m * V, 4, 2))
    for j in range(m):
        for v in range(V):
            for k in range(K):
                for i in range(4):
                    for axis in range(2):
                        found[j * V + v, i, axis] += weights[v, k] * cubics[k, j, i, axis]
    return found


@compiled
def passes(cubic: FloatArray) -> float:
    """How far a cubic passes the box of its ends, at most in a coordinate."""
    most = 0.0
    for axis in range(2):
        p0, p1, p2, p3 = cubic[0, axis], cubic[1, axis], cubic[2, axis], cubic[3, axis]
        a, b, c = p1 - p0, p2 - p1, p3 - p2
        if a * b >= 0 and b * c >= 0:
            continue
        low, high = min(p0, p3), max(p0, p3)
        for k in range(1, 16):
            t = k / 16
            s = 1 - t
            at = s * s * (s * p0 + 3 * t * p1) + t * t * (3 * s * p2 + t * p3)
            most = max(most, max(at - high, low - at))
    return most


@compiled
def crosses_handles(cubic: FloatArray) -> bool:
    """Whether both handles of a cubic reach beyond where they meet, by more than a step of the grid may make."""
    ax, ay, bx, by = (
        cubic[1, 0] - cubic[0, 0],
        cubic[1, 1] - cubic[0, 1],
        cubic[2, 0] - cubic[3, 0],
        cubic[2, 1] - cubic[3, 1],
    )
    x, y = cubic[3, 0] - cubic[0, 0], cubic[3, 1] - cubic[0, 1]
    cross = ax * by - ay * bx
    one, two = length(ax, ay), length(bx, by)
    if abs(cross) <= 0.01 * one * two:
        return False
    s, r = (x * by - y * bx) / cross, (x * ay - y * ax) / cross
    room = 1.4 * one * two / abs(cross)
    return s > 0.0 and r > 0.0 and one * (1 - s) > room and two * (1 - r) > room


@compiled
def joint_turn(before: FloatArray, behind: FloatArray) -> float:
    """The turn of the joint of two cubics (1, 4, 2)."""
    _, _, ax, ay = directions(before, 0, NO_HANDLE)
    bx, by, _, _ = directions(behind, 0, NO_HANDLE)
    return turn_between(ax, ay, bx, by)


@compiled
def misses(
    P: FloatArray, places: IntArray, held: BoolArray, closed: bool, i: int, source: FloatArray, outline: FloatArray,
    corners: FloatArray, tolerance: float,
) -> BoolArray:  # fmt: skip
    """(r,) which cubics of a run are not certified within a tolerance of the source, in the whole design space.

    The run begins at joint i of the source. Every cubic is paired by itself with a stretch of the source.

    Args:
        P: (K, r, 4, 2) the cubics in all masters. places, held, closed: of :class:`.run_nodes.Run`.
        source: (K, m, 4, 2). outline: (m V, 4, 2) that, and corners: (V, K) the weights, at the design space's corners.
    """
    (K, r), m, V = P.shape[:2], source.shape[1], len(corners)
    arc = np.empty(4 if K > 1 else 0)
    if K > 1:
        arc[0], arc[1], arc[2], arc[3] = 0.0, r, i, i + places[r]
        if closed:
            arc[0], arc[1], arc[2], arc[3] = -np.inf, np.inf, -np.inf, np.inf
    hints, stays, far = np.empty(r + 1), np.ones(r + 1, np.bool_), np.empty(r, np.bool_)
    for s in range(r + 1):
        hints[s] = i + places[s]
        q, end = (s, 0) if s < r else (r - 1, 3)
        for v in range(K):
            for axis in range(2):
                stays[s] = stays[s] and P[v, q, end, axis] == source[v, (i + places[s]) % m, 0, axis]
    bounds = certified(V, mixed(corners, P), hints, stays, held, closed, outline, arc, tolerance)
    for s in range(r):
        far[s] = not bounds[s] <= tolerance
    return far


@compiled
def mark_joints(
    P: FloatArray, places: IntArray, extrema: IntArray, closed: bool, i: int, source: FloatArray, em: float,
    single: BoolArray, bad: BoolArray,
) -> None:  # fmt: skip
    """Mark the cubics of a rounded run in one master whose handles cross, or whose curvature jumps, and may not, and
    those with new extrema inside.

    Args:
        P: (r, 4, 2) the cubics. places, extrema, closed: of :class:`.run_nodes.Run`. source: (m, 4, 2).
        single: (n,) segments of the source that are put on the grid by themselves.
    """
    r, m = len(P), len(source)
    for s in range(r):
        alone = places[s + 1] - places[s] == 1
        if crosses_handles(P[s]):
            bad[s] = bad[s] or not alone or not crosses_handles(source[(i + places[s]) % m])
        bad[s] = bad[s] or hidden_extrema(P[s]) > extrema[s]
    for s in range(0 if closed else 1, r):
        k, a = (i + places[s]) % m, s - 1 if s > 0 else r - 1
        more = SINGLE if single[places[a]] or single[places[s]] else MORE
        wrong = end_jump(P[a], P[s], em) > max(end_jump(source[k - 1], source[k], em) + more, 0.1)
        bad[a], bad[s] = bad[a] or wrong, bad[s] or wrong


@compiled
def mark_turns(
    P: FloatArray, places: IntArray, closed: bool, i: int, old: FloatArray, mixes: FloatArray, corner: BoolArray,
    bad: BoolArray,
) -> None:  # fmt: skip
    """Mark the cubics (K, r, 4, 2) of a rounded run at whose joints some mix of the masters turns more than it may.

    Args:
        places, closed: of :class:`.run_nodes.Run`. old: (m M, 4, 2) the source in the mixes (M, K). corner: (m + 1,).
    """
    r, M = P.shape[1], len(mixes)
    m, new = len(old) // M, mixed(mixes, P)
    for s in range(0, r if closed else r + 1):
        k = (i + places[s]) % m
        a, q = (s - 1) % r, s % r
        left = old[(k - 1) % m * M :] if s == 0 and not closed else new[a * M :]
        right = old[k * M :] if s == r else new[q * M :]
        before, after, lost = 0.0, 0.0, False
        for v in range(M):
            turn, now = joint_turn(old[(k - 1) % m * M + v :], old[k * M + v :]), joint_turn(left[v:], right[v:])
            before, after, lost = max(before, turn), max(after, now), lost or now < min(turn, CORNER)
        wrong = lost if corner[k] else after > max(before, KINK)
        if s > 0 or closed:
            bad[a] = bad[a] or wrong
        if s < r:
            bad[q] = bad[q] or wrong


@compiled
def refused(
    P: FloatArray, run: tuple[IntArray, IntArray, BoolArray, bool, int],
    source: tuple[FloatArray, FloatArray, FloatArray, BoolArray], weights: tuple[FloatArray, FloatArray], em: float,
    tolerance: float, gates: int, single: BoolArray,
) -> BoolArray:  # fmt: skip
    """(r,) the cubics (K, r, 4, 2) of a rounded run that one of the gates refuses.

    Args:
        run: its places, most extrema (K, r) inside, cubics that are held, whether it is closed, and its first joint.
        source: the cubics (K, m, 4, 2), the outline at the corners and in the mixes, and (m + 1,) joints that are
            corners. weights: the corners and the mixes of :class:`Limits`. gates: ``DISTANCE``, ``TURNS`` or ``ALL``.
        single: see :func:`mark_joints`.
    """
    (places, extrema, held, closed, i), (cubics, outline, looks, corner), (corners, mixes) = run, source, weights
    bad = misses(P, places, held, closed, i, cubics, outline, corners, tolerance)
    if gates >= TURNS:
        mark_turns(P, places, closed, i, looks, mixes, corner, bad)
    for v in range(len(P) if gates == ALL else 0):
        mark_joints(P[v], places, extrema[v], closed, i, cubics[v], em, single, bad)
    return bad


@compiled
def jumps_of(cubics: FloatArray, degrees: IntArray, closed: bool, em: float) -> int:
    """The number of joints inside a run (K, n, 4, 2) at which curvatures jump by a tenth or more, in all masters."""
    count = 0
    for v in range(len(cubics)):
        for k in range(0 if closed else 1, len(degrees)):
            jumps = degrees[k - 1] > 1 and degrees[k] > 1 and end_jump(cubics[v, k - 1], cubics[v, k], em) > 0.1
            count += 1 if jumps else 0
    return count


@compiled
def on_grid(cubics: FloatArray, degrees: IntArray, closed: bool) -> bool:
    """Whether all points of a run (K, r, 4, 2) are on the grid, but for its ends and those inside lines."""
    r = len(degrees)
    for s in range(r):
        for k in range(0 if s > 0 or closed else 1, 4 if s < r - 1 or closed else 3):
            for v in range(len(cubics) if degrees[s] > 1 or k % 3 == 0 else 0):
                for axis in range(2):
                    if abs(cubics[v, s, k, axis] - np.rint(cubics[v, s, k, axis])) > 1e-6:
                        return False
    return True
