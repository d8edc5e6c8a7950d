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
        lengths: (S, TABLE + 1) length along the contour, from its start, at even parameters of each segment.
    """

    cubics: FloatArray
    offsets: IntArray
    flipped: BoolArray
    turns: FloatArray
    lengths: FloatArray


@compiled
def canonical_contours(contours: ContourArrays) -> CanonicalContours:
    """Contours end to end as the smooth mode fits them; segments of no length are left out."""
    count = len(contours.offsets) - 1
    most = len(contours.degrees)
    cubics, angles, lengths = np.empty((most, 4, 2)), np.empty(most), np.empty((most, TABLE + 1))
    offsets, flipped = np.empty(count + 1, dtype=np.int64), np.empty(count, dtype=np.bool_)
    at = offsets[0] = 0
    for k in range(count):
        given = contour_cubics(contours, k)
        kept = lasting(given)
        m = len(kept)
        for j in range(m):
            for c in range(4):
                given[j, c, 0], given[j, c, 1] = given[kept[j], c, 0], given[kept[j], c, 1]
        chain, flipped[k] = given[:m], is_backward(given[:m])
        if flipped[k]:
            chain = chain[::-1, ::-1].copy()
        first = farthest_joint(chain[:, 0])
        own = np.concatenate((chain[first:], chain[:first]))
        cubics[at : at + m] = own
        turned, table = turns(own, 0.0), length_table(own, WEIGHTS)
        for j in range(m):
            angles[at + j] = abs(turned[j])
            for c in range(TABLE + 1):
                lengths[at + j, c] = table[j * TABLE + c]
        at += m
        offsets[k + 1] = at
    return CanonicalContours(cubics[:at], offsets, flipped, angles[:at], lengths[:at])


@compiled
def length_at(lengths: FloatArray, place: float) -> float:
    """Distance along a contour from its first point; ``place`` may be laps ahead."""
    m = len(lengths)
    j = int(np.floor(place))
    x = (place - j) * TABLE
    k = int(x)
    row = lengths[j % m]
    return j // m * lengths[m - 1, TABLE] + row[k] + (x - k) * (row[min(k + 1, TABLE)] - row[k])


@compiled
def place_at(lengths: FloatArray, distance: float) -> float:
    """The inverse of :func:`length_at`."""
    m = len(lengths)
    total = lengths[m - 1, TABLE]
    lap = np.floor(distance / total)
    d = distance - lap * total
    low, high = 0, m * TABLE - 1
    while low < high:  # the last of all entries that are not beyond d, but for the very last
        middle = (low + high + 1) // 2
        if lengths[middle // TABLE, middle % TABLE] <= d:
            low = middle
        else:
            high = middle - 1
    j, k = low // TABLE, low % TABLE
    step = lengths[j, k + 1] - lengths[j, k]
    x = (k + (min(max((d - lengths[j, k]) / step, 0.0), 1.0) if step > 0 else 0.0)) / TABLE
    return lap * m + j + x


@compiled
def points_at(cubics: FloatArray, places: FloatArray) -> FloatArray:
    """(n, 2) the points at places of a contour, all in its first lap."""
    points = np.empty((len(places), 2))
    for i in range(len(places)):
        s = int(places[i])
        points[i, 0], points[i, 1], _, _, _, _ = jet(cubics, s, places[i] - s)
    return points
