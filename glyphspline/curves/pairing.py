"""The certificate: a bound of the two-sided distance of two closed chains of cubics, in V ≥ 1 instances at once.

A chain is an array (n V, 4, 2), with segment j in instance v in row j V + v. With one instance it is a contour. With
several these are the corners of a design space's grid: everywhere else an instance is a convex combination of some of
them, with the same weights for both chains.

Both chains are cut into the same number of *sections*, one after the other, at places that are the same in all
instances, so that section A of the one is paired with section B of the other. The difference of the two polynomials at
equal parameters is a cubic with Bézier points A_k - B_k, and lies in the convex hull of these. So every point of A has
a point of B within the largest ``|A_k - B_k|`` of all instances, and vice versa, in between too as this is convex. It
bounds the two-sided (Hausdorff) distance of the chains and their Fréchet distance. This holds for *every* subdivision
that runs once round both: hints and Newton's method only make the bound sharp, and sections are halved until it is.
In a design space the smaller of this and the *slip* bound is taken (:mod:`.slip`).

Floating point: a Bézier point of a section is a convex combination of convex combinations, three for the section and
three for each halving, of points of size at most L. ``ROUNDING`` times L, more than all such triples can cost, is added
to every bound.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import compiled, inlined
from ..types import FloatArray, IntArray
from .cubics import extent, length, section, split
from .nearest import nearest_together, search_place
from .slip import SCRATCH, slip_bound

ROUNDING = 1e-13
"""Share of the largest coordinate added to a bound for floating point."""

SHARPNESS = 0.02
"""Fits' certificates may exceed the distances seen by this share of the tolerance."""

DEEPEST, MOST_HALVINGS = 14, 5_000
"""Maximum subdivision depth; pairs still above the limit there count as too far apart. Halvings of one span, after
which what is left counts as too far apart: a wrong pairing would take seconds."""

Parts = tuple[FloatArray, IntArray]
"""Rows of all contours end to end, and the offsets at which contours begin in them."""


class Room(NamedTuple):
    """Scratch for V instances, and ``found``: of the sections so far their bound, without rounding; the largest
    distance seen between paired points; and its place on the other chain."""

    V: int
    work: FloatArray
    marks: FloatArray
    found: FloatArray


class Demand(NamedTuple):
    """How sharp a bound is to be.

    Attributes:
        arc: empty, or (4,); see :func:`pair_instances`.
        coarse: search the segment for the points nearest to the other's joints; or else begin from a proportional
            guess, and halve every pair once, so that a gap is seen between its ends; of an arc, across it. Coarsely, no
            gap is seen of an arc, and nothing is refined once a pair is beyond ``enough``.
        enough: bounds up to this are not refined; nor are bounds within ``sharpness`` of a larger gap already seen.
    """

    arc: FloatArray
    coarse: bool
    enough: float
    sharpness: float


def pair_stretches(
    results: Parts, sources: Parts, anchors: Parts, sharpness: float, limit: float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """Bound the distance of contours from their sources between each anchor and the next.

    Args:
        results: (r, 4, 2) closed contours. sources: (m, 4, 2), likewise.
        anchors: (a, 2) *places* (segment + local parameter, counted on past the last segment) of the result and of the
            source that are taken to belong together. Of a contour neither column decreases; the last row
            is the first one a lap (r, m) later, and the first one lies in the first lap.
        sharpness: halve sections until the bound exceeds the gaps seen by no more than this.
        limit: where the bound is above it, pair again with the roles exchanged, and take the better of the two.

    Returns:
        (a - C,) certified bounds, and the largest distances seen between paired points.
    """
    bounds, gaps = np.full((2, len(anchors[0]) - len(anchors[1]) + 1), np.nan)
    one, other, pairs = ((np.ascontiguousarray(rows), offsets) for rows, offsets in (results, sources, anchors))
    pair_instances(1, one, other, pairs, np.empty((0, 4)), sharpness, limit, bounds, gaps)
    return bounds, gaps


@compiled
def pair_instances(
    V: int, results: Parts, sources: Parts, anchors: Parts, arcs: FloatArray, sharpness: float, limit: float,
    bounds: FloatArray, gaps: FloatArray,
) -> None:  # fmt: skip
    """As :func:`pair_stretches`, of V instances, of the stretches whose ``bounds`` are NaN.

    A stretch is cut where segments of the one contour end, at the nearest points of the other.

    Args:
        results: (r V, 4, 2), sources: (m V, 4, 2), the offsets those of segments. bounds, gaps: (a - C,).
        arcs: (0, 4); or (a - C, 4) in a design space: first and last place on the result and on the source of the arc
            that a stretch belongs to, infinite for closed curves. A bound beyond the limit is seldom the best to be had
            then, as no stretch of an arc is refined once another one is beyond it, and no gaps are seen.
    """
    slips, no_arc = len(arcs) > 0, np.empty(0)
    room, (places, ends) = room_for(V), anchors
    found = room.found
    for c in range(len(ends) - 1):
        result, source = part(V, results, c), part(V, sources, c)
        rounding, lost = ROUNDING * max(extent(result), extent(source)), np.nan
        for k in range(ends[c], ends[c + 1] - 1):
            if not np.isnan(bounds[k - c]):
                continue
            bounds[k - c], gaps[k - c] = np.inf, 0.0
            arc, enough = no_arc, -1.0
            if slips:
                arc = arcs[k - c]
                enough = np.inf if arc[0] == lost else limit
            demand = Demand(arc, True, enough, sharpness)
            for exchanged in range(1 if slips else 2):
                one, other = (source, result) if exchanged else (result, source)
                x, x_end = places[k, exchanged], places[k + 1, exchanged]
                y, y_end = places[k, 1 - exchanged], places[k + 1, 1 - exchanged]
                found[:] = 0.0
                last = False
                while not last:
                    i = int(np.floor(x))
                    last = x_end <= i + 1
                    cut, partner = x_end, y_end
                    if not last:
                        cut = i + 1.0
                        partner = search_place(V, other, y, y_end, one, i % (len(one) // V), 3)
                    pair_span(room, one, (i, x - i, cut - i), other, (y, partner), demand)
                    x, y = cut, partner
                if found[0] + rounding < bounds[k - c]:
                    bounds[k - c], gaps[k - c] = found[0] + rounding, found[1]
                if bounds[k - c] <= limit:
                    break
            if slips and bounds[k - c] > limit:
                lost = arc[0]


@inlined
def part(V: int, parts: Parts, c: int) -> FloatArray:
    """The rows of contour c, in V instances."""
    rows, offsets = parts
    return rows[V * offsets[c] : V * offsets[c + 1]]


@inlined
def room_for(V: int) -> Room:
    """Room for V instances in which nothing is found yet."""
    return Room(V, np.empty((2, (DEEPEST + 2 + SCRATCH) * V, 4, 2)), np.empty((DEEPEST + 2, 5)), np.zeros(3))


@compiled
def pair_span(
    room: Room, chain: FloatArray, span: tuple[int, float, float], other: FloatArray, stretch: tuple[float, float],
    demand: Demand,
) -> None:  # fmt: skip
    """Distance of a section of one segment from a stretch of another chain, in V instances.

    Args:
        room: has what earlier sections found; smaller bounds are not refined.
        chain: (n V, 4, 2). span: a segment, counted on past the last, and parameters x and x_end to measure between.
        other: (m V, 4, 2). stretch: places y and y_end on it.
    """
    (V, work, marks, found), (i, x, x_end), (y, y_end) = room, span, stretch
    arc, coarse, enough, sharpness = demand
    j, m, slips, least = i % (len(chain) // V), len(other) // V, len(arc) > 0, 0 if coarse else 1
    bound, gap, where = found[0], found[1], found[2]
    last, halvings = False, 0
    while not last:
        s = int(np.floor(y))
        last = y_end <= s + 1
        r, stop, cut = s % m, y_end, x_end
        if not last:
            stop = s + 1.0
            if coarse:
                cut = search_place(V, chain[j * V : (j + 1) * V], x, x_end, other, r, 3)
            else:
                guess = x + (x_end - x) * (stop - y) / (y_end - y)
                cut = nearest_together(V, chain, j, x, x_end, guess, other, r, 3)
        for v in range(V):
            section(chain[j * V + v], x, cut, work[0, v])
            section(other[r * V + v], y - s, stop - s, work[1, v])
        # A stack of pairs, V rows each; marks: first and last place on the chain and on the other, and depth.
        marks[0, 0], marks[0, 1], marks[0, 2], marks[0, 3], marks[0, 4] = i + x, i + cut, y, stop, 0.0
        top = 0
        while top >= 0:
            low, high, depth, row = marks[top, 2], marks[top, 3], marks[top, 4], top * V
            first = inner = end = 0.0
            for v in range(row, row + V):
                A, B = work[0, v], work[1, v]
                first, end = max(first, apart(A, B, 0)), max(end, apart(A, B, 3))
                inner = max(inner, max(apart(A, B, 1), apart(A, B, 2)))
            most, limit = max(inner, max(first, end)), max(enough, bound)
            if slips:
                first = end = 0.0
                for v in range(row, row if coarse else row + V):
                    A, B = work[0, v], work[1, v]
                    first, end = max(first, _across(A, B, 0)), max(end, _across(A, B, 3))
            if first > gap:
                gap, where = first, low
            if end > gap:
                gap, where = end, high
            if gap > enough:
                limit = max(limit, gap + sharpness)
            if slips and most > limit:
                one, two, scratch = work[0, row : row + V], work[1, row : row + V], work[0, (DEEPEST + 2) * V :]
                most = min(most, slip_bound(one, two, chain, other, marks[top], arc, limit, scratch))
            if depth >= least and (most <= limit or depth >= DEEPEST or halvings >= MOST_HALVINGS):
                if slips and coarse and most > limit:
                    enough = np.inf
                bound = max(bound, most)
                top -= 1
                continue
            halvings += 1
            for v in range(row, row + V):
                split(work[0, v], 0.5, work[0, V + v])
            z = nearest_together(V, work[1], top, 0.0, 1.0, 0.5, work[0], top, 0)
            for v in range(row, row + V):
                split(work[1, v], z, work[1, V + v])
            middle, place = (marks[top, 0] + marks[top, 1]) / 2, low + z * (high - low)
            marks[top + 1, 0], marks[top + 1, 1] = marks[top, 0], middle
            marks[top + 1, 2], marks[top + 1, 3] = low, place
            marks[top, 0], marks[top, 2] = middle, place
            marks[top, 4] = marks[top + 1, 4] = depth + 1
            top += 1
        x, y = cut, stop
    found[0], found[1], found[2] = bound, gap, where


@inlined
def _across(A: FloatArray, B: FloatArray, k: int) -> float:
    """Distance of an end of a cubic, Bézier point k, from the tangent of another one there; 0 where it has none."""
    i = k - 1 if k > 0 else 0
    x, y = B[i + 1, 0] - B[i, 0], B[i + 1, 1] - B[i, 1]
    size = length(x, y)
    return abs(x * (A[k, 1] - B[k, 1]) - y * (A[k, 0] - B[k, 0])) / size if size > 0 else 0.0


@inlined
def apart(A: FloatArray, B: FloatArray, k: int) -> float:
    """Distance of Bézier points k of two cubics (4, 2)."""
    return length(A[k, 0] - B[k, 0], A[k, 1] - B[k, 1])
