"""Contours end to end in flat arrays: the form in which readers, fit and writers exchange them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..types import BoolArray, FloatArray, IntArray


class ContourArrays(NamedTuple):
    """C closed contours of m segments and N points, end to end.

    Attributes:
        points: (N, 2) and degrees: (m,) of all contours, as in :class:`.outline.Contour`.
        offsets: (C + 1,) first index in ``degrees`` of each contour, and m.
        starts: (C + 1,) first index in ``points`` of each contour, and N.
    """

    points: FloatArray
    degrees: IntArray
    offsets: IntArray
    starts: IntArray

    @property
    def num_contours(self) -> int:
        """C."""
        return len(self.offsets) - 1

    def rounded(self, precision: int) -> ContourArrays:
        """The contours as written with ``precision`` decimals."""
        return self._replace(points=np.round(self.points, precision) + 0.0)

    def part(self, first: int, last: int) -> ContourArrays:
        """The contours from ``first`` to ``last``, exclusive, as views."""
        offsets, starts = self.offsets[first : last + 1], self.starts[first : last + 1]
        points, degrees = self.points[starts[0] : starts[-1]], self.degrees[offsets[0] : offsets[-1]]
        return ContourArrays(points, degrees, offsets - offsets[0], starts - starts[0])

    def chosen(self, which: Sequence[int] | IntArray) -> ContourArrays:
        """The chosen contours in the given order; ``self`` if these are all contours in order."""
        which = np.asarray(which, dtype=np.int64)
        if np.array_equal(which, np.arange(self.num_contours)):
            return self
        of_points, starts = members_of(self.starts, which)
        of_segments, offsets = members_of(self.offsets, which)
        return ContourArrays(self.points[of_points], self.degrees[of_segments], offsets, starts)


class Polylines(NamedTuple):
    """P polygons and open polylines end to end.

    Attributes:
        points: (N, 2). offsets: (P + 1,) first index in ``points`` of each, and N. closed: (P,) whether it is closed.
    """

    points: FloatArray
    offsets: IntArray
    closed: BoolArray

    def part(self, first: int, last: int) -> Polylines:
        """The polylines from ``first`` to ``last``, exclusive, as views."""
        offsets = self.offsets[first : last + 1]
        return Polylines(self.points[offsets[0] : offsets[-1]], offsets - offsets[0], self.closed[first:last])


def cubic_contours(cubics: FloatArray, offsets: IntArray) -> ContourArrays:
    """Closed chains of cubics (m, 4, 2) end to end as contours, with offsets (C + 1,)."""
    return ContourArrays(cubics[:, :3].reshape(-1, 2), np.full(len(cubics), 3), offsets, 3 * offsets)


def lines_and_cubics(cubics: FloatArray, lines: BoolArray) -> tuple[FloatArray, IntArray]:
    """Points (..., N, 2) and degrees (m,) of a chain of cubics (..., m, 4, 2) of which some are lines."""
    kept = np.where(lines[:, None], [True, False, False, False], [True, True, True, False])
    return np.ascontiguousarray(cubics[..., kept, :]), np.where(lines, 1, 3)


def end_to_end(contours: Sequence[tuple[FloatArray, IntArray]]) -> ContourArrays:
    """Contours from the points (..., N, 2) and degrees of each; ``points`` of several masters are end to end in all."""
    if not contours:
        return NO_CONTOURS
    points, degrees = zip(*contours, strict=True)
    offsets, starts = offsets_of([len(each) for each in degrees]), offsets_of([each.shape[-2] for each in points])
    return ContourArrays(np.concatenate(points, axis=-2), np.concatenate(degrees), offsets, starts)


def offsets_of(lengths: Sequence[int] | IntArray) -> IntArray:
    """(C + 1,) first index of each of C parts end to end, and their total length."""
    offsets = np.zeros(len(lengths) + 1, dtype=np.int64)
    np.cumsum(lengths, out=offsets[1:])
    return offsets


def polylines(parts: Sequence[FloatArray], closed: Sequence[bool] | BoolArray) -> Polylines:
    """Polygons (n, 2) end to end."""
    points = np.concatenate([np.empty((0, 2)), *parts])
    return Polylines(points, offsets_of([len(part) for part in parts]), np.array(closed, dtype=np.bool_))


NO_CONTOURS = ContourArrays(np.empty((0, 2)), np.empty(0, dtype=np.int64), offsets_of([]), offsets_of([]))
NO_POLYLINES = polylines([], [])


def joined(parts: Sequence[ContourArrays]) -> ContourArrays:
    """The contours of several arrays end to end."""
    if len(parts) < 2:
        return parts[0] if parts else NO_CONTOURS
    points, degrees, offsets, starts = zip(*parts, strict=True)
    return ContourArrays(
        np.concatenate(points), np.concatenate(degrees), joined_offsets(offsets), joined_offsets(starts)
    )


def joined_polylines(parts: Sequence[Polylines]) -> Polylines:
    """The polylines of several arrays end to end."""
    if len(parts) < 2:
        return parts[0] if parts else NO_POLYLINES
    points, offsets, closed = zip(*parts, strict=True)
    return Polylines(np.concatenate(points), joined_offsets(offsets), np.concatenate(closed))


def joined_offsets(parts: Sequence[IntArray]) -> IntArray:
    """Offsets (C + 1,) of arrays end to end from the offsets of each."""
    if not parts:
        return offsets_of([])
    ends = np.cumsum([len(part) for part in parts])
    return offsets_of(np.delete(np.diff(np.concatenate(parts)), ends[:-1] - 1))


def members_of(offsets: IntArray, which: IntArray) -> tuple[IntArray, IntArray]:
    """The indices of the members of chosen parts, end to end, and (len(which) + 1,) where each of these begins."""
    lengths = np.diff(offsets)[which]
    found = offsets_of(lengths)
    return np.arange(found[-1]) + np.repeat(offsets[which] - found[:-1], lengths), found
