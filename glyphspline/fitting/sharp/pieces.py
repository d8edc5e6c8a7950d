"""The lines and arcs that contours are cut into, end to end."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...types import FloatArray, IntArray


class Pieces(NamedTuple):
    """Lines, arcs and closed curves, contour after contour, in order.

    Attributes:
        contour: (P,) the contour of each. joints: (P, 2) of it between which the piece runs.
        spans: (P,) 0 for a line. closed: (P,) 1 for a closed curve, which runs once round its contour, or else 0.
        starts: (P + 1,) where in ``vertices`` each begins.
        vertices: (V, K, 2) of each piece in each master, both ends of a line or an arc among them. places: (V,) of
            their contour near which they lie; around a closed curve these count on.
        tangents: (P, K, 2, 2) end tangents of arcs, derivatives by chord length: by the root mean square of the chords
            in all masters. Unset for others.
        errors: (P,) largest distance of a sample of the outline.
    """

    contour: IntArray
    joints: IntArray
    spans: IntArray
    closed: IntArray
    starts: IntArray
    vertices: FloatArray
    places: FloatArray
    tangents: FloatArray
    errors: FloatArray


@compiled
def empty_pieces(masters: int, count: int, vertices: int) -> Pieces:
    """Arrays for up to ``count`` pieces, with up to ``vertices`` vertices together."""
    return Pieces(
        np.empty(count, dtype=np.int64), np.empty((count, 2), dtype=np.int64), np.empty(count, dtype=np.int64),
        np.zeros(count, dtype=np.int64), np.zeros(count + 1, dtype=np.int64), np.empty((vertices, masters, 2)),
        np.empty(vertices), np.zeros((count, masters, 2, 2)), np.empty(count),
    )  # fmt: skip


@compiled
def add_source(pieces: Pieces, count: int, c: int, i: int, j: int, cubics: FloatArray, degrees: IntArray) -> int:
    """Add a contour's segments between two joints as they are, as lines and arcs of one span; the number then."""
    for s in range(i, j):
        at, own = pieces.starts[count], cubics[:, s].copy()
        pieces.contour[count], pieces.joints[count, 0], pieces.joints[count, 1] = c, s, s + 1
        pieces.spans[count], pieces.closed[count], pieces.errors[count] = min(degrees[s] - 1, 1), 0, 0.0
        square = 0.0
        for v in range(len(own)):
            square += np.hypot(own[v, 3, 0] - own[v, 0, 0], own[v, 3, 1] - own[v, 0, 1]) ** 2
        factor = 3 / np.sqrt(square / len(own)) if square > 0.0 else 3.0  # see chords
        for end in range(2):
            pieces.places[at + end] = s + end
            pieces.vertices[at + end] = own[:, 3 * end]
            pieces.tangents[count, :, end] = (own[:, 2 * end + 1] - own[:, 2 * end]) * factor
        pieces.starts[count + 1] = at + 2
        count += 1
    return count


@compiled
def copy_piece(source: Pieces, q: int, target: Pieces, count: int, turned: int) -> int:
    """Add a copy of piece q of others after ``count`` pieces; the number then.

    Args:
        turned: the segments of its contour if the copy runs the other way round, or else 0.
    """
    a, n, at, closed = source.starts[q], source.starts[q + 1] - source.starts[q], target.starts[count], source.closed[q]
    target.contour[count], target.errors[count] = source.contour[q], source.errors[q]
    target.spans[count], target.closed[count] = source.spans[q], closed
    target.starts[count + 1] = at + n
    if not turned:
        target.joints[count], target.tangents[count] = source.joints[q], source.tangents[q]
        target.vertices[at : at + n], target.places[at : at + n] = source.vertices[a : a + n], source.places[a : a + n]
        return count + 1
    lap = turned if closed and source.places[a] > 0.0 else 0
    for end in range(2):
        target.joints[count, end] = turned - source.joints[q, 1 - end]
        target.tangents[count, :, end] = -source.tangents[q, :, 1 - end]
    for r in range(n):
        s = a + (n - r if closed else n - 1 - r) % n  # the first vertex of a closed curve stays the first
        target.vertices[at + r], target.places[at + r] = source.vertices[s], turned + lap - source.places[s]
    if closed:
        target.places[at] -= turned
    return count + 1


@compiled
def enlarged(pieces: Pieces, count: int, more: int, vertices: int) -> Pieces:
    """The first ``count`` pieces, in larger arrays if others do not fit after them."""
    needed = pieces.starts[count] + vertices
    if count + more <= len(pieces.spans) and needed <= len(pieces.places):
        return pieces
    larger = empty_pieces(pieces.vertices.shape[1], 2 * (count + more), 2 * needed)
    for q in range(count):
        copy_piece(pieces, q, larger, q, 0)
    return larger


@compiled
def used(pieces: Pieces, count: int) -> Pieces:
    """The first ``count`` pieces."""
    end = pieces.starts[count]
    return Pieces(
        pieces.contour[:count], pieces.joints[:count], pieces.spans[:count], pieces.closed[:count],
        pieces.starts[: count + 1], pieces.vertices[:end], pieces.places[:end], pieces.tangents[:count],
        pieces.errors[:count],
    )  # fmt: skip
