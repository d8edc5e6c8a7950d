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
        vertices: (V, 3) of each piece, both ends of a line or an arc among them, and the places of their contour near
            which they lie; around a closed curve these count on.
        tangents: (P, 2, 2) end tangents of arcs, derivatives by chord length; unset for others.
        errors: (P,) largest distance of a sample of the outline.
    """

    where: IntArray
    starts: IntArray
    vertices: FloatArray
    tangents: FloatArray
    errors: FloatArray


@compiled(internal=True)
def empty_pieces(count: int, vertices: int) -> Pieces:
    """Room for so many pieces, with so many vertices together."""
    pieces = Pieces(
        np.empty((count, 6), dtype=np.int64), np.empty(count + 1, dtype=np.int64), np.empty((vertices, 3)),
        np.empty((count, 2, 2)), np.empty(count),
    )  # fmt: skip
    pieces.starts[0] = 0
    return pieces


@compiled(internal=True)
def used(pieces: Pieces, count: int) -> Pieces:
    """The first ``count`` pieces."""
    where, starts, vertices, tangents, errors = pieces
    return Pieces(where[:count], starts[: count + 1], vertices[: starts[count]], tangents[:count], errors[:count])


@compiled
def part(pieces: Pieces, a: int, b: int) -> Pieces:
    """Pieces a to b - 1."""
    where, starts, vertices, tangents, errors = pieces
    own = vertices[starts[a] : starts[b]]
    return Pieces(where[a:b], starts[a : b + 1] - starts[a], own, tangents[a:b], errors[a:b])


@compiled(internal=True)
def row_of(pieces: Pieces, q: int) -> Row:
    """Piece q's row of ``where``."""
    where = pieces.where
    return where[q, 0], where[q, 1], where[q, 2], where[q, 3], where[q, 4], where[q, 5]


@compiled(internal=True)
def add_pieces(pieces: Pieces, count: int, others: Pieces) -> int:
    """Add pieces after ``count`` others; the number then."""
    for q in range(len(others.where)):
        p = others.vertices[others.starts[q] : others.starts[q + 1]]
        count = add_piece(pieces, count, row_of(others, q), p, others.tangents[q], others.errors[q])
    return count


@compiled(internal=True)
def add_piece(pieces: Pieces, count: int, row: Row, p: FloatArray, tangents: FloatArray, error: float) -> int:
    """Add a piece after ``count`` others: a row of ``where``, its vertices and end tangents; the number then."""
    at, n = pieces.starts[count], max(row[SPANS], 1) + 1 - row[CLOSED]
    for c in range(6):
        pieces.where[count, c] = row[c]
    for r in range(n):
        for axis in range(3):
            pieces.vertices[at + r, axis] = p[r, axis]
    for end in range(2):
        for axis in range(2):
            pieces.tangents[count, end, axis] = tangents[end, axis]
    pieces.errors[count] = error
    pieces.starts[count + 1] = at + n
    return count + 1


@compiled(internal=True)
def reverse_last(pieces: Pieces, count: int, m: int) -> None:
    """Turn the last of ``count`` pieces round, for a contour of m segments that is fitted the other way."""
    q = count - 1
    where, tangents, first, stop = pieces.where[q], pieces.tangents[q], pieces.starts[q], pieces.starts[q + 1]
    where[FIRST], where[LAST] = m - where[LAST], m - where[FIRST]
    lap = float(m) if where[CLOSED] and pieces.vertices[first, 2] > 0.0 else 0.0
    for r in range(first, stop):
        pieces.vertices[r, 2] = m + lap - pieces.vertices[r, 2]
    low, high = first, stop - 1
    if where[CLOSED]:  # the first vertex of a closed curve stays the first
        pieces.vertices[first, 2] -= m
        low += 1
    while low < high:
        for axis in range(3):
            x, y = pieces.vertices[low, axis], pieces.vertices[high, axis]
            pieces.vertices[low, axis], pieces.vertices[high, axis] = y, x
        low, high = low + 1, high - 1
    for axis in range(2):
        x, y = tangents[0, axis], tangents[1, axis]
        tangents[0, axis], tangents[1, axis] = -y, -x


@compiled(internal=True)
def add_source(pieces: Pieces, count: int, row: Row, cubics: FloatArray, degrees: IntArray) -> int:
    """Add the segments of a contour between two joints as they are, as lines and arcs of one span; the number then."""
    p, tangents = np.empty((2, 3)), np.empty((2, 2))
    for s in range(row[FIRST], row[LAST]):
        p[0, 2], p[1, 2] = s, s + 1
        factor = 3 / np.hypot(cubics[s, 3, 0] - cubics[s, 0, 0], cubics[s, 3, 1] - cubics[s, 0, 1])
        for axis in range(2):
            for end in range(2):
                p[end, axis] = cubics[s, 3 * end, axis]
                tangents[end, axis] = (cubics[s, 2 * end + 1, axis] - cubics[s, 2 * end, axis]) * factor
        count = add_piece(pieces, count, (row[CONTOUR], s, s + 1, int(degrees[s] > 1), 0, ONLY), p, tangents, 0.0)
    return count
