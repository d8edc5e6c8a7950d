"""A glyph's result as an SVG drawing: one path of exact Béziers."""

from __future__ import annotations

from typing import Literal, get_args

from ...errors import require_choice
from ...fitting.results import GlyphResult
from ...outlines.outline import Outline
from .markup import code_points, data_attributes, document, id_prefix, text, union, view_box_value
from .path_data import Box, PathData, curves_data

ViewBox = Literal["em", "metrics", "ink"]
VIEW_BOXES: tuple[ViewBox, ...] = get_args(ViewBox)


def to_svg(glyph: GlyphResult, *, view_box: ViewBox = "em") -> str:
    """The interpolated glyph as an SVG document.

    One user unit is one font unit; the font's (x, y) is written as (x, -y), with no transform, so that the
    origin of the glyph is the origin of the drawing. Coordinates have ``glyph.options.precision`` decimals; they are
    written as differences, which add up to the rounded coordinates exactly.

    Args:
        glyph: a result of :func:`convert`.
        view_box: the region shown. "em": from 0 to the advance and from descender to ascender, widened where
            ink exceeds it, so nothing is clipped. "metrics": exactly that region, for drawings side by side;
            ink beyond it overflows visibly. "ink": the tight box around the ink.

    Raises:
        OptionError: ``view_box`` is none of these.

    Example:
        >>> from glyphspline import convert, open_font, to_svg
        >>> glyph = convert(open_font("fonts_test/kouzan-gyosho.ttf").outline("O"))
        >>> to_svg(glyph, view_box="ink").startswith('<svg xmlns="http://www.w3.org/2000/svg" viewBox="')
        True
    """
    path = curves_data(glyph.arrays.curves, glyph.options.precision)[0]
    return svg_document(glyph, path, view_box).decode()


def svg_document(glyph: GlyphResult, path: PathData, view_box: ViewBox) -> bytes:
    """The document of :func:`to_svg` in UTF-8, from the path data of the glyph's curves."""
    outline, precision = glyph.outline, glyph.options.precision
    box = shown_box(outline, path.box, view_box)
    overflow = ' overflow="visible"' if view_box == "metrics" else ""
    prefix = id_prefix(outline.name, outline.gid)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{view_box_value(box, precision)}"{overflow}'
        f' role="img" aria-labelledby="{prefix}-title" {data_attributes(outline, precision)}>\n'
        f'<title id="{prefix}-title">{title(outline)}</title>\n'
        f'<path id="{prefix}-outline" fill="currentColor" fill-rule="nonzero" d="'
    )
    return document([head, path.text, '"/>\n</svg>\n'])


def shown_box(outline: Outline, ink: Box | None, choice: ViewBox) -> Box:
    """The region of a view box choice, in font units, y up."""
    require_choice("view_box", choice, VIEW_BOXES)
    metrics = outline.metrics
    box = (0.0, metrics.descender, outline.advance, metrics.ascender)
    if choice == "metrics":
        return box
    if choice == "em":
        return union(box, ink)
    return ink or (0.0, 0.0, 0.0, 0.0)


def title(outline: Outline) -> str:
    """The accessible title of a drawing, escaped: the glyph's name and code points."""
    return text(f"{outline.name} {code_points(outline)}".strip())
