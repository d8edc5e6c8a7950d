"""The plug-in of fontspector, called as fontspector calls it, and its answers in the shapes that fontspector reads."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from glyphspline.cli.app import app
from glyphspline.extras import has
from glyphspline.plugins.checks.fontspector import CHECK, LISTED, PROFILE, SOURCES
from tests.places import ROOT

FONT = ROOT / "fonts_test" / "kouzan-gyosho.otf"
CALL = "import sys; from glyphspline.plugins.checks.fontspector import main; sys.exit(main())"
SEVERITIES = {"SKIP", "INFO", "PASS", "WARN", "FAIL", "FATAL", "ERROR"}

needs_api = pytest.mark.skipif(not has("fontspector"), reason="fontspectorapi is not installed")


def called(*arguments: str | Path, place: Path = ROOT, code: str = CALL) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.run(command, cwd=place, env=environment, capture_output=True, text=True, check=False)


def checked(font: Path, place: Path, check: str = CHECK) -> dict[str, Any]:
    run = called("--check", check, font, place=place)
    assert run.returncode == 0, run.stderr
    result: dict[str, Any] = json.loads(run.stdout)  # nothing else may be on standard output
    assert {"check_id", "check_name", "check_rationale", "filename", "subresults"} <= result.keys()
    assert (result["check_id"], result["filename"]) == (check, str(font))
    assert (result["hotfix_available"], result["sourcefix_available"]) == (False, False)
    for status in result["subresults"]:
        assert status["severity"] in SEVERITIES
        assert status.keys() <= {"severity", "code", "message", "metadata"}
        assert all(isinstance(status.get(key, ""), str) for key in ("code", "message"))
    return result


@needs_api
@pytest.mark.parametrize("words", [["--metadata"], ["metadata"]])
def test_it_tells_of_a_profile_and_its_check(words: list[str], tmp_path: Path) -> None:
    run = called(*words, place=tmp_path)
    assert run.returncode == 0, run.stderr
    data = json.loads(run.stdout)
    assert (data["api_version"], data["plugin_name"]) == (1, "glyphspline")
    names = [CHECK, *(f"{CHECK}/{kind}" for kind in ("ufo", "designspace", "glyphs"))]
    assert data["profiles"][PROFILE]["sections"] == {"Outlines": names}
    assert data["filetypes"] == SOURCES
    for check, name, kind in zip(data["checks"], names, ("TTF", *SOURCES), strict=True):
        assert check.keys() == {
            "id", "title", "rationale", "proposal", "applies_to", "runs_on_collection", "metadata", "hotfix_available",
            "sourcefix_available",
        }  # fmt: skip
        assert (check["id"], check["applies_to"], check["runs_on_collection"]) == (name, kind, False)


@needs_api
def test_its_report_has_what_the_command_finds(tmp_path: Path) -> None:
    result = checked(FONT, tmp_path)
    command = CliRunner().invoke(app, ["check", str(FONT), "--json", "-j", "0"])
    findings = json.loads(command.stdout)["fonts"][0]["findings"]
    reported = []
    for status in result["subresults"]:
        for item in status["metadata"]:
            ((name, problem),) = item.items()
            assert name == "GlyphProblem"
            assert problem.keys() <= {
                "glyph_name", "glyph_id", "userspace_location", "position", "actual", "expected", "message",
            }  # fmt: skip
            actual = problem["actual"]
            place = problem["glyph_name"], problem["glyph_id"], actual["contour"], actual["segment"]
            what = status["severity"], status["code"], actual["value"], problem["message"]
            reported.append((*place, *problem["position"], *what))
    assert reported == [
        (
            f["glyph"],
            f["gid"],
            f["contour"],
            f["segment"],
            *f["point"],
            f["level"],
            f["kind"],
            f["value"],
            f["sentence"],
        )
        for f in findings
    ]
    assert len(reported) > 100
    kinks = result["subresults"][0]
    assert (result["worst_status"], kinks["code"]) == ("WARN", "kink")
    assert kinks["message"].count("\n* ") == LISTED + 1
    assert kinks["message"].endswith(f"* and {len(kinks['metadata']) - LISTED} more")


@needs_api
def test_sources_have_checks_of_their_own(tmp_path: Path) -> None:
    ufoLib2 = pytest.importorskip("ufoLib2")
    from fontTools.designspaceLib import DesignSpaceDocument

    document = DesignSpaceDocument()
    document.addAxisDescriptor(tag="wght", name="Weight", minimum=400, default=400, maximum=700)
    for weight, height in ((400, 300), (700, 340)):
        font = ufoLib2.Font()
        font.info.familyName, font.info.styleName, font.info.unitsPerEm = "Mine", str(weight), 1000
        pen = font.newGlyph("n").getPen()
        pen.moveTo((0, 0))
        for point in ((0, height), (400, height), (400, 1)):  # the lower line is slanted
            pen.lineTo(point)
        pen.closePath()
        font.save(tmp_path / f"{weight}.ufo")
        document.addSourceDescriptor(path=str(tmp_path / f"{weight}.ufo"), location={"Weight": weight})
    document.write(tmp_path / "Mine.designspace")
    for file, kind in (("400.ufo/metainfo.plist", "ufo"), ("Mine.designspace", "designspace")):
        result = checked(tmp_path / file, tmp_path, f"{CHECK}/{kind}")
        assert "slanted" in [status["code"] for status in result["subresults"]]


@needs_api
def test_settings_of_the_project_hold_and_a_font_without_findings_passes(tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_text('[tool.glyphspline.check]\nkinds = ["kink"]\nkink = 11\n')
    few = checked(FONT, tmp_path)
    assert [status["code"] for status in few["subresults"]] == ["kink"]
    assert all(item["GlyphProblem"]["actual"]["value"] >= 11 for item in few["subresults"][0]["metadata"])
    (tmp_path / "pyproject.toml").write_text('[tool.glyphspline.check]\nkinds = ["kink"]\nkink = 11.99\n')
    none = checked(FONT, tmp_path)
    assert (none["subresults"], none["worst_status"]) == ([{"severity": "PASS"}], "PASS")


@needs_api
def test_what_cannot_be_read_is_an_error_of_the_report(tmp_path: Path) -> None:
    (tmp_path / "broken.ttf").write_bytes(b"nothing")
    (status,) = checked(tmp_path / "broken.ttf", tmp_path)["subresults"]
    assert status["severity"] == "ERROR"
    assert "broken.ttf: not a TTF" in status["message"]


@needs_api
@pytest.mark.parametrize("arguments", [["--metadata"], ["--check", CHECK, str(FONT)]], ids=["short", "long"])
def test_a_reader_that_goes_away_is_no_error(arguments: list[str], tmp_path: Path) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    run = subprocess.run(
        [sys.executable, "-c", CALL, *arguments], cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=writing, stderr=subprocess.PIPE, text=True, check=False,
    )  # fmt: skip
    os.close(writing)
    assert (run.returncode, run.stderr) == (1, "")


def test_without_the_extra_it_says_what_to_install(tmp_path: Path) -> None:
    code = "import sys; sys.modules['fontspectorapi'] = None; " + CALL
    run = called("--metadata", place=tmp_path, code=code)
    assert (run.returncode, run.stdout) == (2, "")
    assert run.stderr.endswith("pip install 'glyphspline[fontspector]'\n")
