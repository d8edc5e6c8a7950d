"""A certified bound of the two-sided (Hausdorff) distance of two outlines.

The bound is for the outlines as sets of points: no point of either is farther from the other than that. Contours need
not correspond. Every segment of one outline is cut into sections, each bounded by pairing it with a section
of the other (:mod:`..curves.pairing`): the one between the points nearest to its ends, or, where these are on different
segments, with the stretch between them cut at the joints, or with a section of either segment by itself. Any pairing
gives a bound, so the least of these is taken.

Points whose nearest point is known give the distance *seen*, from below: ends of segments first, then middles of
sections that are halved. The section with the largest bound is halved first. A section is done when its bound exceeds
the largest distance seen by no more than is asked. While nothing is seen beyond the tolerance, it is not done before
its bound is within: so the distance is refined until the tolerance divides the seen from the certified no more.

The nearest point is sought on all contours, and none is missed. A stretch of a cubic over [a, b] is within
``bend (b - a)²`` of its chord at equal parameters, where ``bend`` is 3/4 of the largest second difference of its Bézier
points. So the distance to the chord, less that, bounds the distance to the stretch from below. Stretches that cannot be
nearer than the best point found are left out, and others are halved.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import ascending
from ..compiled import compiled, inlined
from ..curves.cubics import extent, jet, length, nearest, section
from ..curves.pairing import ROUNDING, apart
from ..types import FloatArray, IntArray
from .contour_arrays import ContourArrays
from .segments import all_cubics

EVEN = 1e-6
"""Share of the tolerance by which a distance may exceed it and still be equal: contours moved by just the tolerance are
within it, whatever rounding adds to the bound."""

SHARP, SLACK = 0.01, 0.01
"""The bound exceeds the distance seen by no more than this share of it, or this many thousandths of an em. Share of
this sharpness by which points are not nearer than the nearest ones found."""

DEEPEST, MOST_HALVINGS = 40, 20_000
"""Halvings of a segment, after which a section's bound counts as it is. Halvings of a glyph's sections, after which
bounds count as they are: hostile outlines would take minutes."""

GROUP = 16
"""Segments in a row that have a common box."""

STACK = 64
"""Stretches of a segment that wait to be searched: one a halving, and no parameter can be halved more often."""

CLOSER = 2e-4
"""Share of its distance by which a place may miss the nearest one, but where the distance seen comes from it."""

Miss = tuple[float, float]
"""By how much a place may miss the nearest one: a length, and a share of its distance. The larger one counts."""

Place = tuple[int, float]
"""A segment, and a parameter on it."""

COLUMNS = 8
BOUND, SEEN, X, Y, SIDE, CONTOUR, NEAR_X, NEAR_Y = range(COLUMNS)
"""Columns of distances: certified bound; certified distance of a point, as rounding leaves it; the point, of outline
SIDE (0 old, 1 new), its contour, and the nearest point of the other outline. Nothing seen: SIDE is -1."""


class Searched(NamedTuple):
    """The contours of one outline, ready to be searched.

    Attributes:
        cubics: (m, 4, 2) the segments of all contours. offsets: (C + 1,) where contours begin in these.
        owners: (m,) the contour of each segment, and beside: (m, 2) the segments before and after it there.
        bends: (m,) as above.
        boxes: (m, 4) left, bottom, right, top of Bézier points. groups: (g, 4) likewise of ``GROUP`` segments in a row.
    """

    cubics: FloatArray
    offsets: IntArray
    owners: IntArray
    beside: IntArray
    bends: FloatArray
    boxes: FloatArray
    groups: FloatArray


def chains_of(contours: ContourArrays) -> Searched:
    """The chains of an outline that is not empty."""
    cubics, offsets = all_cubics(contours), contours.offsets
    boxes = np.concatenate([cubics.min(axis=1), cubics.max(axis=1)], axis=1)
    starts = np.arange(0, len(cubics), GROUP)
    low, high = np.minimum.reduceat(boxes[:, :2], starts), np.maximum.reduceat(boxes[:, 2:], starts)
    seconds = cubics[:, :2] - 2 * cubics[:, 1:3] + cubics[:, 2:]
    bends = 0.75 * np.sqrt((seconds * seconds).sum(axis=2)).max(axis=1)
    owners = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    at, beside = np.arange(len(cubics)), np.empty((len(cubics), 2), dtype=np.int64)
    first, last = offsets[owners], offsets[owners + 1] - 1
    beside[:, 0], beside[:, 1] = np.where(at == first, last, at - 1), np.where(at == last, first, at + 1)
    return Searched(cubics, offsets, owners, beside, bends, boxes, np.concatenate([low, high], axis=1))


@inlined
def from_box(box: FloatArray, x: float, y: float) -> float:
    """Distance of a point from a box (4,)."""
    return length(max(max(box[0] - x, x - box[2]), 0.0), max(max(box[1] - y, y - box[3]), 0.0))


@compiled
def reached(cubics: FloatArray, s: int, guess: float, x: float, y: float) -> tuple[float, float]:
    """The parameter of segment s near a guess that is nearest a point, and its distance; never worse than the guess."""
    z = nearest(cubics[s], 0.0, 1.0, guess, x, y)
    px, py, _, _, _, _ = jet(cubics, s, z)
    d = length(px - x, py - y)
    px, py, _, _, _, _ = jet(cubics, s, guess)
    before = length(px - x, py - y)
    return (z, d) if d <= before else (guess, before)


@compiled
def nearest_on(
    chains: Searched, s: int, x: float, y: float, best: float, miss: Miss, places: FloatArray
) -> tuple[float, float]:
    """The parameter of segment s that is nearest a point, and its distance, if it is less than ``best`` by more than it
    may be missed; or else NaN, and ``best``.

    Args:
        places: (STACK, 2) scratch array.
    """
    slack, closer = miss
    cubics, bend, at = chains.cubics, chains.bends[s], np.nan
    places[0, 0], places[0, 1] = 0.0, 1.0
    top = 0
    while top >= 0:
        a, b = places[top, 0], places[top, 1]
        top -= 1
        ax, ay, _, _, _, _ = jet(cubics, s, a)
        bx, by, _, _, _, _ = jet(cubics, s, b)
        ux, uy = bx - ax, by - ay
        whole = ux * ux + uy * uy
        share = min(max(((x - ax) * ux + (y - ay) * uy) / whole, 0.0), 1.0) if whole > 0.0 else 0.0
        near = length(ax + share * ux - x, ay + share * uy - y)
        off = bend * (b - a) * (b - a)
        allowed = max(slack, closer * best)
        if near - off >= best - allowed:
            continue
        guess = a + share * (b - a)
        if near < best:
            z, d = reached(cubics, s, guess, x, y)
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
    chains: Searched, x: float, y: float, s: int, z: float, miss: Miss, places: FloatArray
) -> tuple[int, float, float]:
    """The segment and parameter of an outline nearest a point, and its distance.

    Args:
        s, z: where to begin. Where several places are as near, as far as that matters, the one near there is taken.
        miss: no point is nearer by more. places: (STACK, 2) scratch array.
    """
    slack, closer = miss
    at, best = reached(chains.cubics, s, z, x, y)
    segment = s
    for after in range(2):
        other = chains.beside[s, after]
        if other != s and from_box(chains.boxes[other], x, y) < best:
            guess, d = reached(chains.cubics, other, 1.0 - after, x, y)
            if d < best:
                segment, at, best = other, guess, d
    for g in range(len(chains.groups)):
        if best <= slack:
            break
        if from_box(chains.groups[g], x, y) >= best - max(slack, closer * best):
            continue
        for k in range(GROUP * g, min(GROUP * (g + 1), len(chains.cubics))):
            if from_box(chains.boxes[k], x, y) < best - max(slack, closer * best):
                guess, d = nearest_on(chains, k, x, y, best, miss, places)
                if d < best:
                    segment, at, best = k, guess, d
    at, best = reached(chains.cubics, segment, at, x, y)  # where the guess was poor, Newton's steps were too few
    return segment, at, best


def outline_distance(old: Searched, new: Searched, unit: float, tolerance: float) -> tuple[FloatArray, FloatArray]:
    """The distance of two outlines, (COLUMNS,); and what :func:`distance` gives.

    Args:
        unit: a thousandth of the em. tolerance: which the bound is to be below, or the distance seen above.
    """
    row = np.zeros(COLUMNS)
    row[SIDE] = row[CONTOUR] = -1
    return row, distance(old, new, SHARP * unit, tolerance, row)


@compiled
def look(
    chains: Searched, x: float, y: float, s: int, z: float, misses: tuple[Miss, Miss], places: FloatArray,
    row: FloatArray,
) -> tuple[int, float, bool]:  # fmt: skip
    """The segment and parameter of an outline nearest a point, and whether that is farther than all that was seen:
    it is in the row then.

    Args:
        s, z, places: see :func:`nearest_of_outline`.
        misses: by how much the nearest place may be missed, and by how much where it is farther than all before.
    """
    s, z, d = nearest_of_outline(chains, x, y, s, z, misses[0], places)
    if d > row[SEEN]:
        s, z, d = nearest_of_outline(chains, x, y, s, z, misses[1], places)
    if d <= row[SEEN]:
        return s, z, False
    row[SEEN], row[X], row[Y] = d, x, y
    row[NEAR_X], row[NEAR_Y], _, _, _, _ = jet(chains.cubics, s, z)
    return s, z, True


@inlined
def enough(seen: float, least: float, tolerance: float) -> float:
    """The bound up to which a section is not halved: within the tolerance, or even with it, while nothing is beyond."""
    limit, even = seen + max(least, SHARP * seen), tolerance * (1.0 + EVEN)
    return limit if seen > even else min(limit, min(even, max(tolerance, seen * (1.0 + EVEN))))


@compiled
def distance(old: Searched, new: Searched, least: float, tolerance: float, row: FloatArray) -> FloatArray:
    """The distance of two outlines, into a row of COLUMNS that are 0.

    Args:
        least: the bound need not exceed the distance seen by less than this, but where the tolerance is between them.

    Returns:
        (m + n, 4) segments of the other outline, and parameters on them, nearest to both ends of each segment: of the m
        old ones, then of the n new ones.
    """
    places, sections, marks = np.empty((STACK, 2)), np.empty((2, 1, 4, 2)), np.empty((DEEPEST + 2, 7))
    m, n = len(old.cubics), len(new.cubics)
    bounds, ends = np.empty(m + n), np.empty((m + n, 4))
    rounding = ROUNDING * max(extent(old.cubics), extent(new.cubics))
    misses, tolerance = ((SLACK * least, CLOSER), (rounding, 0.0)), tolerance - rounding
    for side in range(2):
        one, other, first = (old, new, 0) if side == 0 else (new, old, m)
        s, z = 0, 0.5
        for c in range(len(one.offsets) - 1):
            start = one.offsets[c]
            for i in range(start, one.offsets[c + 1]):
                s, z, farther = look(other, one.cubics[i, 0, 0], one.cubics[i, 0, 1], s, z, misses, places, row)
                ends[first + i, 0], ends[first + i, 1] = s, z
                if farther:
                    row[SIDE], row[CONTOUR] = side, c
            last = one.offsets[c + 1] - 1
            for i in range(start, last + 1):
                j = i + 1 if i < last else start
                ends[first + i, 2], ends[first + i, 3] = ends[first + j, 0], ends[first + j, 1]
        limit = enough(row[SEEN], least, tolerance)
        for i in range(len(one.cubics)):
            e = ends[first + i]
            bounds[first + i] = section_bound(
                one.cubics, i, 0.0, 1.0, other, (int(e[0]), e[1]), (int(e[2]), e[3]), limit, sections
            )
    halvings, bound = 0, 0.0
    order = ascending(-bounds)
    for k in range(m + n):
        at = order[k]
        if bounds[at] <= enough(row[SEEN], least, tolerance):
            bound = max(bound, bounds[at])
            break
        side = 0 if at < m else 1
        one, other, i = (old, new, at) if side == 0 else (new, old, at - m)
        marks[0, 0], marks[0, 1], marks[0, 6] = 0.0, 1.0, bounds[at]
        for q in range(4):
            marks[0, 2 + q] = ends[at, q]
        top = 0
        while top >= 0:
            low, high, own = marks[top, 0], marks[top, 1], marks[top, 6]
            if own <= max(bound, enough(row[SEEN], least, tolerance)) or top >= DEEPEST or halvings >= MOST_HALVINGS:
                bound = max(bound, own)
                top -= 1
                continue
            halvings += 1
            middle = (low + high) / 2
            x, y, _, _, _, _ = jet(one.cubics, i, middle)
            begin, end = (int(marks[top, 2]), marks[top, 3]), (int(marks[top, 4]), marks[top, 5])
            s, z, farther = look(other, x, y, begin[0], begin[1], misses, places, row)
            if farther:
                row[SIDE], row[CONTOUR] = side, one.owners[i]
            limit = max(bound, enough(row[SEEN], least, tolerance))
            marks[top, 1], marks[top, 4], marks[top, 5] = middle, s, z
            marks[top, 6] = section_bound(one.cubics, i, low, middle, other, begin, (s, z), limit, sections)
            top += 1
            marks[top, 0], marks[top, 1], marks[top, 2], marks[top, 3] = middle, high, s, z
            marks[top, 4], marks[top, 5] = end
            marks[top, 6] = section_bound(one.cubics, i, middle, high, other, (s, z), end, limit, sections)
    row[BOUND], row[SEEN] = max(bound, row[SEEN]) + rounding, max(row[SEEN] - rounding, 0.0)
    return ends


@compiled
def section_bound(
    cubics: FloatArray, i: int, low: float, high: float, other: Searched, begin: Place, end: Place, limit: float,
    sections: FloatArray,
) -> float:  # fmt: skip
    """Bound of the distance of the points of a section of a segment from an outline.

    Args:
        cubics: (m, 4, 2), of which number i between parameters ``low`` and ``high``.
        begin, end: places of the outline nearest to the section's ends.
        limit: bounds up to this are small enough: no smaller one is sought.
        sections: (2, 1, 4, 2) scratch array.
    """
    (s0, z0), (s1, z1) = begin, end
    cubic, best, n = cubics[i], np.inf, other.offsets[other.owners[s0] + 1] - other.offsets[other.owners[s0]]
    ahead = (s1 - s0) % n
    after, joints = (1, ahead) if 2 * ahead <= n else (0, n - ahead)
    if n == 2 and 2.0 * z0 < 1.0:  # both ways have one joint: that of the nearer end
        after = 0
    # Segments up to which a stretch is paired with one section.
    if other.owners[s0] == other.owners[s1] and joints < 8:
        best, x, s, z = 0.0, low, s0, z0
        for k in range(joints + 1):
            segment, stop, cut = other.cubics[s], z1, high
            if k < joints:
                stop = float(after)
                px, py, _, _, _, _ = jet(other.cubics, s, stop)
                cut = nearest(cubic, x, high, x + (high - x) / (joints + 1 - k), px, py)
            best = max(best, paired(cubic, x, cut, segment, z, stop, sections))
            if best > limit and k < joints:
                best = np.inf
                break
            x, z, s = cut, 1.0 - stop, other.beside[s, after]
    if best > limit:
        x, y, _, _, _, _ = jet(cubics, i, high)
        z = nearest(other.cubics[s0], 0.0, 1.0, z0, x, y)
        best = min(best, paired(cubic, low, high, other.cubics[s0], z0, z, sections))
        if s0 != s1 and best > limit:
            x, y, _, _, _, _ = jet(cubics, i, low)
            z = nearest(other.cubics[s1], 0.0, 1.0, z1, x, y)
            best = min(best, paired(cubic, low, high, other.cubics[s1], z, z1, sections))
    return best


@compiled
def paired(
    cubic: FloatArray, low: float, high: float, other: FloatArray, z0: float, z1: float, sections: FloatArray
) -> float:
    """Bound of the distance of a section of a cubic from the section of another between two parameters, either of which
    may be the larger one."""
    section(cubic, low, high, sections[0, 0])
    section(other, z0, z1, sections[1, 0])
    most = 0.0
    for k in range(4):
        most = max(most, apart(sections[0, 0], sections[1, 0], k))
    return most
