"""The drawing of a glyph as PNG or PDF, drawn by matplotlib, which is imported on first use."""

from __future__ import annotations

from ...fitting.results import GlyphResult
from ..svg.appearance import CURRENT, PLAIN, Appearance
from ..svg.document import STROKE, em_box, shown_box
from ..svg.path_data import Box, curves_data
from .images import DPI, ImageKind, blank, saved
from .patches import outline_patch

HEIGHT = 6.0
"""Height in inches of a drawing that says none."""

PX = 96.0
"""Pixels an inch of a PNG whose height is in px, which is then that many pixels."""

LARGEST = 8000.0
"""Maximum width and height of a PNG in pixels; a larger one has fewer an inch."""


def drawing_image(glyph: GlyphResult, kind: ImageKind, look: Appearance = PLAIN, ink: Box | None = None) -> bytes:
    """What :func:`..svg.document.to_svg` draws, as a one-page PDF or as a PNG on white.

    Args:
        glyph: a result of :func:`glyphspline.convert`. kind: of the file.
        look: without a size the drawing is 6 inches high; "currentColor" is black.
        ink: the box around the glyph's curves, if it is known.
    """
    outline = glyph.outline
    left, bottom, right, top = shown_box(
        em_box(outline), ink or curves_data(glyph.arrays.curves, glyph.options.precision)[0].box, look.view_box
    )
    width, height = max(right - left, 1.0), max(top - bottom, 1.0)  # as view_box_value has it
    inches = look.inches(height, outline.metrics.units_per_em, HEIGHT)
    figure = blank(inches * width / height, inches)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(left, left + width), ylim=(bottom, bottom + height))
    axes.set_axis_off()
    fill, stroke = ("black" if colour == CURRENT else colour for colour in (look.fill, look.stroke))
    line = STROKE * outline.metrics.units_per_em * inches * 72 / height
    curves = [contour.curve.cubics() for contour in glyph.contours if len(contour.curve)]
    for patch in outline_patch(curves, facecolor=fill, edgecolor=stroke, linewidth=line if stroke != "none" else 0):
        patch.set_clip_on(False)
        axes.add_patch(patch)
    dpi = PX if str(look.size or look.em).endswith("px") else DPI
    return saved(figure, kind, min(dpi, LARGEST / (inches * max(1.0, width / height))))
