"""The lines and arcs that contours are cut into, end to end."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...types import FloatArray, IntArray

Row = tuple[int, int, int, int, int, int]
"""A row of ``Pieces.where``."""

CONTOUR, FIRST, LAST, SPANS, CLOSED, CHOICE = range(6)
"""Its columns."""

ONLY, WHOLE, CUT = 0, 1, 2
"""A piece is the only way between two hard joints; or one spline; or it is one of several cut at corners instead."""


class Pieces(NamedTuple):
    """Lines, arcs and closed curves, contour after contour, in order.

    Attributes:
        where: (P, 6) contour; first and last joint of it between which the piece runs; spans, 0 for a line; 1 for a
            closed curve, which runs once round its contour; and ONLY, WHOLE or CUT.
        starts: (P + 1,) where in ``vertices`` each begins.
        vertices: (K, V, 2) of each piece in each master, both ends of a line or an arc among them. places: (V,) of
            their contour near which they lie; around a closed curve these count on.
        tangents: (K, P, 2, 2) end tangents of arcs, derivatives by chord length: by the root mean square of the chords
            in all masters. Unset for others.
        errors: (P,) largest distance of a sample of the outline.
    """

    where: IntArray
    starts: IntArray
    vertices: FloatArray
    places: FloatArray
    tangents: FloatArray
    errors: FloatArray


@compiled
def empty_pieces(masters: int, count: int, vertices: int) -> Pieces:
    """Room for so many pieces, with so many vertices together."""
    pieces = Pieces(
        np.empty((count, 6), dtype=np.int64), np.empty(count + 1, dtype=np.int64), np.empty((masters, vertices, 2)),
        np.empty(vertices), np.empty((masters, count, 2, 2)), np.empty(count),
    )  # fmt: skip
    pieces.starts[0] = 0
    return pieces


@compiled
def used(pieces: Pieces, count: int) -> Pieces:
    """The first ``count`` pieces."""
    where, starts, vertices, places, tangents, errors = pieces
    end = starts[count]
    return Pieces(
        where[:count], starts[: count + 1], vertices[:, :end].copy(), places[:end], tangents[:, :count].copy(),
        errors[:count],
    )  # fmt: skip


@compiled
def part(pieces: Pieces, a: int, b: int) -> Pieces:
    """Pieces a to b - 1."""
    where, starts, vertices, places, tangents, errors = pieces
    first, end = starts[a], starts[b]
    own = starts[a : b + 1] - first
    return Pieces(
        where[a:b], own, vertices[:, first:end].copy(), places[first:end], tangents[:, a:b].copy(), errors[a:b]
    )


@compiled
def of_master(pieces: Pieces, v: int) -> Pieces:
    """The pieces in one master."""
    where, starts, vertices, places, tangents, errors = pieces
    return Pieces(where, starts, vertices[v : v + 1], places, tangents[v : v + 1], errors)


@compiled
def row_of(pieces: Pieces, q: int) -> Row:
    """Piece q's row of ``where``."""
    where = pieces.where
    return where[q, 0], where[q, 1], where[q, 2], where[q, 3], where[q, 4], where[q, 5]


@compiled
def add_pieces(pieces: Pieces, count: int, others: Pieces) -> int:
    """Add pieces after ``count`` others; the number then."""
    for q in range(len(others.where)):
        a, b = others.starts[q], others.starts[q + 1]
        count = add_piece(
            pieces, count, row_of(others, q), others.vertices[:, a:b].copy(), others.places[a:b],
            others.tangents[:, q].copy(), others.errors[q],
        )  # fmt: skip
    return count


@compiled
def add_piece(
    pieces: Pieces, count: int, row: Row, p: FloatArray, places: FloatArray, tangents: FloatArray, error: float
) -> int:
    """Add a piece after ``count`` others; the number then.

    Args:
        row: of ``where``. p: (K, n, 2) its vertices, and their (n,) places. tangents: (K, 2, 2) at its ends.
    """
    at, n = pieces.starts[count], max(row[SPANS], 1) + 1 - row[CLOSED]
    for c in range(6):
        pieces.where[count, c] = row[c]
    for r in range(n):
        pieces.places[at + r] = places[r]
    for v in range(len(p)):
        for axis in range(2):
            for r in range(n):
                pieces.vertices[v, at + r, axis] = p[v, r, axis]
            for end in range(2):
                pieces.tangents[v, count, end, axis] = tangents[v, end, axis]
    pieces.errors[count] = error
    pieces.starts[count + 1] = at + n
    return count + 1


@compiled
def reverse_last(pieces: Pieces, count: int, m: int) -> None:
    """Turn the last of ``count`` pieces round, for a contour of m segments that is fitted the other way."""
    q = count - 1
    where, places, first, stop = pieces.where[q], pieces.places, pieces.starts[q], pieces.starts[q + 1]
    where[FIRST], where[LAST] = m - where[LAST], m - where[FIRST]
    lap = float(m) if where[CLOSED] and places[first] > 0.0 else 0.0
    for r in range(first, stop):
        places[r] = m + lap - places[r]
    low, high = first, stop - 1
    if where[CLOSED]:  # the first vertex of a closed curve stays the first
        places[first] -= m
        low += 1
    while low < high:
        places[low], places[high] = places[high], places[low]
        for v in range(len(pieces.vertices)):
            p = pieces.vertices[v]
            for axis in range(2):
                p[low, axis], p[high, axis] = p[high, axis], p[low, axis]
        low, high = low + 1, high - 1
    for v in range(len(pieces.tangents)):
        tangents = pieces.tangents[v, q]
        for axis in range(2):
            tangents[0, axis], tangents[1, axis] = -tangents[1, axis], -tangents[0, axis]


@compiled
def add_source(pieces: Pieces, count: int, row: Row, cubics: FloatArray, degrees: IntArray) -> int:
    """Add the segments of a contour between two joints as they are, as lines and arcs of one span; the number then."""
    masters = len(cubics)
    p, places, tangents = np.empty((masters, 2, 2)), np.empty(2), np.empty((masters, 2, 2))
    for s in range(row[FIRST], row[LAST]):
        places[0], places[1] = s, s + 1
        square = 0.0
        for v in range(masters):
            own = cubics[v, s]
            square += np.hypot(own[3, 0] - own[0, 0], own[3, 1] - own[0, 1]) ** 2
        factor = 3 / np.sqrt(square / masters)
        for v in range(masters):
            own = cubics[v, s]
            for axis in range(2):
                for end in range(2):
                    p[v, end, axis] = own[3 * end, axis]
                    tangents[v, end, axis] = (own[2 * end + 1, axis] - own[2 * end, axis]) * factor
        count = add_piece(
            pieces, count, (row[CONTOUR], s, s + 1, int(degrees[s] > 1), 0, ONLY), p, places, tangents, 0.0
        )
    return count
