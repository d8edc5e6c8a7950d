"""Contours as polygons within a certified distance."""

from __future__ import annotations

import numpy as np

from ..curves.bezier import evaluate
from ..errors import OptionError, is_positive, require
from ..types import FloatArray
from .contour_arrays import ContourArrays, Polylines, offsets_of

MOST_POINTS = 5_000_000
"""Points of all polygons together: far more than a drawing has, and few enough for the memory."""


def flattened(contours: ContourArrays, flatness: float) -> tuple[Polylines, float]:
    """Polygons whose corners lie on the contours, and a bound of their distance from them, at most ``flatness``.

    A segment becomes n chords over equal parts of its parameter range. Chord and curve at equal parameters are at most
    max |B''| / (8 n²) apart, and |B''| is at most 6 times the longest second difference of its Bézier points as a cubic
    (convex hull property). This bounds the distance both ways, from the curve and from the polygon.

    Args:
        contours: of lines, quadratics and cubics. flatness: a positive distance, in font units.

    Returns:
        A closed polygon for each contour, its first point not repeated at the end; and the bound.

    Raises:
        OptionError: flatness is not positive, or so small that rounding errors or millions of points would result.
    """
    require(is_positive(flatness), "flatness is a positive distance in font units", flatness)
    from .segments import all_cubics  # here, so that opening needs no compiler

    # Bound of the rounding errors of a point, relative to the largest coordinate.
    rounding = 16 * np.finfo(np.float64).eps * float(np.abs(contours.points).max(initial=0.0))
    aim = flatness - rounding
    if aim < flatness / 2:
        raise OptionError(f"flatness is more than {2 * rounding:.2g}, the rounding of such coordinates")
    cubics = all_cubics(contours)
    bends = np.hypot(*np.moveaxis(np.diff(cubics, n=2, axis=1), 2, 0)).max(axis=1, initial=0.0)
    apart = np.where(contours.degrees > 1, 0.75 * bends, 0.0)
    needed = np.maximum(np.ceil(np.sqrt(apart / aim) * (1 + 1e-12)), 1.0)
    if not needed.sum() <= MOST_POINTS:
        raise OptionError(f"flatness {flatness:g} asks for {needed.sum():.3g} points, more than {MOST_POINTS}")
    at = offsets_of(needed.astype(np.int64))
    own = np.repeat(np.arange(len(cubics)), np.diff(at))
    found = evaluate(cubics[own], (np.arange(len(own)) - at[own]) / needed[own])
    bound = float((apart / needed**2).max(initial=0.0))
    closed = np.ones(contours.num_contours, dtype=np.bool_)
    return Polylines(found, at[contours.offsets], closed), bound + rounding if bound else 0.0


def polygons_of(lines: Polylines) -> list[FloatArray]:
    """The points (n, 2) of each polyline, as views."""
    return np.split(lines.points, lines.offsets[1:-1]) if len(lines.closed) else []
