"""What is at the joints of a contour in all its masters: handles, level ones, and points that may move for a joint."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ...outlines.flaws.turns import joint_controls, turns_of
from ...outlines.masters import MasterContour
from ...types import BoolArray, FloatArray, IntArray

EXACT = 1e-9
"""Difference of coordinates up to which they are equal."""

LONG = 20.0
"""Chord of a curve, in thousandths of an em, from which its curvature is to meet its neighbour's."""

SMOOTH = 12.0
"""Degrees from which a joint ends an arc, whose curves may slip along each other."""

MIDWAY = 1e-6
"""Distance from midway between two control points of quadratics up to which a point is implied by them."""

Move = tuple[IntArray, FloatArray]
"""Numbers (P,) of points in a contour, and their new places (K, P, 2)."""


def starts_of(contour: MasterContour) -> IntArray:
    """(m,) number of the point where each segment begins."""
    starts: IntArray = np.cumsum(contour.degrees) - contour.degrees
    return starts


class ContourLayout:
    """A contour in K masters, of N points and m segments.

    Attributes:
        points: (K, N, 2). degrees: (m,). starts: (m,) number of the point where each segment begins.
        is_node: (N,) points on the curve. implied: (N,) those midway between control points of quadratics, in all
            masters: they move with these. handles: (m, 2) numbers of the points before and behind each joint.
    """

    def __init__(self, contour: MasterContour) -> None:
        self.contour, self.points, self.degrees = contour, contour.points, contour.degrees
        count = self.points.shape[1]
        self.starts = starts_of(contour)
        self.is_node: BoolArray = np.zeros(count, dtype=np.bool_)
        self.is_node[self.starts] = True
        self.handles = np.column_stack([self.starts - 1, self.starts + 1]) % count
        self.implied: BoolArray = np.zeros(count, dtype=np.bool_)
        both = (self.degrees == 2) & (np.roll(self.degrees, 1) == 2)
        before, behind = (self.points[:, each] for each in self.handles.T)
        off = np.abs(self.points[:, self.starts] - (before + behind) / 2).max(axis=(0, 2))
        self.implied[self.starts[both & (off < MIDWAY)]] = True

    @cached_property
    def frozen(self) -> BoolArray:
        """(K, N, 2) coordinates of points that stay: of lines and handles that are level in all masters, or at a joint
        whose other one is level, too. A short handle alone is level by rounding."""
        level = np.abs(self.points - np.roll(self.points, -1, axis=1)) <= EXACT
        level &= (self.is_node | np.roll(self.is_node, -1))[:, None]
        both = level & np.roll(level, 1, axis=1) & self.is_node[:, None]
        level &= level.all(axis=0) | both | np.roll(both, -1, axis=1)
        found: BoolArray = level | np.roll(level, 1, axis=1)
        return found

    @cached_property
    def turns(self) -> FloatArray:
        """(K, m) degrees by which joints turn; NaN where a side has no direction."""
        return turns_of(joint_controls(self.contour))

    def obstacle(self, joint: int, kind: str, em: float) -> str | None:
        """Why a joint cannot be mended, or None."""
        if (self.degrees[[joint - 1, joint]] == 1).all():
            return "is between two lines"
        if kind == "jump":
            ends = self.points[:, self.starts[[joint - 1, joint, (joint + 1) % len(self.starts)]]]
            if np.linalg.norm(np.diff(ends, axis=1), axis=-1).min() < LONG * em / 1000:
                return "is beside a short curve"
        at = np.append(self.handles[joint], self.starts[joint])
        if np.abs(self.points[:, at[:2]] - self.points[:, at[2:]]).max(axis=2).min() <= EXACT:
            return "has a handle of no length"
        return None

    def around(self, joint: int) -> IntArray:
        """(5,) numbers of the points two before a joint to two behind it."""
        return np.arange(self.starts[joint] - 2, self.starts[joint] + 3) % self.points.shape[1]

    def free(self, joint: int, far: int, node: bool) -> list[int]:
        """Numbers of the points that may move for a joint: its handles, those at the other ends, the node.

        With ``far`` of 2 the smooth joints at the other ends move, too, and so do their handles.
        """
        at, count = int(self.starts[joint]), self.points.shape[1]
        found = [at] if node else []
        for side, degree in ((-1, self.degrees[joint - 1]), (1, self.degrees[joint])):
            if degree > 1:
                found.append((at + side) % count)
            if far and degree == 3:
                found.append((at + 2 * side) % count)
            if far and degree == 2 and self.implied[(at + 2 * side) % count]:
                found.append((at + 3 * side) % count)
        if far == 2:
            for other in ((joint - 1) % len(self.degrees), (joint + 1) % len(self.degrees)):
                if np.abs(self.turns[:, other]).max() < SMOOTH:
                    found += self.free(other, 0, True)
        return [point for point in found if not self.implied[point]]
