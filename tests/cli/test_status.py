"""The exit status of each command: 0 all done, 1 something was not, 2 nothing could be."""

from __future__ import annotations

import re
from pathlib import Path

import matplotlib
import pytest
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from tests.places import FONTS, GYOSHO
from tests.plugins.datasets.test_dataset import broken_glyph
from tests.readers.test_bulk import with_anchors

VARIABLE = FONTS / "variable.ttf"
DEJAVU = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A font that has a broken glyph, one with contours of one point, a file that is no font, and a stroked drawing."""
    folder = tmp_path_factory.mktemp("status")
    broken_glyph(folder / "broken.ttf")
    with_anchors(folder / "points.ttf")
    (folder / "bad.ttf").write_bytes(b"no font")
    path = '<path d="M10 10H90V90H10Z" stroke="red"/>'
    (folder / "part.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">{path}</svg>')
    return folder


CONVERT = "convert {gyosho} --format svg -j 0 --out {new}"
DONE = [
    f"{CONVERT} --text O",
    f"{CONVERT} --text O --step 40",  # no tolerance is asked for
    "convert {place}/points.ttf --format svg -j 0 --out {new} --all",
    "refit {variable} --masters --text o --format ttf -j 0 --out {new}",
    "dataset {variable} --no-fit --jobs 0 --out {new}",
    "text {gyosho} Og -o {new}.svg",
    "text {dejavu} Hamburg -o {new}.svg",
    "info {gyosho}",
    "info {place}/broken.ttf --deep",
    "atlas {gyosho} --text O -o {new}.pdf",
    "check {gyosho} --text O -j 0",
    "diff {gyosho} {gyosho} --text O -j 0",
    "demo {gyosho} --text O -j 0 -o {new}",
    "experiment {gyosho} --text O --sheets 0 -j 0 -o {new}",
]
UNDONE = [
    f"{CONVERT} --text O龘",  # a character is missing
    f"{CONVERT} --text O --tolerance 0.001 --precision 2",  # nothing is within a tenth of the last digit written
    "convert {place}/broken.ttf --format svg -j 0 --out {new} --all",  # a glyph fails
    "convert {gyosho} {place}/bad.ttf --text O --format svg -j 0 --out {new}",  # one of two fonts
    "refit {variable} --masters --text o龘 --format ttf -j 0 --out {new}",
    "dataset {place}/broken.ttf --no-fit --jobs 0 --out {new}",
    "dataset {variable} {place}/bad.ttf --no-fit --jobs 0 --out {new}",
    "text {gyosho} O龘 -o {new}.svg",
    "text {place}/broken.ttf AO -o {new}.svg",
    "text {dejavu} e\U000e0100 -o {new}.svg",  # a variation that the font has not
    "text {gyosho} O --tolerance 0.001 --precision 2 -o {new}.svg",
    "atlas {gyosho} --text O龘 -o {new}.pdf",
    "atlas {place}/broken.ttf --all -o {new}.pdf",
    "check {gyosho} --text O龘 -j 0",
    "check {place}/broken.ttf -j 0",
    "check {gyosho} {place}/bad.ttf --text O -j 0",
    "check {gyosho} -j 0 -e INFO",
    "convert {place}/part.svg --all --format svg -j 0 --out {new}",  # a stroke is not read
    "check {place}/part.svg -j 0",
    "diff {place}/part.svg {place}/part.svg -j 0",
    "dataset {place}/part.svg --no-fit --jobs 0 --out {new}",
    "diff {gyosho} {variable} --text O -j 0",
    "diff {gyosho} {gyosho} --text O龘 -j 0",
    "demo {gyosho} --text O龘 -j 0 -o {new}",
]
UNUSABLE = [
    "convert {place}/bad.ttf --text O -j 0 --out {new}",
    "refit {place}/bad.ttf -j 0 --out {new}",
    "refit {gyosho}",  # where to is not said
    "text {place}/bad.ttf O -o {new}.svg",
    "info {place}/bad.ttf",
    "atlas {place}/bad.ttf --text O -o {new}.pdf",
    "check {place}/bad.ttf -j 0",
    "diff {place}/bad.ttf {gyosho} -j 0",
    "view {place}/bad.ttf --no-browser",
    "demo {place}/bad.ttf -j 0 -o {new}",
    f"{CONVERT} --text 龘",
    "convert {gyosho} --text O --format otf -j 0 --out {new}",  # refit does that
    "refit {gyosho} --text O -j 0",  # nor is it said where to
    "refit {gyosho} --in-place -j 0",
    "refit {variable} --masters --format otf,ttf -j 0 --out {new}",  # cubics and quadratics of one fit
    "dataset {place}/none --jobs 0 --out {new}",
    "report {place}",
    "warm --jobs two",
]


@pytest.mark.parametrize(
    ("call", "status"),
    [(call, status) for status, calls in enumerate((DONE, UNDONE, UNUSABLE)) for call in calls],
)
def test_one_rule_for_all_commands(call: str, status: int, place: Path, tmp_path: Path) -> None:
    places = {"gyosho": GYOSHO, "variable": VARIABLE, "dejavu": DEJAVU, "place": place, "new": tmp_path / "new"}
    result = CliRunner().invoke(app, [part.format(**places) for part in call.split()])
    assert result.exit_code == status, result.output


def test_contours_of_one_point_are_not_worth_a_word(tmp_path: Path) -> None:
    assert gs.open_font(DEJAVU).outline("u").notes, "its point is an anchor"
    result = CliRunner().invoke(app, ["text", str(DEJAVU), "u", "-o", str(tmp_path / "u.svg")])
    assert (result.exit_code, result.output) == (0, "")


@pytest.mark.parametrize(
    ("text", "status", "said"),
    [
        ("e\u0301", 0, ""),  # one glyph
        ("q\u0301", 0, "drawn by several glyphs: q\u0301 (q, acutecomb)"),
        ("e\U000e0100", 1, "not in the font: U+0065 U+E0100"),
        ("e\u4e00\u0301", 1, "not in the font: U+4E00"),
    ],
)
def test_what_is_not_drawn_as_it_was_asked_for_is_said(text: str, status: int, said: str, tmp_path: Path) -> None:
    call = ["convert", str(DEJAVU), "--text", text, "--step", "200", "--format", "svg", "-j", "0", "-o", str(tmp_path)]
    result = CliRunner().invoke(app, call)
    assert result.exit_code == status, result.output
    assert said in result.stderr
    assert "several" in said or "several" not in result.stderr


@pytest.mark.parametrize(
    "call", ["convert --text 永 --format svg -j 0 -o {new}", "text 永 -o {new}.svg", "check --text 永 -j 0"]
)
def test_a_collection_says_which_face_is_taken(call: str, tmp_path: Path) -> None:
    command, *rest = call.format(new=tmp_path / "new").split()
    for more, said in (([], True), (["--face-index", "0"], False)):
        result = CliRunner().invoke(app, [command, str(FONTS / "kouzan.ttc"), *rest, *more])
        assert result.exit_code == 0, result.output
        assert ("face 0 of 2 is taken, Kouzan" in result.stderr) == said


def test_the_help_has_the_rule() -> None:
    assert "Exit status: 0 all was done; 1" in " ".join(CliRunner().invoke(app, ["--help"]).output.split())


@pytest.mark.parametrize(
    "call",
    [
        "check {font} -j 0 --html {new}/deep/a.html --csv {new}/b/b.csv --ghmarkdown {new}/c/c.md "
        "--plot {new}/d/d.svg --write-baseline {new}/e/e.json",
        "diff {font} {font} -j 0 --html {new}/deep/f.html",
        "text {font} o -o {new}/deep/g.svg",
        "atlas {font} --text o -o {new}/deep/h.pdf",
    ],
)
def test_files_have_their_folders_made(call: str, tmp_path: Path) -> None:
    words = call.format(font=VARIABLE, new=tmp_path / "new").split()
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output
    assert all(Path(word).is_file() for word in words if word.startswith(str(tmp_path)))


@pytest.mark.parametrize("option", ["--text-file", "--fallback-font"])
def test_messages_of_the_system_name_the_file_and_have_no_number(option: str, tmp_path: Path) -> None:
    words = "" if option == "--text-file" else "O"
    call = ["text", str(GYOSHO), *filter(None, [words]), option, str(tmp_path / "none"), "-o", str(tmp_path / "a.svg")]
    result = CliRunner().invoke(app, call)
    assert result.exit_code == 2
    assert re.search(f"^glyphspline: {tmp_path}/none: .*No such file or directory$", result.stderr, re.MULTILINE)
    assert "Errno" not in result.output
