"""Files that are written: whole or not at all, errors that name them, and what an interrupted process has left."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from typing import BinaryIO

from .errors import GlyphsplineError, OutputError, words_of

_numbers = count()

PARTIAL = ".part"
"""Suffix of temporary files. Their names begin with a dot, so globs over results do not match them."""

O_BINARY = getattr(os, "O_BINARY", 0)
"""On Windows: do not translate line ends."""


@contextmanager
def writing(path: Path | str) -> Iterator[None]:
    """Turn an OSError within into an OutputError that names the file."""
    try:
        yield
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(f"cannot be written: {words_of(error)}", font=str(path)) from error


@contextmanager
def reading(path: Path | str, kind: type[GlyphsplineError] = OutputError, form: str = "") -> Iterator[None]:
    """Turn an error of reading or parsing within into one that names the file, and the ``form`` it has not."""
    try:
        yield
    except (OSError, ValueError, TypeError, KeyError) as error:
        what = f"is not {form}" if form and not isinstance(error, OSError) else "cannot be read"
        raise kind(f"{what}: {words_of(error)}", font=str(path)) from error


def make_place(path: Path) -> None:
    """Make the folder of a file that is going to be written.

    Raises:
        OutputError: the file could not be written.
    """
    with writing(path):
        path.parent.mkdir(parents=True, exist_ok=True)


def write_whole(path: str, content: str | bytes, *, durable: bool = False) -> int:
    """Write a file under a temporary name beside it, then rename; returns its size in bytes.

    ``durable`` syncs the file to the disk before it is renamed, which takes some milliseconds.

    Raises:
        OutputError: it cannot be written; a file of this name remains unchanged.
    """
    data = content.encode() if isinstance(content, str) else content
    with replacing(path, durable=durable) as file:
        file.write(data)
    return len(data)


def write_all(file: BinaryIO, data: bytes) -> None:
    """Write to an unbuffered file, which may take less than all at a time."""
    view = memoryview(data)
    while view:
        view = view[file.write(view) :]


@contextmanager
def replacing(path: Path | str, *, durable: bool = False) -> Iterator[BinaryIO]:
    """A file to write to, which gets its name when the block ends without an error; see :func:`write_whole`.

    Raises:
        OutputError: it cannot be written; a file of this name remains unchanged.
    """
    partial = os.path.join(os.path.dirname(path), f".{os.getpid()}-{next(_numbers)}{PARTIAL}")
    with writing(path):
        file = open(partial, "xb")  # noqa: SIM115 -- x does not follow a link planted under the temporary name
        try:
            with file:
                yield file
                if durable:
                    file.flush()
                    os.fsync(file.fileno())
            os.replace(partial, path)
        except BaseException:
            with suppress(OSError):
                os.unlink(partial)
            raise


def make_folder(path: Path) -> None:
    """Make a folder inside the output folder; a link in its place would lead the run elsewhere and is refused."""
    if path.is_symlink():
        raise OutputError("is a symbolic link, which could lead out of the output folder", font=str(path))
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"cannot be made: {words_of(error)}", font=str(path)) from error


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


def is_url(name: str) -> bool:
    """Whether a name is a URL; ``C:/`` is not."""
    return re.match(r"[A-Za-z][A-Za-z0-9+.-]+://", name) is not None


def local_path(name: str) -> str | None:
    """The path that a name stands for: itself, or that of a ``file://`` URL; None of another URL."""
    if not is_url(name):
        return name
    from urllib.parse import urlsplit
    from urllib.request import url2pathname  # here and not above: it imports what speaks HTTP

    return url2pathname(urlsplit(name).path) if name.lower().startswith("file://") else None
