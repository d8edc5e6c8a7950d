"""The vertices of a contour laid anew where the curve through them is too far off: more, and as evenly as the first.

The field (see :mod:`.spacing`) is lowered where spans fail, and the stretches between corners in which one does are
laid again. A vertex put into a span would leave chords of half the length beside whole ones, which the curve answers
with a wobble, which fails in turn: a round letter took twice the vertices, with a curvature extremum at each.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.sorting import in_order
from ...types import BoolArray, FloatArray, IntArray
from .canonical_contours import TABLE
from .spacing import FEWEST, lay, limit_growth, spans_for, spans_in, steps_of

POWER = 0.25
"""Between corners and jumps, the error of a span grows with the fourth power of its length."""

BELOW = 0.95
"""Share of the length by which a failed span would just pass that is tried."""

LEAST = 0.4
"""Share of its length by which a span that is many times too far off is tried again."""


@compiled
def vertices_at_corners(places: FloatArray, turns: FloatArray, corner_angle: float) -> IntArray:
    """The vertices of a contour that lie at corners; without one, that at the first joint, if there is one."""
    at, count = np.empty(len(places), dtype=np.int64), 0
    for i in range(len(places)):
        j = int(places[i])
        if places[i] == j and turns[j] >= corner_angle:
            at[count] = i
            count += 1
    if count == 0 and places[0] == 0.0:
        at[0], count = 0, 1
    return at[:count]


@compiled
def failed(corners: IntArray, errors: FloatArray, near: float) -> tuple[BoolArray, BoolArray]:
    """The stretches from each vertex at a corner to the next in which a span fails, and (n,) the vertices of these."""
    n, count = len(errors), len(corners)
    fails, inside = np.zeros(count, dtype=np.bool_), np.zeros(n, dtype=np.bool_)
    for k in range(count):
        spans = spans_after(corners, k, n)
        for j in range(spans):
            fails[k] = fails[k] or errors[(corners[k] + j) % n] > near
        for j in range(spans + 1 if fails[k] else 0):
            inside[(corners[k] + j) % n] = True
    return fails, inside


@compiled
def spans_after(corners: IntArray, k: int, n: int) -> int:
    """The number of spans of stretch k; one corner alone has all n."""
    return (corners[(k + 1) % len(corners)] - corners[k] - 1) % n + 1


@compiled
def relaid(
    field: FloatArray, lengths: FloatArray, places: FloatArray, corners: IntArray, errors: FloatArray, near: float,
    growth: float,
) -> FloatArray:  # fmt: skip
    """The places, increasing, with those of each stretch in which a span fails laid anew, by a field that is lowered.

    Args:
        field: (m TABLE + 1,), which changes. places: (n,) of the vertices. corners: see :func:`vertices_at_corners`.
        errors: (n,) of the span after each vertex. near: distance allowed.
        growth: logarithm of the factor by which chords grow at most.
    """
    n, count = len(places), len(corners)
    fails, _ = failed(corners, errors, near)
    shares, steps = np.ones(n), steps_of(field, lengths)
    for k in range(count):
        if fails[k]:
            spans, whole = spans_after(corners, k, n), whole_of(steps, places, corners, k)
            for j in range(spans):
                i = (corners[k] + j) % n
                if errors[i] > near:
                    # Chords are shorter than the field by this much, for their number to be whole.
                    shares[i] = max(BELOW * (near / errors[i]) ** POWER, LEAST) * min(whole / spans, 1.0)
    lower(field, places, shares)
    limit_growth(field, lengths, growth)
    steps = steps_of(field, lengths)
    parts, total = np.empty(count, dtype=np.int64), 0
    for k in range(count):
        parts[k] = spans_for(whole_of(steps, places, corners, k)) if fails[k] else spans_after(corners, k, n)
        total += parts[k]
    if total < FEWEST:
        for k in range(count):
            if fails[k]:
                total += (FEWEST - 1) * parts[k]
                parts[k] *= FEWEST
    new, at = np.empty(total), 0
    for k in range(count):
        if fails[k]:
            whole = whole_of(steps, places, corners, k)
            lay(field, steps, int(places[corners[k]]), whole, parts[k], new[at : at + parts[k]])
        else:
            for j in range(parts[k]):
                new[at + j] = places[(corners[k] + j) % n]
        at += parts[k]
    return in_order(new)


@compiled
def whole_of(steps: FloatArray, places: FloatArray, corners: IntArray, k: int) -> float:
    """The integral of 1/field over stretch k."""
    return spans_in(steps, int(places[corners[k]]), int(places[corners[(k + 1) % len(corners)]]))


@compiled
def lower(field: FloatArray, places: FloatArray, shares: FloatArray) -> None:
    """Multiply a field by a share over each span, which comes to 1 over the spans beside it."""
    n, entries, before = len(places), len(field) - 1, field.copy()
    for i in range(n):
        start, stop = places[i] * TABLE, places[(i + 1) % n] * TABLE
        if i == n - 1:
            stop += entries
        last, here, after = shares[i - 1], shares[i], shares[(i + 1) % n]
        if min(last, min(here, after)) < 1:
            for e in range(int(np.floor(start)), int(np.ceil(stop)) + 1):
                x = min(max((e - start) / (stop - start), 0.0), 1.0)
                share = min(here, min(last + x * (1 - last), 1 - x * (1 - after)))
                field[e % entries] = min(field[e % entries], share * before[e % entries])
    field[entries] = field[0]
