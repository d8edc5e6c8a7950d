"""A glyph before and after sampling: the source outline and the polygons over it, as an SVG drawing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ...fitting.results import GlyphResult, end_to_end
from ...outlines.contour_arrays import joined, offsets_of
from .curvature_map import comb_precision
from .document import title
from .markup import data_attributes, document, id_prefix, number, union, view_box_value
from .path_data import PathData, curves_data, dots_data, polylines_data


class SourceData(NamedTuple):
    """Path data of a glyph's source outline, its polygons, and the control polygons of its result."""

    source: PathData
    polygon: PathData
    control: PathData


def source_data(glyphs: Sequence[GlyphResult]) -> list[SourceData]:
    """Path data of glyphs, at least one, that have the same options and em."""
    precision, coarse = glyphs[0].options.precision, comb_precision(glyphs[0].outline.metrics.units_per_em)
    outlines = [glyph.outline.arrays for glyph in glyphs]
    source = curves_data(joined(outlines), precision, offsets_of([own.num_contours for own in outlines]))
    arrays, offsets = end_to_end(glyphs)
    polygon = polylines_data(arrays.polygons, precision, offsets)
    control = polylines_data(arrays.controls, coarse, arrays.arc_offsets[offsets])
    return [SourceData(*parts) for parts in zip(source, polygon, control, strict=True)]


def to_source_svg(glyph: GlyphResult) -> str:
    """The source outline, and over it the polygon with its vertices, as groups of one SVG document.

    Their ids are ``g<gid>-<name>-source`` and ``…-polygon``. As an image with the fragment of the first, as in
    ``a.svg#g36-A-source``, the drawing has no polygon. A third group, ``…-control``, holds the control
    polygons of the result; it is not displayed.
    """
    return source_document(glyph, source_data([glyph])[0]).decode()


def source_document(glyph: GlyphResult, data: SourceData) -> bytes:
    """The document of :func:`to_source_svg` in UTF-8, from its path data."""
    outline, precision = glyph.outline, glyph.options.precision
    em = outline.metrics.units_per_em
    box = union((0.0, outline.metrics.descender, outline.advance, outline.metrics.ascender), data.source.box)
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
    dots = dots_data(glyph.arrays.polygons.points, comb_precision(em))
    return document([
        head, data.source.text, polygon, data.polygon.text, f'"/><path stroke-width="{number(em / 100, 3)}" d="', dots,
        control, data.control.text, '"/></g>\n</svg>\n',
    ])  # fmt: skip
