"""From glyph indices to path data and measures, a chunk of glyphs at a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..fitting.options import Options
from ..fitting.policy import CERTAIN_RATIO, method_for
from ..fitting.smooth.insertion import graded_polygons
from ..interpolation.batched import BatchedInterpolation, interpolate_batch
from ..outlines.outline import Outline
from ..outlines.places import sampled
from ..readers.opentype.bulk_contours import BulkReader, cubics_of
from ..types import BoolArray, FloatArray, IntArray
from ..writers.svg.bounds import ink_box
from ..writers.svg.curvature_map import comb_precision, map_document
from ..writers.svg.digit_tables import figures
from ..writers.svg.document import ViewBox, shown_box, svg_document
from ..writers.svg.markup import Box, Chains, curves_data, polylines_data
from ..writers.svg.source_drawing import SourceTexts, source_document
from ..writers.svg.spline_paths import cubics_of_splines, paths

MOST_VERTICES = 100_000
"""Vertices of a contour above which it is left to the long way."""


class Solved(NamedTuple):
    """What the interpolation itself has found out of contours, a list each: the first of the ``Measures``."""

    vertices: list[int]
    segments: list[int]
    numbers: list[int]
    iterations: list[int]
    residual: list[float]
    converged: list[bool]
    rate_bound: list[float]
    fallbacks: list[int]


@dataclass(frozen=True, eq=False)
class Chunk:
    """Everything known of a chunk of glyphs, as arrays laid end to end.

    Attributes:
        advances: of each glyph, in font units. left: (g,) which glyphs the long way has to take.
        before: (g + 1,) contours before each glyph.
        source: points and degrees of the source, and where each contour's begin in either; source_cubics: the same
            raised to cubics.
        polygons, polygon_starts: the vertices. controls, knots: of the splines, from the same places on (knots one
            more a contour). cubics, cubic_starts: Bézier pieces of the splines.
        text, text_ends: path data of the glyphs, as bytes. boxes: (g, 4) around the ink.
        solved: of each contour.
    """

    advances: list[int]
    left: BoolArray
    before: IntArray
    source: tuple[FloatArray, IntArray, IntArray, IntArray]
    source_cubics: FloatArray
    polygons: FloatArray
    polygon_starts: IntArray
    controls: FloatArray
    knots: FloatArray
    cubics: FloatArray
    cubic_starts: IntArray
    text: memoryview
    text_ends: list[int]
    boxes: list[list[float]]
    solved: Solved


@dataclass(frozen=True, eq=False)
class Drawn:
    """A glyph of a chunk: its index in it, and from and to where among the chunk's contours its own are."""

    chunk: Chunk
    index: int
    contours: tuple[int, int]

    @property
    def advance(self) -> float:
        """In font units."""
        return float(self.chunk.advances[self.index])

    @property
    def text(self) -> memoryview:
        """SVG path data of the result, as bytes."""
        ends = self.chunk.text_ends
        return self.chunk.text[ends[self.index] : ends[self.index + 1]]

    @property
    def box(self) -> Box:
        """Around the ink."""
        left, bottom, right, top = self.chunk.boxes[self.index]
        return left, bottom, right, top

    @cached_property
    def curves(self) -> tuple[FloatArray, IntArray]:
        """(m, 4, 2) Bézier pieces of the result, and (c + 1,) where each contour begins among them."""
        first, last = self.contours
        starts = self.chunk.cubic_starts[first : last + 1]
        return self.chunk.cubics[starts[0] : starts[-1]], starts - starts[0]

    @cached_property
    def polygons(self) -> Chains:
        """The vertices of all contours."""
        first, last = self.contours
        starts = self.chunk.polygon_starts[first : last + 1]
        ends = starts - starts[0]
        return Chains(self.chunk.polygons[starts[0] : starts[-1]], ends[:-1], ends[1:], np.ones(last - first, np.bool_))

    @property
    def controls(self) -> Chains:
        """The control polygons: as many points as vertices, or less if some were merged."""
        points, starts, _, closed = self.polygons
        first = self.chunk.polygon_starts[self.contours[0]]
        stops = starts + np.diff(self.curves[1])
        return Chains(self.chunk.controls[first : first + len(points)], starts, stops, closed)

    @property
    def splines(self) -> list[tuple[FloatArray, FloatArray]]:
        """(n, 2) control points and (n + 1,) knots of each contour; n is less than its vertices if some were merged."""
        first, last = self.contours
        places = zip(self.chunk.polygon_starts[first:last].tolist(), np.diff(self.curves[1]).tolist(), strict=True)
        return [
            (self.chunk.controls[at : at + n], self.chunk.knots[at + k : at + k + n + 1])
            for k, (at, n) in enumerate(places, first)
        ]


def suits(options: Options) -> bool:
    """Whether the options ask for what the short way does."""
    return (
        options.step is not None
        and options.step > 0
        and options.max_ratio >= 2
        and options.corners == "smooth"
        and options.variant in (1, 2, 3)
        and not options.measure
        and not options.remove_overlaps
    )


def draw_chunk(reader: BulkReader, gids: Sequence[int], options: Options) -> list[Drawn | None]:
    """Read, sample and interpolate glyphs and write their path data.

    Args:
        reader: of the font. gids: which glyphs. options: such that :func:`suits` holds.

    Returns:
        One for each glyph; None where the long way has to be taken.
    """
    assert options.step is not None
    buffer, starts, advances, broken = reader.read(gids)
    source_cubics, segments, before, strange, own, degrees, owns = cubics_of(buffer, starts)
    points, _, offsets, unsampled = sampled(
        source_cubics, segments, options.step, 0, options.max_ratio, np.radians(options.corner_angle), MOST_VERTICES
    )
    even = graded_polygons(points, offsets, min(options.max_ratio, CERTAIN_RATIO) * (1 + 1e-9))
    ragged = interpolate_batch(points, offsets, method_for(options), by_knot=even, threads=1)
    refused = (ragged.whole[:, 0] != 0) | unsampled
    counts = np.where(refused, 0, ragged.whole[:, 1])
    left = np.array([refused[a:b].any() for a, b in pairwise(before.tolist())], dtype=np.bool_)
    cubics, cubic_starts = cubics_of_splines(ragged.controls, ragged.knots, offsets, counts)
    text, ends, boxes, huge = paths(cubics, cubic_starts, before, *figures(options.precision))
    # A glyph that draws nothing may be a space or damaged: the long way tells them apart.
    left |= broken | strange | huge | (before[:-1] == before[1:])
    chunk = Chunk(
        advances, left, before, (own, degrees, segments, owns), source_cubics, points, offsets, ragged.controls,
        ragged.knots, cubics, cubic_starts, memoryview(text), ends.tolist(), boxes.tolist(), solved(ragged),
    )  # fmt: skip
    each = zip(left.tolist(), pairwise(before.tolist()), strict=True)
    return [None if alone else Drawn(chunk, i, contours) for i, (alone, contours) in enumerate(each)]


def last_residuals(ragged: BatchedInterpolation) -> FloatArray:
    """(K,) the residual of each result; undefined where a polygon was refused."""
    if len(ragged.residuals) == 0:
        return np.zeros(len(ragged))
    return ragged.residuals[np.clip(ragged.residual_offsets[1:] - 1, 0, len(ragged.residuals) - 1)]


def drawn_svg(outline: Outline, drawn: Drawn, precision: int, view_box: ViewBox) -> bytes:
    """The SVG document of a glyph; of ``outline`` everything but its contours is needed."""
    box = shown_box(outline, drawn.box, view_box)
    return svg_document(outline, drawn.text, box, precision, view_box)


def drawn_map(outline: Outline, drawn: Drawn, scale: float) -> bytes:
    """The curvature map of a glyph, its vertices marked, as :func:`to_curvature_svg` writes it."""
    return map_document(outline, *drawn.curves, drawn.text, scale, polygon=drawn.polygons.points)


def source_texts(drawn: Drawn, em: float, precision: int) -> SourceTexts:
    """The path data of a glyph's source drawing."""
    points, degrees, segments, owns = drawn.chunk.source
    first, last = drawn.contours
    a, b = segments[first], segments[last]
    path = curves_data(points[owns[first] : owns[last]], degrees[a:b], segments[first : last + 1] - a, precision)
    return SourceTexts(
        path, polylines_data(drawn.polygons, precision), polylines_data(drawn.controls, comb_precision(em))
    )


def drawn_source(outline: Outline, drawn: Drawn, texts: SourceTexts, precision: int) -> bytes:
    """The source drawing of a glyph, as :func:`to_source_svg` writes it."""
    first, last = drawn.contours
    segments = drawn.chunk.source[2]
    left, bottom, right, top = ink_box(drawn.chunk.source_cubics[segments[first] : segments[last]]).tolist()
    return source_document(outline, texts, (left, bottom, right, top), drawn.polygons.points, precision)


def solved(ragged: BatchedInterpolation) -> Solved:
    """What the interpolation itself has found out, for each contour."""
    last = last_residuals(ragged)
    counts, iterations, fallbacks = ragged.whole[:, 1:4].T
    return Solved(
        counts.tolist(), counts.tolist(), (2 * counts).tolist(), iterations.tolist(), last.tolist(),
        (last < ragged.tolerances).tolist(), ragged.rates.tolist(), fallbacks.tolist(),
    )  # fmt: skip
