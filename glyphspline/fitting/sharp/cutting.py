"""Cutting contours at their hard joints, and fitting what lies between them: lines, cubics and splines.

Between two hard joints there is one C2 spline. A contour without hard joints is one closed C2 spline. Most stretches of
a typeface need a line or a single cubic; one call fits these of all contours, and :mod:`.spline_search` the others.
Where a stretch has corners that do not show, one spline and splines between all of these corners are both fitted, and
the cheaper is kept.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import split
from ...outlines.contour_arrays import ContourArrays
from ...outlines.segments import farthest_joint, is_backward, lasting
from ...types import BoolArray, FloatArray, IntArray
from .corners import Joints, find_joints
from .cubics import fit_between, is_straight
from .pieces import Pieces, joined, part, source_pieces, turned
from .settings import SharpSettings
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


def fit_contours(cubics: FloatArray, contours: ContourArrays, settings: SharpSettings) -> tuple[Chains, Pieces]:
    """All contours as they are cut, and lines and arcs that follow them.

    Pieces that are farther off than ``settings.near`` become the source's own segments.

    Args:
        cubics: (K, m, 4, 2) the contours' segments in each master. contours: their degrees and offsets.
    """
    near, how = settings.near, (settings.angle, settings.line, settings.c2)
    *arrays, simple, ways, ends, enough = simplest(
        cubics, contours.degrees, contours.offsets, near, *how, settings.cubic_rounds
    )
    chains, pieces = Chains(*arrays), Pieces(*simple)
    parts: list[Pieces] = []
    kept = 0
    for c in np.flatnonzero(~enough).tolist():
        a, b = ends[c : c + 2].tolist()
        own = slice(*contours.offsets[c : c + 2].tolist())
        joints = prepared(np.ascontiguousarray(cubics[:, own]), contours.degrees[own], near, *how)[-1]
        parts += [part(pieces, kept, a), *fit_contour(joints, part(pieces, a, b), ways[a:b], settings)]
        kept = b
    if kept:
        pieces = joined([*parts, part(pieces, kept, len(ways))], len(cubics))
    pieces = turned(pieces, chains.offsets, chains.flipped)
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


def fit_contour(joints: Joints, pieces: Pieces, ways: IntArray, settings: SharpSettings) -> list[Pieces]:
    """A contour's lines and arcs, in the direction in which it is fitted: splines where what is simplest is not near
    enough.

    Args:
        pieces, ways: of it, from :func:`simplest`.
    """
    near, found, kept = settings.near, list[Pieces](), 0
    parts: list[Pieces] = []
    for q in np.flatnonzero(~(pieces.errors <= near) | (ways > 0)).tolist():
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
def simplest(
    cubics: FloatArray, degrees: IntArray, offsets: IntArray, near: float, angle: float, line: float, c2: bool,
    rounds: int,
) -> tuple[Any, ...]:  # fmt: skip
    """All contours as they are cut, with a line or a cubic for each stretch, and its error; where a stretch has corners
    that do not show, for each part of it between them, and then for the whole.

    The error is infinite for a closed curve, and beside a tied joint, where the cubics of the masters have to agree:
    these are for splines, which may have one span.

    Args:
        cubics: (K, m, 4, 2), degrees, offsets: of contours. near: how near samples have to be. angle, line, c2: see
            :func:`.corners.find_joints`. rounds: of a cubic.

    Returns:
        The arrays of :class:`Chains`; those of :class:`.pieces.Pieces`; (P,) the ways: PART, WHOLE, or 0 where there is
        one; (C + 1,) where the pieces of each contour begin; (C,) whether all of them are near enough, in one way.
    """
    K, C, most = len(cubics), len(offsets) - 1, 2 * len(degrees)  # a segment may be cut in two, and be tried twice
    own, kinds, starts = np.empty((K, most, 4, 2)), np.empty(most, np.int64), np.zeros(C + 1, np.int64)
    flipped, enough, firsts = np.zeros(C, np.bool_), np.ones(C, np.bool_), np.zeros(C + 1, np.int64)
    P = 2 * most
    contour, joints, ways = np.empty(P, np.int64), np.empty((P, 2), np.int64), np.zeros(P, np.int64)
    spans, closed, errors = np.empty(P, np.int64), np.zeros(P, np.int64), np.zeros(P)
    vertices, places, tangents = np.empty((2 * P, K, 2)), np.empty(2 * P), np.zeros((P, K, 2, 2))
    count = 0
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
        last = stretches(around, joints, ways, count)
        for q in range(count, last):
            i, j = joints[q, 0], joints[q, 1]
            ring = i == 0 and j == m and not around.hard[0]
            straight = around.line[i] or (not ring and around.corner[i] and around.corner[j] and is_straight(
                around.samples, around.first[i], around.first[j], near
            ))  # fmt: skip
            if not straight:
                errors[q] = np.inf
                if not (ring or around.tied[i] or around.tied[j]):
                    errors[q] = fit_between(around, i, j, near, rounds, tangents[q])
            contour[q], spans[q], closed[q] = c, 0 if straight else 1, 1 if ring else 0
            for end in range(2):
                places[2 * q + end] = joints[q, end]
                for v in range(K):
                    for axis in range(2):
                        vertices[2 * q + end, v, axis] = around.samples[v, around.first[joints[q, end]], axis]
            enough[c] = enough[c] and errors[q] <= near and ways[q] == 0
        firsts[c + 1] = count = last
    pieces = (
        contour[:count], joints[:count], spans[:count], closed[:count], 2 * np.arange(count + 1),
        vertices[: 2 * count], places[: 2 * count], tangents[:count], errors[:count],
    )  # fmt: skip
    total = starts[C]
    return own[:, :total].copy(), kinds[:total], starts, flipped, pieces, ways[:count], firsts, enough


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


def refit(
    chains: Chains, pieces: Pieces, poor: BoolArray, shares: FloatArray, settings: SharpSettings
) -> tuple[Pieces, IntArray]:
    """Pieces with others in the place of poor ones: fitted more closely, or else the source's own segments.

    Args:
        shares: of ``settings.near``, to be tried in turn.

    Returns:
        The pieces, and which of the given ones each is; -1 for others.
    """
    return _replaced(pieces, poor, lambda piece: _closer(chains, piece, shares, settings))


def _closer(chains: Chains, piece: Pieces, shares: FloatArray, settings: SharpSettings) -> Pieces:
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
