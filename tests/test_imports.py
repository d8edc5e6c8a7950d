"""The rooms of the package: imports run one way between them, no files import each other in a circle, opening is quick.

Rooms are the folders and the single files of the package's top level, and are read from the disk.
"""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from tests.places import ROOT

PACKAGE = ROOT / "glyphspline"

BASE = {"arrays", "code_files", "compiled", "errors", "extras", "fields", "files", "intrinsics", "types", "_version"}
CURVES = BASE | {"curves"}
FITTING = CURVES | {"interpolation", "outlines", "checks", "fitting"}
CHECKS = CURVES | {"outlines", "checks"}
WRITERS = FITTING | {"readers", "typesetting", "comparing", "writers"}
PLAN = {
    "_version": set(),
    "code_files": set(),
    "compiled": {"code_files", "compiling"},
    "compiling": {"code_files", "files", "llvm"},
    "llvm": {"intrinsics"},
    "arrays": {"compiled", "types"},
    "intrinsics": set(),
    "errors": set(),
    "extras": {"errors"},
    "files": {"errors"},
    "fields": {"errors"},
    "types": set(),
    "curves": BASE,
    "interpolation": CURVES,
    "outlines": CURVES,
    "matching": CURVES | {"outlines"},
    "checks": CHECKS,
    "comparing": CHECKS | {"comparing"},
    "mending": CHECKS | {"mending"},
    "fitting": FITTING,
    "readers": CURVES | {"outlines", "matching"},
    "typesetting": FITTING | {"readers"},
    "writers": WRITERS,
    "report": WRITERS | {"mending"},
    "runs": WRITERS | {"matching", "mending", "report"},
    "datasets": WRITERS | {"report", "runs"},
    "viewer": WRITERS | {"report"},
    "notebook": WRITERS,
    "cli": WRITERS | {"mending", "report", "runs", "datasets", "viewer"},
    "fontspector": WRITERS | {"runs", "cli"},
    "__main__": {"cli"},
}
"""What each room may import, besides itself. ``__init__`` stands outside: it gathers the public names."""

FONT_LIBRARIES = {"fontTools", "uharfbuzz", "svgpathtools", "pathops"}
DRAWING_LIBRARIES = {"matplotlib", "PIL"}
CORE = {"curves", "interpolation", "outlines", "matching", "fitting"}


def name_of(path: Path) -> str:
    """The module of a file, without the package's name."""
    return ".".join(path.relative_to(PACKAGE).with_suffix("").parts).removesuffix(".__init__")


MODULES = {name_of(path): path for path in sorted(PACKAGE.rglob("*.py")) if path != PACKAGE / "__init__.py"}


def room(module: str) -> str:
    return module.split(".")[0]


def imported(module: str) -> Iterator[str]:
    """Absolute names of all that a file imports, inside functions too; ``a.b.name`` where a name is imported."""
    path = MODULES[module]
    package = ["glyphspline", *module.split(".")]
    if path.name != "__init__.py":
        package = package[:-1]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            yield from (".".join([*base, *filter(None, [node.module]), alias.name]) for alias in node.names)


def modules_imported(module: str) -> set[str]:
    """The modules of the package that a file imports."""
    found = set()
    for name in imported(module):
        parts = name.removeprefix("glyphspline.").split(".") if name.startswith("glyphspline.") else []
        for stop in (len(parts), len(parts) - 1):
            if ".".join(parts[:stop]) in MODULES:
                found.add(".".join(parts[:stop]))
                break
    return found - {module}


def test_every_room_is_on_the_plan() -> None:
    assert {room(module) for module in MODULES} == PLAN.keys()


@pytest.mark.parametrize("module", MODULES)
def test_a_file_imports_only_what_its_room_may(module: str) -> None:
    allowed = PLAN[room(module)] | {room(module)}
    beyond = [other for other in modules_imported(module) if room(other) not in allowed]
    assert not beyond


def test_the_oracle_is_independent() -> None:
    """The kernels have to agree with ``interpolation.reference``, which uses none of them; they use none of it."""
    oracle = {"interpolation.reference", "interpolation.roots", "interpolation.intervals"}
    used = set().union(*(modules_imported(module) for module in oracle))
    assert [other for other in used if other.startswith(("interpolation.kernels", "interpolation.plain"))] == []
    users = {module for module in MODULES if oracle & modules_imported(module)} - oracle
    assert users == {"interpolation.api"}  # other degrees and diagnostics, which kernels do not have


def test_no_files_import_each_other_in_a_circle() -> None:
    graph = {module: modules_imported(module) for module in MODULES}
    try:
        list(TopologicalSorter(graph).static_order())
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


def test_a_circle_would_be_found() -> None:
    with pytest.raises(CycleError):
        list(TopologicalSorter({"a": {"b"}, "b": {"a"}}).static_order())


@pytest.mark.parametrize("module", [module for module in MODULES if room(module) in CORE])
def test_the_core_knows_no_fonts_and_draws_nothing(module: str) -> None:
    libraries = {name.split(".")[0] for name in imported(module)}
    if module != "outlines.overlaps":
        assert not libraries & (FONT_LIBRARIES | DRAWING_LIBRARIES)


def test_a_run_that_only_hands_out_work_imports_no_compiler() -> None:
    font = PACKAGE.parent / "fonts_test" / "kouzan-gyosho.ttf"
    code = (
        "import sys, glyphspline.cli.app, glyphspline.runs.jobs.check, glyphspline.runs.jobs.convert\n"
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
