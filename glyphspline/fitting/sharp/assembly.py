"""Lines and arcs, all that a glyph is cut into: cutting its contours, cutting closer, and putting them together.

Arcs of one span are all that most glyphs have. Their curve is said by their ends and end tangents; those of more spans
get theirs from :func:`glyphspline.interpolate_many`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import bezier_points, bezier_weights
from ...outlines.canonical import flip
from ...outlines.contour_arrays import ContourArrays
from ...outlines.segments import contour_cubics
from ...types import BoolArray, FloatArray, IntArray
from ..certified_distance import ROUNDING, extent, pair
from .corners import find_joints
from .segmentation import MOST_SPANS, cut, fit_between
from .split_contours import Chains, Settings, laid_out

FINEST = MOST_SPANS["best"]


class Pieces(NamedTuple):
    """Lines and arcs, contour after contour, in order.

    Attributes:
        where: (P, 4) contour; first and last joint of its chain between which the piece runs; spans, 0 for a line.
        starts: (P + 1,) where in ``vertices`` each begins.
        vertices: (V, 2) of each piece, both ends among them.
        tangents: (P, 2, 2) end tangents of arcs, derivatives by chord length.
    """

    where: IntArray
    starts: IntArray
    vertices: FloatArray
    tangents: FloatArray


@compiled
def room(count: int) -> Pieces:
    """Room for so many pieces."""
    return Pieces(
        np.empty((count, 4), dtype=np.int64),
        np.zeros(count + 1, dtype=np.int64),
        np.empty((count * (FINEST + 1), 2)),
        np.zeros((count, 2, 2)),
    )


@compiled
def _add(
    pieces: Pieces, count: int, c: int, i: int, j: int, k: int, p: FloatArray, tangents: FloatArray, flip_m: int
) -> int:
    """Add a piece after ``count`` others; the number of pieces then.

    Args:
        c, i, j, k: contour, joints and spans. p: (max(k, 1) + 1, 2) or more rows. tangents: (2, 2).
        flip_m: 0, or for a piece that runs the other way than its chain the number of the chain's segments.
    """
    n, at = max(k, 1), pieces.starts[count]
    row, tau = pieces.where[count], pieces.tangents[count]
    back = flip_m > 0
    row[0], row[1], row[2], row[3] = c, flip_m - j if back else i, flip_m - i if back else j, k
    for axis in range(2):
        for r in range(n + 1):
            pieces.vertices[at + r, axis] = p[n - r if back else r, axis]
        for end in range(2):
            tau[end, axis] = -tangents[1 - end, axis] if back else tangents[end, axis]
    pieces.starts[count + 1] = at + n + 1
    return count + 1


@compiled
def _add_source(pieces: Pieces, count: int, c: int, cubics: FloatArray, degrees: IntArray, i: int, j: int) -> int:
    """Add segments i to j - 1 of a chain as they are, as lines and arcs of one span."""
    p, tangents = np.empty((2, 2)), np.empty((2, 2))
    for s in range(i, j):
        b = cubics[s]
        factor = 3 / np.hypot(b[3, 0] - b[0, 0], b[3, 1] - b[0, 1])
        for axis in range(2):
            p[0, axis], p[1, axis] = b[0, axis], b[3, axis]
            tangents[0, axis], tangents[1, axis] = (
                (b[1, axis] - b[0, axis]) * factor,
                (b[3, axis] - b[2, axis]) * factor,
            )
        count = _add(pieces, count, c, s, s + 1, 0 if degrees[s] == 1 else 1, p, tangents, 0)
    return count


@compiled
def cut_contours(flat: ContourArrays, settings: Settings) -> tuple[Chains, Pieces]:
    """All contours made ready and cut, by :mod:`.segmentation`; stretches that it cannot fit stay as they are."""
    C = len(flat.offsets) - 1
    most = 2 * len(flat.degrees)
    chains = Chains(
        np.empty((most, 4, 2)), np.empty(most, dtype=np.int64), np.zeros(C + 1, dtype=np.int64),
        np.zeros(C, dtype=np.bool_),
    )  # fmt: skip
    pieces, count = room(most), 0
    where, starts, vertices, tangents = pieces
    for c in range(C):
        own = flat.degrees[flat.offsets[c] : flat.offsets[c + 1]]
        cubics, degrees, flipped, joints = laid_out(contour_cubics(flat, c), own, settings)
        found = cut(
            joints, settings.near, settings.margin, settings.residual, settings.rounds, settings.most, settings.stride
        )
        m, r = len(cubics), len(found.rows)
        if flipped:
            cubics, degrees = flip(cubics), degrees[::-1].copy()
        for n in range(r):
            q = r - 1 - n if flipped else n
            i, j, k = found.rows[q]
            if k == 0 or found.errors[q] <= settings.near:
                count = _add(pieces, count, c, i, j, k, found.vertices[q], found.tangents[q], m if flipped else 0)
            else:
                i, j = (m - j, m - i) if flipped else (i, j)
                count = _add_source(pieces, count, c, cubics, degrees, i, j)
        at = chains.offsets[c]
        for s in range(m):
            chains.degrees[at + s] = degrees[s]
            for corner in range(4):
                for axis in range(2):
                    chains.cubics[at + s, corner, axis] = cubics[s, corner, axis]
        chains.offsets[c + 1], chains.flipped[c] = at + m, flipped
    total = chains.offsets[C]
    return Chains(chains.cubics[:total], chains.degrees[:total], chains.offsets, chains.flipped), Pieces(
        where[:count], starts[: count + 1], vertices[: starts[count]], tangents[:count]
    )


def cut_closer(
    chains: Chains, pieces: Pieces, poor: BoolArray, tries: Sequence[tuple[int, float]], rounds: int, settings: Settings
) -> Pieces:
    """Pieces with others in the place of poor ones: arcs fitted more closely, or else the source's own segments.

    Few pieces are poor, so that this is the one part that is not compiled.

    Args:
        poor: (P,) which pieces have failed.
        tries: what is tried until it succeeds: how many spans to add, and the share of ``settings.near`` allowed.
        rounds: most Gauss-Newton steps.
    """
    parts, done = [], 0
    for q in np.flatnonzero(poor).tolist():
        parts += [_part(pieces, done, q), _closer(chains, pieces.where[q], tries, rounds, settings)]
        done = q + 1
    parts.append(_part(pieces, done, len(poor)))
    where, vertices, tangents = (np.concatenate([part[k] for part in parts]) for k in (0, 2, 3))
    starts = np.concatenate([[0], np.cumsum(np.maximum(where[:, 3], 1) + 1)])
    return Pieces(where, starts, vertices, tangents)


def _part(pieces: Pieces, a: int, b: int) -> Pieces:
    """Pieces a to b - 1."""
    where, starts, vertices, tangents = pieces
    return Pieces(where[a:b], starts[a : b + 1], vertices[starts[a] : starts[b]], tangents[a:b])


def _closer(
    chains: Chains, row: IntArray, tries: Sequence[tuple[int, float]], rounds: int, settings: Settings
) -> Pieces:  # fmt: skip
    """What takes the place of one piece."""
    c, i, j, spans = row.tolist()
    a, b = chains.offsets[c : c + 2].tolist()
    cubics, degrees = chains.cubics[a:b], chains.degrees[a:b]
    flipped = b - a if chains.flipped[c] else 0
    i_there, j_there = (flipped - j, flipped - i) if flipped else (i, j)
    there = (flip(cubics), degrees[::-1].copy()) if flipped else (cubics, degrees)
    joints = find_joints(*there, settings.near, settings.angle, settings.line)
    p, tangents = np.empty((FINEST + 1, 2)), np.empty((2, 2))
    for extra, share in tries:
        k, near = max(spans, 1) + extra, share * settings.near
        if k > FINEST:
            break
        error = fit_between(
            joints, i_there, j_there, k, near, settings.margin, settings.residual, rounds, p, tangents[0], tangents[1]
        )
        if error <= near:
            new = room(1)
            _add(new, 0, c, i_there, j_there, k, p, tangents, flipped)
            return _part(new, 0, 1)
    new = room(j - i)
    return _part(new, 0, _add_source(new, 0, c, cubics, degrees, i, j))


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
    offsets, starts = np.zeros(contours + 1, dtype=np.int64), np.zeros(contours + 1, dtype=np.int64)
    M, b = np.empty((FINEST, 4, 4)), np.empty((FINEST, 4, 2))
    at = count = knot = control = 0
    for q in range(P):
        c, k = pieces.where[q, 0], pieces.where[q, 3]
        p, tau = pieces.vertices[pieces.starts[q] : pieces.starts[q + 1]], pieces.tangents[q]
        if k > 1:
            bezier_weights(knots[knot : knot + k + 1], k, M)
            bezier_points(M, controls[control : control + k + 3], k, b)
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


@compiled
def certify(
    chains: Chains, pieces: Pieces, written: ContourArrays, sharpness: float, limit: float
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """Certified bound between each piece, as written, and its stretch of chain; and the largest gap seen.

    Args:
        written: the contours of :func:`put_together`, rounded.
        sharpness, limit: see :func:`..certified_distance.certified_distance`.
    """
    bounds, gaps = np.empty(len(pieces.where)), np.empty(len(pieces.where))
    q = 0
    for c in range(len(chains.offsets) - 1):
        result = contour_cubics(written, c)
        source = chains.cubics[chains.offsets[c] : chains.offsets[c + 1]]
        rounding = ROUNDING * max(extent(result), extent(source))
        at = 0.0
        while q < len(bounds) and pieces.where[q, 0] == c:
            _, i, j, k = pieces.where[q]
            to = at + max(k, 1)
            bound, gap = pair(result, at, to, source, float(i), float(j), sharpness, limit)
            bounds[q], gaps[q] = bound + rounding, gap
            at = to
            q += 1
    return bounds, gaps
