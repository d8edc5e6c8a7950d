"""Files of a run: safe names that differ in more than case, and atomic writes."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from fontTools.ufoLib.filenames import reservedFileNames, userNameToFileName

from ..errors import OutputError

LONGEST_NAME = 150
"""Bytes of a file name before its suffix. File systems take 255; the rest is for clash numbers and suffixes."""

PARTIAL = ".part"
"""Suffix of temporary files. Their names begin with a dot, so globs over results do not match them."""

O_BINARY = getattr(os, "O_BINARY", 0)
"""On Windows: do not translate line ends."""

_PLAIN = re.compile(r"[a-z0-9_]{1,75}")
"""Names that the UFO rules do not change. For a large font, applying the rules to all names takes half a second."""

_NOT_TEXT = re.compile("[\x7f-\x9f\ud800-\udfff]")


def file_names(glyph_names: Iterable[str]) -> list[str]:
    """A file name, without suffix, for each glyph name; no two are alike without regard to case.

    They depend on all names of the font in order, not on which glyphs are selected.
    """
    names = list(glyph_names)
    taken: set[str] = set()
    first = [_stem(name, taken) for name in names[:1]]  # .notdef in most fonts, which is not plain
    rest = names[1:]
    others = {*taken, *reservedFileNames}
    if all(map(_PLAIN.fullmatch, rest)) and len(others.union(rest)) == len(others) + len(rest):
        return first + rest
    return first + [_stem(name, taken) for name in rest]


def _stem(name: str, taken: set[str]) -> str:
    """A name's file name, which is added to ``taken``."""
    plain = _PLAIN.fullmatch(name) and name not in taken and name not in reservedFileNames
    stem = name if plain else userNameToFileName(_tame(name), taken)
    taken.add(stem.lower())
    return stem


def _tame(name: str) -> str:
    """Make a valid name where the UFO rules do not: the name is too long in bytes, empty, or has lone surrogates."""
    clipped = _NOT_TEXT.sub("_", name).encode()[: LONGEST_NAME // 2]  # capitals take two characters under the rules
    return clipped.decode(errors="ignore").rstrip(". ") or "_"


@contextmanager
def writing(path: Path | str) -> Iterator[None]:
    """Turn an OSError within into an OutputError that names the file."""
    try:
        yield
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(f"cannot be written: {error.strerror or error}", font=str(path)) from error


def write_whole(path: str, content: str | bytes, *, durable: bool = False) -> int:
    """Write a file under a temporary name beside it, then rename; returns its size in bytes.

    Each process reuses one temporary name, which file systems handle faster than new names. ``durable`` syncs the file
    to the disk before it is renamed, which takes some milliseconds.

    Raises:
        OutputError: it cannot be written; a file of this name remains unchanged.
    """
    data = content.encode() if isinstance(content, str) else content
    partial = f"{path.rpartition('/')[0]}/.{os.getpid()}{PARTIAL}"
    with writing(path):
        # O_EXCL does not follow a link planted under the temporary name.
        handle = os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_EXCL | O_BINARY, 0o666)
        try:
            try:
                written = os.write(handle, data)
                while written < len(data):
                    written += os.write(handle, data[written:])
                if durable:
                    os.fsync(handle)
            finally:
                os.close(handle)
            os.replace(partial, path)
        except BaseException:
            with suppress(OSError):
                os.unlink(partial)
            raise
    return len(data)


def make_folder(path: Path) -> None:
    """Make a folder inside the output folder; a link in its place would lead the run elsewhere and is refused."""
    if path.is_symlink():
        raise OutputError("is a symbolic link, which could lead out of the output folder", font=str(path))
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"cannot be made: {error.strerror or error}", font=str(path)) from error


def remove_partials(folder: Path) -> None:
    """Remove temporary files that an interrupted run has left in a folder."""
    with suppress(FileNotFoundError), os.scandir(folder) as items:
        for item in items:
            if item.name.startswith(".") and item.name.endswith(PARTIAL):
                with suppress(OSError):
                    os.unlink(item.path)


def sizes(folder: Path) -> dict[str, int]:
    """The size in bytes of every regular file of a folder, by name; empty if there is no such folder."""
    with suppress(FileNotFoundError), os.scandir(folder) as items:
        return {item.name: item.stat(follow_symlinks=False).st_size for item in items if item.is_file()}
    return {}
