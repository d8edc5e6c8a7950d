"""Outlines that quadratics are to follow: their joints, what these may turn by, and what is stored of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np

from ....compiled import compiled
from ....curves.cubics import directions, length
from ....fitting.sharp.corners import NO_HANDLE, SHARP, SMOOTH_KINK, Joints, find_joints, is_roundings, turn_between
from ....fitting.sharp.settings import SharpSettings
from ....types import BoolArray, FloatArray, IntArray
from .chains import LEAST, OWN, REACH, SLACK
from .gates import CORNER, KINK, mixed
from .run_source import set_upright

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


Ends: TypeAlias = tuple[IntArray, BoolArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]
"""What quadratics between two joints meet at their ends: ``first``, ``corner``, ``arriving`` and ``leaving`` of all
joints, and ``way``, ``turns`` and ``node`` of :class:`Given`."""


@dataclass(frozen=True)
class Given:
    """A contour of m segments in K masters.

    Attributes:
        cubics: (K, m, 4, 2). line: (m,). joints: of it.
        way: (2, K, m + 1, 2) what arrives at joints, and leaves them.
        turns: (2, 4, m + 1) what each may turn by, see :class:`.fit.chains.Quads`, before it and behind.
        level: (m + 1,) whether a curve there is to begin or end along a line.
        cuts: (m + 1,) the joints at which runs end: corners, kinks, ends of lines. upright: (m + 1,) those at which it
            has a horizontal or vertical extremum, in all masters.
        node: (K, m + 1, 2) where joints are on the grid. off: (m + 1,) how far that is from where they are.
        ends: what quadratics meet at joints. stored: what is of it.
        mixes: (M, K) weights of the masters with which joints are looked at. corners: (V, K) those at the corners of
            the design space's grid, and outline: (m V, 4, 2) the contour there.
    """

    cubics: FloatArray
    line: BoolArray
    joints: Joints
    way: FloatArray
    turns: FloatArray
    level: BoolArray
    cuts: BoolArray
    upright: BoolArray
    node: FloatArray
    off: FloatArray
    ends: Ends
    stored: Stored
    mixes: FloatArray
    corners: FloatArray
    outline: FloatArray


def read_contour(
    cubics: FloatArray, degrees: IntArray, settings: SharpSettings, tolerance: float, stored: Stored,
    corners: FloatArray, mixes: FloatArray,
) -> Given:  # fmt: skip
    """A contour, its joints, and the tangents at these: at the ends of lines that are met smoothly, the lines'."""
    joints = find_joints(cubics, degrees, settings.near, settings.angle, settings.line, settings.c2)
    node = np.rint(np.concatenate((stored.node, stored.node[:, :1]), axis=1))
    gap, line = node - joints.samples[:, joints.first], degrees == 1
    off = np.sqrt(gap[..., 0] * gap[..., 0] + gap[..., 1] * gap[..., 1]).max(axis=0)
    way, turns, level, cuts, upright = read_joints(cubics, degrees, line, joints, stored.known, node, mixes, tolerance)
    ends = joints.first, joints.corner, joints.arriving, joints.leaving, way, turns, node
    outline = mixed(corners, cubics)
    return Given(
        cubics, line, joints, way, turns, level, cuts, upright, node, off, ends, stored, mixes, corners, outline
    )


@compiled
def read_joints(
    cubics: FloatArray, degrees: IntArray, line: BoolArray, joints: Joints, stored: bool, node: FloatArray,
    mixes: FloatArray, tolerance: float,
) -> tuple[FloatArray, FloatArray, BoolArray, BoolArray, BoolArray]:  # fmt: skip
    """``way``, ``turns``, ``level``, ``cuts`` and ``upright`` of :class:`Given`; tangents and corners are set anew."""
    K, m, arriving, leaving = cubics.shape[0], cubics.shape[1], joints.arriving, joints.leaving
    upright, cuts, level = np.ones(m + 1, np.bool_), joints.corner.copy(), np.zeros(m + 1, np.bool_)
    way, turns = np.empty((2, K, m + 1, 2)), np.zeros((2, 4, m + 1))
    own = set_upright(cubics, joints.corner, joints.line, joints.arriving, joints.leaving)
    for w in range(K):
        for j in range(m + 1):
            upright[j] = upright[j] and own[w, j]
    for j in range(m):
        for w in range(K):
            _, _, way[0, w, j, 0], way[0, w, j, 1] = directions(cubics[w], j - 1, NO_HANDLE)
            way[1, w, j, 0], way[1, w, j, 1], _, _ = directions(cubics[w], j, NO_HANDLE)
        before, behind, most, fewest_turn = way[0, :, j], way[1, :, j], 0.0, np.inf
        turns[0, REACH, j] = turns[1, REACH, j] = np.inf
        for weights in mixes:
            (ax, ay), (bx, by) = mean(weights, before), mean(weights, behind)
            turns[0, OWN, j] = max(turns[0, OWN, j], turn_between(ax, ay, bx, by))
            turns[0, REACH, j] = min(turns[0, REACH, j], length(ax, ay))
            turns[1, REACH, j] = min(turns[1, REACH, j], length(bx, by))
        straight = not stored and is_roundings(cubics, degrees, j) and not (line[j - 1] and line[j])
        straight = straight and straightened(before, behind, line[j - 1], line[j], MOVED * tolerance)
        for weights in mixes:
            (ax, ay), (bx, by) = mean(weights, before), mean(weights, behind)
            turn = turn_between(ax, ay, bx, by)
            most, fewest_turn = max(most, turn), min(fewest_turn, turn)
        turns[0, SLACK, j] = turns[0, LEAST, j] = KINK
        cuts[j] = cuts[j] or line[j] or line[j - 1] or most > STEEP
        if not cuts[j]:
            for w in range(K):
                if straight:
                    set_unit(before[w], arriving[w, j])
                    set_unit(behind[w], leaving[w, j])
                    upright[j] = upright[j] and (behind[w, 0] == 0.0 or behind[w, 1] == 0.0)
                for axis in range(2):
                    before[w, axis], behind[w, axis] = arriving[w, j, axis], leaving[w, j, axis]
            continue
        # Only beyond it is a corner still one when both sides have turned a little.
        joints.corner[j] = fewest_turn > BLUNT
        turns[0, SLACK, j], turns[0, LEAST, j] = max(most, KINK), max(fewest_turn, KINK)
        if fewest_turn >= SHARP:  # a little less than a corner's turn would be a kink
            turns[0, SLACK, j], turns[0, LEAST, j] = max(most, 1.1 * CORNER), max(fewest_turn, 1.001 * CORNER)
        level[j] = line[j] != line[j - 1] and most < SMOOTH_KINK
        for w in range(K):
            if line[j] or line[j - 1]:
                k, side = (j, 1) if line[j] else ((j - 1) % m, 0)
                x, y = node[w, k + 1, 0] - node[w, k, 0], node[w, k + 1, 1] - node[w, k, 1]
                if x != 0.0 or y != 0.0:
                    way[side, w, j, 0], way[side, w, j, 1] = x, y
            set_unit(before[w], arriving[w, j])
            set_unit(behind[w], leaving[w, j])
    for j in range(m):
        for k in (SLACK, LEAST, OWN):
            turns[1, k, j] = turns[0, k, j]
    cuts[m], upright[m], level[m], joints.corner[m] = cuts[0], upright[0], level[0], joints.corner[0]
    for side in range(2):
        for k in range(4):
            turns[side, k, m] = turns[side, k, 0]
    for w in range(K):
        for axis in range(2):
            way[0, w, m, axis], way[1, w, m, axis] = way[0, w, 0, axis], way[1, w, 0, axis]
            arriving[w, m, axis], leaving[w, m, axis] = arriving[w, 0, axis], leaving[w, 0, axis]
    return way, turns, level, cuts, upright


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
        level, there = a[0] == 0.0 or a[1] == 0.0, b[0] == 0.0 or b[1] == 0.0
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


def is_ring(cuts: BoolArray, i: int, j: int) -> bool:
    """Whether a run is a whole contour without an end; cuts: (m + 1,) the joints at which runs end."""
    return i == 0 and j == len(cuts) - 1 and not cuts[0]
