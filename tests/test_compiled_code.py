"""Compiled code: where it is kept, what it is stamped with, other processors, and no compiler."""

from __future__ import annotations

import json
import os
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
from glyphspline import compiled

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
def test_without_a_place_the_code_is_in_a_folder_of_ones_own(installed: Path) -> None:
    for said in (1, 0):
        found = as_nobody(installed, "-c", SMALL)
        assert found.returncode == 0, found.stderr
        assert found.stderr.count("kept in") == len(found.stderr.splitlines()) == said
    (folder,) = (installed / "tmp").iterdir()
    assert folder.stat().st_mode & 0o777 == 0o700
    assert list(folder.glob("*.nbc"))


@has_users
@pytest.mark.parametrize("harm", ["open to all", "a link", "a file"])
def test_a_folder_that_others_can_change_is_not_used(
    harm: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    first = compiled.temporary_folder()
    assert compiled.temporary_folder() == first
    if harm == "open to all":
        first.chmod(0o777)
    else:
        first.rmdir()
        if harm == "a link":
            first.symlink_to(tmp_path)
        else:
            first.write_text("")
    second = compiled.temporary_folder()
    assert second != first
    assert second.stat().st_mode & 0o777 == 0o700


def test_a_place_that_is_given_is_taken_and_said_once(tmp_path: Path) -> None:
    for lines in (1, 0):
        found = run("-c", SMALL, NUMBA_CACHE_DIR=str(tmp_path / "there"))
        assert found.returncode == 0, found.stderr
        assert len(found.stderr.splitlines()) == found.stderr.count(str(tmp_path / "there")) == lines
    assert [path.suffix for path in (tmp_path / "there").iterdir()] == [".nbc"]


def test_nobody_is_told_who_does_not_want_to_be(tmp_path: Path) -> None:
    found = run("-c", SMALL, NUMBA_CACHE_DIR=str(tmp_path), GLYPHSPLINE_QUIET="1")
    assert (found.returncode, found.stderr) == (0, "")
    assert list(tmp_path.iterdir())


TWO_FILES = {
    "__init__.py": "",
    "inner.py": "from glyphspline.compiled import compiled\n@compiled\ndef twice(x):\n    return 2 * x\n",
    "constants.py": "LARGE = 5\n",
    "outer.py": (
        "from glyphspline.compiled import compiled\nfrom .constants import LARGE\nfrom .inner import twice\n"
        "@compiled\ndef more(x):\n    return twice(x) + LARGE\n"
    ),
}


@pytest.mark.parametrize(
    ("file", "before", "after", "result"),
    [("inner.py", "2 *", "3 *", 35), ("constants.py", "5", "6", 26), ("outer.py", "+", "-", 15)],
)
def test_an_edit_anywhere_below_a_function_is_noticed(
    file: str, before: str, after: str, result: int, tmp_path: Path
) -> None:
    """Also in a file that the function only calls, or takes a constant from; an edit that is undone is known."""
    package = tmp_path / "edited"
    package.mkdir()
    for name, text in TWO_FILES.items():
        (package / name).write_text(text)
    code = (
        "from edited.outer import more; from glyphspline import compiled as c; print(more(10), c._listener.count > 0)"
    )

    def printed() -> str:
        place = {"NUMBA_CACHE_DIR": str(tmp_path / "code"), "PYTHONPATH": str(tmp_path), "GLYPHSPLINE_QUIET": "1"}
        found = run("-B", "-c", code, **place)
        assert found.returncode == 0, found.stderr
        return found.stdout.strip()

    assert [printed(), printed()] == ["25 True", "25 False"]
    (package / file).write_text(TWO_FILES[file].replace(before, after))
    assert [printed(), printed()] == [f"{result} True", f"{result} False"]
    (package / file).write_text(TWO_FILES[file])
    assert printed() == "25 False"


def test_every_compiled_function_can_be_called_from_python() -> None:
    """One that only compiled functions call gets its entry for Python when it is called."""
    from glyphspline.curves import cubics

    assert isinstance(cubics.length, compiled.Compiled)
    assert cubics.length(3.0, 4.0) == 5.0


def test_it_runs_as_plain_python_without_a_compiler(tmp_path: Path) -> None:
    """Fits of small contours, in both modes: the same numbers but for products that compiled code rounds once."""
    code = (
        "import json, sys, numpy as np, glyphspline as gs\n"
        "from glyphspline.runs.warm import DISC, LEAF\n"
        "from glyphspline.compiled import everything\n"
        "points = np.random.default_rng(1).random((9, 2))\n"
        "spline = gs.interpolate(points, finish='solve').spline.control_points\n"
        "found = [spline.tolist()]\n"
        "for shape, options in ((LEAF, gs.Options()), (DISC, gs.Options(corners='sharp', tolerance=0.3))):\n"
        "    glyph = gs.convert(gs.Outline('shape', contours=(shape,)), options)\n"
        "    found.append(glyph.arrays.curves.points.tolist())\n"
        "print(json.dumps([bool(everything), *found]))"
    )
    plain, fast = (json.loads(run("-c", code, NUMBA_DISABLE_JIT=off).stdout) for off in ("1", "0"))
    assert (plain[0], fast[0]) == (False, True)
    np.testing.assert_allclose(plain[1], fast[1], rtol=0, atol=1e-12)
    for slow, quick in zip(plain[2:], fast[2:], strict=True):
        np.testing.assert_allclose(slow, quick, rtol=0, atol=1e-9 * 100)  # of contours a hundred units wide


@pytest.mark.parametrize("corners", ["smooth", "sharp"])
def test_the_command_runs_as_plain_python(corners: str, tmp_path: Path) -> None:
    """Reading and fitting two letters, with no code kept from before."""
    font, place = str(PACKAGE.parent / "fonts_test" / "edge-cases.ttf"), {"NUMBA_CACHE_DIR": str(tmp_path / "code")}
    words = ["convert", font, "--text", "a8", "--corners", corners, "--tolerance", "3", "--jobs", "0"]
    found = run("-m", "glyphspline", *words, "--out", str(tmp_path / "out"), NUMBA_DISABLE_JIT="1", **place)
    assert found.returncode == 0, found.stderr
    assert len(list((tmp_path / "out").rglob("*.svg"))) >= 2
    assert not list(tmp_path.rglob("*.nbc"))


def test_a_processor_without_fused_multiplication_computes_the_same(tmp_path: Path) -> None:
    """To rounding: LLVM then calls the C library's ``fma``, and vectors are shorter."""
    code = (
        "import numpy, glyphspline\n"
        "points = numpy.random.default_rng(1).random((40, 2))\n"
        "print(repr(glyphspline.interpolate(points, residual_tolerance=1e-9).spline.control_points.tolist()))"
    )
    plain = run("-W", "error", "-c", code, NUMBA_CPU_NAME="generic", NUMBA_CACHE_DIR=str(tmp_path))
    assert plain.returncode == 0, plain.stderr
    assert list(tmp_path.rglob("*.nbc"))
    here = run("-c", code)
    np.testing.assert_allclose(json.loads(plain.stdout), json.loads(here.stdout), atol=1e-8)


CONVERT = ["-m", "glyphspline", "convert", str(PACKAGE.parent / "fonts_test" / "kouzan-gyosho.ttf"), "--text", "O"]


@pytest.mark.skipif(os.name == "nt", reason="sends a signal")
@pytest.mark.parametrize("jobs", ["0", "2"])
def test_ctrl_c_ends_a_compilation(jobs: str, tmp_path: Path) -> None:
    place = {"NUMBA_CACHE_DIR": str(tmp_path / "code")}
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore the signal
    started = subprocess.Popen(
        [sys.executable, *CONVERT, "--jobs", jobs, "--out", str(tmp_path / "out")],
        env=os.environ | place, cwd=PACKAGE.parent, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    signal.signal(signal.SIGINT, before)
    assert started.stderr
    assert "compiling once" in started.stderr.readline()
    started.send_signal(signal.SIGINT)
    said = started.communicate(timeout=60)[1]  # until the last process closes it; compiling takes longer
    assert started.returncode == 130
    assert said.splitlines() == ["interrupted; the same command goes on from here"]
    assert run("-c", SMALL, **place).returncode == 0


def test_a_second_command_compiles_nothing(tmp_path: Path) -> None:
    found = run(*CONVERT, "--out", str(tmp_path / "first"))
    assert found.returncode == 0
    found = run(*CONVERT, "--out", str(tmp_path / "second"))
    assert "compiling" not in found.stderr


def test_warm_reaches_every_function() -> None:
    """No function is left for a later command to compile."""
    code = (
        "import importlib, pkgutil, glyphspline\n"
        "from glyphspline.runs.warm import WORK, prepare\n"
        "for kind in WORK: prepare(kind)\n"
        "for module in pkgutil.walk_packages(glyphspline.__path__, 'glyphspline.'):\n"
        "    if '__main__' not in module.name: importlib.import_module(module.name)\n"
        "from glyphspline.compiled import below, everything\n"
        "ready = set().union(*(below(one.py_func) for one in everything if one.entry.overloads))\n"
        "print(*[f'{one.__module__}.{one.__qualname__}' for one in everything if one.py_func not in ready])"
    )
    found = run("-c", code)
    assert (found.returncode, found.stdout.split()) == (0, []), found.stderr


def test_the_command_warms_every_kind_of_work() -> None:
    found = run("-m", "glyphspline", "warm", "--jobs", "1")
    assert (found.returncode, found.stderr.splitlines()[-1]) == (0, "everything is compiled")
