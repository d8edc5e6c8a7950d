"""A glyph as it was read and sampled: the source outline and the polygons over it, as an SVG drawing."""

from __future__ import annotations

from typing import NamedTuple

from ...fitting.results import GlyphResult
from ...outlines.outline import Outline
from ...types import FloatArray
from .curvature_map import comb_precision, dots
from .document import title
from .markup import (
    Box,
    chains,
    data_attributes,
    id_prefix,
    ink_bounds,
    joined,
    number,
    path_data,
    polylines_data,
    union,
    view_box_value,
)


def to_source_svg(glyph: GlyphResult) -> str:
    """The source outline, and over it the polygon with its vertices, as groups of one SVG document.

    Their ids are ``g<gid>-<name>-source`` and ``…-polygon``. Shown as an image with the fragment of the first, as in
    ``a.svg#g36-A-source``, the drawing leaves the polygon out. A third group, ``…-control``, holds the control
    polygons of the result for whoever wants them; it is not displayed.
    """
    outline, precision = glyph.outline, glyph.options.precision
    polygons = [contour.polygon for contour in glyph.contours if len(contour.polygon)]
    splines = [interpolation.spline for contour in glyph.contours for interpolation in contour.interpolations]
    corners = chains(polygons, [True] * len(polygons))
    control = chains([spline.control_points for spline in splines], [spline.closed for spline in splines])
    texts = SourceTexts(
        memoryview(path_data(outline.contours, precision).encode()),
        polylines_data(corners, precision),
        polylines_data(control, comb_precision(outline.metrics.units_per_em)),
    )
    return source_document(outline, texts, ink_bounds(outline.contours), corners.points, precision).decode()


class SourceTexts(NamedTuple):
    """Path data of a source drawing: the source's outline, the polygons, the control polygons of the result."""

    source: memoryview
    polygon: memoryview
    control: memoryview


def source_document(
    outline: Outline, texts: SourceTexts, ink: Box | None, vertices: FloatArray, precision: int
) -> bytes:
    """The drawing from its parts, in UTF-8.

    Args:
        outline: of which everything but the contours is written. ink: the box around these.
        vertices: (n, 2) of all polygons. precision: decimals of the view box.
    """
    em = outline.metrics.units_per_em
    box = union((0.0, outline.metrics.descender, outline.advance, outline.metrics.ascender), ink)
    prefix = id_prefix(outline.name, outline.gid)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{view_box_value(box, precision)}" overflow="visible"'
        f' role="img" aria-labelledby="{prefix}-source-title" {data_attributes(outline, precision)}>\n'
        f'<title id="{prefix}-source-title">Source outline and polygon of {title(outline)}</title>\n'
        f"<style>#{prefix}-source:target~#{prefix}-polygon{{display:none}}</style>\n"
        f'<g id="{prefix}-source" fill="currentColor" fill-opacity=".3" stroke="currentColor"'
        f' stroke-width="{number(em / 500, 3)}"><path fill-rule="nonzero" d="'
    )
    polygon = (
        f'"/></g>\n<g id="{prefix}-polygon" fill="none" stroke="#d33" stroke-width="{number(em / 400, 3)}"'
        ' stroke-linecap="round" stroke-linejoin="round"><path d="'
    )
    control = (
        f'"/></g>\n<g id="{prefix}-control" display="none" fill="none" stroke="#75c"'
        f' stroke-width="{number(em / 600, 3)}"><path d="'
    )
    between = f'"/><path stroke-width="{number(em / 100, 3)}" d="'
    return joined([
        head, texts.source, polygon, texts.polygon, between, dots(vertices, comb_precision(em)), control, texts.control,
        '"/></g>\n</svg>\n',
    ])  # fmt: skip
