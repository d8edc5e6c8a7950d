"""The pen that turns the drawing operations of a glyph into contours."""

# The names of a pen's methods are fontTools' own.
# ruff: noqa: N802, N815

from __future__ import annotations

from collections.abc import Sequence
from math import hypot
from typing import Any, TypeAlias

import numpy as np
from fontTools.pens.basePen import BasePen

from ..errors import GlyphsplineError
from ..outlines.outline import Contour
from ..types import FloatArray

Point: TypeAlias = tuple[float, float]

COINCIDENT = 1e-3
"""Distance in font units below which points coincide.

Variation deltas and transforms round in single precision and leave closing segments of length 1e-4. A smaller value
keeps these; a larger one comes near the grid of a font.
"""

MAX_SEGMENTS, MAX_COMPONENTS = 200_000, 10_000
"""Limits far above any real glyph. A few hundred bytes of nested components can ask for 2^64 copies."""


def notes_of(left_out: Sequence[int]) -> tuple[str, ...]:
    """One sentence for each contour that encloses nothing, by its number."""
    return tuple(f"contour {number} left out: it encloses nothing" for number in left_out)


class ContourPen(BasePen):  # type: ignore[misc, unused-ignore]
    """Collects contours: lines, quadratics with their implied points made explicit, and cubics.

    Components are decomposed. Segments of no length are dropped. A contour whose points all lie on one line encloses
    nothing; it is left out and noted. Most such contours are single points, which fonts use as anchors. A line closes
    an open path, as in every rasteriser.

    Attributes:
        contours: the contours so far. left_out: numbers of those left out. drawn: the count of both.
        snapped: the largest distance of points that are taken to coincide; see :class:`.Outline`.
    """

    skipMissingComponents = False

    def __init__(self, glyph_set: Any = None, glyph_name: str | None = None, coincident: float = COINCIDENT) -> None:
        super().__init__(glyph_set)
        self.contours: list[Contour] = []
        self.left_out: list[int] = []
        self.drawn = 0
        self.snapped = 0.0
        self._coincident = coincident
        self._points: list[Point] = []
        self._degrees: list[int] = []
        self._segments = 0
        self._components = 0
        self._nesting = [glyph_name]

    @property
    def notes(self) -> tuple[str, ...]:
        """One sentence for each contour left out."""
        return notes_of(self.left_out)

    def addComponent(self, glyphName: str, transformation: Any) -> None:
        """Draw another glyph of the set in place; a loop of components, or too many, is an error."""
        self._components += 1
        if glyphName in self._nesting:
            loop = [*self._nesting[self._nesting.index(glyphName) :], glyphName]
            raise GlyphsplineError("components in a loop: " + " > ".join(map(str, loop)))
        if self._components > MAX_COMPONENTS:
            raise GlyphsplineError(f"more than {MAX_COMPONENTS} components")
        if self.glyphSet is None or glyphName not in self.glyphSet:
            raise GlyphsplineError(f"component {glyphName!r} does not exist")
        self._nesting.append(glyphName)
        super().addComponent(glyphName, transformation)
        self._nesting.pop()

    def _moveTo(self, pt: Point) -> None:
        self.finish()
        self._points = [pt]

    def _add(self, *to: Point) -> None:
        """Append the segment from the current point through ``to``, unless all points coincide."""
        self._segments += 1
        if self._segments > MAX_SEGMENTS:
            raise GlyphsplineError(f"more than {MAX_SEGMENTS} segments")
        x, y = self._points[-1]
        near = self._coincident
        for a, b in to:  # most of the time of reading: no calls here
            if not (abs(a - x) <= near and abs(b - y) <= near):
                self._points.extend(to)
                self._degrees.append(len(to))
                return
        self.snapped = max(self.snapped, *(hypot(a - x, b - y) for a, b in to))

    _lineTo = _qCurveToOne = _curveToOne = _add

    def finish(self) -> None:
        """Close a contour left open at the end."""
        if not self._points:
            return
        if not self._same(self._points[0], self._points[-1]):
            self._degrees.append(1)
        elif self._degrees:
            (ax, ay), (bx, by) = self._points[0], self._points.pop()  # the last segment ends on points[0]
            self.snapped = max(self.snapped, hypot(bx - ax, by - ay))
        points = np.array(self._points, dtype=np.float64)
        if not np.isfinite(points).all():
            raise GlyphsplineError("coordinates that are not finite", contour=self.drawn)
        if self._degrees and (self._is_wide() or not self._flat(points)):
            self.contours.append(Contour(points, np.array(self._degrees, dtype=np.int64)))
        else:
            self.left_out.append(self.drawn)
        self.drawn += 1
        self._points, self._degrees = [], []

    _closePath = _endPath = finish

    def _same(self, a: Point, b: Point) -> bool:
        return abs(a[0] - b[0]) <= self._coincident and abs(a[1] - b[1]) <= self._coincident

    def _is_wide(self) -> bool:
        """Whether two of the points prove that the contour is not flat. Most contours pass this quick test.

        Two arms a, b whose ends are at most d from one line through their common start have |a × b| ≤ (|a| + |b|) d.
        """
        n = len(self._points)
        (x, y), (ax, ay), (bx, by) = self._points[0], self._points[n // 3], self._points[2 * n // 3]
        ax, ay, bx, by = ax - x, ay - y, bx - x, by - y
        return abs(ax * by - ay * bx) > self._coincident * (abs(ax) + abs(ay) + abs(bx) + abs(by))

    def _flat(self, points: FloatArray) -> bool:
        """Whether all (N, 2) points lie on the line from the first to the farthest."""
        arms = points - points[0]
        lengths = np.hypot(arms[:, 0], arms[:, 1])
        far = arms[lengths.argmax()]
        across = arms[:, 0] * far[1] - arms[:, 1] * far[0]
        return bool(np.abs(across).max() <= self._coincident * lengths.max())
