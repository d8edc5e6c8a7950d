"""What is said of a glyph: its line of the manifest, and shorter its row of the gallery's table and what is counted.

There are two ways to say the same. Of any glyph, row and counts are made of what its line has. Of one that came the
short way the numbers are at hand, and only those that the interpolation itself knows.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from functools import cache
from itertools import chain
from json.encoder import encode_basestring_ascii as quoted
from math import isfinite
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from ..fitting.options import Options
from ..fitting.results import SOLVED, Measures
from ..report.data import DIGITS, escaped, number
from ..report.gallery import row_of
from .summary import Facts, facts_of

if TYPE_CHECKING:
    from .lane import Solved

NAMES = tuple(field.name for field in fields(Measures))
"""The measures, in the order in which they are written: those of ``SOLVED`` are the first.

With ``step`` or ``count`` and no ``measure`` the others are not computed, whichever way a glyph takes."""

_ALL, _FEW = attrgetter(*NAMES), attrgetter(*SOLVED)
_TEMPLATE = "{" + ",".join(f'"{name}":%s' for name in NAMES) + "}"
_NULLS = ",".join(f'"{name}":null' for name in NAMES[len(SOLVED) :]) + "}"
_UNKNOWN = (None,) * (len(NAMES) - len(SOLVED))
_KINDS = (int, int, int, int, float, bool, float, int, *map(type, _UNKNOWN))
"""Of a contour of which only ``SOLVED`` is known."""

Told = tuple[str, Facts]
"""Of a glyph, its row of the gallery's table, and the facts that are counted."""


def manifest_line(
    glyph: str,
    gid: int,
    unicodes: Sequence[int],
    advance: float | None,
    status: str,
    files: str,
    contours: str,
    error: str | None = None,
) -> str:
    """One glyph's line, without the line end; ``files`` and ``contours`` are JSON without the brackets."""
    codes = ",".join([f'"U+{code:04X}"' for code in unicodes])
    said = "null" if error is None else quoted(error)
    return (
        f'{{"glyph":{quoted(glyph)},"gid":{gid},"unicodes":[{codes}],"advance":{number(advance)},'
        f'"status":"{status}","files":{{{files}}},"contours":[{contours}],"error":{said}}}'
    )


def journal_line(sizes: Iterable[int], line: str) -> bytes:
    """The line of the journal: the sizes of the glyph's files, in the order of the manifest's line, and that line."""
    return f"{','.join(map(str, sizes))}\t{line}\n".encode()


def measured(measures: Iterable[Measures], options: Options) -> str:
    """The measures of a glyph's contours as JSON objects between commas."""
    everything = options.measure or (options.step is None and options.count is None)
    return ",".join([_text_of(_ALL(item) if everything else (*_FEW(item), *_UNKNOWN)) for item in measures])


def _text_of(row: tuple[Any, ...]) -> str:
    """What :func:`number` makes of all measures, in one go if they are finite: this is a good part of the time."""
    quick = _template(tuple(map(type, row)))
    if quick is None or not isfinite(sum([value for value in row if type(value) is float])):
        return _TEMPLATE % tuple(map(number, row))
    values = [("true" if value else "false") if type(value) is bool else value for value in row if value is not None]
    return quick % tuple(values)


@cache
def _template(kinds: tuple[type, ...]) -> str | None:
    """The template with a form for each kind of number, and nulls; None if there is another kind among them."""
    forms = {int: "%d", float: "%.7g", bool: "%s", type(None): "null"}
    return _TEMPLATE % tuple(forms[kind] for kind in kinds) if forms.keys() >= set(kinds) else None


def solved_texts(columns: Sequence[Sequence[Any]]) -> list[str]:
    """The same of what the interpolation itself knows, a text a contour; ``columns`` are the measures of ``SOLVED``."""
    *counts, residuals, converged, rates, fallbacks = columns
    quick = _template(_KINDS)
    if quick is None or not isfinite(sum(residuals) + sum(rates)):
        return [_text_of((*row, *_UNKNOWN)) for row in zip(*columns, strict=True)]
    words = ["true" if good else "false" for good in converged]
    values = chain.from_iterable(zip(*counts, residuals, words, rates, fallbacks, strict=True))
    return ((quick + "\n") * len(words) % tuple(values)).splitlines()


def told_of(entry: Mapping[str, Any]) -> Told:
    """What else is told of a glyph, made of its line of the manifest, parsed."""
    return row_of(entry), facts_of(entry["contours"])


def told_of_solved(
    glyph: str, gid: int, unicodes: Sequence[int], advance: float, solved: Solved, first: int, last: int
) -> Told | None:
    """The same of a glyph whose contours are those from ``first`` to ``last``; None if its numbers are not finite."""
    residuals, rates = solved.residual[first:last], solved.rate_bound[first:last]
    if not isfinite(sum(residuals) + sum(rates)):
        return None
    good = all(solved.converged[first:last])
    codes = " ".join([f"U+{code:04X}" for code in unicodes])
    row = (
        f'[{escaped(quoted(glyph))},{gid},"{codes}",{number(advance)},"ok",{last - first},'
        f"{sum(solved.vertices[first:last])},{sum(solved.segments[first:last])},{sum(solved.numbers[first:last])},"
        f"{max(solved.iterations[first:last])},{_short(max(residuals))},{'true' if good else 'false'},"
        f"{_short(max(rates))},{sum(solved.fallbacks[first:last])}]"
    )
    return row, (not good, False, None)


def known(contours: str) -> str:
    """What :func:`solved_texts` gave, without the measures that are not known."""
    return contours.replace("," + _NULLS, "}")


def _short(value: float) -> str:
    """A number as it is in the table, which has it from the manifest."""
    return f"{float(f'{value:.7g}'):.{DIGITS}g}"
