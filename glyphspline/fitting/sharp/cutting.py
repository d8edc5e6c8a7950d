"""Cutting contours at their hard joints, and what lies between them: lines, cubics, and stretches that need splines.

Between two hard joints there is one C2 spline (``continuity="c2"``), or a chain of cubics that meet without a kink
(``continuity="g1"``). A contour without hard joints is one closed C2 spline. Most stretches of a typeface need a single
cubic, which is fitted here; :mod:`.spline_search` fits the others. Where a stretch has corners that do not show, one
spline and splines between all of these corners are both fitted, and the cheaper is kept.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...outlines.contour_arrays import ContourArrays
from ...outlines.segments import contour_cubics
from ...types import FloatArray, IntArray
from .corners import Joints, find_joints
from .cubic_chain import add_cubics, fit_between, is_straight
from .pieces import (
    CUT,
    ONLY,
    WHOLE,
    Pieces,
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

MOST_SAMPLES = 40
"""Most samples of a segment."""


class Stretches(NamedTuple):
    """Stretches of outline for which a spline is wanted, end to end.

    Attributes:
        piece: (S,) the piece whose place the spline takes.
        starts: (S + 1,) first sample of each. points: (N, 2) samples, the first again at the end of a closed one.
        spacing: (N,) wanted distance of vertices after each sample.
        directions: (S, 2, 2) unit tangents at the ends. free: (S, 2) whether these may turn.
    """

    piece: IntArray
    starts: IntArray
    points: FloatArray
    spacing: FloatArray
    directions: FloatArray
    free: IntArray


@compiled(internal=True)
def empty_stretches(count: int, samples: int) -> Stretches:
    """Room for so many stretches, with so many samples together."""
    stretches = Stretches(
        np.empty(count, dtype=np.int64), np.empty(count + 1, dtype=np.int64), np.empty((samples, 3)), np.empty(samples),
        np.empty((count, 2, 2)), np.empty((count, 2), dtype=np.int64),
    )  # fmt: skip
    stretches.starts[0] = 0
    return stretches


@compiled
def cut_all(contours: ContourArrays, settings: Settings) -> tuple[SplitContours, Pieces, Stretches]:
    """All contours cut: their pieces in the direction in which they are fitted, and the stretches that need splines."""
    count, most = len(contours.offsets) - 1, 2 * len(contours.degrees)
    split = SplitContours(
        np.empty((most, 4, 2)), np.empty(most, dtype=np.int64), np.empty(count + 1, dtype=np.int64),
        np.empty(count, dtype=np.bool_),
    )  # fmt: skip
    pieces, stretches = empty_pieces(2 * most, 4 * most), empty_stretches(2 * most, most)
    at = split.offsets[0] = 0
    done = wanted = contours.offsets[0]  # 0, and no literal, for which callees would be compiled once more
    for c in range(count):
        own = contours.degrees[contours.offsets[c] : contours.offsets[c + 1]]
        cubics, degrees, back, joints = laid_out(contour_cubics(contours, c), own, settings)
        split.flipped[c], m = back, len(cubics)
        i = 0 * c
        while i < m:
            j = i + 1
            while not joints.hard[j] and j < m:
                j += 1
            if joints.line[i]:
                done = _add_line(joints, (c, i, j, 0 * c, 0, ONLY), pieces, done)
            elif settings.c2:
                done, wanted, stretches = _add_stretch(joints, c, i, j, settings, pieces, done, stretches, wanted)
            else:
                done = _add_chain(joints, c, i, j, settings, pieces, done)
            i = j
        for j in range(m):
            t = m - 1 - j if back else j
            split.degrees[at + j] = degrees[t]
            for k in range(4):
                for axis in range(2):
                    split.cubics[at + j, k, axis] = cubics[t, 3 - k if back else k, axis]
        at += m
        split.offsets[c + 1] = at
    split = SplitContours(split.cubics[:at], split.degrees[:at], split.offsets, split.flipped)
    return split, used(pieces, done), _stretches_used(stretches, wanted)


@compiled(internal=True)
def _add_line(joints: Joints, row: tuple[int, int, int, int, int, int], pieces: Pieces, count: int) -> int:
    """Add a line between two joints."""
    p = _ends(joints, row[1], row[2])
    return add_piece(pieces, count, row, p, p, 0.0)


@compiled(internal=True)
def _ends(joints: Joints, i: int, j: int) -> FloatArray:
    """(2, 3) the points at two joints, and their places."""
    p = np.empty((2, 3))
    for axis in range(2):
        p[0, axis], p[1, axis] = joints.samples[joints.first[i], axis], joints.samples[joints.first[j], axis]
    p[0, 2], p[1, 2] = i, j
    return p


@compiled(internal=True)
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


@compiled(internal=True)
def _add_stretch(
    joints: Joints, c: int, i: int, j: int, settings: Settings, pieces: Pieces, count: int, stretches: Stretches,
    wanted: int,
) -> tuple[int, int, Stretches]:  # fmt: skip
    """Add what runs from hard joint i to hard joint j: as a whole, and cut at its corners if it has any."""
    corners = 0 * c
    if joints.hard[0]:
        for n in range(i + 1, j):
            corners += joints.corner[n]
    choice = WHOLE if corners > 0 else ONLY
    a = i
    for n in range(i, j + 1):
        if n == i:
            low, high = i, j
        elif corners > 0 and (n == j or joints.corner[n]):
            low, high, choice = a, n, CUT
            a = n
        else:
            continue
        before = count
        count = add_simplest(joints, (c, low, high, 1, 0, choice), settings, pieces, count)
        if pieces.errors[before] > settings.near:
            stretches = add_wanted(joints, low, high, before, stretches, wanted)
            wanted += 1
    return count, wanted, stretches


@compiled(internal=True)
def add_simplest(
    joints: Joints, row: tuple[int, int, int, int, int, int], settings: Settings, pieces: Pieces, count: int
) -> int:  # fmt: skip
    """Add a line or a cubic between two joints, with its error; a closed curve has an infinite one."""
    c, i, j, _, _, choice = row
    closed = i == 0 and j == len(joints.line) and not joints.hard[0]
    corners = not closed and joints.corner[i] and joints.corner[j]
    if corners and is_straight(joints.samples, joints.first[i], joints.first[j], settings.near):
        return _add_line(joints, (c, i, j, 0 * c, 0, choice), pieces, count)
    p, tangents = _ends(joints, i, j), np.zeros((2, 2))
    error = np.inf
    if not closed:
        error = fit_between(joints, i, j, settings.near, settings.search.cubic_rounds, tangents)
    return add_piece(pieces, count, (c, i, j, 1, int(closed), choice), p, tangents, error)


@compiled(internal=True)
def add_wanted(joints: Joints, i: int, j: int, piece: int, stretches: Stretches, count: int) -> Stretches:
    """Add the samples between two joints to ``count`` stretches that need splines; in larger arrays if need be."""
    a, b, at = joints.first[i], joints.first[j], stretches.starts[count]
    if at + b - a + 1 > len(stretches.points):
        points, spacing = np.empty((2 * (at + b - a + 1), 3)), np.empty(2 * (at + b - a + 1))
        for r in range(at):
            spacing[r] = stretches.spacing[r]
            for axis in range(3):
                points[r, axis] = stretches.points[r, axis]
        stretches = Stretches(stretches.piece, stretches.starts, points, spacing, stretches.directions, stretches.free)
    for r in range(b - a + 1):
        for axis in range(2):
            stretches.points[at + r, axis] = joints.samples[a + r, axis]
        stretches.points[at + r, 2] = joints.places[a + r]
        stretches.spacing[at + r] = joints.spacing[min(a + r, len(joints.spacing) - 1)]
    for axis in range(2):
        stretches.directions[count, 0, axis] = joints.leaving[i, axis]
        stretches.directions[count, 1, axis] = joints.arriving[j, axis]
    stretches.free[count, 0], stretches.free[count, 1] = joints.corner[i], joints.corner[j]
    stretches.piece[count], stretches.starts[count + 1] = piece, at + b - a + 1
    return stretches


@compiled
def choose(contours: SplitContours, pieces: Pieces, near: float) -> Pieces:
    """The pieces that are kept, in each contour's own direction.

    Of a spline and its cut version the one that stores less is kept; what is farther off than ``near`` becomes the
    source's own segments.
    """
    P = len(pieces.where)
    kept = np.ones(P, dtype=np.bool_)
    q = 0
    while q < P:
        last = q + 1
        while pieces.where[q, 5] == WHOLE and last < P and pieces.where[last, 5] == CUT:
            last += 1
        if last > q + 1:
            worst = pieces.errors[q + 1 : last].max()
            numbers = 0
            for r in range(q + 1, last):
                numbers += 2 * pieces.where[r, 3] + (4 if pieces.where[r, 3] > 0 else 2)
            cheaper = numbers < 2 * pieces.where[q, 3] + 4 or pieces.errors[q] > near
            cut = worst <= near and cheaper
            for r in range(q, last):
                kept[r] = cut == (r > q)
        q = last
    found = empty_pieces(P + len(contours.degrees), len(pieces.vertices) + 2 * len(contours.degrees))
    count = first = contours.offsets[0]
    for c in range(len(contours.flipped)):
        a, b, back = contours.offsets[c], contours.offsets[c + 1], contours.flipped[c]
        last = first
        while last < P and pieces.where[last, 0] == c:
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
                    found, count - 1, row_of(found, count - 1), contours.cubics[a:b], contours.degrees[a:b]
                )
        first = last
    return used(found, count)


@compiled
def source_pieces(contours: SplitContours, piece: Pieces) -> Pieces:
    """The source's own segments in the place of a single piece."""
    c, i, j = piece.where[0, 0], piece.where[0, 1], piece.where[0, 2]
    a, b = contours.offsets[c], contours.offsets[c + 1]
    found = empty_pieces(j - i, 2 * (j - i))
    return used(found, add_source(found, 0 * c, row_of(piece, 0), contours.cubics[a:b], contours.degrees[a:b]))


@compiled
def cut_again(contours: SplitContours, piece: Pieces, cut: bool, settings: Settings) -> tuple[Pieces, Stretches]:
    """A single piece taken apart again, in the direction in which it is fitted: as it is, or cut at its corners.

    Returns:
        Lines and cubics, and the stretches that need splines: of a piece as it is, always.
    """
    c, back = piece.where[0, 0], contours.flipped[piece.where[0, 0]]
    cubics = contours.cubics[contours.offsets[c] : contours.offsets[c + 1]].copy()
    degrees = contours.degrees[contours.offsets[c] : contours.offsets[c + 1]].copy()
    m = len(degrees)
    given, none = empty_pieces(1, len(piece.vertices)), 0 * c
    add_pieces(given, none, piece)
    if back:
        reverse_last(given, none + 1, m)
        cubics, degrees = cubics[::-1, ::-1].copy(), degrees[::-1].copy()
    i, j = given.where[0, 1], given.where[0, 2]
    joints = find_joints(cubics, degrees, settings.near, settings.angle, settings.line, settings.c2)
    found, stretches = empty_pieces(j - i, 2 * (j - i)), empty_stretches(j - i, 2 * len(joints.samples))
    if not cut:
        return given, _stretches_used(add_wanted(joints, i, j, none, stretches, none), none + 1)
    count = wanted = none
    for n in range(i + 1, j + 1):
        if n == j or joints.corner[n]:
            count = add_simplest(joints, (c, i, n, 1, 0, ONLY), settings, found, count)
            if found.errors[count - 1] > settings.near:
                stretches = add_wanted(joints, i, n, count - 1, stretches, wanted)
                wanted += 1
            i = n
    return used(found, count), _stretches_used(stretches, wanted)


@compiled(internal=True)
def _stretches_used(stretches: Stretches, count: int) -> Stretches:
    """The first ``count`` stretches."""
    end = stretches.starts[count]
    return Stretches(
        stretches.piece[:count], stretches.starts[: count + 1], stretches.points[:end], stretches.spacing[:end],
        stretches.directions[:count], stretches.free[:count],
    )  # fmt: skip
