"""Where a contour is not smooth: corners, smaller breaks of the tangent, and breaks of curvature."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..curves.comb import end_curvatures
from ..curves.cubics import turns
from ..types import BoolArray, FloatArray
from .outline import Contour
from .sampling import CORNER_ANGLE

Kind = Literal["corner", "G1", "G2"]


@dataclass(frozen=True, eq=False)
class Joins:
    """The joins of a closed contour's segments; row j is the beginning of segment j.

    Attributes:
        points: (m, 2).
        turns: (m,) turn of the tangent in radians, positive to the left.
        jumps: (m,) curvature after less curvature before, in 1/unit.
    """

    points: FloatArray
    turns: FloatArray
    jumps: FloatArray

    def of(self, kind: Kind, least_jump: float) -> BoolArray:
        """(m,) which joins are of the kind: corners, smaller breaks of the tangent (G1), or of curvature alone (G2).

        A join has at most one kind. ``least_jump`` is the smallest jump of curvature that counts, in 1/unit.
        """
        turn = np.degrees(np.abs(self.turns))
        # Degrees of turn from which a tangent is broken: rounding to whole units turns smooth joins by less.
        corner, broken = turn >= CORNER_ANGLE, turn >= 0.5
        if kind == "corner":
            return corner
        return broken & ~corner if kind == "G1" else ~broken & (np.abs(self.jumps) >= least_jump)


def joins(contour: Contour) -> Joins:
    """Tangents and curvatures on the two sides of every join."""
    pieces = contour.cubics()
    curvature = end_curvatures(pieces)
    return Joins(pieces[:, 0], turns(pieces, 0.0), curvature[:, 0] - np.roll(curvature[:, 1], 1))
