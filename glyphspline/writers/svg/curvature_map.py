"""The curvature map of a glyph: its outline with the curvature comb, in the manner of the paper's Figs. 6 and 7."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np

from ...curves.curvature import ANGLE, Comb, comb, relative, robust_scale
from ...fitting.results import GlyphResult
from ...outlines.outline import Outline
from ...types import BoolArray, FloatArray, IntArray
from .colours import SIDES, class_colour
from .digit_tables import figures
from .document import title
from .legend import legend_svg
from .markup import (
    Box,
    Text,
    data_attributes,
    id_prefix,
    joined,
    number,
    path_data,
    polyline_data,
    union,
    view_box_value,
)

SPACING = 1 / 140
"""Teeth stand this far apart, in em, or nearer. Twice as dense they run together in print; half as dense the joined
tips cut corners."""

MOST_TEETH = 8000
"""Beyond so many, spacing grows. An ordinary CJK glyph has 2000; one made to harm could ask for millions."""

TOOTH = 0.03
"""Length in em of a tooth at the shared scale. Longer teeth of neighbouring strokes cross on CJK glyphs."""

LONGEST = 1.25
"""Longest tooth, in units of the scale; what is cut there bears a mark. At 2.5 the fans of rounded
corners cover a whole CJK glyph; without a limit one of them throws a spike across the page."""

STROKE = 3
"""Width of the outline in 1/1000 em. Teeth of less than half of it are hidden below, and left out."""

PRECISION = 1
"""Decimals of the comb, per 1000 units of the em: 1/10,000 em is finer than any screen shows."""


@dataclass(frozen=True, eq=False)
class Teeth:
    """One contour's comb as drawn, in font units: all arrays in curve order.

    Attributes:
        feet, tips: (k, 2). relative: (k,) curvature in units of the scale. cut: (k,) whether the tooth was shortened.
    """

    feet: FloatArray
    tips: FloatArray
    relative: FloatArray
    cut: BoolArray


def curvature_scale(glyphs: Iterable[GlyphResult]) -> float:
    """The scale, in 1/unit, that maps of these glyphs share: see :func:`glyphspline.curves.curvature.robust_scale`."""
    return robust_scale(item for glyph in glyphs for item in combs(glyph))


def combs(glyph: GlyphResult) -> list[Comb]:
    """One comb a contour, twice as dense as those of the maps, for the scale: at theirs it can be 15% too large."""
    return combs_of(*curves_of(glyph), glyph.outline.metrics.units_per_em)


def combs_of(cubics: FloatArray, contours: IntArray, em: float, density: float = 2.0) -> list[Comb]:
    """The same from a glyph's pieces (m, 4, 2) and (c + 1,) where each contour begins among them."""
    spacing = spacing_of(cubics, em) / density
    return [comb(cubics[a:b], spacing) for a, b in pairwise(contours.tolist())]


def curves_of(glyph: GlyphResult) -> tuple[FloatArray, IntArray]:
    """All pieces of a result, and (c + 1,) where each contour begins among them; empty ones are left out."""
    pieces = [contour.curve.cubics() for contour in glyph.contours if len(contour.curve)]
    cubics = np.concatenate([np.empty((0, 4, 2)), *pieces])
    return cubics, np.cumsum([0, *map(len, pieces)], dtype=np.int64)


def spacing_of(cubics: FloatArray, em: float) -> float:
    """How far apart teeth stand along a glyph's pieces (m, 4, 2), in font units."""
    return max(SPACING * em, _compiled().control_length(cubics) / MOST_TEETH)


@cache
def _compiled() -> Any:
    """The compiled code of maps, imported when it is first wanted: the package opens without a compiler."""
    from . import comb_paths as comb_text

    return comb_text


def teeth(glyph: GlyphResult, scale: float) -> list[Teeth]:
    """Feet and tips of each contour's comb. Teeth point away from the centre of curvature."""
    em = glyph.outline.metrics.units_per_em
    return [teeth_of(item, em, scale) for item in combs_of(*curves_of(glyph), em, density=1.0)]


def teeth_of(item: Comb, em: float, scale: float) -> Teeth:
    """Feet and tips of one comb."""
    strength = relative(item.curvature, scale)
    shown = np.clip(strength, -LONGEST, LONGEST)
    tips = item.points - (TOOTH * em * shown)[:, None] * item.normals
    return Teeth(item.points, tips, strength, np.abs(strength) > LONGEST)


def to_curvature_svg(
    glyph: GlyphResult,
    *,
    scale: float | None = None,
    vertices: bool = True,
    control_polygon: bool = False,
) -> str:
    """The outline with its curvature comb, as an SVG document that is legible on light and dark.

    A tooth stands on the curve along its normal, on the outer (convex) side, away from the centre of curvature. Its
    length is |κ|, 0.03 em at ``scale``; teeth are cut at 1.25 times that, with a dot on the end. Colour is signed
    κ: blue and violet turn left, yellow and red turn right in the contour's own direction. The legend is in 1/em.

    Args:
        glyph: what :func:`convert` gave.
        scale: the curvature, in 1/unit, of a full tooth; one for all glyphs of a run, as :func:`curvature_scale`
            gives it. None takes the glyph's own.
        vertices: mark the polygon's vertices.
        control_polygon: draw the control polygon of each interpolation.
    """
    scale = curvature_scale([glyph]) if scale is None else scale
    curves = (contour.curve for contour in glyph.contours)
    splines = [interpolation.spline for contour in glyph.contours for interpolation in contour.interpolations]
    document = map_document(
        glyph.outline,
        *curves_of(glyph),
        path_data(curves, glyph.options.precision),
        scale,
        polygon=np.concatenate([np.empty((0, 2)), *(contour.polygon for contour in glyph.contours)])
        if vertices
        else None,
        controls=[(spline.control_points, spline.closed) for spline in splines] if control_polygon else None,
    )
    return document.decode()


def map_document(
    outline: Outline,
    cubics: FloatArray,
    contours: IntArray,
    path: Text,
    scale: float,
    *,
    polygon: FloatArray | None = None,
    controls: list[tuple[FloatArray, bool]] | None = None,
) -> bytes:
    """The map of a glyph from its curves, in UTF-8.

    Args:
        outline: of which everything but the contours is written.
        cubics: (m, 4, 2) pieces of all contours. contours: (c + 1,) where each contour begins among them.
        path: the same as it is written, as path data. scale: curvature of a full tooth, in 1/unit.
        polygon: (n, 2) all vertices, if they are to be marked.
        controls: control polygons and whether they are closed, if they are to be drawn.
    """
    em = outline.metrics.units_per_em
    precision = comb_precision(em)
    layers, reach = _comb_layer(cubics, contours, em, scale, precision)
    box = reach or (0.0, outline.metrics.descender, outline.advance, outline.metrics.ascender)
    box = (min(box[0], 0.0), box[1], max(box[2], outline.advance), box[3])
    layers += [
        f'<path class="outline" stroke="currentColor" stroke-width="{_width(em, STROKE)}" fill="currentColor"'
        ' fill-opacity=".07" fill-rule="nonzero" d="', path, '"/>\n',
    ]  # fmt: skip
    if controls is not None:
        layers.append(_control_layer(controls, em, precision))
        box = _around(box, [points for points, _ in controls])
    if polygon is not None:
        style = f'<path class="vertices" stroke="currentColor" stroke-width="{_width(em, 6)}" d="'
        layers += [style, dots(polygon, precision), '"/>\n']
    legend, box = legend_svg(box, em, scale, precision, TOOTH, LONGEST)
    margin = 0.02 * em
    box = (box[0] - margin, box[1] - margin, box[2] + margin, box[3] + margin)
    prefix = id_prefix(outline.name, outline.gid)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{view_box_value(box, precision)}" role="img"'
        f' aria-labelledby="{prefix}-map-title" {data_attributes(outline, precision)}'
        f' data-scale="{scale:.6g}" fill="none" stroke-linecap="round" stroke-linejoin="round">\n'
        f'<title id="{prefix}-map-title">Curvature of {title(outline)}</title>\n'
    )
    return joined([head, *layers, legend, "\n</svg>\n"])


@cache
def comb_precision(em: float) -> int:
    """Decimals of comb coordinates: fewer on a large em."""
    return max(0, PRECISION + 3 - round(float(np.log10(em))))


def _comb_layer(
    cubics: FloatArray, contours: IntArray, em: float, scale: float, precision: int
) -> tuple[list[Text], Box | None]:
    """Teeth, grouped by colour into one path a class, the line that joins the tips, and the marks of cut teeth; and
    the box around curve and comb."""
    least = 0.5 * STROKE * em / 1000
    flat = scale * least / (TOOTH * em)
    samples, starts = _compiled().sampled(cubics, spacing_of(cubics, em), ANGLE, flat)
    text, ends, box = _compiled().comb_text(
        samples, starts[contours], TOOTH * em, scale, LONGEST, least, *figures(precision)
    )
    view = memoryview(text)
    layers: list[Text] = [f'<g class="comb" stroke-width="{_width(em, 1.8)}">']
    for style, (a, b) in zip(_styles(em), pairwise(ends.tolist()), strict=True):
        if b > a:
            layers += [style, view[a:b], '"/>\n']
    layers.append("</g>\n")
    return layers, tuple(box.tolist()) if len(samples) else None


@cache
def _styles(em: float) -> list[str]:
    """How the paths of a comb begin, in the order in which ``comb_text`` gives them."""
    return [
        *(f'<path stroke="{class_colour(index)}" d="' for index in range(-SIDES, SIDES + 1)),
        f'<path stroke="currentColor" stroke-opacity=".45" stroke-width="{_width(em, 0.9)}" d="',
        f'<path class="cut" stroke="currentColor" stroke-width="{_width(em, 3)}" d="',
    ]


def dots(points: FloatArray, precision: int) -> Text:
    """Path data of a dot on each of the points (n, 2), to be stroked with round caps; y flipped."""
    return memoryview(_compiled().dots_text(points, *figures(precision)))


def _control_layer(controls: list[tuple[FloatArray, bool]], em: float, precision: int) -> str:
    data = "".join(polyline_data(points, precision, closed=closed) for points, closed in controls)
    dash = _width(em, 6)
    return (
        f'<path class="control-polygon" stroke="currentColor" stroke-opacity=".6" stroke-width="{_width(em, 1.2)}"'
        f' stroke-dasharray="{dash}" d="{data}"/>\n'
    )


def _width(em: float, thousandths: float) -> str:
    """A stroke width given in 1/1000 em."""
    return number(thousandths * em / 1000, 3)


def _around(box: Box, points: list[FloatArray]) -> Box:
    for part in points:
        (left, bottom), (right, top) = part.min(axis=0), part.max(axis=0)
        box = union(box, (float(left), float(bottom), float(right), float(top)))
    return box
