"""Path data of a curvature comb, compiled: teeth by colour, the line through their tips, marks of those cut short.

All of it is relative but for the first point, in units of the last decimal, so that rounding errors do not add up.
"""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...curves.comb import CURVATURE, NX, NY, X, Y, control_length, sampled
from ...outlines.contour_arrays import ContourArrays
from ...outlines.ink import turned_about
from ...outlines.segments import all_cubics
from ...types import BoolArray, FloatArray, IntArray
from .colours import SIDES
from .path_text import LARGEST, LINE_BY, MOVE, MOVE_BY, TIE, WIDEST, Text, dots, more, step

CLASSES = 2 * SIDES + 1
LAYERS = CLASSES + 2
"""Texts of a comb: a path of teeth for each colour class, from the most concave; the line; the marks."""

FLAT = -1


@compiled
def comb_text(
    curves: ContourArrays, sides: FloatArray, corners: FloatArray, corner_offsets: IntArray, near: float,
    spacing: float, most_teeth: float, angle: float, tooth: float, scale: float, longest: float, least: float,
    precision: int,
) -> tuple[Text, IntArray, FloatArray]:  # fmt: skip
    """The texts of a glyph's comb.

    Args:
        curves: the glyph's contours. sides: (C,) 1.0 where the ink is to the left of one, else -1.0.
        corners: (k, 2), those of contour c from ``corner_offsets[c]``, and near: teeth in the turn about one of these
            are left out; see :func:`...outlines.ink.turned_about`.
        spacing, angle: largest distance and turn from tooth to tooth. most_teeth: beyond so many, spacing grows.
        tooth: length of a tooth at the scale. scale: in 1/unit; 0 draws no teeth. longest: where teeth are cut, in
            units of the scale. least: teeth shorter than this are left out.
        precision: decimals.

    Returns:
        The text as bytes; (LAYERS + 1,) where each part of it begins; (4,) left, bottom, right, top of feet and tips,
        infinite the wrong way round without any.
    """
    power = 10.0**precision
    cubics = all_cubics(curves)
    spacing = max(spacing, control_length(cubics) / most_teeth)
    samples, starts = sampled(cubics, spacing, angle, scale * least / tooth)
    k = len(samples)
    points, classes = np.empty((k, 4)), np.empty(k, dtype=np.int64)
    ends = np.zeros(len(curves.offsets), dtype=np.int64)
    text = np.empty(k * 10 * WIDEST, dtype=np.uint8)
    parts = np.zeros(LAYERS + 1, dtype=np.int64)
    used = 0
    for c in range(len(ends) - 1):
        part = samples[starts[curves.offsets[c]] : starts[curves.offsets[c + 1]]]
        own = corners[corner_offsets[c] : corner_offsets[c + 1]]
        hidden = turned_about(own, part[:, :2], np.abs(part[:, CURVATURE]) > longest * scale, near)
        used = _place(part, sides[c], hidden, tooth, scale, longest, least, power, points, classes, used)
        ends[c + 1] = used
    box = _bounds(points[:used])
    at = 0
    if used and max(box[2], box[3], -box[0], -box[1]) < LARGEST:
        at = _teeth(text, points, classes[:used], parts, precision)
        at = _line(text, at, points, classes, ends, precision)
        parts[CLASSES + 1] = at
        at = dots(text, at, points[:used, 2:][classes[:used] >= CLASSES], precision)
    parts[LAYERS] = at
    return text[:at], parts, box / power


@compiled
def _place(
    samples: FloatArray, side: float, hidden: BoolArray, tooth: float, scale: float, longest: float,
    least: float, power: float, points: FloatArray, classes: IntArray, used: int,
) -> int:  # fmt: skip
    """Write a contour's feet and tips, rounded, and colour classes: FLAT if left out, CLASSES or above if cut.

    Pieces share their ends: what is where the one before it was is left out. Returns the number of teeth so far.
    """
    first = used
    inverse = 1.0 / scale if scale > 0.0 else 0.0
    half = 0.5 + TIE
    for i in range(len(samples)):
        strength = samples[i, CURVATURE] * inverse
        if hidden[i]:
            strength = 0.0
        reach = tooth * min(max(strength, -longest), longest)
        x, y = np.floor(samples[i, X] * power + half), np.floor(samples[i, Y] * power + half)
        tx = np.floor((samples[i, X] - reach * samples[i, NX]) * power + half)
        ty = np.floor((samples[i, Y] - reach * samples[i, NY]) * power + half)
        if used > first and _same(points, used - 1, x, y, tx, ty):
            continue
        points[used, 0], points[used, 1], points[used, 2], points[used, 3] = x, y, tx, ty
        classes[used] = FLAT
        if abs(reach) > least and (x != tx or y != ty):
            index = np.int64(np.rint(min(max(side * strength, -1.0), 1.0) * SIDES)) + SIDES
            classes[used] = index + (CLASSES if abs(strength) > longest else 0)
        used += 1
    a = first
    if used > a + 1 and _same(points, used - 1, points[a, 0], points[a, 1], points[a, 2], points[a, 3]):
        used -= 1  # the contour is closed
    return used


@compiled
def _same(points: FloatArray, i: int, x: float, y: float, tx: float, ty: float) -> bool:
    return points[i, 0] == x and points[i, 1] == y and points[i, 2] == tx and points[i, 3] == ty


@compiled
def _bounds(points: FloatArray) -> FloatArray:
    """(4,) left, bottom, right, top of feet and tips (k, 4)."""
    left = bottom = np.inf
    right = top = -np.inf
    for i in range(len(points)):
        x, y, tx, ty = points[i, 0], points[i, 1], points[i, 2], points[i, 3]
        left, bottom, right, top = min(left, x, tx), min(bottom, y, ty), max(right, x, tx), max(top, y, ty)
    return np.array([left, bottom, right, top])


@compiled
def _teeth(text: Text, points: FloatArray, classes: IntArray, parts: IntArray, precision: int) -> int:
    """Every tooth a stroke from foot to tip, class after class."""
    at = 0
    order = np.empty(len(classes), dtype=np.int64)
    places = np.zeros(CLASSES + 1, dtype=np.int64)
    for i in range(len(classes)):
        if classes[i] != FLAT:
            places[classes[i] % CLASSES + 1] += 1
    for c in range(CLASSES):
        places[c + 1] += places[c]
    following = places.copy()
    for i in range(len(classes)):
        if classes[i] != FLAT:
            order[following[classes[i] % CLASSES]] = i
            following[classes[i] % CLASSES] += 1
    for c in range(CLASSES):
        x = y = 0.0
        letter = MOVE
        for k in range(places[c], places[c + 1]):
            i = order[k]
            at = step(text, at, letter, points[i, 0] - x, points[i, 1] - y, precision)
            x, y = points[i, 2], points[i, 3]
            at = step(text, at, LINE_BY, x - points[i, 0], y - points[i, 1], precision)
            letter = MOVE_BY
        parts[c + 1] = at
    return at


@compiled
def _line(text: Text, at: int, points: FloatArray, classes: IntArray, ends: IntArray, precision: int) -> int:
    """The line through the tips, except where it would lie on the outline: between two places with no tooth."""
    x = y = 0.0
    letter = MOVE
    for contour in range(len(ends) - 1):
        a, b = ends[contour], ends[contour + 1]
        down = False
        for i in range(a, b):
            j = i + 1 if i + 1 < b else a
            if classes[i] == FLAT and classes[j] == FLAT:
                down = False
                continue
            dx, dy = points[j, 2] - points[i, 2], points[j, 3] - points[i, 3]
            if down:
                at = more(text, at, dx, dy, precision)
            else:
                at = step(text, at, letter, points[i, 2] - x, points[i, 3] - y, precision)
                at = step(text, at, LINE_BY, dx, dy, precision)
            letter, down = MOVE_BY, True
            x, y = points[j, 2], points[j, 3]
    return at
