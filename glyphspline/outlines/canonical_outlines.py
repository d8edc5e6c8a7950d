"""Outlines as they are whatever way a font stores them: start points, directions and order of contours by rule.

Two fonts may store one shape with other start points, the other way round (TrueType and PostScript do), or with
contours in another order. Here all of these become one outline, number for number:

- The ink is to the left: outer contours run counter-clockwise, holes clockwise, under the non-zero rule. A contour that
  encloses as much to its left as to its right runs the way in which its list of points is lexicographically less, or
  its list of degrees.
- A contour begins at the joint with the least x + y, at the lower left; of several at the leftmost.
- Contours are in order of the least x + y of their curves: an outer contour comes before its holes.

Segments of no length, and contours of fewer than three distinct points, are left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ..compiled import compiled
from ..curves.cubics import jet
from ..curves.integrals import area
from ..types import FloatArray, IntArray
from .contour_arrays import ContourArrays, joined, offsets_of
from .ink import ink_sides
from .outline import Contours, Outline
from .segments import contour_cubics, lasting


def canonical_outlines(outlines: Sequence[Outline]) -> list[Outline]:
    """The same shapes in the one way of storing them that this module says."""
    given = joined([outline.arrays for outline in outlines])
    glyphs = offsets_of([outline.arrays.num_contours for outline in outlines])
    found, keys = _canonical(given, glyphs)
    owner = np.repeat(np.arange(len(outlines)), np.diff(glyphs))
    order = np.lexsort((*keys.T[::-1], owner))
    order = order[np.diff(found.offsets)[order] > 0]
    found = found.chosen(order)
    ends = np.searchsorted(owner[order], np.arange(len(outlines) + 1))
    return [
        replace(outline, contours=Contours(found.part(first, last)))
        for outline, (first, last) in zip(outlines, pairwise(ends.tolist()), strict=True)
    ]


@compiled
def _canonical(contours: ContourArrays, glyphs: IntArray) -> tuple[ContourArrays, FloatArray]:
    """Contours with their start and direction by rule, in the given order.

    Args:
        glyphs: (G + 1,) where the contours of each glyph begin.

    Returns:
        the contours, which have no segments if they enclose nothing; (C, 4) what they are ordered by.
    """
    count = len(contours.offsets) - 1
    points, degrees = np.empty_like(contours.points), np.empty_like(contours.degrees)
    offsets, starts = np.zeros(count + 1, dtype=np.int64), np.zeros(count + 1, dtype=np.int64)
    keys = np.zeros((count, 4))
    for g in range(len(glyphs) - 1):
        a, b = glyphs[g], glyphs[g + 1]
        first, begin = contours.offsets[a], contours.starts[a]
        own = ContourArrays(
            contours.points[begin : contours.starts[b]], contours.degrees[first : contours.offsets[b]],
            contours.offsets[a : b + 1] - first, contours.starts[a : b + 1] - begin,
        )  # fmt: skip
        sides = ink_sides(own)
        for c in range(a, b):
            offsets[c + 1], starts[c + 1] = offsets[c], starts[c]
            cubics = contour_cubics(contours, c)
            lasts = np.zeros(len(cubics), dtype=np.bool_)
            lasts[lasting(cubics)] = True
            its = contours.degrees[contours.offsets[c] : contours.offsets[c + 1]]
            p = contours.points[contours.starts[c] : contours.starts[c + 1]][np.repeat(lasts, its)]
            if len(p) < 3:
                continue
            away = (p[:, 0] != p[0, 0]) | (p[:, 1] != p[0, 1])
            q = p[np.argmax(away)]
            if not (away & ((p[:, 0] != q[0]) | (p[:, 1] != q[1]))).any():
                continue  # of fewer than three distinct points
            d = its[lasts]
            n, m = len(p), len(d)
            backward, its = np.concatenate((p[:1], p[:0:-1])), d[::-1].copy()
            ink, extent = area(cubics), max(np.ptp(p[:, 0]), np.ptp(p[:, 1]))
            # Area relative to the square of a contour's extent below which its sign is rounding.
            if abs(ink) > 1e-9 * extent * extent:
                reverse = sides[c - a] < 0.0
            else:
                reverse = _compare(backward, its, _first_joint(backward, its), p, d, _first_joint(p, d)) < 0
            if reverse:
                p, d = backward, its
            s = _first_joint(p, d)
            i = np.sum(d[:s])
            points[starts[c] : starts[c] + n] = np.concatenate((p[i:], p[:i]))
            degrees[offsets[c] : offsets[c] + m] = np.concatenate((d[s:], d[:s]))
            offsets[c + 1], starts[c + 1] = offsets[c] + m, starts[c] + n
    found = ContourArrays(points[: starts[count]], degrees[: offsets[count]], offsets, starts)
    for c in range(count):
        if offsets[c] < offsets[c + 1]:
            cubics = contour_cubics(found, c)
            place = lower_left(cubics)
            s = min(int(place), len(cubics) - 1)
            x, y, _, _, _, _ = jet(cubics, s, place - s)
            keys[c, 0], keys[c, 1], keys[c, 2], keys[c, 3] = x + y, x, -abs(area(cubics)), len(cubics)
    return found, keys


@compiled
def lower_left(cubics: FloatArray) -> float:
    """Place of the point of a closed chain (m, 4, 2) with the least x + y; of several the leftmost, then the first."""
    best, left, place = np.inf, np.inf, 0.0
    for j in range(len(cubics)):
        p = cubics[j, 0, 0] + cubics[j, 0, 1]
        q = cubics[j, 1, 0] + cubics[j, 1, 1]
        r = cubics[j, 2, 0] + cubics[j, 2, 1]
        s = cubics[j, 3, 0] + cubics[j, 3, 1]
        if min(min(p, q), min(r, s)) > best:
            continue  # convex hull property
        if p < best or (p == best and cubics[j, 0, 0] < left):
            best, left, place = p, cubics[j, 0, 0], float(j)
        a, b, c = s - p + 3.0 * (q - r), r - 2.0 * q + p, q - p  # the derivative is 3 (a x² + 2 b x + c)
        square = b * b - a * c
        if square <= 0.0:
            continue
        root = -(b + np.copysign(np.sqrt(square), b))
        for k in range(2):
            above, below = (root, a) if k == 0 else (c, root)
            if not 1e-9 * abs(below) < abs(above) < (1.0 - 1e-9) * abs(below) or above * below < 0.0:
                continue
            at = above / below
            x, y, _, _, _, _ = jet(cubics, j, at)
            if x + y < best:
                best, left, place = x + y, x, j + at
    return place


@compiled
def _first_joint(points: FloatArray, degrees: IntArray) -> int:
    """The joint from which the contour begins: by what follows, if it passes there twice."""
    best = 0
    for s in range(1, len(degrees)):
        if _compare(points, degrees, s, points, degrees, best) < 0:
            best = s
    return best


@compiled
def _compare(one: FloatArray, degrees: IntArray, s: int, other: FloatArray, its_degrees: IntArray, t: int) -> int:
    """-1, 0 or 1: which of two contours of as many points, from its joint s or t on, is lexicographically less.

    Points are compared by x + y, and then by x; contours through the same points by their degrees.
    """
    n, m = len(one), len(degrees)
    i, j = np.sum(degrees[:s]), np.sum(its_degrees[:t])
    for k in range(n):
        ax, ay = one[(i + k) % n, 0], one[(i + k) % n, 1]
        bx, by = other[(j + k) % n, 0], other[(j + k) % n, 1]
        if ax + ay != bx + by:
            return -1 if ax + ay < bx + by else 1
        if ax != bx:
            return -1 if ax < bx else 1
    for k in range(m):
        a, b = degrees[(s + k) % m], its_degrees[(t + k) % m]
        if a != b:
            return -1 if a < b else 1
    return 0
