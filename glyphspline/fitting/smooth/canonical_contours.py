"""All contours of a glyph as one array of cubics, each begun and run as its shape has it, with lengths along them.

A *place* j + x on a contour is local parameter x of its segment j; places wrap at its number of segments.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet
from ...outlines.canonical import directed, direction, farthest_joint, turn
from ...outlines.contour_arrays import ContourArrays
from ...outlines.segments import contour_cubics, lasting
from ...types import BoolArray, FloatArray, IntArray

TABLE = 16
"""Steps a segment in the table of lengths. It only decides where vertices fall along the outline."""


class Chains(NamedTuple):
    """The contours of a glyph, in the direction in which they are fitted: a closed curve is turned back as a whole.

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
def chains_of(flat: ContourArrays) -> Chains:
    """The chains of contours end to end."""
    count = len(flat.offsets) - 1
    cubics = np.empty((len(flat.degrees), 4, 2))
    offsets, flipped = np.zeros(count + 1, dtype=np.int64), np.zeros(count, dtype=np.bool_)
    for k in range(count):
        given = contour_cubics(flat, k)
        chain, flipped[k] = directed(given[lasting(given)])
        m = len(chain)
        first = farthest_joint(chain[:, 0])
        offsets[k + 1] = offsets[k] + m
        for j in range(m):
            cubics[offsets[k] + j] = chain[(first + j) % m]
    cubics = cubics[: offsets[count]]
    turns, lengths = np.empty(len(cubics)), np.empty((len(cubics), TABLE + 1))
    for k in range(count):
        part = cubics[offsets[k] : offsets[k + 1]]
        _turns(part, turns[offsets[k] :])
        _lengths(part, lengths[offsets[k] :])
    return Chains(cubics, offsets, flipped, turns, lengths)


@compiled
def _turns(cubics: FloatArray, turns: FloatArray) -> None:
    """Into ``turns``; at whatever scale, so that no handle is too short."""
    for j in range(len(cubics)):
        ax, ay, _ = direction(cubics[j - 1], True, 0.0)
        bx, by, _ = direction(cubics[j], False, 0.0)
        turns[j] = turn(ax, ay, bx, by)


@compiled
def _lengths(cubics: FloatArray, lengths: FloatArray) -> None:
    total = 0.0
    for j in range(len(cubics)):
        x, y = cubics[j, 0]
        lengths[j, 0] = total
        for k in range(1, TABLE + 1):
            px, py, _, _, _, _ = jet(cubics, j, k / TABLE)
            total += np.sqrt((px - x) ** 2 + (py - y) ** 2)
            lengths[j, k] = total
            x, y = px, py


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
    low, high = 0, m - 1
    while low < high:
        middle = (low + high + 1) // 2
        if lengths[middle, 0] <= d:
            low = middle
        else:
            high = middle - 1
    row = lengths[low]
    k = min(max(int(np.searchsorted(row, d, side="right")) - 1, 0), TABLE - 1)
    step = row[k + 1] - row[k]
    x = (k + (min(max((d - row[k]) / step, 0.0), 1.0) if step > 0 else 0.0)) / TABLE
    return lap * m + low + x


@compiled
def vertices(cubics: FloatArray, places: FloatArray) -> FloatArray:
    """(n, 2) the points at places of a contour, all in its first lap."""
    points = np.empty((len(places), 2))
    for i in range(len(places)):
        s = int(places[i])
        points[i, 0], points[i, 1], _, _, _, _ = jet(cubics, s, places[i] - s)
    return points
