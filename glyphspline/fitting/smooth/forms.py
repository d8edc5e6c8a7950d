"""What can be said of closed chains of cubics, for whole glyphs: length, area, curvature, crossings, overshoot."""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.crossings import crossings_and_overshoot
from ...curves.integrals import integrals
from ...types import FloatArray, IntArray

LENGTH, AREA, ENERGY, CURVATURE, OVERSHOOT, CROSSINGS = range(6)
"""Columns of what :func:`forms` gives."""


@compiled
def forms(pieces: FloatArray, offsets: IntArray, polygons: FloatArray, corners: IntArray) -> FloatArray:
    """(K, 6) measures of ragged closed chains of cubics.

    Args:
        pieces: (N, 4, 2) with ``offsets``. polygons: ragged, with offsets ``corners``: the overshoot is the largest
            distance of the curve outside a polygon's convex hull. Without polygons it is 0.
    """
    found = np.empty((len(offsets) - 1, 6))
    for k in range(len(offsets) - 1):
        part = pieces[offsets[k] : offsets[k + 1]]
        polygon = polygons[corners[k] : corners[k + 1]] if len(polygons) > 0 else polygons
        found[k, LENGTH], found[k, AREA], found[k, ENERGY], found[k, CURVATURE] = integrals(part)
        found[k, CROSSINGS], found[k, OVERSHOOT] = crossings_and_overshoot(part, polygon)
    return found
