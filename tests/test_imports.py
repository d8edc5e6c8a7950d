"""Imports run one way, and the package opens quickly: no file of an earlier room knows a later one."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parent.parent / "glyphspline"

ROOMS = [
    {"arrays", "errors", "version"},
    {
        "bezier",
        "knots",
        "bspline",
        "polygon",
        "intervals",
        "core",
        "engine",
        "stepwise",
        "result",
        "reference",
        "interpolation",
        "arcs",
    },
    {"outline", "orientation", "sampling"},
    {
        "measure",
        "combing",
        "curvature",
        "distance",
        "crossings",
        "continuity",
        "joints",
        "arcfit",
        "cubicfit",
        "frugal",
        "flat",
        "chains",
        "pieces",
        "survey",
        "smooth",
    },
    {"glyph"},
    {"closed", "refine", "smooth_contours", "fit", "sharp", "contours", "sharp_contours", "overlaps", "convert"},
    {"readers", "writers"},
    {"report", "express", "display"},
    {"viewer"},
    {"batch"},
    {"cli", "__main__"},
]
"""From the curve core to the shell. ``__init__`` stands outside: it gathers the public names."""

FONT_LIBRARIES = {"fontTools", "uharfbuzz", "svgpathtools", "pathops"}
DRAWING_LIBRARIES = {"matplotlib", "PIL"}


def room(module: str) -> int:
    first = module.split(".")[0]
    return next(rank for rank, names in enumerate(ROOMS) if first in names)


def modules() -> list[tuple[str, Path]]:
    paths = [p for p in sorted(PACKAGE.rglob("*.py")) if p != PACKAGE / "__init__.py"]
    return [(".".join(p.relative_to(PACKAGE).with_suffix("").parts).removesuffix(".__init__"), p) for p in paths]


def imports(module: str, path: Path) -> list[str]:
    """Absolute names of all that a file imports, those inside functions included."""
    package = ["glyphspline", *module.split(".")]
    if path.name != "__init__.py":
        package = package[:-1]
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            name = ".".join([*base, *([node.module] if node.module else [])])
            found += [f"{name}.{alias.name}" for alias in node.names] if not node.module else [name]
    return found


@pytest.mark.parametrize(("module", "path"), modules(), ids=[name for name, _ in modules()])
def test_no_file_imports_from_a_later_room(module: str, path: Path) -> None:
    here = room(module)
    for name in imports(module, path):
        if name.startswith("glyphspline.") and name != "glyphspline.version":
            assert room(name.removeprefix("glyphspline.")) <= here, f"{module} imports {name}"


@pytest.mark.parametrize(("module", "path"), modules(), ids=[name for name, _ in modules()])
def test_the_core_knows_no_fonts_and_draws_nothing(module: str, path: Path) -> None:
    libraries = {name.split(".")[0] for name in imports(module, path)}
    if room(module) < room("readers") and module != "overlaps":
        assert not libraries & (FONT_LIBRARIES | DRAWING_LIBRARIES)


def test_a_run_that_only_hands_out_work_imports_no_compiler() -> None:
    font = PACKAGE.parent / "fonts_test" / "kouzan-gyosho.ttf"
    code = (
        "import sys, glyphspline.cli.commands, glyphspline.batch.run, glyphspline.batch.schedule\n"
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
