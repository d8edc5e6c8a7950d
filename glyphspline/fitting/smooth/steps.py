"""The steps of a smooth fit for all contours of a glyph that are not done yet, on ragged arrays.

Vertices are placed, the curves through them measured, and vertices inserted and removed. Part i of a ragged array
belongs to contour ``which[i]`` and is ``values[offsets[i]:offsets[i + 1]]``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ...arrays import ascending, grown, put
from ...compiled import compiled
from ...curves.cubics import extent
from ...curves.nearest import near_places
from ...curves.pairing import ROUNDING, Demand, pair_span, room_for
from ...interpolation.kernels.driver import distance
from ...outlines.contour_arrays import offsets_of
from ...types import BoolArray, FloatArray, IntArray
from .canonical_contours import TABLE, CanonicalContours, chain_of, points_at, table_of
from .spacing import MOST, at_corners, failed, first_field, graded, laid, lowered, off_corners, spans_after, with_more


class Rules(NamedTuple):
    """How vertices are laid.

    Attributes:
        near: the distance allowed, in font units. corner_angle: turn in radians from which a joint is a corner.
        ratio: at most, of adjacent chords. factor: by which they grow at most.
    """

    near: float
    corner_angle: float
    ratio: float
    factor: float


@compiled
def first_places(
    contours: CanonicalContours, rules: Rules, variant: int, hold: BoolArray
) -> tuple[FloatArray, FloatArray, IntArray]:
    """The fields of all contours end to end, and ragged places to begin with."""
    count, (near, corner_angle, ratio, factor) = len(contours.offsets) - 1, rules
    fields, K = np.empty(len(contours.turns) * TABLE + count), len(contours.cubics) // len(contours.turns)
    offsets, values = np.zeros(count + 1, dtype=np.int64), np.empty(1024)
    for k in range(count):
        a, b = contours.offsets[k], contours.offsets[k + 1]
        cubics, turns = chain_of(contours, k), contours.turns[a:b]
        lengths = table_of(contours.lengths, contours.offsets, k)
        field, joints = table_of(fields, contours.offsets, k), np.arange(b - a).astype(np.float64)
        first_field(cubics, lengths, turns, corner_angle, factor, near, variant, hold[k], field)
        corners = at_corners(joints, turns, corner_angle)
        even = laid(field, lengths, joints, corners, np.ones(len(corners), dtype=np.bool_))
        if hold[k] and turns[corners[0]] >= corner_angle:
            corners = at_corners(even, turns, corner_angle)
            errors = off_corners(points_at(cubics, K, even), corners, turns[even[corners].astype(np.int64)])
            fails = failed(corners, errors, near)
            lowered(field, lengths, even, corners, fails, errors, near, np.log(factor), True)
            even = laid(field, lengths, even, corners, fails)
        part = graded(cubics, lengths, even, ratio)
        values = appended(values, offsets[k], part)
        offsets[k + 1] = offsets[k] + len(part)
    return fields, values[: offsets[-1]], offsets


def held_corners(
    contours: CanonicalContours, which: IntArray, places: FloatArray, offsets: IntArray, corner_angle: float,
    hold: BoolArray,
) -> BoolArray:  # fmt: skip
    """(n,) ragged: which vertices lie at corners of contours of which these are held."""
    joints, counts = places.astype(np.int64), np.diff(offsets)
    turns = contours.turns[np.repeat(contours.offsets[which], counts) + joints]
    return np.asarray(np.repeat(hold[which], counts) & (joints == places) & (turns >= corner_angle))


@compiled
def appended(values: FloatArray, count: int, part: FloatArray) -> FloatArray:
    """An array whose first ``count`` values are in use, or a larger one, with more after these."""
    stop = count + len(part)
    values = grown(values, stop)
    put(part, values[count:stop])
    return values


@compiled
def polygons(contours: CanonicalContours, which: IntArray, places: FloatArray, offsets: IntArray) -> FloatArray:
    """Ragged points (n, 2 K) of the outline at the places."""
    K = len(contours.cubics) // len(contours.turns)
    points = np.empty((len(places), 2 * K))
    for i in range(len(which)):
        a, b = offsets[i], offsets[i + 1]
        put(points_at(chain_of(contours, which[i]), K, places[a:b]), points[a:b])
    return points


class Trial(NamedTuple):
    """Polygons of some contours, and how far the curves through them are from the outlines; ragged, a row a span.

    Attributes:
        which: (k,) numbers of the contours. places, offsets, points: the vertices. pieces: (n, V, 4, 2) the curves as
            they are written, in V instances.
        bounds, gaps, worst: certified bounds of the spans, gaps seen, and the places of these on the outline.
        ends: where the stretch of outline that a span is paired with begins; those of part i begin at
            ``offsets[i] + i``, and the first is repeated a lap later.
    """

    which: IntArray
    places: FloatArray
    offsets: IntArray
    points: FloatArray
    pieces: FloatArray
    bounds: FloatArray
    gaps: FloatArray
    worst: FloatArray
    ends: FloatArray


def chosen(columns: Sequence[Any], offsets: IntArray, keep: BoolArray) -> list[Any]:
    """Some parts of ragged arrays: offsets like these, or arrays with a row a part, a row a vertex, or one more a part.

    A part has several vertices, so that lengths tell which is which.
    """
    counts = np.diff(offsets)
    rows = {len(row): np.flatnonzero(row) for row in (keep, np.repeat(keep, counts), np.repeat(keep, counts + 1))}
    new = offsets_of(counts[keep])
    return [new if len(column) == len(offsets) else column.take(rows[len(column)], axis=0) for column in columns]


@compiled
def measured(
    contours: CanonicalContours, which: IntArray, places: FloatArray, offsets: IntArray, points: FloatArray,
    pieces: FloatArray, near: float,
) -> Trial:  # fmt: skip
    """Measure closed curves with vertices at ``places`` of their contours, only as sharply as the search needs.

    A span is paired with the stretch of outline between the points nearest to its ends.

    Args:
        contours: in V instances. pieces: (n, V, 4, 2) the curves as they are written. near: the distance allowed.
    """
    n, V, arc = len(places), len(contours.cubics) // len(contours.turns), np.empty(0)
    if V > 1:
        arc = np.array([-np.inf, np.inf, -np.inf, np.inf])
    room = room_for(V)
    found = room.found
    bounds, gaps, worst, ends = np.empty(n), np.empty(n), np.empty(n), np.empty(n + len(which))
    for i in range(len(which)):
        a, b = offsets[i], offsets[i + 1]
        outline, spans = chain_of(contours, which[i]), pieces[a:b].reshape((-1, 4, 2))
        begins, rounding = ends[a + i : b + i + 1], ROUNDING * max(extent(spans), extent(outline))
        near_places(V, outline, places[a:b], spans, np.zeros(b - a, dtype=np.bool_), True, 0.0, 0.0, begins)
        begins[b - a] = begins[0] + len(outline) // V
        for j in range(b - a):
            y, y_end = begins[j], begins[j + 1]
            found[0], found[1], found[2] = 0.0, 0.0, (y + y_end) / 2
            # Sharpness of the bounds during the search, as a share of the distance allowed.
            demand = Demand(arc, False, near - rounding, 0.1 * near)
            pair_span(room, spans, (j, 0.0, 1.0), outline, (y, y_end), demand)
            bounds[a + j], gaps[a + j], worst[a + j] = found[0] + rounding, found[1], found[2]
    return Trial(which, places, offsets, points, pieces, bounds, gaps, worst, ends)


@compiled
def sharpened(
    pieces: FloatArray, outline: FloatArray, bounds: FloatArray, gaps: FloatArray, ends: FloatArray, sharpness: float
) -> tuple[float, float]:
    """Bound and gap of a contour from those of its spans, within ``sharpness`` of each other; see :class:`Trial`."""
    no_arc, room = np.empty(0), room_for(1)
    found = room.found
    rounding = ROUNDING * max(extent(pieces), extent(outline))
    left, bound, gap = bounds.copy(), 0.0, gaps.max()
    while True:
        i = int(left.argmax())
        enough = max(bound, gap + sharpness)
        if left[i] <= enough:
            return max(bound, left[i]), gap
        found[:] = 0.0
        demand = Demand(no_arc, False, enough - rounding, sharpness)
        pair_span(room, pieces, (i, 0.0, 1.0), outline, (ends[i], ends[i + 1]), demand)
        gap, bound = max(gap, found[1]), max(bound, found[0] + rounding)
        left[i] = 0.0


@compiled
def changed(
    contours: CanonicalContours, fields: FloatArray, trial: Trial, more: BoolArray, fewer: BoolArray, hold: BoolArray,
    rules: Rules, power: float, anew: bool,
) -> tuple[IntArray, FloatArray, IntArray]:  # fmt: skip
    """The contours of a trial that change, and their ragged places.

    Args:
        fields: of all contours, see :func:`first_places`; lowered where vertices are respaced.
        more: (K,) whether to have more vertices where a contour misses the tolerance. fewer: (K,) whether to remove
            vertices that seem unnecessary. hold: (K,) whether control points of corners are held at them. All three
            are indexed by contour.
        power: the error of a span is assumed to grow with this power of its length.
        anew: whether more vertices are respaced, evenly, or inserted into the spans that miss the tolerance.
    """
    (which, places, offsets, points, _, bounds, gaps, worst, _), (near, corner_angle, ratio, factor) = trial, rules
    those, new = np.empty(len(which), dtype=np.int64), np.zeros(len(which) + 1, dtype=np.int64)
    values, count = np.empty(len(places) + 1024), 0
    growth = np.log(factor)
    for i in range(len(which)):
        k, a, b = which[i], offsets[i], offsets[i + 1]
        cubics, turns = chain_of(contours, k), contours.turns[contours.offsets[k] : contours.offsets[k + 1]]
        lengths = table_of(contours.lengths, contours.offsets, k)
        here, bound, at = places[a:b].copy(), bounds[a:b].copy(), worst[a:b].copy()
        if fewer[k]:
            needed = np.zeros(b - a, dtype=np.bool_)
            if anew and more[k]:  # what is laid anew is not thinned first
                corners = at_corners(here, turns, corner_angle)
                fails = failed(corners, bound, near)
                for c in range(len(corners)):
                    for j in range(spans_after(corners, c, b - a) + 1 if fails[c] else 0):
                        needed[(corners[c] + j) % (b - a)] = True
            keep = sparse(points[a:b], here, turns, hold[k], needed, gaps[a:b], rules, power)
            here, bound, at = here[keep], bound[keep], at[keep]
        if more[k]:
            corners = at_corners(here, turns, corner_angle)
            if anew and len(corners) > 0:
                field, fails = table_of(fields, contours.offsets, k), failed(corners, bound, near)
                held = hold[k] and turns[int(here[corners[0]])] >= corner_angle
                lowered(field, lengths, here, corners, fails, bound, near, growth, held)
                here = laid(field, lengths, here, corners, fails)
            else:
                here = with_more(lengths, here, bound, at, near)
        if len(here) == b - a and (here == places[a:b]).all():
            continue
        here = graded(cubics, lengths, here, ratio)
        if len(here) <= MOST:
            values = appended(values, new[count], here)
            those[count], new[count + 1] = k, new[count] + len(here)
            count += 1
    return those[:count], values[: new[count]], new[: count + 1]


@compiled
def sparse(
    points: FloatArray, places: FloatArray, turns: FloatArray, hold: bool, needed: BoolArray, errors: FloatArray,
    rules: Rules, power: float,
) -> BoolArray:  # fmt: skip
    """Which vertices of a closed polygon to keep: not those without which the error would still be small enough.

    The error of a span is taken to grow with the given power of its length. Smallest errors first, no two neighbours
    at once, and none without which adjacent chords would be beyond the ratio. Without a vertex at a corner, the error
    is at least its height over the chord that takes its place. At a held corner it grows with the chord beside it.

    Args:
        points: (n, d), at places (n,). turns: at the joints.
        hold: whether control points of corners are held at them.
        needed: (n,) vertices that are kept in any case. errors: (n,) of the span after each vertex.
    """
    n, (near, corner_angle, ratio, _) = len(points), rules
    keep, expected, corner = np.ones(n, dtype=np.bool_), np.full(n, np.inf), np.empty(n, dtype=np.bool_)
    for i in range(n):
        j = int(places[i])
        corner[i] = places[i] == j and turns[j] >= corner_angle
    for i in range(n):
        if needed[i]:
            continue
        k = (i + 1) % n
        h, g = distance(points, i - 1, i), distance(points, i, k)
        expected[i] = max(errors[i - 1], errors[i]) * ((g + h) / max(g, h)) ** power
        if hold and corner[i - 1]:
            expected[i] = max(expected[i], errors[i - 1] * (g + h) / h)
        if hold and corner[k]:
            expected[i] = max(expected[i], errors[i] * (g + h) / g)
        if corner[i]:
            square = product = height = 0.0
            for axis in range(points.shape[1]):
                a = points[k, axis] - points[i - 1, axis]
                square, product = square + a * a, product + a * (points[i, axis] - points[i - 1, axis])
            along = min(max(product / square, 0.0), 1.0) if square > 0 else 0.0
            for axis in range(points.shape[1]):
                b = points[i, axis] - points[i - 1, axis] - along * (points[k, axis] - points[i - 1, axis])
                height += b * b
            expected[i] = max(expected[i], np.sqrt(height))
    order, left = ascending(expected), n
    for k in range(n):
        i = order[k]
        if not expected[i] <= near or left <= 4:
            break
        before, after = (i - 1) % n, (i + 1) % n
        if not (keep[before] and keep[after]):
            continue
        further, beyond = (before - 1) % n, (after + 1) % n
        while not keep[further]:
            further = (further - 1) % n
        while not keep[beyond]:
            beyond = (beyond + 1) % n
        h, g, f = distance(points, further, before), distance(points, before, after), distance(points, after, beyond)
        if max(h, g) <= ratio * min(h, g) and max(f, g) <= ratio * min(f, g):
            keep[i] = False
            left -= 1
    return keep


@compiled
def put_back(points: FloatArray, keep: BoolArray, errors: FloatArray, near: float, ratio: float) -> BoolArray:
    """Keep again what had been taken out of the spans that are now too far off, or of those beside them.

    Args:
        points: (n, d) the polygon before. keep: (n,) the vertices of the polygon after. errors: of its spans.
    """
    n = len(points)
    kept = np.flatnonzero(keep)
    m = len(kept)
    after = keep.copy()
    for j in range(m):
        if errors[j] > near:
            last = kept[(j + 2) % m]
            i = (kept[j - 1] + 1) % n
            while i != last:
                after[i] = True
                i = (i + 1) % n
    while True:
        kept = np.flatnonzero(after)
        m = len(kept)
        changed = False
        for j in range(m):
            a, b, c, d = kept[j - 1], kept[j], kept[(j + 1) % m], kept[(j + 2) % m]
            h = distance(points, b, c)
            if (b + 1) % n != c and h > ratio * min(distance(points, a, b), distance(points, c, d)):
                after[(b + 1) % n] = True
                changed = True
        if not changed:
            return after
