"""What is painted, and where: the values that pass between structure, clips, strokes and ink."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from fontTools.misc.bezierTools import calcCubicBounds, calcQuadraticBounds

from ....types import FloatArray
from .lengths import Lengths
from .paint import BLACK, Colour
from .path_data import Path
from .styles import Style


@dataclass(frozen=True, eq=False)
class Shape:
    """Something that is painted in one colour.

    Attributes:
        path: in the units of its element. matrix: (3, 3) from these to the glyph's. rule: of filling.
        colour: that shows, with its opacity. line: of its element in the file. element: that one.
    """

    path: Path
    matrix: FloatArray
    rule: str = "nonzero"
    colour: Colour = BLACK
    line: int = 0
    element: Any = None


@dataclass(frozen=True, eq=False)
class Place:
    """Where an element stands.

    Attributes:
        matrix: (3, 3) from the units around it to the glyph's. style: of what is around it; None around the root.
        lengths: what its relative lengths refer to. opacity: of all groups around it.
        mode: what is wanted: "ink"; the area of a "clip"; "geometry", whatever of it shows; "own", of that what is no
            clone.
        clones: the elements that the clones around it refer to. size: width and height that a clone gives it.
    """

    matrix: FloatArray
    style: Style | None
    lengths: Lengths
    opacity: float = 1.0
    mode: str = "ink"
    clones: tuple[Any, ...] = ()
    size: tuple[str | None, str | None] | None = None


def placed(points: Any, matrix: FloatArray) -> list[tuple[float, float]]:
    """Points in the units that a matrix leads to."""
    (a, b, x), (c, d, y) = matrix[:2].tolist()
    return [(a * p + b * q + x, c * p + d * q + y) for p, q in points]


def bounds_of(shape: Shape) -> Iterator[tuple[float, float, float, float]]:
    """The bounds of each segment of a shape."""
    for subpath in shape.path:
        points, at = placed(subpath.points, shape.matrix), 0
        for degree in subpath.degrees:
            piece = points[at : at + degree + 1]
            if degree == 3:
                yield calcCubicBounds(*piece)
            elif degree == 2:
                yield calcQuadraticBounds(*piece)
            else:
                (x, y), (p, q) = piece
                yield min(x, p), min(y, q), max(x, p), max(y, q)
            at += degree
