"""Compiled functions: the one decorator, and where their machine code is kept.

Code comes out of the wheel if that has some for this Python, Numba and processor, or else out of a folder of this
user's, to which new code is written. A file of code is named by the function, the types of its arguments, and a stamp
of all it was made from: the source files of the function and of every compiled function below it, and the constants
that they use. After an edit of any of these the name is another one, so that nothing ever has to be cleared.

With Numba's ``NUMBA_DISABLE_JIT=1`` nothing is compiled: the functions run as Python, for debuggers and coverage.
"""

from __future__ import annotations

import ctypes
import json
import logging
import os
import pickle
import stat
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache, cached_property, update_wrapper
from hashlib import blake2b
from inspect import getfile
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any, TypeVar

import llvmlite.binding as llvm
import numba
import numpy as np
from numba import njit, types
from numba.core import caching, event
from numba.core.ccallback import CFunc
from numba.core.compiler import CompileResult
from numba.core.runtime import nrt
from numba.core.serialize import dumps
from numba.core.sigutils import normalize_signature
from numba.core.typing.ctypes_utils import to_ctypes
from numba.extending import models, register_model
from numba.misc.appdirs import user_cache_dir

from .files import write_whole

JIT = not numba.config.DISABLE_JIT  # type: ignore[attr-defined, unused-ignore]
"""Whether functions are compiled: Numba's own switch."""

Function = TypeVar("Function", bound=Callable[..., Any])

PACKAGE = Path(__file__).parent

SHIPPED = PACKAGE / "_compiled"
"""The compiled code of a platform wheel, never written to; ``made_for.json`` in it says what the code runs on."""

PLACE = "NUMBA_CACHE_DIR"
"""Environment variable: the folder for code compiled here."""

QUIET = "GLYPHSPLINE_QUIET"
"""Environment variable: set to hide the message that code is being compiled."""

OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}

CONSTANTS = (bool, int, float, str, bytes, tuple, np.generic, np.ndarray)
"""Types of the global values that are part of a function's code."""


class Compiled:
    """A function that is compiled for the types of its arguments at its first call, and kept.

    The interpreter's lock is released while it runs. Division by zero gives an infinity or NaN, as in NumPy. No
    ``fastmath``: fused or reassociated operations depend on what is inlined, which differs between code just compiled
    and code out of a file. The last bits of a result would differ too, and at a threshold the result itself.

    Code for callers in Python is made apart from code for compiled callers. With an entry for Python in every function,
    each caller would optimise the entries of all functions below it once more.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        update_wrapper(self, function)
        self.py_func = function
        everything.append(self)

    @cached_property
    def entry(self) -> Any:
        """Numba's dispatcher for callers in Python."""
        return self._dispatcher("entry")

    @cached_property
    def inner(self) -> Any:
        """Numba's dispatcher for compiled callers."""
        return self._dispatcher("inner", no_cpython_wrapper=True)

    @property
    def _numba_type_(self) -> Any:
        """What Numba takes the function for."""
        return _Callee(self.inner)

    def _dispatcher(self, role: str, **options: bool) -> Any:
        jit: Any = njit
        made = jit(**OPTIONS, **options)(self.py_func)
        made._cache = _Files(self.py_func, role)
        return made

    def __call__(self, *arguments: Any) -> Any:
        """Call the code for the types of the arguments."""
        return self.entry(*arguments)

    def __reduce__(self) -> str:
        return self.py_func.__qualname__


class _Callee(types.Dispatcher):  # type: ignore[misc, unused-ignore]
    """A compiled function in a call by another one: a literal argument is any value of its type.

    Numba would compile the function, and those that it hands the literal on to, once more for it.
    """

    def get_call_type(self, context: Any, args: Any, kws: Any) -> Any:
        """The types of a call."""
        args, kws = map(types.unliteral, args), {name: types.unliteral(kind) for name, kind in kws.items()}
        return super().get_call_type(context, tuple(args), kws)


register_model(_Callee)(models.OpaqueModel)


if not JIT:
    np.seterr(divide="ignore", invalid="ignore", over="ignore")  # as compiled code has it

used: set[str] = set()
"""Names of the files of code that this process has loaded or written."""

everything: list[Compiled] = []
"""The compiled functions of the modules that are imported."""


def compiled(function: Function) -> Function:
    """Compile a function at its first call with scalars, arrays and named tuples of them: see :class:`Compiled`."""
    return Compiled(function) if JIT else function  # type: ignore[return-value, unused-ignore]


def inlined(function: Function) -> Function:
    """A function whose body takes the place of each call before types are inferred.

    It is for helpers of SIMD loops, as LLVM inlines too late for some loops to become SIMD; and for a few lines that
    have few callers, which need no machine code, and no file, of their own. The body is typed again for every call.
    """
    decorated: Any = njit(inline="always", error_model="numpy")(function)
    return decorated  # type: ignore[no-any-return, unused-ignore]


def callback(signature: Any) -> Callable[[Callable[..., Any]], Any]:
    """A decorator for functions of fixed types that C libraries call, at their attribute ``address``."""

    def decorate(function: Callable[..., Any]) -> Any:
        made: Any
        if not JIT:
            result, *arguments = map(to_ctypes, (signature.return_type, *signature.args))
            made = ctypes.CFUNCTYPE(result, *arguments)(function)
            made.address = ctypes.cast(made, ctypes.c_void_p).value
            return made
        made = CFunc(function, normalize_signature(signature), locals={}, options={})
        made._cache = _Files(function, "callback")
        made.compile()
        return made

    return decorate


class _Files(caching.NullCache):  # type: ignore[misc, unused-ignore]
    """Numba's interface to the kept code of one function: a file for each signature."""

    def __init__(self, function: Callable[..., Any], role: str) -> None:
        module = function.__module__.removeprefix(f"{__package__}.")
        self._function, self._role, self._name = function, role, f"{module}.{function.__qualname__}.{role}"

    def load_overload(self, signature: Any, target_context: Any) -> CompileResult | None:
        """The code for a signature; None if there is none."""
        nrt.rtsys.initialize(target_context)  # enough to run code; all that compiling needs takes a third of a second
        target = target_context.codegen().magic_tuple()
        if not why_not_shipped(target):
            made_for = tuple(_made_for()["target"])
            if found := self._load(SHIPPED, self._file(signature, made_for), target_context):
                return found
        folder = own_folder()
        return self._load(folder, self._file(signature, target), target_context) if folder else None

    def _load(self, folder: Path, name: str, target_context: Any) -> CompileResult | None:
        try:
            content = (folder / name).read_bytes()
        except OSError:
            return None
        used.add(name)
        return CompileResult._rebuild(target_context, *pickle.loads(content))

    def save_overload(self, signature: Any, code: Any) -> None:
        """Keep code, and delete that of sources of long ago."""
        folder = own_folder()
        if folder is None or code.library.has_dynamic_globals:
            return
        file = folder / self._file(signature, code.codegen.magic_tuple())
        used.add(file.name)
        with suppress(OSError):
            write_whole(str(file), dumps(self._reduced(code)))
        for old in folder.glob(f"{self._name}-*.nbc"):
            with suppress(OSError):
                if old.stat().st_mtime < time.time() - 30 * 86400:  # within a month one may go back to a branch
                    old.unlink()

    def _reduced(self, code: Any) -> tuple[Any, ...]:
        """What is written of code: without all that only compiling needs, loading takes less than half the time.

        That is the intermediate code for callers, where no compiled function calls this one, environments of functions
        without Python objects in them, and the listing of types, which also names folders of this machine.
        """
        (name, kind, (machine_code, bitcode)), *facts, environments = code._reduce()
        if self._role != "inner":
            symbols = (
                code.fndesc.llvm_func_name,
                code.fndesc.llvm_cpython_wrapper_name,
                code.fndesc.llvm_cfunc_wrapper_name,
            )
            declared = "".join(f'define void @"{symbol}"() {{ unreachable }}\n' for symbol in symbols)
            bitcode = llvm.parse_assembly(declared).as_bitcode()
        facts[5] = ""
        return (name, kind, (machine_code, bitcode)), *facts, tuple(env for env in environments if env.consts)

    def _file(self, signature: Any, target: tuple[str, ...]) -> str:
        words = [numba.__version__, sys.implementation.cache_tag, str(signature), *target, stamp(self._function)]
        return f"{self._name}-{blake2b(repr(words).encode(), digest_size=16).hexdigest()}.nbc"


@cache
def why_not_shipped(target: tuple[str, str, str]) -> str:
    """Why this process cannot use the wheel's code on a target (triple, processor, its features); empty if it can."""
    made_for = _made_for()
    if not made_for:
        return "this copy of glyphspline has no compiled code"
    if made_for["numba"] != numba.__version__:
        return f"the wheel's code is for numba {made_for['numba']}, and this is numba {numba.__version__}"
    lacking = [feature for feature in made_for["features"] if f"+{feature}" not in target[2].split(",")]
    if made_for["python"] != sys.implementation.cache_tag or made_for["target"][0] != target[0] or lacking:
        return "the wheel's code is for another processor" + (f", with {', '.join(lacking)}" if lacking else "")
    return ""


@cache
def _made_for() -> dict[str, Any]:
    try:
        made_for: dict[str, Any] = json.loads((SHIPPED / "made_for.json").read_text())
    except OSError:
        return {}
    return made_for


@cache
def own_folder() -> Path | None:
    """The folder for code compiled here: the first of a few that can be written to; None: there is none.

    The user's choice, or beside the source files, or among the user's caches, or a folder among the temporary files,
    which processes started from now on use too.
    """
    chosen = [Path(os.environ[PLACE])] if os.environ.get(PLACE) else []
    for folder in (*chosen, PACKAGE / "__pycache__" / "compiled", Path(user_cache_dir("glyphspline", False))):
        with suppress(OSError):  # trying is the only way to know: rights alone do not tell
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
            return folder
    with suppress(OSError):
        folder = temporary_folder()
        os.environ[PLACE] = str(folder)
        return folder
    return None


def temporary_folder() -> Path:
    """A folder among the temporary files that only this user can write to, the same one at each call.

    Code in it is executed, so a folder of this name that somebody else has made is not used; a new one is, which only
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


@cache
def stamp(function: Callable[..., Any]) -> str:
    """A hash of what a function's code is made from: source files, and constants out of other files."""
    files, constants = set(), set()
    for one in below(function):
        files.add(getfile(one))
        for name, value in globals_of(one):
            module = str(getattr(value, "__module__", ""))
            if module.startswith(f"{__package__}."):  # named tuples, instructions of LLVM
                files.add(str(sys.modules[module].__file__))
            elif isinstance(value, CONSTANTS):
                constants.add((name, value.tobytes() if isinstance(value, np.ndarray) else repr(value).encode()))
    return blake2b(repr((OPTIONS, sorted(map(_digest, files)), sorted(constants))).encode()).hexdigest()


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
def _digest(file: str) -> bytes:
    return blake2b(Path(file).read_bytes()).digest()


class _Listener(event.Listener):  # type: ignore[misc, unused-ignore]
    """Says in one line that this process compiles, and why; counts functions."""

    def __init__(self) -> None:
        self.depth = self.count = 0
        self.observers: list[Callable[[], None]] = []

    def on_start(self, event: Any) -> None:
        if not self.count and not os.environ.get(QUIET):
            target = event.data["dispatcher"].targetctx.codegen().magic_tuple()
            why = why_not_shipped(target) or "its sources are not those of the wheel's code"
            words = "compiling once, up to two minutes (%s); kept in %s"
            logging.getLogger(__package__).warning(words, why, own_folder() or "no folder, as none can be written to")
        self.count += 1
        self._move(1)

    def on_end(self, event: Any) -> None:
        self._move(-1)

    def _move(self, step: int) -> None:
        self.depth += step
        for observer in self.observers:
            observer()


_listener = _Listener()
event.register("numba:compile", _listener)


def observe(observer: Callable[[], None]) -> None:
    """Call a function from now on whenever the compilation of another one begins or ends in this process."""
    _listener.observers.append(observer)


def progress() -> str:
    """What this process compiles at the moment, in words; empty if nothing."""
    return f"compiling once: {_listener.count} functions so far" if _listener.depth else ""
