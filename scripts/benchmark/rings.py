"""How often smooth curves bend beyond the floor, with corners held and with corners passed through as in the paper."""

from __future__ import annotations

from functools import partial
from time import process_time

import numpy as np

import glyphspline as gs

from .batch import least, seconds
from .faithful import FACES, Face, of_faces
from .measure import Row

LEAST = {"Kouzan gyosho": 6.0}
"""Extrema beyond the floor a contour that a face may have; others one."""

WENKAI = Face("LXGW WenKai", "LXGWWenKai-Regular.ttf", False)


def rows() -> list[Row]:
    """All faces that are installed."""
    return of_faces((*FACES, WENKAI), face_rows)


def face_rows(face: Face, glyphs: list[gs.Outline]) -> list[Row]:
    """Extrema beyond the floor, vertices, crossings, peaks and time, each against corners that are passed through.

    A contour below the floor has none beyond it, so that it does not make up for another one.
    """
    held, passed = (gs.Options(tolerance=1.0, corners="smooth", hold_corners=hold) for hold in (True, False))
    beyond, vertices, peaks, crossing, missed, kept = [], [], [], [], 0, 0
    gs.convert_many(glyphs[:5], held)
    times = least(3, *(seconds(partial(gs.convert_many, glyphs, options), process_time) for options in (held, passed)))
    for options in (held, passed):
        results = gs.convert_many(glyphs, options)
        measures = [contour.measures for result in results for contour in result.contours]
        smooth = [m for m in measures if not (m.corners_kept or m.source_kept)]
        beyond.append([(m.curvature_extrema or 0) - (m.curvature_extrema_floor or 0) for m in smooth])
        vertices.append(sum(m.vertices for m in measures))
        peaks.append(np.median([m.max_curvature or 0.0 for m in smooth]))
        crossing.append(sum(any(c.measures.new_crossings for c in result.contours) for result in results))
        if options is held:
            missed = sum(not m.within_tolerance or (m.rate_bound or 0.0) >= 1 for m in measures)
            kept = len(measures) - len(smooth)
    (a, b), limit = map(np.array, beyond), LEAST.get(face.name, 1.0)
    counts = (
        f"medians {np.median(a):g}, {np.median(b):g}; those below the floor as less than none {a.mean():.3g}; "
        f"corners passed {b.clip(0).mean():.3g}; {len(glyphs)} glyphs"
    )
    sharp = f"corners passed {crossing[1]}; {kept} of {len(measures)} contours are fitted sharp or kept"
    return [
        Row(f"{face.name}: extrema beyond the floor a contour", float(a.clip(0).mean()), "", limit, 0.0, False, counts),
        Row(f"{face.name}: vertices, corners held / passed", vertices[0] / vertices[1], "x", 1.2, 1.1, False),
        Row(f"{face.name}: contours not certified", missed, "", 0.5, 0.5, False),
        Row(f"{face.name}: glyphs that cross anew", crossing[0], "", 10.0, 0.5, False, sharp),
        Row(f"{face.name}: largest curvature, held / passed", peaks[0] / peaks[1], "x", 1.6, 1.4, False, "medians"),
        Row(f"{face.name}: time, held / passed", times[0] / times[1], "x", 1.5, 1.0, False),
    ]
