"""A glyph before and after sampling: the source outline and the polygons over it, as an SVG drawing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ...fitting.results import GlyphResult, end_to_end
from ...outlines.contour_arrays import joined, offsets_of
from .curvature_map import comb_precision
from .document import title
from .markup import data_attributes, document, head, id_prefix, number, union, view_box_value
from .path_data import PathData, curves_data, dots_data, polylines_data


class PolygonData(NamedTuple):
    """Path data of a glyph's polygons, and of the control polygons of its result."""

    polygon: PathData
    control: PathData


def source_data(glyphs: Sequence[GlyphResult]) -> list[PathData]:
    """Path data of the source outlines of glyphs, at least one, that have the same options."""
    outlines = [glyph.outline.arrays for glyph in glyphs]
    offsets = offsets_of([own.num_contours for own in outlines])
    return curves_data(joined(outlines), glyphs[0].options.precision, offsets)


def polygon_data(glyphs: Sequence[GlyphResult]) -> list[PolygonData]:
    """Path data of the polygons of glyphs, at least one, that have the same options and em."""
    precision, coarse = glyphs[0].options.precision, comb_precision(glyphs[0].outline.metrics.units_per_em)
    arrays, offsets = end_to_end(glyphs)
    polygon = polylines_data(arrays.polygons, precision, offsets)
    control = polylines_data(arrays.controls, coarse, arrays.arc_offsets[offsets])
    return [PolygonData(*parts) for parts in zip(polygon, control, strict=True)]


def to_polygon_svg(glyph: GlyphResult) -> str:
    """The source outline, and over it the polygon with its vertices, as groups of one SVG document.

    Their ids are ``g<gid>-<name>-source`` and ``…-polygon``. As an image with the fragment of the first, as in
    ``a.svg#g36-A-source``, the drawing has no polygon. A third group, ``…-control``, holds the control
    polygons of the result; it is not displayed.
    """
    return polygon_document(glyph, source_data([glyph])[0], polygon_data([glyph])[0]).decode()


def polygon_document(glyph: GlyphResult, source: PathData, data: PolygonData) -> bytes:
    """The document of :func:`to_polygon_svg` in UTF-8, from its path data."""
    outline, precision = glyph.outline, glyph.options.precision
    em = outline.metrics.units_per_em
    box = union((0.0, outline.metrics.descender, outline.advance, outline.metrics.ascender), source.box)
    prefix = id_prefix(outline.name, outline.gid)
    begin = head(
        view_box_value(box, precision), f"{prefix}-source-title", f"Source outline and polygon of {title(outline)}",
        data_attributes(outline, precision), ' overflow="visible"',
    )  # fmt: skip
    source_group = (
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
    dots = dots_data(glyph.arrays.polygons.points, comb_precision(em))
    return document([
        begin, source_group, source.text, polygon, data.polygon.text,
        f'"/><path stroke-width="{number(em / 100, 3)}" d="', dots, control, data.control.text, '"/></g>\n</svg>\n',
    ])  # fmt: skip
