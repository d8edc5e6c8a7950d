"""Contours drawn in K masters at once: their points are stacks, one position a master."""

# The names of a pen's methods are fontTools' own.
# ruff: noqa: N802, N815

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import GlyphsplineError
from ..outlines.masters import MasterContour
from ..types import FloatArray
from .pens import COINCIDENT, MAX_SEGMENTS, notes_of


class StackPen:
    """Collects the contours of K masters: lines, quadratics with their implied points made explicit, and cubics.

    A point is a pair of coordinates, each a number or an array (K,). Every contour is closed by a line; segments of no
    length in *all* masters are dropped, that line among them, so that all masters have the same segments. A contour
    whose points lie on one line in all masters encloses nothing; it is left out and noted.

    Attributes:
        contours: the contours so far. notes: one sentence for each contour left out.
    """

    def __init__(self, masters: int) -> None:
        self.contours: list[MasterContour] = []
        self.notes: list[str] = []
        self._masters = masters
        self._drawn = self._segments = 0
        self._points: list[Any] = []
        self._degrees: list[int] = []

    def moveTo(self, point: Any) -> None:
        """Begin a contour."""
        self.closePath()
        self._points = [point]

    def lineTo(self, point: Any) -> None:
        """A line to a point."""
        self._add(point)

    def curveTo(self, *points: Any) -> None:
        """A cubic of two control points and an end; of fewer control points, a quadratic or a line, as in fontTools."""
        if len(points) > 3:
            raise GlyphsplineError(f"a curve of {len(points) - 1} control points, more than two", contour=self._drawn)
        self._add(*points)

    def qCurveTo(self, *points: Any) -> None:
        """Quadratics through control points to the last point; they meet midway between two control points.

        If the last point is None, the contour has no point on the curve, and begins midway between its ends.
        """
        controls = [np.array(np.broadcast_arrays(*point)) for point in points[:-1]]
        end = points[-1]
        if end is None:
            end = (controls[-1] + controls[0]) / 2
            self.moveTo(end)
        elif not controls:
            self._add(end)
        for k, control in enumerate(controls):
            self._add(control, end if k + 1 == len(controls) else (control + controls[k + 1]) / 2)

    def _add(self, *points: Any) -> None:
        self._segments += 1
        if self._segments > MAX_SEGMENTS:
            raise GlyphsplineError(f"more than {MAX_SEGMENTS} segments")
        self._points.extend(points)
        self._degrees.append(len(points))

    def closePath(self) -> None:
        """Close the contour by a line."""
        if not self._points:
            return
        stacks = np.empty((self._masters, len(self._points), 2))
        for n, (x, y) in enumerate(self._points):
            stacks[:, n, 0], stacks[:, n, 1] = x, y
        self.contour(stacks, [*self._degrees, 1])
        self._points, self._degrees = [], []

    endPath = closePath

    def contour(self, points: FloatArray, degrees: Any) -> None:
        """Add a closed contour of (K, N, 2) points and segments of (m,) degrees."""
        number = self._drawn
        self._drawn += 1
        if not np.isfinite(points).all():
            raise GlyphsplineError("coordinates that are not finite", contour=number)
        degrees = np.asarray(degrees, dtype=np.int64)
        starts = np.cumsum(degrees) - degrees
        closed = np.concatenate([points, points[:, :1]], axis=1)
        near = np.ones(len(degrees), dtype=bool)
        for k in range(1, 4):
            of_degree = degrees >= k
            steps = closed[:, starts[of_degree] + k] - closed[:, starts[of_degree]]
            near[of_degree] &= (np.abs(steps) <= COINCIDENT).all(axis=(0, 2))
        kept = np.repeat(~near, degrees)
        points, degrees = np.ascontiguousarray(points[:, kept]), degrees[~near]
        if not len(degrees) or all(_is_flat(master) for master in points):
            self.notes += notes_of([number])
        else:
            self.contours.append(MasterContour(points, degrees))


def _is_flat(points: FloatArray) -> bool:
    """Whether all (N, 2) points lie on the line from the first to the farthest."""
    arms = points - points[0]
    lengths = np.hypot(arms[:, 0], arms[:, 1])
    far = arms[lengths.argmax()]
    return bool(np.abs(arms[:, 0] * far[1] - arms[:, 1] * far[0]).max() <= COINCIDENT * lengths.max())
