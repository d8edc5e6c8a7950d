"""Glyphs of a variable font fitted with the quadratics that ``glyf`` stores, in all masters at once.

Between corners, kinks and lines of the source all points on the curve become implied, and control points are as few as
follow it. What is stored is certified, and compared with the source as ``check`` sees it: see :mod:`.stretches`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, replace
from functools import lru_cache

import numpy as np

from ...checks.turns import joint_controls, turns_of
from ...fitting.convert_masters import MastersContourResult, MastersResult, convert_masters, is_regular
from ...fitting.options import Options
from ...outlines.masters import MasterContour, Masters
from ...readers import Font
from ...types import BoolArray
from .master_deltas import Redrawn, Tally
from .quadratic_contours import Own, Quadratic
from .stretches import Turning, settle, tally
from .variable_glyf import Quadratics

SMOOTH = 1.0
"""Degrees of turn in the worst master up to which two curves are one arc of quadratics, which turns nowhere. Ends of
arcs are rounded, and kink by that where handles are short."""


def quadratic_masters(source: Font, masters: Masters, options: Options) -> MastersResult:
    """A glyph of a variable font in quadratics, as few points as follow it; or as it is, where none are to be had.

    Args:
        source: with outlines of either kind. options: the tolerance, which holds at every location.

    Raises:
        GlyphsplineError: see :func:`...fitting.convert_masters.convert_masters`.
    """
    tolerance = options.tolerance_for(masters.metrics.units_per_em)
    owns, shift, before = dict[int, Own](), np.zeros(len(masters)), sum(c.points.shape[1] for c in masters.contours)
    if known := glyphs_of(source):
        glyphs, names = known
        owns, shift = glyphs.own(names[masters.gid], masters)
        before = sum(len(each.on) for each in owns.values())
    whole, corners = unchanged(masters), masters.weights_at(masters.grid())
    tallies = dict[tuple[MasterContour, ...], Tally]()

    def fit(numbers: Sequence[int], share: float) -> list[MastersContourResult]:
        some = Redrawn(
            masters, tuple(whole.contours[c] for c in numbers), tuple(whole.inner[c] for c in numbers),
            (0.0,) * len(numbers), tuple(numbers), known is not None,
        )  # fmt: skip
        stays, plans = known is not None and not owns, list[Quadratic]()
        if not stays:
            plans = [Quadratic(some, c, owns, shift, share * tolerance) for c in range(len(numbers))]
            turning = settle(masters, plans)
            after = sum(len(plan.points()[1]) for plan in plans)
            stays = known is not None and len(numbers) == len(owns) and after > before
        if stays:  # a composite, whose components are drawn anew, or a glyph that would have more points
            return [_result(contour, contour, np.zeros(len(contour), dtype=bool)) for contour in some.contours]
        made = [
            _result(masters.contours[number], plan.stored(), plan.inside(), plan.bound, plan.held)
            for number, plan in zip(numbers, plans, strict=True)
        ]
        tallies[tuple(each.curve for each in made)] = tally((before, after), turning, False)
        return made

    def _result(
        contour: MasterContour, curve: MasterContour, inner: BoolArray, bound: float = 0.0, kept: int | None = None
    ) -> MastersContourResult:
        return MastersContourResult(
            contour, curve, inner, iterations=None, rate_bound=None, deviation_bound=bound,
            within_tolerance=bound <= tolerance, kept=int((contour.degrees > 1).sum()) if kept is None else kept,
            regular=is_regular(curve, corners),
        )  # fmt: skip

    result = convert_masters(masters, options, fit=fit)
    curves = tuple(each.curve for each in result.contours)
    if (found := tallies.get(curves)) is None:
        turning = Turning(masters), Turning(replace(masters, contours=curves, repeats=None))
        found = tally((before, before), turning, False)
    return replace(result, tally=np.array(astuple(found)))


@lru_cache(maxsize=1)
def glyphs_of(source: Font) -> tuple[Quadratics, list[str]] | None:
    """The glyphs of a font, if it has ``glyf``, and their names as stored."""
    font = source.tables()
    return (Quadratics(font), font.getGlyphOrder()) if "glyf" in font else None


def unchanged(masters: Masters) -> Redrawn:
    """A glyph as it is. Curves that meet smoothly in all masters are to stay smooth."""
    contours, inner = tuple(masters.contours), []
    for contour in contours:
        turns = np.nan_to_num(np.abs(turns_of(joint_controls(contour))), nan=180.0).max(axis=0)
        curved = contour.degrees > 1
        inner.append((turns < SMOOTH) & curved & np.roll(curved, 1))
    return Redrawn(masters, contours, tuple(inner))
