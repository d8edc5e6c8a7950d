"""Paint: colours, how much of them shows, and what stands for a paint server."""

from __future__ import annotations

import colorsys
import math
import re
from collections.abc import Iterator
from functools import cache
from typing import Any, NamedTuple

from .lengths import LENGTH, share
from .unread import Unread

LEAST = 1 / 512
"""Opacity below which nothing shows on a screen of 256 levels."""

URL = re.compile(r"""url\(\s*(?:"([^"]*)"|'([^']*)'|([^)"']*?))\s*\)\s*(.*)""", re.IGNORECASE | re.DOTALL)
CALL = re.compile(r"([a-z-]+)\((.*)\)", re.DOTALL)
WORD_PAINTS = {"none", "currentcolor", "context-fill", "context-stroke"}
SYSTEM = {
    "accentcolor", "accentcolortext", "activetext", "buttonborder", "buttonface", "buttontext", "canvas", "canvastext",
    "field", "fieldtext", "graytext", "highlight", "highlighttext", "linktext", "mark", "marktext", "visitedtext",
}  # fmt: skip
"""Colours of the system, whose values are not known."""


class Colour(NamedTuple):
    """Red, green and blue from 0 to 1, nan if they are not known, and opacity."""

    red: float
    green: float
    blue: float
    alpha: float = 1.0

    @property
    def luminance(self) -> float:
        """As in masks, from 0 to 1, without the opacity."""
        return 0.2125 * self.red + 0.7154 * self.green + 0.0721 * self.blue


BLACK = Colour(0.0, 0.0, 0.0)


@cache
def colour(text: str) -> Colour | None:
    """A colour by its CSS text; None if it is none. Those of wide gamuts have no known components."""
    text = text.strip().lower()
    if text == "transparent":
        return Colour(0.0, 0.0, 0.0, 0.0)
    if text.startswith("#"):
        return _of_digits(text[1:])
    if call := CALL.fullmatch(text):
        return _of_function(call[1], call[2])
    if text in ("black", "white"):
        return BLACK if text == "black" else Colour(1.0, 1.0, 1.0)
    if text in SYSTEM:
        return Colour(math.nan, math.nan, math.nan)
    if not text.isalpha():
        return None
    from matplotlib.colors import CSS4_COLORS  # most drawings name no other colour

    return _of_digits(str(CSS4_COLORS[text])[1:]) if text in CSS4_COLORS else None


def _of_digits(digits: str) -> Colour | None:
    if not re.fullmatch(r"[0-9a-fA-F]+", digits) or len(digits) not in (3, 4, 6, 8):
        return None
    size = 1 if len(digits) < 5 else 2
    return Colour(*(int(digits[k : k + size] * (3 - size), 16) / 255 for k in range(0, len(digits), size)))


def _of_function(name: str, inside: str) -> Colour | None:
    """A colour by a function: ``rgb``, ``hsl``; of others the opacity alone is known."""
    if name in ("hwb", "lab", "lch", "oklab", "oklch", "color", "color-mix", "light-dark"):
        alpha = share(inside.rpartition("/")[2].strip()) if "/" in inside else 1.0
        return Colour(math.nan, math.nan, math.nan, 1.0 if alpha is None else alpha)
    parts = re.sub(r"[,/]", " ", inside).split()
    if name not in ("rgb", "rgba", "hsl", "hsla") or len(parts) not in (3, 4):
        return None
    alpha = share(parts[3]) if len(parts) == 4 and parts[3] != "none" else 1.0
    found = [LENGTH.fullmatch("0" if part == "none" else part) for part in parts[:3]]
    if alpha is None or not all(found):
        return None
    values = [(float(each[1]), each[2].lower()) for each in found if each]
    if name.startswith("rgb"):
        if any(unit not in ("", "%") for _, unit in values):
            return None
        red, green, blue = (min(max(value / (100 if unit else 255), 0.0), 1.0) for value, unit in values)
        return Colour(red, green, blue, alpha)
    (hue, unit), (saturation, _), (lightness, _) = values
    turns = hue / {"": 360, "deg": 360, "grad": 400, "rad": 2 * math.pi, "turn": 1}.get(unit, math.nan)
    if math.isnan(turns):
        return None
    saturation, lightness = (min(max(value / 100, 0.0), 1.0) for value in (saturation, lightness))
    return Colour(*colorsys.hls_to_rgb(turns % 1.0, lightness, saturation), alpha)


def is_colour(text: str) -> bool:
    """Whether CSS text is a colour."""
    return text.lower() == "currentcolor" or colour(text) is not None


def is_paint(text: str) -> bool:
    """Whether CSS text is a paint."""
    if found := URL.fullmatch(text):
        return not found[4] or found[4].lower() == "none" or is_colour(found[4])
    return text.lower() in WORD_PAINTS or is_colour(text)


def reference(text: str) -> str | None:
    """What ``url()`` refers to; None if the text is no such thing."""
    found = URL.fullmatch(text.strip())
    return None if found is None else found[1] or found[2] or found[3] or ""


class Painter:
    """Paint as it shows: its colour, with all opacities.

    Args:
        structure: a :class:`.structure.Structure`, which knows gradients and styles. unread: what is not read.
    """

    def __init__(self, structure: Any, unread: Unread) -> None:
        self._structure, self._unread = structure, unread

    def paint(self, text: str, style: Any, opacity: float, line: int) -> Colour | None:
        """What a paint shows as; None: nothing of it shows. What shows in part is named."""
        found = self._resolved(text, style, line)
        if found is None or found.alpha * opacity < LEAST:
            return None
        return found._replace(alpha=found.alpha * opacity)

    def _resolved(self, text: str, style: Any, line: int) -> Colour | None:
        lower = text.lower()
        if lower == "none":
            return None
        if lower == "currentcolor":
            own = style["color"]
            return colour("black" if own.lower() == "currentcolor" else own)
        if lower.startswith("context-"):
            return BLACK if lower == "context-fill" else None
        place = URL.fullmatch(text)
        if place is None:
            return colour(text)
        server = self._structure.resource(reference(text))
        tag = None if server is None else server.tag
        if tag in ("linearGradient", "radialGradient"):
            return self._gradient(server, line)
        if tag == "pattern":
            if not any(len(each) for each in self._chain(server)):
                return None
            self._unread.add("patterns, drawn as ink", line)
            return Colour(math.nan, math.nan, math.nan)
        return self._resolved(place[4], style, line) if place[4] else None

    def _chain(self, server: Any) -> Iterator[Any]:
        """A paint server and those that it refers to."""
        seen = set()
        while server is not None and server not in seen:
            seen.add(server)
            yield server
            server = self._structure.resource(server.get("href"))

    def _gradient(self, server: Any, line: int) -> Colour | None:
        """A gradient as one colour: of its stops, if they are alike, else one that is not known."""
        stops: list[Any] = next((found for each in self._chain(server) if (found := each.findall("stop"))), [])
        colours = []
        for stop in stops:
            style = self._structure.style_of(stop)
            found = self._resolved(style["stop-color"], style, line)
            if found is not None:
                colours.append(found._replace(alpha=found.alpha * (share(style["stop-opacity"]) or 0.0)))
        if not colours or max(each.alpha for each in colours) < LEAST:
            return None
        if min(each.alpha for each in colours) < 1:
            self._unread.add("gradients that fade out, drawn as ink", line)
        alike = len({each[:3] for each in colours}) == 1
        return colours[0]._replace(alpha=1.0) if alike else Colour(math.nan, math.nan, math.nan)
