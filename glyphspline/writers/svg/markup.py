"""Common parts of SVG documents: numbers, text, and attributes of a glyph."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from functools import lru_cache
from html import escape

from ...outlines.outline import FontMetrics, Outline
from .path_data import NUMBER, Box

Text = str | memoryview
"""Part of a document; compiled code writes ASCII bytes."""

_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_NOT_ID = re.compile(r"[^A-Za-z0-9_-]")


def document(parts: Iterable[Text]) -> bytes:
    """A document from its parts, in UTF-8."""
    return b"".join([part.encode() if isinstance(part, str) else part for part in parts])


def head(box: str, name: str, title: str, attributes: str = "", shape: str = "") -> str:
    """The beginning of a document.

    Args:
        box: value of its ``viewBox``. name: id of its title. title: escaped.
        attributes, shape: further attributes, each after a space; those of its size come first.
    """
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}"{shape} role="img" aria-labelledby="{name}"'
        f'{attributes}>\n<title id="{name}">{title}</title>\n'
    )


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
    """Prefix of the ids of a glyph's drawing, which are unique in a document of several drawings."""
    return f"g{gid}-{name if name.isalnum() and name.isascii() else _NOT_ID.sub('_', name)}"


def code_points(outline: Outline) -> str:
    """The glyph's code points as "U+0041 U+0391"."""
    return " ".join([f"U+{code:04X}" for code in outline.unicodes])


def data_attributes(outline: Outline, precision: int) -> str:
    """The glyph's identity and horizontal metrics as ``data-*`` attributes."""
    return (
        f' data-glyph="{text(outline.name)}" data-gid="{outline.gid}" data-unicodes="{code_points(outline)}"'
        f' data-advance="{number(outline.advance, precision)}" {_font_attributes(outline.metrics, precision)}'
    )


@lru_cache(maxsize=64)
def _font_attributes(metrics: FontMetrics, precision: int) -> str:
    values = {"units-per-em": metrics.units_per_em, "ascender": metrics.ascender, "descender": metrics.descender}
    return " ".join(f'data-{key}="{number(value, precision)}"' for key, value in values.items())


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
