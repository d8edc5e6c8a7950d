"""The outline as the sharp mode sees it: samples along it, and at each joint of segments whether it is a corner.

Everything is measured against the tolerance and the em, so that a scaled glyph is cut at the same places.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet
from ...outlines.canonical import direction, turn
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
def unit_tangent(cubic: FloatArray, at_end: bool) -> tuple[float, float]:
    """Direction of travel at an end of a cubic, whatever handles have no length."""
    x, y, length = direction(cubic, at_end, NO_HANDLE)
    return (x / length, y / length) if length > 0 else (1.0, 0.0)


@compiled
def _steps(cubic: FloatArray, straight: bool, tolerance: float) -> int:
    """Samples a segment needs: the outline between two of them is straight to a seventh of the tolerance."""
    length = 0.0
    bend = 0.0
    for j in range(3):
        length += np.hypot(cubic[j + 1, 0] - cubic[j, 0], cubic[j + 1, 1] - cubic[j, 1])
    for j in range(1, 3):
        bend = max(
            bend,
            np.hypot(
                cubic[j + 1, 0] - 2 * cubic[j, 0] + cubic[j - 1, 0], cubic[j + 1, 1] - 2 * cubic[j, 1] + cubic[j - 1, 1]
            ),
        )
    wanted = max(length / (12 * tolerance), np.sqrt(0.75 * bend / (0.15 * tolerance)))
    return int(min(max(np.ceil(wanted), 2.0 if straight else 3.0), 40.0))


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
    first = np.zeros(m + 1, dtype=np.int64)
    for j in range(m):
        first[j + 1] = first[j] + _steps(cubics[j], degrees[j] == 1, tolerance)
    N = first[m] + 1
    samples, density = np.empty((N, 2)), np.zeros(N)
    corner, hard = np.zeros(m + 1, dtype=np.bool_), np.zeros(m + 1, dtype=np.bool_)
    arriving, leaving, line = np.empty((m + 1, 2)), np.empty((m + 1, 2)), np.zeros(m, dtype=np.bool_)
    for j in range(m):
        chord = np.hypot(cubics[j, 3, 0] - cubics[j, 0, 0], cubics[j, 3, 1] - cubics[j, 0, 1])
        line[j] = degrees[j] == 1 and chord >= shortest_line
        leaving[j] = unit_tangent(cubics[j], False)
        arriving[j + 1] = unit_tangent(cubics[j], True)
        _sample_segment(cubics, j, first[j], first[j + 1] - first[j], tolerance, samples, density)
    samples[N - 1] = cubics[0, 0]
    leaving[m], arriving[0] = leaving[0], arriving[m]
    for j in range(m):
        bend = turn(arriving[j, 0], arriving[j, 1], leaving[j, 0], leaving[j, 1])
        corner[j] = bend >= angle
        hard[j] = (corner[j] and shows(samples, first[j], tolerance, angle)) or line[j] or line[j - 1]
        density[first[j]] += np.sqrt(bend * 4 * tolerance)
        if corner[j]:
            continue
        if line[j] or line[j - 1]:
            if bend < SMOOTH_KINK:
                if line[j]:
                    arriving[j] = leaving[j]
                else:
                    leaving[j] = arriving[j]
        else:
            x, y = arriving[j, 0] + leaving[j, 0], arriving[j, 1] + leaving[j, 1]
            arriving[j] = x / np.hypot(x, y), y / np.hypot(x, y)
            leaving[j] = arriving[j]
    corner[m], hard[m], arriving[m], leaving[m] = corner[0], hard[0], arriving[0], leaving[0]
    for j in range(1, N):
        density[j] += density[j - 1]
    return Joints(samples, first, density, corner, hard, arriving, leaving, line)


@compiled
def begun_at(joints: Joints, k: int) -> Joints:
    """The joints of the same contour begun at joint k."""
    m, last = len(joints.line), len(joints.samples) - 1
    s, turned = joints.first[k], (np.arange(m + 1) + k) % m
    return Joints(
        np.concatenate((joints.samples[s:last], joints.samples[: s + 1])),
        np.concatenate((joints.first[k:m] - s, joints.first[: k + 1] + (last - s))),
        np.concatenate((joints.density[s:last], joints.density[: s + 1] + joints.density[last])),
        joints.corner[turned],
        joints.hard[turned],
        joints.arriving[turned],
        joints.leaving[turned],
        joints.line[turned[:m]],
    )


@compiled
def _sample_segment(
    cubics: FloatArray, j: int, at: int, n: int, tolerance: float, samples: FloatArray, density: FloatArray
) -> None:
    """Write samples at..at + n - 1; the density of vertices wanted goes with the root of the curvature."""
    least = 1 / (500 * tolerance)
    for i in range(n):
        x, y, dx, dy, ax, ay = jet(cubics, j, i / n)
        samples[at + i] = x, y
        _, _, dx, dy, ax, ay = jet(cubics, j, (i + 0.5) / n)
        speed = np.hypot(dx, dy)
        curvature = abs(dx * ay - dy * ax) / max(speed, 1e-9) ** 3
        density[at + i + 1] = speed / n * np.sqrt(min(curvature, 1 / (4 * tolerance)) + least)


REACH, HEIGHT = 6.0, 2.0
"""How far a corner is looked at to either side, and how far it has to stand out from the chord, in tolerances.

At this reach a corner between straight sides shows from a turn of 39 degrees. Others may be rounded, if that saves
something and stays within the tolerance; but never between lines that stay lines.
"""


@compiled
def shows(samples: FloatArray, at: int, tolerance: float, angle: float) -> bool:
    """Whether a corner is one at the scale of the tolerance too, and not the zigzag of a ragged outline.

    The outline is looked at from a few tolerances before the corner to as many after it: the corner has to stand out
    from their chord, and its two sides have to turn by the corner angle.
    """
    reach = REACH * tolerance
    N = len(samples) - 1
    ends = np.empty((2, 2))
    for side in range(2):
        step = 1 if side else -1
        left, i = reach, at
        while True:
            a, b = samples[i % N], samples[(i + step) % N]
            d = np.hypot(b[0] - a[0], b[1] - a[1])
            if d >= left or abs(i + step - at) >= N // 2:
                share = min(left / d, 1.0) if d > 0 else 1.0
                ends[side] = a + share * (b - a)
                break
            left -= d
            i += step
    p = samples[at % N]
    ax, ay = p[0] - ends[0, 0], p[1] - ends[0, 1]
    bx, by = ends[1, 0] - p[0], ends[1, 1] - p[1]
    chord = np.hypot(ax + bx, ay + by)
    height = abs(ax * by - ay * bx) / max(chord, 1e-9)
    return turn(ax, ay, bx, by) >= angle and height >= HEIGHT * tolerance
