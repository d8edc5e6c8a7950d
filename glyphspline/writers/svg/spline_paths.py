"""Closed cubic splines as rounded Bézier points and as SVG path data, compiled."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from .bounds import ink_box
from .numbers import SLACK, WIDEST
from .path_data import curve, fit


@compiled
def cubics_of_splines(controls, knots, offsets, counts):
    """Bézier pieces of closed splines, those of each in curve order.

    Args:
        controls: control points of all splines end to end, spline k's from ``offsets[k]``. knots: likewise, from
            ``offsets[k] + k``. counts: (K,) control points of each, at most as many as there is room for.

    Returns:
        (N, 4, 2) pieces, end to end without gaps; (K + 1,) where those of each spline begin.
    """
    starts = np.zeros(len(counts) + 1, dtype=np.int64)
    for k in range(len(counts)):
        starts[k + 1] = starts[k] + counts[k]
    cubics = np.empty((starts[-1], 4, 2))
    for k in range(len(counts)):
        n, at = counts[k], offsets[k]
        if n:
            bezier_points(controls[at : at + n], knots[at + k : at + k + n + 1], cubics[starts[k] : starts[k + 1]])
    return cubics, starts


@compiled
def bezier_points(controls, knots, cubics):
    """Bézier points of a closed spline, one piece a span.

    Args:
        controls: (n, 2). knots: (n + 1,). cubics: (n, 4, 2), written to.
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
            cubics[k, 1, axis] = (1.0 - a) * start + a * end
            cubics[k, 2, axis] = (1.0 - b) * start + b * end
        before = h
    before = knots[n] - knots[n - 1]
    for k in range(n):
        h = knots[k + 1] - knots[k]
        share = before / (before + h)
        for axis in range(2):
            joint = (1.0 - share) * cubics[k - 1, 2, axis] + share * cubics[k, 1, axis]
            cubics[k, 0, axis] = cubics[k - 1, 3, axis] = joint
        before = h


@compiled
def paths(cubics, starts, before, precision, power, limit, words):
    """SVG path data of many glyphs, one after the other.

    Args:
        cubics, starts: as :func:`cubics_of_splines` gave them. before: (g + 1,) splines before each glyph.
        precision, power, limit, words: the figures of so many decimals.

    Returns:
        Text as bytes; (g + 1,) where in it each glyph begins; (g, 4) left, bottom, right, top of the curves;
        (g,) whether a glyph has numbers too large to be written so.
    """
    glyphs = len(before) - 1
    text = np.empty((3 * len(cubics) + len(starts)) * 2 * WIDEST + SLACK, dtype=np.uint8)
    ends = np.zeros(glyphs + 1, dtype=np.int64)
    boxes = np.zeros((glyphs, 4))
    odd = np.zeros(glyphs, dtype=np.bool_)
    figures = (precision, power, limit, np.uint64(words.ctypes.data))
    degrees = np.full(max(1, len(cubics)), 3)
    start = np.uint64(text.ctypes.data)
    at = start
    for glyph in range(glyphs):
        first = starts[before[glyph]]
        points, rounded = whole_units(cubics[first : starts[before[glyph + 1]]], power)
        boxes[glyph] = ink_box(rounded)
        odd[glyph] = not fit(points)
        for k in range(before[glyph], before[glyph] if odd[glyph] else before[glyph + 1]):
            a, b = starts[k] - first, starts[k + 1] - first
            if b > a:
                at = curve(at, points[3 * a : 3 * b], degrees[: b - a], figures)
        ends[glyph + 1] = np.int64(at - start)
    return text[: np.int64(at - start)], ends, boxes, odd


@compiled
def whole_units(cubics, power):
    """(3 m, 2) Bézier points, joints once, in whole units of the last digit; and (m, 4, 2) the pieces, rounded so."""
    flat, unit = cubics.reshape(-1), np.float64(power)
    whole, rounded, points = np.empty_like(flat), np.empty_like(flat), np.empty(6 * len(cubics))
    for i in range(np.uint64(len(flat))):
        whole[i] = np.rint(flat[i] * unit)
        rounded[i] = whole[i] / unit
    for j in range(np.uint64(len(cubics))):
        for k in range(np.uint64(6)):
            points[np.uint64(6) * j + k] = whole[np.uint64(8) * j + k]
    return points.reshape(-1, 2), rounded.reshape(-1, 4, 2)
