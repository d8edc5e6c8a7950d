"""The lock of an output folder: one run at a time writes to it.

The system holds the lock for the open file, not the file's presence: it ends with the process, however that ends, so
a file left by ``kill -9`` locks nothing. On a network drive its server holds it for all machines. The file is removed
when the run ends.
"""

from __future__ import annotations

import errno
import logging
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock, Timeout

from ..errors import OutputError
from ..files import make_folder

LOCK = ".lock"

UNSUPPORTED = {errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOTSUP, errno.EINVAL}
"""Errors of file systems that know no locks."""

LARGEST_NOTE = 200
"""Bytes that are read of what the holder has written of itself."""


log = logging.getLogger(__name__)


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder, which is made if it does not exist.

    Raises:
        OutputError: another run holds it; the message has its process id. Or folder or file cannot be made.
    """
    make_folder(folder)
    path = folder / LOCK
    lock = FileLock(path, timeout=0)
    try:
        lock.acquire()
    except Timeout:
        raise OutputError(f"another run is writing to it: {_note(path)}", font=str(folder)) from None
    except OSError as error:
        if error.errno not in UNSUPPORTED:
            raise OutputError(f"cannot be written: {error.strerror or error}", font=str(path)) from error
        log.warning("%s: its file system has no locks: no other run may write to it now", folder)
    try:
        with suppress(OSError):  # Windows: the lock is of the byte written first
            path.write_text(f"process {os.getpid()} on {socket.gethostname()}\n")
        yield
    finally:
        # Elsewhere than on Windows, once released it may be another run's.
        for step in (lock.release, path.unlink) if os.name == "nt" else (path.unlink, lock.release):
            with suppress(OSError):
                step()


def _note(path: Path) -> str:
    """What the holder has written of itself, which anybody may have written."""
    with suppress(OSError):
        text = path.read_bytes()[:LARGEST_NOTE].decode(errors="replace").strip()
        if text.isprintable() and text:
            return text
    return "a process that has not yet said which"
