"""The text of a Glyphs file, versions 2 and 3, of which only the nodes of paths change."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from ...errors import FontError
from ..fonts.back.nodes import Node, Position

TOKEN = re.compile(r'\s*(?:([{}()=;,])|("(?:[^"\\]|\\.)*")|(<[^>]*>)|([^\s{}()=;,"]+))', re.DOTALL)

LETTERS = {"l": "line", "c": "curve", "q": "qcurve", "o": None}
WORDS = {"LINE": "line", "CURVE": "curve", "QCURVE": "qcurve", "OFFCURVE": None}
"""Kinds of nodes in version 3 and in version 2, and UFO's names of them."""


@dataclass(frozen=True)
class Value:
    """A value of a property list: text, a list or a dictionary, and where it stands in the file."""

    of: Any
    start: int
    stop: int

    def __getitem__(self, key: str | int) -> Value:
        return self.of[key]

    def get(self, key: str) -> Any:
        """The text or list of a key; None if there is none."""
        return self.of[key].of if key in self.of else None


@dataclass(frozen=True)
class Layer:
    """A layer of a glyph.

    Attributes:
        master: the id of the master it belongs to. place: coordinates between masters, as "{100, 0}"; "" for a
            master's own layer, None for any other.
        name: of the layer. paths: lists of nodes with their places in the file. anchors: where points may not move.
        value: all of it.
    """

    master: str
    place: str | None
    name: str
    paths: list[Value]
    anchors: frozenset[Position]
    value: Value


class GlyphsText:
    """A Glyphs file as text.

    Attributes:
        masters: the ids of its masters, in order. glyphs: by name.

    Raises:
        FontError: it is no property list, or not one of a font.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        top, _ = _parsed(text, 0, 0)
        if not isinstance(top.of, dict) or "glyphs" not in top.of:
            raise FontError("is no Glyphs file")
        self.is_new = str(top.get(".formatVersion")) == "3"
        self.masters = [_plain(master["id"].of) for master in top["fontMaster"].of]
        self.glyphs = {_plain(glyph["glyphname"].of): glyph for glyph in top["glyphs"].of}

    def layers(self, glyph: str) -> Iterator[Layer]:
        """The layers of a glyph."""
        for layer in self.glyphs[glyph]["layers"].of:
            name, place = _plain(layer.get("name") or ""), "" if "associatedMasterId" not in layer.of else None
            if place is None and (braces := re.search(r"\{.*\}", name)):
                place = braces[0]
            coordinates = layer["attributes"].get("coordinates") if "attributes" in layer.of else None
            if coordinates:
                place = f"{{{', '.join([value.of for value in coordinates])}}}"
            shapes = layer.get("shapes" if self.is_new else "paths") or []
            paths = [shape["nodes"] for shape in shapes if "nodes" in shape.of]
            anchors = frozenset(filter(None, (self._position(anchor) for anchor in layer.get("anchors") or [])))
            master = _plain(layer.get("associatedMasterId") or layer.get("layerId") or "")
            yield Layer(master, place, name, paths, anchors, layer)

    def _position(self, anchor: Value) -> Position | None:
        if self.is_new:
            found = [float(_plain(value.of)) for value in anchor.get("pos") or []] or [0.0, 0.0]
        else:
            found = [float(part) for part in _plain(anchor.get("position") or "{0, 0}").strip("{}").split(",")]
        return (found[0], found[1]) if len(found) == 2 else None

    def nodes(self, path: Value) -> list[Node]:
        """The nodes of a path from its first one on: in the file the first one comes last."""
        found = []
        for value in path.of:
            if self.is_new:
                x, y, kind, *rest = [part.of for part in value.of]
                extra = self.text[value[3].start : value[3].stop] if rest else ""
                node = Node((float(x), float(y)), LETTERS[kind[0]], kind.endswith("s"), extra)
            else:
                x, y, kind, *rest = value.of.strip('"').split(" ", 3)
                more = rest[0] if rest else ""
                extra = more.removeprefix("SMOOTH").strip()
                node = Node((float(x), float(y)), WORDS[kind], more.startswith("SMOOTH"), extra)
            found.append(node)
        return found[-1:] + found[:-1]

    def written(self, path: Value, nodes: Sequence[Node]) -> str:
        """The text of a path's list with other nodes, in the style of the nodes that were there."""
        first, last = path.of[0], path.of[-1]
        between = self.text[first.stop : path.of[1].start] if len(path.of) > 1 else ",\n"
        parts = between.join(map(self._text, (*nodes[1:], nodes[0])))
        return self.text[path.start : first.start] + parts + self.text[last.stop : path.stop]

    def _text(self, node: Node) -> str:
        x, y = node.at
        if self.is_new:
            letter = {kind: key for key, kind in LETTERS.items()}[node.kind] + "s" * node.smooth
            return f"({x!r},{y!r},{letter}{',' + node.extra if node.extra else ''})"
        word = {kind: key for key, kind in WORDS.items()}[node.kind] + " SMOOTH" * node.smooth
        return f'"{x!r} {y!r} {word}{" " + node.extra if node.extra else ""}"'


def _plain(text: Any) -> str:
    """A text without its quotation marks."""
    text = str(text)
    return re.sub(r"\\(.)", r"\1", text[1:-1]) if text.startswith('"') else text


def _parsed(text: str, at: int, depth: int) -> tuple[Value, int]:
    """A value and where it ends."""
    token = TOKEN.match(text, at)
    # Lists within lists that a Glyphs file may have.
    if token is None or depth > 100:
        raise FontError(f"is no Glyphs file: nothing is understood at character {at}")
    mark, start = token[1], token.start(token.lastindex or 0)
    at = token.end()
    if mark == "{":
        items: dict[str, Value] = {}
        while (after := TOKEN.match(text, at)) and after[1] != "}":
            at = _expected(text, after.end(), "=")
            items[_plain(after[after.lastindex or 0])], at = _parsed(text, at, depth + 1)
            at = _expected(text, at, ";")
        return _closed(items, start, after)
    if mark == "(":
        values: list[Value] = []
        while (after := TOKEN.match(text, at)) and after[1] != ")":
            value, at = _parsed(text, at, depth + 1)
            values.append(value)
            if (after := TOKEN.match(text, at)) and after[1] == ",":
                at = after.end()
        return _closed(values, start, after)
    if mark:
        raise FontError(f"is no Glyphs file: {mark} at character {start}")
    return Value(token[token.lastindex or 0], start, at), at


def _closed(items: Any, start: int, end: re.Match[str] | None) -> tuple[Value, int]:
    if end is None:
        raise FontError("is no Glyphs file: it ends too early")
    return Value(items, start, end.end()), end.end()


def _expected(text: str, at: int, mark: str) -> int:
    token = TOKEN.match(text, at)
    if token is None or token[1] != mark:
        raise FontError(f"is no Glyphs file: no {mark} at character {at}")
    return token.end()
