"""Masters of a glyph out of outlines whose points do not correspond: single fonts of a family, say.

Contours are paired by what does not depend on start points and order, then their landmarks; whole contours are aligned
from a sure pair of these (:mod:`.alignment`), and all masters are cut where any has a joint (:mod:`.cuts`). Every
master keeps its outline.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment

from ..curves.integrals import area
from ..errors import GlyphsplineError, OptionError
from ..outlines.contour_arrays import lines_and_cubics
from ..outlines.masters import DesignAxis, MasterContour, Masters
from ..outlines.outline import Contour, Outline
from ..types import FloatArray, counted
from .cuts import common_cuts, cut
from .landmarks import STEPS, Landmarks

MOST_COST = 0.7
"""Cost of a pair of contours, a landmark, from which they are not taken for the same."""


FARTHEST = 0.95
"""Largest distance of the features of two contours that are a pair, in the outlines' sizes."""


def match_masters(
    outlines: Sequence[Outline], locations: Sequence[Mapping[str, float]], axes: Sequence[DesignAxis]
) -> Masters:
    """Outlines of one glyph, whose points need not correspond, as masters of a design space.

    Args:
        outlines: K of them, of at least two; where the units per em differ, all are scaled to those of the default.
        locations: of the outlines, axis tag to user-space value; axes that are not given are at their default.
        axes: of the design space. The masters are at the default and, along one axis, at any places that include its
            ends; along several axes, at ends of single axes.

    Returns:
        The masters, the default first, the others in the order given. Contours are in the default's order, start where
        its do, and run counter-clockwise around ink. Segments that are lines in all masters are lines, the others
        cubics. Their outlines are those given, but for segments of no length.

    Raises:
        OptionError: the locations are no such design space.
        GlyphsplineError: the outlines cannot be matched; the error says why, and names the contour of the default.
    """
    regions, order = _regions(locations, axes)
    first = outlines[order[0]]
    em = first.metrics.units_per_em
    try:
        contours, scales = _matched([outlines[k] for k in order], [locations[k] for k in order], em)
    except GlyphsplineError as error:
        raise error.locate(glyph=first.name) from None
    advances = np.array([outlines[k].advance for k in order]) * scales
    codes = sorted({code for outline in outlines for code in outline.unicodes})
    return Masters(first.name, first.gid, tuple(codes), tuple(axes), regions, contours, advances, first.metrics)


def _matched(
    outlines: Sequence[Outline], locations: Sequence[Mapping[str, float]], em: float
) -> tuple[list[MasterContour], FloatArray]:
    """The contours in all masters, the default first, and the scales of the outlines."""
    scales = np.array([em / outline.metrics.units_per_em for outline in outlines])
    masters = []
    for scale, outline in zip(scales.tolist(), outlines, strict=True):
        contours = [contour for contour in outline.contours if len(contour) and np.ptp(contour.points, axis=0).any()]
        if sum(area(contour.cubics()) for contour in contours) < 0:  # all counter-clockwise around ink
            contours = [contour.reversed() for contour in contours]
        masters.append([Landmarks(Contour(c.points * scale, c.degrees), em) for c in contours])
    parts = [[own.contour] for own in masters[0]]
    for other, location in zip(masters[1:], locations[1:], strict=True):
        try:
            partners = _paired(masters[0], other)
            parts = [_with(own, other[j], i) for i, (own, j) in enumerate(zip(parts, partners, strict=True))]
        except GlyphsplineError as error:
            place = " ".join([f"{tag}={value:g}" for tag, value in location.items()])
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


def _regions(locations: Sequence[Mapping[str, float]], axes: Sequence[DesignAxis]) -> tuple[FloatArray, list[int]]:
    """(K - 1, A, 3) regions of the masters but the default, and the order of all: the default first."""
    tags = [axis.tag for axis in axes]
    if len(locations) < 2:
        raise OptionError("a design space has two masters or more")
    for location in locations:
        for tag in location:
            if tag not in tags:
                raise OptionError(f"no axis {tag!r}: there are {', '.join(tags)}")
    peaks = np.array(
        [[axis.normalised(location.get(axis.tag, axis.default)) for axis in axes] for location in locations]
    )
    at_default = np.flatnonzero(~peaks.any(axis=1))
    if len(at_default) != 1:
        raise OptionError(f"one master is at the default of all axes, not {len(at_default)}")
    others = [k for k in range(len(locations)) if k != at_default[0]]
    regions = np.zeros((len(others), len(axes), 3))
    for row, k in enumerate(others):
        along = np.flatnonzero(peaks[k])
        if len(along) > 1:
            raise OptionError(f"a master leaves the default along one axis, not {len(along)}: {dict(locations[k])}")
        a = int(along[0])
        side = np.sign(peaks[k, a])
        own = np.sort(np.abs(peaks[others, a][peaks[others, a] * side > 0]))
        at = abs(float(peaks[k, a]))
        if own[-1] != 1 or (len(axes) > 1 and len(own) > 1) or (own == at).sum() > 1:
            raise OptionError(
                f"axis {tags[a]} has one master at each end but its default, and others only if there is no other axis"
            )
        low, high = own[own < at], own[own > at]
        region = [low[-1] if len(low) else 0.0, at, high[0] if len(high) else 1.0]
        regions[row, a] = region if side > 0 else [-x for x in region[::-1]]
    return regions, [int(at_default[0]), *others]
