"""The measures of a glyph for sorting and filtering, combined from those of its contours."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

MEASURES: dict[str, Callable[[Sequence[Any]], Any]] = {
    "deviation": max,
    "deviation_bound": max,
    "iterations": max,
    "residual": max,
    "rate_bound": max,
    "vertices": sum,
    "segments": sum,
    "numbers": sum,
    "fallbacks": sum,
    "bending_energy": sum,
    "max_curvature": max,
    "curvature_extrema": sum,
    "source_curvature_extrema": sum,
    "overshoot": max,
    "length": sum,
    "area_change": lambda values: max(values, key=abs),
    "new_crossings": sum,
    "converged": all,
    "within_tolerance": all,
    "collapsed": any,
    "source_kept": any,
}
"""How the values of contours combine to the glyph's, for each measure: the worst, or the sum."""


def glyph_measures(contours: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """All of ``MEASURES`` for one glyph, None where no contour has it."""
    found: dict[str, Any] = dict.fromkeys(MEASURES)
    columns = zip(*[map(contour.get, MEASURES) for contour in contours], strict=True)
    for (key, together), column in zip(MEASURES.items(), columns, strict=False):
        values = [value for value in column if value is not None] if None in column else column
        if values:
            found[key] = together(values)
    return found
