"""Plug-ins: each can be taken away with its folder, and the rest works; one of a stranger works as ours do."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from glyphspline import hooks
from glyphspline.cli.app import OWN
from glyphspline.code_files import PLACE, own_folder
from scripts.house import NEEDS, PACKAGE
from tests.places import FONTS, ROOT

FONT = FONTS / "kouzan-gyosho.ttf"

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
ENTRIES = PROJECT["entry-points"][hooks.GROUP]

EVERYTHING = """
import importlib, pkgutil, sys, glyphspline
for module in pkgutil.walk_packages(glyphspline.__path__, "glyphspline."):
    if "__main__" not in module.name and not module.name.startswith(tuple(sys.argv[1:])):
        importlib.import_module(module.name)
print(*glyphspline.hooks.away())
"""
"""Imports all modules but those that begin so, and prints which plug-ins are away."""


def metadata(folder: Path, name: str, entries: dict[str, str]) -> None:
    """What an installed package says of itself."""
    facts = folder / f"{name.replace('-', '_')}-1.0.dist-info"
    facts.mkdir()
    (facts / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    words = "".join([f"{key} = {place}\n" for key, place in entries.items()])
    (facts / "entry_points.txt").write_text(f"[{hooks.GROUP}]\n{words}")


def without(folder: Path, *names: str) -> dict[str, str]:
    """The environment of processes for which the package lies in a folder without some of its plug-ins."""
    copy = folder / "glyphspline"
    (copy / "plugins").mkdir(parents=True)
    for path in PACKAGE.iterdir():
        if path.name not in ("plugins", "__pycache__"):
            (copy / path.name).symlink_to(path)
    for path in (PACKAGE / "plugins").iterdir():
        if path.name not in (*names, "__pycache__"):
            (copy / "plugins" / path.name).symlink_to(path)
    metadata(folder, "glyphspline", ENTRIES)
    return {**os.environ, "PYTHONPATH": str(folder), PLACE: str(own_folder())}  # compiled code fits the copy, too


def run(environment: dict[str, str], *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run Python where no package lies, so that the environment's is imported."""
    where = environment["PYTHONPATH"].rpartition(os.pathsep)[2]
    return subprocess.run(
        [sys.executable, *arguments], env=environment, cwd=where, capture_output=True, text=True, check=False
    )


def test_each_folder_is_an_entry_point() -> None:
    folders = {path.parent.name for path in (PACKAGE / "plugins").glob("*/__init__.py")}
    assert folders == ENTRIES.keys() == NEEDS.keys()
    assert {ENTRIES[name] for name in folders} == {f"glyphspline.plugins.{name}:PLUGIN" for name in folders}


def test_what_plugins_add_is_there_and_the_help_says_what_the_commands_do() -> None:
    for hook in ("commands", "formats", "whole", "readers", "services", "work", "names"):
        assert all(found is not None for found in hooks.every(hook))
    assert {*hooks.names("services")} == hooks.SERVICES.keys()
    listed = {name: one for plugin in hooks.plugins().values() for name, one in plugin.commands.items()}
    for name, one in listed.items():
        assert " ".join((hooks.find("commands", name).__doc__ or "").split()).startswith(one.help)
    assert not OWN.keys() & listed.keys()


@pytest.mark.parametrize("name", NEEDS)
def test_a_plugin_can_be_taken_away(name: str, tmp_path: Path) -> None:
    users = {other for other, needs in NEEDS.items() if name in needs}
    environment = without(tmp_path, name)
    done = run(environment, "-c", EVERYTHING, *(f"glyphspline.plugins.{user}." for user in users))
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [name]
    helped = run(environment, "-m", "glyphspline", "--help")
    gone = hooks.plugins()[name].commands
    assert helped.returncode == 0
    assert "convert" in helped.stdout
    assert not [command for command in gone if re.search(rf"^  {command} ", helped.stdout, re.MULTILINE)]
    for command in gone:
        refused = run(environment, "-m", "glyphspline", command, str(FONT))
        assert refused.returncode == 2
        assert f"plug-ins that are not there: {name}" in refused.stderr
    out = tmp_path / "out"
    call = ("convert", str(FONT), "--text", "O", "--step", "80", "--out", str(out), "--jobs", "0")
    done = run(environment, "-m", "glyphspline", *call)
    assert done.returncode == 0, done.stderr
    assert (out / "svg" / "O.svg").read_text().startswith("<svg ")


def test_public_names_of_what_is_away_say_so(tmp_path: Path) -> None:
    environment = without(tmp_path, "checks")
    done = run(environment, "-c", "import glyphspline as gs; gs.check")
    assert "AttributeError: glyphspline.check needs a plug-in that is not there" in done.stderr


def test_all_plugins_can_be_taken_away(tmp_path: Path) -> None:
    environment = without(tmp_path, *NEEDS)
    done = run(environment, "-c", EVERYTHING)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == sorted(NEEDS)
    out = tmp_path / "out"
    done = run(environment, "-m", "glyphspline", "convert", str(FONT), "--text", "O", "--out", str(out), "--jobs", "0")
    assert done.returncode == 0, done.stderr
    refused = run(
        environment, "-m", "glyphspline", "convert", str(FONT), "--text", "O", "--out", str(out), "--format", "dxf"
    )
    assert refused.returncode == 2
    assert "no format dxf" in refused.stderr


OF_THE_PIPELINE = (
    "curves", "interpolation", "fitting", "report", "outlines/test_sampling.py", "outlines/test_regions.py",
    "readers/test_fonts.py", "readers/test_routes.py", "readers/test_selection.py", "readers/test_broken_fonts.py",
    "readers/test_ufo.py", "writers/test_svg.py", "writers/test_drawings.py", "writers/test_curvature_map.py",
    "runs/test_engine.py", "runs/test_pool.py", "runs/test_choice.py", "runs/test_run_files.py",
)  # fmt: skip
"""Tests that call no plug-in."""


@pytest.mark.long
def test_the_pipelines_tests_pass_without_any_plugin(tmp_path: Path) -> None:
    environment = without(tmp_path, *NEEDS)
    for name in ("tests", "scripts", "fonts_test", "docs", "pyproject.toml", "README.md"):
        (tmp_path / name).symlink_to(ROOT / name)
    chosen = [f"tests/{name}" for name in OF_THE_PIPELINE]
    options = ["-q", "-p", "no:cacheprovider", "-m", "not long and not needs", "--rootdir", str(tmp_path)]
    options += ["--deselect", "tests/runs/test_pool.py::test_workers_with_other_code_are_an_error"]  # of links
    options += ["--deselect", "tests/runs/test_run_files.py::test_a_drawing_that_came_out_empty_says_why"]
    options += ["--deselect", "tests/fitting/test_traces.py::test_a_noisy_circle_is_a_circle[g2]"]
    done = run(environment, "-m", "pytest", *options, *chosen)
    assert done.returncode == 0, done.stdout[-3000:]


@pytest.fixture(scope="module")
def stranger(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The environment of processes for which the example of the documents is installed."""
    example = ROOT / "docs" / "examples" / "counting"
    folder = tmp_path_factory.mktemp("site")
    (folder / "counting.py").symlink_to(example / "counting.py")
    project = tomllib.loads((example / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    metadata(folder, project["name"], project["entry-points"][hooks.GROUP])
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(folder)])}


def test_a_strangers_plugin_adds_a_command_a_format_and_a_name(stranger: dict[str, str], tmp_path: Path) -> None:
    assert "  count " in run(stranger, "-m", "glyphspline", "--help").stdout
    done = run(stranger, "-m", "glyphspline", "count", str(FONT), "--text", "gO")
    assert re.fullmatch(r"g 4 \d+\nO 2 47\n", done.stdout), done.stderr
    call = ("convert", str(FONT), "--text", "O", "--count", "12", "--format", "svg,count", "--out", str(tmp_path))
    done = run(stranger, "-m", "glyphspline", *call, "--jobs", "0")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "count" / "O.count.txt").read_text() == "O 2 24\n"
    done = run(stranger, "-c", f"import glyphspline as gs; print(gs.count(gs.open_font({str(FONT)!r}).outline('O')))")
    assert done.stdout == "(2, 47)\n"


@pytest.mark.parametrize("code", ["raise RuntimeError('no')", "import nothing_of_this_name", "PLUGIN = 7"])
def test_a_broken_plugin_is_named(code: str, tmp_path: Path) -> None:
    (tmp_path / "faulty.py").write_text(code)
    metadata(tmp_path, "faulty", {"faulty": "faulty:PLUGIN"})
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(tmp_path)])}
    done = run(environment, "-m", "glyphspline", "--help")
    assert done.returncode == 0
    assert "  check " in done.stdout
    assert "the plug-in 'faulty' of faulty cannot be loaded: " in done.stderr
    fine = run(environment, "-m", "glyphspline", "info", str(FONT))
    assert fine.returncode == 0, fine.stderr
