"""What is being compiled at the moment, for those who wait for it: functions out of the cache are not counted.

The command line says in its environment (:data:`.cache.TELLS`) whether its processes tell on standard error.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any, NamedTuple

from numba.core import event

from .cache import TELLS

ALTERNATIVES = frozenset({"glyphspline.fitting.sharp", "glyphspline.fitting.smooth"})
"""Folders of which most commands need only one: their functions count once one of them is compiled or loaded."""

ENOUGH = 0.02
"""Share of the work that has to be done until there is a guess of the time for the rest."""

FIRST_AGAIN = 10.0
"""Seconds until a process that does not write to a terminal tells again; each time the wait doubles."""


class Progress(NamedTuple):
    """How many functions are ready, of those likely to be needed (0: not known yet); a guess of the seconds left."""

    ready: int
    total: int
    seconds: float | None

    def __str__(self) -> str:
        rest = "" if self.seconds is None else f", about {max(round(self.seconds, -1), 5):.0f} s"
        if not self.total:
            return "compiling once"
        return f"compiling once: {self.ready} of {self.total}{rest}"


class _Watch(event.Listener):  # type: ignore[misc, unused-ignore]
    """Hears of every function that numba compiles. One thread compiles at a time."""

    def __init__(self) -> None:
        self.functions: list[Any] = []
        self.open: list[Any] = []
        self.since = self.seconds = self.done = 0.0
        self.hear: Callable[[], None] | None = None
        self.width = 0
        self.next = 0.0

    def on_start(self, event: Any) -> None:
        if not self.open:
            self.since = time.monotonic()
        self.open.append(event.data["dispatcher"])
        self.tell()

    def on_end(self, event: Any) -> None:
        self.done += effort(self.open.pop())
        if not self.open:
            self.seconds += time.monotonic() - self.since
        self.tell()
        if self.hear:
            self.hear()

    def progress(self) -> Progress | None:
        opened = list(self.open)  # another thread may ask
        if not opened:
            return None
        done = ready()
        begun = {folder(function) for function in (*done, *opened)}
        unused = ALTERNATIVES - begun
        used = {function for function in self.functions if folder(function) not in unused}
        left = sum(map(effort, used - done))
        elapsed = self.seconds + time.monotonic() - self.since
        if opened[0] not in self.functions:  # compiled as its module is imported: not all functions are known yet
            return Progress(0, 0, None)
        return Progress(len(used & done), len(used), elapsed * left / self.done if self.done > ENOUGH * left else None)

    def tell(self) -> None:
        """Renew the line on a terminal, or write one if it is time."""
        how = os.environ.get(TELLS)
        if not how:
            return
        progress = self.progress()
        if how == "line" and sys.stderr.isatty():
            said = "" if progress is None else str(progress)
            sys.stderr.write("\r" + said.ljust(self.width) + "\r")
            self.width = len(said)
        elif progress is not None and self.seconds + time.monotonic() - self.since >= self.next:
            self.next = 2 * self.next or FIRST_AGAIN
            said = str(progress)
            if how == "json":
                said = json.dumps({"compiling": progress.ready, "of": progress.total, "seconds": progress.seconds})
            sys.stderr.write(f"{said}\n")
        sys.stderr.flush()


def folder(function: Any) -> str:
    """The folder of a function's file."""
    return str(function.py_func.__module__).rpartition(".")[0]


@cache
def below(function: Any) -> frozenset[Any]:
    """The function and all compiled functions that it calls, directly or not. Their code is part of its own."""
    found, left = set(), [function]
    while left:
        python = getattr(one := left.pop(), "py_func", None)
        if python is not None and one not in found:
            found.add(one)
            left += [value for name in python.__code__.co_names if callable(value := python.__globals__.get(name))]
    return frozenset(found)


@cache
def effort(function: Any) -> int:
    """The length of a function with all below it, which is optimised again in it: the time to compile goes with it."""
    return sum(len(one.py_func.__code__.co_code) for one in below(function))


def ready() -> set[Any]:
    """The functions that are compiled or out of the cache, by themselves or as parts of others."""
    return set().union(*(below(function) for function in _watch.functions if function.overloads))


_watch = _Watch()
event.register("numba:compile", _watch)


def watched(function: Any) -> Any:
    """The function, which is counted from now on."""
    _watch.functions.append(function)
    return function


def progress() -> Progress | None:
    """What is being compiled now in this process; None if nothing is."""
    return _watch.progress()


@contextmanager
def heard(function: Callable[[], None]) -> Iterator[None]:
    """Meanwhile call a function whenever another one is compiled."""
    _watch.hear = function
    try:
        yield
    finally:
        _watch.hear = None


def functions() -> dict[str, bool]:
    """The functions of the modules imported so far, by name, and whether they are ready."""
    done = ready()
    return {f"{f.py_func.__module__}.{f.py_func.__qualname__}": f in done for f in _watch.functions}
