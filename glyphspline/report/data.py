"""What the gallery's data files say of a glyph: its drawing, and a row of the table that glyphs are sorted by.

Both are text as soon as they are known, so that a worker can write a whole page of drawings from what it has in memory.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from json.encoder import encode_basestring_ascii as quoted
from typing import Any

from ..fitting.results import SOLVED
from ..writers.svg.markup import Text, joined
from .drawings import Drawing
from .glyph_measures import MEASURES, glyph_measures

FOLDER = "gallery"

CHUNK = 40
"""Glyphs on a page, a file of drawings: about half a megabyte of CJK outlines, a tenth of a second to load."""

COLUMNS = (
    "glyph", "gid", "unicodes", "advance", "status", "contours",
    *SOLVED, *(name for name in MEASURES if name not in SOLVED),
)  # fmt: skip
"""What a row of the table has, in order; what is not known is null, and left out at a row's end."""

DIGITS = 5
"""Significant digits of the table's measures."""

_NULL = re.compile(r',"[a-z_]+":null')

_encoded = json.JSONEncoder(ensure_ascii=True, allow_nan=False, separators=(",", ":")).encode


def page_file(number: int) -> str:
    """Where a page is, relative to the run's folder."""
    return f"{FOLDER}/glyphs-{number:05}.js"


def page_text(glyphs: Iterable[bytes]) -> bytes:
    """A page of drawings, each as :func:`glyph_text` gives it."""
    return b"glyphsplineData([" + b",".join(glyphs) + b"]);\n"


def glyph_text(drawing: Drawing, files: str, contours: str, error: str | None) -> bytes:
    """A glyph on its page, as JSON.

    Args:
        drawing: its path data. files: its files as :func:`files_text` gives them. error: what went wrong.
        contours: the measures of its contours as the manifest has them, without the brackets; nulls are left out.
    """
    if ":null" in contours:
        contours = _NULL.sub("", contours)
    parts: list[Text] = ["{"]
    for name, data in drawing.items():
        parts += [f'"{name}":"', data, '",']
    said = "null" if error is None else as_json(error)
    parts.append(f'"files":{{{escaped(files)}}},"contours":[{escaped(contours)}],"error":{said}}}')
    return joined(parts)


def files_text(files: Mapping[str, str]) -> str:
    """Files by format, relative to the run's folder, as JSON without the braces."""
    return ",".join([f"{quoted(name)}:{quoted(path)}" for name, path in files.items()])


def contours_text(contours: Iterable[Mapping[str, Any]]) -> str:
    """What :func:`glyph_text` wants of the measures that were read from a manifest: the same text but for nulls."""
    return ",".join(
        "{" + ",".join(f"{as_json(str(name))}:{_value(value)}" for name, value in known.items()) + "}"
        for known in ({name: value for name, value in contour.items() if value is not None} for contour in contours)
    )


def _value(value: Any) -> str:
    return number(value) if value is None or isinstance(value, int | float) else as_json(value)


def number(value: float | None, digits: int = 7) -> str:
    """A number as JSON: seven significant digits, beyond which measures are rounding noise; not finite is null."""
    if value is None:
        return "null"
    if value is True or value is False:
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    text = f"{value:.{digits}g}"
    return "null" if "n" in text else text


def table_row(
    glyph: str,
    gid: int,
    unicodes: Iterable[object],
    advance: float | None,
    status: str,
    contours: Sequence[Mapping[str, Any]],
) -> str:
    """A glyph's row of the table, as JSON; the arguments are what its line of the manifest has."""
    measures = glyph_measures(contours)
    row = [as_json(glyph), str(gid), as_json(" ".join(map(str, unicodes))), number(advance), as_json(status)]
    row += [str(len(contours)), *(number(measures[name], DIGITS) for name in COLUMNS[len(row) + 1 :])]
    while row[-1] == "null":
        row.pop()
    return f"[{','.join(row)}]"


def table_text(rows: Iterable[str]) -> str:
    """A file of the table."""
    return f'glyphsplineData({{"columns":{as_json(COLUMNS)},"rows":[{",".join(rows)}]}});\n'


def script(data: Any) -> str:
    """A data file: one call."""
    return f"glyphsplineData({as_json(data)});\n"


def as_json(data: Any) -> str:
    """JSON that can stand in a script and in a page: ASCII, and no "<" that could end either."""
    return escaped(_encoded(data))


def escaped(text: str) -> str:
    """JSON without "<"."""
    return text.replace("<", "\\u003c")
