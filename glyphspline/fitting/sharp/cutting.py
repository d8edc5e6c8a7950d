"""Cutting contours at their hard joints, and fitting what lies between them: lines, cubics and splines.

Between two hard joints there is one C2 spline. A contour without hard joints is one closed C2 spline. Most stretches of
a typeface need a line or a single cubic; one call fits all of a contour, and :mod:`.spline_search` the others. Where a
stretch has corners that do not show, one spline and splines between all of these corners are both fitted, and the
cheaper is kept.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import split
from ...outlines.contour_arrays import ContourArrays, offsets_of
from ...outlines.segments import farthest_joint, is_backward, lasting
from ...types import BoolArray, FloatArray, IntArray
from .corners import JointArrays, Joints, find_joints
from .cubics import fit_between, is_straight
from .pieces import Pieces, joined, part, source_pieces, turned
from .settings import Settings
from .spline_search import fit_spline

PART, WHOLE = 1, 2
"""Ways to fit a stretch that has corners: in parts between them, or whole."""


class Chains(NamedTuple):
    """Contours from a hard joint on if there is any, without segments of no length.

    They keep their own direction, in which lines and arcs are put together.

    Attributes:
        cubics: (K, M, 4, 2) in each master and degrees: (M,) of all; offsets: (C + 1,) where each begins.
        flipped: (C,) whether it is fitted the other way round.
    """

    cubics: FloatArray
    degrees: IntArray
    offsets: IntArray
    flipped: BoolArray

    def of(self, piece: Pieces) -> slice:
        """Where the segments of a piece's contour are."""
        c = int(piece.contour[0])
        return slice(int(self.offsets[c]), int(self.offsets[c + 1]))

    def source(self, piece: Pieces) -> Pieces:
        """The source's own segments in the place of a piece."""
        own, (i, j) = self.of(piece), piece.joints[0].tolist()
        cubics, degrees = self.cubics[:, own][:, i:j], self.degrees[own][i:j]
        return source_pieces(int(piece.contour[0]), i, cubics, degrees)


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


def fit_contours(cubics: FloatArray, contours: ContourArrays, settings: Settings) -> tuple[Chains, Pieces]:
    """All contours as they are cut, and lines and arcs that follow them.

    Pieces that are farther off than ``settings.near`` become the source's own segments.

    Args:
        cubics: (K, m, 4, 2) the contours' segments in each master. contours: their degrees and offsets.
    """
    masters, near = len(cubics), settings.near
    own, kinds, ways = [np.empty((masters, 0, 4, 2))], [np.empty(0, dtype=np.int64)], []
    parts: list[Pieces] = []
    for c, (a, b) in enumerate(pairwise(contours.offsets.tolist())):
        chain, degrees, flipped, joints = prepared(
            np.ascontiguousarray(cubics[:, a:b]),
            contours.degrees[a:b],
            near,
            settings.angle,
            settings.line,
            settings.c2,
        )
        parts += fit_contour(joints, c, settings)
        own.append(chain[:, ::-1, ::-1] if flipped else chain)
        kinds.append(degrees[::-1] if flipped else degrees)
        ways.append(flipped)
    offsets = offsets_of([len(degrees) for degrees in kinds[1:]])
    chains = Chains(np.concatenate(own, axis=1), np.concatenate(kinds), offsets, np.array(ways, dtype=np.bool_))
    pieces = turned(joined(parts, masters), offsets, chains.flipped)
    poor = ~(pieces.errors <= near)
    if poor.any():
        pieces, _ = _replaced(pieces, poor, chains.source)
    return chains, pieces


def _replaced(pieces: Pieces, which: BoolArray, other: Callable[[Pieces], Pieces]) -> tuple[Pieces, IntArray]:
    """Pieces with others in the place of some, and which of the given ones each is; -1 for others."""
    found, same, kept = [], [], 0
    for q in [*np.flatnonzero(which).tolist(), len(which)]:
        found.append(part(pieces, kept, q))
        same.append(np.arange(kept, q))
        if q < len(which):
            found.append(other(part(pieces, q, q + 1)))
            same.append(np.full(len(found[-1].spans), -1))
        kept = q + 1
    return joined(found, pieces.vertices.shape[1]), np.concatenate(same)


def fit_contour(joints: Joints, c: int, settings: Settings) -> list[Pieces]:
    """Lines and arcs from joint to joint of contour c, in the direction in which it is fitted."""
    near = settings.near
    *simple, ways, enough = simplest(joints[:], near, settings.cubic_rounds)
    pieces, found, kept = Pieces(np.full(len(ways), c), *simple), [], 0
    parts: list[Pieces] = []
    for q in () if enough else np.flatnonzero(~(pieces.errors <= near) | (ways > 0)).tolist():
        piece = part(pieces, q, q + 1)
        if not piece.errors[0] <= near:
            piece = fit_spline(joints, piece, near, settings, False)
        if ways[q] == PART:
            parts.append(piece)
        found.append(part(pieces, kept, q))
        if ways[q] == WHOLE:
            found += _cheaper(parts, piece, near)
            parts = []
        elif ways[q] != PART:
            found.append(piece)
        kept = q + 1
    return [*found, part(pieces, kept, len(ways))]


def _cheaper(parts: list[Pieces], whole: Pieces, near: float) -> list[Pieces]:
    """Of a stretch that was fitted in parts and whole, what stores less."""
    if any(not own.errors[0] <= near for own in parts):
        return [whole]
    numbers = sum(2 * int(own.spans[0]) + (4 if own.spans[0] > 0 else 2) for own in parts)
    # Those cut at corners are kept if they store as little: a corner that is rounded is a peak of curvature.
    return parts if numbers <= 2 * int(whole.spans[0]) + 4 or whole.errors[0] > near else [whole]


@compiled
def simplest(around: JointArrays, near: float, rounds: int) -> tuple[Any, ...]:
    """A line or a cubic for each stretch of a contour, with its error; where a stretch has corners that do not show,
    for each part of it between them, and then for the whole.

    The error is infinite for a closed curve, and beside a tied joint, where the cubics of the masters have to agree:
    these are for splines, which may have one span.

    Args:
        around: the arrays of the contour's :class:`.corners.Joints`. near: how near samples have to be. rounds: of a
            cubic.

    Returns:
        The arrays of :class:`.pieces.Pieces`, but for the contour; (P,) the ways: PART, WHOLE, or 0 where there is one;
        and whether all that was tried is near enough, in one way.
    """
    joints = Joints(*around)
    m, masters, count = len(joints.line), len(joints.samples), 0
    ends, ways = np.empty((2 * m, 2), np.int64), np.zeros(2 * m, np.int64)
    i = 0
    while i < m:
        j, cut = i + 1, False
        while j < m and not joints.hard[j]:
            cut = cut or joints.corner[j]
            j += 1
        cut = cut and joints.hard[0] and not joints.line[i]
        a = i
        for b in range(i + 1, j + 1):
            if b == j or (cut and joints.corner[b]):
                ends[count, 0], ends[count, 1], ways[count] = a, b, PART if cut else 0
                count, a = count + 1, b
        if cut:
            ends[count, 0], ends[count, 1], ways[count] = i, j, WHOLE
            count += 1
        i = j
    vertices, places, tangents = (
        np.empty((2 * count, masters, 2)),
        np.empty(2 * count),
        np.zeros((count, masters, 2, 2)),
    )
    spans, closed, errors, enough = np.empty(count, np.int64), np.zeros(count, np.int64), np.zeros(count), True
    for q in range(count):
        i, j = ends[q, 0], ends[q, 1]
        ring = i == 0 and j == m and not joints.hard[0]
        line = joints.line[i] or (not ring and joints.corner[i] and joints.corner[j] and is_straight(
            joints.samples, joints.first[i], joints.first[j], near
        ))  # fmt: skip
        if not line:
            errors[q] = np.inf
            if not (ring or joints.tied[i] or joints.tied[j]):
                errors[q] = fit_between(joints, i, j, near, rounds, tangents[q])
        spans[q], closed[q] = 0 if line else 1, 1 if ring else 0
        for end in range(2):
            places[2 * q + end] = ends[q, end]
            for v in range(masters):
                for axis in range(2):
                    vertices[2 * q + end, v, axis] = joints.samples[v, joints.first[ends[q, end]], axis]
        enough = enough and errors[q] <= near and ways[q] == 0
    starts = 2 * np.arange(count + 1)
    return ends[:count], spans, closed, starts, vertices, places, tangents, errors, ways[:count], enough


def refit(
    chains: Chains, pieces: Pieces, poor: BoolArray, shares: FloatArray, settings: Settings
) -> tuple[Pieces, IntArray]:
    """Pieces with others in the place of poor ones: fitted more closely, or else the source's own segments.

    Args:
        shares: of ``settings.near``, to be tried in turn.

    Returns:
        The pieces, and which of the given ones each is; -1 for others.
    """
    return _replaced(pieces, poor, lambda piece: _closer(chains, piece, shares, settings))


def _closer(chains: Chains, piece: Pieces, shares: FloatArray, settings: Settings) -> Pieces:
    """A piece fitted within the first of the shares that a spline is found for, or else the source's own segments."""
    own, way = chains.of(piece), -1 if chains.flipped[piece.contour[0]] else 1
    begin = turned(piece, chains.offsets, chains.flipped)
    joints = find_joints(
        np.ascontiguousarray(chains.cubics[:, own][:, ::way, ::way]), np.ascontiguousarray(chains.degrees[own][::way]),
        settings.near, settings.angle, settings.line, settings.c2,
    )  # fmt: skip
    for near in (shares * settings.near).tolist():
        # The masters' vertices may be where slip rules them out: a new guess is better.
        found = fit_spline(joints, begin, near, settings, len(chains.cubics) == 1)
        if found.errors[0] <= near:
            return turned(found, chains.offsets, chains.flipped)
    return chains.source(piece)
