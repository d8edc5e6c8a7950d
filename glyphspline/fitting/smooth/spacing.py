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


@compiled
def seeds(
    cubics: FloatArray, lengths: FloatArray, turns: FloatArray, corner_angle: float, ratio: float, near: float,
    variant: int,
) -> FloatArray:  # fmt: skip
    """Places of the first vertices of a contour, increasing.

    Args:
        cubics: (m, 4, 2). lengths, turns: as :class:`.canonical_contours.Chains` has them.
        corner_angle: turn in radians from which a joint is a vertex. ratio: at most, of adjacent chords.
        near: distance allowed, in font units.
    """
    factor, at_corner = GROWTH * ratio, AT_CORNER
    if variant == 3:
        factor, at_corner = min(factor, GROWTH_3), AT_CORNER_3
    growth = np.log(factor)
    first = growth / (factor - 1)  # the field at a corner, for chords that begin with 1 and grow by the factor
    field = _bounds(cubics, lengths, turns, first / at_corner, near)
    corners = np.flatnonzero(turns >= corner_angle)
    if len(corners) == 0:
        corners = np.zeros(1, dtype=np.int64)
    m, total = len(cubics), lengths[-1, TABLE]
    for k in range(len(corners)):
        a, b = corners[k], corners[(k + 1) % len(corners)]
        reach = lengths[b, 0] - lengths[a, 0] + (total if b <= a else 0.0)
        for j in (a, b):
            field[j * TABLE] = min(field[j * TABLE], first * reach)
    field[m * TABLE] = field[0] = min(field[0], field[m * TABLE])
    _limit_growth(field, lengths, growth)
    return _laid(field, lengths, corners)


@compiled
def _bounds(cubics: FloatArray, lengths: FloatArray, turns: FloatArray, at_corner: float, near: float) -> FloatArray:
    """The field at all entries of ``lengths`` in turn, (m TABLE + 1,), before its growth is limited."""
    m = len(cubics)
    field = np.full(m * TABLE + 1, lengths[-1, TABLE] / FEWEST)
    curvature = np.zeros((m, TABLE + 1))
    for j in range(m):
        kappa = curvature[j]
        if not _curvatures(cubics, j, kappa):
            continue
        s = lengths[j]
        for k in range(TABLE + 1):
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


@compiled
def _curvatures(cubics: FloatArray, j: int, kappa: FloatArray) -> bool:
    """Signed curvature of segment j at even parameters; False if it is straight."""
    c = cubics[j]
    ax, ay = c[3, 0] - c[0, 0], c[3, 1] - c[0, 1]
    off = 0.0
    for k in (1, 2):
        off = max(off, abs(ax * (c[k, 1] - c[0, 1]) - ay * (c[k, 0] - c[0, 0])))
    if off <= 1e-9 * (ax * ax + ay * ay):
        return False
    for k in range(TABLE + 1):
        _, _, dx, dy, bx, by = jet(cubics, j, k / TABLE)
        speed = np.sqrt(dx * dx + dy * dy)
        kappa[k] = (dx * by - dy * bx) / speed**3 if speed > 0 else 0.0
    return True


@compiled
def _limit_growth(field: FloatArray, lengths: FloatArray, growth: float) -> None:
    """Lower the field until it nowhere grows faster than ``growth`` a unit of length, round the contour."""
    n = len(field) - 1
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
def _parts(a: float, b: float, length: float) -> float:
    """Integral of 1/field over a stretch on which the field goes linearly from a to b."""
    return length * np.log(b / a) / (b - a) if abs(b - a) > 1e-6 * a else length / a


@compiled
def _laid(field: FloatArray, lengths: FloatArray, corners: IntArray) -> FloatArray:
    """Places at the corners and, evenly by the field, between them."""
    m = len(lengths)
    n = m * TABLE
    steps = np.empty(n)
    for i in range(n):
        j, k = i // TABLE, i % TABLE
        steps[i] = _parts(field[i], field[i + 1], lengths[j, k + 1] - lengths[j, k])
    counts = np.empty(len(corners), dtype=np.int64)
    wholes = np.zeros(len(corners))
    for k in range(len(corners)):
        first = corners[k] * TABLE
        stop = corners[(k + 1) % len(corners)] * TABLE
        for i in range(first, stop if stop > first else stop + n):
            wholes[k] += steps[i % n]
        counts[k] = max(int(np.ceil(wholes[k] - SPARE)), 1)
    while counts.sum() < FEWEST:
        counts *= 2
    places = np.empty(counts.sum())
    at = 0
    for k in range(len(corners)):
        i, passed = corners[k] * TABLE, 0.0
        places[at] = corners[k]
        at += 1
        for part in range(1, counts[k]):
            goal = wholes[k] * part / counts[k]
            while passed + steps[i % n] < goal:
                passed += steps[i % n]
                i += 1
            share = _share(field[i % n], field[i % n + 1], (goal - passed) / steps[i % n])
            places[at] = (i % n + share) / TABLE
            at += 1
    return np.sort(places)


@compiled
def _share(a: float, b: float, x: float) -> float:
    """Share of a stretch's length at which the integral of 1/field has come to the share x of the whole."""
    return a * ((b / a) ** x - 1) / (b - a) if abs(b - a) > 1e-6 * a else x
