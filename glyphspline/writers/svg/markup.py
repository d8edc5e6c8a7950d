"""What all SVG writers share: numbers, text, path data, bounds, and what is said about a glyph."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from functools import cache, lru_cache
from html import escape
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ...outlines.outline import Contour, FontMetrics, Outline
from ...types import BoolArray, FloatArray, IntArray
from .digit_tables import figures

Text = str | memoryview
"""Part of a document; what compiled code has written is bytes already, in ASCII."""

Box = tuple[float, float, float, float]
"""Left, bottom, right, top in font units, y up."""

NUMBER = "%.15g"
"""A rounded coordinate. 15 digits never show the binary tail of a double, and %g drops zeros at the end; 17 would
write 0.1 as 0.10000000000000001."""

NO_DEGREES = np.empty(0, dtype=np.int64)

_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_NOT_ID = re.compile(r"[^A-Za-z0-9_-]")
_COMMANDS = {d: "MLQC"[d] + " ".join([f"{NUMBER} {NUMBER}"] * d) for d in (1, 2, 3)}


@cache
def _compiled() -> Any:
    """The compiled writers of path data, imported when they are first wanted: the package opens without a compiler."""
    from . import path_data as path_text

    return path_text


def joined(parts: Iterable[Text]) -> bytes:
    """A document from its parts, in UTF-8."""
    return b"".join([part.encode() if isinstance(part, str) else part for part in parts])


@lru_cache(maxsize=4096)
def number(value: float, precision: int) -> str:
    """One number with at most ``precision`` decimals: no zeros at the end, no "-0"."""
    return NUMBER % (round(float(value), precision) + 0.0)


def text(value: str) -> str:
    """Text for element content or a quoted attribute; characters that XML forbids become U+FFFD."""
    if value.isalnum() and value.isascii():
        return value
    return escape(_NOT_XML.sub("\ufffd", value))


def id_prefix(name: str, gid: int) -> str:
    """What the ids of a glyph's drawing begin with, so that several can stand in one document."""
    return f"g{gid}-{name if name.isalnum() and name.isascii() else _NOT_ID.sub('_', name)}"


def code_points(outline: Outline) -> str:
    """The glyph's code points as "U+0041 U+0391"."""
    return " ".join([f"U+{code:04X}" for code in outline.unicodes])


def data_attributes(outline: Outline, precision: int) -> str:
    """The glyph's identity and horizontal metrics as ``data-*`` attributes."""
    return (
        f'data-glyph="{text(outline.name)}" data-gid="{outline.gid}" data-unicodes="{code_points(outline)}"'
        f' data-advance="{number(outline.advance, precision)}" {_font_attributes(outline.metrics, precision)}'
    )


@lru_cache(maxsize=64)
def _font_attributes(metrics: FontMetrics, precision: int) -> str:
    values = {"units-per-em": metrics.units_per_em, "ascender": metrics.ascender, "descender": metrics.descender}
    return " ".join(f'data-{key}="{number(value, precision)}"' for key, value in values.items())


def path_data(contours: Iterable[Contour], precision: int) -> str:
    """All contours as one SVG path of lines, quadratics and cubics, (x, y) written as (x, -y)."""
    return bytes(curves_data(*laid_out(contours), precision)).decode("ascii")


def laid_out(contours: Iterable[Contour]) -> tuple[FloatArray, IntArray, IntArray]:
    """Contours one after the other: points (N, 2), degrees (m,), and (c + 1,) where each begins among these."""
    drawn = [contour for contour in contours if len(contour)]
    points = np.concatenate([np.empty((0, 2)), *(contour.points for contour in drawn)])
    degrees = np.concatenate([NO_DEGREES, *(contour.degrees for contour in drawn)])
    return points, degrees, np.cumsum([0, *map(len, drawn)], dtype=np.int64)


def curves_data(points: FloatArray, degrees: IntArray, contours: IntArray, precision: int) -> memoryview:
    """The same, as bytes, of contours one after the other.

    Args:
        points: (N, 2). degrees: (m,). contours: (c + 1,) where contours begin among these.
    """
    text = _compiled().curves_text(points, degrees, contours, *figures(precision))
    if text is not None:
        return memoryview(text)
    ends = np.concatenate([[0], np.cumsum(degrees)])[contours]
    parts = [Contour(points[ends[k] : ends[k + 1]], degrees[a:b]) for k, (a, b) in enumerate(pairwise(contours))]
    return memoryview("".join([_contour_data(part, precision) for part in parts]).encode())


def _contour_data(contour: Contour, precision: int) -> str:
    """One contour with numbers of any size, all of them absolute."""
    closed = np.concatenate([contour.points, contour.points[:1]])
    degrees = contour.degrees.tolist()
    if degrees[-1] == 1:  # Z draws the last line
        closed, degrees = closed[:-1], degrees[:-1]
    template = f"M{NUMBER} {NUMBER}" + "".join([_COMMANDS[d] for d in degrees]) + "Z"
    return template % tuple((np.round(closed * (1, -1), precision) + 0.0).ravel().tolist())


class Chains(NamedTuple):
    """Points (N, 2) of polygons; (p,) where each begins and where it stops; (p,) whether it is closed."""

    points: FloatArray
    starts: IntArray
    stops: IntArray
    closed: BoolArray


def chains(parts: Sequence[FloatArray], closed: Sequence[bool]) -> Chains:
    """Polygons laid end to end."""
    ends = np.cumsum([0, *map(len, parts)], dtype=np.int64)
    return Chains(np.concatenate([np.empty((0, 2)), *parts]), ends[:-1], ends[1:], np.array(closed, dtype=np.bool_))


def polyline_data(points: FloatArray, precision: int, *, closed: bool = False) -> str:
    """Points (k, 2) joined by straight lines, as SVG path data; y flipped."""
    return bytes(polylines_data(chains([points], [closed]), precision)).decode("ascii")


def polylines_data(parts: Chains, precision: int) -> memoryview:
    """The same of many, as bytes."""
    text = _compiled().polylines_text(*parts, *figures(precision))
    if text is not None:
        return memoryview(text)
    each = zip(parts.starts.tolist(), parts.stops.tolist(), parts.closed.tolist(), strict=True)
    texts = [_polyline_data(parts.points[a:b], precision) + ("Z" if end else "") for a, b, end in each if b > a]
    return memoryview("".join(texts).encode())


def _polyline_data(points: FloatArray, precision: int) -> str:
    """One chain with numbers of any size, all of them absolute."""
    values = (np.round(points * (1, -1), precision) + 0.0).ravel().tolist()
    return "M" + " ".join([NUMBER] * len(values)) % tuple(values)


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
    return curves_bounds(*laid_out(contours))


def curves_bounds(points: FloatArray, degrees: IntArray, contours: IntArray) -> Box | None:
    """The same of contours one after the other, as :func:`curves_data` has them."""
    from .bounds import contours_box

    if not len(points):
        return None
    left, bottom, right, top = contours_box(points, degrees, contours).tolist()
    return left, bottom, right, top


def union(a: Box, b: Box | None) -> Box:
    """The smallest box around both."""
    return a if b is None else (min(a[0], b[0]), min(a[1], b[1]), max(a[2], b[2]), max(a[3], b[3]))


@lru_cache(maxsize=4096)
def view_box_value(box: Box, precision: int) -> str:
    """The ``viewBox`` value of a box, rounded outwards, at least one unit wide and high (0 would hide all)."""
    unit = 10.0**precision
    left, bottom = math.floor(box[0] * unit) / unit, math.floor(box[1] * unit) / unit
    right, top = math.ceil(box[2] * unit) / unit, math.ceil(box[3] * unit) / unit
    values = (left, -top, max(right - left, 1.0), max(top - bottom, 1.0))
    return " ".join(number(value, precision) for value in values)
