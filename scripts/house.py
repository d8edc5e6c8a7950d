"""The house in numbers: lines, files and compiled functions of each room, and the imports between rooms.

``python -m scripts.house`` prints a table of rooms, those of the pipeline first, then the plug-ins; the numbers of
edges between files of different rooms; and what breaks the rules: imports of plug-ins that may not be, and circles of
files. The exit status is 1 if anything does. Long files come last.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "glyphspline"

NEEDS = {
    "cad": (), "checks": (), "comparing": (), "datasets": (), "drawings": (), "experiments": (), "fonts": (),
    "text": (), "viewer": (),
    "masters": ("checks", "fonts"), "mending": ("checks", "fonts", "masters"),
}  # fmt: skip
"""The plug-ins, and which others each may import."""

LONGEST = 300
"""Lines of a file that tells one story."""


def name_of(path: Path) -> str:
    """The module of a file, without the package's name."""
    return ".".join(path.relative_to(PACKAGE).with_suffix("").parts).removesuffix(".__init__")


MODULES = {name_of(path): path for path in sorted(PACKAGE.rglob("*.py")) if path != PACKAGE / "__init__.py"}
"""The files of the package by module."""


def room(module: str) -> str:
    """The folder or file of the package's top level that a module is in; of a plug-in, its own."""
    parts = module.split(".")
    return ".".join(parts[:2]) if parts[0] == "plugins" else parts[0]


def plugin(module: str) -> str | None:
    """The plug-in that a module is of; None: of the pipeline."""
    parts = module.split(".")
    return parts[1] if parts[0] == "plugins" and len(parts) > 1 else None


@cache
def tree(module: str) -> ast.Module:
    """The syntax tree of a module."""
    return ast.parse(MODULES[module].read_text(encoding="utf-8"))


def imported(module: str) -> Iterator[str]:
    """Absolute names of all that a file imports, inside functions too; ``a.b.name`` where a name is imported."""
    package = ["glyphspline", *module.split(".")]
    if MODULES[module].name != "__init__.py":
        package = package[:-1]
    for node in ast.walk(tree(module)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            yield from (".".join([*base, *filter(None, [node.module]), alias.name]) for alias in node.names)


@cache
def modules_imported(module: str) -> frozenset[str]:
    """The modules of the package that a file imports."""
    found = set()
    for name in imported(module):
        parts = name.removeprefix("glyphspline.").split(".") if name.startswith("glyphspline.") else []
        for stop in (len(parts), len(parts) - 1):
            if ".".join(parts[:stop]) in MODULES:
                found.add(".".join(parts[:stop]))
                break
    return frozenset(found - {module})


def forbidden() -> list[tuple[str, str]]:
    """Imports of plug-ins by the pipeline, and by plug-ins that do not name them."""
    found = []
    for module in MODULES:
        own = plugin(module)
        for other in modules_imported(module):
            of = plugin(other)
            if of is not None and of != own and of not in NEEDS.get(own or "", ()):
                found.append((module, other))
    return sorted(found)


def circle(graph: Mapping[str, frozenset[str]] | None = None) -> list[str]:
    """Files that import each other in a circle; none if there is no such circle."""
    try:
        list(TopologicalSorter(graph or {module: modules_imported(module) for module in MODULES}).static_order())
    except CycleError as error:
        return list(error.args[1])
    return []


def compiled_functions(module: str) -> int:
    """The number of functions of a file that are compiled, or inlined in such."""
    marks = {"compiled", "inlined", "callback"}
    functions = (node for node in ast.walk(tree(module)) if isinstance(node, ast.FunctionDef))
    return sum(
        any(
            getattr(mark, "id", getattr(getattr(mark, "func", None), "id", "")) in marks for mark in node.decorator_list
        )
        for node in functions
    )


def lines(module: str) -> int:
    """The number of lines of a file."""
    return len(MODULES[module].read_text(encoding="utf-8").splitlines())


def main() -> int:
    """The command."""
    rooms = dict.fromkeys(sorted(map(room, MODULES), key=lambda name: (name.startswith("plugins"), name)))
    print(f"{'room':22}{'files':>6}{'lines':>8}{'compiled':>10}")
    sums = {"pipeline": [0, 0, 0], "all": [0, 0, 0]}
    for name in rooms:
        own = [module for module in MODULES if room(module) == name]
        counts = [len(own), sum(map(lines, own)), sum(map(compiled_functions, own))]
        print(f"{name:22}{counts[0]:6}{counts[1]:8,}{counts[2]:10}")
        for which in ("all", *(["pipeline"] if not name.startswith("plugins.") else [])):
            sums[which] = [a + b for a, b in zip(sums[which], counts, strict=True)]
    for which, counts in sums.items():
        print(f"{which:22}{counts[0]:6}{counts[1]:8,}{counts[2]:10}")
    edges = [(room(a), room(b)) for a in MODULES for b in modules_imported(a) if room(a) != room(b)]
    print(f"{len(edges)} imports between rooms, {len(set(edges))} pairs of rooms")
    wrong = [f"{a} imports {b}" for a, b in forbidden()]
    wrong += [f"circle: {' -> '.join(found)}"] if (found := circle()) else []
    for line in wrong:
        print(line)
    for module in sorted(MODULES, key=lines, reverse=True):
        if lines(module) > LONGEST:
            print(f"{module} has {lines(module)} lines")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
