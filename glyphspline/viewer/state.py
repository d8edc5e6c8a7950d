"""Requests of the page, validated: a glyph, a location in the design space, options, and moved vertices."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, get_args

from ..errors import GlyphsplineError, is_number, require, require_choice
from ..fitting.options import Options

Sampling = Literal["tolerance", "step", "count"]

FINEST = {"tolerance": 1 / 20000, "step": 1 / 1000}
"""Smallest tolerance and step, in em: smaller ones cost time and change nothing that shows."""

MOST_VERTICES = 1000
"""Maximum number of vertices of a contour sampled by count."""

MOST_MOVED = 1000
"""Maximum number of moved vertices."""

LONGEST_TEXT = 500
"""Maximum number of characters of the line of text."""

Moved = tuple[tuple[int, int, float, float], ...]
"""(contour, vertex, x, y) each, in font units, y up."""


@dataclass(frozen=True)
class State:
    """One valid request of the page; ``options`` are those for :func:`glyphspline.fitting.convert`."""

    glyph: str
    location: tuple[tuple[str, float], ...]
    options: Options
    sampling: Sampling
    amount: float
    moved: Moved = ()
    text: str = ""


def read_state(given: Any, units_per_em: float) -> State:
    """Validate a parsed request.

    Raises:
        GlyphsplineError: something is missing, of the wrong type, or out of range.
    """
    if not isinstance(given, Mapping) or not isinstance(given.get("glyph"), str):
        raise GlyphsplineError("a request is an object that names its glyph")
    sampling = given.get("sampling", "tolerance")
    require_choice("sampling", sampling, get_args(Sampling))
    amount = _number(given, "amount", units_per_em / 1000)
    if sampling == "count":
        amount = float(min(max(round(amount), 3), MOST_VERTICES))
    else:
        amount = float(f"{max(amount, FINEST[sampling] * units_per_em):.6g}")  # as the command has it
    names = ("variant", "corners", "continuity", "effort", "fallback")
    chosen: dict[str, Any] = {name: given[name] for name in names if name in given}
    chosen[sampling] = int(amount) if sampling == "count" else amount
    options = Options(
        **chosen,
        margin=min(max(_number(given, "margin", Options.margin), 0.0), 0.25),
        measure=given.get("measure") is True,
    )
    return State(given["glyph"], _location(given), options, sampling, amount, _moved(given), _text(given))


def _number(given: Mapping[str, Any], key: str, default: float) -> float:
    value = given.get(key, default)
    require(is_number(value), f"{key} is a number", value)
    return float(value)


def _location(given: Mapping[str, Any]) -> tuple[tuple[str, float], ...]:
    location = given.get("location") or {}
    if not isinstance(location, Mapping):
        raise GlyphsplineError("location is an object of axis tags and values")
    return tuple((str(tag), _number(location, tag, 0.0)) for tag in sorted(location))


def _text(given: Mapping[str, Any]) -> str:
    text = given.get("text") or ""
    if not isinstance(text, str) or len(text) > LONGEST_TEXT:
        raise GlyphsplineError(f"text is a string of at most {LONGEST_TEXT} characters")
    return text


def _moved(given: Mapping[str, Any]) -> Moved:
    moved = given.get("moved") or []
    if not isinstance(moved, list) or len(moved) > MOST_MOVED:
        raise GlyphsplineError(f"moved is a list of at most {MOST_MOVED} vertices")
    found = []
    for item in moved:
        if not isinstance(item, list) or len(item) != 4 or not all(map(is_number, item)):
            raise GlyphsplineError("a moved vertex is [contour, vertex, x, y], finite numbers")
        contour, vertex, x, y = item
        found.append((int(contour), int(vertex), float(x), float(y)))
    return tuple(found)
