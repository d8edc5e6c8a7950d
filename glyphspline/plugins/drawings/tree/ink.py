"""Contours whose ink, by the nonzero rule, is what shapes paint together: each under its own rule, and as it is seen.

A path alone is left as it is. Otherwise contours are turned round where that is enough, and their points stay; only
where contours of one shape cross so that no direction serves, they are united.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import comb
from typing import TYPE_CHECKING

import numpy as np

from ....extras import has
from ....types import BoolArray, FloatArray, IntArray
from .booleans import CutError, overlap, size_of
from .painted import Shape, placed

if TYPE_CHECKING:
    from .path_data import Point
    from .structure import Structure

CHORDS = 24
"""Chords a curve, for telling inside from outside."""

LINES = (24, 9, 3)
"""Scan lines through each contour; the fewer where there are very many contours."""

MOST_CROSSINGS = 2_000_000
"""Crossings of scan lines that are looked at."""

NARROW = 5e-4
"""Share of a shape's width: what is narrower says nothing of inside and outside."""

WHITE = 254.5 / 255
"""Components from which a colour is that of the paper."""

LOST = 1e-3
"""Share of an area that goes unnoticed where colours lie upon each other."""

MOST_PAIRS = 500
"""Pairs of shapes that are looked at for colours upon each other."""


@dataclass(frozen=True, eq=False)
class Chain:
    """A contour as it is drawn: its points, the degrees of its segments, and whether it is closed."""

    points: list[Point]
    degrees: list[int]
    closed: bool

    def turned(self) -> Chain:
        """It in the other direction, from the same start."""
        points, degrees = self.points, self.degrees
        if points[-1] != points[0]:
            points, degrees = [*points, points[0]], [*degrees, 1]
        return Chain(points[::-1], degrees[::-1], True)

    def chords(self) -> FloatArray:
        """(n, 2) points on it."""
        parts, at, t = [np.array(self.points[:1])], 0, np.arange(1, CHORDS + 1) / CHORDS
        for degree in self.degrees:
            points = np.array(self.points[at : at + degree + 1])
            at += degree
            if degree == 1:
                parts.append(points[1:])
            else:
                weights = [comb(degree, k) * t**k * (1 - t) ** (degree - k) for k in range(degree + 1)]
                parts.append(np.transpose(weights) @ points)
        return np.concatenate(parts)


def ink_of(shapes: Sequence[Shape], structure: Structure) -> list[Chain]:
    """The contours of all that shapes paint, in their order."""
    shapes = on_paper(shapes, structure)
    name_colours(shapes, structure)
    chains = [chains_of(shape) for shape in shapes]
    if len(shapes) == 1 and shapes[0].rule == "nonzero":
        return chains[0]
    boxes = np.array([box_of(each) for each in chains]).reshape(-1, 4)
    found = list[list[Chain]]()
    for k, (shape, own) in enumerate(zip(shapes, chains, strict=True)):
        meets = int(overlap(boxes[k], boxes).sum()) > 1
        directed = directed_of(own, shape.rule)
        if directed is None and (meets or shape.rule != "nonzero"):
            directed = united(shape, structure)
        found.append(own if directed is None else directed)
    first = _area(max(chains[0], key=lambda chain: abs(_area(chain)))) if chains and chains[0] else 1.0
    turn = first < 0
    return [chain.turned() if turn else chain for each in found for chain in each]


def chains_of(shape: Shape) -> list[Chain]:
    """The contours of a shape, in the glyph's units."""
    return [Chain(placed(sub.points, shape.matrix), sub.degrees, sub.closed) for sub in shape.path]


def united(shape: Shape, structure: Structure) -> list[Chain] | None:
    """The contours of a shape without overlaps, running counter-clockwise around ink; None if there is no result."""
    plane = structure.cutting.plane
    try:
        path = plane.path(plane.simple(plane.area(shape)))
    except CutError:
        structure.unread.add("crossing contours that cannot be united", shape.line)
        return None
    chains = [Chain(sub.points, sub.degrees, sub.closed) for sub in path]
    return directed_of(chains, "nonzero") or chains


def directed_of(chains: list[Chain], rule: str) -> list[Chain] | None:
    """Contours turned so that they wind around ink once or more, counter-clockwise, and around nothing else.

    None if no directions do, or what is inside cannot be told.
    """
    solid = [chain for chain in chains if chain.degrees]
    crossed = crossings(solid)
    if crossed is None:
        return None
    contour, way, before, after, tell = crossed
    if rule == "nonzero":
        if (after[tell] >= 0).all():
            return chains
        if (after[tell] <= 0).all():
            return [chain.turned() if chain.degrees else chain for chain in chains]
        inked = (before != 0).astype(int), (after != 0).astype(int)
    else:
        inked = before % 2, after % 2
    # At each crossing ink begins (1), ends (-1) or goes on (0); that is what its contour should wind.
    wanted = (inked[1] - inked[0]) * way
    turned = list[Chain]()
    for c, chain in enumerate(solid):
        own = wanted[(contour == c) & tell]
        if not len(own) and abs(_area(chain)) <= NARROW * np.ptp(chain.chords(), axis=0).max() ** 2:
            turned.append(chain)  # it encloses nothing
            continue
        if not len(own) or own.min() != own.max():
            return None
        if own[0]:
            turned.append(chain if own[0] > 0 else chain.turned())
    return turned


def crossings(chains: list[Chain]) -> tuple[IntArray, IntArray, IntArray, IntArray, BoolArray] | None:
    """Where scan lines cross contours, from left to right.

    Returns:
        Of each crossing the contour, by how much it winds to the right of it, the winding number of all before and
        after it, and whether it is far enough from others to tell anything; None without crossings.
    """
    outlines = [chain.chords() for chain in chains]
    if not outlines:
        return None
    start = np.concatenate(outlines)
    stop = np.concatenate([np.roll(points, -1, axis=0) for points in outlines])
    of = np.repeat(np.arange(len(outlines)), [len(points) for points in outlines])
    ends = np.sort([start[:, 1], stop[:, 1]], axis=0)
    for at in scan_lines(chains, outlines):
        first, last = np.searchsorted(at, ends)
        if (last - first).sum() <= MOST_CROSSINGS:
            break
    if not 0 < (last - first).sum() <= MOST_CROSSINGS:
        return None
    side = np.repeat(np.arange(len(start)), last - first)
    line = np.arange(len(side)) - np.repeat(np.cumsum(last - first) - last, last - first)
    rise = stop[side, 1] - start[side, 1]
    x = start[side, 0] + (at[line] - start[side, 1]) / rise * (stop[side, 0] - start[side, 0])
    order = np.lexsort((x, line))
    side, line, x = side[order], line[order], x[order]
    way = -np.sign(rise[order]).astype(np.int64)  # what runs down has its ink to the right
    after = np.cumsum(way)  # 0 at the end of each line
    near = np.diff(x) < NARROW * np.ptp(start, axis=0).max()
    near &= line[1:] == line[:-1]
    tell = ~(np.append(near, False) | np.insert(near, 0, False))
    return of[side], way, after - way, after, tell


def scan_lines(chains: Sequence[Chain], outlines: Sequence[FloatArray]) -> Iterator[FloatArray]:
    """Heights of scan lines through all contours, ascending: many, also between points, then fewer and fewer."""
    levels = np.unique(np.concatenate([np.array(chain.points)[:, 1] for chain in chains]))
    between = (levels[1:] + levels[:-1]) / 2
    for count in LINES:
        shares = (np.arange(count) + 0.5 + 0.1 * np.sin(np.arange(count))) / count
        lines = [points[:, 1].min() + shares * np.ptp(points[:, 1]) for points in outlines]
        yield np.unique(np.concatenate([*lines, between]))
        between = between[:0]


def _area(chain: Chain) -> float:
    """The signed area of a contour's chords."""
    x, y = chain.chords().T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def box_of(chains: Sequence[Chain]) -> tuple[float, float, float, float]:
    """Left, bottom, right and top of the points of contours."""
    points = np.concatenate([chain.points for chain in chains])
    return (*points.min(axis=0).tolist(), *points.max(axis=0).tolist())


# Colours -------------------------------------------------------------------------------------------------------------


def on_paper(shapes: Sequence[Shape], structure: Structure) -> list[Shape]:
    """Shapes as they look on white paper: what is white covers what is below it. White alone is ink."""
    white = [min(shape.colour[:3]) >= WHITE for shape in shapes]
    if all(white) or not any(white):
        return list(shapes)
    found, boxes = list[Shape](), np.empty((0, 4))
    for shape, is_white in zip(shapes, white, strict=True):
        box = np.array([box_of(chains_of(shape))])
        if not is_white:
            found, boxes = [*found, shape], np.concatenate([boxes, box])
            continue
        structure.unread.note("white is taken for the paper", shape.line)
        left = [
            without(below, shape, structure) if met else below
            for below, met in zip(found, overlap(box[0], boxes), strict=True)
        ]
        boxes = boxes[[below is not None for below in left]]
        found = [below for below in left if below is not None]
    return found


def without(below: Shape, shape: Shape, structure: Structure) -> Shape | None:
    """What a shape leaves of another below it; None if nothing."""
    plane = structure.cutting.plane
    try:
        return structure.cutting.changed(below, plane.without(plane.area(below), plane.area(shape)))
    except CutError:
        structure.unread.add("white that cannot be cut out", shape.line)
        return below


def name_colours(shapes: Sequence[Shape], structure: Structure) -> None:
    """Name colours that lie upon each other: what is between them does not show in one ink."""
    colours = [shape.colour[:3] for shape in shapes]
    if len({*colours}) < 2:
        return
    boxes, pairs = np.array([box_of(chains_of(shape)) for shape in shapes]), 0
    for k in range(len(shapes)):
        for j in np.nonzero(overlap(boxes[k], boxes[:k]))[0].tolist():
            if colours[j] == colours[k]:
                continue
            pairs += 1
            if pairs > MOST_PAIRS or shows_through(shapes[j], shapes[k], structure):
                structure.unread.add("colours upon each other, drawn as one ink", shapes[k].line)
                return


def shows_through(below: Shape, above: Shape, structure: Structure) -> bool:
    """Whether a shape covers a part of another, and not all of it; their boxes say it where nothing cuts."""
    if not has("drawings"):
        return True
    plane = structure.cutting.plane
    try:
        areas = [plane.simple(plane.area(each)) for each in (below, above)]
        covered, sizes = size_of(plane.both(*areas)), [size_of(area) for area in areas]
    except CutError:
        return True
    return LOST * min(sizes) < covered < (1 - LOST) * sizes[0]
