"""Cutting contours at their hard joints, and fitting what lies between them: lines, cubics and splines.

Between two hard joints there is one C2 spline. A contour without hard joints is one closed C2 spline. Most stretches of
a typeface need a line or a single cubic; one call fits these of all contours (:mod:`.stretches`), and
:mod:`.spline_search` the others. Where a stretch has corners that do not show, splines between all of these corners are
fitted, and then one spline is sought that stores less. A stretch that no spline follows is cut in two.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ...outlines.contour_arrays import ContourArrays
from ...types import BoolArray, FloatArray, IntArray
from .corners import Joints, find_joints
from .pieces import Piece, Pieces, chord_lengths, end_to_end, in_order, joined, piece_of, turned
from .settings import SharpSettings
from .spline_search import MOST, fit_spline
from .stretches import PART, WHOLE, simplest


class Chains(NamedTuple):
    """Contours from a hard joint on if there is any, without segments of no length.

    They keep their own direction, in which lines and arcs are put together.

    Attributes:
        cubics: (K, M, 4, 2) in each master and degrees: (M,) of all; offsets: (C + 1,) where each begins.
        flipped: (C,) whether it is fitted the other way round. known: joints of some contours, by their numbers.
    """

    cubics: FloatArray
    degrees: IntArray
    offsets: IntArray
    flipped: BoolArray
    known: dict[int, Joints]

    def of(self, piece: Piece) -> tuple[FloatArray, IntArray]:
        """The cubics of a piece's contour and their degrees, in the direction in which it is fitted."""
        own, way = slice(*self.offsets[piece.contour : piece.contour + 2]), -1 if self.flipped[piece.contour] else 1
        return self.cubics[:, own][:, ::way, ::way], self.degrees[own][::way]

    def joints(self, piece: Piece, settings: SharpSettings) -> Joints:
        """Samples and joints of a piece's contour."""
        if piece.contour in self.known:
            return self.known[piece.contour]
        cubics, degrees = self.of(piece)
        how = settings.near, settings.angle, settings.line, settings.c2
        return find_joints(np.ascontiguousarray(cubics), np.ascontiguousarray(degrees), *how)

    def source(self, piece: Piece) -> Iterator[Piece]:
        """The source's own segments in the place of a piece, as lines and arcs of one span."""
        (i, j), (cubics, degrees) = piece.joints, self.of(piece)
        factors = 3 / chord_lengths((cubics[:, i:j, 3] - cubics[:, i:j, 0]).swapaxes(0, 1))
        for n, (degree, factor) in enumerate(zip(degrees[i:j].tolist(), factors, strict=True), i):
            own, ends = cubics[:, n], (n, n + 1)
            tangents = (own[:, 1::2] - own[:, ::2]) * factor
            vertices, places = own[:, ::3].swapaxes(0, 1), np.array(ends, dtype=np.float64)
            yield Piece(piece.contour, ends, min(degree - 1, 1), 0, vertices, places, tangents, 0.0)


def fit_contours(cubics: FloatArray, contours: ContourArrays, settings: SharpSettings) -> tuple[Chains, Pieces]:
    """All contours as they are cut, and lines and arcs that follow them.

    Pieces that are farther off than ``settings.near`` become the source's own segments.

    Args:
        cubics: (K, m, 4, 2) the contours' segments in each master. contours: their degrees and offsets.
    """
    near = settings.near
    chain, degrees, offsets, flipped, simple, ways, enough, left = simplest(
        cubics, contours.degrees, contours.offsets, near, settings.angle, settings.line, settings.c2,
        settings.cubic_rounds,
    )  # fmt: skip
    known = dict(zip(np.flatnonzero(~enough).tolist(), left, strict=True))
    chains, pieces = Chains(chain, degrees, offsets, flipped, known), Pieces(*simple)
    poor = ~(pieces.errors <= near) | (ways > 0)
    tried = [(piece_of(pieces, q), int(ways[q])) for q in np.flatnonzero(poor).tolist()]
    followed = splines(chains, tried, settings)
    found = [own for piece in followed for own in ([piece] if piece.error <= near else chains.source(piece))]
    pieces, _ = _replaced(chains, turned(pieces, chains.offsets, chains.flipped), poor, found)
    return chains, pieces


def _replaced(chains: Chains, pieces: Pieces, poor: BoolArray, found: list[Piece]) -> tuple[Pieces, IntArray]:
    """Pieces with others, in the direction in which these are fitted, in the place of poor ones; see :func:`refit`."""
    if found:
        pieces = joined(pieces, turned(end_to_end(found), chains.offsets, chains.flipped))
    pieces, order = in_order(pieces, np.append(np.flatnonzero(~poor), np.arange(len(poor), len(pieces.spans))))
    return pieces, np.where(order < len(poor), order, -1)


def splines(chains: Chains, tried: list[tuple[Piece, int]], settings: SharpSettings) -> Iterator[Piece]:
    """What takes the place of stretches that their line or cubic does not follow, as far as a spline does.

    Args:
        tried: with their ways, from :func:`.stretches.simplest`. The parts of a stretch that has corners that do not
            show come before it.
    """
    parts, near = list[Piece](), settings.near
    for piece, way in tried:
        around, most = chains.joints(piece, settings), most_spans(parts, near) if way == WHOLE else MOST
        found = piece if piece.error <= near else fit_spline(around, piece, near, settings, False, most)
        if way == PART:
            parts.append(found)
            continue
        if found.error <= near:
            yield found
        elif most < MOST:
            yield from parts
        else:
            yield from in_two(around, piece, near, settings)
        parts = []


def in_two(joints: Joints, piece: Piece, near: float, settings: SharpSettings) -> Iterator[Piece]:
    """A stretch that no spline follows, cut at the joint in the middle of its samples, and again where that is needed.

    A single segment is left as it is, and so is a stretch of masters: at the cut their arcs would not meet smoothly.
    """
    (i, j), first = piece.joints, joints.first
    if j - i < 2 or len(joints.samples) > 1:
        yield piece
        return
    middle = i + 1 + int(np.abs(2 * first[i + 1 : j] - first[i] - first[j]).argmin())
    for ends in ((i, middle), (middle, j)):
        vertices, places = joints.samples[:, first[list(ends)]].swapaxes(0, 1), np.array(ends, dtype=np.float64)
        own = Piece(piece.contour, ends, 1, 0, vertices, places, piece.tangents, np.inf)
        found = fit_spline(joints, own, near, settings, given=True)
        yield from [found] if found.error <= near else in_two(joints, own, near, settings)


def most_spans(parts: list[Piece], near: float) -> int:
    """The most spans with which a spline stores less than the parts of a stretch; many if one is not near enough.

    Parts that store as little are kept: a corner that is rounded is a peak of curvature.
    """
    if any(not own.error <= near for own in parts):
        return MOST
    numbers = sum(2 * own.spans + (4 if own.spans > 0 else 2) for own in parts)
    return (numbers - 5) // 2


def refit(
    chains: Chains, pieces: Pieces, poor: BoolArray, shares: FloatArray, settings: SharpSettings
) -> tuple[Pieces, IntArray]:
    """Pieces with others in the place of poor ones: fitted more closely, or else the source's own segments.

    Args:
        shares: of ``settings.near``, to be tried in turn.

    Returns:
        The pieces, and which of the given ones each is; -1 for others.
    """
    begin = turned(pieces, chains.offsets, chains.flipped)
    fits = (_closer(chains, piece_of(begin, q), shares, settings) for q in np.flatnonzero(poor).tolist())
    return _replaced(chains, pieces, poor, [piece for own in fits for piece in own])


def _closer(chains: Chains, piece: Piece, shares: FloatArray, settings: SharpSettings) -> Iterator[Piece]:
    """A piece fitted within the first of the shares that a spline is found for, or else the source's own segments."""
    joints = chains.joints(piece, settings)
    # What begins from its own vertices has to come nearer than it is, or it stays as it is. Those of masters may be
    # where slip rules them out: a new guess is better.
    given = len(chains.cubics) == 1 and piece.spans > 0
    most = min(settings.near, piece.error) if given else settings.near
    for near in (shares * most).tolist():
        found = fit_spline(joints, piece, near, settings, given)
        if found.error <= near:
            yield found
            return
    yield from chains.source(piece)
