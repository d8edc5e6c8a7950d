"""The steps of a smooth fit for all contours of a glyph that are not done yet, on ragged arrays.

Part i of a ragged array belongs to contour ``which[i]`` and is ``values[offsets[i]:offsets[i + 1]]``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...types import BoolArray, FloatArray, IntArray
from ..certified_distance import measure_spans
from .canonical_contours import TABLE, CanonicalContours, points_at
from .insertion import MOST_VERTICES, graded, with_more
from .pruning import put_back, sparse
from .respacing import failed, relaid, vertices_at_corners
from .spacing import corners_of, first_field, growth_of, laid

ROUGHLY = 0.1
"""Sharpness of the bounds during the search, as a share of ``near``."""


@compiled
def first_places(
    contours: CanonicalContours, which: IntArray, corner_angle: float, ratio: float, near: FloatArray, variant: int
) -> tuple[FloatArray, FloatArray, IntArray]:
    """The fields of all contours end to end, and ragged places to begin with, of the contours ``which``."""
    fields = np.empty(len(contours.cubics) * TABLE + len(near))
    offsets, values = np.empty(len(which) + 1, dtype=np.int64), np.empty(1024)
    offsets[0] = 0
    for i in range(len(which)):
        a, b = contours.offsets[which[i]], contours.offsets[which[i] + 1]
        cubics, lengths = contours.cubics[a:b], contours.lengths[a:b]
        turns, field = contours.turns[a:b], field_of(fields, contours.offsets, which[i])
        first_field(cubics, lengths, turns, corner_angle, ratio, near[which[i]], variant, field)
        part = graded(cubics, lengths, laid(field, lengths, corners_of(turns, corner_angle)), ratio)
        values = appended(values, offsets[i], part)
        offsets[i + 1] = offsets[i] + len(part)
    return fields, values[: offsets[-1]], offsets


@compiled
def field_of(fields: FloatArray, offsets: IntArray, k: int) -> FloatArray:
    """The field of contour k."""
    return fields[offsets[k] * TABLE + k : offsets[k + 1] * TABLE + k + 1]


@compiled
def appended(values: FloatArray, count: int, part: FloatArray) -> FloatArray:
    """An array of which the first ``count`` values are in use, or a larger one, with more after these."""
    if count + len(part) > len(values):
        larger = np.empty(2 * (count + len(part)))
        for i in range(count):
            larger[i] = values[i]
        values = larger
    for i in range(len(part)):
        values[count + i] = part[i]
    return values


@compiled
def polygons(contours: CanonicalContours, which: IntArray, places: FloatArray, offsets: IntArray) -> FloatArray:
    """Ragged points (n, 2) of the outline at the places."""
    points = np.empty((len(places), 2))
    for i in range(len(which)):
        a, b = offsets[i], offsets[i + 1]
        own = points_at(contours.cubics[contours.offsets[which[i]] : contours.offsets[which[i] + 1]], places[a:b])
        for j in range(b - a):
            points[a + j, 0], points[a + j, 1] = own[j, 0], own[j, 1]
    return points


class Trial(NamedTuple):
    """Polygons of some contours, and how far the curves through them are from the outlines; ragged, a row a span.

    Attributes:
        which: (k,) numbers of the contours. places, offsets, points: the vertices.
        bounds, gaps, worst, ends: see :func:`..certified_distance.measure_spans`; ends of part i begin at
            ``offsets[i] + i``.
    """

    which: IntArray
    places: FloatArray
    offsets: IntArray
    points: FloatArray
    bounds: FloatArray
    gaps: FloatArray
    worst: FloatArray
    ends: FloatArray


@compiled
def measured(
    contours: CanonicalContours, which: IntArray, places: FloatArray, offsets: IntArray, points: FloatArray,
    pieces: FloatArray, near: FloatArray,
) -> Trial:  # fmt: skip
    """Measure closed curves with vertices at ``places`` of their contours.

    Args:
        pieces: (n, 4, 2) the curves as they are written. near: (K,) by contour, the distance allowed.
    """
    n = len(places)
    bounds, gaps, worst, ends = np.empty(n), np.empty(n), np.empty(n), np.empty(n + len(which))
    for i in range(len(which)):
        k, a, b = which[i], offsets[i], offsets[i + 1]
        measure_spans(
            pieces[a:b], contours.cubics[contours.offsets[k] : contours.offsets[k + 1]], places[a:b], near[k],
            ROUGHLY * near[k], bounds[a:b], gaps[a:b], worst[a:b], ends[a + i : b + i + 1],
        )  # fmt: skip
    return Trial(which, places, offsets, points, bounds, gaps, worst, ends)


@compiled
def changed(
    contours: CanonicalContours, fields: FloatArray, trial: Trial, near: FloatArray, more: BoolArray, fewer: BoolArray,
    corner_angle: float, ratio: float, variant: int, power: float, anew: bool,
) -> tuple[IntArray, FloatArray, IntArray]:  # fmt: skip
    """The contours of a trial that change, and their ragged places.

    Args:
        fields: of all contours, see :func:`first_places`; lowered where vertices are laid anew.
        more: (K,) whether to have more vertices where a contour misses the tolerance. fewer: (K,) whether to remove
            vertices that seem unnecessary. Both are indexed by contour.
        variant: of the method.
        power: the error of a span is assumed to grow with this power of its length.
        anew: whether more vertices are laid anew, evenly, or put into the spans that miss the tolerance.
    """
    which, places, offsets, points, bounds, gaps, worst, _ = trial
    those, new = np.empty(len(which), dtype=np.int64), np.empty(len(which) + 1, dtype=np.int64)
    values, needed = np.empty(len(places) + 1024), np.empty(len(places), dtype=np.bool_)
    for i in range(len(places)):
        needed[i] = False
    count = new[0] = 0
    for i in range(len(which)):
        k, a, b = which[i], offsets[i], offsets[i + 1]
        s, t = contours.offsets[k], contours.offsets[k + 1]
        cubics, lengths, turns = contours.cubics[s:t], contours.lengths[s:t], contours.turns[s:t]
        here, bound, at = places[a:b].copy(), bounds[a:b].copy(), worst[a:b].copy()
        n = b - a
        again = anew and more[k]
        if again:  # what is laid anew is not thinned first
            _, needed[a:b] = failed(vertices_at_corners(here, turns, corner_angle), bound, near[k])
        if fewer[k]:
            keep = sparse(points[a:b], here, turns, corner_angle, needed[a:b], gaps[a:b], near[k], ratio, power)
            n = 0
            for j in range(b - a):
                if keep[j]:
                    here[n], bound[n], at[n] = here[j], bound[j], at[j]
                    n += 1
            here = here[:n]
        if more[k]:
            corners = vertices_at_corners(here, turns, corner_angle)
            if again and len(corners) > 0:
                field, growth = field_of(fields, contours.offsets, k), np.log(growth_of(ratio, variant))
                here = relaid(field, lengths, here, corners, bound[:n], near[k], growth)
            else:
                here = with_more(lengths, here, bound[:n], at[:n], near[k])
        same = len(here) == b - a
        for j in range(len(here)):
            same = same and here[j] == places[a + j]
        if not same:
            here = graded(cubics, lengths, here, ratio)
            if len(here) <= MOST_VERTICES:
                values = appended(values, new[count], here)
                those[count], new[count + 1] = k, new[count] + len(here)
                count += 1
    return those[:count], values[: new[count]], new[: count + 1]


class Good(NamedTuple):
    """Polygons that passed, and the next vertices to try; all ragged, with ``offsets``.

    Attributes:
        places, points, gaps: of the polygons and their spans.
        keep: vertices of the next trial. needed: vertices that every further trial keeps.
    """

    places: FloatArray
    offsets: IntArray
    points: FloatArray
    gaps: FloatArray
    keep: BoolArray
    needed: BoolArray


@compiled
def thinned(
    contours: CanonicalContours, near: FloatArray, corner_angle: float, ratio: float, power: float, trial: Trial,
    good: Good,
) -> tuple[IntArray, Good]:  # fmt: skip
    """The next polygons to try, to find the vertices that are needed.

    A trial that passes replaces the good polygon, and the next trial omits vertices of it that seem unnecessary. If a
    trial fails, the vertices beside the failure are restored and kept from then on.

    Args:
        good: the polygons that passed, of the contours of the trial.

    Returns:
        Numbers and polygons of the contours that are not finished.
    """
    which, places, offsets, points, bounds, gaps, _, _ = trial
    n = len(good.places)
    those, count, at = np.empty_like(which), 0, 0
    new = Good(
        np.empty(n), np.zeros(len(which) + 1, dtype=np.int64), np.empty((n, 2)), np.empty(n),
        np.empty(n, dtype=np.bool_), np.empty(n, dtype=np.bool_),
    )  # fmt: skip
    for i in range(len(which)):
        k, a, b, c, d = which[i], offsets[i], offsets[i + 1], good.offsets[i], good.offsets[i + 1]
        here, p, e, keep, needed = good.places[c:d], good.points[c:d], good.gaps[c:d], good.keep[c:d], good.needed[c:d]
        if bounds[a:b].max() <= near[k]:
            here, p, e, needed = places[a:b], points[a:b], gaps[a:b], needed[keep]
            keep = np.ones(b - a, dtype=np.bool_)
        else:
            back = put_back(p, keep, bounds[a:b], near[k], ratio)
            needed = needed | (back & ~keep)
            keep = back
        if keep.all():
            turns = contours.turns[contours.offsets[k] : contours.offsets[k + 1]]
            keep = sparse(p, here, turns, corner_angle, needed, e, near[k], ratio, power)
        if keep.all():
            continue
        those[count] = k
        stop = at + len(here)
        new.places[at:stop], new.points[at:stop], new.gaps[at:stop] = here, p, e
        new.keep[at:stop], new.needed[at:stop] = keep, needed
        count, at = count + 1, stop
        new.offsets[count] = stop
    return those[:count].copy(), Good(
        new.places[:at].copy(), new.offsets[: count + 1].copy(), new.points[:at].copy(), new.gaps[:at].copy(),
        new.keep[:at].copy(), new.needed[:at].copy(),
    )  # fmt: skip
