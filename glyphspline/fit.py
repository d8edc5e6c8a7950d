"""The smooth mode: sample a contour, interpolate, measure, and sample again until the curve is within its tolerance."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .arrays import BoolArray, FloatArray, IntArray
from .distance import Distance, certified_distance
from .glyph import Options
from .interpolation import interpolate
from .orientation import canonical
from .outline import Contour
from .result import Interpolation
from .sampling import Track, even_places, insert_midway, spacings, stepped_places
from .spans import span_errors

ROUNDS = 60
"""Refinements before giving up; each at least halves the largest error's span."""

PRUNINGS = {"fast": 3, "best": 12}
"""Passes that take out vertices which are not needed."""

MOST_VERTICES = 2000
"""A contour's polygon grows no larger than this by refinement."""

CERTAIN_RATIO = 6.0
"""Basis functions rise above 1/2 as long as adjacent knot intervals are within 6.15 of each other."""

SHORTEST = 1e-5
"""No span shorter than this share of the contour is divided: it would end in duplicate vertices."""

SHARE = 0.98
"""Share of the tolerance that the fit may use. The rest is for what its samples miss; the certificate decides."""

SHARPNESS = 0.02
"""The certified bound may exceed the distances seen by this share of the tolerance."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A closed curve for a contour.

    Attributes:
        places: (n,) where on the contour the polygon's vertices lie (see :class:`.sampling.Track`).
        polygon: (n, 2) the vertices. result: the curve through them.
        errors: (n,) largest distance seen between each vertex and the next, in font units; worst: (n,) its place.
        distance: certified distance of the written curve from the outline; None if not measured.
    """

    places: FloatArray
    polygon: FloatArray
    result: Interpolation
    errors: FloatArray | None = None
    worst: FloatArray | None = None
    distance: Distance | None = None


def fit_smooth(contour: Contour, options: Options, tolerance: float) -> Fit:
    """One closed C2 curve for a contour, measured if the fit needs it or the options ask for it."""
    track = Track(contour)
    if options.count is not None or options.step is not None:
        if options.count is not None:
            places = even_places(track, options.count, options.max_ratio)
        else:
            assert options.step is not None
            places = stepped_places(track, options.step, options.max_ratio)
        fit = _interpolate(track, places, options)
        return certified(track, fit, options, tolerance) if options.measure else fit
    form, flipped = canonical(contour)
    track = Track(form)
    near = max(SHARE * tolerance - 10.0**-options.precision, tolerance / 4)
    for _ in range(TIGHTENINGS):
        fit = _frugal(track, options, near)
        if flipped:
            back = Track(form.reversed())
            fit = _interpolate(back, np.sort(np.mod(-fit.places, back.places)), options)
        fit = certified(back if flipped else track, fit, options, tolerance)
        assert fit.distance is not None
        if fit.distance.bound <= tolerance:
            break
        near *= 0.9
    return fit


TIGHTENINGS = 3
"""Fits with a smaller tolerance if the certificate of the first one fails."""


def _frugal(track: Track, options: Options, near: float) -> Fit:
    """Add vertices until every span is near enough, then take out those that can be spared."""
    fit = _refine(track, seeds(track, options), options, near)
    for _ in range(PRUNINGS[options.effort]):
        pruned = _prune(track, fit, options, near)
        if pruned is None:
            break
        fit = pruned
    return fit


def seeds(track: Track, options: Options) -> FloatArray:
    """Places to begin with: the corners, at least four places, graded."""
    places = track.corners(options.corner_angle)
    if len(places) == 0:
        places = np.zeros(1)
    while len(places) < 4:
        places = insert_midway(track, places, np.ones(len(places), dtype=np.bool_))
    return _graded(track, places, options)


def _graded(track: Track, places: FloatArray, options: Options) -> FloatArray:
    """The places with spans halved where *chords* are too uneven, each counted within the first lap.

    Up to a ratio of 4 this is what certifies convergence before the interpolation is run (Theorem 2).
    """
    while True:
        places = np.sort(np.mod(places, track.places))
        h = chords(track(places))
        poor = h > options.max_ratio * np.minimum(np.roll(h, 1), np.roll(h, -1))
        poor &= spacings(track, places) > SHORTEST * track.length
        if not poor.any() or len(places) > MOST_VERTICES:
            return places
        places = insert_midway(track, places, poor)


def is_graded(polygon: FloatArray, max_ratio: float) -> bool:
    """Whether chords are even enough for Lemma 2 to have an interval everywhere, so that its own rule converges."""
    h = chords(polygon)
    before = np.roll(h, 1)
    most = min(max_ratio, CERTAIN_RATIO) * (1 + 1e-9)
    return bool((h <= most * before).all() and (before <= most * h).all())


def chords(polygon: FloatArray) -> FloatArray:
    """(n,) distance from each vertex to the next, the last to the first."""
    return np.hypot(*(np.roll(polygon, -1, axis=0) - polygon).T)


def _refine(track: Track, places: FloatArray, options: Options, near: float) -> Fit:
    """Add a vertex at the worst point of all spans that are among the worst, until none is too far off."""
    for _ in range(ROUNDS):
        fit = _measured(track, _interpolate(track, places, options))
        assert fit.errors is not None
        poor = (fit.errors > near) & (spacings(track, fit.places) > SHORTEST * track.length)
        if not poor.any() or len(places) + poor.sum() > MOST_VERTICES:
            break
        poor &= fit.errors > fit.errors.max() / 2
        places = _graded(track, insert_at_worst(track, fit, poor), options)
    return fit


def insert_at_worst(track: Track, fit: Fit, where: BoolArray) -> FloatArray:
    """The places with one more in each span marked: at its worst point, or as near to it as the middle three fifths."""
    assert fit.worst is not None
    at, h = track.arc_length(fit.places), spacings(track, fit.places)
    worst = np.mod(track.arc_length(fit.worst) - at, track.length)
    new = at + np.clip(worst, 0.2 * h, 0.8 * h)
    return np.sort(np.concatenate([fit.places, np.mod(track.place_at(new[where]), track.places)]))


def _prune(track: Track, fit: Fit, options: Options, near: float) -> Fit | None:
    """The fit without vertices that can be spared; None if there are none. No two neighbours go at once."""
    assert fit.errors is not None
    keep = np.ones(len(fit.places), dtype=np.bool_)
    corners = np.isin(fit.places, track.corners(options.corner_angle))
    keep[_spare(fit, corners, options.max_ratio, near)] = False
    for _ in range(4):
        if keep.all() or keep.sum() < 4:
            return None
        pruned = _measured(track, _interpolate(track, fit.places[keep], options))
        assert pruned.errors is not None
        if (pruned.errors <= near).all():
            return pruned
        keep |= _beside(fit.places, keep, pruned.places[pruned.errors > near], pruned.places)
        keep = _graded_again(fit.polygon, keep, options.max_ratio)
    return None


def _graded_again(polygon: FloatArray, keep: BoolArray, max_ratio: float) -> BoolArray:
    """Put vertices back until the chords are graded: the nearest one after the start of each chord too long."""
    while True:
        kept = np.flatnonzero(keep)
        h = chords(polygon[kept])
        uneven = h > max_ratio * (1 + 1e-9) * np.minimum(np.roll(h, 1), np.roll(h, -1))
        missing = np.diff(np.append(kept, kept[0] + len(keep))) > 1
        back = kept[uneven & missing] + 1
        if len(back) == 0:
            return keep
        keep[back % len(keep)] = True


def _spare(fit: Fit, corners: BoolArray, max_ratio: float, near: float) -> IntArray:
    """Vertices that might be spared, those between the smallest errors first, at least three apart and graded."""
    assert fit.errors is not None
    both = np.maximum(fit.errors, np.roll(fit.errors, 1))
    both[corners] = np.inf
    n = len(both)
    taken = np.zeros(n, dtype=np.bool_)
    for i in np.argsort(both, kind="stable"):
        if both[i] > 0.9 * near:
            break
        around = np.arange(i - 2, i + 3) % n
        if taken[around].any():
            continue
        taken[i] = True
        left = np.flatnonzero(~taken)
        near_by = np.searchsorted(left, i) + np.arange(-3, 3)
        h = np.hypot(*np.diff(fit.polygon[left[near_by % len(left)]], axis=0).T)
        if (h[1:] > max_ratio * h[:-1]).any() or (h[:-1] > max_ratio * h[1:]).any():
            taken[i] = False
    return np.flatnonzero(taken)


def _beside(places: FloatArray, keep: BoolArray, poor: FloatArray, kept: FloatArray) -> BoolArray:
    """Of the vertices taken out, those in the spans that begin at ``poor`` or next to them."""
    order = np.searchsorted(kept, poor)
    back = np.zeros(len(places), dtype=np.bool_)
    for j in order:
        for low, high in ((j - 1, j), (j, j + 1), (j + 1, j + 2)):
            a, b = kept[low % len(kept)], kept[high % len(kept)]
            inside = (places > a) & (places < b) if a < b else (places > a) | (places < b)
            back |= inside & ~keep
    return back


def _interpolate(track: Track, places: FloatArray, options: Options) -> Fit:
    polygon = track(places)
    result = interpolate(
        polygon,
        options.variant,
        margin=options.margin,
        fallback="knot" if is_graded(polygon, options.max_ratio) else options.fallback,
        residual_tolerance=options.residual_tolerance,
        max_iterations=options.max_iterations,
    )
    return Fit(np.delete(places, result.merged), np.delete(polygon, result.merged, axis=0), result)


def _measured(track: Track, fit: Fit) -> Fit:
    """The fit with the distance of its curve from the outline between each vertex and the next."""
    anchors = _anchors(track, fit)
    errors, worst = span_errors(fit.result.spline.to_bezier(), anchors[:, 0], track.cubics, anchors[:, 1])
    return replace(fit, errors=errors, worst=worst)


def _anchors(track: Track, fit: Fit) -> FloatArray:
    """(n + 1, 2) places on the curve and on the outline of all vertices, the first one again at the end."""
    u, n = fit.result.spline.knots, len(fit.places)
    t = np.maximum.accumulate(fit.result.parameters)
    laps = np.floor(t / u[-1])
    within = t - laps * u[-1]
    span = np.clip(np.searchsorted(u, within, side="right") - 1, 0, n - 1)
    on_curve = laps * n + span + (within - u[span]) / (u[span + 1] - u[span])
    anchors = np.stack([np.minimum(on_curve, on_curve[0] + n), fit.places], axis=1)
    return np.concatenate([anchors, anchors[:1] + np.array([n, track.places])])


def certified(track: Track, fit: Fit, options: Options, tolerance: float) -> Fit:
    """The fit with the certified distance of its curve, rounded as it is written, from the outline."""
    written = Contour.from_segments(fit.result.spline.to_bezier()).rounded(options.precision)
    sharpness = SHARPNESS * tolerance
    distance = certified_distance(written.cubics(), track.cubics, _anchors(track, fit), sharpness, tolerance)
    return replace(fit, distance=distance)
