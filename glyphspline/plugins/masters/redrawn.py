"""The glyphs of a font that are drawn anew in all masters, and what a font stores of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from ...curves.integrals import area
from ...outlines.masters import MasterContour, Masters
from ...outlines.outline import Contour
from ...readers.pens import ContourPen
from ...readers.ufo import EditableSource
from ...types import BoolArray, IntArray, counted
from ..fonts.back.back import NewGlyph
from ..fonts.tables.font_glyphs import Flavour


@dataclass(frozen=True, eq=False)
class Redrawn:
    """A glyph's new contours in all its masters.

    Attributes:
        masters: the glyph as the font has it. Its K masters and their regions are those of ``contours``.
        contours: the new ones.
        inner: for each contour (m,) whether segment j begins inside an arc, where the curve is to stay smooth; False
            at the ends of arcs and lines.
        bounds: for each contour its certified distance from its source. If they are given, arcs are compared with the
            source, and stay as the font has them where the new ones would turn a joint that the source does not turn.
        numbers: with ``bounds``, for each contour that of its source in ``masters``.
        fewest: with ``bounds``, arcs also stay as they are where new ones would need more points.
        tally: see :class:`StoredGlyph`, of contours that are as ``glyf`` stores them: quadratics, those at ``inner``
            joints beginning midway between control points; or the source's own. Else None.

    Raises:
        ValueError: the numbers of masters, contours or segments do not agree.
    """

    masters: Masters
    contours: tuple[MasterContour, ...]
    inner: tuple[BoolArray, ...]
    bounds: tuple[float, ...] = ()
    numbers: tuple[int, ...] = ()
    fewest: bool = False
    tally: IntArray | None = None

    def __post_init__(self) -> None:
        if len(self.contours) != len(self.inner):
            raise ValueError(f"{counted(len(self.contours), 'contour')}, but joints of {len(self.inner)}")
        if self.bounds and not len(self.bounds) == len(self.numbers) == len(self.contours):
            raise ValueError(f"{counted(len(self.contours), 'contour')}, but bounds of {len(self.bounds)}")
        for contour, inner in zip(self.contours, self.inner, strict=True):
            points, degrees = contour.points, contour.degrees
            if points.shape != (len(self.masters), int(degrees.sum()), 2) or inner.shape != degrees.shape:
                raise ValueError(f"{counted(len(self.masters), 'master')}, but points {points.shape}")


@dataclass(frozen=True, eq=False)
class StoredGlyph:
    """A glyph as a font stores it.

    Attributes:
        inner: for each contour (m,) whether segment j begins inside an arc; in glyf, at an implied point.
        distance: certified bound of the largest distance from the contours that were given, in font units, at any
            location. bound: of that from the source; None if no bounds were given.
        tally: (3, 2) before and after: points, in glyf as stored, in CFF2 lines and curves; joints that ``check``
            reports along the axes and in masters; and those of them that turn more between masters than in them. None
            likewise.
    """

    inner: tuple[BoolArray, ...]
    distance: float
    bound: float | None = None
    tally: IntArray | None = None


def displaced(found: Masters, drawn: Masters) -> float:
    """How far the points of a glyph, as it was read, are at most from those that were to be drawn, at any location.

    Infinite where it has other segments; those of no length do not count.
    """
    pen, corners = ContourPen(masters=len(drawn), opens=True), drawn.grid()
    for contour in drawn.contours:
        pen.contour(contour.points, contour.degrees)
    far, weights = 0.0, (found.weights_at(corners), drawn.weights_at(corners))
    if [each.degrees.tolist() for each in pen.stacks] != [each.degrees.tolist() for each in found.contours]:
        return inf
    for both in zip(found.contours, pen.stacks, strict=True):
        # Between the corners of the grid points are convex combinations of those there, and so are their distances.
        here, there = (np.tensordot(w, contour.points, axes=1) for w, contour in zip(weights, both, strict=True))
        far = max(far, float(np.linalg.norm(here - there, axis=2).max()))
    return far


def bound_of(glyph: StoredGlyph, redrawn: Redrawn) -> float:
    """A bound of a stored glyph's distance from its source. Where its arcs were not compared with the source, what is
    certified and how far it is stored add up.
    """
    return max(redrawn.bounds, default=0.0) + glyph.distance if glyph.bound is None else glyph.bound


def oriented(new: Redrawn, flavour: Flavour) -> Redrawn:
    """The glyph with ink to the right of its contours in the default, as TrueType has it, or to their left.

    Quadratics are not compared with the source's, which are others: their bounds are none.
    """
    if flavour == "ttf" and new.tally is None:
        new = Redrawn(new.masters, new.contours, new.inner)
    total = sum(area(contour.cubics()[0]) for contour in new.contours)
    if (total >= 0) == (flavour == "otf") or total == 0:
        return new
    masters = replace(new.masters, contours=[contour.reversed() for contour in new.masters.contours], repeats=None)
    inner = tuple(np.roll(joints[::-1], 1) for joints in new.inner)
    return replace(new, masters=masters, contours=tuple(c.reversed() for c in new.contours), inner=inner)


def of_masters(source: EditableSource, redrawn: Mapping[str, Redrawn]) -> Iterable[NewGlyph]:
    """The new contours of a source's glyphs in the masters in which they are drawn."""
    for name, new in redrawn.items():
        places = new.masters.stored_peaks
        drawings = [each for each in source.drawings(name) if each.place in places]
        chosen = [places.index(each.place) for each in drawings]
        yield NewGlyph(name, [[Contour(c.points[k], c.degrees) for k in chosen] for c in new.contours], drawings)
