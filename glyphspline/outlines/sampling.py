"""From a contour to a polygon: places on the outline, evenly spaced or given, with chords graded."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..curves.bezier import derivative_points, evaluate
from ..errors import GlyphsplineError
from ..types import BoolArray, FloatArray
from .outline import Contour

CORNER_ANGLE = 12.0
"""Degrees of turn from which a join of two segments is a corner. Brush faces join smooth strokes at up to 10."""

TABLE = 32
"""Steps a segment in the table of arc lengths. It only decides where vertices fall along the outline."""

TIE = 1e-6
"""A half part, or a ratio just at its bound, is common among straight lines; rounding errors must not decide there."""


class Track:
    """A contour as a curve by *place*: place j + x is local parameter x of segment j, places wrap at len(contour)."""

    def __init__(self, contour: Contour) -> None:
        self.contour = contour
        self.cubics = contour.cubics()
        self.places = len(self.cubics)

    def __call__(self, place: FloatArray) -> FloatArray:
        """(k,) places give (k, 2) points."""
        segment = np.floor(place).astype(np.int64)
        return evaluate(self.cubics[segment % self.places], place - segment)

    @cached_property
    def _table(self) -> tuple[FloatArray, FloatArray]:
        place = np.arange(self.places * TABLE + 1) / TABLE
        steps = np.hypot(*np.diff(self(place), axis=0).T)
        return place, np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def length(self) -> float:
        """Length of the contour."""
        return float(self._table[1][-1])

    def arc_length(self, place: FloatArray) -> FloatArray:
        """Distance along the contour from its first point."""
        laps = np.floor(place / self.places)
        return laps * self.length + np.interp(place - laps * self.places, *self._table)

    def place_at(self, distance: FloatArray) -> FloatArray:
        """The inverse of :meth:`arc_length`."""
        laps = np.floor(distance / self.length)
        return laps * self.places + np.interp(distance - laps * self.length, self._table[1], self._table[0])

    def corners(self, angle: float = CORNER_ANGLE) -> FloatArray:
        """Places of the joins at which the tangent turns by ``angle`` degrees or more."""
        arriving = np.roll(end_tangents(self.cubics[:, ::-1]) * -1, 1, axis=0)
        leaving = end_tangents(self.cubics)
        turn = np.abs(np.arctan2(_cross(arriving, leaving), (arriving * leaving).sum(axis=1)))
        return np.flatnonzero(turn >= np.radians(angle)).astype(np.float64)

    def extrema(self) -> FloatArray:
        """Places inside segments where the tangent is horizontal or vertical."""
        hodograph = derivative_points(self.cubics)
        found = []
        for j, (a, b, c) in enumerate(hodograph):
            for axis in (0, 1):
                zeros = np.roots([a[axis] - 2 * b[axis] + c[axis], 2 * (b[axis] - a[axis]), a[axis]])
                found += [j + x.real for x in zeros if abs(x.imag) < 1e-9 and 0.02 < x.real < 0.98]
        return np.array(sorted(found))


def end_tangents(cubics: FloatArray) -> FloatArray:
    """(m, 2) direction in which each cubic leaves its first point, whatever handles have no length."""
    chords = cubics[:, 1:] - cubics[:, :1]
    first = (np.abs(chords).sum(axis=2) > 0).argmax(axis=1)
    return chords[np.arange(len(cubics)), first]


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def sample(
    contour: Contour, *, count: int | None = None, step: float | None = None, max_ratio: float = 4.0
) -> FloatArray:
    """Sample a contour to a polygon whose vertices lie on it.

    Args:
        contour: the outline.
        count: that many vertices, evenly spaced by arc length; the nearest vertex moves onto each corner where the
            chords stay within ``max_ratio``.
        step: corners are vertices, and the stretches between them are divided evenly into parts of at most about
            ``step`` (at least 3 vertices); longer chords beside much shorter ones are halved.
        max_ratio: bound on the ratio of adjacent spacings along the contour. Up to 4 keeps every
            basis function above 1/2, so that convergence is certified.

    Returns:
        (n, 2) vertices, in the contour's direction.

    Raises:
        GlyphsplineError: neither or both of ``count`` and ``step``, or values out of range.
    """
    if (count is None) == (step is None):
        raise GlyphsplineError("sample by count or by step")
    if max_ratio < 2:
        raise GlyphsplineError(f"max_ratio is 2 or more, not {max_ratio}")
    track = Track(contour)
    if count is not None:
        if count < 3:
            raise GlyphsplineError(f"count is 3 or more, not {count}")
        return track(even_places(track, count, max_ratio))
    if step is None or not step > 0:
        raise GlyphsplineError(f"step is a positive length, not {step}")
    return track(stepped_places(track, step, max_ratio))


def even_places(track: Track, count: int, max_ratio: float) -> FloatArray:
    """(count,) places evenly spaced, snapped to corners where that leaves the chords graded."""
    at = track.length * np.arange(count) / count
    for corner in track.arc_length(track.corners()):
        nearest = int(np.argmin(np.abs(at - corner)))
        moved = at.copy()
        moved[nearest] = corner
        if (spacing_ratios(moved, track.length) <= max_ratio).all():
            at = moved
    return track.place_at(at)


def stepped_places(track: Track, step: float, max_ratio: float) -> FloatArray:
    """(n,) places at all corners and at even distances of about ``step`` between them."""
    corners = track.arc_length(track.corners())
    if len(corners) == 0:
        corners = np.zeros(1)
    ends = np.append(corners[1:], corners[0] + track.length)
    parts = np.maximum(np.rint((ends - corners) / step - TIE), 1).astype(np.int64)
    if parts.sum() < 3:
        parts *= 3
    at = np.concatenate([np.linspace(a, b, k, endpoint=False) for a, b, k in zip(corners, ends, parts, strict=True)])
    return np.sort(np.mod(grade(track, track.place_at(at), max_ratio), track.places))


def spacing_ratios(at: FloatArray, length: float) -> FloatArray:
    """(n,) ratio, at least 1, of the spacings on the two sides of each vertex."""
    h = np.diff(np.append(at, at[0] + length))
    before = np.roll(h, 1)
    shorter = np.minimum(h, before)
    return np.where(shorter > 0, np.maximum(h, before) / np.where(shorter > 0, shorter, 1), np.inf)


def grade(track: Track, places: FloatArray, max_ratio: float) -> FloatArray:
    """Halve every spacing that is more than ``max_ratio`` times a neighbour, until none is."""
    while True:
        h = spacings(track, places)
        neighbour = np.minimum(np.roll(h, 1), np.roll(h, -1))
        long = h > (max_ratio + TIE) * neighbour
        if not long.any():
            return places
        places = insert_midway(track, places, long)


def spacings(track: Track, places: FloatArray) -> FloatArray:
    """(n,) arc length from each place to the next, the last to the first."""
    at = track.arc_length(places)
    return np.diff(np.append(at, at[0] + track.length))


def insert_midway(track: Track, places: FloatArray, where: BoolArray) -> FloatArray:
    """Add a place in the middle, by arc length, of each span marked."""
    middles = track.arc_length(places) + spacings(track, places) / 2
    return np.sort(np.concatenate([places, track.place_at(middles[where])]))
