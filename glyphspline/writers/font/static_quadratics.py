"""Glyphs as TrueType stores them, of continuity "g2": from outlines of quadratics, or of cubics."""

from __future__ import annotations

import numpy as np

from ...fitting.results import GlyphResult
from ...fitting.sharp.font_fit import quadratic_points
from ...outlines.outline import Outline
from .font_glyphs import (
    QUADRATIC_SHARE,
    ROUNDING,
    Drawn,
    bounds_of,
    check_size,
    oriented,
    quadratic_glyph,
    simple_glyph,
)


def quadratic_result(result: GlyphResult, tolerance: float) -> Drawn:
    """A glyph as quadratics with as few points as follow it.

    Outlines of lines and quadratics keep what need not change. Where whole units do not have others near enough, each
    cubic becomes some by itself.
    """
    outline = result.outline
    curved = (outline.arrays.degrees > 2).any()
    source = [each for each in (oriented(outline.contours, "ttf") if curved else outline.contours) if len(each)]
    arrays, em = Outline(outline.name, contours=tuple(source)).arrays, outline.metrics.units_per_em
    contours, distance = quadratic_points(arrays, result.options, tolerance, em)
    if distance > tolerance:
        step = max(tolerance - ROUNDING, QUADRATIC_SHARE * tolerance)
        data = quadratic_glyph(source, step, outline.name)
        return Drawn(data, bounds_of(data, []), ROUNDING + step + outline.snapped)
    points = np.concatenate([np.empty((0, 2)), *(points for points, _ in contours)]).astype(np.int64)
    check_size(points.tolist(), outline.name)
    on = np.concatenate([np.empty(0, dtype=np.bool_), *(on for _, on in contours)])
    data = simple_glyph(points, on, (np.cumsum([len(on) for _, on in contours]) - 1).tolist(), False)
    return Drawn(data, bounds_of(data, []), distance + outline.snapped)
