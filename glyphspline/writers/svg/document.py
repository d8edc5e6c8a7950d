"""A glyph's result as an SVG drawing: one path of exact Béziers."""

from __future__ import annotations

from ...errors import require_choice
from ...fitting.results import GlyphResult
from ...outlines.outline import Outline
from .appearance import CURRENT, PLAIN, VIEW_BOXES, Appearance, ViewBox
from .markup import code_points, data_attributes, document, head, id_prefix, number, text, union, view_box_value
from .path_data import Box, PathData, curves_data

STROKE = 1 / 1000
"""Width in em of a line along the outline: cutters follow its middle."""


def to_svg(
    glyph: GlyphResult,
    *,
    view_box: ViewBox = "em",
    size: str | None = None,
    fill: str = CURRENT,
    stroke: str = "none",
    em: str | None = None,
) -> str:
    """The interpolated glyph as an SVG document.

    One user unit is one font unit; the font's (x, y) is written as (x, -y), with no transform, so that the
    origin of the glyph is the origin of the drawing. Coordinates have ``glyph.options.precision`` decimals; they are
    written as differences, which add up to the rounded coordinates exactly.

    Args:
        glyph: a result of :func:`convert`.
        view_box: the region shown. "em": from 0 to the advance and from descender to ascender, widened where
            ink exceeds it, so nothing is clipped. "metrics": exactly that region, for drawings side by side;
            ink beyond it overflows visibly. "ink": the tight box around the ink.
        size: height of the drawing with its unit, as in "20mm", its width in proportion: the attributes ``width`` and
            ``height``. Units are mm, cm, in, pt, pc and px. None: as large as the page makes it.
        fill: colour of the ink: a name of CSS, #rgb, #rrggbb, "none", or "currentColor", that of the text around it.
        stroke: colour of a line of 1/1000 em along the outline, likewise.
        em: instead of ``size``, the length of an em with its unit: the size that type has, as in "12pt".

    Raises:
        OptionError: a view box, a size or a colour that is none of these.

    Example:
        >>> from glyphspline import convert, open_font, to_svg
        >>> glyph = convert(open_font("fonts_test/kouzan-gyosho.ttf").outline("O"))
        >>> to_svg(glyph, view_box="ink").startswith('<svg xmlns="http://www.w3.org/2000/svg" viewBox="')
        True
    """
    path = curves_data(glyph.arrays.curves, glyph.options.precision)[0]
    return svg_document(glyph, path, Appearance(view_box, size, fill, stroke, em)).decode()


def svg_document(glyph: GlyphResult, path: PathData, look: Appearance = PLAIN) -> bytes:
    """The document of :func:`to_svg` in UTF-8, from the path data of the glyph's curves."""
    outline, precision = glyph.outline, glyph.options.precision
    em = outline.metrics.units_per_em
    box = shown_box(em_box(outline), path.box, look.view_box)
    prefix = id_prefix(outline.name, outline.gid)
    value, shape = shown_as(box, look, em, precision)
    begin = head(value, f"{prefix}-title", title(outline), data_attributes(outline, precision), shape)
    return document([begin, f'<path id="{prefix}-outline" {painting(look, em)} d="', path.text, '"/>\n</svg>\n'])


def shown_as(box: Box, look: Appearance, em: float, precision: int) -> tuple[str, str]:
    """The ``viewBox`` of a drawing's region, and its size as attributes."""
    value = view_box_value(box, precision)
    width, height = map(float, value.split()[2:])
    overflow = ' overflow="visible"' if look.view_box == "metrics" else ""
    return value, look.attributes(width, height, em) + overflow


def painting(look: Appearance, em: float) -> str:
    """How outlines are filled and stroked, as attributes."""
    line = number(STROKE * em, 3)
    stroke = f' stroke="{text(look.stroke)}" stroke-width="{line}"' if look.stroke != "none" else ""
    return f'fill="{text(look.fill)}"{stroke} fill-rule="nonzero"'


def em_box(outline: Outline) -> Box:
    """From the origin to the advance, and from descender to ascender."""
    return (0.0, outline.metrics.descender, outline.advance, outline.metrics.ascender)


def shown_box(box: Box, ink: Box | None, choice: ViewBox) -> Box:
    """The region of a view box choice, in font units, y up; ``box``: that of the metrics."""
    require_choice("view_box", choice, VIEW_BOXES)
    if choice == "metrics":
        return box
    if choice == "em":
        return union(box, ink)
    return ink or (0.0, 0.0, 0.0, 0.0)


def title(outline: Outline) -> str:
    """The accessible title of a drawing, escaped: the glyph's name and code points."""
    return text(f"{outline.name} {code_points(outline)}".strip())
