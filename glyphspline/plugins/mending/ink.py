"""Whether a glyph keeps its ink: what it fills, its islands and its counters, wherever it is looked at."""

from __future__ import annotations

import numpy as np

from ...outlines.contour_arrays import ContourArrays, end_to_end
from ...outlines.masters import Masters
from ...outlines.regions import ink_difference
from ...types import FloatArray
from .state import PER_EM, Design

FLATNESS = 0.02
"""Share of the tolerance, 1/1000 em at most, by which polygons are off the curves."""

INK = "would change the ink"
"""Why a move is not made."""


def keeps_ink(old: Masters, new: Masters, design: Design) -> bool:
    """Whether two drawings of a glyph fill the same, in all masters, at corners of the design space, and along axes.

    The area that only one of them fills is at most the tolerance times the length of the outline, and no island and no
    counter comes or goes.
    """
    flatness = FLATNESS * min(design.tolerance, PER_EM * design.em)
    for weights in np.unique(np.concatenate([design.corners, design.places]), axis=0):
        found = ink_difference(_mixed(old, weights), _mixed(new, weights), flatness)
        if found.lost or found.gained or found.area + found.error > design.tolerance * found.length:
            return False
    return True


def _mixed(glyph: Masters, weights: FloatArray) -> ContourArrays:
    """The contours with weights (K,) of the masters."""
    return end_to_end([(np.tensordot(weights, each.points, axes=1), each.degrees) for each in glyph.contours])
