"""All contours of a glyph as one array of cubics, each from its canonical start and in its canonical direction."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import bernstein, jet, length_table, turns
from ...outlines.contour_arrays import ContourArrays
from ...outlines.segments import contour_cubics, farthest_joint, is_backward, lasting
from ...types import BoolArray, FloatArray, IntArray

TABLE = 16
"""Steps a segment in the table of lengths. It only decides where vertices fall along the outline."""

WEIGHTS = bernstein(TABLE)


class CanonicalContours(NamedTuple):
    """The contours of a glyph in the direction in which they are fitted: a closed curve is turned back as a whole.

    They begin at the joint farthest out, corner or not: such a curve ends nowhere.

    Attributes:
        cubics: (S, 4, 2) the segments of all contours; offsets: (K + 1,) where each contour begins, and S.
        flipped: (K,) whether a contour is run against its given direction.
        turns: (S,) angle between the tangents at the start of each segment, in radians.
        lengths: (S TABLE + K,) length along each contour, from start to end, at even parameters of each segment.
    """

    cubics: FloatArray
    offsets: IntArray
    flipped: BoolArray
    turns: FloatArray
    lengths: FloatArray


@compiled
def canonical_contours(contours: ContourArrays) -> CanonicalContours:
    """Contours end to end as the smooth mode fits them; segments of no length are left out."""
    count, most = len(contours.offsets) - 1, len(contours.degrees)
    cubics, angles, lengths = np.empty((most, 4, 2)), np.empty(most), np.empty(most * TABLE + count)
    offsets, flipped = np.zeros(count + 1, dtype=np.int64), np.empty(count, dtype=np.bool_)
    for k in range(count):
        given = contour_cubics(contours, k)
        kept = lasting(given)
        at, m = offsets[k], len(kept)
        for j in range(m):
            for c in range(4):
                given[j, c, 0], given[j, c, 1] = given[kept[j], c, 0], given[kept[j], c, 1]
        chain, flipped[k] = given[:m], is_backward(given[:m])
        if flipped[k]:
            chain = chain[::-1, ::-1].copy()
        first = farthest_joint(chain[:, 0])
        own = np.concatenate((chain[first:], chain[:first]))
        offsets[k + 1] = at + m
        cubics[at : at + m], angles[at : at + m] = own, np.abs(turns(own, 0.0))
        table_of(lengths, offsets, k)[:] = length_table(own, WEIGHTS)
    at = offsets[count]
    return CanonicalContours(cubics[:at], offsets, flipped, angles[:at], lengths[: at * TABLE + count])


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
def points_at(cubics: FloatArray, places: FloatArray) -> FloatArray:
    """(n, 2) the points at places of a contour, all in its first lap."""
    points = np.empty((len(places), 2))
    for i in range(len(places)):
        s = int(places[i])
        points[i, 0], points[i, 1], _, _, _, _ = jet(cubics, s, places[i] - s)
    return points
