"""The lock of an output folder: one run at a time writes to it.

The system holds the lock for the open file, not the file's presence: it ends with the process, however that ends, so
no lock is ever stale, and a file left by ``kill -9`` locks nothing. On a network drive its server holds it for all
machines. The file is removed when the run ends.
"""

from __future__ import annotations

import errno
import logging
import os
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..errors import OutputError
from ..files import O_BINARY, make_folder, writing

LOCK = ".lock"

LARGEST_NOTE = 200
"""Bytes of a lock file that are read."""

UNSUPPORTED = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.ENOTSUP, errno.EINVAL}
"""Errors of file systems that know no locks."""

log = logging.getLogger(__name__)


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder, which is made if it does not exist.

    Raises:
        OutputError: another run holds it; the message has its process id. Or folder or file cannot be made.
    """
    make_folder(folder)
    path = folder / LOCK
    handle = _held(path)
    try:
        with suppress(OSError):
            os.ftruncate(handle, 0)
            os.write(handle, f"process {os.getpid()} on {socket.gethostname()}\n".encode())
        yield
    finally:
        if sys.platform == "win32":  # where a file that is open cannot be removed
            os.close(handle)
            _remove(path)
        else:
            _remove(path)
            os.close(handle)


def _held(path: Path) -> int:
    """The lock file, open and locked."""
    flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | O_BINARY
    while True:
        with writing(path):
            handle = os.open(path, flags, 0o666)
        try:
            _take(handle)
        except OSError as error:
            if error.errno not in UNSUPPORTED:
                holder = _note(path)
                os.close(handle)
                raise OutputError(f"another run is writing to it: {holder}", font=str(path.parent)) from None
            log.warning("%s: its file system has no locks: no other run may write to it now", path.parent)
            return handle
        with suppress(OSError):
            if os.path.samestat(os.fstat(handle), os.stat(path, follow_symlinks=False)):
                return handle
        os.close(handle)  # the run before removed the file between the opening and the locking


def _note(path: Path) -> str:
    """What the holder has written of itself, which anybody may have written."""
    with suppress(OSError):
        text = path.read_bytes()[:LARGEST_NOTE].decode(errors="replace").strip()
        if text.isprintable() and text:
            return text
    return "a process that has not yet said which"


def _remove(path: Path) -> None:
    with suppress(OSError):
        path.unlink()


if sys.platform == "win32":
    import msvcrt

    FAR = 1 << 30
    """The byte that is locked, far behind the note, as nobody else may read a locked byte."""

    def _take(handle: int) -> None:
        os.lseek(handle, FAR, os.SEEK_SET)
        msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        os.lseek(handle, 0, os.SEEK_SET)

else:
    import fcntl

    def _take(handle: int) -> None:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
