"""Compiles everything there is, in several processes, so that no later command has to."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from concurrent.futures import wait
from importlib import import_module
from math import inf
from pathlib import Path

from .pool import WorkerPool
from .warm import EVERYTHING, module_names

OFTEN = 0.2
"""Seconds between looks at what the processes have written."""


def precompile(jobs: int | None = None, observer: Callable[[int, int], None] | None = None) -> int:
    """Compile every function that is not in the cache; returns how many there are in all.

    Args:
        jobs: processes; None takes all cores.
        observer: called with the number of functions that are ready and of all, now and then and at the end.

    Raises:
        GlyphsplineError: a process died.
    """
    with tempfile.TemporaryDirectory(prefix="glyphspline-") as folder:
        log = Path(folder) / "functions"
        log.touch()
        size = min(jobs or os.cpu_count() or 1, len(EVERYTHING))
        with WorkerPool(size, inf, expected=size) as pool:
            left = {pool.submit(compile_for, name, str(log)) for name in module_names(EVERYTHING)}
            while left:
                done, left = wait(left, OFTEN)
                for call in done:
                    call.result()
                lines = set(log.read_text(encoding="utf-8").splitlines())
                if observer:
                    observer(sum(line.startswith("+") for line in lines), sum(line.startswith("?") for line in lines))
    return sum(line.startswith("?") for line in lines)


def compile_for(name: str, log: str) -> None:
    """Import a module of :mod:`.warm`, and write to a file a line for each function that is known (?) or ready (+)."""
    from .. import compiling
    from . import worker  # noqa: F401

    with open(log, "a", encoding="utf-8") as file:
        said: set[str] = set()

        def write() -> None:
            found = compiling.functions()
            lines = {f"?{function}\n" for function in found} | {
                f"+{function}\n" for function in found if found[function]
            }
            file.write("".join(lines - said))
            file.flush()
            said.update(lines)

        with compiling.heard(write):
            import_module(name)
        write()
