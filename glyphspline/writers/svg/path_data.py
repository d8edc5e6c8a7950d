"""SVG path data, compiled: of curves, polygons and dots, from coordinates in whole units of the last digit.

Coordinates are doubles that are whole numbers below ``LARGEST``, y up; y is written with its sign turned. What numbers
are written with, ``figures``, is explained in ``digits``.
"""

# mypy: disable-error-code="no-untyped-def, no-any-return"

from __future__ import annotations

import numpy as np

from ...compiled import compiled, store
from .numbers import LARGEST, ONE, SLACK, SPACE, WIDEST, decimal

MOVE, QUADRATIC, CUBIC, CLOSE = (np.uint8(ord(c)) for c in "MQCZ")
MOVE_BY, LINE_BY, QUADRATIC_BY, CUBIC_BY = (np.uint8(ord(c)) for c in "mlqc")
DOT = np.uint16(int.from_bytes(b"h0", "little"))
"""A stroke of no length, which round caps make a dot."""


TIE = 1e-6
"""Fractions this near to a half are rounded up: rounding errors should not decide which way."""


@compiled
def nearest(value):
    """The whole number nearest."""
    return np.floor(value + (0.5 + TIE))


@compiled
def apart(at, value, figures):
    """One more number: a minus sets it apart from the one before as well as a space."""
    store(at, SPACE)
    return decimal(at + np.uint64(value >= 0), value, figures)


@compiled
def more(at, dx, dy, figures):
    """One more pair of numbers of the command before."""
    at = apart(at, np.int64(dx), figures)
    return apart(at, -np.int64(dy), figures)


@compiled
def step(at, letter, dx, dy, figures):
    """A command with one pair of numbers."""
    store(at, letter)
    at = decimal(at + ONE, np.int64(dx), figures)
    return apart(at, -np.int64(dy), figures)


@compiled
def curve(at, points, degrees, figures):
    """A closed chain of Bézier segments: M, then l, q or c, then Z, which also draws a last line.

    Relative numbers take two thirds of the room. A last curve is absolute, so that it ends where the chain begins for
    a reader, too, who has added up binary fractions.

    Args:
        points: (N, 2). degrees: (m,) whose sum is N, as :class:`~glyphspline.outlines.outline.Contour` has them.
    """
    at = step(at, MOVE, points[0, 0], points[0, 1], figures)
    m = len(degrees)
    i, before = 0, 0
    for j in range(m - 1):
        degree = degrees[j]
        x, y = points[i, 0], points[i, 1]
        for k in range(1, degree + 1):
            dx, dy = points[i + k, 0] - x, points[i + k, 1] - y
            if k > 1 or degree == before:
                at = more(at, dx, dy, figures)
            else:
                at = step(at, CUBIC_BY if degree == 3 else LINE_BY if degree == 1 else QUADRATIC_BY, dx, dy, figures)
        i, before = i + degree, degree
    degree = degrees[m - 1]
    if degree > 1:
        at = step(at, CUBIC if degree == 3 else QUADRATIC, points[i + 1, 0], points[i + 1, 1], figures)
        if degree == 3:
            at = more(at, points[i + 2, 0], points[i + 2, 1], figures)
        at = more(at, points[0, 0], points[0, 1], figures)
    store(at, CLOSE)
    return at + ONE


@compiled
def polyline(at, points, closed, figures):
    """Points joined by straight lines: M, then l."""
    at = step(at, MOVE, points[0, 0], points[0, 1], figures)
    for i in range(1, len(points)):
        dx, dy = points[i, 0] - points[i - 1, 0], points[i, 1] - points[i - 1, 1]
        at = more(at, dx, dy, figures) if i > 1 else step(at, LINE_BY, dx, dy, figures)
    if closed:
        store(at, CLOSE)
        at += ONE
    return at


@compiled
def fit(whole):
    """Whether all numbers of an array (N, 2) can be written digit by digit."""
    fine = True
    for i in range(len(whole)):
        fine &= abs(whole[i, 0]) < LARGEST and abs(whole[i, 1]) < LARGEST
    return fine


@compiled
def curves_text(points, degrees, contours, precision, power, limit, words):
    """Path data of closed contours as bytes; None if a number is too large for it.

    Args:
        points: (N, 2) of all contours one after the other. degrees: (m,) of all segments. contours: (c + 1,) where
            those of each contour begin. precision, power, limit, words: the figures of so many decimals.
    """
    figures = (precision, power, limit, np.uint64(words.ctypes.data))
    whole = np.rint(points * power)
    if not fit(whole):
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


@compiled
def polylines_text(points, starts, stops, closed, precision, power, limit, words):
    """Path data of polygons as bytes; None if a number is too large for it.

    Args:
        points: (N, 2) of all. starts, stops: (p,) where in it each begins and stops. closed: (p,) whether Z ends it.
        precision, power, limit, words: the figures of so many decimals.
    """
    figures = (precision, power, limit, np.uint64(words.ctypes.data))
    whole = np.rint(points * power)
    if not fit(whole):
        return None
    text = np.empty((len(points) + len(starts)) * 2 * WIDEST + SLACK, dtype=np.uint8)
    start = np.uint64(text.ctypes.data)
    at = start
    for p in range(len(starts)):
        if stops[p] > starts[p]:
            at = polyline(at, whole[starts[p] : stops[p]], closed[p], figures)
    return text[: np.int64(at - start)]
