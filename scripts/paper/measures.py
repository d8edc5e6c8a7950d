"""Measures of a closed chain of cubics that only experiments and tests need."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from glyphspline.curves.integrals import area, integrals
from glyphspline.types import FloatArray


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
