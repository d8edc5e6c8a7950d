"""Runs on a dask.distributed cluster of several processes, one of which is killed."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from glyphspline.errors import GlyphsplineError
from glyphspline.fitting.options import Options
from glyphspline.plugins.datasets.cluster import KEPT, ClusterExecutor
from glyphspline.readers import open_font
from glyphspline.runs import pool as pools
from glyphspline.runs.convert import convert_font
from glyphspline.runs.pool import TimeLimitError, WorkerLostError
from glyphspline.runs.schedule import workers
from glyphspline.runs.spec import Limits, RunSpec, kinds_for
from tests.places import GYOSHO as FONT
from tests.runs.test_hostile import endless_font

pytestmark = pytest.mark.needs("distributed")

SPEC = RunSpec(Options(step=60.0))


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    with import_module("distributed").LocalCluster(  # nannies start its workers as daemonic processes
        n_workers=2, threads_per_worker=1, dashboard_address=None, host="127.0.0.1", silence_logs=50
    ) as made:
        yield made


def content(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_a_lost_worker_does_not_show_in_the_result(cluster: Any, tmp_path: Path) -> None:
    font = open_font(FONT)
    names = font.select(all_glyphs=True)
    convert_font(font, names, tmp_path / "here", SPEC, jobs=0)
    victim = next(iter(cluster.workers.values())).pid
    killed: list[int] = []

    def kill(done: int, total: int, failed: int) -> None:
        if not killed:
            os.kill(victim, signal.SIGKILL)
            killed.append(done)

    with ClusterExecutor(cluster.scheduler_address) as executor:
        summary = convert_font(font, names, tmp_path / "there", SPEC, executor=executor, observer=kill)
    assert killed
    assert killed[0] < len(names)
    assert summary.done == len(names)
    assert content(tmp_path / "there") == content(tmp_path / "here")


def test_a_glyph_that_never_ends_is_ended_there_too(cluster: Any, tmp_path: Path) -> None:
    endless_font(tmp_path / "endless.otf")
    font = open_font(tmp_path / "endless.otf")
    spec = RunSpec(Options(step=50.0), limits=Limits(seconds=10.0))
    convert_font(font, font.glyph_names, tmp_path / "here", spec, jobs=2)
    with workers(None, 10.0, kinds_for(spec.options, spec.formats), scheduler=cluster.scheduler_address) as executor:
        summary = convert_font(font, font.glyph_names, tmp_path / "there", spec, executor=executor)
    assert summary.statuses == {"ok": 2, "failed": 1}
    assert summary.failures == [("endless", "took longer than 10 s")]
    assert content(tmp_path / "there") == content(tmp_path / "here")


class Reading(NamedTuple):
    """A call on two files, which returns bytes and writes nothing."""

    first: Path
    others: tuple[Path, ...]


def read(reading: Reading, parts: list[int]) -> tuple[int, Path, str, list[bytes]]:
    name = reading.first.name
    return (
        os.getpid(),
        reading.first,
        name,
        [path.read_bytes()[part:] for path in (reading.first, *reading.others) for part in parts],
    )


def end(reading: Reading, older: list[float]) -> None:
    """Die, or hang with a last sign of life that is older by some seconds."""
    if not older:
        os.kill(os.getpid(), signal.SIGKILL)
    pools._last_sign.value -= older[0]
    time.sleep(older[0])


def test_any_call_with_files_goes_there(cluster: Any, tmp_path: Path) -> None:
    files = [tmp_path / f"{k}.ttf" for k in range(3 * KEPT)]
    for k, file in enumerate(files):
        file.write_bytes(bytes(range(k, k + 50)))
    with ClusterExecutor(cluster.scheduler_address, 600.0, ()) as executor:
        futures = [executor.submit(read, Reading(file, (files[0],)), [0, 10]) for file in files * 2]
        found = [future.result(timeout=600) for future in futures]
        for (_, path, name, parts), file in zip(found, files * 2, strict=True):
            assert (path, name) == (file, file.name)
            assert parts == [
                file.read_bytes(),
                file.read_bytes()[10:],
                files[0].read_bytes(),
                files[0].read_bytes()[10:],
            ]
        processes = {process for process, *_ in found}
        assert processes.isdisjoint({worker.pid for worker in cluster.workers.values()} | {os.getpid()})
        assert len(processes) <= 2, "processes are kept between calls"
        lost, hung = (executor.submit(end, Reading(files[0], ()), older) for older in ([], [1200.0]))
        assert isinstance(lost.exception(timeout=600), WorkerLostError)
        assert isinstance(hung.exception(timeout=600), TimeLimitError)
        with pytest.raises(GlyphsplineError, match="only font files can go to a cluster"):
            executor.submit(read, Reading(tmp_path, ()), [0])


def test_no_scheduler_is_an_error() -> None:
    with pytest.raises(GlyphsplineError, match="no scheduler at tcp://127"):
        ClusterExecutor("tcp://127.0.0.1:9", patience="1s")
