"""What an extra is needed for says so before it does anything, where the extra is not installed."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

from glyphspline.extras import EXTRAS
from tests.places import FONTS, ROOT

FONT = str(FONTS / "kouzan-gyosho.ttf")

COMMANDS = {
    "fonts": ["refit", FONT, "--text", "O", "--format", "otf"],
    "text": ["text", FONT, "O", "--width", "900", "--format", "svg"],
    "overlaps": ["convert", FONT, "--text", "O", "--remove-overlaps"],
    "parquet": ["convert", FONT, "--text", "O", "--format", "svg,parquet"],
    "drawings": ["convert", "styled.svg", "--all"],
    "cad": ["convert", FONT, "--text", "O", "--format", "dxf"],
    "sources": ["convert", "made.glyphs", "--text", "O"],
    "cluster": ["convert", FONT, "--text", "O", "--jobs", "tcp://127.0.0.1:1"],
    "remote": ["convert", "s3://fonts/made.ttf", "--text", "O"],
    "view": ["view", FONT, "--no-browser"],
}

RUN = """
import contextlib, io, json, sys
missing, commands = json.loads(sys.argv[1])
sys.modules.update(dict.fromkeys(missing))
from glyphspline.cli import main
found = {}
for extra, sys.argv[1:] in commands.items():
    status, said = None, io.StringIO()
    with contextlib.redirect_stderr(said):
        try:
            main()
        except SystemExit as exit:
            status = exit.code
    found[extra] = [status, said.getvalue()]
print(json.dumps(found))
"""
"""Runs commands where modules cannot be imported; prints the exit status and standard error of each."""


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("extras")


@pytest.fixture(scope="module")
def found(place: Path) -> Any:
    """The exit status and standard error of each command, where no extra is installed and nothing is compiled."""
    (place / "made.glyphs").write_text('{\n.appVersion = "3208";\n}\n')
    (place / "styled.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg"><style>.a{fill:none}</style><path d="M0 0H9V9Z"/></svg>'
    )
    commands = {
        extra: [*words, *([] if extra == "view" else ["--out", f"out-{extra}"])] for extra, words in COMMANDS.items()
    }
    missing = [module for _, *modules in EXTRAS.values() for module in modules]
    done = subprocess.run(
        [sys.executable, "-c", RUN, json.dumps([missing, commands])],
        cwd=place, env=os.environ | {"NUMBA_CACHE_DIR": str(place / "cache"), "PYTHONPATH": str(ROOT)},
        capture_output=True, text=True, timeout=600, check=True,
    )  # fmt: skip
    return json.loads(done.stdout)


@pytest.mark.parametrize("extra", COMMANDS)
def test_a_missing_extra_is_said_at_once(extra: str, found: Any, place: Path) -> None:
    status, text = found[extra]
    assert status == 2
    said = text.splitlines()
    assert len(said) == 1, text
    assert said[0].endswith(f"pip install 'glyphspline[{extra}]'")
    assert not list(place.glob(f"out-{extra}/**/*.svg"))


def test_the_names_are_those_of_the_project() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert set(EXTRAS) == {*COMMANDS, "fontspector"} <= set(project["optional-dependencies"])
