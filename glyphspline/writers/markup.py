"""What all SVG writers share: numbers, text, path data, bounds, and what is said about a glyph."""

from __future__ import annotations

import re
from collections.abc import Iterable
from html import escape

import numpy as np

from ..arrays import FloatArray
from ..outline import Contour, Outline

Box = tuple[float, float, float, float]
"""Left, bottom, right, top in font units, y up."""

NUMBER = "%.15g"
"""A rounded coordinate. 15 digits never show the binary tail of a double, and %g drops zeros at the end; 17 would
write 0.1 as 0.10000000000000001."""

_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_NOT_ID = re.compile(r"[^A-Za-z0-9_-]")
_COMMANDS = {d: "MLQC"[d] + " ".join([f"{NUMBER} {NUMBER}"] * d) for d in (1, 2, 3)}


def number(value: float, precision: int) -> str:
    """One number with at most ``precision`` decimals: no zeros at the end, no "-0"."""
    return NUMBER % (round(float(value), precision) + 0.0)


def text(value: str) -> str:
    """Text for element content or a quoted attribute; characters that XML forbids become U+FFFD."""
    return escape(_NOT_XML.sub("\ufffd", value))


def id_prefix(name: str, gid: int) -> str:
    """What the ids of a glyph's drawing begin with, so that several can stand in one document."""
    return f"g{gid}-{_NOT_ID.sub('_', name)}"


def code_points(outline: Outline) -> str:
    """The glyph's code points as "U+0041 U+0391"."""
    return " ".join(f"U+{code:04X}" for code in outline.unicodes)


def data_attributes(outline: Outline, precision: int) -> str:
    """The glyph's identity and horizontal metrics as ``data-*`` attributes."""
    metrics = outline.metrics
    values = {
        "glyph": text(outline.name),
        "gid": str(outline.gid),
        "unicodes": code_points(outline),
        "advance": number(outline.advance, precision),
        "units-per-em": number(metrics.units_per_em, precision),
        "ascender": number(metrics.ascender, precision),
        "descender": number(metrics.descender, precision),
    }
    return " ".join(f'data-{key}="{value}"' for key, value in values.items())


def path_data(contours: Iterable[Contour], precision: int) -> str:
    """All contours as one SVG path: absolute lines, quadratics and cubics, (x, y) written as (x, -y)."""
    return "".join(_contour_data(contour, precision) for contour in contours if len(contour))


def _contour_data(contour: Contour, precision: int) -> str:
    closed = np.concatenate([contour.points, contour.points[:1]])
    degrees = contour.degrees.tolist()
    if degrees[-1] == 1:  # Z draws the last line
        closed, degrees = closed[:-1], degrees[:-1]
    template = f"M{NUMBER} {NUMBER}" + "".join([_COMMANDS[d] for d in degrees]) + "Z"
    # One % for the whole contour: number by number takes three times as long. Adding 0.0 turns -0.0 into 0.0.
    return template % tuple((np.round(closed * (1, -1), precision) + 0.0).ravel().tolist())


def polyline_data(points: FloatArray, precision: int, *, closed: bool = False) -> str:
    """Points (k, 2) joined by straight lines, as SVG path data; y flipped."""
    values = (np.round(points * (1, -1), precision) + 0.0).ravel().tolist()
    return "M" + " ".join([NUMBER] * len(values)) % tuple(values) + ("Z" if closed else "")


def segments_data(starts: FloatArray, ends: FloatArray, precision: int) -> str:
    """Separate strokes from each of ``starts`` (k, 2) to its end, as SVG path data; y flipped.

    The ends are written relative to the rounded starts, which is shorter and adds no error up.
    """
    a = np.round(starts * (1, -1), precision)
    b = np.round(np.round(ends * (1, -1), precision) - a, precision)
    values = (np.concatenate([a, b], axis=1) + 0.0).ravel().tolist()
    return f"M{NUMBER} {NUMBER}l{NUMBER} {NUMBER}" * len(a) % tuple(values)


def ink_bounds(contours: Iterable[Contour]) -> Box | None:
    """The tight box around all contours; None if there is nothing."""
    points = [_extreme_points(contour.cubics()) for contour in contours if len(contour)]
    if not points:
        return None
    every = np.concatenate(points)
    (left, bottom), (right, top) = every.min(axis=0), every.max(axis=0)
    return float(left), float(bottom), float(right), float(top)


def _extreme_points(pieces: FloatArray) -> FloatArray:
    """(4m, 2): for each cubic and each axis, its ends and the values where the derivative is zero."""
    p0, p1, p2, p3 = np.moveaxis(pieces, 1, 0)
    a, half_b, c = p3 - 3 * p2 + 3 * p1 - p0, p2 - 2 * p1 + p0, p1 - p0
    root = np.sqrt(np.maximum(half_b * half_b - a * c, 0.0))
    # The stable pair q/a and c/q: neither loses digits when a is small, as on a line or a quadratic raised.
    q = -(half_b + np.where(half_b < 0, -root, root))
    values = [p0, p3]
    for numerator, denominator in ((q, a), (c, q)):
        x = np.divide(numerator, denominator, out=np.zeros_like(q), where=np.abs(denominator) > np.abs(numerator))
        x = np.clip(x, 0.0, 1.0)
        y = 1 - x
        values.append(y**3 * p0 + 3 * y * y * x * p1 + 3 * y * x * x * p2 + x**3 * p3)
    return np.concatenate(values)


def union(a: Box, b: Box | None) -> Box:
    """The smallest box around both."""
    return a if b is None else (min(a[0], b[0]), min(a[1], b[1]), max(a[2], b[2]), max(a[3], b[3]))


def view_box_value(box: Box, precision: int) -> str:
    """The ``viewBox`` value of a box, rounded outwards, at least one unit wide and high (0 would hide all)."""
    unit = 10.0**precision
    left, bottom = np.floor(box[0] * unit) / unit, np.floor(box[1] * unit) / unit
    right, top = np.ceil(box[2] * unit) / unit, np.ceil(box[3] * unit) / unit
    values = (left, -top, max(right - left, 1.0), max(top - bottom, 1.0))
    return " ".join(number(value, precision) for value in values)
