"""Closed curves of several masters through points of their outlines, for contours that the search has no curve for.

It moves vertices off the outline, each master's to where they serve best, and finds no places that suit all masters
where a contour has corners. Here the vertices lie on the outline, as in the smooth mode of a single one: at the same
places in all masters, and so on the outline of every instance. How far apart they are laid follows the certificate.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.bezier import evaluate
from ...interpolation.api import interpolate_many
from ...outlines.contour_arrays import offsets_of
from ...types import FloatArray, IntArray
from ..options import Options
from .assembly import ring_bounds
from .corners import Joints
from .cutting import joints_again
from .pieces import ONLY, Pieces
from .spline_curve import chord
from .split_contours import Settings, SplitContours
from .stretches import limit_growth

ROUNDS, MORE = 14, 2
"""Most rounds in which vertices are laid anew; and those after the first that is certified, for fewer vertices."""

MOST = 1000
"""Most vertices of a curve."""

ENOUGH = 0.98
"""Share of the tolerance that each span has to meet: what is put together is certified anew, with other roundings."""

GOAL = 0.7
"""Share of the tolerance for which vertices are laid."""

CLOSER, WIDER = 1 / 3, 1 / 6
"""Powers of a span's error by which its vertices move together or apart. An error is of the fourth order in their
distance where the outline is smooth, and of the first at a corner."""


def on_outline(
    split: SplitContours, c: int, mixes: FloatArray, settings: Settings, options: Options, tolerance: float
) -> Pieces | None:
    """A closed curve through points of contour c, certified in the whole design space; None if there is none.

    Args:
        mixes: (V, K) weights of the masters at the corners of the design space's grid.
    """
    cubics = split.cubics[:, split.offsets[c] : split.offsets[c + 1]]
    masters, m = cubics.shape[:2]
    source, size = np.einsum("vk,kmpc->vmpc", mixes, cubics), np.sqrt(masters)
    samples, step, spacing = spacings_of(joints_again(split, c, settings))
    if split.flipped[c]:
        samples, step, spacing = m - samples[::-1], step[::-1].copy(), spacing[::-1].copy()
    best, left = None, ROUNDS
    while left > 0:
        left -= 1
        places = even_places(samples, step, spacing)
        if len(places) > MOST:
            break
        segments = places.astype(np.int64)
        vertices = np.stack([evaluate(own[segments], places - segments) for own in cubics])
        polygon = vertices.swapaxes(0, 1).reshape(-1, 2 * masters) / size
        (found,) = interpolate_many(
            [polygon], options.variant, threads=1, margin=options.margin, max_iterations=options.max_iterations,
            residual_tolerance=options.solver_tolerance,
        )  # fmt: skip
        curve = found.spline.to_bezier().reshape(-1, 4, masters, 2).transpose(2, 0, 1, 3) * size
        bounds = ring_bounds(source, np.einsum("vk,kmpc->vmpc", mixes, curve), places, ENOUGH * tolerance)
        if bounds.max() <= ENOUGH * tolerance:
            if best is None:
                left = min(left, MORE)
            if best is None or len(places) < len(best.places):
                best = _piece(c, m, places, vertices)
        own = np.searchsorted(places, (samples[:-1] + samples[1:]) / 2, side="right") - 1
        ratio = (bounds / (GOAL * tolerance))[own].clip(0.05, 20.0)
        spacing /= np.where(ratio > 1, ratio**CLOSER, ratio**WIDER)
    return best


def _piece(c: int, m: int, places: FloatArray, vertices: FloatArray) -> Pieces:
    masters, k = vertices.shape[:2]
    where: IntArray = np.array([[c, 0, m, k, 1, ONLY]])
    return Pieces(where, offsets_of([k]), vertices, places, np.zeros((masters, 1, 2, 2)), np.zeros(1))


@compiled
def spacings_of(joints: Joints) -> tuple[FloatArray, FloatArray, FloatArray]:
    """(N,) places of a contour's samples, (N - 1,) their distances and (N - 1,) wanted distances of vertices."""
    n = len(joints.places) - 1
    step = np.empty(n)
    for r in range(n):
        step[r] = chord(joints.samples, r, r + 1)
    return joints.places.copy(), step, joints.spacing.copy()


@compiled
def even_places(samples: FloatArray, step: FloatArray, spacing: FloatArray) -> FloatArray:
    """(k,) ascending places of a contour, 0 the first, at the wanted distances, which grow no faster than chords may;
    four at least.

    Args:
        samples: (n + 1,) places once round. step: (n,) their distances. spacing: (n,) wanted distances of vertices.
    """
    n = len(step)
    limit_growth(spacing, step, 1)
    total = 0.0
    for r in range(n):
        total += step[r] / spacing[r]
    k = max(int(np.ceil(total)), 4)
    places, reached, i = np.empty(k), 0.0, 0 * k
    for r in range(n):
        more = step[r] / spacing[r] * k / total
        while i < k and i < reached + more:
            places[i] = samples[r] + (i - reached) / more * (samples[r + 1] - samples[r])
            i += 1
        reached += more
    return places[:i]
