"""Where calls are made, in worker processes, this process or a cluster; and how a process opens sources: once."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor, Future
from contextlib import AbstractContextManager, nullcontext
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..code_files import kept
from ..hooks import service
from ..types import Head
from .choice import SLOWNESS, Choice
from .pool import WorkerPool
from .spec import Limits
from .warm import code_for, compile_kind, warm

if TYPE_CHECKING:
    from ..readers import Source

Place = tuple[Path, int, tuple[tuple[str, float], ...]]
"""By which a process opens a source again: a file, a face and a location, axis tags with user-space values."""


def place_of(source: Source) -> Place:
    """Where a source is opened again."""
    return source.path.absolute(), source.face_index, tuple(source.location.items())


@lru_cache(maxsize=1)
def sources(*places: Place) -> list[Source]:
    """The sources of a job, opened once; only one job's are kept, as each may take 100 MB."""
    from ..readers.open import reopened

    return [reopened(path, face_index, dict(location)) for path, face_index, location in places]


def heads_of(source: Source, names: Iterable[str] | None = None) -> dict[str, Head]:
    """The glyphs of a source by their names, in glyph index order: those of these names, or all."""
    gids, codes = source.gids, source.unicodes
    chosen = gids if names is None else sorted(gids.keys() & {*names}, key=gids.__getitem__)
    return {name: Head(name, gids[name], codes.get(name, ())) for name in chosen}


PLAIN = ("glyphspline.runs.worker", "glyphspline.fitting.sharp.sharp_fit")
"""Modules that workers need that run as plain Python."""


class Workers(WorkerPool):
    """Worker processes whose calls run as plain Python where no code is there, unless it pays to compile.

    Time limits are for computing, not for being plain.
    """

    def __init__(self, size: int, seconds: float, kinds: Sequence[str], expected: int = 0) -> None:
        self.choice = Choice(kinds, size, self._compile)
        self._compiled_seconds = seconds
        if self.choice.is_plain:
            super().__init__(size, seconds * SLOWNESS, PLAIN, expected)
        else:
            super().__init__(size, seconds, code_for(kinds), expected)

    def _compile(self) -> None:
        """Compile what calls need, in as many processes, and start them anew."""
        warm(self.choice.processes, self.choice.kinds)
        self.renew(self._compiled_seconds, code_for(self.choice.kinds))


class InProcess(Executor):
    """An executor that makes each call at once in this process: for notebooks and for debugging."""

    def __init__(self, kinds: Sequence[str] = ()) -> None:
        self.choice = Choice(kinds, 1, self._compile)

    def _compile(self) -> None:
        """Compile what calls need, here."""
        for kind in self.choice.kinds:
            compile_kind(kind)
        kept.look_again(anew=True)

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Call the function now."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Forget the sources that are open: their files may have been edited when they are opened again."""
        sources.cache_clear()


def workers(
    jobs: int | None,
    seconds: float = Limits.seconds,
    kinds: Iterable[str] = (),
    expected: int = 0,
    *,
    count: int = 1,
    scheduler: str | None = None,
    executor: Executor | None = None,
) -> AbstractContextManager[Executor]:
    """A pool of worker processes; None: one a core, 0: no processes, calls are made in this one.

    Args:
        seconds: time limit of a batch, after which its worker is killed.
        kinds: of work, see :func:`.spec.kinds_for`; compiled code that it needs, and that is there, is loaded before
            the first call. :func:`.engine.choose_to_compile` may have it made.
        expected: number of calls known to come. count: of sources whose tasks come.
        scheduler: address of a dask cluster, whose workers are used instead.
        executor: used instead of all these; it is not closed.

    Raises:
        GlyphsplineError: nothing answers at the address.
    """
    if executor is not None:
        return nullcontext(executor)
    kinds = tuple(kinds)
    if scheduler is not None:
        found: AbstractContextManager[Executor] = service("cluster")(scheduler, seconds, kinds)
        return found
    size = jobs or os.cpu_count() or 1
    made = InProcess(kinds) if jobs == 0 else Workers(size, seconds, kinds, expected)
    made.choice.sources = count
    return made
