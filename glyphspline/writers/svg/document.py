"""A glyph's result as an SVG drawing, one path of exact Béziers; its source with the polygon over it; and the common
parts of SVG documents."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from functools import lru_cache
from html import escape
from typing import NamedTuple

from ...errors import require_choice
from ...fitting.results import GlyphResult, joined_results
from ...outlines.contour_arrays import joined, offsets_of
from ...outlines.outline import Outline
from ..settings import CURRENT, VIEW_BOXES, Appearance, Settings, ViewBox
from .path_data import Box, PathData, comb_precision, curves_data, dots_data, polylines_data, union

_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
XMLNS = 'xmlns="http://www.w3.org/2000/svg"'


class PolygonData(NamedTuple):
    """Path data of a glyph's polygons, and of the control polygons of its result."""

    polygon: PathData
    control: PathData


def to_svg(
    glyph: GlyphResult,
    *,
    view_box: ViewBox = "em",
    size: str | None = None,
    fill: str = CURRENT,
    stroke: str = "none",
    em: str | None = None,
    stroke_width: str | None = None,
    bare: bool = False,
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
        stroke: colour of a line along the outline, likewise.
        em: instead of ``size``, the length of an em with its unit: the size that type has, as in "12pt".
        stroke_width: of that line: font units, "0.01em", or "0.1mm" of a drawing with a size; None: 1/1000 em. Open
            paths are such lines too, without a stroke in the colour of the ink and 1/40 em wide.
        bare: a path in an ``svg`` and nothing else, for the web: no label, no metrics, black unless a colour is given.

    Raises:
        OptionError: a view box, a size or a colour that is none of these.

    Example:
        >>> from glyphspline import convert, open_font, to_svg
        >>> glyph = convert(open_font("fonts_test/kouzan-gyosho.ttf").outline("O"))
        >>> to_svg(glyph, view_box="ink").startswith('<svg xmlns="http://www.w3.org/2000/svg" viewBox="')
        True
    """
    look = Appearance(view_box, size, fill, stroke, em, stroke_width, bare)
    return write_svg(glyph, Settings(look)).decode()


def write_svg(result: GlyphResult, settings: Settings, path: PathData | None = None) -> bytes:
    """The document of :func:`to_svg` in UTF-8; ``path`` is that of the curves, if it is known."""
    outline, precision, look = result.outline, result.options.precision, settings.look
    path = path or curves_data(result.arrays.curves, precision)[0]
    em = outline.metrics.units_per_em
    box = shown_box(em_box(outline), inked(path, look, em), look.view_box)
    value, shape = shown_as(box, look, em, precision)
    height, end = float(value.split()[3]), "" if look.bare else "\n"
    drawn = [f'<path{painting(look, em, height)} d="{path.text}"/>{end}'] if path.text or not path.strokes else []
    if path.strokes:
        drawn.append(f'<path{stroking(look, em, height)} d="{path.strokes}"/>{end}')
    begin = f'<svg {XMLNS} viewBox="{value}"{shape}>'
    if not look.bare:
        begin = head(value, label(outline, settings.title), data_attributes(outline, precision), shape)
    return f"{begin}{''.join(drawn)}</svg>{end}".encode()


def write_source(result: GlyphResult, settings: Settings, path: PathData | None = None) -> bytes:
    """The file of the outline that a result was made of."""
    return write_svg(result, settings, path or source_data([result])[0])


def shown_as(box: Box, look: Appearance, em: float, precision: int) -> tuple[str, str]:
    """The ``viewBox`` of a drawing's region, and its size as attributes."""
    value = view_box_value(box, precision)
    width, height = map(float, value.split()[2:])
    overflow = ' overflow="visible"' if look.view_box == "metrics" else ""
    found = look.scale(height, em)
    if found is None:
        return value, overflow
    scale, unit = found
    return value, f' width="{number(width * scale, 4)}{unit}" height="{number(height * scale, 6)}{unit}"{overflow}'


def painting(look: Appearance, em: float, height: float) -> str:
    """How outlines are filled and stroked, as attributes, after spaces; ``height`` of the drawing in font units."""
    line = number(look.line(em, height), 3)
    stroke = f' stroke="{text(look.stroke)}" stroke-width="{line}"' if look.stroke != "none" else ""
    return stroke if look.bare and look.fill == CURRENT else f' fill="{text(look.fill)}"{stroke}'


def stroking(look: Appearance, em: float, height: float) -> str:
    """How open paths are drawn, likewise: as lines, without a ``stroke`` in the colour of the ink."""
    colour, line = look.open_line(em, height)
    return (
        f' fill="none" stroke="{text(colour)}" stroke-width="{number(line, 3)}" stroke-linecap="round"'
        ' stroke-linejoin="round"'
    )


def inked(path: PathData, look: Appearance, em: float) -> Box | None:
    """The box around a glyph, with the width of the lines that open paths are drawn as."""
    if path.box is None or not path.strokes:
        return path.box
    left, bottom, right, top = path.box
    half = look.open_line(em, max(top - bottom, 1.0))[1] / 2
    return left - half, bottom - half, right + half, top + half


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


def label(outline: Outline, words: str | None = None) -> str:
    """What assistive technology says of a drawing, escaped: these words, or the glyph's name and code points."""
    return text(f"{outline.name} {code_points(outline)}".strip() if words is None else words)


def source_data(glyphs: Sequence[GlyphResult]) -> list[PathData]:
    """Path data of the source outlines of glyphs, at least one, that have the same options."""
    outlines = [glyph.outline.arrays for glyph in glyphs]
    offsets = offsets_of([own.num_contours for own in outlines])
    return curves_data(joined(outlines), glyphs[0].options.precision, offsets)


def polygon_data(glyphs: Sequence[GlyphResult]) -> list[PolygonData]:
    """Path data of the polygons of glyphs, at least one, that have the same options and em."""
    precision, coarse = glyphs[0].options.precision, comb_precision(glyphs[0].outline.metrics.units_per_em)
    arrays, offsets = joined_results(glyphs)
    polygon = polylines_data(arrays.polygons, precision, offsets)
    control = polylines_data(arrays.controls, coarse, arrays.arc_offsets[offsets])
    return [PolygonData(*parts) for parts in zip(polygon, control, strict=True)]


def polygon_document(glyph: GlyphResult, source: PathData | None = None, data: PolygonData | None = None) -> bytes:
    """The source outline, and over it the polygon with its vertices, as groups of one SVG document in UTF-8.

    Their classes are "source" and "polygon". A third group, "control", holds the control polygons of the result; it is
    not displayed. ``source`` and ``data`` are the path data, if they are known.
    """
    source, data = source or source_data([glyph])[0], data or polygon_data([glyph])[0]
    outline, precision = glyph.outline, glyph.options.precision
    em = outline.metrics.units_per_em
    box = union(em_box(outline), source.box)
    begin = head(
        view_box_value(box, precision), f"Source outline and polygon of {label(outline)}",
        data_attributes(outline, precision), ' overflow="visible"',
    )  # fmt: skip
    dots = dots_data(glyph.arrays.polygons.points, comb_precision(em))
    strokes = f'<path fill="none" d="{source.strokes}"/>' if source.strokes else ""
    drawn = (
        f'{begin}<g class="source" fill="currentColor" fill-opacity=".3" stroke="currentColor"'
        f' stroke-width="{number(em / 500, 3)}"><path d="{source.text}"/>{strokes}</g>\n'
        f'<g class="polygon" fill="none" stroke="#d33" stroke-width="{number(em / 400, 3)}"'
        f' stroke-linecap="round" stroke-linejoin="round"><path d="{data.polygon.text}"/>'
        f'<path stroke-width="{number(em / 100, 3)}" d="{dots}"/></g>\n'
        f'<g class="control" display="none" fill="none" stroke="#75c"'
        f' stroke-width="{number(em / 600, 3)}"><path d="{data.control.text}"/></g>\n</svg>\n'
    )
    return drawn.encode()


def head(box: str, label: str, attributes: str = "", shape: str = "") -> str:
    """The beginning of a document, with a label and no title, which browsers show as a tooltip.

    Args:
        box: value of its ``viewBox``. label: escaped.
        attributes, shape: further attributes, each after a space; those of its size come first.
    """
    return f'<svg {XMLNS} viewBox="{box}"{shape} role="img" aria-label="{label}"{attributes}>\n'


@lru_cache(maxsize=4096)
def number(value: float, precision: int) -> str:
    """One number with at most ``precision`` decimals: no zeros at the end, no "-0"."""
    return f"{round(float(value), precision) + 0.0:.15g}"  # 17 digits would write 0.1 as 0.10000000000000001


def text(value: str) -> str:
    """Text for element content or a quoted attribute; characters that XML forbids become U+FFFD."""
    return escape(_NOT_XML.sub("\ufffd", value))


def code_points(outline: Outline) -> str:
    """The glyph's code points as "U+0041 U+0391"."""
    return " ".join([f"U+{code:04X}" for code in outline.unicodes])


def data_attributes(outline: Outline, precision: int) -> str:
    """The glyph's identity and horizontal metrics as ``data-*`` attributes."""
    em, ascender, descender = outline.metrics.units_per_em, outline.metrics.ascender, outline.metrics.descender
    values = {"advance": outline.advance, "units-per-em": em, "ascender": ascender, "descender": descender}
    numbers = "".join([f' data-{key}="{number(value, precision)}"' for key, value in values.items()])
    return (
        f' data-glyph="{text(outline.name)}" data-gid="{outline.gid}" data-unicodes="{code_points(outline)}"{numbers}'
    )


@lru_cache(maxsize=4096)
def view_box_value(box: Box, precision: int) -> str:
    """The ``viewBox`` value of a box, rounded outwards, at least one unit wide and high (0 would hide all)."""
    unit = 10.0**precision
    left, bottom = math.floor(box[0] * unit) / unit, math.floor(box[1] * unit) / unit
    right, top = math.ceil(box[2] * unit) / unit, math.ceil(box[3] * unit) / unit
    values = (left, -top, max(right - left, 1.0), max(top - bottom, 1.0))
    return " ".join(number(value, precision) for value in values)
