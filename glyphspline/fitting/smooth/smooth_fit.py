"""A glyph's contours through the smooth mode: fitted and measured together, and those again that cross themselves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...interpolation.result import reversed_interpolation, turned
from ...outlines.outline import Contour, Contours
from ...types import FloatArray, IntArray
from ..certified_distance import certified_distance, sharpen_spans
from ..measures import check_coordinates
from ..options import Options
from ..results import ContourResult, Measures
from .canonical_contours import CanonicalContours, canonical_contours
from .forms import AREA, CROSSINGS, CURVATURE, ENERGY, LENGTH, OVERSHOOT, forms
from .refine import Round, refined

SHARPNESS = 0.02
"""The certified bound may exceed the distances seen by this share of the tolerance."""

AGAIN = ((1.0, 3), (0.5, 3), (0.25, 3))
"""For contours that cross themselves: shares of the tolerance, and rounds in which vertices are taken out as well.

Strands of an outline that lie on each other are crossed the less the fewer vertices they have.
"""

NO_POLYGONS = np.empty((0, 2))


def convert_smooth(contours: Sequence[Contour], options: Options, tolerance: float) -> list[ContourResult]:
    """Fit a closed C2 curve to each contour, within ``tolerance`` in font units, and measure it.

    Results that cross themselves where their source did not are fitted again, with fewer vertices and more closely; the
    one with the fewest crossings counts, and is flagged if it has any. Outlines that go back the way they came may keep
    some.

    Raises:
        GlyphsplineError: a contour that cannot be fitted; its ``contour`` is the index in the list.
    """
    if not contours:
        return []
    given = Contours(contours).arrays
    check_coordinates(given)
    canonical = canonical_contours(given)
    source = forms(canonical.cubics, canonical.offsets, NO_POLYGONS, canonical.offsets)
    near = np.full(len(contours), tolerance)
    results: dict[int, ContourResult] = {}
    left = np.arange(len(contours))
    for share, early in ((1.0, None), *AGAIN):
        near[left] = share * tolerance
        kept = refined(canonical, left, options, near, early)
        own = _measured(canonical, left, [kept[k] for k in left.tolist()], source, tolerance)
        for k, measures in zip(left.tolist(), own, strict=True):
            if k not in results or _rank(measures) < _rank(results[k].measures):
                results[k] = _result(contours[k], *kept[k], bool(canonical.flipped[k]), measures)
        left = left[[bool(measures.new_crossings) for measures in own]]
        if len(left) == 0:
            break
    return [results[k] for k in range(len(contours))]


def _rank(measures: Measures) -> tuple[bool, int]:
    """The lower, the better: within the tolerance before all, then few crossings."""
    return not measures.within_tolerance, measures.new_crossings or 0


def _result(contour: Contour, found: Round, i: int, flipped: bool, measures: Measures) -> ContourResult:
    """Part i of a round, in the direction in which the contour was given."""
    points, pieces = found.part(found.points, i), found.part(found.pieces, i)
    if flipped:
        points, pieces = turned(points), pieces[::-1, ::-1]
    curve = Contour(pieces[:, :3].reshape(-1, 2), np.full(len(pieces), 3))
    result = reversed_interpolation(found.found[i]) if flipped else found.found[i]
    return ContourResult(contour, points, (result,), curve, measures)


def _measured(
    canonical: CanonicalContours,
    which: IntArray,
    kept: Sequence[tuple[Round, int]],
    source: FloatArray,
    tolerance: float,
) -> list[Measures]:
    """All that is known of some contours' results."""
    parts = [found.part(found.pieces, i) for found, i in kept]
    offsets = np.cumsum([0] + [len(part) for part in parts])
    polygons = np.concatenate([found.part(found.points, i) for found, i in kept])
    form = forms(np.concatenate(parts), offsets, polygons, offsets)
    change = np.where(canonical.flipped[which], -1, 1) * (form[:, AREA] - source[which, AREA])
    crossings = np.maximum(form[:, CROSSINGS] - source[which, CROSSINGS], 0).astype(int).tolist()
    results = []
    for k, (found, i), row, difference, crossed in zip(
        which.tolist(), kept, form.tolist(), change.tolist(), crossings, strict=True
    ):
        bound, gap = _certificate(canonical, k, found, i, tolerance)
        _, n, iterations, fallbacks, _ = found.found.whole[i].tolist()
        residual = float(found.found.residuals[found.found.residual_offsets[i + 1] - 1])
        results.append(
            Measures(
                vertices=n,
                segments=n,
                numbers=2 * n,
                iterations=iterations,
                residual=residual,
                converged=residual < float(found.found.tolerances[i]),
                rate_bound=float(found.found.rates[i]),
                fallbacks=fallbacks,
                deviation=gap,
                deviation_bound=bound,
                within_tolerance=bound <= tolerance,
                overshoot=row[OVERSHOOT],
                length=row[LENGTH],
                area_change=difference,
                bending_energy=row[ENERGY],
                max_curvature=row[CURVATURE],
                new_crossings=crossed,
            )
        )
    return results


def _certificate(
    canonical: CanonicalContours, k: int, found: Round, i: int, tolerance: float
) -> tuple[float, float]:  # fmt: skip
    """Certified bound, and distance seen, of part i of a round from contour k."""
    measured, start = found.measured, found.offsets[i] + i
    written, outline = found.part(found.written, i), canonical.cubics[slice(*canonical.offsets[k : k + 2])]
    ends = measured.ends[start : start + len(written) + 1]
    bounds, gaps = found.part(measured.bounds, i), found.part(measured.gaps, i)
    bound, gap = sharpen_spans(written, outline, bounds, gaps, ends, SHARPNESS * tolerance)
    if bound <= tolerance:
        return bound, gap
    # Pairing the other way round too is slow, and only seldom better.
    anchors = np.stack([np.arange(len(ends), dtype=np.float64), ends], axis=1)
    other = certified_distance(written, outline, anchors, SHARPNESS * tolerance, tolerance)
    return (other.bound, other.measured) if other.bound < bound else (bound, gap)
