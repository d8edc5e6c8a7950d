"""The smooth mode: one closed curve for each contour. Contours whose curves cross themselves are fitted again."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...interpolation.result import Interpolation, reversed_interpolation, turned
from ...outlines.contour_arrays import ContourArrays, Polylines, cubic_contours, offsets_of
from ...types import Views
from ..certified_distance import SHARPNESS, certified_distance, sharpen_spans
from ..measures import check_coordinates, distance_columns, geometric_columns, solved_columns
from ..options import Options
from ..results import ConvertedContours, assembled
from .canonical_contours import CanonicalContours, canonical_contours
from .refine import Round, refined

AGAIN = ((1.0, 3), (0.5, 3), (0.25, 3))
"""For contours that cross themselves: shares of the tolerance, and rounds in which vertices are taken out as well.

Strands of an outline that lie on each other are crossed the less the fewer vertices they have.
"""


def convert_smooth(contours: ContourArrays, options: Options, tolerance: float) -> ConvertedContours:
    """Fit a closed C2 curve to each contour, within ``tolerance`` in font units, and measure it.

    Results that cross themselves where their source did not are fitted again, with fewer vertices and more closely; the
    one with the fewest crossings counts, and is flagged if it has any. Outlines that go back the way they came may keep
    some.

    Raises:
        GlyphsplineError: a contour that cannot be fitted; its ``contour`` is the index.
    """
    check_coordinates(contours)
    canonical = canonical_contours(contours)
    near = np.full(contours.num_contours, tolerance)
    best: dict[int, tuple[ConvertedContours, int]] = {}
    left = np.arange(contours.num_contours)
    for share, early in ((1.0, None), *AGAIN):
        if len(left) == 0:
            break
        near[left] = share * tolerance
        kept = refined(canonical, left, options, near, early)
        own = _converted(contours, canonical, left.tolist(), [kept[k] for k in left.tolist()], tolerance)
        for j, k in enumerate(left.tolist()):
            if k not in best or _rank(own, j) < _rank(*best[k]):
                best[k] = own, j
        left = left[np.array(own.measures["new_crossings"]) > 0]
    return assembled([best[k] for k in range(contours.num_contours)])


def _rank(found: ConvertedContours, k: int) -> tuple[bool, int]:
    """Lower is better: first within the tolerance, then the number of crossings."""
    return not found.measures["within_tolerance"][k], found.measures["new_crossings"][k]


def _converted(
    contours: ContourArrays,
    canonical: CanonicalContours,
    which: list[int],
    kept: Sequence[tuple[Round, int]],
    tolerance: float,
) -> ConvertedContours:
    """Results for some contours from their rounds: measured in the fitted direction, returned in the given one."""
    flipped = canonical.flipped[which].tolist()
    points = [found.part(found.trial.points, i) for found, i in kept]
    pieces = [found.part(found.pieces, i) for found, i in kept]
    controls = [found.part(found.found.controls, i) for found, i in kept]
    offsets, closed = offsets_of([len(part) for part in pieces]), np.ones(len(kept), dtype=np.bool_)
    geometry = geometric_columns(
        cubic_contours(np.concatenate(pieces), offsets),
        cubic_contours(canonical.cubics, canonical.offsets).chosen(which),
        Polylines(np.concatenate(points), offsets, closed),
    )
    changes = zip(geometry["area_change"], flipped, strict=True)
    geometry["area_change"] = [-change if back else change for change, back in changes]
    distances = [_certificate(canonical, k, found, i, tolerance) for k, (found, i) in zip(which, kept, strict=True)]
    bounds, gaps = [bound for bound, _ in distances], [gap for _, gap in distances]
    for n in [n for n, back in enumerate(flipped) if back]:
        points[n], controls[n], pieces[n] = turned(points[n]), turned(controls[n]), pieces[n][::-1, ::-1]

    def arcs() -> list[Interpolation]:
        each = zip(kept, flipped, strict=True)
        return [reversed_interpolation(found.found[i]) if back else found.found[i] for (found, i), back in each]

    return ConvertedContours(
        contours.chosen(which),
        cubic_contours(np.concatenate(pieces), offsets),
        Polylines(np.concatenate(points), offsets, closed),
        Views(len(which), arcs),
        Polylines(np.concatenate(controls), offsets, closed),
        np.arange(len(which) + 1),
        solved_columns([(found.found, np.array([i])) for found, i in kept])
        | distance_columns(gaps, bounds, tolerance)
        | geometry,
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
