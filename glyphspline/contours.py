"""One contour's way through the pipeline: fitted in either mode, measured, and fitted again if it crosses itself."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .arrays import FloatArray
from .crossings import overshoot, self_crossings
from .distance import Distance
from .errors import GlyphsplineError
from .fit import fit_smooth
from .glyph import ContourResult, Measures, Options
from .measure import shape
from .outline import Contour
from .result import Interpolation
from .sharp import fit_sharp


def convert_contour(contour: Contour, options: Options, tolerance: float, em: float) -> ContourResult:
    """Fit and measure one contour; ``tolerance`` and ``em`` are in font units.

    A result that crosses itself where its source did not is fitted again more closely, and flagged if that is no cure.
    """
    if not np.isfinite(contour.points).all():
        raise GlyphsplineError("the outline has a coordinate that is not finite")
    crossings = self_crossings(contour.cubics())
    for share in CLOSER:
        fit = _fit(contour, options, share * tolerance, em)
        new = self_crossings(fit.curve.cubics()) - crossings
        if new <= 0 or options.step is not None or options.count is not None:
            break
    return ContourResult(contour, fit.polygon, fit.arcs, fit.curve, _measures(contour, fit, tolerance, max(new, 0)))


CLOSER = (1.0, 0.5, 0.25)
"""Shares of the tolerance tried until a result has no self-crossings of its own."""


class _Fit(NamedTuple):
    """What both modes have in common."""

    polygon: FloatArray
    arcs: tuple[Interpolation, ...]
    curve: Contour
    numbers: int
    distance: Distance | None


def _fit(contour: Contour, options: Options, tolerance: float, em: float) -> _Fit:
    if options.corners == "sharp":
        sharp = fit_sharp(contour, options, tolerance, em)
        arcs = tuple(piece.arc for piece in sharp.pieces if piece.arc is not None)
        return _Fit(sharp.polygon, arcs, sharp.curve, sharp.numbers, sharp.distance)
    smooth = fit_smooth(contour, options, tolerance)
    curve = Contour.from_segments(smooth.result.spline.to_bezier())
    return _Fit(smooth.polygon, (smooth.result,), curve, 2 * len(smooth.polygon), smooth.distance)


def _measures(contour: Contour, fit: _Fit, tolerance: float, new_crossings: int) -> Measures:
    """All that is known of one contour's result. Of several arcs the worst counts, and the most iterations."""
    polygon, arcs, curve, numbers, distance = fit
    pieces = curve.cubics()
    form = shape(pieces)
    return Measures(
        vertices=len(polygon),
        segments=len(curve),
        numbers=numbers,
        iterations=max((arc.iterations for arc in arcs), default=0),
        residual=max((arc.max_error for arc in arcs), default=0.0),
        converged=all(arc.converged for arc in arcs),
        rate_bound=max((certified_rate(arc) for arc in arcs), default=0.0),
        fallbacks=sum(arc.fallbacks for arc in arcs),
        deviation=distance.measured if distance else None,
        deviation_bound=distance.bound if distance else None,
        within_tolerance=distance.bound <= tolerance if distance else None,
        length=form.length,
        area_change=form.area - shape(contour.cubics()).area,
        bending_energy=form.bending_energy,
        max_curvature=form.max_curvature,
        overshoot=overshoot(pieces, polygon),
        new_crossings=new_crossings,
    )


def certified_rate(arc: Interpolation) -> float:
    """Factor a step by Theorem 2, or by Theorem 1 for an arc of two spans, whose one free vertex moves alone."""
    alone = not arc.spline.closed and len(arc.parameters) == 3
    return arc.rate_bound / 2 if alone else arc.rate_bound
