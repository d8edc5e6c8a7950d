"""Runs over many glyphs: what is in the folder, and that it does not depend on workers or interruptions."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import numpy as np
import pytest

from glyphspline.errors import FontError, GlyphsplineError, OutputError
from glyphspline.files import write_whole
from glyphspline.fitting.convert import convert_many
from glyphspline.fitting.options import Options
from glyphspline.outlines.outline import Contour, Outline
from glyphspline.readers import Font, open_font, open_source
from glyphspline.runs import worker
from glyphspline.runs.convert import convert_font, write_gallery
from glyphspline.runs.file_names import LONGEST_NAME, file_names, folders_for
from glyphspline.runs.folder import entries_of
from glyphspline.runs.font_search import find_fonts
from glyphspline.runs.spec import Limits, RunSpec
from glyphspline.runs.summary import Summary
from glyphspline.runs.worker import contour_entries
from glyphspline.writers.settings import Appearance, Settings
from tests.drawings import L_SHAPE, METRICS, circle, polygon_contour
from tests.places import FONTS

SPEC = RunSpec(Options(step=80))
MANIFEST_KEYS = [
    "glyph", "gid", "unicodes", "advance", "status", "files", "deviation", "contours", "notes", "unread", "error",
]  # fmt: skip


@pytest.fixture(scope="module")
def font() -> Font:
    return open_font(FONTS / "kouzan-gyosho.otf")


@pytest.fixture(scope="module")
def finished(font: Font, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("runs") / "finished"
    convert_font(font, font.select(text="O8 B"), out, SPEC, jobs=0)
    return out


def content(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_every_glyph_is_in_the_manifest_once_in_gid_order_with_its_files(finished: Path) -> None:
    entries = list(entries_of(finished))
    assert [entry["glyph"] for entry in entries] == ["space", "eight", "B", "O"]
    assert all(list(entry) == MANIFEST_KEYS for entry in entries)
    assert [entry["status"] for entry in entries] == ["empty", "ok", "ok", "ok"]
    written = {path for entry in entries for path in entry["files"].values()}
    data = {f"gallery/{name}.js" for name in ("run", "table-00000")}
    pages = {"index.html", "manifest.jsonl", "run.json", ".sizes.txt"} | data
    assert written | pages == content(finished).keys()
    assert entries[2]["unicodes"] == ["U+0042"]
    assert all(contour["converged"] is True for entry in entries for contour in entry["contours"])


def test_run_json_says_what_was_run_and_nothing_of_the_machine(finished: Path, font: Font) -> None:
    text = (finished / "run.json").read_text()
    run = json.loads(text)
    assert run["font"]["sha256"] == font.sha256
    assert run["options"]["step"] == 80
    assert run["curvature_scale"] > 0
    assert str(FONTS) not in text
    assert "jobs" not in text


def test_worker_processes_write_the_same_bytes(finished: Path, font: Font, tmp_path: Path) -> None:
    convert_font(font, font.select(text="O8 B"), tmp_path / "out", SPEC, jobs=2)
    assert content(tmp_path / "out") == content(finished)


def test_a_finished_folder_is_left_as_it_is(finished: Path, font: Font) -> None:
    before = {path: path.stat().st_mtime_ns for path in finished.rglob("*")}
    summary = convert_font(font, font.select(text="O8 B"), finished, SPEC, jobs=0)
    assert summary.done == 0
    assert summary.statuses == {"ok": 3, "empty": 1}
    assert {path: path.stat().st_mtime_ns for path in finished.rglob("*")} == before


def interrupt(done: int, total: int, failed: int) -> None:
    if done == 2:
        raise KeyboardInterrupt


def test_an_interrupted_run_goes_on_and_ends_the_same(finished: Path, font: Font, tmp_path: Path) -> None:
    out = tmp_path / "out"
    names = font.select(text="O8 B")
    with pytest.raises(KeyboardInterrupt):
        convert_font(font, names, out, SPEC, jobs=0, observer=interrupt)
    assert not (out / ".sizes.txt").exists()
    (out / "svg" / ".B_.svg-1.part").write_text("half a fi")
    with open(out / "manifest.jsonl", "ab") as manifest:
        manifest.write(b'{"glyph":"O"')
    assert convert_font(font, names, out, SPEC, jobs=0).done == 2
    assert content(out) == content(finished)


def test_a_file_lost_or_cut_after_it_was_recorded_is_written_again(finished: Path, font: Font, tmp_path: Path) -> None:
    out = tmp_path / "out"
    with pytest.raises(KeyboardInterrupt):
        convert_font(font, font.select(text="O8 B"), out, SPEC, jobs=0, observer=interrupt)
    (out / "svg" / "eight.svg").write_bytes(b"")
    assert convert_font(font, font.select(text="O8 B"), out, SPEC, jobs=0).done == 3
    assert content(out) == content(finished)


@pytest.mark.parametrize(
    "lost", ["svg/*", "gallery/*.glyph.js", "gallery/table-00000.js", "gallery/run.js", "index.html"]
)
def test_what_a_finished_folder_lost_to_a_power_cut_is_made_again(
    lost: str, finished: Path, font: Font, tmp_path: Path
) -> None:
    shutil.copytree(finished, tmp_path / "cut")
    victim = sorted((tmp_path / "cut").glob(lost))[0]
    size = victim.stat().st_size
    for left in (victim.read_bytes()[:-40], b"", bytes(size)):
        victim.write_bytes(left)
        convert_font(font, font.select(text="O8 B"), tmp_path / "cut", SPEC, jobs=0)
        assert content(tmp_path / "cut") == content(finished)


def test_a_list_of_sizes_that_is_no_such_list_does_no_harm(finished: Path, font: Font, tmp_path: Path) -> None:
    shutil.copytree(finished, tmp_path / "odd")
    (tmp_path / "odd" / ".sizes.txt").write_bytes(b"1\n2\tx\n" + b"9" * 5000 + b"\t1\n\t\n\xff\t1,,2\n")
    assert convert_font(font, font.select(text="O8 B"), tmp_path / "odd", SPEC, jobs=0).done == 0


def test_a_wider_selection_adds_to_the_folder(font: Font, tmp_path: Path) -> None:
    out = tmp_path / "out"
    convert_font(font, font.select(text="O"), out, SPEC, jobs=0)
    assert convert_font(font, font.select(text="8O"), out, SPEC, jobs=0).done == 1
    assert [entry["glyph"] for entry in entries_of(out)] == ["eight", "O"]


def test_other_options_are_refused_with_the_difference(finished: Path, font: Font) -> None:
    other = replace(SPEC, options=Options(step=81))
    with pytest.raises(OutputError, match=r"options\.step: 80 in the folder, 81 now"):
        convert_font(font, font.select(text="O"), finished, other, jobs=0)


def test_restart_does_it_anew(font: Font, tmp_path: Path) -> None:
    out = tmp_path / "out"
    convert_font(font, font.select(text="O "), out, SPEC, jobs=0)
    convert_font(
        font, font.select(text=" "), out, replace(SPEC, settings=Settings(Appearance("ink"))), jobs=0, restart=True
    )
    assert [entry["glyph"] for entry in entries_of(out)] == ["space"]


def test_a_bad_glyph_fails_alone(tmp_path: Path) -> None:
    class Damaged(Font):
        """A font one of whose glyphs cannot be drawn."""

        def read(self, heads: Any) -> Any:
            error = GlyphsplineError("broken", font=str(self.path), glyph="B", contour=3)
            return [error if getattr(outline, "name", "") == "B" else outline for outline in super().read(heads)]

    font = open_font(FONTS / "kouzan-gyosho.otf")
    font.__class__ = Damaged
    with opened_as(font):
        summary = convert_font(font, font.select(text="OB "), tmp_path / "out", SPEC, jobs=0)
    assert summary.statuses == {"ok": 1, "empty": 1, "failed": 1}
    assert summary.failures == [("B", "contour 3: broken")]
    failed = next(entry for entry in entries_of(tmp_path / "out") if entry["glyph"] == "B")
    assert (failed["unicodes"], failed["advance"], failed["files"]) == (["U+0042"], None, {})


def opened_as(font: Font) -> Any:
    """Workers of this process find this font where they would open it."""
    patch = pytest.MonkeyPatch()
    patch.setattr("glyphspline.readers.open.reopened", lambda *key: font)

    class Undo:
        def __enter__(self) -> None: ...

        def __exit__(self, *what: object) -> None:
            patch.undo()

    return Undo()


def test_a_fault_of_ours_costs_only_its_glyph(font: Font, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def faulty(outlines: Any, options: Any, errors: str) -> Any:
        if any(outline.name == "B" for outline in outlines):
            raise ZeroDivisionError("a fault")
        return convert_many(outlines, options, errors="return")

    monkeypatch.setattr(worker, "convert_many", faulty)
    monkeypatch.setattr("glyphspline.runs.engine.slices", lambda tasks, size: [tasks])
    summary = convert_font(font, font.select(text="OB8 "), tmp_path / "out", SPEC, jobs=0)
    assert summary.failures == [("B", "ZeroDivisionError: a fault")]
    assert summary.statuses == {"ok": 2, "empty": 1, "failed": 1}


@pytest.mark.parametrize(
    "formats", [("svg",), ("curvature",), ("gallery",), ("svg", "curvature", "gallery", "parquet")]
)
def test_a_glyph_has_the_same_bytes_whichever_formats_are_asked_for(
    formats: tuple[str, ...], finished: Path, font: Font, tmp_path: Path
) -> None:
    convert_font(font, font.select(text="O8 B"), tmp_path, replace(SPEC, formats=formats), jobs=0)
    kept = content(finished)
    same = [name for name in content(tmp_path) if name.partition("/")[0] in {*formats} - {"gallery", "parquet"}]
    assert len(same) == 3 * len({"svg", "curvature"} & {*formats})
    for name in same:
        assert (tmp_path / name).read_bytes() == kept[name]
    for path in tmp_path.glob("gallery/*.glyph.js"):
        mine, whole = (
            re.sub('"files":{[^}]*}', "", text) for text in (path.read_text(), kept[f"gallery/{path.name}"].decode())
        )
        assert mine == whole


def test_drawings_alone_are_written_without_a_gallery(font: Font, tmp_path: Path) -> None:
    convert_font(font, font.select(text="O "), tmp_path, replace(SPEC, formats=("svg",)), jobs=0)
    alone = {"svg/O.svg", "manifest.jsonl", "run.json", ".sizes.txt"}
    assert content(tmp_path).keys() == alone
    convert_font(font, font.select(text="O "), tmp_path, SPEC, jobs=0, restart=True)
    convert_font(font, font.select(text="O "), tmp_path, replace(SPEC, formats=("svg",)), jobs=0, restart=True)
    assert content(tmp_path).keys() == alone


@pytest.mark.parametrize("step", [20.0, 90.0])
def test_the_estimate_of_vertices_is_near(font: Font, step: float) -> None:
    outlines = font.outlines(font.select(text="O8 B龍"))
    found = [worker.vertices_of(outline, Options(step=step)) for outline in outlines]
    for outline, vertices in zip(outlines, found, strict=True):
        sides = [np.hypot(*np.diff(contour.points, axis=0).T).sum() for contour in outline.contours]
        assert vertices == pytest.approx(sum(sides) / step)
    assert all(worker.vertices_of(outline, Options(count=7)) == 7.0 * len(outline.contours) for outline in outlines)


def test_measures_that_are_not_finite_or_not_known_are_null() -> None:
    columns: dict[str, list[Any]] = {
        "vertices": [3, 4], "iterations": [9, None], "residual": [0.001, np.inf], "converged": [True, False],
        "rate_bound": [1.5, np.nan], "deviation": [0.123456789, 2.0],
    }  # fmt: skip
    (good,), _, (bad,) = contour_entries(columns, np.array([0, 1, 1, 2]))
    assert (good["vertices"], good["residual"], good["converged"], good["rate_bound"]) == (3, 0.001, True, 1.5)
    assert (bad["iterations"], bad["residual"], bad["converged"], bad["rate_bound"]) == (None, None, False, None)
    assert (good["deviation"], good["length"], bad["length"]) == (0.1234568, None, None)


@pytest.mark.parametrize(("options", "splines"), [(Options(), 1), (Options(corners="smooth"), 3)])
def test_contours_that_are_one_closed_spline_are_counted(
    options: Options, splines: int, font: Font, tmp_path: Path
) -> None:
    disc = list(circle(200, centre=(800.0, 300.0)))
    half = [*circle(200, centre=(1300.0, 300.0))[:16], np.array([[1100.0, 300.0], [1500.0, 300.0]])]
    contours = polygon_contour(L_SHAPE), Contour.from_segments(disc), Contour.from_segments(half)
    drawn = Outline("three", contours=contours, metrics=METRICS)
    found = convert_many([drawn], options)[0]
    assert sum([arc.spline.closed for arc in contour.interpolations] == [True] for contour in found.contours) == splines
    summary = Summary()
    (entries,) = contour_entries(found.arrays.measures, np.array([0, 3]))
    summary.add({"glyph": "three", "status": "ok", "contours": entries})
    assert (summary.contours, summary.splines) == (3, splines)
    new, old = (convert_font(font, ["O"], tmp_path, RunSpec(options, ("svg",)), jobs=0) for _ in range(2))
    assert (old.contours, old.splines) == (new.contours, new.splines)  # of the manifest
    said = f"contours that are one closed spline without a corner: {old.splines} of 2" in old.lines()
    assert said == (old.splines > 0)


@pytest.mark.parametrize(
    "wrong",
    [{"formats": "svg"}, {"formats": ()}, {"formats": ("bmp",)}, {"names": "n"}, {"options": None}, {"settings": None}],
)
def test_a_run_that_makes_no_sense_is_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(GlyphsplineError, match=r"formats|no format|names|Options|Settings"):
        RunSpec(**wrong)


@pytest.mark.parametrize("limit", ["seconds", "segments", "vertices"])
def test_limits_are_positive(limit: str) -> None:
    with pytest.raises(GlyphsplineError, match=limit):
        Limits(**{limit: 0})


def test_file_names_differ_without_regard_to_case_and_stay_in_their_folder() -> None:
    nasty = ["a", "A", "a_", "../../etc/passwd", "CON", "con", "x" * 10_000, "x" * 10_001, "龍" * 300, "\ud800"]
    nasty += ["", ".", "..", "a\0b", "a\x1bb", "<&>", "nul.alt", " ", "a/b", "a\\b", "-rf", "~", ".notdef"]
    stems = file_names(nasty)
    assert len({stem.lower() for stem in stems}) == len(nasty)
    for stem in stems:
        assert len(stem.encode()) <= 2 * LONGEST_NAME
        assert Path(stem).name == stem
        assert stem not in (".", "..")
        assert not stem.startswith(".")


def test_a_write_leaves_nothing_half_done(tmp_path: Path) -> None:
    assert write_whole(f"{tmp_path}/a.svg", "é") == 2
    with pytest.raises(OutputError):
        write_whole(f"{tmp_path}/no such folder/a.svg", "b")
    (tmp_path / "folder.svg").mkdir()
    with pytest.raises(OutputError):
        write_whole(f"{tmp_path}/folder.svg", "b")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.svg", "folder.svg"]


def test_a_linked_folder_is_refused(font: Font, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "svg").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(OutputError, match="symbolic link"):
        convert_font(font, font.select(text="O"), tmp_path / "out", SPEC, jobs=0)
    assert list((tmp_path / "elsewhere").iterdir()) == []


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    (tmp_path / "a" / "b").mkdir(parents=True)
    for name in ("a/x.ttf", "a/b/y.OTF", "a/notes.txt", "z.woff2"):
        (tmp_path / name).write_bytes(b"")
    (tmp_path / "list.txt").write_text(f"# fonts\n{tmp_path / 'a'}\n\n{tmp_path}/*.woff2\n")
    return tmp_path


def test_fonts_are_found_in_folders_globs_and_lists(tree: Path) -> None:
    assert find_fonts([str(tree / "a")]) == [tree / "a/b/y.OTF", tree / "a/x.ttf"]
    assert find_fonts([str(tree / "**" / "*.ttf"), str(tree / "a" / "x.ttf")]) == [tree / "a/x.ttf"]
    assert len(find_fonts([f"@{tree / 'list.txt'}"])) == 3
    with pytest.raises(GlyphsplineError, match="no such file"):
        find_fonts([str(tree / "missing.ttf")])


@pytest.mark.parametrize("name", ["Mine.ufo", "empty"])
def test_a_folder_without_fonts_is_named(name: str, tmp_path: Path) -> None:
    (tmp_path / name).mkdir()
    (found,) = find_fonts([str(tmp_path / name)])
    with pytest.raises(FontError, match=rf"{name}: a folder with neither fonts, SVG drawings nor a UFO's metainfo"):
        open_source(found)


def test_a_zipped_ufo_is_named(tmp_path: Path) -> None:
    with ZipFile(tmp_path / "Mine.ufoz", "w") as file:
        file.writestr("Mine.ufo/metainfo.plist", "")
    with pytest.raises(FontError, match=r"Mine\.ufoz: a zipped folder"):
        open_source(tmp_path / "Mine.ufoz")


KILL_ME = """
import os, signal, sys
from pathlib import Path
from glyphspline.runs.convert import convert_font
from glyphspline.runs.spec import RunSpec
from glyphspline.fitting.options import Options
from glyphspline.readers import open_font

def observe(done, total, failed):
    if done >= int(sys.argv[3]):
        os.kill(os.getpid(), signal.SIGKILL)

if __name__ == "__main__":
    font = open_font(sys.argv[1])
    names = font.select(text="O8 B")
    convert_font(font, names, Path(sys.argv[2]), RunSpec(Options(step=80)), jobs=2, observer=observe)
"""


@pytest.mark.parametrize("moment", [1, pytest.param(3, marks=pytest.mark.long)])
def test_a_killed_run_goes_on_and_ends_the_same(moment: int, finished: Path, font: Font, tmp_path: Path) -> None:
    script, out = tmp_path / "run.py", tmp_path / "out"
    script.write_text(KILL_ME)
    killed = subprocess.run([sys.executable, script, font.path, out, str(moment)], cwd=FONTS.parent, timeout=600,
                            env={**os.environ, "PYTHONPATH": str(FONTS.parent)})  # fmt: skip
    assert killed.returncode == -signal.SIGKILL
    assert not (out / ".sizes.txt").exists()
    summary = convert_font(font, font.select(text="O8 B"), out, SPEC, jobs=0)
    assert summary.done <= 4 - moment
    for _ in range(6000):  # a worker may outlive the process that was killed, and write the file that it is at
        if not list(out.rglob("*.part")):
            break
        time.sleep(0.1)
    assert content(out) == content(finished)


def test_fonts_of_one_name_get_folders_of_their_own() -> None:
    fonts = [Path("a/Fine.ttf"), Path("b/fine.ttf"), Path("c/CON"), Path("d/...."), Path("Fine.otf")]
    assert folders_for(fonts) == ["Fine-ttf", "fine-ttf-2", "CON-2", "font", "Fine-otf"]


def test_a_gallery_afterwards_needs_the_format(font: Font, tmp_path: Path) -> None:
    convert_font(font, font.select(text="O"), tmp_path, replace(SPEC, formats=("svg",)), jobs=0)
    with pytest.raises(OutputError, match=r"without the format gallery; add it by: .*--format svg,gallery --out"):
        write_gallery(tmp_path)
