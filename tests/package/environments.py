"""Builds the wheel and the sdist from the files of the repository, installs them where nothing else is, and tries them.

Without options: the wheel, made from the sdist, on this Python without extras, and then with all in the same
environment. ``--all``: on every Python from 3.11 to 3.14 that is found on the PATH or among those of pyenv, without
extras, with each, and with all, each in an environment of its own; and the sdist.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
VERSIONS = tuple(f"3.{minor}" for minor in (11, 12, 13, 14))
EXTRAS = ("overlaps", "parquet", "cad", "sources", "cluster", "remote", "fontspector", "view", "notebook")
INSTALL = ("-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-compile")
UNSET = ("PYTHONPATH", "NUMBA_CACHE_DIR", "PYTHONDONTWRITEBYTECODE", "GLYPHSPLINE_COMPILED")


LOOK = """
import importlib, pkgutil, sys
from importlib.resources import files
import glyphspline as gs
from glyphspline.extras import EXTRAS, has
assert sys.prefix in gs.__file__, gs.__file__
extras = set(sys.argv[1:])
assert {extra for extra in EXTRAS if has(extra)} >= extras & set(EXTRAS)
if extras & {"view", "all"}:
    import glyphspline.plugins.viewer.app
pages = {
    "report": ("gallery.html", "gallery.js", "theme.css", "shapes.js", "page.html", "page.js", "places.js"),
    "plugins.checks": ("findings.html", "findings.css", "findings.js"),
    "plugins.comparing": ("comparison.html", "comparison.css"),
    "plugins.mending": ("mending.html", "mending.css", "mending.js"),
    "plugins.viewer": ("viewer.html", "viewer.css", "viewer.js"),
    "plugins.cad": ("polyline.schema.json",),
}
for folder, names in pages.items():
    for name in names:
        assert files(f"glyphspline.{folder}").joinpath(name).read_bytes(), name
assert files("glyphspline").joinpath("py.typed").is_file()
"""


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--all", action="store_true", help="every Python and every extra")
    everything = parser.parse_args().all
    with tempfile.TemporaryDirectory(prefix="glyphspline-") as folder:
        place = Path(folder)
        wheel, sdist = build(place)
        pythons = found_pythons() if everything else {f"3.{sys.version_info.minor}": sys.executable}
        print("Python", ", ".join(pythons), flush=True)
        for version, python in pythons.items():
            for extras in [[""], *([extra] for extra in EXTRAS), ["all"]] if everything else [["", "all"]]:
                install(place / f"{version}-{extras[-1]}", python, wheel, extras)
        if everything:
            install(place / "sdist", sys.executable, sdist, [""])


def build(place: Path) -> tuple[Path, Path]:
    """Build from a copy of the files that git knows; returns the wheel, made from the sdist, and the sdist."""
    tree = copy_tree(place / "tree")
    run(sys.executable, "-m", "venv", place / "builder")
    python = interpreter(place / "builder")
    run(python, *INSTALL, "build")
    run(python, "-m", "build", "--outdir", place / "dist", tree)
    (wheel,), (sdist,) = (place / "dist").glob("*.whl"), (place / "dist").glob("*.tar.gz")
    return wheel, sdist


def copy_tree(tree: Path) -> Path:
    """Copy the files that git knows."""
    names = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for name in filter(None, names.split("\0")):
        if (ROOT / name).is_file():
            (tree / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, tree / name)
    return tree


def install(place: Path, python: str, package: Path, extras: list[str]) -> None:
    """Install a package into a new environment and try it, with one extra after the other; "" is none."""
    run(python, "-m", "venv", place)
    for extra in extras:
        began = time.monotonic()
        wanted = f"{package}[{extra}]" if extra else package
        run(interpreter(place), *INSTALL, wanted)
        look(place, extra, converts=package.suffix == ".whl" and not extra)
        print(f"{place.name}[{extra}] from {package.name}: good, {time.monotonic() - began:.0f} s", flush=True)
    shutil.rmtree(place)


def look(place: Path, extra: str, converts: bool) -> None:
    """Try what is installed with an extra; if ``converts``, convert a glyph too."""
    own = interpreter(place)
    names = list(EXTRAS) if extra == "all" else [extra]
    run(own, "-c", LOOK, *filter(None, [extra, *names]), cwd=place)
    command = own.with_name("glyphspline")
    run(command, "--version", cwd=place)
    run(command, "info", ROOT / "fonts_test" / "variable.ttf", cwd=place)
    if converts:
        font = ROOT / "fonts_test" / "kouzan-gyosho.ttf"
        options = ["--text", "O", "--step", "90", "--format", "svg,gallery", "--jobs", "1"]
        run(command, "convert", font, *options, "--out", "out", cwd=place)
        assert (place / "out" / "index.html").is_file()
        assert list((place / "out" / "svg").glob("*.svg"))


def found_pythons() -> dict[str, str]:
    """By version, an interpreter that can make environments."""
    found = {}
    for version in VERSIONS:
        for python in candidates(version):
            works = subprocess.run([python, "-c", "import ensurepip, sys; print(sys.version)"], capture_output=True)
            if works.returncode == 0 and works.stdout.decode().startswith(f"{version}."):
                found[version] = python
                break
    return found


def candidates(version: str) -> Iterator[str]:
    """Interpreters of a version: on the PATH, then those that pyenv has installed."""
    if on_path := shutil.which(f"python{version}"):
        yield on_path
    root = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    yield from map(str, sorted(root.glob(f"versions/{version}.*/bin/python3")))


def interpreter(environment: Path) -> Path:
    """The Python of a virtual environment."""
    return environment / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def run(*words: str | Path, cwd: Path | None = None, **variables: str) -> None:
    """Run a command with more environment variables, and show what it has said if it fails."""
    environment = {name: value for name, value in os.environ.items() if name not in UNSET} | variables
    done = subprocess.run(list(map(str, words)), cwd=cwd, env=environment, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}\n{done.stdout}{done.stderr}")


if __name__ == "__main__":
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert set(EXTRAS) < set(project["optional-dependencies"])
    main()
