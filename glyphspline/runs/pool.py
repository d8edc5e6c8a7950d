"""Worker processes that can be killed and replaced, behind the interface of ``concurrent.futures``.

The pools of the standard library break when one process dies, and cannot kill one that hangs. Here only the current
call of such a process fails: its future gets the error, and a new process replaces the old one.

A busy process gets its next call in advance if enough are queued. Otherwise it would wait a millisecond between calls,
the time of two or three glyphs.
"""

from __future__ import annotations

import gc
import math
import multiprocessing
import os
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor, Future
from contextlib import suppress
from importlib import import_module
from multiprocessing import connection, forkserver, resource_tracker
from multiprocessing.reduction import ForkingPickler
from typing import Any

from ..errors import GlyphsplineError

POLL = 0.25
"""Seconds between checks for hung processes."""

STARTS, STARTING = 4, 1800.0
"""Processes in a row that may die while they start: somebody may have killed one, or there was no memory for it.
Seconds in which a process has to start: compiling everything takes two minutes on an idle machine."""

CODE = os.path.realpath(__file__)
"""This file, which workers have to import too: those of another copy of the package would do other things."""

Call = tuple[Future[Any], bytes]
"""The future of a call, and its function and arguments, pickled."""


class WorkerLostError(GlyphsplineError):
    """The process died during the call: killed, out of memory, or crashed."""


class TimeLimitError(GlyphsplineError):
    """The process gave no sign of life within the time limit and was killed."""


class WorkerStartError(GlyphsplineError):
    """Several processes in a row died before their first call, or have other code; others would too."""


def pool_size(pool: Executor) -> int:
    """Number of calls that a pool runs at a time."""
    return int(getattr(pool, "_max_workers", 1))


ASKED = "GLYPHSPLINE_PRELOAD"
"""Environment variable of the process from which workers are forked: what it loads, separated by spaces."""

_last_sign: Any = None
_limit = 0.0


def code_for(kinds: Iterable[str]) -> list[str]:
    """What to load for kinds of work of :mod:`.warm`."""
    return [f"{__package__}.warm:{kind}" for kind in kinds]


def load(items: Iterable[str]) -> None:
    """Import modules, and call what follows a colon: ``prepare`` of the module with it."""
    for item in items:
        name, _, kind = item.partition(":")
        module = import_module(name)
        if kind:
            module.prepare(kind)


def sign_of_life() -> None:
    """Restart the time limit: a long call calls this between its parts."""
    if _last_sign is not None:
        _last_sign.value = time.monotonic()
        # Times the time limit after which a process ends itself: the one that would have ended it has been killed.
        _end_after(2.0 * _limit)


def _end_after(seconds: float) -> None:
    """Have the system end this process; 0: not any more. It does so in the midst of native code too."""
    if hasattr(signal, "setitimer"):
        # A timer of any system can hold three years.
        signal.setitimer(signal.ITIMER_REAL, 0.0 if seconds == math.inf else min(seconds, 1e8))


def start_forkserver(preload: Sequence[str]) -> None:
    """Start the process from which workers are forked, if it does not run yet, without waiting for its imports.

    SIGINT is blocked in it and in its workers: only this process handles Ctrl-C. An interrupted import would print a
    traceback. It does not import from the current folder, which may have a folder ``fs`` or a file ``numba.py`` in it.
    """
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    environment = dict(os.environ)
    os.environ |= {"PYTHONSAFEPATH": "1", ASKED: " ".join(preload)}
    try:
        forkserver.set_forkserver_preload([__name__])
        forkserver.ensure_running()
    finally:
        del os.environ["PYTHONSAFEPATH"], os.environ[ASKED]
        os.environ |= environment
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


_is_ending = False


def kill_all() -> None:
    """Kill the workers of all pools, and the process from which they are forked, which may be compiling.

    No pool starts others from then on: this process is about to end.
    """
    global _is_ending
    _is_ending = True
    for process in multiprocessing.active_children():
        process.kill()
    kill_server()


def kill_server() -> None:
    """Kill the process from which workers are forked; the next pool starts another."""
    server = getattr(getattr(forkserver, "_forkserver", None), "_forkserver_pid", None)
    if server is not None:
        with suppress(OSError):
            os.kill(server, signal.SIGKILL)


def _serve(calls: Any, sign: Any, seconds: float, preload: Sequence[str]) -> None:
    """The main loop of a worker process: receive calls and send results until the pipe is closed.

    Calls and time limits begin after all imports, which usually happen before the fork.
    """
    global _last_sign, _limit
    _last_sign, _limit = sign, seconds
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole group; the parent kills its workers
    load(preload)
    if compiled := sys.modules.get("glyphspline.compiled"):
        compiled.observe(sign_of_life)  # a font has no say in how long compiling takes
    gc.freeze()  # the garbage collector does not scan imported objects, nor copy their pages
    gc.enable()  # it may be off in the process from which this one is forked
    with suppress(EOFError, OSError):
        calls.send(CODE)
        while True:
            function, arguments = calls.recv()
            sign_of_life()
            try:
                answer = (True, function(*arguments))
            except Exception as error:
                answer = (False, error)
            _end_after(0.0)
            calls.send(answer)


class _Worker:
    """One process, its end of the pipe, and its calls; the first of them is running."""

    def __init__(self, context: Any, seconds: float, preload: Sequence[str]) -> None:
        self.sign = context.RawValue("d", 0.0)
        self.calls, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, self.sign, seconds, preload), daemon=True)
        self.ready, self.started = False, time.monotonic()
        limit = threading.Timer(STARTING, kill_server)  # a start waits for the process from which workers are forked
        limit.daemon = True
        limit.start()
        try:
            self.process.start()
        finally:
            limit.cancel()
            theirs.close()
        self.has: deque[Call] = deque()

    def give(self, call: Call) -> None:
        """Send a call."""
        if not self.has:
            self.sign.value = time.monotonic()
        self.has.append(call)
        with suppress(OSError):  # a dead process is noticed when its pipe is read
            self.calls.send_bytes(call[1])

    def end(self) -> None:
        """Kill the process."""
        self.process.kill()
        self.process.join()
        self.calls.close()


class WorkerPool(Executor):
    """A fixed number of processes; :meth:`submit` gives futures whose errors may be the three above.

    Args:
        size: how many processes.
        seconds: time limit between signs of life.
        preload: what to load before the first call, as :func:`load` takes it: once, in the process from which
            the workers are forked. If that runs already, for an earlier pool, each worker loads what it lacks.
        expected: number of calls known to come; processes for them start at once.

    Attributes:
        is_closed: whether it takes no more calls: it was closed, or its processes could not start.
    """

    def __init__(self, size: int, seconds: float, preload: Sequence[str] = (), expected: int = 0) -> None:
        self._max_workers = size
        self._seconds = seconds
        self._preload = tuple(preload)
        self._expected = expected
        self._context: Any = multiprocessing.get_context("spawn" if os.name == "nt" else "forkserver")
        if os.name != "nt":
            start_forkserver(preload)
        self._queue: deque[Call] = deque()
        self._wake, self._woken = self._context.Pipe()
        self.is_closed, self._starting = False, True
        self._error: Exception | None = None
        self._died = 0  # processes in a row that died while they started
        self._workers: list[_Worker] = []
        self._thread = threading.Thread(target=self._manage, daemon=True)
        self._thread.start()

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Queue a call of a function that can be pickled.

        Raises:
            WorkerStartError: no process could start.
        """
        if self._error is not None:
            raise self._error
        if kwargs or self.is_closed:
            raise RuntimeError("the pool is closed, or was given keywords")
        future: Future[Any] = Future()
        self._queue.append((future, bytes(ForkingPickler.dumps((fn, args)))))
        self._wake.send_bytes(b"")
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Kill the processes; running and queued calls are lost."""
        if not self.is_closed:
            self.is_closed = True
            self._wake.send_bytes(b"")
        if wait:
            if self._starting:  # what workers import may be compiled for minutes yet, which no call waits for now
                kill_server()
            self._thread.join()

    def _manage(self) -> None:
        try:
            while not self.is_closed:
                self._start()
                self._assign()
                busy = any(worker.has or not worker.ready for worker in self._workers)
                awaited = [self._woken, *(worker.calls for worker in self._workers)]
                for item in connection.wait(awaited, POLL if busy else None):
                    if item is self._woken:
                        self._woken.recv_bytes()
                    else:
                        self._receive(next(worker for worker in self._workers if worker.calls is item))
                self._end_hung()
        except Exception as error:
            self._error, self.is_closed = error, True
            self._fail_all(error)
        finally:
            for worker in self._workers:
                worker.end()
            self._fail_all(WorkerLostError("the pool was closed"))

    def _assign(self) -> None:
        """Send calls to idle processes; then, if enough are queued, send busy ones their next calls."""
        ready = [worker for worker in self._workers if worker.ready]
        for worker in ready:
            if not worker.has:
                self._give_next(worker)
        for worker in ready:
            # Bytes of a call that a pipe buffers: sending them does not block.
            if len(worker.has) == 1 and len(self._queue) >= self._max_workers and len(self._queue[0][1]) <= 32_768:
                self._give_next(worker)

    def _give_next(self, worker: _Worker) -> None:
        while self._queue:
            call = self._queue.popleft()
            if call[0].running() or call[0].set_running_or_notify_cancel():
                worker.give(call)
                break

    def _start(self) -> None:
        """Start as many processes as there are calls, up to the size."""
        wanted = max(self._expected, len(self._queue) + sum(len(worker.has) for worker in self._workers))
        while len(self._workers) < min(self._max_workers, wanted):
            self._workers.append(self._new_worker())

    def _new_worker(self) -> _Worker:
        """Start a process, and the one from which it is forked again if that has died.

        Raises:
            WorkerStartError: several in a row have died.
        """
        self._starting = True
        while not (self.is_closed or _is_ending) and self._died < STARTS:
            if self._died and os.name != "nt":
                start_forkserver(self._preload)
            try:
                return _Worker(self._context, self._seconds, self._preload)
            except (EOFError, OSError):
                self._died += 1
                time.sleep(POLL * self._died)  # a process that was killed may not have ended yet
        raise WorkerStartError("a worker process could not start")

    def _receive(self, worker: _Worker) -> None:
        try:
            answer = worker.calls.recv()
        except (EOFError, OSError):
            self._died += not worker.ready
            self._replace(worker, WorkerLostError("the worker process died"))
            return
        if not worker.ready:
            if answer != CODE:
                raise WorkerStartError(f"workers run other code, {answer}, not {CODE}: set PYTHONPATH to its folder")
            worker.ready, self._died = True, 0
            self._starting = not all(other.ready for other in self._workers)
            return
        future, _ = worker.has.popleft()
        good, value = answer
        (future.set_result if good else future.set_exception)(value)

    def _end_hung(self) -> None:
        now = time.monotonic()
        for worker in list(self._workers):
            if worker.has and now - worker.sign.value > self._seconds:
                self._replace(worker, TimeLimitError(f"took longer than {self._seconds:g} s"))
            elif not worker.ready and now - worker.started > STARTING:
                self._died += 1
                self._replace(worker, TimeLimitError("did not start in time"))

    def _replace(self, worker: _Worker, error: GlyphsplineError) -> None:
        """Replace a lost process: its running call gets the error, its next call is queued again."""
        worker.end()
        if worker.has:
            worker.has.popleft()[0].set_exception(error)
        self._queue.extendleft(reversed(worker.has))
        worker.has.clear()
        self._workers[self._workers.index(worker)] = self._new_worker()

    def _fail_all(self, error: Exception) -> None:
        left = [future for worker in self._workers for future, _ in worker.has if not future.done()]
        left += [future for future, _ in self._queue if future.running() or future.set_running_or_notify_cancel()]
        self._queue.clear()
        for future in left:
            future.set_exception(error)


if ASKED in os.environ:  # the process from which workers are forked imports this module, and takes no arguments
    gc.disable()  # there is no garbage yet, and looking for it takes a sixth of the time; workers enable it again
    load(os.environ.pop(ASKED).split())
