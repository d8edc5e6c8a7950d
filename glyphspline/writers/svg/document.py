"""A glyph's result as an SVG drawing: one path of exact Béziers."""

from __future__ import annotations

from typing import Literal

import numpy as np

from ...fitting.results import GlyphResult
from ...outlines.outline import Outline
from .markup import (
    Box,
    Text,
    code_points,
    curves_bounds,
    curves_data,
    data_attributes,
    id_prefix,
    joined,
    laid_out,
    text,
    union,
    view_box_value,
)

ViewBox = Literal["em", "metrics", "ink"]
VIEW_BOXES: tuple[ViewBox, ...] = ("em", "metrics", "ink")


def to_svg(glyph: GlyphResult, *, view_box: ViewBox = "em") -> str:
    """The interpolated glyph as an SVG document.

    One user unit is one font unit; the font's (x, y) is written as (x, -y), with no transform, so that the
    origin of the glyph is the origin of the drawing. Coordinates have ``glyph.options.precision`` decimals; they are
    written as differences, which add up to the rounded coordinates exactly.

    Args:
        glyph: what :func:`convert` gave.
        view_box: the region shown. "em": from 0 to the advance and from descender to ascender, widened where
            ink goes beyond, so nothing is ever clipped. "metrics": exactly that region, for setting drawings
            side by side; ink beyond it overflows visibly. "ink": the tight box around the ink.
            In all of them the side bearings follow from ``data-advance`` and the path itself.

    Raises:
        ValueError: ``view_box`` is none of these.
    """
    precision = glyph.options.precision
    points, degrees, contours = laid_out(contour.curve for contour in glyph.contours)
    ink = curves_bounds(np.round(points, precision), degrees, contours)
    path = curves_data(points, degrees, contours, precision)
    return svg_document(glyph.outline, path, shown_box(glyph.outline, ink, view_box), precision, view_box).decode()


def svg_document(outline: Outline, path: Text, box: Box, precision: int, view_box: ViewBox) -> bytes:
    """The document around path data, in UTF-8; of ``outline`` everything but its contours is written."""
    overflow = ' overflow="visible"' if view_box == "metrics" else ""
    prefix = id_prefix(outline.name, outline.gid)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{view_box_value(box, precision)}"{overflow}'
        f' role="img" aria-labelledby="{prefix}-title" {data_attributes(outline, precision)}>\n'
        f'<title id="{prefix}-title">{title(outline)}</title>\n'
        f'<path id="{prefix}-outline" fill="currentColor" fill-rule="nonzero" d="'
    )
    return joined([head, path, '"/>\n</svg>\n'])


def shown_box(outline: Outline, ink: Box | None, choice: ViewBox) -> Box:
    """The region of a view box choice, in font units, y up."""
    metrics = outline.metrics
    box = (0.0, metrics.descender, outline.advance, metrics.ascender)
    if choice == "metrics":
        return box
    if choice == "em":
        return union(box, ink)
    if choice == "ink":
        return ink or (0.0, 0.0, 0.0, 0.0)
    raise ValueError(f'view_box is "em", "metrics" or "ink", not {choice!r}')


def title(outline: Outline) -> str:
    """What a reader is told the drawing shows, escaped: the glyph's name and code points."""
    return text(f"{outline.name} {code_points(outline)}".strip())
