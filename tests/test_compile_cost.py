"""What compiling costs: the arrays that compiled functions take, and the time that each of them needs."""

from __future__ import annotations

import importlib
import os
import pkgutil
import subprocess
import sys
import types
import typing
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import glyphspline
from glyphspline.compiled import everything

MOST_ARRAYS = 25
"""Arrays that a compiled function takes, those in nested tuples too: each is seven numbers and more to LLVM, which
passes all of them one by one."""

MOST_SECONDS = 5.0
"""Processor time of compiling one function, without what it calls, where ten million turns of ``s += i`` take 1.1 s."""


def arrays_in(kind: Any) -> int:
    """The arrays in an argument, by its annotation."""
    origin, parts = typing.get_origin(kind), typing.get_args(kind)
    if np.ndarray in (kind, origin):
        return 1
    if isinstance(kind, type) and hasattr(kind, "_fields"):
        return sum(map(arrays_in, hints(kind).values()))
    if origin is tuple:
        assert parts[-1] is not Ellipsis or not arrays_in(parts[0]), f"{kind} does not say how many"
        return sum(map(arrays_in, parts))
    if origin in (typing.Union, types.UnionType):
        return max(map(arrays_in, parts))
    return 0


def hints(of: Any) -> dict[str, Any]:
    """Annotations of a function or a class."""
    names = vars(sys.modules[of.__module__]) | {"np": np, "NDArray": NDArray}
    return {name: kind for name, kind in typing.get_type_hints(of, names).items() if name != "return"}


def test_compiled_functions_take_few_arrays() -> None:
    for module in pkgutil.walk_packages(glyphspline.__path__, "glyphspline."):
        if "__main__" not in module.name:
            importlib.import_module(module.name)
    counts = {}
    for one in everything:
        function = one.py_func
        own, name = hints(function), f"{function.__module__}.{function.__qualname__}"
        assert len(own) == function.__code__.co_argcount, name
        counts[name] = sum(map(arrays_in, own.values()))
    assert len(counts) > 200
    assert counts["glyphspline.fitting.sharp.stretches.simplest"] == 3
    assert not {name for name, count in counts.items() if count > MOST_ARRAYS}


EVENTS = """
import time
from numba.core import event
from glyphspline.runs.small_runs import work
from glyphspline.runs.warm import compile_kind

class Times(event.Listener):
    def __init__(self):
        self.open, self.own = [], {}
    def on_start(self, event):
        self.open.append([time.process_time(), 0.0])
    def on_end(self, event):
        began, below = self.open.pop()
        whole, function = time.process_time() - began, event.data["dispatcher"].py_func
        name = f"{function.__module__}.{function.__qualname__}".replace(" ", "")
        self.own[name] = max(self.own.get(name, 0.0), whole - below)
        if self.open:
            self.open[-1][1] += whole

def turns():
    began = time.process_time()
    exec("for i in range(10_000_000): s += i", {"s": 0})  # as in a script: in a function it takes a third of that
    return time.process_time() - began

times, units = Times(), [turns()]
event.register("numba:compile", times)
for kind in work():
    compile_kind(kind)
    units.append(turns())
print(sorted(units)[len(units) // 2])
for name, seconds in sorted(times.own.items(), key=lambda one: -one[1]):
    print(f"{seconds:.2f} {name}")
"""
"""A program that compiles everything, and prints the processor time of ten million turns of ``s += i``, and of each
function, the longest first."""


@pytest.mark.long
def test_no_function_compiles_for_long(tmp_path: Path) -> None:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    found = subprocess.run(
        [sys.executable, "-c", EVENTS], env=environment, cwd=Path(glyphspline.__file__).parents[1],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    sys.stdout.write(found.stdout)
    unit, *lines = found.stdout.splitlines()
    times = [line.split() for line in lines]
    assert len(times) > 250
    slowness = float(unit) / 1.1
    assert not [name for seconds, name in times if float(seconds) > slowness * MOST_SECONDS]
