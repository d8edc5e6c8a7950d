"""The fewest arcs and lines for a stretch of outline: dynamic programming over its joints.

An arc of k spans stores 2 k + 4 numbers (its vertices and two end tangents), a line 2; each span and each line is a
segment of the result. Splitting a stretch at a joint of the source saves segments where its curvature jumps, and
costs numbers: the price of a segment balances the two.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...outlines.contour_arrays import ContourArrays
from ...outlines.segments import contour_cubics
from ...types import FloatArray, IntArray
from .bezier_fit import fit_cubic
from .corners import Joints
from .spline_fit import fit_arc
from .split_contours import Settings, SplitContours, laid_out

SEGMENT_PRICE = 1.5
"""Numbers that saving one segment is worth."""

MOST_SPANS = {"fast": 1, "best": 4}
"""Spans an arc has at most, by effort. Larger values save little storage, and each doubles the candidates."""

PRICE_OF_LINE, PRICE_OF_CUBIC = 2.0 + SEGMENT_PRICE, 6.0 + SEGMENT_PRICE
"""Prices of a line and of an arc of one span."""

NEAR_MISS = 2.0
"""Arcs that miss the tolerance by less than this factor do not rule out longer ones of as many spans."""


@compiled(internal=True)
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
def fit_between(
    joints: Joints, i: int, j: int, k: int, tolerance: float, settings: Settings, rounds: int, p: FloatArray,
    tangents: FloatArray,
) -> float:  # fmt: skip
    """A line (k = 0) or an arc of k spans from joint i to joint j; tangents at corners are free to turn.

    Args:
        tolerance, rounds: see :func:`.spline_fit.fit_arc`.
        p, tangents: receive the vertices, and the end tangents of an arc.

    Returns:
        The largest distance of a sample from an arc; infinite if there is none.
    """
    a, b = joints.first[i], joints.first[j] + 1
    if k > 1:
        return fit_arc(
            joints.samples[a:b], joints.density[a:b], k, joints.leaving[i], joints.corner[i], joints.arriving[j],
            joints.corner[j], tolerance, settings.margin, settings.residual, rounds, p, tangents,
        )  # fmt: skip
    for axis in range(2):
        p[0, axis], p[1, axis] = joints.samples[a, axis], joints.samples[b - 1, axis]
    if k == 0:
        return 0.0
    return fit_cubic(
        joints.samples[a:b], joints.leaving[i], joints.corner[i], joints.arriving[j], joints.corner[j], tolerance,
        rounds, tangents[0], tangents[1],
    )  # fmt: skip


class Cut(NamedTuple):
    """Contours cut into lines and arcs.

    Attributes:
        rows: (r, 4) contour, joint, next joint and number of spans of each piece; no spans for a line.
        vertices: (r, most + 1, 2) and tangents: (r, 2, 2), as far as they are used: a line has no tangents.
        errors: (r,) largest distance of a sample from each arc.
    """

    rows: IntArray
    vertices: FloatArray
    tangents: FloatArray
    errors: FloatArray


@compiled(internal=True)
def room(count: int, most: int) -> Cut:
    """Empty arrays for so many pieces of at most so many spans."""
    rows = np.empty((count, 4), dtype=np.int64)
    return Cut(rows, np.empty((count, most + 1, 2)), np.empty((count, 2, 2)), np.empty(count))


@compiled(internal=True)
def cheapest(joints: Joints, nodes: IntArray, settings: Settings, result: Cut, count: int) -> int:
    """The cheapest way from nodes[0] to nodes[-1] by lines and arcs between the joints ``nodes``.

    From the last node backwards; from each one the ends are tried in the order of the price they promise, a longer
    stretch being taken to need at least the spans of a shorter one, so that the first that can be kept is the best.
    The pieces go to ``result`` after the ``count`` that are there. Returns their number then.
    """
    J, tolerance, most = len(nodes) - 1, settings.near, settings.most
    rest, following = np.empty(J + 1), np.empty(J + 1, dtype=np.int64)
    least, carried = np.empty(J + 1, dtype=np.int64), np.empty(J + 1, dtype=np.int64)
    for j in range(J + 1):
        rest[j], following[j], least[j], carried[j] = 0.0, 0, 1, 1
    kept = room(J, most)  # the piece that begins at each node
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
            best, at = np.inf, i + 1
            for j in range(i + 1, J + 1):
                price = 2.0 * least[j] + 4.0 + SEGMENT_PRICE * least[j] + rest[j]
                if least[j] <= most and price <= best:
                    best, at = price, j
            k = least[at]
            if line > i and PRICE_OF_LINE + rest[line] <= best:
                best, at, k = PRICE_OF_LINE + rest[line], line, 0 * k
            error = fit_between(
                joints, nodes[i], nodes[at], k, tolerance, settings, settings.rounds, kept.vertices[i],
                kept.tangents[i],
            )  # fmt: skip
            own = nodes[at] - nodes[i]
            if k == 0 or error <= tolerance:
                break
            if at == i + 1 and (own == 1 or k == most):
                # What cannot be fitted stays as the source has it, a cubic a segment.
                best = own * PRICE_OF_CUBIC + rest[at]
                break
            more = max(k + 1, min(int(0.7 * k * (error / tolerance) ** 0.25), most + 1) if error < np.inf else 0)
            for j in range(at, J + 1):
                least[j] = max(least[j], k + 1 if j > at else more)
                # A near miss may be due to the tangent here: it says little of what begins before.
                carried[j] = max(carried[j], k if error < NEAR_MISS * tolerance else k + 1)
        rest[i], following[i], kept.errors[i] = best, at, error
        kept.rows[i, 1], kept.rows[i, 2], kept.rows[i, 3] = nodes[i], nodes[at], k
        for j in range(J + 1):
            least[j] = carried[j]
    i = 0
    while i < J:
        result.errors[count] = kept.errors[i]
        for k in range(1, 4):
            result.rows[count, k] = kept.rows[i, k]
        for axis in range(2):
            result.tangents[count, 0, axis] = kept.tangents[i, 0, axis]
            result.tangents[count, 1, axis] = kept.tangents[i, 1, axis]
            for k in range(max(kept.rows[i, 3], 1) + 1):
                result.vertices[count, k, axis] = kept.vertices[i, k, axis]
        count += 1
        i = following[i]
    return count


@compiled
def cut_all(contours: ContourArrays, settings: Settings) -> tuple[SplitContours, Cut]:
    """All contours as they are fitted, and cut: those that are flipped run against their own direction."""
    count, most = len(contours.offsets) - 1, 2 * len(contours.degrees)
    split = SplitContours(
        np.empty((most, 4, 2)), np.empty(most, dtype=np.int64), np.empty(count + 1, dtype=np.int64),
        np.empty(count, dtype=np.bool_),
    )  # fmt: skip
    result, nodes = room(most, settings.most), np.empty(most + 1, dtype=np.int64)
    at = split.offsets[0] = 0
    done = contours.offsets[0]  # 0, and no literal, for which callees would be compiled once more
    for c in range(count):
        own = contours.degrees[contours.offsets[c] : contours.offsets[c + 1]]
        cubics, degrees, split.flipped[c], joints = laid_out(contour_cubics(contours, c), own, settings)
        m, first = len(cubics), done
        for j in range(m):
            split.degrees[at + j] = degrees[j]
            for k in range(4):
                split.cubics[at + j, k, 0], split.cubics[at + j, k, 1] = cubics[j, k, 0], cubics[j, k, 1]
        at += m
        split.offsets[c + 1] = at
        i = 0
        while i < m:
            nodes[0] = i
            last, j = 0, i + 1
            while not joints.hard[j] and j < m:
                if joints.corner[j] or j - nodes[last] >= settings.stride:
                    last += 1
                    nodes[last] = j
                j += 1
            nodes[last + 1] = j
            if joints.line[i]:
                result.rows[done, 1], result.rows[done, 2], result.rows[done, 3], result.errors[done] = i, j, 0, 0.0
                for axis in range(2):
                    result.vertices[done, 0, axis] = joints.samples[joints.first[i], axis]
                    result.vertices[done, 1, axis] = joints.samples[joints.first[j], axis]
                done += 1
            else:
                done = cheapest(joints, nodes[: last + 2], settings, result, done)
            i = j
        for r in range(first, done):
            result.rows[r, 0] = c
    return (
        SplitContours(split.cubics[:at], split.degrees[:at], split.offsets, split.flipped),
        Cut(result.rows[:done], result.vertices[:done], result.tangents[:done], result.errors[:done]),
    )
