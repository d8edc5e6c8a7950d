"""Lengths and numbers of attributes and styles, in user units."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from ....types import INCHES
from .unread import Unread

NUMBER = r"[+-]?(?:[0-9]*\.[0-9]+|[0-9]+)(?:[eE][+-]?[0-9]+)?"
LENGTH = re.compile(rf"\s*({NUMBER})([A-Za-z]*|%)\s*")
FIRST, NEXT = re.compile(rf"({NUMBER})"), re.compile(rf"\s*,?\s*({NUMBER})")
UNITS = {name: inches / INCHES["px"] for name, inches in INCHES.items()} | {"q": 96 / 101.6, "": 1.0}
"""Absolute units, in CSS pixels."""

OF_WINDOW = {"vw", "vh", "vmin", "vmax", "vi", "vb", "ex", "ch", "cap", "ic", "lh", "rlh"}
"""Units of the browser's window, or of a typeface: unknown here."""

X_HEIGHT = 0.5
"""Of the em, where no typeface says it."""

TOKEN = re.compile(rf"\s*({NUMBER}[a-zA-Z%]*|[-+*/()]|[a-zA-Z-]+\()\s*")


@dataclass(frozen=True)
class Lengths:
    """What relative lengths refer to.

    Attributes:
        width, height: of the nearest view. size, root_size: of the font, and of the root's, in user units.
        unread, line: where units are named that cannot be known.
    """

    width: float = 100.0
    height: float = 100.0
    size: float = 16.0
    root_size: float = 16.0
    unread: Unread = field(default_factory=Unread)
    line: int = 0

    @property
    def sides(self) -> dict[str, float]:
        """What 100 % is, along x, along y, and for what has no direction."""
        return {"x": self.width, "y": self.height, "": math.hypot(self.width, self.height) / math.sqrt(2)}

    def of(self, text: str | None, side: str = "") -> float | None:
        """A length in user units; None if it is none. ``side``: what 100 % are, a key of ``sides``."""
        found = LENGTH.fullmatch(text or "")
        if found is None:
            return self._calculated(text or "", side)
        value = self._scaled(float(found[1]), found[2].lower(), side)
        return value if value is not None and math.isfinite(value) else None

    def in_box(self) -> Lengths:
        """The same where 100 % are 1: the units of a bounding box."""
        return replace(self, width=1.0, height=1.0)

    def _scaled(self, value: float, unit: str, side: str) -> float | None:
        if unit in UNITS:
            return value * UNITS[unit]
        if unit in OF_WINDOW:
            self.unread.add(f"lengths in {unit}", self.line)
        share = {
            "%": self.sides[side] / 100, "em": self.size, "rem": self.root_size, "ex": self.size * X_HEIGHT,
            "vw": self.width / 100, "vh": self.height / 100, "ch": self.size * X_HEIGHT,
        }.get(unit)  # fmt: skip
        return None if share is None else value * share

    def _calculated(self, text: str, side: str) -> float | None:
        """The value of ``calc()``; None if it is no such thing, or not one that is read."""
        if not text.strip().lower().startswith("calc("):
            return None
        tokens, at = list[str](), 0
        while at < len(text) and (found := TOKEN.match(text, at)):
            tokens.append(found[1].lower())
            at = found.end()
        try:
            left = iter([*tokens, ""])
            value = self._sum(_Ahead(left), side)
        except (ValueError, ZeroDivisionError, RecursionError):
            return None
        return value if at == len(text) and math.isfinite(value) else None

    def _sum(self, left: _Ahead, side: str) -> float:
        value = self._product(left, side)
        while left.now in ("+", "-"):
            value += (1.0 if left.take() == "+" else -1.0) * self._product(left, side)
        return value

    def _product(self, left: _Ahead, side: str) -> float:
        value = self._factor(left, side)
        while left.now in ("*", "/"):
            value = value * self._factor(left, side) if left.take() == "*" else value / self._factor(left, side)
        return value

    def _factor(self, left: _Ahead, side: str) -> float:
        token = left.take()
        if token in ("(", "calc("):
            value = self._sum(left, side)
            if left.take() != ")":
                raise ValueError
            return value
        found = LENGTH.fullmatch(token)
        value_or_none = None if found is None else self._scaled(float(found[1]), found[2], side)
        if value_or_none is None:
            raise ValueError
        return value_or_none


class _Ahead:
    """Tokens, the next one in view."""

    def __init__(self, tokens: Iterator[str]) -> None:
        self._tokens, self.now = tokens, next(tokens)

    def take(self) -> str:
        token, self.now = self.now, next(self._tokens, "")
        return token


def share(text: str) -> float | None:
    """A number or percentage from 0 to 1, cut there; None if it is neither."""
    found = LENGTH.fullmatch(text)
    if found is None or found[2] not in ("", "%"):
        return None
    return min(max(float(found[1]) / (100 if found[2] else 1), 0.0), 1.0)


def numbers(text: str) -> tuple[list[float], bool]:
    """Numbers between white space and commas, up to the first error; and whether there is none."""
    found, at, text = list[float](), 0, text.strip()
    while at < len(text) and (each := (NEXT if at else FIRST).match(text, at)) and math.isfinite(float(each[1])):
        found.append(float(each[1]))
        at = each.end()
    return found, at == len(text)


def view_box(text: str | None) -> tuple[float, float, float, float] | None:
    """Left, top, width and height; None if there are no four numbers, or of negative sizes."""
    box, whole = numbers(text or "")
    return (box[0], box[1], box[2], box[3]) if whole and len(box) == 4 and min(box[2:]) >= 0 else None
