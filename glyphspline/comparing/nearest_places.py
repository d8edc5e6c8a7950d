"""The nearest point of a whole outline, compiled: all contours are searched, and none is missed.

A stretch of a cubic over [a, b] is within ``bend (b - a)²`` of its chord at equal parameters, where ``bend`` is 3/4 of
the largest second difference of its Bézier points. So the distance to the chord, less that, bounds the distance to the
stretch from below. Stretches that cannot be nearer than the best point found are left out, and others are halved.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import compiled
from ..curves.cubics import length, nearest
from ..types import FloatArray, IntArray

GROUP = 16
"""Segments in a row that have a common box."""

STACK = 64
"""Stretches of a segment that wait to be searched: one a halving, and no parameter can be halved more often."""

CLOSER = 2e-4
"""Share of its distance by which a place may miss the nearest one."""


class Chains(NamedTuple):
    """The contours of one outline, ready to be searched.

    Attributes:
        cubics: (m, 4, 2) the segments of all contours. offsets: (C + 1,) where contours begin in these.
        owners: (m,) the contour of each segment. bends: (m,) as above.
        boxes: (m, 4) left, bottom, right, top of Bézier points. groups: (g, 4) likewise of ``GROUP`` segments in a row.
    """

    cubics: FloatArray
    offsets: IntArray
    owners: IntArray
    bends: FloatArray
    boxes: FloatArray
    groups: FloatArray


@compiled
def chains_of(cubics: FloatArray, offsets: IntArray) -> Chains:
    """The chains of an outline with segments (m, 4, 2) and offsets (C + 1,), which may begin at any number."""
    m = len(cubics)
    own, owners, bends = offsets - offsets[0], np.empty(m, dtype=np.int64), np.empty(m)
    boxes, groups = np.empty((m, 4)), np.empty(((m + GROUP - 1) // GROUP, 4))
    for c in range(len(own) - 1):
        for s in range(own[c], own[c + 1]):
            owners[s] = c
    for s in range(m):
        b, box, group = cubics[s], boxes[s], groups[s // GROUP]
        for axis in range(2):
            box[axis] = min(min(b[0, axis], b[1, axis]), min(b[2, axis], b[3, axis]))
            box[axis + 2] = max(max(b[0, axis], b[1, axis]), max(b[2, axis], b[3, axis]))
            first = s % GROUP == 0
            group[axis] = box[axis] if first else min(group[axis], box[axis])
            group[axis + 2] = box[axis + 2] if first else max(group[axis + 2], box[axis + 2])
        bends[s] = 0.0
        for k in range(2):
            x = b[k, 0] - 2 * b[k + 1, 0] + b[k + 2, 0]
            y = b[k, 1] - 2 * b[k + 1, 1] + b[k + 2, 1]
            bends[s] = max(bends[s], 0.75 * length(x, y))
    return Chains(cubics, own, owners, bends, boxes, groups)


@compiled
def from_box(box: FloatArray, x: float, y: float) -> float:
    """Distance of a point from a box (4,)."""
    return length(max(max(box[0] - x, x - box[2]), 0.0), max(max(box[1] - y, y - box[3]), 0.0))


@compiled
def reached(cubic: FloatArray, guess: float, x: float, y: float) -> tuple[float, float]:
    """The parameter of a cubic (4, 2) near a guess that is nearest a point, and its distance; never worse than the
    guess."""
    z = nearest(cubic, 0.0, 1.0, guess, x, y)
    px, py = point(cubic, z)
    d = length(px - x, py - y)
    px, py = point(cubic, guess)
    before = length(px - x, py - y)
    return (z, d) if d <= before else (guess, before)


@compiled
def point(cubic: FloatArray, z: float) -> tuple[float, float]:
    """The point of a cubic (4, 2) at a parameter."""
    y = 1.0 - z
    a, b, c, d = y * y * y, 3.0 * y * y * z, 3.0 * y * z * z, z * z * z
    return (
        a * cubic[0, 0] + b * cubic[1, 0] + c * cubic[2, 0] + d * cubic[3, 0],
        a * cubic[0, 1] + b * cubic[1, 1] + c * cubic[2, 1] + d * cubic[3, 1],
    )


@compiled
def neighbour(chains: Chains, s: int, step: int) -> int:
    """The segment after (1) or before (-1) segment s of its contour."""
    c = chains.owners[s]
    first, last = chains.offsets[c], chains.offsets[c + 1]
    s += step
    return first if s == last else last - 1 if s < first else s


@compiled
def nearest_on(
    chains: Chains, s: int, x: float, y: float, best: float, slack: float, places: FloatArray
) -> tuple[float, float]:
    """The parameter of segment s that is nearest a point, and its distance, if less than ``best`` by more than
    ``slack``; or else NaN, and ``best``.

    Args:
        places: (STACK, 2) scratch array.
    """
    cubic, bend = chains.cubics[s], chains.bends[s]
    at = np.nan
    places[0, 0], places[0, 1] = 0.0, 1.0
    top = 0
    while top >= 0:
        a, b = places[top, 0], places[top, 1]
        top -= 1
        ax, ay = point(cubic, a)
        bx, by = point(cubic, b)
        ux, uy = bx - ax, by - ay
        whole = ux * ux + uy * uy
        share = min(max(((x - ax) * ux + (y - ay) * uy) / whole, 0.0), 1.0) if whole > 0.0 else 0.0
        near = length(ax + share * ux - x, ay + share * uy - y)
        off = bend * (b - a) * (b - a)
        allowed = max(slack, CLOSER * best)
        if near - off >= best - allowed:
            continue
        guess = a + share * (b - a)
        if near < best:
            z, d = reached(cubic, guess, x, y)
            if d < best:
                at, best = z, d
        if off > allowed and top + 2 < STACK:
            middle = (a + b) / 2
            near_first = share < 0.5  # searched first, so at the top
            places[top + 1, 0], places[top + 1, 1] = (middle, b) if near_first else (a, middle)
            places[top + 2, 0], places[top + 2, 1] = (a, middle) if near_first else (middle, b)
            top += 2
    return at, best


@compiled
def nearest_of_outline(
    chains: Chains, x: float, y: float, s: int, z: float, slack: float, places: FloatArray
) -> tuple[int, float, float]:
    """The segment and parameter of an outline nearest a point, and its distance.

    No point is nearer by more than ``slack`` or a share ``CLOSER``, whichever is larger.

    Args:
        s, z: where to begin. Where several places are as near, as far as that matters, the one near there is taken.
        places: (STACK, 2) scratch array.
    """
    at, best = reached(chains.cubics[s], z, x, y)
    segment = s
    for step in range(-1, 2, 2):
        other = neighbour(chains, s, step)
        if other != s and from_box(chains.boxes[other], x, y) < best:
            guess, d = reached(chains.cubics[other], 0.0 if step > 0 else 1.0, x, y)
            if d < best:
                segment, at, best = other, guess, d
    for g in range(len(chains.groups)):
        if best <= slack:
            break
        if from_box(chains.groups[g], x, y) >= best - max(slack, CLOSER * best):
            continue
        for k in range(GROUP * g, min(GROUP * (g + 1), len(chains.cubics))):
            if from_box(chains.boxes[k], x, y) < best - max(slack, CLOSER * best):
                guess, d = nearest_on(chains, k, x, y, best, slack, places)
                if d < best:
                    segment, at, best = k, guess, d
    at, best = reached(chains.cubics[segment], at, x, y)  # where the guess was poor, Newton's steps were too few
    return segment, at, best
