"""UFO sources (versions 1 to 3) through fontTools' ufoLib: the default layer, components decomposed."""

from __future__ import annotations

import os
import re
from abc import abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import MappingProxyType, SimpleNamespace
from typing import Any

from fontTools.pens.pointPen import PointToSegmentPen
from fontTools.pens.recordingPen import RecordingPointPen
from fontTools.ufoLib import UFOReader
from fontTools.ufoLib.glifLib import GlyphSet

from ..errors import FontError
from ..outlines.outline import FontMetrics, Outline
from ..types import Head
from .pens import ContourPen, drawn_by
from .source import Source, first_claims, opening, parsed

ORDER_KEY, SKIP_KEY = "public.glyphOrder", "public.skipExportGlyphs"
VARIATIONS_KEY = "public.unicodeVariationSequences"


@dataclass(frozen=True)
class Drawing:
    """Where a glyph is drawn: a UFO, a layer of it (None: its default), and the normalised place of the master."""

    ufo: Path
    layer: str | None = None
    place: tuple[float, ...] = ()


class EditableSource(Source):
    """A source that takes outlines back: its glyphs are drawn in UFOs, or in one text that becomes UFOs.

    Attributes:
        folders: the UFOs beside the file at ``path``; none if that is one.
        others: why glyphs are drawn otherwise than by their own points, which then take no outlines back.
    """

    folders: Sequence[Path] = ()
    others: Mapping[str, str] = MappingProxyType({})

    @abstractmethod
    def drawings(self, name: str) -> Sequence[Drawing]:
        """Where a glyph is drawn itself, the default master first."""

    @abstractmethod
    def own_contours(self, name: str) -> list[int | None]:
        """The number in :meth:`masters` of each contour that a glyph draws itself; None: left out there."""

    @abstractmethod
    def components(self) -> dict[str, set[str]]:
        """The names of the components that each composite has itself, in any master."""

    def text_edit(self, layer: str | None) -> Any:
        """The edit of a source that is one text, in the place of UFOs; see :func:`.back.write_back`."""
        return None


class Ufo(EditableSource):
    """A UFO folder.

    Attributes:
        path: the folder, as given. face_index, location: 0 and empty, as a UFO is one master.
        family, style: from ``fontinfo.plist``, falling back on the folder's name and "Regular".
        metrics: units per em, ascender and descender.
        glyph_names: in the order of ``public.glyphOrder``, then the rest by name. Glyphs of
            ``public.skipExportGlyphs`` are left out; they may still be components.
        cmap: code point to the first glyph that has it. variations: those of ``public.unicodeVariationSequences``.
        default_layer: the glyphs of the default layer. lib: that of the font.
    """

    format = kind = "UFO"

    def __init__(self, path: Path) -> None:
        self.path = path
        for file in _files(path):
            if file.endswith(".plist"):
                parsed(_content(file))
        self._reader = reader = UFOReader(path, validate=True)
        info = SimpleNamespace(familyName=None, styleName=None, unitsPerEm=None, ascender=None, descender=None)
        reader.readInfo(info)
        self.family, self.style = info.familyName or path.stem, info.styleName or "Regular"
        em = float(info.unitsPerEm or 1000)
        if em <= 0:
            raise FontError(f"units per em cannot be {em:g}")
        ascender = 0.8 * em if info.ascender is None else info.ascender
        descender = -0.2 * em if info.descender is None else info.descender
        self.metrics = FontMetrics(em, float(ascender), float(descender))
        if not max(map(abs, (em, self.metrics.ascender, self.metrics.descender))) < 2.0**63:  # integers of a plist
            raise FontError("has metrics that are too large for numbers of a font")
        self.default_layer = self._glyph_set(None)
        self.lib = lib = reader.readLib()
        folder, files = self.default_layer.fs.getsyspath("."), self.default_layer.contents
        self._glifs = {name: os.path.join(folder, file) for name, file in files.items()}
        there = set(files)
        ordered = [name for name in dict.fromkeys(lib.get(ORDER_KEY, ())) if name in there]
        skipped = set(lib.get(SKIP_KEY, ()))
        self.glyph_names = tuple(n for n in [*ordered, *sorted(there - set(ordered))] if n not in skipped)

    @cached_property
    def cmap(self) -> Mapping[int, str]:  # type: ignore[override]
        """Code point to the first glyph that has it."""
        return first_claims((name, _claims(self._glifs[name])) for name in self.glyph_names)

    @cached_property
    def variations(self) -> Mapping[str, str]:  # type: ignore[override]
        """Base and selector to glyph name."""
        with opening(self.path, self.kind):
            return {
                chr(int(base, 16)) + chr(int(selector, 16)): name
                for selector, of_base in self.lib.get(VARIATIONS_KEY, {}).items()
                for base, name in of_base.items()
                if name in self.gids
            }

    def _bytes(self) -> Iterable[bytes]:
        return folder_bytes(self.path)

    def _outline(self, head: Head) -> Outline:
        pen, glyph = self._drawn(head.name)
        return Outline(*head, float(glyph.width), pen.contours, self.metrics, pen.notes, pen.snapped)

    def _drawn(self, name: str) -> tuple[ContourPen, _Glyph]:
        glyph = self.default_layer[name]
        return drawn_by(glyph.draw, glyph_set=self.default_layer, glyph_name=name, opens=True), glyph

    def drawings(self, name: str) -> list[Drawing]:
        """See :meth:`EditableSource.drawings`: there is one."""
        return [Drawing(self.path)]

    def own_contours(self, name: str) -> list[int | None]:
        """See :meth:`EditableSource.own_contours`."""
        pen, glyph = self._drawn(name)
        return glyph.numbered(pen.own)

    def components(self) -> dict[str, set[str]]:
        """See :meth:`EditableSource.components`."""
        return components_of([self.default_layer])

    def layer(self, name: str) -> GlyphSet:
        """The glyphs of another layer.

        Raises:
            FontError: there is no such layer.
        """
        if name not in self._reader.getLayerNames():
            raise FontError(f"no layer {name!r}", font=str(self.path))
        return self._glyph_set(name)

    def _glyph_set(self, layer: str | None) -> GlyphSet:
        """The glyphs of a layer, all inside the UFO."""
        glyphs = self._reader.getGlyphSet(layer)
        glyphs.glyphClass = _Glyph
        outside = [name for name, file in glyphs.contents.items() if Path(file).name != file]
        if outside:
            raise FontError("a glyph's file lies outside the UFO", glyph=outside[0])
        return glyphs


class _Glyph(RecordingPointPen):  # type: ignore[misc, unused-ignore]
    """A glyph of a glyph set as ufoLib fills it in: a width, and the calls to a point pen."""

    width: float = 0

    def __init__(self, name: str, glyphs: GlyphSet) -> None:
        super().__init__()
        parsed(glyphs.getGLIF(name))  # refuses entities, before ufoLib reads them
        glyphs.readGlyph(name, self, self, validate=True)

    def draw(self, pen: Any) -> None:
        """Draw with a segment pen."""
        self.replay(PointToSegmentPen(pen))

    def numbered(self, own: Iterable[int | None]) -> list[int | None]:
        """``own``, which has an item for each contour with points, as a list that has None for each without, too."""
        calls, drawn = [name for name, *_ in self.value], iter(own)
        ends = [k for k, name in enumerate(calls) if name == "endPath"]
        return [None if calls[k - 1] == "beginPath" else next(drawn) for k in ends]


def components_of(masters: Iterable[GlyphSet]) -> dict[str, set[str]]:
    """The names of the components that composites have in any of these masters; a broken glyph has none."""
    found: dict[str, set[str]] = {}
    for glyphs in masters:
        for name in glyphs.contents:
            try:
                parts = set(values(glyphs.getGLIF(name), "component", "base"))
            except Exception:  # as in opening
                continue
            if parts:
                found.setdefault(name, set()).update(parts)
    return found


def values(glif: bytes, element: str, attribute: str) -> list[str]:
    """The attribute of each element of that name in a GLIF.

    Most need no parser: without comments, sections, declarations and instructions, "<" begins an element wherever it
    stands. Those that are written in another way than usual are parsed, in a hundred times as long.

    Raises:
        GlyphsplineError: it has to be parsed, and declares entities or is not XML.
    """
    if glif.startswith((b"<?xml ", b"<glyph")) and b"<!" not in glif and b"<?" not in glif[1:]:
        found = re.findall(rf'<{element}\s+{attribute}="([^"&<\s\x80-\xff]*)"'.encode("latin-1"), glif)
        if len(found) == glif.count(b"<" + element.encode()):
            return [value.decode() for value in found]
    return [item.get(attribute) for item in parsed(glif).iter(element)]


def _claims(file: str) -> list[int]:
    """The code points of the glyph in a file; a broken one has none, and its error when it is read."""
    try:
        return [int(value, 16) for value in values(_content(file), "unicode", "hex")]
    except Exception:  # as in opening
        return []


def folder_bytes(folder: Path) -> Iterator[bytes]:
    """All files of a folder with their names, for a checksum."""
    for file in _files(folder):
        content, name = _content(file), file.removeprefix(str(folder)).lstrip(os.sep).replace(os.sep, "/")
        yield f"{name}\0{len(content)}\0".encode() + content


def _files(folder: Path) -> Iterator[str]:
    """All files of a folder in a fixed order, without following links to folders."""
    for here, folders, files in os.walk(folder):
        folders.sort()
        yield from (os.path.join(here, file) for file in sorted(files))


def _content(file: str) -> bytes:
    with open(file, "rb") as opened:
        return opened.read()
