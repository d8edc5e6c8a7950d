"""Grey pictures of glyphs, antialiased by Agg, which matplotlib brings along.

Agg weighs each pixel by the share of it that the outline covers, in 256 steps, under the non-zero rule. Pathops has no
rasteriser, and Pillow draws polygons without antialiasing.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..outlines.contour_arrays import ContourArrays
from ..outlines.outline import Outline
from ..types import FloatArray, IntArray
from ..writers.arrow_columns import arrow


def rasters(outlines: Sequence[Outline], contours: ContourArrays, offsets: IntArray, size: int) -> Any:
    """Pictures of ``size`` by ``size`` pixels of glyphs, as an Arrow array of lists of rows, the first on top.

    The picture is a square of one em: from left to right its middle is that of the advance, from bottom to top that
    between descender and ascender. What is beyond is cut off.

    Args:
        contours: of all outlines; offsets: (G + 1,) where those of each begin.
    """
    from matplotlib.backends.backend_agg import RendererAgg
    from matplotlib.path import Path
    from matplotlib.transforms import Affine2D

    renderer = RendererAgg(size, size, 72)
    context = renderer.new_gc()
    context.set_linewidth(0.0)
    context.set_snap(False)
    pictures = np.zeros((len(outlines), size, size), dtype=np.uint8)
    for g, outline in enumerate(outlines):
        own = contours.part(int(offsets[g]), int(offsets[g + 1]))
        if not own.num_contours:
            continue
        em, metrics = outline.metrics.units_per_em, outline.metrics
        left, bottom = (outline.advance - em) / 2, (metrics.ascender + metrics.descender - em) / 2
        renderer.clear()
        placed = Affine2D().translate(-left, -bottom).scale(size / em)
        renderer.draw_path(context, Path(*_path(own)), placed, (0.0, 0.0, 0.0))
        pictures[g] = np.asarray(renderer.buffer_rgba())[..., 3]
    pa = arrow()
    lines = pa.FixedSizeListArray.from_arrays(pa.array(pictures.ravel()), size)
    return pa.FixedSizeListArray.from_arrays(lines, size)


def _path(contours: ContourArrays) -> tuple[Any, Any]:
    """Vertices and codes of matplotlib's path."""
    move, close = 1, 79
    vertices, codes = list[FloatArray](), list[Any]()
    for c in range(contours.num_contours):
        part = contours.part(c, c + 1)
        vertices += [part.points, part.points[:1], part.points[:1]]
        drawn = np.repeat(part.degrees + 1, part.degrees)  # LINETO 2, CURVE3 3, CURVE4 4
        codes += [[move], drawn, [close]]
    return np.concatenate(vertices), np.concatenate(codes).astype(np.uint8)
