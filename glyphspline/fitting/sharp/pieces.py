"""The lines and arcs that contours are cut into, end to end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import numpy as np

from ...compiled import compiled
from ...outlines.contour_arrays import offsets_of
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


PieceArrays: TypeAlias = tuple[
    IntArray, IntArray, IntArray, IntArray, IntArray, FloatArray, FloatArray, FloatArray, FloatArray
]
"""The arrays of pieces, for calls of compiled functions: see :data:`.corners.JointArrays`."""


def part(pieces: Pieces, first: int, end: int) -> Pieces:
    """Pieces ``first`` to ``end``, in the same memory."""
    own, a, b = slice(first, end), int(pieces.starts[first]), int(pieces.starts[end])
    return Pieces(
        pieces.contour[own], pieces.joints[own], pieces.spans[own], pieces.closed[own],
        pieces.starts[first : end + 1] - a, pieces.vertices[a:b], pieces.places[a:b], pieces.tangents[own],
        pieces.errors[own],
    )  # fmt: skip


def joined(parts: Sequence[Pieces], masters: int) -> Pieces:
    """All pieces of several, in K masters."""
    none = source_pieces(0, 0, np.empty((masters, 0, 4, 2)), np.empty(0, dtype=np.int64))
    contour, joints, spans, closed, starts, *others = zip(none, *parts, strict=True)
    lengths = np.concatenate([own[1:] - own[:-1] for own in starts])
    before, after = (map(np.concatenate, columns) for columns in ((contour, joints, spans, closed), others))
    return Pieces._make([*before, offsets_of(lengths), *after])


def source_pieces(c: int, i: int, cubics: FloatArray, degrees: IntArray) -> Pieces:
    """Segments (K, n, 4, 2) of contour c from its joint i on as they are, as lines and arcs of one span."""
    masters, n = cubics.shape[:2]
    squares = np.zeros(n)
    for own in cubics:
        chords = np.hypot(own[:, 3, 0] - own[:, 0, 0], own[:, 3, 1] - own[:, 0, 1])
        squares += chords * chords
    factors = 3 / np.sqrt(np.where(squares > 0.0, squares / masters, 1.0))  # see chords
    ends = i + np.arange(n)[:, None] + np.arange(2)
    return Pieces(
        np.full(n, c), ends, np.minimum(degrees - 1, 1), np.zeros(n, dtype=np.int64), 2 * np.arange(n + 1),
        cubics[:, :, ::3].transpose(1, 2, 0, 3).reshape(2 * n, masters, 2), ends.reshape(-1).astype(np.float64),
        (cubics[:, :, 1::2] - cubics[:, :, ::2]).transpose(1, 0, 2, 3) * factors[:, None, None, None], np.zeros(n),
    )  # fmt: skip


def turned(pieces: Pieces, offsets: IntArray, flipped: BoolArray) -> Pieces:
    """The same pieces with those of flipped contours the other way round, from the last one's end on.

    Args:
        offsets: (C + 1,) where the segments of each contour begin. flipped: (C,).
    """
    return Pieces(*turned_arrays(pieces[:], offsets, flipped))


@compiled
def turned_arrays(pieces: PieceArrays, offsets: IntArray, flipped: BoolArray) -> PieceArrays:
    """The arrays of pieces, turned: see :func:`turned`."""
    old = Pieces(*pieces)
    P, masters = len(old.spans), old.vertices.shape[1]
    order, first = np.arange(P), 0
    for q in range(P):
        c = old.contour[q]
        if q > 0 and old.contour[q - 1] != c:
            first = q
        if flipped[c] and (q + 1 == P or old.contour[q + 1] != c):
            for r in range(first, q + 1):
                order[r] = first + q - r
    joints, tangents, starts = np.empty_like(old.joints), np.empty_like(old.tangents), np.zeros_like(old.starts)
    vertices, places = np.empty_like(old.vertices), np.empty_like(old.places)
    for count in range(P):
        q, at = order[count], starts[count]
        c, a, n, ring = old.contour[q], old.starts[q], old.starts[q + 1] - old.starts[q], old.closed[q]
        m, turns, sign = offsets[c + 1] - offsets[c], flipped[c], -1.0 if flipped[c] else 1.0
        lap = m if ring and old.places[a] > 0.0 else 0
        for end in range(2):
            other = 1 - end if turns else end
            joints[count, end] = m - old.joints[q, other] if turns else old.joints[q, end]
            for v in range(masters):
                for axis in range(2):
                    tangents[count, v, end, axis] = sign * old.tangents[q, v, other, axis]
        for r in range(n):
            s = a + r
            if turns:
                s = a + (n - r if ring else n - 1 - r) % n  # the first vertex of a closed curve stays the first
            places[at + r] = m + lap - old.places[s] if turns else old.places[s]
            for v in range(masters):
                vertices[at + r, v, 0], vertices[at + r, v, 1] = old.vertices[s, v, 0], old.vertices[s, v, 1]
        if turns and ring:
            places[at] -= m
        starts[count + 1] = at + n
    return (
        old.contour, joints, old.spans[order], old.closed[order], starts, vertices, places, tangents, old.errors[order],
    )  # fmt: skip
