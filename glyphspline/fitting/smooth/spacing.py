"""Where the vertices of a contour lie along it: even at first, respaced where the curve fails, inserted, and graded.

A *field* says at every point how long a chord may be there. Three things bound it, each measured on the curve of a
model outline:

- a corner of angle θ between straight legs, chords growing by 4 away from it: variant 2 is off by 0.0575 sin θ times
  the chord beside the corner, and by less further out. Variant 3, whose spans further out would be worse, is off by
  0.09 sin θ if chords grow by 2.5;
- a jump Δκ of curvature: off by up to 0.03 Δκ h², h the chord;
- curvature κ itself: off by some 0.004 (κ³ + |κ''|) h⁴.

Away from its bounds the field grows by ``log(growth)`` a unit of length: consecutive chords along such a field grow
by the factor ``growth``. Vertices lie at all corners and, between two, where the integral of 1/field is whole.

Of several masters the field is in lengths of the curve in R^{2K}, as share of which each asks for lengths of its own,
and the least counts.

Where spans fail the field is lowered, and the stretches between corners in which one does are respaced. A vertex put
into a span would leave chords of half the length beside whole ones, which the curve answers with a wobble, which fails
in turn: a round letter took twice the vertices, with a curvature extremum at each.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled, inlined
from ...curves.cubics import jet, length, length_table
from ...types import BoolArray, FloatArray, IntArray
from ..closed_curves import chords_of
from .canonical_contours import TABLE, WEIGHTS, length_at, points_at

AT_CORNER, AT_JUMP, AT_CURVATURE = 0.065, 0.03, 0.004
"""The three numbers, with something to spare at corners, where a span that just fails costs a vertex."""

FEWEST, MOST = 4, 2000
"""Vertices that a contour has at least, and up to which its polygon is refined."""


@compiled
def first_field(
    cubics: FloatArray, lengths: FloatArray, turns: FloatArray, corner_angle: float, factor: float, near: float,
    variant: int, hold: bool, field: FloatArray,
) -> None:  # fmt: skip
    """Write the field of a contour, at all entries of ``lengths`` in turn.

    Args:
        cubics: (m K, 4, 2). lengths, turns: see :class:`.canonical_contours.CanonicalContours`.
        corner_angle: turn in radians from which a joint is a vertex. factor: by which chords grow at most.
        near: distance allowed, in font units. hold: whether control points of corners are held at them.
        field: (m TABLE + 1,).
    """
    at_corner = 0.1 if variant == 3 else AT_CORNER
    first = np.log(factor) / (factor - 1)  # the field at a corner, for chords that begin with 1 and grow by the factor
    m = len(turns)
    K, steps = len(cubics) // m, m * TABLE
    curvature, scale = np.empty((m, TABLE + 1)), np.ones(steps)
    field[:] = lengths[-1] / FEWEST
    for v in range(K):
        own = cubics[v::K].copy() if K > 1 else cubics
        table = length_table(own, WEIGHTS) if K > 1 else lengths
        for i in range(steps if K > 1 else 0):  # lengths in R^{2K} by those in this master
            step = table[i + 1] - table[i]
            scale[i] = (lengths[i + 1] - lengths[i]) / step if step > 0 else np.inf
        for j in range(m):
            kappa, s = curvature[j], table[j * TABLE : (j + 1) * TABLE + 1]
            ax, ay = own[j, 3, 0] - own[j, 0, 0], own[j, 3, 1] - own[j, 0, 1]
            off = 0.0
            for k in range(1, 3):
                off = max(off, abs(ax * (own[j, k, 1] - own[j, 0, 1]) - ay * (own[j, k, 0] - own[j, 0, 0])))
            straight = off <= 1e-9 * (ax * ax + ay * ay)
            for k in range(TABLE + 1):
                kappa[k] = 0.0
                if not straight:
                    _, _, dx, dy, bx, by = jet(own, j, k / TABLE)
                    speed = np.sqrt(dx * dx + dy * dy)
                    kappa[k] = (dx * by - dy * bx) / (speed * speed * speed) if speed > 0 else 0.0
            for k in range(0 if straight else TABLE + 1):
                c = min(max(k, 1), TABLE - 1)
                before, after = s[c] - s[c - 1], s[c + 1] - s[c]
                change = 0.0
                if before > 0 and after > 0:
                    slope = (kappa[c + 1] - kappa[c]) / after - (kappa[c] - kappa[c - 1]) / before
                    change = 2 * abs(slope) / (before + after)
                bend = abs(kappa[k])
                h = (near / (AT_CURVATURE * (change + bend * bend * bend) + 1e-300)) ** 0.25
                if bend > 0:  # a chord turns by no more radians than this, unless it is as short as the tolerance
                    h = min(h, 2.5 / bend)
                at = j * TABLE
                longer = min(scale[at + max(k - 1, 0)], scale[at + min(k, TABLE - 1)])
                field[at + k] = min(field[at + k], max(h, near) * longer)
        for j in range(m):
            # Corners count as if the sine of their angle were at least this.
            if hold and turns[j] >= corner_angle:
                # Chords growing by 4, the curve is off by this times the chord and the sine, at the corner alone.
                h = first / 0.167 * near / max(np.sin(turns[j] / 2), 0.1)
            else:
                h = first / at_corner * near / max(np.sin(turns[j]), 0.1) if turns[j] > 0.01 else np.inf
            jump = abs(curvature[j, 0] - curvature[j - 1, TABLE])
            if jump > 0:
                h = min(h, max(np.sqrt(near / (AT_JUMP * jump)), near))
            field[j * TABLE] = min(field[j * TABLE], h * min(scale[j * TABLE - 1], scale[j * TABLE]))
    corners = at_corners(np.arange(m).astype(np.float64), turns, corner_angle)
    for k in range(len(corners)):
        a, b = corners[k], corners[(k + 1) % len(corners)]
        reach = lengths[b * TABLE] - lengths[a * TABLE] + (lengths[-1] if b <= a else 0.0)
        for j in (a, b):
            field[j * TABLE] = min(field[j * TABLE], first * reach)
    limit_growth(field, lengths, np.log(factor))


def growth_of(ratio: float, variant: int) -> float:
    """The factor by which chords grow at most, for a ratio of adjacent chords that is allowed."""
    # With a little to spare. Beyond a ratio of 4, faster growth takes more chords; variant 3 is worse beyond 2.5.
    return 0.97 * min(ratio, 2.5 / 0.97 if variant == 3 else 4.0)


@compiled
def at_corners(places: FloatArray, turns: FloatArray, corner_angle: float) -> IntArray:
    """Which of a contour's places are at corners; without one, that at the first joint, if there is one."""
    joints = places.astype(np.int64)
    at = np.flatnonzero((joints == places) & (turns[joints] >= corner_angle))
    return at if len(at) > 0 or places[0] != 0.0 else np.zeros(1, dtype=np.int64)


@compiled
def limit_growth(field: FloatArray, lengths: FloatArray, growth: float) -> None:
    """Lower a field until it nowhere grows faster than ``growth`` a unit of length, round the contour."""
    n = len(field) - 1
    field[n] = field[0] = min(field[0], field[n])
    for _ in range(2):
        for i in range(n):
            field[i + 1] = min(field[i + 1], field[i] + growth * (lengths[i + 1] - lengths[i]))
        field[0] = field[n]
        for i in range(n - 1, -1, -1):
            field[i] = min(field[i], field[i + 1] + growth * (lengths[i + 1] - lengths[i]))
        field[n] = field[0]


@compiled
def failed(corners: IntArray, errors: FloatArray, near: float) -> BoolArray:
    """The stretches from each vertex at a corner to the next in which a span's error exceeds ``near``."""
    n, fails = len(errors), np.zeros(len(corners), dtype=np.bool_)
    for k in range(len(corners)):
        for j in range(spans_after(corners, k, n)):
            fails[k] = fails[k] or errors[(corners[k] + j) % n] > near
    return fails


@inlined
def spans_after(corners: IntArray, k: int, n: int) -> int:
    """The number of spans of stretch k; one corner alone has all n."""
    return (corners[(k + 1) % len(corners)] - corners[k] - 1) % n + 1


@compiled
def steps_of(field: FloatArray, lengths: FloatArray) -> FloatArray:
    """(m TABLE,) the integral of 1/field, which goes linearly from one entry to the next, over each step."""
    steps = np.empty(len(field) - 1)
    for i in range(len(steps)):
        a, b, h = field[i], field[i + 1], lengths[i + 1] - lengths[i]
        steps[i] = h * np.log(b / a) / (b - a) if abs(b - a) > 1e-6 * a else h / a
    return steps


@compiled
def spans_in(steps: FloatArray, places: FloatArray, corners: IntArray, k: int) -> float:
    """The integral of 1/field over stretch k, once round if there is one corner."""
    a, b = int(places[corners[k]]), int(places[corners[(k + 1) % len(corners)]])
    n, total = len(steps), 0.0
    stop = b * TABLE
    for i in range(a * TABLE, stop if b > a else stop + n):
        total += steps[i % n]
    return total


@compiled
def off_corners(points: FloatArray, corners: IntArray, turns: FloatArray) -> FloatArray:
    """(n,) about how far off the curve will be in the spans beside corners whose control points are held at them.

    Args:
        points: (n, 2 K) vertices. corners: (k,) those at corners; turns: (k,) there, in radians.
    """
    n = len(points)
    chords, _ = chords_of(points, 1.0)
    errors = np.zeros(n)
    for k in range(len(corners)):
        i = corners[k]
        c, d, e, f = chords[i - 2], chords[i - 1], chords[i], chords[(i + 1) % n]
        for v in range(0, points.shape[1], 2):
            x, y = points[:, v], points[:, v + 1]
            g, h = length(x[i] - x[i - 1], y[i] - y[i - 1]), length(x[(i + 1) % n] - x[i], y[(i + 1) % n] - y[i])
            # How far the two control points beside the corner draw the curve, which are 0.78 chords away from it.
            a, b = 0.78 * e * e * g / ((d + e) * (c + d + e)), 0.78 * d * d * h / ((d + e) * (d + e + f))
            errors[i - 1] = errors[i] = max(
                np.sqrt(a * a + b * b - 2 * a * b * np.cos(turns[k])), max(errors[i - 1], errors[i])
            )
    return errors


@compiled
def lowered(
    field: FloatArray, lengths: FloatArray, places: FloatArray, corners: IntArray, again: BoolArray, errors: FloatArray,
    near: float, growth: float, hold: bool,
) -> None:  # fmt: skip
    """Lower a field over the spans that fail, and over those beside them less and less.

    Args:
        field: (m TABLE + 1,), which changes. places: (n,) of the vertices; ``corners``: those at corners.
        again: the stretches between corners in which spans fail. errors: (n,) of the span after each vertex.
        near: distance allowed. growth: logarithm of the factor by which chords grow at most.
        hold: whether control points of the corners are held at them.
    """
    n, entries, before = len(places), len(field) - 1, field.copy()
    shares, steps = np.ones(n), steps_of(field, lengths)
    for k in range(len(corners)):
        if again[k]:
            spans, whole = spans_after(corners, k, n), spans_in(steps, places, corners, k)
            for j in range(spans):
                i = (corners[k] + j) % n
                if errors[i] > near:
                    # Between corners and jumps, the error grows with the fourth power of the length. Chords are
                    # shorter than the field by whole / spans, for their number to be whole.
                    # Beside held corners it grows with the length: the curve is off at the corner.
                    beside = hold and (j == 0 or j == spans - 1)
                    share = 0.985 * near / errors[i] if beside else 0.95 * (near / errors[i]) ** 0.25
                    shares[i] = max(share, 0.4) * min(whole / spans, 1.0)
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
    limit_growth(field, lengths, growth)


@compiled
def laid(field: FloatArray, lengths: FloatArray, places: FloatArray, corners: IntArray, again: BoolArray) -> FloatArray:
    """The places, increasing, with those of some stretches between corners spaced evenly by the field."""
    n, count, steps, total = len(places), len(corners), steps_of(field, lengths), 0
    m, parts, wholes = len(steps), np.empty(count, dtype=np.int64), np.empty(count)
    for k in range(count):
        parts[k] = spans_after(corners, k, n)
        if again[k]:
            wholes[k] = spans_in(steps, places, corners, k)
            # Share of a vertex by which an integral may exceed a whole number without one more.
            parts[k] = max(int(np.ceil(wholes[k] - 0.05)), 1)
        total += parts[k]
    while total < FEWEST:
        for k in range(count):
            if again[k]:
                total, parts[k] = total + parts[k], 2 * parts[k]
    new, at = np.empty(total), 0
    for k in range(count):
        if again[k]:
            a, passed = int(places[corners[k]]), 0.0
            new[at], i = a, a * TABLE
            for part in range(1, parts[k]):
                goal = wholes[k] * part / parts[k]
                while passed + steps[i % m] < goal:
                    passed += steps[i % m]
                    i += 1
                b, c, x = field[i % m], field[i % m + 1], (goal - passed) / steps[i % m]
                share = b * ((c / b) ** x - 1) / (c - b) if abs(c - b) > 1e-6 * b else x
                new[at + part] = (i % m + share) / TABLE % (m // TABLE)  # the last entry's end is the first joint
        else:
            for j in range(parts[k]):
                new[at + j] = places[(corners[k] + j) % n]
        at += parts[k]
    return np.sort(new)


@compiled
def spans_of(lengths: FloatArray, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(n,) length along the contour at which each place lies, and to the next one."""
    n = len(places)
    at, h = np.empty(n), np.empty(n)
    for i in range(n):
        at[i] = length_at(lengths, places[i])
    for i in range(n - 1):
        h[i] = at[i + 1] - at[i]
    h[n - 1] = at[0] + lengths[-1] - at[n - 1]
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
    n = len(places)
    parts, shares = np.ones(n, dtype=np.int64), np.empty(n)
    for i in range(n):
        # What is wrong with a span is most often wrong with its worse neighbour.
        if errors[i] > near and errors[i] >= max(errors[i - 1], errors[(i + 1) % n]):
            parts[i] = 2 if errors[i] < 6 * near else (3 if errors[i] < 30 * near else 4)
            shares[i] = min(max((length_at(lengths, worst[i]) - at[i]) / h[i], 0.3), 1 - 0.3)
    return divided(lengths, places, at, h, parts, shares)


@compiled
def graded(cubics: FloatArray, lengths: FloatArray, places: FloatArray, ratio: float) -> FloatArray:
    """The places with chords cut where they are more than ``ratio`` times a neighbour, until none is.

    Up to a ratio of 4 this certifies convergence before the interpolation is run (Theorem 2).
    """
    K = len(cubics) * TABLE // (len(lengths) - 1)
    while True:
        n = len(places)
        chords, even = chords_of(points_at(cubics, K, places), ratio)
        if n > MOST or even:
            return places
        at, h = spans_of(lengths, places)
        parts, shares = np.ones(n, dtype=np.int64), np.empty(n)
        for i in range(n):
            before, after = chords[i - 1], chords[(i + 1) % n]
            if chords[i] > ratio * min(before, after):
                # Share of the ratio allowed that a chord cut off beside a shorter one has to it.
                cut = min(0.98 * ratio * min(before, after) / chords[i], 0.5)
                parts[i], shares[i] = 2, cut if before <= after else 1 - cut
        places = divided(lengths, places, at, h, parts, shares)
        if len(places) == n:
            return places


@compiled
def divided(
    lengths: FloatArray, places: FloatArray, at: FloatArray, h: FloatArray, parts: IntArray, shares: FloatArray
) -> FloatArray:
    """The places with more in the spans that have several parts: of two, the first has a share; more are equal.

    Args:
        at, h: see :func:`spans_of`.
    """
    new, count, m = np.empty(parts.sum()), 0, len(lengths) // TABLE
    for i in range(len(places)):
        new[count] = places[i]
        count += 1
        # A shorter span that is divided would end in duplicate vertices.
        for part in range(1, parts[i] if h[i] > 1e-5 * lengths[-1] else 1):
            share = shares[i] if parts[i] == 2 else part / parts[i]
            distance = at[i] + share * h[i]
            lap = np.floor(distance / lengths[-1])
            d = distance - lap * lengths[-1]
            j = np.searchsorted(lengths[:-1], d, side="right") - 1
            step = lengths[j + 1] - lengths[j]
            x = j % TABLE + (min(max((d - lengths[j]) / step, 0.0), 1.0) if step > 0 else 0.0)
            new[count] = (lap * m + j // TABLE + x / TABLE) % m
            count += 1
    return np.sort(new[:count])
