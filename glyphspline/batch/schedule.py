"""Work for many glyphs handed out in chunks, to workers that may be lost on the way."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from typing import TYPE_CHECKING, Any, TypeVar

from ..fitting.options import Options
from .pool import TimeLimitError, WorkerLostError, WorkerPool
from .warm import modules_for

if TYPE_CHECKING:
    from .job import Job, Task

LARGEST_CHUNK = 40
"""Glyphs handed to a worker at once: enough to make the exchange cheap, few enough for a smooth progress bar."""

AHEAD = 4
"""Chunks in flight for each worker, so that none waits for the next: two that it has, and two to come."""

TRIALS = 3
"""How often a glyph is tried whose worker died: a worker may be killed for no fault of the glyph's."""

Result = TypeVar("Result")


class InProcess(Executor):
    """An executor that does everything at once, here: for notebooks, and for looking into a glyph's failure."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Call the function now."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


def workers(
    jobs: int | None, seconds: float, options: Options | None = None, formats: Sequence[str] = (), expected: int = 0
) -> Executor:
    """As many worker processes as asked for; None: one a core, 0: everything is done in this process.

    Args:
        seconds: what a glyph may take before its worker is killed.
        options, formats: what glyphs will be converted with and to, so that the code for it is loaded, or compiled,
            beforehand.
        expected: how many calls are sure to come.
    """
    if jobs == 0:
        return InProcess()
    return WorkerPool(jobs or os.cpu_count() or 1, seconds, modules_for(options, formats), expected)


def pool_size(pool: Executor) -> int:
    """How many calls a pool runs at a time."""
    return int(getattr(pool, "_max_workers", 1))


def chunks_of(tasks: Sequence[Task], pool: Executor) -> list[Sequence[Task]]:
    """Glyphs in chunks, so many that the workers finish at about the same time."""
    return slices(tasks, max(1, min(LARGEST_CHUNK, len(tasks) // (8 * pool_size(pool)))))


def slices(tasks: Sequence[Task], size: int) -> list[Sequence[Task]]:
    """Glyphs in chunks of a size."""
    return [tasks[start : start + size] for start in range(0, len(tasks), size)]


def spread(
    pool: Executor, function: Callable[[Job, Sequence[Task]], Result], job: Job, chunks: Iterable[Sequence[Task]]
) -> Iterator[tuple[Sequence[Task], Result | WorkerLostError | TimeLimitError]]:
    """Call a function on chunks of glyphs: each chunk with its result, in the order in which they get done.

    Only a few chunks are under way at a time. Of a chunk whose worker was lost or killed each glyph is tried on its
    own, so that in the end only the one to blame comes with an error.
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
