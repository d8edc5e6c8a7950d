"""Where a data set's files are, a folder or an object store: written whole or not at all, listed, read."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO, TypeAlias

from ..files import make_folder, remove_partials, replacing, writing
from ..runs import remote
from ..runs.folder import locked

Content: TypeAlias = bytes | Callable[[BinaryIO], None]
"""What is in a file, or what writes it."""


def place_of(out: str | Path) -> str:
    """A folder's absolute path or URL, without a slash at its end.

    Raises:
        GlyphsplineError: the URL cannot be used, or is not that of an object store.
    """
    local = remote.local_path(str(out))
    if local is not None:
        return str(Path(local).absolute())
    remote.check_whole(str(out))
    remote.file_system(str(out))
    return str(out).rstrip("/")


@contextmanager
def alone(folder: str) -> Iterator[None]:
    """Hold a folder against other runs. A store has no locks: two runs of the same data set write the same files there.

    Raises:
        OutputError: another run writes to the folder.
    """
    if remote.is_url(folder):
        yield
    else:
        with locked(Path(folder)):
            yield


def put(path: str, content: Content) -> None:
    """Write a file whole: into a store by one put; else under a temporary name, synced to the disk, then renamed.

    Raises:
        OutputError: it cannot be written; a file of this name remains unchanged.
    """
    if not remote.is_url(path):
        _put_here(path, content)
    elif isinstance(content, bytes):
        remote.put(path, content)
    else:
        with tempfile.TemporaryDirectory(prefix="glyphspline-") as folder:
            whole = Path(folder) / "whole"
            with writing(whole), open(whole, "xb") as file:
                content(file)
            remote.put(path, whole)


def _put_here(path: str, content: Content) -> None:
    place = Path(path)
    make_folder(place.parent)
    with replacing(place, durable=True) as file:
        if isinstance(content, bytes):
            file.write(content)
        else:
            content(file)


def exists(path: str) -> bool:
    """Whether there is a file of that name."""
    if remote.is_url(path):
        return (remote.info(path) or {}).get("type") == "file"
    return os.path.isfile(path)


def listing(folder: str) -> list[str]:
    """The names of a folder's files, sorted; none if there is no such folder. Half written files are removed."""
    if remote.is_url(folder):
        return remote.names(folder)
    remove_partials(Path(folder))
    with suppress(FileNotFoundError), os.scandir(folder) as items:
        return sorted(item.name for item in items if item.is_file())
    return []


def read(path: str) -> BinaryIO:
    """A file open for reading at any place; of a file in a store only what is read is fetched.

    Raises:
        OSError: it cannot be opened.
    """
    return remote.opened(path) if remote.is_url(path) else open(path, "rb")


def size(path: str) -> int:
    """The size of a file in bytes.

    Raises:
        OSError: there is no such file.
    """
    with read(path) as file:
        return file.seek(0, os.SEEK_END)


def remove(path: str) -> None:
    """Remove a file.

    Raises:
        OSError: there is no such file.
    """
    if remote.is_url(path):
        remote.remove(path)
    else:
        os.unlink(path)
