"""The text of a .glif file, of which only the points of contours change."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from xml.parsers import expat

from ....readers.source import parsed
from .nodes import Node, Position

OWN = ("x", "y", "type", "smooth")
"""Attributes of a point that are not kept as ``extra``."""


@dataclass(frozen=True)
class Span:
    """The points of a contour: where their text begins and ends, in bytes, and what they are."""

    start: int
    stop: int
    nodes: list[Node]


class Glif:
    """A glyph's file.

    Attributes:
        data: its bytes. contours: its contours in order; a component between them does not count.
        anchors: places of its anchors.

    Raises:
        GlyphsplineError: it is no XML, or declares entities.
    """

    def __init__(self, data: bytes) -> None:
        parsed(data)
        self.data, self.contours, self.anchors = data, list[Span](), set[Position]()
        self._open: list[str] = []
        self._start, self._nodes = -1, list[Node]()
        self._parser = parser = expat.ParserCreate()
        parser.StartElementHandler, parser.EndElementHandler = self._begin, self._end
        parser.Parse(data, True)

    def _begin(self, name: str, given: dict[str, str]) -> None:
        from xml.sax.saxutils import quoteattr  # here and not above: with it comes what speaks HTTP

        self._open.append(name)
        if self._open == ["glyph", "anchor"]:
            self.anchors.add((float(given["x"]), float(given["y"])))
        elif self._open == ["glyph", "outline", "contour"]:
            self._start, self._nodes = -1, []
        elif self._open == ["glyph", "outline", "contour", "point"]:
            if self._start < 0:
                self._start = self._parser.CurrentByteIndex
            kind = given.get("type", "offcurve")
            extra = "".join([f" {key}={quoteattr(value)}" for key, value in given.items() if key not in OWN])
            at = float(given["x"]), float(given["y"])
            self._nodes.append(Node(at, None if kind == "offcurve" else kind, given.get("smooth") == "yes", extra))

    def _end(self, name: str) -> None:
        if self._open == ["glyph", "outline", "contour"]:
            at = self._parser.CurrentByteIndex
            stop = len(self.data[:at].rstrip()) if self._start >= 0 else at
            self.contours.append(Span(self._start, stop, self._nodes))
        self._open.pop()

    def with_contours(self, new: Mapping[int, Sequence[Node]]) -> bytes:
        """The file with other points in some of its contours, in the style of the points that were there."""
        parts, at = list[bytes](), 0
        for number, nodes in sorted(new.items()):
            span = self.contours[number]
            style = self.data[span.start : span.stop]
            between = self.data[len(self.data[: span.start].rstrip()) : span.start]
            end = " />" if style.endswith(b" />") else "/>"
            points = between.join([_point(node, end).encode() for node in nodes])
            parts += [self.data[at : span.start], points]
            at = span.stop
        return b"".join([*parts, self.data[at:]])


def _point(node: Node, end: str) -> str:
    x, y = node.at
    kind = f' type="{node.kind}"' if node.kind else ""
    smooth = ' smooth="yes"' if node.smooth else ""
    return f'<point x="{x!r}" y="{y!r}"{kind}{smooth}{node.extra}{end}'
