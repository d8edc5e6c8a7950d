"""Requests of the page, validated: a glyph, a location in the design space, options, and moved vertices."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, cast, get_args

from ..errors import GlyphsplineError
from ..fitting.options import Corners, Options

Sampling = Literal["tolerance", "step", "count"]

FINEST = {"tolerance": 1 / 20000, "step": 1 / 1000}
"""Smallest tolerance and step, in em: smaller ones cost time and change nothing that shows."""

MOST_VERTICES = 1000
"""Maximum number of vertices of a contour sampled by count."""

MOST_MOVED = 1000
"""Maximum number of moved vertices."""

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


def read_state(given: Any, units_per_em: float) -> State:
    """Validate a parsed request.

    Raises:
        GlyphsplineError: something is missing, of the wrong type, or out of range.
    """
    if not isinstance(given, Mapping) or not isinstance(given.get("glyph"), str):
        raise GlyphsplineError("a request is an object that names its glyph")
    sampling = cast(Sampling, _choice(given, "sampling", get_args(Sampling), "tolerance"))
    amount = _number(given, "amount", units_per_em / 1000)
    if sampling == "count":
        amount = float(min(max(round(amount), 3), MOST_VERTICES))
    else:
        amount = max(amount, FINEST[sampling] * units_per_em)
    options = Options(
        variant=int(_choice(given, "variant", (0, 1, 2, 3, 4), 2)),
        margin=min(max(_number(given, "margin", 0.02), 0.0), 0.25),
        corners=cast(Corners, _choice(given, "corners", get_args(Corners), "smooth")),
        fallback=cast(Literal["knot", "peak"], _choice(given, "fallback", ("knot", "peak"), "peak")),
        measure=given.get("measure") is True,
        tolerance=amount if sampling == "tolerance" else None,
        step=amount if sampling == "step" else None,
        count=int(amount) if sampling == "count" else None,
    )
    return State(given["glyph"], _location(given), options, sampling, amount, _moved(given))


def _number(given: Mapping[str, Any], key: str, default: float) -> float:
    value = given.get(key, default)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise GlyphsplineError(f"{key} is a number, not {value!r}")
    return float(value)


def _choice(given: Mapping[str, Any], key: str, choices: tuple[Any, ...], default: Any) -> Any:
    value = given.get(key, default)
    if isinstance(value, bool) or value not in choices:
        raise GlyphsplineError(f"{key} is one of {', '.join(map(str, choices))}, not {value!r}")
    return value


def _location(given: Mapping[str, Any]) -> tuple[tuple[str, float], ...]:
    location = given.get("location") or {}
    if not isinstance(location, Mapping):
        raise GlyphsplineError("location is an object of axis tags and values")
    return tuple((str(tag), _number(location, tag, 0.0)) for tag in sorted(location))


def _moved(given: Mapping[str, Any]) -> Moved:
    moved = given.get("moved") or []
    if not isinstance(moved, list) or len(moved) > MOST_MOVED:
        raise GlyphsplineError(f"moved is a list of at most {MOST_MOVED} vertices")
    found = []
    for item in moved:
        if not isinstance(item, list) or len(item) != 4 or not all(isinstance(v, int | float) for v in item):
            raise GlyphsplineError("a moved vertex is [contour, vertex, x, y]")
        contour, vertex, x, y = item
        if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(contour) and math.isfinite(vertex)):
            raise GlyphsplineError("a moved vertex is not finite")
        found.append((int(contour), int(vertex), float(x), float(y)))
    return tuple(found)
