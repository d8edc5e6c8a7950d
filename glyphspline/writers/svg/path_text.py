"""SVG path data, compiled: of curves, polygons and dots. Python calls it through :mod:`.path_data`.

Coordinates are doubles that are integers below ``LARGEST``, in units of the last decimal, y up; y is written with its
sign turned.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...compiled import compiled
from ...intrinsics import store
from ...outlines.contour_arrays import ContourArrays
from ...types import BoolArray, FloatArray, IntArray
from .bounds import grow
from .numbers import LARGEST, ONE, SLACK, SPACE, WIDEST, Figures, decimal

MOVE, QUADRATIC, CUBIC, CLOSE = (np.uint8(ord(c)) for c in "MQCZ")
MOVE_BY, LINE_BY, QUADRATIC_BY, CUBIC_BY = (np.uint8(ord(c)) for c in "mlqc")
DOT = np.uint16(int.from_bytes(b"h0", "little"))
"""A stroke of no length, which round caps make a dot."""

TWO = np.uint64(2)
INFINITE = np.array([np.inf, np.inf, -np.inf, -np.inf])

TIE = 1e-6
"""Fractions this near to a half are rounded up: rounding errors should not decide which way."""


@compiled
def path_text(
    curves: ContourArrays, closed: BoolArray, glyphs: IntArray, tables: Figures
) -> tuple[NDArray[np.uint8], IntArray, FloatArray, BoolArray]:
    """Path data of the contours, or polylines, of many glyphs.

    Args:
        curves: of all glyphs.
        closed: (C,) whether a contour ends with Z; an open polyline has a point for each of its ``degrees``, too.
        glyphs: (G + 1,) where the contours of each glyph begin.
        tables: for numbers of the decimals wanted.

    Returns:
        Text as bytes; (G + 1,) where that of each glyph begins; (G, 4) left, bottom, right, top of the rounded curves,
        infinite the wrong way round without any; (G,) whether a glyph has a coordinate too large to be written.
    """
    points, degrees, offsets, starts = curves
    count, power = len(glyphs) - 1, tables.power
    figures = Figures(tables.precision, power, tables.limit, np.uint64(tables.words.ctypes.data))
    whole, rounded = np.empty_like(points), np.empty_like(points)
    unit = np.float64(power)
    for i in range(np.uint64(len(points))):  # unsigned: such loops become SIMD
        for axis in range(np.uint64(2)):
            whole[i, axis] = np.rint(points[i, axis] * unit)
            rounded[i, axis] = whole[i, axis] / unit
    text = np.empty((len(points) + len(offsets)) * 2 * WIDEST + SLACK, dtype=np.uint8)
    ends, boxes, too_large = np.zeros(count + 1, np.int64), np.empty((count, 4)), np.zeros(count, np.bool_)
    start = np.uint64(text.ctypes.data)
    at = start
    for glyph in range(count):
        boxes[glyph] = INFINITE
        a, b = glyphs[glyph], glyphs[glyph + 1]
        too_large[glyph] = not _fits(whole[starts[a] : starts[b]])
        for c in range(a, b):
            own = degrees[offsets[c] : offsets[c + 1]]
            if len(own) and not too_large[glyph]:
                at = _contour(at, whole[starts[c] : starts[c + 1]], own, closed[c], figures)
            grow(boxes[glyph], rounded[starts[c] : starts[c + 1]], own)
        ends[glyph + 1] = np.int64(at - start)
    return text[: np.int64(at - start)], ends, boxes, too_large


@compiled
def dots_text(points: FloatArray, tables: Figures) -> NDArray[np.uint8]:
    """Path data of a dot on each of the points (n, 2), as bytes; coordinates too large to be written are left out."""
    figures = Figures(tables.precision, tables.power, tables.limit, np.uint64(tables.words.ctypes.data))
    text = np.empty(len(points) * 3 * WIDEST + SLACK, dtype=np.uint8)
    start = np.uint64(text.ctypes.data)
    rounded = np.floor(points * tables.power + (0.5 + TIE))
    return text[: np.int64(dots(start, rounded, figures) - start)]


@compiled
def dots(at: np.uint64, points: FloatArray, figures: Figures) -> np.uint64:
    """A dot on each point (n, 2)."""
    x = y = 0.0
    letter = MOVE
    for i in range(len(points)):
        if abs(points[i, 0]) < LARGEST and abs(points[i, 1]) < LARGEST:
            at = step(at, letter, points[i, 0] - x, points[i, 1] - y, figures)
            store(at, DOT)
            at += TWO
            x, y = points[i, 0], points[i, 1]
            letter = MOVE_BY
    return at


@compiled
def _contour(at: np.uint64, points: FloatArray, degrees: IntArray, closed: bool, figures: Figures) -> np.uint64:
    """One contour: M, then l, q or c, then Z, which also draws a last line.

    Relative numbers take two thirds of the bytes. A last curve is absolute: it ends where the contour begins also for
    a reader that adds up binary fractions.
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
    return at + np.uint64(closed)


@compiled
def _fits(points: FloatArray) -> bool:
    """Whether all of the points (n, 2) can be written."""
    fine = True
    for i in range(len(points)):
        fine &= abs(points[i, 0]) < LARGEST and abs(points[i, 1]) < LARGEST
    return fine


@compiled
def step(at: np.uint64, letter: np.uint8, dx: float, dy: float, figures: Figures) -> np.uint64:
    """A command with one pair of numbers."""
    store(at, letter)
    at = decimal(at + ONE, np.int64(dx), figures)
    return _separated(at, -np.int64(dy), figures)


@compiled
def more(at: np.uint64, dx: float, dy: float, figures: Figures) -> np.uint64:
    """One more pair of numbers of the command before."""
    at = _separated(at, np.int64(dx), figures)
    return _separated(at, -np.int64(dy), figures)


@compiled
def _separated(at: np.uint64, value: np.int64, figures: Figures) -> np.uint64:
    """One more number: a minus separates it from the one before as well as a space."""
    store(at, SPACE)
    return decimal(at + np.uint64(value >= 0), value, figures)
