"""The command refit: what it fits does not depend on what is written, and where outlines go is what was asked."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.cli.groups import collected, without
from glyphspline.fitting.options import Options
from glyphspline.plugins.fonts.spec import RefitSpec
from tests.places import FONTS, GYOSHO

OTF = FONTS / "kouzan-gyosho.otf"


def refit(*words: object) -> Result:
    return CliRunner().invoke(app, ["refit", *map(str, words), "--jobs", "0"])


def said(result: Result) -> str:
    return result.output + (result.stderr if result.stderr_bytes else "")


@pytest.fixture(scope="module")
def ufo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("ufo")
    assert refit(OTF, "--text", "OB", "--format", "ufo", "--out", folder).exit_code == 0
    (path,) = folder.glob("*.ufo")
    return path


def files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize(
    ("formats", "more", "expected"),
    [
        ("otf", [], Options(continuity="g2")),
        ("svg,otf", [], Options(continuity="g2")),
        ("ttf,ufo,gallery", [], Options(continuity="g2")),
        ("otf", ["--continuity", "c2"], Options()),
        ("otf", ["--preset", "brush"], Options(corners="smooth", thousandths=3.0, continuity="g2")),
        ("ufo", ["--precision", "1", "--tolerance", "2"], Options(continuity="g2", precision=1, tolerance=2.0)),
    ],
)
def test_no_option_changes_with_the_formats(formats: str, more: list[str], expected: Options, tmp_path: Path) -> None:
    assert refit(OTF, "--text", "O", "--format", formats, "--out", tmp_path, *more).exit_code == 0
    options = json.loads((tmp_path / "run.json").read_text())["options"]
    names = ("corners", "continuity", "precision", "effort", "variant")
    assert {name: options[name] for name in names} == {name: getattr(expected.for_em(1024), name) for name in names}
    assert options["tolerance"] == expected.tolerance_for(1024)


def test_what_follows_from_another_option_is_not_given() -> None:
    spec = collected(RefitSpec(), without(), {"continuity": "c2"})
    assert spec.options == Options(continuity="c2")
    assert collected(RefitSpec(), without(), {}) == RefitSpec()


@pytest.mark.parametrize(("source", "suffix"), [(OTF, "otf"), (GYOSHO, "ttf")])
def test_a_font_becomes_what_it_is(source: Path, suffix: str, tmp_path: Path) -> None:
    assert refit(source, "--text", "O", "--out", tmp_path).exit_code == 0
    (made,) = tmp_path.glob("*.?tf")
    assert made.suffix == f".{suffix}"
    assert gs.open_font(made).family.endswith(" Spline")
    run = json.loads((tmp_path / "run.json").read_text())
    assert run["command"] == f"glyphspline refit {source.name} --text O --format {suffix}"


def test_a_source_is_changed_in_place_and_nothing_is_left_elsewhere(ufo: Path, tmp_path: Path) -> None:
    before, beside = files(ufo), files(ufo.parent)
    done = refit(ufo, "--in-place", "--continuity", "c2", "--tolerance", "4")
    assert done.exit_code == 0, said(done)
    after = files(ufo)
    assert after.keys() == before.keys()
    assert {Path(name).suffix for name in before if before[name] != after[name]} == {".glif"}
    assert files(ufo.parent).keys() == beside.keys()
    assert "written to" not in said(done)
    assert re.search(r"fewer points\): points \d+ → \d+; nothing else changed", said(done).replace("\n", " "))


def test_masters_are_taken_of_what_has_them(tmp_path: Path) -> None:
    made = refit(FONTS / "variable.ttf", "--glyphs", "o", "--masters", "--format", "ufo", "--out", tmp_path / "a")
    assert made.exit_code == 0, said(made)
    (space,) = (tmp_path / "a").rglob("*.designspace")
    before = files(space.parent)
    done = refit(space, "--in-place", "--tolerance", "5")
    assert done.exit_code == 0, said(done)
    assert re.search(r"in all masters: points \d+ → \d+; nothing else changed", said(done).replace("\n", " "))
    assert files(space.parent).keys() == before.keys()


@pytest.mark.parametrize("name", ["otf", "ttf", "ufo"])
def test_convert_says_the_call_that_writes_fonts(name: str, tmp_path: Path) -> None:
    words = ["convert", str(OTF), "--text", "O", "--format", f"svg,{name}", "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 2
    line = re.search(r"glyphspline refit FONT (.*)", said(done))
    assert line is not None
    assert refit(OTF, "--text", "O", *line[1].replace("DIR", str(tmp_path / "out")).split()).exit_code == 0
    assert list((tmp_path / "out").glob(f"*.{name}"))


def test_python_refits_as_the_command_does(tmp_path: Path) -> None:
    assert refit(OTF, "--glyphs", "O", "--out", tmp_path / "a").exit_code == 0
    summary = gs.refit(OTF, tmp_path / "b", glyphs=["O"])
    assert summary.statuses == {"ok": 1}
    assert files(tmp_path / "a").keys() == files(tmp_path / "b").keys()
    (name,) = (path for path in files(tmp_path / "a") if path.endswith(".otf"))
    assert files(tmp_path / "a")[name] == files(tmp_path / "b")[name]
    with pytest.raises(gs.OptionError, match="say where outlines go"):
        gs.refit(OTF)
