"""Closed cubic splines as rounded Bézier points and as SVG path data, compiled."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np
from numba import njit

WIDEST = 20
"""Characters of the longest number written, with what separates it from the next."""

LARGEST = 1e15
"""Rounded coordinates, in units of the last digit, have to be below this: as doubles they are whole numbers there."""


@njit(cache=True, nogil=True, error_model="numpy")
def bezier_points(controls, knots, points):
    """Bézier points of a closed spline, three a span in curve order; the next span's first is the fourth.

    Args:
        controls: (n, 2). knots: (n + 1,). points: (n, 3, 2), written to.
    """
    n = len(controls)
    before = knots[n] - knots[n - 1]
    for k in range(n):
        h = knots[k + 1] - knots[k]
        after = knots[(k + 1) % n + 1] - knots[(k + 1) % n]
        whole = before + h + after
        a, b = before / whole, (before + h) / whole
        following = k + 1 if k + 1 < n else 0
        for axis in range(2):
            start, end = controls[k, axis], controls[following, axis]
            points[k, 1, axis] = (1.0 - a) * start + a * end
            points[k, 2, axis] = (1.0 - b) * start + b * end
        before = h
    before = knots[n] - knots[n - 1]
    for k in range(n):
        h = knots[k + 1] - knots[k]
        share = before / (before + h)
        for axis in range(2):
            points[k, 0, axis] = (1.0 - share) * points[k - 1, 2, axis] + share * points[k, 1, axis]
        before = h


@njit(cache=True, nogil=True, error_model="numpy")
def paths(controls, knots, offsets, counts, before, precision):
    """SVG path data of many glyphs, one after the other.

    Args:
        controls: control points of all splines end to end, spline k's from ``offsets[k]``. knots: likewise, from
            ``offsets[k] + k``. counts: (K,) control points of each, at most as many as there is room for.
        before: (g + 1,) splines before each glyph. precision: decimals.

    Returns:
        Text as bytes; (g + 1,) where in it each glyph begins; (g, 4) left, bottom, right, top of the rounded Bézier
        points; (g,) whether a glyph has numbers too large to be written so.
    """
    glyphs = len(before) - 1
    vertices = 0
    for k in range(len(counts)):
        vertices += counts[k]
    text = np.empty(vertices * 6 * WIDEST + len(counts) * 2 * WIDEST + 64, dtype=np.uint8)
    ends = np.zeros(glyphs + 1, dtype=np.int64)
    boxes = np.zeros((glyphs, 4))
    odd = np.zeros(glyphs, dtype=np.bool_)
    unit, power = 1.0, 1
    for _ in range(precision):
        unit *= 10.0
        power *= 10
    at = 0
    for glyph in range(glyphs):
        box = boxes[glyph]
        box[0] = box[1] = np.inf
        box[2] = box[3] = -np.inf
        for k in range(before[glyph], before[glyph + 1]):
            n = counts[k]
            points = np.empty((n, 3, 2))
            start = offsets[k]
            bezier_points(controls[start : start + n], knots[start + k : start + k + n + 1], points)
            largest = 0.0
            for i in range(n):
                for j in range(3):
                    x, y = np.rint(points[i, j, 0] * unit), np.rint(points[i, j, 1] * unit)
                    points[i, j, 0], points[i, j, 1] = x, y
                    largest = max(largest, abs(x), abs(y))
                    box[0], box[1] = min(box[0], x / unit), min(box[1], y / unit)
                    box[2], box[3] = max(box[2], x / unit), max(box[3], y / unit)
            if not largest < LARGEST:
                odd[glyph] = True
                break
            at = _contour(text, at, points, precision, power)
        if odd[glyph]:
            at = ends[glyph]
        ends[glyph + 1] = at
    return text[:at], ends, boxes, odd


@njit(cache=True, nogil=True, error_model="numpy")
def _contour(text, at, points, precision, power):
    """M, a C for each span, Z; y flipped."""
    n = len(points)
    text[at] = 77
    at = _pair(text, at + 1, points[0, 0], precision, power)
    for i in range(n):
        text[at] = 67
        at = _pair(text, at + 1, points[i, 1], precision, power)
        text[at] = 32
        at = _pair(text, at + 1, points[i, 2], precision, power)
        text[at] = 32
        at = _pair(text, at + 1, points[i + 1 if i + 1 < n else 0, 0], precision, power)
    text[at] = 90
    return at + 1


@njit(cache=True, nogil=True, error_model="numpy")
def _pair(text, at, point, precision, power):
    """Two numbers with a space between them."""
    at = number(text, at, np.int64(point[0]), precision, power)
    text[at] = 32
    return number(text, at + 1, -np.int64(point[1]), precision, power)


@njit(cache=True, nogil=True, error_model="numpy")
def number(text, at, value, precision, power):
    """Write value / power with no zeros at its end; where the next character goes."""
    if value < 0:
        text[at] = 45
        at += 1
        value = -value
    whole = value // power
    part = value - whole * power
    digits = 1
    rest = whole
    while rest >= 10:
        rest //= 10
        digits += 1
    for k in range(digits):
        text[at + digits - 1 - k] = 48 + whole % 10
        whole //= 10
    at += digits
    if part:
        decimals = precision
        while part % 10 == 0:
            part //= 10
            decimals -= 1
        text[at] = 46
        for k in range(decimals):
            text[at + decimals - k] = 48 + part % 10
            part //= 10
        at += decimals + 1
    return at
