"""How far the glyphs of a written file are from their sources: the file is read again, whatever was to be in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf, isfinite
from typing import Any, NamedTuple, TypeVar

import numpy as np

from ...fitting.results import GlyphResult
from ...outlines.outline import Contours, Outline
from ...readers import Source
from ...types import rounded_up

BATCH = 200
"""Glyphs read at once."""

Key = TypeVar("Key", str, int)
"""What a glyph is asked for by: its name or its index."""


class Promise(NamedTuple):
    """What is said of a glyph of a file: that it is within the tolerance of an outline."""

    outline: Outline
    tolerance: float

    @classmethod
    def of(cls, result: GlyphResult, tolerance: float) -> Promise | None:
        """What is said of a result; None if its conversion measured no distance."""
        measures = [contour.measures for contour in result.contours]
        if any(each.deviation_bound is None and each.deviation is None for each in measures):
            return None
        return cls(replace(result.outline, contours=Contours(result.arrays.source)), tolerance)

    def apart(self, found: Outline) -> float:
        """A bound of how far an outline is from the one that was promised; see :func:`held`."""
        from ...outlines.outline_distance import BOUND, chains_of, outline_distance  # imports the compiler

        given, made = self.outline.arrays, found.arrays
        if not (len(given.degrees) and len(made.degrees)):
            return inf if len(given.degrees) or len(made.degrees) else 0.0
        snapped, unit = self.outline.snapped + found.snapped, self.outline.metrics.units_per_em / 1000
        if all(map(np.array_equal, given, made)):
            return snapped
        row, _ = outline_distance(chains_of(given), chains_of(made), unit, self.tolerance - snapped)
        return float(row[BOUND]) + snapped


class Held(NamedTuple):
    """How near glyphs of a file are to what was promised.

    Attributes:
        bounds: by name, certified bounds of their distances, in both directions, in font units.
        beyond: names of those that are farther than their tolerance.
    """

    bounds: Mapping[str, float]
    beyond: Sequence[str]

    @property
    def largest(self) -> float | None:
        """The largest of the bounds; None if there are none."""
        return max(self.bounds.values(), default=None)

    @property
    def words(self) -> tuple[str, str]:
        """How far the farthest is; and which are beyond the tolerance: to be added to a sentence."""
        near = "" if self.largest is None else f", within {rounded_up(self.largest, 3):.3g} units of the source"
        far = f"; {len(self.beyond)} may be beyond the tolerance: {', '.join(self.beyond[:5])}" if self.beyond else ""
        return near, far

    def facts(self) -> dict[str, dict[str, Any]]:
        """By name, as the manifest has it: bounds are rounded up, and null if they are infinite."""
        beyond = {*self.beyond}
        return {
            name: {"bound": rounded_up(bound, 6) if isfinite(bound) else None, "within_tolerance": name not in beyond}
            for name, bound in self.bounds.items()
        }


def held(written: Source, promises: Mapping[Key, Promise]) -> Held:
    """Read glyphs of a file, by name or index, and measure how far they are from what was promised.

    A bound exceeds the distance by at most 1 %, or a hundredth of a thousandth of the em, and the tolerance only where
    the distance does. It is infinite where one of the two outlines is empty, or the glyph cannot be read.
    """
    bounds, beyond, every = dict[str, float](), list[str](), [*promises.items()]
    for first in range(0, len(every), BATCH):
        some = every[first : first + BATCH]
        read = written.outlines([key for key, _ in some], errors="return")
        for (_, promise), found in zip(some, read, strict=True):
            name, bound = promise.outline.name, promise.apart(found) if isinstance(found, Outline) else inf
            bounds[name] = bound
            beyond += [name] if bound > promise.tolerance else []
    return Held(bounds, beyond)
