"""Worker processes that can be killed and replaced, behind the interface of ``concurrent.futures``.

The pools of the standard library break when one process dies, and cannot kill one that hangs. Here only the current
call of such a process fails: its future gets the error, and a new process replaces the old one.
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
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import suppress
from importlib import import_module
from multiprocessing import forkserver, resource_tracker
from multiprocessing.reduction import ForkingPickler
from types import ModuleType
from typing import Any

from ..code_files import QUIET
from ..errors import GlyphsplineError

POLL = 0.25
"""Seconds between checks for hung processes."""

STARTS, STARTING = 4, 1800.0
"""Processes in a row that may die while they start: somebody may have killed one, or there was no memory for it.
Seconds in which a process has to start."""

CODE = os.path.realpath(__file__)
"""This file, which workers have to import too: those of another copy of the package would do other things."""


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
    """Kill the workers of all pools, which may be compiling, and the process from which they are forked.

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
            os.waitid(os.P_PID, server, os.WEXITED | os.WNOWAIT)  # its end is for multiprocessing to take


def _serve(calls: Any, sign: Any, seconds: float, preload: Sequence[str]) -> None:
    """The main loop of a worker process: receive calls and send results until the pipe is closed."""
    global _last_sign, _limit
    _last_sign, _limit = sign, seconds
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole group; the parent kills its workers
    os.environ[QUIET] = "1"  # the parent says what there is to say about compiling
    load(preload)  # before calls and their time limits begin; usually it is done before the fork
    gc.freeze()  # the garbage collector does not scan imported objects, nor copy their pages
    gc.enable()  # it may be off in the process from which this one is forked
    with suppress(EOFError, OSError):
        calls.send(CODE)
        while True:
            function, arguments, keywords = calls.recv()
            sign_of_life()
            try:
                answer = (True, function(*arguments, **keywords))
            except Exception as error:
                answer = (False, error)
            _end_after(0.0)
            calls.send(answer)


class _Worker:
    """One process, and this end of its pipe."""

    def __init__(self, context: Any, seconds: float, preload: Sequence[str], with_main: bool) -> None:
        self.sign = context.RawValue("d", time.monotonic())
        self.calls, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, self.sign, seconds, preload), daemon=True)
        main = sys.modules["__main__"]
        try:
            if not with_main:
                sys.modules["__main__"] = ModuleType("__main__")
            self.process.start()
        finally:
            sys.modules["__main__"] = main
            theirs.close()

    def receive(self, seconds: float) -> Any:
        """What the process sends next. It is ended if it gives no sign of life for that long.

        Raises:
            EOFError, OSError: it has died. TimeoutError: it gave no sign of life.
        """
        try:
            while not self.calls.poll(POLL):
                if time.monotonic() - self.sign.value > seconds:
                    raise TimeoutError
            return self.calls.recv()
        except (EOFError, OSError):
            self.end()
            raise

    def end(self) -> None:
        """Kill the process."""
        self.process.kill()
        self.process.join()
        self.calls.close()


class WorkerPool(ThreadPoolExecutor):
    """Threads with a process each, which makes their calls; :meth:`submit` gives futures with the three errors above.

    Args:
        size: how many processes.
        seconds: time limit between signs of life.
        preload: what to load before the first call, as :func:`load` takes it: once, in the process from which
            the workers are forked. If that runs already, for an earlier pool, each worker loads what it lacks.
        expected: number of calls known to come; processes for them start at once.
        with_main: whether they import the main module, which has to be made for it: calls may be of its functions.

    Attributes:
        is_closed: whether it takes no more calls: it was closed, or its processes could not start.
    """

    def __init__(
        self, size: int, seconds: float, preload: Sequence[str] = (), expected: int = 0, *, with_main: bool = True
    ) -> None:
        super().__init__(size)
        self._seconds, self._preload, self._with_main = seconds, tuple(preload), with_main
        self._context: Any = multiprocessing.get_context("spawn" if os.name == "nt" else "forkserver")
        self._processes: dict[int, _Worker] = {}  # by thread
        self._starting = threading.Lock()
        self._died = 0  # processes in a row that died while they started
        self._is_ready = self.is_closed = False
        self._error: WorkerStartError | None = None
        if os.name != "nt":
            start_forkserver(preload)
        for _ in range(min(size, expected)):
            super().submit(self._process)

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Queue a call of a function that can be pickled.

        Raises:
            WorkerStartError: no process could start.
        """
        if self._error is not None:
            raise self._error
        return super().submit(self._call, bytes(ForkingPickler.dumps((fn, args, kwargs))))

    def renew(self, seconds: float, preload: Sequence[str]) -> None:
        """Start processes anew, with another time limit and preload. No call may be under way."""
        with self._starting:
            self._seconds, self._preload = seconds, tuple(preload)
            for worker in self._processes.values():
                worker.end()
            self._processes.clear()
            if os.name != "nt":
                kill_server()
                start_forkserver(preload)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Kill the processes; running and queued calls are lost."""
        self.is_closed = True
        if wait and not self._is_ready:  # no call waits for what workers import
            kill_server()
        for worker in [*self._processes.values()]:
            worker.process.kill()
        super().shutdown(wait)

    def _call(self, call: bytes) -> Any:
        """Make a call in this thread's process."""
        worker = self._process()
        worker.sign.value = time.monotonic()
        try:
            with suppress(OSError):  # a dead process is noticed when its pipe is read
                worker.calls.send_bytes(call)
            good, value = worker.receive(self._seconds)
        except TimeoutError:
            raise TimeLimitError(f"took longer than {self._seconds:g} s") from None
        except (EOFError, OSError):
            raise WorkerLostError("the pool was closed" if self.is_closed else "the worker process died") from None
        if not good:
            raise value
        return value

    def _process(self) -> _Worker:
        """This thread's process, ready for a call: a new one if there is none, or it has died.

        Raises:
            WorkerStartError: several in a row have died. WorkerLostError: the pool is closed.
        """
        thread = threading.get_ident()
        known = self._processes.get(thread)
        if known and not (known.calls.closed or known.calls.poll()):
            return known
        while not (self.is_closed or _is_ending):
            try:
                with self._starting:
                    if self._died and os.name != "nt":
                        start_forkserver(self._preload)
                    started = _Worker(self._context, self._seconds, self._preload, self._with_main)
                    worker = self._processes[thread] = started
                if self.is_closed:
                    worker.end()
                code = worker.receive(STARTING)
            except (EOFError, OSError):
                self._is_ready = False
                self._died += 1
                if self._died >= STARTS:
                    self._fail("a worker process could not start")
                time.sleep(POLL * self._died)  # a process that was killed may not have ended yet
            else:
                if code != CODE:
                    self._fail(f"workers run other code, {code}, not {CODE}: set PYTHONPATH to its folder")
                self._is_ready, self._died = True, 0
                return worker
        raise self._error or WorkerLostError("the pool was closed")

    def _fail(self, why: str) -> None:
        self.is_closed, self._error = True, WorkerStartError(why)
        raise self._error


if ASKED in os.environ:  # the process from which workers are forked imports this module, and takes no arguments
    gc.disable()  # there is no garbage yet, and looking for it takes a sixth of the time; workers enable it again
    load(os.environ.pop(ASKED).split())
