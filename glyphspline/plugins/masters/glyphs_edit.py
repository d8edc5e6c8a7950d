"""New outlines in a Glyphs file: its text, and what is put in the place of what."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

from ...readers.ufo import Drawing
from ..fonts.back.back import Drawn, Edit
from ..fonts.back.nodes import Node
from .glyphs_text import GlyphsText, Layer


class GlyphsEdit(Edit):
    """The glyphs of a Glyphs file.

    Args:
        path: of the file. master_ids: see :meth:`.glyphs_file.GlyphsFile.master_ids`.
        layer: put new outlines into this layer beside the old ones.
    """

    def __init__(self, path: Path, master_ids: Callable[[Sequence[str]], dict[Path, str]], layer: str | None) -> None:
        self.file, self.layer = GlyphsText(path.read_text(encoding="utf-8")), layer
        self.masters = master_ids(self.file.masters)
        self._edits: list[tuple[int, int, str]] = []

    def _layer(self, drawing: Drawing, name: str) -> Layer:
        master, place = self.masters[drawing.ufo], _place(drawing.layer)
        return next(each for each in self.file.layers(name) if (each.master, _place(each.place)) == (master, place))

    def drawn(self, drawing: Drawing, name: str) -> Drawn:
        """What a glyph draws itself."""
        layer = self._layer(drawing, name)
        return [self.file.nodes(path) for path in layer.paths], layer.anchors

    def put(self, drawing: Drawing, name: str, nodes: Mapping[int, Sequence[Node]]) -> None:
        """Put new nodes into some of a glyph's contours."""
        layer = self._layer(drawing, name)
        edits = [(layer.paths[k], self.file.written(layer.paths[k], new)) for k, new in nodes.items()]
        spans = [(path.start, path.stop, text) for path, text in edits]
        if self.layer is None:
            self._edits += spans
            return
        title = self.layer if not drawing.layer else f"{self.layer} {_place(drawing.layer)}"
        start, text = layer.value.start, self.file.text[layer.value.start : layer.value.stop]
        drop = [layer.value.of[key] for key in ("layerId", "associatedMasterId", "name") if key in layer.value.of]
        keyed = [(text.rfind("\n", 0, v.start - start) + 1, text.find(";", v.stop - start) + 1, "") for v in drop]
        own = uuid.uuid5(uuid.NAMESPACE_URL, f"{name}/{layer.master}/{title}")
        head = f'\nassociatedMasterId = "{layer.master}";\nlayerId = "{str(own).upper()}";\nname = "{title}";\n'
        copied = _with(text, [(a - start, b - start, new) for a, b, new in spans] + keyed + [(1, 1, head)])
        others = [each for each in self.file.layers(name) if each.master == layer.master and each.place is None]
        there = [each.value for each in others if each.name == title]
        if there:
            self._edits.append((there[0].start, there[0].stop, copied))
        else:
            self._edits.append((layer.value.stop, layer.value.stop, f",\n{copied}"))

    def finish(self) -> None:
        """Nothing: the file is written once."""

    def text(self) -> str:
        """The file's text with all edits."""
        return _with(self.file.text, self._edits)


def _with(text: str, edits: Iterable[tuple[int, int, str]]) -> str:
    """A text with others in the place of some stretches."""
    parts, at = list[str](), 0
    for start, stop, new in sorted(edits):
        parts += [text[at:start], new]
        at = stop
    return "".join([*parts, text[at:]])


def _place(name: str | None) -> str:
    """The coordinates in the name of a layer between masters, without spaces; "" for a master's own."""
    return "" if not name else "".join(name[name.find("{") : name.rfind("}") + 1].split())
