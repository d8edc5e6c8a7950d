"""The gallery's page and data files: complete, streamed, the same bytes each time, and safe whatever a font says."""

from __future__ import annotations

import json
import re
from base64 import b64encode
from collections.abc import Iterator
from dataclasses import asdict
from hashlib import sha256
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from svgpathtools import parse_path

import glyphspline as gs
from glyphspline.report.data import glyph_measures, glyph_text, inside
from glyphspline.report.gallery import write_index, write_report
from glyphspline.writers.svg.document import polygon_data, source_data
from tests.drawings import METRICS, circle

HOSTILE = "\"'></script><script>alert(1)</script><!--<img src=x onerror=alert(1)>\u2028"
CONTOUR = {"vertices": 6, "iterations": 7, "converged": True, "deviation": 0.5, "within_tolerance": True}
RUN = {"font": {"family": "Tests", "style": "Regular", "metrics": {"units_per_em": 1000.0}}, "curvature_scale": 0.004}


def entry(gid: int, name: str = "", **changes: Any) -> dict[str, Any]:
    return {
        "glyph": name or f"glyph{gid}", "gid": gid, "unicodes": ["U+0041"], "advance": 600, "status": "ok",
        "files": {}, "contours": [CONTOUR], "error": None,
    } | changes  # fmt: skip


def data(path: Path) -> Any:
    found = re.fullmatch(r"glyphsplineData\((.*)\);\n", path.read_text(encoding="ascii"), re.DOTALL)
    assert found, "a data file is one call, in ASCII"
    return json.loads(found[1])


def tables(folder: Path) -> list[Any]:
    return [data(path) for path in sorted((folder / "gallery").glob("table-*.js"))]


def test_a_glyphs_file_has_its_drawing(tmp_path: Path) -> None:
    outline = gs.Outline("odd #%?name", 3, (65,), 600.0, (gs.Contour.from_segments(circle(200.0, 8)),), METRICS)
    result = gs.convert(outline, gs.Options(count=12))
    source, polygon, control = (part.text for part in (*source_data([result]), *polygon_data([result])[0]))
    drawing: dict[str, Any] = {"source": source, "result": "M0 0Z", "polygon": polygon, "control": control}
    files = {"svg": "svg/odd #%?name.svg", "gallery": "gallery/odd.glyph.js"}
    (tmp_path / "a.js").write_bytes(glyph_text(drawing, files, [{"vertices": 12, "deviation": None}]))
    glyph = data(tmp_path / "a.js")
    assert len(parse_path(glyph["source"])) == 8
    assert glyph["result"] == "M0 0Z"
    for kind, points in [("polygon", result.contours[0].polygon),
                         ("control", result.contours[0].interpolations[0].spline.control_points)]:  # fmt: skip
        found = np.array([[segment.start.real, -segment.start.imag] for segment in parse_path(glyph[kind])])
        np.testing.assert_allclose(found, points, atol=0.051)
    assert glyph["files"] == {"svg": files["svg"]}
    assert glyph["contours"] == [{"vertices": 12}]


def test_measures_of_contours_are_taken_together() -> None:
    worse = CONTOUR | {"iterations": 9, "deviation": 2.0, "within_tolerance": False, "area_change": -3.0}
    found = glyph_measures([CONTOUR | {"area_change": 1.0}, worse])
    assert (found["vertices"], found["iterations"], found["deviation"]) == (12, 9, 2.0)
    assert found["converged"] is True
    assert found["within_tolerance"] is False
    assert found["area_change"] == -3.0
    assert glyph_measures([])["deviation"] is None


class Scripts(HTMLParser):
    def __init__(self, text: str) -> None:
        super().__init__()
        self.scripts: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.inside = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self.inside = tag == "script"

    def handle_data(self, data: str) -> None:
        if self.inside:
            self.scripts.append(data)
            self.inside = False


def test_hostile_text_stays_text(tmp_path: Path) -> None:
    files = {"gallery": "../../etc/passwd"}
    bad = entry(1, HOSTILE, unicodes=[HOSTILE], status="failed", error=HOSTILE + "\x00", files=files)
    write_report(tmp_path, [bad], RUN | {"font": RUN["font"] | {"family": HOSTILE}})  # type: ignore[operator]
    page = Scripts((tmp_path / "index.html").read_text(encoding="utf-8"))
    assert len(page.scripts) == 2, "the setup and the script"
    assert not [attrs for _, attrs in page.tags if any(name.startswith("on") for name in attrs)]
    for path in (tmp_path / "gallery").iterdir():
        assert "<" not in path.read_text(encoding="ascii")
    assert data(tmp_path / "gallery" / "run.js")["family"] == HOSTILE
    (row,) = (row for table in tables(tmp_path) for row in table["rows"])
    assert (row[0], row[2], row[5], row[6]) == (HOSTILE, HOSTILE, None, HOSTILE + "\x00")


@pytest.mark.parametrize("path", ["../a", "/a", "a/../../b", "a\\b", None, 3])
def test_a_link_out_of_the_folder_is_none(path: object) -> None:
    assert not inside(path)
    assert inside("svg/a.svg")


def test_only_the_pages_own_script_may_run(tmp_path: Path) -> None:
    write_report(tmp_path, [entry(1)], RUN)
    page = Scripts((tmp_path / "index.html").read_text(encoding="utf-8"))
    policy = next(
        str(attrs["content"]) for _, attrs in page.tags if attrs.get("http-equiv") == "Content-Security-Policy"
    )
    digest = b64encode(sha256(page.scripts[1].encode()).digest()).decode()
    assert f"'sha256-{digest}'" in policy
    assert "default-src 'none'" in policy
    assert "http" not in policy


def test_the_run_says_how_it_was_made(tmp_path: Path) -> None:
    options = asdict(gs.Options(corners="sharp", continuity="g2"))
    for given, words in (
        ({"options": options}, gs.Options(**options).words),
        ({}, ""),
        ({"options": {"corners": HOSTILE}}, ""),
        ({"options": options | {"of a later version": 1}}, ""),
        ({"options": 3}, ""),
    ):
        write_report(tmp_path, [entry(1)], RUN | given)
        assert data(tmp_path / "gallery" / "run.js")["words"] == words


@pytest.mark.parametrize("count", [0, 1, 40, 41, 5001])
def test_every_glyph_is_there_once_in_order(tmp_path: Path, count: int) -> None:
    write_report(tmp_path, (entry(gid) for gid in range(count)), RUN)
    gids = [row[table["columns"].index("gid")] for table in tables(tmp_path) for row in table["rows"]]
    assert gids == list(range(count))
    assert data(tmp_path / "gallery" / "run.js")["glyphs"] == count


def test_entries_are_streamed(tmp_path: Path) -> None:
    def entries() -> Iterator[dict[str, Any]]:
        for gid in range(12_000):
            yield entry(gid)
            assert gid <= 5000 * (1 + len(list((tmp_path / "gallery").glob("table-*.js")))), "more than a table ahead"

    write_report(tmp_path, entries(), RUN)
    assert len(tables(tmp_path)) == 3


def test_the_same_run_gives_the_same_bytes_and_a_smaller_one_leaves_no_old_files(tmp_path: Path) -> None:
    for folder, counts in (("a", [100, 50]), ("b", [50])):
        for count in counts:
            (tmp_path / folder).mkdir(exist_ok=True)
            write_report(tmp_path / folder, (entry(gid) for gid in range(count)), RUN)
    a, b = ({path.name: path.read_bytes() for path in (tmp_path / name).rglob("*") if path.is_file()} for name in "ab")
    assert a == b


def test_several_runs_share_an_index(tmp_path: Path) -> None:
    write_index(tmp_path, ["one", "two/face-1"], "2 fonts")
    page = Scripts((tmp_path / "index.html").read_text(encoding="utf-8"))
    assert json.loads(page.scripts[0])["runs"] == ["one", "two/face-1"]
