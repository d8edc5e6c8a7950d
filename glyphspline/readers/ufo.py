"""UFO sources (versions 1 to 3) through fontTools' ufoLib: the default layer, components decomposed."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from types import MappingProxyType, SimpleNamespace
from typing import Any

from defusedxml.common import DefusedXmlException
from defusedxml.ElementTree import fromstring
from fontTools.pens.pointPen import PointToSegmentPen
from fontTools.ufoLib import UFOReader

from ..errors import FontError, GlyphsplineError
from ..outlines.outline import FontMetrics, Outline
from .pens import ContourPen
from .source import Head, OutlineOrError, Source, drawing, opening

ORDER_KEY, SKIP_KEY = "public.glyphOrder", "public.skipExportGlyphs"


class Ufo(Source):
    """A UFO folder; made by :func:`open_ufo`.

    Attributes:
        path: the folder, as given. face_index, location: 0 and empty, as a UFO is one master.
        family, style: from ``fontinfo.plist``, falling back on the folder's name and "Regular".
        metrics: units per em, ascender and descender.
        glyph_names: in the order of ``public.glyphOrder``, then the rest by name. Glyphs of
            ``public.skipExportGlyphs`` are left out; they may still be components.
        cmap: code point to the first glyph that has it.
    """

    format = "UFO"
    face_index = 0
    num_faces = 1
    location: Mapping[str, float] = MappingProxyType({})

    def __init__(self, path: Path) -> None:
        self.path = path
        reader = UFOReader(path, validate=True)
        info = SimpleNamespace(familyName=None, styleName=None, unitsPerEm=None, ascender=None, descender=None)
        reader.readInfo(info)
        self.family, self.style = info.familyName or path.stem, info.styleName or "Regular"
        em = float(info.unitsPerEm or 1000)
        if em <= 0:
            raise FontError(f"units per em cannot be {em:g}")
        ascender, descender = info.ascender, info.descender
        self.metrics = FontMetrics(
            em,
            float(0.8 * em if ascender is None else ascender),
            float(-0.2 * em if descender is None else descender),
        )
        self._glyphs = reader.getGlyphSet()
        outside = [name for name, file in self._glyphs.contents.items() if Path(file).name != file]
        if outside:
            raise FontError("a glyph's file lies outside the UFO", glyph=outside[0])
        self.glyph_names = _exported(list(self._glyphs.contents), reader.readLib())
        self.cmap: Mapping[int, str] = MappingProxyType(self._code_points())

    def __reduce__(self) -> tuple[Any, ...]:
        return open_ufo, (self.path,)

    @cached_property
    def sha256(self) -> str:
        """Hash of the names and contents of all files, in hexadecimal."""
        digest = hashlib.sha256()
        for file in _files(self.path):
            content = file.read_bytes()
            digest.update(f"{file.relative_to(self.path).as_posix()}\0{len(content)}\0".encode() + content)
        return digest.hexdigest()

    def _read(self, heads: Sequence[Head]) -> list[OutlineOrError]:
        found: list[OutlineOrError] = []
        for head in heads:
            try:
                found.append(self._outline(head))
            except GlyphsplineError as error:
                found.append(error)
        return found

    def _outline(self, head: Head) -> Outline:
        """The contours of the default layer, components decomposed."""
        pen = ContourPen(_Drawable(self), head.name)
        with drawing(self.path, head.name):
            glyph = self._glyph(head.name)
            glyph.draw(pen)
            pen.finish()
        return Outline(*head, float(glyph.width), pen.contours, self.metrics, pen.notes)

    def _glyph(self, name: str) -> _Glyph:
        glyph = _Glyph()
        self._glyphs.readGlyph(name, glyph, glyph.record, validate=True)
        return glyph

    def _code_points(self) -> dict[int, str]:
        """The cmap. Every glyph's file is checked for entities here, before ufoLib reads any."""
        claims: dict[str, list[int]] = {}
        for name in self._glyphs.contents:
            try:
                root = parsed(self._glyphs.getGLIF(name))
                claims[name] = [int(item.get("hex"), 16) for item in root.iter("unicode")]
            except GlyphsplineError as error:
                raise FontError(error.message, glyph=name) from error
        found: dict[int, str] = {}
        for name in self.glyph_names:
            for code in claims[name]:
                found.setdefault(code, name)
        return found


class _Glyph:
    """A glyph as ufoLib fills it in: a width, and the calls to a point pen, recorded."""

    def __init__(self) -> None:
        self.width: float = 0
        self._calls: list[tuple[str, tuple[Any, ...], dict[str, Any]]] = []
        self.record: Any = self

    def __getattr__(self, method: str) -> Any:
        if method not in ("beginPath", "addPoint", "endPath", "addComponent"):
            raise AttributeError(method)
        return lambda *args, **named: self._calls.append((method, args, named))

    def draw(self, pen: Any) -> None:
        """Draw with a segment pen."""
        points = PointToSegmentPen(pen)
        for method, args, named in self._calls:
            getattr(points, method)(*args, **named)


class _Drawable:
    """The glyph set in which a pen finds components: all glyphs, those not exported too."""

    def __init__(self, ufo: Ufo) -> None:
        self._ufo = ufo

    def __contains__(self, name: str) -> bool:
        return name in self._ufo._glyphs.contents

    def __getitem__(self, name: str) -> _Glyph:
        return self._ufo._glyph(name)


def open_ufo(path: str | Path) -> Ufo:
    """Open a UFO folder.

    Raises:
        FontError: the folder cannot be read or is no UFO.
    """
    path = Path(path)
    with opening(path, "UFO"):
        for file in _files(path):
            if file.suffix == ".plist":
                parsed(file.read_bytes())
        return Ufo(path)


def parsed(document: bytes) -> Any:
    """Parse an XML document and return its root. Entities are refused: they can expand without bound or read files.

    Raises:
        GlyphsplineError: the document declares entities, or is not XML.
    """
    try:
        return fromstring(document)
    except DefusedXmlException as error:
        raise GlyphsplineError("its XML declares entities, which are refused") from error
    except SyntaxError as error:
        raise GlyphsplineError(f"not well-formed XML: {error}") from error


def _exported(names: list[str], lib: Mapping[str, Any]) -> tuple[str, ...]:
    there, skipped = set(names), set(lib.get(SKIP_KEY, ()))
    ordered = [name for name in dict.fromkeys(lib.get(ORDER_KEY, ())) if name in there]
    return tuple(name for name in [*ordered, *sorted(there - set(ordered))] if name not in skipped)


def _files(folder: Path) -> Iterator[Path]:
    """All files of a folder in a fixed order, without following links to folders."""
    for here, folders, files in os.walk(folder):
        folders.sort()
        yield from (Path(here, file) for file in sorted(files))
