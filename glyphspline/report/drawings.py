"""What the gallery shows of a glyph, read back from the drawings that a run has written beside it."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path, PurePosixPath

from ..writers.svg.markup import Text

Drawing = dict[str, Text]
"""Path data of ``source``, ``result``, ``polygon`` and ``control``; "" for what was not written."""

_GROUP = re.compile(r'<g id="[^"]*-(source|polygon|control)"[^>]*><path(?: [a-z-]+="[^"]*")*? d="([^"]*)"')
_RESULT = re.compile(r'<path (?:id="[^"]*-outline"|class="outline")(?: [a-z-]+="[^"]*")*? d="([^"]*)"')
_PATH = re.compile(r"[MLQCZlqc0-9 .e+-]*")


def read_drawing(folder: Path, files: Mapping[str, str]) -> Drawing:
    """The path data of one glyph; of files that are not there, or are no drawings of ours, nothing."""
    return drawing_of(lambda kind: _content(folder, files.get(kind)))


def drawing_of(content: Callable[[str], str]) -> Drawing:
    """The path data of one glyph from its drawings, which are asked for by their kind; "" says there is none."""
    found = drawing()
    for name, data in _GROUP.findall(content("source")):
        found[name] = _clean(data)
    # The curvature map draws the same outline, for runs that wrote no plain SVG.
    for kind in ("svg", "curvature"):
        match = _RESULT.search(content(kind))
        if match:
            found["result"] = _clean(match[1])
            break
    return found


def drawing(result: Text = "") -> Drawing:
    """A glyph of which no more than its outline is drawn."""
    return {"source": "", "result": result, "polygon": "", "control": ""}


def inside(path: object) -> bool:
    """Whether a manifest's path stays in the run's folder. A manifest may come from anywhere."""
    pure = PurePosixPath(str(path))
    return isinstance(path, str) and not pure.is_absolute() and ".." not in pure.parts and "\\" not in path


def _content(folder: Path, path: str | None) -> str:
    if path is None or not inside(path):
        return ""
    try:
        return (folder / path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return ""


def _clean(data: str) -> str:
    return data if _PATH.fullmatch(data) else ""
