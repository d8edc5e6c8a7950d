"""UFO sources (versions 1 to 3) through fontTools' ufoLib: the default layer, components decomposed."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property, partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from defusedxml.common import DefusedXmlException
from defusedxml.ElementTree import fromstring
from fontTools.pens.pointPen import PointToSegmentPen
from fontTools.pens.recordingPen import RecordingPointPen
from fontTools.ufoLib import UFOReader
from fontTools.ufoLib.glifLib import GlyphSet

from ..errors import FontError, GlyphsplineError
from ..outlines.outline import FontMetrics, Outline
from .pens import ContourPen
from .source import Head, OutlineOrError, Source, attempt, first_claims, opening

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

    def __init__(self, path: Path) -> None:
        self.path = path
        reader = UFOReader(path, validate=True)
        info = SimpleNamespace(familyName=None, styleName=None, unitsPerEm=None, ascender=None, descender=None)
        reader.readInfo(info)
        self.family, self.style = info.familyName or path.stem, info.styleName or "Regular"
        em = float(info.unitsPerEm or 1000)
        if em <= 0:
            raise FontError(f"units per em cannot be {em:g}")
        ascender = 0.8 * em if info.ascender is None else info.ascender
        descender = -0.2 * em if info.descender is None else info.descender
        self.metrics = FontMetrics(em, float(ascender), float(descender))
        self._reader, self._glyphs = reader, _glyph_set(reader)
        self.glyph_names = _exported(list(self._glyphs.contents), reader.readLib())
        claims = {name: self._claims(name) for name in self._glyphs.contents}
        self.cmap = first_claims((name, claims[name]) for name in self.glyph_names)

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
        return [attempt(self.path, head.name, partial(self._outline, head)) for head in heads]

    def _outline(self, head: Head) -> Outline:
        """The contours of the default layer, components decomposed."""
        pen = ContourPen(self._glyphs, head.name)
        glyph = self._glyphs[head.name]
        glyph.draw(pen)
        pen.finish()
        return Outline(*head, float(glyph.width), pen.contours, self.metrics, pen.notes, pen.snapped)

    def layer(self, name: str) -> GlyphSet:
        """The glyphs of another layer. Their files are not checked for entities; see :func:`parsed`.

        Raises:
            FontError: there is no such layer.
        """
        if name not in self._reader.getLayerNames():
            raise FontError(f"no layer {name!r}", font=str(self.path))
        return _glyph_set(self._reader, name)

    @property
    def default_layer(self) -> GlyphSet:
        """The glyphs of the default layer."""
        return self._glyphs

    def _claims(self, name: str) -> list[int]:
        """A glyph's code points. Its file is checked for entities here, before ufoLib reads it."""
        try:
            root = parsed(self._glyphs.getGLIF(name))
            return [int(item.get("hex"), 16) for item in root.iter("unicode")]
        except GlyphsplineError as error:
            raise FontError(error.message, glyph=name) from error


class _Glyph(RecordingPointPen):  # type: ignore[misc, unused-ignore]
    """A glyph of a glyph set as ufoLib fills it in: a width, and the calls to a point pen."""

    width: float = 0

    def __init__(self, name: str, glyphs: GlyphSet) -> None:
        super().__init__()
        glyphs.readGlyph(name, self, self, validate=True)

    def draw(self, pen: Any) -> None:
        """Draw with a segment pen."""
        self.replay(PointToSegmentPen(pen))


def _glyph_set(reader: UFOReader, layer: str | None = None) -> GlyphSet:
    """The glyphs of a layer, all of which are inside the UFO."""
    glyphs = reader.getGlyphSet(layer)
    glyphs.glyphClass = _Glyph
    outside = [name for name, file in glyphs.contents.items() if Path(file).name != file]
    if outside:
        raise FontError("a glyph's file lies outside the UFO", glyph=outside[0])
    return glyphs


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
