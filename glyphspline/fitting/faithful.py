"""Fits of contours, and closer ones of those that cross or collapse where their source does not."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from ..errors import GlyphsplineError
from ..outlines.contour_arrays import ContourArrays, lines_and_cubics, offsets_of
from ..outlines.segments import all_cubics
from ..types import BoolArray, IntArray
from .measures import distance_columns, with_geometry
from .options import Options
from .results import ConvertedContours, assembled, not_fitted
from .topology import Changes, changed, changes


class Fits(NamedTuple):
    """What a mode tries for contours.

    Attributes:
        tries: how many fits there are; later ones are closer to the source.
        fit: from contours, and the number of a fit, to their results, before their geometry is measured.
        keeps_collapsed, keeps_crossing: whether contours that collapse, or cross, in every fit are kept as they are in
            the source.
        instead: fits of another mode, for contours that cross in every fit of this one.
    """

    tries: int
    fit: Callable[[ContourArrays, int], ConvertedContours]
    keeps_collapsed: bool = True
    keeps_crossing: bool = False
    instead: Fits | None = None


Result = TypeVar("Result")


class Search(Generic[Result]):
    """The search for results that enclose what their sources do, for one outline or for all masters of one.

    Of what is tried for a glyph, the first with the fewest contours outside the tolerance counts, and among these the
    first with the fewest changes.

    Attributes:
        tried, found: the (C,) results tried last, and what changed in them. best, kept: the same of those that count.
    """

    def __init__(
        self, glyphs: IntArray, results: Iterable[Result],
        compare: Callable[[int, int, Sequence[Result]], Changes], is_outside: Callable[[Result], bool],
    ) -> None:  # fmt: skip
        """Begin with first results.

        Args:
            glyphs: (G + 1,) where the contours of each glyph begin.
            compare: from a range of contours, a to b - 1, and their results, to what changed in them.
            is_outside: whether a result is outside the tolerance.
        """
        self.glyphs, self.compare, self.is_outside = glyphs, compare, is_outside
        self.tried = list(results)
        self.found = compare(0, len(self.tried), self.tried)
        self.best, self.kept = list(self.tried), self.found.copy()

    def attempt(self, wrong: BoolArray, fit: Callable[[list[int]], Iterable[Result]]) -> None:
        """Put other results in the place of some contours', and keep what is better for their glyphs."""
        which = np.flatnonzero(wrong).tolist()
        if not which:
            return
        for c, result in zip(which, fit(which), strict=True):
            self.tried[c] = result
        for a, b in self.ranges(which):
            tried, found = self.tried[a:b], self.compare(a, b, self.tried[a:b])
            self.found[..., a:b] = found
            if self._rank(tried, found) < self._rank(self.best[a:b], self.kept[..., a:b]):
                self.best[a:b] = tried
                self.kept[..., a:b] = found

    def _rank(self, results: Sequence[Result], found: Changes) -> tuple[int, int]:
        """Lower is better: the number of results outside the tolerance, then of changes.

        A crossing of two contours counts twice; crossings that are not counted count as a thousand.
        """
        return sum(map(self.is_outside, results)), int(np.where(found < 0, 1_000, found).sum())

    def go_back(self) -> None:
        """Go on from the best results."""
        self.tried, self.found = list(self.best), self.kept.copy()

    def ranges(self, which: Sequence[int]) -> list[tuple[int, int]]:
        """The contours of each glyph that has one of some contours: the first, and the one after the last."""
        those = np.unique(np.searchsorted(self.glyphs, which, side="right") - 1)
        return [(int(self.glyphs[g]), int(self.glyphs[g + 1])) for g in those]


Part = tuple[ConvertedContours, int]
"""The result of one contour: results of several, and its number among these."""


def faithful(
    contours: ContourArrays, glyphs: IntArray, fits: Fits, options: Options, tolerance: float
) -> ConvertedContours:
    """Fit contours; those that cross or collapse where their source does not are fitted again.

    They are fitted more closely, then in another mode, and in the end kept as they are in the source, as far as the
    mode has it: see :class:`Search`. What still crosses in the best result is flagged.

    Args:
        contours: of all glyphs. glyphs: (G + 1,) where the contours of each glyph begin.

    Raises:
        GlyphsplineError: a contour that cannot be fitted; its ``contour`` is the index.
    """

    def compare(a: int, b: int, results: Sequence[Part]) -> Changes:
        source, made, own = contours.part(a, b), assembled(results).curves, np.unique(glyphs.clip(a, b)) - a
        written = made.rounded(options.precision)
        found = changes(source, written, own)
        # Stretches that stay as they are in the source keep their decimals in fonts.
        if options.is_for_fonts and not np.array_equal(made.points, written.points):
            other = changes(source, made, own)  # what changed the more counts
            found = np.where(np.minimum(found, other) < 0, -1, np.maximum(found, other))
        return found

    def is_outside(result: Part) -> bool:
        return result[0].measures["within_tolerance"][result[1]] is False

    def fitted(of: Fits, turn: int, which: list[int]) -> list[Part]:
        try:
            return _parts(of.fit(contours.chosen(which), turn))
        except GlyphsplineError as error:
            error.contour = None if error.contour is None else which[error.contour]
            raise

    search = Search(glyphs, _parts(fits.fit(contours, 0)), compare, is_outside)
    for turn in range(1, fits.tries):
        search.attempt(changed(search.found), partial(fitted, fits, turn))
    own_best, instead = list(search.best), fits.instead
    if instead is not None:
        for turn in range(instead.tries):
            search.go_back()
            search.attempt(changed(search.kept[:1]), partial(fitted, instead, turn))
    fits_best = list(search.best)
    crosses, collapsed = search.kept > 0
    keeps_crossing = fits.keeps_crossing or (instead is not None and instead.keeps_crossing)
    wrong = (collapsed & fits.keeps_collapsed) | (crosses & keeps_crossing)
    search.go_back()
    search.attempt(wrong, lambda which: _parts(as_source(contours.chosen(which), options, tolerance)))
    result = assembled(search.best)
    columns = {
        "new_crossings": [None if count < 0 else count for count in search.kept[0].tolist()],
        "collapsed": (search.kept[1] > 0).tolist(),
        "corners_kept": [new is not old for new, old in zip(fits_best, own_best, strict=True)],
        "source_kept": [new is not old for new, old in zip(search.best, fits_best, strict=True)],
    }
    return with_geometry(replace(result, measures={**result.measures, **columns}), options)


def _parts(found: ConvertedContours) -> list[Part]:
    return [(found, k) for k in range(len(found))]


def as_source(contours: ContourArrays, options: Options, tolerance: float) -> ConvertedContours:
    """Contours as they are: lines, and cubics in the place of curves. Nothing is interpolated."""
    points, degrees = lines_and_cubics(all_cubics(contours), contours.degrees == 1)
    starts = offsets_of(degrees)[contours.offsets]
    found = not_fitted(contours, ContourArrays(points, degrees, contours.offsets, starts))
    # A curve is within the largest distance of its Bézier points from those of another one.
    moved = np.hypot(*(found.curves.rounded(options.precision).points - found.curves.points).T)
    distances = np.maximum.reduceat(moved, starts[:-1]).tolist()
    return replace(found, measures={**found.measures, **distance_columns(distances, distances, tolerance)})
