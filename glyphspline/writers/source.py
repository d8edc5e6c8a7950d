"""A glyph as it was read and sampled: the source outline and the polygons over it, as an SVG drawing."""

from __future__ import annotations

from ..glyph import GlyphResult
from ..outline import Outline
from .curvature_map import comb_precision, dots
from .markup import (
    Box,
    Chains,
    Text,
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
from .svg import title


def to_source_svg(glyph: GlyphResult) -> str:
    """The source outline, and over it the polygon with its vertices, as groups of one SVG document.

    Their ids are ``g<gid>-<name>-source`` and ``…-polygon``. Shown as an image with the fragment of the first, as in
    ``a.svg#g36-A-source``, the drawing leaves the polygon out. A third group, ``…-control``, holds the control
    polygons of the result for whoever wants them; it is not displayed.
    """
    outline, precision = glyph.outline, glyph.options.precision
    polygons = [contour.polygon for contour in glyph.contours if len(contour.polygon)]
    splines = [interpolation.spline for contour in glyph.contours for interpolation in contour.interpolations]
    document = source_document(
        outline,
        path_data(outline.contours, precision),
        ink_bounds(outline.contours),
        chains(polygons, [True] * len(polygons)),
        chains([spline.control_points for spline in splines], [spline.closed for spline in splines]),
        precision,
    )
    return document.decode()


def source_document(
    outline: Outline, path: Text, ink: Box | None, polygons: Chains, controls: Chains, precision: int
) -> bytes:
    """The drawing from its parts, in UTF-8.

    Args:
        outline: of which everything but the contours is written; path: these, as path data; ink: the box around them.
        polygons: all vertices. controls: control polygons. precision: decimals of outline and polygons.
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
    digits = comb_precision(em)
    return joined([
        head, path, polygon, polylines_data(polygons, precision), between, dots(polygons.points, digits),
        control, polylines_data(controls, digits), '"/></g>\n</svg>\n',
    ])  # fmt: skip
