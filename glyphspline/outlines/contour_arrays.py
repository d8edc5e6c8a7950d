"""Contours end to end in flat arrays, as they go from the reader through the fit to the writer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..types import BoolArray, FloatArray, IntArray


class ContourArrays(NamedTuple):
    """C closed contours of m segments and N points, end to end.

    Attributes:
        points: (N, 2) and degrees: (m,) of all contours, each as :class:`.outline.Contour` has them.
        offsets: (C + 1,) where in ``degrees`` each contour begins, and m.
        starts: (C + 1,) where in ``points`` each contour begins, and N.
    """

    points: FloatArray
    degrees: IntArray
    offsets: IntArray
    starts: IntArray

    @property
    def num_contours(self) -> int:
        """C."""
        return len(self.offsets) - 1

    def part(self, first: int, last: int) -> ContourArrays:
        """The contours from ``first`` up to ``last``, as views."""
        offsets, starts = self.offsets[first : last + 1], self.starts[first : last + 1]
        points, degrees = self.points[starts[0] : starts[-1]], self.degrees[offsets[0] : offsets[-1]]
        return ContourArrays(points, degrees, offsets - offsets[0], starts - starts[0])

    def chosen(self, which: Sequence[int]) -> ContourArrays:
        """Some of the contours, in the order given; the arrays themselves if that is all of them."""
        if list(which) == list(range(self.num_contours)):
            return self
        return joined([self.part(c, c + 1) for c in which])


class Polylines(NamedTuple):
    """P polygons and open polylines end to end.

    Attributes:
        points: (N, 2). offsets: (P + 1,) where in ``points`` each begins, and N. closed: (P,) whether it is closed.
    """

    points: FloatArray
    offsets: IntArray
    closed: BoolArray

    def part(self, first: int, last: int) -> Polylines:
        """Those from ``first`` up to ``last``, as views."""
        offsets = self.offsets[first : last + 1]
        return Polylines(self.points[offsets[0] : offsets[-1]], offsets - offsets[0], self.closed[first:last])


def offsets_of(lengths: Sequence[int] | IntArray) -> IntArray:
    """(C + 1,) where each of C parts begins that lie end to end, and their total length."""
    offsets = np.zeros(len(lengths) + 1, dtype=np.int64)
    np.cumsum(lengths, out=offsets[1:])
    return offsets


def polylines(parts: Sequence[FloatArray], closed: Sequence[bool] | BoolArray) -> Polylines:
    """Polygons (n, 2) end to end."""
    points = np.concatenate([np.empty((0, 2)), *parts])
    return Polylines(points, offsets_of([len(part) for part in parts]), np.array(closed, dtype=np.bool_))


NO_CONTOURS = ContourArrays(
    np.empty((0, 2)), np.empty(0, dtype=np.int64), np.zeros(1, dtype=np.int64), np.zeros(1, dtype=np.int64)
)
"""No contours."""


NO_POLYLINES = polylines([], [])
"""No polygons."""


def joined(parts: Sequence[ContourArrays]) -> ContourArrays:
    """The contours of several arrays end to end."""
    if len(parts) == 1:
        return parts[0]
    if not parts:
        return NO_CONTOURS
    return ContourArrays(
        np.concatenate([part.points for part in parts]),
        np.concatenate([part.degrees for part in parts]),
        joined_offsets([part.offsets for part in parts]),
        joined_offsets([part.starts for part in parts]),
    )


def joined_polylines(parts: Sequence[Polylines]) -> Polylines:
    """The polylines of several arrays end to end."""
    if len(parts) < 2:
        return parts[0] if parts else NO_POLYLINES
    points, closed = (np.concatenate([part[k] for part in parts]) for k in (0, 2))
    return Polylines(points, joined_offsets([part.offsets for part in parts]), closed)


def joined_offsets(parts: Sequence[IntArray]) -> IntArray:
    """Offsets (C + 1,) of arrays end to end, from those of each."""
    ends = np.cumsum([0, *(int(part[-1]) for part in parts)])
    return np.concatenate([[0], *(part[1:] + end for part, end in zip(parts, ends, strict=False))]).astype(np.int64)
