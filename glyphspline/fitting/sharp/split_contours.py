"""The contours of a glyph as the sharp mode takes them up: chains of cubics, each begun and directed by its shape.

:mod:`..smooth.canonical_contours` has those of the smooth mode.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...outlines.canonical import directed, farthest_joint
from ...outlines.segments import lasting
from ...types import BoolArray, FloatArray, IntArray
from .corners import Joints, begun_at, find_joints


class Settings(NamedTuple):
    """How contours are cut.

    Attributes:
        near: how near samples have to be. angle: turn in radians from which a joint is a corner.
        line: length from which lines stay lines. margin, residual: of the interpolation.
        rounds: most Gauss-Newton steps an arc. most: spans of an arc. stride: arcs end at corners and at every so many
            joints.
    """

    near: float
    angle: float
    line: float
    margin: float
    residual: float
    rounds: int
    most: int
    stride: int


class Chains(NamedTuple):
    """Contours made ready to be cut: segments of no length dropped, the first joint a hard one if there is any.

    They keep their own direction, in which lines and arcs are put together, and have no use for lengths.

    Attributes:
        cubics: (M, 4, 2) and degrees: (M,) of all, in their own direction; offsets: (C + 1,) where each begins.
        flipped: (C,) whether it is fitted the other way round.
    """

    cubics: FloatArray
    degrees: IntArray
    offsets: IntArray
    flipped: BoolArray


@compiled
def with_ends(cubics: FloatArray, degrees: IntArray) -> tuple[FloatArray, IntArray]:
    """The segments that have a length, those that end where they begin cut in two: an arc needs two ends."""
    those = lasting(cubics)
    found, kept = np.empty((2 * len(those), 4, 2)), np.empty(2 * len(those), dtype=np.int64)
    count = 0
    for j in those:
        b = cubics[j]
        parts = 2 if b[0, 0] == b[3, 0] and b[0, 1] == b[3, 1] else 1
        if parts == 2:
            _halve(b, found[count], found[count + 1])
        else:
            found[count] = b
        kept[count : count + parts] = degrees[j]
        count += parts
    return found[:count].copy(), kept[:count].copy()


@compiled
def _halve(cubic: FloatArray, first: FloatArray, second: FloatArray) -> None:
    for axis in range(2):
        p, q, r, s = cubic[0, axis], cubic[1, axis], cubic[2, axis], cubic[3, axis]
        pq, qr, rs = (p + q) / 2, (q + r) / 2, (r + s) / 2
        left, right = (pq + qr) / 2, (qr + rs) / 2
        middle = (left + right) / 2
        first[0, axis], first[1, axis], first[2, axis], first[3, axis] = p, pq, left, middle
        second[0, axis], second[1, axis], second[2, axis], second[3, axis] = middle, right, rs, s


@compiled
def first_joint(joints: Joints) -> int:
    """A hard joint to begin at, or else that farthest from the middle: the same whatever the contour's first point."""
    m = len(joints.line)
    for j in range(m):
        if joints.hard[j]:
            return j
    return farthest_joint(joints.samples[joints.first[:m]])


@compiled
def laid_out(
    cubics: FloatArray, degrees: IntArray, settings: Settings
) -> tuple[FloatArray, IntArray, bool, Joints]:  # fmt: skip
    """A contour as it is fitted: its chain, whether that runs the other way, and its joints."""
    cubics, degrees = with_ends(cubics, degrees)
    cubics, flipped = directed(cubics)
    if flipped:
        degrees = degrees[::-1].copy()
    joints = find_joints(cubics, degrees, settings.near, settings.angle, settings.line)
    k = first_joint(joints)
    if k > 0:
        cubics, degrees = np.concatenate((cubics[k:], cubics[:k])), np.concatenate((degrees[k:], degrees[:k]))
        joints = begun_at(joints, k)
    return cubics, degrees, flipped, joints
