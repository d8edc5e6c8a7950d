"""Runs over many glyphs that are interrupted, and gone on with: the folder is the same to the byte."""

from __future__ import annotations

import json
import shutil
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from glyphspline.errors import OutputError
from glyphspline.fitting.options import Options
from glyphspline.readers import Font, open_font
from glyphspline.runs import record
from glyphspline.runs.convert import convert_font, write_gallery
from glyphspline.runs.engine import Job
from glyphspline.runs.folder import MANIFEST
from glyphspline.runs.record import RECORD
from glyphspline.runs.spec import RunSpec
from tests.runs.test_batch import content
from tests.runs.test_hostile import built, square

SPEC = RunSpec(Options(step=300.0), ("svg", "gallery", "parquet"))
CHUNK = 10
MANY = 16 * CHUNK + 5
"""Glyphs of which each of two workers gets whole chunks."""


@pytest.fixture(autouse=True)
def small_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Job, "chunk", CHUNK)


@pytest.fixture(scope="module")
def font(tmp_path_factory: pytest.TempPathFactory) -> Font:
    path = tmp_path_factory.mktemp("font") / "many.ttf"
    empty = [3, CHUNK]
    names = {f"glyph{k:03}": square(0.0 if k in empty else 300.0 + k) for k in range(MANY - 1)}
    built({".notdef": square(), **names}).save(path)
    return open_font(path)


@pytest.fixture(scope="module")
def finished(font: Font, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("runs") / "finished"
    summary = convert_font(font, font.glyph_names, out, SPEC, jobs=0)
    assert summary.statuses == {"ok": MANY - 2, "empty": 2}
    return out


def stop_at(least: int) -> Any:
    def observe(done: int, total: int, failed: int) -> None:
        if done >= least:
            raise KeyboardInterrupt

    return observe


def test_the_gallery_written_again_is_the_same(finished: Path, font: Font, tmp_path: Path) -> None:
    convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=2)
    assert content(tmp_path) == content(finished)
    for path in [tmp_path / "index.html", tmp_path / "gallery" / "run.js", tmp_path / "gallery" / "table-00000.js"]:
        path.unlink()
    write_gallery(tmp_path)
    assert content(tmp_path) == content(finished)


def test_an_interrupted_run_ends_with_the_same_files(finished: Path, font: Font, tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0, observer=stop_at(3 * CHUNK))
    (tmp_path / "gallery" / ".glyph001.glyph.js-1.part").write_text("half a fi")
    assert convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=2).done == MANY - 3 * CHUNK
    assert content(tmp_path) == content(finished)


def test_glyphs_between_those_that_are_there_are_added(finished: Path, font: Font, tmp_path: Path) -> None:
    convert_font(font, font.glyph_names[1::2], tmp_path, SPEC, jobs=0)
    convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0)
    assert content(tmp_path) == content(finished)


def test_drawings_lost_or_cut_are_made_again(finished: Path, font: Font, tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0, observer=stop_at(2 * CHUNK))
    drawings = sorted((tmp_path / "svg").iterdir())
    drawings[0].unlink()
    drawings[1].write_bytes(drawings[1].read_bytes()[:-1])
    assert convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0).done == MANY - 2 * CHUNK + 2
    assert content(tmp_path) == content(finished)


def test_a_power_cut_after_the_end_may_leave_empty_drawings(finished: Path, font: Font, tmp_path: Path) -> None:
    convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0)
    emptied = sorted((tmp_path / "svg").iterdir())[7:9]
    for drawing in emptied:
        drawing.write_bytes(b"")
    assert convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0).done == 2
    assert content(tmp_path) == content(finished)


def test_a_gallery_that_could_not_be_written_is_made_up_for(finished: Path, font: Font, tmp_path: Path) -> None:
    (tmp_path / "index.html").mkdir()
    with pytest.raises(OutputError):
        convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0)
    assert (tmp_path / RECORD).exists()
    with pytest.raises(OutputError, match="no finished run"):
        write_gallery(tmp_path)
    (tmp_path / "index.html").rmdir()
    assert convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0).done == 0
    assert content(tmp_path) == content(finished)


def test_a_file_that_cannot_be_written_ends_a_run_that_can_go_on(finished: Path, font: Font, tmp_path: Path) -> None:
    blocked = tmp_path / "gallery" / "glyph100.glyph.js"
    blocked.mkdir(parents=True)
    with pytest.raises(OutputError, match=blocked.name):
        convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=2)
    blocked.rmdir()
    assert convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=2).done >= CHUNK
    assert content(tmp_path) == content(finished)


def test_rows_are_made_once_and_a_table_that_is_lost_or_broken_is_made_again(
    finished: Path, font: Font, tmp_path: Path
) -> None:
    with pytest.raises(KeyboardInterrupt):
        convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0, observer=stop_at(3 * CHUNK))
    with sqlite3.connect(tmp_path / RECORD) as db:
        db.execute("update batch set rows = substr(rows, 1, length(rows) - 1) where number = 3")
    db.close()
    assert convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0).done == MANY - 2 * CHUNK
    (table,) = tmp_path.glob("*.parquet")
    table.write_bytes(table.read_bytes()[:-9])
    assert convert_font(font, font.glyph_names[:CHUNK], tmp_path, SPEC, jobs=0).done == CHUNK - 1
    assert convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0).done == MANY - CHUNK - 1
    assert content(tmp_path) == content(finished)
    assert not (tmp_path / "results").exists()


def killed_at(least: int, out: Path, copy: Path) -> Any:
    """An observer that ends a run, and has a copy of its folder as it would be had the process been killed."""

    def observe(done: int, total: int, failed: int) -> None:
        if done >= least:
            shutil.copytree(out, copy)
            raise KeyboardInterrupt

    return observe


def changed(file: Path, change: Callable[[bytes], bytes]) -> None:
    file.write_bytes(change(file.read_bytes()))


LOG = f"{RECORD}-wal"

TEARS: dict[str, tuple[str, Callable[[bytes], bytes]]] = {
    "nothing": (LOG, bytes),
    "empty": (RECORD, lambda data: b""),
    "cut": (RECORD, lambda data: data[: len(data) // 2]),
    "text": (RECORD, lambda data: b"no data base" * 1000),
    "zeros": (RECORD, lambda data: data[:100] + bytes(len(data) - 100)),
    "a hole": (RECORD, lambda data: data[: len(data) // 2] + bytes(5000) + data[len(data) // 2 + 5000 :]),
    "no log": (LOG, lambda data: b""),
    "half a log": (LOG, lambda data: data[: len(data) // 2]),
    "a log that ends with zeros": (LOG, lambda data: data[: len(data) // 2] + bytes(len(data) // 2)),
    "text for a log": (LOG, lambda data: b"no log" * 5000),
}


ADDED = MANY - MANY // 2
"""Glyphs that are added to a folder that has every other one."""


@pytest.fixture(scope="module")
def stopped(font: Font, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A finished folder to which glyphs are added, after three chunks: the run was stopped, or killed."""
    out = tmp_path_factory.mktemp("stopped")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Job, "chunk", CHUNK)
        convert_font(font, font.glyph_names[1::2], out / "stopped", SPEC, jobs=0)
        observer = killed_at(MANY - ADDED + 3 * CHUNK, out / "stopped", out / "killed")
        with pytest.raises(KeyboardInterrupt):
            convert_font(font, font.glyph_names, out / "stopped", SPEC, jobs=0, observer=observer)
    return out / "stopped", out / "killed"


@pytest.mark.parametrize("tear", TEARS)
def test_a_torn_record_costs_time_alone(
    tear: str, stopped: tuple[Path, Path], finished: Path, font: Font, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    name, change = TEARS[tear]
    shutil.copytree(stopped[name == LOG], tmp_path, dirs_exist_ok=True)
    changed(tmp_path / name, change)
    done = convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0).done
    assert ADDED - 3 * CHUNK < done + (tear == "nothing") <= ADDED
    assert bool(caplog.records) == (done == ADDED) or name == LOG  # a log that ends early is one of an earlier moment
    assert content(tmp_path) == content(finished)


def test_a_record_that_a_disk_has_changed_is_not_trusted(
    stopped: tuple[Path, Path], font: Font, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    shutil.copytree(stopped[0], tmp_path, dirs_exist_ok=True)
    with sqlite3.connect(tmp_path / RECORD) as db:
        db.execute("update glyph set sizes = cast(x'ff31' as text) where gid = 5")
    db.close()
    assert convert_font(font, font.glyph_names[1::2], tmp_path, SPEC, jobs=0).done == 0
    assert "damaged" in caplog.text
    assert len((tmp_path / MANIFEST).read_text().splitlines()) == MANY - ADDED


def test_the_manifest_grows_while_a_run_goes_on(finished: Path, font: Font, tmp_path: Path) -> None:
    found = []

    def observe(done: int, total: int, failed: int) -> None:
        lines = (tmp_path / MANIFEST).read_text().splitlines()
        found.append((done, [json.loads(line)["gid"] for line in lines]))
        if done == 5 * CHUNK:
            (tmp_path / MANIFEST).write_text("\n".join([*lines[:-1], lines[-1][:9]]))  # as a kill may leave it
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0, observer=observe)
    convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0, observer=observe)
    assert found[5][0] == 6 * CHUNK
    assert all(gids == list(range(done)) for done, gids in found)
    assert content(tmp_path) == content(finished)


@pytest.mark.parametrize("is_local", [True, False])
def test_a_shared_folder_has_no_write_ahead_log(
    is_local: bool, finished: Path, font: Font, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(record, "local", lambda folder: is_local)
    out, copy = tmp_path / "out", tmp_path / "copy"
    with pytest.raises(KeyboardInterrupt):
        convert_font(font, font.glyph_names, out, SPEC, jobs=0, observer=killed_at(3 * CHUNK, out, copy))
    assert (copy / LOG).exists() == is_local
    assert convert_font(font, font.glyph_names, copy, SPEC, jobs=0).done == MANY - 3 * CHUNK
    assert content(copy) == content(finished)


def test_disks_of_this_machine_are_told_from_shared_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    mounts = [
        "/dev/a / ext4 rw 0 0",
        "home:/ /home nfs4 rw 0 0",
        "b /home/my\\040disk xfs rw 0 0",
        "c /c fuse.sshfs rw 0 0",
    ]
    monkeypatch.setattr(Path, "read_text", lambda *_, **__: "\n".join(mounts))
    found = [record.local(Path(name)) for name in ("/", "/homes", "/home/a", "/home/my disk/a", "/c/a")]
    assert found == [True, True, False, True, False]
    del mounts[:]
    assert not record.local(Path("/"))


@pytest.mark.parametrize("left", [".journal.jsonl", ".unfinished/0"])
def test_what_an_older_version_left_unfinished_is_refused(
    left: str, finished: Path, font: Font, tmp_path: Path
) -> None:
    (tmp_path / "svg").mkdir()
    (tmp_path / "svg" / "other.svg").write_text("<svg/>")
    (tmp_path / left).parent.mkdir(exist_ok=True)
    (tmp_path / left).write_text('6\t{"glyph":"other","gid":9,"files":{"svg":"svg/other.svg"}}\n')
    with pytest.raises(OutputError, match=rf"older version.*{left.partition('/')[0]}.*--restart"):
        convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0)
    convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0, restart=True)
    assert (tmp_path / "svg" / "other.svg").exists() == (left != ".journal.jsonl")
    (tmp_path / "svg" / "other.svg").unlink(missing_ok=True)
    assert content(tmp_path) == content(finished)
