"""The measures of all contours of a glyph cut into lines and arcs, in one compiled call.

For closed curves, which have no lines, :mod:`.smooth.forms` has the same numbers.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import compiled
from ..curves.crossings import crossings_and_overshoot
from ..curves.integrals import integrals
from ..outlines.contour_arrays import ContourArrays
from ..outlines.segments import contour_cubics
from ..types import FloatArray, IntArray


class Survey(NamedTuple):
    """Measures of C contours, (C,) each; see :class:`.results.Measures`. Crossings are those of the result and of the
    source, each by itself.
    """

    length: FloatArray
    area_change: FloatArray
    bending_energy: FloatArray
    max_curvature: FloatArray
    overshoot: FloatArray
    crossings: IntArray
    source_crossings: IntArray


@compiled
def survey(result: ContourArrays, source: ContourArrays, polygons: FloatArray, offsets: IntArray) -> Survey:
    """Measure contours.

    Args:
        result: the curves; source: what they were fitted to.
        polygons: (n, 2) their vertices; offsets: (C + 1,) where each contour's begin.
    """
    C = len(offsets) - 1
    length, change, energy, curvature, beyond = np.empty(C), np.empty(C), np.empty(C), np.empty(C), np.empty(C)
    crossings, before = np.empty(C, dtype=np.int64), np.empty(C, dtype=np.int64)
    for c in range(C):
        cubics, given = contour_cubics(result, c), contour_cubics(source, c)
        length[c], energy[c], curvature[c] = 0.0, 0.0, 0.0
        for j in range(len(cubics)):
            if result.degrees[result.offsets[c] + j] == 1:
                length[c] += np.hypot(cubics[j, 3, 0] - cubics[j, 0, 0], cubics[j, 3, 1] - cubics[j, 0, 1])
                continue
            own_length, _, own_energy, own_curvature = integrals(cubics[j : j + 1])
            length[c] += own_length
            energy[c] += own_energy
            curvature[c] = max(curvature[c], own_curvature)
        change[c] = _area(cubics) - _area(given)
        crossings[c], beyond[c] = crossings_and_overshoot(cubics, polygons[offsets[c] : offsets[c + 1]])
        before[c], _ = crossings_and_overshoot(given, polygons[:0])
    return Survey(length, change, energy, curvature, beyond, crossings, before)


@compiled
def _area(cubics: FloatArray) -> float:
    """Signed area of a closed chain, lines among it, exactly: the integral of its Bézier points' products."""
    total = 0.0
    for b in cubics:
        for i, j, weight in ((0, 1, 6), (0, 2, 3), (0, 3, 1), (1, 2, 3), (1, 3, 3), (2, 3, 6)):
            total += weight * (b[i, 0] * b[j, 1] - b[i, 1] * b[j, 0])
    return total / 20
