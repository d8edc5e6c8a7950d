"""Files of compiled code: what they are named by, where they are kept, and which are there, known without Numba.

A file is named by the function, the role of the code, a stamp of all it was made from, and the types of the arguments.
The stamp is of the source files of the function and of every compiled function below it, and of the constants that they
use: after an edit of any of these the name is another one, so that nothing ever has to be cleared.

Code comes out of the wheel if that has some for this Python and Numba, or out of the folders of :func:`places`, to one
of which new code is written.
"""

from __future__ import annotations

import json
import logging
import os
import stat
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from hashlib import blake2b
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

PACKAGE = Path(__file__).parent

SHIPPED = PACKAGE / "_compiled"
"""The compiled code of a platform wheel, never written to; ``made_for.json`` in it says what the code runs on."""

PLACE = "NUMBA_CACHE_DIR"
"""Environment variable: the folder for code compiled here."""

OFF = "NUMBA_DISABLE_JIT"
"""Environment variable, Numba's own switch: 1 has everything run as Python, for debuggers and coverage."""

QUIET = "GLYPHSPLINE_QUIET"
"""Environment variable: set to hide what is said about compiling."""

SUFFIX = ".nbc"

OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
"""What Numba is asked for; part of the stamp."""

MAKERS = ("intrinsics.py", "linking.py", "llvm.py")
"""Files of the package that are part of all code."""


class NoCodeError(Exception):
    """There is no code for these types of arguments, and nothing is compiled in this process."""


class Kept:
    """Which code there is.

    Attributes:
        edition: grows whenever an answer may have changed.
        is_compiling: whether what is not there is compiled.
        asked: functions whose code was asked for since that began.
    """

    def __init__(self) -> None:
        self.edition = 0
        self.is_compiling = False
        self.asked: set[Callable[..., Any]] = set()
        self._names: frozenset[str] = frozenset()
        self._folders: list[Path] = []
        self._dates: list[int] | None = None

    def has(self, function: Callable[..., Any], role: str) -> bool:
        """Whether there is code of a function, for some types of arguments, or some is to be compiled."""
        if self.is_compiling:
            self.asked.add(function)
            return True
        if self._dates is None:
            self.look_again()
        name = f"{title_of(function)}.{role}"
        # Stamps are not computed for nothing: they take reading the sources.
        return name in self._names and f"{name}-{stamp(function)}" in self._names

    def look_again(self, anew: bool = False) -> bool:
        """List the folders again if one has changed since, or ``anew``; whether they were."""
        if anew or self._dates is None:
            self._folders = [] if is_off() else [*places(), *([] if why_not_shipped() else [SHIPPED])]
        dates = [_date(folder) for folder in self._folders]
        if dates == self._dates and not anew:
            return False
        files = [name.rpartition("-")[0] for folder in self._folders for name in names_in(folder, SUFFIX)]
        self._dates, self._names = dates, frozenset([*files, *(name.rpartition("-")[0] for name in files)])
        self.edition += 1
        return True

    @contextmanager
    def compiling(self) -> Iterator[None]:
        """Compile from now on what is called and not there, in all threads of this process."""
        before, self.is_compiling, self.asked = self.is_compiling, not is_off(), set()
        self.edition += 1
        try:
            yield
        finally:
            self.is_compiling = before
            self.edition += 1


def is_off() -> bool:
    """Whether nothing compiled is to run."""
    return os.environ.get(OFF, "0") not in ("", "0")


def _date(folder: Path) -> int:
    """When a folder has changed; 0: it is not there."""
    try:
        return os.stat(folder).st_mtime_ns
    except OSError:
        return 0


def title_of(function: Callable[..., Any]) -> str:
    """What names of a function's files begin with."""
    return f"{function.__module__.removeprefix(f'{__package__}.')}.{function.__qualname__}"


@cache
def made_for() -> dict[str, Any]:
    """What the wheel's code runs on: ``numba`` and ``python``, ``target`` and ``features`` of the processor."""
    try:
        found: dict[str, Any] = json.loads((SHIPPED / "made_for.json").read_text())
    except OSError:
        return {}
    return found


@cache
def numba_version() -> str:
    """The version of Numba, which is not imported for it."""
    from importlib.metadata import version

    return version("numba")


@cache
def why_not_shipped(target: tuple[str, str, str] | None = None) -> str:
    """Why this process cannot use the wheel's code, on a target (triple, processor, its features) if that is known.

    Empty if it can.
    """
    known = made_for()
    if not known:
        return "this copy of glyphspline has no compiled code"
    if known["numba"] != numba_version():
        return f"the wheel's code is for numba {known['numba']}, and this is numba {numba_version()}"
    features = [] if target is None else target[2].split(",")
    lacking = [name for name in known["features"] if target and f"+{name}" not in features]
    if known["python"] != sys.implementation.cache_tag or (target and known["target"][0] != target[0]) or lacking:
        return "the wheel's code is for another processor" + (f", with {', '.join(lacking)}" if lacking else "")
    return ""


def places() -> list[Path]:
    """Folders for code compiled here: the user's choice alone, or else beside the source files, or among the user's
    caches, or a folder among the temporary files."""
    if os.environ.get(PLACE):
        return [Path(os.environ[PLACE])]
    from platformdirs import user_cache_dir

    return [PACKAGE / "__pycache__" / "compiled", Path(user_cache_dir("glyphspline", appauthor=False)), _temporary()]


@cache
def own_folder() -> Path | None:
    """The first of the places that can be written to; None: there is none.

    One among the temporary files is known to processes started from now on: it is a new one where others can write.
    """
    import tempfile

    for folder in places():
        with suppress(OSError):  # trying is the only way to know: rights alone do not tell
            if folder == _temporary():
                folder = temporary_folder()
                os.environ[PLACE] = str(folder)
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
            return folder
    return None


def temporary_folder() -> Path:
    """A folder among the temporary files that only this user can write to, the same one at each call.

    Code in it is executed, so a folder of this name that somebody else has made is not used; a new one is, which only
    this process and its children know.

    Raises:
        OSError: there is no folder for temporary files.
    """
    import tempfile

    folder = _temporary()
    with suppress(FileExistsError):
        folder.mkdir(mode=0o700)
    return folder if is_trusted(folder) else Path(tempfile.mkdtemp(prefix=f"{folder.name}-"))


def is_trusted(folder: Path) -> bool:
    """Whether code in one of the places can be executed: among the temporary files anybody can make a folder."""
    if folder != _temporary() or not hasattr(os, "getuid"):  # on Windows temporary files are in the user's own folder
        return True
    with suppress(OSError):
        found = folder.lstat()
        return stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & 0o077
    return False


def _temporary() -> Path:
    import tempfile

    user = f"-{os.getuid()}" if hasattr(os, "getuid") else ""
    return Path(tempfile.gettempdir()) / f"glyphspline{user}-compiled"


def names_in(folder: Path, suffix: str) -> list[str]:
    """The files in one of the places, or in the wheel's, whose names end so; none if there is no such folder."""
    with suppress(OSError):
        return [name for name in os.listdir(folder) if name.endswith(suffix)] if is_trusted(folder) else []
    return []


@cache
def stamp(function: Callable[..., Any]) -> str:
    """A hash of what a function's code is made from: source files, constants out of other files, Python and Numba."""
    import numpy as np

    kinds, constants = (bool, int, float, str, bytes, tuple, np.generic, np.ndarray), set()
    for one in below(function):
        for name, value in globals_of(one):
            if isinstance(value, kinds):
                constants.add((name, value.tobytes() if isinstance(value, np.ndarray) else repr(value).encode()))
    made_by = OPTIONS, sys.implementation.cache_tag, numba_version()
    words = repr((made_by, sorted(map(digest, sources_of(function))), sorted(constants)))
    return blake2b(words.encode(), digest_size=8).hexdigest()


@cache
def sources_of(function: Callable[..., Any]) -> frozenset[str]:
    """The source files that a function's code is made from: its own, and those of what it calls."""
    files = {str(PACKAGE / name) for name in MAKERS}
    for one in below(function):
        files.add(one.__code__.co_filename)
        modules = {str(getattr(value, "__module__", "")) for _, value in globals_of(one)}  # of named tuples too
        files |= {str(sys.modules[name].__file__) for name in modules if name.startswith(f"{__package__}.")}
    return frozenset(files)


@cache
def below(function: Callable[..., Any]) -> frozenset[Callable[..., Any]]:
    """A function and all compiled functions that it calls, directly or not: their code is part of its own."""
    found, left = set(), [function]
    while left:
        one = left.pop()
        if one not in found:
            found.add(one)
            left += [value.py_func for _, value in globals_of(one) if hasattr(value, "py_func")]
    return frozenset(found)


def globals_of(function: Any) -> Iterator[tuple[str, Any]]:
    """Names and values of what a function's code refers to outside of it."""
    names = set(_names(function.__code__))
    cells = (cell.cell_contents for cell in function.__closure__ or ())
    values = dict(zip(function.__code__.co_freevars, cells, strict=True))
    values |= {name: function.__globals__[name] for name in names & function.__globals__.keys()}
    for name, value in values.items():
        yield name, value
        if isinstance(value, ModuleType) and value.__name__.startswith(f"{__package__}."):
            yield from ((member, getattr(value, member)) for member in names & vars(value).keys())


def _names(code: CodeType) -> Iterator[str]:
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _names(constant)


@cache
def digest(file: str) -> str:
    """A hash of a file."""
    return blake2b(Path(file).read_bytes(), digest_size=16).hexdigest()


def tell(words: str, *values: Any) -> None:
    """Say something about compiling, unless nobody wants to know."""
    if not os.environ.get(QUIET):
        logging.getLogger(__package__).warning(words, *values)


kept = Kept()
"""The compiled code that this process finds."""
