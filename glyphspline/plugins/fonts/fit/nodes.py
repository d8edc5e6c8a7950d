"""Nodes of a run: the fewest cubics, each between joints of the outline, that are near enough to it by themselves."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from ....arrays import put
from ....compiled import compiled
from ....fitting.sharp.corners import JointArrays, Joints
from ....fitting.sharp.cubics import fit_between, is_straight
from ....fitting.sharp.spline_curve import chord
from ....types import FloatArray, IntArray
from .gates import crosses_handles, passes

SEEN = 6
"""How many fits of single cubics are kept from each joint on; most cubics cover fewer segments."""

BEYOND = 0.3e-3
"""Of the em: how far a cubic may pass the ends of its span before it is rounded, where the source's segments do not."""

STRAIGHT = 0.6e-3
"""Of the em: how far from its chord a stretch with a line is at least if a curve takes its place."""

PRICE_OF_LINE = 0.1
"""Of a line that stays, in cubics."""

Seen: TypeAlias = tuple[FloatArray, FloatArray]
"""(n, SEEN, 2), (n, SEEN, K, 4, 2) single cubics, of two segments and more from each joint on: how near they were to be
and are, and the cubics."""


@compiled
def between(joints: Joints, a: int, b: int, near: float, rounds: int, cubic: FloatArray) -> float:
    """Fit one cubic (K, 4, 2) from joint a to joint b in each master; the largest distance of a sample."""
    tangents = np.empty((len(cubic), 2, 2))
    error = fit_between(joints, a, b, near, rounds, tangents)
    if error < np.inf:
        i, j = joints.first[a], joints.first[b]
        third = chord(joints.samples, i, j) / 3
        for v in range(len(cubic)):
            for axis in range(2):
                p, q = joints.samples[v, i, axis], joints.samples[v, j, axis]
                cubic[v, 0, axis], cubic[v, 1, axis] = p, p + third * tangents[v, 0, axis]
                cubic[v, 2, axis], cubic[v, 3, axis] = q - third * tangents[v, 1, axis], q
    return error


@compiled
def chosen_nodes(
    cubics: FloatArray, degrees: IntArray, arrays: JointArrays, i: int, share: FloatArray,
    limits: tuple[float, float, int], seen: Seen, places: IntArray, P: FloatArray,
) -> int:  # fmt: skip
    """Cover n segments from joint i on by the fewest cubics, the same in all masters.

    Args:
        cubics, degrees, arrays: of the contour, (K, m, 4, 2), and its :class:`.corners.Joints`.
        share: (n,) of each segment: of the tolerance that its cubic may use; 0 keeps it.
        limits: the tolerance, the em, and the rounds of a cubic's fit. seen: of earlier calls; this one's are added.
        places: (n + 1,) receives the nodes, as numbers of segments from i. P: (K, n, 4, 2) receives the cubics.

    Returns:
        Their number.
    """
    joints, (tolerance, em, rounds), (known, fits) = Joints(*arrays), limits, seen
    n, masters, flat = len(share), len(cubics), STRAIGHT * em
    price, following, past = np.zeros(n + 1), np.empty(n, dtype=np.int64), np.empty(masters)
    found, cubic = np.empty((n, masters, 4, 2)), np.empty((masters, 4, 2))
    for a in range(n - 1, -1, -1):
        price[a] = (PRICE_OF_LINE if degrees[i + a] == 1 else 1.0) + price[a + 1]
        following[a] = a + 1
        least, misses, lines = share[a], 0, degrees[i + a] == 1
        for v in range(masters):
            put(cubics[v, i + a], found[a, v])
            past[v] = max(BEYOND * em, passes(cubics[v, i + a]))
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
            near = least * tolerance
            slot = min(b - a - 2, SEEN - 1)
            if slot < SEEN - 1 and known[a, slot, 0] == near:
                error = known[a, slot, 1]
                put(fits[a, slot], cubic)
            else:
                error = between(joints, i + a, i + b, near, rounds, cubic)
                known[a, slot, 0], known[a, slot, 1] = near, error
                put(cubic, fits[a, slot])
            good = error <= near
            for v in range(masters):
                good = good and passes(cubic[v]) <= past[v] and not crosses_handles(cubic[v])
            if not good:
                misses += 1 if error < 2.0 * near else 2
                continue
            misses = 0
            cost = 1.0 + 0.05 * error / near + price[b]
            if cost < price[a]:
                price[a], following[a] = cost, b
                put(cubic, found[a])
    a = r = 0
    while a < n:
        places[r] = a
        for v in range(masters):
            put(found[a, v], P[v, r])
        a, r = following[a], r + 1
    places[r] = n
    return r
