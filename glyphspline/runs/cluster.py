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
from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError, Executor, Future
from contextlib import contextmanager
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Any

from ..errors import GlyphsplineError, words_of
from ..extras import need
from ..files import write_whole
from .pool import WorkerLostError, WorkerPool
from .spec import Limits

KEPT = 8
"""Fonts kept in the memory of the cluster, and on each worker's disk, beside those of calls in flight."""

OUT = "out"
"""Stands for the output folder in a call, as a number does for a font."""


Processes = tuple[float, tuple[str, ...]]
"""Processes that make calls in a worker of the cluster: time limit between signs of life, and what they load first."""


class ClusterExecutor(Executor):
    """Calls ``function(job, tasks)`` on the workers of a scheduler.

    Paths anywhere in ``job`` and ``tasks`` are those of font files, which go to the cluster by content, each once; in
    the result they are what they are here. If the job has an output folder, ``job.out``, the call gets an empty one
    with the same folders in it, and what it writes there is written here before its future is done.

    Args:
        address: of the scheduler, as in ``tcp://10.0.0.1:8786``.
        seconds: time limit between signs of life, after which a call is ended.
        preload: what to load before the first call, see :func:`.pool.load`.
        patience: time limit for the scheduler to answer.

    Raises:
        GlyphsplineError: distributed is not installed, or nothing answers at the address.
    """

    def __init__(
        self, address: str, seconds: float = Limits.seconds, preload: Sequence[str] = (), patience: str = "10s"
    ) -> None:
        distributed = need("cluster")
        try:
            self._client = distributed.Client(address, timeout=patience, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise GlyphsplineError(f"no scheduler at {address}: {words_of(error)}") from error
        self._processes: Processes = seconds, tuple(preload)
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


@dataclass
class Workshop:
    """The processes and fonts of a worker of the cluster, kept between calls.

    Attributes:
        pool: what makes the calls. folder: of font files. calls: number of them in flight.
        fonts: names of files, last used last, and how many calls in flight use each.
    """

    pool: WorkerPool
    folder: Path
    calls: int = 0
    fonts: OrderedDict[str, int] = field(default_factory=OrderedDict)


_workshops: dict[Processes, Workshop] = {}
_lock = threading.Lock()


def call_there(
    processes: Processes, call: bytes, folders: Sequence[str], names: Sequence[str], *fonts: bytes
) -> tuple[bytes, dict[str, bytes]]:
    """Make a call in a process of this worker of the cluster; returns its result, and what it has written by path."""
    worker = need("cluster").get_worker()
    scratch = worker.local_directory  # dask empties it, after a kill too
    with (
        workshop(processes, worker.state.nthreads, scratch) as shop,
        kept(shop, dict(zip(names, fonts, strict=True))) as paths,
        tempfile.TemporaryDirectory(prefix="glyphspline-", dir=scratch) as folder,
    ):
        out = Path(folder)
        for name in folders:
            (out / name).mkdir()
        result = shop.pool.submit(make_call, call, {OUT: out, **dict(enumerate(paths))}).result()
        files = {f"{file.parent.name}/{file.name}": file.read_bytes() for file in sorted(out.glob("*/*"))}
    return result, files


@contextmanager
def workshop(processes: Processes, size: int, scratch: str) -> Iterator[Workshop]:
    """The processes, new ones if there are none of this kind; idle ones of other kinds are ended then."""
    with _lock:
        for other, shop in list(_workshops.items()):
            if not shop.calls and (other != processes or shop.pool.is_closed):
                del _workshops[other]
                shop.pool.shutdown()
                shutil.rmtree(shop.folder, ignore_errors=True)
        if processes not in _workshops:
            # dask starts its workers as daemonic, which may have no children: these would outlive it. Ours end with it,
            # since their pipes close.
            multiprocessing.current_process().daemon = False
            pool = WorkerPool(size, *processes)
            _workshops[processes] = Workshop(pool, Path(tempfile.mkdtemp(prefix="glyphspline-fonts-", dir=scratch)))
        shop = _workshops[processes]
        shop.calls += 1
    try:
        yield shop
    finally:
        with _lock:
            shop.calls -= 1


@contextmanager
def kept(shop: Workshop, fonts: Mapping[str, bytes]) -> Iterator[list[Path]]:
    """Files of fonts, in the order given; of those that no call uses, the last used ``KEPT`` stay."""
    with _lock:
        for name, content in fonts.items():
            if name not in shop.fonts:
                (shop.folder / name).parent.mkdir(exist_ok=True)
                write_whole(f"{shop.folder}/{name}", content)
            shop.fonts[name] = shop.fonts.get(name, 0) + 1
            shop.fonts.move_to_end(name)
    try:
        yield [shop.folder / name for name in fonts]
    finally:
        with _lock:
            for name in fonts:
                shop.fonts[name] -= 1
            unused = [name for name, calls in shop.fonts.items() if not calls]
            for name in unused[: max(0, len(shop.fonts) - KEPT)]:
                del shop.fonts[name]
                (shop.folder / name).unlink(missing_ok=True)


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
