"""Measures of a closed chain of cubics that only experiments and tests need."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from glyphspline.curves.bezier import cross, derivative_points
from glyphspline.curves.integrals import NODES, WEIGHTS, area, integrals
from glyphspline.types import FloatArray

PARTS = 4
"""Parts of a piece for the integral of the variation, so that its nodes meet sharp turns."""


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
    pieces = np.ascontiguousarray(pieces)
    length, energy, curvature = integrals(pieces)
    return Shape(length, area(pieces), energy, curvature)


def curvature_variation(cubics: FloatArray) -> float:
    """∫(dκ/ds)² ds in 1/unit³ along cubics (m, 4, 2), without the jumps of curvature between them; large at a cusp."""
    t = (np.arange(PARTS)[:, None] + (NODES + 1) / 2).ravel() / PARTS
    a, b, c = np.moveaxis(derivative_points(cubics), 1, 0)[:, :, None]  # of the velocity
    b, c = 2 * (b - a), c - 2 * b + a
    x = t[:, None]
    velocity, acceleration = a + x * (b + x * c), b + 2 * x * c
    bend, squared = cross(velocity, acceleration), (velocity**2).sum(axis=2)
    straight = np.abs(bend) <= 1e-12 * squared
    squared = np.where(straight, 1.0, squared)
    slope = cross(velocity, 2 * c + 0 * x) * squared - 3 * bend * (velocity * acceleration).sum(axis=2)
    with np.errstate(divide="ignore"):
        own = np.where(straight, 0.0, slope**2 / squared**5.5)
    return float((own * np.tile(WEIGHTS, PARTS)).sum() / (2 * PARTS))
