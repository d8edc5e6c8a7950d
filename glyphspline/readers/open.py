"""Opens a source of any kind; the content of the path decides which reader is used. And the facts of a file as data."""

from __future__ import annotations

import re
import sys
import tempfile
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from ..errors import FontError
from ..outlines.masters import DesignAxis
from .opentype.containers import FORMATS
from .opentype.font import Font, open_faces, open_font
from .source import Location, Source, opening

if TYPE_CHECKING:
    from .designspace import Designspace, GlyphsFile
    from .svg import SvgDrawings
    from .ufo import Ufo

AnySource: TypeAlias = "Font | Ufo | Designspace | GlyphsFile | SvgDrawings"

STDIN = "-"
UTF8 = b"\xef\xbb\xbf"
LARGEST_INPUT = 1 << 29
"""Limit of bytes from standard input."""

_kept: list[tempfile.TemporaryDirectory[str]] = []


def open_source(path: str | Path, face_index: int = 0, location: Location = None) -> AnySource:
    """Open a font file, a UFO, a designspace, a Glyphs file, an SVG drawing or a folder of drawings.

    The content of the path decides, not its name.

    Args:
        path: file or folder; ``"-"`` is a font or drawing on standard input.
        face_index, location: as in :func:`open_font`; only fonts have them; a designspace and a Glyphs file
            have locations.

    Raises:
        FontError: the path cannot be read, or it has no such face or location.
    """
    if is_font(path):
        return open_font(_place(path), face_index, location)
    path = _place(path)
    if face_index:
        raise FontError(f"no face {face_index}: this has one, counted from 0", font=str(path))
    # Here and not above: a font file needs none of them, and they import a third of fontTools.
    from .designspace import Designspace, GlyphsFile
    from .svg import SvgDrawings
    from .ufo import Ufo

    head = b"" if path.is_dir() else beginning(path)
    if is_glyphs(head):
        return GlyphsFile.opened(path, location)
    if b"<designspace" in head:
        return Designspace.opened(path, location)
    if location:
        raise FontError("a location is asked for, and it is not a variable font", font=str(path))
    if (path / "metainfo.plist").exists():
        return Ufo.opened(path)
    if path.is_dir() and next(path.glob("*.svg"), None) is None:
        raise FontError("a folder that is no UFO and holds no SVG drawings", font=str(path))
    return SvgDrawings.opened(path)


def reopened(path: Path, face_index: int, location: Location) -> Source:
    """A source that was open before, opened as :func:`open_source` does, but for the names and characters of a font.

    Those take longest, and are read when they are asked for.
    """
    return next(open_faces(path, face_index, location)) if is_font(path) else open_source(path, face_index, location)


def is_font(path: str | Path) -> bool:
    """Whether a path is to be read as a font file: it is one, or neither a folder, nor XML, nor a Glyphs file.

    Raises:
        FontError: it cannot be read.
    """
    path = _place(path)
    if path.is_dir():
        return False
    head = beginning(path)
    return head[:4] in FORMATS or not (is_glyphs(head) or head.removeprefix(UTF8).lstrip()[:1] == b"<")


def is_glyphs(head: bytes) -> bool:
    """Whether a file that begins so is a Glyphs file: a property list in braces."""
    return re.match(rb'\s*\{\s*"?\.?\w+"?\s*=', head.removeprefix(UTF8)) is not None


def beginning(path: Path) -> bytes:
    """The first bytes of a file, which say its kind.

    Raises:
        FontError: it cannot be read.
    """
    with opening(path), open(path, "rb") as file:
        return file.read(4096)


def _place(path: str | Path) -> Path:
    return standard_input() if str(path) == STDIN else Path(path)


@cache
def standard_input() -> Path:
    """Copy standard input to a file, which this process removes at its end; workers open it too.

    Raises:
        FontError: standard input is empty or too large.
    """
    data = sys.stdin.buffer.read(LARGEST_INPUT + 1)
    if not data or len(data) > LARGEST_INPUT:
        raise FontError("nothing" if not data else f"more than {LARGEST_INPUT >> 20} MiB", font="standard input")
    _kept.append(tempfile.TemporaryDirectory(prefix="glyphspline-"))
    path = Path(_kept[-1].name) / "stdin"
    path.write_bytes(data)
    return path


def forget_standard_input() -> None:
    """Remove the copy of standard input, for exits that skip atexit handlers."""
    while _kept:
        _kept.pop().cleanup()


def file_facts(path: str | Path, face_index: int | None = None, location: Location = None) -> dict[str, Any]:
    """The file's format, and the facts of each face or of the one requested. No glyph is read.

    Raises:
        FontError: as in :func:`open_source`.
    """
    faces: list[Source]
    if is_font(path):
        faces = [*open_faces(_place(path), face_index, location)]
    else:
        faces = [open_source(path, face_index or 0, location)]
    fonts = []
    for face in faces:
        glyphs, characters = face.counts()
        fonts.append({
            "face_index": face.face_index, "family": face.family, "style": face.style, **asdict(face.metrics),
            "axes": [axis_facts(axis) for axis in face.axes],
            "instances": {name: dict(place) for name, place in face.instances.items()},
            "location": dict(face.location), "glyphs": glyphs, "characters": characters,
        })  # fmt: skip
    return {"file": str(path), "format": faces[0].format, "faces": faces[0].num_faces, "fonts": fonts}


def axis_facts(axis: DesignAxis) -> dict[str, Any]:
    """An axis in user space."""
    return {name: value for name, value in asdict(axis).items() if name != "mapping"}
