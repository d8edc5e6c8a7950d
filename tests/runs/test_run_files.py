"""What a run writes besides drawings: names of files, run.json, columns of the manifest; and the lock of its folder."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from glyphspline.errors import GlyphsplineError, OutputError
from glyphspline.fitting.options import Options
from glyphspline.readers import Font, Selection, open_font, open_source
from glyphspline.runs.convert import convert_font
from glyphspline.runs.file_names import file_names
from glyphspline.runs.folder import LOCK, entries_of, locked
from glyphspline.runs.spec import RunSpec
from glyphspline.types import Names
from glyphspline.writers.settings import Appearance, Maps, Settings
from tests.places import FONTS, GYOSHO, ROOT

SPEC = RunSpec(Options(step=90), ("svg",))


@pytest.fixture(scope="module")
def font() -> Font:
    return open_font(FONTS / "kouzan-gyosho.otf")


def test_only_names_that_clash_in_case_change() -> None:
    names = [".notdef", "space", "A", "a", "B", "uni9F8D", "Aacute", "c.ss01", "C.sc"]
    assert file_names(names) == ["_notdef", "space", "A_", "a", "B", "uni9F8D", "Aacute", "c.ss01", "C.sc"]


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        ("unicode", [".notdef", "uni0020", "uni0041", "uni0061", "uni9F8D", "u20000", "a.alt"]),
        ("gid", ["00000", "00001", "00002", "00003", "00004", "00005", "00006"]),
        ("char", [".notdef", "uni0020", "A_", "a", "龍", "𠀀", "a.alt"]),
    ],
)
def test_files_are_called_after_what_is_asked_for(names: Names, expected: list[str]) -> None:
    glyphs = [".notdef", "space", "A", "a", "dragon", "rare", "a.alt"]
    cmap = {0x20: "space", 0x41: "A", 0x61: "a", 0x9F8D: "dragon", 0x2FA1D: "dragon", 0x20000: "rare"}
    assert file_names(glyphs, names, cmap) == [name.replace(".notdef", "_notdef") for name in expected]


def test_a_glyph_is_called_by_the_character_that_was_asked_for_or_the_unified_one() -> None:
    glyphs, cmap = ["dragon", "dollar", "heavy", "A"], {0x2FD3: "dragon", 0x9F8D: "dragon", 0x24: "dollar", 0xF041: "A"}
    assert file_names(glyphs, "char", cmap) == ["龍", "$", "heavy", "uniF041"]
    assert file_names(glyphs, "unicode", cmap)[0] == "uni9F8D"
    asked = {"dragon": "\u2fd3", "heavy": "$", "A": "A"}  # the dollar is not what is seen at the location
    assert file_names(glyphs, "char", cmap, asked=asked) == ["\u2fd3", "dollar", "$", "A"]
    assert file_names(["A", "a"], "char", {0x41: "A", 0x61: "a"}, [0], {"A": "A"}) == ["A_"]  # as the whole font
    assert file_names(glyphs, "char", cmap, asked={"A": "葛\U000e0100"})[3] == "葛-uE_0100"


def test_files_that_are_there_keep_their_names(tmp_path: Path) -> None:
    """Names depend on what is asked for; another call in the same folder takes none of them."""
    font, spec = open_font(GYOSHO), RunSpec(Options(step=90), ("svg",), names="char")
    one = Selection(["A"], characters={"A": "B"})
    convert_font(font, one, tmp_path, spec, jobs=0)
    convert_font(font, tuple(font.select(text="AB")), tmp_path, spec, jobs=0)
    assert [entry["files"] for entry in entries_of(tmp_path)] == [{"svg": "svg/B.svg"}, {"svg": "svg/B_2.svg"}]


def test_characters_that_lead_out_of_a_folder_are_not_in_a_name() -> None:
    cmap = dict(zip(map(ord, './\\:*?"<>|\u202e\u0301\0'), "abcdefghijklm", strict=True))
    assert all(name.startswith("uni") for name in file_names("abcdefghijklm", "char", cmap))


def test_names_alike_but_for_composition_differ() -> None:
    names = file_names(["é", "e\u0301", "É", "ﬁ", "fi"])
    assert len(set(names)) == 5
    assert names[4] != names[3]


def test_a_part_of_the_font_has_the_names_of_the_whole(tmp_path: Path) -> None:
    source = open_font(FONTS / "edge-cases.ttf")
    for names in (None, *source.glyph_names[1:4]):
        chosen = source.glyph_names if names is None else [names]
        convert_font(source, chosen, tmp_path / "out", SPEC, jobs=0, restart=True)
        found = {entry["glyph"]: entry["files"].get("svg") for entry in entries_of(tmp_path / "out")}
        if names is None:
            whole = found
        else:
            assert found == {names: whole[names]}


def test_other_names_are_another_run(font: Font, tmp_path: Path) -> None:
    convert_font(font, font.select(text="O"), tmp_path, SPEC, jobs=0)
    with pytest.raises(OutputError, match="names"):
        convert_font(font, font.select(text="O"), tmp_path, RunSpec(SPEC.options, ("svg",), names="gid"), jobs=0)
    with pytest.raises(GlyphsplineError, match="names"):
        RunSpec(names="name")  # type: ignore[arg-type]


def test_run_json_has_the_options_in_effect_the_selection_and_the_command(font: Font, tmp_path: Path) -> None:
    spec = RunSpec(Options(corners="smooth"), ("svg",))
    summary = convert_font(font, font.select(text="O龘\ud800"), tmp_path, spec, jobs=0)
    run = json.loads((tmp_path / "run.json").read_text())
    assert run["options"]["tolerance"] == font.metrics.units_per_em / 1000
    assert run["options"]["residual_tolerance"] == 0.005
    assert run["selection"] == {"text": "O龘?"}
    assert run["selected"] == 1
    assert run["missing"] == {"count": 2, "first": ["U+9F98", "U+D800"]} == {
        "count": len(summary.missing), "first": list(summary.missing)}  # fmt: skip
    expected = "glyphspline convert kouzan-gyosho.otf --text 'O龘?' --corners smooth --format svg"
    assert run["command"] == expected


def test_the_command_of_a_run_has_how_its_drawings_look(font: Font, tmp_path: Path) -> None:
    look: dict[str, Any] = {"view_box": "ink", "em": "20mm", "fill": "none", "stroke": "red"}
    given = look | {"comb": "source", "names": "gid"}
    settings = Settings(Appearance(**look))
    spec = RunSpec(Options(step=90), ("svg",), settings, names="gid", maps=Maps("source", corner_teeth=True))
    convert_font(font, font.select(text="O"), tmp_path, spec, jobs=0)
    told = shlex.split(json.loads((tmp_path / "run.json").read_text())["command"])
    for name, value in given.items():
        option = "--size" if name == "em" else f"--{name.replace('_', '-')}"
        assert told[told.index(option) + 1] == value


def test_run_json_says_what_was_asked_for_last_and_the_rest_stays(font: Font, tmp_path: Path) -> None:
    def selection() -> object:
        return json.loads((tmp_path / "run.json").read_text())["selection"]

    convert_font(font, font.select(unicodes=[0x4F]), tmp_path, SPEC, jobs=0)
    assert selection() == {"unicodes": ["U+004F"]}
    convert_font(font, ["eight"], tmp_path, SPEC, jobs=0)
    assert selection() == {"glyphs": ["eight"]}
    convert_font(font, font.glyph_names, tmp_path, SPEC, jobs=0)
    assert selection() == {"all": True}
    assert len(list(entries_of(tmp_path))) == len(font.glyph_names)


def test_a_glyph_has_its_worst_deviation_and_its_notes_in_the_manifest(tmp_path: Path) -> None:
    source = open_font(FONTS / "edge-cases.ttf")
    convert_font(source, source.glyph_names, tmp_path, RunSpec(formats=("svg",)), jobs=0)
    entries = {entry["glyph"]: entry for entry in entries_of(tmp_path)}
    for entry in entries.values():
        assert entry["deviation"] == max((c["deviation"] for c in entry["contours"]), default=None)
    assert entries["onepoint"]["notes"] == list(source.outline("onepoint").notes) != []


DRAWINGS = {
    "stroked": '<path d="M0 0H9V9" fill="none" stroke="black"/>',
    "written": "<text>a</text>",
    "blank": "",
}


def test_a_drawing_that_came_out_empty_says_why(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    for name, content in DRAWINGS.items():
        svg = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9">{content}</svg>'
        (tmp_path / "in" / f"{name}.svg").write_text(svg)
    source = open_source(tmp_path / "in")
    for _ in range(2):  # the second time from the manifest
        summary = convert_font(source, source.glyph_names, tmp_path / "out", SPEC, jobs=0)
        lines = "\n".join(summary.lines())
        assert "not read of stroked: strokes, which --strokes draws (line 1)" in lines
        assert "not read of written: text (line 1)" in lines
        assert "blank" not in lines
        assert summary.undone


HOLD = """
import sys, time
from pathlib import Path
from glyphspline.runs.folder import locked
with locked(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(60)
"""


def test_a_second_run_is_refused_with_the_first_ones_process_and_goes_on_when_that_is_killed(
    font: Font, tmp_path: Path
) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen([sys.executable, "-c", HOLD, tmp_path], stdout=subprocess.PIPE, env=environment) as first:
        assert first.stdout is not None
        assert first.stdout.readline() == b"held\n"
        with pytest.raises(OutputError, match=f"another run is writing to it: process {first.pid} on "):
            convert_font(font, font.select(text="O"), tmp_path, SPEC, jobs=0)
        assert [path.name for path in tmp_path.iterdir()] == [LOCK]
        first.kill()
    assert (tmp_path / LOCK).exists()
    assert convert_font(font, font.select(text="O"), tmp_path, SPEC, jobs=0).done == 1
    assert not (tmp_path / LOCK).exists()


def test_a_lock_is_free_again_after_an_error_and_its_file_is_no_link(tmp_path: Path) -> None:
    def fails() -> None:
        with locked(tmp_path):
            raise KeyboardInterrupt

    for _ in range(2):
        with pytest.raises(KeyboardInterrupt):
            fails()
        assert list(tmp_path.iterdir()) == []
    (tmp_path / LOCK).symlink_to(tmp_path / "elsewhere")
    with pytest.raises(OutputError):
        fails()
    assert not (tmp_path / "elsewhere").exists()
