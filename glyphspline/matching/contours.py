"""Which contour of one outline is which of another: assignment by what does not depend on start points and order."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment

from ..curves.integrals import area
from ..errors import GlyphsplineError
from ..outlines.outline import Contour, Outline
from ..types import FloatArray, counted
from .landmarks import STEPS, Landmarks

FLAT = 0.02
"""Share of the area of a circle of the same length below which the sign of a contour's area says nothing."""

FARTHEST = 0.95
"""Largest distance of the features of two contours that are a pair, in the outlines' sizes."""

CORNERS = 0.01
"""Weight of the number of corners: so far apart, in the outlines' sizes, are contours that have one more or less."""


def along_ink(outline: Outline) -> list[Contour]:
    """Contours that have an extent, all reversed if their total signed area is negative."""
    contours = [contour for contour in outline.contours if len(contour) and np.ptp(contour.points, axis=0).any()]
    if sum(area(contour.cubics()) for contour in contours) < 0:
        return [contour.reversed() for contour in contours]
    return contours


def paired_contours(one: Sequence[Landmarks], other: Sequence[Landmarks]) -> list[int]:
    """For each contour of the first outline the index of its partner in the second.

    Raises:
        GlyphsplineError: the numbers of contours differ, the area of a contour turns round, or no assignment is near.
    """
    if len(one) != len(other):
        raise GlyphsplineError(f"the default has {counted(len(one), 'contour')}, that one {len(other)}")
    if not one:
        return []
    mine, its = features(one), features(other)
    costs = ((mine[:, None] - its) ** 2).sum(axis=2)
    _, partners = linear_sum_assignment(costs)
    chosen: list[int] = partners.tolist()
    for i, j in enumerate(chosen):
        signs = [_sign(of) for of in (one[i], other[j])]
        if signs[0] * signs[1] < 0:
            words = ["counter-clockwise" if sign > 0 else "clockwise" for sign in signs]
            raise GlyphsplineError(
                f"it runs {words[0]} in the default, and its partner, contour {j}, {words[1]}, so that its ink flips",
                contour=i,
            )
        if not costs[i, j] < FARTHEST**2:
            raise GlyphsplineError(
                f"no contour there resembles it: its partner, contour {j}, is {costs[i, j] ** 0.5:.2f} of the glyph's"
                f" size away in place, size and shape, more than {FARTHEST:g}",
                contour=i,
            )
    return chosen


def features(contours: Sequence[Landmarks]) -> FloatArray:
    """(n, 7) of each contour: signed size, centre, spread, correlation, corners; lengths in sizes of the outline."""
    every = np.concatenate([of.cubics.reshape(-1, 2) for of in contours])
    low, size = every.min(axis=0), np.ptp(every, axis=0)
    size = np.where(size > 0, size, 1.0)
    rows = []
    for of in contours:
        at = np.arange(len(of.cubics) * STEPS) / STEPS
        points = (of.contour.at(at) - low) / size
        steps = np.hypot(*(np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)).T) + 1e-12
        weights = steps / steps.sum()
        centre = weights @ points
        away = points - centre
        spread = np.sqrt(weights @ (away * away))
        mixed = weights @ (away[:, 0] * away[:, 1])
        signed = area(np.ascontiguousarray(of.cubics)) / (size[0] * size[1])
        rows.append([
            np.copysign(np.sqrt(abs(signed)), signed), *centre, *(2 * spread),
            np.copysign(np.sqrt(abs(mixed)), mixed), CORNERS * len(of.corners),
        ])  # fmt: skip
    return np.array(rows)


def _sign(of: Landmarks) -> int:
    """Of the area: 0 if there is too little to tell."""
    own = area(np.ascontiguousarray(of.cubics))
    return int(np.sign(own)) if abs(own) > FLAT * of.length**2 / (4 * np.pi) else 0
