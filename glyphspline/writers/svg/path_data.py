"""SVG path data of the contours of many glyphs in one compiled call.

A font point (x, y) is written as (x, -y). Coordinates are rounded and written as differences, whose sums are exactly
the rounded coordinates.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ...outlines.contour_arrays import ContourArrays, Polylines
from ...outlines.outline import Contour, Contours
from ...types import BoolArray, FloatArray, IntArray

Box = tuple[float, float, float, float]
"""Left, bottom, right, top in font units, y up."""

NUMBER = "%.15g"
"""Format of a rounded coordinate, without trailing zeros. 15 digits do not show binary rounding; 17 would write 0.1 as
0.10000000000000001."""

_COMMANDS = {d: "MLQC"[d] + " ".join([f"{NUMBER} {NUMBER}"] * d) for d in (1, 2, 3)}


class PathData(NamedTuple):
    """Path data of a glyph, in ASCII, and the tight box around it; None if there is nothing."""

    text: memoryview
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


def dots_data(points: FloatArray, precision: int) -> memoryview:
    """Path data of a dot on each of the points (n, 2), to be stroked with round caps."""
    from .path_text import dots_text  # here and not above: the package opens without a compiler

    return dots_text(np.ascontiguousarray(points), precision).data


def path_data(contours: Iterable[Contour], precision: int) -> str:
    """The contours of one glyph as SVG path data."""
    arrays = contours.arrays if isinstance(contours, Contours) else Contours(contours).arrays
    return str(curves_data(arrays, precision)[0].text, "ascii")


def polyline_data(points: FloatArray, precision: int, *, closed: bool = False) -> str:
    """Points (k, 2) joined by straight lines, as SVG path data."""
    points = np.ascontiguousarray(points, dtype=np.float64)
    lines = Polylines(points, np.array([0, len(points)]), np.array([closed]))
    return str(polylines_data(lines, precision)[0].text, "ascii")


def _written(curves: ContourArrays, closed: BoolArray, precision: int, glyphs: IntArray | None) -> list[PathData]:
    from .path_text import path_text  # here and not above: the package opens without a compiler

    bounds = np.asarray([0, curves.num_contours] if glyphs is None else glyphs, dtype=np.int64)
    text, ends, boxes, too_large = path_text(curves, closed, bounds, precision)
    parts = [text.data[a:b] for a, b in pairwise(ends.tolist())]
    for glyph in np.flatnonzero(too_large).tolist():
        parts[glyph] = _of_any_size(curves, closed, range(*bounds[glyph : glyph + 2].tolist()), precision)
    return [PathData(part, _box(box)) for part, box in zip(parts, boxes.tolist(), strict=True)]


def _box(values: list[float]) -> Box | None:
    left, bottom, right, top = values
    return (left, bottom, right, top) if left <= right else None


def _of_any_size(curves: ContourArrays, closed: BoolArray, which: range, precision: int) -> memoryview:
    """Path data of one glyph with absolute numbers of any size."""
    texts = []
    for c in which:
        part: Any = curves.part(c, c + 1)
        values, degrees = np.round(part.points * (1, -1), precision) + 0.0, part.degrees.tolist()
        if degrees:
            ends = [] if degrees[-1] == 1 else [values[:1]]  # Z draws a last line
            degrees = degrees[: len(degrees) - 1 + len(ends)]
            template = f"M{NUMBER} {NUMBER}" + "".join([_COMMANDS[d] for d in degrees]) + "Z" * bool(closed[c])
            texts.append(template % tuple(np.concatenate([values, *ends]).ravel().tolist()))
    return memoryview("".join(texts).encode())
