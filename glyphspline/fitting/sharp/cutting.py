"""Cutting contours at their hard joints, and fitting what lies between them: lines, cubics and splines.

Between two hard joints there is one C2 spline. A contour without hard joints is one closed C2 spline. Most stretches of
a typeface need a line or a single cubic; one call fits these of all contours (:mod:`.stretches`), and
:mod:`.spline_search` the others. Where a stretch has corners that do not show, splines between all of these corners are
fitted, and then one spline is sought that stores less. A stretch that no spline follows is cut in two.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ...outlines.contour_arrays import ContourArrays
from ...types import BoolArray, FloatArray, IntArray
from .corners import Joints, find_joints
from .pieces import Pieces, joined, part, source_pieces, turned
from .settings import SharpSettings
from .spline_search import MOST, fit_spline
from .stretches import PART, WHOLE, simplest


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

    def joints(self, piece: Pieces, settings: SharpSettings) -> Joints:
        """Samples and joints of a piece's contour, in the direction in which it is fitted."""
        own, way = self.of(piece), -1 if self.flipped[piece.contour[0]] else 1
        cubics, degrees = self.cubics[:, own][:, ::way, ::way], self.degrees[own][::way]
        how = settings.near, settings.angle, settings.line, settings.c2
        return find_joints(np.ascontiguousarray(cubics), np.ascontiguousarray(degrees), *how)

    def source(self, piece: Pieces) -> Pieces:
        """The source's own segments in the place of a piece."""
        own, (i, j) = self.of(piece), piece.joints[0].tolist()
        cubics, degrees = self.cubics[:, own][:, i:j], self.degrees[own][i:j]
        return source_pieces(int(piece.contour[0]), i, cubics, degrees)


def fit_contours(cubics: FloatArray, contours: ContourArrays, settings: SharpSettings) -> tuple[Chains, Pieces]:
    """All contours as they are cut, and lines and arcs that follow them.

    Pieces that are farther off than ``settings.near`` become the source's own segments.

    Args:
        cubics: (K, m, 4, 2) the contours' segments in each master. contours: their degrees and offsets.
    """
    near = settings.near
    *arrays, simple, ways, enough, left = simplest(
        cubics, contours.degrees, contours.offsets, near, settings.angle, settings.line, settings.c2,
        settings.cubic_rounds,
    )  # fmt: skip
    chains, pieces = Chains(*arrays), Pieces(*simple)
    splines = Splines(dict(zip(np.flatnonzero(~enough).tolist(), left, strict=True)), ways.tolist(), settings)
    pieces, _ = _replaced(pieces, ~(pieces.errors <= near) | (ways > 0), splines)
    pieces = turned(pieces, chains.offsets, chains.flipped)
    pieces, _ = _replaced(pieces, ~(pieces.errors <= near), lambda q, piece: [chains.source(piece)])
    return chains, pieces


def _replaced(
    pieces: Pieces, which: BoolArray, others: Callable[[int, Pieces], list[Pieces]]
) -> tuple[Pieces, IntArray]:  # fmt: skip
    """Pieces with others in the place of some, and which of the given ones each is; -1 for others."""
    found, kept, counts = list[Pieces](), 0, np.ones(len(which), dtype=np.int64)
    for q in np.flatnonzero(which).tolist():
        if kept < q:
            found.append(part(pieces, kept, q))
        own = others(q, part(pieces, q, q + 1))
        counts[q] = sum(len(one.spans) for one in own)
        found += own
        kept = q + 1
    same = np.where(which, -1, np.arange(len(which))).repeat(counts)
    if not kept:
        return pieces, same
    return joined([*found, part(pieces, kept, len(which))], pieces.vertices.shape[1]), same


@dataclass
class Splines:
    """What takes the place of stretches that their line or cubic does not follow, one after the other.

    Attributes:
        joints: of their contours, in the direction in which these are fitted.
        ways: of all stretches, from :func:`.stretches.simplest`.
        parts: of a stretch that has corners that do not show, so far.
    """

    joints: dict[int, Joints]
    ways: list[int]
    settings: SharpSettings
    parts: list[Pieces] = field(default_factory=list)

    def __call__(self, q: int, piece: Pieces) -> list[Pieces]:
        """What takes the place of stretch q; nothing for a part, as the whole stretch is next."""
        joints, way, near = self.joints[int(piece.contour[0])], self.ways[q], self.settings.near
        most = most_spans(self.parts, near) if way == WHOLE else MOST
        if not piece.errors[0] <= near:
            piece = fit_spline(joints, piece, near, self.settings, False, most)
        if way == PART:
            self.parts.append(piece)
            return []
        parts, self.parts = self.parts, []
        if piece.errors[0] <= near:
            return [piece]
        return parts if most < MOST else in_two(joints, piece, near, self.settings)


def in_two(joints: Joints, piece: Pieces, near: float, settings: SharpSettings) -> list[Pieces]:
    """A stretch that no spline follows, cut at the joint in the middle of its samples, and again where that is needed.

    A single segment is left as it is, and so is a stretch of masters: at the cut their arcs would not meet smoothly.
    """
    (i, j), first = piece.joints[0].tolist(), joints.first
    if j - i < 2 or len(joints.samples) > 1:
        return [piece]
    middle = i + 1 + int(np.abs(2 * first[i + 1 : j] - first[i] - first[j]).argmin())
    found: list[Pieces] = []
    for ends in (np.array([i, middle]), np.array([middle, j])):
        own = piece._replace(
            joints=ends[None], spans=np.ones(1, np.int64), closed=np.zeros(1, np.int64), starts=np.array([0, 2]),
            vertices=joints.samples[:, first[ends]].swapaxes(0, 1), places=ends.astype(np.float64),
            errors=np.array([np.inf]),
        )  # fmt: skip
        own = fit_spline(joints, own, near, settings, given=True)
        found += [own] if own.errors[0] <= near else in_two(joints, own, near, settings)
    return found


def most_spans(parts: list[Pieces], near: float) -> int:
    """The most spans with which a spline stores less than the parts of a stretch; many if one is not near enough.

    Parts that store as little are kept: a corner that is rounded is a peak of curvature.
    """
    if any(not own.errors[0] <= near for own in parts):
        return MOST
    numbers = sum(2 * int(own.spans[0]) + (4 if own.spans[0] > 0 else 2) for own in parts)
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
    return _replaced(pieces, poor, lambda q, piece: [_closer(chains, piece, shares, settings)])


def _closer(chains: Chains, piece: Pieces, shares: FloatArray, settings: SharpSettings) -> Pieces:
    """A piece fitted within the first of the shares that a spline is found for, or else the source's own segments."""
    begin, joints = turned(piece, chains.offsets, chains.flipped), chains.joints(piece, settings)
    # What begins from its own vertices has to come nearer than it is, or it stays as it is. Those of masters may be
    # where slip rules them out: a new guess is better.
    given = len(chains.cubics) == 1 and bool(piece.spans[0] > 0)
    most = min(settings.near, float(piece.errors[0])) if given else settings.near
    for near in (shares * most).tolist():
        found = fit_spline(joints, begin, near, settings, given)
        if found.errors[0] <= near:
            return turned(found, chains.offsets, chains.flipped)
    return chains.source(piece)
