"""A glyph's line of the manifest."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from json.encoder import encode_basestring_ascii as quoted
from math import isfinite
from operator import attrgetter

from ..glyph import Measures, Options
from ..report.data import number

NAMES = tuple(field.name for field in fields(Measures))
"""The measures, in the order in which they are written."""

SOLVERS = NAMES.index("fallbacks") + 1
"""How many of them the interpolation itself knows. With ``step`` or ``count`` and no ``measure`` the others are not
computed, whichever way a glyph takes."""

_ALL, _FEW = attrgetter(*NAMES), attrgetter(*NAMES[:SOLVERS])
_TEMPLATE = "{" + ",".join(f'"{name}":%s' for name in NAMES) + "}"
_NULLS = ",".join(f'"{name}":null' for name in NAMES[SOLVERS:]) + "}"
_QUICK = (
    '{"vertices":%d,"segments":%d,"numbers":%d,"iterations":%d,"residual":%.7g,"converged":%s,"rate_bound":%.7g,'
    '"fallbacks":%d,' + _NULLS
)
"""What :func:`number` makes of numbers that are finite, in one go: of a short glyph this is a good part of the time."""


def manifest_line(
    glyph: str,
    gid: int,
    unicodes: Sequence[int],
    advance: float | None,
    status: str,
    files: Mapping[str, str],
    contours: str,
    error: str | None = None,
) -> str:
    """One glyph's line, without the line end; ``contours`` is what :func:`contours_text` gave."""
    codes = ",".join([f'"U+{code:04X}"' for code in unicodes])
    paths = ",".join([f'"{name}":{quoted(path)}' for name, path in files.items()])
    said = "null" if error is None else quoted(error)
    return (
        f'{{"glyph":{quoted(glyph)},"gid":{gid},"unicodes":[{codes}],"advance":{number(advance)},'
        f'"status":"{status}","files":{{{paths}}},"contours":[{contours}],"error":{said}}}'
    )


def contours_text(measures: Iterable[Measures], options: Options) -> str:
    """The measures of a glyph's contours as JSON objects between commas."""
    if options.measure or (options.step is None and options.count is None):
        return ",".join([_TEMPLATE % tuple(map(number, _ALL(item))) for item in measures])
    return solved_text(map(_FEW, measures))


def solved_text(rows: Iterable[Sequence[float]]) -> str:
    """The same of what the interpolation itself knows: the first ``SOLVERS`` measures of each contour."""
    return ",".join(map(_solved, rows))


def _solved(row: Sequence[float]) -> str:
    *counts, residual, converged, rate, fallbacks = row
    if isfinite(residual) and isfinite(rate):
        return _QUICK % (*counts, residual, "true" if converged else "false", rate, fallbacks)
    return _TEMPLATE % (*map(number, row), *["null"] * (len(NAMES) - SOLVERS))
