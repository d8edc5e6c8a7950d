"""A glyph as it was read and sampled: the source outline and the polygons over it, as an SVG drawing."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..glyph import GlyphResult
from ..outline import Outline
from .curvature_map import comb_precision, dots
from .markup import (
    Box,
    data_attributes,
    id_prefix,
    ink_bounds,
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
    return source_document(
        outline,
        path_data(outline.contours, precision),
        ink_bounds(outline.contours),
        polygons,
        [(spline.control_points, spline.closed) for spline in splines],
        precision,
    )


def source_document(
    outline: Outline,
    path: str,
    ink: Box | None,
    polygons: list[FloatArray],
    controls: list[tuple[FloatArray, bool]],
    precision: int,
) -> str:
    """The drawing from its parts.

    Args:
        outline: of which everything but the contours is written; path: these, as path data; ink: the box around them.
        polygons: (n, 2) vertices of each. controls: control polygons, and whether they are closed.
        precision: decimals of outline and polygons.
    """
    em = outline.metrics.units_per_em
    box = union((0.0, outline.metrics.descender, outline.advance, outline.metrics.ascender), ink)
    edges = polylines_data(polygons, precision, closed=[True] * len(polygons))
    control = polylines_data([p for p, _ in controls], comb_precision(em), closed=[closed for _, closed in controls])
    every = np.concatenate(polygons) if polygons else np.empty((0, 2))
    prefix = id_prefix(outline.name, outline.gid)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{view_box_value(box, precision)}" overflow="visible"'
        f' role="img" aria-labelledby="{prefix}-source-title" {data_attributes(outline, precision)}>\n'
        f'<title id="{prefix}-source-title">Source outline and polygon of {title(outline)}</title>\n'
        f"<style>#{prefix}-source:target~#{prefix}-polygon{{display:none}}</style>\n"
        f'<g id="{prefix}-source" fill="currentColor" fill-opacity=".3" stroke="currentColor"'
        f' stroke-width="{number(em / 500, 3)}"><path fill-rule="nonzero"'
        f' d="{path}"/></g>\n'
        f'<g id="{prefix}-polygon" fill="none" stroke="#d33" stroke-width="{number(em / 400, 3)}"'
        f' stroke-linecap="round" stroke-linejoin="round"><path d="{edges}"/>'
        f'<path stroke-width="{number(em / 100, 3)}" d="{dots(every, comb_precision(em))}"/></g>\n'
        f'<g id="{prefix}-control" display="none" fill="none" stroke="#75c" stroke-width="{number(em / 600, 3)}">'
        f'<path d="{control}"/></g>\n'
        "</svg>\n"
    )
