"""Each command where nothing is compiled: it runs as plain Python, at once, and compiles nothing."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from starlette.testclient import TestClient
from typer.testing import CliRunner

from glyphspline import hooks
from glyphspline.cli.app import app
from glyphspline.code_files import OFF, PLACE, kept
from glyphspline.plugins.viewer.app import make_app
from glyphspline.report import FOLDER as GALLERY
from glyphspline.runs.pool import kill_server
from glyphspline.writers.formats import OURS
from tests.variable_fonts import polygon, quadratic, variable_font

ROUND = [(0, 0), (200, -40), (400, 0), (440, 300), (400, 600), (200, 640), (0, 600), (-40, 300)]
ON = [True, False] * 4
BOX = [(50, 0), (150, 0), (150, 700), (50, 700)]

CONVERSIONS = [
    *([f"--format={name}"] for name in (*OURS, GALLERY, *hooks.names("formats"), "parquet")),
    ["--corners=smooth"],
    ["--step=150"],
    ["--count=8"],
    ["--preset=type", "--format=svg"],
    ["--remove-overlaps", "--format=svg"],
]
FITS = [
    *([f"--format={name}"] for name in ("otf", "ttf", "ufo", "svg")), [], ["--continuity=c2"],
    ["--masters", "--format=gallery"], ["--masters"],
]  # fmt: skip


@pytest.fixture(scope="module")
def font(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A variable font of a box and a round glyph."""
    wider = [((wght := {"wght": (0.0, 1.0, 1.0)}), [(0, 0), (60, 0), (60, 0), (0, 0)])]
    moved = [(wght, [(2 * (x > 200), 0) for x, _ in ROUND])]
    glyphs = {"l": polygon(*BOX), "o": quadratic(ROUND, ON)}
    return variable_font(tmp_path_factory.mktemp("font") / "small.ttf", glyphs, {"l": wider, "o": moved})


@pytest.fixture(autouse=True)
def nothing_compiled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Compiled code is looked for in an empty folder, by worker processes too; none is there after the test."""
    place = tmp_path / "nothing"
    with monkeypatch.context() as change:
        change.setenv(PLACE, str(place))
        kill_server()
        kept.look_again(anew=True)
        yield
    kill_server()  # other tests' workers are not to look there
    kept.look_again(anew=True)
    assert not place.exists() or not [*place.iterdir()]


def ran(*words: object, status: int = 0) -> str:
    """What a command prints, in this process."""
    found = CliRunner().invoke(app, [str(word) for word in words])
    if found.exception is not None and not isinstance(found.exception, SystemExit):
        raise found.exception
    assert found.exit_code == status, found.output
    return found.stdout


@pytest.mark.parametrize(
    ("verb", "options"), [*(("convert", each) for each in CONVERSIONS), *(("refit", each) for each in FITS)]
)
def test_convert_and_refit(verb: str, options: list[str], font: Path, tmp_path: Path) -> None:
    text = "o" if {"--corners=smooth", "--count=8"} & {*options} else "l"
    facts = json.loads(ran(verb, font, "--text", text, *options, "-j0", "--json", "--out", tmp_path / "out"))
    assert not facts["failed"]
    assert [path for path in (tmp_path / "out").rglob("*") if path.is_file()]


def test_info_check_diff_text_and_atlas(font: Path, tmp_path: Path) -> None:
    assert "Masters" in ran("info", font)
    ran("check", font, "--text", "lo", "-j0")
    ran("check", font, "--text", "l", "-j0", "--axis", "wght")
    ran("diff", font, font, "--text", "lo", "-j0")
    ran("text", font, "lo", "--out", tmp_path / "line.svg")
    ran("atlas", font, "--text", "lo", "-j0", "--out", tmp_path / "combs.pdf")
    assert (tmp_path / "line.svg").stat().st_size > 300
    assert (tmp_path / "combs.pdf").stat().st_size > 5000


def test_dataset_and_report(font: Path, tmp_path: Path) -> None:
    ran("dataset", font, "--text", "lo", "-j0", "--out", tmp_path / "rows")
    ran("convert", font, "--text", "l", "-j0", "--out", tmp_path / "run")
    (tmp_path / "run" / "index.html").unlink()
    ran("report", tmp_path / "run")
    assert (tmp_path / "run" / "index.html").exists()


def test_mend(font: Path, tmp_path: Path) -> None:
    ran("refit", font, "--text", "lo", "--format", "ufo", "-j0", "--out", tmp_path / "run")
    (source,) = (tmp_path / "run").rglob("*.ufo")
    ran("mend", source, "-j0", "--out", tmp_path / "mended")


def test_view_shows_a_glyph(font: Path) -> None:
    client = TestClient(make_app(font, hosts=("testserver",)))
    assert client.get("/").status_code == 200
    assert client.get("/api/font").json()["family"] == "Masters"
    state = {"glyph": "l", "sampling": "count", "amount": 8, "variant": 2, "corners": "smooth"}
    assert client.post("/api/glyph", json=state).json()["result"].startswith("M")


@pytest.mark.parametrize("variable", [OFF, PLACE])
def test_workers_run_as_plain_python(variable: str, font: Path, tmp_path: Path) -> None:
    place = "1" if variable == OFF else str(tmp_path / "nothing")
    words = ["convert", str(font), "--text", "lo", "-j1", "--out", str(tmp_path / "out")]
    call, own = [sys.executable, "-m", "glyphspline", *words], os.environ | {variable: place}
    run = subprocess.run(call, env=own, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert sorted(path.name for path in (tmp_path / "out" / "svg").iterdir()) == ["l.svg", "o.svg"]
