"""Path data of a curvature comb, compiled: teeth by colour, the line through their tips, marks of those cut short.

All of it is relative but for the first point, in whole units of the last digit, so that nothing adds up.
"""

# mypy: disable-error-code="no-untyped-def, no-any-return"

from __future__ import annotations

import numpy as np

from ...compiled import compiled, store
from ...curves.comb import CURVATURE, NX, NY, X, Y, control_length, sampled
from .colours import SIDES
from .numbers import LARGEST, SLACK, WIDEST
from .path_data import DOT, LINE_BY, MOVE, MOVE_BY, more, nearest, step

__all__ = ["comb_text", "control_length", "dots_text", "sampled"]

CLASSES = 2 * SIDES + 1
LAYERS = CLASSES + 2
"""Texts of a comb: a path of teeth for each colour class, from the strongest right turn; the line; the marks."""

FLAT = -1
TWO = np.uint64(2)


@compiled
def comb_text(samples, contours, tooth, scale, longest, least, precision, power, limit, words):
    """The texts of a glyph's comb.

    Args:
        samples: (k, 6) as ``combing`` has them. contours: (c + 1,) where those of each contour begin.
        tooth: length of a tooth at the scale. scale: in 1/unit; 0 draws no teeth. longest: where teeth are cut, in
            units of the scale. least: teeth shorter than this are left out.
        precision, power, limit, words: the figures of so many decimals.

    Returns:
        The text as bytes; (LAYERS + 1,) where each part of it begins; (4,) left, bottom, right, top of feet and tips.
    """
    figures = (precision, power, limit, np.uint64(words.ctypes.data))
    k = len(samples)
    points, classes = np.empty((k, 4)), np.empty(k, dtype=np.int64)
    ends = np.zeros(len(contours), dtype=np.int64)
    text = np.empty(k * 10 * WIDEST + SLACK, dtype=np.uint8)
    parts = np.zeros(LAYERS + 1, dtype=np.int64)
    used = 0
    for contour in range(len(contours) - 1):
        part = samples[contours[contour] : contours[contour + 1]]
        used = _place(part, tooth, scale, longest, least, power, points, classes, used)
        ends[contour + 1] = used
    box = _bounds(points[:used])
    start = np.uint64(text.ctypes.data)
    at = start
    if used and max(box[2], box[3], -box[0], -box[1]) < LARGEST:
        at = _teeth(at, points, classes[:used], parts, figures)
        at = _line(at, points, classes, ends, figures)
        parts[CLASSES + 1] = np.int64(at - start)
        at = _marks(at, points, classes[:used], figures)
    parts[LAYERS] = np.int64(at - start)
    return text[: parts[LAYERS]], parts, box / power


@compiled
def _place(samples, tooth, scale, longest, least, power, points, classes, used):
    """Feet and tips of a contour's teeth, rounded; their colour classes, FLAT if left out, beyond CLASSES if cut.

    What is where the one before it was is left out: pieces share their ends. How many there are now.
    """
    first = used
    inverse = 1.0 / scale if scale > 0.0 else 0.0
    for i in range(len(samples)):
        strength = samples[i, CURVATURE] * inverse
        reach = tooth * min(max(strength, -longest), longest)
        x, y = nearest(samples[i, X] * power), nearest(samples[i, Y] * power)
        tx = nearest((samples[i, X] - reach * samples[i, NX]) * power)
        ty = nearest((samples[i, Y] - reach * samples[i, NY]) * power)
        if used > first and _same(points, used - 1, x, y, tx, ty):
            continue
        points[used, 0], points[used, 1], points[used, 2], points[used, 3] = x, y, tx, ty
        classes[used] = FLAT
        if abs(reach) > least and (x != tx or y != ty):
            index = np.int64(np.rint(min(max(strength, -1.0), 1.0) * SIDES)) + SIDES
            classes[used] = index + (CLASSES if abs(strength) > longest else 0)
        used += 1
    a = first
    if used > a + 1 and _same(points, used - 1, points[a, 0], points[a, 1], points[a, 2], points[a, 3]):
        used -= 1  # the contour is closed
    return used


@compiled
def _same(points, i, x, y, tx, ty):
    return points[i, 0] == x and points[i, 1] == y and points[i, 2] == tx and points[i, 3] == ty


@compiled
def _bounds(points):
    left = bottom = np.inf
    right = top = -np.inf
    for i in range(len(points)):
        x, y, tx, ty = points[i, 0], points[i, 1], points[i, 2], points[i, 3]
        left, bottom, right, top = min(left, x, tx), min(bottom, y, ty), max(right, x, tx), max(top, y, ty)
    return np.array([left, bottom, right, top])


@compiled
def _teeth(at, points, classes, parts, figures):
    """Every tooth a stroke from foot to tip, class after class."""
    start = at
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
            at = step(at, letter, points[i, 0] - x, points[i, 1] - y, figures)
            x, y = points[i, 2], points[i, 3]
            at = step(at, LINE_BY, x - points[i, 0], y - points[i, 1], figures)
            letter = MOVE_BY
        parts[c + 1] = np.int64(at - start)
    return at


@compiled
def _line(at, points, classes, ends, figures):
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
                at = more(at, dx, dy, figures)
            else:
                at = step(at, letter, points[i, 2] - x, points[i, 3] - y, figures)
                at = step(at, LINE_BY, dx, dy, figures)
            letter, down = MOVE_BY, True
            x, y = points[j, 2], points[j, 3]
    return at


@compiled
def _marks(at, points, classes, figures):
    """A dot on every tip that was cut."""
    x = y = 0.0
    letter = MOVE
    for i in range(len(classes)):
        if classes[i] >= CLASSES:
            at = step(at, letter, points[i, 2] - x, points[i, 3] - y, figures)
            store(at, DOT)
            at += TWO
            x, y = points[i, 2], points[i, 3]
            letter = MOVE_BY
    return at


@compiled
def dots_text(points, precision, power, limit, words):
    """Path data of a dot on each of the points (n, 2), as bytes; nothing if one is too large to be written."""
    figures = (precision, power, limit, np.uint64(words.ctypes.data))
    text = np.empty(len(points) * 3 * WIDEST + SLACK, dtype=np.uint8)
    start = np.uint64(text.ctypes.data)
    at = start
    x = y = 0.0
    letter = MOVE
    for i in range(len(points)):
        nx, ny = nearest(points[i, 0] * power), nearest(points[i, 1] * power)
        if not (abs(nx) < LARGEST and abs(ny) < LARGEST):
            continue
        at = step(at, letter, nx - x, ny - y, figures)
        store(at, DOT)
        at += TWO
        x, y = nx, ny
        letter = MOVE_BY
    return text[: np.int64(at - start)]
