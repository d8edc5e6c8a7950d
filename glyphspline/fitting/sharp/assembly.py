"""Lines and arcs, all that a glyph is cut into: cutting its contours, cutting closer, and putting them together.

Arcs of one span are all that most glyphs have. Their curve is given by their ends and end tangents; those of more spans
get theirs from :func:`glyphspline.interpolate_many`.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import raised, spline_beziers
from ...outlines.contour_arrays import ContourArrays, offsets_of
from ...types import BoolArray, FloatArray, IntArray
from ..certified_distance import certified_distance
from .corners import find_joints
from .segmentation import MOST_SPANS, Cut, cut_contour, fit_between
from .split_contours import Settings, SplitContours

FINEST = MOST_SPANS["best"]


class Pieces(NamedTuple):
    """Lines and arcs, contour after contour, in order.

    Attributes:
        where: (P, 4) contour; first and last joint of it between which the piece runs; spans, 0 for a line.
        starts: (P + 1,) where in ``vertices`` each begins.
        vertices: (V, 2) of each piece, both ends among them.
        tangents: (P, 2, 2) end tangents of arcs, derivatives by chord length; unset for lines.
    """

    where: IntArray
    starts: IntArray
    vertices: FloatArray
    tangents: FloatArray


def cut_contours(contours: ContourArrays, settings: Settings) -> tuple[SplitContours, Pieces]:
    """All contours cut, by :mod:`.segmentation`; stretches that it cannot fit stay as they are."""
    parts, cubics, degrees, flips = [], [], [], []
    for c in range(contours.num_contours):
        own, kinds, flipped, found = cut_contour(contours, c, settings)
        pieces = _fitted(c, found)
        poor = (found.rows[:, 2] > 0) & (found.errors > settings.near)
        if poor.any():
            pieces = _replaced(pieces, poor, [_source(c, own, kinds, i, j) for i, j, _ in found.rows[poor].tolist()])
        parts.append(_turned(pieces, len(own)) if flipped else pieces)
        cubics.append(own[::-1, ::-1] if flipped else own)
        degrees.append(kinds[::-1] if flipped else kinds)
        flips.append(flipped)
    split = SplitContours(
        np.concatenate(cubics), np.concatenate(degrees), offsets_of(list(map(len, degrees))), np.array(flips)
    )
    return split, _joined(parts)


def _pieces(where: IntArray, vertices: FloatArray, tangents: FloatArray) -> Pieces:
    return Pieces(where, offsets_of(np.maximum(where[:, 3], 1) + 1), vertices, tangents)


def _fitted(c: int, found: Cut) -> Pieces:
    """The pieces of contour c, in the direction in which it is fitted."""
    where = np.empty((len(found.rows), 4), dtype=np.int64)
    where[:, 0], where[:, 1:] = c, found.rows
    used = np.arange(found.vertices.shape[1]) <= np.maximum(where[:, 3:], 1)
    return _pieces(where, found.vertices[used], found.tangents)


def _source(c: int, cubics: FloatArray, degrees: IntArray, i: int, j: int) -> Pieces:
    """Segments i to j - 1 of a contour as they are, as lines and arcs of one span."""
    b, joints = cubics[i:j], np.arange(i, j)
    factor = 3 / np.hypot(b[:, 3, 0] - b[:, 0, 0], b[:, 3, 1] - b[:, 0, 1])
    where = np.stack([np.full(j - i, c), joints, joints + 1, degrees[i:j] > 1], axis=1)
    return _pieces(where, b[:, ::3].reshape(-1, 2), (b[:, 1::2] - b[:, ::2]) * factor[:, None, None])


def _turned(pieces: Pieces, m: int) -> Pieces:
    """Pieces of a contour of m segments as they are when it runs the other way."""
    c, i, j, k = pieces.where[::-1].T
    return _pieces(np.stack([c, m - j, m - i, k], axis=1), pieces.vertices[::-1], -pieces.tangents[::-1, ::-1])


def _replaced(pieces: Pieces, poor: BoolArray, others: Sequence[Pieces]) -> Pieces:
    """Pieces with others in the place of poor ones."""
    where, starts, vertices, tangents = pieces
    parts, done = [], 0
    for q, other in zip([*np.flatnonzero(poor).tolist(), len(poor)], [*others, None], strict=True):
        parts.append(Pieces(where[done:q], starts[done:q], vertices[starts[done] : starts[q]], tangents[done:q]))
        parts += [other] if other else []
        done = q + 1
    return _joined(parts)


def _joined(parts: Sequence[Pieces]) -> Pieces:
    where, vertices, tangents = (np.concatenate([part[k] for part in parts]) for k in (0, 2, 3))
    return _pieces(where, vertices, tangents)


def cut_closer(
    contours: SplitContours,
    pieces: Pieces,
    poor: BoolArray,
    tries: Sequence[tuple[int, float]],
    rounds: int,
    settings: Settings,
) -> Pieces:
    """Pieces with others in the place of poor ones: arcs fitted more closely, or else the source's own segments.

    Args:
        poor: (P,) which pieces have failed.
        tries: what is tried until it succeeds: how many spans to add, and the share of ``settings.near`` allowed.
        rounds: most Gauss-Newton steps.
    """
    rows = pieces.where[poor].tolist()
    return _replaced(pieces, poor, [_closer(contours, row, tries, rounds, settings) for row in rows])


def _closer(
    contours: SplitContours, row: Sequence[int], tries: Sequence[tuple[int, float]], rounds: int, settings: Settings
) -> Pieces:
    """What takes the place of the piece that was at a row of :attr:`Pieces.where`."""
    c, i, j, spans = row
    own = slice(*contours.offsets[c : c + 2].tolist())
    cubics, degrees, flipped = contours.cubics[own], contours.degrees[own], bool(contours.flipped[c])
    m = len(degrees)
    if flipped:
        cubics, degrees, i, j = cubics[::-1, ::-1].copy(), degrees[::-1].copy(), m - j, m - i
    joints = find_joints(cubics, degrees, settings.near, settings.angle, settings.line)
    new = _source(c, cubics, degrees, i, j)
    p, tangents = np.empty((FINEST + 1, 2)), np.empty((2, 2))
    for extra, share in tries:
        k, near = max(spans, 1) + extra, share * settings.near
        if k > FINEST:
            break
        if fit_between(joints, i, j, k, near, settings, rounds, p, tangents) <= near:
            new = _pieces(np.array([[c, i, j, k]]), p[: k + 1], tangents[None])
            break
    return _turned(new, m) if flipped else new


@compiled
def put_together(pieces: Pieces, contours: int, knots: FloatArray, controls: FloatArray) -> ContourArrays:
    """The Bézier segments of all pieces as contours: one a span, of degree 1 for lines and 3 for arcs.

    Args:
        pieces: of so many contours.
        knots, controls: of the arcs of more than one span, one arc after the other: k + 1 knots and (k + 3, 2) control
            points each.
    """
    P = len(pieces.where)
    segments = pieces.starts[P] - P
    points, degrees = np.empty((3 * segments, 2)), np.empty(segments, dtype=np.int64)
    offsets, starts = np.empty(contours + 1, dtype=np.int64), np.empty(contours + 1, dtype=np.int64)
    b = np.empty((FINEST, 4, 2))
    at = count = knot = control = offsets[0] = starts[0] = 0
    for q in range(P):
        c, k, first = pieces.where[q, 0], pieces.where[q, 3], pieces.starts[q]
        p, tau = pieces.vertices[first : pieces.starts[q + 1]], pieces.tangents[q]
        if k > 1:
            spline_beziers(controls[control : control + k + 3], knots[knot : knot + k + 1], False, b)
            knot, control = knot + k + 1, control + k + 3
        third = np.hypot(p[1, 0] - p[0, 0], p[1, 1] - p[0, 1]) / 3
        for axis in range(2):
            points[at, axis] = p[0, axis]
            if k == 1:
                points[at + 1, axis] = p[0, axis] + third * tau[0, axis]
                points[at + 2, axis] = p[1, axis] - third * tau[1, axis]
            for r in range(3 * k if k > 1 else 0):
                points[at + r, axis] = b[r // 3, r % 3, axis]
        for s in range(max(k, 1)):
            degrees[count + s] = 1 if k == 0 else 3
        at += max(3 * k, 1)
        count += max(k, 1)
        starts[c + 1], offsets[c + 1] = at, count
    return ContourArrays(points[:at], degrees, offsets, starts)


def certify(
    contours: SplitContours, pieces: Pieces, written: ContourArrays, sharpness: float, limit: float
) -> tuple[FloatArray, FloatArray]:
    """Certified bound between each piece, as written, and its stretch of contour; and the largest gap seen.

    Args:
        written: the contours of :func:`put_together`, rounded.
        sharpness, limit: see :func:`..certified_distance.certified_distance`.
    """
    found = []
    ends = np.searchsorted(pieces.where[:, 0], np.arange(len(contours.flipped) + 1)).tolist()
    for c, (a, b) in enumerate(pairwise(ends)):
        own = pieces.where[a:b]
        anchors = np.zeros((len(own) + 1, 2))
        np.cumsum(np.maximum(own[:, 3], 1), out=anchors[1:, 0])
        anchors[1:, 1] = own[:, 2]
        part = written.part(c, c + 1)
        source = contours.cubics[contours.offsets[c] : contours.offsets[c + 1]]
        found.append(certified_distance(raised(part.points, part.degrees), source, anchors, sharpness, limit))
    return np.concatenate([one.bounds for one in found]), np.concatenate([one.gaps for one in found])
