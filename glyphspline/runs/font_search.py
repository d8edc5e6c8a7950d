"""Many fonts: where they are, and their faces."""

from __future__ import annotations

import glob
from collections.abc import Iterable, Iterator
from pathlib import Path

from ..errors import GlyphsplineError
from ..files import local_path, reading
from ..hooks import service
from ..readers.open import STDIN, open_source
from ..readers.source import Location, Source

SUFFIXES = frozenset({".ttf", ".otf", ".ttc", ".otc", ".woff", ".woff2"})
"""Suffixes of fonts in a folder. A file given by its own name may have any suffix."""


def find_fonts(inputs: Iterable[str]) -> list[Path]:
    """The font files of the inputs, each once, sorted by path.

    Args:
        inputs: files, UFO folders, other folders (searched to the bottom; one without fonts is itself a source, as one
            of SVG drawings is), globs (``**`` too), URLs of fonts, folders and globs, ``-`` for standard input, and
            ``@list``: a text file with one of these a line, relative to where the command was called; empty lines and
            lines with ``#`` are ignored. What is behind a URL is copied to the user's cache.

    Raises:
        GlyphsplineError: an input does not exist or cannot be fetched, or a list cannot be read.
    """
    return sorted({path for item in inputs for path in _found(item)})


def _found(item: str) -> Iterator[Path]:
    local = local_path(item)
    if local is None:
        yield from service("fetch_fonts")(item, SUFFIXES)
        return
    item, path = local, Path(local)
    if item.startswith("@"):
        yield from find_fonts(_listed(Path(item[1:])))
    elif item == STDIN or is_ufo(path):
        yield path
    elif path.is_dir():
        fonts = [file for file in path.rglob("*") if file.suffix.lower() in SUFFIXES and file.is_file()]
        fonts += [folder for folder in path.rglob("*.ufo") if is_ufo(folder)]
        yield from fonts or [path]  # drawings, or what its reader says of it
    elif path.exists():
        yield path
    else:
        matches = [Path(match) for match in glob.glob(item, recursive=True)]
        if not matches:
            raise GlyphsplineError("no such file or folder, and as a pattern it matches nothing", font=item)
        yield from (file for file in matches if file.is_file())


def is_ufo(path: Path) -> bool:
    """Whether a folder is a UFO, which is one font."""
    return (path / "metainfo.plist").is_file()


def _listed(path: Path) -> list[str]:
    with reading(path, GlyphsplineError):
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    named = [line.strip() for line in lines if line.strip() and not line.lstrip().startswith("#")]
    nested = [line for line in named if line.startswith("@")]
    if nested:
        raise GlyphsplineError(f"a list in a list: {nested[0]}", font=str(path))
    return named


def faces_of(font: Path, location: Location = None, face_index: int | None = None) -> Iterator[Source]:
    """The faces of a font file one after the other, or the one that is asked for.

    Raises:
        FontError: as in :func:`open_source`.
    """
    first = open_source(font, face_index or 0, location)
    yield first
    if face_index is None:
        for index in range(1, first.num_faces):
            yield open_source(font, index, location)
