"""Closed curves within a tolerance, for all contours of a glyph at once: vertices put in and taken out until they are.

Each round interpolates the contours that are not done in one compiled call, measures what would be written, and puts
vertices where a span is too far off. The measure is the certificate itself, so that a contour that passes is certified.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...errors import GlyphsplineError
from ...interpolation.batched import BatchedInterpolation
from ...types import FloatArray, IntArray
from ..options import Options
from ..policy import interpolated
from . import steps
from .canonical_contours import CanonicalContours

ROUNDS = 80
"""Rounds before giving up."""

EARLY = {"fast": 1, "best": 2}
"""Rounds in which vertices that seem not to be needed go while others come."""

PRUNINGS = {"fast": 0, "best": 12}
"""How often a contour that passed loses such vertices, and gets others until it passes again."""

POWERS = (3.0, 2.0, 1.5, 1.0)
"""In turn: with what power of a span's length its error is taken to grow when a vertex goes."""

THINNINGS = {"fast": 0, "best": 30}
"""Trials, at the end, to do without vertices one by one: none comes, those that are needed are put back."""

THIN_POWER = 1.0
"""The power for these trials: what it promises is tried out."""


@dataclass(frozen=True, eq=False)
class Round:
    """One interpolation of some contours, measured; parts of the ragged arrays belong to these.

    Attributes:
        which: (k,) numbers of the contours.
        places, offsets, points: ragged vertices. found: the curves through them.
        pieces: ragged (n, 4, 2), the curves as Béziers; written: the same, rounded as they are written.
        measured: their distances from the outline.
        most: (k,) the largest bound of each contour.
    """

    which: IntArray
    places: FloatArray
    offsets: IntArray
    points: FloatArray
    found: BatchedInterpolation
    pieces: FloatArray
    written: FloatArray
    measured: steps.Measured
    most: FloatArray

    def part(self, values: FloatArray, i: int) -> FloatArray:
        """Part i of a ragged array."""
        return values[self.offsets[i] : self.offsets[i + 1]]


Kept = dict[int, tuple[Round, int]]
"""By contour: a round, and which part of it."""


def refined(
    contours: CanonicalContours, which: IntArray, options: Options, near: FloatArray, early: int | None = None
) -> Kept:
    """Fit contours.

    Args:
        contours: of a glyph. which: numbers of those to fit.
        near: (K,) by contour, how near the written curve has to be, in font units.
        early: in place of EARLY.

    Returns:
        The round with the fewest vertices that are near enough; if none is, that with the smallest bound.
    """
    search = _Search(contours, options, near)
    search.refine(which, EARLY[options.effort] if early is None else early)
    if THINNINGS[options.effort]:
        search.thin(which)
    return search.kept


class _Search:
    """The search for the vertices of a glyph's contours."""

    def __init__(self, contours: CanonicalContours, options: Options, near: FloatArray) -> None:
        self.contours, self.options, self.near = contours, options, near
        self.angle = float(np.radians(options.corner_angle))
        self.kept: Kept = {}

    def refine(self, which: IntArray, early: int) -> None:
        """Begin with what is known of the outline; add vertices, and take out others, until all contours pass."""
        contours, options, near = self.contours, self.options, self.near
        left = np.full(len(near), PRUNINGS[options.effort])
        passed = np.zeros(len(near), dtype=np.bool_)
        every = np.ones(len(near), dtype=np.bool_)
        places, offsets = steps.first_places(contours, which, self.angle, options.max_ratio, near, options.variant)
        for turn in range(ROUNDS):
            done = self.attempt(which, places, offsets)
            which, places, offsets = done.which, done.places, done.offsets
            passed[which] = done.most <= near[which]
            fewer = every if turn < early else passed & (left > 0)
            left[which] -= passed[which]
            which, places, offsets = steps.changed(
                contours, which, places, offsets, done.points, done.measured.bounds,
                done.measured.gaps, done.measured.worst, near, ~passed, fewer, self.angle, options.max_ratio,
                POWERS[turn % len(POWERS)],
            )  # fmt: skip
            if len(which) == 0:
                break

    def thin(self, which: IntArray) -> None:
        """Take out vertices of the contours that passed, as long as they still do."""
        contours, near = self.contours, self.near
        which = np.array([k for k in which.tolist() if _passes(self.kept[k], near[k])], dtype=np.int64)
        if len(which) == 0:
            return
        parts = [self.kept[k] for k in which.tolist()]
        places = [found.part(found.places, i) for found, i in parts]
        done = self.attempt(which, np.concatenate(places), np.cumsum([0] + [len(part) for part in places]))
        keep = np.ones(len(done.places), dtype=np.bool_)
        good = steps.Good(done.places, done.offsets, done.points, done.measured.gaps, keep, ~keep)
        for _ in range(THINNINGS[self.options.effort]):
            which, good = steps.thinned(
                contours, near, self.angle, self.options.max_ratio, THIN_POWER, done.which, done.places, done.offsets,
                done.points, done.measured.bounds, done.measured.gaps, good,
            )  # fmt: skip
            if len(which) == 0:
                break
            counts = np.cumsum(good.keep)[good.offsets[1:] - 1]
            done = self.attempt(which, good.places[good.keep], np.concatenate([[0], counts]))

    def attempt(self, which: IntArray, places: FloatArray, offsets: IntArray) -> Round:
        """Interpolate contours through their points at places, measure, and keep what is better than before."""
        contours, options = self.contours, self.options
        points = steps.polygons(contours, which, places, offsets)
        try:
            found = interpolated(points, offsets, options)
        except GlyphsplineError as error:
            error.contour = None if error.contour is None else int(which[error.contour])
            raise
        if found.whole[:, 1].sum() < len(places):  # duplicates were merged
            kept = [found.kept[a : a + n] + a for a, n in zip(offsets[:-1], found.whole[:, 1], strict=True)]
            return self.attempt(which, places[np.concatenate(kept)], np.cumsum([0] + [len(part) for part in kept]))
        pieces, written = steps.beziers(found.controls, found.knots, offsets, 10.0**options.precision)
        measured = steps.measured(contours, which, places, offsets, written, self.near)
        most = np.maximum.reduceat(measured.bounds, offsets[:-1])
        done = Round(which, places, offsets, points, found, pieces, written, measured, most)
        for i, k in enumerate(which.tolist()):
            if k not in self.kept or _better((done, i), self.kept[k], self.near[k]):
                self.kept[k] = done, i
        return done


def _passes(found: tuple[Round, int], near: float) -> bool:
    return bool(found[0].most[found[1]] <= near)


def _better(new: tuple[Round, int], old: tuple[Round, int], near: float) -> bool:
    """Whether a part of a round is to be kept in place of another one."""
    if _passes(old, near):
        counts = [found.offsets[i + 1] - found.offsets[i] for found, i in (new, old)]
        return _passes(new, near) and bool(counts[0] < counts[1])
    return bool(new[0].most[new[1]] < old[0].most[old[1]])
