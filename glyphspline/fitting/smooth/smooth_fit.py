"""The smooth mode: one closed curve for each contour."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...interpolation.result import Interpolation, reversed_interpolation, turned
from ...outlines.contour_arrays import ContourArrays, Polylines, cubic_contours, offsets_of
from ...types import Views
from ..certified_distance import SHARPNESS, certified_distance, sharpen_spans
from ..faithful import Fits
from ..ladders import SMOOTH_TRIES, TRY_APART
from ..measures import distance_columns, solved_columns
from ..options import Options
from ..results import ConvertedContours
from .canonical_contours import CanonicalContours, canonical_contours
from .refine import Round, refined


def smooth_fits(options: Options, tolerance: float) -> Fits:
    """Fits of a closed C2 curve to each contour, within ``tolerance`` in font units, and then closer."""

    def fit(contours: ContourArrays, attempt: int) -> ConvertedContours:
        share, early = SMOOTH_TRIES[attempt]
        canonical = canonical_contours(contours)
        near = np.full(contours.num_contours, share * tolerance)
        kept = refined(canonical, np.arange(contours.num_contours), options, near, early)
        fits = [kept[k] for k in range(contours.num_contours)]
        return _converted(contours, canonical, fits, tolerance)

    return Fits(len(SMOOTH_TRIES), fit, apart=TRY_APART)


def _converted(
    contours: ContourArrays, canonical: CanonicalContours, kept: Sequence[tuple[Round, int]], tolerance: float
) -> ConvertedContours:
    """Results from rounds: measured in the fitted direction, returned in the given one."""
    flipped = canonical.flipped.tolist()
    points = [found.part(found.trial.points, i) for found, i in kept]
    pieces = [found.part(found.pieces, i) for found, i in kept]
    controls = [found.part(found.found.controls, i) for found, i in kept]
    offsets, closed = offsets_of([len(part) for part in pieces]), np.ones(len(kept), dtype=np.bool_)
    distances = [_certificate(canonical, k, found, i, tolerance) for k, (found, i) in enumerate(kept)]
    bounds, gaps = [bound for bound, _ in distances], [gap for _, gap in distances]
    for n in [n for n, back in enumerate(flipped) if back]:
        points[n], controls[n], pieces[n] = turned(points[n]), turned(controls[n]), pieces[n][::-1, ::-1]

    def arcs() -> list[Interpolation]:
        each = zip(kept, flipped, strict=True)
        return [reversed_interpolation(found.found[i]) if back else found.found[i] for (found, i), back in each]

    curves = cubic_contours(np.concatenate(pieces), offsets)
    polygons = Polylines(np.concatenate(points), offsets, closed)
    return ConvertedContours(
        contours,
        curves,
        polygons,
        Views(len(kept), arcs),
        Polylines(np.concatenate(controls), offsets, closed),
        np.arange(len(kept) + 1),
        solved_columns([(found.found, np.array([i])) for found, i in kept]) | distance_columns(gaps, bounds, tolerance),
    )


def _certificate(canonical: CanonicalContours, k: int, found: Round, i: int, tolerance: float) -> tuple[float, float]:
    """Certified bound, and distance seen, of part i of a round from contour k."""
    trial, start = found.trial, found.trial.offsets[i] + i
    written, outline = found.part(found.written, i), canonical.cubics[slice(*canonical.offsets[k : k + 2])]
    ends = trial.ends[start : start + len(written) + 1]
    bounds, gaps = found.part(trial.bounds, i), found.part(trial.gaps, i)
    bound, gap = sharpen_spans(written, outline, bounds, gaps, ends, SHARPNESS * tolerance)
    if bound <= tolerance:
        return bound, gap
    # Pairing in both directions is slow and seldom better.
    anchors = np.stack([np.arange(len(ends), dtype=np.float64), ends], axis=1)
    other = certified_distance(written, outline, anchors, SHARPNESS * tolerance, tolerance)
    return (other.bound, other.measured) if other.bound < bound else (bound, gap)
