"""Compiled code: where it is kept if there is no place for it, other processors, and no compiler."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import site
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import glyphspline
from glyphspline import cache

PACKAGE = Path(glyphspline.__file__).parent
NOBODY = 65534
SMALL = "import numpy; from glyphspline.curves.integrals import area; print(area(numpy.zeros((1, 4, 2))))"
"""A program that compiles little."""

has_users = pytest.mark.skipif(os.name == "nt", reason="has no users with numbers")


def run(*words: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """The interpreter of the tests, with changes of its environment."""
    return subprocess.run(
        [sys.executable, *words], env=os.environ | environment, cwd=PACKAGE.parent, capture_output=True, text=True
    )


@pytest.fixture
def installed() -> Iterator[Path]:
    """A folder with a copy of the package that cannot be written to, and ``tmp``, where everybody can write."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        folder.chmod(0o755)
        copy = shutil.copytree(PACKAGE, folder / "lib" / PACKAGE.name, ignore=shutil.ignore_patterns("__pycache__"))
        (folder / "tmp").mkdir()
        (folder / "tmp").chmod(0o777)
        for path in [copy, *copy.rglob("*")]:
            path.chmod(0o555 if path.is_dir() else 0o444)
        yield folder
        for path in [copy, *copy.rglob("*")]:
            path.chmod(0o755)


def as_nobody(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """An interpreter run by a user without a home, to whom the packages of this one are given."""
    own: Any = {} if os.getuid() else {"user": NOBODY, "group": NOBODY, "extra_groups": []}
    paths = [str(folder / "lib"), *site.getsitepackages()]
    environment = {"PYTHONPATH": os.pathsep.join(paths), "HOME": "/nonexistent/home", "TMPDIR": str(folder / "tmp")}
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    for python in filter(None, [sys.executable, shutil.which(version, path=os.defpath)]):
        try:
            found: subprocess.CompletedProcess[str] = subprocess.run(
                [python, *words], env=environment, cwd="/", capture_output=True, text=True, **own
            )
        except PermissionError:
            continue
        if "No module named" not in found.stderr:
            return found
    pytest.skip("there is no interpreter that another user can run")


@has_users
def test_without_a_place_the_cache_is_a_folder_of_ones_own(installed: Path) -> None:
    for _ in range(2):
        found = as_nobody(installed, "-c", SMALL)
        assert found.returncode == 0, found.stderr
        assert found.stderr.count("compiled code is kept in") == len(found.stderr.splitlines()) == 1
    (folder,) = (installed / "tmp").iterdir()
    assert folder.stat().st_mode & 0o777 == 0o700
    assert list(folder.rglob("*.nbc"))


@has_users
def test_a_command_says_once_where_the_cache_is(installed: Path) -> None:
    font = shutil.copy(PACKAGE.parent / "fonts_test" / "variable.ttf", installed)
    found = as_nobody(installed, "-m", "glyphspline", "info", str(font))
    assert found.returncode == 0, found.stderr
    assert found.stderr.count("compiled code is kept in") == 1


@has_users
@pytest.mark.parametrize("harm", ["open to all", "a link", "a file"])
def test_a_folder_that_others_can_change_is_not_used(
    harm: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    first = cache.temporary()
    assert cache.temporary() == first
    if harm == "open to all":
        first.chmod(0o777)
    else:
        first.rmdir()
        if harm == "a link":
            first.symlink_to(tmp_path)
        else:
            first.write_text("")
    second = cache.temporary()
    assert second != first
    assert second.stat().st_mode & 0o777 == 0o700


def test_a_place_that_is_given_is_taken(tmp_path: Path) -> None:
    found = run("-c", SMALL, NUMBA_CACHE_DIR=str(tmp_path / "there"))
    assert (found.returncode, found.stderr) == (0, "")
    assert list((tmp_path / "there").rglob("*.nbc"))


def test_without_a_compiler_a_command_says_so_in_one_line(tmp_path: Path) -> None:
    font = str(PACKAGE.parent / "fonts_test" / "variable.ttf")
    words = ["-m", "glyphspline", "convert", font, "--text", "O", "--out", str(tmp_path / "out")]
    found = run(*words, NUMBA_DISABLE_JIT="1")
    assert found.returncode == 2
    assert found.stderr.startswith("glyphspline: NUMBA_DISABLE_JIT is set")
    assert len(found.stderr.splitlines()) == 1


def test_a_processor_without_fused_multiplication_computes_the_same(tmp_path: Path) -> None:
    """To rounding: LLVM then calls the C library's ``fma``, and vectors are shorter."""
    code = (
        "import numpy, glyphspline\n"
        "points = numpy.random.default_rng(1).random((40, 2))\n"
        "print(repr(glyphspline.interpolate(points, residual_tolerance=1e-9).spline.control_points.tolist()))"
    )
    plain = run("-W", "error", "-c", code, NUMBA_CPU_NAME="generic", NUMBA_CACHE_DIR=str(tmp_path))
    assert (plain.returncode, plain.stderr) == (0, "")
    assert list(tmp_path.rglob("*.nbc"))
    here = run("-c", code)
    np.testing.assert_allclose(json.loads(plain.stdout), json.loads(here.stdout), atol=1e-8)


CONVERT = ["-m", "glyphspline", "convert", str(PACKAGE.parent / "fonts_test" / "kouzan-gyosho.ttf"), "--text", "O"]


@pytest.mark.skipif(os.name == "nt", reason="sends a signal")
@pytest.mark.parametrize("jobs", ["0", "2"])
def test_ctrl_c_ends_a_compilation(jobs: str, tmp_path: Path) -> None:
    place = {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore the signal
    started = subprocess.Popen(
        [sys.executable, *CONVERT, "--jobs", jobs, "--out", str(tmp_path / "out")],
        env=os.environ | place, cwd=PACKAGE.parent, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    signal.signal(signal.SIGINT, before)
    assert started.stderr
    assert started.stderr.readline().startswith("compiling once")
    started.send_signal(signal.SIGINT)
    said = started.communicate(timeout=20)[1]  # until the last process closes it; compiling takes a minute
    assert started.returncode == 130
    lines = [line for line in said.splitlines() if not line.startswith("compiling once")]
    assert lines == ["interrupted; the same command goes on from here"]
    assert run("-c", SMALL, **place).returncode == 0


def test_a_warm_command_says_nothing_of_compiling(tmp_path: Path) -> None:
    found = run(*CONVERT, "--out", str(tmp_path / "first"))
    assert found.returncode == 0
    found = run(*CONVERT, "--out", str(tmp_path / "second"))
    assert "compiling" not in found.stderr


def test_everything_is_compiled_by_the_modules_for_it() -> None:
    """No function is left for a later command to compile."""
    code = (
        "import importlib, pkgutil, glyphspline\n"
        "from glyphspline.batch.warm import EVERYTHING, __path__, module_names\n"
        "assert {module.name for module in pkgutil.iter_modules(__path__)} == set(EVERYTHING)\n"
        "for name in module_names(EVERYTHING): importlib.import_module(name)\n"
        "for module in pkgutil.walk_packages(glyphspline.__path__, 'glyphspline.'):\n"
        "    if '__main__' not in module.name: importlib.import_module(module.name)\n"
        "from glyphspline.compiling import functions\n"
        "print(*[name for name, ready in functions().items() if not ready])"
    )
    found = run("-c", code)
    assert (found.returncode, found.stdout.split()) == (0, []), found.stderr


def test_warm_says_how_many_functions_are_compiled() -> None:
    found = run("-m", "glyphspline", "warm", "--jobs", "1")
    assert found.returncode == 0
    assert re.fullmatch(r"\d{3} functions are compiled\n", found.stderr)
