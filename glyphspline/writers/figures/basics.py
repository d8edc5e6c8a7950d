"""Figures of matplotlib, which is imported on first use: their bytes as PNG, PDF or SVG, outlines and combs as patches.

The same figure gives the same bytes.
"""

from __future__ import annotations

import io
from collections.abc import Iterable
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from ...files import replacing
from ...outlines.masters import Masters
from ...outlines.outline import Outline
from ...types import FloatArray
from ..settings import FigureKind
from ..svg.comb import SIDES, Teeth, colour_classes, palette

DPI = 200.0
"""Pixels an inch of a PNG that says none."""

UNDATED = {"CreationDate": None, "Producer": None, "Creator": None}
"""Metadata of a PDF: without dates and versions the same input gives the same bytes."""

PAGE = (8.27, 11.69)
"""A4 in inches."""

OUTLINE: dict[str, Any] = {"facecolor": "0.93", "edgecolor": "black", "linewidth": 0.5}
"""Of pages."""


def blank(width: float, height: float, **how: Any) -> Any:
    """A figure of a size in inches, without pyplot and its state; ``how`` as for ``Figure``."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), **how)
    FigureCanvasAgg(figure)
    return figure


def saved(figure: Any, kind: FigureKind, dpi: float = DPI) -> bytes:
    """The figure as a PNG of ``dpi`` pixels an inch, as a one-page PDF, or as an SVG."""
    from matplotlib import rc_context

    how: dict[FigureKind, dict[str, Any]] = {
        "png": {"dpi": dpi, "metadata": {"Software": None}},
        "pdf": {"metadata": UNDATED},
        "svg": {"metadata": {"Date": None, "Creator": None}},
    }
    file = io.BytesIO()
    with rc_context({"svg.hashsalt": "glyphspline"}):  # the names of an SVG's parts
        figure.savefig(file, format=kind, **how[kind])
    return file.getvalue()


def write_pages(path: FilePath, figures: Iterable[Any]) -> int:
    """Write figures as the pages of a PDF, which is replaced when it is complete; their number.

    One page is held in memory at a time. The same figures give the same bytes.
    """
    from matplotlib.backends.backend_pdf import PdfPages

    count = 0
    with replacing(path) as file, PdfPages(file, metadata=UNDATED) as pages:
        for figure in figures:
            pages.savefig(figure)
            count += 1
    return count


def ascii_text(text: str) -> str:
    """The text with "?" for what the fonts of matplotlib may lack."""
    return text.encode("ascii", "replace").decode()


def outline_patch(curves: Iterable[FloatArray], **style: Any) -> list[Any]:
    """Curves, each of cubics (m, 4, 2), as one patch, so that counters stay open; [] if there are none."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    shown = [cubics for cubics in curves if len(cubics)]
    if not shown:
        return []
    points = np.concatenate([part for cubics in shown for part in (cubics[0, :1], cubics[:, 1:].reshape(-1, 2))])
    codes = [code for cubics in shown for code in (Path.MOVETO, *[Path.CURVE4] * (3 * len(cubics)))]
    return [PathPatch(Path(points, codes), **style)]


def comb_patches(drawn: Iterable[Teeth], *, closed: bool = True, width: float = 0.3) -> list[Any]:
    """Teeth as one patch per colour, which keeps files small, and the lines through their tips."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    parts = [part for part in drawn if len(part.feet)]
    if not parts:
        return []
    strokes = np.stack([np.concatenate([t.feet for t in parts]), np.concatenate([t.tips for t in parts])], axis=1)
    classes = colour_classes(np.concatenate([t.relative for t in parts]))
    patches = []
    for index, colour in enumerate(palette(), -SIDES):
        some = strokes[classes == index]
        if len(some):
            path = Path(some.reshape(-1, 2), np.tile([Path.MOVETO, Path.LINETO], len(some)))
            patches.append(PathPatch(path, facecolor="none", edgecolor=colour, linewidth=width))
    tips = [ring(t.tips) if closed else t.tips for t in parts]
    codes = [code for part in tips for code in (Path.MOVETO, *[Path.LINETO] * (len(part) - 1))]
    ends = Path(np.concatenate(tips), codes)
    return [*patches, PathPatch(ends, facecolor="none", edgecolor="black", alpha=0.4, linewidth=0.7 * width)]


def colour_bar(figure: Any, reach: float, **place: Any) -> Any:
    """A bar of the colour classes from -``reach`` to ``reach`` in 1/em; ``place`` as for ``Figure.colorbar``."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize

    return figure.colorbar(ScalarMappable(Normalize(-reach, reach), ListedColormap(palette())), **place)


def ring(points: FloatArray) -> FloatArray:
    """Points (n, 2), and the first one again."""
    return np.concatenate([points, points[:1]])


def headed(heading: str, caption: str, size: tuple[float, float] = PAGE) -> Any:
    """A page with a heading, and a line in small print below it; ``size`` in inches."""
    figure = blank(*size)
    figure.text(0.05, 1 - 0.39 / size[1], ascii_text(heading), fontsize=11, weight="bold", parse_math=False)
    figure.text(0.05, 1 - 0.53 / size[1], caption, fontsize=7, color="0.35", parse_math=False)
    return figure


def colour_legend(
    figure: Any, place: tuple[float, float, float, float], reach: float, words: str = " in 1/em, convex positive"
) -> None:
    """The colours of curvature up to ``reach`` in 1/em, at a place of the page: left, bottom, width and height."""
    bar = colour_bar(figure, reach, cax=figure.add_axes(place), orientation="horizontal")
    bar.set_label(f"curvature{words}", fontsize=6)
    bar.ax.tick_params(labelsize=6)


def glyph_label(of: Outline | Masters) -> str:
    """Index, name and characters of a glyph."""
    return f"gid {of.gid}  {of.name[:40]}  {' '.join(f'U+{code:04X}' for code in of.unicodes[:2])}"
