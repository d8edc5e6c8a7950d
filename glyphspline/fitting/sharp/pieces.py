"""The lines and arcs that contours are cut into, end to end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...outlines.contour_arrays import members_of, offsets_of
from ...types import BoolArray, FloatArray, IntArray


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


class Piece(NamedTuple):
    """A piece by itself, as it is fitted, with ``vertices`` (n, K, 2), ``places`` (n,) and ``tangents`` (K, 2, 2)."""

    contour: int
    joints: tuple[int, int]
    spans: int
    closed: int
    vertices: FloatArray
    places: FloatArray
    tangents: FloatArray
    error: float


def piece_of(pieces: Pieces, q: int) -> Piece:
    """Piece q, in the same memory."""
    (i, j), own = pieces.joints[q].tolist(), slice(int(pieces.starts[q]), int(pieces.starts[q + 1]))
    return Piece(
        int(pieces.contour[q]), (i, j), int(pieces.spans[q]), int(pieces.closed[q]), pieces.vertices[own],
        pieces.places[own], pieces.tangents[q], float(pieces.errors[q]),
    )  # fmt: skip


def end_to_end(pieces: Sequence[Piece]) -> Pieces:
    """Pieces, one or more, as arrays."""
    contour, joints, spans, closed, vertices, places, tangents, errors = zip(*pieces, strict=True)
    return Pieces(
        np.array(contour), np.array(joints), np.array(spans), np.array(closed), offsets_of([*map(len, places)]),
        np.concatenate(vertices), np.concatenate(places), np.array(tangents), np.array(errors),
    )  # fmt: skip


def chord_lengths(chords: FloatArray) -> FloatArray:
    """(n,) lengths of chords (n, K, 2), the root mean square of those in the masters; 1 for one without length.

    A segment of the source may end where it begins.
    """
    squares: FloatArray = (np.hypot(chords[..., 0], chords[..., 1]) ** 2).mean(axis=1)
    return np.sqrt(np.where(squares > 0.0, squares, 1.0))


def joined(pieces: Pieces, others: Pieces) -> Pieces:
    """Two groups of pieces as one."""
    columns = [np.concatenate(each) for each in zip(pieces, others, strict=True)]
    columns[4] = np.append(pieces.starts, others.starts[1:] + pieces.starts[-1])
    return Pieces._make(columns)


def in_order(pieces: Pieces, which: IntArray) -> tuple[Pieces, IntArray]:
    """The chosen pieces contour after contour, each from its first joint on; and which of the given ones each is."""
    order = which[np.lexsort((pieces.joints[which, 0], pieces.contour[which]))]
    own, starts = members_of(pieces.starts, order)
    return Pieces(
        pieces.contour[order], pieces.joints[order], pieces.spans[order], pieces.closed[order], starts,
        pieces.vertices[own], pieces.places[own], pieces.tangents[order], pieces.errors[order],
    ), order  # fmt: skip


def turned(pieces: Pieces, offsets: IntArray, flipped: BoolArray) -> Pieces:
    """The same pieces, those of flipped contours the other way round.

    Args:
        offsets: (C + 1,) where the segments of each contour begin. flipped: (C,).
    """
    turns, size = flipped[pieces.contour], np.diff(offsets)[pieces.contour]
    if not turns.any():
        return pieces
    first, counts, ring = pieces.starts[:-1], np.diff(pieces.starts), pieces.closed > 0
    whose = np.repeat(np.arange(len(first)), counts)
    row, back = np.arange(len(whose)) - first[whose], turns[whose]
    other = (counts - 1 + pieces.closed)[whose] - row  # the first vertex of a closed curve stays the first
    own = first[whose] + np.where(back, other % counts[whose], row)
    lap = size * (1 + (ring & (pieces.places[first] > 0.0)))
    places = np.where(back, lap[whose] - pieces.places[own], pieces.places[own])
    places[first[turns & ring]] -= size[turns & ring]
    joints = np.where(turns[:, None], size[:, None] - pieces.joints[:, ::-1], pieces.joints)
    tangents = np.where(turns[:, None, None, None], -pieces.tangents[:, :, ::-1], pieces.tangents)
    return pieces._replace(joints=joints, vertices=pieces.vertices[own], places=places, tangents=tangents)
