"""First places for the vertices of a contour: how far apart they may lie, by what is known of the outline.

A *field* says at every point how long a chord may be there. Three things bound it, each measured on the curve of a
model outline:

- a corner of angle θ between straight legs, chords growing by 4 away from it: variant 2 is off by 0.0575 sin θ times
  the chord beside the corner, and by less further out. Variant 3, whose spans further out would be worse, is off by
  0.09 sin θ if chords grow by 2.5;
- a jump Δκ of curvature: off by up to 0.03 Δκ h², h the chord, less if a vertex is there;
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

AT_CORNER, AT_JUMP, AT_CURVATURE = 0.065, 0.014, 0.004
"""The three numbers, with something to spare at corners, where a span that just fails would be halved."""

GROWTH = 0.97
"""Share of the ratio allowed by which chords grow."""

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


@compiled(internal=True)
def seeds(
    cubics: FloatArray, lengths: FloatArray, turns: FloatArray, corner_angle: float, ratio: float, near: float,
    variant: int,
) -> FloatArray:  # fmt: skip
    """Places of the first vertices of a contour, increasing.

    Args:
        cubics: (m, 4, 2). lengths, turns: as :class:`.canonical_contours.CanonicalContours` has them.
        corner_angle: turn in radians from which a joint is a vertex. ratio: at most, of adjacent chords.
        near: distance allowed, in font units.
    """
    factor, at_corner = GROWTH * ratio, AT_CORNER
    if variant == 3:
        factor, at_corner = min(factor, GROWTH_3), AT_CORNER_3
    growth = np.log(factor)
    first = growth / (factor - 1)  # the field at a corner, for chords that begin with 1 and grow by the factor
    field = bounds_of(cubics, lengths, turns, first / at_corner, near)
    m, total = len(cubics), lengths[-1, TABLE]
    corners, count = np.empty(m, dtype=np.int64), 0
    for j in range(m):
        if turns[j] >= corner_angle:
            corners[count] = j
            count += 1
    if count == 0:
        corners[0], count = 0, 1
    for k in range(count):
        a, b = corners[k], corners[(k + 1) % count]
        reach = lengths[b, 0] - lengths[a, 0] + (total if b <= a else 0.0)
        for j in (a, b):
            field[j * TABLE] = min(field[j * TABLE], first * reach)
    n = m * TABLE
    field[n] = field[0] = min(field[0], field[n])
    for _ in range(2):  # lower it until it nowhere grows faster than ``growth`` a unit of length, round the contour
        for i in range(n):
            j, k = i // TABLE, i % TABLE
            field[i + 1] = min(field[i + 1], field[i] + growth * (lengths[j, k + 1] - lengths[j, k]))
        field[0] = field[n]
        for i in range(n - 1, -1, -1):
            j, k = i // TABLE, i % TABLE
            field[i] = min(field[i], field[i + 1] + growth * (lengths[j, k + 1] - lengths[j, k]))
        field[n] = field[0]
    return laid(field, lengths, corners[:count])


@compiled(internal=True)
def bounds_of(cubics: FloatArray, lengths: FloatArray, turns: FloatArray, at_corner: float, near: float) -> FloatArray:
    """The field at all entries of ``lengths`` in turn, (m TABLE + 1,), before its growth is limited."""
    m = len(cubics)
    field, curvature = np.empty(m * TABLE + 1), np.empty((m, TABLE + 1))
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
    return field


@compiled(internal=True)
def laid(field: FloatArray, lengths: FloatArray, corners: IntArray) -> FloatArray:
    """Places at the corners and, evenly by the field, between them."""
    n, c = len(lengths) * TABLE, len(corners)
    steps = np.empty(n)  # the integral of 1/field, which goes linearly from one entry to the next
    for i in range(n):
        j, k = i // TABLE, i % TABLE
        a, b, h = field[i], field[i + 1], lengths[j, k + 1] - lengths[j, k]
        steps[i] = h * np.log(b / a) / (b - a) if abs(b - a) > 1e-6 * a else h / a
    counts, wholes, total = np.empty(c, dtype=np.int64), np.empty(c), 0
    for k in range(c):
        first = corners[k] * TABLE
        stop = corners[(k + 1) % c] * TABLE
        wholes[k] = 0.0
        for i in range(first, stop if stop > first else stop + n):
            wholes[k] += steps[i % n]
        counts[k] = max(int(np.ceil(wholes[k] - SPARE)), 1)
        total += counts[k]
    times = 1
    while times * total < FEWEST:
        times *= 2
    places, at = np.empty(times * total), 0
    for k in range(c):
        i, passed, parts = corners[k] * TABLE, 0.0, times * counts[k]
        places[at] = corners[k]
        at += 1
        for part in range(1, parts):
            goal = wholes[k] * part / parts
            while passed + steps[i % n] < goal:
                passed += steps[i % n]
                i += 1
            a, b, x = field[i % n], field[i % n + 1], (goal - passed) / steps[i % n]
            share = a * ((b / a) ** x - 1) / (b - a) if abs(b - a) > 1e-6 * a else x
            places[at] = (i % n + share) / TABLE
            at += 1
    return in_order(places[:at])
