"""What the gallery's data files say of a glyph: its drawing, and a row of the table that glyphs are sorted by.

Both are text as soon as they are known, so that a worker can write a whole page of drawings from what it has in memory.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from .drawings import Drawing
from .measures import MEASURES, glyph_measures

FOLDER = "gallery"

CHUNK = 40
"""Glyphs on a page, a file of drawings: about half a megabyte of CJK outlines, a tenth of a second to load."""

COLUMNS = ("glyph", "gid", "unicodes", "advance", "status", "contours", *MEASURES)
"""What a row of the table has, in order."""

STATUS = COLUMNS.index("status")

ALWAYS = COLUMNS.index("contours")
"""How many columns are there in any case; the others only if a glyph has something in them."""

Row = list[Any]

_encoded = json.JSONEncoder(ensure_ascii=True, allow_nan=False, separators=(",", ":")).encode


def page_file(number: int) -> str:
    """Where a page is, relative to the run's folder."""
    return f"{FOLDER}/glyphs-{number:05}.js"


def page_text(glyphs: Iterable[str]) -> str:
    """A page of drawings, each as :func:`glyph_text` gives it."""
    return f"glyphsplineData([{','.join(glyphs)}]);\n"


def glyph_text(drawing: Drawing, files: Mapping[str, str], contours: str, error: str | None) -> str:
    """A glyph on its page, as JSON.

    Args:
        drawing: its path data. files: by format, relative to the run's folder. error: what went wrong.
        contours: the measures of its contours as the manifest has them, without the brackets.
    """
    paths = "".join([f'"{name}":"{data}",' for name, data in drawing.items()])
    return f'{{{paths}"files":{as_json(files)},"contours":[{escaped(contours)}],"error":{as_json(error)}}}'


def contours_text(contours: Iterable[Mapping[str, Any]]) -> str:
    """What :func:`glyph_text` wants of the measures that were read from a manifest: the same text again."""
    return ",".join(
        "{" + ",".join(f"{json.dumps(str(name))}:{_value(value)}" for name, value in contour.items()) + "}"
        for contour in contours
    )


def _value(value: Any) -> str:
    return number(value) if value is None or isinstance(value, int | float) else as_json(value)


def number(value: float | None) -> str:
    """A number as JSON: seven significant digits, beyond which measures are rounding noise; not finite is null."""
    if value is None:
        return "null"
    if value is True or value is False:
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    text = f"{value:.7g}"
    return "null" if "n" in text else text


def table_row(
    glyph: str,
    gid: int,
    unicodes: Iterable[object],
    advance: float | None,
    status: str,
    contours: Sequence[Mapping[str, Any]],
) -> Row:
    """A glyph's row of the table; the arguments are what its line of the manifest has."""
    measures = glyph_measures(contours)
    return [glyph, gid, " ".join(map(str, unicodes)), advance, status, *map(measures.get, COLUMNS[ALWAYS:])]


def table_text(rows: Sequence[Row]) -> str:
    """A file of the table: columns, which are a third of the size of rows with names."""
    columns = dict(zip(COLUMNS, zip(*rows, strict=True), strict=True))
    empty = [name for name in COLUMNS[ALWAYS:] if all(value is None for value in columns[name])]
    return script({name: column for name, column in columns.items() if name not in empty})


def script(data: Any) -> str:
    """A data file: one call."""
    return f"glyphsplineData({as_json(data)});\n"


def as_json(data: Any) -> str:
    """JSON that can stand in a script and in a page: ASCII, and no "<" that could end either."""
    return escaped(_encoded(data))


def escaped(text: str) -> str:
    """JSON without "<"."""
    return text.replace("<", "\\u003c")
