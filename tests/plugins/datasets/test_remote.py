"""Fonts and data sets behind URLs: an S3 server on this machine, which is killed and started again."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from functools import partial
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import BinaryIO

import pytest

from glyphspline.errors import FontError, GlyphsplineError, OutputError
from glyphspline.plugins.datasets import remote
from glyphspline.plugins.datasets.run import dataset
from glyphspline.plugins.datasets.spec import DatasetSpec, Sizes
from glyphspline.runs.font_search import find_fonts
from tests.places import GYOSHO as FONT

pytestmark = pytest.mark.needs("fsspec", "s3fs", "localbucket")


SECRET = "no-secret-at-all"


class Server:
    """An S3 server that keeps its files in a folder, through its being killed."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.start()

    def start(self) -> None:
        command = [sys.executable, "-m", "localbucket", "--port", str(self.port), str(self.folder)]
        self.process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        until = time.monotonic() + 600
        while time.monotonic() < until:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", self.port)) == 0:
                    return
            time.sleep(0.05)
        raise TimeoutError("the S3 server does not start")

    def kill(self) -> None:
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    folder = tmp_path_factory.mktemp("s3")
    (folder / "bucket").mkdir()
    made = Server(folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(folder / "cache"))
        patch.setenv("AWS_ENDPOINT_URL", f"http://127.0.0.1:{made.port}")
        patch.setenv("AWS_ACCESS_KEY_ID", "somebody")
        patch.setenv("AWS_SECRET_ACCESS_KEY", SECRET)
        patch.setenv("AWS_DEFAULT_REGION", "us-east-1")
        patch.setenv("AWS_EC2_METADATA_DISABLED", "true")
        # A client of an earlier server in this process knows the address of that one.
        pytest.importorskip("s3fs").S3FileSystem.clear_instance_cache()
        yield made
    made.kill()


def put(path: str, content: bytes) -> None:
    remote.put(path, lambda file: file.write(content))


@pytest.fixture(params=["s3", "memory", "file", "path"])
def folder(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    if request.param == "s3":
        request.getfixturevalue("server")
    places = {"s3": "s3://bucket", "memory": "memory://", "file": f"file://{tmp_path}", "path": str(tmp_path)}
    return remote.place_of(f"{places[request.param]}/{tmp_path.name}/")


def test_files_are_put_listed_read_and_removed(folder: str) -> None:
    def write(file: BinaryIO) -> None:
        file.write(b"abc" * 1000)

    assert remote.listing(folder) == []
    assert remote.size(f"{folder}/b.bin") is None
    remote.put(f"{folder}/b.bin", write)
    put(f"{folder}/a.bin", b"first")
    put(f"{folder}/a.bin", b"second")
    put(f"{folder}/deep/c.bin", b"")
    assert remote.listing(folder) == ["a.bin", "b.bin"]
    assert remote.size(f"{folder}/a.bin")
    assert remote.size(f"{folder}/deep") is None
    assert (remote.size(f"{folder}/b.bin"), remote.size(f"{folder}/deep/c.bin")) == (3000, 0)
    with remote.read(f"{folder}/b.bin") as file:
        file.seek(-4, os.SEEK_END)
        assert file.read() == b"cabc"
        file.seek(3)
        assert (file.read(2), file.tell(), file.read(0)) == (b"ab", 5, b"")
    with remote.read(f"{folder}/a.bin") as file:
        assert file.read() == b"second"
    remote.remove(f"{folder}/a.bin")
    assert remote.listing(folder) == ["b.bin"]
    with pytest.raises(OSError, match=r"[Nn]o such file"):
        remote.read(f"{folder}/a.bin")
    assert remote.size(f"{folder}/a.bin") is None


def test_what_fails_while_it_is_written_leaves_the_old_file(folder: str) -> None:
    def break_off(file: BinaryIO) -> None:
        file.write(b"half")
        raise KeyboardInterrupt

    put(f"{folder}/a.bin", b"whole")
    with pytest.raises(KeyboardInterrupt):
        remote.put(f"{folder}/a.bin", break_off)
    assert remote.listing(folder) == ["a.bin"]
    with remote.read(f"{folder}/a.bin") as file:
        assert file.read() == b"whole"


def test_parquet_in_a_store_is_read_by_parts(server: Server) -> None:
    pa = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    file = BytesIO()
    parquet.write_table(pa.table({"a": list(range(100_000)), "b": [str(k) for k in range(100_000)]}), file, 1000)
    put("s3://bucket/table.parquet", file.getvalue())
    with remote.read("s3://bucket/table.parquet") as there:
        table = parquet.ParquetFile(there)
        assert table.metadata.num_rows == 100_000
        assert table.read_row_group(7, columns=["a"])["a"].to_pylist() == list(range(7000, 8000))


def test_a_server_that_comes_back_is_waited_for(server: Server) -> None:
    server.kill()
    again = threading.Timer(2.0, server.start)
    again.start()
    put("s3://bucket/patient.bin", b"there")
    again.join()
    with remote.read("s3://bucket/patient.bin") as file:
        assert file.read() == b"there"


def test_a_server_that_stays_away_is_said(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(remote, "PATIENCE", 0.0)
    server.kill()
    try:
        with pytest.raises(OutputError, match=r"^s3://bucket/away.bin: the store does not answer: "):
            put("s3://bucket/away.bin", b"there")
        with pytest.raises(OutputError, match="does not answer"):
            remote.size("s3://bucket/away.bin")
        with pytest.raises(FontError, match="does not answer"):
            find_fonts(["s3://bucket/fonts/*.ttf"])
    finally:
        server.start()


@pytest.mark.parametrize(
    ("url", "said"),
    [
        (
            "nothing://bucket/a",
            "nothing://bucket/a: nothing:// is not written to, only folders and object stores: abfs",
        ),
        (f"s3://somebody:{SECRET}@bucket/a", "s3://bucket/a: credentials do not belong into a URL"),
        ("s3://no-such-bucket/a", "s3://no-such-bucket/a: cannot be written: The specified bucket does not exist"),
        ("ftp://127.0.0.1/a", "ftp://127.0.0.1/a: ftp:// is not written to, only folders and object stores: abfs"),
    ],
)
def test_a_url_that_cannot_be_used_is_said(url: str, said: str, server: Server) -> None:
    with pytest.raises(GlyphsplineError, match=said) as caught:
        put(url, b"")
    assert SECRET not in str(caught.value)


def test_a_font_s_url_that_cannot_be_used_is_said() -> None:
    with pytest.raises(
        GlyphsplineError, match=r"nothing://bucket/a\.ttf: is no URL that can be used: Protocol not known"
    ):
        find_fonts(["nothing://bucket/a.ttf"])


def test_a_store_that_refuses_is_said(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    from fsspec.implementations.memory import MemoryFileSystem

    def refuse(*args: object, **kwargs: object) -> None:
        raise PermissionError("Access Denied")

    monkeypatch.setattr(MemoryFileSystem, "put_file", refuse)
    with pytest.raises(OutputError, match="memory://a/b: the store refuses: Access Denied"):
        put("memory://a/b", b"")


def test_fonts_are_fetched_once_by_content(server: Server, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "cache"))
    content = FONT.read_bytes()
    for name in ("fonts/a.ttf", "fonts/deep/b.otf", "fonts/README.txt", "copies/a.ttf"):
        put(f"s3://bucket/{name}", content if name.endswith("tf") else b"text")
    put("s3://bucket/fonts/deep/c.ttf", b"other")
    assert [path.name for path in find_fonts(["s3://bucket/fonts/a.ttf"])] == ["a.ttf"]
    found = find_fonts(["s3://bucket/fonts", "s3://bucket/copies/"])
    assert sorted(path.name for path in found) == ["a.ttf", "b.otf", "c.ttf"]
    assert {path.read_bytes() for path in found} == {content, b"other"}
    assert [path.name for path in find_fonts(["s3://bucket/fonts/*/*.ttf"])] == ["c.ttf"]
    (tmp_path / "list.txt").write_text("s3://bucket/fonts/deep/b.otf\n")
    assert [path.name for path in find_fonts([f"@{tmp_path / 'list.txt'}"])] == ["b.otf"]
    kept = [path for path in (tmp_path / "cache").rglob("*") if path.is_file()]
    assert sorted(kept) == sorted(found)
    assert find_fonts([FONT.as_uri()]) == [FONT]
    for wrong in ("s3://bucket/fonts/nothing.ttf", "s3://bucket/fonts/*.woff", "s3://nowhere/a.ttf"):
        with pytest.raises(FontError, match=r"no such file|no fonts"):
            find_fonts([wrong])


def content(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


FONTS = sorted(str(path) for path in FONT.parent.glob("kouzan-*") if path.suffix != ".csv")
LETTERS = DatasetSpec(points=16, options=None)


make = partial(dataset, sizes=Sizes(shard=12, chunk=4))


@pytest.fixture
def expected(tmp_path: Path) -> dict[str, bytes]:
    make(FONTS, tmp_path / "here", LETTERS, jobs=0)
    found = content(tmp_path / "here")
    assert len([name for name in found if name.startswith("data/")]) > 4
    return found


def test_a_run_goes_on_after_its_server_was_killed(
    server: Server, expected: dict[str, bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(remote, "PATIENCE", 0.0)
    there = server.folder / "bucket" / "resumed"

    reached: list[int] = []

    def kill(done: int, total: int, failed: int) -> None:
        reached.append(done)
        if done > total / 2:
            server.kill()

    with pytest.raises(OutputError, match="does not answer"):
        make(FONTS, "s3://bucket/resumed/", LETTERS, jobs=0, observer=kill)
    before = {path: path.stat().st_mtime_ns for path in there.rglob("*.parquet")}
    server.start()
    assert 1 <= len(before) < len(expected) - 3
    done: list[int] = []
    make(FONTS, "s3://bucket/resumed", LETTERS, jobs=0, observer=lambda number, total, failed: done.append(number))
    assert done[0] > reached[-1] > 12, "what is finished is made again"
    assert not list((server.folder / "cache" / "glyphspline" / "runs").iterdir())
    assert content(there) == expected
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert not [name for name, found in content(there).items() if SECRET.encode() in found]
    with pytest.raises(OutputError, match="holds another data set"):
        make(FONTS, "s3://bucket/resumed", DatasetSpec(points=17, options=None), jobs=0)


@pytest.mark.needs("distributed")
def test_a_cluster_that_loses_a_worker_and_a_server_that_is_restarted_do_not_show(
    server: Server, expected: dict[str, bytes], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    distributed = import_module("distributed")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    for font in FONTS:
        put(f"s3://bucket/installed/{Path(font).name}", Path(font).read_bytes())
    happened: list[int] = []
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, host="127.0.0.1", silence_logs=50
    ) as cluster:
        victim = next(iter(cluster.workers.values())).pid

        def harm(done: int, total: int, failed: int) -> None:
            if not happened:
                os.kill(victim, signal.SIGKILL)
                server.kill()
                happened.append(done)
                threading.Timer(2.0, server.start).start()

        make("s3://bucket/installed", "s3://bucket/far", LETTERS, scheduler=cluster.scheduler_address, observer=harm)
    assert happened
    assert content(server.folder / "bucket" / "far") == expected
