"""Basic shapes as paths, by the rules of SVG 2."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

from .lengths import Lengths, numbers
from .path_data import DrawnPath, Path, parsed_path

Get = Callable[[str], str | None]
"""The value of an attribute, or of the property of its name."""

SIDES = {"x": "x", "y": "y", "width": "x", "height": "y", "cx": "x", "cy": "y", "rx": "x", "ry": "y", "r": ""}
SIDES |= {"x1": "x", "x2": "x", "y1": "y", "y2": "y"}
"""What 100 % of each attribute are."""


def shape_of(tag: str, get: Get, lengths: Lengths) -> Path:
    """The path of a shape, in its own units; without one, or without a size, it is empty."""
    return SHAPES[tag](get, lengths)


def length(name: str, get: Get, lengths: Lengths) -> float | None:
    """An attribute as a length; None if it has none, or one that is no length."""
    return lengths.of(get(name), SIDES[name])


def _size(name: str, get: Get, lengths: Lengths) -> float | None:
    """A length that cannot be negative; None is ``auto``."""
    found = length(name, get, lengths)
    return found if found is not None and found >= 0 else None


def _path(get: Get, lengths: Lengths) -> Path:
    data = get("d") or ""
    if data.strip() == "none":
        return []
    if found := re.fullmatch(r"""\s*path\(\s*(["'])(.*)\1\s*\)\s*""", data, re.DOTALL):
        data = found[2]
    path, error = parsed_path(data)
    if error is not None:
        beginning = data[max(0, error - 8) : error + 8].strip()
        lengths.unread.add(f"path data after an error at character {error + 1}, near {beginning!r}", lengths.line)
    return path


def _rect(get: Get, lengths: Lengths) -> Path:
    x, y = (length(name, get, lengths) or 0.0 for name in "xy")
    width, height = (_size(name, get, lengths) or 0.0 for name in ("width", "height"))
    if not (width and height):
        return []
    rx, ry = (_size(name, get, lengths) for name in ("rx", "ry"))
    rx, ry = (ry if rx is None else rx) or 0.0, (rx if ry is None else ry) or 0.0
    rx, ry = min(rx, width / 2), min(ry, height / 2)
    drawn, (right, bottom) = DrawnPath(), (x + width, y + height)
    if not (rx and ry):
        corners = [(x, y), (right, y), (right, bottom), (x, bottom)]
        return _closed(drawn, corners)
    drawn.move((x + rx, y))
    for along, around in (
        ((right - rx, y), (right, y + ry)),
        ((right, bottom - ry), (right - rx, bottom)),
        ((x + rx, bottom), (x, bottom - ry)),
        ((x, y + ry), (x + rx, y)),
    ):
        if along != drawn.here:
            drawn.add(along)
        drawn.arc(rx, ry, 0.0, False, True, around)
    drawn.close()
    return drawn.path


def _circle(get: Get, lengths: Lengths) -> Path:
    r = _size("r", get, lengths) or 0.0
    return _oval(get, lengths, r, r)


def _ellipse(get: Get, lengths: Lengths) -> Path:
    rx, ry = (_size(name, get, lengths) for name in ("rx", "ry"))
    return _oval(get, lengths, (ry if rx is None else rx) or 0.0, (rx if ry is None else ry) or 0.0)


def _oval(get: Get, lengths: Lengths, rx: float, ry: float) -> Path:
    if not (rx and ry):
        return []
    cx, cy = (length(name, get, lengths) or 0.0 for name in ("cx", "cy"))
    drawn = DrawnPath()
    drawn.move((cx + rx, cy))
    for to in ((cx, cy + ry), (cx - rx, cy), (cx, cy - ry), (cx + rx, cy)):
        drawn.arc(rx, ry, 0.0, False, True, to)
    drawn.close()
    return drawn.path


def _line(get: Get, lengths: Lengths) -> Path:
    drawn = DrawnPath()
    x1, y1, x2, y2 = (length(name, get, lengths) or 0.0 for name in ("x1", "y1", "x2", "y2"))
    drawn.move((x1, y1))
    drawn.add((x2, y2))
    return drawn.path


def _polyline(get: Get, lengths: Lengths) -> Path:
    found, whole = numbers(get("points") or "")
    if not whole:
        lengths.unread.add("points after an error", lengths.line)
    elif len(found) % 2:
        lengths.unread.note("an odd count of coordinates: the last is left out", lengths.line)
    points = list(zip(found[::2], found[1::2], strict=False))
    if not points:
        return []
    drawn = DrawnPath()
    drawn.move(points[0])
    for to in points[1:]:
        drawn.add(to)
    return drawn.path


def _polygon(get: Get, lengths: Lengths) -> Path:
    path = _polyline(get, lengths)
    for subpath in path:
        subpath.closed = True
    return path


def _closed(drawn: DrawnPath, points: list[tuple[float, float]]) -> Path:
    drawn.move(points[0])
    for to in points[1:]:
        drawn.add(to)
    drawn.close()
    return drawn.path


SHAPES: Mapping[str, Any] = {
    "path": _path, "rect": _rect, "circle": _circle, "ellipse": _ellipse, "line": _line, "polyline": _polyline,
    "polygon": _polygon,
}  # fmt: skip
"""By tag, what makes its path."""
