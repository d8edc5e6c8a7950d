"""Runs on a dask.distributed cluster: the bytes of fonts are sent to the workers, results and files are sent back.

A worker of the cluster makes calls in processes of its own (:class:`.pool.WorkerPool`), one a thread. A call that hangs
or crashes there ends such a process and never the worker, so that it fails as it does without a cluster. dask repeats
the calls of a worker that is lost.
"""

from __future__ import annotations

import io
import multiprocessing
import pickle
import shutil
import tempfile
import threading
import warnings
import weakref
from collections import OrderedDict, deque
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import CancelledError, Executor, Future
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import Any
from weakref import WeakValueDictionary

from ...errors import GlyphsplineError, words_of
from ...extras import need
from ...files import write_whole
from ...runs.pool import WorkerLostError, WorkerPool
from ...runs.spec import Limits
from ...runs.warm import code_for, is_ready, warm

KEPT = 8
"""Fonts kept in the memory of the cluster, and on each worker's disk, beside those of calls in flight."""

OUT = "out"
"""Stands for the output folder in a call, as a number does for a font."""


Processes = tuple[float, tuple[str, ...]]
"""Processes that make calls in a worker of the cluster: time limit between signs of life, and kinds of work in them."""


class ClusterExecutor(Executor):
    """Calls ``function(job, tasks)`` on the workers of a scheduler.

    Paths anywhere in ``job`` and ``tasks`` are those of font files, which go to the cluster by content, each once; in
    the result they are what they are here. If the job has an output folder, ``job.out``, the call gets an empty one
    with the same folders in it, and what it writes there is written here before its future is done.

    Args:
        address: of the scheduler, as in ``tcp://10.0.0.1:8786``.
        seconds: time limit between signs of life, after which a call is ended.
        kinds: of work, see :mod:`.warm`; each machine of the cluster compiles first what it has no code of.
        patience: time limit for the scheduler to answer.

    Raises:
        GlyphsplineError: distributed is not installed, or nothing answers at the address.
    """

    def __init__(
        self, address: str, seconds: float = Limits.seconds, kinds: Sequence[str] = (), patience: str = "10s"
    ) -> None:
        distributed = need("cluster")
        try:
            self._client = distributed.Client(address, timeout=patience, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise GlyphsplineError(f"no scheduler at {address}: {words_of(error)}") from error
        self._processes: Processes = seconds, tuple(kinds)
        self._inner = self._client.get_executor(pure=False)
        self._fonts: OrderedDict[Path, tuple[str, Any]] = OrderedDict()
        self._max_workers = max(1, sum(self._client.nthreads().values()))

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Call ``fn(job, tasks)`` there.

        Raises:
            GlyphsplineError: a path is not that of a font file.
        """
        out = getattr(args[0], "out", None) if args else None
        paths: dict[Path, int | str] = {}

        def named(path: Path) -> int | str:
            if path not in paths:
                if path != out and not path.is_file():
                    raise GlyphsplineError("only font files can go to a cluster", font=str(path))
                paths[path] = OUT if path == out else sum(name != OUT for name in paths.values())
            return paths[path]

        call = pickled((fn, args), named)
        fonts = [self._sent(path) for path in paths if path != out]
        folders = [] if out is None else [item.name for item in out.iterdir() if item.is_dir()]
        future: Future[Any] = Future()
        future.set_running_or_notify_cancel()
        inner = self._inner.submit(
            call_there, self._processes, call, folders, [name for name, _ in fonts], *[content for _, content in fonts]
        )
        inner.add_done_callback(lambda done: take_back(done, {name: path for path, name in paths.items()}, future))
        return future

    def _sent(self, path: Path) -> tuple[str, Any]:
        """The name of a font, and its bytes in the cluster, as the result of a call.

        The cluster makes the result of a call again if the workers that had it are gone. Data that are scattered it
        loses, and copies of them that a client releases and scatters again it has been seen to make without end.
        """
        if path not in self._fonts or self._fonts[path][1].status in ("cancelled", "error", "lost"):
            content = path.read_bytes()
            with warnings.catch_warnings():
                warnings.filterwarnings("ignore", "Sending large graph")
                there = self._client.submit(bytes, content, pure=False)
            self._fonts[path] = f"{sha256(content).hexdigest()}/{path.name}", there
        self._fonts.move_to_end(path)
        while len(self._fonts) > KEPT:  # the cluster keeps those that calls in flight need
            self._fonts.popitem(last=False)
        return self._fonts[path]

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Disconnect from the cluster; calls in flight are cancelled."""
        self._client.close()


def pickled(value: Any, name: Callable[[Path], int | str | None]) -> bytes:
    """A value in bytes, with names instead of the paths that have one."""

    class Packer(pickle.Pickler):
        def persistent_id(self, obj: Any) -> int | str | None:
            return name(obj) if isinstance(obj, Path) else None

    file = io.BytesIO()
    Packer(file, pickle.HIGHEST_PROTOCOL).dump(value)
    return file.getvalue()


def unpickled(data: bytes, paths: Mapping[int | str, Path]) -> Any:
    """What :func:`pickled` has written, with paths for the names."""

    class Unpacker(pickle.Unpickler):
        def persistent_load(self, pid: Any) -> Path:
            return paths[pid]

    return Unpacker(io.BytesIO(data)).load()


def make_call(call: bytes, paths: Mapping[int | str, Path]) -> bytes:
    """Make a call with the paths of this machine; its result has names for them again."""
    function, arguments = unpickled(call, paths)
    return pickled(function(*arguments), {path: name for name, path in paths.items()}.get)


class FontFile:
    """A font on the disk of a worker of the cluster, there as long as something refers to it."""

    def __init__(self, name: str, content: bytes, scratch: str) -> None:
        folder = Path(tempfile.mkdtemp(prefix="glyphspline-fonts-", dir=scratch))
        self.path = folder / name
        write_whole(str(self.path), content)
        weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)


_lock = threading.Lock()
_files: WeakValueDictionary[str, FontFile] = WeakValueDictionary()
_used: deque[FontFile] = deque(maxlen=KEPT)  # last, beside those of calls in flight


def font_file(name: str, content: bytes, scratch: str) -> FontFile:
    """The file of a font on the disk of this worker of the cluster; it is called what follows its hash."""
    file = _files.get(name) or FontFile(name.rpartition("/")[2], content, scratch)
    _files[name] = file
    _used.append(file)
    return file


@lru_cache(maxsize=1)
def processes_of(size: int, seconds: float, kinds: tuple[str, ...]) -> WorkerPool:
    """The processes of this worker of the cluster. Those of another kind end with their calls, as their pipes close."""
    # dask starts its workers as daemonic, which may have no children: these would outlive it. Ours end with it.
    multiprocessing.current_process().daemon = False
    if not is_ready(kinds):
        warm(size, kinds)
    return WorkerPool(size, seconds, code_for(kinds))


def call_there(
    processes: Processes, call: bytes, folders: Sequence[str], names: Sequence[str], *fonts: bytes
) -> tuple[bytes, dict[str, bytes]]:
    """Make a call in a process of this worker of the cluster; returns its result, and what it has written by path."""
    worker = need("cluster").get_worker()
    scratch = worker.local_directory  # dask empties it, after a kill too
    with _lock:
        if processes_of(worker.state.nthreads, *processes).is_closed:  # they could not start
            processes_of.cache_clear()
        pool = processes_of(worker.state.nthreads, *processes)
        files = [font_file(name, content, scratch) for name, content in zip(names, fonts, strict=True)]
    with tempfile.TemporaryDirectory(prefix="glyphspline-", dir=scratch) as folder:
        out = Path(folder)
        for name in folders:
            (out / name).mkdir()
        paths: dict[int | str, Path] = {OUT: out, **dict(enumerate(file.path for file in files))}
        result = pool.submit(make_call, call, paths).result()
        written = {f"{file.parent.name}/{file.name}": file.read_bytes() for file in sorted(out.glob("*/*"))}
    return result, written


def take_back(done: Any, paths: Mapping[int | str, Path], future: Future[Any]) -> None:
    """Write the files of a finished call, then finish its future."""
    try:
        data, files = done.result()
        result = unpickled(data, paths)
        for name, content in files.items():
            write_whole(f"{paths[OUT]}/{name}", content)
    except Exception as error:
        # CancelledError is of the cluster's, whose workers with the font are gone.
        lost = isinstance(error, CancelledError) or type(error).__name__ == "KilledWorker"
        future.set_exception(WorkerLostError("its workers died") if lost else error)
    else:
        future.set_result(result)
