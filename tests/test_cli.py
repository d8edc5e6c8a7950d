"""The shell, mostly from within; a few calls as a process of its own."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from glyphspline import Outline, open_font
from glyphspline.cli import app
from glyphspline.outlines.corner_share import share_of_corners

from .polygons import circle_contour, square_contour

ROOT = Path(__file__).parents[1]
FONTS = ROOT / "fonts_test"
FONT = str(FONTS / "kouzan-gyosho.ttf")
runner = CliRunner()


def test_convert_writes_what_it_says(tmp_path: Path) -> None:
    out = tmp_path / "out"
    result = runner.invoke(app, ["convert", FONT, "--text", "O \n龘", "--step", "90", "--out", str(out), "--jobs", "0"])
    assert result.exit_code == 0, result.output
    assert result.stdout == ""
    assert "not in the font: U+9F98" in result.stderr
    assert "1 ok, 1 empty, 0 failed" in result.stderr
    assert (out / "svg" / "O.svg").exists()
    assert (out / "index.html").exists()
    options = json.loads((out / "run.json").read_text())["options"]
    assert (options["step"], options["variant"], options["margin"]) == (90, 2, 0.02)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["--preset", "paper"], ("smooth", 0.0, "fast")),
        (["--preset", "type", "--corners", "sharp"], ("sharp", 0.02, "best")),
    ],
)
def test_presets_set_options_together(arguments: list[str], expected: tuple[object, ...], tmp_path: Path) -> None:
    out = ["--format", "svg", "--out", str(tmp_path / "out"), "--jobs", "0"]
    assert runner.invoke(app, ["convert", FONT, "--text", "O", *arguments, *out]).exit_code == 0
    options = json.loads((tmp_path / "out" / "run.json").read_text())["options"]
    assert (options["corners"], options["margin"], options["effort"]) == expected


@pytest.mark.parametrize("corners", ["smooth", "sharp"])
def test_a_hint_says_that_outlines_are_mostly_corners(corners: str, tmp_path: Path) -> None:
    source = open_font(FONT)
    assert share_of_corners([source.outline(name) for name in source.select(text="永")]) > 0.5
    output = ["--out", str(tmp_path / "out"), "--jobs", "0", "--format", "svg"]
    said = runner.invoke(app, ["convert", FONT, "--text", "永", "--corners", corners, *output]).stderr
    assert ("--preset type" in said) == (corners == "smooth")


def test_joints_that_are_corners_or_end_lines_are_counted() -> None:
    square, circle = (Outline("x", contours=(contour,)) for contour in (square_contour(), circle_contour()))
    assert share_of_corners([square]) == 1.0
    assert share_of_corners([circle]) == 0.0
    corners, joints = len(square.arrays.degrees), len(circle.arrays.degrees)
    assert share_of_corners([square, circle]) == corners / (corners + joints)
    assert share_of_corners([]) == 0.0


def test_quiet_says_nothing(tmp_path: Path) -> None:
    arguments = ["convert", FONT, "--gids", "1,6", "--count", "30", "--out", str(tmp_path / "o"), "--jobs", "0", "-q"]
    result = runner.invoke(app, [*arguments, "--format", "svg"])
    assert (result.exit_code, result.output) == (0, "")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([FONT], "no glyphs asked for"),
        ([FONT, "--text", "龘"], "none of the glyphs"),
        ([FONT, "--unicodes", "zz"], "no code point"),
        ([FONT, "--all", "--step", "9", "--count", "9"], "one of tolerance, step and count"),
        ([FONT, "--all", "--format", "bmp"], "no format bmp"),
        ([FONT, "--all", "--face-index", "1"], "no face 1"),
        ([FONT, "--all", "--location", "wght=700"], "not a variable font"),
        ([FONT, "--all", "--location", "wght=bold"], "--location"),
        ([FONT, "--all", "--location", "Bold"], "no named instance"),
        ([str(ROOT / "LICENSE"), "--all"], "not a TTF"),
        (["missing.ttf", "--all"], "missing.ttf"),
        ([FONT, "--text-file", "missing.txt"], "missing.txt"),
        ([FONT, "--all", "--variant", "7"], "variant"),
        ([FONT, "--all", "--preset", "paper", "--corners", "sharp"], "--preset paper sets --corners smooth"),
        ([FONT, "--all", "--preset", "type", "--step", "9"], "give a tolerance"),
    ],
)
def test_an_unusable_call_ends_with_2_and_a_reason(arguments: list[str], words: str, tmp_path: Path) -> None:
    result = runner.invoke(app, ["convert", *arguments, "--out", str(tmp_path / "out"), "--jobs", "0"])
    assert result.exit_code == 2
    assert words in result.stderr
    assert "Traceback" not in result.stderr
    assert not (tmp_path / "out").exists()


def test_info_of_a_collection_and_of_a_variable_font() -> None:
    facts = json.loads(runner.invoke(app, ["info", str(FONTS / "kouzan.ttc"), "--json"]).stdout)
    assert (facts["format"], facts["faces"], len(facts["fonts"])) == ("collection", 2, 2)
    assert facts["fonts"][0]["glyphs"] == 18
    words = runner.invoke(app, ["info", str(FONTS / "variable.ttf")]).stdout
    assert "axis wght" in words
    assert "8 glyphs" in words


def test_report_writes_the_index_anew(tmp_path: Path) -> None:
    out = tmp_path / "out"
    runner.invoke(app, ["convert", FONT, "--text", "O", "--step", "90", "--out", str(out), "--jobs", "0"])
    before = (out / "index.html").read_bytes()
    (out / "index.html").unlink()
    assert runner.invoke(app, ["report", str(out)]).exit_code == 0
    assert (out / "index.html").read_bytes() == before
    assert runner.invoke(app, ["report", str(tmp_path)]).exit_code == 0  # a folder of runs has an index of its own
    assert '"runs":["out"]' in (tmp_path / "index.html").read_text()
    (tmp_path / "empty").mkdir()
    assert runner.invoke(app, ["report", str(tmp_path / "empty")]).exit_code == 2


def test_report_makes_a_gallery_afterwards(tmp_path: Path) -> None:
    out = tmp_path / "out"
    options = ["--text", "O", "--step", "90", "--out", str(out), "--jobs", "0", "--format", "svg"]
    assert runner.invoke(app, ["convert", FONT, *options]).exit_code == 0
    assert not (out / "index.html").exists()
    assert runner.invoke(app, ["report", str(out), "--font", FONT]).exit_code == 0
    assert '"source":"M' in (out / "gallery" / "O.glyph.js").read_text()
    other = runner.invoke(app, ["report", str(out), "--font", str(FONTS / "kouzan-gyosho.otf")])
    assert (other.exit_code, "another font" in other.stderr) == (2, True)


def call(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *arguments], cwd=ROOT, capture_output=True, text=True, timeout=120)


def test_a_process_of_its_own_with_workers(tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = call("-m", "glyphspline", "convert", FONT, "--text", "O8", "--step", "90", "--out", str(out), "--jobs", "2")
    assert (done.returncode, done.stdout) == (0, "")
    assert "2 ok" in done.stderr
    assert "\x1b" not in done.stderr  # no progress bar off a terminal


def test_help_imports_nothing_heavy() -> None:
    code = "import sys; from glyphspline.cli import app; from typer.testing import CliRunner; " \
           "assert CliRunner().invoke(app, ['--help']).exit_code == 0; print(*sys.modules)"  # fmt: skip
    loaded = call("-c", code).stdout.split()
    assert "glyphspline.cli" in loaded
    assert not {"matplotlib", "fontTools.ttLib", "glyphspline.batch"} & set(loaded)


def test_the_batch_script_gives_each_font_a_folder(tmp_path: Path) -> None:
    (tmp_path / "bad.ttf").write_bytes(b"no font at all")
    inputs = [str(FONTS / "kouzan.ttc"), str(FONTS / "kouz*.otf"), str(tmp_path / "bad.ttf")]
    options = ["--text", "8", "--count", "20", "--out", str(tmp_path / "out"), "--jobs", "0"]
    done = call("scripts/batch_convert.py", *inputs, *options)
    assert done.returncode == 1
    assert "bad.ttf: not a TTF" in done.stderr
    made = {path.parent.relative_to(tmp_path / "out").as_posix() for path in tmp_path.glob("out/**/manifest.jsonl")}
    assert made == {"kouzan-gyosho-otf", "kouzan-ttc/face-0", "kouzan-ttc/face-1"}
