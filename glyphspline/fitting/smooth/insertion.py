"""More places for the vertices of a contour: where the curve through those it has is too far off, and graded."""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.sorting import in_order
from ...types import FloatArray
from ..closed_curves import chords_of
from .canonical_contours import TABLE, length_at, place_at, points_at

MOST_VERTICES = 2000
"""A contour's polygon grows no larger than this by refinement."""

SHORTEST = 1e-5
"""No span shorter than this share of the contour is divided: it would end in duplicate vertices."""

NEAR_RATIO = 0.98
"""Share of the ratio allowed that a chord cut off beside a shorter one has to it."""

MARGIN = 0.3
"""Share of a span at either end where it is not divided."""


@compiled
def spans_of(lengths: FloatArray, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(n,) length along the contour at which each place lies, and to the next one."""
    n = len(places)
    at, h = np.empty(n), np.empty(n)
    for i in range(n):
        at[i] = length_at(lengths, places[i])
    for i in range(n - 1):
        h[i] = at[i + 1] - at[i]
    h[n - 1] = at[0] + lengths[-1, TABLE] - at[n - 1]
    return at, h


@compiled
def with_more(
    lengths: FloatArray, places: FloatArray, errors: FloatArray, worst: FloatArray, near: float
) -> FloatArray:
    """The places with more in each span whose error exceeds ``near`` and its neighbours'; the same if there is none.

    A vertex is put at the span's worst place, or as near to it as the middle two fifths. A span that is many times too
    far off is divided evenly into three or four.
    """
    at, h = spans_of(lengths, places)
    n, m = len(places), len(lengths)
    total = lengths[-1, TABLE]
    new = np.empty(4 * n)
    count = 0
    for i in range(n):
        new[count] = places[i]
        count += 1
        if not (errors[i] > near and h[i] > SHORTEST * total):
            continue
        # What is wrong with a span is most often wrong with its worse neighbour.
        if errors[i] < max(errors[i - 1], errors[(i + 1) % n]):
            continue
        parts = 2 if errors[i] < 6 * near else (3 if errors[i] < 30 * near else 4)
        for part in range(1, parts):
            share = part / parts
            if parts == 2:
                share = (length_at(lengths, worst[i]) - at[i]) / h[i]
                share = min(max(share, MARGIN), 1 - MARGIN)
            new[count] = place_at(lengths, at[i] + share * h[i]) % m
            count += 1
    return in_order(new[:count])


@compiled
def graded(cubics: FloatArray, lengths: FloatArray, places: FloatArray, ratio: float) -> FloatArray:
    """The places with chords cut where they are more than ``ratio`` times a neighbour, until none is.

    Up to a ratio of 4 this certifies convergence before the interpolation is run (Theorem 2).
    """
    total = lengths[-1, TABLE]
    while True:
        n = len(places)
        chords, even = chords_of(points_at(cubics, places), ratio)
        if n > MOST_VERTICES or even:
            return places
        at, h = spans_of(lengths, places)
        new = np.empty(2 * n)
        count = 0
        for i in range(n):
            new[count] = places[i]
            count += 1
            before, after = chords[i - 1], chords[(i + 1) % n]
            if chords[i] > ratio * min(before, after) and h[i] > SHORTEST * total:
                cut = min(NEAR_RATIO * ratio * min(before, after) / chords[i], 0.5)
                share = cut if before <= after else 1 - cut
                new[count] = place_at(lengths, at[i] + share * h[i]) % len(lengths)
                count += 1
        if count == n:
            return places
        places = in_order(new[:count])
