"""Glyphs of a variable font fitted with the quadratics that ``glyf`` stores, in all masters at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ...fitting.options import Options
from ...outlines.masters import MasterContour, Masters
from ...readers import Font
from ...types import IntArray
from ..fonts.tables.font_glyphs import drop_endless
from .convert_masters import MastersContourResult, MastersResult, convert_masters, is_regular
from .quadratic_contours import in_quadratics, unchanged
from .quadratic_glyphs import Quadratics
from .stretches import Turning, tally


def quadratic_masters(source: Font | None, masters: Masters, options: Options) -> MastersResult:
    """A glyph in all masters in quadratics, as few points as follow it; or as it is, where none are to be had.

    Args:
        source: with outlines of either kind; None: the masters are of single fonts.
        options: the tolerance, which holds at every location.

    Raises:
        GlyphsplineError: see :func:`.convert_masters.convert_masters`.
    """
    tolerance, corners = options.tolerance_for(masters.metrics.units_per_em), masters.weights_at(masters.grid())
    tallies, known = dict[tuple[MasterContour, ...], IntArray](), None if source is None else glyphs_of(source)
    owns, shift = ({}, np.zeros(len(masters))) if known is None else known[0].own(known[1][masters.gid], masters)
    tolerance *= 1.0 if known is None else known[0].share(known[1][masters.gid])

    def fit(numbers: Sequence[int], share: float) -> list[MastersContourResult]:
        contours = tuple(masters.contours[c] for c in numbers)
        some = replace(unchanged(masters, contours), bounds=(0.0,) * len(numbers), numbers=tuple(numbers), fewest=True)
        if known is None or owns:  # or else a composite, whose components are drawn anew
            some = in_quadratics(some, owns, shift, share * tolerance, options)
            assert some.tally is not None
            tallies[some.contours] = some.tally
        return [
            MastersContourResult(
                contour, curve, inner, iterations=None, rate_bound=None, deviation_bound=bound,
                within_tolerance=bound <= tolerance, kept=kept(contour, curve), regular=is_regular(curve, corners),
            )
            for contour, curve, inner, bound in zip(contours, some.contours, some.inner, some.bounds, strict=True)
        ]  # fmt: skip

    result = convert_masters(masters, options, fit=fit)
    curves = tuple(each.curve for each in result.contours)
    if (found := tallies.get(curves)) is None:
        found = tally((0, 0), (Turning(masters), Turning(replace(masters, contours=curves, repeats=None))))
    return replace(result, tally=found)


def kept(source: MasterContour, made: MasterContour) -> int:
    """How many curves of a contour are in what was made of it."""
    there = {np.round(each, 3).tobytes() for each in np.swapaxes(made.cubics(), 0, 1)}
    curved = np.swapaxes(source.cubics(), 0, 1)[source.degrees > 1]
    return sum(np.round(each, 3).tobytes() in there for each in curved)


@lru_cache(maxsize=1)
def glyphs_of(source: Font) -> tuple[Quadratics, list[str]] | None:
    """The glyphs of a font, if it has ``glyf``, and their names as stored."""
    font = source.tables()
    if "glyf" not in font:
        return None
    drop_endless(font)
    return Quadratics(font), font.getGlyphOrder()
