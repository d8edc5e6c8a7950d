"""Points of contours as TrueType stores them, of :mod:`.quadratics`, and as few kinks as the grid allows."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from ....curves.bezier import evaluate
from ....curves.cubics import turns
from ....fitting.options import Options
from ....fitting.sharp.corners import NO_HANDLE
from ....fitting.sharp.settings import EFFORTS, LONG_LINE
from ....outlines.contour_arrays import ContourArrays, joined, offsets_of
from ....outlines.flaws.joints import CONTOUR, PLACE, WHAT
from ....outlines.masters import quadratics
from ....outlines.segments import all_cubics
from ....types import BoolArray, FloatArray, IntArray
from .fit import ONE, chains, findings
from .gates import CORNER
from .gates import KINK as KINKED
from .outlines import Stored
from .quadratics import fit_contour as fit_quadratics

Made = tuple[FloatArray, BoolArray, float]
"""Points (K, n, 2) of a contour in K masters, whether each is on the curve, and a bound of their distance from the
source."""

SAME = 0.005
"""Of an em, within which two findings of a kind are one."""

DENSER = 4.0
"""How much finer a source of cubics is sampled: what follows it has more quadratics, each with samples inside."""


def quadratic_points(
    source: ContourArrays, options: Options, tolerance: float, em: float
) -> tuple[list[tuple[FloatArray, BoolArray]], float]:
    """Points of contours as TrueType stores them, and whether each is on the curve.

    Returns:
        These, and a bound of their distance from the source.
    """
    parts = [source.part(c, c + 1) for c in range(source.num_contours)]
    stored = [stored_points(own) for own in parts]
    found = [
        quadratic_contour([own], points, ONE, ONE, options, tolerance, em)
        for own, points in zip(parts, stored, strict=True)
    ]
    fewer = {c: own for c, own in enumerate(stored) if own is not None and len(found[c][1]) < len(own[1])}
    if fewer:
        made = joined([of_points(found[c][0][0], found[c][1]) for c in fewer])
        more = more_findings(source.chosen([*fewer]), made, em)
        for worse, (c, points) in zip(more.tolist(), fewer.items(), strict=True):
            if worse:
                found[c] = (*points, as_stored(all_cubics(parts[c])[None], points).drift)
    return [(points[0], on) for points, on, _ in found], max((far for *_, far in found), default=0.0)


def quadratic_contour(
    sources: Sequence[ContourArrays], stored: tuple[FloatArray, BoolArray] | None, corners: FloatArray,
    mixes: FloatArray, options: Options, tolerance: float, em: float, stays: BoolArray | None = None,
) -> tuple[FloatArray, BoolArray, float]:  # fmt: skip
    """Points (K, n, 2) of one contour in K masters as TrueType stores them, and whether each is on the curve.

    Args:
        stored: points (K, n, 2) as they are, and which are on the curve, where the source is these but for rounding.
        corners, mixes: see :func:`.fit.fit_for_fonts`. stays: (m,) segments that are to stay as they are.

    Returns:
        Also a bound of their distance from the source.
    """
    cubics, degrees = np.stack([all_cubics(master) for master in sources]), sources[0].degrees
    settings = EFFORTS[options.effort](
        near=tolerance if stored else tolerance / DENSER, angle=float(np.radians(options.corner_angle)),
        line=LONG_LINE * em, c2=False, margin=0.0, residual=0.0,
    )  # fmt: skip
    if stored is None:

        def fit(cubics: FloatArray, degrees: IntArray) -> Made:
            return fit_quadratics(cubics, degrees, settings, tolerance, unstored(cubics, degrees), corners, mixes)

        made = fit(cubics, degrees)
        return slid(sources[0], fit, made, tolerance) if len(sources) == 1 else made
    own = as_stored(cubics, stored, stays)
    points, on, far = fit_quadratics(cubics, degrees, settings, tolerance, own, corners, mixes)
    return (*begun_as(points, on, stored), far) if 0 < len(on) < len(stored[1]) else (*stored, own.drift)


def rounded_nodes(cubics: FloatArray, degrees: IntArray) -> FloatArray:
    """(K, m, 2) where segments begin, in whole units: the nearest, but of short lines with decimals between two curves
    those that turn them least, of the four around each end."""
    node, m = np.rint(cubics[:, :, 0]), len(degrees)
    for s in np.flatnonzero((degrees == 1) & (np.roll(degrees, 1) > 1) & (np.roll(degrees, -1) > 1)).tolist():
        ends = [s, (s + 1) % m]
        for own, now in zip(cubics, node, strict=True):
            a, b = own[ends, 0]
            if off_way(b - a, now[ends[1]] - now[ends[0]]) > KINKED:
                around = [[(f(p[0]), g(p[1])) for f in BOTH for g in BOTH] for p in (a, b)]
                pairs = np.array([(p, q) for p in around[0] for q in around[1] if p != q], dtype=np.float64)
                turned = off_way(b - a, pairs[:, 1] - pairs[:, 0])
                now[ends] = pairs[(turned + 0.01 * np.hypot(*(pairs - (a, b)).T).sum(axis=0)).argmin()]
    return node


BOTH = (np.floor, np.ceil)


def off_way(a: FloatArray, b: FloatArray) -> FloatArray:
    """The angle between a vector and others (…, 2), without sign."""
    return np.abs(np.arctan2(a[0] * b[..., 1] - a[1] * b[..., 0], b @ a))


def unstored(cubics: FloatArray, degrees: IntArray) -> Stored:
    """What there is of a contour (K, m, 4, 2) of which nothing is stored: where its segments begin."""
    (K, m), no = cubics.shape[:2], np.zeros(len(degrees), np.bool_)
    return Stored(False, rounded_nodes(cubics, degrees), np.empty((K, m, 2)), no, 0.0, no)


def as_stored(cubics: FloatArray, stored: tuple[FloatArray, BoolArray], stays: BoolArray | None = None) -> Stored:
    """What is stored of a contour (K, m, 4, 2) by its segments."""
    points, degrees, implied = quadratics(*stored)
    starts = np.cumsum(degrees) - degrees
    node, control = points[:, starts], points[:, np.minimum(starts + 1, points.shape[1] - 1)]
    exact = np.where((degrees == 2)[:, None], (3 * cubics[:, :, 1] - cubics[:, :, 0]) / 2, control)
    drift = max(np.abs(each).max() for each in (node - cubics[:, :, 0], control - exact))
    node, control = (np.ascontiguousarray(each) for each in (node, control))
    stays = np.zeros(len(degrees), np.bool_) if stays is None else stays
    return Stored(True, node, control, implied, float(np.sqrt(2) * drift), stays)


SLIDES = (*range(1, 13), 15, 18, 21, 25, 30, 35)
"""From how many units from the end of a line on it is tried to let a curve begin there."""

ALONG, BESIDE, REACH = np.radians(0.3), 0.4, 40
"""Angle from a line at which the grid has a control point along it; how far from the line, in units, a new end of it
may be; and how far from the old one, in units."""


def slid(
    source: ContourArrays, fit: Callable[[FloatArray, IntArray], Made], made: Made, tolerance: float
) -> Made:  # fmt: skip
    """What was made of a contour, or, if it has new kinks at the ends of lines, of one whose lines end earlier there.

    The rest of a line belongs to the curve then, which has its first control point further away: near the end of a line
    the grid may have none in its direction. Each end slides on alone, until it has no kink.
    """
    slides: dict[tuple[int, int], int] = {}
    best, last, ends, before = made, made, list[tuple[int, int]](), source
    kinks = fewest = new_kinks(source, of_points(made[0][0], made[1]))
    for least in SLIDES if len(fewest) else ():
        ends = kinked_ends(source, kinks, slides) + (ends if last[2] > tolerance else [])
        if not ends:
            break
        slides.update(dict.fromkeys(ends, least))
        cut = with_cut_lines(source, slides)
        if np.array_equal(cut.points, before.points):
            continue
        before, last = cut, fit(all_cubics(cut)[None], cut.degrees)
        kinks = new_kinks(source, of_points(last[0][0], last[1]))
        if last[2] <= tolerance and len(kinks) < len(fewest):
            best, fewest = last, kinks
    return best


def new_kinks(source: ContourArrays, made: ContourArrays) -> FloatArray:
    """(n, 2) where curves that were made of a contour turn as a kink does, and it has no such kink, in whole units."""
    (old, turned), (places, sizes) = (_turning(each) for each in (source, made))
    turned = np.where(turned < CORNER, turned, 0.0) + 1e-3
    there = (np.abs(places[:, None] - np.rint(old)) < 0.5).all(axis=2)
    known = (there & (turned >= sizes[:, None])).any(axis=1)
    return places[(sizes > KINKED) & (sizes < CORNER) & ~known]


def _turning(contour: ContourArrays) -> tuple[FloatArray, FloatArray]:
    """(m, 2) where segments begin, and (m,) by how much the joint turns there, by nothing between two lines."""
    cubics, line = all_cubics(contour), contour.degrees == 1
    return cubics[:, 0], np.where(line & np.roll(line, 1), 0.0, np.abs(turns(cubics, NO_HANDLE)))


def kinked_ends(
    source: ContourArrays, kinks: FloatArray, slides: Mapping[tuple[int, int], int]
) -> list[tuple[int, int]]:  # fmt: skip
    """The ends of lines, by segment and end, that meet a curve at a kink, where these slid by so many units."""
    cubics, m = all_cubics(source), len(source.degrees)
    found = []
    for s in np.flatnonzero(source.degrees == 1).tolist():
        for end in range(2):
            beside = (s + 1) % m if end else s - 1
            place = end_of_line(cubics[s], end, slides.get((s, end), 0))
            # A short line may end at any place on the grid around its end.
            if source.degrees[beside] > 1 and (np.abs(kinks - place) < 1.0).all(axis=1).any():
                found.append((s, end))
    return found


def with_cut_lines(source: ContourArrays, slides: Mapping[tuple[int, int], int]) -> ContourArrays:
    """A contour whose lines end earlier, by so many units or more."""
    rows: list[FloatArray] = []
    degrees: list[int] = []
    for s, (own, degree) in enumerate(zip(all_cubics(source), source.degrees.tolist(), strict=True)):
        first, last = (end_of_line(own, end, slides.get((s, end), 0)) for end in range(2))
        if (first != own[0]).any():
            rows, degrees = [*rows, straight(own[0], first)], [*degrees, 3]
        rows, degrees = [*rows, own if degree > 1 else straight(first, last)], [*degrees, degree]
        if (last != own[3]).any():
            rows, degrees = [*rows, straight(last, own[3])], [*degrees, 3]
    return chains(np.array(rows), np.array(degrees), np.array([0, len(rows)]))


def end_of_line(line: FloatArray, end: int, least: int) -> FloatArray:
    """Where a line (4, 2) is to end, at least so many units earlier, so that the grid has a control point beyond its
    end, along it; its end if there is no such place, or ``least`` is 0."""
    share = _share_of_line(np.rint(line[3 * (1 - end)]), line[3 * end], least) if least > 0 else None
    return line[3 * end] if share is None else share * line[3 * (1 - end)] + (1 - share) * line[3 * end]


def straight(a: FloatArray, b: FloatArray) -> FloatArray:
    """A line as a cubic (4, 2)."""
    return a + np.arange(4.0)[:, None] / 3 * (b - a)


def _share_of_line(far: FloatArray, end: FloatArray, least: int) -> float | None:
    """By which share a line is to be shorter, so that the grid has a control point beyond its end, along it."""
    vector = far - end
    size = float(np.hypot(*vector))
    for step in range(least, min(REACH, int(0.45 * size)) + 1):
        node = np.rint(end + step / size * vector)
        away = node - end
        if abs(vector[0] * away[1] - vector[1] * away[0]) > BESIDE * size:
            continue
        x, y = np.meshgrid(*(node[k] - end[k] + np.arange(-12.0, 13.0) for k in range(2)))
        x, y = -x, -y
        u, v = (node - far) / np.hypot(*(node - far))
        along, across = u * x + v * y, np.abs(u * y - v * x)
        if ((along > step) & (along < step + 12.0) & (across < ALONG * along)).any():
            return float(away @ vector) / size**2
    return None


def stored_points(contour: ContourArrays) -> tuple[FloatArray, BoolArray] | None:
    """The points (1, n, 2) of one contour as TrueType stores them, without those midway between control points.

    None if one is off the grid, or a segment is a cubic.
    """
    if (contour.degrees > 2).any():
        return None
    points, first = contour.points, offsets_of(contour.degrees)[:-1]
    on, implied = np.zeros((2, len(points)), dtype=np.bool_)
    on[first] = True
    curved = contour.degrees == 2
    inner = first[curved & curved[np.arange(len(first)) - 1]]
    middle = (points[inner - 1] + points[(inner + 1) % len(points)]) / 2
    implied[inner] = (np.abs(middle - points[inner]) < 1e-6).all(axis=1)
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


def more_findings(source: ContourArrays, made: ContourArrays, em: float) -> BoolArray:
    """(C,) whether a check finds in contours what it does not find near there in those of which they were made."""
    worse = np.zeros(source.num_contours, dtype=np.bool_)
    (old, there), (new, here) = (placed_findings(each, em) for each in (source, made))
    for row, point in zip(new, here, strict=True):
        alike = (old[:, CONTOUR] == row[CONTOUR]) & (old[:, WHAT] == row[WHAT])
        worse[int(row[CONTOUR])] |= not (np.abs(there[alike] - point).max(axis=1) <= SAME * em).any()
    return worse


def placed_findings(contours: ContourArrays, em: float) -> tuple[FloatArray, FloatArray]:
    """What :func:`.fit.fit.findings` finds, and (n, 2) where."""
    found = findings(contours, em)
    segments = np.floor(found[:, PLACE]).astype(np.int64)
    cubics = all_cubics(contours)[contours.offsets[found[:, CONTOUR].astype(np.int64)] + segments]
    return found, evaluate(cubics, found[:, PLACE] - segments)
