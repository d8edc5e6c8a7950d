"""Data sets of fonts: the same bytes however they are made, splits by family, what fails, and how others open them."""

from __future__ import annotations

import json
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import Executor, Future
from dataclasses import replace
from functools import partial
from hashlib import sha256
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.dataset as pads
import pyarrow.parquet as pq
import pytest
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.plugins.datasets.canonical_outlines import canonical_outlines
from glyphspline.plugins.datasets.card import command
from glyphspline.plugins.datasets.kept import Made
from glyphspline.plugins.datasets.plan import DatasetTask, Plan, plan_of
from glyphspline.plugins.datasets.run import RowsJob
from glyphspline.plugins.datasets.scan import SPLITS, FontFacts, licence_of, split_of
from glyphspline.plugins.datasets.spec import DatasetSpec, Sizes
from glyphspline.runs.engine import Part, run
from glyphspline.runs.pool import WorkerLostError
from glyphspline.runs.shapes import Shapes
from tests.character_fonts import HEAVY, font_of
from tests.places import FONTS

PLAIN = DatasetSpec(options=None, points=8)
SMALL = Sizes(shard=25, chunk=10, group=10)
"""Few glyphs in a shard, so that the test fonts fill several."""

dataset = partial(gs.dataset, sizes=SMALL)


def contents(folder: Path) -> dict[str, str]:
    """A hash of every file."""
    files = [path for path in sorted(folder.rglob("*")) if path.is_file()]
    return {str(path.relative_to(folder)): sha256(path.read_bytes()).hexdigest() for path in files}


def rows_of(folder: Path) -> list[dict[str, Any]]:
    """All rows, in the order in which they are written."""
    files = [path for split in SPLITS for path in sorted((folder / "data").glob(f"{split}-*"))]
    return [row for path in files for row in pq.read_table(path).to_pylist()]


def fonts_of(folder: Path) -> dict[tuple[str, int], dict[str, Any]]:
    """Rows of ``fonts.parquet`` by file and face."""
    return {(row["file"], row["face"]): row for row in pq.read_table(folder / "fonts.parquet").to_pylist()}


def renamed(path: Path, source: str, **names: str) -> Path:
    """A font with other entries of its name table: family, version, copyright, licence, url."""
    numbers = {"copyright": 0, "family": 1, "version": 5, "licence": 13, "url": 14}
    font = TTFont(FONTS / source)
    for name, text in names.items():
        font["name"].setName(text, numbers[name], 3, 1, 0x409)
        font["name"].setName(text, numbers[name], 1, 0, 0)
    font.save(path)
    return path


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The data set of all test fonts."""
    out = tmp_path_factory.mktemp("whole") / "set"
    dataset(FONTS, out, PLAIN, jobs=0)
    return out


# The same bytes


def test_the_bytes_do_not_depend_on_the_number_of_workers(whole: Path, tmp_path: Path) -> None:
    dataset([str(path) for path in sorted(FONTS.iterdir(), reverse=True) if path.suffix not in (".md", ".csv")],
               tmp_path / "2", PLAIN, jobs=2)  # fmt: skip
    found = contents(tmp_path / "2")
    assert found == contents(whole)
    assert sum(name.startswith("data/") for name in found) > 4
    assert str(tmp_path).encode() not in (tmp_path / "2" / "dataset.json").read_bytes()


MAKE = """
import sys, time
import glyphspline as gs
from glyphspline.plugins.datasets.spec import DatasetSpec, Sizes
sizes = Sizes(shard=25, chunk=10, group=10)
wait = lambda done, total, failed: time.sleep(0.15)
gs.dataset(sys.argv[1], sys.argv[2], DatasetSpec(options=None, points=8), jobs=0, observer=wait, sizes=sizes)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="kills as POSIX does")
@pytest.mark.parametrize("finished", [1, pytest.param(3, marks=pytest.mark.long)])
def test_a_run_that_was_killed_goes_on_and_ends_with_the_same_bytes(finished: int, whole: Path, tmp_path: Path) -> None:
    out = tmp_path / "killed"
    run = subprocess.Popen([sys.executable, "-c", MAKE, str(FONTS), str(out)])
    try:
        until = time.monotonic() + 600
        while len(list(out.glob("data/*.parquet"))) < finished:
            assert run.poll() is None
            assert time.monotonic() < until
            time.sleep(0.01)
    finally:
        os.kill(run.pid, signal.SIGKILL)
        run.wait()
    before = {path: path.stat().st_mtime_ns for path in out.glob("data/*.parquet")}
    assert finished <= len(before) < len(list((whole / "data").iterdir()))
    assert not (out / "README.md").exists()
    dataset(FONTS, out, PLAIN, jobs=0)
    assert {path: path.stat().st_mtime_ns for path in before} == before  # none was made again
    assert contents(out) == contents(whole)


class StoppedError(Exception):
    pass


SOME, ONE = replace(PLAIN, characters="龍好愛國書法永之あいうのをABgO"), replace(SMALL, shard=1000)


@pytest.fixture(scope="module")
def one_shard(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A data set of a shard a split."""
    out = tmp_path_factory.mktemp("one") / "set"
    dataset(FONTS, out, SOME, jobs=0, sizes=ONE)
    return out


@pytest.mark.parametrize("damage", ["", "cut", "changed", "link"])
def test_a_run_that_was_stopped_within_a_shard_keeps_its_glyphs(
    damage: str, one_shard: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    counts = list[int]()
    together = RowsJob.together

    def counted(self: RowsJob, tasks: Any, contents: Any) -> Made:
        counts.append(len(tasks))
        return together(self, tasks, contents)

    def until(done: int, total: int, failed: int) -> None:
        if done >= 20:
            raise StoppedError

    monkeypatch.setattr(RowsJob, "together", counted)
    glyphs, out = len(rows_of(one_shard)), tmp_path / "stopped"
    with pytest.raises(StoppedError):
        dataset(FONTS, out, SOME, jobs=0, observer=until, sizes=ONE)
    kept, made = out / ".record.sqlite", sum(counts)
    assert not list(out.glob("data/*.parquet"))
    if damage == "link":
        kept.rename(tmp_path / "victim")
        kept.symlink_to(tmp_path / "victim")
    elif damage:
        with sqlite3.connect(kept) as db:
            number, rows = db.execute("select max(number), rows from batch").fetchone()
            middle = len(rows) // 2
            torn = rows[:-1] if damage == "cut" else rows[:middle] + bytes([rows[middle] ^ 1]) + rows[middle + 1 :]
            db.execute("update batch set rows = ? where number = ?", (torn, number))
        db.close()
    counts.clear()
    dataset(FONTS, out, SOME, jobs=0, sizes=ONE)
    again = sum(counts) - (glyphs - made)
    assert again == made if damage == "link" else (0 < again <= 10) == bool(damage)
    assert contents(out) == contents(one_shard)


@pytest.mark.parametrize("rows", ["glyph", "contour"])
@pytest.mark.parametrize(
    ("options", "count"),
    [(gs.Options(), 0), (gs.Options(tolerance=1e-5, corners="smooth"), 2), (gs.Options(step=300.0), 0)],
)
def test_glyphs_that_miss_the_tolerance_are_counted(rows: Any, options: gs.Options, count: int, tmp_path: Path) -> None:
    spec = DatasetSpec(options=options, characters="O8", rows=rows)
    for _ in range(2):
        summary = dataset(FONTS / "kouzan-gyosho.ttf", tmp_path, spec, jobs=0)
        assert (summary.glyphs, summary.outside_tolerance) == (2, count)


def test_shards_that_are_gone_or_broken_are_made_again(whole: Path, tmp_path: Path) -> None:
    out = shutil.copytree(whole, tmp_path / "set")
    files = sorted((out / "data").iterdir())
    files[0].unlink()
    files[2].write_bytes(files[2].read_bytes()[:-100])
    shutil.copy(files[3], files[1])  # of the same run, but not this shard
    (out / "fonts.parquet").unlink()
    dataset(FONTS, out, PLAIN, jobs=0)
    assert contents(out) == contents(whole)


def test_a_folder_with_something_else_is_left_alone(tmp_path: Path) -> None:
    dataset(FONTS / "variable.ttf", tmp_path / "set", PLAIN, jobs=0)
    before = contents(tmp_path / "set")
    with pytest.raises(gs.OutputError, match=r"spec\.points: 8 in the folder, 9 now"):
        dataset(FONTS / "variable.ttf", tmp_path / "set", replace(PLAIN, points=9), jobs=0)
    with pytest.raises(gs.OutputError, match=r"fonts\.count: 1 in the folder, 2 now"):
        dataset([FONTS / "variable.ttf", FONTS / "edge-cases.ttf"], tmp_path / "set", PLAIN, jobs=0)
    assert contents(tmp_path / "set") == before
    dataset(FONTS / "edge-cases.ttf", tmp_path / "set", replace(PLAIN, points=9), jobs=0, restart=True)
    dataset(FONTS / "edge-cases.ttf", tmp_path / "new", replace(PLAIN, points=9), jobs=0)
    assert contents(tmp_path / "set") == contents(tmp_path / "new")
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "README.md").write_text("mine")
    for restart in (False, True):
        with pytest.raises(gs.OutputError, match="of no data set"):
            dataset(FONTS / "variable.ttf", tmp_path / "other", PLAIN, jobs=0, restart=restart)
        (tmp_path / "other" / "dataset.json").write_text('{"name": "mine too"}')
    assert [path.name for path in sorted((tmp_path / "other").iterdir())] == ["README.md", "dataset.json"]


class Scrambled(Executor):
    """Finishes calls in another order, and loses a worker at one of them."""

    _max_workers = 3

    def __init__(self, lost: int) -> None:
        self.open: list[tuple[Future[Any], Callable[..., Any], tuple[Any, ...]]] = []
        self.lost, self.most, self.random = lost, 0, np.random.default_rng(1)

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.open.append((Future(), fn, args))
        future = self.open[-1][0]
        self.most = max(self.most, len(self.open))
        if len(self.open) == 12:
            while self.open:
                self.finish(*self.open.pop(int(self.random.integers(len(self.open)))))
        return future

    def finish(self, future: Future[Any], fn: Callable[..., Any], args: tuple[Any, ...]) -> None:
        tasks: list[DatasetTask] = args[1]
        if any(task.at == self.lost for task in tasks):
            future.set_exception(WorkerLostError("the worker process died"))
        else:
            future.set_result([Part(tasks, Made(b"", len(tasks), []))])


def test_rows_come_in_order_from_workers_that_do_not(monkeypatch: pytest.MonkeyPatch) -> None:
    font = FontFacts(Path("gone.ttf"), "gone.ttf", sha256="a", split="train", taken=SMALL.shard * 40)
    whole = Plan(PLAIN, (font,), SMALL)
    pool = Scrambled(lost=437)

    def ending(*args: Any, **kwargs: Any) -> Any:  # the last calls, which are fewer than are waited for
        while pool.open:
            pool.finish(*pool.open.pop())
        return waited(*args, **kwargs)

    from glyphspline.runs import engine

    waited = vars(engine)["wait"]
    monkeypatch.setattr(engine, "wait", ending)
    chunks = (chunk for shard in whole.shards for chunk in whole.chunks(shard))
    found = list(run(RowsJob(PLAIN), (), pool, ordered=True, chunks=chunks))
    numbers = [task.at for part in found for task in part.tasks]
    assert numbers == list(range(SMALL.shard * 40))
    assert [part.result.failed for part in found if part.result.failed] == [[("#437", "the worker process died")]]


class Lossy(Executor):
    """Loses its worker with each call."""

    _max_workers = 1

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_exception(WorkerLostError("the worker process died"))
        return future


def test_glyphs_that_cost_a_worker_are_named() -> None:
    facts = FontFacts(FONTS / "kouzan-kaisho.ttf", "kouzan-kaisho.ttf", sha256="a", split="train", taken=5)
    spec = replace(PLAIN, characters="あいうのを")
    whole = Plan(spec, (facts,), SMALL)
    found = run(RowsJob(spec), (), Lossy(), ordered=True, chunks=whole.chunks(whole.shards[0]))
    assert [name for part in found for name, _ in part.result.failed] == [f"uni{ord(c):04X}" for c in "あいうのを"]


# What is taken


def test_splits_are_of_families_and_do_not_depend_on_other_fonts(tmp_path: Path) -> None:
    spec = replace(PLAIN, validation=0.3, test=0.3, characters="A")
    for k in range(12):
        (tmp_path / "fonts").mkdir(exist_ok=True)
        for style in ("one", "two"):
            renamed(tmp_path / "fonts" / f"{k}-{style}.ttf", "kouzan-gyosho.ttf", family=f"Family {k}", version=style)
    dataset(tmp_path / "fonts", tmp_path / "set", spec, jobs=0)
    splits: dict[str, set[str]] = {}
    for row in rows_of(tmp_path / "set"):
        splits.setdefault(row["family"], set()).add(row["split"])
    assert len(splits) == 12
    assert all(len(found) == 1 for found in splits.values())
    assert {split for found in splits.values() for split in found} == set(SPLITS)
    assert splits == {family: {split_of(family, spec)} for family in splits}
    dataset(tmp_path / "fonts" / "3-one.ttf", tmp_path / "alone", spec, jobs=0)
    assert {row["split"] for row in rows_of(tmp_path / "alone")} == splits["Family 3"]


def test_shares_of_splits_are_kept_over_many_families() -> None:
    spec = replace(PLAIN, validation=0.2, test=0.1)
    found = [split_of(f"Family {k}", spec) for k in range(4000)]
    assert found.count("test") / 4000 == pytest.approx(0.1, abs=0.015)
    assert found.count("validation") / 4000 == pytest.approx(0.2, abs=0.02)
    moved = sum(a != split_of(f"Family {k}", replace(spec, seed=1)) for k, a in enumerate(found))
    assert moved > 1000
    wider = replace(spec, test=0.15, validation=0.15)  # what is tested on stays so
    assert all(split_of(f"Family {k}", wider) == "test" for k, a in enumerate(found) if a == "test")


def test_characters_scripts_and_coverage_choose(tmp_path: Path) -> None:
    spec = replace(PLAIN, characters="AB龍Ω", coverage=0.5)
    summary = dataset(FONTS, tmp_path / "some", spec, jobs=0)
    rows = rows_of(tmp_path / "some")
    assert {row["characters"] for row in rows} == {"A", "B", "龍"}
    assert {(row["script"], row["category"]) for row in rows} == {("Latn", "Lu"), ("Hani", "Lo")}
    fonts = fonts_of(tmp_path / "some")
    left = {file for (file, _), font in fonts.items() if font["status"] == "left out"}
    assert left == {"edge-cases.ttf", "variable.ttf", "variable-cff2.otf"} - {
        file for (file, _), font in fonts.items() if font["coverage"] >= 0.5
    }
    assert fonts["kouzan-gyosho.ttf", 0]["coverage"] == 0.75
    assert summary.rows == len(rows) == sum(font["rows"] for font in fonts.values())
    dataset(FONTS / "kouzan-kaisho.ttf", tmp_path / "kana", replace(PLAIN, scripts=("Hira",)), jobs=0)
    assert sorted(row["characters"] for row in rows_of(tmp_path / "kana")) == sorted("あいうのを")


def test_a_row_is_of_the_character_asked_for_or_of_the_usual_one(tmp_path: Path) -> None:
    """A glyph of a Kangxi radical and of the character, and one that stands for a character at an instance alone."""
    cmap = {0x2FD3: "dragon", 0x9F8D: "dragon", 0x24: "dollar"}
    font_of(tmp_path / "asked.ttf", cmap, "dollar.heavy", features=HEAVY, weight=True)
    for k, (asked, category) in enumerate({"\u2fd3$": "So", "龍$": "Lo", "": "Lo"}.items()):
        spec = DatasetSpec(options=None, characters=asked, instances="named")
        gs.dataset(tmp_path / "asked.ttf", tmp_path / f"{k}", spec, jobs=0)
        rows = [row for row in rows_of(tmp_path / f"{k}") if row["glyph"] != ".notdef"]
        assert {row["category"] for row in rows if row["glyph"] == "dragon"} == {category}
        if asked:
            found = {(row["style"], row["glyph"]): row["category"] for row in rows}
            assert found == {
                ("Regular", "dragon"): category, ("Regular", "dollar"): "Sc",
                ("Black", "dragon"): category, ("Black", "dollar.heavy"): "Sc",
            }  # fmt: skip


def test_variable_fonts_are_taken_at_their_named_instances(tmp_path: Path) -> None:
    file = FONTS / "variable-cff2.otf"
    dataset(file, tmp_path / "default", PLAIN, jobs=0)
    dataset([file, FONTS / "variable.ttf"], tmp_path / "named", replace(PLAIN, instances="named"), jobs=2)
    found = pq.read_table(tmp_path / "named" / "fonts.parquet").to_pylist()
    assert [(row["style"], row["location"], row["weight_class"]) for row in found if row["file"] == file.name] == [
        ("Regular", "wght=400,wdth=100", 400),
        ("Bold Condensed", "wght=700,wdth=75", 700),
        ("Bold", "wght=700,wdth=100", 700),
    ]
    (unnamed,) = [row for row in found if row["file"] == "variable.ttf"]  # it has no named instances
    assert (unnamed["style"], unnamed["location"]) == ("Regular", "wght=400")
    assert len({row["split"] for row in found if row["file"] == file.name}) == 1
    rows = rows_of(tmp_path / "named")
    (font,) = rows_of(tmp_path / "default")[:1]
    for style, location in gs.open_font(file).instances.items():
        source = gs.open_font(file, location=location)
        own = {row["glyph"]: row for row in rows if row["font"] == font["font"] and row["style"] == style}
        assert list(own) == list(source.glyph_names)
        for outline in canonical_outlines(source.outlines(source.glyph_names)):
            assert own[outline.name]["advance"] == outline.advance / outline.metrics.units_per_em
            contours = [np.array(contour) for contour in own[outline.name]["source_points"]]
            for one, other in zip(contours, outline.contours, strict=True):
                np.testing.assert_allclose(one * outline.metrics.units_per_em, other.points, rtol=1e-12, atol=1e-9)


def test_licences_choose_and_are_told(tmp_path: Path) -> None:
    fonts = [
        renamed(tmp_path / "ofl.ttf", "variable.ttf", licence="SIL Open Font License, Version 1.1", family="One"),
        renamed(tmp_path / "apache.ttf", "variable.ttf", url="https://apache.org/licenses/LICENSE-2.0", family="Two"),
        renamed(tmp_path / "none.ttf", "variable.ttf", copyright="All rights reserved", family="Three"),
    ]
    summary = dataset(fonts, tmp_path / "set", replace(PLAIN, licences=("OFL-1.1", "Apache-2.0")), jobs=0)
    assert {row["licence"] for row in rows_of(tmp_path / "set")} == {"OFL-1.1", "Apache-2.0"} == set(summary.licences)
    found = fonts_of(tmp_path / "set")["none.ttf", 0]
    assert (found["status"], found["licence"], found["reason"]) == ("left out", "unknown", "its licence is unknown")
    card = (tmp_path / "set" / "README.md").read_text(encoding="utf-8")
    assert "| OFL-1.1 | 1 |" in card
    assert "- apache-2.0\n- ofl-1.1" in card


@pytest.mark.parametrize(
    ("texts", "licence"),
    [
        (("This Font Software is licensed under the SIL Open Font License, Version 1.1.", None), "OFL-1.1"),
        ((None, "https://openfontlicense.org"), "OFL-1.1"),
        (("Open Font License v1.0",), "OFL-1.0"),
        (("Licensed under the Apache License, Version 2.0", None), "Apache-2.0"),
        (("Fonts are (c) Bitstream. Bitstream Vera Fonts Copyright. Permission is hereby granted, free of charge",),
         "Bitstream-Vera"),
        (("GPL- General Public License version 2 or later AND OFL-Open Font License",), "OFL-1.1 OR GPL-2.0-or-later"),
        (("GNU General Public License, version 3, with font exception",), "GPL-3.0-only WITH Font-exception-2.0"),
        (("released under GNU GPL v2.0",), "GPL-2.0-only"),
        (("http://ipafont.ipa.go.jp/ipa_font_license_v1.html",), "IPA"),
        (("GNU Lesser General Public License v3",), "LGPL-3.0-only"),
        ((None, None, "These fonts are in the public domain"), "LicenseRef-public-domain"),
        (("All rights reserved", None, "Released under the MIT License"), "MIT"),
        (("You may not copy this", "https://example.org/eula", "Copyright Foundry"), "unknown"),
        ((None, None, None), "unknown"),
    ],
)  # fmt: skip
def test_licences_are_told_apart(texts: tuple[str | None, ...], licence: str) -> None:
    assert licence_of(*texts) == licence


# What fails


def broken_glyph(path: Path) -> Path:
    """A font one of whose glyphs is a component of itself."""
    tables = TTFont(FONTS / "edge-cases.ttf", recalcBBoxes=False)
    name = tables.getGlyphOrder()[3]
    pen = TTGlyphPen(dict.fromkeys(tables.getGlyphOrder()))
    pen.addComponent(name, (1, 0, 0, 1, 0, 0))
    glyph = pen.glyph()
    glyph.xMin = glyph.yMin = glyph.xMax = glyph.yMax = 0
    tables["glyf"][name] = glyph
    tables.save(path)
    return path


@pytest.mark.parametrize("jobs", [0, 2])
def test_broken_fonts_and_glyphs_cost_only_themselves(jobs: int, tmp_path: Path) -> None:
    (tmp_path / "fonts").mkdir()
    broken = broken_glyph(tmp_path / "fonts" / "glyph.ttf")
    (tmp_path / "fonts" / "cut.ttf").write_bytes((FONTS / "kouzan-gyosho.ttf").read_bytes()[:3000])
    (tmp_path / "fonts" / "text.otf").write_text("no font")
    shutil.copy(FONTS / "variable.ttf", tmp_path / "fonts")
    summary = dataset(tmp_path / "fonts", tmp_path / "set", PLAIN, jobs=jobs)
    found = fonts_of(tmp_path / "set")
    assert {file: font["status"] for (file, _), font in found.items()} == {
        "glyph.ttf": "taken", "variable.ttf": "taken", "cut.ttf": "failed", "text.otf": "failed",
    }  # fmt: skip
    assert all(found[file, 0]["reason"] for file in ("cut.ttf", "text.otf"))
    name = gs.open_font(broken).glyph_names[3]
    font = found["glyph.ttf", 0]
    assert (font["failed"], font["rows"]) == (1, font["taken"] - 1)
    assert font["failures"][0].startswith(f"{name}: ")
    assert str(tmp_path) not in font["failures"][0]
    assert (summary.failed, summary.fonts["failed"]) == (1, 2)
    assert name not in {row["glyph"] for row in rows_of(tmp_path / "set") if row["font"] == font["sha256"]}
    assert any("glyph failed" in line for line in summary.lines())


def test_names_that_would_escape_stay_in_their_cells(tmp_path: Path) -> None:
    nasty = '../../x"|---\n# Evil\x1b[31m\x00 <script>```'
    (tmp_path / "fonts").mkdir()
    renamed(tmp_path / "fonts" / "a|b`c.ttf", "kouzan-gyosho.ttf", family=nasty, licence=nasty + " OFL", url=nasty)
    spec = replace(PLAIN, characters="A`\n---\n$(rm)")
    dataset(tmp_path / "fonts", tmp_path / "set", spec, jobs=0)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fonts", "set"]
    assert {path.name for path in (tmp_path / "set").iterdir()} == {
        "README.md",
        "data",
        "dataset.json",
        "fonts.parquet",
    }
    card = (tmp_path / "set" / "README.md").read_text(encoding="utf-8")
    assert "Evil" not in card
    assert "rm" not in card.split("## How it was made")[1].split("## Columns")[0].replace("characters", "")
    assert card.count("\n---\n") == 1
    assert json.loads((tmp_path / "set" / "dataset.json").read_text())["spec"]["characters"] == spec.characters
    found = fonts_of(tmp_path / "set")["a|b`c.ttf", 0]
    assert found["licence"] == "OFL-1.1"
    assert found["licence_text"].isprintable()
    assert found["family"] == rows_of(tmp_path / "set")[0]["family"]


# Duplicates


def test_fonts_and_shapes_that_are_there_twice_are_marked(tmp_path: Path) -> None:
    (tmp_path / "fonts").mkdir()
    for file in ("kouzan-gyosho.ttf", "kouzan-gyosho.woff2"):
        shutil.copy(FONTS / file, tmp_path / "fonts")
    shutil.copy(FONTS / "kouzan-gyosho.ttf", tmp_path / "fonts" / "again.ttf")
    dataset(tmp_path / "fonts", tmp_path / "set", PLAIN, jobs=0)
    fonts = fonts_of(tmp_path / "set")
    first, again = fonts["again.ttf", 0], fonts["kouzan-gyosho.ttf", 0]
    assert (first["status"], again["status"], again["same_as"]) == ("taken", "duplicate", first["sha256"])
    assert again["rows"] == again["taken"] == 0
    packed = fonts["kouzan-gyosho.woff2", 0]
    assert packed["status"] == "taken"
    assert {first["same_as"], packed["same_as"]} == {
        None,
        max(first, packed, key=lambda f: f["same_as"] is None)["sha256"],
    }
    seen: set[str] = set()
    rows = rows_of(tmp_path / "set")
    for row in rows:
        assert row["duplicate"] == (row["shape"] is not None and row["shape"] in seen)
        seen.add(row["shape"])
    ink = [row for row in rows if row["shape"] is not None]
    assert sum(row["duplicate"] for row in ink) >= len(ink) / 2  # each shape of the second font is in the first


def test_shapes_are_known_again_after_many() -> None:
    rng = np.random.default_rng(7)
    shapes, known = Shapes(), set[int]()
    for _ in range(60):
        values = rng.integers(-300, 300, rng.integers(0, 40)) * (1 << 50)
        expected = []
        for value in values.tolist():
            expected.append(value in known)
            known.add(value)
        assert (shapes.first(values) != np.arange(len(values))).tolist() == expected
    assert len(shapes) == len(known)


# What a plan packs


def test_shards_hold_each_glyph_once_and_no_more_than_they_may() -> None:
    rng = np.random.default_rng(3)
    sizes = rng.integers(1, 90, 40)
    fonts = [
        FontFacts(Path(f"{k}"), f"{k}", sha256=f"{k:03d}", split=SPLITS[k % 3], taken=int(size))
        for k, size in enumerate(sizes)
    ]
    whole = plan_of(PLAIN, [fonts[k] for k in rng.permutation(40)], SMALL)
    assert whole.digest == plan_of(PLAIN, fonts, SMALL).digest
    taken = [(task.font.file, task.at) for shard in whole.shards for chunk in whole.chunks(shard) for task in chunk]
    assert len(set(taken)) == len(taken) == sizes.sum()
    last = {shard.split: shard for shard in whole.shards}
    assert all(shard.glyphs == SMALL.shard for shard in whole.shards if shard is not last[shard.split])
    assert all(0 < shard.glyphs <= SMALL.shard for shard in last.values())
    assert all(task.font.split == shard.split for shard in whole.shards for c in whole.chunks(shard) for task in c)


# How others open it


@pytest.fixture(scope="module")
def letters(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A data set with fits."""
    out = tmp_path_factory.mktemp("letters") / "set"
    fonts = [FONTS / "kouzan-gyosho.ttf", FONTS / "variable.ttf", FONTS / "kouzan-kaisho.ttf"]
    dataset(fonts, out, DatasetSpec(points=16, characters="AOgB", validation=0.3, test=0.3), jobs=0)
    return out


def test_arrow_opens_it(letters: Path) -> None:
    table = pads.dataset(letters / "data", format="parquet").to_table()
    assert table.num_rows == len(rows_of(letters)) > 4
    assert set(table["family"].to_pylist()) >= {"Kouzan Gyosho Subset", "Kouzan Kaisho Subset"}
    for path in (letters / "data").iterdir():
        file = pq.ParquetFile(path)
        assert {file.metadata.row_group(0).column(k).compression for k in range(file.metadata.num_columns)} == {"ZSTD"}
    schema = pads.dataset(letters / "data", format="parquet").schema
    assert schema.field("ascender").metadata[b"unit"] == b"em"
    assert not any(pa.types.is_dictionary(field.type) for field in schema)  # datasets does not open these


def test_row_groups_are_bounded(whole: Path) -> None:
    for path in (whole / "data").iterdir():
        file = pq.ParquetFile(path).metadata
        sizes = [file.row_group(k).num_rows for k in range(file.num_row_groups)]
        assert all(size == 10 for size in sizes[:-1])
        assert 0 < sizes[-1] <= 10


def test_large_rows_make_small_groups_and_chunks(tmp_path: Path) -> None:
    sizes = replace(SMALL, chunk_bytes=1 << 20, group_bytes=1 << 20)
    spec = replace(PLAIN, raster=512)
    for jobs in (0, 2):
        dataset(FONTS / "kouzan-gyosho.ttf", tmp_path / str(jobs), spec, jobs=jobs, sizes=sizes)
    (file,) = (tmp_path / "0" / "data").iterdir()
    found = pq.ParquetFile(file).metadata
    groups = [found.row_group(k).num_rows for k in range(found.num_row_groups)]
    assert groups == [6, 6, 6], "a chunk has three rows of 512² pixels, and the second one fills a megabyte"
    assert contents(tmp_path / "0") == contents(tmp_path / "2")


def test_a_glyph_of_more_contours_than_real_ones_have_fails_alone(tmp_path: Path) -> None:
    tables = TTFont(FONTS / "edge-cases.ttf", recalcBBoxes=False)
    name, pen = tables.getGlyphOrder()[3], TTGlyphPen(None)
    for k in range(150):
        pen.moveTo((k, 0))
        pen.lineTo((k, 10))
        pen.lineTo((k + 1, 0))
        pen.closePath()
    tables["glyf"][name] = glyph = pen.glyph()
    glyph.recalcBounds(tables["glyf"])
    tables.save(tmp_path / "many.ttf")
    summary = dataset(tmp_path / "many.ttf", tmp_path / "set", replace(PLAIN, points=2000), jobs=0)
    assert summary.failures == [("many.ttf", name, "150 contours of 2000 points, more than the 200000 points allowed")]


def test_metrics_are_in_the_unit_that_is_asked_for(tmp_path: Path) -> None:
    for normalise in ("em", "units"):
        spec = replace(PLAIN, normalise=normalise, characters="A")
        dataset(FONTS / "kouzan-gyosho.ttf", tmp_path / normalise, spec, jobs=0)
    (em,), (units,) = rows_of(tmp_path / "em"), rows_of(tmp_path / "units")
    metrics = gs.open_font(FONTS / "kouzan-gyosho.ttf").metrics
    assert (units["ascender"], units["descender"]) == (metrics.ascender, metrics.descender)
    assert em["ascender"] * 1024 == units["ascender"]
    assert em["units_per_em"] == units["units_per_em"] == 1024
    assert em["advance"] * 1024 == units["advance"]


def test_a_fit_is_the_one_of_convert(letters: Path) -> None:
    rows = [row for row in rows_of(letters) if row["family"] == "Kouzan Kaisho Subset"]
    assert rows
    for row in rows:
        assert all(value is not None for value in row["within_tolerance"])
        assert all(row["within_tolerance"])
        assert max(row["deviation_bound"]) <= 1.001e-3  # em


@pytest.mark.needs("pandas")
def test_pandas_opens_it(letters: Path) -> None:
    pandas = import_module("pandas")
    frame = pandas.concat(pandas.read_parquet(path) for path in (letters / "data").iterdir())
    assert len(frame) == len(rows_of(letters))


@pytest.mark.needs("duckdb")
def test_duckdb_opens_it(letters: Path) -> None:
    duckdb = import_module("duckdb")
    query = f"select count(*), count(distinct font) from '{letters}/data/*.parquet'"
    fonts = {row["font"] for row in rows_of(letters)}
    assert duckdb.sql(query).fetchall() == [(len(rows_of(letters)), len(fonts))]


@pytest.mark.needs("datasets")
def test_datasets_opens_it(letters: Path, tmp_path: Path) -> None:
    datasets = import_module("datasets")
    found = datasets.load_dataset(str(letters), cache_dir=str(tmp_path))
    counts = {split: len(rows) for split, rows in found.items()}
    rows = rows_of(letters)
    assert counts == {split: n for split in SPLITS if (n := sum(row["split"] == split for row in rows))}
    first = next(iter(counts))
    assert found[first][0]["glyph"] == rows[0]["glyph"]
    fonts = datasets.load_dataset(str(letters), "fonts", cache_dir=str(tmp_path))
    assert len(fonts["fonts"]) == 3


# The command


def test_the_command_makes_what_the_function_makes(tmp_path: Path) -> None:
    call = ["dataset", str(FONTS / "variable.ttf"), "--points", "8", "--no-fit", "--jobs", "0", "--test", "0.2"]
    found = CliRunner().invoke(app, [*call, "--out", str(tmp_path / "command"), "--json", "--quiet"])
    assert found.exit_code == 0, found.output
    summary = gs.dataset(FONTS / "variable.ttf", tmp_path / "function", replace(PLAIN, test=0.2), jobs=0)
    assert contents(tmp_path / "command") == contents(tmp_path / "function")
    told = json.loads(found.stdout)
    assert told["rows"] == summary.rows
    assert told["fonts"] == summary.fonts
    card = (tmp_path / "command" / "README.md").read_text(encoding="utf-8")
    assert "glyphspline dataset FONTS… --out DIR --points 8 --test 0.2 --no-fit" in card


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--points", "two"], "not a whole number"),
        (["--points", "2"], "--points is a whole number from 3"),
        (["--validation", "0.9", "--test", "0.2"], "more than all families"),
        (["--text", "@none.txt"], "none.txt"),
        (["--step", "20", "--corners", "sharp"], "corners"),
    ],
)
def test_the_command_refuses_what_makes_no_sense(arguments: list[str], message: str, tmp_path: Path) -> None:
    call = ["dataset", str(FONTS / "variable.ttf"), "--out", str(tmp_path / "set"), *arguments]
    found = CliRunner().invoke(app, call)
    assert found.exit_code == 2
    assert message in " ".join(found.output.replace("│", " ").split())
    assert not (tmp_path / "set").exists()


def test_the_status_says_that_something_failed(tmp_path: Path) -> None:
    font = broken_glyph(tmp_path / "glyph.ttf")
    call = ["dataset", str(font), "--out", str(tmp_path / "set"), "--no-fit", "--jobs", "0", "--points", "8"]
    found = CliRunner().invoke(app, call)
    assert found.exit_code == 1
    assert "1 glyph failed" in found.output


def test_a_command_names_only_options_that_there_are() -> None:
    assert command(DatasetSpec(options=gs.Options(max_iterations=7))) == "glyphspline dataset FONTS… --out DIR"
    assert command(DatasetSpec(options=None, characters="`")) == (
        "glyphspline dataset FONTS… --out DIR --text @CHARACTERS.txt --no-fit"
    )


def test_a_command_names_what_is_not_default() -> None:
    spec = DatasetSpec("contour", None, "units", replace(DatasetSpec().options or gs.Options(), effort="best"), 32,
                       scripts=("Latn", "Grek"), seed=3)  # fmt: skip
    assert command(spec) == (
        "glyphspline dataset FONTS… --out DIR --rows contour --points polygon --normalise units --raster 32 "
        "--script Latn,Grek --seed 3 --effort best"
    )
