"""From glyph indices to path data and measures, a chunk of glyphs at a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..closed import CERTAIN_RATIO
from ..engine import Ragged, interpolate_ragged
from ..glyph import Measures, Options
from ..outline import Contour, Outline
from ..writers.markup import Box, ink_bounds
from ..writers.svg import ViewBox, shown_box, svg_document
from .contours import cubics_of
from .curves import paths
from .reading import BulkReader
from .stepping import stepped_points, uneven

MOST_VERTICES = 100_000
"""Vertices of a contour above which it is left to the long way."""


@dataclass(frozen=True)
class Drawn:
    """A glyph that went the short way.

    Attributes:
        advance: in font units. path: SVG path data. box: around the rounded Bézier points, so around the ink.
        measures: of each contour; what sampling by step needs not know is None.
    """

    advance: float
    path: str
    box: Box
    measures: list[Measures]


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
    cubics, contours, before, strange = cubics_of(buffer, starts)
    points, offsets, unsampled = stepped_points(cubics, contours, options.step, options.max_ratio, MOST_VERTICES)
    ragged = interpolated(points, offsets, options)
    refused = (ragged.whole[:, 0] != 0) | unsampled
    counts = np.where(refused, 0, ragged.whole[:, 1])
    left = np.array([refused[a:b].any() for a, b in pairwise(before.tolist())], dtype=np.bool_)
    text, ends, boxes, huge = paths(ragged.controls, ragged.knots, offsets, counts, before, options.precision)
    # A glyph that draws nothing may be a space or damaged: the long way tells them apart.
    left |= broken | strange | huge | (before[:-1] == before[1:])
    measures = measures_of(ragged)
    return [
        None
        if left[i]
        else Drawn(
            float(advances[i]),
            text[ends[i] : ends[i + 1]].tobytes().decode("ascii"),
            tuple(boxes[i].tolist()),
            measures[before[i] : before[i + 1]],
        )
        for i in range(len(gids))
    ]


def interpolated(points: FloatArray, offsets: IntArray, options: Options) -> Ragged:
    """The curves of all polygons: those of well graded chords by Lemma 2's own rule, the rest by the options'."""
    ragged = interpolate_ragged(points, offsets, options.variant, **_how(options, "knot"))
    ungraded = np.flatnonzero(uneven(points, offsets, min(options.max_ratio, CERTAIN_RATIO) * (1 + 1e-9)))
    if options.fallback == "knot" or len(ungraded) == 0:
        return ragged
    parts = [points[offsets[k] : offsets[k + 1]] for k in ungraded]
    where = np.concatenate([[0], np.cumsum([len(part) for part in parts])]).astype(np.int64)
    again = interpolate_ragged(np.concatenate(parts), where, options.variant, **_how(options, options.fallback))
    for j, k in enumerate(ungraded.tolist()):
        here, there, n = int(offsets[k]), int(where[j]), int(where[j + 1] - where[j])
        ragged.controls[here : here + n] = again.controls[there : there + n]
        ragged.knots[here + k : here + k + n + 1] = again.knots[there + j : there + j + n + 1]
    ragged.whole[ungraded], ragged.rates[ungraded] = again.whole, again.rates
    last = last_residuals(ragged)
    last[ungraded] = last_residuals(again)
    ends = np.arange(len(last) + 1)
    return replace(ragged, residuals=last, residual_offsets=ends)


def _how(options: Options, fallback: str) -> dict[str, Any]:
    return {
        "margin": options.margin,
        "fallback": fallback,
        "residual_tolerance": options.residual_tolerance,
        "max_iterations": options.max_iterations,
        "threads": 1,
    }


def last_residuals(ragged: Ragged) -> FloatArray:
    """(K,) the residual of each result; undefined where a polygon was refused."""
    if len(ragged.residuals) == 0:
        return np.zeros(len(ragged))
    return ragged.residuals[np.clip(ragged.residual_offsets[1:] - 1, 0, len(ragged.residuals) - 1)]


def drawn_svg(outline: Outline, drawn: Drawn, precision: int, view_box: ViewBox) -> str:
    """The SVG document of a glyph; of ``outline`` everything but its contours is needed."""
    box = shown_box(outline, drawn.box, "em")
    if view_box == "ink" or (view_box == "em" and box != shown_box(outline, None, "em")):
        ink = ink_bounds(path_contours(drawn.path))  # the box around Bézier points may be wider
        box = shown_box(outline, ink, view_box)
    return svg_document(outline, drawn.path, box, precision, view_box)


def path_contours(path: str) -> list[Contour]:
    """The contours of path data as :func:`.curves.paths` writes it, y up again."""
    found = []
    for contour in path.split("Z")[:-1]:
        values = contour[1:].replace("C", " ").split(" ")
        points = np.array(values, dtype=np.float64).reshape(-1, 2)[:-1] * (1, -1) + 0.0
        found.append(Contour(points, np.full(len(points) // 3, 3)))
    return found


def measures_of(ragged: Ragged) -> list[Measures]:
    """What the interpolation itself has found out, for each contour."""
    last = last_residuals(ragged)
    return [
        Measures(n, n, 2 * n, iterations, residual, residual < tolerance, rate, fallbacks)
        for (n, iterations, fallbacks), residual, tolerance, rate in zip(
            ragged.whole[:, 1:4].tolist(), last.tolist(), ragged.tolerances.tolist(), ragged.rates.tolist(), strict=True
        )
    ]
