"""The contours of a glyph as the sharp mode takes them up: chains of cubics, each begun and directed by its shape.

All contours lie one after the other in flat arrays, so that compiled code sees a glyph and Python a single call.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .arcs import jit, raised
from .arrays import BoolArray, FloatArray, IntArray
from .joints import Joints, begun_at, find_joints
from .orientation import farthest_joint, flip, runs_backwards


class Flat(NamedTuple):
    """Contours end to end.

    Attributes:
        points: (N, 2) and degrees: (m,) of all contours, each as :class:`.outline.Contour` has them.
        offsets: (C + 1,) where in ``degrees``, starts: (C + 1,) where in ``points`` each contour begins.
    """

    points: FloatArray
    degrees: IntArray
    offsets: IntArray
    starts: IntArray


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

    Attributes:
        cubics: (M, 4, 2) and degrees: (M,) of all, in their own direction; offsets: (C + 1,) where each begins.
        flipped: (C,) whether it is fitted the other way round.
    """

    cubics: FloatArray
    degrees: IntArray
    offsets: IntArray
    flipped: BoolArray


@jit
def contour_cubics(flat: Flat, c: int) -> FloatArray:
    """(m, 4, 2) the segments of contour c as cubics."""
    return raised(flat.points[flat.starts[c] : flat.starts[c + 1]], flat.degrees[flat.offsets[c] : flat.offsets[c + 1]])


@jit
def with_ends(cubics: FloatArray, degrees: IntArray) -> tuple[FloatArray, IntArray]:
    """The segments that have a length, those that end where they begin cut in two: an arc needs two ends."""
    m = len(cubics)
    found, kept = np.empty((2 * m, 4, 2)), np.empty(2 * m, dtype=np.int64)
    count = 0
    for j in range(m):
        b = cubics[j]
        still = closed = True
        for axis in range(2):
            closed &= b[0, axis] == b[3, axis]
            for k in range(1, 4):
                still &= b[k, axis] == b[0, axis]
        if still:
            continue
        kept[count] = degrees[j]
        for axis in range(2):
            p, q, r, s = b[0, axis], b[1, axis], b[2, axis], b[3, axis]
            pq, qr, rs = (p + q) / 2, (q + r) / 2, (r + s) / 2
            left, right = (pq + qr) / 2, (qr + rs) / 2
            middle = (left + right) / 2
            whole, halves = (p, q, r, s), (p, pq, left, middle, right, rs, s)
            for k in range(4):
                found[count, k, axis] = halves[k] if closed else whole[k]
                if closed:
                    found[count + 1, k, axis] = halves[3 + k]
        if closed:
            count += 1
            kept[count] = degrees[j]
        count += 1
    return found[:count].copy(), kept[:count].copy()


@jit
def first_joint(joints: Joints) -> int:
    """A hard joint to begin at, or else that farthest from the middle: the same whatever the contour's first point."""
    m = len(joints.line)
    for j in range(m):
        if joints.hard[j]:
            return j
    return farthest_joint(joints.samples[joints.first[:m]])


@jit
def laid_out(
    cubics: FloatArray, degrees: IntArray, settings: Settings
) -> tuple[FloatArray, IntArray, bool, Joints]:  # fmt: skip
    """A contour as it is fitted: its chain, whether that runs the other way, and its joints."""
    cubics, degrees = with_ends(cubics, degrees)
    flipped = runs_backwards(cubics)
    if flipped:
        cubics, degrees = flip(cubics), degrees[::-1].copy()
    joints = find_joints(cubics, degrees, settings.near, settings.angle, settings.line)
    k = first_joint(joints)
    if k > 0:
        cubics, degrees = np.concatenate((cubics[k:], cubics[:k])), np.concatenate((degrees[k:], degrees[:k]))
        joints = begun_at(joints, k)
    return cubics, degrees, flipped, joints
