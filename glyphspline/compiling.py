"""The compiler behind :mod:`.compiled`: how Numba makes the code of a function, and loads and keeps its files."""

from __future__ import annotations

import pickle
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from hashlib import blake2b
from pathlib import Path
from types import FunctionType
from typing import Any

import llvmlite.binding as llvm
import numba
from numba import njit, types
from numba.core import caching
from numba.core.ccallback import CFunc
from numba.core.compiler import Compiler, CompileResult
from numba.core.registry import cpu_target
from numba.core.runtime import nrt
from numba.core.serialize import dumps
from numba.core.sigutils import normalize_signature
from numba.extending import models, register_model, typeof_impl

from . import code_files
from .code_files import OPTIONS, SHIPPED, SUFFIX, NoCodeError, kept
from .files import write_whole
from .linking import Linked, Whole
from .llvm import type_of

used: set[str] = set()
"""Names of the files of code that this process has loaded or written."""


class Callee(types.Dispatcher):  # type: ignore[misc, unused-ignore]
    """A compiled function in a call by another one: a literal argument is any value of its type.

    Numba would compile the function, and those that it hands the literal on to, once more for it.
    """

    def get_call_type(self, context: Any, args: Any, kws: Any) -> Any:
        """The types of a call."""
        args, kws = map(types.unliteral, args), {name: types.unliteral(kind) for name, kind in kws.items()}
        return super().get_call_type(context, tuple(args), kws)


register_model(Callee)(models.OpaqueModel)


@typeof_impl.register(FunctionType)
def _type_of(function: Any, context: Any) -> Any:
    """What Numba takes inlined functions for, and those that stand for instructions of LLVM."""
    if hasattr(function, "targetoptions"):
        return Callee(_inlined(function))
    return type_of(function) or typeof_impl.dispatch(object)(function, context)


@cache  # Numba keeps no dispatcher itself
def _inlined(function: Callable[..., Any]) -> Any:
    jit: Any = njit
    return jit(inline="always", error_model="numpy")(function)


def target() -> tuple[str, str, str]:
    """What code is made for here: triple, processor, its features."""
    found: tuple[str, str, str] = cpu_target.target_context.codegen().magic_tuple()
    return found


def dispatcher(function: Callable[..., Any], role: str, **options: bool) -> Any:
    """Numba's dispatcher for a function and its kept code. It compiles only while :meth:`.Kept.compiling` is open."""
    jit: Any = njit
    made = jit(**OPTIONS, **options)(function)
    made._compiler.pipeline_class = _Inner if role == "inner" else _Entry
    made._cache = _Files(function, role)
    return made


class _Linking(Compiler):  # type: ignore[misc, unused-ignore]
    """How functions are compiled, with a library of :mod:`.linking`."""

    linked_as: type[Linked | Whole]

    def __init__(self, typing: Any, target: Any, library: Any, *rest: Any) -> None:
        super().__init__(typing, target, self.linked_as(target.codegen()), *rest)


class _Inner(_Linking):
    """Functions for compiled callers."""

    linked_as = Linked


class _Entry(_Linking):
    """Functions for callers in Python."""

    linked_as = Whole


def callback_of(function: Callable[..., Any], signature: str) -> Any:
    """Numba's object for a function that C calls.

    Raises:
        NoCodeError: there is no code, and nothing is compiled.
    """
    made: Any = CFunc(function, normalize_signature(signature), locals={}, options={})
    made._cache = _Files(function, "callback")
    made.compile()
    return made


class _Files(caching.NullCache):  # type: ignore[misc, unused-ignore]
    """Numba's interface to the kept code of one function: a file for each signature."""

    def __init__(self, function: Callable[..., Any], role: str) -> None:
        self._function, self._role, self._name = function, role, f"{code_files.title_of(function)}.{role}"
        self._absent: set[tuple[Any, int]] = set()

    def load_overload(self, signature: Any, target_context: Any) -> CompileResult | None:
        """The code for a signature; None: it has to be compiled.

        Raises:
            NoCodeError: there is none, and nothing is compiled.
        """
        if not kept.is_compiling and (signature, kept.edition) in self._absent:
            raise NoCodeError
        nrt.rtsys.initialize(target_context)  # enough to run code; all that compiling needs takes a third of a second
        here = target()
        folders = [(folder, here) for folder in code_files.places() if code_files.is_trusted(folder)]
        if not code_files.why_not_shipped(here):
            folders.insert(0, (SHIPPED, tuple(code_files.made_for()["target"])))
        for folder, made in folders:
            if found := self._load(folder, self._file(signature, made), target_context):
                return found
        if kept.is_compiling:
            return None
        self._absent.add((signature, kept.edition))
        raise NoCodeError

    def _load(self, folder: Path, name: str, target_context: Any) -> CompileResult | None:
        try:
            content = (folder / name).read_bytes()
        except OSError:
            return None
        used.add(name)
        return CompileResult._rebuild(target_context, *pickle.loads(content))

    def save_overload(self, signature: Any, code: Any) -> None:
        """Keep code, and delete that of sources of long ago."""
        folder = code_files.own_folder()
        if folder is None or code.library.has_dynamic_globals:
            return
        file = folder / self._file(signature, code.codegen.magic_tuple())
        used.add(file.name)
        with suppress(OSError):
            write_whole(str(file), dumps(self._reduced(code)))
        for old in folder.glob(f"{self._name}-*{SUFFIX}"):
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
        words = [numba.__version__, sys.implementation.cache_tag, str(signature), *target]
        types = blake2b(repr(words).encode(), digest_size=16).hexdigest()
        return f"{self._name}-{code_files.stamp(self._function)}-{types}{SUFFIX}"
