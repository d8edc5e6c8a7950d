"""Strokes as outlines, by Skia (the extra ``drawings``)."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from ....extras import need
from .booleans import SIZE, draw, path_of, simplified
from .lengths import LENGTH, Lengths
from .painted import Shape
from .styles import Style


def stroke_of(shape: Shape, style: Style, width: float, lengths: Lengths) -> Shape:
    """The stroke of a shape's path, as wide in its units, as a shape to be filled."""
    need("drawings")
    import pathops

    points = np.concatenate([subpath.points for subpath in shape.path])
    extent = float(np.ptp(points, axis=0).max()) + width
    scale, area = 2.0 ** round(math.log2(SIZE / extent)), pathops.Path()
    for subpath in shape.path:
        draw(area, [(x * scale, y * scale) for x, y in subpath.points], subpath)
    caps = {"round": pathops.LineCap.ROUND_CAP, "square": pathops.LineCap.SQUARE_CAP}
    joins = {"round": pathops.LineJoin.ROUND_JOIN, "bevel": pathops.LineJoin.BEVEL_JOIN}
    limit = LENGTH.fullmatch(style["stroke-miterlimit"])
    dashes, offset = dashes_of(style, lengths)
    area.stroke(
        width * scale,
        caps.get(style["stroke-linecap"].lower(), pathops.LineCap.BUTT_CAP),
        joins.get(style["stroke-linejoin"].lower(), pathops.LineJoin.MITER_JOIN),
        float(limit[1]) if limit else 4.0,
        [dash * scale for dash in dashes] or None,
        offset * scale,
    )
    path = path_of(_simple(area))
    for subpath in path:
        subpath.points = [(x / scale, y / scale) for x, y in subpath.points]
    return replace(shape, path=path)


def dashes_of(style: Style, lengths: Lengths) -> tuple[list[float], float]:
    """The lengths of dashes and gaps, an even count, and where in them a path begins; none if it is solid."""
    text = style["stroke-dasharray"].replace(",", " ")
    found = [lengths.of(word) for word in text.split()]
    dashes = [dash for dash in found if dash is not None]
    if len(dashes) < len(found) or min(dashes, default=0.0) < 0 or not sum(dashes) > 0:
        return [], 0.0
    return dashes * (1 + len(dashes) % 2), lengths.of(style["stroke-dashoffset"]) or 0.0


def _simple(area: Any) -> Any:
    """An area without overlaps; as it is where Skia finds no result."""
    import pathops

    try:
        return simplified(area)
    except pathops.PathOpsError:
        return area
