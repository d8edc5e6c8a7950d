"""Masters of a glyph out of outlines whose points do not correspond: single fonts of a family, say.

Contours are paired by what does not depend on start points and order, then their landmarks; whole contours are aligned
from a sure pair of these (:mod:`.alignment`), and all masters are cut where any has a joint (:mod:`.cuts`). Every
master keeps its outline.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment

from ....curves.integrals import area
from ....errors import GlyphsplineError
from ....outlines.contour_arrays import lines_and_cubics
from ....outlines.masters import DesignAxis, MasterContour, Masters
from ....outlines.outline import Contour, Outline
from ....types import FloatArray, counted
from .cuts import common_cuts, cut
from .landmarks import STEPS, Landmarks

MOST_COST = 0.7
"""Cost of a pair of contours, a landmark, from which they are not taken for the same."""


FARTHEST = 0.95
"""Largest distance of the features of two contours that are a pair, in the outlines' sizes."""


def match_masters(outlines: Sequence[Outline], values: Sequence[float], axis: DesignAxis) -> Masters:
    """Outlines of one glyph, whose points need not correspond, as masters along an axis.

    Args:
        outlines: K of them, of at least two; where the units per em differ, all are scaled to those of the default.
        values: of the outlines on the axis, each another one. The axis's default and its ends are among them.

    Returns:
        The masters, the default first, the others in the order given. Contours are in the default's order, start where
        its do, and run counter-clockwise around ink. Segments that are lines in all masters are lines, the others
        cubics. Their outlines are those given, but for segments of no length.

    Raises:
        GlyphsplineError: the outlines cannot be matched; the error says why, and names the contour of the default.
    """
    order = sorted(range(len(values)), key=lambda k: values[k] != axis.default)  # the default first
    first = outlines[order[0]]
    em = first.metrics.units_per_em
    try:
        contours, scales = _matched([outlines[k] for k in order], [f"{axis.tag}={values[k]:g}" for k in order], em)
    except GlyphsplineError as error:
        raise error.locate(glyph=first.name) from None
    advances = np.array([outlines[k].advance for k in order]) * scales
    codes = sorted({code for outline in outlines for code in outline.unicodes})
    at = [axis.normalised(values[k]) for k in order]
    # A region ends at the masters beside it, or at an end of the axis.
    regions = [(max([y for y in at if y < x], default=x), x, min([y for y in at if y > x], default=x)) for x in at[1:]]
    tents = np.array(regions).reshape(-1, 1, 3)
    return Masters(first.name, first.gid, tuple(codes), (axis,), tents, contours, advances, first.metrics)


def _matched(outlines: Sequence[Outline], places: Sequence[str], em: float) -> tuple[list[MasterContour], FloatArray]:
    """The contours in all masters, the default first, and the scales of the outlines; ``places`` are for errors."""
    scales = np.array([em / outline.metrics.units_per_em for outline in outlines])
    masters = []
    for scale, outline in zip(scales.tolist(), outlines, strict=True):
        contours = [contour for contour in outline.contours if len(contour) and np.ptp(contour.points, axis=0).any()]
        if sum(area(contour.cubics()) for contour in contours) < 0:  # all counter-clockwise around ink
            contours = [contour.reversed() for contour in contours]
        masters.append([Landmarks(Contour(c.points * scale, c.degrees), em) for c in contours])
    parts = [[own.contour] for own in masters[0]]
    for other, place in zip(masters[1:], places[1:], strict=True):
        try:
            partners = _paired(masters[0], other)
            parts = [_with(own, other[j], i) for i, (own, j) in enumerate(zip(parts, partners, strict=True))]
        except GlyphsplineError as error:
            raise GlyphsplineError(f"unlike the master at {place}: {error.message}", contour=error.contour) from None
    together = []
    for own in parts:  # a segment that is a line in all masters is one
        lines = np.all([contour.degrees == 1 for contour in own], axis=0)
        together.append(MasterContour(*lines_and_cubics(np.stack([contour.cubics() for contour in own]), lines)))
    return together, scales


def _paired(one: Sequence[Landmarks], other: Sequence[Landmarks]) -> list[int]:
    """For each contour of the first outline the index of its partner in the second.

    Raises:
        GlyphsplineError: the numbers of contours differ, the area of a contour turns round, or no assignment is near.
    """
    if len(one) != len(other):
        raise GlyphsplineError(f"the default has {counted(len(one), 'contour')}, that one {len(other)}")
    if not one:
        return []
    mine, its = _features(one), _features(other)
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


def _features(contours: Sequence[Landmarks]) -> FloatArray:
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
        # A corner more or less counts as a distance of 0.01 outlines' sizes.
        rows.append([
            np.copysign(np.sqrt(abs(signed)), signed), *centre, *(2 * spread),
            np.copysign(np.sqrt(abs(mixed)), mixed), 0.01 * len(of.corners),
        ])  # fmt: skip
    return np.array(rows)


def _sign(of: Landmarks) -> int:
    """Of the area: 0 if there is too little to tell."""
    own = area(np.ascontiguousarray(of.cubics))
    # Share of the area of a circle of the same length below which the sign of a contour's area says nothing.
    return int(np.sign(own)) if abs(own) > 0.02 * of.length**2 / (4 * np.pi) else 0


def _with(parts: Sequence[Contour], other: Landmarks, index: int) -> list[Contour]:
    """One contour in one more master: those before it are cut like the default, the first of them."""
    u, v, cost = common_cuts(Landmarks(parts[0], other.em), other)
    if not cost < MOST_COST:
        raise GlyphsplineError(
            f"their corners resemble each other too little: they cost {cost:.2f} each, more than {MOST_COST:g}",
            contour=index,
        )
    return [*(cut(contour, u) for contour in parts), cut(other.contour, v)]
