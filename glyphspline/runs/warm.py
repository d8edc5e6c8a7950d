"""Compiling: all code of some kinds of work, in several processes; and loading it before a worker's time is limited.

A file beside the code, named by the kind, says that all of its code is there. It lists the sources that were compiled,
so that neither they nor Numba have to be imported to know.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from contextlib import suppress
from functools import cache
from hashlib import blake2b
from importlib import import_module
from math import inf
from pathlib import Path

from .. import code_files
from ..code_files import PACKAGE, SHIPPED, SUFFIX, kept, own_folder, tell, why_not_shipped
from ..files import write_whole

SAYING = 15.0
"""Seconds between two lines about what is compiled."""

MARK = ".kind"


def is_ready(kinds: Iterable[str]) -> bool:
    """Whether all code of some kinds of work is there: the wheel's, or some compiled here."""
    if code_files.is_off():
        return False
    folders = [*code_files.places(), *([] if why_not_shipped() else [SHIPPED])]
    names = [folder / name for folder in folders for name in code_files.names_in(folder, MARK)]
    return all(any(_holds(name) for name in names if name.name.rpartition("-")[0] == kind) for kind in kinds)


def warm(jobs: int | None = None, kinds: Sequence[str] | None = None) -> None:
    """Compile every function that is not kept yet, in several processes; this one uses the code from then on.

    A line every few seconds says how far it is.

    Args:
        jobs: processes; None takes all cores.
        kinds: of work that comes, see :func:`.small_runs.work`; None: all.

    Raises:
        GlyphsplineError: a process died.
    """
    from .pool import WorkerPool
    from .small_runs import work

    left = [kind for kind in work() if not is_ready([kind]) and (kinds is None or kind in kinds)]
    if not left:
        return
    folder, size, started = own_folder(), min(jobs or os.cpu_count() or 1, len(left)), time.monotonic()
    before = _number_in(folder)
    tell("compiling once, some minutes (%s); kept in %s", why_not_shipped() or "sources changed", folder or "no folder")
    with WorkerPool(size, inf, expected=size, with_main=False) as pool:  # a script may call this without a guard
        calls = {pool.submit(compile_kind, kind) for kind in left}
        while calls:
            done, calls = wait(calls, SAYING, FIRST_COMPLETED)
            for call in done:
                call.result()
            numbers = _number_in(folder) - before, len(left) - len(calls), len(left), time.monotonic() - started
            tell("compiling: %d functions, %d of %d kinds of work, %.0f s", *numbers)
    kept.look_again(anew=True)


def compile_kind(kind: str) -> None:
    """Compile what is not kept of a kind of work, and mark the kind."""
    from .small_runs import __file__ as own_file
    from .small_runs import work

    with kept.compiling():
        prepare(kind)
        sources = {own_file, work()[kind].__code__.co_filename}.union(*map(code_files.sources_of, kept.asked))
    if (folder := own_folder()) is None:
        return
    lines = [f"{code_files.digest(file)} {os.path.relpath(file, PACKAGE)}\n" for file in sorted(sources)]
    content = "".join([_made_by(), *lines]).encode()
    with suppress(OSError):
        write_whole(str(folder / f"{kind}-{blake2b(content, digest_size=16).hexdigest()}{MARK}"), content)


@cache
def prepare(kind: str) -> None:
    """Do the small runs of a kind of work, once in a process, with what reads outlines and all modules of a worker."""
    from ..readers.opentype.bulk import load_compiled
    from .small_runs import work

    import_module(f"{__package__}.worker")  # by its name: the engine asks this file what is compiled
    load_compiled()
    work()[kind]()


def code_for(kinds: Iterable[str]) -> list[str]:
    """What a worker loads for kinds of work, see :func:`.pool.load`."""
    return [f"{__name__}:{kind}" for kind in kinds]


def _number_in(folder: Path | None) -> int:
    return 0 if folder is None else len(code_files.names_in(folder, SUFFIX))


def _made_by() -> str:
    return f"{code_files.numba_version()} {sys.implementation.cache_tag}\n"


def _holds(mark: Path) -> bool:
    """Whether the sources are as they were when a mark was made."""
    with suppress(OSError):
        made_by, *lines = mark.read_text(encoding="utf-8").splitlines(keepends=True)
        known = map(str.split, lines)
        return made_by == _made_by() and all(code_files.digest(str(PACKAGE / file)) == own for own, file in known)
    return False
