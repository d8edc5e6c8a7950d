"""SVG path data of the contours of many glyphs at once, and the tight boxes around them.

A font point (x, y) is written as (x, -y). Coordinates are rounded and written as differences, whose sums are exactly
the rounded coordinates: these take two thirds of the bytes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...curves.bezier import evaluate
from ...outlines.contour_arrays import ContourArrays, Polylines, offsets_of
from ...outlines.extrema import stationary
from ...outlines.outline import Contour, Contours
from ...types import BoolArray, FloatArray, IntArray

Box = tuple[float, float, float, float]
"""Left, bottom, right, top in font units, y up."""

COMMANDS = b" lqcmLQCM"
"""By degree, relative and absolute."""

LINE_BY, MOVE_BY, MOVE = 1, 4, 8

EXACT = 2.0**50
"""Differences of coordinates, in units of the last decimal, are whole numbers below this. A glyph that has larger ones
is written with absolute numbers of 15 digits."""


class PathData(NamedTuple):
    """Path data of a glyph, and the tight box around it; None if there is nothing."""

    text: str
    box: Box | None


def curves_data(curves: ContourArrays, precision: int, glyphs: IntArray | None = None) -> list[PathData]:
    """Path data of lines, quadratics and cubics.

    Args:
        curves: of all glyphs end to end. precision: decimals.
        glyphs: (G + 1,) where the contours of each glyph begin; None: they are one glyph's.
    """
    return _written(curves, np.ones(curves.num_contours, dtype=np.bool_), precision, glyphs)


def polylines_data(lines: Polylines, precision: int, glyphs: IntArray | None = None) -> list[PathData]:
    """Path data of polygons and open polylines; arguments as for :func:`curves_data`."""
    ones = np.ones(len(lines.points), dtype=np.int64)
    return _written(ContourArrays(lines.points, ones, lines.offsets, lines.offsets), lines.closed, precision, glyphs)


def path_data(contours: Iterable[Contour], precision: int) -> str:
    """The contours of one glyph as SVG path data."""
    arrays = contours.arrays if isinstance(contours, Contours) else Contours(contours).arrays
    return curves_data(arrays, precision)[0].text


def polyline_data(points: FloatArray, precision: int, *, closed: bool = False) -> str:
    """Points (k, 2) joined by straight lines, as SVG path data."""
    points = np.ascontiguousarray(points, dtype=np.float64)
    return polylines_data(Polylines(points, np.array([0, len(points)]), np.array([closed])), precision)[0].text


def dots_data(points: FloatArray, precision: int) -> str:
    """Path data of a dot on each of the points (n, 2), to be stroked with round caps; huge coordinates are left out."""
    whole = to_whole(points, precision)
    whole = whole[(np.abs(whole) < EXACT / 2).all(axis=1)]
    return dots(*path_text(whole, np.full(len(whole), MOVE_BY), np.array([0, len(whole)]), precision))


def dots(moves: str, starts: Sequence[int]) -> str:
    """A dot, a stroke of no length, after each move; ``starts`` are where the moves begin, and the last one ends."""
    return "".join([moves[a:b] + "h0" for a, b in pairwise(starts)])


@cache
def comb_precision(em: float) -> int:
    """Decimals of comb coordinates: 1/10,000 em is finer than any screen shows."""
    return max(0, 4 - round(float(np.log10(em))))


def to_whole(points: FloatArray, precision: int) -> FloatArray:
    """Coordinates rounded, in units of the last decimal. Rounding errors do not decide which way a half goes: up."""
    return np.asarray(np.floor(points * 10.0**precision + (0.5 + 1e-6)))


def path_text(points: FloatArray, commands: IntArray, offsets: IntArray, precision: int) -> tuple[str, list[int]]:
    """Paths end to end, of relative moves and lines, as :func:`moves_text`; each then begins with an absolute one.

    Args:
        points: (n, 2) in units of the last decimal. offsets: where each path begins, and n.
    """
    first = offsets[:-1][np.diff(offsets) > 0]
    steps = np.diff(points, axis=0, prepend=[[0.0, 0.0]])
    steps[first], commands[first] = points[first], MOVE
    return moves_text(steps, commands, precision)


def moves_text(moves: FloatArray, commands: IntArray, precision: int) -> tuple[str, list[int]]:
    """Path data, and where each point of it begins, with its command, and the last one ends.

    Args:
        moves: (n, 2) in units of the last decimal, y up.
        commands: (n,) indices of ``COMMANDS``; of equal ones in a row that are no moves the first is written.
        precision: decimals.
    """
    from .path_numbers import path_numbers  # here and not above: the package opens without a compiler

    shown = (np.diff(commands, prepend=0) != 0) | (commands % MOVE_BY == 0)
    letters = np.where(shown, np.frombuffer(COMMANDS, dtype=np.uint8)[commands], 0).astype(np.int64)
    if not len(moves) or np.abs(moves).max() < EXACT:
        text, starts = path_numbers(moves, letters, precision)
        return text.tobytes().decode("ascii"), starts.tolist()
    pairs = zip(letters.tolist(), (moves * (1, -1) / 10.0**precision + 0.0).tolist(), strict=True)
    parts = [f"{chr(letter) if letter else ' '}{x:.15g} {y:.15g}" for letter, (x, y) in pairs]
    return "".join(parts), offsets_of([len(part) for part in parts]).tolist()


def _written(curves: ContourArrays, closed: BoolArray, precision: int, glyphs: IntArray | None) -> list[PathData]:
    points, degrees, offsets, starts = curves
    bounds = [0, curves.num_contours] if glyphs is None else glyphs.tolist()
    whole = np.rint(points * 10.0**precision)
    huge = not np.abs(whole).max(initial=0.0) < EXACT / 2
    if huge and len(bounds) > 2:
        return [_written(curves.part(a, b), closed[a:b], precision, None)[0] for a, b in pairwise(bounds)]
    full = np.flatnonzero(np.diff(offsets))
    first, number = offsets[full], np.arange(len(full))
    last = offsets[full + 1] + number
    # The commands of a contour: a move, then its segments. Z draws a last line. A last curve is absolute: it ends where
    # the contour begins also for a reader that adds up binary fractions.
    kinds, counts = np.insert(degrees, first, MOVE_BY), np.insert(degrees, first, 1)
    begin = np.insert(np.cumsum(degrees) - degrees, first, 0)
    curved = kinds[last] > 1
    counts[last] *= curved
    absolute = np.full(len(kinds), huge)
    absolute[first + number] = absolute[last] = True
    of = np.repeat(np.arange(len(kinds)), counts)
    commands = (kinds + MOVE_BY * absolute)[of]
    again = full[curved]  # their first points are written once more
    order = np.insert(np.arange(len(points)), starts[again + 1], starts[again])
    moves = whole[order] - np.where(absolute[of], 0.0, whole[begin[of]].T).T
    (text, at), sizes = moves_text(moves, commands, precision), np.diff(starts)
    sizes[again] += 1
    ends = pairwise(np.array(at)[offsets_of(sizes)].tolist())
    drawn = [text[a:b] + "Z" * (shut and a < b) for (a, b), shut in zip(ends, closed.tolist(), strict=True)]
    boxes = _boxes(curves._replace(points=whole / 10.0**precision), [int(offsets[c]) for c in bounds])
    return [PathData("".join(drawn[a:b]), box) for (a, b), box in zip(pairwise(bounds), boxes, strict=True)]


def _boxes(curves: ContourArrays, bounds: list[int]) -> Iterator[Box | None]:
    """The boxes of groups of segments; ``bounds`` are the first segment of each, and the number of all."""
    from ...outlines.segments import all_cubics  # here and not above: the package opens without a compiler

    cubics = all_cubics(curves)
    low, high = cubics[:, ::3].min(axis=1), cubics[:, ::3].max(axis=1)
    out = np.nonzero((cubics.min(axis=1) < low) | (cubics.max(axis=1) > high))
    values = cubics[out[0], :, out[1]]
    for t in np.nan_to_num(stationary(np.diff(values, axis=1))).T:
        found = evaluate(values[..., None], np.clip(t, 0.0, 1.0))[:, 0]
        low[out], high[out] = np.minimum(low[out], found), np.maximum(high[out], found)
    for a, b in pairwise(bounds):
        yield (*low[a:b].min(axis=0).tolist(), *high[a:b].max(axis=0).tolist()) if a < b else None
