"""Outlines that quadratics are to follow: their joints, what these may turn by, and what is stored of them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....compiled import compiled
from ....curves.cubics import directions, length
from ....fitting.sharp.corners import NO_HANDLE, SHARP, SMOOTH_KINK, Joints, find_joints, is_roundings, turn_between
from ....fitting.sharp.settings import Settings
from ....types import BoolArray, FloatArray, IntArray
from .contours import alone, set_upright
from .gates import CORNER, KINK, mixed

STEEP = np.radians(1.5)
"""Turn of a joint from which it stays where it is, with the turn it has."""

BLUNT = np.radians(20.0)
"""Turn from which a corner's sides may turn; less would soon be a kink."""

MOVED = 2.5
"""How many tolerances the end of a handle may move to have the direction of the other one."""


class Stored(NamedTuple):
    """What is stored of a contour of m quadratics and lines in K masters.

    Attributes:
        known: whether anything is, on the grid. node: (K, m, 2) where segments begin, whole but for those implied.
        control: (K, m, 2), implied: (m,) whether a segment begins midway between control points. drift: how far it is
            from the source, which may have the same numbers before they were rounded. stays: (m,) what is to.
    """

    known: bool
    node: FloatArray
    control: FloatArray
    implied: BoolArray
    drift: float
    stays: BoolArray


class Given(NamedTuple):
    """A contour of m segments in K masters.

    Attributes:
        cubics: (K, m, 4, 2). line: (m,). joints: of it. slack: (m + 1,) the largest turn of each that is no new kink,
            least: (m + 1,) its smallest turn in any mix. own: (m + 1,) the largest it has, reach: (2, m + 1) beside
            handles that long, before and behind. level: (m + 1,) whether a curve there is to begin or end along a line.
        way: (2, K, m + 1, 2) what arrives at joints, and leaves them.
        cuts: (m + 1,) the joints at which runs end: corners, kinks, ends of lines. upright: (m + 1,) those at which it
            has a horizontal or vertical extremum, in all masters.
        stored: what is of it. mixes: (M, K) weights of the masters with which joints are looked at. corners: (V, K)
            those at the corners of the design space's grid, and outline: (m V, 4, 2) the contour there.
    """

    cubics: FloatArray
    line: BoolArray
    joints: Joints
    slack: FloatArray
    least: FloatArray
    own: FloatArray
    reach: FloatArray
    level: BoolArray
    way: FloatArray
    cuts: BoolArray
    upright: BoolArray
    stored: Stored
    mixes: FloatArray
    corners: FloatArray
    outline: FloatArray


@compiled
def read_contour(
    cubics: FloatArray, degrees: IntArray, settings: Settings, tolerance: float, stored: Stored, corners: FloatArray,
    mixes: FloatArray,
) -> Given:  # fmt: skip
    """A contour, its joints, and the tangents at these: at the ends of lines that are met smoothly, the lines'."""
    K, m = cubics.shape[:2]
    joints, line = find_joints(cubics, degrees, settings.near, settings.angle, settings.line, settings.c2), degrees == 1
    upright, cuts, way = np.ones(m + 1, np.bool_), joints.corner.copy(), np.empty((2, K, m + 1, 2))
    for w in range(K):
        upright &= set_upright(cubics[w], alone(joints, w))
    slack, least, level = np.full(m + 1, KINK), np.full(m + 1, KINK), np.zeros(m + 1, dtype=np.bool_)
    own, reach = np.zeros(m + 1), np.full((2, m + 1), np.inf)
    for j in range(m):
        for w in range(K):
            _, _, way[0, w, j, 0], way[0, w, j, 1] = directions(cubics[w], j - 1, NO_HANDLE)
            way[1, w, j, 0], way[1, w, j, 1], _, _ = directions(cubics[w], j, NO_HANDLE)
        before, behind, most, fewest_turn = way[0, :, j], way[1, :, j], 0.0, np.inf
        for weights in mixes:
            (ax, ay), (bx, by) = mean(weights, before), mean(weights, behind)
            own[j] = max(own[j], turn_between(ax, ay, bx, by))
            reach[0, j], reach[1, j] = min(reach[0, j], length(ax, ay)), min(reach[1, j], length(bx, by))
        straight = not stored.known and is_roundings(cubics, degrees, j) and line[j - 1] + line[j] < 2
        straight = straight and straightened(before, behind, line[j - 1], line[j], MOVED * tolerance)
        for weights in mixes:
            (ax, ay), (bx, by) = mean(weights, before), mean(weights, behind)
            turn = turn_between(ax, ay, bx, by)
            most, fewest_turn = max(most, turn), min(fewest_turn, turn)
        cuts[j] = cuts[j] or line[j] or line[j - 1] or most > STEEP
        if not cuts[j]:
            for w in range(K if straight else 0):
                set_unit(before[w], joints.arriving[w, j])
                set_unit(behind[w], joints.leaving[w, j])
                upright[j] = upright[j] and (behind[w] == 0.0).any()
            way[0, :, j], way[1, :, j] = joints.arriving[:, j], joints.leaving[:, j]
            continue
        # Only beyond it is a corner still one when both sides have turned a little.
        joints.corner[j] = fewest_turn > BLUNT
        slack[j], least[j] = max(most, KINK), max(fewest_turn, KINK)
        if fewest_turn >= SHARP:  # a little less than a corner's turn would be a kink
            slack[j], least[j] = max(most, 1.1 * CORNER), max(fewest_turn, 1.001 * CORNER)
        level[j] = line[j] != line[j - 1] and most < SMOOTH_KINK
        for w in range(K):
            if line[j] or line[j - 1]:
                k, side = (j, 1) if line[j] else ((j - 1) % m, 0)
                here, there = stored.node[w, k], stored.node[w, (k + 1) % m]
                x, y = np.rint(there[0]) - np.rint(here[0]), np.rint(there[1]) - np.rint(here[1])
                if x != 0.0 or y != 0.0:
                    way[side, w, j, 0], way[side, w, j, 1] = x, y
            set_unit(way[0, w, j], joints.arriving[w, j])
            set_unit(way[1, w, j], joints.leaving[w, j])
    cuts[m], upright[m], level[m] = cuts[0], upright[0], level[0]
    slack[m], least[m], own[m] = slack[0], least[0], own[0]
    reach[:, m] = reach[:, 0]
    joints.corner[m], way[:, :, m] = joints.corner[0], way[:, :, 0]
    joints.arriving[:, m], joints.leaving[:, m] = joints.arriving[:, 0], joints.leaving[:, 0]
    outline = mixed(corners, cubics)
    return Given(
        cubics, line, joints, slack, least, own, reach, level, way, cuts, upright, stored, mixes, corners, outline
    )  # fmt: skip


@compiled
def straightened(
    before: FloatArray, behind: FloatArray, line_before: bool, line_behind: bool, most: float
) -> bool:  # fmt: skip
    """Give handles (K, 2) beside a joint one direction in each master, if none moves its end by more than ``most``;
    whether that is so."""
    stays = np.empty(len(before), np.bool_)
    for w in range(len(before)):
        a, b = before[w], behind[w]
        one, two, turn = length(a[0], a[1]), length(b[0], b[1]), turn_between(a[0], a[1], b[0], b[1])
        level, there = (a == 0.0).any(), (b == 0.0).any()
        stays[w] = one >= two  # rounding turns the longer one least
        if line_before or line_behind:
            stays[w] = line_before
        elif level != there and turn * (two if level else one) <= most:
            stays[w] = level
        if turn * (two if stays[w] else one) > most:
            return False
    for w in range(len(before)):
        a, b = before[w], behind[w]
        ratio = length(b[0], b[1]) / length(a[0], a[1])
        if stays[w]:
            b[0], b[1] = ratio * a[0], ratio * a[1]
        else:
            a[0], a[1] = b[0] / ratio, b[1] / ratio
    return True


@compiled
def set_unit(vector: FloatArray, out: FloatArray) -> None:
    """The direction of a vector."""
    size = max(length(vector[0], vector[1]), 1e-12)
    out[0], out[1] = vector[0] / size, vector[1] / size


@compiled
def mean(weights: FloatArray, vectors: FloatArray) -> tuple[float, float]:
    """The mix of (K, 2) vectors."""
    x = y = 0.0
    for w in range(len(weights)):
        x, y = x + weights[w] * vectors[w, 0], y + weights[w] * vectors[w, 1]
    return x, y


@compiled
def is_ring(cuts: BoolArray, i: int, j: int) -> bool:
    """Whether a run is a whole contour without an end; cuts: (m + 1,) the joints at which runs end."""
    return i == 0 and j == len(cuts) - 1 and not cuts[0]
