"""Fits of contours, and closer ones of those that cross or collapse where their source does not."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from ..curves.crossings import meetings
from ..errors import GlyphsplineError
from ..outlines.contour_arrays import NO_POLYLINES, ContourArrays, Polylines, joined, offsets_of
from ..outlines.segments import all_cubics
from ..types import BoolArray, IntArray
from .apart import drawn_apart
from .measures import distance_columns, with_geometry
from .options import Options
from .results import ConvertedContours, assembled
from .topology import Changes, changes

APART = (0.35, 0.7)
"""Shares of the tolerance by which contours are drawn apart, if closer fits do not help."""


class Fits(NamedTuple):
    """What a mode tries for contours.

    Attributes:
        tries: how many fits there are; later ones are closer to the source.
        fit: from contours, and the number of a fit, to their results, of which the geometry is not yet measured.
        apart: the number of the fit of contours that are drawn apart, after which that is tried; 0 if it is not.
            Contours that touch in the source are drawn apart at once: closer fits do not help.
        keeps_collapsed, keeps_crossing: whether contours that collapse, or cross, in every fit are kept as they are in
            the source.
    """

    tries: int
    fit: Callable[[ContourArrays, int], ConvertedContours]
    apart: int = 0
    keeps_collapsed: bool = True
    keeps_crossing: bool = False


class _State:
    """A result of each contour, and what changed in it."""

    def __init__(self, chosen: Sequence[tuple[ConvertedContours, int]], found: Changes) -> None:
        self.chosen, self.found = list(chosen), found

    def copy(self) -> _State:
        return _State(self.chosen, self.found.copy())

    def written(self, a: int, b: int, precision: int) -> ContourArrays:
        """The contours from a up to b as they are written."""
        return assembled(self.chosen[a:b]).curves.rounded(precision)

    def rank(self, a: int, b: int) -> tuple[int, int]:
        """Lower is better: contours from a up to b that are outside the tolerance, then changes."""
        outside = sum(own.measures["within_tolerance"][k] is False for own, k in self.chosen[a:b])
        return outside, self.found.part(a, b).number


def faithful(
    contours: ContourArrays, glyphs: IntArray, fits: Fits, options: Options, tolerance: float
) -> ConvertedContours:
    """Fit contours; those that cross or collapse where their source does not are fitted again.

    They are fitted more closely, then drawn apart, and in the end kept as they are in the source, as far as the mode
    has it. Of what is tried for a glyph, the first with the fewest contours outside the tolerance counts, and among
    these the first with the fewest changes. What still crosses in it is flagged.

    Args:
        contours: of all glyphs. glyphs: (G + 1,) where the contours of each glyph begin.

    Raises:
        GlyphsplineError: a contour that cannot be fitted; its ``contour`` is the index.
    """
    first = fits.fit(contours, 0)
    found = changes(contours, first.curves.rounded(options.precision), glyphs)
    state = _State([(first, c) for c in range(contours.num_contours)], found)
    search = _Search(contours, glyphs, fits, options, tolerance, state)
    if found.number:
        search.run()
    crossings = [None if count < 0 else count for count in search.best.found.new_crossings.tolist()]
    columns = {
        "new_crossings": crossings,
        "collapsed": search.best.found.collapsed.tolist(),
        "source_kept": search.kept.tolist(),
    }
    result = assembled(search.best.chosen)
    return with_geometry(replace(result, measures={**result.measures, **columns}), options.precision)


class _Search:
    """The search for results that enclose what their sources do.

    Attributes:
        state: what was tried last. best: what counts so far. kept: (C,) which of its contours are the source's.
    """

    def __init__(
        self, contours: ContourArrays, glyphs: IntArray, fits: Fits, options: Options, tolerance: float, state: _State
    ) -> None:
        self.contours, self.glyphs, self.fits = contours, glyphs, fits
        self.options, self.tolerance = options, tolerance
        self.state, self.best = state, state.copy()
        self.kept = np.zeros(contours.num_contours, dtype=np.bool_)

    def run(self) -> None:
        """Try what the mode has, as long as there are changes."""
        touching = self.touching() if self.fits.apart else np.zeros_like(self.kept)
        for turn in range(1, self.fits.tries):
            self.attempt(self.state.found.any & ~touching, partial(self.fit_closer, turn))
            near = self.state.copy()
            for share in APART if turn == self.fits.apart else ():
                self.attempt(self.state.found.new_crossings > 0, partial(self.fit_apart, near, share))
        self.state = self.best.copy()
        found = self.state.found
        wrong = (found.collapsed & self.fits.keeps_collapsed) | ((found.new_crossings > 0) & self.fits.keeps_crossing)
        self.attempt(wrong, self.keep, keeps=True)

    def touching(self) -> BoolArray:
        """(C,) whether a contour that crosses touches itself or others in the source."""
        found = np.zeros_like(self.kept)
        for a, b in self.ranges(np.flatnonzero(self.state.found.new_crossings > 0).tolist()):
            source = self.contours.part(a, b)
            met, _ = meetings(all_cubics(source), source.offsets, np.array([0, b - a]))
            found[a + met[~np.isnan(met[:, 4]), :2].astype(np.int64)] = True
        return found

    def attempt(self, wrong: BoolArray, fit: Callable[[list[int]], ConvertedContours], keeps: bool = False) -> None:
        """Put other results in the place of some contours', and keep what is better for their glyphs."""
        which = np.flatnonzero(wrong).tolist()
        if not which:
            return
        own = fit(which)
        for k, c in enumerate(which):
            self.state.chosen[c] = own, k
        for a, b in self.ranges(which):
            written = self.state.written(a, b, self.options.precision)
            self.state.found.put(a, b, changes(self.contours.part(a, b), written, np.array([0, b - a])))
            if self.state.rank(a, b) < self.best.rank(a, b):
                self.best.chosen[a:b] = self.state.chosen[a:b]
                self.best.found.put(a, b, self.state.found.part(a, b))
                self.kept[a:b] = wrong[a:b] & keeps

    def ranges(self, which: list[int]) -> list[tuple[int, int]]:
        """The contours of each glyph that has one of some contours: the first, and the one after the last."""
        those = np.unique(np.searchsorted(self.glyphs, which, side="right") - 1)
        return [(int(self.glyphs[g]), int(self.glyphs[g + 1])) for g in those]

    def keep(self, which: list[int]) -> ConvertedContours:
        """Contours as they are in the source."""
        return as_source(self.contours.chosen(which), self.options, self.tolerance)

    def fit_closer(self, turn: int, which: list[int]) -> ConvertedContours:
        """Contours by a later fit."""
        return self.fit(self.contours.chosen(which), which, turn)

    def fit(self, contours: ContourArrays, which: list[int], turn: int) -> ConvertedContours:
        """A fit of contours that are those numbered ``which``, or stand for them."""
        try:
            return self.fits.fit(contours, turn)
        except GlyphsplineError as error:
            error.contour = None if error.contour is None else which[error.contour]
            raise

    def fit_apart(self, near: _State, share: float, which: list[int]) -> ConvertedContours:
        """The closest fits of contours drawn apart where those of ``near`` cross. Their distance is not measured."""
        shift, moved = share * self.tolerance, []
        for a, b in self.ranges(which):
            written = near.written(a, b, self.options.precision)
            apart = drawn_apart(self.contours.part(a, b), written, shift, self.tolerance)
            moved.append(apart.chosen([c - a for c in which if a <= c < b]))
        found, source = self.fit(joined(moved), which, self.fits.apart), self.contours.chosen(which)
        bounds = [bound + shift for bound in found.measures["deviation_bound"]]
        measures = {
            **found.measures,
            **distance_columns([None] * len(bounds), bounds, self.tolerance),
        }
        return replace(found, source=source, measures=measures)


def as_source(contours: ContourArrays, options: Options, tolerance: float) -> ConvertedContours:
    """Contours as they are: lines, and cubics in the place of curves. Nothing is interpolated."""
    cubics, lines = all_cubics(contours), contours.degrees == 1
    needed = np.ones((len(cubics), 3), dtype=np.bool_)
    needed[lines, 1:] = False
    degrees = np.where(lines, 1, 3)
    starts = offsets_of(degrees)[contours.offsets]
    curves = ContourArrays(cubics[:, :3][needed], degrees, contours.offsets, starts)
    polygons = Polylines(cubics[:, 0].copy(), contours.offsets, np.ones(contours.num_contours, dtype=np.bool_))
    # A curve is within the largest distance of its Bézier points from those of another one.
    moved = np.hypot(*(curves.rounded(options.precision).points - curves.points).T)
    distances = np.maximum.reduceat(moved, starts[:-1]).tolist()
    segments = np.diff(contours.offsets).tolist()
    measures = {
        "vertices": segments, "segments": segments, "numbers": (2 * np.diff(starts)).tolist(),
        **distance_columns(distances, distances, tolerance),
    }  # fmt: skip
    return ConvertedContours(
        contours, curves, polygons, (), NO_POLYLINES, np.zeros(contours.num_contours + 1, dtype=np.int64), measures
    )
