"""What the contours of a glyph enclose: whether the written result crosses and turns as its source does.

A distance does not tell. Two strands that are nearer to each other than the tolerance may cross, and a hairline may
lose its area, while the result is within the tolerance. So the written curves of a glyph, all its contours together,
are compared with its source.

A curve within the tolerance goes a little to both sides of its source, so that of two strands that touch each other
some crossing is left however closely they are fitted. Each is fitted instead to a source that steps back from the other
one near the crossing, by a share of the tolerance.
"""

from __future__ import annotations

from collections import Counter
from typing import TypeAlias

import numpy as np

from ..curves.bezier import divided, evaluate
from ..curves.crossings import crossings
from ..curves.cubics import bernstein
from ..curves.integrals import area
from ..outlines.contour_arrays import ContourArrays, cubic_contours, offsets_of
from ..outlines.segments import all_cubics, contour_cubics
from ..types import BoolArray, FloatArray, IntArray

PARTS, MOST_PARTS = 8, 64
"""Pieces into which a strand of that length is cut at least, each stepping back by its own amount, and into which a
segment is cut at most."""


Changes: TypeAlias = IntArray
"""What changed in C contours, (2, C), or in V instances of them, (2, V, C): first the number of crossings that the
source does not have, with the contour itself and with others of the glyph, -1 where strands lie on each other in such
numbers that crossings are not counted; then 1 where the area of a contour that does not cross itself has gone, or
changed its sign."""


def changed(found: Changes) -> BoolArray:
    """(C,) whether a contour has a change, in any instance, that a closer fit may undo; of ``found[:1]``, crossings."""
    wrong: BoolArray = np.logical_or.reduce((found > 0).reshape(-1, found.shape[-1]))
    return wrong


def changes(source: ContourArrays, written: ContourArrays, glyphs: IntArray) -> Changes:
    """Compare contours with their sources.

    Args:
        source, written: C contours each. glyphs: (G + 1,) where the contours of each glyph begin.
    """
    pairs, counted = _crossing_pairs(written, glyphs)
    new = np.where(np.repeat(counted, np.diff(glyphs)), 0, -1)
    crossing = np.unique(np.searchsorted(glyphs, [c for c, _ in pairs], side="right") - 1)
    for g in crossing[counted[crossing]].tolist():
        a, b = glyphs[g : g + 2].tolist()
        known, _ = _crossing_pairs(source.part(a, b), np.array([0, b - a]))
        for (c, d), number in pairs.items():
            if a <= c < b:
                new[list({c, d})] += max(number - known[c - a, d - a], 0)
    both = [[area(contour_cubics(of, c)) for c in range(of.num_contours)] for of in (source, written)]
    before, now = np.array(both)
    # A contour whose area is less than this share of its source's, or of the other sign, has collapsed.
    collapsed = now * np.sign(before) < 0.25 * np.abs(before)
    for c in np.flatnonzero(collapsed).tolist():
        collapsed[c] = not _crossing_pairs(source.part(c, c + 1), np.array([0, 1]))[0]
    return np.stack([new, collapsed])


def _crossing_pairs(contours: ContourArrays, glyphs: IntArray) -> tuple[Counter[tuple[int, int]], BoolArray]:
    """Number of crossings by the numbers of the two contours; and (G,) whether a glyph's were counted."""
    found, counted = crossings(all_cubics(contours), contours.offsets, glyphs)
    return Counter(map(tuple, found[:, :2].astype(np.int64).tolist())), counted


def drawn_apart(source: ContourArrays, written: ContourArrays, shift: float, tolerance: float) -> ContourArrays:
    """The contours of a glyph as cubics, moved by up to ``shift`` where the written curves cross.

    No point of a contour is farther than ``shift`` from its source, as a piece is within the largest distance of its
    Bézier points.
    """
    # Length along the outline over which it steps back to each side of a crossing, in tolerances.
    reach = 40.0 * tolerance
    found, _ = crossings(all_cubics(written), written.offsets, np.array([0, written.num_contours]))
    given, results = all_cubics(source), all_cubics(written)
    strands = [_Strand(given[a:b], reach) for a, b in zip(source.offsets, source.offsets[1:], strict=False)]
    moves: list[list[tuple[float, FloatArray]]] = [[] for _ in strands]
    # Crossings of a glyph from which contours step back: a tangle of more is none the better for it.
    for c, d, a, _ in found[:200].tolist():
        own, other = strands[int(c)], strands[int(d)]
        segment = written.offsets[int(c)] + int(a)
        point = evaluate(results[segment : segment + 1], np.array([a % 1]))[0]
        one = own.nearest(point)
        two = other.nearest(point, one if own is other else None)
        v = own.middle(one) - other.middle(two)
        moves[int(c)].append((one, own.away(one, v)))
        moves[int(d)].append((two, other.away(two, -v)))
    cubics = [strand.moved(each, shift) for strand, each in zip(strands, moves, strict=True)]
    return cubic_contours(np.concatenate(cubics), offsets_of([len(part) for part in cubics]))


class _Strand:
    """A contour cut into short pieces, by the length along it; it steps back over ``reach`` to each side."""

    def __init__(self, cubics: FloatArray, reach: float) -> None:
        legs = np.hypot(*np.moveaxis(np.diff(cubics, axis=1), 2, 0)).sum(axis=1)
        counts = np.clip(np.ceil(legs * PARTS / reach), 1, MOST_PARTS).astype(np.int64)
        self.pieces, _ = divided(cubics, counts)
        chords = np.hypot(*np.moveaxis(np.diff(self.pieces, axis=1), 2, 0))
        ends = np.concatenate([[0.0], np.cumsum(chords)])
        self.places, self.total = ends[:-1], ends[-1]  # of all control points but the last of each piece
        self.points = np.einsum("kt,mkc->mtc", bernstein(3)[:, :3], self.pieces).reshape(-1, 2)
        self.outward, self.reach = np.sign(area(cubics)), reach

    def way(self, place: float) -> FloatArray:
        """Distance along the contour from a place to all points."""
        away: FloatArray = np.abs((self.places - place + self.total / 2) % self.total - self.total / 2)
        return away

    def nearest(self, point: FloatArray, beside: float | None = None) -> float:
        """Where the contour is nearest to a point; or where another strand of it is than that at a place."""
        distances = np.hypot(*(self.points - point).T)
        if beside is not None:
            distances[self.way(beside) < min(self.reach, self.total) / 8] = np.inf
        return float(self.places[distances.argmin()])

    def middle(self, place: float) -> FloatArray:
        """The mean of the points around a place."""
        mean: FloatArray = self.points[self.way(place) <= self.reach / 2].mean(axis=0)
        return mean

    def away(self, place: float, v: FloatArray) -> FloatArray:
        """Unit vector by which the contour steps back at a place, if the other strand lies opposite to v."""
        size = float(np.hypot(*v))
        if size > self.reach / 20:
            return v / size
        k = int(self.way(place).argmin())
        tangent = self.points[(k + 1) % len(self.points)] - self.points[k - 1]
        normal = np.array([tangent[1], -tangent[0]]) / max(float(np.hypot(*tangent)), 1e-300) * self.outward
        return normal if normal @ v >= -1e-9 * self.reach else -normal

    def moved(self, moves: list[tuple[float, FloatArray]], shift: float) -> FloatArray:
        """The pieces, stepped back at some places."""
        if not moves:
            return self.pieces
        weights = np.stack([np.maximum(1 - (self.way(place) / self.reach) ** 2, 0) ** 2 for place, _ in moves])
        steps = weights.T @ np.array([direction for _, direction in moves])
        steps *= shift / np.maximum(np.hypot(*steps.T), 1)[:, None]
        points = self.pieces[:, :3].reshape(-1, 2) + steps
        return np.stack([points[0::3], points[1::3], points[2::3], np.roll(points[0::3], -1, axis=0)], axis=1)
