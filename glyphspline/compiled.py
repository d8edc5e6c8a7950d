"""Compiled functions: Python functions first, and machine code where there is some.

Each call from Python asks for itself: where :mod:`.code_files` has code of the function and of the types of the
arguments, that runs, with all compiled functions below it; or else the function runs as Python, and its calls of others
ask for themselves. Nothing is compiled but by :func:`.runs.warm.warm`, which a run calls where it pays. Numba is not
imported before there is code, or some is to be made: see :mod:`.compiling`.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from functools import cached_property, update_wrapper
from typing import Any, TypeVar

import numpy as np

from .code_files import NoCodeError, is_off, kept, tell, why_not_shipped

Function = TypeVar("Function", bound=Callable[..., Any])

PATIENCE = 10.0
"""Seconds of plain Python in a process after which it says what compiling would bring."""


class Compiled:
    """A function that runs as machine code where that is kept, and as Python otherwise, with the same result.

    Machine code releases the interpreter's lock while it runs. Division by zero gives an infinity or NaN, as in NumPy,
    whose warnings are off while Python runs. No ``fastmath``: fused or reassociated operations depend on what is
    inlined, which differs between code just compiled and code out of a file. The last bits of a result would differ
    too, and at a threshold the result itself.

    Code for callers in Python is made apart from code for compiled callers. With an entry for Python in every function,
    each caller would optimise the entries of all functions below it once more.

    Attributes:
        py_func: the Python function.
        plain: what runs in its place where there is no code: itself, or its form in NumPy, see :func:`in_numpy`.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        update_wrapper(self, function)
        self.py_func = self.plain = function
        self._edition, self._code, self._lacks = -1, None, False
        everything.append(self)

    def __call__(self, *arguments: Any) -> Any:
        """Call the code for the types of the arguments, or the Python function."""
        if self._edition != kept.edition:
            self._choose()
        if self._code is not None and not (self._lacks and _thread.is_plain):
            try:
                return self._code(*arguments)
            except NoCodeError:  # learning it takes longer than some functions do
                self._lacks = True
        if _thread.is_plain:
            return self.plain(*arguments)
        return self._run_plain(arguments)

    def _choose(self) -> None:
        """Take machine code for callers in Python, if there is any."""
        self._edition, self._lacks = kept.edition, False  # first: what changes meanwhile is asked for again
        self._code = self.entry if kept.has(self.py_func, "entry") else None

    def _run_plain(self, arguments: tuple[Any, ...]) -> Any:
        """Run as Python, called from outside of all compiled functions."""
        if kept.look_again():
            return self(*arguments)
        started = time.perf_counter()
        _thread.is_plain = True
        try:
            with np.errstate(all="ignore"):
                return self.plain(*arguments)
        finally:
            _thread.is_plain = False
            spend(time.perf_counter() - started)

    @cached_property
    def entry(self) -> Any:
        """Numba's dispatcher for callers in Python."""
        from .compiling import dispatcher

        return dispatcher(self.py_func, "entry")

    @cached_property
    def inner(self) -> Any:
        """Numba's dispatcher for compiled callers."""
        from .compiling import dispatcher

        return dispatcher(self.py_func, "inner", no_cpython_wrapper=True)

    @property
    def _numba_type_(self) -> Any:
        """What Numba takes the function for."""
        from .compiling import Callee

        return Callee(self.inner)

    def __reduce__(self) -> str:
        return self.py_func.__qualname__


class Callback:
    """A function of fixed types for C libraries.

    Args:
        signature: its types, as Numba reads them from a string.
    """

    def __init__(self, function: Callable[..., Any], signature: str) -> None:
        self.__module__, self.__doc__ = function.__module__, function.__doc__
        self.py_func, self._signature = function, signature
        self._edition, self._address = -1, None

    @property
    def address(self) -> int | None:
        """Of the machine code; None: there is none."""
        if self._edition != kept.edition:
            self._edition = kept.edition
            self._address = self._code.address if kept.has(self.py_func, "callback") else None
        return self._address

    @cached_property
    def _code(self) -> Any:
        from .compiling import callback_of

        return callback_of(self.py_func, self._signature)


class _Thread(threading.local):
    """Of each thread: whether it is inside of a compiled function that runs as Python."""

    is_plain = False


_thread = _Thread()

everything: list[Compiled] = []
"""The compiled functions of the modules that are imported."""


def compiled(function: Function) -> Function:
    """Mark a function of scalars, arrays and named tuples of them that can be compiled: see :class:`Compiled`."""
    return Compiled(function)  # type: ignore[return-value]


def in_numpy(of: Function) -> Callable[[Function], Function]:
    """A decorator for the form in NumPy of a compiled function, which gives the same bits: it runs as plain Python.

    In the name's place comes the compiled function.
    """

    def mark(function: Function) -> Function:
        form: Any = of
        form.plain = function
        return of

    return mark


def inlined(function: Function) -> Function:
    """A function whose body takes the place of each call before types are inferred.

    It is for helpers of SIMD loops, as LLVM inlines too late for some loops to become SIMD; and for a few lines that
    have few callers, which need no machine code, and no file, of their own. The body is typed again for every call.
    """
    marked: Any = function
    marked.py_func, marked.targetoptions = function, {"inline": "always"}  # where Numba looks for them
    return function


def callback(signature: str) -> Callable[[Callable[..., Any]], Callback]:
    """A decorator for functions of fixed types that C libraries call: see :class:`Callback`."""
    return lambda function: Callback(function, signature)


_spent = 0.0


def spend(seconds: float) -> None:
    """Count time in which plain Python has run; after a while say in one line what compiling would bring."""
    global _spent
    before, _spent = _spent, _spent + seconds
    if before < PATIENCE and (words := hint()):
        tell("%s", words)


def hint() -> str:
    """What compiling would bring, once this process has run as plain Python for a while; empty until then."""
    if _spent < PATIENCE or is_off():
        return ""
    compiler = sys.modules.get(f"{__package__}.compiling")
    why = why_not_shipped(compiler and compiler.target()) or "its sources are not those of the wheel's code"
    return f"running as plain Python ({why}): `glyphspline warm` compiles once, in minutes, and makes this 100x as fast"
