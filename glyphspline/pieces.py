"""Lines and arcs, all that a glyph is cut into: cutting its contours, cutting closer, and putting them together.

Arcs of one span are all that most glyphs have. Their curve is said by their ends and end tangents; those of more spans
get theirs from :func:`glyphspline.interpolate_many`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .arcs import bezier_points, bezier_weights, jit
from .arrays import BoolArray, FloatArray, IntArray
from .chains import Chains, Flat, Settings, contour_cubics, laid_out
from .distance import ROUNDING, pair
from .frugal import MOST_SPANS, cut, fit_between
from .joints import find_joints
from .orientation import flip

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


@jit
def _room(count: int) -> Pieces:
    """Room for so many pieces."""
    return Pieces(
        np.empty((count, 4), dtype=np.int64),
        np.zeros(count + 1, dtype=np.int64),
        np.empty((count * (FINEST + 1), 2)),
        np.zeros((count, 2, 2)),
    )


@jit
def _first(pieces: Pieces, count: int) -> Pieces:
    """The first so many of them, without the room behind."""
    where, starts, vertices, tangents = pieces
    return Pieces(where[:count], starts[: count + 1], vertices[: starts[count]], tangents[:count])


@jit
def _add(
    pieces: Pieces, count: int, c: int, i: int, j: int, k: int, p: FloatArray, tangents: FloatArray, flip_m: int
) -> int:
    """Add a piece after ``count`` others; the number of pieces then.

    Args:
        c, i, j, k: contour, joints and spans. p: (max(k, 1) + 1, 2) or more rows. tangents: (2, 2).
        flip_m: 0, or for a piece that runs the other way than its chain the number of the chain's segments.
    """
    n = max(k, 1) + 1
    at = pieces.starts[count]
    row = pieces.where[count]
    if flip_m == 0:
        row[0], row[1], row[2], row[3] = c, i, j, k
        pieces.vertices[at : at + n] = p[:n]
        pieces.tangents[count] = tangents
    else:
        row[0], row[1], row[2], row[3] = c, flip_m - j, flip_m - i, k
        pieces.vertices[at : at + n] = p[:n][::-1]
        pieces.tangents[count, 0], pieces.tangents[count, 1] = -tangents[1], -tangents[0]
    pieces.starts[count + 1] = at + n
    return count + 1


@jit
def _add_source(
    pieces: Pieces, count: int, c: int, cubics: FloatArray, degrees: IntArray, i: int, j: int
) -> int:  # fmt: skip
    """Add segments i to j - 1 of a chain as they are, as lines and arcs of one span."""
    tangents = np.zeros((2, 2))
    for s in range(i, j):
        b = cubics[s]
        if degrees[s] > 1:
            chord = np.hypot(b[3, 0] - b[0, 0], b[3, 1] - b[0, 1])
            tangents[0], tangents[1] = (b[1] - b[0]) * 3 / chord, (b[3] - b[2]) * 3 / chord
        count = _add(pieces, count, c, s, s + 1, min(degrees[s] - 1, 1), b[::3], tangents, 0)
    return count


@jit
def cut_contours(flat: Flat, settings: Settings) -> tuple[Chains, Pieces]:
    """All contours made ready and cut, by :mod:`.frugal`; stretches that it cannot fit stay as they are."""
    C = len(flat.offsets) - 1
    most = 2 * len(flat.degrees)
    chains = Chains(
        np.empty((most, 4, 2)), np.empty(most, dtype=np.int64), np.zeros(C + 1, dtype=np.int64),
        np.zeros(C, dtype=np.bool_),
    )  # fmt: skip
    pieces, count = _room(most), 0
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
        chains.cubics[at : at + m], chains.degrees[at : at + m] = cubics, degrees
        chains.offsets[c + 1], chains.flipped[c] = at + m, flipped
    total = chains.offsets[C]
    return Chains(chains.cubics[:total], chains.degrees[:total], chains.offsets, chains.flipped), _first(pieces, count)


@jit
def cut_closer(chains: Chains, pieces: Pieces, poor: BoolArray, extra: int, rounds: int, settings: Settings) -> Pieces:
    """Pieces with others in the place of poor ones: an arc of ``extra`` spans more, or the source's own segments.

    Args:
        poor: (P,) which pieces have failed.
        extra: spans to add; 0 to take the source's segments at once. rounds: most Gauss-Newton steps.
    """
    longest = 0
    for q in range(len(poor)):
        longest += pieces.where[q, 2] - pieces.where[q, 1] if poor[q] else 1
    result, count, near = _room(longest), 0, 0.9 * settings.near
    p, tangents = np.empty((FINEST + 1, 2)), np.zeros((2, 2))
    for q in range(len(poor)):
        c, i, j, k = pieces.where[q]
        at = pieces.starts[q]
        if not poor[q]:
            count = _add(result, count, c, i, j, k, pieces.vertices[at:], pieces.tangents[q], 0)
            continue
        cubics = chains.cubics[chains.offsets[c] : chains.offsets[c + 1]]
        degrees = chains.degrees[chains.offsets[c] : chains.offsets[c + 1]]
        m = len(cubics)
        k = max(k, 1) + extra
        if extra > 0 and k <= FINEST:
            back = m if chains.flipped[c] else 0
            a, b = (m - j, m - i) if back else (i, j)
            chain = flip(cubics) if back else cubics
            joints = find_joints(
                chain, degrees[::-1].copy() if back else degrees, settings.near, settings.angle, settings.line
            )
            error = fit_between(
                joints, a, b, k, near, settings.margin, settings.residual, rounds, p, tangents[0], tangents[1]
            )
            if error <= near:
                count = _add(result, count, c, a, b, k, p, tangents, back)
                continue
        count = _add_source(result, count, c, cubics, degrees, i, j)
    return _first(result, count)


@jit
def put_together(pieces: Pieces, contours: int, knots: FloatArray, controls: FloatArray) -> Flat:
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
        p = pieces.vertices[pieces.starts[q] : pieces.starts[q + 1]]
        if k == 0:
            points[at] = p[0]
        elif k == 1:
            third = np.hypot(p[1, 0] - p[0, 0], p[1, 1] - p[0, 1]) / 3
            points[at] = p[0]
            points[at + 1] = p[0] + third * pieces.tangents[q, 0]
            points[at + 2] = p[1] - third * pieces.tangents[q, 1]
        else:
            bezier_weights(knots[knot : knot + k + 1], k, M)
            bezier_points(M, controls[control : control + k + 3], k, b)
            for s in range(k):
                points[at + 3 * s : at + 3 * s + 3] = b[s, :3]
            knot, control = knot + k + 1, control + k + 3
        degrees[count : count + max(k, 1)] = 1 if k == 0 else 3
        at += max(3 * k, 1)
        count += max(k, 1)
        starts[c + 1], offsets[c + 1] = at, count
    return Flat(points[:at], degrees, offsets, starts)


@jit
def certify(
    chains: Chains, pieces: Pieces, written: Flat, sharpness: float, limit: float
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """Certified bound between each piece, as written, and its stretch of chain; and the largest gap seen.

    Args:
        written: the contours of :func:`put_together`, rounded.
        sharpness, limit: see :func:`.distance.certified_distance`.
    """
    bounds, gaps = np.empty(len(pieces.where)), np.empty(len(pieces.where))
    q = 0
    for c in range(len(chains.offsets) - 1):
        result = contour_cubics(written, c)
        source = chains.cubics[chains.offsets[c] : chains.offsets[c + 1]]
        rounding = ROUNDING * max(np.abs(result).max(), np.abs(source).max())
        at = 0.0
        while q < len(bounds) and pieces.where[q, 0] == c:
            _, i, j, k = pieces.where[q]
            to = at + max(k, 1)
            bound, gap = pair(result, at, to, source, float(i), float(j), sharpness)
            if bound > limit:
                other, gap_there = pair(source, float(i), float(j), result, at, to, sharpness)
                if other < bound:
                    bound, gap = other, gap_there
            bounds[q], gaps[q] = bound + rounding, gap
            at = to
            q += 1
    return bounds, gaps
