"""A glyph as PNG or PDF: its drawing, and its curvature map."""

from __future__ import annotations

from textwrap import wrap
from typing import Any

import numpy as np

from ...fitting.results import GlyphResult
from ...outlines.open_paths import are_open
from ..settings import CURRENT, PLAIN_MAPS, Combs, ImageKind, Maps, Settings
from ..svg.comb import SIDES, SOURCE, colour_classes, curvature_scale, legend, palette, shown_by, teeth
from ..svg.document import em_box, inked, shown_box
from ..svg.path_data import PathData, curves_data
from .basics import DPI, ascii_text, blank, colour_bar, outline_patch, ring, saved

SIZE = 6.0
"""Height in inches of a drawing that says none, and width and height of a map."""

LAYOUTS, EDGE = 8, 0.02
"""How often a map is laid out at most, until so many inches are free at its edges. A layout measures title and legend
before the axes shrink to one scale in x and y. Mostly one is enough; a glyph as wide as it is high takes some four."""


def write_drawing(glyph: GlyphResult, settings: Settings, kind: ImageKind, path: PathData | None = None) -> bytes:
    """What :func:`..svg.document.to_svg` draws, as a one-page PDF or as a PNG on white.

    Args:
        glyph: a result of :func:`glyphspline.convert`. kind: of the file.
        settings: without a size the drawing is 6 inches high; "currentColor" is black.
        path: the data of the glyph's curves, if it is known.
    """
    look = settings.look
    outline = glyph.outline
    path = path or curves_data(glyph.arrays.curves, glyph.options.precision)[0]
    ink = inked(path, look, outline.metrics.units_per_em)
    left, bottom, right, top = shown_box(em_box(outline), ink, look.view_box)
    width, height = max(right - left, 1.0), max(top - bottom, 1.0)  # as view_box_value has it
    inches = look.inches(height, outline.metrics.units_per_em, SIZE)
    # A height in px is that many pixels. Maximum width and height of a PNG in pixels; a larger one has fewer an inch.
    dpi = 96.0 if str(look.size or look.em).endswith("px") else DPI
    dpi = min(dpi, 8000.0 / (inches * max(1.0, width / height)))
    least = 1.01 / dpi if kind == "png" else 0.0  # a pixel
    figure = blank(max(inches * width / height, least), max(inches, least))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(left, left + width), ylim=(bottom, bottom + height))
    axes.set_axis_off()
    fill, stroke = ("black" if colour == CURRENT else colour for colour in (look.fill, look.stroke))
    line = look.line(outline.metrics.units_per_em, height) * inches * 72 / height
    curves = [contour.curve.cubics() for contour in glyph.contours if len(contour.curve)]
    opened = are_open(glyph.arrays.curves).tolist()
    closed, strokes = ([c for c, cut in zip(curves, opened, strict=True) if cut is which] for which in (False, True))
    patches = outline_patch(closed, facecolor=fill, edgecolor=stroke, linewidth=line if stroke != "none" else 0)
    if strokes:
        colour, width = look.open_line(outline.metrics.units_per_em, height)
        colour = "black" if colour == CURRENT else colour
        width *= inches * 72 / height
        patches += outline_patch(
            [cubics[: len(cubics) // 2] for cubics in strokes], facecolor="none", edgecolor=colour, linewidth=width,
            capstyle="round", joinstyle="round",
        )  # fmt: skip
    for patch in patches:
        patch.set_clip_on(False)
        axes.add_patch(patch)
    return saved(figure, kind, dpi)


def write_map(
    glyph: GlyphResult,
    settings: Settings,
    kind: ImageKind,
    maps: Maps = PLAIN_MAPS,
    scale: float | None = None,
) -> bytes:
    """The curvature map as a PNG on white, or as a one-page PDF; see :func:`..svg.curvature_map.write_map`."""
    if scale is None:
        scale = maps.scale_for(glyph.outline.metrics.units_per_em) or curvature_scale([glyph])
    figure = blank(SIZE, SIZE, layout="constrained")
    draw_map(figure.add_subplot(), glyph, maps.comb, scale, maps.corner_teeth)
    for _ in range(LAYOUTS):
        figure.get_layout_engine().execute(figure)
        box = figure.get_tightbbox(figure.canvas.get_renderer())
        if min(box.min) >= EDGE and max(box.max) <= SIZE - EDGE:
            break
    figure.set_layout_engine("none")  # a figure is laid out once more where it is saved
    return saved(figure, kind)


def draw_map(axes: Any, glyph: GlyphResult, combs: Combs, scale: float, in_corners: bool) -> None:
    """Draw the map onto matplotlib axes, y up in font units, with a colour bar in 1/em."""
    from matplotlib.collections import LineCollection

    outline, whose = glyph.outline, shown_by(combs)
    shown = [contour.curve if whose == "result" else contour.source for contour in glyph.contours]
    curves = [contour.cubics() for contour in shown if len(contour)]
    for patch in outline_patch(curves, facecolor=(0, 0, 0, 0.07), edgecolor="black", linewidth=1):
        axes.add_patch(patch)
    drawn = teeth(glyph, scale, whose, in_corners=in_corners)
    for part in drawn:
        colours = [palette()[index + SIDES] for index in colour_classes(part.relative).tolist()]
        strokes = list(np.stack([part.feet, part.tips], axis=1))
        axes.add_collection(LineCollection(strokes, colors=colours, linewidths=0.5))
        axes.plot(*ring(part.tips).T, color="black", alpha=0.45, linewidth=0.3)
        axes.plot(*part.tips[part.cut].T, "k.", markersize=1)
    for part in teeth(glyph, scale, "source") if combs == "both" else ():
        axes.plot(*ring(part.tips).T, color=SOURCE, linewidth=0.6, linestyle=(0, (4, 2)))
    for contour in glyph.contours:
        points = contour.polygon if whose == "result" else contour.source.points[contour.source.offsets]
        axes.plot(*points.T, "k.", markersize=1.8)
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.set_axis_off()
    # A name with dollar signs is not mathematics.
    axes.set_title(f"gid {outline.gid}  {ascii_text(outline.name)}", parse_math=False)
    reach = scale * outline.metrics.units_per_em
    # As wide as the glyph and its comb: letters are 8 points, a line has some 5 inches.
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    columns = int(75 * min(1.0, (right - left) / (top - bottom)))
    place = axes.inset_axes((0.0, -0.05, 1.0, 0.02))
    bar = colour_bar(axes.figure, reach if reach > 0 else 1.0, cax=place, orientation="horizontal")
    bar.ax.tick_params(labelsize=8)
    if columns < 30:
        bar.set_ticks([-reach, reach], labels=[f"{-reach:.3g}", f"{reach:.3g}"], fontsize=6)
    words = f"curvature{legend(combs, sum(int(part.cut.sum()) for part in drawn), reach)}"
    bar.set_label("\n".join(wrap(words, max(columns, 12))), fontsize=8)
