"""Chunks of glyphs for a pool of workers, any of which may be lost."""

from __future__ import annotations

import os
import sys
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from typing import Any, TypeVar

from ..fitting.options import Options
from .pool import TimeLimitError, WorkerLostError, WorkerPool
from .preload import code_for, kinds_for

LARGEST_CHUNK = 40
"""Maximum number of glyphs in a call: enough to make the exchange cheap, few enough for a smooth progress bar."""

AHEAD = 4
"""Chunks in flight for each worker, so that none waits: two in the worker, and two in the queue."""

TRIALS = 3
"""Attempts at a glyph whose worker died: the glyph need not be the cause."""

Result = TypeVar("Result")
Job = TypeVar("Job")
Task = TypeVar("Task")
"""What a call is about, a glyph of it, and what it returns."""


class InProcess(Executor):
    """An executor that makes each call at once in this process: for notebooks and for debugging."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Call the function now."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Forget the source that is open: its file may have been edited when the next one is made."""
        if worker := sys.modules.get(f"{__package__}.worker"):
            worker.forget_opened()


def workers(
    jobs: int | None,
    seconds: float,
    options: Options | None = None,
    formats: Sequence[str] = (),
    expected: int = 0,
    masters: bool = False,
    also: Sequence[str] = (),
    scheduler: str | None = None,
) -> Executor:
    """A pool of worker processes; None: one a core, 0: no processes, calls are made in this one.

    Args:
        seconds: time limit of a batch, after which its worker is killed.
        options, formats, masters: of the run; the compiled code that they need is loaded before the first call.
        expected: number of calls known to come.
        also: kinds of work of :mod:`.warm` besides.
        scheduler: address of a dask cluster, whose workers are used instead.

    Raises:
        GlyphsplineError: nothing answers at the address.
    """
    loaded = code_for([*kinds_for(options, formats, masters), *also])
    if scheduler is not None:
        from .cluster import ClusterExecutor

        return ClusterExecutor(scheduler, seconds, loaded)
    if jobs == 0:
        return InProcess()
    return WorkerPool(jobs or os.cpu_count() or 1, seconds, loaded, expected)


def pool_size(pool: Executor) -> int:
    """Number of calls that a pool runs at a time."""
    return int(getattr(pool, "_max_workers", 1))


def chunks_of(tasks: Sequence[Task], pool: Executor) -> list[Sequence[Task]]:
    """Glyphs in chunks, small enough for the workers to finish at about the same time."""
    return slices(tasks, max(1, min(LARGEST_CHUNK, len(tasks) // (8 * pool_size(pool)))))


def slices(tasks: Sequence[Task], size: int) -> list[Sequence[Task]]:
    """Glyphs in chunks of a size."""
    return [tasks[start : start + size] for start in range(0, len(tasks), size)]


def spread(
    pool: Executor, function: Callable[[Job, Sequence[Task]], Result], job: Job, chunks: Iterable[Sequence[Task]]
) -> Iterator[tuple[Sequence[Task], Result | WorkerLostError | TimeLimitError]]:
    """Call a function on chunks of glyphs; yield each chunk with its result as it completes.

    Only a few chunks are in flight at a time. ``chunks`` may yield an empty one while others are in flight: none is
    to be begun now, and it is asked again when one completes. If a worker is lost or killed, the glyphs of its chunk
    are tried one by one, so that only the glyph that causes it fails.
    """
    again: deque[tuple[Sequence[Task], int]] = deque()
    fresh = ((chunk, 1) for chunk in chunks)
    pending: dict[Future[Result], tuple[Sequence[Task], int]] = {}
    try:
        while True:
            while len(pending) < AHEAD * pool_size(pool):
                chunk, trial = again.popleft() if again else next(fresh, ((), 0))
                if not chunk:
                    break
                pending[pool.submit(function, job, chunk)] = chunk, trial
            if not pending:
                return
            wait(pending, return_when=FIRST_COMPLETED)
            for future in [future for future in pending if future.done()]:
                chunk, trial = pending.pop(future)
                try:
                    result: Result | WorkerLostError | TimeLimitError = future.result()
                except (WorkerLostError, TimeLimitError) as error:
                    if len(chunk) > 1 or (isinstance(error, WorkerLostError) and trial < TRIALS):
                        again.extend(([task], trial + 1) for task in chunk)
                        continue
                    result = error
                yield chunk, result
    finally:
        for future in pending:
            future.cancel()
