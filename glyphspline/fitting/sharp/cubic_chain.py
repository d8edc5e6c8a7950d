"""The fewest cubics and lines for a stretch of outline, joined without a kink: dynamic programming over its joints.

This is ``continuity="g1"``: each cubic is a fit of its own, and variant 2 does not run.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import length
from ...types import FloatArray, IntArray
from .corners import Joints
from .cubic_fit import fit_cubic
from .pieces import ONLY, Pieces, add_piece
from .spline_curve import chord
from .split_contours import Settings

SEGMENT_PRICE = 1.5
"""Numbers that saving one segment is worth."""

PRICE_OF_LINE, PRICE_OF_CUBIC = 2.0 + SEGMENT_PRICE, 6.0 + SEGMENT_PRICE
"""Prices of a line, which stores 2 numbers, and of a cubic, which stores 6."""

NEAR_MISS = 2.0
"""Cubics that miss the tolerance by less than this factor do not rule out longer ones."""


@compiled
def is_straight(samples: FloatArray, a: int, b: int, tolerance: float) -> bool:
    """Whether samples a to b run along their chord, in order, within the tolerance in every master."""
    straight = True
    for v in range(len(samples)):
        straight = straight and _is_straight(samples[v], a, b, tolerance)
    return straight


@compiled
def _is_straight(samples: FloatArray, a: int, b: int, tolerance: float) -> bool:
    """The same in one master."""
    x, y = samples[b, 0] - samples[a, 0], samples[b, 1] - samples[a, 1]
    length = np.hypot(x, y)
    if length <= tolerance:
        return False
    x, y = x / length, y / length
    reached = 0.0
    for j in range(a + 1, b):
        dx, dy = samples[j, 0] - samples[a, 0], samples[j, 1] - samples[a, 1]
        along, across = dx * x + dy * y, abs(dy * x - dx * y)
        if across > tolerance or along < reached - tolerance or along > length + tolerance:
            return False
        reached = max(reached, along)
    return True


@compiled
def fit_between(joints: Joints, i: int, j: int, tolerance: float, rounds: int, tangents: FloatArray) -> float:
    """A cubic from joint i to joint j, in each master by itself; tangents at corners are free to turn.

    Args:
        tolerance, rounds: see :func:`.cubic_fit.fit_cubic`. tangents: (K, 2, 2) receives the end tangents.

    Returns:
        The largest distance of a sample; infinite if there is no cubic.
    """
    worst = 0.0
    for v in range(len(tangents)):
        error = fit_cubic(
            joints.samples[v, joints.first[i] : joints.first[j] + 1], joints.leaving[v, i], joints.corner[i],
            joints.arriving[v, j], joints.corner[j], tolerance, rounds, tangents[v, 0], tangents[v, 1],
        )  # fmt: skip
        worst = max(worst, error)
        if worst == np.inf:
            return worst
    whole = chord(joints.samples, joints.first[i], joints.first[j])
    for v in range(len(tangents) if len(tangents) > 1 else 0):
        Q = joints.samples[v]
        own = length(Q[joints.first[j], 0] - Q[joints.first[i], 0], Q[joints.first[j], 1] - Q[joints.first[i], 1])
        for end in range(2):
            for axis in range(2):
                tangents[v, end, axis] *= own / whole
    return worst


@compiled
def add_cubics(joints: Joints, c: int, nodes: IntArray, settings: Settings, pieces: Pieces, count: int) -> int:
    """Add the cheapest way from nodes[0] to nodes[-1] of contour c by lines and cubics between the joints ``nodes``.

    From the last node backwards; from each one the ends are tried in the order of the price they promise, so that the
    first that can be kept is the best. Returns the number of pieces then.
    """
    J, tolerance = len(nodes) - 1, settings.near
    rest, following, errors = np.empty(J + 1), np.empty(J + 1, dtype=np.int64), np.empty(J + 1)
    masters = len(joints.samples)
    spans, tangents = np.empty(J + 1, dtype=np.int64), np.empty((J + 1, masters, 2, 2))
    out, carried = np.zeros(J + 1, dtype=np.bool_), np.zeros(J + 1, dtype=np.bool_)
    rest[J] = 0.0
    for i in range(J - 1, -1, -1):
        # The node from which the rest is cheapest among those that a straight line may end at; i if there is none.
        line = i
        for j in range(i + 1, (J if joints.corner[nodes[i]] else i) + 1):
            if not is_straight(joints.samples, joints.first[nodes[i]], joints.first[nodes[j]], tolerance):
                if j > i + 3:
                    break
            elif joints.corner[nodes[j]] and (line == i or rest[j] < rest[line]):
                line = j
        while True:
            best, at, k = np.inf, i + 1, 1
            for j in range(i + 1, J + 1):
                if not out[j] and PRICE_OF_CUBIC + rest[j] <= best:
                    best, at = PRICE_OF_CUBIC + rest[j], j
            if line > i and PRICE_OF_LINE + rest[line] <= best:
                best, at, k = PRICE_OF_LINE + rest[line], line, 0
                error = 0.0
                break
            error = fit_between(joints, nodes[i], nodes[at], tolerance, settings.rounds, tangents[i])
            if error <= tolerance:
                break
            if at == i + 1:
                # What cannot be fitted stays as the source has it, a cubic a segment.
                best = (nodes[at] - nodes[i]) * PRICE_OF_CUBIC + rest[at]
                break
            for j in range(at, J + 1):
                out[j] = True
                # A near miss may be due to the tangent here: it says little of what begins before.
                carried[j] = carried[j] or not error < NEAR_MISS * tolerance
        rest[i], following[i], errors[i], spans[i] = best, at, error, k
        for j in range(J + 1):
            out[j] = carried[j]
    i = 0
    while i < J:
        j = following[i]
        p, places = ends(joints, nodes[i], nodes[j])
        count = add_piece(pieces, count, (c, nodes[i], nodes[j], spans[i], 0, ONLY), p, places, tangents[i], errors[i])
        i = j
    return count


@compiled
def ends(joints: Joints, i: int, j: int) -> tuple[FloatArray, FloatArray]:
    """(K, 2, 2) the points at two joints, and their places."""
    p, places = np.empty((len(joints.samples), 2, 2)), np.empty(2)
    for v in range(len(p)):
        for axis in range(2):
            p[v, 0, axis] = joints.samples[v, joints.first[i], axis]
            p[v, 1, axis] = joints.samples[v, joints.first[j], axis]
    places[0], places[1] = i, j
    return p, places
