"""The shell, mostly from within; a few calls as a process of its own."""

from __future__ import annotations

import json
import os
import re
import shlex
import subprocess
import sys
from itertools import chain
from pathlib import Path
from typing import Annotated, Any

import pytest
import typer
from fontTools.ttLib import TTFont
from typer.testing import CliRunner, Result

import glyphspline
from glyphspline.cli.app import app
from glyphspline.cli.groups import grouped, without
from glyphspline.fields import arguments, options_of
from glyphspline.fitting.options import PRESETS, Options
from glyphspline.plugins.datasets.spec import DatasetSpec
from glyphspline.runs.folder import locked
from glyphspline.runs.spec import RunSpec
from glyphspline.runs.summary import Summary
from glyphspline.writers.settings import Appearance, Maps, Settings
from tests.places import ROOT
from tests.runs.test_batch import content

FONTS = ROOT / "fonts_test"
FONT = str(FONTS / "kouzan-gyosho.ttf")
runner = CliRunner()


def test_convert_writes_what_it_says(tmp_path: Path) -> None:
    out = tmp_path / "out"
    result = runner.invoke(app, ["convert", FONT, "--text", "O \n龘", "--step", "90", "--out", str(out), "--jobs", "0"])
    assert result.exit_code == 1, result.output
    assert result.stdout == ""
    assert "not in the font: U+9F98" in result.stderr
    assert re.search(r"1 glyph and 1 empty in [0-9.]+ s; open .*index.html", result.stderr)
    assert (out / "svg" / "O.svg").exists()
    assert (out / "index.html").exists()
    options = json.loads((out / "run.json").read_text())["options"]
    assert (options["step"], options["variant"], options["margin"]) == (90, 2, 0.02)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ([], ("sharp", 0.02, "fast", 1.024)),
        (["--step", "40"], ("smooth", 0.02, "fast", 1.024)),
        (["--preset", "paper"], ("smooth", 0.0, "fast", 1.024)),
        (["--preset", "paper", "--step", "40"], ("smooth", 0.0, "fast", 1.024)),
        (["--preset", "brush"], ("smooth", 0.02, "fast", 3.072)),
        (["--preset", "brush", "--tolerance", "2"], ("smooth", 0.02, "fast", 2.0)),
        (["--preset", "brush", "--tolerance", "2", "--corners", "sharp"], ("sharp", 0.02, "fast", 2.0)),
        (["--preset", "type", "--corners", "sharp"], ("sharp", 0.02, "best", 1.024)),
        (["--preset", "type", "--corners", "smooth"], ("smooth", 0.02, "best", 1.024)),
        (["--preset", "paper", "--corners", "sharp"], ("sharp", 0.0, "fast", 1.024)),
    ],
)
def test_presets_set_options_together_and_options_given_beside_them_win(
    arguments: list[str], expected: tuple[object, ...], tmp_path: Path
) -> None:
    out = ["--format", "svg", "--out", str(tmp_path / "out"), "--jobs", "0"]
    assert runner.invoke(app, ["convert", FONT, "--text", "O", *arguments, *out]).exit_code == 0
    options = json.loads((tmp_path / "out" / "run.json").read_text())["options"]
    assert tuple(options[name] for name in ("corners", "margin", "effort", "tolerance")) == expected


@pytest.mark.parametrize("more", [[], ["--preset", "type"]])
def test_options_of_a_file_win_over_a_preset(more: list[str], tmp_path: Path) -> None:
    preset = "" if more else 'preset = "type"\n'
    (tmp_path / "mine.toml").write_text(f'{preset}corners = "smooth"\nformat = "svg"\njobs = 0\n')
    given = ["--config", str(tmp_path / "mine.toml"), "--out", str(tmp_path / "out"), *more]
    assert runner.invoke(app, ["convert", FONT, "--text", "O", *given]).exit_code == 0
    options = json.loads((tmp_path / "out" / "run.json").read_text())["options"]
    assert (options["corners"], options["effort"]) == ("smooth", "best")


def test_a_value_is_made_of_what_is_given_and_printed_as_what_is_not_default() -> None:
    options = Options(corners="smooth", tolerance=2.5, measure=True)
    spec = RunSpec(options, ("svg",), Settings(Appearance(fill="red"), flatness=3.0), maps=Maps("source"))
    words = [*chain(*arguments(spec, RunSpec()).values())]
    assert words == [
        "--tolerance", "2.5", "--corners", "smooth", "--measure", "--format", "svg", "--fill", "red",
        "--flatness", "3.0", "--comb", "source",
    ]  # fmt: skip
    found = []

    @grouped
    def command(made: Annotated[RunSpec, without("em")]) -> None:
        found.append(made)

    only = typer.Typer()
    only.command()(command)
    assert runner.invoke(only, words).exit_code == 0
    assert found == [spec]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (Options(**PRESETS["paper"]), ["--preset", "paper"]),
        (Options(**PRESETS["paper"], step=40.0), ["--preset", "paper", "--step", "40.0"]),
        (Options(corners="sharp", margin=0.0, hold_corners=False), ["--preset", "paper", "--corners", "sharp"]),
        (Options(corners="smooth", margin=0.0), ["--corners", "smooth"]),
        (Options(fallback="knot", max_ratio=3.0), []),
        (Options(**PRESETS["type"], tolerance=2.0), ["--preset", "type", "--tolerance", "2.0"]),
        (Options(**PRESETS["type"] | {"corners": "smooth"}), ["--preset", "type", "--corners", "smooth"]),
        (Options(**PRESETS["brush"], count=9), ["--preset", "brush", "--count", "9"]),
        (Options(measure=True, thousandths=2.0), []),
    ],
)
def test_what_no_option_sets_is_printed_if_a_preset_sets_it(options: Options, words: list[str]) -> None:
    assert [*chain(*arguments(RunSpec(options), RunSpec(), RunSpec.unshown).values())] == words


@pytest.mark.parametrize(
    "flag",
    [
        "--margin", "--fallback", "--hold-corners", "--pass-corners", "--corner-teeth", "--comb-scale", "--dxf",
        "--continuity", "--effort", "--flatness", "--measure", "--height", "--stroke-width", "--thousandths",
        "--masters", "--from", "--axis", "--in-place", "--layer", "--keep-name", "--scheduler", "--json-log",
    ],
)  # fmt: skip
def test_what_python_or_another_command_sets_is_no_option(flag: str, tmp_path: Path) -> None:
    result = runner.invoke(app, ["convert", FONT, "--all", "--out", str(tmp_path / "out"), flag])
    assert result.exit_code == 2
    assert f"No such option: {flag}" in result.stderr


@pytest.mark.parametrize("kind", [Options, RunSpec, Settings, Maps, Appearance, DatasetSpec])
def test_help_is_a_sentence(kind: type) -> None:
    for one in options_of(kind):
        assert re.fullmatch(r"[A-Z][a-z]+ .*[.)]", one.about.help), one.name


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
        ([FONT, "--text", "@missing.txt"], "missing.txt"),
        ([FONT, "--all", "--variant", "7"], "variant"),
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


def test_report_shows_the_command_that_adds_a_gallery(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "out"
    options = ["--text", "O", "--step", "90", "--out", str(out), "--jobs", "0", "--format", "svg,parquet"]
    assert runner.invoke(app, ["convert", FONT, *options]).exit_code == 0
    assert not (out / "index.html").exists()
    result = runner.invoke(app, ["report", str(out)])
    assert result.exit_code == 2
    monkeypatch.chdir(FONTS)
    command = shlex.split(result.stderr.partition("add it by: ")[2])
    assert runner.invoke(app, [*command[1:], "--jobs", "0"]).exit_code == 0
    assert {*json.loads((out / "run.json").read_text())["formats"]} == {"svg", "parquet", "gallery"}
    assert list(out.glob("*.parquet"))
    assert '"source":"M' in (out / "gallery" / "O.glyph.js").read_text()


@pytest.mark.skipif(os.name == "nt", reason="a locale of POSIX")
@pytest.mark.parametrize(
    ("command", "said"),
    [
        (["convert", FONT, "--text", "好", "--jobs", "0", "--format", "svg", "--out", "good"], "1 glyph in"),
        (["text", FONT, "好", "--out", "good.svg"], ""),
        pytest.param(["check", FONT, "--text", "好"], "1 glyph: ", marks=pytest.mark.long),
        pytest.param(["diff", FONT, FONT, "--text", "好"], "1 glyph compared", marks=pytest.mark.long),
        pytest.param(
            ["atlas", FONT, "--text", "O好", "--profiles", "好", "--out", "good.pdf"], "2 pages", marks=pytest.mark.long
        ),
        pytest.param(
            ["dataset", FONT, "--text", "好", "--no-fit", "--jobs", "0", "--out", "good"],
            "1 row of 1 glyph",
            marks=pytest.mark.long,
        ),
        pytest.param(
            ["demo", FONT, "--text", "好", "--jobs", "0", "--out", "good"], "1 glyph in", marks=pytest.mark.long
        ),
    ],
)
def test_text_is_utf_8_whatever_the_locale(command: list[str], said: str, tmp_path: Path) -> None:
    environment = os.environ | {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-m", "glyphspline", *command],
        cwd=tmp_path, env=environment, capture_output=True, check=False, timeout=600,
    )  # fmt: skip
    assert said in done.stderr.decode()
    assert done.returncode == 0
    assert "--out" not in command or list(tmp_path.glob("good*"))


def call(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *arguments], cwd=ROOT, capture_output=True, text=True, timeout=600)


def test_a_process_of_its_own_with_workers(tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = call("-m", "glyphspline", "convert", FONT, "--text", "O8", "--step", "90", "--out", str(out), "--jobs", "2")
    assert (done.returncode, done.stdout) == (0, "")
    assert "2 glyphs in" in done.stderr
    assert "\x1b" not in done.stderr  # no progress bar off a terminal


def test_help_imports_nothing_heavy() -> None:
    code = "import sys; from glyphspline.cli.app import app; from typer.testing import CliRunner; " \
           "assert CliRunner().invoke(app, ['--help']).exit_code == 0; print(*sys.modules)"  # fmt: skip
    loaded = call("-c", code).stdout.split()
    assert "glyphspline.cli" in loaded
    assert not {"matplotlib", "fontTools.ttLib", "numpy"} & set(loaded)


def test_the_batch_script_gives_each_font_a_folder(tmp_path: Path) -> None:
    (tmp_path / "bad.ttf").write_bytes(b"no font at all")
    inputs = [str(FONTS / "kouzan.ttc"), str(FONTS / "kouz*.otf"), str(tmp_path / "bad.ttf")]
    options = ["--text", "8", "--count", "20", "--out", str(tmp_path / "out"), "--jobs", "0"]
    done = call("scripts/batch_convert.py", *inputs, *options)
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1] == f"failed: {tmp_path / 'bad.ttf'}: not a TTF, OTF, TTC, WOFF or WOFF2 file"
    made = {path.parent.relative_to(tmp_path / "out").as_posix() for path in tmp_path.glob("out/**/manifest.jsonl")}
    assert made == {"kouzan-gyosho-otf", "kouzan-ttc/face-0", "kouzan-ttc/face-1"}
    before = content(tmp_path / "out")
    assert {name.rpartition("/")[2] for name in before} == {
        "run.json", "manifest.jsonl", ".sizes.txt", "index.html", "run.js", "table-00000.js", "eight.svg",
        "eight.glyph.js",
    }  # fmt: skip
    options[options.index("--out") + 1] = str(tmp_path / "command")
    result = runner.invoke(app, ["convert", *inputs, *options])
    assert result.exit_code == 1
    assert content(tmp_path / "command") == before


def test_one_font_of_a_list_is_converted_whole_into_a_folder_of_it(tmp_path: Path) -> None:
    options = ["--step", "90", "--jobs", "0", "--format", "svg"]
    (tmp_path / "list.txt").write_text(FONT, encoding="utf-8")
    listed = runner.invoke(app, ["convert", f"@{tmp_path / 'list.txt'}", "--out", str(tmp_path / "listed"), *options])
    assert listed.exit_code == 0, listed.output
    alone = runner.invoke(app, ["convert", FONT, "--all", "--out", str(tmp_path / "alone"), *options])
    assert alone.exit_code == 0
    assert content(tmp_path / "listed" / "kouzan-gyosho-ttf") == content(tmp_path / "alone")


def several(tmp_path: Path, *more: str) -> Result:
    """A run over two fonts and something that is no font, by a list."""
    (tmp_path / "bad\x1b[31m.ttf").write_bytes(b"no font at all")
    (tmp_path / "list.txt").write_text(f"{FONTS / 'variable.ttf'}\n# no\n{tmp_path}/bad*\n", encoding="utf-8")
    inputs = [FONT, f"@{tmp_path / 'list.txt'}"]
    return runner.invoke(app, ["convert", *inputs, "--text", "Oo", "--out", str(tmp_path / "out"), "-j", "0", *more])


def test_several_fonts_end_with_a_table_whose_failures_come_last(tmp_path: Path) -> None:
    result = several(tmp_path, "--format", "svg")
    assert (result.exit_code, result.stdout) == (1, "")
    lines = result.stderr.splitlines()
    assert f"{FONT}: not in the font: U+006F o" in lines
    assert f"{FONTS / 'variable.ttf'}: not in the font: U+004F O" in lines
    heading = next(k for k, line in enumerate(lines) if "outside tolerance" in line)
    cells = [[cell.strip() for cell in line.split("|")] for line in lines[heading:-1] if "|" in line]
    assert cells[0] == ["font", "glyphs", "failed", "outside tolerance", "seconds"]
    assert [row[1:4] for row in cells[1:]] == [["1", "0", "0"], ["1", "0", "0"], ["-", "-", "-"], ["2", "0", "0"]]
    assert lines[-1].startswith("failed: ")
    assert "\x1b" not in result.stderr
    run = json.loads((tmp_path / "out" / "variable-ttf" / "run.json").read_text())
    assert run["missing"] == {"count": 1, "first": ["U+004F"]}
    assert not list(tmp_path.glob("**/.lock"))


def test_the_summary_as_json_is_alone_on_standard_output(tmp_path: Path) -> None:
    result = several(tmp_path, "--json", "--quiet", "--format", "svg")
    facts = json.loads(result.stdout)
    assert (facts["glyphs"], facts["failed"], facts["unreadable"], facts["missing"]) == (2, 0, 1, 2)
    assert [run["statuses"] for run in facts["fonts"] if run["error"] is None] == [{"ok": 1}, {"ok": 1}]
    alone = ["convert", FONT, "--text", "O", "--out", str(tmp_path / "one"), "-j", "0", "--json", "--format", "svg"]
    result = runner.invoke(app, alone)
    (run,) = json.loads(result.stdout)["fonts"]
    assert (run["out"], run["aim"]) == (str(tmp_path / "one"), "1.02 units")
    assert json.loads(result.stderr.splitlines()[-1]) == {"done": 1, "total": 1, "failed": 0}


def test_what_is_not_within_the_tolerance_is_named(tmp_path: Path) -> None:
    summary = Summary(aim="1 units", seconds=0.25, done=9)
    for k in range(9):
        contour = {"within_tolerance": k <= 1, "new_crossings": k == 3}
        summary.add({"glyph": f"g{k}", "status": "ok", "deviation": k / 4, "contours": [contour]})
    assert summary.headline() == "9 glyphs in 0.2 s, 7 not within 1 units"
    assert list(summary.lines()) == [
        "not within 1 units: g2, g3, g4, g5, g6 and 2 more",
        "cross where the source does not: g3",
    ]
    summary = Summary(aim="1.02 units", seconds=0.4, done=2)
    for name in "龍好":
        summary.add({"glyph": name, "status": "ok", "deviation": 1.0, "contours": None})
    assert summary.headline() == "2 glyphs in 0.4 s, all within 1.02 units"
    assert list(summary.lines()) == []


def test_a_run_into_a_folder_that_is_locked_is_refused(tmp_path: Path) -> None:
    with locked(tmp_path):
        options = ["--text", "O", "--out", str(tmp_path), "-j", "0", "--format", "svg"]
        for inputs in ([FONT], [FONT, str(FONTS / "variable.ttf")]):
            result = runner.invoke(app, ["convert", *inputs, *options])
            assert result.exit_code == 2
            assert f"another run is writing to it: process {os.getpid()}" in result.stderr
    assert list(tmp_path.iterdir()) == []


def old_font(path: Path) -> None:
    """A font of which fontTools says that its time of creation is very low."""
    font = TTFont(FONT, recalcTimestamp=False)
    font["head"].created = 1_300_000_000
    font.save(path)


def test_what_fonttools_logs_is_said_once_and_not_if_quiet(tmp_path: Path) -> None:
    old_font(tmp_path / "old.ttf")
    options = ["--text", "O8", "--out", str(tmp_path / "out"), "-j", "1", "--format", "svg"]
    said = call("-m", "glyphspline", "convert", str(tmp_path / "old.ttf"), *options).stderr
    assert said.count("'created' timestamp seems very low") == 1
    assert said.startswith("fontTools: ")
    done = call("-m", "glyphspline", "convert", str(tmp_path / "old.ttf"), *options, "--quiet", "--restart")
    assert (done.returncode, done.stderr) == (0, "")


def test_settings_come_from_files_and_the_command_line_wins(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def converted(*more: str) -> dict[str, Any]:
        result = runner.invoke(app, ["convert", FONT, "--text", "O", "--restart", "-j", "0", *more])
        assert result.exit_code == 0, result.output
        return json.loads((tmp_path / "out" / "run.json").read_text())

    monkeypatch.chdir(tmp_path)
    project = (
        '[tool.glyphspline]\nout = "out"\nformat = ["svg"]\ntolerance = 4\nview-box = "ink"\nremove-overlaps = true\n'
    )
    (tmp_path / "pyproject.toml").write_text(project)
    run = converted()
    assert (run["formats"], run["options"]["tolerance"], run["view_box"]) == (["svg"], 4.0, "ink")
    assert run["options"]["remove_overlaps"] is True
    (tmp_path / "mine.toml").write_text('tolerance = 3.0\ncorners = "sharp"\nview_box = "ink"\n')
    run = converted("--config", "mine.toml", "--corners", "smooth")
    assert (run["options"]["tolerance"], run["options"]["corners"], run["view_box"]) == (3.0, "smooth", "ink")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("tolerence = 3", "mine.toml: no option 'tolerence'"),
        ("config = 'x'", "mine.toml: no option 'config'"),
        ("tolerance = ", "mine.toml: is not TOML"),
        ("tolerance = {a = 1}", "mine.toml: tolerance cannot be"),
        ("tolerance = 'x'", "'--tolerance': 'x' is not a number"),
        (None, "mine.toml: cannot be read"),
    ],
)
def test_settings_that_are_none_are_refused(text: str | None, words: str, tmp_path: Path) -> None:
    if text is not None:
        (tmp_path / "mine.toml").write_text(text)
    given = ["--config", str(tmp_path / "mine.toml"), "--out", str(tmp_path / "out")]
    result = runner.invoke(app, ["convert", FONT, "--text", "O", *given])
    assert result.exit_code == 2
    assert words in result.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--tolerance", "-1"], "--tolerance is a positive distance, not -1.0"),
        (["--tolerance", "abc"], "'--tolerance': 'abc' is not a number"),
        (["--tolerance", "nan"], "--tolerance is a positive distance, not nan"),
        (["--strokes", "--location", "Bold"], "--strokes is for drawings"),
        (["--precision", "12"], "--precision is a whole number from 0 to 9, not 12"),
        (["--count", "2.5"], "'--count': '2.5' is not a whole number"),
        (["--jobs", "-1"], "-1' is not a whole number from 0 on"),
        (["--face-index", "x"], "'--face-index': 'x' is not a whole number"),
        (["--out", ""], "'--out' / '-o': it is empty"),
    ],
)
def test_a_bad_number_names_option_and_value(arguments: list[str], words: str, tmp_path: Path) -> None:
    result = runner.invoke(app, ["convert", FONT, "--all", "--out", str(tmp_path / "out"), *arguments])
    assert result.exit_code == 2
    assert words in " ".join(result.stderr.replace("│", " ").split())


def test_short_help_version_and_completion() -> None:
    assert runner.invoke(app, ["--version"]).stdout == f"glyphspline {glyphspline.__version__}\n"
    said = runner.invoke(app, ["-h"]).stdout
    assert "--show-completion" in said
    said = " ".join(runner.invoke(app, ["convert", "-h"]).stdout.replace("│", " ").split())
    for words in (
        "Which glyphs",
        "How close to the source",
        "corners (sharp), or draw one curve a",
        "the paper's terms",
    ):
        assert words in said


def test_files_are_called_after_characters_if_asked(tmp_path: Path) -> None:
    options = ["--text", "龍O", "--names", "char", "--format", "svg", "--out", str(tmp_path / "out"), "-j", "0"]
    assert runner.invoke(app, ["convert", FONT, *options]).exit_code == 0
    assert {path.name for path in (tmp_path / "out" / "svg").iterdir()} == {"龍.svg", "O.svg"}


@pytest.mark.parametrize(("tolerance", "status"), [("1", 0), ("0.00001", 1)])
@pytest.mark.parametrize("command", ["convert", "text", "atlas", "dataset"])
def test_a_missed_tolerance_is_something_that_was_not_done(
    command: str, tolerance: str, status: int, tmp_path: Path
) -> None:
    given = ["O"] if command == "text" else ["--text", "O", *(["--format", "svg"] if command == "convert" else [])]
    out = tmp_path / {"text": "o.svg", "atlas": "o.pdf"}.get(command, "o")
    font = str(ROOT / "fonts_test" / "kouzan-gyosho.ttf")
    words = [command, font, *given, "--corners", "smooth", "--tolerance", tolerance, "--out", str(out)]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == status, result.output
