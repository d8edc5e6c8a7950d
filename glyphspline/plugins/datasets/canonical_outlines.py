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
from functools import partial
from itertools import pairwise

import numpy as np

from ...compiled import compiled
from ...curves.cubics import jet
from ...curves.integrals import areas
from ...outlines.contour_arrays import ContourArrays, joined, offsets_of
from ...outlines.ink import ink_sides
from ...outlines.outline import Contours, Outline
from ...outlines.segments import all_cubics
from ...types import BoolArray, FloatArray, IntArray


def canonical_outlines(outlines: Sequence[Outline]) -> list[Outline]:
    """The same shapes in the one way of storing them that this module says."""
    given = joined([outline.arrays for outline in outlines])
    glyphs = offsets_of([outline.arrays.num_contours for outline in outlines])
    sides = np.concatenate([np.empty(0), *(ink_sides(given.part(*ends)) for ends in pairwise(glyphs.tolist()))])
    cubics = all_cubics(given)
    signed = areas(cubics, given.offsets)
    contours, kept = _distinct(given, cubics)
    owner = np.repeat(np.arange(len(outlines)), np.diff(glyphs))[kept]
    turned = _reversed(contours, _backward(contours, signed[kept], sides[kept]))
    firsts = turned.offsets[:-1] + _first_joints(turned)
    points = turned.points[_rolled(turned.starts, offsets_of(turned.degrees)[firsts])]
    found = turned._replace(points=points, degrees=turned.degrees[_rolled(turned.offsets, firsts)])
    cubics = all_cubics(found)
    lowest = [lower_left(cubics[first:last])[1:] for first, last in pairwise(found.offsets.tolist())]
    lengths, low, left = np.diff(found.offsets), *np.array(lowest).reshape(-1, 2).T
    order = np.lexsort((lengths, -np.abs(areas(cubics, found.offsets)), left, low, owner))
    ends = np.searchsorted(owner, np.arange(len(outlines) + 1))
    found = found.chosen(order)
    return [
        replace(outline, contours=Contours(found.part(first, last)))
        for outline, (first, last) in zip(outlines, pairwise(ends.tolist()), strict=True)
    ]


def _distinct(contours: ContourArrays, cubics: FloatArray) -> tuple[ContourArrays, IntArray]:
    """Contours without segments of no length, those of three distinct points at least; and which of the given ones.

    Args:
        cubics: their segments.
    """
    lasts = (cubics != cubics[:, :1]).any(axis=(1, 2))
    points, degrees = contours.points[np.repeat(lasts, contours.degrees)], contours.degrees[lasts]
    offsets = offsets_of(lasts)[contours.offsets]
    starts = offsets_of(degrees)[offsets]
    owner, two = np.repeat(np.arange(contours.num_contours), np.diff(starts)), starts[:-1].copy()
    away = np.flatnonzero((points != points[starts[owner]]).any(axis=1))
    those, first = np.unique(owner[away], return_index=True)
    two[those] = away[first]  # the first point of each that is not where it begins
    third = away[(points[away] != points[two[owner[away]]]).any(axis=1)]
    kept = np.unique(owner[third])
    return ContourArrays(points, degrees, offsets, starts).chosen(kept), kept


def _backward(contours: ContourArrays, areas: FloatArray, sides: FloatArray) -> BoolArray:
    """(C,) which contours are to run the other way."""
    if contours.num_contours == 0:
        return np.empty(0, dtype=np.bool_)
    low, high = (each.reduceat(contours.points, contours.starts[:-1]) for each in (np.minimum, np.maximum))
    extents = (high - low).max(axis=1)
    # Area relative to the square of a contour's extent below which its sign is rounding.
    backward, flat = sides < 0.0, ~(np.abs(areas) > 1e-9 * extents * extents)
    for c in np.flatnonzero(flat).tolist():
        own = contours.part(c, c + 1)
        both = own, _reversed(own, np.ones(1, dtype=np.bool_))
        one, other = (min(_sequence(each, s) for s in range(len(each.degrees))) for each in both)
        backward[c] = other < one
    return backward


def _reversed(contours: ContourArrays, which: BoolArray) -> ContourArrays:
    """Contours, some of them in the opposite direction from the same first point."""
    points, degrees = np.arange(len(contours.points)), np.arange(len(contours.degrees))
    owner, of = (np.repeat(np.arange(len(which)), np.diff(each)) for each in (contours.starts, contours.offsets))
    first, last = contours.starts[owner], contours.starts[owner + 1]
    points = np.where(which[owner] & (points > first), first + last - points, points)
    degrees = np.where(which[of], contours.offsets[of] + contours.offsets[of + 1] - 1 - degrees, degrees)
    return contours._replace(points=contours.points[points], degrees=contours.degrees[degrees])


def _first_joints(contours: ContourArrays) -> IntArray:
    """(C,) the joint of each contour from which it begins: by what follows, if it passes there twice."""
    offsets = contours.offsets
    owner = np.repeat(np.arange(contours.num_contours), np.diff(offsets))
    x, y = contours.points[offsets_of(contours.degrees)[:-1]].T
    order = np.lexsort((x, x + y, owner))
    first = order[offsets[:-1]]
    as_low = np.flatnonzero((x == x[first][owner]) & (x + y == (x + y)[first][owner]))
    count = np.bincount(owner[as_low], minlength=contours.num_contours)
    found = first - offsets[:-1]
    for c in np.flatnonzero(count > 1).tolist():
        tied = as_low[owner[as_low] == c] - offsets[c]
        found[c] = min(tied.tolist(), key=partial(_sequence, contours.part(c, c + 1)))
    return found


def _sequence(contour: ContourArrays, s: int) -> tuple[list[list[float]], list[int]]:
    """What a single contour is compared by, from joint s on: x + y and x of all points, and then the degrees."""
    x, y = np.roll(contour.points, -int(contour.degrees[:s].sum()), axis=0).T
    return np.stack([x + y, x], axis=1).tolist(), np.roll(contour.degrees, -s).tolist()


def _rolled(ends: IntArray, firsts: IntArray) -> IntArray:
    """Indices of the members of parts, each part from one of its members on and around."""
    sizes = np.diff(ends)
    found = np.arange(ends[-1]) + np.repeat(firsts - ends[:-1], sizes)
    return found - np.where(found >= np.repeat(ends[1:], sizes), np.repeat(sizes, sizes), 0)


@compiled
def lower_left(cubics: FloatArray) -> tuple[float, float, float]:
    """Place of the point of a closed chain (m, 4, 2) with the least x + y; of several the leftmost, then the first.

    Returns:
        The place, and x + y and x of its point.
    """
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
    return place, best, left
