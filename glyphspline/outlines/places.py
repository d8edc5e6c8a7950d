"""Places of vertices on contours, by step or by count, compiled.

A *place* j + x on a contour is local parameter x of its segment j. Distances along a contour come from a table of
chord lengths: they determine the spacing only, and vertices lie on the outline exactly.
"""

from __future__ import annotations

import numpy as np

from ..arrays import grown
from ..compiled import compiled
from ..curves.cubics import bernstein, length_table, turns
from ..types import BoolArray, FloatArray, IntArray

TABLE = 32
"""Steps per segment in the table of arc lengths."""

TIE = 1e-6
"""Tolerance of rounding and comparison: exact halves and ratios at their bound are common on straight lines."""

WEIGHTS = bernstein(TABLE)


@compiled
def sampled(
    cubics: FloatArray, offsets: IntArray, step: float, count: int, max_ratio: float, corner_angle: float, most: int
) -> tuple[FloatArray, FloatArray, IntArray, BoolArray]:
    """Vertices on all contours.

    Args:
        cubics: (M, 4, 2). offsets: (K + 1,) where contours begin.
        step: in font units, or 0 to sample by ``count`` vertices per contour.
        max_ratio: of adjacent spacings. corner_angle: turn in radians from which a joint is a corner.
        most: maximum number of vertices of a contour.

    Returns:
        (N, 2) vertices; (N,) their places, increasing within a contour; (K + 1,) where each polygon begins; (K,)
        whether a contour would need more than ``most`` vertices; such a contour has none.
    """
    contours = len(offsets) - 1
    found = np.empty((1024, 3))
    ends = np.zeros(contours + 1, dtype=np.int64)
    refused = np.zeros(contours, dtype=np.bool_)
    used = 0
    for k in range(contours):
        pieces = cubics[offsets[k] : offsets[k + 1]]
        table = length_table(pieces, WEIGHTS)
        corners = table[:-1:TABLE][np.abs(turns(pieces, 0.0)) >= corner_angle]
        if count > 0:
            at = table[-1] * np.arange(count) / count
            for corner in corners:  # the nearest moves onto it where spacings stay within max_ratio
                moved = at.copy()
                moved[np.argmin(np.abs(at - corner))] = corner
                gaps = np.append(moved[1:], moved[0] + table[-1]) - moved
                before = np.roll(gaps, 1)
                if np.all(np.maximum(gaps, before) <= max_ratio * np.minimum(gaps, before)):
                    at = moved
        else:
            at = _stepped(corners, table[-1], step, max_ratio, most)
        n = len(at)
        refused[k] = n < 3
        found = grown(found, used + n)
        cell, last = 0, len(table) - 2
        for i in range(n):
            while cell < last and table[cell + 1] <= at[i]:
                cell += 1
            width = table[cell + 1] - table[cell]
            place = (cell + ((at[i] - table[cell]) / width if width > 0.0 else 0.0)) / TABLE
            j = min(int(place), len(pieces) - 1)
            found[used + i, 2] = place
            t = place - j
            s = 1.0 - t
            for axis in range(2):
                a, b, c, d = pieces[j, 0, axis], pieces[j, 1, axis], pieces[j, 2, axis], pieces[j, 3, axis]
                ab, bc, cd = s * a + t * b, s * b + t * c, s * c + t * d
                found[used + i, axis] = s * (s * ab + t * bc) + t * (s * bc + t * cd)
        used += n
        ends[k + 1] = used
    return found[:used, :2].copy(), found[:used, 2].copy(), ends, refused


@compiled
def _stepped(corners: FloatArray, length: float, step: float, max_ratio: float, most: int) -> FloatArray:
    """Ascending distances of the vertices along a contour; empty if there are too many.

    Sections between corners are divided evenly, and then spacings larger than ``max_ratio`` times a neighbour halved.
    """
    if len(corners) == 0:
        corners = np.zeros(1)
    sections = np.append(corners[1:], corners[0] + length) - corners
    if not np.max(sections) / step < most:
        return np.empty(0)
    parts = np.maximum(np.rint(sections / step - TIE), 1.0)
    total = 0.0
    for part in parts:
        total += part
    if total < 3:
        parts, total = 3 * parts, 3 * total
    if total > most:
        return np.empty(0)
    at, i = np.empty(int(total)), 0
    for j in range(len(corners)):
        for k in range(int(parts[j])):
            at[i] = corners[j] + k * (sections[j] / parts[j])
            i += 1
    # Maximum number of halvings of a spacing; a contour that needs more is refused.
    for _ in range(64):
        gaps = np.append(at[1:], at[0] + length) - at
        wide = np.flatnonzero(gaps > (max_ratio + TIE) * np.minimum(np.roll(gaps, 1), np.roll(gaps, -1)))
        if len(wide) == 0:
            k = int(np.searchsorted(at, length))  # from here on they are in the next lap
            return np.concatenate((at[k:] - length, at[:k]))
        if len(at) + len(wide) > most:
            break
        at = np.sort(np.append(at, at[wide] + 0.5 * gaps[wide]))
    return np.empty(0)
