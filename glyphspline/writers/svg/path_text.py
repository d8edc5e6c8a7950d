"""SVG path data, compiled: of curves, polygons and dots. Python calls it through :mod:`.path_data`.

Coordinates are doubles that are integers below ``LARGEST``, in units of the last decimal, y up; y is written with its
sign turned. Functions that write take a text, the index at which they begin, and the number of decimals; they return
the index behind what they have written.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...compiled import compiled
from ...outlines.contour_arrays import ContourArrays
from ...types import BoolArray, FloatArray, IntArray
from .bounds import grow

Text = NDArray[np.uint8]

MOVE, QUADRATIC, CUBIC, CLOSE = b"MQCZ"
MOVE_BY, LINE_BY, QUADRATIC_BY, CUBIC_BY, ACROSS_BY = b"mlqch"
SPACE, MINUS, POINT, ZERO = b" -.0"

WIDEST = 20
"""Characters of the longest number written, with its separator."""

LARGEST = 1e15
"""Coordinates, in units of the last decimal, have to be below this: as doubles they are integers there."""

INFINITE = np.array([np.inf, np.inf, -np.inf, -np.inf])

TIE = 1e-6
"""Fractions this near to a half are rounded up: rounding errors should not decide which way."""


@compiled
def path_text(
    curves: ContourArrays, closed: BoolArray, glyphs: IntArray, precision: int
) -> tuple[Text, IntArray, FloatArray, BoolArray]:
    """Path data of the contours, or polylines, of many glyphs.

    Args:
        curves: of all glyphs.
        closed: (C,) whether a contour ends with Z; an open polyline has a point for each of its ``degrees``, too.
        glyphs: (G + 1,) where the contours of each glyph begin.
        precision: decimals.

    Returns:
        Text as bytes; (G + 1,) where that of each glyph begins; (G, 4) left, bottom, right, top of the rounded curves,
        infinite the wrong way round without any; (G,) whether a glyph has a coordinate too large to be written.
    """
    points, degrees, offsets, starts = curves
    count, unit = len(glyphs) - 1, 10.0**precision
    whole = np.rint(points * unit)
    rounded = whole / unit
    text = np.empty((len(points) + len(offsets)) * 2 * WIDEST, dtype=np.uint8)
    ends, boxes, too_large = np.zeros(count + 1, np.int64), np.empty((count, 4)), np.zeros(count, np.bool_)
    at = 0
    for glyph in range(count):
        boxes[glyph] = INFINITE
        a, b = glyphs[glyph], glyphs[glyph + 1]
        too_large[glyph] = not _fits(whole[starts[a] : starts[b]])
        for c in range(a, b):
            own = degrees[offsets[c] : offsets[c + 1]]
            if len(own) and not too_large[glyph]:
                at = _contour(text, at, whole[starts[c] : starts[c + 1]], own, closed[c], precision)
            grow(boxes[glyph], rounded[starts[c] : starts[c + 1]], own)
        ends[glyph + 1] = at
    return text[:at], ends, boxes, too_large


@compiled
def dots_text(points: FloatArray, precision: int) -> Text:
    """Path data of a dot on each of the points (n, 2), as bytes; coordinates too large to be written are left out."""
    text = np.empty(len(points) * 3 * WIDEST, dtype=np.uint8)
    return text[: dots(text, 0, np.floor(points * 10.0**precision + (0.5 + TIE)), precision)]


@compiled
def dots(text: Text, at: int, points: FloatArray, precision: int) -> int:
    """A dot on each point (n, 2): a stroke of no length, which has round caps."""
    x = y = 0.0
    letter = MOVE
    for i in range(len(points)):
        if abs(points[i, 0]) < LARGEST and abs(points[i, 1]) < LARGEST:
            at = step(text, at, letter, points[i, 0] - x, points[i, 1] - y, precision)
            text[at], text[at + 1] = ACROSS_BY, ZERO
            at += 2
            x, y = points[i, 0], points[i, 1]
            letter = MOVE_BY
    return at


@compiled
def _contour(text: Text, at: int, points: FloatArray, degrees: IntArray, closed: bool, precision: int) -> int:
    """One contour: M, then l, q or c, then Z, which also draws a last line.

    Relative numbers take two thirds of the bytes. A last curve is absolute: it ends where the contour begins also for
    a reader that adds up binary fractions.
    """
    at = step(text, at, MOVE, points[0, 0], points[0, 1], precision)
    m = len(degrees)
    i, before = 0, 0
    for j in range(m - 1):
        degree = degrees[j]
        x, y = points[i, 0], points[i, 1]
        for k in range(1, degree + 1):
            dx, dy = points[i + k, 0] - x, points[i + k, 1] - y
            if k > 1 or degree == before:
                at = more(text, at, dx, dy, precision)
            else:
                letter = CUBIC_BY if degree == 3 else LINE_BY if degree == 1 else QUADRATIC_BY
                at = step(text, at, letter, dx, dy, precision)
        i, before = i + degree, degree
    degree = degrees[m - 1]
    if degree > 1:
        at = step(text, at, CUBIC if degree == 3 else QUADRATIC, points[i + 1, 0], points[i + 1, 1], precision)
        if degree == 3:
            at = more(text, at, points[i + 2, 0], points[i + 2, 1], precision)
        at = more(text, at, points[0, 0], points[0, 1], precision)
    if closed:
        text[at] = CLOSE
        at += 1
    return at


@compiled
def _fits(points: FloatArray) -> bool:
    """Whether all of the points (n, 2) can be written."""
    fine = True
    for i in range(len(points)):
        fine &= abs(points[i, 0]) < LARGEST and abs(points[i, 1]) < LARGEST
    return fine


@compiled
def step(text: Text, at: int, letter: int, dx: float, dy: float, precision: int) -> int:
    """A command with one pair of numbers."""
    text[at] = letter
    at = decimal(text, at + 1, int(dx), precision)
    return _separated(text, at, -int(dy), precision)


@compiled
def more(text: Text, at: int, dx: float, dy: float, precision: int) -> int:
    """One more pair of numbers of the command before."""
    at = _separated(text, at, int(dx), precision)
    return _separated(text, at, -int(dy), precision)


@compiled
def _separated(text: Text, at: int, value: int, precision: int) -> int:
    """One more number: a minus separates it from the one before as well as a space."""
    if value >= 0:
        text[at] = SPACE
        at += 1
    return decimal(text, at, value, precision)


@compiled
def decimal(text: Text, at: int, value: int, precision: int) -> int:
    """The number value / 10**precision, without zeros at its end or before its point."""
    if value < 0:
        text[at] = MINUS
        at += 1
    value, decimals = abs(value), precision
    while decimals and value % 10 == 0:
        value //= 10
        decimals -= 1
    width, rest = 1, value // 10
    while rest:
        width += 1
        rest //= 10
    width = max(width, decimals)
    end = at + width + (decimals > 0)
    k = end
    for digit in range(width):
        if digit == decimals and decimals:
            k -= 1
            text[k] = POINT
        k -= 1
        text[k] = ZERO + value % 10
        value //= 10
    if width == decimals:
        text[at] = POINT
    return end
