"""The drawing of a glyph as PNG or PDF, drawn by matplotlib, which is imported on first use."""

from __future__ import annotations

import io
from typing import Literal

from ...fitting.results import GlyphResult
from ..svg.appearance import CURRENT, PLAIN, Appearance
from ..svg.document import STROKE, shown_box
from ..svg.path_data import Box, curves_data
from .patches import UNDATED, outline_patch

Kind = Literal["png", "pdf"]

HEIGHT = 6.0
"""Height in inches of a drawing that says none."""

DPI = 200.0
"""Pixels an inch of a PNG. A height in px is that many pixels."""

LARGEST = 8000.0
"""Maximum width and height of a PNG in pixels; a larger one has fewer an inch."""


def drawing_image(glyph: GlyphResult, kind: Kind, look: Appearance = PLAIN, ink: Box | None = None) -> bytes:
    """What :func:`..svg.document.to_svg` draws, as a one-page PDF or as a PNG on white.

    Args:
        glyph: a result of :func:`glyphspline.convert`. kind: of the file.
        look: its height is 6 inches unless it says another; "currentColor" is black.
        ink: the box around the glyph's curves, if it is known.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    outline = glyph.outline
    left, bottom, right, top = shown_box(
        outline, ink or curves_data(glyph.arrays.curves, glyph.options.precision)[0].box, look.view_box
    )
    width, height = max(right - left, 1.0), max(top - bottom, 1.0)  # as view_box_value has it
    inches = look.inches(HEIGHT)
    figure = Figure(figsize=(inches * width / height, inches))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(left, left + width), ylim=(bottom, bottom + height))
    axes.set_axis_off()
    fill, stroke = ("black" if colour == CURRENT else colour for colour in (look.fill, look.stroke))
    line = STROKE * outline.metrics.units_per_em * inches * 72 / height
    curves = [contour.curve.cubics() for contour in glyph.contours if len(contour.curve)]
    for patch in outline_patch(curves, facecolor=fill, edgecolor=stroke, linewidth=line if stroke != "none" else 0):
        patch.set_clip_on(False)
        axes.add_patch(patch)
    file = io.BytesIO()
    if kind == "pdf":
        figure.savefig(file, format="pdf", metadata=UNDATED)
    else:
        dpi = 96.0 if str(look.size).endswith("px") else DPI
        dpi = min(dpi, LARGEST / (inches * max(1.0, width / height)))
        figure.savefig(file, format="png", dpi=dpi, metadata={"Software": None})
    return file.getvalue()
