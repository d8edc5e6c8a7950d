"""SVG path data, compiled: of curves, polygons, dots and combs. Python calls it through :mod:`.path_data`.

Coordinates are whole numbers below ``LARGEST`` in units of the last decimal, y up; y is written with its sign turned.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...compiled import compiled
from ...curves.comb import CURVATURE, NX, NY, X, Y, control_length, sampled
from ...curves.curvature import ANGLE
from ...outlines.contour_arrays import ContourArrays
from ...outlines.ink import turned_about
from ...outlines.segments import all_cubics
from ...types import BoolArray, FloatArray, IntArray
from .comb import LONGEST, MOST_TEETH, NEAR, SIDES, SPACING, TOOTH

Text = NDArray[np.uint8]

LETTERS = tuple(b" lqcmLQCM")
"""Commands by degree, relative and absolute."""

LINE_BY, MOVE_BY, MOVE = LETTERS[1], LETTERS[4], LETTERS[8]

LARGEST = 1e15
"""Coordinates are below this in units of the last decimal: their differences are exact as doubles and as integers."""

WIDEST = 40
"""Characters of a pair of numbers with its command, and two for each decimal."""

TIE = 1e-6
"""Fractions this near to a half are rounded up: rounding errors do not decide which way."""


@compiled
def write_pair(text: Text, at: int, letter: int, x: float, y: float, precision: int) -> int:
    """Write a command, or 0 to go on with the one before, and a pair of numbers at an index; returns the index behind.

    They are separated by a space or a minus, and without zeros at the end or before the point.
    """
    for axis in range(2):
        value = int(-y if axis else x)
        if letter or value >= 0:
            text[at] = letter if letter else 32  # a space
            at += 1
        letter = 0
        if value < 0:
            text[at] = 45  # a minus
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
        k = at = at + width + (decimals > 0)
        for digit in range(width):
            if decimals and digit == decimals:
                k -= 1
                text[k] = 46  # a point
            k -= 1
            text[k] = 48 + value % 10
            value //= 10
        if decimals and width == decimals:
            text[k - 1] = 46
    return at


@compiled
def curves_text(curves: ContourArrays, closed: BoolArray, glyphs: IntArray, precision: int) -> tuple[Text, IntArray]:
    """Path data of the contours, or polylines, of many glyphs.

    Args:
        curves: of all glyphs, rounded; an open polyline has a point for each of its ``degrees``.
        closed: (C,) whether a contour ends with Z. glyphs: (G + 1,) where the contours of each glyph begin.

    Returns:
        Text as bytes; (G + 1,) where that of each glyph begins: one with larger coordinates has none.
    """
    whole, degrees, offsets, starts = curves
    text = np.empty((len(whole) + len(offsets)) * (WIDEST + 2 * precision), dtype=np.uint8)
    ends, at = np.zeros(len(glyphs), dtype=np.int64), 0
    for g in range(len(glyphs) - 1):
        fits = True
        for i in range(starts[glyphs[g]], starts[glyphs[g + 1]]):
            fits &= abs(whole[i, 0]) < LARGEST and abs(whole[i, 1]) < LARGEST
        for c in range(glyphs[g], glyphs[g + 1] if fits else 0):
            i, before, last = starts[c], 0, offsets[c + 1] - 1
            for j in range(offsets[c], last + 1):
                if j == offsets[c]:
                    at = write_pair(text, at, MOVE, whole[i, 0], whole[i, 1], precision)
                degree, x, y = degrees[j], whole[i, 0], whole[i, 1]
                letter, pairs = 0 if degree == before else LETTERS[degree], degree
                if j == last:
                    # Z draws a last line. A last curve is absolute: it ends where the contour begins also for a reader
                    # that adds up binary fractions.
                    letter, x, y, pairs = LETTERS[degree + 4], 0.0, 0.0, degree if degree > 1 else 0
                for k in range(1, pairs + 1):
                    p = starts[c] if j == last and k == degree else i + k
                    at = write_pair(text, at, letter, whole[p, 0] - x, whole[p, 1] - y, precision)
                    letter = 0
                i, before = i + degree, degree
            if closed[c] and last >= offsets[c]:
                text[at] = 90  # Z
                at += 1
        ends[g + 1] = at
    return text[:at], ends


@compiled
def dots_text(whole: FloatArray, precision: int) -> Text:
    """A dot on each point (n, 2): a stroke of no length, which has round caps. Larger coordinates are left out."""
    text = np.empty(len(whole) * (WIDEST + 2 + 2 * precision), dtype=np.uint8)
    at, x, y, letter = 0, 0.0, 0.0, MOVE
    for i in range(len(whole)):
        if abs(whole[i, 0]) < LARGEST and abs(whole[i, 1]) < LARGEST:
            at = write_pair(text, at, letter, whole[i, 0] - x, whole[i, 1] - y, precision)
            text[at], text[at + 1] = 104, 48  # h0
            at, x, y, letter = at + 2, whole[i, 0], whole[i, 1], MOVE_BY
    return text[:at]


@compiled
def comb_teeth(
    curves: ContourArrays, sides: FloatArray, corners: FloatArray, corner_offsets: IntArray,
    em: float, scale: float, least: float, precision: int,
) -> tuple[FloatArray, IntArray, BoolArray, IntArray]:  # fmt: skip
    """The teeth of a glyph as :func:`.comb.teeth` places them, rounded, without those that would be the one before.

    Args:
        sides, corners, corner_offsets: as for :func:`.comb.teeth_of`, the corners of contour c from
            ``corner_offsets[c]``. least: teeth of less curvature, in units of the scale, are not shown.

    Returns:
        (k, 4) feet and tips; (k,) colour classes from 0, or -1 for a tooth that is not shown; (k,) whether it was
        shortened; (C + 1,) where the teeth of each contour begin.
    """
    cubics = all_cubics(curves)
    spacing = max(SPACING * em, control_length(cubics) / MOST_TEETH)
    samples, starts = sampled(cubics, spacing, ANGLE, scale * least)
    ends, classes = np.empty((len(samples), 4)), np.empty(len(samples), dtype=np.int64)
    cut, offsets = np.zeros(len(samples), dtype=np.bool_), np.zeros(len(curves.offsets), dtype=np.int64)
    power, half, inverse = 10.0**precision, 0.5 + TIE, 1.0 / scale if scale > 0.0 else 0.0
    k = 0
    for c in range(len(offsets) - 1):
        own = samples[starts[curves.offsets[c]] : starts[curves.offsets[c + 1]]]
        about = corners[corner_offsets[c] : corner_offsets[c + 1]]
        hidden = turned_about(about, own[:, :2], np.abs(own[:, CURVATURE]) > LONGEST * scale, NEAR * em)
        for i in range(len(own)):
            strength = 0.0 if hidden[i] else own[i, CURVATURE] * inverse
            reach = TOOTH * em * min(max(strength, -LONGEST), LONGEST)
            ends[k, 0], ends[k, 1] = np.floor(own[i, X] * power + half), np.floor(own[i, Y] * power + half)
            ends[k, 2] = np.floor((own[i, X] - reach * own[i, NX]) * power + half)
            ends[k, 3] = np.floor((own[i, Y] - reach * own[i, NY]) * power + half)
            if k > offsets[c] and (ends[k] == ends[k - 1]).all():
                continue
            cut[k], classes[k] = abs(strength) > LONGEST, -1
            if min(abs(strength), LONGEST) > least and (ends[k, 0] != ends[k, 2] or ends[k, 1] != ends[k, 3]):
                classes[k] = SIDES + np.int64(np.rint(min(max(sides[c] * strength, -1.0), 1.0) * SIDES))
            k += 1
        if k > offsets[c] + 1 and (ends[k - 1] == ends[offsets[c]]).all():
            k -= 1  # the contour is closed
        offsets[c + 1] = k
    return ends[:k], classes[:k], cut[:k], offsets


@compiled
def comb_text(ends: FloatArray, classes: IntArray, offsets: IntArray, precision: int) -> tuple[Text, IntArray]:
    """Paths of the teeth of each colour class, strokes from foot to tip, and of the line through the tips.

    Args:
        ends, classes, offsets: of :func:`comb_teeth`.

    Returns:
        Text as bytes; (2 * SIDES + 3,) where each path begins.
    """
    layers = 2 * SIDES + 1
    text, parts = np.empty(4 * len(ends) * (WIDEST + 2 * precision), np.uint8), np.zeros(layers + 2, np.int64)
    at = 0
    for layer in range(layers):
        x, y, letter = 0.0, 0.0, MOVE
        for i in range(len(ends)):
            if classes[i] == layer:
                at = write_pair(text, at, letter, ends[i, 0] - x, ends[i, 1] - y, precision)
                x, y, letter = ends[i, 2], ends[i, 3], MOVE_BY
                at = write_pair(text, at, LINE_BY, x - ends[i, 0], y - ends[i, 1], precision)
        parts[layer + 1] = at
    x, y, letter = 0.0, 0.0, MOVE
    for c in range(len(offsets) - 1):
        line = LINE_BY  # 0 after a line
        for i in range(offsets[c], offsets[c + 1]):
            j = i + 1 if i + 1 < offsets[c + 1] else offsets[c]
            if classes[i] < 0 and classes[j] < 0:  # a line would lie on the outline
                line = LINE_BY
                continue
            if line:
                at = write_pair(text, at, letter, ends[i, 2] - x, ends[i, 3] - y, precision)
            at = write_pair(text, at, line, ends[j, 2] - ends[i, 2], ends[j, 3] - ends[i, 3], precision)
            x, y, letter, line = ends[j, 2], ends[j, 3], MOVE_BY, 0
    parts[layers + 1] = at
    return text[:at], parts
