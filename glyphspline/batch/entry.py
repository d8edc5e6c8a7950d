"""A glyph's line of the manifest."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from json.encoder import encode_basestring_ascii as quoted
from operator import attrgetter

from ..glyph import Measures, Options

NAMES = tuple(field.name for field in fields(Measures))
"""The measures, in the order in which they are written."""

SOLVERS = NAMES.index("fallbacks") + 1
"""How many of them the interpolation itself knows. With ``step`` or ``count`` and no ``measure`` the others are not
computed, whichever way a glyph takes."""

_ALL, _FEW = attrgetter(*NAMES), attrgetter(*NAMES[:SOLVERS])
_TEMPLATE = "{" + ",".join(f'"{name}":%s' for name in NAMES) + "}"
_FEW_TEMPLATE = "{" + ",".join(f'"{name}":' + ("%s" if k < SOLVERS else "null") for k, name in enumerate(NAMES)) + "}"


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
    return ",".join([_FEW_TEMPLATE % tuple(map(number, row)) for row in rows])


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
