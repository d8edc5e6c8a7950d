"""The rooms of the package: imports run one way between them, no files import each other in a circle, opening is quick.

Rooms are the folders and the single files of the package's top level, and are read from the disk.
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

from scripts.house import MODULES, NEEDS, PACKAGE, circle, forbidden, imported, modules_imported, plugin, room, tree

BASE = {"arrays", "code_files", "compiled", "errors", "extras", "fields", "files", "hooks", "intrinsics", "types"}
CURVES = BASE | {"curves"}
FITTING = CURVES | {"interpolation", "outlines", "fitting"}
WRITERS = FITTING | {"_version", "readers", "writers"}
PLAN = {
    "_version": set(),
    "code_files": set(),
    "compiled": {"code_files", "compiling"},
    "compiling": {"code_files", "files", "linking", "llvm"},
    "linking": set(),
    "llvm": {"intrinsics"},
    "arrays": {"compiled", "types"},
    "intrinsics": set(),
    "errors": set(),
    "extras": {"errors"},
    "files": {"errors"},
    "fields": {"errors"},
    "hooks": {"errors"},
    "types": set(),
    "curves": BASE,
    "interpolation": CURVES,
    "outlines": CURVES,
    "fitting": FITTING,
    "readers": CURVES | {"outlines"},
    "writers": WRITERS,
    "report": WRITERS,
    "runs": WRITERS | {"report"},
    "cli": WRITERS | {"report", "runs"},
    "plugins": set(),
    "__main__": {"cli"},
}
"""What each room of the pipeline may import, besides itself. ``__init__`` stands outside: it gathers the public names.
A plug-in imports the pipeline, and the plug-ins that it names."""

FONT_LIBRARIES = {"fontTools", "uharfbuzz", "svgpathtools", "pathops"}
DRAWING_LIBRARIES = {"matplotlib", "PIL"}
CORE = {"curves", "interpolation", "outlines", "fitting"}


def test_every_room_is_on_the_plan() -> None:
    assert {room(module) for module in MODULES} == PLAN.keys() | {f"plugins.{name}" for name in NEEDS}


@pytest.mark.parametrize("module", [module for module in MODULES if plugin(module) is None])
def test_a_file_imports_only_what_its_room_may(module: str) -> None:
    allowed = PLAN[room(module)] | {room(module)}
    beyond = [other for other in modules_imported(module) if room(other) not in allowed]
    assert not beyond


def test_the_pipeline_imports_no_plugin_and_a_plugin_those_it_names() -> None:
    assert forbidden() == []


@pytest.mark.parametrize(("name", "others"), NEEDS.items())
def test_a_plugin_says_which_others_it_needs(name: str, others: tuple[str, ...]) -> None:
    words = (ast.get_docstring(tree(f"plugins.{name}")) or "").partition(". In: ")[0]
    (said,) = re.findall(r"^Needs (.*)$", words, re.MULTILINE)
    assert said == (
        "no other plug-in" if not others else " and ".join([", ".join(others[:-1]), others[-1]]).lstrip(" and")
    )


def test_the_oracle_is_independent() -> None:
    """The kernels have to agree with ``interpolation.reference``, which uses none of them; they use none of it."""
    oracle = {"interpolation.reference", "interpolation.roots", "interpolation.intervals"}
    used = set().union(*(modules_imported(module) for module in oracle))
    assert [other for other in used if other.startswith(("interpolation.kernels", "interpolation.plain"))] == []
    users = {module for module in MODULES if oracle & modules_imported(module)} - oracle
    assert users == {"interpolation.api"}  # other degrees and diagnostics, which kernels do not have


def test_no_files_import_each_other_in_a_circle() -> None:
    assert circle() == []


def test_a_circle_would_be_found() -> None:
    assert circle({"a": frozenset("b"), "b": frozenset("a")}) != []


@pytest.mark.parametrize("module", [module for module in MODULES if room(module) in CORE])
def test_the_core_knows_no_fonts_and_draws_nothing(module: str) -> None:
    libraries = {name.split(".")[0] for name in imported(module)}
    if module != "outlines.overlaps":
        assert not libraries & (FONT_LIBRARIES | DRAWING_LIBRARIES)


def test_a_run_that_only_hands_out_work_imports_no_compiler() -> None:
    font = PACKAGE.parent / "fonts_test" / "kouzan-gyosho.ttf"
    code = (
        "import sys, glyphspline.cli.app, glyphspline.plugins.checks.job, glyphspline.runs.convert\n"
        f"glyphspline.open_source({str(font)!r}).select(text='龍')\n"
        "print(*sorted({name.split('.')[0] for name in sys.modules}))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not set(run.stdout.split()) & {"numba", "llvmlite", "scipy", "svgpathtools", "matplotlib"}


def test_importing_the_package_imports_no_heavy_library() -> None:
    code = "import sys, glyphspline; print(*sorted({name.split('.')[0] for name in sys.modules}))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(run.stdout.split())
    assert not loaded & {"matplotlib", "scipy", "svgpathtools", "fontTools", "distributed", "pyarrow"}


@pytest.mark.parametrize(
    ("arguments", "beyond"),
    [
        (["--help"], {"numpy", "fontTools", "uharfbuzz", "rich"}),
        (["convert", "--help"], {"numpy", "fontTools", "uharfbuzz", "rich"}),
        (["convert", "FONT", "--text", "O", "--format", "svg", "--out", "OUT"], set()),
        (["text", "FONT", "O", "--out", "OUT/text.svg"], set()),
    ],
)
def test_a_command_leaves_heavy_libraries_to_its_workers(
    arguments: list[str], beyond: set[str], tmp_path: Path
) -> None:
    font = PACKAGE.parent / "fonts_test" / "kouzan-gyosho.ttf"
    filled = [word.replace("FONT", str(font)).replace("OUT", str(tmp_path)) for word in arguments]
    code = (
        "import sys\nfrom glyphspline.cli.app import app\n"
        f"if __name__ == '__main__':\n    status = app({filled!r}, standalone_mode=False)\n"
        "    print('loaded', *sorted({name.split('.')[0] for name in sys.modules}))\n"
        "    sys.exit(status)"
    )
    script = tmp_path / "command.py"
    script.write_text(code, encoding="utf-8")
    run = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    loaded = set(run.stdout.splitlines()[-1].split())
    assert "loaded" in loaded
    assert not loaded & (
        {"numba", "llvmlite", "scipy", "matplotlib", "svgpathtools", "pyarrow", "distributed"} | beyond
    )


def test_fonts_are_opened_without_the_libraries_of_other_sources() -> None:
    font = PACKAGE.parent / "fonts_test" / "kouzan-gyosho.ttf"
    code = f"import sys, glyphspline\nglyphspline.open_source({str(font)!r})\nprint(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    others = {"fontTools.varLib", "fontTools.ufoLib", "fontTools.designspaceLib", "fontTools.ttLib.tables.otTables"}
    assert not set(run.stdout.split()) & others
