"""A certified bound of the two-sided distance between a written result and its source outline.

It looks only at the two chains of Bézier segments, as they are written, and knows nothing of how one was fitted
to the other.

Both contours are cut into the same number of *sections*, one after the other, so that section j of the result is
paired with section j of the source and each is a piece of one cubic. Let A and B be a pair's polynomials, both over
[0, 1]. Their difference at equal parameters is a cubic with Bézier points A_k - B_k, and lies in the convex hull of
these. So every point of A has a point of B within ``max |A_k - B_k|``, and the other way round; the largest of these
numbers bounds the two-sided (Hausdorff) distance of the contours, and their Fréchet distance too. This holds
for *every* way of cutting that runs once round both: hints and Newton's method only serve to make the bound sharp, and
sections are halved until it is.

Here any two stretches are paired, whatever lies between their ends. :mod:`.smooth.span_distance` pairs the spans of a
curve whose vertices are on the outline: from better guesses and less sharply, as every round of a fit asks it again.

Floating point: a Bézier point of a section is a convex combination, in three rounds, of points of size at most L, so
that its error is below 16 units in the last place of L. ``ROUNDING`` times L, far more than that,
is added to the bound.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..compiled import compiled
from ..curves.cubics import jet, length
from ..types import FloatArray

ROUNDING = 1e-14
"""Share of the largest coordinate added to the bound for floating point."""

COARSE = 8
"""Points a segment among which the nearest one is taken before Newton's method refines it."""

DEEPEST = 14
"""Most halvings of a section: a pair that still seems too far apart then is."""


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
    bounds, gaps = _pair_all(
        np.ascontiguousarray(result), np.ascontiguousarray(source), np.ascontiguousarray(anchors), sharpness, limit
    )
    return Distance(bounds + ROUNDING * max(extent(result), extent(source)), gaps)


@compiled
def extent(cubics: FloatArray) -> float:
    """The largest coordinate of (m, 4, 2) Bézier points."""
    most = 0.0
    for b in cubics:
        for k in range(4):
            most = max(most, abs(b[k, 0]), abs(b[k, 1]))
    return most


@compiled
def apart(A: FloatArray, B: FloatArray) -> tuple[float, float, float]:
    """The largest distance of the Bézier points (4, 2) of a pair, which bounds its own, and those of its two ends."""
    first, last = length(A[0, 0] - B[0, 0], A[0, 1] - B[0, 1]), length(A[3, 0] - B[3, 0], A[3, 1] - B[3, 1])
    most = max(first, last)
    for k in (1, 2):
        most = max(most, length(A[k, 0] - B[k, 0], A[k, 1] - B[k, 1]))
    return most, first, last


@compiled
def section(cubic: FloatArray, x0: float, x1: float, out: FloatArray) -> None:
    """Bézier points (4, 2) of a cubic between two parameters, by blossoming."""
    for c in range(2):
        a, b, d, e = cubic[0, c], cubic[1, c], cubic[2, c], cubic[3, c]
        for k in range(4):
            x = x1 if k > 2 else x0
            p, q, r = a + x * (b - a), b + x * (d - b), d + x * (e - d)
            x = x1 if k > 1 else x0
            p, q = p + x * (q - p), q + x * (r - q)
            x = x1 if k > 0 else x0
            out[k, c] = p + x * (q - p)


@compiled
def newton_step(at: float, slope: float, speed: float, bend: float, low: float, high: float) -> float:
    """Newton's next estimate of a nearest point, in [low, high]; Gauss and Newton's where the distance is not convex.

    Args:
        slope, bend: half the first and second derivative of the squared distance. speed: the square of it.
    """
    return min(max(at - slope / (bend if bend > 0.2 * speed else speed), low), high)


@compiled
def nearest(cubics: FloatArray, s: int, low: float, high: float, guess: float, x: float, y: float) -> float:
    """A parameter in [low, high] of cubic s near (x, y): Newton's method from a guess."""
    at = guess
    for _ in range(4):
        px, py, dx, dy, ax, ay = jet(cubics, s, at)
        speed = dx * dx + dy * dy
        bend = speed + (px - x) * ax + (py - y) * ay
        if speed <= 0:
            break
        before, at = at, newton_step(at, (px - x) * dx + (py - y) * dy, speed, bend, low, high)
        if abs(at - before) < 1e-7:
            break
    return at


@compiled
def nearest_place(cubics: FloatArray, low: float, high: float, x: float, y: float) -> float:
    """The place between two places of a closed chain that is nearest (x, y), as far as coarse points tell."""
    m = len(cubics)
    if high <= low:
        return low
    best, at = np.inf, low
    for s in range(int(np.floor(low)), int(np.ceil(high))):
        a, b = max(low - s, 0.0), min(high - s, 1.0)
        for k in range(COARSE + 1):
            z = a + (b - a) * k / COARSE
            px, py, _, _, _, _ = jet(cubics, s % m, z)
            d = (px - x) ** 2 + (py - y) ** 2
            if d < best:
                best, at = d, s + z
    s = min(int(np.floor(at)), int(np.ceil(high)) - 1)
    z = nearest(cubics, s % m, max(low - s, 0.0), min(high - s, 1.0), at - s, x, y)
    px, py, _, _, _, _ = jet(cubics, s % m, z)
    return s + z if (px - x) ** 2 + (py - y) ** 2 <= best else at


@compiled
def _pair_all(
    result: FloatArray, source: FloatArray, anchors: FloatArray, sharpness: float, limit: float
) -> tuple[FloatArray, FloatArray]:
    """Bounds and gaps between each anchor and the next."""
    n = len(anchors) - 1
    bounds, gaps = np.zeros(n), np.zeros(n)
    for k in range(n):
        a, s = anchors[k]
        a_end, s_end = anchors[k + 1]
        bounds[k], gaps[k] = pair(result, a, a_end, source, s, s_end, sharpness, limit)
    return bounds, gaps


@compiled
def pair(
    result: FloatArray, a: float, a_end: float, source: FloatArray, s: float, s_end: float, sharpness: float,
    limit: float,
) -> tuple[float, float]:  # fmt: skip
    """Bound and gap between two stretches; see :func:`certified_distance` for sharpness and limit."""
    bound, gap = _pair(result, a, a_end, source, s, s_end, sharpness)
    if bound > limit:
        other, gap_there = _pair(source, s, s_end, result, a, a_end, sharpness)
        if other < bound:
            return other, gap_there
    return bound, gap


@compiled
def _pair(
    result: FloatArray, a: float, a_end: float, source: FloatArray, s: float, s_end: float, sharpness: float
) -> tuple[float, float]:
    """Bound and gap between two stretches, cut where segments of the first end, at the second's nearest points."""
    r = len(result)
    bound, gap = 0.0, 0.0
    while True:
        i = int(np.floor(a))
        last = a_end <= i + 1
        if last:
            cut, partner = a_end, s_end
        else:
            cut = i + 1.0
            partner = nearest_place(source, s, s_end, result[i % r, 3, 0], result[i % r, 3, 1])
        bound, gap = _pair_segment(result, i % r, a - i, cut - i, source, s, partner, sharpness, bound, gap)
        if last:
            return bound, gap
        a, s = cut, partner


@compiled
def _pair_segment(
    result: FloatArray, i: int, x0: float, x_end: float, source: FloatArray, before: float, after: float,
    sharpness: float, bound: float, gap: float,
) -> tuple[float, float]:  # fmt: skip
    """Bound and gap between segment i of the result, from x0 to x_end, and the source from one place to another.

    They begin with those of what came before: what is below them need not be known sharply.
    """
    m = len(source)
    place = before
    while True:
        s = int(np.floor(place))
        last = after <= s + 1
        if last:
            x1, end = x_end, after - s
        else:
            end = 1.0
            x1 = nearest_place(result[i : i + 1], x0, x_end, source[s % m, 3, 0], source[s % m, 3, 1])
        bound, gap = _sections(result[i], x0, x1, source[s % m], place - s, end, sharpness, bound, gap)
        if last:
            return bound, gap
        x0, place = x1, s + 1.0


@compiled
def _sections(
    a: FloatArray, x0: float, x1: float, b: FloatArray, y0: float, y1: float, sharpness: float, bound: float, gap: float
) -> tuple[float, float]:
    """Bound and gap between two pieces of cubics, halved until the bound is sharp or as often as is allowed.

    They begin with those of what came before.
    """
    stack = np.empty((DEEPEST + 2, 5))
    stack[0, 0], stack[0, 1], stack[0, 2], stack[0, 3], stack[0, 4] = x0, x1, y0, y1, 0.0
    count = 1
    A, B = np.empty((4, 2)), np.empty((4, 2))
    whole = np.empty((1, 4, 2))
    whole[0] = b
    while count:
        count -= 1
        x0, x1, y0, y1, depth = stack[count]
        section(a, x0, x1, A)
        section(b, y0, y1, B)
        most, first, last = apart(A, B)
        gap = max(gap, max(first, last))
        if most <= max(bound, gap + sharpness) or depth >= DEEPEST:
            bound = max(bound, most)
            continue
        x = (x0 + x1) / 2
        section(a, x, x, A)
        y = nearest(whole, 0, y0, y1, (y0 + y1) / 2, A[0, 0], A[0, 1])
        stack[count, 0], stack[count, 1], stack[count, 2], stack[count, 3], stack[count, 4] = x, x1, y, y1, depth + 1
        count += 1
        stack[count, 0], stack[count, 1], stack[count, 2], stack[count, 3], stack[count, 4] = x0, x, y0, y, depth + 1
        count += 1
    return bound, gap
