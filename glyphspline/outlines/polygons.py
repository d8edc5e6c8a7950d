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

ROUNDING = 16 * np.finfo(np.float64).eps
"""Bound of the rounding errors of a point, relative to the largest coordinate."""

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

    rounding = ROUNDING * float(np.abs(contours.points).max(initial=0.0))
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
    """(k, 2) pairs of sides that cross, of pairs of polygons whose boxes overlap."""
    low, high = np.minimum(points, points + sides), np.maximum(points, points + sides)
    spans = [(a, b) for a, b in pairwise(starts.tolist()) if b > a]
    boxes = np.array([[*low[a:b].min(axis=0), *high[a:b].max(axis=0)] for a, b in spans])
    spans = [spans[k] for k in np.argsort(boxes[:, 0], kind="stable")]
    boxes = boxes[np.argsort(boxes[:, 0], kind="stable")]
    for c, (a, b) in enumerate(spans):
        box = boxes[c]
        last = int(np.searchsorted(boxes[:, 0], box[2], side="right"))
        near = c + np.flatnonzero((boxes[c:last, 1] <= box[3]) & (boxes[c:last, 3] >= box[1]))
        for d in near.tolist():
            e, f = spans[d]
            common = np.maximum(box[:2], boxes[d, :2]), np.minimum(box[2:], boxes[d, 2:])
            one, other = (
                u + np.flatnonzero((low[u:v] <= common[1]).all(axis=1) & (high[u:v] >= common[0]).all(axis=1))
                for u, v in ((a, b), (e, f))
            )
            for part in np.array_split(one, 1 + len(one) * len(other) // 1_000_000):
                yield _pairs(points, sides, follows, part, other)


def _pairs(points: FloatArray, sides: FloatArray, follows: IntArray, one: IntArray, other: IntArray) -> IntArray:
    """(k, 2) pairs of a side of the one and a side of the other that cross; of equal sets each pair once."""
    p, q, r, s = points[one], sides[one], points[other], sides[other]
    begin = r[None] - p[:, None]
    left = cross(q[:, None], begin) > 0
    split = left != (cross(q[:, None], begin + s[None]) > 0)
    split &= (cross(s[None], -begin) > 0) != (cross(s[None], q[:, None] - begin) > 0)
    if len(one) and len(other) and one[0] <= other[-1] and other[0] <= one[-1]:  # of one polygon
        split &= one[:, None] < other[None]
        split &= (follows[one][:, None] != other[None]) & (follows[other][None] != one[:, None])
    k, m = np.nonzero(split)
    return np.stack([one[k], other[m]], axis=1)


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
