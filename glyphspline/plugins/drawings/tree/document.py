"""The XML of a drawing: compression, encoding, entities, namespaces. Nothing but the file itself is read."""

from __future__ import annotations

import re
import zlib
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from ....errors import GlyphsplineError

LARGEST_FILE = 1 << 26
"""Limit of bytes of one drawing, unpacked, with its entities in place."""

DEEPEST = 200
"""Limit of nested elements, far above any real drawing."""

GZIP = b"\x1f\x8b"
MARKS = {b"\xef\xbb\xbf": "utf-8-sig", b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}
MARKS |= {b"<\0": "utf-16-le", b"\0<": "utf-16-be"}
"""First bytes that say an encoding."""

SVG = "http://www.w3.org/2000/svg}"
HREF = "http://www.w3.org/1999/xlink}href"
DECLARED = re.compile(rb"""<\?xml[^>]*?\sencoding\s*=\s*["']([A-Za-z0-9._-]+)""")


@dataclass
class Document:
    """A parsed drawing.

    Attributes:
        root: its tree: the tag of an SVG element is its plain name, of others ``namespace}name``; ``href`` is an
            attribute with or without its old namespace.
        lines: of elements. sheets: whether it asks for style sheets in other files.
    """

    root: Any = None
    lines: dict[Any, int] = field(default_factory=dict)
    sheets: bool = False

    @cached_property
    def ids(self) -> dict[str, Any]:
        """The first element of each id."""
        found: dict[str, Any] = {}
        for element in self.root.iter():
            if name := element.get("id"):
                found.setdefault(name, element)
        return found

    @cached_property
    def parents(self) -> dict[Any, Any]:
        """The element around each one."""
        return {child: element for element in self.root.iter() for child in element}

    def target(self, reference: str | None) -> Any:
        """The element that ``#name`` refers to; None if there is none, or in another file."""
        reference = (reference or "").strip()
        return self.ids.get(reference[1:]) if reference.startswith("#") else None


def parse(data: bytes) -> Document:
    """Parse a drawing.

    Raises:
        GlyphsplineError: it is too large, not an SVG drawing, nested too deep, in no encoding that is known, or
            declares entities in other files or in each other.
    """
    text = decoded(unpacked(data))
    reader, document = _Reader(len(text)), Document()
    parser = expat.ParserCreate(namespace_separator="}")
    parser.buffer_text = True
    parser.StartElementHandler = lambda tag, given: reader.start(document, parser.CurrentLineNumber, tag, given)
    parser.EndElementHandler, parser.CharacterDataHandler = reader.end, reader.builder.data
    parser.EntityDeclHandler = lambda name, parameter, value, *_: reader.declare(text, name, parameter, value)
    parser.ProcessingInstructionHandler = lambda target, _: reader.instruct(document, target)
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        why = expat.ErrorString(error.code)
        raise GlyphsplineError(f"not well-formed XML: {why}, line {error.lineno}") from error
    document.root = reader.builder.close()
    if document.root.tag != "svg":
        raise GlyphsplineError("not an SVG drawing")
    return document


class _Reader:
    """What the parser calls."""

    def __init__(self, size: int) -> None:
        self.builder, self._depth, self._size = TreeBuilder(), 0, size
        self._own = SVG

    def start(self, document: Document, line: int, tag: str, given: dict[str, str]) -> None:
        self._depth += 1
        if self._depth > DEEPEST:
            raise GlyphsplineError(f"elements nested more than {DEEPEST} deep, line {line}")
        if self._depth == 1 and "}" not in tag:
            self._own = ""  # a drawing without a namespace
        plain = tag.removeprefix(self._own) if tag.startswith(self._own) else f"{{{tag}"
        if HREF in given:
            given.setdefault("href", given[HREF])
        element: Element = self.builder.start(plain, given)
        document.lines[element] = line

    def end(self, tag: str) -> None:
        self._depth -= 1
        self.builder.end(tag)

    def declare(self, text: str, name: str, parameter: bool, value: str | None) -> None:
        if parameter or value is None or "&" in value:
            raise GlyphsplineError("its XML declares entities that are in other files, or in each other: refused")
        self._size += text.count(f"&{name};") * len(value)
        if self._size > LARGEST_FILE:
            raise GlyphsplineError(f"its entities make it more than {LARGEST_FILE >> 20} MiB")

    def instruct(self, document: Document, target: str) -> None:
        document.sheets |= target == "xml-stylesheet"


def unpacked(data: bytes) -> bytes:
    """The bytes of a drawing that may be compressed, as ``.svgz`` are.

    Raises:
        GlyphsplineError: they are too many, or broken.
    """
    if data.startswith(GZIP):
        try:
            data = zlib.decompressobj(31).decompress(data, LARGEST_FILE + 1)
        except zlib.error as error:
            raise GlyphsplineError("compressed data that is broken") from error
    if len(data) > LARGEST_FILE:
        raise GlyphsplineError(f"more than {LARGEST_FILE >> 20} MiB")
    return data


def decoded(data: bytes) -> str:
    """The text of a drawing, in the encoding that its first bytes or its declaration say.

    Raises:
        GlyphsplineError: there is no such encoding, or the text is not in it.
    """
    found = DECLARED.match(data)
    name = next((name for mark, name in MARKS.items() if data.startswith(mark)), None)
    name = name or (found[1].decode() if found else "utf-8")
    try:
        return data.decode(name)
    except LookupError as error:
        raise GlyphsplineError(f"text in an encoding that is not known: {name}") from error
    except (UnicodeError, ValueError) as error:
        raise GlyphsplineError(f"text that is not in its encoding, {name}") from error
