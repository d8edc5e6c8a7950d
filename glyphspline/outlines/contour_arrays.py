"""The contours of a glyph end to end, as both modes take them up.

All contours lie one after the other in flat arrays, so that compiled code sees a glyph and Python a single call.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..curves.cubics import jit, raised
from ..types import FloatArray, IntArray
from .outline import Contour


class Flat(NamedTuple):
    """Contours end to end.

    Attributes:
        points: (N, 2) and degrees: (m,) of all contours, each as :class:`.outline.Contour` has them.
        offsets: (C + 1,) where in ``degrees``, starts: (C + 1,) where in ``points`` each contour begins.
    """

    points: FloatArray
    degrees: IntArray
    offsets: IntArray
    starts: IntArray


def flattened(contours: Sequence[Contour]) -> Flat:
    """Contours end to end."""
    offsets, starts = np.zeros((2, len(contours) + 1), dtype=np.int64)
    np.cumsum([len(contour.degrees) for contour in contours], out=offsets[1:])
    np.cumsum([len(contour.points) for contour in contours], out=starts[1:])
    points = np.concatenate([contour.points for contour in contours])
    return Flat(points, np.concatenate([contour.degrees for contour in contours]), offsets, starts)


def unflattened(flat: Flat) -> list[Contour]:
    """The contours one by one."""
    ends = zip(pairwise(flat.starts.tolist()), pairwise(flat.offsets.tolist()), strict=True)
    return [Contour(flat.points[a:b], flat.degrees[i:j]) for (a, b), (i, j) in ends]


@jit
def contour_cubics(flat: Flat, c: int) -> FloatArray:
    """(m, 4, 2) the segments of contour c as cubics."""
    return raised(flat.points[flat.starts[c] : flat.starts[c + 1]], flat.degrees[flat.offsets[c] : flat.offsets[c + 1]])


@jit
def lasting(cubics: FloatArray) -> IntArray:
    """Indices of the segments of a chain that have a length."""
    found, count = np.empty(len(cubics), dtype=np.int64), 0
    for j in range(len(cubics)):
        b = cubics[j]
        for k in range(1, 4):
            if b[k, 0] != b[0, 0] or b[k, 1] != b[0, 1]:
                found[count] = j
                count += 1
                break
    return found[:count]
