"""A certified bound of the two-sided distance between a written result and its source outline.

Both contours are cut into the same number of *sections*, one after the other, so that section j of the result is
paired with section j of the source and each is a piece of one cubic. The Bézier points of a pair bound their distance
(:mod:`..curves.paired`), and the largest of these numbers bounds the two-sided (Hausdorff) distance of the contours and
their Fréchet distance. This holds for *every* subdivision that runs once round both: hints and Newton's method only
make the bound sharp, and sections are halved until it is.

:func:`certified_distance` pairs any two stretches, from coarse guesses. :func:`measure_spans` pairs the spans of a
closed curve whose vertices are on the outline: from better guesses and only as sharply as asked, because every round of
a smooth fit measures all spans.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..compiled import compiled
from ..curves.cubics import extent, jet, length, nearest, nearest_place, section, split
from ..curves.paired import ROUNDING, points_apart
from ..types import FloatArray, IntArray

SHARPNESS = 0.02
"""The certified bound may exceed the distances seen by this share of the tolerance."""

DEEPEST = 14
"""Maximum subdivision depth; pairs still above the limit there count as too far apart."""


MOST_HALVINGS = 5_000
"""Halvings of one stretch, after which what is left counts as too far apart: a wrong pairing would take seconds."""


@dataclass(frozen=True, eq=False)
class Distance:
    """Two-sided distance of a result from its source, in font units.

    Attributes:
        bounds: (a - 1,) certified bound between each anchor and the next.
        gaps: (a - 1,) largest distance seen between paired points: what ``bounds`` overestimates.
    """

    bounds: FloatArray
    gaps: FloatArray

    @property
    def bound(self) -> float:
        """Certified bound for the whole contour."""
        return float(self.bounds.max(initial=0.0))

    @property
    def measured(self) -> float:
        """Largest distance seen."""
        return float(self.gaps.max(initial=0.0))


def certified_distance(
    result: FloatArray, source: FloatArray, anchors: FloatArray, sharpness: float, limit: float = 0.0
) -> Distance:
    """Bound the two-sided distance between two closed chains of cubics.

    Args:
        result: (r, 4, 2) the result; source: (m, 4, 2) the source.
        anchors: (a, 2) *places* (segment + local parameter, counted on past the last segment) of the result and of the
            source that are taken to belong together. Neither column decreases; the last row is the first one a
            lap (r, m) later, and the first one lies in the first lap.
        sharpness: halve sections until the bound exceeds the gaps seen by no more than this.
        limit: where the bound is above it, pair again with the roles exchanged, and take the better of the two.
    """
    ends = np.array([0, len(result)]), np.array([0, len(source)]), np.array([0, len(anchors)])
    result, source, anchors = map(np.ascontiguousarray, (result, source, anchors))
    return Distance(*pair_stretches(result, ends[0], source, ends[1], anchors, ends[2], sharpness, limit))


@compiled
def pair_stretches(
    results: FloatArray, result_offsets: IntArray, sources: FloatArray, source_offsets: IntArray, anchors: FloatArray,
    anchor_offsets: IntArray, sharpness: float, limit: float,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """Bounds and gaps between each anchor and the next, of contours end to end; see :func:`certified_distance`.

    A stretch is cut where segments of the one contour end, at the nearest points of the other.
    """
    n = len(anchors) - len(anchor_offsets) + 1
    bounds, gaps = np.empty(n), np.empty(n)
    work, marks = np.empty((2, DEEPEST + 2, 4, 2)), np.empty((DEEPEST + 2, 3))
    for c in range(len(anchor_offsets) - 1):
        result = results[result_offsets[c] : result_offsets[c + 1]]
        source = sources[source_offsets[c] : source_offsets[c + 1]]
        rounding = ROUNDING * max(extent(result), extent(source))
        for k in range(anchor_offsets[c], anchor_offsets[c + 1] - 1):
            bounds[k - c], gaps[k - c] = np.inf, 0.0
            for exchanged in range(2):
                one, other = (source, result) if exchanged else (result, source)
                x, x_end = anchors[k, exchanged], anchors[k + 1, exchanged]
                y, y_end = anchors[k, 1 - exchanged], anchors[k + 1, 1 - exchanged]
                bound = gap = where = 0.0
                last = False
                while not last:
                    i = int(np.floor(x))
                    s = i % len(one)
                    last = x_end <= i + 1
                    cut, partner = x_end, y_end
                    if not last:
                        cut = i + 1.0
                        partner = nearest_place(other, y, y_end, one[s, 3, 0], one[s, 3, 1])
                    bound, gap, where = pair_cubic(
                        one, s, x - i, cut - i, other, y, partner, True, -1.0, sharpness, bound, gap, where, work, marks
                    )
                    x, y = cut, partner
                if bound + rounding < bounds[k - c]:
                    bounds[k - c], gaps[k - c] = bound + rounding, gap
                if bounds[k - c] <= limit:
                    break
    return bounds, gaps


@compiled
def pair_cubic(
    cubics: FloatArray, i: int, x: float, x_end: float, outline: FloatArray, y: float, y_end: float, coarse: bool,
    enough: float, sharpness: float, bound: float, gap: float, where: float, work: FloatArray, marks: FloatArray,
) -> tuple[float, float, float]:  # fmt: skip
    """Distance of a section of one cubic from a stretch of a closed chain.

    Args:
        cubics: (n, 4, 2), of which number i is measured from parameter x to x_end.
        outline: (m, 4, 2); y, y_end: places on it.
        coarse: search the cubic for the points nearest to the outline's joints; or else begin from a proportional
            guess, and halve every pair once, so that a gap is seen between its ends.
        enough: bounds up to this are not refined; nor are bounds within ``sharpness`` of a larger gap already seen.
        bound, gap, where: results of earlier sections; smaller values are not refined.
        work, marks: (2, DEEPEST + 2, 4, 2) and (DEEPEST + 2, 3) scratch arrays.

    Returns:
        The bound, without rounding; the largest distance seen between paired points; and its place on the outline.
    """
    m = len(outline)
    least = 0 if coarse else 1
    last, halvings = False, 0
    while not last:
        s = int(np.floor(y))
        last = y_end <= s + 1
        stop, cut = y_end, x_end
        if not last:
            stop = s + 1.0
            px, py = outline[s % m, 3, 0], outline[s % m, 3, 1]
            if coarse:
                cut = nearest_place(cubics[i : i + 1], x, x_end, px, py)
            else:
                cut = nearest(cubics[i], x, x_end, x + (x_end - x) * (stop - y) / (y_end - y), px, py)
        section(cubics[i], x, cut, work[0, 0])
        section(outline[s % m], y - s, stop - s, work[1, 0])
        # A stack of pairs; marks: first and last place on the outline, and depth.
        marks[0, 0], marks[0, 1], marks[0, 2] = y, stop, 0.0
        top = 0
        while top >= 0:
            A, B = work[0, top], work[1, top]
            low, high, depth = marks[top, 0], marks[top, 1], marks[top, 2]
            first, end = length(A[0, 0] - B[0, 0], A[0, 1] - B[0, 1]), length(A[3, 0] - B[3, 0], A[3, 1] - B[3, 1])
            most = max(first, end, points_apart(A, B, 1, 3))
            if first > gap:
                gap, where = first, low
            if end > gap:
                gap, where = end, high
            limit = max(enough, bound)
            if gap > enough:
                limit = max(limit, gap + sharpness)
            if depth >= least and (most <= limit or depth >= DEEPEST or halvings >= MOST_HALVINGS):
                bound = max(bound, most)
                top -= 1
                continue
            halvings += 1
            split(A, 0.5, work[0, top + 1])
            z = nearest(B, 0.0, 1.0, 0.5, A[0, 0], A[0, 1])
            split(B, z, work[1, top + 1])
            middle = low + z * (high - low)
            marks[top, 0], marks[top, 2] = middle, depth + 1
            top += 1
            marks[top, 0], marks[top, 1], marks[top, 2] = low, middle, depth + 1
        x, y = cut, stop
    return bound, gap, where


@compiled
def near_place(cubics: FloatArray, place: float, low: float, high: float, x: float, y: float) -> float:
    """The place in [low, high] of a closed chain near which (x, y) has its nearest point, from one in between."""
    m = len(cubics)
    best, at = np.inf, place
    for step in range(2):
        here = place
        for _ in range(3):
            s = int(np.floor(here))
            if step == 1 and s == here:
                s -= 1
            a, b = max(low, float(s)), min(high, s + 1.0)
            if b <= a:
                break
            z = nearest(cubics[s % m], a - s, b - s, here - s, x, y)
            px, py, _, _, _, _ = jet(cubics, s % m, z)
            d = (px - x) ** 2 + (py - y) ** 2
            if d < best:
                best, at = d, s + z
            end = b if step == 0 else a
            if s + z != end or end in (low, high):
                break
            here = end
        if place != np.floor(place) and at != np.floor(place):  # it may lie in the segment before
            break
    return at


@compiled
def measure_spans(
    pieces: FloatArray, outline: FloatArray, places: FloatArray, enough: float, sharpness: float, bounds: FloatArray,
    gaps: FloatArray, worst: FloatArray, ends: FloatArray,
) -> None:  # fmt: skip
    """Distance of every span of a closed curve from the stretch of outline between the points nearest to its ends.

    Args:
        pieces: (n, 4, 2) the curve's spans; the one after vertex i is number i. outline: (m, 4, 2).
        places: (n,) the vertices on it, increasing, within a lap.
        enough, sharpness: see :func:`pair_cubic`.
        bounds, gaps, worst: (n,) receive certified bounds, gaps seen, and the places of these on the outline.
        ends: (n + 1,) receives where each stretch of outline begins.
    """
    work, marks = np.empty((2, DEEPEST + 2, 4, 2)), np.empty((DEEPEST + 2, 3))
    n, m = len(places), len(outline)
    rounding = ROUNDING * max(extent(pieces), extent(outline))
    for i in range(n):
        before = places[i - 1] if i > 0 else places[n - 1] - m
        after = places[i + 1] if i + 1 < n else places[0] + m
        low, high = (before + places[i]) / 2, (places[i] + after) / 2
        ends[i] = near_place(outline, places[i], low, high, pieces[i, 0, 0], pieces[i, 0, 1])
    ends[n] = ends[0] + m
    for i in range(n):
        bound, gaps[i], worst[i] = pair_cubic(
            pieces, i, 0.0, 1.0, outline, ends[i], ends[i + 1], False, enough - rounding, sharpness, 0.0, 0.0,
            (ends[i] + ends[i + 1]) / 2, work, marks,
        )  # fmt: skip
        bounds[i] = bound + rounding


@compiled
def sharpen_spans(
    pieces: FloatArray, outline: FloatArray, bounds: FloatArray, gaps: FloatArray, ends: FloatArray, sharpness: float
) -> tuple[float, float]:
    """Bound and gap of a contour from the results of :func:`measure_spans`, within ``sharpness`` of each other."""
    work, marks = np.empty((2, DEEPEST + 2, 4, 2)), np.empty((DEEPEST + 2, 3))
    rounding = ROUNDING * max(extent(pieces), extent(outline))
    left, bound, gap = bounds.copy(), 0.0, 0.0
    for i in range(len(gaps)):
        gap = max(gap, gaps[i])
    while True:
        i = len(left) - 1
        for k in range(i):
            if left[k] > left[i]:
                i = k
        enough = max(bound, gap + sharpness)
        if left[i] <= enough:
            return max(bound, left[i]), gap
        sharper, seen, _ = pair_cubic(
            pieces, i, 0.0, 1.0, outline, ends[i], ends[i + 1], False, enough - rounding, sharpness, 0.0, 0.0, 0.0,
            work, marks,
        )  # fmt: skip
        gap, bound = max(gap, seen), max(bound, sharper + rounding)
        left[i] = 0.0
