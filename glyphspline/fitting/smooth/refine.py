"""Closed curves within a tolerance, for all contours of a batch at once, by laying and removing vertices.

Each round interpolates the unfinished contours in one compiled call, measures the curves as they are written, and where
a span misses the tolerance lays vertices anew, more and evenly, between the corners beside it. What has not come to
pass after some rounds gets vertices where it fails. The measure is the certificate: a contour that passes is certified.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...errors import GlyphsplineError
from ...interpolation.result import BatchedInterpolation
from ...outlines.contour_arrays import offsets_of
from ...types import FloatArray, IntArray
from ..closed_curves import beziers, interpolated
from ..options import Options
from . import steps
from .canonical_contours import CanonicalContours

ROUNDS = 80
"""Rounds before giving up."""

EARLY = 1
"""Rounds that also remove vertices that seem unnecessary."""

PRUNINGS = {"fast": 0, "best": 12}
"""How often a contour that passed loses such vertices and is refined again until it passes."""

LAID = 6
"""Rounds that lay vertices anew; later ones put them into the spans that fail, which ends sooner but is uneven."""

POWERS = (3.0, 2.0, 1.5, 1.0)
"""In turn, the assumed power of a span's length with which its error grows when a vertex is removed."""

THINNINGS = {"fast": 0, "best": 30}
"""Final trials that only remove vertices; those that prove necessary are restored."""

THIN_POWER = 1.0
"""The power for these trials, which may be optimistic because each trial is measured."""


@dataclass(frozen=True, eq=False)
class Round:
    """One interpolation of some contours, measured; parts of the ragged arrays belong to these.

    Attributes:
        trial: the polygons, and the distances of the curves as written from the outline.
        found: the curves through the polygons. pieces: ragged (n, 4, 2), the curves as Béziers; written: the same,
            rounded as they are written.
        most: (k,) the largest bound of each contour.
    """

    trial: steps.Trial
    found: BatchedInterpolation
    pieces: FloatArray
    written: FloatArray
    most: FloatArray

    def part(self, values: FloatArray, i: int) -> FloatArray:
        """Part i of a ragged array."""
        return values[self.trial.offsets[i] : self.trial.offsets[i + 1]]


Kept = dict[int, tuple[Round, int]]
"""By contour: a round, and which part of it."""


def refined(
    contours: CanonicalContours, which: IntArray, options: Options, near: FloatArray, early: int | None = None
) -> Kept:
    """Fit contours.

    Args:
        contours: of a glyph. which: numbers of those to fit.
        near: (K,) by contour, the distance allowed, in font units.
        early: in place of EARLY.

    Returns:
        By contour, the round with the fewest vertices that passed; if none did, that with the smallest bound.
    """
    search = _Search(contours, options, near)
    search.refine(which, EARLY if early is None else early)
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
        """Start from vertices spaced by the outline; add and remove vertices until all contours pass."""
        contours, options, near = self.contours, self.options, self.near
        left = np.full(len(near), PRUNINGS[options.effort])
        passed = np.zeros(len(near), dtype=np.bool_)
        every = np.ones(len(near), dtype=np.bool_)
        fields, places, offsets = steps.first_places(
            contours, which, self.angle, options.max_ratio, near, options.variant
        )
        for turn in range(ROUNDS):
            done = self.attempt(which, places, offsets)
            passed[which] = done.most <= near[which]
            fewer = every if turn < early else passed & (left > 0)
            left[which] -= passed[which]
            power = POWERS[turn % len(POWERS)]
            which, places, offsets = steps.changed(
                contours, fields, done.trial, near, ~passed, fewer, self.angle, options.max_ratio, options.variant,
                power, turn < LAID,
            )  # fmt: skip
            if len(which) == 0:
                break

    def thin(self, which: IntArray) -> None:
        """Remove vertices of the contours that passed, as long as they still pass."""
        contours, near = self.contours, self.near
        which = np.array([k for k in which.tolist() if _passes(self.kept[k], near[k])], dtype=np.int64)
        if len(which) == 0:
            return
        parts = [self.kept[k] for k in which.tolist()]
        places = [found.part(found.trial.places, i) for found, i in parts]
        trial = self.attempt(which, np.concatenate(places), offsets_of([len(part) for part in places])).trial
        keep = np.ones(len(trial.places), dtype=np.bool_)
        good = steps.Good(trial.places, trial.offsets, trial.points, trial.gaps, keep, ~keep)
        for _ in range(THINNINGS[self.options.effort]):
            which, good = steps.thinned(contours, near, self.angle, self.options.max_ratio, THIN_POWER, trial, good)
            if len(which) == 0:
                break
            counts = np.cumsum(good.keep)[good.offsets[1:] - 1]
            trial = self.attempt(which, good.places[good.keep], np.concatenate([[0], counts])).trial

    def attempt(self, which: IntArray, places: FloatArray, offsets: IntArray) -> Round:
        """Interpolate contours through their points at places, measure, and keep improvements."""
        contours, options = self.contours, self.options
        points = steps.polygons(contours, which, places, offsets)
        try:
            found = interpolated(points, offsets, options)
        except GlyphsplineError as error:
            error.contour = None if error.contour is None else int(which[error.contour])
            raise
        if found.whole[:, 1].sum() < len(places):  # duplicates were merged
            kept = [found.kept[a : a + n] + a for a, n in zip(offsets[:-1], found.whole[:, 1], strict=True)]
            return self.attempt(which, places[np.concatenate(kept)], offsets_of([len(part) for part in kept]))
        pieces, written = beziers(found.controls, found.knots, offsets, 10.0**options.precision)
        trial = steps.measured(contours, which, places, offsets, points, written, self.near)
        done = Round(trial, found, pieces, written, np.maximum.reduceat(trial.bounds, offsets[:-1]))
        for i, k in enumerate(which.tolist()):
            if k not in self.kept or _better((done, i), self.kept[k], self.near[k]):
                self.kept[k] = done, i
        return done


def _passes(found: tuple[Round, int], near: float) -> bool:
    return bool(found[0].most[found[1]] <= near)


def _better(new: tuple[Round, int], old: tuple[Round, int], near: float) -> bool:
    """Whether a part of a round replaces another one."""
    if _passes(old, near):
        counts = [len(found.part(found.trial.places, i)) for found, i in (new, old)]
        return _passes(new, near) and counts[0] < counts[1]
    return bool(new[0].most[new[1]] < old[0].most[old[1]])
