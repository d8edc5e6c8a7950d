"""Runs on a dask.distributed cluster of several processes, one of which is killed."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from glyphspline.batch import RunSpec, convert_font
from glyphspline.batch.cluster import ClusterExecutor
from glyphspline.errors import GlyphsplineError
from glyphspline.fitting.options import Options
from glyphspline.readers import open_font

FONT = Path(__file__).parents[1] / "fonts_test" / "kouzan-gyosho.ttf"
SPEC = RunSpec(Options(step=60.0))


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    with import_module("distributed").LocalCluster(
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


def test_no_scheduler_is_said_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("glyphspline.batch.cluster.PATIENCE", "1s")
    with pytest.raises(GlyphsplineError, match="no scheduler at tcp://127"):
        ClusterExecutor("tcp://127.0.0.1:9")
