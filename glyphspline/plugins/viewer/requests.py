"""Requests of the page, validated: a glyph, a location, options, and moved vertices; and the search for a glyph."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import islice
from typing import Any, Literal, get_args

from ...errors import GlyphsplineError, is_number, require, require_choice
from ...fitting.options import PRESETS, Options
from ...readers import Font
from ...readers.clusters import unified

Sampling = Literal["tolerance", "step", "count"]

FINEST = {"tolerance": 1 / 20000, "step": 1 / 1000}
"""Smallest tolerance and step, in em: smaller ones cost time and change nothing that shows."""

MOST_VERTICES, LONGEST_TEXT = 1000, 500
"""Maximum number of vertices of a contour sampled by count, and of moved ones. Maximum number of characters of the line
of text, as in the page."""

SHOWN = 120
"""Maximum number of glyphs that a search lists."""

Moved = tuple[tuple[int, int, float, float], ...]
"""(contour, vertex, x, y) each, in font units, y up."""


@dataclass(frozen=True)
class PageState:
    """One valid request of the page; ``options`` are those for :func:`glyphspline.fitting.convert`."""

    glyph: str
    location: tuple[tuple[str, float], ...]
    options: Options
    moved: Moved = ()
    text: str = ""


def read_state(given: Any, units_per_em: float) -> PageState:
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
    names = ("variant", "corners", "continuity", "effort")
    chosen: dict[str, Any] = {name: given[name] for name in names if name in given}
    chosen[sampling] = int(amount) if sampling == "count" else amount
    options = Options(**chosen, measure=given.get("measure") is True)
    if options.corners == "smooth" and not options.is_fixed:
        # The page shows variant 2 pass by pass, and moves vertices: the curve has to pass through each of them.
        options = replace(options, **PRESETS["paper"])
    location = given.get("location") or {}
    if not isinstance(location, Mapping):
        raise GlyphsplineError("location is an object of axis tags and values")
    place = tuple((str(tag), _number(location, tag, 0.0)) for tag in sorted(location))
    text = given.get("text") or ""
    if not isinstance(text, str) or len(text) > LONGEST_TEXT:
        raise GlyphsplineError(f"text is a string of at most {LONGEST_TEXT} characters")
    return PageState(given["glyph"], place, options, _moved(given.get("moved") or []), text)


def _number(given: Mapping[str, Any], key: str, default: float) -> float:
    value = given.get(key, default)
    require(is_number(value), f"{key} is a number", value)
    return float(value)


def _moved(moved: Any) -> Moved:
    if not isinstance(moved, list) or len(moved) > MOST_VERTICES:
        raise GlyphsplineError(f"moved is a list of at most {MOST_VERTICES} vertices")
    for item in moved:
        if not isinstance(item, list) or len(item) != 4 or not all(map(is_number, item)):
            raise GlyphsplineError("a moved vertex is [contour, vertex, x, y], finite numbers")
    return tuple((int(contour), int(vertex), float(x), float(y)) for contour, vertex, x, y in moved)


def search(font: Font, words: str) -> dict[str, Any]:
    """The first glyphs that match; without words, the first that have a character."""
    found = list(islice(_matches(font, words.strip()), SHOWN))
    codes = {name: font.unicodes.get(name) for name in found}
    listed = [{"name": name, "text": chr(unified(of_name)) if of_name else ""} for name, of_name in codes.items()]
    return {"glyphs": listed, "more": len(found) == SHOWN}


def _matches(font: Font, words: str) -> Iterator[str]:
    cmap, names = font.cmap, font.glyph_names
    if not words:
        mapped = set(cmap.values())
        yield from (name for name in names if name in mapped or not mapped)
        return
    code = re.fullmatch(r"(?:U\+|0x)([0-9a-f]{1,6})", words, re.IGNORECASE)
    if code and int(code[1], 16) in cmap:
        yield cmap[int(code[1], 16)]
    index = re.fullmatch(r"(?:gid ?)?(\d{1,7})", words, re.IGNORECASE)
    if index and int(index[1]) < len(names):
        yield names[int(index[1])]
    if words in names:
        yield words
    if len(words) == 1 or not words.isascii():  # several letters of ASCII are a name, as in the gallery
        yield from font.select(text="".join(words.split()))
    yield from (name for name in names if words.lower() in name.lower())
