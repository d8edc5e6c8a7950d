"""The command: tables, sheets and the page; runs that go on; bad input."""

from __future__ import annotations

import csv
import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from html import unescape
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.plugins.experiments.claims import verdicts
from glyphspline.plugins.experiments.measures import QUANTITIES
from glyphspline.plugins.experiments.report import ENDS, Tally
from tests.places import DEJAVU, FONTS

BRUSH = FONTS / "kouzan-gyosho.ttf"
MEASURED = {"times.csv", "times.js"}
"""Files with times."""


def call(*arguments: object, status: int = 0) -> str:
    done = CliRunner().invoke(app, ["experiment", *map(str, arguments), "-j", "0"])
    assert done.exit_code == status, done.output
    return done.output


def files(folder: Path) -> dict[str, bytes]:
    paths = (path for path in folder.rglob("*") if path.is_file() and path.name not in MEASURED)
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("experiment")
    call(BRUSH, "--text", "Oあ", "--variants", "2,3", "--out", out, "--sheets", 1, "--format", "svg,png")
    return out


def test_the_tables_say_what_python_says(made: Path) -> None:
    font = gs.open_font(BRUSH)
    rows = json.loads((made / "table.json").read_text(encoding="utf-8"))
    own = [row for name in ("O", "uni3042") for row in gs.experiment(font.outline(name), (2, 3)).rows]
    assert [{key: row[key] for key in own[0]} for row in rows] == own
    with open(made / "table.csv", encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    assert [row["bulge"] for row in table] == [str(row["bulge"]) for row in rows]
    assert {row["font"] for row in table} == {"Kouzan Gyosho Subset Regular"}
    with open(made / "times.csv", encoding="utf-8") as file:
        times = list(csv.DictReader(file))
    assert [(t["glyph"], t["contour"], t["method"]) for t in times] == [
        (row["glyph"], row["contour"], row["method"]) for row in table
    ]
    assert all(float(t["seconds"]) > 0 for t in times)


class Page(HTMLParser):
    def __init__(self, text: str) -> None:
        super().__init__()
        self.rows = self.images = 0
        self.addresses: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.rows += tag == "tr"
        self.images += tag == "img"
        self.addresses += [value for key, value in attrs if key in ("src", "href") and value]


def test_the_page_stands_alone(made: Path) -> None:
    text = (made / "index.html").read_text(encoding="utf-8")
    page = Page(text)
    rows = json.loads((made / "table.json").read_text(encoding="utf-8"))
    assert page.images == 1  # one sheet was asked for
    assert page.rows > len(rows)
    assert all(address.startswith("data:image/") for address in page.addresses)
    assert "Variant 3 needs the most iterations." in text
    assert "glyphspline experiment kouzan-gyosho.ttf --text 'Oあ' --" in unescape(text)
    assert str(made) not in text
    seconds = re.fullmatch(r"glyphsplineData\((.*)\);\n", (made / "times.js").read_text(encoding="ascii"))
    assert seconds
    assert len(json.loads(seconds[1])) == len(rows)


def test_a_run_is_the_same_again_and_goes_on(made: Path, tmp_path: Path) -> None:
    how = ("--variants", "2,3", "--out", tmp_path, "--sheets", 1, "--format", "svg,png")
    call(BRUSH, "--text", "O", *how)
    sheet = (tmp_path / "svg/O.svg").stat().st_mtime_ns
    call(BRUSH, "--text", "Oあ", *how)
    assert files(tmp_path) == files(made)
    assert (tmp_path / "svg/O.svg").stat().st_mtime_ns == sheet, "what is done is not done again"
    said = call(BRUSH, "--text", "O", "--step", 30, *how, status=2)
    assert "step: null in the folder, 30.0 now" in said


def test_workers_make_the_same_files(made: Path, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "glyphspline", "experiment", str(BRUSH), "--text", "Oあ", "--variants", "2,3"]
    command += ["--out", str(tmp_path), "--sheets", "1", "--format", "svg,png", "--jobs", "2", "--quiet"]
    subprocess.run(command, check=True, env=os.environ)
    assert files(tmp_path) == files(made)


def test_clicked_points_are_taken_and_choose_the_glyphs(tmp_path: Path) -> None:
    points = tmp_path / "points.csv"
    corners = [(100, 100), (900, 120), (880, 800), (500, 950), (90, 820)]
    lines = [f"好,0,{x},{y}\n" for x, y in corners]
    points.write_text("glyph,contour,x,y\n" + "".join(lines), encoding="utf-8")
    call(BRUSH, "--clicked", points, "--out", tmp_path / "out", "--sheets", 0)
    rows = json.loads((tmp_path / "out/table.json").read_text(encoding="utf-8"))
    assert {(row["glyph"], row["contour"], row["vertices"]) for row in rows} == {("uni597D", 0, 5)}
    found = gs.interpolate(corners, 3, residual_tolerance=1024e-7)
    assert [row["iterations"] for row in rows if row["method"] in ("variant 3", "PIA")] == [found.iterations] * 2
    assert "none of it" in call(BRUSH, "--text", "O", "--clicked", points, "--out", tmp_path / "o", status=1)
    run = json.loads((tmp_path / "out/run.json").read_text(encoding="utf-8"))
    assert run["command"] == "glyphspline experiment kouzan-gyosho.ttf --glyphs uni597D --clicked points.csv --sheets 0"


def test_several_fonts_come_into_one_table(tmp_path: Path) -> None:
    said = call(BRUSH, DEJAVU, "--text", "O", "--count", 12, "--out", tmp_path, "--sheets", 0, "--variants", "1-3")
    rows = json.loads((tmp_path / "table.json").read_text(encoding="utf-8"))
    assert {row["font"] for row in rows} == {"Kouzan Gyosho Subset Regular", "DejaVu Sans Book"}
    assert {row["vertices"] for row in rows} == {12}
    assert "2 glyphs, 4 contours, 7 curves of each" in said
    assert "2 fonts" in (tmp_path / "index.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--variants", "5"), "--variants is a list of 0 to 4"),
        (("--variants", "2-"), "--variants is a list of 0 to 4"),
        (("--count", "9", "--step", "3"), "one of them"),
        (("--format", "gif"), "a sheet is png, svg, pdf, not 'gif'"),
        (("--clicked", "away.csv"), "away.csv"),
        (("--text", "龘"), "not in the font"),
    ],
)
def test_bad_calls_end_with_a_sentence(arguments: tuple[str, ...], words: str, tmp_path: Path) -> None:
    assert words in call(BRUSH, *arguments, "--out", tmp_path, status=2)


def tally(**columns: dict[str, list[Any]]) -> Tally:
    """Contours with these numbers by variant."""
    found = Tally()
    for variant, own in columns.items():
        for values in zip(*own.values(), strict=True):
            row = dict.fromkeys(QUANTITIES) | dict(zip(own, values, strict=True))
            found.add(row | {"method": f"variant {variant[1]}"})
    return found


def said_of(found: Tally) -> Iterator[tuple[str, str]]:
    return ((source, verdict) for source, _, _, verdict in verdicts(found))


def test_a_verdict_is_what_the_numbers_say() -> None:
    fast: dict[str, list[Any]] = {
        "iterations": [20, 22], "converged": [True, True], "bulge": [4, 5], "curvature_variation": [10, 10],
        "vertices": [30, 30], "fallbacks": [0, 0],
    }  # fmt: skip
    slow = fast | {"iterations": [40, 50], "bulge": [9, 5], "curvature_variation": [12, 13]}
    good = dict(said_of(tally(v1=fast | {"iterations": [19, 22]}, v2=fast, v3=slow)))
    assert set(good.values()) == {"reproduced"}
    assert set(good) == {"Section 4.1", "Fig. 3", "Section 4.2", "Section 4.4", "Figs. 6 and 7", "Figs. 8 and 9"}
    bad = dict(said_of(tally(v1=slow, v2=slow | {"fallbacks": [9, 0]}, v3=fast | {"converged": [True, False]})))
    assert set(bad.values()) == {"differs"}
    zero = fast | {"vertices": [30, 80], "converged": [True, False]}
    assert ("Fig. 2", "reproduced") in set(said_of(tally(v0=zero)))
    assert ("Fig. 2", "differs") in set(said_of(tally(v0=zero | {"converged": [False, True]})))


def test_means_are_of_contours_with_about_as_many_vertices() -> None:
    vertices: list[Any] = [5, 6, 7, 8, 40]
    found = tally(v2={"vertices": vertices, "iterations": [10, 20, 60, 30, 7]})
    groups = {row["from"]: row for row in found.groups()}
    assert groups.keys() <= {*ENDS}
    assert [groups[3][f"iterations, {what}"] for what in ("mean", "median")] == [30, 20]
    assert groups[3]["iterations, 90%"] == pytest.approx(np.quantile([10, 20, 60], 0.9))
    assert (groups[8]["contours"], groups[32]["iterations, mean"]) == (1, 7)
    assert groups[3]["bulge, mean"] is None
