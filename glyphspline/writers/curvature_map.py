"""The curvature map of a glyph: its outline with the curvature comb, in the manner of the paper's Figs. 6 and 7."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..bspline import Spline
from ..curvature import Comb, comb, relative, robust_scale
from ..glyph import GlyphResult
from .colours import SIDES, class_colour, colour_classes
from .legend import legend_svg
from .markup import (
    Box,
    data_attributes,
    id_prefix,
    ink_bounds,
    number,
    path_data,
    polyline_data,
    segments_data,
    union,
    view_box_value,
)
from .svg import title

SPACING = 1 / 160
"""Teeth stand this far apart, in em, or nearer. Twice as dense they run together in print; half as dense the joined
tips cut corners."""

MOST_TEETH = 8000
"""Beyond so many, spacing grows. An ordinary CJK glyph has 2000; one made to harm could ask for millions."""

TOOTH = 0.03
"""Length in em of a tooth at the shared scale. Longer teeth of neighbouring strokes cross on CJK glyphs."""

LONGEST = 1.25
"""Longest tooth, in units of the scale; what is cut there bears a mark. At 2.5 the fans of rounded
corners cover a whole CJK glyph; without a limit one of them throws a spike across the page."""

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
    """The scale, in 1/unit, that maps of these glyphs share: see :func:`glyphspline.curvature.robust_scale`."""
    return robust_scale(item for glyph in glyphs for item in combs(glyph))


def combs(glyph: GlyphResult) -> list[Comb]:
    """One comb a contour, at the spacing of the maps, or wider on an outline long enough for MOST_TEETH."""
    contours = [contour.curve.cubics() for contour in glyph.contours if len(contour.curve)]
    length = sum(float(np.hypot(*np.diff(cubics, axis=1).reshape(-1, 2).T).sum()) for cubics in contours)
    spacing = max(SPACING * glyph.outline.metrics.units_per_em, length / MOST_TEETH)
    return [comb(cubics, spacing) for cubics in contours]


def teeth(glyph: GlyphResult, scale: float) -> list[Teeth]:
    """Feet and tips of each contour's comb. Teeth point away from the centre of curvature."""
    return [teeth_of(item, glyph.outline.metrics.units_per_em, scale) for item in combs(glyph)]


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
    outline = glyph.outline
    em = outline.metrics.units_per_em
    scale = curvature_scale([glyph]) if scale is None else scale
    precision = comb_precision(em)
    drawn = teeth(glyph, scale)
    ink = ink_bounds(contour.curve for contour in glyph.contours)
    box = ink or (0.0, outline.metrics.descender, outline.advance, outline.metrics.ascender)
    box = (min(box[0], 0.0), box[1], max(box[2], outline.advance), box[3])
    layers = [_comb_layer(drawn, em, precision), _outline_layer(glyph)]
    if control_polygon:
        layers.append(_control_layer(glyph, precision))
        box = _around(box, [spline.control_points for spline in _splines(glyph)])
    if vertices:
        layers.append(_vertex_layer(glyph, precision))
    box = _around(box, [part.tips for part in drawn])
    legend, box = legend_svg(box, em, scale, precision, TOOTH, LONGEST)
    margin = 0.02 * em
    box = (box[0] - margin, box[1] - margin, box[2] + margin, box[3] + margin)
    prefix = id_prefix(outline.name, outline.gid)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{view_box_value(box, precision)}" role="img"'
        f' aria-labelledby="{prefix}-map-title" {data_attributes(outline, precision)}'
        f' data-scale="{scale:.6g}" fill="none" stroke-linecap="round" stroke-linejoin="round">\n'
        f'<title id="{prefix}-map-title">Curvature of {title(outline)}</title>\n'
        + "\n".join([*layers, legend])
        + "\n</svg>\n"
    )


def comb_precision(em: float) -> int:
    """Decimals of comb coordinates: fewer on a large em."""
    return max(0, PRECISION + 3 - round(float(np.log10(em))))


def _comb_layer(drawn: list[Teeth], em: float, precision: int) -> str:
    """Teeth, grouped by colour into one path a class, the line that joins the tips, and the marks of cut teeth."""
    paths = []
    if drawn:
        feet, tips = np.concatenate([part.feet for part in drawn]), np.concatenate([part.tips for part in drawn])
        classes = colour_classes(np.concatenate([part.relative for part in drawn]))
        cut = tips[np.concatenate([part.cut for part in drawn])]
        for index in range(-SIDES, SIDES + 1):
            chosen = (classes == index) & (np.abs(tips - feet).max(axis=1) > 0.5 * 10.0**-precision)
            if chosen.any():
                paths.append(
                    f'<path stroke="{class_colour(index)}" d="{segments_data(feet[chosen], tips[chosen], precision)}"/>'
                )
        ends = "".join(polyline_data(part.tips, precision, closed=True) for part in drawn)
        paths.append(f'<path stroke="currentColor" stroke-opacity=".45" stroke-width="{_width(em, 0.9)}" d="{ends}"/>')
        if len(cut):
            dots = segments_data(cut, cut, precision)  # a stroke of no length with round caps is a dot
            paths.append(f'<path class="cut" stroke="currentColor" stroke-width="{_width(em, 3)}" d="{dots}"/>')
    return f'<g class="comb" stroke-width="{_width(em, 1.8)}">' + "\n".join(paths) + "</g>"


def _outline_layer(glyph: GlyphResult) -> str:
    contours = [contour.curve.rounded(glyph.options.precision) for contour in glyph.contours]
    width = _width(glyph.outline.metrics.units_per_em, 3)
    return (
        f'<path class="outline" stroke="currentColor" stroke-width="{width}" fill="currentColor" fill-opacity=".07"'
        f' fill-rule="nonzero" d="{path_data(contours, glyph.options.precision)}"/>'
    )


def _vertex_layer(glyph: GlyphResult, precision: int) -> str:
    points = [contour.polygon for contour in glyph.contours if len(contour.polygon)]
    every = np.concatenate(points) if points else np.empty((0, 2))
    width = _width(glyph.outline.metrics.units_per_em, 6)
    dots = segments_data(every, every, precision)
    return f'<path class="vertices" stroke="currentColor" stroke-width="{width}" d="{dots}"/>'


def _splines(glyph: GlyphResult) -> list[Spline]:
    return [interpolation.spline for contour in glyph.contours for interpolation in contour.interpolations]


def _control_layer(glyph: GlyphResult, precision: int) -> str:
    em = glyph.outline.metrics.units_per_em
    data = "".join(polyline_data(s.control_points, precision, closed=s.closed) for s in _splines(glyph))
    dash = _width(em, 6)
    return (
        f'<path class="control-polygon" stroke="currentColor" stroke-opacity=".6" stroke-width="{_width(em, 1.2)}"'
        f' stroke-dasharray="{dash}" d="{data}"/>'
    )


def _width(em: float, thousandths: float) -> str:
    """A stroke width given in 1/1000 em."""
    return number(thousandths * em / 1000, 3)


def _around(box: Box, points: list[FloatArray]) -> Box:
    for part in points:
        (left, bottom), (right, top) = part.min(axis=0), part.max(axis=0)
        box = union(box, (float(left), float(bottom), float(right), float(top)))
    return box
