"""Contours cut into stretches at their hard joints, with the line or the cubic that follows each: all in one pass.

Most stretches of a typeface need no more. :mod:`.cutting` has splines fitted to the others.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...compiled import compiled
from ...curves.cubics import split
from ...outlines.segments import farthest_joint, is_backward, lasting
from ...types import FloatArray, IntArray
from .corners import Joints, find_joints
from .cubics import fit_between, is_straight
from .pieces import Pieces

PART, WHOLE = 1, 2
"""Ways to fit a stretch that has corners: in parts between them, or whole."""


@compiled
def prepared(
    cubics: FloatArray, degrees: IntArray, near: float, angle: float, line: float, c2: bool
) -> tuple[FloatArray, IntArray, bool, Joints]:
    """A contour as it is fitted: its cubics, their degrees, whether they run the other way, and its joints.

    Segments that have a length in no master are left out; those that end where they begin are cut in two: an arc needs
    two ends. It begins at a hard joint, or else at that farthest from the middle: the same whatever the contour's first
    point. Direction and that joint are those of the first master.
    """
    masters, m = len(cubics), len(degrees)
    found, kept, count = np.empty((masters, 2 * m, 4, 2)), np.empty(2 * m, dtype=np.int64), 0
    for j in lasting(cubics):
        closed = True
        for v in range(masters):
            own = cubics[v, j]
            closed = closed and own[0, 0] == own[3, 0] and own[0, 1] == own[3, 1]
        last = count + 1 if closed else count
        for v in range(masters):
            for r in range(4):
                found[v, last, r, 0], found[v, last, r, 1] = cubics[v, j, r, 0], cubics[v, j, r, 1]
            if closed:
                split(found[v, last], 0.5, found[v, count])
        kept[count] = kept[last] = degrees[j]
        count = last + 1
    chain, kept = found[:, :count].copy(), kept[:count]
    m, flipped = count, is_backward(chain[0])
    if flipped:
        chain, kept = chain[:, ::-1, ::-1].copy(), kept[::-1].copy()
    joints = find_joints(chain, kept, near, angle, line, c2)
    k = 0
    while k < m and not joints.hard[k]:
        k += 1
    if k == m:
        k = farthest_joint(chain[0, :, 0])
    if k > 0:
        before, types = chain, kept
        chain, kept = np.empty_like(before), np.empty_like(types)
        for j in range(m):
            s = (j + k) % m
            kept[j] = types[s]
            for v in range(masters):
                for r in range(4):
                    chain[v, j, r, 0], chain[v, j, r, 1] = before[v, s, r, 0], before[v, s, r, 1]
        joints = find_joints(chain, kept, near, angle, line, c2)
    return chain, kept, flipped, joints


@compiled
def simplest(
    cubics: FloatArray, degrees: IntArray, offsets: IntArray, near: float, angle: float, line: float, c2: bool,
    rounds: int,
) -> tuple[Any, ...]:  # fmt: skip
    """All contours as they are cut, with a line or a cubic for each stretch, and its error; where a stretch has corners
    that do not show, for each part of it between them, and then for the whole, unless that decides between the two.

    The error is infinite for a closed curve, and beside a tied joint, where the cubics of the masters have to agree:
    these are for splines, which may have one span.

    Args:
        cubics: (K, m, 4, 2), degrees, offsets: of contours. near: how near samples have to be. angle, line, c2: see
            :func:`.corners.find_joints`. rounds: of a cubic.

    Returns:
        The arrays of :class:`.cutting.Chains`; those of :class:`.pieces.Pieces`; (P,) the ways: PART, WHOLE, or 0 where
        there is one; (C,) whether all pieces of a contour are near enough, in one way; the joints of those contours
        that are not.
    """
    K, C, most = len(cubics), len(offsets) - 1, 2 * len(degrees)  # a segment may be cut in two, and be tried twice
    own, kinds, starts = np.empty((K, most, 4, 2)), np.empty(most, np.int64), np.zeros(C + 1, np.int64)
    flipped, enough = np.zeros(C, np.bool_), np.ones(C, np.bool_)
    P, ways, count = 2 * most, np.zeros(2 * most, np.int64), 0
    left: list[Joints] = []
    pieces = Pieces(
        np.empty(P, np.int64), np.empty((P, 2), np.int64), np.empty(P, np.int64), np.zeros(P, np.int64),
        2 * np.arange(P + 1), np.empty((2 * P, K, 2)), np.empty(2 * P), np.zeros((P, K, 2, 2)), np.zeros(P),
    )  # fmt: skip
    for c in range(C):
        a, b, at = offsets[c], offsets[c + 1], starts[c]
        chain, types, turns, around = prepared(cubics[:, a:b].copy(), degrees[a:b], near, angle, line, c2)
        m = len(types)
        flipped[c], starts[c + 1] = turns, at + m
        for j in range(m):
            s = m - 1 - j if turns else j
            kinds[at + j] = types[s]
            for v in range(K):
                for r in range(4):
                    k = 3 - r if turns else r
                    own[v, at + j, r, 0], own[v, at + j, r, 1] = chain[v, s, k, 0], chain[v, s, k, 1]
        last = fit_stretches(around, c, pieces, ways, count, near, rounds)
        for r in range(count, last):
            enough[c] = enough[c] and pieces.errors[r] <= near and ways[r] == 0
        if not enough[c]:
            left.append(around)
        count = last
    simple = (
        pieces.contour[:count], pieces.joints[:count], pieces.spans[:count], pieces.closed[:count],
        pieces.starts[: count + 1], pieces.vertices[: 2 * count], pieces.places[: 2 * count], pieces.tangents[:count],
        pieces.errors[:count],
    )  # fmt: skip
    total = starts[C]
    return own[:, :total].copy(), kinds[:total], starts, flipped, simple, ways[:count], enough, left


@compiled
def fit_stretches(around: Joints, c: int, pieces: Pieces, ways: IntArray, count: int, near: float, rounds: int) -> int:
    """Write the pieces of contour c, each with two vertices, from ``count`` on; return where they end."""
    K, m, at = len(around.samples), len(around.line), count
    least = 8.0 if K == 1 else 6.0  # numbers that a spline stores; that of masters may have one span
    joints, spans, errors, tangents = pieces.joints, pieces.spans, pieces.errors, pieces.tangents
    for row in range(count, stretches(around, joints, ways, count)):
        i, j, way = joints[row, 0], joints[row, 1], ways[row]
        ring = i == 0 and j == m and not around.hard[0]
        straight = around.line[i] or (not ring and around.corner[i] and around.corner[j] and is_straight(
            around.samples, around.first[i], around.first[j], near
        ))  # fmt: skip
        # The first of its parts, and the numbers that these store; infinite if one is not near enough.
        parts, stored = at, 0.0 if way == WHOLE else np.inf
        while way == WHOLE and parts > 0 and ways[parts - 1] == PART:
            parts -= 1
            stored += 2.0 * spans[parts] + (4.0 if spans[parts] > 0 else 2.0) if errors[parts] <= near else np.inf
        error, fits = 0.0 if straight else np.inf, stored > (4.0 if straight else 6.0)
        if fits and not (straight or ring or around.tied[i] or around.tied[j]):
            error = fit_between(around, i, j, near, rounds, tangents[at])
        if way == WHOLE and not (fits and error <= near) and stored <= least:
            for r in range(parts, at):
                ways[r] = 0
            continue
        if way == WHOLE and error <= near:
            for v in range(K):
                for end in range(2):
                    for axis in range(2):
                        tangents[parts, v, end, axis] = tangents[at, v, end, axis]
            at, way = parts, 0
        ways[at], errors[at], joints[at, 0], joints[at, 1] = way, error, i, j
        pieces.contour[at], spans[at], pieces.closed[at] = c, 0 if straight else 1, 1 if ring else 0
        for end in range(2):
            pieces.places[2 * at + end] = joints[at, end]
            for v in range(K):
                for axis in range(2):
                    value = around.samples[v, around.first[joints[at, end]], axis]
                    pieces.vertices[2 * at + end, v, axis] = value
        at += 1
    return at


@compiled
def stretches(around: Joints, joints: IntArray, ways: IntArray, count: int) -> int:
    """Write the stretches of a contour into rows from ``count`` on, and ways to fit them; return where they end."""
    m, i = len(around.line), 0
    while i < m:
        j, cut = i + 1, False
        while j < m and not around.hard[j]:
            cut = cut or around.corner[j]
            j += 1
        cut = cut and around.hard[0] and not around.line[i]
        a = i
        for b in range(i + 1, j + 1):
            if b == j or (cut and around.corner[b]):
                joints[count, 0], joints[count, 1], ways[count] = a, b, PART if cut else 0
                count, a = count + 1, b
        if cut:
            joints[count, 0], joints[count, 1], ways[count] = i, j, WHOLE
            count += 1
        i = j
    return count
