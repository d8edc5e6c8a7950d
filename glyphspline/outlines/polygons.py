"""Contours as polygons within a certified distance, and polygons cut and joined again so that none cross."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from ..curves.bezier import cross, evaluate
from ..errors import OptionError, is_positive, require
from ..types import FloatArray, IntArray
from .contour_arrays import ContourArrays, Polylines, offsets_of

MOST_POINTS = 5_000_000
"""Points of all polygons together: far more than a drawing has, and few enough for the memory."""

GOLDEN = np.array([0.7548776662466927, 0.5698402909980532])
"""The fractional parts of its multiples are spread evenly over the unit square."""


def flattened(contours: ContourArrays, flatness: float) -> tuple[Polylines, float]:
    """Polygons whose corners lie on the contours, and a bound of their distance from them, at most ``flatness``.

    A segment becomes n chords over equal parts of its parameter range. Chord and curve at equal parameters are at most
    max |B''| / (8 n²) apart, and |B''| is at most 6 times the longest second difference of its Bézier points as a cubic
    (convex hull property). This bounds the distance both ways, from the curve and from the polygon.

    Args:
        contours: of lines, quadratics and cubics. flatness: a positive distance, in font units.

    Returns:
        A closed polygon for each contour, its first point not repeated at the end; and the bound.

    Raises:
        OptionError: flatness is not positive, or so small that rounding errors or millions of points would result.
    """
    require(is_positive(flatness), "flatness is a positive distance in font units", flatness)
    from .segments import all_cubics  # here, so that opening needs no compiler

    # Bound of the rounding errors of a point, relative to the largest coordinate.
    rounding = 16 * np.finfo(np.float64).eps * float(np.abs(contours.points).max(initial=0.0))
    aim = flatness - rounding
    if aim < flatness / 2:
        raise OptionError(f"flatness is more than {2 * rounding:.2g}, the rounding of such coordinates")
    cubics = all_cubics(contours)
    bends = np.hypot(*np.moveaxis(np.diff(cubics, n=2, axis=1), 2, 0)).max(axis=1, initial=0.0)
    apart = np.where(contours.degrees > 1, 0.75 * bends, 0.0)
    needed = np.maximum(np.ceil(np.sqrt(apart / aim) * (1 + 1e-12)), 1.0)
    if not needed.sum() <= MOST_POINTS:
        raise OptionError(f"flatness {flatness:g} asks for {needed.sum():.3g} points, more than {MOST_POINTS}")
    at = offsets_of(needed.astype(np.int64))
    own = np.repeat(np.arange(len(cubics)), np.diff(at))
    found = evaluate(cubics[own], (np.arange(len(own)) - at[own]) / needed[own])
    bound = float((apart / needed**2).max(initial=0.0))
    closed = np.ones(contours.num_contours, dtype=np.bool_)
    return Polylines(found, at[contours.offsets], closed), bound + rounding if bound else 0.0


def polygons_of(lines: Polylines) -> list[FloatArray]:
    """The points (n, 2) of each polyline, as views."""
    return np.split(lines.points, lines.offsets[1:-1]) if len(lines.closed) else []


def uncrossed(polygons: Sequence[FloatArray]) -> list[FloatArray]:
    """Polygons (n, 2) cut where sides cross, and joined again so that none crosses itself or another.

    Where two sides cross, each goes on as the other, in its direction. The sides stay the same, and so do the winding
    numbers of all points; loops only touch. Polygons without crossings are returned as they are.
    """
    starts = offsets_of([len(polygon) for polygon in polygons])
    if not starts[-1]:
        return list(polygons)
    points = np.concatenate(polygons)
    count = len(points)
    extent = float(np.ptp(points, axis=0).max())
    # Of the extent: corners are taken to be so far from where they are, each its own way, so that none lies on a side.
    moved = points + 1e-9 * extent * (np.outer(np.arange(1, count + 1), GOLDEN) % 1 - 0.5)
    follows = np.arange(1, count + 1)
    some = np.flatnonzero(np.diff(starts))
    follows[starts[some + 1] - 1] = starts[some]
    sides = moved[follows] - moved
    pairs = np.concatenate([np.empty((0, 2), dtype=np.int64), *_crossing(moved, sides, follows, starts)])
    if not len(pairs):
        return list(polygons)
    i, j = pairs.T
    apart = moved[j] - moved[i]
    turn = cross(sides[i], sides[j])
    along = np.stack([cross(apart, sides[j]) / turn, cross(apart, sides[i]) / turn], axis=1)
    # Nodes: the corners, then each crossing twice, as a point of one side and of the other.
    crossings = points[i] + along[:, :1] * (points[follows[i]] - points[i])
    nodes = np.concatenate([points, np.repeat(crossings, 2, axis=0)])
    side = np.concatenate([np.arange(count), pairs.ravel()])
    order = np.lexsort((np.concatenate([np.full(count, -1.0), along.ravel()]), side))
    ends = np.searchsorted(side[order], starts)
    after = np.empty(len(nodes), dtype=np.int64)
    after[order] = np.roll(order, -1)
    some = np.flatnonzero(np.diff(ends))
    after[order[ends[some + 1] - 1]] = order[ends[some]]
    after[count:] = after[count:].reshape(-1, 2)[:, ::-1].ravel()
    return [nodes[loop] for loop in _loops(after, order)]


def _crossing(points: FloatArray, sides: FloatArray, follows: IntArray, starts: IntArray) -> Iterator[IntArray]:
    """(k, 2) pairs of sides that cross, of those whose boxes overlap; neighbours meet and do not cross.

    The first is of the polygon that begins farther to the left.
    """
    low, high = np.minimum(points, points + sides), np.maximum(points, points + sides)
    lefts = [low[a:b, 0].min(initial=np.inf) for a, b in pairwise(starts.tolist())]
    rank = np.argsort(np.argsort(np.repeat(lefts, np.diff(starts)), kind="stable"))
    for i, j in box_pairs(low, high):
        i, j = np.where(rank[i] < rank[j], [i, j], [j, i])
        near = (follows[i] != j) & (follows[j] != i)
        i, j = i[near], j[near]
        begin, q, s = points[j] - points[i], sides[i], sides[j]
        split = (cross(q, begin) > 0) != (cross(q, begin + s) > 0)
        split &= (cross(s, -begin) > 0) != (cross(s, q - begin) > 0)
        yield np.stack([i[split], j[split]], axis=1)


def box_pairs(low: FloatArray, high: FloatArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Pairs of boxes that overlap or touch, each once, a million candidates at a time; of their corners (n, 2)."""
    order = np.argsort(low[:, 0], kind="stable")
    counts = np.searchsorted(low[order, 0], high[order, 0], side="right") - np.arange(len(order)) - 1
    for part in np.array_split(np.arange(len(order)), 1 + int(counts.sum()) // 1_000_000):
        first = np.repeat(part, counts[part])
        behind = np.arange(len(first)) - np.repeat(offsets_of(counts[part])[:-1], counts[part])
        i, j = order[first], order[first + 1 + behind]
        near = (low[i, 1] <= high[j, 1]) & (low[j, 1] <= high[i, 1])
        yield i[near], j[near]


def _loops(after: IntArray, order: IntArray) -> Iterator[list[int]]:
    following, seen = after.tolist(), [False] * len(after)
    for first in order.tolist():
        loop, at = [], first
        while not seen[at]:
            seen[at] = True
            loop.append(at)
            at = following[at]
        if loop:
            yield loop
