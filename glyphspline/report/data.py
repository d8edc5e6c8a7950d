"""The gallery's data files: a script with the drawing of each glyph, and tables of measures."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from json.encoder import encode_basestring_ascii as quoted
from pathlib import PurePosixPath
from typing import Any

from ..fitting.results import BOUNDS, SOLVED
from ..types import rounded_up
from ..writers.svg.markup import Text, document
from .gallery_files import FOLDER
from .glyph_measures import MEASURES, glyph_measures

COLUMNS = (
    "glyph", "gid", "unicodes", "advance", "status", "file", "error", "contours",
    *SOLVED, *(name for name in MEASURES if name not in SOLVED),
)  # fmt: skip
"""Columns of the table; nulls at the end of a row are omitted."""

DIGITS = 5
"""Significant digits of the table's measures."""

_NULL = re.compile(r',"[a-z_]+":null')

_encoded = json.JSONEncoder(ensure_ascii=True, allow_nan=False, separators=(",", ":")).encode


def glyph_text(drawing: Mapping[str, Text], files: Mapping[str, str], contours: str) -> bytes:
    """A glyph's data file.

    Args:
        drawing: path data of ``source``, ``result``, ``polygon`` and ``control``; "" if unknown.
        files: by format, relative to the run's folder.
        contours: the measures of its contours as JSON without the brackets; nulls are left out.
    """
    links = files_text({name: path for name, path in files.items() if name != FOLDER})
    parts: list[Text] = ["glyphsplineData({"]
    for name, data in drawing.items():
        parts += [f'"{name}":"', data, '",']
    parts.append(f'"files":{{{escaped(links)}}},"contours":[{escaped(_NULL.sub("", contours))}]}});\n')
    return document(parts)


def files_text(files: Mapping[str, str]) -> str:
    """Files by format as JSON without the braces."""
    return ",".join([f"{quoted(name)}:{quoted(path)}" for name, path in files.items()])


DECIMALS = 7
"""Significant digits of measures, beyond which they are rounding noise."""


def number(value: float | None, digits: int = DECIMALS) -> str:
    """A number as JSON, of so many significant digits; not finite is null."""
    if value is None:
        return "null"
    if value is True or value is False:
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    text = f"{value:.{digits}g}"
    return "null" if "n" in text else text


def row_of(line: str | bytes | Mapping[str, Any]) -> str:
    """The row of the table for a line of a manifest, parsed or not. Only files inside the run's folder become links."""
    entry = line if isinstance(line, Mapping) else json.loads(line)
    contours = entry.get("contours") or ()
    measures = glyph_measures(contours)
    file = (entry.get("files") or {}).get(FOLDER)
    row = [
        as_json(str(entry["glyph"])), str(int(entry["gid"])), as_json(" ".join(map(str, entry.get("unicodes") or ()))),
        number(entry.get("advance")), as_json(str(entry["status"])), as_json(file if inside(file) else None),
        as_json(entry.get("error")), str(len(contours)),
    ]  # fmt: skip
    measures |= {name: rounded_up(value, DIGITS) for name in BOUNDS if (value := measures[name]) is not None}
    row += [number(measures[name], DIGITS) for name in COLUMNS[len(row) :]]
    while row[-1] == "null":
        row.pop()
    return f"[{','.join(row)}]"


def inside(path: object) -> bool:
    """Whether a path is inside the run's folder."""
    pure = PurePosixPath(str(path))
    return isinstance(path, str) and not pure.is_absolute() and ".." not in pure.parts and "\\" not in path


def script(data: Any) -> str:
    """A data file: one call."""
    return f"glyphsplineData({as_json(data)});\n"


def as_json(data: Any) -> str:
    """ASCII JSON for a script or a page, without "<", which could end it."""
    return escaped(_encoded(data))


def escaped(text: str) -> str:
    """JSON without "<"."""
    return text.replace("<", "\\u003c")
