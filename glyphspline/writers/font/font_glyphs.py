"""A glyph as a font stores it, in whole units or, where those are too coarse, in CFF fractions; with its error."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from fontTools.misc.roundTools import otRound
from fontTools.pens.boundsPen import BoundsPen
from fontTools.pens.cu2quPen import Cu2QuPen
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen

from ...curves.bezier import as_cubic
from ...curves.integrals import area
from ...errors import GlyphsplineError
from ...fitting.results import GlyphResult
from ...outlines.outline import Contour, Outline

Flavour = Literal["otf", "ttf"]

ROUNDING = math.sqrt(0.5)
"""Largest distance by which rounding to whole units moves a control point, and so, by convexity, the curve."""

FINE = 64
"""Parts of a unit to which CFF coordinates are rounded where whole units would break the tolerance. Sums of such
numbers are exact in the format's 16.16 fixed point."""

QUADRATIC_SHARE = 0.1
"""Least share of the tolerance for the approximation of cubics by quadratics."""

LIMIT = 32767
"""Largest coordinate of a font."""


@dataclass(frozen=True)
class Drawn:
    """A glyph ready to be stored: ``data`` for the table, and its bounds.

    ``error`` bounds the two-sided distance from the source in font units; None if the conversion measured none.
    """

    data: Any
    bounds: tuple[float, float, float, float] | None
    error: float | None


def fitting_tolerance(tolerance: float, flavour: Flavour) -> float:
    """Tolerance for the fit such that the written font stays within ``tolerance``.

    An OTF has fractions, so almost nothing is subtracted. For a TTF the rounding and the approximation by quadratics
    are; if the tolerance is too small for those, the fit has half of it and glyphs are reported as beyond it.
    """
    left = tolerance - ROUNDING / FINE if flavour == "otf" else (1 - QUADRATIC_SHARE) * tolerance - ROUNDING
    return left if left > 0 else tolerance / 2


def drawn_result(result: GlyphResult, tolerance: float, flavour: Flavour, width: float | None) -> Drawn:
    """A converted glyph within ``tolerance`` of its source; ``width`` is for :func:`char_string`."""
    contours = oriented([contour.curve for contour in result.contours], flavour)
    measured = [contour.measures.deviation_bound or contour.measures.deviation for contour in result.contours]
    deviation = max((value for value in measured if value is not None), default=0.0)
    known = None not in measured
    left = tolerance - deviation - ROUNDING
    if flavour == "otf":
        whole = not known or left >= 0 or all(np.array_equal(c.points, np.rint(c.points)) for c in contours)
        data = char_string(contours, width, 1 if whole else FINE, result.outline.name)
        error = ROUNDING if whole else ROUNDING / FINE
    else:
        step = max(left if known else 0.0, QUADRATIC_SHARE * tolerance)
        data = quadratic_glyph(contours, step, result.outline.name)
        error = ROUNDING + (step if any((c.degrees == 3).any() for c in contours) else 0.0)
    return Drawn(data, bounds_of(data, contours), deviation + error if known else None)


def drawn_outline(outline: Outline, flavour: Flavour) -> Drawn:
    """The source outline of a glyph that was not converted, in the other format."""
    contours = oriented(outline.contours, flavour)
    if flavour == "otf":
        data = char_string(contours, round(outline.advance), 1, outline.name)
    else:
        data = quadratic_glyph(contours, outline.metrics.units_per_em / 2000, outline.name)
    return Drawn(data, bounds_of(data, contours), None)


def oriented(contours: Sequence[Contour], flavour: Flavour) -> list[Contour]:
    """The contours, all reversed if the ink lies on the wrong side of them.

    The total signed area is positive in CFF, which fills the left side, and negative in TrueType.
    """
    total = sum(area(contour.cubics()) for contour in contours)
    wrong = total < 0 if flavour == "otf" else total > 0
    return [contour.reversed() if wrong else contour for contour in contours]


def char_string(contours: Sequence[Contour], width: float | None, parts: int, name: str) -> Any:
    """A Type 2 char string with coordinates in multiples of 1/``parts`` unit; ``width`` is stored as given."""
    pen = T2CharStringPen(width, None, roundTolerance=0)
    stored = [rounded_cubics(contour, parts) for contour in contours]
    for contour in stored:
        check_size(contour.points, name)
        contour.draw(_WholeNumbers(pen) if parts == 1 else pen)
    return pen.getCharString(optimize=not any(map(doubles_back, stored)))


def rounded_cubics(contour: Contour, parts: int) -> Contour:
    """The contour as lines and cubics with coordinates in multiples of 1/``parts``."""
    raised = Contour.from_segments(part if len(part) == 2 else as_cubic(part) for part in contour.segments())
    return Contour(np.rint(parts * raised.points) / parts + 0.0, raised.degrees)


def doubles_back(contour: Contour) -> bool:
    """Whether a line goes back over the one before it: the char string optimiser would merge the two."""
    starts = contour.points[contour.offsets]
    arms = np.roll(starts, -1, axis=0) - starts
    lines = contour.degrees == 1
    before = np.roll(arms, 1, axis=0)
    opposite = ((arms * before).sum(axis=1) < 0) & (arms[:, 0] * before[:, 1] == arms[:, 1] * before[:, 0])
    return bool((opposite & lines & np.roll(lines, 1)).any())


class _WholeNumbers:
    """Passes ints to a pen: they are shorter in a char string than floats of the same value."""

    def __init__(self, pen: Any) -> None:
        self._pen = pen

    def __getattr__(self, method: str) -> Any:
        draw = getattr(self._pen, method)
        return lambda *points: draw(*[(int(x), int(y)) for x, y in points])


def quadratic_glyph(contours: Sequence[Contour], step: float, name: str) -> Any:
    """A TrueType glyph whose quadratics are within ``step`` of the contours before they are rounded."""
    collected = TTGlyphPen(None)
    pen = Cu2QuPen(collected, step, all_quadratic=True)
    for contour in contours:
        check_size(contour.points, name)
        contour.draw(pen)
    return collected.glyph()


def check_size(points: Any, name: str) -> None:
    """Refuse coordinates that a font cannot hold."""
    if len(points) and np.abs(points).max() > LIMIT:
        raise GlyphsplineError(f"coordinates beyond {LIMIT} do not fit into a font", glyph=name)


def bounds_of(data: Any, contours: Sequence[Contour]) -> tuple[float, float, float, float] | None:
    """The box around a stored glyph, in whole units."""
    if hasattr(data, "coordinates"):
        data.recalcBounds(None)
        return (data.xMin, data.yMin, data.xMax, data.yMax) if data.numberOfContours else None
    pen = BoundsPen(None)
    for contour in contours:
        contour.draw(pen)
    return pen.bounds and tuple(map(otRound, pen.bounds))
