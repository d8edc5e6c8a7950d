"""The measures of a glyph for sorting and filtering, combined from those of its contours."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

MEASURES: dict[str, tuple[str, Callable[[Sequence[Any]], Any]]] = {
    "deviation": ("deviation", max),
    "deviation_bound": ("deviation, certified", max),
    "iterations": ("iterations", max),
    "residual": ("residual", max),
    "rate_bound": ("rate bound", max),
    "vertices": ("vertices", sum),
    "segments": ("segments", sum),
    "numbers": ("numbers to store", sum),
    "fallbacks": ("fallbacks", sum),
    "bending_energy": ("bending energy", sum),
    "max_curvature": ("largest curvature", max),
    "curvature_extrema": ("curvature extrema", sum),
    "source_curvature_extrema": ("curvature extrema, source", sum),
    "overshoot": ("overshoot", max),
    "length": ("length", sum),
    "area_change": ("change of area", lambda values: max(values, key=abs)),
    "new_crossings": ("new crossings", sum),
    "converged": ("converged", all),
    "within_tolerance": ("within tolerance", all),
}
"""The label of each measure, and how the values of contours combine to the glyph's: the worst, or the sum."""


def glyph_measures(contours: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """All of ``MEASURES`` for one glyph, None where no contour has it."""
    found: dict[str, Any] = dict.fromkeys(MEASURES)
    columns = zip(*[map(contour.get, MEASURES) for contour in contours], strict=True)
    for (key, (_, together)), column in zip(MEASURES.items(), columns, strict=False):
        values = [value for value in column if value is not None] if None in column else column
        if values:
            found[key] = together(values)
    return found
