"""Runs on a dask.distributed cluster: the bytes of fonts are sent to the workers, and the files are sent back.

dask repeats the calls of a lost worker. Its workers cannot be killed from here, so the time limit does not apply; the
limits of size do.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from typing import Any

from ..errors import GlyphsplineError
from ..extras import need
from .files import write_whole
from .job import Job, Task
from .pool import WorkerLostError

Files = dict[str, bytes]

PATIENCE = "10s"
"""Time limit for a scheduler to answer."""


class ClusterExecutor(Executor):
    """Calls of :func:`.worker.work` and :func:`.worker.survey` on the workers of a scheduler.

    Args:
        address: of the scheduler, as in ``tcp://10.0.0.1:8786``.

    Raises:
        GlyphsplineError: distributed is not installed, or nothing answers at the address.
    """

    def __init__(self, address: str) -> None:
        distributed = need("cluster")
        try:
            self._client = distributed.Client(address, timeout=PATIENCE, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise GlyphsplineError(f"no scheduler at {address}: {error}") from error
        self._inner = self._client.get_executor(pure=False)
        self._fonts: dict[Path, Any] = {}
        self._max_workers = max(1, sum(self._client.nthreads().values()))

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Call ``fn(job, tasks)`` there; its files are written here before the future is done."""
        job, tasks = args
        if not job.path.is_file():
            raise GlyphsplineError("only font files can go to a cluster", font=str(job.path))
        if job.path not in self._fonts:
            self._fonts[job.path] = self._client.scatter(job.path.read_bytes(), broadcast=True, hash=True)
        future: Future[Any] = Future()
        future.set_running_or_notify_cancel()
        inner = self._inner.submit(call_there, fn, self._fonts[job.path], job, tasks)
        inner.add_done_callback(lambda done: take_back(done, job.out, future))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Disconnect from the cluster; calls in flight are cancelled."""
        self._client.close()


def call_there(fn: Callable[..., Any], font: bytes, job: Job, tasks: Sequence[Task]) -> tuple[Any, Files]:
    """Make the call on a worker of the cluster; returns its result and the files it has written."""
    path = local_font(font, job.path.suffix)
    with tempfile.TemporaryDirectory(prefix="glyphspline-") as folder:
        out = Path(folder)
        for name in job.spec.folders:
            (out / name).mkdir()
        result = fn(replace(job, path=path, out=out), tasks)
        files = {f"{file.parent.name}/{file.name}": file.read_bytes() for file in sorted(out.glob("*/*"))}
    return result, files


def local_font(font: bytes, suffix: str) -> Path:
    """A file with the font's bytes, shared by all calls on this machine."""
    path = Path(tempfile.gettempdir()) / f"glyphspline-{sha256(font).hexdigest()}{suffix}"
    if not path.is_file() or path.is_symlink() or path.read_bytes() != font:
        write_whole(str(path), font)
    return path


def take_back(done: Any, out: Path, future: Future[Any]) -> None:
    """Write the files of a finished call, then finish its future."""
    try:
        result, files = done.result()
        for name, content in files.items():
            write_whole(f"{out}/{name}", content)
    except Exception as error:
        lost = type(error).__name__ == "KilledWorker"
        future.set_exception(WorkerLostError("its workers died") if lost else error)
    else:
        future.set_result(result)
