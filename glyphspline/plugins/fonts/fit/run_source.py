"""What cubics as fonts store them follow: a contour with its joints and extrema, and stretches between its cuts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ....arrays import put
from ....compiled import compiled
from ....curves.cubics import directions
from ....fitting.sharp.corners import NO_HANDLE, Joints, find_joints
from ....fitting.sharp.settings import SharpSettings
from ....outlines.segments import farthest_joint
from ....types import BoolArray, FloatArray, IntArray
from ..extrema import hidden_extrema
from .gates import FitLimits, mixed, refused
from .run_nodes import CubicRun, Guide

UPRIGHT = np.sin(np.radians(1.5))
"""Sine of the angle to an axis up to which the tangent at an extremum is the axis."""


@compiled
def cut_at(joints: Joints) -> BoolArray:
    """(m + 1,) the joints at which runs end: corners, and the ends of long lines."""
    m = len(joints.line)
    found = joints.corner.copy()
    for j in range(m):
        found[j] = found[j] or joints.line[j] or joints.line[j - 1]
    found[m] = found[0]
    return found


@compiled
def set_upright(
    cubics: FloatArray, corner: BoolArray, line: BoolArray, arriving: FloatArray, leaving: FloatArray
) -> BoolArray:
    """(K, m + 1) at which smooth joints of a contour (K, m, 4, 2) the outline is horizontal or vertical.

    Their tangents become the axis.

    Args:
        corner, line, arriving, leaving: of :class:`.corners.Joints`.
    """
    K, m = cubics.shape[:2]
    found = np.zeros((K, m + 1), dtype=np.bool_)
    for v in range(K):
        for j in range(m):
            if corner[j] or line[j] or line[j - 1]:
                continue
            x, y = leaving[v, j, 0], leaving[v, j, 1]
            _, _, bx, by = directions(cubics[v], j - 1, NO_HANDLE)
            ax, ay, _, _ = directions(cubics[v], j, NO_HANDLE)
            flat = ay == 0.0 or by == 0.0
            upright = ax == 0.0 or bx == 0.0
            if (flat or upright) and min(abs(x), abs(y)) < UPRIGHT:
                x, y = (np.sign(x), 0.0) if abs(x) > abs(y) else (0.0, np.sign(y))
                leaving[v, j, 0], leaving[v, j, 1] = x, y
                arriving[v, j, 0], arriving[v, j, 1] = x, y
                found[v, j] = True
        found[v, m] = found[v, 0]
        for axis in range(2):
            leaving[v, m, axis], arriving[v, m, axis] = leaving[v, 0, axis], arriving[v, 0, axis]
    return found


@compiled
def read_source(
    cubics: FloatArray, degrees: IntArray, how: tuple[float, float, float, bool], corners: FloatArray, mixes: FloatArray
) -> tuple[Any, ...]:
    """A contour (K, m, 4, 2) from its first cut on, or else from the joint farthest from the middle.

    Args:
        how: ``near``, ``angle``, ``line`` and ``c2`` of :class:`.settings.Settings`. corners, mixes: of ``Limits``.

    Returns:
        The number of that joint; whether any run is to be fitted; and the arrays of :class:`Source`.
    """
    (K, m), (near, angle, line, c2) = cubics.shape[:2], how
    chain, types, joints, k = cubics, degrees, find_joints(cubics, degrees, near, angle, line, c2), 0
    cuts = cut_at(joints)
    while k < m and not cuts[k]:
        k += 1
    if k == m:
        k = farthest_joint(cubics[0, :, 0])
    if k > 0:
        chain, types = np.empty_like(cubics), np.empty_like(degrees)
        for j in range(m):
            types[j] = degrees[(j + k) % m]
            for v in range(K):
                put(cubics[v, (j + k) % m], chain[v, j])
        joints = find_joints(chain, types, near, angle, line, c2)
        cuts = cut_at(joints)
    alone, extrema, fitted = np.ones(m, np.bool_), np.zeros((K, m + 1), np.int64), False
    for j in range(m):
        for v in range(K):
            extrema[v, j + 1] = extrema[v, j] + hidden_extrema(chain[v, j])
            for i in range(2, 6):
                p = chain[v, j, i // 2, i % 2]
                alone[j] = alone[j] and (types[j] == 1 or not abs(p - np.rint(p)) > 1e-6)
        fitted = fitted or not (cuts[j] and cuts[j + 1] and alone[j])
    upright = set_upright(chain, joints.corner, joints.line, joints.arriving, joints.leaving)
    outline, looks = mixed(corners, chain), mixed(mixes, chain)
    return k, fitted, (chain, types, joints, cuts, alone, upright, extrema, outline, looks)


@dataclass(frozen=True, eq=False)
class RunSource:
    """A contour of m segments in K masters, which begins at a cut, if it has any.

    Attributes:
        limits: of the fit. cubics: (K, m, 4, 2). degrees: (m,). joints: of it; at extrema their tangents are axes.
        cuts: (m + 1,) the joints at which runs end. alone: (m,) segments that stay as they are between two cuts.
        upright: (K, m + 1) see :func:`set_upright`. extrema: (K, m + 1) inside all segments before each joint.
        outline: (m V, 4, 2), looks: (m M, 4, 2) the contour at the corners and in the mixes of the limits.
    """

    limits: FitLimits
    cubics: FloatArray
    degrees: IntArray
    joints: Joints
    cuts: BoolArray
    alone: BoolArray
    upright: BoolArray
    extrema: IntArray
    outline: FloatArray
    looks: FloatArray

    @classmethod
    def of(
        cls, cubics: FloatArray, degrees: IntArray, settings: SharpSettings, limits: FitLimits
    ) -> tuple[int, RunSource | None]:  # fmt: skip
        """The joint of a contour at which the source begins, and this; None: no run is to be fitted."""
        how = settings.near, settings.angle, settings.line, settings.c2
        k, fitted, arrays = read_source(cubics, degrees, how, limits.corners, limits.mixes)
        return k, cls(limits, *arrays) if fitted else None


@dataclass(frozen=True, eq=False)
class Stretch:
    """The n segments of a contour from joint i to joint j, between which there is no cut.

    Attributes:
        closed: whether it is a whole contour without a cut. cubics: (K, n, 4, 2). degrees: (n,).
        guides: what a run follows in each master.
    """

    source: RunSource
    i: int
    closed: bool
    cubics: FloatArray
    degrees: IntArray
    guides: tuple[Guide, ...]

    @classmethod
    def of(cls, source: RunSource, i: int, j: int, closed: bool) -> Stretch:
        """The stretch between two joints."""
        own, joints = slice(i, j + 1), source.joints
        first, corner, upright = joints.first[own], joints.corner[own], source.upright[:, own]
        ends = zip(joints.samples, upright, joints.arriving[:, own], joints.leaving[:, own], strict=True)
        guides = tuple(Guide(samples, first, corner, flat, before, behind) for samples, flat, before, behind in ends)
        return cls(source, i, closed, source.cubics[:, i:j].copy(), source.degrees[i:j], guides)

    @property
    def limits(self) -> FitLimits:
        """Of the fit."""
        return self.source.limits

    def extrema(self, places: IntArray) -> IntArray:
        """(K, r) the extrema inside the segments from each of (r + 1,) nodes to the next."""
        before = self.source.extrema[:, self.i + places]
        found: IntArray = np.ascontiguousarray(before[:, 1:] - before[:, :-1])
        return found

    def run(self, P: FloatArray, held: BoolArray, places: IntArray, extrema: IntArray, ease: FloatArray) -> CubicRun:
        """A run of cubics (r, 4, 2) in one master, of which no jump may stay."""
        n = len(places)
        return CubicRun(
            P, held, np.empty(n, np.int64), np.empty((n, 2)), places, extrema, ease, np.zeros(n), self.closed
        )

    def refused(
        self, P: FloatArray, places: IntArray, extrema: IntArray, held: BoolArray, share: float, gates: int,
        single: BoolArray,
    ) -> BoolArray:  # fmt: skip
        """(r,) the cubics (K, r, 4, 2) of a run that a gate refuses, see :func:`.fit.gates.refused`.

        Args:
            share: of the tolerance, to be certified within.
        """
        source, limits = self.source, self.source.limits
        found: BoolArray = refused(
            P, (places, extrema, held, self.closed, self.i),
            (source.cubics, source.outline, source.looks, source.joints.corner), (limits.corners, limits.mixes),
            limits.em, share * limits.tolerance, gates, single,
        )  # fmt: skip
        return found
