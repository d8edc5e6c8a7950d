"""Cutting contours at their hard joints, and fitting what lies between them: lines, cubics and splines.

Between two hard joints there is one C2 spline. A contour without hard joints is one closed C2 spline. Most stretches of
a typeface need a single cubic; :mod:`.spline_search` fits the others. Where a stretch has corners that do not show, one
spline and splines between all of these corners are both fitted, and the cheaper is kept.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import split
from ...intrinsics import borrowed, keep_alive
from ...outlines.contour_arrays import ContourArrays
from ...outlines.segments import farthest_joint, is_backward, lasting
from ...types import BoolArray, FloatArray, IntArray
from .corners import Joints, find_joints
from .cubics import fit_between, is_straight
from .pieces import Pieces, add_source, copy_piece, empty_pieces, enlarged, used
from .settings import Settings
from .spline_search import fit_spline


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


@compiled
def prepared(cubics: FloatArray, degrees: IntArray, settings: Settings) -> tuple[FloatArray, IntArray, bool, Joints]:
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
            found[v, last] = cubics[v, j]
            if closed:
                split(found[v, last], 0.5, found[v, count])
        kept[count] = kept[last] = degrees[j]
        count = last + 1
    chain, kept = found[:, :count].copy(), kept[:count]
    m, flipped = count, is_backward(chain[0])
    if flipped:
        chain, kept = chain[:, ::-1, ::-1].copy(), kept[::-1].copy()
    joints = find_joints(chain, kept, settings)
    k = 0
    while k < m and not joints.hard[k]:
        k += 1
    if k == m:
        k = farthest_joint(chain[0, :, 0])
    if k > 0:
        chain = np.concatenate((chain[:, k:], chain[:, :k]), axis=1)
        kept = np.roll(kept, -k)
        joints = find_joints(chain, kept, settings)
    return chain, kept, flipped, joints


@compiled
def fit_contours(cubics: FloatArray, contours: ContourArrays, settings: Settings) -> tuple[Chains, Pieces]:
    """All contours as they are cut, and lines and arcs that follow them.

    Pieces that are farther off than ``settings.near`` become the source's own segments.

    Args:
        cubics: (K, m, 4, 2) the contours' segments in each master. contours: their degrees and offsets.
    """
    masters, count, most = len(cubics), len(contours.offsets) - 1, 2 * len(contours.degrees)
    chains = Chains(
        np.empty((masters, most, 4, 2)), np.empty(most, dtype=np.int64), np.zeros(count + 1, dtype=np.int64),
        np.empty(count, dtype=np.bool_),
    )  # fmt: skip
    pieces, done = empty_pieces(masters, most, 4 * most), 0
    for c in range(count):
        a, b = contours.offsets[c], contours.offsets[c + 1]
        chain, degrees, flipped, joints = prepared(cubics[:, a:b].copy(), contours.degrees[a:b], settings)
        own = fit_contour(borrowed(joints), c, settings)
        keep_alive(joints)
        if flipped:
            chain, degrees = chain[:, ::-1, ::-1].copy(), degrees[::-1].copy()
        m, P, at = len(degrees), len(own.spans), chains.offsets[c]
        chains.cubics[:, at : at + m], chains.degrees[at : at + m] = chain, degrees
        chains.offsets[c + 1], chains.flipped[c] = at + m, flipped
        pieces = enlarged(pieces, done, P + m, len(own.places) + 2 * m)
        for n in range(P):
            q = P - 1 - n if flipped else n
            i, j = own.joints[q, 0], own.joints[q, 1]
            if own.errors[q] <= settings.near:
                done = copy_piece(own, q, pieces, done, m if flipped else 0)
            else:
                i, j = (m - j, m - i) if flipped else (i, j)
                done = add_source(pieces, done, c, i, j, chain, degrees)
    at = chains.offsets[count]
    chains = Chains(chains.cubics[:, :at].copy(), chains.degrees[:at], chains.offsets, chains.flipped)
    return chains, used(pieces, done)


@compiled
def fit_contour(joints: Joints, c: int, settings: Settings) -> Pieces:
    """Lines and arcs from joint to joint of contour c, in the direction in which it is fitted."""
    m, near = len(joints.line), settings.near
    owned, count, i = empty_pieces(len(joints.samples), 2 * m, 2 * (len(joints.places) + 2 * m)), 0, 0
    pieces = borrowed(owned)
    while i < m:
        j = i + 1
        while j < m and not joints.hard[j]:
            j += 1
        if joints.line[i]:
            count = add_simplest(joints, i, j, settings, pieces, count)
        else:
            first, cut = count, joints.hard[0] and joints.corner[i + 1 : j].any()
            for whole in range(0 if cut else 1, 2):
                a = i
                for b in range(i + 1, j + 1):
                    if b == j or (not whole and joints.corner[b]):
                        count = add_simplest(joints, a, b, settings, pieces, count)
                        if pieces.errors[count - 1] > near:
                            fit_spline(joints, near, settings, False, pieces, count - 1)
                        a = b
            if cut:
                whole, numbers, worst = count - 1, 0, 0.0
                for q in range(first, whole):
                    numbers += 2 * pieces.spans[q] + (4 if pieces.spans[q] > 0 else 2)
                    worst = max(worst, pieces.errors[q])
                # Those cut at corners are kept if they store as little: a corner that is rounded is a peak of curvature
                if worst <= near and (numbers <= 2 * pieces.spans[whole] + 4 or pieces.errors[whole] > near):
                    count = whole
                else:
                    count = copy_piece(pieces, whole, pieces, first, 0)
        i = j
    owned.contour[:] = c
    return used(owned, count)


@compiled
def add_simplest(joints: Joints, i: int, j: int, settings: Settings, pieces: Pieces, count: int) -> int:
    """Add a line or a cubic between two joints, with its error; the number of pieces then.

    It is infinite for a closed curve, and beside a tied joint, where the cubics of the masters have to agree: these are
    for splines, which may have one span.
    """
    closed = i == 0 and j == len(joints.line) and not joints.hard[0]
    straight = not closed and joints.corner[i] and joints.corner[j]
    straight = straight and is_straight(joints.samples, joints.first[i], joints.first[j], settings.near)
    straight = straight or joints.line[i]
    error = 0.0 if straight else np.inf
    if not (straight or closed or joints.tied[i] or joints.tied[j]):
        error = fit_between(joints, i, j, settings.near, settings.cubic_rounds, pieces.tangents[count])
    at = pieces.starts[count]
    pieces.joints[count, 0], pieces.joints[count, 1] = i, j
    pieces.spans[count], pieces.closed[count], pieces.errors[count] = 0 if straight else 1, closed, error
    for end, joint in ((0, i), (1, j)):
        pieces.places[at + end] = joint
        pieces.vertices[at + end] = joints.samples[:, joints.first[joint]]
    pieces.starts[count + 1] = at + 2
    return count + 1


@compiled
def refit(
    chains: Chains, pieces: Pieces, poor: BoolArray, shares: FloatArray, settings: Settings
) -> tuple[Pieces, IntArray]:
    """Pieces with others in the place of poor ones: fitted more closely, or else the source's own segments.

    Args:
        shares: of ``settings.near``, to be tried in turn.

    Returns:
        The pieces, and which of the given ones each is; -1 for others.
    """
    masters, most = len(chains.cubics), len(pieces.spans) + len(chains.degrees)
    found, same, count = empty_pieces(masters, most, 2 * len(pieces.places) + 2 * most), np.full(most, -1), 0
    for q in range(len(pieces.spans)):
        if not poor[q]:
            same[count] = q
            found = enlarged(found, count, most - count, pieces.starts[q + 1] - pieces.starts[q])
            count = copy_piece(pieces, q, found, count, 0)
            continue
        c = pieces.contour[q]
        a, b, flipped = chains.offsets[c], chains.offsets[c + 1], chains.flipped[c]
        chain, degrees, turned = chains.cubics[:, a:b].copy(), chains.degrees[a:b].copy(), b - a if flipped else 0
        joints = find_joints(
            chain[:, ::-1, ::-1].copy() if flipped else chain, degrees[::-1].copy() if flipped else degrees, settings
        )
        own = empty_pieces(masters, 1, len(joints.places) + pieces.starts[q + 1] - pieces.starts[q])
        own.errors[0] = np.inf
        for share in shares:
            copy_piece(pieces, q, own, 0, turned)
            # The masters' vertices may be where slip rules them out: a new guess is better.
            fit_spline(joints, share * settings.near, settings, masters == 1, own, 0)
            if own.errors[0] <= share * settings.near:
                break
            own.errors[0] = np.inf
        found = enlarged(found, count, most - count, len(own.places) + 2 * (b - a))
        if own.errors[0] < np.inf:
            count = copy_piece(own, 0, found, count, turned)
        else:
            count = add_source(found, count, c, pieces.joints[q, 0], pieces.joints[q, 1], chain, degrees)
    return used(found, count), same[:count]
