"""Where numba keeps the compiled code: a folder of this user's among the temporary files if there is no other place.

Imports no compiler, so that the command line can settle the place for all its processes before they start.
"""

from __future__ import annotations

import os
import stat
import sys
import tempfile
from contextlib import suppress
from pathlib import Path

from .errors import GlyphsplineError

PLACE = "NUMBA_CACHE_DIR"

TELLS = "GLYPHSPLINE_TELLS"
"""Of the environment: how processes tell what they compile, as a "line" or as "json"; empty: not at all."""


def settle() -> str | None:
    """Let numba keep compiled code in a temporary folder if it cannot where it would; returns the folder, or None.

    Processes started afterwards inherit the choice, and only the one that chooses says so on standard error.

    Raises:
        GlyphsplineError: there is no folder for temporary files either, or numba is told not to compile.
    """
    if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0"):
        raise GlyphsplineError("NUMBA_DISABLE_JIT is set, and the curves are computed by compiled code only: unset it")
    if any(map(can_write, places())):
        return None
    try:
        folder = str(temporary())
    except OSError as error:
        raise GlyphsplineError(f"compiled code can be kept nowhere: set {PLACE} to a folder with room") from error
    os.environ[PLACE] = folder
    sys.stderr.write(f"glyphspline: compiled code is kept in {folder}; {PLACE} chooses another place\n")
    return folder


def places() -> list[Path]:
    """Where numba looks for a place, in its order: what the user says, beside the source files, the user's caches."""
    if sys.platform == "win32":
        caches = os.environ.get("LOCALAPPDATA", "~/AppData/Local") + "/numba/Cache"
    elif sys.platform == "darwin":
        caches = "~/Library/Caches/numba"
    else:
        caches = os.environ.get("XDG_CACHE_HOME", "~/.cache") + "/numba"
    said = [Path(os.environ[PLACE])] if os.environ.get(PLACE) else []
    return [*said, Path(__file__).parent / "__pycache__", Path(os.path.expanduser(caches))]


def can_write(folder: Path) -> bool:
    """Whether files can be written to a folder, which is made if there is none. Rights alone do not tell."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True


def temporary() -> Path:
    """A folder among the temporary files that only this user can write to, the same one at each call.

    Cached code is executed, so a folder of this name that somebody else has made is not used; a new one is, which only
    this process and its children know.

    Raises:
        OSError: there is no folder for temporary files.
    """
    if not hasattr(os, "getuid"):  # Windows: temporary files are in the user's own folder
        folder = Path(tempfile.gettempdir()) / "glyphspline-compiled"
        folder.mkdir(exist_ok=True)
        return folder
    folder = Path(tempfile.gettempdir()) / f"glyphspline-{os.getuid()}-compiled"
    with suppress(FileExistsError):
        folder.mkdir(mode=0o700)
    found = folder.lstat()
    if stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & 0o077:
        return folder
    return Path(tempfile.mkdtemp(prefix=f"{folder.name}-"))
