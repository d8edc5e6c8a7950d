"""The smooth mode: one closed C2 curve for each contour, within a tolerance, for all contours of a batch at once.

The K masters of a contour are one curve in R^{2K}, with vertices at the same places of all of them.

Each round interpolates the unfinished contours in one compiled call, measures the curves as they are written, and where
a span misses the tolerance lays vertices anew, more and evenly, between the corners beside it. A contour that still
misses it after some rounds gets vertices where it does. The measure is the certificate: a contour that passes is
certified.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...curves.pairing import SHARPNESS, pair_stretches
from ...errors import GlyphsplineError
from ...interpolation.polygon import NO_FLAGS
from ...interpolation.result import BatchedInterpolation, Interpolation, reversed_interpolation, turned
from ...outlines.contour_arrays import ContourArrays, Polylines, cubic_contours, offsets_of
from ...outlines.masters import MasterContour
from ...outlines.segments import all_cubics
from ...types import BoolArray, FloatArray, IntArray, Views
from ..closed_curves import beziers, interpolated
from ..faithful import Fits
from ..ladders import HELD_TRY, SMOOTH_TRIES, SmoothTry
from ..measures import distance_columns, solved_columns
from ..options import Options
from ..results import ConvertedContours
from . import fairing, steps
from .canonical_contours import canonical_contours, chain_of
from .spacing import growth_of

ROUNDS = 80
"""Rounds before giving up."""

POWERS = (3.0, 2.0, 1.5, 1.0)
"""In turn, the assumed power of a span's length with which its error grows when a vertex is removed."""

PRUNINGS = {"fast": 0, "best": 12}
"""How often a contour that passed loses such vertices and is refined again until it passes."""

THINNINGS = {"fast": 0, "best": 30}
"""Final trials that only remove vertices; those that prove necessary are restored."""


def smooth_fits(options: Options, tolerance: float) -> Fits:
    """Fits of a closed C2 curve to each contour, within ``tolerance`` in font units, and then closer."""
    held = (HELD_TRY,) if options.hold_corners else ()
    tries = (SMOOTH_TRIES[0], *held, *SMOOTH_TRIES[1:])

    def fit(contours: ContourArrays, attempt: int) -> ConvertedContours:
        chosen = tries[attempt]
        search = _Search(all_cubics(contours)[None], contours.offsets, None, options, chosen.share * tolerance)
        search.search(chosen)
        return search.converted(contours, tolerance)

    return Fits(len(tries), fit)


def fit_smooth_masters(
    cubics: FloatArray, offsets: IntArray, mixes: FloatArray, options: Options, near: float, first: bool
) -> list[tuple[MasterContour, float, int, float]]:
    """Closed C2 curves for the masters of C contours.

    Args:
        cubics: (K, m, 4, 2) their segments in each master. offsets: (C + 1,) where each contour begins.
        mixes: (V, K) weights of the masters at the corners of the design space's grid.
        near: the distance allowed, in font units. first: whether this is the contours' first fit.

    Returns:
        Of each its curve in all masters, the certified distance from the source in the whole design space, and the
        iterations and the rate bound of variant 2.

    Raises:
        GlyphsplineError: a contour that cannot be fitted; its ``contour`` is the index.
    """
    search = _Search(cubics, offsets, mixes, options, near)
    search.search(SMOOTH_TRIES[0 if first else 1]._replace(fair=True))
    return [search.in_masters(k) for k in range(len(offsets) - 1)]


@dataclass(frozen=True, eq=False)
class Round:
    """One interpolation of some contours, measured; parts of the ragged arrays belong to these.

    Attributes:
        trial: the polygons, and the distances of the curves as written from the outline.
            Plain ones are measured as they are written, those of masters in the instances that are measured.
        found: the curves through the polygons. pieces: ragged (n, K, 4, 2), the curves as Béziers.
        held: ragged, the vertices whose control points stay at them; () where none does.
        most: (k,) the largest bound of each contour.
    """

    trial: steps.Trial
    found: BatchedInterpolation
    pieces: FloatArray
    held: BoolArray
    most: FloatArray

    def part(self, values: Any, i: int) -> Any:
        """Part i of a ragged array."""
        return values[self.trial.offsets[i] : self.trial.offsets[i + 1]]


def _mixed(mixes: FloatArray, cubics: FloatArray) -> FloatArray:
    """Cubics in V instances, (n, V, 4, 2), from those in the masters, (n, K, 4, 2)."""
    return np.ascontiguousarray(np.einsum("vk,nkpc->nvpc", mixes, cubics))


class _Search:
    """The search for the vertices of a glyph's contours.

    It is an iteration, not a choice among proposals: each round moves, adds and removes the vertices of all contours
    that are not done, from what was measured in the last one, in one call.

    Attributes:
        contours: in all masters. mixes: (V, K) weights of the masters in the instances that are measured, and
            instances: the contours in these; None for plain outlines.
        near: the distance allowed, in font units. rules: how vertices are laid.
        hold: (C,) whether control points of corners are held at them.
        kept: by contour, a round and which part of it: that with the fewest vertices that passed; if none did, that
            with the smallest bound.
    """

    def __init__(
        self, cubics: FloatArray, offsets: IntArray, mixes: FloatArray | None, options: Options, near: float
    ) -> None:
        self.contours = self.instances = canonical_contours(cubics, offsets)
        self.mixes, self.options, self.near = mixes, options, near
        if mixes is not None:
            every = self.contours.cubics.reshape(-1, len(cubics), 4, 2)
            self.instances = self.contours._replace(cubics=_mixed(mixes, every).reshape(-1, 4, 2))
        self.hold = np.zeros(len(self.contours.flipped), dtype=np.bool_)
        growth = growth_of(options.max_ratio, options.variant)
        self.rules = steps.Rules(near, float(np.radians(options.corner_angle)), options.max_ratio, growth)
        self.kept: dict[int, tuple[Round, int]] = {}

    def search(self, chosen: SmoothTry) -> None:
        """Search for the curves of all contours."""
        early, self.hold[:] = chosen.early, chosen.holds and self.options.hold_corners
        # One round also removes vertices that seem unnecessary. Those beside held corners do not grow fewer by it.
        self.refine(int(not self.hold.any()) if early is None else early)
        if missed := [k for k, found in self.kept.items() if self.hold[k] and not self.passes(found)]:
            self.hold[missed] = False
            self.refine(1 if early is None else early, missed)
        self.thin()
        if self.options.hold_corners and chosen.fair:
            self.fair()

    def refine(self, early: int, again: Sequence[int] = ()) -> None:
        """Start from vertices spaced by the outline; add and remove vertices until all contours pass.

        Args:
            early: rounds that also remove vertices. again: the contours to fit; none are all of them.
        """
        contours, options, count = self.contours, self.options, len(self.contours.flipped)
        left, which = np.full(count, PRUNINGS[options.effort]), np.arange(count)
        passed, every = np.zeros(count, dtype=np.bool_), np.ones(count, dtype=np.bool_)
        fields, places, offsets = steps.first_places(contours, self.rules, options.variant, self.hold)
        if again:
            which = np.array(sorted(again), dtype=np.int64)
            parts = [places[offsets[k] : offsets[k + 1]] for k in which.tolist()]
            places, offsets = np.concatenate(parts), offsets_of([len(part) for part in parts])
        for turn in range(ROUNDS):
            done = self.attempt(which, places, offsets)
            passed[which] = done.most <= self.near
            fewer = every if turn < early else passed & (left > 0)
            left[which] -= passed[which]
            which, places, offsets = steps.changed(
                contours, fields, done.trial, ~passed, fewer, self.hold, self.rules,
                # Later rounds put vertices into the spans that fail, which ends sooner but is uneven.
                POWERS[turn % len(POWERS)], turn < 6,
            )  # fmt: skip
            if len(which) == 0:
                break

    def thin(self) -> None:
        """Remove vertices of the contours that passed, as long as they still pass.

        A polygon that passes is good, and the next trial omits vertices of it that seem unnecessary. If a trial fails,
        the vertices beside the failure are restored and kept from then on.
        """
        left = [item for item in sorted(self.kept.items()) if self.passes(item[1])]
        good: dict[int, tuple[Round, int]] = {}
        keep, needed = dict[int, BoolArray](), dict[int, BoolArray]()  # of the vertices of good polygons
        for _ in range(THINNINGS[self.options.effort]):
            places = {}
            for k, (found, i) in left:
                bounds = found.part(found.trial.bounds, i)
                if found.most[i] <= self.near:
                    needed[k] = needed[k][keep[k]] if k in good else np.zeros(len(bounds), dtype=np.bool_)
                    good[k], keep[k] = (found, i), np.ones(len(bounds), dtype=np.bool_)
                trial, part = good[k][0].trial, partial(good[k][0].part, i=good[k][1])
                if found.most[i] > self.near:
                    back = steps.put_back(part(trial.points), keep[k], bounds, self.near, self.rules.ratio)
                    keep[k], needed[k] = back, needed[k] | (back & ~keep[k])
                if keep[k].all():
                    turns = self.contours.turns[slice(*self.contours.offsets[k : k + 2])]
                    # Optimistic: the error grows with the length alone, as each trial is measured.
                    keep[k] = steps.sparse(
                        part(trial.points), part(trial.places), turns, bool(self.hold[k]), needed[k], part(trial.gaps),
                        self.rules, 1.0,
                    )  # fmt: skip
                if not keep[k].all():
                    places[k] = part(trial.places)[keep[k]]
            if not places:
                break
            offsets = offsets_of([len(part) for part in places.values()])
            found = self.attempt(np.array([*places]), np.concatenate([*places.values()]), offsets)
            left = [(k, (found, i)) for i, k in enumerate(places)]

    def fair(self) -> None:
        """Let vertices leave the outline where a contour that passed bends more often than it has to."""
        rounds: dict[int, tuple[Round, BoolArray]] = {}
        for found, i in self.kept.values():
            _, keep = rounds.setdefault(id(found), (found, np.zeros(len(found.most), dtype=np.bool_)))
            keep[i] = found.most[i] <= self.near
        if not rounds:
            return
        parts = [self.uneven(found, keep) for found, keep in rounds.values()]
        counts, before, surplus, most, limits, *columns = map(np.concatenate, zip(*parts, strict=True))
        splines, trial = fairing.Splines(*columns[:4]), steps.Trial(*columns[4:])._replace(offsets=offsets_of(counts))
        again, moved = limits > 0, trial.points.copy()
        for _ in range(fairing.TRIES):
            if len(before) == 0:
                break
            fairing.fair(self.contours, trial, splines, surplus, limits, again, self.near, moved)
            done = self.run(trial.which, trial.places, trial.offsets, moved)
            if len(done.pieces) < len(moved):  # vertices fell together
                break
            starts = trial.offsets[:-1]
            extrema, _, peaks, _ = fairing.bends(
                self.contours, trial, done.pieces, np.ones(len(before), dtype=np.bool_), False
            )
            good = (done.most <= self.near) & (np.maximum.reduceat(peaks, starts) <= most).all(axis=1)
            fewer = extrema.sum(axis=1) < before
            for n in np.flatnonzero(good & fewer & (done.found.arrays.rates < 1)).tolist():
                self.kept[int(trial.which[n])] = done, n
            again = fairing.lowered(limits, trial.offsets, done.trial.bounds, self.near, peaks, most)
            left = ~good & np.logical_or.reduceat(again, starts).any(axis=1)
            every = (before, surplus, most, limits, again, moved, *splines, *trial)
            before, surplus, most, limits, again, moved, *columns = steps.chosen(every, trial.offsets, left)
            splines, trial = fairing.Splines(*columns[:4]), steps.Trial(*columns[4:])

    def uneven(self, found: Round, keep: BoolArray) -> list[Any]:
        """What :meth:`fair` begins with, of the contours that are to be faired among some of a round.

        Returns:
            Numbers of vertices, extrema, those beyond the floor, largest curvature allowed, limits, and columns of
            splines and of the trial.
        """
        trial, arrays = found.trial, found.found.arrays
        extrema, surplus, peaks, uneven = fairing.bends(self.contours, trial, found.pieces, keep, True)
        starts, counts = trial.offsets[:-1], np.diff(trial.offsets)
        most = fairing.PEAK * np.maximum.reduceat(peaks, starts)
        limits = np.where(uneven, fairing.LIMIT * self.near, 0.0)
        held = found.held if len(found.held) else np.zeros(len(found.pieces), dtype=np.bool_)
        columns = (
            counts, extrema.sum(axis=1), surplus, most, limits, arrays.controls, arrays.knots, arrays.parameters, held,
            *trial,
        )  # fmt: skip
        return steps.chosen(columns, trial.offsets, np.add.reduceat(uneven.any(axis=1), starts) > 0)

    def attempt(self, which: IntArray, places: FloatArray, offsets: IntArray) -> Round:
        """Interpolate contours through their points at places, measure, and keep improvements."""
        done = self.run(which, places, offsets, steps.polygons(self.contours, which, places, offsets))
        for i, k in enumerate(done.trial.which.tolist()):
            if k not in self.kept or self.wrong((done, i)) < self.wrong(self.kept[k]):
                self.kept[k] = done, i
        return done

    def run(self, which: IntArray, places: FloatArray, offsets: IntArray, points: FloatArray) -> Round:
        """Interpolate contours through points at their places, or beside them, and measure."""
        try:
            held = steps.held_corners(self.contours, which, places, offsets, self.rules.corner_angle, self.hold)
            held = held if held.any() else NO_FLAGS
            found = interpolated(points, offsets, self.options, held)
        except GlyphsplineError as error:
            error.contour = None if error.contour is None else int(which[error.contour])
            raise
        if found.arrays.whole[:, 1].sum() < len(places):  # duplicates were merged
            parts = [
                found.arrays.kept[a : a + n] + a for a, n in zip(offsets[:-1], found.arrays.whole[:, 1], strict=True)
            ]
            kept = np.concatenate(parts)
            return self.run(which, places[kept], offsets_of([len(part) for part in parts]), points[kept])
        pieces, written = beziers(found.arrays.controls, found.arrays.knots, offsets, 10.0**self.options.precision)
        written = written if self.mixes is None else _mixed(self.mixes, pieces)
        trial = steps.measured(self.instances, which, places, offsets, points, written, self.near)
        return Round(trial, found, pieces, held, np.maximum.reduceat(trial.bounds, offsets[:-1]))

    def passes(self, found: tuple[Round, int]) -> bool:
        """Whether a part of a round is within the distance allowed."""
        return bool(found[0].most[found[1]] <= self.near)

    def wrong(self, found: tuple[Round, int]) -> tuple[float, int]:
        """How far a part of a round is off if that is too far, and else how many vertices it has."""
        done, i = found
        return (0.0, len(done.part(done.trial.places, i))) if self.passes(found) else (float(done.most[i]), 0)

    def converted(self, contours: ContourArrays, tolerance: float) -> ConvertedContours:
        """The results: measured in the fitted direction, returned in the given one."""
        flipped = self.contours.flipped.tolist()
        kept = [self.kept[k] for k in range(len(flipped))]
        points = [found.part(found.trial.points, i) for found, i in kept]
        pieces = [found.part(found.pieces, i)[:, 0] for found, i in kept]
        for n, (found, i) in enumerate(kept):
            held = found.part(found.held, i) if len(found.held) else found.held
            if held.any():  # the vertex is where the curve passes by
                points[n] = np.where(held[:, None], pieces[n][:, 0], points[n])
        controls = [found.part(found.found.arrays.controls, i) for found, i in kept]
        offsets, closed = offsets_of([len(part) for part in pieces]), np.ones(len(kept), dtype=np.bool_)
        bounds, gaps = zip(*(self.certificate(k, tolerance) for k in range(len(kept))), strict=True)
        for n in np.flatnonzero(flipped).tolist():
            points[n], controls[n], pieces[n] = turned(points[n]), turned(controls[n]), pieces[n][::-1, ::-1]

        def arcs() -> list[Interpolation]:
            results = [found.found.results()[i] for found, i in kept]
            return [reversed_interpolation(r) if back else r for r, back in zip(results, flipped, strict=True)]

        solved = solved_columns([(found.found, np.array([i])) for found, i in kept])
        return ConvertedContours(
            contours,
            cubic_contours(np.concatenate(pieces), offsets),
            Polylines(np.concatenate(points), offsets, closed),
            Views(len(kept), arcs),
            Polylines(np.concatenate(controls), offsets, closed),
            np.arange(len(kept) + 1),
            solved | distance_columns(gaps, bounds, tolerance),
        )

    def in_masters(self, k: int) -> tuple[MasterContour, float, int, float]:
        """The curve kept for contour k, in the given direction; see :func:`fit_smooth_masters`."""
        found, i = self.kept[k]
        cubics, arrays = found.part(found.pieces, i).swapaxes(0, 1), found.found.arrays
        if self.contours.flipped[k]:
            cubics = cubics[:, ::-1, ::-1]
        curve = MasterContour(cubics[:, :, :3].reshape(len(cubics), -1, 2), np.full(cubics.shape[1], 3))
        return curve, float(found.most[i]), int(arrays.whole[i, 2]), float(arrays.rates[i])

    def certificate(self, k: int, tolerance: float) -> tuple[float, float]:
        """Certified bound, and distance seen, of the curve kept for contour k."""
        (found, i), trial = self.kept[k], self.kept[k][0].trial
        written, outline = found.part(trial.pieces, i)[:, 0], chain_of(self.contours, k)
        ends = trial.ends[trial.offsets[i] + i : trial.offsets[i + 1] + i + 1]
        spans = found.part(trial.bounds, i), found.part(trial.gaps, i)
        bound, gap = steps.sharpened(written, outline, *spans, ends, SHARPNESS * tolerance)
        if bound <= tolerance:
            return bound, gap
        # Pairing in both directions is slow and seldom better.
        anchors = np.stack([np.arange(len(ends), dtype=np.float64), ends], axis=1)
        parts = [(rows, np.array([0, len(rows)])) for rows in (written, outline, anchors)]
        others = pair_stretches(parts[0], parts[1], parts[2], SHARPNESS * tolerance, tolerance)
        other, seen = (float(values.max()) for values in others)
        return (other, seen) if other < bound else (bound, gap)
