"""The fonts in fonts_test/ are what the script makes, each time the same."""

from __future__ import annotations

import subprocess
import sys
from io import StringIO
from pathlib import Path

import pytest
from fontTools.ttLib import TTFont

from tests.places import ROOT

DRAWN = ["variable.ttf", "variable-cff2.otf", "edge-cases.ttf"]


def make(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, ROOT / "scripts/make_test_fonts.py", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def content(path: Path) -> str:
    """All tables as text. Bytes may be packed otherwise by another version of fontTools."""
    text = StringIO()
    TTFont(path).saveXML(text, writeVersion=False)
    return "\n".join(line for line in text.getvalue().splitlines() if "checkSumAdjustment" not in line)


def test_drawn_fonts_are_made_anew_to_the_same_bytes(tmp_path: Path) -> None:
    for folder in ("one", "other"):
        assert make("--drawn-only", "--out", tmp_path / folder).returncode == 0
        assert sorted(path.name for path in (tmp_path / folder).iterdir()) == sorted(DRAWN)
    for file in DRAWN:
        assert (tmp_path / "one" / file).read_bytes() == (tmp_path / "other" / file).read_bytes()
        assert content(tmp_path / "one" / file) == content(ROOT / "fonts_test" / file)


def test_without_the_package_the_script_says_how_to_get_it(tmp_path: Path) -> None:
    done = make("--kouzan", tmp_path, "--out", tmp_path / "out")
    assert done.returncode == 2
    assert "--help" in done.stderr
    assert not (tmp_path / "out").exists()
    assert "apt-get download fonts-kouzan-mouhitsu" in make("--help").stdout


@pytest.mark.parametrize("file", ["kouzan-gyosho.ttf", "kouzan-kaisho.ttf", "kouzan-gyosho.otf", "kouzan-gyosho.woff2"])
def test_brush_fonts_hold_the_promised_characters_and_names_of_their_own(file: str) -> None:
    font = TTFont(ROOT / "fonts_test" / file)
    assert set(font.getBestCmap()) == set(map(ord, "龍好善永あいうのをAaBOg&8 "))
    assert font["name"].getBestFamilyName().endswith("Subset")


def test_the_folder_is_small_and_its_readme_lists_every_font() -> None:
    files = [path for path in (ROOT / "fonts_test").iterdir() if path.suffix != ".md"]
    readme = (ROOT / "fonts_test/README.md").read_text(encoding="utf-8")
    assert sum(path.stat().st_size for path in files) < 1_500_000
    assert all(f"| `{path.name}` |" in readme for path in files)
