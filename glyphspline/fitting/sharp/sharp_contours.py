"""A glyph's contours through the sharp mode: fitted and measured together, and those again that cross themselves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...interpolation.result import Interpolation
from ...outlines.outline import Contour, Contours
from ..measures import Survey, certified_rate, check_coordinates, survey
from ..options import Options
from ..results import ContourResult, Measures
from .sharp_fit import SharpFit, fit_sharp

CLOSER = (1.0, 0.5, 0.25)
"""Shares of the tolerance tried until a result has no self-crossings of its own."""


def convert_sharp(contours: Sequence[Contour], options: Options, tolerance: float, em: float) -> list[ContourResult]:
    """Fit and measure contours; ``tolerance`` and ``em`` are in font units.

    Results that cross themselves where their source did not are fitted again more closely, and flagged if that is no
    cure.

    Raises:
        GlyphsplineError: a contour that cannot be fitted; its ``contour`` is the index in the list.
    """
    if not contours:
        return []
    check_coordinates(Contours(contours).arrays)
    results: dict[int, ContourResult] = {}
    left = list(range(len(contours)))
    for share in CLOSER:
        if not left:
            break
        own = _contour_results([contours[c] for c in left], options, tolerance, share, em)
        results |= zip(left, own, strict=True)
        left = [c for c in left if results[c].measures.new_crossings]
    return [results[c] for c in range(len(contours))]


def _contour_results(
    contours: Sequence[Contour], options: Options, tolerance: float, share: float, em: float
) -> list[ContourResult]:
    """Contours fitted to within a share of the tolerance, and measured."""
    source = Contours(contours).arrays
    fit = fit_sharp(source, options, share * tolerance, em)
    _, starts, vertices, _ = fit.pieces
    # Where two pieces meet, the vertex belongs to the second one.
    polygons = np.delete(vertices, starts[1:] - 1, axis=0)
    offsets = starts[fit.offsets] - fit.offsets
    curves = Contours(fit.curve)
    measures = _measures(fit, survey(fit.curve, source, polygons, offsets), tolerance)
    return [
        ContourResult(contour, polygons[offsets[c] : offsets[c + 1]], fit.interpolations(c), curves[c], measures[c])
        for c, contour in enumerate(contours)
    ]


def _measures(fit: SharpFit, found: Survey, tolerance: float) -> list[Measures]:
    """All that is known of each contour's result. Of several arcs the worst counts, and the most iterations."""
    spans, first = fit.pieces.where[:, 3], fit.offsets[:-1]
    segments = np.add.reduceat(np.maximum(spans, 1), first)
    numbers = np.add.reduceat(np.where(spans > 0, 2 * spans + 4, 2), first)
    bound, gap = np.maximum.reduceat(fit.bounds, first), np.maximum.reduceat(fit.gaps, first)
    arcs: list[list[Interpolation]] = [[] for _ in first]
    for q, arc in fit.splines.items():
        arcs[fit.pieces.where[q, 0]].append(arc)
    rows = [values.tolist() for values in (segments, numbers, bound, gap, *found)]
    results = []
    for own, segment, number, top, seen, length, change, energy, curvature, beyond, after, before in zip(
        arcs, *rows, strict=True
    ):
        results.append(
            Measures(
                vertices=segment,
                segments=segment,
                numbers=number,
                iterations=max((arc.iterations for arc in own), default=0),
                residual=max((arc.max_error for arc in own), default=0.0),
                converged=all(arc.converged for arc in own),
                rate_bound=max((certified_rate(arc) for arc in own), default=0.0),
                fallbacks=sum(arc.fallbacks for arc in own),
                deviation=seen,
                deviation_bound=top,
                within_tolerance=top <= tolerance,
                length=length,
                area_change=change,
                bending_energy=energy,
                max_curvature=curvature,
                overshoot=beyond,
                new_crossings=max(after - before, 0),
            )
        )
    return results
