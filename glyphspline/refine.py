"""Closed curves within a tolerance, for all contours of a glyph at once: vertices put in and taken out until they are.

Each round interpolates the contours that are not done in one compiled call, measures what would be written, and puts
vertices where a span is too far off. The measure is the certificate itself, so that a contour that passes is certified.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import FloatArray, IntArray
from .engine import Ragged, explain, interpolate_ragged
from .glyph import Options
from .smooth import rounds
from .smooth.chains import Chains

ROUNDS = 60
"""Rounds before giving up."""

EARLY = 1
"""Rounds in which vertices that seem not to be needed go while others come."""

PRUNINGS = {"fast": 0, "best": 0}
THIN=40; POW=0.
"""How often vertices are taken out of a contour that passed, to see whether it passes with fewer."""

POWERS = (3.0, 2.0, 1.5, 1.0)
"""In turn: the power of a span's length with which its error is taken to grow when a vertex goes."""

SHARE = 0.9
"""Share of the tolerance below which the error has to be expected to stay."""

SHARPNESS = 0.02
"""The certified bound may exceed the distances seen by this share of the tolerance."""


@dataclass(frozen=True, eq=False)
class Round:
    """One interpolation of some contours, measured; parts of the ragged arrays belong to these.

    Attributes:
        which: (k,) numbers of the contours.
        places, offsets, points: ragged vertices. found: the curves. pieces: ragged (n, 4, 2), rounded as written.
        bounds, gaps, worst, ends: ragged, of the spans; see :func:`.smooth.rounds.examined`.
        most: (k,) the largest bound of each contour.
    """

    which: IntArray
    places: FloatArray
    offsets: IntArray
    points: FloatArray
    found: Ragged
    pieces: FloatArray
    bounds: FloatArray
    gaps: FloatArray
    worst: FloatArray
    ends: FloatArray
    most: FloatArray


class Refinement:
    """The search for the vertices of a glyph's contours."""

    def __init__(self, chains: Chains, options: Options, near: FloatArray) -> None:
        self.chains, self.options, self.near = chains, options, near
        self.angle = float(np.radians(options.corner_angle))
        self.kept: dict[int, tuple[Round, int]] = {}
        """By contour: the round, and the part of it, with the fewest vertices that pass, or with the smallest bound."""

    def run(self) -> None:
        """Fill ``kept``."""
        chains, near = self.chains, self.near
        which = np.arange(len(near))
        prunings = np.full(len(near), PRUNINGS[self.options.effort])
        places, offsets = rounds.first_places(
            chains.cubics, chains.offsets, chains.lengths, chains.turns, which, self.angle, self.options.max_ratio, near
        )
        for turn in range(ROUNDS):
            done = self.attempt(which, places, offsets)
            passed = np.ones(len(near), dtype=np.bool_)
            passed[which] = done.most <= near[which]
            self._keep(done)
            fewer = passed & (prunings > 0) if turn >= EARLY else np.ones(len(near), dtype=np.bool_)
            prunings[which] -= passed[which]
            which, places, offsets = rounds.changed(
                chains.cubics, chains.offsets, chains.lengths, chains.turns, which, places, offsets, done.points,
                done.bounds, done.gaps, done.worst, near, ~passed, fewer, self.angle, self.options.max_ratio, POWERS[turn % len(POWERS)],
            )  # fmt: skip
            if len(which) == 0:
                break

    def thin(self) -> None:
        """Take out vertices of the contours that pass, as long as they do; what that leaves goes to ``kept``."""
        chains, near, ratio = self.chains, self.near, self.options.max_ratio
        which = np.array([k for k, (r, i) in self.kept.items() if r.most[i] <= near[k]], dtype=np.int64)
        parts = [self.kept[k] for k in which.tolist()]
        good = [r.places[r.offsets[i] : r.offsets[i + 1]] for r, i in parts]
        places, offsets = np.concatenate(good), np.cumsum([0] + [len(p) for p in good])
        done = self.attempt(which, places, offsets)
        state = (places, offsets, done.points, done.gaps, np.ones(len(places), bool), np.zeros(len(places), bool))
        for turn in range(THIN):
            which, *state = rounds.thinned(
                chains.offsets, chains.turns, near, self.angle, ratio, POW, which, done.places,
                done.offsets, done.points, done.bounds, done.gaps, *state,
            )  # fmt: skip
            if len(which) == 0:
                break
            keep = state[4]
            counts = np.add.reduceat(keep, state[1][:-1])
            done = self.attempt(which, state[0][keep], np.concatenate([[0], np.cumsum(counts)]))
            self._keep(done)

    def attempt(self, which: IntArray, places: FloatArray, offsets: IntArray) -> Round:
        """Interpolate and measure."""
        chains, options = self.chains, self.options
        points = rounds.polygons(chains.cubics, chains.offsets, which, places, offsets)
        found = interpolate_ragged(
            points, offsets, options.variant, margin=options.margin, fallback="knot",
            residual_tolerance=options.residual_tolerance, max_iterations=options.max_iterations, threads=1,
        )  # fmt: skip
        pieces = rounds.written(found.controls, found.knots, offsets, 10.0**options.precision)
        bounds, gaps, worst, ends = rounds.examined(
            chains.cubics, chains.offsets, which, places, offsets, pieces, self.near
        )
        most = np.maximum.reduceat(bounds, offsets[:-1])
        return Round(which, places, offsets, points, found, pieces, bounds, gaps, worst, ends, most)

    def _keep(self, done: Round) -> None:
        for i, k in enumerate(done.which.tolist()):
            if k in self.kept:
                before, j = self.kept[k]
                counts = [int(r.offsets[p + 1] - r.offsets[p]) for r, p in ((done, i), (before, j))]
                passes = [bool(r.most[p] <= self.near[k]) for r, p in ((done, i), (before, j))]
                if passes[1] and not (passes[0] and counts[0] < counts[1]):
                    continue
            self.kept[k] = done, i
