"""All contours of a glyph as one array of cubics, each begun and run as its shape has it, with lengths along them.

A *place* j + x on a contour is local parameter x of its segment j; places wrap at its number of segments.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arcs import jet, jit
from ..arrays import BoolArray, FloatArray, IntArray
from ..orientation import farthest_joint, flip, runs_backwards

TABLE = 16
"""Steps a segment in the table of lengths. It only decides where vertices fall along the outline."""


class Chains(NamedTuple):
    """The contours of a glyph.

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


def chains_of(parts: list[FloatArray]) -> Chains:
    """Chains of contours given as cubics, (m, 4, 2) each."""
    return Chains(*_canonical(np.concatenate(parts), np.cumsum([0] + [len(part) for part in parts])))


@jit
def _canonical(given: FloatArray, offsets: IntArray) -> tuple[FloatArray, IntArray, BoolArray, FloatArray, FloatArray]:
    """The attributes of :class:`Chains`; segments that are points are left out."""
    count = len(offsets) - 1
    cubics = np.empty_like(given)
    starts = np.zeros(count + 1, dtype=np.int64)
    flipped = np.zeros(count, dtype=np.bool_)
    for k in range(count):
        m = 0
        chain = np.empty_like(given[offsets[k] : offsets[k + 1]])
        for j in range(offsets[k], offsets[k + 1]):
            if (given[j] != given[j, 0]).any():
                chain[m] = given[j]
                m += 1
        chain = chain[:m]
        flipped[k] = runs_backwards(chain)
        if flipped[k]:
            chain = flip(chain)
        first = farthest_joint(chain[:, 0])
        starts[k + 1] = starts[k] + m
        for j in range(m):
            cubics[starts[k] + j] = chain[(first + j) % m]
    cubics = cubics[: starts[count]]
    turns, lengths = np.empty(len(cubics)), np.empty((len(cubics), TABLE + 1))
    for k in range(count):
        part = cubics[starts[k] : starts[k + 1]]
        _turns(part, turns[starts[k] :])
        _lengths(part, lengths[starts[k] :])
    return cubics, starts, flipped, turns, lengths


@jit
def _direction(cubics: FloatArray, j: int, end: int) -> tuple[float, float]:
    """Direction of segment j at its first (0) or last (3) point, whatever handles have no length."""
    step = 1 if end == 0 else -1
    for k in range(end + step, end + 4 * step, step):
        dx, dy = step * (cubics[j, k, 0] - cubics[j, end, 0]), step * (cubics[j, k, 1] - cubics[j, end, 1])
        if dx != 0 or dy != 0:
            return dx, dy
    return 0.0, 0.0


@jit
def _turns(cubics: FloatArray, turns: FloatArray) -> None:
    m = len(cubics)
    for j in range(m):
        ax, ay = _direction(cubics, (j - 1) % m, 3)
        bx, by = _direction(cubics, j, 0)
        turns[j] = abs(np.arctan2(ax * by - ay * bx, ax * bx + ay * by))


@jit
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


@jit
def length_at(lengths: FloatArray, place: float) -> float:
    """Distance along a contour from its first point; ``place`` may be laps ahead."""
    m = len(lengths)
    j = int(np.floor(place))
    x = (place - j) * TABLE
    k = int(x)
    row = lengths[j % m]
    return j // m * lengths[m - 1, TABLE] + row[k] + (x - k) * (row[min(k + 1, TABLE)] - row[k])


@jit
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


@jit
def vertices(cubics: FloatArray, places: FloatArray) -> FloatArray:
    """(n, 2) the points at places of a contour, all in its first lap."""
    points = np.empty((len(places), 2))
    for i in range(len(places)):
        s = int(places[i])
        points[i, 0], points[i, 1], _, _, _, _ = jet(cubics, s, places[i] - s)
    return points
