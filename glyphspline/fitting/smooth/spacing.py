"""First places for the vertices of a contour, even: how far apart they may lie, by what is known of the outline.

A *field* says at every point how long a chord may be there. Three things bound it, each measured on the curve of a
model outline:

- a corner of angle θ between straight legs, chords growing by 4 away from it: variant 2 is off by 0.0575 sin θ times
  the chord beside the corner, and by less further out. Variant 3, whose spans further out would be worse, is off by
  0.09 sin θ if chords grow by 2.5;
- a jump Δκ of curvature: off by up to 0.03 Δκ h², h the chord;
- curvature κ itself: off by some 0.004 (κ³ + |κ''|) h⁴.

Away from its bounds the field grows by ``log(growth)`` a unit of length: chords laid end to end along such a field grow
by the factor ``growth``. Vertices lie at all corners and, between two, where the integral of 1/field is whole.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet
from ...curves.sorting import in_order
from ...types import FloatArray, IntArray
from .canonical_contours import TABLE

AT_CORNER, AT_JUMP, AT_CURVATURE = 0.065, 0.03, 0.004
"""The three numbers, with something to spare at corners, where a span that just fails costs a vertex."""

GROWTH, FASTEST = 0.97, 4.0
"""Share of the ratio allowed by which chords grow, and the ratio beyond which faster growth takes more of them."""

AT_CORNER_3, GROWTH_3 = 0.1, 2.5
"""The same for variant 3."""

FLATTEST = 0.1
"""Corners count as if the sine of their angle were at least this."""

BEND = 2.5
"""A chord turns by no more than this, in radians, unless it is as short as the tolerance."""

SPARE = 0.05
"""Share of a vertex by which an integral may exceed a whole number without one more."""

FEWEST = 4
"""Vertices a contour has at least."""


@compiled
def first_field(
    cubics: FloatArray, lengths: FloatArray, turns: FloatArray, corner_angle: float, ratio: float, near: float,
    variant: int, field: FloatArray,
) -> None:  # fmt: skip
    """Write the field of a contour, at all entries of ``lengths`` in turn.

    Args:
        cubics: (m, 4, 2). lengths, turns: as :class:`.canonical_contours.CanonicalContours` has them.
        corner_angle: turn in radians from which a joint is a vertex. ratio: at most, of adjacent chords.
        near: distance allowed, in font units. field: (m TABLE + 1,).
    """
    factor, at_corner = growth_of(ratio, variant), AT_CORNER_3 if variant == 3 else AT_CORNER
    first = np.log(factor) / (factor - 1)  # the field at a corner, for chords that begin with 1 and grow by the factor
    write_bounds(cubics, lengths, turns, first / at_corner, near, field)
    total, corners = lengths[-1, TABLE], corners_of(turns, corner_angle)
    for k in range(len(corners)):
        a, b = corners[k], corners[(k + 1) % len(corners)]
        reach = lengths[b, 0] - lengths[a, 0] + (total if b <= a else 0.0)
        for j in (a, b):
            field[j * TABLE] = min(field[j * TABLE], first * reach)
    limit_growth(field, lengths, np.log(factor))


@compiled
def growth_of(ratio: float, variant: int) -> float:
    """The factor by which chords grow at most."""
    return GROWTH * min(ratio, GROWTH_3 / GROWTH if variant == 3 else FASTEST)


@compiled
def corners_of(turns: FloatArray, corner_angle: float) -> IntArray:
    """The joints at which a contour has corners; the first joint if it has none."""
    corners, count = np.empty(len(turns), dtype=np.int64), 0
    for j in range(len(turns)):
        if turns[j] >= corner_angle:
            corners[count] = j
            count += 1
    if count == 0:
        corners[0], count = 0, 1
    return corners[:count]


@compiled
def limit_growth(field: FloatArray, lengths: FloatArray, growth: float) -> None:
    """Lower a field until it nowhere grows faster than ``growth`` a unit of length, round the contour."""
    n = len(field) - 1
    field[n] = field[0] = min(field[0], field[n])
    for _ in range(2):
        for i in range(n):
            j, k = i // TABLE, i % TABLE
            field[i + 1] = min(field[i + 1], field[i] + growth * (lengths[j, k + 1] - lengths[j, k]))
        field[0] = field[n]
        for i in range(n - 1, -1, -1):
            j, k = i // TABLE, i % TABLE
            field[i] = min(field[i], field[i + 1] + growth * (lengths[j, k + 1] - lengths[j, k]))
        field[n] = field[0]


@compiled
def write_bounds(
    cubics: FloatArray, lengths: FloatArray, turns: FloatArray, at_corner: float, near: float, field: FloatArray
) -> None:
    """Write a field as it is before its growth is limited."""
    m = len(cubics)
    curvature = np.empty((m, TABLE + 1))
    for i in range(m * TABLE + 1):
        field[i] = lengths[-1, TABLE] / FEWEST
    for j in range(m):
        kappa, s = curvature[j], lengths[j]
        ax, ay = cubics[j, 3, 0] - cubics[j, 0, 0], cubics[j, 3, 1] - cubics[j, 0, 1]
        off = 0.0
        for k in range(1, 3):
            off = max(off, abs(ax * (cubics[j, k, 1] - cubics[j, 0, 1]) - ay * (cubics[j, k, 0] - cubics[j, 0, 0])))
        straight = off <= 1e-9 * (ax * ax + ay * ay)
        for k in range(TABLE + 1):
            kappa[k] = 0.0
            if not straight:
                _, _, dx, dy, bx, by = jet(cubics, j, k / TABLE)
                speed = np.sqrt(dx * dx + dy * dy)
                kappa[k] = (dx * by - dy * bx) / speed**3 if speed > 0 else 0.0
        for k in range(0 if straight else TABLE + 1):
            c = min(max(k, 1), TABLE - 1)
            before, after = s[c] - s[c - 1], s[c + 1] - s[c]
            change = 0.0
            if before > 0 and after > 0:
                slope = (kappa[c + 1] - kappa[c]) / after - (kappa[c] - kappa[c - 1]) / before
                change = 2 * abs(slope) / (before + after)
            bend = abs(kappa[k])
            h = (near / (AT_CURVATURE * (change + bend**3) + 1e-300)) ** 0.25
            if bend > 0:
                h = min(h, BEND / bend)
            at = j * TABLE + k
            field[at] = min(field[at], max(h, near))
    for j in range(m):
        h = at_corner * near / max(np.sin(turns[j]), FLATTEST) if turns[j] > 0.01 else np.inf
        jump = abs(curvature[j, 0] - curvature[j - 1, TABLE])
        if jump > 0:
            h = min(h, max(np.sqrt(near / (AT_JUMP * jump)), near))
        field[j * TABLE] = min(field[j * TABLE], h)


@compiled
def steps_of(field: FloatArray, lengths: FloatArray) -> FloatArray:
    """(m TABLE,) the integral of 1/field, which goes linearly from one entry to the next, over each step."""
    steps = np.empty(len(field) - 1)
    for i in range(len(steps)):
        j, k = i // TABLE, i % TABLE
        a, b, h = field[i], field[i + 1], lengths[j, k + 1] - lengths[j, k]
        steps[i] = h * np.log(b / a) / (b - a) if abs(b - a) > 1e-6 * a else h / a
    return steps


@compiled
def spans_in(steps: FloatArray, a: int, b: int) -> float:
    """The integral of 1/field from joint a to joint b, or once round if they are one joint."""
    n, total = len(steps), 0.0
    stop = b * TABLE
    for i in range(a * TABLE, stop if b > a else stop + n):
        total += steps[i % n]
    return total


@compiled
def spans_for(whole: float) -> int:
    """The number of spans for an integral of 1/field."""
    return max(int(np.ceil(whole - SPARE)), 1)


@compiled
def lay(field: FloatArray, steps: FloatArray, a: int, whole: float, parts: int, places: FloatArray) -> None:
    """Write the places of joint a and, evenly by the field, of the vertices up to the next joint, ``parts`` in all."""
    n, i, passed = len(steps), a * TABLE, 0.0
    places[0] = a
    for part in range(1, parts):
        goal = whole * part / parts
        while passed + steps[i % n] < goal:
            passed += steps[i % n]
            i += 1
        b, c, x = field[i % n], field[i % n + 1], (goal - passed) / steps[i % n]
        share = b * ((c / b) ** x - 1) / (c - b) if abs(c - b) > 1e-6 * b else x
        places[part] = (i % n + share) / TABLE % (n // TABLE)  # the last entry's end is the first joint


@compiled
def laid(field: FloatArray, lengths: FloatArray, corners: IntArray) -> FloatArray:
    """Places at the corners and, evenly by the field, between them, increasing."""
    c, steps = len(corners), steps_of(field, lengths)
    counts, wholes, total = np.empty(c, dtype=np.int64), np.empty(c), 0
    for k in range(c):
        wholes[k] = spans_in(steps, corners[k], corners[(k + 1) % c])
        counts[k] = spans_for(wholes[k])
        total += counts[k]
    times = 1
    while times * total < FEWEST:
        times *= 2
    places, at = np.empty(times * total), 0
    for k in range(c):
        parts = times * counts[k]
        lay(field, steps, corners[k], wholes[k], parts, places[at : at + parts])
        at += parts
    return in_order(places)
