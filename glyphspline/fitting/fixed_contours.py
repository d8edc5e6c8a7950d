"""One contour's way through the smooth mode by count or by step: sampled, interpolated, measured."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..curves.crossings import overshoot, self_crossings
from ..curves.integrals import shape
from ..errors import GlyphsplineError
from ..interpolation.polygon import LARGEST, clean_polygon
from ..interpolation.result import Interpolation
from ..outlines.outline import Contour
from .fixed_sampling import Fit, fit_even
from .options import Options
from .results import ContourResult, Measures


def convert_contour(contour: Contour, options: Options, tolerance: float) -> ContourResult:
    """Interpolate and measure one contour; ``tolerance``, in font units, is what its distance is compared with."""
    if not np.isfinite(contour.points).all():
        raise GlyphsplineError("the outline has a coordinate that is not finite")
    fit = fit_even(contour, options, tolerance)
    curve = Contour.from_segments(fit.result.spline.to_bezier())
    new = self_crossings(curve.cubics()) - self_crossings(contour.cubics())
    measures = _measures(contour, fit, curve, tolerance, max(new, 0))
    return ContourResult(contour, fit.polygon, (fit.result,), curve, measures)


def _measures(contour: Contour, fit: Fit, curve: Contour, tolerance: float, new_crossings: int) -> Measures:
    """All that is known of one contour's result."""
    arc, distance = fit.result, fit.distance
    pieces = curve.cubics()
    form = shape(pieces)
    return Measures(
        vertices=len(fit.polygon),
        segments=len(curve),
        numbers=2 * len(fit.polygon),
        iterations=arc.iterations,
        residual=arc.max_error,
        converged=arc.converged,
        rate_bound=certified_rate(arc),
        fallbacks=arc.fallbacks,
        deviation=distance.measured if distance else None,
        deviation_bound=distance.bound if distance else None,
        within_tolerance=distance.bound <= tolerance if distance else None,
        length=form.length,
        area_change=form.area - shape(contour.cubics()).area,
        bending_energy=form.bending_energy,
        max_curvature=form.max_curvature,
        overshoot=overshoot(pieces, fit.polygon),
        new_crossings=new_crossings,
    )


def certified_rate(arc: Interpolation) -> float:
    """Factor a step by Theorem 2, or by Theorem 1 for an arc of two spans, whose one free vertex moves alone."""
    alone = not arc.spline.closed and len(arc.parameters) == 3
    return arc.rate_bound / 2 if alone else arc.rate_bound


def check_coordinates(contours: Sequence[Contour]) -> None:
    """Refuse coordinates that are not finite, or too large.

    Raises:
        GlyphsplineError: its ``contour`` is the index in the list.
    """
    if np.abs(np.concatenate([contour.points for contour in contours])).max() < LARGEST / 4:
        return
    for k, contour in enumerate(contours):
        if not np.abs(contour.points).max() < LARGEST / 4:
            try:
                if not np.isfinite(contour.points).all():
                    raise GlyphsplineError("the outline has a coordinate that is not finite")
                clean_polygon(contour.points)
            except GlyphsplineError as error:
                raise error.locate(contour=k) from None
