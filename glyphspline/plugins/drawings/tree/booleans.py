"""Skia's path operations (the extra ``drawings``) on shapes: only where something has to be cut or united.

They work in single precision, so that shapes are brought to some thousand units, and only what changes is taken back.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np

from ....errors import GlyphsplineError
from ....extras import need
from ....types import BoolArray, FloatArray
from .painted import Shape, placed
from .path_data import Path, Subpath
from .transforms import translation

SIZE = 4096.0
"""Height of a view in the units of the operations, about: single precision has a thousandth of them."""

MOST_SEGMENTS, MOST_MEETINGS, MOST_WORK = 10_000, 100_000, 2_000_000
"""Limits of one operation, of segments and of pairs that may cross, and of all: a scribble takes Skia hours."""

EACH = 100
"""What an operation costs besides, in such pairs."""

CHUNK = 512
"""Segments that are compared with all others at a time."""

CHANGED = 1e-6
"""Share of an area from which it counts as changed."""

Area: TypeAlias = Any
"""A ``pathops.Path``, by its own rule of filling."""


class CutError(GlyphsplineError):
    """Skia found no result."""


class Plane:
    """Shapes as areas and back.

    Args:
        x, y: the middle of what is drawn, in the glyph's units. height: of it.
    """

    def __init__(self, x: float, y: float, height: float) -> None:
        self._x, self._y = x, y
        self.scale, self._work = 2.0 ** round(math.log2(SIZE / height)), 0

    @cached_property
    def _skia(self) -> Any:
        need("drawings")
        import pathops

        return pathops

    def area(self, shape: Shape) -> Area:
        """A shape as an area."""
        found = self._skia.Path()
        found.fillType = self._skia.FillType.EVEN_ODD if shape.rule == "evenodd" else self._skia.FillType.WINDING
        for subpath in shape.path:
            points = [
                ((x - self._x) * self.scale, (y - self._y) * self.scale)
                for x, y in placed(subpath.points, shape.matrix)
            ]
            draw(found, points, subpath)
        return found

    def box(self, corners: list[tuple[float, float]]) -> Area:
        """A polygon, in the glyph's units, as an area."""
        return self.area(Shape([Subpath(corners, [1] * (len(corners) - 1), True)], translation(0.0, 0.0)))

    def path(self, area: Area) -> Path:
        """An area as a path in the glyph's units."""
        found = path_of(area)
        for subpath in found:
            subpath.points = [(x / self.scale + self._x, y / self.scale + self._y) for x, y in subpath.points]
        return found

    def simple(self, area: Area) -> Area:
        """The same area without overlaps, filled by the nonzero rule.

        Raises:
            CutError: Skia finds no result, or would take too long for it.
            GlyphsplineError: all that was asked of it is too much.
        """
        return self._tried(lambda: simplified(area), area)

    def united(self, areas: list[Area]) -> Area:
        """What any of some areas covers; raises as :meth:`simple`."""
        return self._tried(lambda: self._united(areas), *areas)

    def both(self, one: Area, other: Area) -> Area:
        """What both areas cover; raises as :meth:`simple`."""
        return self._tried(lambda: self._skia.op(one, other, self._skia.PathOp.INTERSECTION), one, other)

    def without(self, one: Area, other: Area) -> Area:
        """What the first area covers and the second does not; raises as :meth:`simple`."""
        return self._tried(lambda: self._skia.op(one, other, self._skia.PathOp.DIFFERENCE), one, other)

    def _united(self, areas: list[Area]) -> Area:
        """All that are simple run alike, so that they are one area by the nonzero rule."""
        found = self._skia.Path()
        for area in areas:
            found.addPath(simplified(area))
        return simplified(found)

    def _tried(self, make: Callable[[], Area], *areas: Area) -> Area:
        work = meetings(areas)
        self._work += work + EACH
        if work > MOST_MEETINGS:
            raise CutError("path operations on too many crossings")
        if self._work > MOST_WORK:
            raise GlyphsplineError("more to cut and to unite than is done for one drawing")
        try:
            return make()
        except self._skia.PathOpsError as error:
            raise CutError("path operations found no result") from error


def meetings(areas: Sequence[Area]) -> int:
    """How many segments there are, and pairs of them that may cross: Skia looks at each."""
    boxes, here = list[tuple[float, ...]](), (0.0, 0.0)
    for area in areas:
        for _, points in area:
            if len(points) > 0:
                x, y = zip(here, *points, strict=True)
                boxes.append((min(x), min(y), max(x), max(y)))
                here = points[-1]
    if len(boxes) > MOST_SEGMENTS:
        return MOST_MEETINGS + 1
    left, bottom, right, top = np.array(boxes).reshape(-1, 4).T
    met = len(boxes)
    for k in range(0, len(boxes), CHUNK):
        part = slice(k, k + CHUNK)
        across = (left[part, None] < right) & (left < right[part, None])
        met += int((across & (bottom[part, None] < top) & (bottom < top[part, None])).sum()) // 2
    return met


def simplified(area: Area) -> Area:
    """A copy of an area without overlaps, filled by the nonzero rule; Skia's own exceptions pass through."""
    import pathops

    found = pathops.Path(area)
    found.simplify(fix_winding=True, keep_starting_points=True)
    return found


def draw(area: Area, points: list[tuple[float, float]], subpath: Subpath) -> None:
    """Add a subpath, at these points, to an area."""
    pen, at = area.getPen(), 1
    pen.moveTo(points[0])
    for degree in subpath.degrees:
        (pen.lineTo, pen.qCurveTo, pen.curveTo)[degree - 1](*points[at : at + degree])
        at += degree
    (pen.closePath if subpath.closed else pen.endPath)()


def path_of(area: Area) -> Path:
    """An area as a path, in its own units."""
    from pathops import PathVerb

    area.convertConicsToQuads(0.05)
    found: Path = []
    for verb, points in area:
        if verb == PathVerb.MOVE:
            found.append(Subpath([points[0]]))
        elif verb == PathVerb.CLOSE:
            found[-1].closed = True
        else:
            found[-1].points.extend(points)
            found[-1].degrees.append(len(points))
    return [subpath for subpath in found if subpath.degrees]


def size_of(area: Area) -> float:
    """The area of an area without overlaps."""
    return abs(float(area.area))


def overlap(box: FloatArray, boxes: FloatArray) -> BoolArray:
    """(n,) whether a box (4,), its left, bottom, right and top, has more than a line in common with others (n, 4)."""
    return np.all((box[:2] < boxes[:, 2:]) & (boxes[:, :2] < box[2:]), axis=1)
