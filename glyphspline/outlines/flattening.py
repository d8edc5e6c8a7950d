"""Contours as polygons within a certified distance."""

from __future__ import annotations

import numpy as np

from ..curves.bezier import evaluate
from ..errors import OptionError, is_positive, require
from ..types import FloatArray
from .contour_arrays import ContourArrays, Polylines, offsets_of

MOST_POINTS = 5_000_000
"""Points of all polygons together: far more than a drawing has, and few enough for the memory."""

ROUNDING = 16 * np.finfo(np.float64).eps
"""Bound of the rounding errors of a point, relative to the largest coordinate."""


def flattened(contours: ContourArrays, flatness: float) -> tuple[Polylines, float]:
    """Polygons whose corners lie on the contours, and a bound of their distance from them, at most ``flatness``.

    A segment becomes n chords over equal parts of its parameter range. Chord and curve at equal parameters are at most
    max |B''| / (8 n²) apart, and |B''| is at most d (d - 1) times the longest second difference of the d + 1 Bézier
    points (convex hull property). This bounds the distance both ways, from the curve and from the polygon.

    Args:
        contours: of lines, quadratics and cubics. flatness: a positive distance, in font units.

    Returns:
        A closed polygon for each contour, its first point not repeated at the end; and the bound.

    Raises:
        OptionError: flatness is not positive, or so small that rounding errors or millions of points would result.
    """
    require(is_positive(flatness), "flatness is a positive distance in font units", flatness)
    points, degrees, offsets, starts = contours
    rounding = ROUNDING * float(np.abs(points).max(initial=0.0))
    aim = flatness - rounding
    if aim < flatness / 2:
        raise OptionError(f"flatness is more than {2 * rounding:.2g}, the rounding of such coordinates")
    first = np.cumsum(degrees) - degrees
    end = first + degrees
    some = np.flatnonzero(np.diff(offsets))
    end[offsets[some + 1] - 1] = starts[some]  # a contour ends where it begins
    counts = np.ones(len(degrees), dtype=np.int64)
    bound, curved = 0.0, []
    for degree in (2, 3):
        which = np.flatnonzero(degrees == degree)
        index = first[which, None] + np.arange(degree + 1)
        index[:, -1] = end[which]
        pieces = points[index]
        bends = np.hypot(*np.moveaxis(np.diff(pieces, n=2, axis=1), 2, 0)).max(axis=1, initial=0.0)
        apart = degree * (degree - 1) / 8 * bends
        needed = np.maximum(np.ceil(np.sqrt(apart / aim) * (1 + 1e-12)), 1.0)
        if not needed.sum() <= MOST_POINTS:
            raise OptionError(f"flatness {flatness:g} asks for {needed.sum():.3g} points, more than {MOST_POINTS}")
        counts[which] = needed
        bound = max(bound, float((apart / needed**2).max(initial=0.0)))
        curved.append((which, pieces))
    at = offsets_of(counts)
    found = np.empty((at[-1], 2))
    lines = degrees == 1
    found[at[:-1][lines]] = points[first[lines]]
    for which, pieces in curved:
        own = np.repeat(np.arange(len(which)), counts[which])
        step = np.arange(len(own)) - np.repeat(offsets_of(counts[which])[:-1], counts[which])
        found[np.repeat(at[which], counts[which]) + step] = evaluate(pieces[own], step / counts[which][own])
    closed = np.ones(contours.num_contours, dtype=np.bool_)
    return Polylines(found, at[offsets], closed), bound + rounding if bound else 0.0


def polygons_of(lines: Polylines) -> list[FloatArray]:
    """The points (n, 2) of each polyline, as views."""
    return np.split(lines.points, lines.offsets[1:-1]) if len(lines.closed) else []
