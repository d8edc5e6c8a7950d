"""The measures of all contours of a glyph, in one compiled call."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .arcs import jit
from .arrays import FloatArray, IntArray
from .chains import Flat, contour_cubics
from .crossings import _count, flatten, overshoot
from .measure import NODES, WEIGHTS, _shape


class Survey(NamedTuple):
    """Measures of C contours, (C,) each; see :class:`.glyph.Measures`. Crossings are those of the result and of the
    source, each by itself.
    """

    length: FloatArray
    area_change: FloatArray
    bending_energy: FloatArray
    max_curvature: FloatArray
    overshoot: FloatArray
    crossings: IntArray
    source_crossings: IntArray


def survey(result: Flat, source: Flat, polygons: FloatArray, offsets: IntArray) -> Survey:
    """Measure contours.

    Args:
        result: the curves; source: what they were fitted to.
        polygons: (n, 2) their vertices; offsets: (C + 1,) where each contour's begin.
    """
    return Survey(*_survey(result, source, polygons, offsets, NODES, WEIGHTS))


@jit
def _survey(
    result: Flat, source: Flat, polygons: FloatArray, offsets: IntArray, nodes: FloatArray, weights: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, IntArray, IntArray]:
    C = len(offsets) - 1
    length, change, energy, curvature, beyond = np.empty(C), np.empty(C), np.empty(C), np.empty(C), np.empty(C)
    crossings, before = np.empty(C, dtype=np.int64), np.empty(C, dtype=np.int64)
    for c in range(C):
        cubics, given = contour_cubics(result, c), contour_cubics(source, c)
        length[c], area, energy[c], curvature[c] = _shape(cubics, nodes, weights)
        change[c] = area - _shape(given, nodes, weights)[1]
        beyond[c] = overshoot(cubics, polygons[offsets[c] : offsets[c + 1]])
        crossings[c], before[c] = _count(flatten(cubics)), _count(flatten(given))
    return length, change, energy, curvature, beyond, crossings, before
