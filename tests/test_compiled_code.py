"""Compiled code: which calls run it, where it is kept, what it is stamped with, other processors, and no compiler."""

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
from glyphspline import code_files, compiled

PACKAGE = Path(glyphspline.__file__).parent
NOBODY = 65534
SMALL = (
    "import sys, numpy; from glyphspline.code_files import kept; from glyphspline.curves.integrals import area\n"
    "with kept.compiling(): print(area(numpy.zeros((1, 4, 2))))"
)
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


@pytest.mark.long
@has_users
def test_without_a_place_the_code_is_in_a_folder_of_ones_own(installed: Path) -> None:
    for _ in range(2):
        found = as_nobody(installed, "-c", SMALL)
        assert (found.returncode, found.stderr) == (0, "")
    (folder,) = (installed / "tmp").iterdir()
    assert folder.stat().st_mode & 0o777 == 0o700
    assert len(list(folder.glob("*.nbc"))) == 1


@has_users
@pytest.mark.parametrize("harm", ["open to all", "a link", "a file"])
def test_a_folder_that_others_can_change_is_not_used(
    harm: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    first = code_files.temporary_folder()
    assert code_files.temporary_folder() == first
    if harm == "open to all":
        first.chmod(0o777)
    else:
        first.rmdir()
        if harm == "a link":
            first.symlink_to(tmp_path)
        else:
            first.write_text("")
    second = code_files.temporary_folder()
    assert second != first
    assert second.stat().st_mode & 0o777 == 0o700


@pytest.mark.long
def test_a_place_that_is_given_is_taken(tmp_path: Path) -> None:
    for _ in range(2):
        found = run("-c", SMALL, NUMBA_CACHE_DIR=str(tmp_path / "there"))
        assert (found.returncode, found.stderr) == (0, "")
    assert [path.suffix for path in (tmp_path / "there").iterdir()] == [".nbc"]


TWO_FILES = {
    "__init__.py": "",
    "inner.py": "from glyphspline.compiled import compiled\n@compiled\ndef twice(x):\n    return 2 * x\n",
    "constants.py": "LARGE = 5\n",
    "outer.py": (
        "from glyphspline.compiled import compiled\nfrom .constants import LARGE\nfrom .inner import twice\n"
        "@compiled\ndef more(x):\n    return twice(x) + LARGE\n"
    ),
}

COMPILING = "with kept.compiling(): more(10)"
CALLING = "print(more(10), 'compiled' if more._code is not None and not more._lacks else 'plain')"
USED = "from glyphspline.compiling import used; print(len(used), 'files')"


@pytest.fixture
def two_files(tmp_path: Path) -> Path:
    """The folder of a package of two compiled functions, one of which calls the other."""
    package = tmp_path / "edited"
    package.mkdir()
    for name, text in TWO_FILES.items():
        (package / name).write_text(text)
    return package


def printed(package: Path, *lines: str) -> list[str]:
    """What a program of these lines prints, its code kept beside the package."""
    names = "import subprocess, sys", "from glyphspline.code_files import kept"
    functions = "from edited.inner import twice", "from edited.outer import more"
    place = {"NUMBA_CACHE_DIR": str(package.parent / "code"), "PYTHONPATH": str(package.parent)}
    found = run("-B", "-c", "\n".join([*names, *functions, *lines]), **place)
    assert (found.returncode, found.stderr) == (0, "")
    return found.stdout.splitlines()


@pytest.mark.parametrize(
    ("file", "before", "after", "result"),
    [
        ("inner.py", "2 *", "3 *", 35),
        pytest.param("constants.py", "5", "6", 26, marks=pytest.mark.long),
        pytest.param("outer.py", "+", "-", 15, marks=pytest.mark.long),
    ],
)
def test_an_edit_anywhere_below_a_function_is_noticed(
    file: str, before: str, after: str, result: int, two_files: Path
) -> None:
    """Also in a file that the function only calls, or takes a constant from; an edit that is undone is known."""
    assert printed(two_files, COMPILING, CALLING) == printed(two_files, CALLING) == ["25 compiled"]
    (two_files / file).write_text(TWO_FILES[file].replace(before, after))
    assert printed(two_files, CALLING) == [f"{result} plain"]
    assert printed(two_files, COMPILING, CALLING) == printed(two_files, CALLING) == [f"{result} compiled"]
    (two_files / file).write_text(TWO_FILES[file])
    assert printed(two_files, CALLING) == ["25 compiled"]


def test_code_that_is_there_in_part_is_used_for_what_it_fits(two_files: Path) -> None:
    """An outer call without code runs as Python and calls the code of an inner function; other types run as Python."""
    assert printed(two_files, "with kept.compiling(): twice(10)", CALLING, USED) == ["25 plain", "1 files"]
    assert printed(two_files, CALLING, USED) == ["25 plain", "1 files"]
    assert printed(two_files, COMPILING, "print(more(1.5), more(10))", USED) == ["8.0 25", "2 files"]
    assert printed(two_files, "print(more(1.5), more._lacks, more(10))", USED) == ["8.0 True 25", "1 files"]


def test_code_that_another_process_makes_is_used_from_the_next_call_on(two_files: Path) -> None:
    elsewhere = f"from edited.outer import more; from glyphspline.code_files import kept\n{COMPILING}"
    there = f"subprocess.run([sys.executable, '-B', '-c', {elsewhere!r}], check=True)"
    imported = "print('numba' in sys.modules)"
    assert printed(two_files, CALLING, imported, there, CALLING) == ["25 plain", "False", "25 compiled"]


def test_running_as_python_imports_no_compiler_and_changes_nothing_in_the_process(tmp_path: Path) -> None:
    """Nor in its threads, and nothing warns of what compiled code computes in silence."""
    font = PACKAGE.parent / "fonts_test" / "edge-cases.ttf"
    code = (
        "import sys, threading, numpy as np\n"
        "before = np.geterr()\n"
        "import glyphspline as gs\n"
        "def work():\n"
        "    gs.interpolate(np.random.default_rng(1).random((9, 2)))\n"
        f"    gs.convert(gs.open_font({str(font)!r}).outline('a'), gs.Options(tolerance=3.0))\n"
        "    assert np.geterr() == before\n"
        "    done.append(1)\n"
        "done = []\n"
        "work()\n"
        "thread = threading.Thread(target=work); thread.start(); thread.join()\n"
        "print(len(done), *sorted({name.split('.')[0] for name in sys.modules} & {'numba', 'llvmlite'}))"
    )
    found = run("-W", "error", "-c", code, NUMBA_CACHE_DIR=str(tmp_path))
    assert (found.returncode, found.stdout.split()) == (0, ["2"]), found.stderr
    assert not list(tmp_path.iterdir())


def test_it_runs_as_plain_python_without_a_compiler(tmp_path: Path) -> None:
    """An interpolation, the same bits; fits of small contours, in both modes, the same numbers to rounding."""
    code = (
        "import json, sys, numpy as np, glyphspline as gs\n"
        "from glyphspline.runs.small_runs import DISC, LEAF\n"
        "points = np.random.default_rng(1).random((9, 2))\n"
        "spline = gs.interpolate(points).spline.control_points\n"
        "found = [spline.tolist()]\n"
        "for shape, options in ((LEAF, gs.Options()), (DISC, gs.Options(corners='sharp', tolerance=0.3))):\n"
        "    glyph = gs.convert(gs.Outline('shape', contours=(shape,)), options)\n"
        "    found.append(glyph.arrays.curves.points.tolist())\n"
        "print(json.dumps(['numba' in sys.modules, *found]))"
    )
    plain, fast = (json.loads(run("-c", code, NUMBA_DISABLE_JIT=off).stdout) for off in ("1", "0"))
    assert (plain[0], fast[0]) == (False, True)
    assert plain[1] == fast[1]
    for slow, quick in zip(plain[2:], fast[2:], strict=True):
        np.testing.assert_allclose(slow, quick, rtol=0, atol=1e-9 * 100)  # of contours a hundred units wide


@pytest.mark.parametrize("corners", [pytest.param("smooth", marks=pytest.mark.long), "sharp"])
def test_the_command_runs_as_plain_python(corners: str, tmp_path: Path) -> None:
    """Reading and fitting two letters, with no code kept from before."""
    font, place = str(PACKAGE.parent / "fonts_test" / "edge-cases.ttf"), {"NUMBA_CACHE_DIR": str(tmp_path / "code")}
    words = ["convert", font, "--text", "a8", "--corners", corners, "--tolerance", "3", "--jobs", "0"]
    found = run("-m", "glyphspline", *words, "--out", str(tmp_path / "out"), NUMBA_DISABLE_JIT="1", **place)
    assert found.returncode == 0, found.stderr
    assert len(list((tmp_path / "out").rglob("*.svg"))) >= 2
    assert not list(tmp_path.rglob("*.nbc"))


@pytest.mark.long
def test_another_processor_computes_the_same_bits(tmp_path: Path) -> None:
    """One with shorter vectors, and without fused products."""
    code = (
        "import numpy, glyphspline\n"
        "from glyphspline.code_files import kept\n"
        "points = numpy.random.default_rng(1).random((40, 2))\n"
        "with kept.compiling():\n"
        "    print(repr(glyphspline.interpolate(points, residual_tolerance=1e-9).spline.control_points.tolist()))"
    )
    plain = run("-W", "error", "-c", code, NUMBA_CPU_NAME="generic", NUMBA_CACHE_DIR=str(tmp_path))
    assert plain.returncode == 0, plain.stderr
    assert list(tmp_path.rglob("*.nbc"))
    here = run("-c", code)
    assert json.loads(plain.stdout) == json.loads(here.stdout)


CONVERT = ["-m", "glyphspline", "convert", str(PACKAGE.parent / "fonts_test" / "kouzan-gyosho.ttf"), "--text", "O"]


@pytest.mark.long
@pytest.mark.skipif(os.name == "nt", reason="sends a signal")
def test_ctrl_c_ends_a_compilation(tmp_path: Path) -> None:
    place = {"NUMBA_CACHE_DIR": str(tmp_path / "code")}
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore the signal
    started = subprocess.Popen(
        [sys.executable, "-m", "glyphspline", "warm", "--jobs", "2"],
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


def test_a_command_with_code_runs_nothing_as_python(tmp_path: Path) -> None:
    words = [*CONVERT[2:], "--jobs", "0", "--out", str(tmp_path / "out")]
    code = (
        "from glyphspline import compiled\nfrom glyphspline.cli.app import app\n"
        f"app({words!r}, standalone_mode=False)\nprint(compiled._spent)"
    )
    found = run("-c", code)
    assert (found.returncode, float(found.stdout)) == (0, 0.0), found.stderr


AS_QUICK = {"arc", "directions", "length", "set_unit"}
"""Functions of a few lines that Python also calls, for which they need no code."""


def test_warm_reaches_every_function() -> None:
    """No function is left that always runs as Python: none at all, and of those that Python calls none from there."""
    code = (
        "import gc, importlib, pkgutil, glyphspline\n"
        "from types import FunctionType\n"
        "from glyphspline.code_files import below, globals_of, kept\n"
        "from glyphspline.runs.small_runs import work\n"
        "from glyphspline.runs.warm import compile_kind\n"
        "for kind in work(): compile_kind(kind)\n"
        "for module in pkgutil.walk_packages(glyphspline.__path__, 'glyphspline.'):\n"
        "    if '__main__' not in module.name: importlib.import_module(module.name)\n"
        "from glyphspline.compiled import Compiled, everything\n"
        "called = {one for one in everything if one.entry.overloads}\n"
        "ready = set().union(*(below(one.py_func) for one in called))\n"
        "print(*[f'{one.__module__}.{one.__qualname__}' for one in everything if one.py_func not in ready])\n"
        "own = {function for one in everything for function in (one.py_func, one.plain)}\n"
        "for function in gc.get_objects():\n"
        "    if not isinstance(function, FunctionType) or function in own: continue\n"
        "    if hasattr(function, 'targetoptions'): continue\n"
        "    if not str(function.__module__).startswith('glyphspline.'): continue\n"
        "    if function.__module__ == 'glyphspline.interpolation.plain': continue\n"
        "    for name, value in globals_of(function):\n"
        "        if isinstance(value, Compiled) and function.__globals__.get(name) is value and value not in called:\n"
        "            print(name)\n"
    )
    found = run("-c", code)
    assert (found.returncode, set(found.stdout.split()) - AS_QUICK) == (0, set()), found.stderr


@pytest.mark.long
def test_the_command_warms_every_kind_of_work() -> None:
    found = run("-m", "glyphspline", "warm", "--jobs", "1")
    assert (found.returncode, found.stderr.splitlines()[-1]) == (0, "everything is compiled")


def test_after_a_while_one_line_says_what_compiling_would_bring(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(compiled, "_spent", 0.0)
    monkeypatch.delenv("GLYPHSPLINE_QUIET", raising=False)
    for _ in range(30):
        compiled.spend(0.7)
    (record,) = caplog.records
    assert "glyphspline warm" in record.getMessage()
    assert record.getMessage() == compiled.hint()
    monkeypatch.setattr(compiled, "_spent", 0.0)
    monkeypatch.setenv("GLYPHSPLINE_QUIET", "1")
    compiled.spend(11.0)
    assert len(caplog.records) == 1
