"""Smooth curves through polygons sampled by count or by step, measured only if asked for."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..interpolation.api import interpolate
from ..interpolation.result import Interpolation
from ..outlines.outline import Contour
from ..outlines.sampling import Track, even_places, stepped_places
from ..types import FloatArray
from .certified_distance import Distance, certified_distance
from .options import Options
from .policy import CERTAIN_RATIO

SHARPNESS = 0.02
"""The certified bound may exceed the distances seen by this share of the tolerance."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A closed curve for a contour.

    Attributes:
        places: (n,) where on the contour the polygon's vertices lie (see :class:`..outlines.sampling.Track`).
        polygon: (n, 2) the vertices. result: the curve through them.
        distance: certified distance of the written curve from the outline; None if not measured.
    """

    places: FloatArray
    polygon: FloatArray
    result: Interpolation
    distance: Distance | None = None


def fit_even(contour: Contour, options: Options, tolerance: float) -> Fit:
    """One closed C2 curve through points of a contour, as many or as far apart as the options ask for."""
    track = Track(contour)
    if options.count is not None:
        places = even_places(track, options.count, options.max_ratio)
    else:
        assert options.step is not None
        places = stepped_places(track, options.step, options.max_ratio)
    fit = _interpolate(track, places, options)
    return certified(track, fit, options, tolerance) if options.measure else fit


def is_graded(polygon: FloatArray, max_ratio: float) -> bool:
    """Whether chords are even enough for Lemma 2 to have an interval everywhere, so that its own rule converges."""
    h = chords(polygon)
    before = np.roll(h, 1)
    most = min(max_ratio, CERTAIN_RATIO) * (1 + 1e-9)
    return bool((h <= most * before).all() and (before <= most * h).all())


def chords(polygon: FloatArray) -> FloatArray:
    """(n,) distance from each vertex to the next, the last to the first."""
    return np.hypot(*(np.roll(polygon, -1, axis=0) - polygon).T)


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
