"""The pen that turns the drawing operations of a glyph into contours, in one master or in several at once."""

# The names of a pen's methods are fontTools' own.
# ruff: noqa: N802, N815

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from fontTools.pens.basePen import BasePen

from ..errors import GlyphsplineError
from ..outlines.masters import MasterContour
from ..outlines.open_paths import Path, lasting_path, retraced, there_and_back, without_area
from ..outlines.outline import Contour, Contours
from ..types import FloatArray, IntArray

COINCIDENT = 1e-3
"""Distance in font units below which points coincide.

Variation deltas and transforms round in single precision and leave closing segments of length 1e-4. A smaller value
keeps these; a larger one comes near the grid of a font.
"""

MAX_SEGMENTS, MAX_COMPONENTS = 200_000, 10_000
"""Limits far above any real glyph. A few hundred bytes of nested components can ask for 2^64 copies."""


NO_AREA = "it encloses nothing"
"""What notes say of contours without area. Most are single points, which fonts use for hints and anchors."""


def notes_of(left_out: Sequence[int]) -> tuple[str, ...]:
    """One sentence for each contour that encloses nothing, by its number."""
    return tuple(f"contour {number} left out: {NO_AREA}" for number in left_out)


def enter_component(nesting: Sequence[str | None], name: str) -> list[str | None]:
    """The names of a glyph and its components, from the outermost to this one.

    Raises:
        GlyphsplineError: the component is in a loop.
    """
    if name in nesting:
        loop = [*nesting[nesting.index(name) :], name]
        raise GlyphsplineError("components in a loop: " + " > ".join(map(str, loop)))
    return [*nesting, name]


def drawn_by(draw: Callable[[ContourPen], object], **how: Any) -> ContourPen:
    """A glyph that ``draw`` draws. In one that encloses nothing closed contours that retrace themselves are strokes.

    Beside ink they are what edits have left, as no program shows them. ``how``: see :class:`ContourPen`.
    """
    pen = ContourPen(**how)
    draw(pen)
    pen.finish()
    closed = [each.points[0] for each in pen.stacks if not Contour(each.points[0], each.degrees).is_open]
    if pen.drawn and all(without_area(points, np.array([0, len(points)]))[0] for points in closed):
        pen = ContourPen(strokes=True, **how)
        draw(pen)
        pen.finish()
    return pen


class ContourPen(BasePen):  # type: ignore[misc, unused-ignore]
    """Collects contours in K masters: lines, quadratics with their implied points made explicit, and cubics.

    Components are decomposed. A line closes an open path, as in every rasteriser, unless it ``opens``. Segments of no
    length in all masters are dropped, that line among them. A contour whose points lie on one line in all masters, or
    that goes along a path and back, encloses nothing; it is left out and noted, unless these are ``strokes``. Most such
    contours are single points, which fonts use as anchors.

    A point is a pair of coordinates, each a number or an array (K,) over the masters.

    Attributes:
        stacks: the contours so far. left_out: numbers of those left out. drawn: the count of both.
        own: of each contour that is drawn itself, not by a component, the number in ``stacks``; None: left out.
        repeats: of each contour; see :class:`.Contours`.
        snapped: the largest distance of points that are taken to coincide; see :class:`.Outline`.
        opens: whether open paths become open contours, as in sources. strokes: whether closed ones that retrace
            themselves do.
    """

    skipMissingComponents = False

    def __init__(
        self, glyph_set: Any = None, glyph_name: str | None = None, masters: int = 1, coincident: float = COINCIDENT,
        opens: bool = False, strokes: bool = False,
    ) -> None:  # fmt: skip
        super().__init__(glyph_set)
        self.reverseFlipped = opens  # sources are decomposed as compilers do: a mirrored component keeps its ink
        self.stacks: list[MasterContour] = []
        self.repeats: list[IntArray] = []
        self.left_out: list[int] = []
        self.own: list[int | None] = []
        self.drawn = 0
        self.snapped = 0.0
        self._masters, self._coincident = masters, coincident
        self.opens, self.strokes = opens, strokes
        self._points: list[Any] = []
        self._degrees: list[int] = []
        self._segments = 0
        self._components = 0
        self._nesting = [glyph_name]

    @property
    def contours(self) -> Contours:
        """The contours in the first master."""
        return Contours([Contour.trusted(stack.points[0], stack.degrees) for stack in self.stacks], self.repeated)

    @property
    def repeated(self) -> IntArray:
        """The repeats of all contours."""
        return np.concatenate([np.zeros(0, dtype=np.int64), *self.repeats])

    @property
    def notes(self) -> tuple[str, ...]:
        """One sentence for each contour left out."""
        return notes_of(self.left_out)

    def addComponent(self, glyphName: str, transformation: Any) -> None:
        """Draw another glyph of the set in place; a loop of components, or too many, is an error."""
        self._components += 1
        before, self._nesting = self._nesting, enter_component(self._nesting, glyphName)
        if self._components > MAX_COMPONENTS:
            raise GlyphsplineError(f"more than {MAX_COMPONENTS} components")
        if self.glyphSet is None or glyphName not in self.glyphSet:
            raise GlyphsplineError(f"component {glyphName!r} does not exist")
        super().addComponent(glyphName, transformation)
        self._nesting = before

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

    def finish(self, closed: bool = True) -> None:
        """Close a contour left open at the end; or keep it open."""
        if not self._points:
            return
        points = np.empty((self._masters, len(self._points), 2))
        if self._masters == 1:
            points[0] = np.reshape(self._points, (-1, 2))
        else:
            for n, (x, y) in enumerate(self._points):
                points[:, n, 0], points[:, n, 1] = x, y
        degrees = np.array([*self._degrees, 1] if closed else self._degrees, dtype=np.int64)
        self._points, self._degrees = [], []
        kept = len(self.stacks)
        if closed:
            self._keep(points, degrees, np.zeros_like(degrees), True)
        else:
            path, dropped = lasting_path(points, degrees, self._coincident)
            self.snapped = max(self.snapped, dropped)
            self._keep_paths([path] if path else [])
        if len(self._nesting) == 1:
            self.own.append(kept if len(self.stacks) > kept else None)

    _closePath = finish

    def _endPath(self) -> None:
        self.finish(closed=not self.opens)

    def contour(self, points: FloatArray, degrees: IntArray, repeats: IntArray | None = None) -> None:
        """Add a contour of (K, N, 2) points and segments of (m,) degrees and repeats."""
        if self.opens and Contour(points[0], degrees).is_open:
            half = points.shape[1] // 2
            self._keep_paths([(points[:, : half + 1], degrees[: len(degrees) // 2])])
            return
        self._keep(points.copy(), degrees.copy(), np.zeros_like(degrees) if repeats is None else repeats.copy(), False)

    def _keep(self, points: FloatArray, degrees: IntArray, repeats: IntArray, closed: bool) -> None:
        """Add what is left of a contour, whose arrays are no longer needed; ``closed``: by a line of this reader."""
        from ..outlines.segments import keep_lasting  # imports the compiler, which opening does not need

        if self.strokes and (found := retraced(points, degrees, self._coincident)):
            self._keep_paths(found)
            return
        n, m, distance = keep_lasting(points, degrees, repeats, self._coincident, closed)
        if n < 0:
            raise GlyphsplineError("coordinates that are not finite", contour=self.drawn)
        self.snapped = max(self.snapped, distance)
        if n and not (self._masters == 1 and Contour(points[0, :n], degrees[:m]).is_open):
            self.stacks.append(MasterContour(np.ascontiguousarray(points[:, :n]), degrees[:m]))
            self.repeats.append(repeats[:m])
        else:
            self.left_out.append(self.drawn)
        self.drawn += 1

    def _keep_paths(self, found: Sequence[Path]) -> None:
        """Add the strokes of a contour; it is left out if there are none."""
        for points, degrees in found:
            if not np.isfinite(points).all():
                raise GlyphsplineError("coordinates that are not finite", contour=self.drawn)
            self.stacks.append(MasterContour(*there_and_back(points, degrees)))
            self.repeats.append(np.zeros(2 * len(degrees), dtype=np.int64))
        if not found:
            self.left_out.append(self.drawn)
        self.drawn += 1
