"""Fits of contours, and closer ones of those that cross or collapse where their source does not."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..outlines.contour_arrays import NO_POLYLINES, ContourArrays, Polylines, offsets_of
from ..outlines.segments import all_cubics
from ..types import IntArray
from .measures import distance_columns, geometric_columns
from .options import Options
from .results import ConvertedContours, assembled
from .topology import Changes, changes


class Fits(NamedTuple):
    """What a mode tries for a contour.

    Attributes:
        tries: how many fits there are; later ones are closer to the source.
        fit: from the numbers of contours, and that of a fit, to their results.
        keeps_collapsed, keeps_crossing: whether contours that collapse, or cross, in every fit are kept as they are in
            the source.
    """

    tries: int
    fit: Callable[[Sequence[int], int], ConvertedContours]
    keeps_collapsed: bool = True
    keeps_crossing: bool = False


class _State:
    """A result of each contour, and what changed in it."""

    def __init__(self, chosen: Sequence[tuple[ConvertedContours, int]], found: Changes) -> None:
        self.chosen, self.found = list(chosen), found

    def copy(self) -> _State:
        return _State(self.chosen, self.found.copy())

    def take(self, a: int, b: int, other: _State) -> None:
        """Replace the contours from a up to b by those of another state."""
        self.chosen[a:b] = other.chosen[a:b]
        for mine, values in zip(self.found, other.found, strict=True):
            mine[a:b] = values[a:b]

    def rank(self, a: int, b: int) -> tuple[int, int]:
        """Lower is better: contours from a up to b that are outside the tolerance, then changes."""
        outside = sum(own.measures["within_tolerance"][k] is False for own, k in self.chosen[a:b])
        return outside, self.found.part(a, b).number


def faithful(
    contours: ContourArrays, glyphs: IntArray, fits: Fits, options: Options, tolerance: float
) -> ConvertedContours:
    """Fit contours; those that cross or collapse where their source does not are fitted again more closely.

    Of what is tried for a glyph, the first with the fewest contours outside the tolerance counts, and among these the
    first with the fewest changes. Contours that collapse in it are kept as they are in the source. What still crosses
    is flagged.

    Args:
        contours: of all glyphs. glyphs: (G + 1,) where the contours of each glyph begin.

    Raises:
        GlyphsplineError: a contour that cannot be fitted; its ``contour`` is the index.
    """
    first = fits.fit(range(contours.num_contours), 0)
    found = changes(contours, first.curves.rounded(options.precision), glyphs)
    best = _State([(first, c) for c in range(contours.num_contours)], found)
    state = best.copy() if found.number else best
    kept = np.zeros(contours.num_contours, dtype=np.bool_)
    for attempt in range(1, fits.tries + 1):
        last = attempt == fits.tries
        if last:
            state = best.copy()
        collapsed = state.found.collapsed & (fits.keeps_collapsed or not last)
        wrong = collapsed | ((state.found.new_crossings > 0) & (fits.keeps_crossing or not last))
        which = np.flatnonzero(wrong).tolist()
        if not which:
            continue
        own = as_source(contours.chosen(which), options, tolerance) if last else fits.fit(which, attempt)
        for k, c in enumerate(which):
            state.chosen[c] = own, k
        for g in np.unique(np.searchsorted(glyphs, which, side="right") - 1).tolist():
            a, b = glyphs[g : g + 2].tolist()
            written = assembled(state.chosen[a:b]).curves.rounded(options.precision)
            now = changes(contours.part(a, b), written, np.array([0, b - a]))
            for values, new in zip(state.found, now, strict=True):
                values[a:b] = new
            if state.rank(a, b) < best.rank(a, b):
                best.take(a, b, state)
                kept[a:b] = wrong[a:b] & last
    crossings = [None if count < 0 else count for count in best.found.new_crossings.tolist()]
    columns = {"new_crossings": crossings, "collapsed": best.found.collapsed.tolist(), "source_kept": kept.tolist()}
    result = assembled(best.chosen)
    return replace(result, measures={**result.measures, **columns})


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
        **geometric_columns(curves, options.precision, contours, polygons),
    }  # fmt: skip
    return ConvertedContours(
        contours, curves, polygons, (), NO_POLYLINES, np.zeros(contours.num_contours + 1, dtype=np.int64), measures
    )
