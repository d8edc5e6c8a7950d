"""The fewest arcs and lines for a stretch of outline: dynamic programming over its joints.

An arc of k spans stores 2 k + 4 numbers (its vertices and two end tangents), a line 2; each span and each line is a
segment of the result. Splitting a stretch at a joint of the source saves segments where its curvature jumps, and
costs numbers: the price of a segment balances the two.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...types import FloatArray, IntArray
from .bezier_fit import fit_cubic
from .corners import Joints
from .spline_fit import fit_arc

SEGMENT_PRICE = 1.5
"""Numbers that saving one segment is worth."""

MOST_SPANS = {"fast": 1, "best": 4}
"""Spans an arc has at most, by effort. More spare few numbers, and each doubles the arcs to be tried."""


NEAR_MISS = 2.0
"""Arcs that miss the tolerance by less than this factor do not rule out longer ones of as many spans."""


@compiled
def price(k: int) -> float:
    """Price of an arc of k spans; of a line for k = 0."""
    return 2.0 + SEGMENT_PRICE if k == 0 else 2.0 * k + 4.0 + SEGMENT_PRICE * k


@compiled
def is_straight(samples: FloatArray, a: int, b: int, tolerance: float) -> bool:
    """Whether samples a to b run along their chord, in order, within the tolerance."""
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
def set_ends(joints: Joints, i: int, j: int, p: FloatArray) -> None:
    """The vertices of a piece without inner ones."""
    for axis in range(2):
        p[0, axis], p[1, axis] = joints.samples[joints.first[i], axis], joints.samples[joints.first[j], axis]


@compiled
def fit_between(
    joints: Joints,
    i: int,
    j: int,
    k: int,
    tolerance: float,
    margin: float,
    residual: float,
    rounds: int,
    p: FloatArray,
    start: FloatArray,
    end: FloatArray,
) -> float:
    """:func:`.spline_fit.fit_arc` from joint i to joint j; tangents at corners are free to turn."""
    a, b = joints.first[i], joints.first[j] + 1
    if k == 1:
        set_ends(joints, i, j, p)
        return fit_cubic(
            joints.samples[a:b],
            joints.leaving[i],
            joints.corner[i],
            joints.arriving[j],
            joints.corner[j],
            tolerance,
            rounds,
            start,
            end,
        )
    return fit_arc(
        joints.samples[a:b],
        joints.density[a:b],
        k,
        joints.leaving[i],
        joints.corner[i],
        joints.arriving[j],
        joints.corner[j],
        tolerance,
        margin,
        residual,
        rounds,
        p,
        start,
        end,
    )


class Cut(NamedTuple):
    """A contour cut into lines and arcs.

    Attributes:
        rows: (r, 3) joint, next joint and number of spans of each piece; no spans for a line.
        vertices: (r, most + 1, 2) and tangents: (r, 2, 2), as far as they are used.
        errors: (r,) largest distance of a sample from each arc.
    """

    rows: IntArray
    vertices: FloatArray
    tangents: FloatArray
    errors: FloatArray


@compiled
def room(count: int, most: int) -> Cut:
    """Room for so many pieces of at most so many spans."""
    rows = np.zeros((count, 3), dtype=np.int64)
    return Cut(rows, np.zeros((count, most + 1, 2)), np.zeros((count, 2, 2)), np.zeros(count))


@compiled
def copy_piece(a: Cut, i: int, b: Cut, j: int) -> None:
    """Write a's piece i where b has its piece j."""
    b.errors[j] = a.errors[i]
    for k in range(3):
        b.rows[j, k] = a.rows[i, k]
    for axis in range(2):
        for end in range(2):
            b.tangents[j, end, axis] = a.tangents[i, end, axis]
        for k in range(a.rows[i, 2] + 1 if a.rows[i, 2] > 0 else 2):
            b.vertices[j, k, axis] = a.vertices[i, k, axis]


@compiled
def cheapest(
    joints: Joints, nodes: IntArray, tolerance: float, margin: float, residual: float, rounds: int, most: int,
    result: Cut, count: int,
) -> int:  # fmt: skip
    """The cheapest way from nodes[0] to nodes[-1] by lines and arcs between the joints ``nodes``.

    From the last node backwards; from each one the ends are tried in the order of the price they promise, a longer
    stretch being taken to need at least the spans of a shorter one, so that the first that can be kept is the best.
    The pieces go to ``result`` after the ``count`` that are there. Returns their number then.
    """
    J = len(nodes) - 1
    rest, following = np.zeros(J + 1), np.zeros(J + 1, dtype=np.int64)
    least, carried = np.ones(J + 1, dtype=np.int64), np.ones(J + 1, dtype=np.int64)
    kept = room(J, most)  # the piece that begins at each node
    for i in range(J - 1, -1, -1):
        line = _farthest_line(joints, nodes, i, rest, tolerance)
        p, start, end = kept.vertices[i], kept.tangents[i, 0], kept.tangents[i, 1]
        while True:
            best, at = np.inf, i + 1
            for j in range(i + 1, J + 1):
                if least[j] <= most and price(least[j]) + rest[j] <= best:
                    best, at = price(least[j]) + rest[j], j
            if line > i and price(0) + rest[line] <= best:
                best, at, k, error = price(0) + rest[line], line, 0, 0.0
                set_ends(joints, nodes[i], nodes[at], p)
                break
            k = least[at]
            error = fit_between(joints, nodes[i], nodes[at], k, tolerance, margin, residual, rounds, p, start, end)
            own = nodes[at] - nodes[i]
            if error <= tolerance:
                break
            if at == i + 1 and (own == 1 or k == most):
                # What cannot be fitted stays as the source has it, a cubic a segment.
                best = own * price(1) + rest[at]
                break
            more = max(k + 1, min(int(0.7 * k * (error / tolerance) ** 0.25), most + 1) if error < np.inf else 0)
            for j in range(at, J + 1):
                least[j] = max(least[j], k + 1 if j > at else more)
                # A near miss may be due to the tangent here: it says little of what begins before.
                carried[j] = max(carried[j], k if error < NEAR_MISS * tolerance else k + 1)
        rest[i], following[i], kept.errors[i] = best, at, error
        kept.rows[i, 0], kept.rows[i, 1], kept.rows[i, 2] = nodes[i], nodes[at], k
        for j in range(J + 1):
            least[j] = carried[j]
    i = 0
    while i < J:
        copy_piece(kept, i, result, count)
        count += 1
        i = following[i]
    return count


@compiled
def _farthest_line(joints: Joints, nodes: IntArray, i: int, rest: FloatArray, tolerance: float) -> int:
    """The node from which the rest is cheapest among those that a straight line from node i may end at; i if none."""
    found = i
    if not joints.corner[nodes[i]]:
        return found
    for j in range(i + 1, len(nodes)):
        if not is_straight(joints.samples, joints.first[nodes[i]], joints.first[nodes[j]], tolerance):
            if j > i + 3:
                break
        elif joints.corner[nodes[j]] and (found == i or rest[j] < rest[found]):
            found = j
    return found


@compiled
def cut(
    joints: Joints, tolerance: float, margin: float, residual: float, rounds: int, most: int, stride: int
) -> Cut:  # fmt: skip
    """All pieces of a contour whose joint 0 is hard.

    Args:
        joints: of the contour. tolerance: of the fit. margin, residual: of the interpolation.
        rounds: most Gauss-Newton steps an arc. most: spans of an arc.
        stride: arcs end at corners and at every so many joints.
    """
    m = len(joints.line)
    result, count = room(m, most), 0
    nodes = np.empty(m + 1, dtype=np.int64)
    i = 0
    while i < m:
        nodes[0] = i
        last, j = 0, i + 1
        while not joints.hard[j] and j < m:
            if joints.corner[j] or j - nodes[last] >= stride:
                last += 1
                nodes[last] = j
            j += 1
        nodes[last + 1] = j
        if joints.line[i]:
            result.rows[count, 0], result.rows[count, 1] = i, j
            set_ends(joints, i, j, result.vertices[count])
            count += 1
        else:
            count = cheapest(joints, nodes[: last + 2], tolerance, margin, residual, rounds, most, result, count)
        i = j
    return Cut(result.rows[:count], result.vertices[:count], result.tangents[:count], result.errors[:count])
