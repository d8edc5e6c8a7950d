"""A glyph's line of the manifest and of the journal."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Any

from ..fitting.results import BOUNDS, MEASURES, MeasureColumns
from ..report.data import DECIMALS, plain
from ..types import IntArray, rounded_up


def manifest_entry(
    glyph: str,
    gid: int,
    unicodes: Sequence[int],
    advance: float | None,
    status: str,
    files: Mapping[str, str],
    contours: Sequence[Mapping[str, Any]] | None,
    *,
    deviation: float | None = None,
    notes: Sequence[str] = (),
    error: str | None = None,
) -> dict[str, Any]:
    """One glyph's line, as JSON has it; ``contours`` is None if nothing was fitted."""
    return {
        "glyph": glyph,
        "gid": gid,
        "unicodes": [f"U+{code:04X}" for code in unicodes],
        "advance": plain(advance),
        "status": status,
        "files": files,
        "deviation": plain(deviation),
        "contours": contours,
        "notes": notes,
        "error": error,
    }


def journal_line(sizes: Iterable[int], line: str) -> bytes:
    """The journal's line: the sizes of the glyph's files in the order of its manifest line, a tab, and that line."""
    return f"{','.join(map(str, sizes))}\t{line}\n".encode()


def contour_entries(measures: MeasureColumns, offsets: IntArray) -> list[list[dict[str, Any]]]:
    """The measures of each glyph's contours; what is not known, or not finite, is None.

    Args:
        measures: columns of all contours. offsets: (G + 1,) where the contours of each glyph begin.
    """
    count = int(offsets[-1])
    columns = [_written(measures[name], name in BOUNDS) if name in measures else [None] * count for name in MEASURES]
    entries = [dict(zip(MEASURES, row, strict=True)) for row in zip(*columns, strict=True)]
    return [entries[a:b] for a, b in pairwise(offsets.tolist())]


def _written(column: Sequence[float | None], is_bound: bool) -> list[Any]:
    """The values of a column with the digits that are written; bounds are rounded up."""
    if is_bound:
        column = [value if value is None else rounded_up(value, DECIMALS) for value in column]
    return [plain(value) for value in column]


def columns_of(contours: Sequence[Mapping[str, float | None]]) -> MeasureColumns:
    """The measures of the contours of a parsed line as columns."""
    return {name: [contour.get(name) for contour in contours] for name in MEASURES}
