"""Glyph results made by hand for the writers' tests."""

from __future__ import annotations

import numpy as np

import glyphspline as gs
from glyphspline.types import FloatArray

METRICS = gs.FontMetrics(1000.0, 800.0, -200.0)
L_SHAPE = np.array([[50, 0], [450, 0], [450, 80], [130, 80], [130, 700], [50, 700]], dtype=float)


def circle(radius: float, pieces: int = 32, *, centre: tuple[float, float] = (0.0, 0.0), turn: int = 1) -> FloatArray:
    """A circle as cubics (pieces, 4, 2), counter-clockwise with ``turn`` 1; 32 of them are right to 1e-10 of r."""
    step = turn * 2 * np.pi / pieces
    angle = step * np.arange(pieces + 1)
    on = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    on[-1] = on[0]
    tangent = np.stack([-np.sin(angle), np.cos(angle)], axis=1) * (4 / 3 * np.tan(step / 4) * radius)
    return np.stack([on[:-1], on[:-1] + tangent[:-1], on[1:] - tangent[1:], on[1:]], axis=1) + np.array(centre)


def polygon_contour(points: FloatArray) -> gs.Contour:
    """Straight lines through points (n, 2)."""
    return gs.Contour(points, np.ones(len(points), dtype=np.int64))


def result(
    *curves: gs.Contour, name: str = "A", gid: int = 36, advance: float = 600.0, unicodes: tuple[int, ...] = (65,)
) -> gs.GlyphResult:
    """A glyph whose result is these curves, and whose polygons are their segments' ends."""
    outline = gs.Outline(name, gid, unicodes, advance, curves, METRICS)
    measures = gs.Measures(0, 0, 0, 0, 0.0, True, 0.0, 0)
    contours = tuple(gs.ContourResult(c, c.points[c.offsets], (), c, measures) for c in curves)
    return gs.GlyphResult(outline, gs.Options(), contours)
