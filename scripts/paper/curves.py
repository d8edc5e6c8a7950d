"""Figs. 6 to 9: curves of variants 1, 2 and 3 side by side, with zooms of the marked parts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Rectangle

import glyphspline as gs
from glyphspline.curves.curvature import comb
from glyphspline.types import FloatArray

from .common import COLOURS, GREY, INK

VARIANTS = (1, 2, 3)
Box = tuple[float, float, float, float]
"""x from, x to, y from, y to."""


def interpolate_variants(polygons: Sequence[FloatArray], tolerance: float) -> dict[int, list[gs.Interpolation]]:
    """Variants 1, 2 and 3 through each polygon."""
    return {v: gs.interpolate_many(polygons, v, residual_tolerance=tolerance) for v in VARIANTS}


def draw_comb(axes: Axes, spline: gs.Spline, colour: str, scale: float, longest: float, spacing: float) -> None:
    """A curvature map: teeth of length ``scale`` |κ| on the convex side, cut at ``longest``, and their outline."""
    teeth = comb(spline.to_bezier(), spacing)
    ends = teeth.points - np.clip(scale * teeth.curvature, -longest, longest)[:, None] * teeth.normals
    lines = list(np.stack([teeth.points, ends], axis=1))
    axes.add_collection(LineCollection(lines, colors=colour, linewidths=0.35, alpha=0.55))
    axes.plot(*ends.T, color=colour, lw=0.6, alpha=0.9)
    axes.plot(*teeth.points.T, color=INK, lw=0.9)


def mark(axes: Axes, box: Box) -> None:
    """The dotted rectangle around what is zoomed."""
    x0, x1, y0, y1 = box
    axes.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, fill=False, ls=(0, (1, 1.5)), lw=0.9, ec=INK, zorder=5))


def zoomed(axes: Axes, box: Box) -> None:
    """Show the box only, in a thin frame."""
    axes.set(xlim=box[:2], ylim=box[2:], xticks=[], yticks=[], aspect="equal")
    axes.grid(False)
    for side in axes.spines.values():
        side.set(visible=True, color=GREY, linestyle=(0, (1, 1.5)))


def colour(variant: int) -> str:
    """The variant's colour."""
    return COLOURS[f"variant {variant}"]
