"""Cutting contours at their hard joints, and what lies between them: lines, cubics, and stretches that need splines.

Between two hard joints there is one C2 spline (``continuity="c2"``), or a chain of cubics that meet without a kink
(``continuity="g1"``). A contour without hard joints is one closed C2 spline. Most stretches of a typeface need a single
cubic, which is fitted here; :mod:`.spline_search` fits the others. Where a stretch has corners that do not show, one
spline and splines between all of these corners are both fitted, and the cheaper is kept.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...outlines.contour_arrays import ContourArrays
from ...types import FloatArray
from .corners import Joints, find_joints
from .cubic_chain import add_cubics, ends, fit_between, is_straight
from .pieces import (
    CHOICE,
    CONTOUR,
    CUT,
    FIRST,
    LAST,
    ONLY,
    SPANS,
    WHOLE,
    Pieces,
    Row,
    add_piece,
    add_pieces,
    add_source,
    empty_pieces,
    part,
    reverse_last,
    row_of,
    used,
)
from .split_contours import Settings, SplitContours, laid_out
from .stretches import Stretches, add_stretch, empty_stretches, stretches_used


@compiled
def cut_all(cubics: FloatArray, contours: ContourArrays, settings: Settings) -> tuple[SplitContours, Pieces, Stretches]:
    """All contours cut: their pieces in the direction in which they are fitted, and the stretches that need splines.

    Args:
        cubics: (K, m, 4, 2) the contours' segments in each master. contours: their degrees and offsets.
    """
    masters, count, most = len(cubics), len(contours.offsets) - 1, 2 * len(contours.degrees)
    split = SplitContours(
        np.empty((masters, most, 4, 2)), np.empty(most, dtype=np.int64), np.empty(count + 1, dtype=np.int64),
        np.empty(count, dtype=np.bool_),
    )  # fmt: skip
    pieces, stretches = empty_pieces(masters, 2 * most, 4 * most), empty_stretches(masters, 2 * most, most)
    at = split.offsets[0] = 0
    done = wanted = 0
    for c in range(count):
        a, b = contours.offsets[c], contours.offsets[c + 1]
        chain, degrees, back, joints = laid_out(cubics[:, a:b].copy(), contours.degrees[a:b], settings)
        split.flipped[c], m = back, len(degrees)
        i = 0
        while i < m:
            j = i + 1
            while not joints.hard[j] and j < m:
                j += 1
            if joints.line[i]:
                done = _add_line(joints, (c, i, j, 0, 0, ONLY), pieces, done)
            elif settings.c2:
                done, wanted, stretches = _add_splines(joints, c, i, j, settings, pieces, done, stretches, wanted)
            else:
                done = _add_chain(joints, c, i, j, settings, pieces, done)
            i = j
        for j in range(m):
            t = m - 1 - j if back else j
            split.degrees[at + j] = degrees[t]
            for v in range(masters):
                for k in range(4):
                    for axis in range(2):
                        split.cubics[v, at + j, k, axis] = chain[v, t, 3 - k if back else k, axis]
        at += m
        split.offsets[c + 1] = at
    split = SplitContours(split.cubics[:, :at].copy(), split.degrees[:at], split.offsets, split.flipped)
    return split, used(pieces, done), stretches_used(stretches, wanted)


@compiled
def _add_line(joints: Joints, row: Row, pieces: Pieces, count: int) -> int:
    """Add a line between two joints."""
    p, places = ends(joints, row[1], row[2])
    return add_piece(pieces, count, row, p, places, p, 0.0)


@compiled
def _add_chain(joints: Joints, c: int, i: int, j: int, settings: Settings, pieces: Pieces, count: int) -> int:
    """Add cubics from hard joint i to hard joint j, which end at corners and at every so many joints."""
    nodes = np.empty(j - i + 1, dtype=np.int64)
    nodes[0] = i
    last = 0
    for n in range(i + 1, j):
        if joints.corner[n] or n - nodes[last] >= settings.stride:
            last += 1
            nodes[last] = n
    nodes[last + 1] = j
    return add_cubics(joints, c, nodes[: last + 2], settings, pieces, count)


@compiled
def _add_splines(
    joints: Joints, c: int, i: int, j: int, settings: Settings, pieces: Pieces, count: int, stretches: Stretches,
    wanted: int,
) -> tuple[int, int, Stretches]:  # fmt: skip
    """Add what runs from hard joint i to hard joint j: as a whole, and cut at its corners if it has any."""
    corners = 0
    if joints.hard[0]:
        for n in range(i + 1, j):
            corners += joints.corner[n]
    row = c, i, j, 1, 0, WHOLE if corners > 0 else ONLY
    count, wanted, stretches = _add_spline(joints, row, settings, pieces, count, stretches, wanted)
    if corners > 0:
        return _add_cut(joints, c, i, j, CUT, settings, pieces, count, stretches, wanted)
    return count, wanted, stretches


@compiled
def _add_cut(
    joints: Joints, c: int, i: int, j: int, choice: int, settings: Settings, pieces: Pieces, count: int,
    stretches: Stretches, wanted: int,
) -> tuple[int, int, Stretches]:  # fmt: skip
    """Add pieces from joint i to joint j that end at all corners between."""
    for n in range(i + 1, j + 1):
        if n == j or joints.corner[n]:
            row = c, i, n, 1, 0, choice
            count, wanted, stretches = _add_spline(joints, row, settings, pieces, count, stretches, wanted)
            i = n
    return count, wanted, stretches


@compiled
def _add_spline(
    joints: Joints, row: Row, settings: Settings, pieces: Pieces, count: int, stretches: Stretches, wanted: int
) -> tuple[int, int, Stretches]:
    """Add a line or a cubic between two joints, and a stretch that needs a spline where neither is near enough."""
    count = _add_simplest(joints, row, settings, pieces, count)
    if pieces.errors[count - 1] > settings.near:
        stretches = add_stretch(stretches, wanted, joints, row[1], row[2], count - 1)
        wanted += 1
    return count, wanted, stretches


@compiled
def _add_simplest(joints: Joints, row: Row, settings: Settings, pieces: Pieces, count: int) -> int:
    """Add a line or a cubic between two joints, with its error.

    It is infinite for a closed curve, and beside a tied joint, where the cubics of the masters have to agree: these are
    stretches that need a spline, which may have one span.
    """
    c, i, j, _, _, choice = row
    closed = i == 0 and j == len(joints.line) and not joints.hard[0]
    corners = not closed and joints.corner[i] and joints.corner[j]
    if corners and is_straight(joints.samples, joints.first[i], joints.first[j], settings.near):
        return _add_line(joints, (c, i, j, 0, 0, choice), pieces, count)
    (p, places), tangents = ends(joints, i, j), np.zeros((len(joints.samples), 2, 2))
    error = np.inf
    if not (closed or joints.tied[i] or joints.tied[j]):
        error = fit_between(joints, i, j, settings.near, settings.search.cubic_rounds, tangents)
    return add_piece(pieces, count, (c, i, j, 1, int(closed), choice), p, places, tangents, error)


@compiled
def choose(contours: SplitContours, pieces: Pieces, near: float) -> Pieces:
    """The pieces that are kept, in each contour's own direction.

    Of a spline and its cut version the one that stores less is kept, the cut one if they store the same: a corner that
    is rounded is a peak of curvature. What is farther off than ``near`` becomes the source's own segments.
    """
    P = len(pieces.where)
    kept = np.ones(P, dtype=np.bool_)
    q = 0
    while q < P:
        last = q + 1
        while pieces.where[q, CHOICE] == WHOLE and last < P and pieces.where[last, CHOICE] == CUT:
            last += 1
        if last > q + 1:
            worst = pieces.errors[q + 1 : last].max()
            numbers = 0
            for r in range(q + 1, last):
                numbers += 2 * pieces.where[r, SPANS] + (4 if pieces.where[r, SPANS] > 0 else 2)
            cut = worst <= near and (numbers <= 2 * pieces.where[q, SPANS] + 4 or pieces.errors[q] > near)
            for r in range(q, last):
                kept[r] = cut == (r > q)
        q = last
    m = len(contours.degrees)
    found = empty_pieces(len(contours.cubics), P + m, len(pieces.places) + 2 * m)
    count = first = contours.offsets[0]
    for c in range(len(contours.flipped)):
        a, b, back = contours.offsets[c], contours.offsets[c + 1], contours.flipped[c]
        last = first
        while last < P and pieces.where[last, CONTOUR] == c:
            last += 1
        for n in range(last - first):
            q = last - 1 - n if back else first + n
            if not kept[q]:
                continue
            count = add_pieces(found, count, part(pieces, q, q + 1))
            if back:
                reverse_last(found, count, b - a)
            if pieces.errors[q] > near:
                count = add_source(
                    found, count - 1, row_of(found, count - 1), contours.cubics[:, a:b].copy(), contours.degrees[a:b]
                )
        first = last
    return used(found, count)


@compiled
def source_pieces(contours: SplitContours, piece: Pieces) -> Pieces:
    """The source's own segments in the place of a single piece."""
    row = row_of(piece, 0)
    a, b = contours.offsets[row[CONTOUR]], contours.offsets[row[CONTOUR] + 1]
    most = row[LAST] - row[FIRST]
    found = empty_pieces(len(contours.cubics), most, 2 * most)
    return used(found, add_source(found, 0, row, contours.cubics[:, a:b].copy(), contours.degrees[a:b]))


@compiled
def joints_again(contours: SplitContours, c: int, settings: Settings) -> Joints:
    """The joints of contour c, in the direction in which it is fitted."""
    a, b = contours.offsets[c], contours.offsets[c + 1]
    cubics, degrees = contours.cubics[:, a:b].copy(), contours.degrees[a:b].copy()
    if contours.flipped[c]:
        cubics, degrees = cubics[:, ::-1, ::-1].copy(), degrees[::-1].copy()
    return find_joints(cubics, degrees, settings.near, settings.angle, settings.line, settings.c2)


@compiled
def cut_again(
    contours: SplitContours, piece: Pieces, joints: Joints, cut: bool, settings: Settings
) -> tuple[Pieces, Stretches]:
    """A single piece taken apart again, in the direction in which it is fitted: as it is, or cut at its corners.

    Args:
        joints: of its contour, by :func:`joints_again`.

    Returns:
        Lines and cubics, and the stretches that need splines: of a piece as it is, always.
    """
    c = piece.where[0, CONTOUR]
    masters = len(contours.cubics)
    given, count = empty_pieces(masters, 1, len(piece.places)), 0
    add_pieces(given, count, piece)
    if contours.flipped[c]:
        reverse_last(given, count + 1, contours.offsets[c + 1] - contours.offsets[c])
    i, j = given.where[0, FIRST], given.where[0, LAST]
    found = empty_pieces(masters, j - i, 2 * (j - i))
    stretches = empty_stretches(masters, j - i, 2 * len(joints.places))
    if not cut:
        return given, stretches_used(add_stretch(stretches, count, joints, i, j, count), count + 1)
    count, wanted, stretches = _add_cut(joints, c, i, j, ONLY, settings, found, count, stretches, count)
    return used(found, count), stretches_used(stretches, wanted)
