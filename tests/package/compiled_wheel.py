"""Builds a wheel with compiled code, installs it where nothing can be written, and counts what its commands compile.

Without options: a wheel for this processor, of the code that is kept in the checkout (``glyphspline warm`` puts it
there), which takes a minute. ``--wheel FILE``: that wheel, as ``make wheel`` has made it. ``--all``: also with another
numba, on a processor that lacks what the wheel's code needs, after an edit, and by ``uvx``.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.package.environments import INSTALL, ROOT, copy_tree, interpreter, run

FONTS = ROOT / "fonts_test"
NOBODY = 65534
EXTRAS = "parquet,view"

LISTENER = '''
"""Writes down in the file COMPILATIONS what a process compiles, whoever asks for it."""
import os, sys

class Finder:
    def find_spec(self, name, path=None, target=None):
        if name != "numba.core.event":
            return None
        sys.meta_path.remove(self)
        from importlib.util import find_spec
        spec = find_spec(name)
        execute = spec.loader.exec_module
        def exec_module(module):
            execute(module)
            class Listener(module.Listener):
                def on_start(self, event):
                    if event.data["name"].startswith("translate_bytecode"):
                        with open(os.environ["COMPILATIONS"], "a") as file:
                            print(event.data["module"], event.data["qualname"], event.data["args"], file=file)
                def on_end(self, event):
                    pass
            module.register("numba:run_pass", Listener())
        spec.loader.exec_module = exec_module
        return spec

if "COMPILATIONS" in os.environ:
    sys.meta_path.insert(0, Finder())
'''

INTERPOLATE = "import glyphspline as gs; print(gs.interpolate([[0, 0], [9, 1], [8, 9], [-1, 7]]).spline.control_points)"

AREA = (
    "from glyphspline.runs.small_runs import DISC; from glyphspline.curves.integrals import area\n"
    "print(area(DISC.cubics()))\n"
    "from glyphspline import compiled; compiled.spend(100.0); print(area._code is None or area._lacks)"
)
"""A program that runs little, says why as plain Python, and prints whether it did."""

BRUSH, VARIABLE = FONTS / "kouzan-gyosho.ttf", FONTS / "variable.ttf"

COMMANDS: dict[str, Sequence[str | Path]] = {
    "interpolate": ["-c", INTERPOLATE],
    "smooth": ["convert", BRUSH, "--text", "龍", "--preset", "paper", "--out", "smooth"],
    "sharp": ["convert", BRUSH, "--text", "好", "--format", "svg,curvature", "--out", "sharp"],
    "type": ["convert", VARIABLE, "--all", "--preset", "type", "--out", "type"],
    "masters": ["refit", VARIABLE, "--masters", "--preset", "type", "--format", "ttf", "--out", "masters"],
    "check": ["check", VARIABLE],
    "diff": ["diff", BRUSH, FONTS / "kouzan-kaisho.ttf", "--text", "龍"],
    "text": ["text", BRUSH, "好", "--out", "text.svg"],
    "dataset": ["dataset", BRUSH, "--text", "龍好", "--out", "dataset"],
    "demo": ["demo", BRUSH, "--out", "demo"],
}


class Environment:
    """A virtual environment that is not written to, and a folder for its commands."""

    def __init__(self, place: Path, python: str) -> None:
        self.place, self.python = place / "environment", interpreter(place / "environment")
        self.out, self.log = place / "out", place / "out" / "compilations"
        run(python, "-m", "venv", self.place)
        self.out.mkdir()
        self.out.chmod(0o777)
        self.as_nobody: dict[str, Any] = {}
        if os.name != "nt" and os.getuid() == 0:
            self.as_nobody = {"user": NOBODY, "group": NOBODY, "extra_groups": []}
        self.variables = {
            "PATH": os.defpath,
            "HOME": "/nonexistent",
            **dict.fromkeys(("TMPDIR", "TEMP"), str(self.out / "tmp")),
            "PYTHONPYCACHEPREFIX": str(self.out / "bytecode"),
            "COMPILATIONS": str(self.log),
        } | {name: os.environ[name] for name in ("SYSTEMROOT",) if name in os.environ}
        (self.out / "tmp").mkdir()
        (self.out / "tmp").chmod(0o777)

    def package(self) -> Path:
        """The installed package."""
        (found,) = self.place.glob("[Ll]ib/**/site-packages/glyphspline")
        return found

    def listen(self) -> None:
        """Count what is compiled in every process."""
        packages = self.package().parent
        (packages / "count_compilations.py").write_text(LISTENER)
        (packages / "count_compilations.pth").write_text("import count_compilations\n")

    def lock(self) -> None:
        """Take the right to write from everybody; root has it all the same, so that commands run as another user."""
        for path in (self.place, *self.place.rglob("*")):
            if not path.is_symlink():
                mode = path.stat().st_mode
                path.chmod((mode | 0o444 | (0o111 if mode & 0o100 else 0)) & ~0o222)

    @contextmanager
    def changed(self) -> Iterator[None]:
        """For a while its owner can write to it."""
        for path in (self.place, *self.place.rglob("*")):
            if not path.is_symlink():
                path.chmod(path.stat().st_mode | 0o200)
        yield
        self.lock()

    def words(self, words: Sequence[str | Path]) -> list[str]:
        """A command of the package, or Python code."""
        first = [] if words[0] == "-c" else ["-m", "glyphspline"]
        return [str(self.python), *first, *map(str, words)]

    def run(self, *words: str | Path, **variables: str) -> tuple[subprocess.CompletedProcess[str], list[str]]:
        """Run a command; returns what became of it, and what was compiled."""
        self.log.unlink(missing_ok=True)
        done = subprocess.run(
            self.words(words), cwd=self.out, env=self.variables | variables, capture_output=True, text=True,
            **self.as_nobody,
        )  # fmt: skip
        return done, self.compiled()

    def compiled(self) -> list[str]:
        """What has been compiled since the last command began."""
        return self.log.read_text().splitlines() if self.log.exists() else []

    def view(self) -> list[str]:
        """Open the live page, and have it show a glyph; returns what was compiled."""
        self.log.unlink(missing_ok=True)
        words = self.words(["view", BRUSH, "--no-browser"])
        server: subprocess.Popen[str] = subprocess.Popen(
            words, cwd=self.out, env=self.variables, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            **self.as_nobody,
        )  # fmt: skip
        assert server.stdout
        try:
            address = next(word for line in server.stdout for word in line.split() if word.startswith("http://"))
            urllib.request.urlopen(address, timeout=30).read()
            font = json.load(urllib.request.urlopen(f"{address.rstrip('/')}/api/font", timeout=30))
            state = {"glyph": font["first"], "location": {}, **font["defaults"], "moved": [], "measure": True}
            for route in ("glyph", "steps", "svg", "compare"):
                asked = urllib.request.Request(f"{address.rstrip('/')}/api/{route}", json.dumps(state).encode())
                asked.add_header("content-type", "application/json")
                urllib.request.urlopen(asked, timeout=60).read()
        finally:
            server.terminate()
            server.wait()
        return self.compiled()


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wheel", type=Path, help="a wheel that is there")
    parser.add_argument("--all", action="store_true", help="also what makes the wheel's code unfit")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="glyphspline-") as folder:
        place = Path(folder)
        place.chmod(0o755)
        environment = Environment(place, python_for_all())
        wheel = options.wheel or build(place, environment)
        run(environment.python, *INSTALL, f"{wheel.resolve()}[{EXTRAS}]")
        print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB", flush=True)
        environment.listen()
        environment.lock()
        try_commands(environment)
        if options.all:
            same_bytes(environment)
            without_its_code(environment)
            if uvx := shutil.which("uvx"):
                by_uvx(uvx, wheel.resolve(), environment)


def try_commands(environment: Environment) -> None:
    """Nothing is compiled by the first command of each kind."""
    for name, words in COMMANDS.items():
        began = time.monotonic()
        done, compiled = environment.run(*words)
        report(name, compiled, f"{time.monotonic() - began:.1f} s")
        if done.returncode > (name == "diff") or "plain Python" in done.stderr:
            sys.exit(f"{name}: {done.stdout}{done.stderr}")
    report("view", environment.view(), "")
    left = list((environment.out / "tmp").glob("glyphspline-*-compiled"))  # folders of commands for what they compiled
    assert not left, left


def same_bytes(environment: Environment) -> None:
    """What code compiled for this processor, as the checkout keeps it, writes is the same to the byte."""
    code = environment.out / "code"
    shutil.copytree(kept_code(), code)
    for path in (code, *code.iterdir()):
        path.chmod(0o777)
    with environment.changed():
        (environment.package() / "_compiled" / "made_for.json").rename(environment.package() / "made_for.json")
    for name in ("smooth", "sharp", "type", "masters"):
        out = f"{name}-here"
        done, compiled = environment.run(*COMMANDS[name][:-1], out, NUMBA_CACHE_DIR=str(code))
        assert done.returncode == 0, done.stderr
        pairs = [
            (file, environment.out / out / file.relative_to(environment.out / name))
            for file in (environment.out / name).rglob("*")
            if file.suffix in (".svg", ".ttf")
        ]
        same = sum(one.read_bytes() == other.read_bytes() for one, other in pairs)
        print(f"{name}: {same} of {len(pairs)} files have the bytes that code for this processor writes", flush=True)
        print(f"  ({len(compiled)} functions compiled)", flush=True)
        assert pairs
        assert same == len(pairs)
    with environment.changed():
        (environment.package() / "made_for.json").rename(environment.package() / "_compiled" / "made_for.json")


def without_its_code(environment: Environment) -> None:
    """Where the wheel's code does not fit, plain Python runs, which one line says, and computes the same."""

    def area(why: str, **variables: str) -> float:
        done, compiled = environment.run("-c", AREA, **variables)
        print(f"{done.stdout.split()}: {len(compiled)} functions compiled; {done.stderr.strip()}", flush=True)
        if done.returncode or compiled or why not in done.stderr:
            sys.exit(done.stdout + done.stderr)
        found, is_plain = done.stdout.split()
        assert is_plain == str(bool(why))
        return float(found)

    shipped = area("")
    assert abs(area("another processor", NUMBA_CPU_NAME="generic") / shipped - 1) < 1e-12
    kernel = environment.package() / "curves" / "integrals.py"
    text = kernel.read_text(encoding="utf-8")
    with environment.changed():
        kernel.write_text(text.replace("total / 20", "total / 10"), encoding="utf-8")
    assert abs(area("sources are not those") / shipped - 2) < 1e-12
    with environment.changed():
        kernel.write_text(text, encoding="utf-8")
        run(environment.python, *INSTALL, "--no-deps", "numba==0.67.*", "llvmlite==0.49.*")
    assert abs(area("this is numba 0.67") / shipped - 1) < 1e-12


def by_uvx(uvx: str, wheel: Path, environment: Environment) -> None:
    """A command of the wheel without an environment."""
    places = {"UV_CACHE_DIR": str(environment.out / "uv"), "HOME": str(environment.out)}
    began = time.monotonic()
    words = [
        uvx,
        "--python",
        sys.executable,
        "--from",
        str(wheel),
        "glyphspline",
        *map(str, COMMANDS["smooth"][:-1]),
        "uvx",
    ]
    done = subprocess.run(words, cwd=environment.out, env=os.environ | places, capture_output=True, text=True)
    print(f"uvx: {time.monotonic() - began:.0f} s {done.stderr[-300:]}", flush=True)
    assert done.returncode == 0
    assert "plain Python" not in done.stderr


def report(name: str, compiled: list[str], words: str) -> None:
    """Say how many functions were compiled; the end if there was one."""
    print(f"{name}: {len(compiled)} functions compiled {words}", flush=True)
    if compiled:
        sys.exit("\n".join(compiled))


def build(place: Path, environment: Environment) -> Path:
    """A wheel for this processor, built where it will be tried, so that its libraries are installed once."""
    copy_tree(place / "tree")
    run(environment.python, *INSTALL, f"{place / 'tree'}[{EXTRAS}]", "setuptools>=77")
    run(environment.python, "-m", "pip", "uninstall", "--quiet", "--yes", "glyphspline")
    words = ("-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", place / "dist")
    run(environment.python, *words, place / "tree", GLYPHSPLINE_COMPILED="host", NUMBA_CACHE_DIR=str(kept_code()))
    (wheel,) = (place / "dist").glob("*.whl")
    return wheel


def kept_code() -> Path:
    """The folder of code compiled in the checkout."""
    return Path(os.environ.get("NUMBA_CACHE_DIR") or ROOT / "glyphspline" / "__pycache__" / "compiled")


def python_for_all() -> str:
    """This Python if another user can run it, or else that of the system."""
    if os.name == "nt" or os.getuid():
        return sys.executable
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    for python in filter(None, [sys.executable, shutil.which(version, path=os.defpath)]):
        try:
            subprocess.run([os.path.realpath(python), "-c", "import ensurepip"], user=NOBODY, check=True, cwd="/")
        except (PermissionError, subprocess.CalledProcessError):
            continue
        return os.path.realpath(python)
    sys.exit("run this as another user than root: no Python here is for all users")


if __name__ == "__main__":
    main()
