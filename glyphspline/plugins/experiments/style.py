"""How figures look: one typeface, and colours that print in grey, each of its own lightness."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import AbstractContextManager
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from ...curves.curvature import Comb
from ...types import FloatArray
from ...writers.figures.basics import outline_patch, ring
from . import PEERS, VARIANTS

INK = "#1f2933"
GREY = "#9aa5b1"
SHADES = "#7a1f12", "#2a5caa", "#239478", "#e3a11a", "#9d7cc1"
COLOURS = dict(zip(VARIANTS, SHADES, strict=True))
MARKERS = dict(zip(VARIANTS, "xos^D", strict=True))
DASHES: dict[str, Any] = dict(zip(PEERS, ("-", (0, (5, 1.5)), (0, (3, 1.5)), (0, (1, 1))), strict=True))
"""Of peers, whose lines are grey."""

TOOTH, CUT_AT = 0.014, 3.5
"""Length in em of a tooth at the scale of a figure's curvature maps, and of the longest one in units of the scale."""

DOTTED = (0, (1, 1.5))

Box = tuple[float, float, float, float]
"""x from, x to, y from, y to."""


@cache
def style() -> Any:
    """The settings of matplotlib for figures."""
    from matplotlib import rc_params_from_file

    return rc_params_from_file(Path(__file__).with_name("figures.mplstyle"), use_default_template=False)


def styled() -> AbstractContextManager[None]:
    """The style while figures are drawn and saved."""
    from matplotlib import rc_context

    found: AbstractContextManager[None] = rc_context(style())
    return found


def line_of(method: str) -> dict[str, Any]:
    """Colour, marker and dashes of a method's line."""
    if method in COLOURS:
        return {"color": COLOURS[method], "marker": MARKERS[method]}
    return {"color": GREY, "ls": DASHES[method]}


def draw_closed(axes: Any, points: FloatArray, **how: Any) -> None:
    """A closed polyline."""
    axes.plot(*ring(points).T, **how)


def fill(axes: Any, curves: Iterable[FloatArray], shade: str, edge: str, width: float = 0.8) -> None:
    """Closed curves, each of cubics (m, 4, 2), as one filled path, holes left out."""
    for patch in outline_patch(curves, facecolor=shade, edgecolor=edge, linewidth=width):
        axes.add_artist(patch)  # not "add_patch", which looks for the limits of what is drawn: those are set


def draw_comb(axes: Any, teeth: Comb, colour: str, length: float, longest: float) -> None:
    """A curvature map: all teeth, of ``length`` |κ| on the convex side and cut at ``longest``, and the curve."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Line

    tips = teeth.points - np.clip(length * teeth.curvature, -longest, longest)[:, None] * teeth.normals
    strokes = np.stack([teeth.points, tips], axis=1).reshape(-1, 2)
    path = Line(strokes, np.tile([Line.MOVETO, Line.LINETO], len(tips)))
    axes.add_artist(PathPatch(path, facecolor="none", edgecolor=colour, linewidth=0.3, alpha=0.6))
    draw_closed(axes, tips, color=colour, lw=0.5)
    draw_closed(axes, teeth.points, color=INK, lw=0.8)


def mark(axes: Any, box: Box) -> None:
    """The dotted rectangle around what is zoomed."""
    from matplotlib.patches import Rectangle

    x0, x1, y0, y1 = box
    axes.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, fill=False, ls=DOTTED, lw=0.9, ec=INK, zorder=5))


def zoomed(axes: Any, box: Box) -> None:
    """Show the box only, in a thin dotted frame."""
    axes.set(xlim=box[:2], ylim=box[2:], xticks=[], yticks=[], aspect="equal")
    axes.grid(False)
    for side in axes.spines.values():
        side.set(visible=True, color=GREY, linestyle=DOTTED)


def bare(axes: Any, margin: float = 0.03) -> None:
    """Equal units, no frame."""
    axes.set_aspect("equal")
    axes.margins(margin)
    axes.axis("off")


def letter(axes: Any, text: str) -> None:
    """A subfigure's label, below it as in the paper."""
    axes.text(0.5, -0.04, text, transform=axes.transAxes, ha="center", va="top", fontsize=8.5)


def small(png: bytes) -> bytes:
    """A PNG with a palette of its own: a third of the bytes, and nothing to be seen."""
    from PIL import Image

    file = BytesIO()
    with Image.open(BytesIO(png)) as drawn:
        few = drawn.convert("RGB").quantize(256, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    few.save(file, format="png")
    return file.getvalue()
