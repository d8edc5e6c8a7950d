"""The contours of a glyph as the sharp mode takes them: cubics from a hard joint on, with their joints classified.

:mod:`..smooth.canonical_contours` has those of the smooth mode.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import compiled
from ...curves.cubics import split
from ...outlines.segments import begun_at, directed, farthest_joint, lasting
from ...types import BoolArray, FloatArray, IntArray
from ..ladders import Search
from .corners import Joints, find_joints


class Settings(NamedTuple):
    """How contours are cut and fitted.

    Attributes:
        near: how near samples have to be. angle: turn in radians from which a joint is a corner.
        line: length from which lines stay lines.
        c2: whether one spline runs between hard joints, by ``search``; or else cubics.
        rounds: most Gauss-Newton steps of these. stride: they end at corners and at every so many joints.
    """

    near: float
    angle: float
    line: float
    c2: bool
    search: Search
    rounds: int
    stride: int


class SplitContours(NamedTuple):
    """Contours ready to be cut: segments of no length dropped, the first joint a hard one if there is any.

    They keep their own direction, in which lines and arcs are put together.

    Attributes:
        cubics: (K, M, 4, 2) in each master and degrees: (M,) of all, in their own direction; offsets: (C + 1,) where
            each begins.
        flipped: (C,) whether it is fitted the other way round.
    """

    cubics: FloatArray
    degrees: IntArray
    offsets: IntArray
    flipped: BoolArray


@compiled
def with_ends(cubics: FloatArray, degrees: IntArray) -> tuple[FloatArray, IntArray]:
    """The segments that have a length in some master; those that end where they begin are cut in two: an arc needs two
    ends.
    """
    masters, m = len(cubics), len(degrees)
    lasts = np.zeros(m, dtype=np.bool_)
    for v in range(masters):
        for j in lasting(cubics[v]):
            lasts[j] = True
    found, kept = np.empty((masters, 2 * m, 4, 2)), np.empty(2 * m, dtype=np.int64)
    count = 0
    for j in range(m):
        if not lasts[j]:
            continue
        closed = True
        for v in range(masters):
            own = cubics[v, j]
            closed = closed and own[0, 0] == own[3, 0] and own[0, 1] == own[3, 1]
        last = count + 1 if closed else count
        for v in range(masters):
            for k in range(4):
                found[v, last, k, 0], found[v, last, k, 1] = cubics[v, j, k, 0], cubics[v, j, k, 1]
            if closed:
                split(found[v, last], 0.5, found[v, count])
        kept[count] = kept[last] = degrees[j]
        count = last + 1
    return found[:, :count].copy(), kept[:count]


@compiled
def laid_out(cubics: FloatArray, degrees: IntArray, settings: Settings) -> tuple[FloatArray, IntArray, bool, Joints]:
    """A contour as it is fitted: its cubics, their degrees, whether they run the other way, and its joints.

    It begins at a hard joint, or else at that farthest from the middle: the same whatever the contour's first point.
    Direction and that joint are those of the first master.
    """
    chain, kept = with_ends(cubics, degrees)
    masters, m = len(chain), len(kept)
    _, flipped = directed(chain[0])
    if flipped:
        chain = chain[:, ::-1, ::-1].copy()
        for j in range(m // 2):
            kept[j], kept[m - 1 - j] = kept[m - 1 - j], kept[j]
    joints = find_joints(chain, kept, settings.near, settings.angle, settings.line, settings.c2)
    k = 0
    while k < m and not joints.hard[k]:
        k += 1
    if k == m:
        k = farthest_joint(chain[0, :, 0])
    if k == 0:
        return chain, kept, flipped, joints
    turned, own = np.empty((masters, m, 4, 2)), np.empty(m, dtype=np.int64)
    for v in range(masters):
        turned[v] = begun_at(chain[v], k)
    for j in range(m):
        own[j] = kept[(j + k) % m]
    return turned, own, flipped, find_joints(turned, own, settings.near, settings.angle, settings.line, settings.c2)
