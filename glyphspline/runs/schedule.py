"""What calls are made in: worker processes, this process, or a cluster."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from typing import Any

from ..fitting.options import Options
from .places import forget_opened
from .pool import WorkerPool
from .preload import code_for, kinds_for
from .spec import Limits


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
        forget_opened()


def workers(
    jobs: int | None,
    seconds: float = Limits.seconds,
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
