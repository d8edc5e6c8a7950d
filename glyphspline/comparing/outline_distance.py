"""A certified bound of the two-sided (Hausdorff) distance of two outlines, compiled.

The bound is for the outlines as sets of points: no point of either is farther from the other than that. Contours need
not correspond. Every segment of one outline is cut into sections, each of which is bounded by pairing it with a section
of the other (:mod:`..curves.paired`): the one between the points nearest to its ends, or, where these are on different
segments, with the stretch between them cut at the joints, or with a section of either segment by itself. Any pairing
gives a bound, so the least of these is taken.

Points whose nearest point is known give the distance *seen*, from below: ends of segments first, then middles of
sections that are halved. The section with the largest bound is halved first. A section is done when its bound exceeds
the largest distance seen by no more than is asked.
"""

from __future__ import annotations

import numpy as np

from ..compiled import compiled
from ..curves.cubics import extent, nearest, section
from ..curves.paired import ROUNDING, points_apart
from ..types import BoolArray, FloatArray, IntArray
from .nearest_places import STACK, Chains, chains_of, nearest_of_outline, neighbour, point

SHARP = 0.01
"""The bound exceeds the distance seen by no more than this share of it, or this many thousandths of an em."""

SLACK = 0.01
"""Share of this sharpness by which points are not nearer than the nearest ones found."""

LONGEST = 8
"""Segments up to which a stretch is paired with one section."""

DEEPEST = 40
"""Halvings of a segment, after which a section's bound counts as it is."""

MOST_HALVINGS = 20_000
"""Halvings of a glyph's sections, after which bounds count as they are: hostile outlines would take minutes."""

COLUMNS = 8
BOUND, SEEN, X, Y, SIDE, CONTOUR, NEAR_X, NEAR_Y = range(COLUMNS)
"""Columns of distances: certified bound; largest distance seen; the point where, of outline SIDE (0 old, 1 new), its
contour, and the nearest point of the other outline. Nothing seen: SIDE is -1."""

DIRECTIONS = 16
"""Directions in which contours are measured to pair them."""


@compiled
def equal_glyphs(
    old_points: FloatArray, old_degrees: IntArray, old_offsets: IntArray, old_glyphs: IntArray,
    new_points: FloatArray, new_degrees: IntArray, new_offsets: IntArray, new_glyphs: IntArray,
) -> BoolArray:  # fmt: skip
    """(G,) whether the contours of glyphs are the same numbers in the same order.

    Args:
        old_points, old_degrees, old_offsets: of all glyphs' contours end to end, as in :class:`ContourArrays`.
        old_glyphs: (G + 1,) where the contours of each glyph begin. The rest likewise.
    """
    count = len(old_glyphs) - 1
    equal = np.ones(count, dtype=np.bool_)
    p = q = 0
    for g in range(count):
        a, b, c, d = old_glyphs[g], old_glyphs[g + 1], new_glyphs[g], new_glyphs[g + 1]
        i, j, m, n = old_offsets[a], old_offsets[b], new_offsets[c], new_offsets[d]
        mine = its = 0
        for s in range(i, j):
            mine += old_degrees[s]
        for s in range(m, n):
            its += new_degrees[s]
        same = b - a == d - c and j - i == n - m and mine == its
        if same:
            for s in range(b - a + 1):
                same = same and old_offsets[a + s] - i == new_offsets[c + s] - m
            for s in range(j - i):
                same = same and old_degrees[i + s] == new_degrees[m + s]
            for s in range(mine):
                same = (
                    same
                    and old_points[p + s, 0] == new_points[q + s, 0]
                    and old_points[p + s, 1] == new_points[q + s, 1]
                )
        equal[g] = same
        p, q = p + mine, q + its
    return equal


@compiled
def outline_distances(
    old: FloatArray, old_offsets: IntArray, old_glyphs: IntArray, new: FloatArray, new_offsets: IntArray,
    new_glyphs: IntArray, units: FloatArray,
) -> FloatArray:  # fmt: skip
    """(G, COLUMNS) the distances of glyphs' outlines.

    Args:
        old: (m, 4, 2) segments of all glyphs. old_offsets: (C + 1,) where contours begin. old_glyphs: (G + 1,) where
            the contours of each glyph begin. new, new_offsets, new_glyphs: likewise.
        units: (G,) thousandths of the em.
    """
    count = len(old_glyphs) - 1
    found = np.zeros((count, COLUMNS))
    for g in range(count):
        a, b = old_glyphs[g], old_glyphs[g + 1]
        one = old[old_offsets[a] : old_offsets[b]]
        c, d = new_glyphs[g], new_glyphs[g + 1]
        other = new[new_offsets[c] : new_offsets[d]]
        row = found[g]
        row[SIDE] = row[CONTOUR] = -1
        if len(one) > 0 and len(other) > 0:
            distance(
                chains_of(one, old_offsets[a : b + 1]), chains_of(other, new_offsets[c : d + 1]), SHARP * units[g], row
            )
        elif len(one) > 0 or len(other) > 0:
            row[BOUND] = row[SEEN] = np.inf
    return found


@compiled
def distance(old: Chains, new: Chains, least: float, row: FloatArray) -> None:
    """The distance of two outlines, into a row of COLUMNS; see :func:`outline_distances`."""
    places, sections, marks = np.empty((STACK, 2)), np.empty((2, 4, 2)), np.empty((DEEPEST + 2, 7))
    m, n = len(old.cubics), len(new.cubics)
    # Of every segment: the bound; and the segment of the other outline, and parameter on it, nearest to both its ends.
    bounds, ends = np.empty(m + n), np.empty((m + n, 4))
    slack = SLACK * least
    for side in range(2):
        one, other, first = (old, new, 0) if side == 0 else (new, old, m)
        s, z = 0, 0.5
        for c in range(len(one.offsets) - 1):
            start = one.offsets[c]
            for i in range(start, one.offsets[c + 1]):
                x, y = one.cubics[i, 0, 0], one.cubics[i, 0, 1]
                s, z, d = nearest_of_outline(other, x, y, s, z, slack, places)
                ends[first + i, 0], ends[first + i, 1] = s, z
                if d > row[SEEN]:
                    note(row, d, x, y, side, c, other, s, z)
            last = one.offsets[c + 1] - 1
            for i in range(start, last + 1):
                j = i + 1 if i < last else start
                ends[first + i, 2], ends[first + i, 3] = ends[first + j, 0], ends[first + j, 1]
        limit = row[SEEN] + max(least, SHARP * row[SEEN])
        for i in range(len(one.cubics)):
            e = ends[first + i]
            bounds[first + i] = section_bound(
                one.cubics[i], 0.0, 1.0, other, int(e[0]), e[1], int(e[2]), e[3], limit, sections
            )
    halvings, bound = 0, 0.0
    order = np.argsort(-bounds)
    for k in range(m + n):
        at = order[k]
        if bounds[at] <= row[SEEN] + max(least, SHARP * row[SEEN]):
            bound = max(bound, bounds[at])
            break
        side = 0 if at < m else 1
        one, other, i = (old, new, at) if side == 0 else (new, old, at - m)
        cubic = one.cubics[i]
        marks[0, 0], marks[0, 1], marks[0, 6] = 0.0, 1.0, bounds[at]
        for q in range(4):
            marks[0, 2 + q] = ends[at, q]
        top = 0
        while top >= 0:
            limit = max(bound, row[SEEN] + max(least, SHARP * row[SEEN]))
            low, high, own = marks[top, 0], marks[top, 1], marks[top, 6]
            if own <= limit or top >= DEEPEST or halvings >= MOST_HALVINGS:
                bound = max(bound, own)
                top -= 1
                continue
            halvings += 1
            middle = (low + high) / 2
            x, y = point(cubic, middle)
            s0, z0, s1, z1 = int(marks[top, 2]), marks[top, 3], int(marks[top, 4]), marks[top, 5]
            s, z, d = nearest_of_outline(other, x, y, s0, z0, slack, places)
            if d > row[SEEN]:
                note(row, d, x, y, side, one.owners[i], other, s, z)
                limit = max(bound, d + max(least, SHARP * d))
            marks[top, 1], marks[top, 4], marks[top, 5] = middle, s, z
            marks[top, 6] = section_bound(cubic, low, middle, other, s0, z0, s, z, limit, sections)
            top += 1
            marks[top, 0], marks[top, 1], marks[top, 2], marks[top, 3] = middle, high, s, z
            marks[top, 4], marks[top, 5] = s1, z1
            marks[top, 6] = section_bound(cubic, middle, high, other, s, z, s1, z1, limit, sections)
    row[BOUND] = max(bound, row[SEEN]) + ROUNDING * max(extent(old.cubics), extent(new.cubics))


@compiled
def note(
    row: FloatArray, d: float, x: float, y: float, side: int, contour: int, other: Chains, s: int, z: float
) -> None:
    """Keep a point that is farther from the other outline than those before."""
    row[SEEN], row[X], row[Y], row[SIDE], row[CONTOUR] = d, x, y, side, contour
    row[NEAR_X], row[NEAR_Y] = point(other.cubics[s], z)


@compiled
def section_bound(
    cubic: FloatArray, low: float, high: float, other: Chains, s0: int, z0: float, s1: int, z1: float, limit: float,
    sections: FloatArray,
) -> float:  # fmt: skip
    """Bound of the distance of the points of a section of a cubic from an outline.

    Args:
        cubic: (4, 2), between parameters ``low`` and ``high``.
        s0, z0, s1, z1: segments of the outline, and parameters, nearest to the section's ends.
        limit: bounds up to this are small enough: no smaller one is sought.
        sections: (2, 4, 2) scratch array.
    """
    best = np.inf
    if s0 == s1:
        best = paired(cubic, low, high, other.cubics[s0], z0, z1, sections)
    elif other.owners[s0] == other.owners[s1]:
        c = other.owners[s0]
        n = other.offsets[c + 1] - other.offsets[c]
        ahead = (s1 - s0) % n
        step, joints = (1, ahead) if 2 * ahead <= n else (-1, n - ahead)
        if n == 2 and 2.0 * z0 < 1.0:  # both ways have one joint: that of the nearer end
            step = -1
        if joints < LONGEST:
            best = stretch_bound(cubic, low, high, other, s0, z0, z1, step, joints, limit, sections)
    if best > limit:
        x, y = point(cubic, high)
        z = nearest(other.cubics[s0], 0.0, 1.0, z0, x, y)
        best = min(best, paired(cubic, low, high, other.cubics[s0], z0, z, sections))
        if s0 != s1 and best > limit:
            x, y = point(cubic, low)
            z = nearest(other.cubics[s1], 0.0, 1.0, z1, x, y)
            best = min(best, paired(cubic, low, high, other.cubics[s1], z, z1, sections))
    return best


@compiled
def stretch_bound(
    cubic: FloatArray, low: float, high: float, other: Chains, s: int, z: float, z_end: float, step: int, joints: int,
    limit: float, sections: FloatArray,
) -> float:  # fmt: skip
    """As :func:`section_bound`, by pairing with the stretch from segment s on over a number of joints.

    Args:
        step: 1 along the contour, -1 against it. z, z_end: parameters where the stretch begins and ends.
    """
    most, x = 0.0, low
    for k in range(joints + 1):
        segment = other.cubics[s]
        stop, cut = z_end, high
        if k < joints:
            end = 3 if step > 0 else 0
            stop = 1.0 if step > 0 else 0.0
            cut = nearest(cubic, x, high, x + (high - x) / (joints + 1 - k), segment[end, 0], segment[end, 1])
        most = max(most, paired(cubic, x, cut, segment, z, stop, sections))
        if most > limit and k < joints:
            return np.inf
        x, z = cut, 0.0 if step > 0 else 1.0
        s = neighbour(other, s, step)
    return most


@compiled
def paired(
    cubic: FloatArray, low: float, high: float, other: FloatArray, z0: float, z1: float, sections: FloatArray
) -> float:
    """Bound of the distance of a section of a cubic from the section of another between two parameters, any of which
    may be the larger one."""
    section(cubic, low, high, sections[0])
    section(other, z0, z1, sections[1])
    return points_apart(sections[0], sections[1], 0, 4)


@compiled
def hull_distances(old: FloatArray, old_offsets: IntArray, new: FloatArray, new_offsets: IntArray) -> FloatArray:
    """(C, D) distances of the convex hulls of the contours of two outlines; arguments as :func:`outline_distances`.

    The distance of two convex sets is the largest difference of their extents in any direction: here in ``DIRECTIONS``
    of them, and of points of the contours at every quarter of a segment. Whichever is larger counts, that or the
    difference of the square roots of the areas: it tells a ring's outer contour from a disc in several pieces.
    """
    mine, its = extents(old, old_offsets), extents(new, new_offsets)
    found = np.zeros((len(mine), len(its)))
    for c in range(len(mine)):
        for d in range(len(its)):
            for k in range(DIRECTIONS + 1):
                found[c, d] = max(found[c, d], abs(mine[c, k] - its[d, k]))
    return found


@compiled
def extents(cubics: FloatArray, offsets: IntArray) -> FloatArray:
    """(C, DIRECTIONS + 1) extents of contours, and the square roots of the areas of the polygons of their points."""
    found = np.full((len(offsets) - 1, DIRECTIONS + 1), -np.inf)
    ux, uy = np.empty(DIRECTIONS), np.empty(DIRECTIONS)
    for k in range(DIRECTIONS):
        ux[k], uy[k] = np.cos(2 * np.pi * k / DIRECTIONS), np.sin(2 * np.pi * k / DIRECTIONS)
    for c in range(len(offsets) - 1):
        area = 0.0
        first = offsets[c]
        ox, oy = cubics[first, 0, 0], cubics[first, 0, 1]
        ax = ay = 0.0
        for s in range(first, offsets[c + 1]):
            for q in range(4):
                x, y = point(cubics[s], q / 4)
                area += ax * (y - oy) - ay * (x - ox)
                ax, ay = x - ox, y - oy
                for k in range(DIRECTIONS):
                    found[c, k] = max(found[c, k], ux[k] * x + uy[k] * y)
        found[c, DIRECTIONS] = np.sqrt(abs(area) / 2)
    return found
