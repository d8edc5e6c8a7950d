"""Lines and arcs, all that a glyph is cut into: cutting its contours, cutting closer, and putting them together.

Arcs of one span are all that most glyphs have. Their curve is given by their ends and end tangents; those of more spans
get theirs from :func:`glyphspline.interpolate_many`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import spline_beziers
from ...outlines.contour_arrays import ContourArrays, Polylines, offsets_of
from ...outlines.segments import all_cubics
from ...types import BoolArray, FloatArray, IntArray
from ..certified_distance import pair_stretches
from .corners import find_joints
from .segmentation import MOST_SPANS, Cut, cut_all, fit_between
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
    fitted, found = cut_all(contours, settings)
    return own_directions(fitted, found, settings.near)


@compiled
def room(count: int) -> Pieces:
    """Empty arrays for so many pieces."""
    pieces = Pieces(
        np.empty((count, 4), dtype=np.int64), np.empty(count + 1, dtype=np.int64),
        np.empty((count * (FINEST + 1), 2)), np.empty((count, 2, 2)),
    )  # fmt: skip
    pieces.starts[0] = 0
    return pieces


@compiled
def add(pieces: Pieces, count: int, row: IntArray, p: FloatArray, tangents: FloatArray, back: bool, m: int) -> None:
    """Add a piece after ``count`` others.

    Args:
        row: as in ``Pieces.where``. p: (spans + 1, 2) or more rows. tangents: (2, 2).
        back: the piece runs the other way than its contour, of m segments.
    """
    k, at = row[3], pieces.starts[count]
    n = max(k, 1)
    where, tau = pieces.where[count], pieces.tangents[count]
    where[0], where[1], where[2], where[3] = row[0], m - row[2] if back else row[1], m - row[1] if back else row[2], k
    for axis in range(2):
        for r in range(n + 1):
            pieces.vertices[at + r, axis] = p[n - r if back else r, axis]
        for end in range(2):
            tau[end, axis] = -tangents[1 - end, axis] if back else tangents[end, axis]
    pieces.starts[count + 1] = at + n + 1


@compiled
def add_source(
    pieces: Pieces, count: int, row: IntArray, cubics: FloatArray, degrees: IntArray, back: bool
) -> int:  # fmt: skip
    """Add the segments of a contour between two joints as they are, as lines and arcs of one span; the pieces then.

    Args:
        row: contour, joint and next joint of the contour as it is fitted, whose segments cubics and degrees are.
    """
    p, tangents, own = np.empty((2, 2)), np.empty((2, 2)), np.empty(4, dtype=np.int64)
    for n in range(row[2] - row[1]):
        s = row[2] - 1 - n if back else row[1] + n
        factor = 3 / np.hypot(cubics[s, 3, 0] - cubics[s, 0, 0], cubics[s, 3, 1] - cubics[s, 0, 1])
        for axis in range(2):
            for end in range(2):
                p[end, axis] = cubics[s, 3 * end, axis]
                tangents[end, axis] = (cubics[s, 2 * end + 1, axis] - cubics[s, 2 * end, axis]) * factor
        own[0], own[1], own[2], own[3] = row[0], s, s + 1, int(degrees[s] > 1)
        add(pieces, count + n, own, p, tangents, back, len(degrees))
    return count + row[2] - row[1]


@compiled
def own_directions(fitted: SplitContours, found: Cut, near: float) -> tuple[SplitContours, Pieces]:
    """Contours in their own direction, and their pieces; arcs farther off than ``near`` become source segments."""
    cubics, degrees = np.empty_like(fitted.cubics), np.empty_like(fitted.degrees)
    pieces = room(len(degrees))
    count = first = fitted.offsets[0]
    for c in range(len(fitted.flipped)):
        a, b, back = fitted.offsets[c], fitted.offsets[c + 1], fitted.flipped[c]
        m = b - a
        for j in range(m):
            t = m - 1 - j if back else j
            degrees[a + j] = fitted.degrees[a + t]
            for k in range(4):
                for axis in range(2):
                    cubics[a + j, k, axis] = fitted.cubics[a + t, 3 - k if back else k, axis]
        last = first
        while last < len(found.rows) and found.rows[last, 0] == c:
            last += 1
        for n in range(last - first):
            q = last - 1 - n if back else first + n
            if found.rows[q, 3] > 0 and found.errors[q] > near:
                count = add_source(pieces, count, found.rows[q], fitted.cubics[a:b], fitted.degrees[a:b], back)
            else:
                add(pieces, count, found.rows[q], found.vertices[q], found.tangents[q], back, m)
                count += 1
        first = last
    vertices = pieces.vertices[: pieces.starts[count]]
    kept = Pieces(pieces.where[:count], pieces.starts[: count + 1], vertices, pieces.tangents[:count])
    return SplitContours(cubics, degrees, fitted.offsets, fitted.flipped), kept


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
    parts, done = [], 0
    for q in np.flatnonzero(poor).tolist():
        parts += [_part(pieces, done, q), _closer(contours, pieces.where[q], tries, rounds, settings)]
        done = q + 1
    parts.append(_part(pieces, done, len(poor)))
    where, vertices, tangents = (np.concatenate([part[k] for part in parts]) for k in (0, 2, 3))
    return Pieces(where, offsets_of(np.maximum(where[:, 3], 1) + 1), vertices, tangents)


def _part(pieces: Pieces, a: int, b: int) -> Pieces:
    """Pieces a to b - 1."""
    where, starts, vertices, tangents = pieces
    return Pieces(where[a:b], starts[a : b + 1], vertices[starts[a] : starts[b]], tangents[a:b])


def _closer(
    contours: SplitContours, row: IntArray, tries: Sequence[tuple[int, float]], rounds: int, settings: Settings
) -> Pieces:
    """What takes the place of the piece that was at a row of :attr:`Pieces.where`."""
    c, i, j, spans = row.tolist()
    own = slice(*contours.offsets[c : c + 2].tolist())
    cubics, degrees, flipped = contours.cubics[own], contours.degrees[own], bool(contours.flipped[c])
    m = len(degrees)
    if flipped:
        cubics, degrees, i, j = cubics[::-1, ::-1].copy(), degrees[::-1].copy(), m - j, m - i
    joints = find_joints(cubics, degrees, settings.near, settings.angle, settings.line)
    p, tangents = np.empty((FINEST + 1, 2)), np.empty((2, 2))
    new = room(j - i)
    for extra, share in tries:
        k, near = max(spans, 1) + extra, share * settings.near
        if k > FINEST:
            break
        if fit_between(joints, i, j, k, near, settings, rounds, p, tangents) <= near:
            add(new, 0, np.array([c, i, j, k]), p, tangents, flipped, m)
            return _part(new, 0, 1)
    return _part(new, 0, add_source(new, 0, np.array([c, i, j, 0]), cubics, degrees, flipped))


class Assembly(NamedTuple):
    """Pieces put together.

    Attributes:
        curves: the contours, a segment a span, of degree 1 for lines and 3 for arcs.
        controls: the control polygons of all arcs.
        anchors: (P + C, 2) places on curves and sources where pieces begin, and where contours end.
        anchor_offsets: (C + 1,) where in ``anchors`` each contour begins.
    """

    curves: ContourArrays
    controls: Polylines
    anchors: FloatArray
    anchor_offsets: IntArray


@compiled
def put_together(pieces: Pieces, contours: int, knots: FloatArray, controls: FloatArray) -> Assembly:
    """The curves of all pieces.

    Args:
        pieces: of so many contours.
        knots, controls: of the arcs of more than one span, one arc after the other: k + 1 knots and (k + 3, 2) control
            points each.
    """
    P = len(pieces.where)
    segments, arcs = pieces.starts[P] - P, 0
    for q in range(P):
        arcs += pieces.where[q, 3] > 0
    points, degrees = np.empty((3 * segments, 2)), np.empty(segments, dtype=np.int64)
    offsets, starts = np.empty(contours + 1, dtype=np.int64), np.empty(contours + 1, dtype=np.int64)
    own, ends, closed = np.empty((segments + 3 * arcs, 2)), np.empty(arcs + 1, np.int64), np.empty(arcs, np.bool_)
    anchors, anchor_offsets = np.empty((P + contours, 2)), np.empty(contours + 1, dtype=np.int64)
    b = np.empty((FINEST, 4, 2))
    at = count = knot = control = arc = offsets[0] = starts[0] = ends[0] = anchor_offsets[0] = 0
    for q in range(P):
        c, k, first = pieces.where[q, 0], pieces.where[q, 3], pieces.starts[q]
        p, tau = pieces.vertices[first : pieces.starts[q + 1]], pieces.tangents[q]
        third = np.hypot(p[1, 0] - p[0, 0], p[1, 1] - p[0, 1]) / 3
        if k > 1:
            spline_beziers(controls[control : control + k + 3], knots[knot : knot + k + 1], False, b)
        for axis in range(2):
            points[at, axis] = p[0, axis]
            if k == 1:
                points[at + 1, axis] = p[0, axis] + third * tau[0, axis]
                points[at + 2, axis] = p[1, axis] - third * tau[1, axis]
                for r in range(3):
                    own[ends[arc] + r, axis] = points[at + r, axis]
                own[ends[arc] + 3, axis] = p[1, axis]
            if k > 1:
                for r in range(3 * k):
                    points[at + r, axis] = b[r // 3, r % 3, axis]
                for r in range(k + 3):
                    own[ends[arc] + r, axis] = controls[control + r, axis]
        if k > 1:
            knot, control = knot + k + 1, control + k + 3
        if k > 0:
            ends[arc + 1], closed[arc] = ends[arc] + k + 3, False
            arc += 1
        for s in range(max(k, 1)):
            degrees[count + s] = 1 if k == 0 else 3
        anchors[q + c, 0], anchors[q + c, 1] = count - offsets[c], pieces.where[q, 1]
        at += max(3 * k, 1)
        count += max(k, 1)
        # Those of the contour's last piece stay.
        starts[c + 1], offsets[c + 1], anchor_offsets[c + 1] = at, count, q + c + 2
        anchors[q + c + 1, 0], anchors[q + c + 1, 1] = count - offsets[c], pieces.where[q, 2]
    curves = ContourArrays(points[:at], degrees, offsets, starts)
    return Assembly(curves, Polylines(own[: ends[arc]], ends, closed), anchors, anchor_offsets)


def certify(
    contours: SplitContours, assembly: Assembly, written: ContourArrays, sharpness: float, limit: float
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """(P,) certified bound between each piece, as written, and its stretch of contour; and the largest gap seen.

    Args:
        written: the curves, rounded. sharpness, limit: see :func:`..certified_distance.certified_distance`.
    """
    return pair_stretches(
        all_cubics(written), written.offsets, contours.cubics, contours.offsets, assembly.anchors,
        assembly.anchor_offsets, sharpness, limit,
    )  # fmt: skip
