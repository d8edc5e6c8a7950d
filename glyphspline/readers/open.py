"""Opens a source of any kind; the content of the path decides which reader is used. And the facts of a file as data."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from .. import hooks
from ..errors import FontError
from ..outlines.masters import DesignAxis
from .opentype.containers import FORMATS
from .opentype.font import open_faces, open_font
from .source import Location, Source, opening

STDIN = "-"
ZIPPED = b"PK\x03\x04"
UTF8 = b"\xef\xbb\xbf"
"""The mark with which a text may begin."""

LARGEST_INPUT = 1 << 29
"""Limit of bytes from standard input."""

_kept: list[tempfile.TemporaryDirectory[str]] = []


class Reader(NamedTuple):
    """A kind of source that a plug-in reads.

    Attributes:
        recognises: whether a path is one, by it and the first bytes of a file (of a folder none).
        opened: from a path and a location to the source. has_axes: whether a source may have a location, in a design
            space or by name.
        own: the format in which ``refit`` writes such a source again.
    """

    recognises: Callable[[Path, bytes], bool]
    opened: Callable[[Path, Location], Source]
    has_axes: bool = False
    own: str = "ufo"


def open_source(path: str | Path, face_index: int = 0, location: Location = None) -> Source:
    """Open a font file, a UFO, a designspace, a Glyphs file, an SVG drawing or a folder of drawings.

    The content of the path decides, not its name.

    Args:
        path: file or folder; ``"-"`` is a font or drawing on standard input.
        face_index, location: as in :func:`open_font`; only fonts have them; a designspace and a Glyphs file
            have locations.

    Raises:
        FontError: the path cannot be read, or it has no such face or location.
    """
    path = _path_of(path)
    reader = reader_of(path)
    if reader is None:
        return open_font(path, face_index, location)
    if face_index:
        raise FontError(f"no face {face_index}: this has one, counted from 0", font=str(path))
    if location and not reader.has_axes:
        raise FontError("a location is asked for, and it is not a variable font", font=str(path))
    return reader.opened(path, location)


def reader_of(path: str | Path) -> Reader | None:
    """How a path is read; None: as a font file, which it is, or nothing else that is known.

    Raises:
        FontError: it cannot be read, or it is of a kind that nothing here reads.
    """
    path = _path_of(path)
    head = b"" if path.is_dir() else beginning(path)
    if head[:4] in FORMATS:
        return None
    if (path / "metainfo.plist").exists():
        return UFO
    for reader in hooks.every("readers"):
        if reader.recognises(path, head):
            return reader
    if path.is_dir():
        raise FontError("a folder with neither fonts, SVG drawings nor a UFO's metainfo.plist", font=str(path))
    if head.startswith(ZIPPED):
        raise FontError("a zipped folder, as .ufoz is: unzip it first", font=str(path))
    if is_xml(head):
        raise FontError("XML that nothing here reads" + hooks.away_words(), font=str(path))
    return None


def _open_ufo(path: Path, location: Location) -> Source:
    from .ufo import Ufo  # here and not above: a font file does not need it, and it imports a part of fontTools

    return Ufo.opened(path)


UFO = Reader(lambda path, head: False, _open_ufo)
"""Recognised by its folder."""


def reopened(path: Path, face_index: int, location: Location) -> Source:
    """A source that was open before, opened as :func:`open_source` does, but for the names and characters of a font.

    Those take longest, and are read when they are asked for.
    """
    return next(open_faces(path, face_index, location)) if is_font(path) else open_source(path, face_index, location)


def is_font(path: str | Path) -> bool:
    """Whether a path is to be read as a font file.

    Raises:
        FontError: it cannot be read.
    """
    return reader_of(path) is None


def is_xml(head: bytes) -> bool:
    """Whether a file that begins so is XML."""
    return head.removeprefix(UTF8).lstrip()[:1] == b"<"


def beginning(path: Path) -> bytes:
    """The first bytes of a file, which say its kind.

    Raises:
        FontError: it cannot be read.
    """
    with opening(path), open(path, "rb") as file:
        return file.read(4096)


def _path_of(path: str | Path) -> Path:
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
        faces = [*open_faces(_path_of(path), face_index, location)]
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
