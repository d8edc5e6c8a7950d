"""A glyph's line of the manifest and of the journal, as JSON text."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain, pairwise
from json.encoder import encode_basestring_ascii as quoted

import numpy as np

from ..fitting.results import BOUNDS, MEASURES, MeasureColumns
from ..report.data import DECIMALS, number
from ..types import IntArray, rounded_up


def manifest_line(
    glyph: str,
    gid: int,
    unicodes: Sequence[int],
    advance: float | None,
    status: str,
    files: str,
    contours: str | None,
    *,
    deviation: float | None = None,
    notes: Sequence[str] = (),
    error: str | None = None,
) -> str:
    """One glyph's line, without the line end; ``files`` and ``contours`` are JSON without the brackets.

    ``contours`` is None if nothing was fitted.
    """
    said = ",".join(map(quoted, notes))
    codes = ",".join([f'"U+{code:04X}"' for code in unicodes])
    failed = "null" if error is None else quoted(error)
    measures = "null" if contours is None else f"[{contours}]"
    return (
        f'{{"glyph":{quoted(glyph)},"gid":{gid},"unicodes":[{codes}],"advance":{number(advance)},'
        f'"status":"{status}","files":{{{files}}},"deviation":{number(deviation)},"contours":{measures},'
        f'"notes":[{said}],"error":{failed}}}'
    )


def journal_line(sizes: Iterable[int], line: str) -> bytes:
    """The journal's line: the sizes of the glyph's files in the order of its manifest line, a tab, and that line."""
    return f"{','.join(map(str, sizes))}\t{line}\n".encode()


def contour_texts(measures: MeasureColumns, offsets: IntArray) -> list[str]:
    """The measures of each glyph's contours as JSON objects between commas.

    Args:
        measures: columns of all contours. offsets: (G + 1,) where the contours of each glyph begin.
    """
    template, columns = [], []
    for name in MEASURES:
        form = "null"
        if name in measures:
            form, column = _written(measures[name], name in BOUNDS)
            columns.append(column)
        template.append(f'"{name}":{form}')
    text = (
        ("{" + ",".join(template) + "}\n") * int(offsets[-1]) % tuple(chain.from_iterable(zip(*columns, strict=True)))
    )
    lines = text.splitlines()
    return [",".join(lines[a:b]) for a, b in pairwise(offsets.tolist())]


def _written(column: Sequence[float | None], is_bound: bool) -> tuple[str, Sequence[object]]:
    """A format for ``%`` and its arguments, which write the values of a column as :func:`number` does; bounds up."""
    if is_bound:
        column = [value if value is None else rounded_up(value, DECIMALS) for value in column]
    values = np.array(column)
    if values.dtype.kind == "i":
        return "%d", column
    if values.dtype.kind == "f" and np.isfinite(values).all():
        return "%.7g", column
    return "%s", [number(value) for value in column]


def columns_of(contours: Sequence[Mapping[str, float | None]]) -> MeasureColumns:
    """The measures of the contours of a parsed line as columns."""
    return {name: [contour.get(name) for contour in contours] for name in MEASURES}
