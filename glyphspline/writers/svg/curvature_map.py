"""The curvature map of a glyph: its outline with the curvature comb, in the manner of the paper's Figs. 6 and 7."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np

from ...curves.curvature import ANGLE, Comb, comb, relative, robust_scale
from ...errors import require_choice
from ...fitting.results import GlyphResult
from ...outlines.contour_arrays import ContourArrays
from ...outlines.sampling import CORNER_ANGLE
from ...types import BoolArray, FloatArray, IntArray
from .appearance import WHOSE, Whose
from .colours import SIDES, class_colour
from .document import title
from .legend import legend_svg
from .markup import Text, data_attributes, document, head, id_prefix, number, union, view_box_value
from .path_data import Box, PathData, curves_data, dots_data, polylines_data

SPACING = 1 / 140
"""Maximum spacing of teeth in em. At half of it teeth run together in print; at twice, the tips cut corners."""

MOST_TEETH = 8000
"""Maximum number of teeth; beyond it spacing grows. A CJK glyph has some 2000, a hostile one could have millions."""

TOOTH = 0.03
"""Length in em of a tooth at the shared scale. Longer teeth of neighbouring strokes cross on CJK glyphs."""

LONGEST = 1.25
"""Maximum length of a tooth in units of the scale; shortened teeth have a mark. At 2.5 the fans of rounded corners
cover a CJK glyph; without a limit a single tooth may cross the page."""

STROKE = 3
"""Width of the outline in 1/1000 em. It would hide teeth of less than half of it, so these are left out."""

PRECISION = 1
"""Decimals of the comb, per 1000 units of the em: 1/10,000 em is finer than any screen shows."""


NEAR = 1 / 40
"""Distance in em within which a smooth result turns about a corner of the source, and swings out on both sides."""


@dataclass(frozen=True, eq=False)
class Teeth:
    """One contour's comb as drawn, in font units: all arrays in curve order.

    Attributes:
        feet, tips: (k, 2). relative: (k,) curvature in units of the scale, positive where the ink is convex.
        cut: (k,) whether the tooth was shortened.
    """

    feet: FloatArray
    tips: FloatArray
    relative: FloatArray
    cut: BoolArray


def curvature_scale(glyphs: Iterable[GlyphResult]) -> float:
    """The scale, in 1/unit, that maps of these glyphs share: see :func:`glyphspline.curves.curvature.robust_scale`.

    It is that of the sources, so that combs of sources and of all their results compare; a smooth result's turns about
    corners would make it larger. Where all sources are straight it is that of the results.
    """
    every = list(glyphs)
    order: tuple[Whose, ...] = ("source", "result")
    found = (robust_scale(item for glyph in every for item in combs(glyph, whose=whose)) for whose in order)
    return next(filter(None, found), 0.0)


def combs(glyph: GlyphResult, density: float = 2.0, whose: Whose = "result") -> list[Comb]:
    """One comb a contour. By default it is twice as dense as in maps, from which the scale can be 15% too large."""
    from ...curves.comb import control_length  # here and not above: the package opens without a compiler
    from ...outlines.segments import all_cubics

    curves = curves_of(glyph, whose)
    cubics = all_cubics(curves)
    spacing = max(SPACING * glyph.outline.metrics.units_per_em, control_length(cubics) / MOST_TEETH) / density
    return [comb(cubics[a:b], spacing) for a, b in pairwise(curves.offsets.tolist()) if a < b]


def curves_of(glyph: GlyphResult, whose: Whose) -> ContourArrays:
    """The contours whose curvature is shown."""
    require_choice("comb", whose, WHOSE)
    return glyph.arrays.curves if whose == "result" else glyph.arrays.source


def sides_and_corners(
    glyph: GlyphResult, whose: Whose = "result", *, in_corners: bool = False
) -> tuple[FloatArray, FloatArray, IntArray]:
    """(C,) sides of the ink, (k, 2) corners in whose turn no teeth are drawn, and (C + 1,) where each contour's begin.

    Only a smooth result turns about a corner. In the source, and in a result with corners, it is a point between two
    curvatures.
    """
    from ...outlines.ink import corner_points, ink_sides  # here and not above: the package opens without a compiler

    turned = whose == "result" and glyph.options.corners == "smooth" and not in_corners
    corners, offsets = corner_points(glyph.arrays.source, np.radians(CORNER_ANGLE) if turned else np.inf)
    return ink_sides(curves_of(glyph, whose)), corners, offsets


def teeth(glyph: GlyphResult, scale: float, whose: Whose = "result", *, in_corners: bool = False) -> list[Teeth]:
    """Feet and tips of each contour's comb. Teeth point away from the centre of curvature."""
    em, curves = glyph.outline.metrics.units_per_em, curves_of(glyph, whose)
    sides, corners, offsets = sides_and_corners(glyph, whose, in_corners=in_corners)
    drawn = np.flatnonzero(np.diff(curves.offsets)).tolist()
    found = combs(glyph, density=1.0, whose=whose)
    return [
        teeth_of(item, em, scale, float(sides[c]), corners[offsets[c] : offsets[c + 1]])
        for item, c in zip(found, drawn, strict=True)
    ]


def teeth_of(item: Comb, em: float, scale: float, side: float = 1.0, corners: FloatArray | None = None) -> Teeth:
    """Feet and tips of one comb; ``side`` and ``corners`` (k, 2) of its contour as for :func:`sides_and_corners`."""
    strength = relative(item.curvature, scale)
    cut = np.abs(strength) > LONGEST
    if corners is not None and len(corners):
        from ...outlines.ink import turned_about  # as above

        hidden = turned_about(corners, item.points, cut, NEAR * em)
        strength[hidden], cut[hidden] = 0.0, False
    shown = np.clip(strength, -LONGEST, LONGEST)
    tips = item.points - (TOOTH * em * shown)[:, None] * item.normals
    return Teeth(item.points, tips, side * strength, cut)


def to_curvature_svg(
    glyph: GlyphResult,
    *,
    comb: Whose = "result",
    scale: float | None = None,
    vertices: bool = True,
    control_polygon: bool = False,
    in_corners: bool = False,
) -> str:
    """The outline with its curvature comb, as an SVG document that is legible on light and dark.

    A tooth stands on the curve along its normal, on the outer (convex) side, away from the centre of curvature. Its
    length is the absolute curvature, 0.03 em at ``scale``; teeth are cut at 1.25 times that and end with a dot. Colour
    is signed κ: blue and violet where the ink is convex, yellow and red where it is concave, whichever way the contours
    run. The legend is in 1/em: curvature times units per em.

    Args:
        glyph: a result of :func:`convert`.
        comb: "result" is the interpolated curve; "source" is the outline as the font has it, with its exact curvature.
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
    scale = curvature_scale([glyph]) if scale is None else scale
    path = curves_data(curves_of(glyph, comb), glyph.options.precision)[0]
    return map_document(
        glyph, path, scale, comb, vertices=vertices, control_polygon=control_polygon, in_corners=in_corners
    ).decode()


def map_document(
    glyph: GlyphResult,
    path: PathData,
    scale: float,
    whose: Whose = "result",
    *,
    vertices: bool = True,
    control_polygon: bool = False,
    in_corners: bool = False,
) -> bytes:
    """The document of :func:`to_curvature_svg` in UTF-8, from the path data of the curves that the comb stands on."""
    outline, arrays = glyph.outline, glyph.arrays
    em = outline.metrics.units_per_em
    precision = comb_precision(em)
    marks = sides_and_corners(glyph, whose, in_corners=in_corners)
    layers, box = _comb_layer(curves_of(glyph, whose), *marks, em, scale, precision)
    box = box or (0.0, outline.metrics.descender, outline.advance, outline.metrics.ascender)
    box = (min(box[0], 0.0), box[1], max(box[2], outline.advance), box[3])
    kind = "outline" if whose == "result" else "source"
    layers += [
        f'<path class="{kind}" stroke="currentColor" stroke-width="{_width(em, STROKE)}" fill="currentColor"'
        ' fill-opacity=".07" fill-rule="nonzero" d="', path.text, '"/>\n',
    ]  # fmt: skip
    if control_polygon and whose == "result":
        polygons = polylines_data(arrays.controls, precision)[0]
        layers += [
            f'<path class="control-polygon" stroke="currentColor" stroke-opacity=".6" stroke-width="{_width(em, 1.2)}"'
            f' stroke-dasharray="{_width(em, 6)}" d="', polygons.text, '"/>\n',
        ]  # fmt: skip
        box = union(box, polygons.box)
    if vertices:
        style = f'<path class="vertices" stroke="currentColor" stroke-width="{_width(em, 6)}" d="'
        source = arrays.source
        joints = source.points[np.cumsum(source.degrees) - source.degrees]
        points = arrays.polygons.points if whose == "result" else joints
        layers += [style, dots_data(points, precision), '"/>\n']
    legend, box = legend_svg(box, em, scale, precision, TOOTH, LONGEST, whose)
    margin = 0.02 * em
    box = (box[0] - margin, box[1] - margin, box[2] + margin, box[3] + margin)
    prefix, drawn = id_prefix(outline.name, outline.gid), "" if whose == "result" else ", source"
    attributes = (
        f'{data_attributes(outline, precision)} data-scale="{scale:.6g}" fill="none" stroke-linecap="round"'
        ' stroke-linejoin="round"'
    )
    value = view_box_value(box, precision)
    begin = head(value, f"{prefix}-map-title", f"Curvature of {title(outline)}{drawn}", attributes)
    return document([begin, *layers, legend, "\n</svg>\n"])


@cache
def comb_precision(em: float) -> int:
    """Decimals of comb coordinates: fewer on a large em."""
    return max(0, PRECISION + 3 - round(float(np.log10(em))))


def _comb_layer(
    curves: ContourArrays,
    sides: FloatArray,
    corners: FloatArray,
    corner_offsets: IntArray,
    em: float,
    scale: float,
    precision: int,
) -> tuple[list[Text], Box | None]:
    """The comb's paths (teeth by colour class, line of tips, marks of cut teeth), and the box around curve and comb."""
    from .comb_paths import comb_text  # here and not above: the package opens without a compiler

    text, ends, (left, bottom, right, top) = comb_text(
        curves, sides, corners, corner_offsets, NEAR * em, SPACING * em, float(MOST_TEETH), ANGLE, TOOTH * em, scale,
        LONGEST, 0.5 * STROKE * em / 1000, precision,
    )  # fmt: skip
    view = text.data
    layers: list[Text] = [f'<g class="comb" stroke-width="{_width(em, 1.8)}">']
    for style, (a, b) in zip(_styles(em), pairwise(ends.tolist()), strict=True):
        if b > a:
            layers += [style, view[a:b], '"/>\n']
    layers.append("</g>\n")
    return layers, (float(left), float(bottom), float(right), float(top)) if left <= right else None


@cache
def _styles(em: float) -> list[str]:
    """The beginnings of a comb's paths, in the order of ``comb_text``."""
    return [
        *(f'<path stroke="{class_colour(index)}" d="' for index in range(-SIDES, SIDES + 1)),
        f'<path stroke="currentColor" stroke-opacity=".45" stroke-width="{_width(em, 0.9)}" d="',
        f'<path class="cut" stroke="currentColor" stroke-width="{_width(em, 3)}" d="',
    ]


def _width(em: float, thousandths: float) -> str:
    """A stroke width given in 1/1000 em."""
    return number(thousandths * em / 1000, 3)
