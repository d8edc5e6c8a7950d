"""``continuity="g2"``: contours as fonts store them, of :mod:`.font_curves`, measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...checks.kinds import JUMP, KINK, THRESHOLDS
from ...checks.segments import CONTOUR, PLACE, WHAT, Segments, joint_findings, rows, segment_findings
from ...compiled import compiled
from ...curves.cubics import turns
from ...curves.nearest import near_places
from ...curves.pairing import SHARPNESS, pair_instances
from ...outlines.contour_arrays import ContourArrays, joined, offsets_of
from ...outlines.masters import quadratics
from ...outlines.segments import all_cubics, farthest_joint
from ...types import BoolArray, FloatArray, IntArray
from ..faithful import Fits
from ..ladders import SHARP_TRIES
from ..measures import distance_columns
from ..options import Options
from ..results import ConvertedContours, not_fitted
from .corners import NO_HANDLE, find_joints
from .font_curves import KEPT, cut_at, fit_contour
from .font_quadratics import Stored
from .font_quadratics import fit_contour as fit_quadratics
from .run_gates import CORNER, Limits, mixed
from .run_gates import KINK as KINKED
from .settings import EFFORTS, LONG_LINE, Settings

GATES = (2, 4, KEPT, KEPT + 1, KEPT + 1)
"""As how many tries the finding of a check counts, in each round; beyond ``KEPT`` the contour stays as it is."""


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
        if m > 1 and (held < KEPT).any():
            joints = find_joints(source, own, settings)
            cuts = cut_at(joints)
            while k < m and not cuts[k]:
                k += 1
            if k == m:
                k = farthest_joint(source[0, :, 0])
            chain = source
            if k > 0:
                chain = np.concatenate((source[:, k:], source[:, :k]), axis=1)
                own, held = np.roll(own, -k), np.roll(held, -k)
                joints = find_joints(chain, own, settings)
            old, n = last.cubics[:, last.offsets[c] : last.offsets[c + 1]], last.offsets[c + 1] - last.offsets[c]
            before, at = np.empty((masters, n, 4, 2)), (last.nodes[last.offsets[c] : last.offsets[c + 1]] - k) % m
            order = np.argsort(at)
            for v in range(masters):
                for s in range(n):
                    before[v, s] = old[v, order[s]]
            run, types, nodes, inside = fit_contour(
                chain, own, joints, held, limits, np.roll(fresh[a:b], -k), before, at[order]
            )
        # Back to the first joint of the source, or the next node after it.
        r, first = run.shape[1], 0
        while first < r and nodes[first] + k < m:
            first += 1
        for s in range(r):
            q = (first + s) % r
            for v in range(masters):
                found[v, count + s] = run[v, q]
            kinds[count + s], inner[count + s] = 1 if types[q] == 1 else 3, inside[q]
            numbers[count + s] = (nodes[q] + k) % m
            anchors[count + c + s, 0], anchors[count + c + s, 1] = s, (nodes[q] + k) % m
        places = anchors[count + c : count + c + r, 1]
        hints, outline = places.copy(), mixed(limits.corners, source)
        begins = mixed(limits.corners, found[:, count : count + r])
        alike = np.ones(r, dtype=np.bool_)  # the outline may come by here twice
        for s in range(r):
            for v in range(V):
                here, p = outline[int(hints[s]) * V + v, 0], begins[s * V + v, 0]
                alike[s] = alike[s] and here[0] == p[0] and here[1] == p[1]
        near_places(V, outline, hints, begins, alike, True, 0.0, 0.0, places)
        if places[0] < 0.0:
            places += m
        anchors[count + c + r, 0], anchors[count + c + r, 1] = r, places[0] + m
        count += r
        ends[c + 1] = count
    result = Fitted(found[:, :count].copy(), numbers[:count], ends)
    return result, kinds[:count], anchors[: count + len(offsets) - 1], inner[:count]


class FontCurve(NamedTuple):
    """A contour as fonts store it, the same segments in K masters.

    Attributes:
        curves: in each master. fitted: the same on the grid. inner: (r,) whether a segment begins inside a run.
        anchors: (r + 1, 2) places on it and on its source that belong together.
        bound: certified distance from the source, of masters in the whole design space. gap: the largest one seen; of
            masters it is not looked for.
    """

    curves: tuple[ContourArrays, ...]
    fitted: Fitted
    inner: BoolArray
    anchors: FloatArray
    bound: float
    gap: float


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
        written = _findings(master.rounded(options.precision), em)
        expected.append(np.concatenate([_findings(master, em), written[written[:, WHAT] != KINK]]))
    for level in GATES:
        wrong, places = np.zeros(len(tries), dtype=np.bool_), [each.anchors for each in found]
        for v, (master, known) in enumerate(zip(sources, expected, strict=True)):
            wrong |= _new_findings(master, known, joined([each.curves[v] for each in found]), places, em)
        outside = [c for c, each in enumerate(found) if not each.bound <= tolerance]
        for c in outside:
            wrong[source.offsets[c] : source.offsets[c + 1]] = True
        which = np.unique(np.searchsorted(source.offsets, np.flatnonzero(wrong), side="right") - 1).tolist()
        before = tries.copy()
        tries[wrong] = np.minimum(np.maximum(tries[wrong], level), KEPT)
        for c in which if level > KEPT else outside:
            tries[source.offsets[c] : source.offsets[c + 1]] = KEPT
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
        tries: (m,) of each segment that were in vain; ``KEPT`` keeps it. fresh, last: see :func:`fit_contours`.
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
            float(bounds[a:b].max()), float(gaps[a:b].max()),
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


def _findings(contours: ContourArrays, em: float) -> FloatArray:
    """(n, 7) what a check finds at joints and in segments, see :data:`...checks.segments.WHAT`; and as kinks joints of
    curves that turn less, which a check takes for rounding's."""
    segments, limits = Segments.of(all_cubics(contours), contours), THRESHOLDS.limits(em)
    line = segments.degrees == 1
    sizes = np.abs(np.angle(segments.last[segments.before].conj() * segments.first))
    joints = np.flatnonzero((sizes > KINKED) & (sizes < CORNER) & ~(line & line[segments.before]))
    c = np.searchsorted(segments.offsets, joints, side="right") - 1
    turning = rows(KINK, c, joints - segments.offsets[c], 0.0)
    found = np.concatenate([joint_findings(segments, limits), segment_findings(segments, limits), turning])
    return found[found[:, WHAT] != JUMP]


def _new_findings(
    source: ContourArrays, expected: FloatArray, curves: ContourArrays, places: Sequence[FloatArray], em: float
) -> BoolArray:
    """(m,) the source's segments where curves have a finding of a kind that these segments have not."""
    wrong = np.zeros(len(source.degrees), dtype=np.bool_)
    for row in _findings(curves, em):
        c, s = int(row[CONTOUR]), int(row[PLACE])
        own, m = places[c][:, 1], int(np.diff(source.offsets)[c])
        low, high = own[s] - (own[-1] - own[-2] if s == 0 else own[s] - own[s - 1]) * (row[WHAT] == KINK), own[s + 1]
        alike = expected[(expected[:, CONTOUR] == c) & (expected[:, WHAT] == row[WHAT]), PLACE]
        first, last = (own[s], own[s]) if row[WHAT] == KINK else (low, high)
        if ((alike - first + 0.5) % m <= last - first + 1.0).any():
            continue
        wrong[source.offsets[c] + np.arange(int(np.floor(low + 1e-6)), int(np.ceil(high - 1e-6))) % m] = True
    return wrong


DENSER = 4.0
"""How much finer a source of cubics is sampled: what follows it has more quadratics, each with samples inside."""


def chains(cubics: FloatArray, degrees: IntArray, offsets: IntArray) -> ContourArrays:
    """Closed chains of lines and cubics (r, 4, 2) as contours, with offsets (C + 1,)."""
    needed = np.ones((len(cubics), 3), dtype=np.bool_)
    needed[degrees == 1, 1:] = False
    return ContourArrays(cubics[:, :3][needed], degrees, offsets, offsets_of(degrees)[offsets])


def quadratic_points(
    source: ContourArrays, options: Options, tolerance: float, em: float
) -> tuple[list[tuple[FloatArray, BoolArray]], float]:
    """Points of contours as TrueType stores them, and whether each is on the curve.

    Returns:
        These, and a bound of their distance from the source.
    """
    found, reached = [], 0.0
    for c in range(source.num_contours):
        own = source.part(c, c + 1)
        points, on, far = quadratic_contour([own], stored_points(own), ONE, ONE, options, tolerance, em)
        found.append((points[0], on))
        reached = max(reached, far)
    return found, reached


def quadratic_contour(
    sources: Sequence[ContourArrays], stored: tuple[FloatArray, BoolArray] | None, corners: FloatArray,
    mixes: FloatArray, options: Options, tolerance: float, em: float, stays: BoolArray | None = None,
) -> tuple[FloatArray, BoolArray, float]:  # fmt: skip
    """Points (K, n, 2) of one contour in K masters as TrueType stores them, and whether each is on the curve.

    Args:
        stored: points (K, n, 2) as they are, and which are on the curve, where the source is these but for rounding.
        corners, mixes: see :func:`fit_for_fonts`. stays: (m,) segments that are to stay as they are.

    Returns:
        Also a bound of their distance from the source.
    """

    def fit(cubics: FloatArray, degrees: IntArray) -> tuple[FloatArray, BoolArray, float]:
        settings = EFFORTS[options.effort](
            near=tolerance if stored else tolerance / DENSER, angle=float(np.radians(options.corner_angle)),
            line=LONG_LINE * em, c2=False, margin=0.0, residual=0.0,
        )  # fmt: skip
        return fit_quadratics(cubics, degrees, settings, tolerance, as_stored(cubics, stored, stays), corners, mixes)

    cubics, degrees = np.stack([all_cubics(master) for master in sources]), sources[0].degrees
    points, on, far = fit(cubics, degrees)
    if stored is None:
        if len(sources) > 1:
            return points, on, far
        own = sources[0]
        first, turned = of_points(points[0], on), _turns_in(own)
        for least in SLIDES if _turns_in(first) > turned else ():
            cut = with_cut_lines(own, first, least)
            if cut is None or _turns_in(of_points(points[0], on)) <= turned:
                break
            other = fit(all_cubics(cut)[None], cut.degrees)
            if other[2] <= tolerance and _turns_in(of_points(other[0][0], other[1])) < _turns_in(
                of_points(points[0], on)
            ):
                points, on, far = other
        return points, on, far
    if 0 < len(on) < len(stored[1]) and (
        len(sources) > 1 or not _more_findings(sources[0], of_points(points[0], on), em)
    ):
        return (*begun_as(points, on, stored), far)
    return (*stored, as_stored(cubics, stored).drift)


def as_stored(
    cubics: FloatArray, stored: tuple[FloatArray, BoolArray] | None, stays: BoolArray | None = None
) -> Stored:
    """What is stored of a contour (K, m, 4, 2) by its segments."""
    K, m = cubics.shape[:2]
    if stored is None:
        nothing = np.empty((K, m, 2))
        return Stored(False, np.rint(cubics[:, :, 0]), nothing, np.zeros(m, np.bool_), 0.0, np.zeros(m, np.bool_))
    points, degrees, implied = quadratics(*stored)
    starts = np.cumsum(degrees) - degrees
    node, control = points[:, starts], points[:, np.minimum(starts + 1, points.shape[1] - 1)]
    exact = np.where((degrees == 2)[:, None], (3 * cubics[:, :, 1] - cubics[:, :, 0]) / 2, control)
    drift = max(np.abs(each).max() for each in (node - cubics[:, :, 0], control - exact))
    node, control = (np.ascontiguousarray(each) for each in (node, control))
    stays = np.zeros(m, np.bool_) if stays is None else stays
    return Stored(True, node, control, implied, float(np.sqrt(2) * drift), stays)


SLIDES = (1, 3, 6, 10, 15, 21)
"""From how many units from the end of a line on it is tried to let a curve begin there."""

ALONG, BESIDE, REACH = np.radians(0.3), 0.4, 40
"""Angle from a line at which the grid has a control point along it; how far from the line, in units, a new end of it
may be; and how far from the old one, in units."""


def _turns_in(contour: ContourArrays) -> int:
    """The number of joints with curves that turn as a kink does."""
    sizes = np.abs(turns(all_cubics(contour), NO_HANDLE))
    line = contour.degrees == 1
    return int(((sizes > KINKED) & (sizes < CORNER) & ~(line & np.roll(line, 1))).sum())


def with_cut_lines(source: ContourArrays, made: ContourArrays, least: int) -> ContourArrays | None:
    """A contour whose lines end earlier where those of what was made of it, in whole units, are left with a new kink.

    The rest of a line belongs to the curve then, which has its first control point further away: near the end of a line
    the grid may have none in its direction.

    Args:
        least: units from the old end. None if there is no such line.
    """
    cubics, sizes, made_sizes = all_cubics(source), turns(all_cubics(source), NO_HANDLE), {}
    begins = all_cubics(made)[:, 0].tolist()
    for point, size in zip(begins, np.abs(turns(all_cubics(made), NO_HANDLE)).tolist(), strict=True):
        made_sizes[tuple(point)] = size
    rows, degrees, m, changed = [], [], len(cubics), False
    for s in range(m):
        own, pieces = cubics[s], [(cubics[s], int(source.degrees[s]))]
        for end in range(2) if source.degrees[s] == 1 else ():
            j, beside = (s + end) % m, (s + 1) % m if end else s - 1
            size = made_sizes.get(tuple(np.rint(cubics[j, 0]).tolist()), 0.0)
            if source.degrees[beside] == 1 or not max(abs(sizes[j]) + 1e-3, KINKED) < size < CORNER:
                continue
            share = _share_of_line(np.rint(own[3 * (1 - end)]), own[3 * end], least)
            if share is None:
                continue
            changed, at = True, share * own[3 * (1 - end)] + (1 - share) * own[3 * end]
            line, _ = pieces.pop(-1 if end else 0)
            first, last = straight(line[0], at), straight(at, line[3])
            if end:
                pieces += [(first, 1), (last, 3)]
            else:
                pieces = [(first, 3), (last, 1), *pieces]
        rows += [cubic for cubic, _ in pieces]
        degrees += [degree for _, degree in pieces]
    if not changed:
        return None
    return chains(np.array(rows), np.array(degrees), np.array([0, len(rows)]))


def straight(a: FloatArray, b: FloatArray) -> FloatArray:
    """A line as a cubic (4, 2)."""
    return a + np.arange(4.0)[:, None] / 3 * (b - a)


def _share_of_line(far: FloatArray, end: FloatArray, least: int) -> float | None:
    """By which share a line is to be shorter, so that the grid has a control point beyond its end, along it."""
    vector = far - end
    size = float(np.hypot(*vector))
    for step in range(least, min(REACH, int(size / 2)) + 1):
        node = np.rint(end + step / size * vector)
        away = node - end
        if abs(vector[0] * away[1] - vector[1] * away[0]) > BESIDE * size:
            continue
        x, y = np.meshgrid(*(node[k] - end[k] + np.arange(-12.0, 13.0) for k in range(2)))
        x, y = -x, -y
        u, v = node - far
        along, across = (u * x + v * y) / size, np.abs(u * y - v * x) / size
        if ((along > step) & (along < step + 12.0) & (across < ALONG * along)).any():
            return float(away @ vector) / size**2
    return None


def stored_points(contour: ContourArrays) -> tuple[FloatArray, BoolArray] | None:
    """The points (1, n, 2) of one contour as TrueType stores them, without those midway between control points.

    None if one is off the grid, or a segment is a cubic.
    """
    if (contour.degrees > 2).any():
        return None
    points, first = contour.points, offsets_of(contour.degrees)
    on = np.zeros(len(points), dtype=np.bool_)
    on[first[:-1]] = True
    curved = (contour.degrees == 2) & (np.roll(contour.degrees, 1) == 2)
    middle = (np.roll(points, 1, axis=0) + np.roll(points, -1, axis=0)) / 2
    implied = np.zeros(len(points), dtype=np.bool_)
    implied[first[:-1][curved]] = True
    implied &= (np.abs(middle - points) < 1e-6).all(axis=1)
    points, on = points[~implied], on[~implied]
    if np.abs(points - np.rint(points)).max() > 1e-6:
        return None
    return np.rint(points)[None], on


def of_points(points: FloatArray, on: BoolArray) -> ContourArrays:
    """A contour from points (n, 2) as TrueType stores them."""
    whole, degrees, _ = quadratics(points[None], on)
    return ContourArrays(whole[0], degrees, np.array([0, len(degrees)]), np.array([0, whole.shape[1]]))


def begun_as(points: FloatArray, on: BoolArray, stored: tuple[FloatArray, BoolArray]) -> tuple[FloatArray, BoolArray]:
    """Points from the first one on the curve that others, which are stored, have too."""
    here = {tuple(point): k for k, point in reversed(list(enumerate(points[0].tolist()))) if on[k]}
    first = next(
        (here[tuple(p)] for p, own in zip(stored[0][0].tolist(), stored[1], strict=True) if own and tuple(p) in here), 0
    )
    return np.roll(points, -first, axis=1), np.roll(on, -first)


def _more_findings(source: ContourArrays, made: ContourArrays, em: float) -> bool:
    """Whether a check finds more of a kind in what was made of a contour."""
    before, after = (
        np.bincount(_findings(each, em)[:, WHAT].astype(np.int64), minlength=20) for each in (source, made)
    )
    return bool((after > before).any())
