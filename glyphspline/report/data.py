"""The gallery's data files: a script with the drawing of each glyph, and tables of measures."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from math import isfinite
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any

import numpy as np

from ..fitting.results import BOUNDS, SOLVED
from ..types import FloatArray, rounded_up
from . import FOLDER

if TYPE_CHECKING:
    from ..outlines.masters import MasterContour

COMBINED: dict[str, Callable[[Sequence[Any]], Any]] = {
    "deviation": max,
    "deviation_bound": max,
    "iterations": max,
    "residual": max,
    "rate_bound": max,
    "vertices": sum,
    "segments": sum,
    "numbers": sum,
    "fallbacks": sum,
    "bending_energy": sum,
    "max_curvature": max,
    "curvature_extrema": sum,
    "source_curvature_extrema": sum,
    "curvature_extrema_floor": sum,
    "overshoot": max,
    "length": sum,
    "area_change": lambda values: max(values, key=abs),
    "new_crossings": sum,
    "converged": all,
    "within_tolerance": all,
    "collapsed": any,
    "corners_kept": any,
    "source_kept": any,
}
"""How the values of contours combine to the glyph's, for each measure: the worst, or the sum. Pages list them so."""

COLUMNS = (
    "glyph", "gid", "unicodes", "advance", "status", "file", "error", "contours",
    *SOLVED, *(name for name in COMBINED if name not in SOLVED),
)  # fmt: skip
"""Columns of the table; nulls at the end of a row are omitted."""

DIGITS, DECIMALS = 5, 7
"""Significant digits of the table's measures. Significant digits of measures, beyond which they are rounding noise."""

FULL = 4.0
"""Curvature in 1/em at which colours end and teeth are full, where a run has no scale of its own."""

PRECISION = 3
"""Decimals of coordinates in masters, which are multiplied by weights of about 1."""

encoded = json.JSONEncoder(ensure_ascii=True, allow_nan=False, separators=(",", ":")).encode
"""Data as ASCII JSON in one line."""


def glyph_text(
    drawing: Mapping[str, str], files: Mapping[str, str], contours: Sequence[Mapping[str, Any]],
    masters: Mapping[str, Any] | None = None,
) -> bytes:  # fmt: skip
    """A glyph's data file.

    Args:
        drawing: path data of ``source``, ``result``, ``polygon`` and ``control``; "" if unknown. ``strokes``, if there
            are open paths, which go there and back.
        files: by format, relative to the run's folder.
        contours: the measures of its contours; what is None is left out.
        masters: of a glyph in all masters, as the page mixes it.
    """
    links = {name: path for name, path in files.items() if name != FOLDER}
    known = [{name: value for name, value in contour.items() if value is not None} for contour in contours]
    data = {**drawing, "files": links, "contours": known, **({"masters": masters} if masters else {})}
    return script(data).encode()


def contours_in(mixes: FloatArray, contours: Sequence[MasterContour]) -> list[list[Any]]:
    """For each contour its degrees, and its coordinates in each of (n, K) mixes of its masters."""
    return [
        [each.degrees.tolist(), np.round(mixes @ each.points.reshape(len(each.points), -1), PRECISION).tolist()]
        for each in contours
    ]


def plain(value: Any, digits: int = DECIMALS) -> Any:
    """A value as JSON has it: rounded to ``digits`` digits, an integer without a fraction; None if not finite."""
    if not isinstance(value, float):
        return value
    near = float(f"{value:.{digits}g}")
    if not isfinite(near):
        return None
    # Below this a float without decimals is written as an integer.
    return int(near) if near.is_integer() and abs(near) < 1e15 else near


def row_of(entry: Mapping[str, Any]) -> str:
    """The row of the table for a line of a manifest, parsed. Only files inside the run's folder become links."""
    contours = entry.get("contours") or ()
    measures = glyph_measures(contours)
    file = (entry.get("files") or {}).get(FOLDER)
    row = [
        str(entry["glyph"]), int(entry["gid"]), " ".join(map(str, entry.get("unicodes") or ())),
        plain(entry.get("advance")), str(entry["status"]), file if inside(file) else None, entry.get("error"),
        len(contours),
    ]  # fmt: skip
    measures |= {name: rounded_up(value, DIGITS) for name in BOUNDS if (value := measures[name]) is not None}
    row += [plain(measures[name], DIGITS) for name in COLUMNS[len(row) :]]
    while row[-1] is None:
        row.pop()
    return as_json(row)


def glyph_measures(contours: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """All of ``MEASURES`` for one glyph, None where no contour has it."""
    found: dict[str, Any] = dict.fromkeys(COMBINED)
    columns = zip(*[map(contour.get, COMBINED) for contour in contours], strict=True)
    for (key, together), column in zip(COMBINED.items(), columns, strict=False):
        values = [value for value in column if value is not None] if None in column else column
        if values:
            found[key] = together(values)
    return found


def inside(path: object) -> bool:
    """Whether a path is inside the run's folder."""
    pure = PurePosixPath(str(path))
    return isinstance(path, str) and not pure.is_absolute() and ".." not in pure.parts and "\\" not in path


def script(data: Any) -> str:
    """A data file: one call."""
    return f"glyphsplineData({as_json(data)});\n"


def as_json(data: Any) -> str:
    """ASCII JSON for a script or a page, without "<", which could end it."""
    return encoded(data).replace("<", "\\u003c")
