"""The pens that turn the drawing operations of a glyph into contours, in one master or in several at once."""

# The names of a pen's methods are fontTools' own.
# ruff: noqa: N802, N815

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from fontTools.pens.basePen import BasePen

from ..errors import GlyphsplineError
from ..outlines.masters import MasterContour
from ..outlines.outline import Contour
from ..types import FloatArray, IntArray

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
    """Collects contours in K masters: lines, quadratics with their implied points made explicit, and cubics.

    Components are decomposed. A line closes an open path, as in every rasteriser. Segments of no length in all masters
    are dropped, that line among them. A contour whose points lie on one line in all masters encloses nothing; it is
    left out and noted. Most such contours are single points, which fonts use as anchors.

    A point is a pair of coordinates, each a number or an array (K,) over the masters.

    Attributes:
        stacks: the contours so far. left_out: numbers of those left out. drawn: the count of both.
        snapped: the largest distance of points that are taken to coincide; see :class:`.Outline`.
    """

    skipMissingComponents = False

    def __init__(
        self, glyph_set: Any = None, glyph_name: str | None = None, masters: int = 1, coincident: float = COINCIDENT
    ) -> None:
        super().__init__(glyph_set)
        self.stacks: list[MasterContour] = []
        self.left_out: list[int] = []
        self.drawn = 0
        self.snapped = 0.0
        self._masters, self._coincident = masters, coincident
        self._points: list[Any] = []
        self._degrees: list[int] = []
        self._segments = 0
        self._components = 0
        self._nesting = [glyph_name]

    @property
    def contours(self) -> list[Contour]:
        """The contours in the first master."""
        return [Contour(stack.points[0], stack.degrees) for stack in self.stacks]

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

    def _moveTo(self, pt: Any) -> None:
        self.finish()
        self._points = [pt]

    def _add(self, *to: Any) -> None:
        self._segments += 1
        if self._segments > MAX_SEGMENTS:
            raise GlyphsplineError(f"more than {MAX_SEGMENTS} segments")
        self._points.extend(to)
        self._degrees.append(len(to))

    _lineTo = _qCurveToOne = _curveToOne = _add

    def finish(self) -> None:
        """Close a contour left open at the end."""
        if not self._points:
            return
        points = np.empty((self._masters, len(self._points), 2))
        if self._masters == 1:
            points[0] = self._points
        else:
            for n, (x, y) in enumerate(self._points):
                points[:, n, 0], points[:, n, 1] = x, y
        degrees = np.array([*self._degrees, 1], dtype=np.int64)
        self._points, self._degrees = [], []
        self.contour(points, degrees)

    _closePath = _endPath = finish

    def contour(self, points: FloatArray, degrees: IntArray) -> None:
        """Add a closed contour of (K, N, 2) points and segments of (m,) degrees."""
        if not np.isfinite(points).all():
            raise GlyphsplineError("coordinates that are not finite", contour=self.drawn)
        points, degrees = self._lasting(points, degrees)
        if len(degrees) and not all(self._is_flat(master) for master in points):
            self.stacks.append(MasterContour(points, degrees))
        else:
            self.left_out.append(self.drawn)
        self.drawn += 1

    def _lasting(self, points: FloatArray, degrees: IntArray) -> tuple[FloatArray, IntArray]:
        """The contour without segments all of whose points coincide with the end of the last one that is kept."""
        closed = np.concatenate([points, points[:, :1]], axis=1)
        starts = np.cumsum(degrees) - degrees
        kept = np.zeros(len(degrees), dtype=np.bool_)
        for k in (1, 2, 3):
            longer = degrees >= k
            steps = np.abs(closed[:, starts[longer] + k] - closed[:, starts[longer]])
            kept[longer] |= (steps > self._coincident).any(axis=(0, 2))
        index, at = np.arange(points.shape[1]), 0
        for j in range(len(degrees) if not kept[:-1].all() else 0):
            index[starts[j]] = at
            steps = closed[:, starts[j] + 1 : starts[j] + degrees[j] + 1] - closed[:, at : at + 1]
            kept[j] = (np.abs(steps) > self._coincident).any()
            at = starts[j] + degrees[j] if kept[j] else at
        if kept.all():
            return points, degrees
        for j in np.flatnonzero(~kept).tolist():
            steps = closed[:, starts[j] + 1 : starts[j] + degrees[j] + 1] - points[:, index[starts[j]], None]
            self.snapped = max(self.snapped, float(np.hypot(steps[..., 0], steps[..., 1]).max()))
        return np.ascontiguousarray(points[:, index[np.repeat(kept, degrees)]]), degrees[kept]

    def _is_flat(self, points: FloatArray) -> bool:
        """Whether all (N, 2) points lie on the line from the first to the farthest."""
        arms = points - points[0]
        lengths = np.hypot(arms[:, 0], arms[:, 1])
        far = arms[lengths.argmax()]
        return bool(np.abs(arms[:, 0] * far[1] - arms[:, 1] * far[0]).max() <= self._coincident * lengths.max())
