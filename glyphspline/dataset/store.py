"""Where a data set's files are: written whole or not at all, listed, read."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, TypeAlias

from ..batch.files import PARTIAL, make_folder, remove_partials, writing

Content: TypeAlias = bytes | Callable[[BinaryIO], None]
"""What is in a file, or what writes it."""


def put(path: str, content: Content) -> None:
    """Write a file whole: under a temporary name beside it, synced to the disk, then renamed.

    Raises:
        OutputError: it cannot be written; a file of this name remains unchanged.
    """
    place = Path(path)
    make_folder(place.parent)
    partial = place.with_name(f".{place.name}-{os.getpid()}{PARTIAL}")
    with writing(path):
        try:
            with open(partial, "xb") as file:  # x does not follow a link planted under the temporary name
                if isinstance(content, bytes):
                    file.write(content)
                else:
                    content(file)
                file.flush()
                os.fsync(file.fileno())
            os.replace(partial, place)
        finally:
            with suppress(OSError):
                partial.unlink(missing_ok=True)


def exists(path: str) -> bool:
    """Whether there is a file of that name."""
    return os.path.isfile(path)


def listing(folder: str) -> list[str]:
    """The names of a folder's files, sorted, none of no folder. What was left half written is removed."""
    remove_partials(Path(folder))
    with suppress(FileNotFoundError), os.scandir(folder) as items:
        return sorted(item.name for item in items if item.is_file())
    return []


def read(path: str) -> BinaryIO:
    """A file open for reading at any place.

    Raises:
        OSError: it cannot be opened.
    """
    return open(path, "rb")


def size(path: str) -> int:
    """The size of a file in bytes."""
    return os.path.getsize(path)


def remove(path: str) -> None:
    """Remove a file."""
    os.unlink(path)
