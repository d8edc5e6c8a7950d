"""Union of overlapping contours by Skia's path operations (the extra ``overlaps``)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..curves.integrals import area
from ..curves.overshoot import chords
from ..extras import need
from ..types import FloatArray
from .contour_arrays import joined, offsets_of
from .open_paths import are_open
from .outline import Contour, Contours, Outline

SCANLINES = 1000
"""Scan lines on which the inked area of a glyph is measured."""


def remove_overlaps(outline: Outline) -> tuple[Outline, str | None]:
    """The outline with its closed contours united, and None; or the unchanged outline and a note why that failed.

    Raises:
        GlyphsplineError: skia-pathops is not installed.
    """
    pathops = need("overlaps")
    if not outline.contours:
        return outline, None
    if (opened := are_open(outline.arrays)).any():
        closed, strokes = (outline.arrays.chosen(np.flatnonzero(which)) for which in (~opened, opened))
        filled, note = remove_overlaps(replace(outline, contours=Contours(closed)))
        return replace(filled, contours=Contours(joined([filled.arrays, strokes]))), note
    areas = [area(contour.cubics()) for contour in outline.contours]
    clockwise = max(areas, key=abs) < 0  # the contour of the largest area is not a hole
    try:
        path = pathops.Path()
        outline.draw(path.getPen())
        path.simplify(fix_winding=True, keep_starting_points=True, clockwise=clockwise)
        united = contours_of(path)
    except pathops.PathOpsError as error:
        return outline, f"overlaps were left in: {error or 'path operations failed'}"
    if sorted(map(len, united)) == sorted(map(len, outline.contours)):  # no segment was cut
        return outline, None
    before, after = inked_area(outline.contours), inked_area(united)
    # Maximum relative change of the inked area. Scan lines are exact to 1e-3; a lost contour changes it by more.
    if abs(after - before) > 2e-3 * before:
        return outline, f"overlaps were left in: uniting them changed the area from {before:.0f} to {after:.0f}"
    return replace(outline, contours=united), None


def contours_of(path: Any) -> list[Contour]:
    """The contours of a ``pathops.Path``."""
    from pathops import PathVerb

    found: list[Contour] = []
    segments: list[FloatArray] = []
    start = here = (0.0, 0.0)
    for verb, points in [*path, (PathVerb.CLOSE, ())]:
        if verb not in (PathVerb.MOVE, PathVerb.CLOSE):
            segments.append(np.array([here, *points]))
            here = points[-1]
            continue
        if segments:
            found.append(Contour.from_segments([*segments, *([np.array([here, start])] if here != start else [])]))
        segments = []
        start = here = points[0] if points else start
    return found


def inked_area(contours: Sequence[Contour]) -> float:
    """Area filled by the nonzero winding rule, from evenly spaced scan lines."""
    polygons = [chords(contour.cubics())[0] for contour in contours if len(contour)]
    if not polygons:
        return 0.0
    start = np.concatenate(polygons)
    stop = np.concatenate([np.roll(polygon, -1, axis=0) for polygon in polygons])
    side = stop - start
    low, step = start[:, 1].min(), np.ptp(start[:, 1]) / SCANLINES
    at = low + (np.arange(SCANLINES) + 0.5) * step
    first, last = np.searchsorted(at, np.sort([start[:, 1], stop[:, 1]], axis=0))
    crossed = np.repeat(np.arange(len(start)), last - first)
    line = np.arange(len(crossed)) - np.repeat(offsets_of(last - first)[:-1] - first, last - first)
    x = start[crossed, 0] + (at[line] - start[crossed, 1]) / side[crossed, 1] * side[crossed, 0]
    order = np.lexsort((x, line))
    winding = np.cumsum(np.sign(side[crossed[order], 1]))  # 0 after each line, as polygons are closed
    return float(step * np.diff(x[order])[winding[:-1] != 0].sum())
