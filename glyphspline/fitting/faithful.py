"""Fits of contours, and closer ones of those that cross or collapse where their source does not."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from ..errors import GlyphsplineError
from ..outlines.contour_arrays import ContourArrays, lines_and_cubics, offsets_of
from ..outlines.segments import all_cubics
from ..types import BoolArray, IntArray
from .first_good import first_good
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

Refit = Callable[[list[int]], Iterable[Result]]
"""From the numbers of contours to other results of these."""


class GlyphTrial(NamedTuple, Generic[Result]):
    """One try of a whole glyph: results of its contours, and what changed in them, see :data:`.topology.Changes`."""

    results: Sequence[Result]
    found: Changes

    def wrong(self, is_outside: Callable[[Result], bool]) -> tuple[int, int]:
        """The number of results outside the tolerance, then of changes.

        A crossing of two contours counts twice; crossings that are not counted count as a thousand.
        """
        return sum(map(is_outside, self.results)), int(np.where(self.found < 0, 1_000, self.found).sum())


def tries(
    trial: GlyphTrial[Result], refits: Iterable[Refit[Result]],
    judged: Callable[[Sequence[Result]], GlyphTrial[Result]], which: Callable[[Changes], BoolArray] = changed,
) -> Iterator[GlyphTrial[Result]]:  # fmt: skip
    """A trial, and others, each with other results for those contours of the last one that are wrong.

    Args:
        refits: in turn. judged: makes a trial of results. which: contours that are wrong, by what changed.
    """
    yield trial
    for refit in refits:
        wrong = np.flatnonzero(which(trial.found)).tolist()
        if not wrong:
            return
        results = list(trial.results)
        for c, result in zip(wrong, refit(wrong), strict=True):
            results[c] = result
        trial = judged(results)
        yield trial


Part = tuple[ConvertedContours, int]
"""The result of one contour: results of several, and its number among these."""


def faithful(
    contours: ContourArrays, glyphs: IntArray, fits: Fits, options: Options, tolerance: float
) -> ConvertedContours:
    """Fit contours; those that cross or collapse where their source does not are fitted again.

    They are fitted more closely, then in another mode, and in the end kept as they are in the source, as far as the
    mode has it. Of what is tried for a glyph that with the fewest contours outside the tolerance counts, and among
    these the first with the fewest changes. What still crosses in it is flagged.

    Args:
        contours: of all glyphs. glyphs: (G + 1,) where the contours of each glyph begin.

    Raises:
        GlyphsplineError: a contour that cannot be fitted; its ``contour`` is the index.
    """
    best = _parts(fits.fit(contours, 0))
    kept = _compared(contours, best, glyphs, options)
    corners_kept, source_kept = np.zeros((2, len(best)), dtype=np.bool_)
    for g in np.unique(np.searchsorted(glyphs, np.flatnonzero(changed(kept)), side="right") - 1).tolist():
        a, b = glyphs[g : g + 2].tolist()
        steps = _settled(contours, a, b, GlyphTrial(best[a:b], kept[:, a:b]), fits, options, tolerance)
        own, other, last = (trial.results for trial in steps)
        best[a:b], kept[:, a:b] = last, steps[-1].found
        corners_kept[a:b] = [new is not old for new, old in zip(other, own, strict=True)]
        source_kept[a:b] = [new is not old for new, old in zip(last, other, strict=True)]
    result = assembled(best)
    columns = {
        "new_crossings": [None if count < 0 else count for count in kept[0].tolist()],
        "collapsed": (kept[1] > 0).tolist(),
        "corners_kept": corners_kept.tolist(),
        "source_kept": source_kept.tolist(),
    }
    return with_geometry(replace(result, measures={**result.measures, **columns}), options)


def _settled(
    contours: ContourArrays, a: int, b: int, first: GlyphTrial[Part], fits: Fits, options: Options, tolerance: float
) -> tuple[GlyphTrial[Part], GlyphTrial[Part], GlyphTrial[Part]]:
    """The best of the fits of a glyph, of contours a up to b; of those of another mode too; and of its source too."""
    source = contours.part(a, b)

    def judged(results: Sequence[Part]) -> GlyphTrial[Part]:
        return GlyphTrial(results, _compared(source, results, np.array([0, b - a]), options))

    def better(
        trial: GlyphTrial[Part], refits: Iterable[Refit[Part]], which: Callable[[Changes], BoolArray]
    ) -> GlyphTrial[Part]:
        return first_good(tries(trial, refits, judged, which), lambda each: each.wrong(_is_outside))

    def fitted(of: Fits, turn: int, which: list[int]) -> list[Part]:
        try:
            return _parts(of.fit(source.chosen(which), turn))
        except GlyphsplineError as error:
            error.contour = None if error.contour is None else a + which[error.contour]
            raise

    own = better(first, [partial(fitted, fits, turn) for turn in range(1, fits.tries)], changed)
    other, instead = own, fits.instead
    if instead is not None:
        for turn in range(instead.tries):
            other = better(other, [partial(fitted, instead, turn)], lambda found: changed(found[:1]))
    keeps_crossing = fits.keeps_crossing or (instead is not None and instead.keeps_crossing)
    kept_whole = np.array([[keeps_crossing], [fits.keeps_collapsed]])
    last = better(
        other, [lambda which: _parts(as_source(source.chosen(which), options, tolerance))],
        lambda found: ((found > 0) & kept_whole).any(axis=0),
    )  # fmt: skip
    return own, other, last


def _compared(source: ContourArrays, results: Sequence[Part], glyphs: IntArray, options: Options) -> Changes:
    """What changed in results as they are written."""
    made = assembled(results).curves
    written = made.rounded(options.precision)
    found = changes(source, written, glyphs)
    # Stretches that stay as they are in the source keep their decimals in fonts.
    if options.is_for_fonts and not np.array_equal(made.points, written.points):
        other = changes(source, made, glyphs)  # what changed the more counts
        found = np.where(np.minimum(found, other) < 0, -1, np.maximum(found, other))
    return found


def _is_outside(result: Part) -> bool:
    return result[0].measures["within_tolerance"][result[1]] is False


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
