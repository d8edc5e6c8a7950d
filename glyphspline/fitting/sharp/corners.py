"""The outline as the sharp mode sees it: samples along it, and at each joint of segments whether it is a corner.

Everything is measured against the tolerance and the em, so that a scaled glyph is cut at the same places.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import directions, jet, turns
from ...types import BoolArray, FloatArray, IntArray

NO_HANDLE = 1e-9
"""Handles up to this long, in font units, may be rounding's alone, and give no tangent."""

SMOOTH_KINK = np.radians(3.0)
"""A line meets a curve smoothly if the source turns by less than this: twice what rounding to integers makes."""


class Joints(NamedTuple):
    """Samples of one contour, and its joints; arrays run once round, so that the last joint is the first again.

    Attributes:
        samples: (N, 2) points of the outline; first: (m + 1,) index of each joint in them.
        density: (N,) integral of the wanted vertex density.
        corner: (m + 1,) the outline turns by the corner angle or more.
        hard: (m + 1,) an arc has to end here: a corner that shows, or the end of a straight line that stays.
        arriving, leaving: (m + 1, 2) unit tangents that arcs take up when they end here.
        line: (m,) segment j is a line that stays.
    """

    samples: FloatArray
    first: IntArray
    density: FloatArray
    corner: BoolArray
    hard: BoolArray
    arriving: FloatArray
    leaving: FloatArray
    line: BoolArray


@compiled
def find_joints(cubics: FloatArray, degrees: IntArray, tolerance: float, angle: float, shortest_line: float) -> Joints:
    """Sample a contour and classify its joints.

    Args:
        cubics: (m, 4, 2) its segments, none without length; degrees: (m,) as in :class:`...outlines.outline.Contour`.
        tolerance: the fit's, in font units.
        angle: turn from which a joint is a corner, in radians.
        shortest_line: straight lines at least this long stay lines.
    """
    m = len(cubics)
    first = np.empty(m + 1, dtype=np.int64)
    first[0] = 0
    for j in range(m):
        first[j + 1] = first[j] + samples_of(cubics, j, degrees[j] == 1, tolerance)
    N = first[m] + 1
    samples, density = np.empty((N, 2)), np.empty(N)
    corner, hard, line = np.empty(m + 1, np.bool_), np.empty(m + 1, np.bool_), np.empty(m, np.bool_)
    arriving, leaving = np.empty((m + 1, 2)), np.empty((m + 1, 2))
    density[0], least = 0.0, 1 / (500 * tolerance)
    for j in range(m):
        chord = np.hypot(cubics[j, 3, 0] - cubics[j, 0, 0], cubics[j, 3, 1] - cubics[j, 0, 1])
        line[j] = degrees[j] == 1 and chord >= shortest_line
        ax, ay, bx, by = directions(cubics, j, NO_HANDLE)
        if ax == ay == 0.0:
            ax = bx = 1.0
        size, size_there = np.hypot(ax, ay), np.hypot(bx, by)
        leaving[j, 0], leaving[j, 1] = ax / size, ay / size
        arriving[j + 1, 0], arriving[j + 1, 1] = bx / size_there, by / size_there
        n = first[j + 1] - first[j]
        for i in range(n):
            at = first[j] + i
            samples[at, 0], samples[at, 1], _, _, _, _ = jet(cubics, j, i / n)
            # The density of vertices wanted goes with the root of the curvature.
            _, _, dx, dy, ax, ay = jet(cubics, j, (i + 0.5) / n)
            speed = np.hypot(dx, dy)
            curvature = abs(dx * ay - dy * ax) / max(speed, 1e-9) ** 3
            density[at + 1] = speed / n * np.sqrt(min(curvature, 1 / (4 * tolerance)) + least)
    samples[N - 1, 0], samples[N - 1, 1] = cubics[0, 0, 0], cubics[0, 0, 1]
    arriving[0, 0], arriving[0, 1] = arriving[m, 0], arriving[m, 1]
    bends = turns(cubics, NO_HANDLE)
    for j in range(m):
        bend = abs(bends[j])
        corner[j] = bend >= angle
        hard[j] = (corner[j] and shows(samples, first[j], tolerance, angle)) or line[j] or line[j - 1]
        density[first[j]] += np.sqrt(bend * 4 * tolerance)
        if corner[j]:
            continue
        ax, ay, bx, by = arriving[j, 0], arriving[j, 1], leaving[j, 0], leaving[j, 1]
        x, y = ax + bx, ay + by
        if line[j] or line[j - 1]:
            if not bend < SMOOTH_KINK:
                continue
            x, y = (bx, by) if line[j] else (ax, ay)
        else:
            size = np.hypot(x, y)
            x, y = x / size, y / size
        arriving[j, 0], arriving[j, 1], leaving[j, 0], leaving[j, 1] = x, y, x, y
    corner[m], hard[m] = corner[0], hard[0]
    for axis in range(2):
        arriving[m, axis], leaving[m, axis] = arriving[0, axis], leaving[0, axis]
    for j in range(1, N):
        density[j] += density[j - 1]
    return Joints(samples, first, density, corner, hard, arriving, leaving, line)


@compiled(internal=True)
def samples_of(cubics: FloatArray, j: int, straight: bool, tolerance: float) -> int:
    """Samples that segment j needs: the outline between two of them is straight to a seventh of the tolerance."""
    length = bend = 0.0
    for k in range(3):
        length += np.hypot(cubics[j, k + 1, 0] - cubics[j, k, 0], cubics[j, k + 1, 1] - cubics[j, k, 1])
    for k in range(1, 3):
        x = cubics[j, k + 1, 0] - 2 * cubics[j, k, 0] + cubics[j, k - 1, 0]
        y = cubics[j, k + 1, 1] - 2 * cubics[j, k, 1] + cubics[j, k - 1, 1]
        bend = max(bend, np.hypot(x, y))
    wanted = max(length / (12 * tolerance), np.sqrt(0.75 * bend / (0.15 * tolerance)))
    return int(min(max(np.ceil(wanted), 2.0 if straight else 3.0), 40.0))


REACH, HEIGHT = 6.0, 2.0
"""How far a corner is looked at to either side, and how far it has to stand out from the chord, in tolerances.

At this reach a corner between straight sides shows from a turn of 39 degrees. Others may be rounded, if that saves
something and stays within the tolerance; but never between lines that stay lines.
"""


@compiled(internal=True)
def shows(samples: FloatArray, at: int, tolerance: float, angle: float) -> bool:
    """Whether a corner is one at the scale of the tolerance too, and not the zigzag of a ragged outline.

    The outline is looked at from a few tolerances before the corner to as many after it: the corner has to stand out
    from their chord, and its two sides have to turn by the corner angle.
    """
    N = len(samples) - 1
    ends = np.empty((2, 2))
    for side in range(2):
        step = 1 if side else -1
        left, i = REACH * tolerance, at
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
    across = ax * by - ay * bx
    height = abs(across) / max(np.hypot(ax + bx, ay + by), 1e-9)
    return abs(np.arctan2(across, ax * bx + ay * by)) >= angle and height >= HEIGHT * tolerance
