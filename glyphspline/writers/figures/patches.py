"""Outlines and combs as matplotlib patches, and the colour bar. Matplotlib is imported on first use."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ...types import FloatArray
from ..svg.colours import SIDES, class_colour, colour_classes
from ..svg.curvature_map import Teeth


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
    for index in range(-SIDES, SIDES + 1):
        some = strokes[classes == index]
        if len(some):
            path = Path(some.reshape(-1, 2), np.tile([Path.MOVETO, Path.LINETO], len(some)))
            patches.append(PathPatch(path, facecolor="none", edgecolor=class_colour(index), linewidth=width))
    tips = [np.concatenate([t.tips, t.tips[:1]]) if closed else t.tips for t in parts]
    codes = [code for part in tips for code in (Path.MOVETO, *[Path.LINETO] * (len(part) - 1))]
    ends = Path(np.concatenate(tips), codes)
    return [*patches, PathPatch(ends, facecolor="none", edgecolor="black", alpha=0.4, linewidth=0.7 * width)]


def colour_bar(figure: Any, reach: float, **place: Any) -> Any:
    """A bar of the colour classes from -``reach`` to ``reach`` in 1/em; ``place`` as for ``Figure.colorbar``."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize

    colours = ListedColormap([class_colour(index) for index in range(-SIDES, SIDES + 1)])
    return figure.colorbar(ScalarMappable(Normalize(-reach, reach), colours), **place)
