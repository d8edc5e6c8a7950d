"""``continuity="g2"``: contours as fonts store them, of :mod:`.fit.contours`, measured."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ....curves.pairing import SHARPNESS, pair_instances
from ....fitting.faithful import Fits
from ....fitting.first_good import first_good
from ....fitting.ladders import SHARP_TRIES
from ....fitting.measures import distance_columns
from ....fitting.options import Options
from ....fitting.results import ConvertedContours, not_fitted
from ....fitting.sharp.settings import EFFORTS, LONG_LINE, SharpSettings
from ....outlines.contour_arrays import ContourArrays, joined, lines_and_cubics, offsets_of
from ....outlines.flaws.bends import bend_findings
from ....outlines.flaws.joints import CONTOUR, PLACE, WHAT, Segments, joint_findings, rows, segment_findings
from ....outlines.flaws.kinds import JUMP, KINDS, KINK, LUMP, THRESHOLDS
from ....outlines.segments import all_cubics
from ....types import BoolArray, FloatArray, IntArray
from .contours import Fitted, fit_contour
from .gates import CORNER, FitLimits, mixed
from .gates import KINK as KINKED
from .tries import KEPT

LEVELS = (2, 4, KEPT, KEPT + 1, KEPT + 2, KEPT + 2, KEPT + 2)
"""As how many tries the finding of a check counts, in each fit; in the last ones the whole contour is kept."""

TURNING = len(KINDS)
"""Beside the kinds of a check: a joint of curves that turns."""


class FontCurve(NamedTuple):
    """A contour as fonts store it, the same segments in K masters.

    Attributes:
        curves: in each master. fitted: the same on the grid.
        bounds: (r,) certified distances from the source, of masters in the whole design space. gap: the largest one
            seen; of masters it is not looked for.
    """

    curves: tuple[ContourArrays, ...]
    fitted: Fitted
    bounds: FloatArray
    gap: float

    @property
    def inner(self) -> BoolArray:
        """(r,) whether a segment begins inside a run."""
        return self.fitted.inner

    @property
    def anchors(self) -> FloatArray:
        """(r + 1, 2) places on it and on its source that belong together."""
        return self.fitted.anchors

    @property
    def bound(self) -> float:
        """The largest of the bounds."""
        return float(self.bounds.max())


NOWHERE = np.empty(0)

ONE = np.ones((1, 1))
"""The weights of a single outline, which is its only master."""


def font_fits(options: Options, tolerance: float, em: float) -> Fits:
    """Fits within ``tolerance``, and then closer; it and ``em`` are in font units."""

    def fit(contours: ContourArrays, attempt: int) -> ConvertedContours:
        found = fit_for_fonts([contours], ONE, ONE, options, tolerance, SHARP_TRIES[attempt], em)
        result = not_fitted(contours, joined([each.curves[0] for each in found]))
        distances = distance_columns([each.gap for each in found], [each.bound for each in found], tolerance)
        return replace(result, measures={**result.measures, **distances})

    return Fits(len(SHARP_TRIES), fit, keeps_crossing=True)


def fit_for_fonts(
    sources: Sequence[ContourArrays], corners: FloatArray, mixes: FloatArray, options: Options, tolerance: float,
    share: float, em: float,
) -> list[FontCurve]:  # fmt: skip
    """Contours in K masters fitted to within a share of the tolerance; where a check finds in a master what it does not
    find in the source, segments stay as they are.

    Args:
        corners: (V, K) weights of the masters at the corners of the design space's grid. mixes: (M, K) those with which
            joints are looked at.
    """
    scale = 10.0**options.precision
    settings = EFFORTS[options.effort](
        near=scale * share * tolerance, angle=float(np.radians(options.corner_angle)), line=LONG_LINE * em * scale,
        c2=False, margin=0.0, residual=0.0,
    )  # fmt: skip
    limits = FitLimits(settings.near, em * scale, settings.chain_rounds, corners, mixes)
    wanted = FontSources(sources, settings, limits, options.precision, tolerance, em)
    return first_good(wanted.fits(), lambda fit: (int((fit.again != fit.tries).sum()),)).curves


class FontFit(NamedTuple):
    """Curves of all contours, the tries of each of the m segments that were in vain before, and those that are now."""

    curves: list[FontCurve]
    tries: IntArray
    again: IntArray


class FontSources(NamedTuple):
    """Contours in K masters that are to be fitted for fonts.

    Attributes:
        settings, limits: in steps of the grid. precision: decimals. tolerance, em: in font units.
    """

    sources: Sequence[ContourArrays]
    settings: SharpSettings
    limits: FitLimits
    precision: int
    tolerance: float
    em: float

    def fits(self) -> Iterator[FontFit]:
        """Fits: of all contours, and then of those again in which segments of the last one are wrong."""
        source, expected = self.sources[0], [self.expected(master) for master in self.sources]
        tries = np.zeros(len(source.degrees), dtype=np.int64)
        curves = self.fitted(self.sources, tries, tries == 0, None)
        for level in LEVELS:
            wrong = self.wrong(curves, expected)
            which = np.unique(np.searchsorted(source.offsets, np.flatnonzero(wrong), side="right") - 1).tolist()
            again = tries.copy()
            again[wrong] = np.minimum(np.maximum(tries[wrong], level), KEPT + 1)
            for c in which if level > KEPT + 1 else ():
                a, b = source.offsets[c : c + 2]
                again[a:b] = np.maximum(again[a:b], KEPT)
            yield FontFit(curves, tries, again)
            own = np.concatenate([np.arange(source.offsets[c], source.offsets[c + 1]) for c in which])
            chosen, last = [master.chosen(which) for master in self.sources], [curves[c].fitted for c in which]
            new = dict(zip(which, self.fitted(chosen, again[own], again[own] != tries[own], last), strict=True))
            curves, tries = [new.get(c, each) for c, each in enumerate(curves)], again

    def expected(self, master: ContourArrays) -> FloatArray:
        """The findings of a master, which its fit may have too."""
        # Beside points that are rounded, a segment that is kept may be found wrong as if it were rounded too.
        written = findings(master.rounded(self.precision), self.em)
        return np.concatenate([findings(master, self.em), written[~np.isin(written[:, WHAT], (KINK, TURNING))]])

    def wrong(self, curves: Sequence[FontCurve], expected: Sequence[FloatArray]) -> BoolArray:
        """(m,) the segments of the sources where curves have a finding that is not expected, or are too far off."""
        source, places = self.sources[0], [each.anchors for each in curves]
        wrong = np.zeros(len(source.degrees), dtype=np.bool_)
        for v, (master, known) in enumerate(zip(self.sources, expected, strict=True)):
            wrong |= _new_findings(master, known, joined([each.curves[v] for each in curves]), places, self.em)
        for c, each in enumerate(curves):
            # Where the source has decimals, fits that were near enough may not be once their ends are rounded too.
            for s in [] if each.bound <= self.tolerance else np.flatnonzero(~(each.bounds <= self.tolerance)).tolist():
                wrong[source.offsets[c] + _stretch(each.anchors[s, 1], each.anchors[s + 1, 1], source, c)] = True
        return wrong

    def fitted(
        self, sources: Sequence[ContourArrays], tries: IntArray, fresh: BoolArray, last: Sequence[Fitted] | None
    ) -> list[FontCurve]:
        """Some of the contours fitted and certified.

        Args:
            tries: (m,) of each segment that were in vain; ``KEPT`` and more keep it. fresh, last: see
                :func:`fit_contour`.
        """
        scale, source, (*_, corners, _) = 10.0**self.precision, sources[0], self.limits
        cubics, fits = np.stack([all_cubics(master) for master in sources]), []
        for c, (a, b) in enumerate(pairwise(source.offsets.tolist())):
            own, old = np.ascontiguousarray(scale * cubics[:, a:b]), None if last is None else last[c]
            fits.append(fit_contour(own, source.degrees[a:b], tries[a:b], self.settings, self.limits, fresh[a:b], old))
        fitted, nodes, kinds, inner, anchors = zip(*fits, strict=True)
        degrees, offsets = np.concatenate(kinds), offsets_of(list(map(len, nodes)))
        ends = offsets + np.arange(len(offsets))
        curves = [chains(each / scale, degrees, offsets) for each in np.concatenate(fitted, axis=1)]
        written = np.stack([all_cubics(curve.rounded(self.precision)) for curve in curves])
        bounds, gaps = np.full((2, len(degrees)), np.nan)
        arcs, sharpness = np.empty((0, 4)), SHARPNESS * self.tolerance
        if len(sources) > 1:
            arcs, sharpness, gaps = np.concatenate(list(map(runs_of, inner, anchors))), 0.0, np.zeros(len(degrees))
        pair_instances(
            len(corners), (mixed(corners, written), offsets), (mixed(corners, cubics), source.offsets),
            (np.concatenate(anchors), ends), arcs, sharpness, self.tolerance, bounds, gaps,
        )  # fmt: skip
        if len(sources) > 1:
            gaps[:] = np.nan
        return [
            FontCurve(tuple(curve.part(c, c + 1) for curve in curves), fits[c], bounds[a:b], float(gaps[a:b].max()))
            for c, (a, b) in enumerate(pairwise(offsets.tolist()))
        ]


def runs_of(inner: BoolArray, anchors: FloatArray) -> FloatArray:
    """(r, 4) of each segment of a contour the places where its run begins and ends, on it and on its source."""
    r, starts = len(inner), np.flatnonzero(~inner)
    if not len(starts):
        return np.tile([-np.inf, np.inf], (r, 2))
    lap = anchors[-1] - anchors[0]
    laps = np.concatenate([anchors[starts[-1:]] - lap, anchors[starts], anchors[starts[:1]] + lap])
    k = np.searchsorted(starts, np.arange(r), side="right")
    return np.stack([laps[k, 0], laps[k + 1, 0], laps[k, 1], laps[k + 1, 1]], axis=1)


def findings(contours: ContourArrays, em: float) -> FloatArray:
    """(n, 7) what a check finds at joints, in segments and bends, see :data:`.flaws.joints.WHAT`; as ``TURNING``
    the joints of curves that turn as kinks do, also those that a check takes for rounding's."""
    cubics, limits = all_cubics(contours), THRESHOLDS.limits(em)
    segments = Segments.of(cubics, contours)
    line = segments.degrees == 1
    sizes = np.abs(np.angle(segments.last[segments.before].conj() * segments.first))
    joints = np.flatnonzero((sizes > KINKED) & (sizes < CORNER) & ~(line & line[segments.before]))
    c = np.searchsorted(segments.offsets, joints, side="right") - 1
    turning = rows(TURNING, c, joints - segments.offsets[c], 0.0)
    lumps = rows(LUMP, *bend_findings(cubics, contours, limits.lump, limits.lump_height, limits.corner_angle).T)
    return np.concatenate([joint_findings(segments, limits), segment_findings(segments, limits), lumps, turning])


def _new_findings(
    source: ContourArrays, expected: FloatArray, curves: ContourArrays, places: Sequence[FloatArray], em: float
) -> BoolArray:
    """(m,) the source's segments where curves have a finding of a kind that these segments have not."""
    # Of curvature nothing is found in quadratics: it is looked at where the source has none.
    wrong, counts = np.zeros(len(source.degrees), dtype=np.bool_), np.diff(source.offsets).tolist()
    quadratic = (np.add.reduceat(source.degrees == 2, source.offsets[:-1]) > 0).tolist()
    order = np.lexsort((expected[:, WHAT], expected[:, CONTOUR]))
    ordered = expected[order]
    changes = np.flatnonzero((np.diff(ordered[:, (CONTOUR, WHAT)], axis=0) != 0.0).any(axis=1)) + 1
    known = {(own[0, CONTOUR], own[0, WHAT]): own[:, PLACE] for own in np.split(ordered, changes) if len(own)}
    for row in findings(curves, em).tolist():
        c, s, what = int(row[CONTOUR]), int(row[PLACE]), row[WHAT]
        if quadratic[c] and what in (JUMP, LUMP):
            continue
        own, m, alike = places[c][:, 1], counts[c], known.get((row[CONTOUR], what), NOWHERE)
        at_joint = what in (KINK, TURNING, JUMP) or (what == LUMP and row[PLACE] == s)
        low, high = own[s] - (own[-1] - own[-2] if s == 0 else own[s] - own[s - 1]) * at_joint, own[s + 1]
        first, last = (own[s], own[s]) if at_joint else (low, high)
        if not ((alike - first + 0.5) % m <= last - first + 1.0).any():
            wrong[source.offsets[c] + _stretch(low, high, source, c)] = True
    return wrong


def _stretch(low: float, high: float, source: ContourArrays, c: int) -> IntArray:
    """The segments of a contour from one place to another."""
    return np.arange(int(np.floor(low + 1e-6)), int(np.ceil(high - 1e-6))) % int(np.diff(source.offsets)[c])


def chains(cubics: FloatArray, degrees: IntArray, offsets: IntArray) -> ContourArrays:
    """Closed chains of lines, of degree 1, and cubics (r, 4, 2) as contours, with offsets (C + 1,)."""
    points, kinds = lines_and_cubics(cubics, degrees == 1)
    return ContourArrays(points, kinds, offsets, offsets_of(kinds)[offsets])
