"""The outline as the sharp mode sees it: samples along it, and at each joint of segments whether it is a corner.

Everything is measured against the tolerance and the em, so that a scaled glyph is cut at the same places. Of several
masters the one counts that asks for most: a joint is a corner if it is one in any of them.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np

from ...compiled import compiled
from ...curves.cubics import directions, jet, length, turns
from ...outlines.flaws.joints import rounding_turn
from ...outlines.flaws.kinds import THRESHOLDS
from ...types import BoolArray, FloatArray, IntArray
from .spline_curve import chord

NO_HANDLE = 1e-9
"""Handles up to this long, in font units, may be rounding's alone, and give no tangent."""

SMOOTH_KINK = np.radians(3.0)
"""A line meets a curve smoothly if the source turns by less than this: twice what rounding to integers makes."""

SHARP, DEVIATIONS = np.radians(THRESHOLDS.corner_angle), THRESHOLDS.rounding
"""What a check goes by: the turn from which a joint is a corner, and up to how many standard deviations of what
rounding to whole units turns a joint by that lets it pass."""

BEND, KINK = 0.004, 0.065
"""A spline whose vertices are h apart misses an outline by about BEND h⁴ κ³ where it bends, and by KINK h sin θ where
it turns by θ."""


class Joints(NamedTuple):
    """Samples of one contour, and its joints; arrays run once round, so that the last joint is the first again.

    Attributes:
        samples: (K, N, 2) points of the outline in each master; places: (N,) where on it they lie. first: (m + 1,)
            index of each joint.
        spacing: (N - 1,) wanted distance of vertices between each sample and the next.
        corner: (m + 1,) the outline turns by the corner angle or more.
        hard: (m + 1,) an arc has to end here: a corner that shows, or the end of a straight line that stays.
        arriving, leaving: (K, m + 1, 2) unit tangents that arcs take up when they end here; at a tied joint, the line's
            vectors in units of their root mean square.
        tied: (m + 1,) an arc ends smoothly on a line whose direction is not the same in all masters. Between these it
            stays smooth only if the arc's tangents are the line's vectors times one number.
        line: (m,) segment j is a line that stays.
    """

    samples: FloatArray
    places: FloatArray
    first: IntArray
    spacing: FloatArray
    corner: BoolArray
    hard: BoolArray
    arriving: FloatArray
    leaving: FloatArray
    tied: BoolArray
    line: BoolArray


JointArrays: TypeAlias = tuple[
    FloatArray, FloatArray, IntArray, FloatArray, BoolArray, BoolArray, FloatArray, FloatArray, BoolArray, BoolArray,
]  # fmt: skip
"""The arrays of :class:`Joints`, for calls of compiled functions: Numba finds the type of a plain tuple at once, and
takes tens of microseconds for that of a named one. A slice of all of a named tuple is a plain one."""


@compiled
def find_joints(
    cubics: FloatArray, degrees: IntArray, near: float, angle: float, line_length: float, c2: bool
) -> Joints:
    """Sample a contour and classify its joints.

    Args:
        cubics: (K, m, 4, 2) its segments in each master; degrees: (m,) as in :class:`...outlines.outline.Contour`.
        near, angle, line_length, c2: see :class:`.settings.Settings`.
    """
    masters, m = len(cubics), len(degrees)
    places = even_places(cubics, degrees, near)
    samples = sampled(cubics, places)
    if c2:  # a spline might swing out between the samples beside a tight turn
        places, samples = graded(cubics, places, samples, near)
    spacing = spacings(cubics, places, samples, near)
    first = np.searchsorted(places, np.arange(m + 1.0))
    bends = np.zeros(m)
    corner, hard, line = np.zeros(m + 1, np.bool_), np.zeros(m + 1, np.bool_), np.empty(m, np.bool_)
    smooth = np.empty(m, np.bool_)
    for j in range(m):
        line[j] = degrees[j] == 1 and chord(samples, first[j], first[j + 1]) >= line_length
    for v in range(masters):
        own = np.abs(turns(cubics[v], NO_HANDLE))
        for j in range(m):
            bends[j] = max(bends[j], own[j])
            if own[j] >= angle:
                corner[j] = True
                hard[j] = hard[j] or shows(samples[v], first[j], near, angle)
    for j in range(m):
        hard[j] = hard[j] or line[j] or line[j - 1]
        smooth[j] = bends[j] < SMOOTH_KINK
        if line[j] != line[j - 1] and not smooth[j] and not c2:
            smooth[j] = is_roundings(cubics, degrees, j)
        kink = near / (KINK * np.sin(max(min(bends[j], np.pi / 2), 1e-9)))
        for i in (first[j], first[j] - 1):
            spacing[i] = min(spacing[i], kink)
    corner[m], hard[m] = corner[0], hard[0]
    arriving, leaving = np.empty((masters, m + 1, 2)), np.empty((masters, m + 1, 2))
    for v in range(masters):
        set_directions(cubics[v], smooth, corner, line, arriving[v], leaving[v])
    tied = np.zeros(m + 1, dtype=np.bool_)
    if masters > 1:
        for j in range(m):
            if line[j] != line[j - 1] and not corner[j] and smooth[j]:
                first_way, turn, straight = leaving[0, j], 0.0, cubics[:, j if line[j] else (j - 1) % m].copy()
                for v in range(masters):
                    turn = max(turn, abs(leaving[v, j, 0] * first_way[1] - leaving[v, j, 1] * first_way[0]))
                # Masters' lines have one direction if they turn by no more than this from each other, in radians.
                tied[j] = not turn < 1e-3
                whole = chord(straight, 0, 3)
                for v in range(masters if tied[j] else 0):  # the line's vectors in the masters
                    for axis in range(2):
                        arriving[v, j, axis] = (straight[v, 3, axis] - straight[v, 0, axis]) / whole
                        leaving[v, j, axis] = arriving[v, j, axis]
        tied[m] = tied[0]
        for v in range(masters):
            for axis in range(2):
                arriving[v, m, axis], leaving[v, m, axis] = arriving[v, 0, axis], leaving[v, 0, axis]
    return Joints(samples, places, first, spacing, corner, hard, arriving, leaving, tied, line)


@compiled
def turn_between(ax: float, ay: float, bx: float, by: float) -> float:
    """The angle between two vectors, without sign."""
    return abs(np.arctan2(ax * by - ay * bx, ax * bx + ay * by))


@compiled
def is_roundings(cubics: FloatArray, degrees: IntArray, j: int) -> bool:
    """Whether rounding to whole units may have turned joint j of a contour (K, m, 4, 2) in all masters.

    A check lets such a turn pass beside a short handle. What follows the outline has longer ones, beside which the same
    turn would be a kink.
    """
    for own in cubics:
        _, _, ax, ay = directions(own, j - 1, NO_HANDLE)
        bx, by, _, _ = directions(own, j, NO_HANDLE)
        one, two = 3 / degrees[j - 1] * length(ax, ay), 3 / degrees[j] * length(bx, by)
        turn = turn_between(ax, ay, bx, by)
        if min(one, two) == 0.0 or turn >= min(SHARP, DEVIATIONS * rounding_turn(one, two)):
            return False
    return True


@compiled
def sampled(cubics: FloatArray, places: FloatArray) -> FloatArray:
    """(K, N, 2) the outline at places that run once round."""
    masters, N = len(cubics), len(places)
    samples = np.empty((masters, N, 2))
    for v in range(masters):
        for i in range(N - 1):
            j = int(places[i])
            samples[v, i, 0], samples[v, i, 1], _, _, _, _ = jet(cubics[v], j, places[i] - j)
        samples[v, N - 1, 0], samples[v, N - 1, 1] = cubics[v, 0, 0, 0], cubics[v, 0, 0, 1]
    return samples


@compiled
def spacings(cubics: FloatArray, places: FloatArray, samples: FloatArray, tolerance: float) -> FloatArray:
    """(N - 1,) the wanted distance of vertices after each sample.

    A master's own counts in proportion to its step: in the one that asks for most vertices it is the wanted one.
    """
    masters, N = len(cubics), len(places)
    spacing = np.empty(N - 1)
    for i in range(N - 1):
        j = int(places[i])
        step = chord(samples, i, i + 1)
        spacing[i] = np.inf
        for v in range(masters):
            _, _, dx, dy, ax, ay = jet(cubics[v], j, (places[i] + places[i + 1]) / 2 - j)
            speed = max(length(dx, dy), 1e-9)
            curvature = max(abs(dx * ay - dy * ax) / (speed * speed * speed), 1e-9 / tolerance)
            wanted = np.sqrt(np.sqrt(tolerance / (BEND * (curvature * curvature * curvature))))
            own = length(samples[v, i + 1, 0] - samples[v, i, 0], samples[v, i + 1, 1] - samples[v, i, 1])
            if masters == 1 or own > 0.0:
                spacing[i] = min(spacing[i], wanted * step / own if masters > 1 else wanted)
        if spacing[i] == np.inf:
            spacing[i] = 1e6 * tolerance
    return spacing


@compiled
def set_directions(
    cubics: FloatArray, smooth: BoolArray, corner: BoolArray, line: BoolArray, arriving: FloatArray, leaving: FloatArray
) -> None:
    """The unit tangents of arcs that end at the joints of one master.

    Args:
        smooth: (m,) whether a line would meet a curve smoothly there.
    """
    m = len(cubics)
    for j in range(m):
        ax, ay, bx, by = directions(cubics, j, NO_HANDLE)
        if ax == ay == 0.0:
            ax = bx = 1.0
        size, size_there = np.hypot(ax, ay), np.hypot(bx, by)
        leaving[j, 0], leaving[j, 1] = ax / size, ay / size
        arriving[j + 1, 0], arriving[j + 1, 1] = bx / size_there, by / size_there
    arriving[0, 0], arriving[0, 1] = arriving[m, 0], arriving[m, 1]
    for j in range(m):
        if corner[j]:
            continue
        ax, ay, bx, by = arriving[j, 0], arriving[j, 1], leaving[j, 0], leaving[j, 1]
        x, y = ax + bx, ay + by
        if line[j] or line[j - 1]:
            if not smooth[j]:
                continue
            x, y = (bx, by) if line[j] else (ax, ay)
        else:
            size = np.hypot(x, y)
            x, y = x / size, y / size
        arriving[j, 0], arriving[j, 1], leaving[j, 0], leaving[j, 1] = x, y, x, y
    for axis in range(2):
        arriving[m, axis], leaving[m, axis] = arriving[0, axis], leaving[0, axis]


@compiled
def even_places(cubics: FloatArray, degrees: IntArray, tolerance: float) -> FloatArray:
    """(N,) places of the samples, evenly spaced in each segment; the last is that of the first joint, a lap later.

    The outline between two samples is straight to a seventh of the tolerance in every master.
    """
    m = len(degrees)
    counts, total = np.empty(m, dtype=np.int64), 0
    for j in range(m):
        most = 2.0 if degrees[j] == 1 else 3.0
        for v in range(len(cubics)):
            p, size, bend = cubics[v, j], 0.0, 0.0
            for k in range(3):
                size += np.hypot(p[k + 1, 0] - p[k, 0], p[k + 1, 1] - p[k, 1])
            for k in range(1, 3):
                x, y = p[k + 1, 0] - 2 * p[k, 0] + p[k - 1, 0], p[k + 1, 1] - 2 * p[k, 1] + p[k - 1, 1]
                bend = max(bend, np.hypot(x, y))
            wanted = max(size / (12 * tolerance), np.sqrt(0.75 * bend / (0.15 * tolerance)))
            most = min(max(np.ceil(wanted), most), 40.0)
        counts[j] = int(most)
        total += counts[j]
    places, at = np.empty(total + 1), 0
    for j in range(m):
        for i in range(counts[j]):
            places[at] = j + i / counts[j]
            at += 1
    places[at] = m
    return places


@compiled
def graded(
    cubics: FloatArray, places: FloatArray, samples: FloatArray, tolerance: float
) -> tuple[FloatArray, FloatArray]:
    """Places and samples with more between them, until no step longer than the tolerance is over twice as long as the
    next.

    Halved beside a step that differs a little, as they do between masters, steps would be halved all along the outline.
    """
    # Ratio of adjacent steps from which samples are denser if there are several masters.
    masters, most = len(cubics), 2.0 if len(cubics) == 1 else 3.0
    while True:
        n = len(places) - 1
        step, long, count = np.empty(n), np.zeros(n, dtype=np.bool_), 0
        for v in range(masters):
            for i in range(n):
                x, y = samples[v, i + 1, 0] - samples[v, i, 0], samples[v, i + 1, 1] - samples[v, i, 1]
                step[i] = length(x, y)
            for i in range(n):
                long[i] = long[i] or step[i] > max(most * min(step[i - 1], step[i + 1 if i + 1 < n else 0]), tolerance)
        for i in range(n):
            count += 2 if long[i] else 1
        if count == n:
            return places, samples
        new, points, at = np.empty(count + 1), np.empty((masters, count + 1, 2)), 0
        for i in range(n + 1):
            new[at] = places[i]
            for v in range(masters):
                points[v, at, 0], points[v, at, 1] = samples[v, i, 0], samples[v, i, 1]
            at += 1
            if i < n and long[i]:
                new[at] = (places[i] + places[i + 1]) / 2
                j = int(new[at])
                for v in range(masters):
                    points[v, at, 0], points[v, at, 1], _, _, _, _ = jet(cubics[v], j, new[at] - j)
                at += 1
        places, samples = new, points


@compiled
def shows(samples: FloatArray, at: int, tolerance: float, angle: float) -> bool:
    """Whether a corner is one at the scale of the tolerance too, and not the zigzag of a ragged outline.

    The outline is examined from six tolerances before the corner to as many after it: the corner has to stand out from
    their chord by two, and its two sides have to turn by the corner angle. Between straight sides it shows so from a
    turn of 39 degrees. Others may be rounded, if that saves something and stays within the tolerance; but never between
    lines that stay lines.
    """
    N = len(samples) - 1
    ends = np.empty((2, 2))
    for side in range(2):
        step = 1 if side else -1
        left, i = 6.0 * tolerance, at
        while True:
            a, b = i % N, (i + step) % N
            x, y = samples[b, 0] - samples[a, 0], samples[b, 1] - samples[a, 1]
            d = np.hypot(x, y)
            if d >= left or abs(i + step - at) >= N // 2:
                share = min(left / d, 1.0) if d > 0 else 1.0
                ends[side, 0], ends[side, 1] = samples[a, 0] + share * x, samples[a, 1] + share * y
                break
            left -= d
            i += step
    x, y = samples[at % N, 0], samples[at % N, 1]
    ax, ay = x - ends[0, 0], y - ends[0, 1]
    bx, by = ends[1, 0] - x, ends[1, 1] - y
    height = abs(ax * by - ay * bx) / max(np.hypot(ax + bx, ay + by), 1e-9)
    return turn_between(ax, ay, bx, by) >= angle and height >= 2.0 * tolerance
