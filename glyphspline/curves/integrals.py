"""What can be said of a closed chain of cubics: its length, area and curvature."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import compiled
from ..types import FloatArray
from .cubics import jet

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
"""For integrals over a Bézier piece; exact for areas, converged for the rest but at near-cusps."""

CURVATURE_STEPS = 32
"""Steps a piece at whose ends curvature is looked at for its maximum."""


class Shape(NamedTuple):
    """Measures of a curve; lengths in font units.

    Attributes:
        length: arc length. area: signed, positive if it runs counter-clockwise.
        bending_energy: integral of the squared curvature over arc length, in 1/unit; infinite at a cusp.
        max_curvature: largest absolute curvature, in 1/unit; infinite at a cusp.
    """

    length: float
    area: float
    bending_energy: float
    max_curvature: float


def shape(pieces: FloatArray) -> Shape:
    """Measure a closed chain of cubics (m, 4, 2)."""
    return Shape(*integrals(np.ascontiguousarray(pieces)))


@compiled
def integrals(pieces: FloatArray) -> tuple[float, float, float, float]:
    """The numbers of a :class:`Shape`, of some cubics (m, 4, 2), closed or not."""
    length = area = energy = highest = 0.0
    for s in range(len(pieces)):
        for k in range(len(NODES)):
            x, y, dx, dy, ax, ay = jet(pieces, s, (NODES[k] + 1) / 2)
            speed = np.hypot(dx, dy)
            length += WEIGHTS[k] * speed / 2
            area += WEIGHTS[k] * (x * dy - y * dx) / 4
            curvature = _curvature(dx, dy, ax, ay)
            energy += WEIGHTS[k] * curvature * curvature * speed / 2 if speed > 0 else np.inf
        for k in range(CURVATURE_STEPS + 1):
            _, _, dx, dy, ax, ay = jet(pieces, s, k / CURVATURE_STEPS)
            highest = max(highest, _curvature(dx, dy, ax, ay))
    return length, area, energy, highest


@compiled
def _curvature(dx: float, dy: float, ax: float, ay: float) -> float:
    """Absolute curvature. Dividing by the speed three times keeps tiny and huge curves from under- and overflow."""
    square = dx * dx + dy * dy
    if 1e-60 < square < 1e60:
        return abs(dx * ay - dy * ax) / (square * np.sqrt(square))
    speed = np.hypot(dx, dy)
    if speed == 0:
        return np.inf
    return abs(dx / speed * (ay / speed) - dy / speed * (ax / speed)) / speed


def area(pieces: FloatArray) -> float:
    """Signed area of a closed chain of cubics (m, 4, 2), positive if it runs counter-clockwise."""
    return shape(pieces).area
