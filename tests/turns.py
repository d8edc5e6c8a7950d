"""Turns at the nodes of outlines, read from fonts by fontTools alone: those of a font that another one has not.

It shares nothing with the package. A node is where two pieces of a contour meet: also where TrueType implies a point on
the curve. What a piece arrives and leaves with is the way to the nearest of its control points that is elsewhere.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import atan2, degrees, dist
from typing import Any, NamedTuple

from fontTools.pens.basePen import decomposeQuadraticSegment
from fontTools.pens.recordingPen import DecomposingRecordingPen

Point = tuple[float, float]
Piece = tuple[Point, ...]
"""Control points of a line, quadratic or cubic."""

LEAST, MOST = 0.5, 12.0
"""Degrees of a turn that is seen, and is no corner."""

ALIKE = 1.0
"""Degrees by which a turn may be more than the one that is there already."""


class Turn(NamedTuple):
    """A node, and by how many degrees the outline turns there."""

    x: float
    y: float
    size: float


def contours(glyphs: Any, name: str) -> Iterator[list[Piece]]:
    """The contours of a glyph of a font's glyph set, closed, without pieces that have no extent."""
    pen = DecomposingRecordingPen(glyphs)
    glyphs[name].draw(pen)
    pieces, here, start = list[Piece](), (0.0, 0.0), (0.0, 0.0)
    for operator, points in pen.value:
        if operator == "moveTo":
            pieces, here, start = [], points[0], points[0]
        elif operator == "lineTo":
            pieces.append((here, points[0]))
        elif operator == "curveTo":
            pieces.append((here, *points))
        elif operator == "qCurveTo":
            if points[-1] is None:  # a contour without a point on the curve begins midway
                points = (*points[:-1], middle(points[-2], points[0]))
                pieces, here, start = [], points[-1], points[-1]
            for control, end in decomposeQuadraticSegment(points):
                pieces.append((here, control, end))
                here = end
        else:
            pieces.append((here, start))
            yield [piece for piece in pieces if any(point != piece[0] for point in piece)]
            continue
        here = points[-1]


def middle(a: Point, b: Point) -> Point:
    """Midway between two points."""
    return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2


def way(points: Piece) -> Point:
    """From the first point to the next one that is elsewhere."""
    (x, y), (u, v) = points[0], next(point for point in points if point != points[0])
    return u - x, v - y


def turns(glyphs: Any, name: str) -> list[Turn]:
    """The nodes of a glyph at which it turns by half a degree or more, corners too."""
    found = []
    for pieces in contours(glyphs, name):
        for before, behind in zip(pieces[-1:] + pieces[:-1], pieces, strict=True):
            (ax, ay), (bx, by) = way(before[::-1]), way(behind)
            ax, ay = -ax, -ay
            size = abs(degrees(atan2(ax * by - ay * bx, ax * bx + ay * by)))
            if size >= LEAST:
                found.append(Turn(*behind[0], size))
    return found


def new_turns(source: list[Turn], result: list[Turn], near: float) -> list[Turn]:
    """Turns of a result, no corners, that its source has not within ``near`` units of them; each of its turns counts
    for one, for the largest first."""
    left, found = list(source), []
    for turn in sorted(result, key=lambda turn: -turn.size):
        there = [one for one in left if dist(one[:2], turn[:2]) <= near and turn.size <= one.size + ALIKE]
        if there:
            left.remove(min(there, key=lambda one: abs(one.size - turn.size)))
        elif turn.size <= MOST:
            found.append(turn)
    return found
