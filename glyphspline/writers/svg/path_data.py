"""SVG path data of the contours of many glyphs at once, and the tight boxes around them.

A font point (x, y) is written as (x, -y). Coordinates are rounded and written as differences, whose sums are exactly
the rounded coordinates: these take two thirds of the bytes.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...outlines.contour_arrays import ContourArrays, Polylines, polylines
from ...outlines.open_paths import are_open, by_kind, paths
from ...outlines.outline import Contour, Contours
from ...types import BoolArray, FloatArray, IntArray

Box = tuple[float, float, float, float]
"""Left, bottom, right, top in font units, y up."""


class PathData(NamedTuple):
    """Path data of a glyph, and the tight box around it; None if there is nothing. ``strokes`` is that of open paths,
    which are drawn as lines.
    """

    text: str
    box: Box | None
    strokes: str = ""


def curves_data(curves: ContourArrays, precision: int, glyphs: IntArray | None = None) -> list[PathData]:
    """Path data of lines, quadratics and cubics.

    Args:
        curves: of all glyphs end to end. precision: decimals.
        glyphs: (G + 1,) where the contours of each glyph begin; None: they are one glyph's.
    """
    bounds, opened = np.array([0, curves.num_contours]) if glyphs is None else glyphs, are_open(curves)
    if not opened.any():
        return _written(curves, ~opened, precision, bounds)
    ways, both = paths(curves, opened), by_kind(opened, bounds)
    closed, strokes = (_written(ways.chosen(which), ~opened[which], precision, ends) for which, ends in both)
    return [
        PathData(a.text, b.box if a.box is None else union(a.box, b.box), b.text)
        for a, b in zip(closed, strokes, strict=True)
    ]


def polylines_data(lines: Polylines, precision: int, glyphs: IntArray | None = None) -> list[PathData]:
    """Path data of polygons and open polylines; arguments as for :func:`curves_data`."""
    ones = np.ones(len(lines.points), dtype=np.int64)
    bounds = np.array([0, len(lines.closed)]) if glyphs is None else glyphs
    return _written(ContourArrays(lines.points, ones, lines.offsets, lines.offsets), lines.closed, precision, bounds)


def path_data(contours: Iterable[Contour], precision: int) -> str:
    """The contours of one glyph as SVG path data; open paths there and back, so that no filling shows."""
    arrays = contours.arrays if isinstance(contours, Contours) else Contours(contours).arrays
    count = arrays.num_contours
    return _written(arrays, np.ones(count, dtype=np.bool_), precision, np.array([0, count]))[0].text


def both_ways(data: PathData, curves: ContourArrays, precision: int) -> str:
    """Path data of all contours in order, open paths there and back, from what is known of them."""
    return path_data(Contours(curves), precision) if data.strokes else data.text


def polyline_data(points: FloatArray, precision: int, *, closed: bool = False) -> str:
    """Points (k, 2) joined by straight lines, as SVG path data."""
    return polylines_data(polylines([points], [closed]), precision)[0].text


def dots_data(points: FloatArray, precision: int) -> str:
    """Path data of a dot on each of the points (n, 2), to be stroked with round caps; huge coordinates are left out."""
    from .path_text import TIE, dots_text  # here and not above: the package opens without a compiler

    return dots_text(np.floor(points * 10.0**precision + (0.5 + TIE)), precision).tobytes().decode("ascii")


def union(a: Box, b: Box | None) -> Box:
    """The smallest box around both."""
    return a if b is None else (min(a[0], b[0]), min(a[1], b[1]), max(a[2], b[2]), max(a[3], b[3]))


@cache
def comb_precision(em: float) -> int:
    """Decimals of comb coordinates: 1/10,000 em is finer than any screen shows."""
    return max(0, 4 - round(float(np.log10(em))))


def _written(curves: ContourArrays, closed: BoolArray, precision: int, bounds: IntArray) -> list[PathData]:
    from .path_text import curves_text  # here and not above: the package opens without a compiler

    unit, found = 10.0**precision, []
    whole = curves._replace(points=np.rint(curves.points * unit))
    text, ends = curves_text(whole, closed, bounds, precision)
    boxes = _boxes(whole._replace(points=whole.points / unit), bounds)
    drawn = text.tobytes().decode("ascii")
    for g, ((a, b), box) in enumerate(zip(pairwise(ends.tolist()), boxes, strict=True)):
        data = drawn[a:b] if a < b or not box else _of_any_size(curves, closed, bounds[g], bounds[g + 1], precision)
        found.append(PathData(data, box))
    return found


def _boxes(curves: ContourArrays, glyphs: IntArray) -> list[Box | None]:
    """The tight boxes around glyphs."""
    from ...outlines.segments import all_cubics  # as above

    cubics, segments = all_cubics(curves), curves.offsets[glyphs]
    inked = np.diff(segments) > 0
    if not inked.any():
        return [None] * len(inked)
    owners = np.repeat(np.cumsum(inked) - 1, np.diff(segments))
    low, high = (extreme.reduceat(cubics[:, 0], segments[:-1][inked]) for extreme in (np.minimum, np.maximum))
    # Few segments reach beyond the ends of all.
    beyond = (cubics[:, 1:3].min(axis=1) < low[owners]) | (cubics[:, 1:3].max(axis=1) > high[owners])
    which, axis = np.nonzero(beyond)
    p0, p1, p2, p3 = cubics[which, :, axis].T
    a, half_b, c = p3 - 3.0 * p2 + 3.0 * p1 - p0, p2 - 2.0 * p1 + p0, p1 - p0
    root = np.sqrt(np.maximum(half_b * half_b - a * c, 0.0))
    # The stable pair q/a and c/q: neither loses digits when a is small, as on a raised quadratic.
    q = -(half_b + np.where(half_b < 0.0, -root, root))
    for numerator, denominator in ((q, a), (c, q)):
        t = np.maximum(numerator / np.where(np.abs(denominator) > np.abs(numerator), denominator, np.inf), 0.0)
        s = 1.0 - t
        values = s * s * s * p0 + 3.0 * s * s * t * p1 + 3.0 * s * t * t * p2 + t * t * t * p3
        np.minimum.at(low, (owners[which], axis), values)
        np.maximum.at(high, (owners[which], axis), values)
    found = iter(np.hstack([low, high]).tolist())
    return [tuple(next(found)) if some else None for some in inked.tolist()]


def _of_any_size(curves: ContourArrays, closed: BoolArray, first: int, stop: int, precision: int) -> str:
    """Path data of one glyph with absolute numbers of 15 digits."""
    texts = []
    for c in range(first, stop):
        own = curves.part(c, c + 1)
        values, degrees = np.round(own.points * (1, -1), precision) + 0.0, own.degrees.tolist()
        if degrees:
            pairs = [f"{x:.15g} {y:.15g}" for x, y in [*values.tolist(), values[0].tolist()]]
            ends = np.cumsum([1, *(degrees if degrees[-1] > 1 else degrees[:-1])]).tolist()  # Z draws a last line
            lines = [
                " LQC"[degree] + " ".join(pairs[a:b]) for degree, (a, b) in zip(degrees, pairwise(ends), strict=False)
            ]
            texts.append("".join(["M", pairs[0], *lines, "Z" * bool(closed[c])]))
    return "".join(texts)
