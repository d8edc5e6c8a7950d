"""Compiling: all code of some kinds of work, in several processes; and loading it before a worker's time is limited."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from contextlib import suppress
from functools import cache
from hashlib import blake2b
from math import inf
from pathlib import Path

from ..code_files import PACKAGE, SUFFIX, kept, numba_version, own_folder, why_not_shipped
from ..compiled import tell
from ..files import write_whole

SAYING = 15.0
"""Seconds between two lines about what is compiled."""


def is_ready(kinds: Iterable[str]) -> bool:
    """Whether all code of some kinds of work is there: the wheel's, or some compiled here."""
    return not why_not_shipped() or all(map(_is_marked, kinds))


def warm(jobs: int | None = None, kinds: Sequence[str] | None = None) -> None:
    """Compile every function that is not kept yet, in several processes; this one uses the code from then on.

    A line every few seconds says how far it is.

    Args:
        jobs: processes; None takes all cores.
        kinds: of work that comes; None: all.

    Raises:
        GlyphsplineError: a process died.
    """
    from .pool import WorkerPool
    from .small_runs import WORK

    left = [kind for kind in WORK if not _is_marked(kind) and (kinds is None or kind in kinds)]
    if not left:
        return
    size, started, before = min(jobs or os.cpu_count() or 1, len(left)), time.monotonic(), _files()
    tell("compiling once, some minutes (%s); kept in %s", why_not_shipped() or "asked for", own_folder() or "no folder")
    with WorkerPool(size, inf, expected=size) as pool:
        calls = {pool.submit(compile_kind, kind) for kind in left}
        while calls:
            done, calls = wait(calls, SAYING, FIRST_COMPLETED)
            for call in done:
                call.result()
            seconds = time.monotonic() - started
            numbers = len(_files() - before), len(left) - len(calls), len(left), seconds
            tell("compiling: %d functions, %d of %d kinds of work, %.0f s", *numbers)
    kept.look_again(anew=True)


def compile_kind(kind: str) -> None:
    """Compile what is not kept of a kind of work, and mark the kind."""
    with kept.compiling():
        prepare(kind)
    if (mark := _mark(kind)) is not None:
        with suppress(OSError):
            write_whole(str(mark), b"")


@cache
def prepare(kind: str) -> None:
    """Do the small runs of a kind of work, once in a process, with what reads outlines and all modules of a worker."""
    from ..readers.opentype.bulk import load_compiled
    from . import (
        small_runs,
        worker,  # noqa: F401
    )

    load_compiled()
    small_runs.WORK[kind]()


def code_for(kinds: Iterable[str]) -> list[str]:
    """What a worker loads for kinds of work, see :func:`.pool.load`."""
    return [f"{__name__}:{kind}" for kind in kinds]


def _files() -> set[str]:
    folder = own_folder()
    return set() if folder is None else {name for name in os.listdir(folder) if name.endswith(SUFFIX)}


def _is_marked(kind: str) -> bool:
    folder = own_folder()
    if folder is None or not any(folder.glob(f"{kind}-*.kind")):
        return False
    mark = _mark(kind)
    return mark is not None and mark.exists()


def _mark(kind: str) -> Path | None:
    """The file that says that all of a kind of work is compiled, from the sources as they are."""
    folder = own_folder()
    return None if folder is None else folder / f"{kind}-{_digest()}.kind"


@cache
def _digest() -> str:
    digest = blake2b(f"{numba_version()} {sys.implementation.cache_tag}".encode(), digest_size=16)
    for file in sorted(PACKAGE.rglob("*.py")):
        digest.update(file.read_bytes())
    return digest.hexdigest()
