"""``continuity="g2"``: contours as fonts store them, of :mod:`.contours`, measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ....arrays import ascending
from ....compiled import compiled
from ....curves.nearest import near_places
from ....curves.pairing import SHARPNESS, pair_instances
from ....fitting.faithful import Fits
from ....fitting.ladders import SHARP_TRIES
from ....fitting.measures import distance_columns
from ....fitting.options import Options
from ....fitting.results import ConvertedContours, not_fitted
from ....fitting.sharp.corners import find_joints
from ....fitting.sharp.settings import EFFORTS, LONG_LINE, Settings
from ....intrinsics import borrowed, keep_alive
from ....outlines.contour_arrays import ContourArrays, joined, lines_and_cubics, offsets_of
from ....outlines.flaws.bends import bend_findings
from ....outlines.flaws.joints import CONTOUR, PLACE, WHAT, Segments, joint_findings, rows, segment_findings
from ....outlines.flaws.kinds import JUMP, KINDS, KINK, LUMP, THRESHOLDS
from ....outlines.segments import all_cubics, farthest_joint
from ....types import BoolArray, FloatArray, IntArray
from .contours import KEPT, cut_at, fit_contour
from .gates import CORNER, Limits, mixed
from .gates import KINK as KINKED

GATES = (2, 4, KEPT, KEPT + 1, KEPT + 2, KEPT + 2)
"""As how many tries the finding of a check counts, in each round; in the last ones the whole contour is kept."""

TURNING = len(KINDS)
"""Beside the kinds of a check: a joint of curves that turns."""


class Fitted(NamedTuple):
    """Contours fitted, in steps of the grid.

    Attributes:
        cubics: (K, r, 4, 2) in K masters. nodes: (r,) joints of the source at which these begin. offsets: (C + 1,).
    """

    cubics: FloatArray
    nodes: IntArray
    offsets: IntArray


@compiled
def fit_contours(
    cubics: FloatArray, degrees: IntArray, offsets: IntArray, tries: IntArray, settings: Settings, limits: Limits,
    fresh: BoolArray, last: Fitted,
) -> tuple[Fitted, IntArray, FloatArray, BoolArray]:  # fmt: skip
    """All contours (K, m, 4, 2) fitted, each from its own first joint on, if that is still a node.

    Args:
        fresh: (m,) segments whose tries are not those of the last fit. Runs without any stay as they were in it.

    Returns:
        What was fitted; (r,) degrees; (r + C, 2) anchors as in :func:`...curves.pairing.pair_stretches`; (r,) whether
        a segment begins inside a run.
    """
    masters, most, V, count = len(cubics), len(degrees), len(limits.corners), 0
    found, kinds, ends = np.empty((masters, most, 4, 2)), np.empty(most, np.int64), np.zeros(len(offsets), np.int64)
    numbers = np.empty(most, np.int64)
    anchors, inner = np.empty((most + len(offsets), 2)), np.zeros(most, dtype=np.bool_)
    for c in range(len(offsets) - 1):
        a, b = offsets[c], offsets[c + 1]
        m, source, own, held = b - a, cubics[:, a:b].copy(), degrees[a:b], tries[a:b]
        run, types, nodes, k, inside = source, own, np.arange(m + 1), 0, np.zeros(m, dtype=np.bool_)
        if m > 1 and ((held < KEPT).any() or (own == 2).any()):
            joints = find_joints(source, own, settings.near, settings.angle, settings.line, settings.c2)
            cuts = cut_at(joints)
            while k < m and not cuts[k]:
                k += 1
            if k == m:
                k = farthest_joint(source[0, :, 0])
            chain = source
            if k > 0:
                chain = np.concatenate((source[:, k:], source[:, :k]), axis=1)
                own, held = np.roll(own, -k), np.roll(held, -k)
                joints = find_joints(chain, own, settings.near, settings.angle, settings.line, settings.c2)
            old = last.cubics[:, last.offsets[c] : last.offsets[c + 1]]
            at = (last.nodes[last.offsets[c] : last.offsets[c + 1]] - k) % m
            order = ascending(at.astype(np.float64))
            run, types, nodes, inside = fit_contour(
                borrowed(chain), own, borrowed(joints), held, borrowed(limits), np.roll(fresh[a:b], -k),
                old[:, order], at[order],
            )  # fmt: skip
            keep_alive((chain, joints))
        # Back to the first joint of the source, or the next node after it.
        r, first = run.shape[1], 0
        while first < r and nodes[first] + k < m:
            first += 1
        order, end = (first + np.arange(r)) % r, count + r
        found[:, count:end], inner[count:end] = run[:, order], inside[order]
        kinds[count:end], numbers[count:end] = np.where(types[order] == 1, 1, 3), (nodes[order] + k) % m
        anchors[count + c : end + c, 0], places = np.arange(r), anchors[count + c : end + c, 1]
        places[:] = numbers[count:end]
        hints, outline = places.copy(), mixed(limits.corners, source)
        begins = mixed(limits.corners, found[:, count:end])
        alike = np.ones(r, dtype=np.bool_)  # the outline may come by here twice
        for s in range(r):
            for v in range(V):
                here, p = outline[int(hints[s]) * V + v, 0], begins[s * V + v, 0]
                alike[s] = alike[s] and here[0] == p[0] and here[1] == p[1]
        near_places(V, outline, hints, begins, alike, True, 0.0, 0.0, places)
        if places[0] < 0.0:
            places += m
        anchors[end + c, 0], anchors[end + c, 1] = r, places[0] + m
        ends[c + 1] = count = end
    result = Fitted(found[:, :count].copy(), numbers[:count], ends)
    return result, kinds[:count], anchors[: count + len(offsets) - 1], inner[:count]


class FontCurve(NamedTuple):
    """A contour as fonts store it, the same segments in K masters.

    Attributes:
        curves: in each master. fitted: the same on the grid. inner: (r,) whether a segment begins inside a run.
        anchors: (r + 1, 2) places on it and on its source that belong together.
        bounds: (r,) certified distances from the source, of masters in the whole design space. gap: the largest one
            seen; of masters it is not looked for.
    """

    curves: tuple[ContourArrays, ...]
    fitted: Fitted
    inner: BoolArray
    anchors: FloatArray
    bounds: FloatArray
    gap: float

    @property
    def bound(self) -> float:
        """The largest of the bounds."""
        return float(self.bounds.max())


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
    source = sources[0]
    tries = np.zeros(len(source.degrees), dtype=np.int64)
    nothing = Fitted(np.empty((len(sources), 0, 4, 2)), tries[:0], np.zeros(len(source.offsets), dtype=np.int64))
    found = _fitted(sources, tries, tries == 0, nothing, corners, mixes, options, tolerance, share, em)
    expected = []
    for master in sources:
        # Beside points that are rounded, a segment that is kept may be found wrong as if it were rounded too.
        written = findings(master.rounded(options.precision), em)
        expected.append(np.concatenate([findings(master, em), written[~np.isin(written[:, WHAT], (KINK, TURNING))]]))
    for level in GATES:
        wrong, places = np.zeros(len(tries), dtype=np.bool_), [each.anchors for each in found]
        for v, (master, known) in enumerate(zip(sources, expected, strict=True)):
            wrong |= _new_findings(master, known, joined([each.curves[v] for each in found]), places, em)
        for c, each in enumerate(found):
            # Where the source has decimals, fits that were near enough may not be once their ends are rounded too.
            for s in np.flatnonzero(~(each.bounds <= tolerance)).tolist():
                wrong[source.offsets[c] + _stretch(each.anchors[s, 1], each.anchors[s + 1, 1], source, c)] = True
        which = np.unique(np.searchsorted(source.offsets, np.flatnonzero(wrong), side="right") - 1).tolist()
        before = tries.copy()
        tries[wrong] = np.minimum(np.maximum(tries[wrong], level), KEPT + 1)
        for c in which if level > KEPT + 1 else ():
            a, b = source.offsets[c : c + 2]
            tries[a:b] = np.maximum(tries[a:b], KEPT)
        if (tries == before).all():
            break
        own = np.concatenate([np.arange(source.offsets[c], source.offsets[c + 1]) for c in which])
        chosen, parts = [master.chosen(which) for master in sources], [found[c].fitted for c in which]
        last = Fitted(
            np.concatenate([each.cubics for each in parts], axis=1), np.concatenate([each.nodes for each in parts]),
            np.cumsum([0, *(len(each.nodes) for each in parts)]),
        )  # fmt: skip
        fresh = tries[own] != before[own]
        again = _fitted(chosen, tries[own], fresh, last, corners, mixes, options, tolerance, share, em)
        for c, each in zip(which, again, strict=True):
            found[c] = each
    return found


def _fitted(
    sources: Sequence[ContourArrays], tries: IntArray, fresh: BoolArray, last: Fitted, corners: FloatArray,
    mixes: FloatArray, options: Options, tolerance: float, share: float, em: float,
) -> list[FontCurve]:  # fmt: skip
    """Contours fitted and certified.

    Args:
        tries: (m,) of each segment that were in vain; ``KEPT`` and more keep it. fresh, last: see :func:`fit_contours`.
    """
    scale, source, V = 10.0**options.precision, sources[0], len(corners)
    near = scale * share * tolerance
    settings = EFFORTS[options.effort](
        near=near, angle=float(np.radians(options.corner_angle)), line=LONG_LINE * em * scale, c2=False,
        margin=0.0, residual=0.0,
    )  # fmt: skip
    cubics = np.stack([all_cubics(master) for master in sources])
    limits = Limits(near, em * scale, settings.chain_rounds, corners, mixes)
    fitted, degrees, anchors, inner = fit_contours(
        cubics * scale, source.degrees, source.offsets, tries, settings, limits, fresh, last
    )
    offsets = fitted.offsets
    curves = [chains(each / scale, degrees, offsets) for each in fitted.cubics]
    written = np.stack([all_cubics(curve.rounded(options.precision)) for curve in curves])
    ends = offsets + np.arange(len(offsets))
    bounds, gaps = np.full((2, len(inner)), np.nan)
    arcs, sharpness = np.empty((0, 4)), SHARPNESS * tolerance
    if len(sources) > 1:
        own = [runs_of(inner[a:b], anchors[a + c : b + c + 1]) for c, (a, b) in enumerate(pairwise(offsets.tolist()))]
        arcs, sharpness, gaps = np.concatenate(own), 0.0, np.zeros(len(inner))
    pair_instances(
        V, mixed(corners, written), offsets, mixed(corners, cubics), source.offsets, anchors, ends, arcs, sharpness,
        tolerance, bounds, gaps,
    )  # fmt: skip
    if len(sources) > 1:
        gaps[:] = np.nan
    return [
        FontCurve(
            tuple(curve.part(c, c + 1) for curve in curves),
            Fitted(fitted.cubics[:, a:b], fitted.nodes[a:b], np.array([0, b - a])), inner[a:b],
            anchors[a + c : b + c + 1],
            bounds[a:b], float(gaps[a:b].max()),
        )
        for c, (a, b) in enumerate(pairwise(offsets.tolist()))
    ]  # fmt: skip


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
    """(m,) the source's segments where curves have a finding of a kind that these segments have not.

    Of curvature nothing is found in quadratics: it is looked at where the source has none.
    """
    wrong = np.zeros(len(source.degrees), dtype=np.bool_)
    quadratic = np.add.reduceat(source.degrees == 2, source.offsets[:-1]) > 0
    for row in findings(curves, em):
        c, s, what = int(row[CONTOUR]), int(row[PLACE]), row[WHAT]
        if quadratic[c] and what in (JUMP, LUMP):
            continue
        own, m = places[c][:, 1], int(np.diff(source.offsets)[c])
        at_joint = what in (KINK, TURNING, JUMP) or (what == LUMP and row[PLACE] == s)
        low, high = own[s] - (own[-1] - own[-2] if s == 0 else own[s] - own[s - 1]) * at_joint, own[s + 1]
        alike = expected[(expected[:, CONTOUR] == c) & (expected[:, WHAT] == what), PLACE]
        first, last = (own[s], own[s]) if at_joint else (low, high)
        if ((alike - first + 0.5) % m <= last - first + 1.0).any():
            continue
        wrong[source.offsets[c] + _stretch(low, high, source, c)] = True
    return wrong


def _stretch(low: float, high: float, source: ContourArrays, c: int) -> IntArray:
    """The segments of a contour from one place to another."""
    return np.arange(int(np.floor(low + 1e-6)), int(np.ceil(high - 1e-6))) % int(np.diff(source.offsets)[c])


def chains(cubics: FloatArray, degrees: IntArray, offsets: IntArray) -> ContourArrays:
    """Closed chains of lines, of degree 1, and cubics (r, 4, 2) as contours, with offsets (C + 1,)."""
    points, kinds = lines_and_cubics(cubics, degrees == 1)
    return ContourArrays(points, kinds, offsets, offsets_of(kinds)[offsets])
