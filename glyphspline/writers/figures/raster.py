"""The curvature map as PNG or PDF, drawn by matplotlib, which is imported on first use."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...fitting.results import GlyphResult
from ..svg.appearance import Whose
from ..svg.colours import class_colour, colour_classes
from ..svg.curvature_map import LONGEST, Teeth, curvature_scale, teeth
from .images import ImageKind, blank, saved
from .patches import ascii_text, colour_bar, outline_patch

SIZE = 6.0
"""Width and height of the figure in inches."""


def map_image(
    glyph: GlyphResult,
    kind: ImageKind,
    *,
    comb: Whose = "result",
    scale: float | None = None,
    vertices: bool = True,
    in_corners: bool = False,
) -> bytes:
    """The curvature map as a PNG on white, or as a one-page PDF; the others as for :func:`to_curvature_svg`."""
    scale = curvature_scale([glyph]) if scale is None else scale
    figure = blank(SIZE, SIZE, layout="constrained")
    draw_map(figure.add_subplot(), glyph, comb, scale, vertices, in_corners)
    return saved(figure, kind)


def draw_map(axes: Any, glyph: GlyphResult, whose: Whose, scale: float, vertices: bool, in_corners: bool) -> None:
    """Draw the map onto matplotlib axes, y up in font units, with a colour bar in 1/em."""
    outline = glyph.outline
    shown = [contour.curve if whose == "result" else contour.source for contour in glyph.contours]
    curves = [contour.cubics() for contour in shown if len(contour)]
    for patch in outline_patch(curves, facecolor=(0, 0, 0, 0.07), edgecolor="black", linewidth=1):
        axes.add_patch(patch)
    for part in teeth(glyph, scale, whose, in_corners=in_corners):
        _draw_teeth(axes, part)
    if vertices:
        for contour in glyph.contours:
            points = contour.polygon if whose == "result" else contour.source.points[contour.source.offsets]
            axes.plot(*points.T, "k.", markersize=1.8)
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.set_axis_off()
    # A name with dollar signs is not mathematics.
    axes.set_title(f"gid {outline.gid}  {ascii_text(outline.name)}", parse_math=False)
    reach = scale * outline.metrics.units_per_em
    bar = colour_bar(axes.figure, reach if reach > 0 else 1.0, ax=axes, location="bottom", shrink=0.5, aspect=40)
    bar.set_label(f"curvature of the {whose} in 1/em, convex positive; dots: cut at {LONGEST * reach:.3g}")


def _draw_teeth(axes: Any, part: Teeth) -> None:
    from matplotlib.collections import LineCollection

    colours = [class_colour(index) for index in colour_classes(part.relative).tolist()]
    axes.add_collection(LineCollection(list(np.stack([part.feet, part.tips], axis=1)), colors=colours, linewidths=0.5))
    closed = np.concatenate([part.tips, part.tips[:1]])
    axes.plot(*closed.T, color="black", alpha=0.45, linewidth=0.3)
    axes.plot(*part.tips[part.cut].T, "k.", markersize=1)
