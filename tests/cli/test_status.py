"""The exit status of each command: 0 all done, 1 something was not, 2 nothing could be."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import pytest
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli import app
from tests.datasets.test_dataset import broken_glyph
from tests.places import FONTS, GYOSHO
from tests.readers.test_bulk import with_anchors

VARIABLE = FONTS / "variable.ttf"
DEJAVU = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a font that has a broken glyph, one with contours of one point, and a file that is no font."""
    folder = tmp_path_factory.mktemp("status")
    broken_glyph(folder / "broken.ttf")
    with_anchors(folder / "points.ttf")
    (folder / "bad.ttf").write_bytes(b"no font")
    return folder


CONVERT = "convert {gyosho} --format svg -j 0 --out {new}"
DONE = [
    f"{CONVERT} --text O",
    f"{CONVERT} --text O --step 40 --measure",  # no tolerance is asked for
    "convert {place}/points.ttf --format svg -j 0 --out {new} --all",
    "convert {variable} --masters --text o --format ttf -j 0 --out {new}",
    "dataset {variable} --no-fit --jobs 0 --out {new}",
    "text {gyosho} Og -o {new}.svg",
    "text {dejavu} Hamburg -o {new}.svg",
    "info {gyosho}",
    "info {place}/broken.ttf --deep",
    "atlas {gyosho} --text O -o {new}.pdf",
    "check {gyosho} --text O -j 0",
    "diff {gyosho} {gyosho} --text O -j 0",
    "demo {gyosho} --text O -j 0 -o {new}",
]
UNDONE = [
    f"{CONVERT} --text O龘",  # a character is missing
    f"{CONVERT} --text O --tolerance 0.001",  # nothing is within a tenth of the last digit written
    "convert {place}/broken.ttf --format svg -j 0 --out {new} --all",  # a glyph fails
    "convert {gyosho} {place}/bad.ttf --text O --format svg -j 0 --out {new}",  # one of two fonts
    "convert {variable} --masters --text o龘 --format ttf -j 0 --out {new}",
    "dataset {place}/broken.ttf --no-fit --jobs 0 --out {new}",
    "dataset {variable} {place}/bad.ttf --no-fit --jobs 0 --out {new}",
    "text {gyosho} O龘 -o {new}.svg",
    "text {place}/broken.ttf AO -o {new}.svg",
    "text {gyosho} O --tolerance 0.001 -o {new}.svg",
    "atlas {gyosho} --text O龘 -o {new}.pdf",
    "atlas {place}/broken.ttf --all -o {new}.pdf",
    "check {gyosho} --text O龘 -j 0",
    "check {place}/broken.ttf -j 0",
    "check {gyosho} {place}/bad.ttf --text O -j 0",
    "check {gyosho} -j 0 -e INFO",
    "diff {gyosho} {variable} --text O -j 0",
    "diff {gyosho} {gyosho} --text O龘 -j 0",
    "demo {gyosho} --text O龘 -j 0 -o {new}",
]
UNUSABLE = [
    "convert {place}/bad.ttf --text O -j 0 --out {new}",
    "text {place}/bad.ttf O -o {new}.svg",
    "info {place}/bad.ttf",
    "atlas {place}/bad.ttf --text O -o {new}.pdf",
    "check {place}/bad.ttf -j 0",
    "diff {place}/bad.ttf {gyosho} -j 0",
    "view {place}/bad.ttf --no-browser",
    "demo {place}/bad.ttf -j 0 -o {new}",
    f"{CONVERT} --text 龘",
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


def test_the_help_has_the_rule() -> None:
    assert "Exit status: 0 all was done; 1" in " ".join(CliRunner().invoke(app, ["--help"]).output.split())
