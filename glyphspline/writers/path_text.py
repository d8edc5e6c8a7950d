"""SVG path data, compiled: of curves, polygons and dots, from coordinates in whole units of the last digit.

Coordinates are doubles that are whole numbers below ``LARGEST``, y up; y is written with its sign turned. What numbers
are written with, ``figures``, is explained in ``digits``.
"""

# mypy: disable-error-code="no-untyped-def, no-any-return"

from __future__ import annotations

import numpy as np
from numba import njit

from .digits import LARGEST, ONE, SLACK, SPACE, WIDEST, decimal
from .words import store

MOVE, LINE, QUADRATIC, CUBIC, CLOSE, MOVE_BY, LINE_BY = (np.uint8(ord(c)) for c in "MLQCZml")
DOT = np.uint16(int.from_bytes(b"h0", "little"))
"""A stroke of no length, which round caps make a dot."""


TIE = 1e-6
"""Fractions this near to a half are rounded up: rounding errors should not decide which way."""


@njit(cache=True, nogil=True, error_model="numpy")
def nearest(value):
    """The whole number nearest."""
    return np.floor(value + (0.5 + TIE))


@njit(cache=True, nogil=True, error_model="numpy")
def pair(at, x, y, figures):
    """ "x y"."""
    at = decimal(at, np.int64(x), figures)
    store(at, SPACE)
    return decimal(at + ONE, -np.int64(y), figures)


@njit(cache=True, nogil=True, error_model="numpy")
def curve(at, points, degrees, figures):
    """A closed chain of Bézier segments: M, then L, Q or C for each, then Z, which also draws a last line.

    Args:
        points: (N, 2). degrees: (m,) whose sum is N, as :class:`~glyphspline.outline.Contour` has them.
    """
    store(at, MOVE)
    at = pair(at + ONE, points[0, 0], points[0, 1], figures)
    i, n, m = 0, len(points), len(degrees)
    for j in range(m if degrees[m - 1] > 1 else m - 1):
        degree = degrees[j]
        store(at, CUBIC if degree == 3 else (LINE if degree == 1 else QUADRATIC))
        for k in range(1, degree + 1):
            at += ONE
            e = i + k if i + k < n else 0
            at = pair(at, points[e, 0], points[e, 1], figures)
            store(at, SPACE)
        i += degree
    store(at, CLOSE)
    return at + ONE


@njit(cache=True, nogil=True, error_model="numpy")
def polyline(at, points, closed, figures):
    """Points joined by straight lines: "M x y x y …"."""
    store(at, MOVE)
    for i in range(len(points)):
        at += ONE
        at = pair(at, points[i, 0], points[i, 1], figures)
        store(at, SPACE)
    if closed:
        store(at, CLOSE)
        at += ONE
    return at


@njit(cache=True, nogil=True, error_model="numpy")
def step(at, letter, dx, dy, figures):
    """A command with one pair of numbers, as short as can be."""
    store(at, letter)
    at = decimal(at + ONE, np.int64(dx), figures)
    store(at, SPACE)
    at += np.uint64(dy <= 0)  # a minus sets numbers apart; y is turned
    return decimal(at, -np.int64(dy), figures)


@njit(cache=True, nogil=True, error_model="numpy")
def _fit(whole):
    """Whether all numbers can be written digit by digit."""
    fine = True
    for i in range(len(whole)):
        fine &= abs(whole[i, 0]) < LARGEST and abs(whole[i, 1]) < LARGEST
    return fine


@njit(cache=True, nogil=True, error_model="numpy")
def curves_text(points, degrees, contours, precision, power, limit, words):
    """Path data of closed contours as bytes; None if a number is too large for it.

    Args:
        points: (N, 2) of all contours one after the other. degrees: (m,) of all segments. contours: (c + 1,) where
            those of each contour begin. precision, power, limit, words: the figures of so many decimals.
    """
    figures = (precision, power, limit, np.uint64(words.ctypes.data))
    whole = np.rint(points * power)
    if not _fit(whole):
        return None
    text = np.empty((len(points) + len(contours)) * 2 * WIDEST + SLACK, dtype=np.uint8)
    start = np.uint64(text.ctypes.data)
    at, first = start, 0
    for c in range(len(contours) - 1):
        part = degrees[contours[c] : contours[c + 1]]
        n = part.sum()
        if n:
            at = curve(at, whole[first : first + n], part, figures)
        first += n
    return text[: np.int64(at - start)]


@njit(cache=True, nogil=True, error_model="numpy")
def polylines_text(points, starts, stops, closed, precision, power, limit, words):
    """Path data of polygons as bytes; None if a number is too large for it.

    Args:
        points: (N, 2) of all. starts, stops: (p,) where in it each begins and stops. closed: (p,) whether Z ends it.
        precision, power, limit, words: the figures of so many decimals.
    """
    figures = (precision, power, limit, np.uint64(words.ctypes.data))
    whole = np.rint(points * power)
    if not _fit(whole):
        return None
    text = np.empty((len(points) + len(starts)) * 2 * WIDEST + SLACK, dtype=np.uint8)
    start = np.uint64(text.ctypes.data)
    at = start
    for p in range(len(starts)):
        if stops[p] > starts[p]:
            at = polyline(at, whole[starts[p] : stops[p]], closed[p], figures)
    return text[: np.int64(at - start)]
