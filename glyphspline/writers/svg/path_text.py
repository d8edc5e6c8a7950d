"""SVG path data, compiled: of curves, polygons, dots and combs. Python calls it through :mod:`.path_data`.

Coordinates are whole numbers below ``LARGEST`` in units of the last decimal, y up; y is written with its sign turned.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...compiled import compiled, inlined
from ...curves.comb import CURVATURE, NX, NY, X, Y, control_length, sampled
from ...curves.curvature import ANGLE
from ...outlines.contour_arrays import ContourArrays
from ...outlines.ink import ink_sides, turned_about
from ...outlines.segments import all_cubics
from ...types import BoolArray, FloatArray, IntArray
from .comb import LONGEST, MOST_TEETH, NEAR, SIDES, SPACING, TOOTH

Text = NDArray[np.uint8]

LINE_BY, MOVE_BY, MOVE = 108, 109, 77  # l, m, M

OF_DEGREE, SMOOTH = (0, 108, 113, 99), (0, 108, 116, 115)
"""Relative commands of lines, quadratics and cubics: l, q, c; and t, s of those whose first handle mirrors the last one
before. The absolute ones are 32 less."""

ACROSS, DOWN = 104, 118  # h, v

ABSOLUTE = 32

LARGEST = 1e15
"""Coordinates are below this in units of the last decimal: their differences are exact as doubles and as integers."""

WIDEST = 40
"""Characters of a pair of numbers with its command, and two for each decimal."""

PARTS = 2 * SIDES + 3
"""Paths of a comb: teeth by colour class, the line of tips, marks of cut teeth."""

TIE = 1e-6
"""Fractions this near to a half are rounded up: rounding errors do not decide which way."""


@compiled
def write_number(text: Text, at: int, number: float, precision: int) -> int:
    """Write a number in units of the last decimal at an index; returns the index behind.

    It has no zeros at the end nor before the point. What parts it from a number before is a minus, its point after one
    that has a point too, or a space.
    """
    value, decimals = int(abs(number)), precision
    rest = value // 10
    while decimals and value == 10 * rest:
        value, rest, decimals = rest, rest // 10, decimals - 1
    width, power = 1, 10
    while power <= value:
        width, power = width + 1, 10 * power
    if number < 0.0:
        text[at] = 45  # a minus
        at += 1
    elif at and (text[at - 1] < 58 and not (decimals and width <= decimals and _has_point(text, at))):
        text[at] = 32  # a space after a digit
        at += 1
    width = max(width, decimals)
    k = at = at + width + (decimals > 0)
    for digit in range(width):
        if decimals and digit == decimals:
            k -= 1
            text[k] = 46  # a point
        k -= 1
        rest = value // 10
        text[k] = 48 + (value - 10 * rest)
        value = rest
    if decimals and width == decimals:
        text[k - 1] = 46
    return at


@inlined
def _has_point(text: Text, at: int) -> bool:
    """Whether the number that ends at an index has a point."""
    k = at - 1
    while k > 0 and 48 <= text[k] < 58:
        k -= 1
    return bool(text[k] == 46)


@compiled
def write_pair(text: Text, at: int, letter: int, x: float, y: float, precision: int) -> int:
    """Write a command, or 0 to go on with the one before, and a pair of numbers; y has its sign turned."""
    if letter:
        text[at] = letter
        at += 1
    at = write_number(text, at, x, precision)
    return write_number(text, at, 0.0 - y, precision)


@compiled
def write_command(
    text: Text, at: int, before: int, letter: int, points: FloatArray, x: float, y: float, precision: int
) -> int:
    """Write a command with points (k, 2) seen from (x, y), without its letter if that is the letter before."""
    if letter != before:
        text[at] = letter
        at += 1
    kind = letter | ABSOLUTE
    for k in range(len(points)):
        if kind != DOWN:
            at = write_number(text, at, points[k, 0] - x, precision)
        if kind != ACROSS:
            at = write_number(text, at, y - points[k, 1], precision)
    return at


@compiled
def write_shorter(
    text: Text, at: int, before: int, letter: int, points: FloatArray, x: float, y: float, precision: int
) -> tuple[int, int]:
    """Write a relative command, or the absolute one if that is shorter; the index behind it, and its letter."""
    behind = write_command(text, at, before, letter - ABSOLUTE, points, 0.0, 0.0, precision)
    kept = text[at:behind].copy()
    behind = write_command(text, at, before, letter, points, x, y, precision)
    if len(kept) >= behind - at:
        return behind, letter
    return write_bytes(text, at, kept), letter - ABSOLUTE


@compiled
def curves_text(curves: ContourArrays, closed: BoolArray, glyphs: IntArray, precision: int) -> tuple[Text, IntArray]:
    """Path data of the contours, or polylines, of many glyphs, in the shortest of the forms that a segment has.

    Decimals are binary fractions to a reader, whose sums are not exact. So with decimals each contour begins, and its
    last curve ends, with absolute coordinates, which are the same.

    Args:
        curves: of all glyphs, rounded; an open polyline has a point for each of its ``degrees``.
        closed: (C,) whether a contour ends with Z. glyphs: (G + 1,) where the contours of each glyph begin.

    Returns:
        Text as bytes; (G + 1,) where that of each glyph begins: one with larger coordinates has none.
    """
    whole, degrees, offsets, starts = curves
    text = np.empty((len(whole) + len(offsets)) * (WIDEST + 2 * precision), dtype=np.uint8)
    ends, at, own = np.zeros(len(glyphs), dtype=np.int64), 0, np.zeros((3, 2))
    for g in range(len(glyphs) - 1):
        fits, x, y = True, 0.0, 0.0
        for i in range(starts[glyphs[g]], starts[glyphs[g + 1]]):
            fits &= abs(whole[i, 0]) < LARGEST and abs(whole[i, 1]) < LARGEST
        for c in range(glyphs[g], glyphs[g + 1] if fits else 0):
            i, last = starts[c], offsets[c + 1] - 1
            if offsets[c] > last:
                continue
            if precision or c == glyphs[g]:
                at = write_command(text, at, 0, MOVE, whole[i : i + 1], 0.0, 0.0, precision)
            else:
                at, _ = write_shorter(text, at, 0, MOVE_BY, whole[i : i + 1], x, y, precision)
            x, y, bent_x, bent_y, before, letter = whole[i, 0], whole[i, 1], 0.0, 0.0, 0, 0
            for j in range(offsets[c], last + 1):
                degree = degrees[j]
                if j == last and degree == 1:
                    break  # Z draws it
                for k in range(degree):
                    p = starts[c] if j == last and k == degree - 1 else i + 1 + k
                    own[k, 0], own[k, 1] = whole[p, 0], whole[p, 1]
                if degree == 1:
                    named = ACROSS if own[0, 1] == y else DOWN if own[0, 0] == x else OF_DEGREE[1]
                    points = own[:1]
                else:
                    if before != degree:
                        bent_x, bent_y = x, y  # after another kind of segment a smooth one has no first handle
                    smooth = own[0, 0] - x == x - bent_x and own[0, 1] - y == y - bent_y
                    named, points = (SMOOTH if smooth else OF_DEGREE)[degree], own[int(smooth) : degree]
                if precision and j == last:
                    at = write_command(text, at, letter, named - ABSOLUTE, points, 0.0, 0.0, precision)
                else:
                    at, letter = write_shorter(text, at, letter, named, points, x, y, precision)
                if degree > 1:
                    bent_x, bent_y = own[degree - 2, 0], own[degree - 2, 1]
                i, before, x, y = i + degree, degree, own[degree - 1, 0], own[degree - 1, 1]
            if closed[c]:
                text[at] = 90  # Z
                at, x, y = at + 1, whole[starts[c], 0], whole[starts[c], 1]
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
def combs_text(
    curves: ContourArrays, whole: ContourArrays, opened: BoolArray, glyphs: IntArray,
    corners: tuple[FloatArray, IntArray], measures: tuple[float, float, float], precision: int,
) -> tuple[Text, IntArray, FloatArray, IntArray]:  # fmt: skip
    """The combs of many glyphs, one after another: their teeth, and the text of these.

    Args:
        curves: of all glyphs, of open paths the way there. whole: as they are. opened: (C,) which are open paths.
        glyphs: (G + 1,) where the contours of each glyph begin. corners: see :func:`.comb.corners_left_out`.
        measures: em, scale and ``least`` of :func:`comb_teeth`.

    Returns:
        Text as bytes; (G, PARTS + 1) where each path of a glyph begins in it; nothing of a glyph with larger
        coordinates. (G, 4) boxes around feet and tips: left, bottom, right, top; NaN without teeth. (G,) the number of
        teeth that are cut.
    """
    em, scale, least = measures
    count, text, at = len(glyphs) - 1, np.empty(0, np.uint8), 0
    parts, boxes = np.zeros((count, PARTS + 1), np.int64), np.full((count, 4), np.nan)
    numbers = np.zeros(count, np.int64)
    for g in range(count):
        a, b = glyphs[g], glyphs[g + 1]
        sides = ink_sides(part_of(whole, a, b))
        for c in range(a, b):
            sides[c - a] = 1.0 if opened[c] else sides[c - a]
        ends, classes, cut, offsets = comb_teeth(
            part_of(curves, a, b), sides, corners[0], corners[1][a : b + 1], em, scale, least, precision
        )
        left, bottom, right, top = extremes(ends)
        fits = max(max(right, top), -min(left, bottom)) < LARGEST and len(ends) > 0
        if fits:
            boxes[g, 0], boxes[g, 1], boxes[g, 2], boxes[g, 3] = left, bottom, right, top
        marked = np.empty((len(ends), 2))
        for i in range(len(ends)):
            if cut[i] and classes[i] >= 0:
                marked[numbers[g], 0], marked[numbers[g], 1] = ends[i, 2], ends[i, 3]
                numbers[g] += 1
        own, begins = comb_text(ends if fits else ends[:0], classes, offsets if fits else offsets[:1], precision)
        marks = dots_text(marked[: numbers[g] if fits else 0], precision)
        for k in range(PARTS):
            parts[g, k] = at + begins[k]
        parts[g, PARTS] = at + len(own) + len(marks)
        if parts[g, PARTS] > len(text):
            larger = np.empty(2 * parts[g, PARTS], np.uint8)
            write_bytes(larger, 0, text[:at])
            text = larger
        at = write_bytes(text, write_bytes(text, at, own), marks)
    return text[:at], parts, boxes, numbers


@inlined
def extremes(ends: FloatArray) -> tuple[float, float, float, float]:
    """Left, bottom, right and top of feet and tips (k, 4)."""
    left = bottom = np.inf
    right = top = -np.inf
    for i in range(len(ends)):
        left, right = min(left, min(ends[i, 0], ends[i, 2])), max(right, max(ends[i, 0], ends[i, 2]))
        bottom, top = min(bottom, min(ends[i, 1], ends[i, 3])), max(top, max(ends[i, 1], ends[i, 3]))
    return left, bottom, right, top


@inlined
def write_bytes(text: Text, at: int, own: Text) -> int:
    """Write a text into another one at an index; returns the index behind."""
    for k in range(len(own)):
        text[at + k] = own[k]
    return at + len(own)


@compiled
def part_of(curves: ContourArrays, a: int, b: int) -> ContourArrays:
    """Contours a up to b, in the same memory but for their offsets."""
    points, degrees, offsets, starts = curves
    return ContourArrays(
        points[starts[a] : starts[b]], degrees[offsets[a] : offsets[b]], offsets[a : b + 1] - offsets[a],
        starts[a : b + 1] - starts[a],
    )  # fmt: skip


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
            x, y = np.floor(own[i, X] * power + half), np.floor(own[i, Y] * power + half)
            tip_x = np.floor((own[i, X] - reach * own[i, NX]) * power + half)
            tip_y = np.floor((own[i, Y] - reach * own[i, NY]) * power + half)
            if k > offsets[c] and _is_tooth(ends, k - 1, x, y, tip_x, tip_y):
                continue
            ends[k, 0], ends[k, 1], ends[k, 2], ends[k, 3] = x, y, tip_x, tip_y
            cut[k], classes[k] = abs(strength) > LONGEST, -1
            if min(abs(strength), LONGEST) > least and (x != tip_x or y != tip_y):
                classes[k] = SIDES + np.int64(np.rint(min(max(sides[c] * strength, -1.0), 1.0) * SIDES))
            k += 1
        j = offsets[c]
        if k > j + 1 and _is_tooth(ends, k - 1, ends[j, 0], ends[j, 1], ends[j, 2], ends[j, 3]):
            k -= 1  # the contour is closed
        offsets[c + 1] = k
    return ends[:k], classes[:k], cut[:k], offsets


@inlined
def _is_tooth(ends: FloatArray, k: int, x: float, y: float, tip_x: float, tip_y: float) -> bool:
    """Whether tooth k has this foot and this tip."""
    return bool(ends[k, 0] == x and ends[k, 1] == y and ends[k, 2] == tip_x and ends[k, 3] == tip_y)


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
    following, firsts = np.empty(len(ends), np.int64), np.full(layers + 1, -1)  # the next tooth of a class; the first
    for i in range(len(ends) - 1, -1, -1):
        following[i], firsts[classes[i]] = firsts[classes[i]], i
    at = 0
    for layer in range(layers):
        x, y, letter, i = 0.0, 0.0, MOVE, firsts[layer]
        while i >= 0:
            at = write_pair(text, at, letter, ends[i, 0] - x, ends[i, 1] - y, precision)
            x, y, letter = ends[i, 2], ends[i, 3], MOVE_BY
            at = write_pair(text, at, LINE_BY, x - ends[i, 0], y - ends[i, 1], precision)
            i = following[i]
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
