"""The cascade: what each element's properties are, from attributes, style sheets, styles, and the element around it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeAlias

from .document import Document
from .lengths import LENGTH, NUMBER, Lengths, share
from .paint import is_colour, is_paint
from .sheets import StyleRules, declarations
from .unread import Unread

Style: TypeAlias = Mapping[str, str]
"""Property to value. A property that is not inherited and has no initial value here is in it where it is set."""

INHERITED = {
    "clip-rule": "nonzero", "color": "black", "cursor": "auto", "fill": "black", "fill-opacity": "1",
    "fill-rule": "nonzero", "font-size": "16px", "marker-end": "none", "marker-mid": "none", "marker-start": "none",
    "paint-order": "normal", "stroke": "none", "stroke-dasharray": "none", "stroke-dashoffset": "0",
    "stroke-linecap": "butt", "stroke-linejoin": "miter", "stroke-miterlimit": "4", "stroke-opacity": "1",
    "stroke-width": "1", "visibility": "visible",
}  # fmt: skip
"""Inherited properties and their initial values."""

OWN = {
    "clip-path": "none", "display": "inline", "filter": "none", "mask": "none", "mask-type": "luminance",
    "mix-blend-mode": "normal", "opacity": "1", "overflow": "", "stop-color": "black", "stop-opacity": "1",
    "transform-box": "view-box", "transform-origin": "", "vector-effect": "none",
}  # fmt: skip
"""Properties that are not inherited and that attributes set too."""

FONT_SIZES = {
    "xx-small": 9, "x-small": 10, "small": 13, "medium": 16, "large": 18, "x-large": 24, "xx-large": 32,
}  # fmt: skip

SHORT = {"marker": ("marker-start", "marker-mid", "marker-end")}
"""Properties that stand for several."""

MOVING = {"translate", "rotate", "scale", "offset-path", "animation", "animation-name", "zoom", "perspective"}
"""Properties that place elements, which are named where they are set."""

WIDE = {"inherit", "initial", "unset", "revert", "revert-layer"}
"""Values that any property has."""


def _one_of(*words: str) -> Callable[[str], bool]:
    return lambda value: value.lower() in words


def _is_size(value: str) -> bool:
    found = LENGTH.fullmatch(value)
    return (found is not None and float(found[1]) >= 0) or value.lower().startswith("calc(")


def _is_css_length(value: str) -> bool:
    """Whether a value is a length as style sheets write it: with a unit, unlike in attributes."""
    found = LENGTH.fullmatch(value)
    return (found is not None and (found[2] != "" or float(found[1]) == 0)) or value.lower().startswith("calc(")


def _is_reference(value: str) -> bool:
    return value.lower() == "none" or re.match(r"[a-z-]+\(", value, re.IGNORECASE) is not None


def _is_share(value: str) -> bool:
    return share(value) is not None


RULES = _one_of("nonzero", "evenodd")
VALID: Mapping[str, Callable[[str], bool]] = {
    "fill": is_paint, "stroke": is_paint, "color": is_colour, "stop-color": is_colour,
    "fill-rule": RULES, "clip-rule": RULES, "visibility": _one_of("visible", "hidden", "collapse"),
    **dict.fromkeys(("opacity", "fill-opacity", "stroke-opacity", "stop-opacity"), _is_share),
    "display": _one_of(
        "none", "inline", "block", "contents", "flex", "grid", "inline-block", "inline-flex", "list-item", "table",
        "inline-table", "run-in", "compact", "marker", "table-row-group", "table-header-group", "table-footer-group",
        "table-row", "table-column-group", "table-column", "table-cell", "table-caption", "flow-root", "inline-grid",
    ),
    "stroke-width": _is_size, "stroke-linecap": _one_of("butt", "round", "square"),
    "stroke-linejoin": _one_of("miter", "round", "bevel", "miter-clip", "arcs"),
    "stroke-miterlimit": lambda value: re.fullmatch(rf"{NUMBER}", value) is not None and float(value) >= 0,
    "overflow": _one_of("visible", "hidden", "scroll", "auto", "clip"),
    "clip-path": _is_reference, "mask": _is_reference, "filter": _is_reference,
    **dict.fromkeys(("x", "y", "cx", "cy"), _is_css_length),
    **dict.fromkeys(("width", "height", "r", "rx", "ry"), lambda value: _is_css_length(value) and _is_size(value)),
    "d": lambda value: value.lower() == "none" or value.lower().startswith("path("),
}  # fmt: skip
"""Whether a property can have a value: a declaration with another one does not count."""


class Cascade:
    """The styles of a drawing's elements."""

    def __init__(self, document: Document, unread: Unread) -> None:
        self._rules, self._unread = StyleRules(document, unread), unread
        self._lines = document.lines
        self.root_size = 16.0

    def of(self, element: Any, around: Style | None) -> Style:
        """The style of an element within one of another style."""
        line = self._lines.get(element, 0)
        before: Style = around or INHERITED
        style = {name: value for name, value in before.items() if name in INHERITED or name.startswith("--")} | OWN
        declared = [*_attributes(element), *self._declared(element)]
        for name, value in declared:
            if name.startswith("--"):
                style[name] = value
        for name, written in declared:
            value = substituted(written, style) or ""
            if name.startswith("--") or not value:
                continue
            if name in MOVING and value.lower() not in WIDE | {"none", "1", "normal", "0"}:
                self._unread.add(f"the style {name}: {value}", line)
            elif value.lower() in WIDE:
                _take_wide(style, before, name, value.lower())
            elif VALID.get(name, bool)(value):
                for each in SHORT.get(name, (name,)):
                    style[each] = value
        style["font-size"] = f"{self._font_size(style['font-size'], before['font-size'])!r}px"
        if around is None:
            self.root_size = font_size(style)
        return style

    def _declared(self, element: Any) -> Iterator[tuple[str, str]]:
        """Declarations of rules and of the style attribute, later ones before earlier ones; important ones last."""
        found = [*self._rules.of(element)]
        own = [*declarations(element.get("style") or "", self._unread, self._lines.get(element, 0))]
        for important in (False, True):
            for each in (found, own):
                yield from ((name, value) for name, value, is_so in each if is_so == important)

    def _font_size(self, value: str, around: str) -> float:
        size = float(around[:-2])
        value = value.lower()
        if value in ("larger", "smaller"):
            return size * (1.2 if value == "larger" else 1 / 1.2)
        known = FONT_SIZES.get(value)
        found = Lengths(size, size, size, self.root_size).of(value, "x") if known is None else float(known)
        return size if found is None or found < 0 else found


def font_size(style: Style) -> float:
    """The size of the font, in user units."""
    return float(style["font-size"][:-2])


def _attributes(element: Any) -> Iterator[tuple[str, str]]:
    """The attributes that are properties."""
    for name, value in element.attrib.items():
        if name in INHERITED or name in OWN:
            yield name, value.strip()


def _take_wide(style: dict[str, str], before: Style, name: str, value: str) -> None:
    """Give a property the value of the element around, or its initial one."""
    initial = INHERITED.get(name, OWN.get(name))
    if value == "inherit" or (value != "initial" and name in INHERITED):
        initial = before.get(name, initial)
    if initial is None:
        style.pop(name, None)
        if name == "transform":
            style[name] = "none"
    else:
        style[name] = initial


def substituted(value: str, style: Style, depth: int = 8) -> str | None:
    """A value with custom properties in place; None if one is not there."""
    call = re.search(r"var\(\s*(--[^\s,()]+)\s*(?:,((?:[^()]|\([^()]*\))*))?\)", value)
    if call is None:
        return value.strip() if "var(" not in value else None
    found = style.get(call[1], call[2])
    if found is None or depth == 0:
        return None
    return substituted(value[: call.start()] + found.strip() + value[call.end() :], style, depth - 1)
