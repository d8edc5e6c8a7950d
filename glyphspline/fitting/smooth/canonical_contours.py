"""All contours of a glyph as one array of cubics, each from its canonical start and in its canonical direction."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import put
from ...compiled import compiled
from ...curves.cubics import bernstein, jet, length_table, turns
from ...outlines.segments import farthest_joint, is_backward, lasting
from ...types import BoolArray, FloatArray, IntArray

TABLE = 16
"""Steps a segment in the table of lengths. It only decides where vertices fall along the outline."""

WEIGHTS = bernstein(TABLE)


class CanonicalContours(NamedTuple):
    """The contours of a glyph in the direction in which they are fitted: a closed curve is turned back as a whole.

    They begin at the joint farthest out, corner or not: such a curve ends nowhere. In K masters a contour is one in
    R^{2K}, where squares of lengths are sums of those in the masters. Direction and first joint are the first master's.

    Attributes:
        cubics: (S K, 4, 2) the segments of all contours, segment j in master v in row j K + v; offsets: (C + 1,) where
            each contour begins, in segments, and S.
        flipped: (C,) whether a contour is run against its given direction.
        turns: (S,) angle between the tangents at the start of each segment, in radians: the largest in any master.
        lengths: (S TABLE + C,) length along each contour, from start to end, at even parameters of each segment.
    """

    cubics: FloatArray
    offsets: IntArray
    flipped: BoolArray
    turns: FloatArray
    lengths: FloatArray


@compiled
def canonical_contours(given: FloatArray, begins: IntArray) -> CanonicalContours:
    """Contours end to end as the smooth mode fits them; segments that have a length in no master are left out.

    Args:
        given: (K, M, 4, 2) their segments in each master. begins: (C + 1,) where each contour begins.
    """
    K, most, count = given.shape[0], given.shape[1], len(begins) - 1
    cubics, angles, lengths = np.empty((most * K, 4, 2)), np.zeros(most), np.empty(most * TABLE + count)
    offsets, flipped = np.zeros(count + 1, dtype=np.int64), np.empty(count, dtype=np.bool_)
    for k in range(count):
        kept, at = lasting(given[:, begins[k] : begins[k + 1]].copy()), offsets[k]
        m = len(kept)
        chain = np.empty((K, m, 4, 2))
        for v in range(K):
            for j in range(m):
                chain[v, j] = given[v, begins[k] + kept[j]]
        flipped[k] = is_backward(chain[0])
        if flipped[k]:
            chain = chain[:, ::-1, ::-1].copy()
        first = farthest_joint(chain[0, :, 0])
        chain = np.concatenate((chain[:, first:], chain[:, :first]), axis=1)
        offsets[k + 1] = at + m
        table = table_of(lengths, offsets, k)
        for v in range(K):
            own = np.abs(turns(chain[v], 0.0))
            for j in range(m):
                put(chain[v, j], cubics[(at + j) * K + v])
                angles[at + j] = max(angles[at + j], own[j])
            own = length_table(chain[v], WEIGHTS)
            if K == 1:
                put(own, table)
            else:
                for i in range(m * TABLE):
                    step = own[i + 1] - own[i]
                    square = step * step
                    table[i + 1] = square if v == 0 else table[i + 1] + square
        if K > 1:
            table[0] = 0.0
            for i in range(m * TABLE):
                table[i + 1] = table[i] + np.sqrt(table[i + 1])
    at = offsets[count]
    return CanonicalContours(cubics[: at * K], offsets, flipped, angles[:at], lengths[: at * TABLE + count])


@compiled
def chain_of(contours: CanonicalContours, k: int) -> FloatArray:
    """(m K, 4, 2) the segments of contour k."""
    K = len(contours.cubics) // len(contours.turns)
    return contours.cubics[contours.offsets[k] * K : contours.offsets[k + 1] * K]


@compiled
def in_master(contours: CanonicalContours, k: int, v: int) -> tuple[FloatArray, float]:
    """(m, 4, 2) the segments of contour k in master v, and its length there."""
    K = len(contours.cubics) // len(contours.turns)
    if K == 1:
        return chain_of(contours, k), table_of(contours.lengths, contours.offsets, k)[-1]
    own = chain_of(contours, k)[v::K].copy()
    return own, length_table(own, WEIGHTS)[-1]


@compiled
def table_of(values: FloatArray, offsets: IntArray, k: int) -> FloatArray:
    """The values of contour k: ``TABLE`` a segment, and one more."""
    return values[offsets[k] * TABLE + k : offsets[k + 1] * TABLE + k + 1]


@compiled
def length_at(lengths: FloatArray, place: float) -> float:
    """Distance along a contour from its first point; ``place`` may be laps ahead."""
    m, j = len(lengths) // TABLE, int(np.floor(place))
    x = (place - j) * TABLE
    i = j % m * TABLE + int(x)
    return j // m * lengths[-1] + lengths[i] + (x - int(x)) * (lengths[i + 1] - lengths[i])


@compiled
def points_at(cubics: FloatArray, K: int, places: FloatArray) -> FloatArray:
    """(n, 2 K) the points at places of a contour in K masters, all in its first lap."""
    points = np.empty((len(places), 2 * K))
    for i in range(len(places)):
        s = int(places[i])
        for v in range(K):
            points[i, 2 * v], points[i, 2 * v + 1], _, _, _, _ = jet(cubics, s * K + v, places[i] - s)
    return points
