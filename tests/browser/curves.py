"""Path data of a page against that of a drawing, which has a decimal less."""

from __future__ import annotations

import numpy as np

from tests.topology import path_contours, svg_contours


def off(data: str, svg: str) -> float:
    """How far the points of path data are from those of a drawing, at most; infinite if they are other segments."""
    shown, drawn = path_contours(data), svg_contours(svg)
    if [[len(piece) for piece in pieces] for pieces in shown.contours] != [
        [len(piece) for piece in pieces] for pieces in drawn.contours
    ]:
        return np.inf
    ours, theirs = (
        np.array([point for pieces in each.contours for piece in pieces for point in piece]) / each.unit
        for each in (shown, drawn)
    )
    return float(np.abs(ours - theirs).max())
