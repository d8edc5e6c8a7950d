"""Traced outlines: hundreds of short lines, or curves, whose turns are noise within the tolerance.

A fit follows what its source turns. So a trace is first made *calm*: least-squares splines within a share of the
tolerance of it, which average the noise, between corners. A corner is where no such spline passes whose spans are as
long as corners have to be to show at the tolerance. What is fitted is the calm contour, with the rest of the tolerance;
distances, certified both times, are added.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..curves.bezier import derivative_points, evaluate
from ..curves.bspline import bezier_pieces, full_knots, span_controls
from ..curves.pairing import SHARPNESS, pair_stretches
from ..outlines.contour_arrays import ContourArrays, end_to_end, lines_and_cubics, offsets_of
from ..outlines.segments import contour_cubics
from ..types import BoolArray, FloatArray, IntArray
from .faithful import Fits
from .measures import distance_columns
from .options import Options
from .results import ConvertedContours, assembled

FEWEST, SHORT, TURNING = 24, 1.5, 1 / 3
"""A trace has at least this many segments. At so large a share of its joints it turns by the corner angle beside a
segment shorter than this many tolerances."""

SHARES, MOST = (0.5, 0.65, 0.8), 0.9
"""Of the tolerance, how far samples of traces may be from calm contours, in turn, and how far the certificate may say
that these are: the rest is left to the fit."""

SHORTEST = 16.0
"""Spans of calm contours are longer than this many times that distance. They then round corners of less than some 40
degrees, and bends of a radius of less than ten times the distance are corners."""

STRAIGHT, EXACT = 1.5, 0.1
"""A line takes the place of a spline of one span where it is this many times as far off, or within this share of the
distance."""

MOST_SAMPLES = 6_000
"""Samples of a trace, at most."""


class TraceSamples(NamedTuple):
    """A trace at even steps, once round and without the first point again.

    Attributes:
        points: (N, 2). places: (N + 1,) where on the contour they lie, with the first one a lap later.
        passed: (N + 1,) length from the first one to each, along what is left of the trace without zigzags.
    """

    points: FloatArray
    places: FloatArray
    passed: FloatArray


class CalmStretch(NamedTuple):
    """A part of a calm contour: cubics (k, 4, 2), and the (k,) places on the trace where they begin; or a line."""

    cubics: FloatArray
    places: FloatArray
    line: bool


def calming(fits: Callable[[float], Fits], contours: ContourArrays, options: Options, tolerance: float) -> Fits:
    """The fits of a mode within a tolerance, with traces among the contours made calm before they are fitted.

    Where that saves no segments, as the noise exceeds the tolerance, the fit of the trace itself counts.

    Args:
        fits: of the mode, from a tolerance. contours: all that are to be fitted.
    """
    own, known = fits(tolerance), dict[bytes, tuple[ContourArrays, float] | None]()
    if not are_traces(contours, options.corner_angle, tolerance).any():
        return own

    def fit(given: ContourArrays, attempt: int) -> ConvertedContours:
        plain, traces = own.fit(given, attempt), are_traces(given, options.corner_angle, tolerance)
        parts = [(plain, c) for c in range(given.num_contours)]
        for c in np.flatnonzero(traces).tolist():
            cubics, most = contour_cubics(given, c), segments(parts[c])
            if (trace := cubics.tobytes()) not in known:  # or else it was calmed for an attempt before
                known[trace] = calm_contour(cubics, tolerance)
            found = known[trace]
            if found is None or len(found[0].degrees) >= most:
                continue
            calm, bound = found
            result = fits(tolerance - bound).fit(calm, attempt)
            bounds = [own_bound + bound for own_bound in result.measures["deviation_bound"]]
            columns = distance_columns(bounds, bounds, tolerance)
            result = replace(result, source=given.part(c, c + 1), measures={**result.measures, **columns})
            if segments((result, 0)) < most:
                parts[c] = result, 0
        return assembled(parts)

    return own._replace(fit=fit)


def segments(result: tuple[ConvertedContours, int]) -> float:
    """The number of segments of a contour's result; infinite beyond the tolerance."""
    measures, c = result[0].measures, result[1]
    return float(measures["segments"][c]) if measures["within_tolerance"][c] else np.inf


def are_traces(contours: ContourArrays, corner_angle: float, tolerance: float) -> BoolArray:
    """(C,) whether contours are traces at a tolerance in font units; the angle is in degrees."""
    counts, first = np.diff(contours.offsets), contours.offsets[:-1]
    found: BoolArray = counts >= FEWEST
    if not found.any():
        return found
    joints = contours.points[offsets_of(contours.degrees)[:-1]]
    after, before = np.arange(1, len(joints) + 1), np.arange(-1, len(joints) - 1)
    after[contours.offsets[1:] - 1], before[first] = first, contours.offsets[1:] - 1
    x, y = (joints[after] - joints).T
    sizes = np.hypot(x, y)
    turns = np.abs(np.arctan2(x[before] * y - y[before] * x, x[before] * x + y[before] * y))
    ragged = (turns >= np.radians(corner_angle)) & (np.minimum(sizes, sizes[before]) < SHORT * tolerance)
    return found & (np.add.reduceat(ragged, first, dtype=np.int64) >= TURNING * counts)


def calm_contour(cubics: FloatArray, tolerance: float) -> tuple[ContourArrays, float] | None:
    """The calm contour of a trace (m, 4, 2), and its certified distance; None if it takes too much of the tolerance.

    Where it has corners these may be noise, and one farther off with less than half of them takes its place.
    """
    best: tuple[ContourArrays, float] | None = None
    fewest = np.inf
    for share in SHARES:
        near = share * tolerance
        stretches = calmed(even_samples(cubics, near), near)
        if stretches is None or not len(stretches) < fewest / 2:
            continue
        pieces = np.concatenate([each.cubics for each in stretches])
        lines = np.concatenate([np.full(len(each.cubics), each.line) for each in stretches])
        places = np.maximum.accumulate(np.concatenate([each.places for each in stretches]))
        anchors = np.column_stack([np.arange(len(pieces) + 1.0), np.append(places, places[0] + len(cubics))])
        calm, trace, pairs = ((rows, np.array([0, len(rows)])) for rows in (pieces, cubics, anchors))
        bound = float(pair_stretches(calm, trace, pairs, SHARPNESS * tolerance, near)[0].max())
        if bound <= MOST * tolerance:
            best, fewest = (end_to_end([lines_and_cubics(pieces, lines)]), bound), len(stretches)
        if fewest <= 2:
            break
    return best


def even_samples(cubics: FloatArray, near: float) -> TraceSamples:
    """Samples of a closed contour (m, 4, 2) at steps of a distance, or more."""
    steps = 8
    places = np.arange(steps * len(cubics) + 1) / steps
    fine = evaluate(cubics.repeat(steps, axis=0), places[:-1] % 1.0)
    fine = np.concatenate([fine, fine[:1]])
    lengths = np.append(0.0, np.cumsum(np.hypot(*np.diff(fine, axis=0).T)))
    N = max(min(int(lengths[-1] / (near / 2)), MOST_SAMPLES), 4 * FEWEST)
    at = np.interp(np.arange(N + 1) * (lengths[-1] / N), lengths, places)
    x, y = (np.interp(at, places, column) for column in fine.T)
    points = np.column_stack([x[:-1], y[:-1]])
    wide = max(int(np.ceil(3 * near / (lengths[-1] / N))), 1)  # the mean of so many to each side has no zigzags
    smooth = np.stack([np.roll(points, k, axis=0) for k in range(-wide, wide + 1)]).mean(axis=0)
    way = np.hypot(*(np.roll(smooth, -1, axis=0) - smooth).T)
    return TraceSamples(points, at, np.append(0.0, np.cumsum(np.maximum(way, 1e-3 * near))))


def calmed(samples: TraceSamples, near: float) -> list[CalmStretch] | None:
    """A trace as stretches between corners, each within a distance of its samples.

    None if it needs so many that they would be shorter than two spans: its noise is farther off.
    """
    corners = list[int]()
    done = dict[tuple[int, int], CalmStretch]()
    while len(corners) * SHORTEST * near <= samples.passed[-1] / 2:
        ends = [*corners, corners[0] + len(samples.points)] if corners else [0, len(samples.points)]
        added = set[int]()
        for a, b in pairwise(ends):
            if (a, b) not in done:
                found = stretch(samples, a, b, not corners, near)
                if isinstance(found, int):
                    added.add(found % len(samples.points))
                else:
                    done[a, b] = found
        if not added:
            return [done[pair] for pair in pairwise(ends)]
        corners = sorted({*corners, *added})
    return None


def stretch(samples: TraceSamples, a: int, b: int, closed: bool, near: float) -> CalmStretch | int:
    """The samples from a to b as a spline, or a line; or the sample at which they have to be cut."""
    N, index = len(samples.points), np.arange(a, b + 1)
    points, turn = samples.points[index % N], index // N
    places = samples.places[index % N] + turn * samples.places[N]
    t = samples.passed[index % N] + turn * samples.passed[N]
    t -= t[0]
    knots = np.linspace(0.0, t[-1], 9 if closed else 2)
    while True:
        cubics = least_squares(points, t, knots, closed)
        span = np.clip(np.searchsorted(knots, t, side="right") - 1, 0, len(knots) - 2)
        share = (t - knots[span]) / (knots[span + 1] - knots[span])
        errors = distances(cubics[span], share, points)
        worst = np.zeros(len(knots) - 1)
        np.maximum.at(worst, span, errors)
        if len(cubics) == 1 and from_chord(points).max() <= min(near, max(STRAIGHT * worst[0], EXACT * near)):
            thirds = np.linspace(0.0, 1.0, 4)[:, None]
            return CalmStretch(((1 - thirds) * points[0] + thirds * points[-1])[None], places[:1], True)
        if worst.max() <= near:
            return CalmStretch(cubics, np.interp(knots[:-1], t, places), False)
        halves = np.flatnonzero((worst > near) & (np.diff(knots) >= 2 * SHORTEST * near))
        if len(halves) == 0:
            return a + corner_near(points, t, int(errors.argmax()), closed, near)
        knots = np.sort(np.append(knots, (knots[halves] + knots[halves + 1]) / 2))


def corner_near(points: FloatArray, t: FloatArray, worst: int, closed: bool, near: float) -> int:
    """The sample that stands out farthest from the chord between those beside it, near one where a spline fails."""
    reach, n = SHORTEST * near, len(points) - 1
    if not closed and t[-1] <= 2 * reach:
        return int(np.clip(from_chord(points).argmax(), 1, n - 1))
    tried = np.flatnonzero(np.abs(t - t[worst]) <= 2 * reach)
    tried = tried[(tried > 0) & (tried < n)]
    sides = (np.interp(t[tried] + way * reach / 2, t, np.arange(n + 1.0)).astype(np.int64) for way in (-1, 1))
    (ax, ay), (bx, by) = ((points[side] - points[tried]).T for side in sides)
    heights = np.abs(ax * by - ay * bx) / np.maximum(np.hypot(bx - ax, by - ay), near)
    return int(tried[heights.argmax()])


def distances(cubics: FloatArray, share: FloatArray, points: FloatArray) -> FloatArray:
    """How far points (n, 2) are from curves (n, 4, 2), across these; half as far where they lie ahead or behind."""
    (x, y), (dx, dy) = (evaluate(cubics, share) - points).T, evaluate(derivative_points(cubics), share).T
    across = np.abs(x * dy - y * dx) / np.maximum(np.hypot(dx, dy), 1e-300)
    return np.asarray(np.maximum(across, np.hypot(x, y) / 2))


def from_chord(points: FloatArray) -> FloatArray:
    """Distances of points (n, 2) from the chord between the first and the last, or from these if they are one."""
    (x, y), (dx, dy) = points[-1] - points[0], (points - points[0]).T
    size = np.hypot(x, y)
    if size == 0.0:
        return np.asarray(np.hypot(dx, dy))
    along = np.clip((dx * x + dy * y) / size, 0.0, size)
    return np.asarray(np.hypot(dx - along * (x / size), dy - along * (y / size)))


def least_squares(points: FloatArray, t: FloatArray, knots: FloatArray, closed: bool) -> FloatArray:
    """(k, 4, 2) the cubic spline on k + 1 knots nearest to points at t; an open one has their ends.

    Sums are in a fixed order, so that they have the same bits everywhere.
    """
    k = len(knots) - 1
    full, which = full_knots(knots, 3, closed), span_controls(k, 3, closed)
    span = np.clip(np.searchsorted(knots, t, side="right") - 1, 0, k - 1)
    values, index, n = basis(full, span, t), which[span], int(which.max()) + 1
    pairs, products = index[:, :, None] * n + index[:, None], values[:, :, None] * values[:, None]
    A: FloatArray = np.bincount(pairs.ravel(), products.ravel(), n * n).reshape(n, n).astype(np.float64)
    A += 1e-9 * np.eye(n)
    sums = [np.bincount(index.ravel(), (values * column[:, None]).ravel(), n) for column in points.T]
    b: FloatArray = np.column_stack(sums).astype(np.float64)
    if not closed:
        for end, point in ((0, points[0]), (n - 1, points[-1])):
            A[end] = 0.0
            A[end, end], b[end] = 1.0, point
    return bezier_pieces(full, solved(A, b)[which])


def basis(full: FloatArray, span: IntArray, t: FloatArray) -> FloatArray:
    """(N, 4) the cubic basis functions that are not zero at t, by Cox and de Boor."""
    values = np.ones((len(t), 1))
    for d in range(1, 4):
        new = np.zeros((len(t), d + 1))
        for r in range(d):
            right, left = full[span + 4 + r], full[span + 4 + r - d]
            term = values[:, r] / (right - left)
            new[:, r] += (right - t) * term
            new[:, r + 1] += (t - left) * term
        values = new
    return values


def solved(A: FloatArray, b: FloatArray) -> FloatArray:
    """The solution of a system with a large diagonal, by elimination without pivots."""
    rows = np.concatenate([A, b], axis=1)
    n = len(A)
    for i in range(n):
        rows[i] /= rows[i, i]
        factors = rows[:, i].copy()
        factors[i] = 0.0
        rows -= factors[:, None] * rows[i]
    return rows[:, n:]
