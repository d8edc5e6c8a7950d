"""What an extra is needed for says so before it does anything, where the extra is not installed."""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from glyphspline.extras import EXTRAS

ROOT = Path(__file__).parents[1]
FONT = str(ROOT / "fonts_test" / "kouzan-gyosho.ttf")

COMMANDS = {
    "overlaps": ["convert", FONT, "--text", "O", "--remove-overlaps"],
    "parquet": ["convert", FONT, "--text", "O", "--format", "svg,parquet"],
    "cad": ["convert", FONT, "--text", "O", "--format", "dxf"],
    "sources": ["convert", "made.glyphs", "--text", "O"],
    "cluster": ["convert", FONT, "--text", "O", "--scheduler", "tcp://127.0.0.1:1"],
    "remote": ["convert", "s3://fonts/made.ttf", "--text", "O"],
    "view": ["view", FONT, "--no-browser"],
}


def without(extra: str, words: list[str], place: Path) -> subprocess.CompletedProcess[str]:
    """A command where the modules of an extra cannot be imported, and where nothing is compiled yet."""
    missing = dict.fromkeys(EXTRAS[extra][1:])
    code = f"import sys; sys.modules.update({missing}); sys.argv[1:] = {words}; import glyphspline.cli as c; c.main()"
    environment = os.environ | {"NUMBA_CACHE_DIR": str(place)}
    return subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=60
    )


@pytest.mark.parametrize("extra", COMMANDS)
def test_a_missing_extra_is_said_at_once(extra: str, tmp_path: Path) -> None:
    glyphs = tmp_path / "made.glyphs"
    glyphs.write_text('{\n.appVersion = "3208";\n}\n')
    words = [str(glyphs) if word == "made.glyphs" else word for word in COMMANDS[extra]]
    out = [] if extra == "view" else ["--out", str(tmp_path / "out")]
    found = without(extra, [*words, *out], tmp_path / "cache")
    assert found.returncode == 2
    said = [line for line in found.stderr.splitlines() if not line.startswith("compiling once")]
    assert len(said) == 1, found.stderr
    assert said[0].endswith(f"pip install 'glyphspline[{extra}]'")
    assert not list(tmp_path.glob("out/**/*.svg"))


def test_the_names_are_those_of_the_project() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert set(EXTRAS) == {*COMMANDS, "fontspector"} <= set(project["optional-dependencies"])
