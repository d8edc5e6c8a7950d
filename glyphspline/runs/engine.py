"""The one engine for runs over glyphs: a job says what is done with tasks, the engine does it in a pool of workers.

A worker reads a chunk of tasks and does them batch by batch. After an unexpected error it does those of the batch one
by one, so that only the task at fault fails. If a worker is lost or killed, the tasks of its chunk are tried one by one
too. Results do not depend on the number of workers, nor on chunks and batches.

This module is imported before the compiled code: jobs import what they need within their methods, in the worker.
"""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from contextlib import suppress
from dataclasses import dataclass
from itertools import chain
from typing import Any, ClassVar, Generic, NamedTuple, TypeVar

from ..compiled import spend
from ..errors import GlyphsplineError, OutputError
from .choice import SAMPLE, choice_of, is_plain
from .pool import TimeLimitError, WorkerLostError, WorkerPool, pool_size, sign_of_life

AHEAD = 4
"""Chunks in flight for each worker, so that none waits while results are taken."""

Task = TypeVar("Task")
Result = TypeVar("Result")

Observer = Callable[[int, int, int], None]
"""Called with the number of tasks done, of all tasks, and of those that failed."""


class Item(NamedTuple):
    """A task that has been read.

    Attributes:
        content: what :meth:`Job.together` takes. cost: its part of a batch's budget: segments and vertices.
        kind: items of one batch have the same.
    """

    content: Any
    cost: float = 1.0
    kind: Hashable = None


@dataclass(frozen=True)
class Part(Generic[Task, Result]):
    """Tasks that were done together: ``failed`` of them failed; ``seconds`` is what they took without reading."""

    tasks: Sequence[Task]
    result: Result
    seconds: float = 0.0
    failed: int = 0


class Job(ABC, Generic[Task, Result]):
    """What a run does with its tasks: a frozen dataclass of what a worker needs to know, pickled for each call.

    Attributes:
        chunk: maximum number of tasks in a call: enough to make the exchange cheap, few enough for a smooth progress
            bar. budget: maximum cost of a batch. A worker's time limit and memory are for one batch.
        chooses: whether its tasks decide if a run compiles first.
    """

    chunk: ClassVar[int] = 40
    budget: ClassVar[float] = float("inf")
    chooses: ClassVar[bool] = True

    def read(self, tasks: Sequence[Task]) -> Sequence[Item | Exception]:
        """Read tasks, in a worker: an item for each, or why it cannot be read."""
        found: list[Item | Exception] = []
        for task in tasks:
            try:
                found.append(self.item(task))
            except Exception as error:  # broken data raises anything
                found.append(error)
        return found

    def item(self, task: Task) -> Item | Exception:
        """Read a task, if each is read by itself."""
        return Item(task)

    @abstractmethod
    def together(self, tasks: Sequence[Task], contents: Sequence[Any]) -> Result:
        """Do a batch of tasks, in a worker.

        Raises:
            OutputError: the output folder cannot be written to; every other task would fail too.
        """

    @abstractmethod
    def failed(self, task: Task, error: Exception) -> Result:
        """The result of a task that could not be read or done, or whose worker was lost."""

    def failures(self, result: Result) -> int:
        """Number of tasks that failed in a batch that was done together."""
        return 0


def run(
    job: Job[Task, Result],
    tasks: Sequence[Task],
    pool: Executor,
    *,
    ordered: bool = False,
    observer: Observer | None = None,
    before: int = 0,
    chunks: Iterable[Sequence[Task]] | None = None,
    total: int | None = None,
) -> Iterator[Part[Task, Result]]:
    """Do all tasks in a pool; yield the results, each of one task or more, as they come or in the tasks' order.

    Args:
        ordered: in the tasks' order. Results wait until those before them are there; only a few chunks are in flight.
        observer: called when the results of a chunk have been taken.
        before: number of tasks done in an earlier run, for the observer.
        chunks: the tasks of each call, where they cannot be cut anywhere; ``total``: their number with those before.
    """
    total = before + len(tasks) if total is None else total
    left = iter(() if chunks is None else chunks)
    first = tasks or next(left, ())
    choose_to_compile(job, first, pool, total - before)
    alone = is_plain(pool)  # a glyph takes seconds
    if chunks is None:
        # Chunks for each worker at least, so that the workers finish at about the same time.
        left = iter(slices(tasks, 1 if alone else max(1, min(job.chunk, len(tasks) // (8 * pool_size(pool))))))
    elif first:
        left = chain([first], left)
    most = AHEAD * pool_size(pool) * (2 if ordered else 1)
    pending: list[tuple[Future[list[Part[Task, Result]]], Sequence[Task], int]] = []
    done, failed = before, 0
    try:
        while True:
            awaited = [future for future, _, _ in pending[: 1 if ordered else None]]
            k = next((k for k, future in enumerate(awaited) if future.done()), None)
            if k is None:
                if len(pending) < most and (chunk := next(left, ())):
                    pending.append((pool.submit(work, job, chunk, alone), chunk, 1))
                elif pending:
                    wait(awaited, return_when=FIRST_COMPLETED)
                else:
                    return
                continue
            future, chunk, trial = pending.pop(k)
            try:
                parts = future.result()
            except (WorkerLostError, TimeLimitError) as error:
                # Attempts at a task whose worker died: the task need not be the cause.
                if len(chunk) > 1 or (isinstance(error, WorkerLostError) and trial < 3):
                    pending[k:k] = [(pool.submit(work, job, [task]), [task], trial + 1) for task in chunk]
                    continue
                parts = [_failed(job, chunk[0], error)]
            if alone and isinstance(pool, WorkerPool):  # this process counts its own time itself
                spend(sum(part.seconds for part in parts))
            yield from parts
            done += len(chunk)
            failed += sum(part.failed for part in parts)
            if observer:
                observer(done, total, failed)
    finally:
        for future, _, _ in pending:
            future.cancel()


def choose_to_compile(job: Job[Task, Result], tasks: Sequence[Task], pool: Executor, left: int) -> None:
    """Have a pool compile first, if it is not decided yet and what is left to do would take longer as plain Python.

    Args:
        tasks: some of those that are left, which stand for all. left: their number.
    """
    choice = choice_of(pool)
    if choice is None or choice.is_made or not (job.chooses and tasks):
        return
    choice.is_made = True
    if choice.is_clear(left):
        return
    with suppress(GlyphsplineError):  # a task that ends its worker is reported when it is done
        choice.take(left, pool.submit(costs_of, job, tasks[:: -(-len(tasks) // SAMPLE)]).result())


def costs_of(job: Job[Task, Result], tasks: Sequence[Task]) -> list[float]:
    """The costs of tasks, of those that can be read."""
    return [item.cost for item in job.read(tasks) if isinstance(item, Item)]


def slices(tasks: Sequence[Task], size: int) -> list[Sequence[Task]]:
    """Tasks in chunks of a size."""
    return [tasks[start : start + size] for start in range(0, len(tasks), size)]


def work(job: Job[Task, Result], tasks: Sequence[Task], alone: bool = False) -> list[Part[Task, Result]]:
    """Do a chunk of tasks, in a worker, in batches or each ``alone``; the results are in the tasks' order."""
    parts: list[Part[Task, Result]] = []
    batch: list[tuple[Task, Item]] = []
    cost = 0.0

    def finish() -> None:
        if batch:
            parts.extend(_do(job, batch))
            batch.clear()
            sign_of_life()

    for task, item in zip(tasks, job.read(tasks), strict=True):
        if isinstance(item, Exception):
            finish()
            parts.append(_failed(job, task, item))
            continue
        cost = (cost if batch else 0.0) + item.cost
        if batch and (alone or cost > job.budget or item.kind != batch[0][1].kind):
            finish()
            cost = item.cost
        batch.append((task, item))
    finish()
    return parts


def _do(job: Job[Task, Result], batch: Sequence[tuple[Task, Item]]) -> list[Part[Task, Result]]:
    """Do a batch; after an unexpected error, one by one."""
    started = time.perf_counter()
    tasks = [task for task, _ in batch]
    try:
        result = job.together(tasks, [item.content for _, item in batch])
    except OutputError:
        raise
    except Exception as error:  # broken data raises anything
        if len(batch) > 1:
            return [part for one in batch for part in _do(job, [one])]
        return [_failed(job, tasks[0], error, time.perf_counter() - started)]
    return [Part(tasks, result, time.perf_counter() - started, job.failures(result))]


def _failed(job: Job[Task, Result], task: Task, error: Exception, seconds: float = 0.0) -> Part[Task, Result]:
    return Part([task], job.failed(task, error), seconds, 1)


def reason(error: Exception) -> str:
    """The message of an error without the file's path, which may not be in a manifest."""
    if isinstance(error, GlyphsplineError):
        return error.message if error.contour is None else f"contour {error.contour}: {error.message}"
    if isinstance(error, MemoryError):
        return "not enough memory"
    from ..readers.source import library_words

    return library_words(error)
