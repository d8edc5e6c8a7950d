"""New outlines in a source that takes them back, as a UFO: in itself, in a layer of it, or in a copy.

Only the points of contours change, as text; an unchanged glyph's file keeps its bytes. Components, anchors, guidelines,
kerning, groups, features, layers, libs, images and font info stay as they are, and so do contours that are open, drawn
in quadratics, or without a point that something refers to.
"""

from __future__ import annotations

import os
import plistlib
import shutil
from abc import ABC, abstractmethod
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from fontTools.misc.filenames import userNameToFileName

from ....errors import OutputError
from ....files import write_whole
from ....fitting.results import GlyphResult
from ....outlines.masters import Masters
from ....outlines.outline import Contour
from ....readers import Source
from ....readers.ufo import Drawing, EditableSource, Ufo
from ..ufo_folder import replacing, stored_curves
from .glif import Glif
from .nodes import Node, Position, moved, replaced

Drawn = tuple[list[list[Node]], frozenset[Position]]
"""The nodes of a glyph's own contours, and where its anchors are."""


@dataclass
class Written:
    """What was written back.

    Attributes:
        names: of the glyphs that changed. kept: why contours of others stayed as they were, by glyph.
        contours: the same by glyph and number of the contour in its outline.
        points: of the contours that changed, of one master: as they were, and as they are.
    """

    names: list[str] = field(default_factory=list)
    kept: dict[str, str] = field(default_factory=dict)
    contours: dict[tuple[str, int], str] = field(default_factory=dict)
    points: tuple[int, int] = (0, 0)


@dataclass(frozen=True)
class NewGlyph:
    """A glyph's new contours: ``contours[c][k]`` is contour c where ``drawings[k]`` says.

    With ``old``, the contours as they were, nothing but coordinates changes: the new ones have the same points, but for
    the contours ``redrawn``, of which points went or changed their order.
    """

    name: str
    contours: Sequence[Sequence[Contour]]
    drawings: Sequence[Drawing]
    old: Sequence[Sequence[Contour]] | None = None
    redrawn: Collection[int] = ()


class Edit(ABC):
    """How glyphs are read from a source and put into it."""

    @abstractmethod
    def drawn(self, drawing: Drawing, name: str) -> Drawn:
        """What a glyph draws itself."""

    @abstractmethod
    def put(self, drawing: Drawing, name: str, nodes: Mapping[int, Sequence[Node]]) -> None:
        """Put new nodes into some of a glyph's contours."""

    @abstractmethod
    def finish(self) -> None:
        """Write what is still to be written when all glyphs are there."""


def editable(source: Source) -> EditableSource:
    """A source that takes outlines back.

    Raises:
        OutputError: it is of another kind.
    """
    if not isinstance(source, EditableSource):
        raise OutputError("only UFOs, designspaces and Glyphs files take outlines back", font=str(source.path))
    return source


def of_results(source: Ufo, results: Iterable[GlyphResult]) -> Iterable[NewGlyph]:
    """The new contours of a UFO's glyphs."""
    for result in results:
        contours = [[curve] for curve in stored_curves(result)]
        yield NewGlyph(result.outline.name, contours, source.drawings(result.outline.name))


def moved_points(source: EditableSource, old: Masters, new: Masters, redrawn: Collection[int]) -> NewGlyph:
    """The contours of a glyph of which points moved, in all masters; ``redrawn``: see :class:`NewGlyph`."""
    places, drawings = new.stored_peaks, source.drawings(new.name)
    chosen = [places.index(each.place) for each in drawings]
    both = [[[Contour(c.points[k], c.degrees) for k in chosen] for c in each.contours] for each in (new, old)]
    return NewGlyph(new.name, both[0], drawings, both[1], redrawn)


def write_back(
    source: EditableSource, glyphs: Iterable[NewGlyph], digits: int, *, copy: Path | None = None,
    layer: str | None = None, dry: bool = False,
) -> Written:  # fmt: skip
    """Write new contours, rounded to ``digits`` decimals, into a source or a copy of it.

    Args:
        copy: a folder (for a Glyphs file: a file) that becomes a copy of the source with the new outlines; None writes
            into the source itself. layer: put them into this layer beside the old ones, which stay.
        dry: write nothing; only look what would be.

    Raises:
        OutputError: something else is at ``copy``; a UFO before version 3 has no layers. OSError: it cannot be written.
        GlyphsplineError: a file of the source is broken.
    """
    if (edit := source.text_edit(layer)) is not None:
        found = _edited(source, glyphs, digits, edit, dry)
        if not dry and (found.names or copy is not None):
            write_whole(str(copy or source.path), edit.text(), durable=True)
        return found
    if copy is None or dry:
        return _edited(source, glyphs, digits, _UfoEdit(Path(), Path(), layer), dry)
    with replacing(copy, "is no source of a font", "metainfo.plist", "**/*.designspace") as partial:
        return _edited(source, glyphs, digits, _UfoEdit(_copied(source, partial), partial, layer), dry)


def _copied(source: EditableSource, folder: Path) -> Path:
    """Copy a source's files; returns the folder that ``folder`` is a copy of."""
    if source.path.is_dir():
        shutil.copytree(source.path, folder, symlinks=True)
        return source.path
    paths = [path.absolute() for path in (source.path, *source.folders)]
    root = Path(os.path.commonpath([path.parent for path in paths]))
    for path in paths:
        to = folder / path.relative_to(root)
        to.parent.mkdir(parents=True, exist_ok=True)
        if path.is_dir():
            shutil.copytree(path, to, symlinks=True)
        else:
            shutil.copyfile(path, to)
    return root


def _edited(source: EditableSource, glyphs: Iterable[NewGlyph], digits: int, edit: Edit, dry: bool) -> Written:
    found = Written()
    for new in glyphs:
        if new.name in source.others:
            found.kept[new.name] = why = source.others[new.name]
            found.contours |= {(new.name, index): why for index in range(len(new.contours))}
            continue
        old, changes, stays = _changes(source, new, digits, edit)
        if stays:
            found.kept[new.name] = "; ".join([f"contour {number} {why}" for number, _, why in stays])
            found.contours |= {(new.name, index): why for _, index, why in stays}
        if changes:
            found.names.append(new.name)
            before, after = found.points
            found.points = before + sum(len(old[k]) for k in changes[0]), after + sum(map(len, changes[0].values()))
            for drawing, nodes in zip(new.drawings, () if dry else changes, strict=not dry):
                edit.put(drawing, new.name, nodes)
    edit.finish()
    return found


def _changes(
    source: EditableSource, new: NewGlyph, digits: int, edit: Edit
) -> tuple[list[list[Node]], list[dict[int, list[Node]]], list[tuple[int, int, str]]]:
    """The nodes of contours in the first drawing; by drawing those that change, with their new ones; and numbers of
    contours that stay, in the file and in the outline, and why.
    """
    changes: list[dict[int, list[Node]]] = [{} for _ in new.drawings]
    stays = []
    old, held = zip(*(edit.drawn(drawing, new.name) for drawing in new.drawings), strict=True)
    for number, index in enumerate(source.own_contours(new.name)):
        if index is None:
            continue
        nodes, contours = [contours[number] for contours in old], new.contours[index]
        if new.old is None or index in new.redrawn:
            made = replaced(nodes, contours, held, digits, keeps_flags=new.old is not None)
        else:
            made = moved(nodes, new.old[index], contours, held, digits)
        if isinstance(made, str):
            stays.append((number, index, made))
        elif made:
            for change, own in zip(changes, made, strict=True):
                change[number] = own
    return old[0], (changes if any(changes) else []), stays


class _UfoEdit(Edit):
    """Glyphs of UFOs at ``root``, or of their copies in another folder.

    Files are written at the end of each glyph, so that an interrupted run leaves whole files.
    """

    def __init__(self, root: Path, copy: Path, layer: str | None) -> None:
        self.root, self.copy, self.layer = root, copy, layer
        self._folders: dict[tuple[Path, str | None], _Folder] = {}

    def _folder(self, drawing: Drawing, layer: str | None) -> _Folder:
        ufo = drawing.ufo
        if self.copy != Path():
            ufo = self.copy / (ufo if ufo == self.root else ufo.absolute()).relative_to(self.root)
        return self._folders.setdefault((ufo, layer), _Folder(ufo, layer))

    def _glif(self, drawing: Drawing, name: str) -> Glif:
        return Glif(self._folder(drawing, drawing.layer).file(name).read_bytes())

    def drawn(self, drawing: Drawing, name: str) -> Drawn:
        """What a glyph draws itself."""
        glif = self._glif(drawing, name)
        return [span.nodes for span in glif.contours], frozenset(glif.anchors)

    def put(self, drawing: Drawing, name: str, nodes: Mapping[int, Sequence[Node]]) -> None:
        """Write a glyph with new nodes in some of its contours."""
        data = self._glif(drawing, name).with_contours(nodes)
        if self.layer is None:
            write_whole(str(self._folder(drawing, drawing.layer).file(name)), data)
        else:
            layer = self.layer if drawing.layer is None else f"{self.layer} {drawing.layer}"
            self._folder(drawing, layer).add(name, data)

    def finish(self) -> None:
        """Write the lists of the glyphs of new layers."""
        for folder in self._folders.values():
            folder.finish()


class _Folder:
    """The folder of a layer of a UFO, None its default; a layer that there is not is made when a glyph is added."""

    def __init__(self, ufo: Path, layer: str | None) -> None:
        self.ufo, self.layer, self.added = ufo, layer, False

    @cached_property
    def layers(self) -> list[list[str]]:
        """Names and folders of all layers, the default one first."""
        path = self.ufo / "layercontents.plist"
        found = plistlib.loads(path.read_bytes()) if path.exists() else [["public.default", "glyphs"]]
        return [[str(name), Path(str(folder)).name] for name, folder in found]

    @cached_property
    def path(self) -> Path:
        """Where the layer's files are."""
        names = dict(self.layers)
        if self.layer is None:
            return self.ufo / "glyphs"
        if self.layer not in names:
            taken = {folder.lower() for folder in names.values()}
            names[self.layer] = userNameToFileName(self.layer, taken, prefix="glyphs.")
        return self.ufo / names[self.layer]

    @cached_property
    def contents(self) -> dict[str, str]:
        """File names of glyphs, without folders."""
        path = self.path / "contents.plist"
        found = plistlib.loads(path.read_bytes()) if path.exists() else {}
        return {name: Path(str(file)).name for name, file in found.items()}

    def file(self, name: str) -> Path:
        """The file of a glyph."""
        return self.path / self.contents[name]

    def add(self, name: str, data: bytes) -> None:
        """Write a glyph, which the layer may have or not."""
        if plistlib.loads((self.ufo / "metainfo.plist").read_bytes()).get("formatVersion", 1) < 3:
            raise OutputError("has no layers, as it is no UFO 3", font=str(self.ufo))
        self.path.mkdir(exist_ok=True)
        if name not in self.contents:
            taken = {file.lower() for file in self.contents.values()}
            self.contents[name] = userNameToFileName(name, taken, suffix=".glif")
        write_whole(str(self.file(name)), data)
        self.added = True

    def finish(self) -> None:
        """Write the lists of glyphs and of layers, if glyphs were added."""
        if not self.added:
            return
        write_whole(str(self.path / "contents.plist"), plistlib.dumps(dict(sorted(self.contents.items()))))
        if self.layer not in dict(self.layers):
            layers = [*self.layers, [str(self.layer), self.path.name]]
            write_whole(str(self.ufo / "layercontents.plist"), plistlib.dumps(layers))
