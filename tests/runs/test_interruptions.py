"""Runs over many glyphs that are interrupted, and gone on with: the folder is the same to the byte."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from glyphspline.errors import OutputError
from glyphspline.fitting.options import Options
from glyphspline.readers import Font, open_font
from glyphspline.runs.convert import convert_font, write_gallery
from glyphspline.runs.engine import Job
from glyphspline.runs.folder import JOURNAL
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
    assert (tmp_path / JOURNAL).exists()
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
    kept = tmp_path / ".unfinished" / "2"
    kept.write_bytes(kept.read_bytes()[:-1])
    assert convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0).done == MANY - 2 * CHUNK
    (table,) = tmp_path.glob("*.parquet")
    table.write_bytes(table.read_bytes()[:-9])
    assert convert_font(font, font.glyph_names[:CHUNK], tmp_path, SPEC, jobs=0).done == CHUNK - 1
    assert convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0).done == MANY - CHUNK - 1
    assert content(tmp_path) == content(finished)
    assert not (tmp_path / "results").exists()
