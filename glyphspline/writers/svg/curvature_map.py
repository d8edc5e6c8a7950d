"""The curvature map of a glyph: its outline with the curvature comb, in the manner of the paper's Figs. 6 and 7."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache, lru_cache, reduce
from itertools import pairwise
from math import floor

import numpy as np

from ...fitting.results import GlyphResult
from ..settings import PLAIN_MAPS, Combs, Maps, Settings, Whose
from .comb import (
    SIDES,
    SOURCE,
    TOOTH,
    colour_classes,
    curvature_scale,
    curves_of,
    legend,
    palette,
    shown_by,
)  # fmt: skip
from .comb_data import STROKE, GlyphComb, combs_data
from .document import data_attributes, em_box, head, label, number, view_box_value
from .path_data import PathData, comb_precision, curves_data, dots_data, polylines_data, union

WIDEST, STEP = 1.5, 0.02
"""Width in em of the longest legend, and what widths are multiples of: those of many glyphs are equal."""

LETTERS, ADVANCE = 0.028, 0.6
"""Size in em of a legend's letters, and their advance in sizes, which is larger than that of common sans serifs."""

MEANING = (
    "Length and colour of a tooth are the curvature there, 1/radius with the em as the unit: 2 is the bend of a circle"
    " of half an em in radius. Blue to violet: the ink is convex; yellow to red: it is concave."
)
"""Tooltip of the legend."""


def to_curvature_svg(
    glyph: GlyphResult,
    *,
    comb: Combs = "result",
    scale: float | None = None,
    vertices: bool = True,
    control_polygon: bool = False,
    in_corners: bool = False,
) -> str:
    """The outline with its curvature comb, as an SVG document that is legible on light and dark.

    A tooth starts on the curve and follows its normal, on the outer (convex) side, away from the centre of curvature.
    Its length is the absolute curvature, 0.03 em at ``scale``; teeth are cut at 2.5 times that and end with a dot.
    Colour is signed κ: blue and violet where the ink is convex, yellow and red where it is concave, whichever way the
    contours run. The legend, no wider than the glyph, is in 1/em: curvature times units per em; it says how many teeth
    are cut, in how many corners they are left out, and the largest curvature of a result, corners included.

    Args:
        glyph: a result of :func:`convert`.
        comb: "result" is the interpolated curve; "source" is the outline as the font has it, with its exact curvature;
            "both" is the result's, and a dashed line through the tips of the source's.
        scale: the curvature, in 1/unit, of a full tooth. By default :func:`curvature_scale` of the glyph.
        vertices: mark the polygon's vertices, or the points on the curve of a source.
        control_polygon: draw the control polygon of each interpolation.
        in_corners: also draw the teeth where a smooth result turns about a corner of the source, within 1/40 em.

    Raises:
        OptionError: ``comb`` is none of these.

    Example:
        >>> from glyphspline import convert, open_font, to_curvature_svg
        >>> glyph = convert(open_font("fonts_test/kouzan-gyosho.ttf").outline("O"))
        >>> 'class="comb"' in to_curvature_svg(glyph)
        True
    """
    maps = Maps(comb, corner_teeth=in_corners)
    return write_map(glyph, Settings(), maps, scale, vertices=vertices, control_polygon=control_polygon).decode()


def write_map(
    glyph: GlyphResult,
    settings: Settings,
    maps: Maps = PLAIN_MAPS,
    scale: float | None = None,
    path: PathData | None = None,
    combs: Mapping[Whose, GlyphComb] | None = None,
    *,
    vertices: bool = True,
    control_polygon: bool = False,
) -> bytes:
    """The document of :func:`to_curvature_svg` in UTF-8.

    Args:
        settings: whose title names the glyph otherwise.
        scale, path, combs: the second of the curves under the comb, the third of :func:`.combs_data`; if known.
    """
    outline, arrays = glyph.outline, glyph.arrays
    em, whose = outline.metrics.units_per_em, shown_by(maps.comb)
    if scale is None:
        scale = maps.scale_for(em) or curvature_scale([glyph])
    precision = comb_precision(em)
    path = path or curves_data(curves_of(glyph, whose), glyph.options.precision)[0]
    combs = combs or combs_data([glyph], maps.comb, scale, in_corners=maps.corner_teeth)[0]
    shown, layers = combs[whose], list(_layers(combs, em))
    boxes = [comb.box for comb in combs.values() if comb.box] or [em_box(outline)]
    box = reduce(union, boxes, (0.0, np.inf, outline.advance, -np.inf))
    kind = "outline" if whose == "result" else "source"
    layers.append(
        f'<path class="{kind}" stroke="currentColor" stroke-width="{_width(em, STROKE)}" fill="currentColor"'
        f' fill-opacity=".07" d="{path.text}"/>\n'
    )
    if path.strokes:
        layers.append(
            f'<path class="{kind}" stroke="currentColor" stroke-width="{_width(em, STROKE)}" d="{path.strokes}"/>\n'
        )
    if control_polygon and whose == "result":
        polygons = polylines_data(arrays.controls, precision)[0]
        layers.append(
            f'<path class="control-polygon" stroke="currentColor" stroke-opacity=".6" stroke-width="{_width(em, 1.2)}"'
            f' stroke-dasharray="{_width(em, 6)}" d="{polygons.text}"/>\n'
        )
        box = union(box, polygons.box)
    if vertices:
        points, degrees = arrays.source.points, arrays.source.degrees
        marked = arrays.polygons.points if whose == "result" else points[np.cumsum(degrees) - degrees]
        dots = dots_data(marked, precision)
        layers.append(f'<path class="vertices" stroke="currentColor" stroke-width="{_width(em, 6)}" d="{dots}"/>\n')
    width = min(max(floor((box[2] - box[0]) / (STEP * em)), 1) * STEP, WIDEST) * em
    letters = min(LETTERS * em, width / 9)
    measured = arrays.measures.get("max_curvature", ()) if whose == "result" else ()
    known = [each for each in measured if each is not None]
    words = legend(maps.comb, shown.cut, scale * em, shown.corners, max(known) * em if known else None)
    lines = _lines(f"κ{words}", int(width / (ADVANCE * letters)))
    said = [_words(0.0, -2.75 - 1.4 * k, "start", line, letters, precision) for k, line in enumerate(lines)]
    height, margin = (3.1 + 1.4 * (len(lines) - 1)) * letters, 0.02 * em
    left, base = box[0], box[1] - (0.06 + TOOTH) * em
    layers.append(
        f'<g class="legend" transform="translate({number(left, precision)} {number(-base, precision)})"'
        f' stroke-width="{_width(em, 3)}">{_axis(em, scale, precision, width, letters)}'
        f"{''.join(said)}</g></g>\n</svg>\n"
    )
    box = (box[0] - margin, base - height - margin, max(box[2], left + width) + margin, box[3] + margin)
    drawn = "" if whose == "result" else ", source"
    attributes = (
        f'{data_attributes(outline, precision)} data-scale="{scale:.6g}" fill="none" stroke-linecap="round"'
        ' stroke-linejoin="round"'
    )
    named = f"Curvature of {label(outline, settings.title)}{drawn}"
    return b"".join([layer.encode() for layer in (head(view_box_value(box, precision), named, attributes), *layers)])


def _layers(combs: Mapping[Whose, GlyphComb], em: float) -> Iterator[str]:
    """The comb's paths: teeth by colour class, the line of tips and marks of cut teeth; of the source of both, the line
    alone."""
    yield f'<g class="comb" stroke-width="{_width(em, 1.8)}">'
    first, *others = combs.values()
    yield from (f'{begin}{path}"/>\n' for begin, path in zip(_styles(em), first.paths, strict=False) if path)
    dashed = f'stroke-width="{_width(em, 2.4)}" stroke-dasharray="{_width(em, 10)} {_width(em, 5)}"'
    for comb in others:
        if comb.box:
            yield f'<path class="source-comb" stroke="{SOURCE}" {dashed} d="{comb.paths[-2]}"/>\n'
    yield "</g>\n"


@cache
def _styles(em: float) -> list[str]:
    """The beginnings of a comb's paths, in their order."""
    return [
        *(f'<path stroke="{colour}" d="' for colour in palette()),
        f'<path stroke="currentColor" stroke-opacity=".45" stroke-width="{_width(em, 0.9)}" d="',
        f'<path class="cut" stroke="currentColor" stroke-width="{_width(em, 3)}" d="',
    ]


@lru_cache(maxsize=128)
def _axis(em: float, scale: float, precision: int, width: float, letters: float) -> str:
    """A row of teeth over an axis from -κ to κ of the scale, in 1/em, from its left end; a group of text stays open."""
    from .path_text import comb_text  # here and not above: the package opens without a compiler

    reach = scale * em
    strength = np.linspace(-1, 1, 8 * SIDES + 1)
    feet = np.stack([(strength + 1) / 2 * width, 0 * strength], axis=1)
    tips = feet + np.stack([0 * strength, np.abs(strength) * TOOTH * em], axis=1)
    ends = np.rint(np.concatenate([feet, tips], axis=1) * 10**precision)
    data, at = comb_text(ends, colour_classes(strength) + SIDES, np.array([0, len(ends)]), precision)
    strokes = [
        (colour, data[a:b].tobytes().decode()) for colour, (a, b) in zip(palette(), pairwise(at.tolist()), strict=False)
    ]
    labels = [(0.0, "start", f"\N{MINUS SIGN}{reach:.3g}"), (width / 2, "middle", "0"), (width, "end", f"{reach:.3g}")]
    texts = [_words(x, -1.35, anchor, label, letters, precision) for x, anchor, label in labels]
    return (
        f"<title>{MEANING}</title>"
        + "\n".join([f'<path stroke="{colour}" d="{path}"/>' for colour, path in strokes])
        + f'\n<path stroke="currentColor" d="M0 0h{number(width, precision)}"/>\n'
        + f'<g fill="currentColor" font-family="sans-serif" font-size="{number(letters, precision)}">'
        + "".join(texts)
    )


def _lines(words: str, most: int) -> list[str]:
    """A text on lines of at most so many letters; ``textwrap`` takes ten times as long."""
    first, *others = words.split(" ")
    lines = [first]
    for word in others:
        if len(lines[-1]) + 1 + len(word) <= most:
            lines[-1] += f" {word}"
        else:
            lines.append(word)
    return lines


def _words(x: float, line: float, anchor: str, words: str, letters: float, precision: int) -> str:
    """A text of a legend; ``line`` is its baseline's height in sizes of its letters."""
    y = number(-line * letters, precision)
    return f'<text x="{number(x, precision)}" y="{y}" text-anchor="{anchor}">{words}</text>'


def _width(em: float, thousandths: float) -> str:
    """A stroke width given in 1/1000 em."""
    return number(thousandths * em / 1000, 3)
