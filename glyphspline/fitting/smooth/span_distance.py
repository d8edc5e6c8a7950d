"""How far a closed curve is from its outline, span by span: a certified bound, and the place where it is worst.

The certificate is that of :mod:`..certified_distance`: both contours are cut into the same number of sections, each a
piece of one cubic, and the largest distance of Bézier points of a pair bounds its two-sided distance. Here sections
come by halving with de Casteljau's rule, a pair is let go as soon as its bound is small enough, and a span of the
curve, from one knot to the next, goes with the stretch of outline between the points nearest to its ends.

Floating point: a Bézier point is a convex combination of convex combinations, three for a section and three for each
halving, of points of size at most L. ``ROUNDING`` times L, more than ``DEEPEST`` such triples can cost, is to be
added to a bound.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet
from ...types import FloatArray
from ..certified_distance import apart, extent, newton_step, section

ROUNDING = 1e-13
"""Share of the largest coordinate added to the bound for floating point."""

DEEPEST = 12
"""Most halvings of a section."""

NEWTON_STEPS = 4


@compiled
def closest(cubic: FloatArray, low: float, high: float, guess: float, x: float, y: float) -> float:
    """A parameter in [low, high] of a cubic (4, 2) near (x, y): Newton's method from a guess.

    As :func:`..certified_distance.nearest`, in fewer products and ended sooner: halving asks it again and again.
    """
    at = guess
    for _ in range(NEWTON_STEPS):
        z = 1 - at
        ax, ay = cubic[1, 0] - cubic[0, 0], cubic[1, 1] - cubic[0, 1]
        bx, by = cubic[2, 0] - cubic[1, 0], cubic[2, 1] - cubic[1, 1]
        cx, cy = cubic[3, 0] - cubic[2, 0], cubic[3, 1] - cubic[2, 1]
        lx, ly, rx, ry = z * ax + at * bx, z * ay + at * by, z * bx + at * cx, z * by + at * cy
        dx, dy = 3 * (z * lx + at * rx), 3 * (z * ly + at * ry)
        # q = z² (z p0 + 3 at p1) + at² (3 z p2 + at p3)
        qx = z * z * (z * cubic[0, 0] + 3 * at * cubic[1, 0]) + at * at * (3 * z * cubic[2, 0] + at * cubic[3, 0]) - x
        qy = z * z * (z * cubic[0, 1] + 3 * at * cubic[1, 1]) + at * at * (3 * z * cubic[2, 1] + at * cubic[3, 1]) - y
        speed = dx * dx + dy * dy
        if speed <= 0:
            break
        bend = speed + 6 * (qx * (rx - lx) + qy * (ry - ly))
        before, at = at, newton_step(at, qx * dx + qy * dy, speed, bend, low, high)
        if abs(at - before) < 1e-6:
            break
    return at


@compiled
def partner(cubics: FloatArray, place: float, low: float, high: float, x: float, y: float) -> float:
    """The place in [low, high] of a closed chain near which (x, y) has its nearest point, from one in between."""
    m = len(cubics)
    best, at = np.inf, place
    for direction in (1, -1):
        here = place
        for _ in range(3):
            s = int(np.floor(here))
            if direction < 0 and s == here:
                s -= 1
            a, b = max(low, float(s)), min(high, s + 1.0)
            if b <= a:
                break
            z = closest(cubics[s % m], a - s, b - s, here - s, x, y)
            px, py, _, _, _, _ = jet(cubics, s % m, z)
            d = (px - x) ** 2 + (py - y) ** 2
            if d < best:
                best, at = d, s + z
            end = b if direction > 0 else a
            if s + z != end or end in (low, high):
                break
            here = end
        if place != np.floor(place):
            break
    return at


@compiled
def stretches(pieces: FloatArray, cubics: FloatArray, places: FloatArray, ends: FloatArray) -> None:
    """Where on the outline the spans of a closed curve begin, into ``ends`` (n + 1,): near the vertices, in order.

    Args:
        pieces: (n, 4, 2) the curve's spans; the one after vertex i is number i.
        cubics: (m, 4, 2) the outline.
        places: (n,) the vertices on it, increasing, within a lap.
    """
    n, m = len(places), len(cubics)
    for i in range(n):
        before = places[i - 1] if i > 0 else places[n - 1] - m
        after = places[i + 1] if i + 1 < n else places[0] + m
        low, high = (before + places[i]) / 2, (places[i] + after) / 2
        ends[i] = partner(cubics, places[i], low, high, pieces[i, 0, 0], pieces[i, 0, 1])
    ends[n] = ends[0] + m


@compiled
def span_distance(
    piece: FloatArray, cubics: FloatArray, start: float, end: float, enough: float, sharpness: float,
    work: FloatArray, marks: FloatArray,
) -> tuple[float, float, float]:  # fmt: skip
    """Distance of a span of the curve from a stretch of outline.

    Args:
        piece: (4, 2). cubics: (m, 4, 2) the outline; start, end: places on it.
        enough: bounds up to this are not made sharper. Where a larger gap has been seen, nor are bounds that exceed
            that by ``sharpness`` or less.
        work, marks: (2, DEEPEST + 2, 4, 2) and (DEEPEST + 2, 3) room for sections.

    Returns:
        The certified bound, the largest distance seen between paired points, and its place on the outline.
    """
    m = len(cubics)
    bound, gap, where = 0.0, 0.0, (start + end) / 2
    x, y = 0.0, start
    while True:
        s = int(np.floor(y))
        last = end <= s + 1
        stop = end if last else s + 1.0
        cut = 1.0
        if not last:
            guess = x + (1 - x) * (stop - y) / (end - y)
            cut = closest(piece, x, 1.0, guess, cubics[s % m, 3, 0], cubics[s % m, 3, 1])
        section(piece, x, cut, work[0, 0])
        section(cubics[s % m], y - s, stop - s, work[1, 0])
        bound, gap, where = _halve(work, marks, y, stop, enough, sharpness, bound, gap, where)
        if last:
            return bound, gap, where
        x, y = cut, stop


@compiled
def _halve(
    work: FloatArray, marks: FloatArray, start: float, end: float, enough: float, sharpness: float, bound: float,
    gap: float, where: float,
) -> tuple[float, float, float]:  # fmt: skip
    """The same of two sections, in ``work[:, 0]``, halved until the bound is small enough; a first time anyhow."""
    marks[0, 0], marks[0, 1], marks[0, 2] = start, end, 0.0
    top = 0
    while top >= 0:
        A, B = work[0, top], work[1, top]
        low, high, depth = marks[top]
        most, first, last = apart(A, B)
        if first > gap:
            gap, where = first, low
        if last > gap:
            gap, where = last, high
        limit = max(enough, bound)
        if gap > enough:
            limit = max(limit, gap + sharpness)
        if depth > 0 and (most <= limit or depth >= DEEPEST):
            bound = max(bound, most)
            top -= 1
            continue
        _split(A, 0.5, work[0, top + 1])
        y = closest(B, 0.0, 1.0, 0.5, A[0, 0], A[0, 1])
        _split(B, y, work[1, top + 1])
        middle = low + y * (high - low)
        marks[top, 0], marks[top, 2] = middle, depth + 1
        top += 1
        marks[top, 0], marks[top, 1], marks[top, 2] = low, middle, depth + 1
    return bound, gap, where


@compiled
def _split(c: FloatArray, x: float, first: FloatArray) -> None:
    """Cut a cubic: its part before x into ``first``, that after x in its own place."""
    for k in range(2):
        a, b, d, e = c[0, k], c[1, k], c[2, k], c[3, k]
        ab, bd, de = a + x * (b - a), b + x * (d - b), d + x * (e - d)
        abd, bde = ab + x * (bd - ab), bd + x * (de - bd)
        middle = abd + x * (bde - abd)
        first[0, k], first[1, k], first[2, k], first[3, k] = a, ab, abd, middle
        c[0, k], c[1, k], c[2, k], c[3, k] = middle, bde, de, e


@compiled
def check(
    pieces: FloatArray, cubics: FloatArray, places: FloatArray, enough: float, sharpness: float, bounds: FloatArray,
    gaps: FloatArray, worst: FloatArray, ends: FloatArray,
) -> None:  # fmt: skip
    """:func:`span_distance` of every span of a closed curve, into ``bounds``, ``gaps`` and ``worst``, (n,) each.

    Where each stretch of outline begins goes into ``ends``, (n + 1,).
    """
    work, marks = np.empty((2, DEEPEST + 2, 4, 2)), np.empty((DEEPEST + 2, 3))
    stretches(pieces, cubics, places, ends)
    for i in range(len(places)):
        bounds[i], gaps[i], worst[i] = span_distance(
            pieces[i], cubics, ends[i], ends[i + 1], enough, sharpness, work, marks
        )


@compiled
def sharpened(
    pieces: FloatArray, cubics: FloatArray, bounds: FloatArray, gaps: FloatArray, ends: FloatArray, sharpness: float
) -> tuple[float, float]:
    """Bound and gap of a whole contour, from what :func:`check` left, the first within ``sharpness`` of the second."""
    work, marks = np.empty((2, DEEPEST + 2, 4, 2)), np.empty((DEEPEST + 2, 3))
    gap, bound = gaps.max(), 0.0
    for i in np.argsort(-bounds):
        enough = max(bound, gap + sharpness)
        if bounds[i] > enough:
            bounds[i], gaps[i], _ = span_distance(
                pieces[i], cubics, ends[i], ends[i + 1], enough, sharpness, work, marks
            )
            gap = max(gap, gaps[i])
        bound = max(bound, bounds[i])
    return bound + ROUNDING * max(extent(pieces), extent(cubics)), gap
