"""Worker processes that die, hang and raise."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import wait
from pathlib import Path

import pytest

from glyphspline.runs import pool as pools
from glyphspline.runs.pool import (
    POLL,
    TimeLimitError,
    WorkerLostError,
    WorkerPool,
    WorkerStartError,
    kill_server,
    sign_of_life,
)
from tests.places import ROOT

LIMIT = 600.0
"""Seconds without a sign of life, and for any answer: no loaded machine exceeds them, and no test waits for them."""


def age(seconds: float) -> None:
    """Make the last sign of life older, and let the pool look at it."""
    pools._last_sign.value -= seconds
    time.sleep(4 * POLL)


def hang() -> None:
    age(2 * LIMIT)
    time.sleep(LIMIT)


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def parts(number: int, each: float) -> int:
    for _ in range(number):
        sign_of_life()
        age(each)
    return number


def has_imported(name: str) -> bool:
    return name in sys.modules


@pytest.fixture(scope="module")
def pool() -> Iterator[WorkerPool]:
    with WorkerPool(2, seconds=LIMIT) as made:
        yield made


def test_results_and_errors_come_back(pool: WorkerPool) -> None:
    futures = [pool.submit(pow, 2, k) for k in range(100)]
    assert [future.result(timeout=LIMIT) for future in futures] == [2**k for k in range(100)]
    assert isinstance(pool.submit(pow, "a", 1).exception(timeout=LIMIT), TypeError)


def test_a_dead_worker_costs_one_call_and_is_replaced(pool: WorkerPool) -> None:
    lost = pool.submit(die)
    kept = [pool.submit(pow, 3, k) for k in range(20)]
    assert isinstance(lost.exception(timeout=LIMIT), WorkerLostError)
    assert [future.result(timeout=LIMIT) for future in kept] == [3**k for k in range(20)]
    assert len({pool.submit(os.getpid).result(timeout=LIMIT) for _ in range(8)}) <= 2


@pytest.mark.parametrize(("call", "limit"), [(die, WorkerLostError), (hang, TimeLimitError)])
def test_what_waits_for_a_lost_worker_is_done_by_another(call: Callable[[], None], limit: type[Exception]) -> None:
    with WorkerPool(1, seconds=LIMIT) as pool:
        first = pool.submit(os.getpid)
        lost, kept = pool.submit(call), [pool.submit(pow, 5, k) for k in range(6)]
        last = pool.submit(os.getpid)
        assert isinstance(lost.exception(timeout=LIMIT), limit)
        assert [future.result(timeout=LIMIT) for future in kept] == [5**k for k in range(6)]
        assert first.result(timeout=LIMIT) != last.result(timeout=LIMIT)


def test_calls_may_be_larger_than_a_pipe_holds() -> None:
    with WorkerPool(1, seconds=LIMIT) as pool:
        futures = [pool.submit(len, b"x" * 3_000_000) for _ in range(6)]
        assert [future.result(timeout=LIMIT) for future in futures] == [3_000_000] * 6


def test_a_hung_worker_is_killed_and_others_go_on(pool: WorkerPool) -> None:
    hung, quick = pool.submit(hang), pool.submit(pow, 2, 2)
    assert quick.result(timeout=LIMIT) == 4
    assert isinstance(hung.exception(timeout=LIMIT), TimeLimitError)
    assert pool.submit(pow, 2, 3).result(timeout=LIMIT) == 8


def test_the_limit_is_for_each_part_of_a_long_call(pool: WorkerPool) -> None:
    assert pool.submit(parts, 4, 0.4 * LIMIT).result(timeout=LIMIT) == 4


def test_closing_ends_what_is_running_and_queued() -> None:
    with WorkerPool(1, seconds=LIMIT) as pool:
        futures = [pool.submit(time.sleep, LIMIT) for _ in range(3)]
        time.sleep(0.1)
    assert not wait(futures, timeout=LIMIT).not_done
    assert all(future.exception() is not None for future in futures)


def test_a_worker_has_imported_what_it_needs_before_its_time_counts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "slow_to_import.py").write_text(f"from tests.runs.test_pool import age\nage({2 * LIMIT})\n")
    monkeypatch.syspath_prepend(tmp_path)
    with WorkerPool(1, seconds=LIMIT, preload=["slow_to_import"]) as pool:  # the server of forks is there already
        assert pool.submit(has_imported, "slow_to_import").result(timeout=LIMIT) is True


DIES = """
import os, pathlib, signal
starts = pathlib.Path(__file__).with_name("starts")
starts.write_text(starts.read_text() + ".") if starts.exists() else starts.write_text(".")
if len(starts.read_text()) <= {times}:
    os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.parametrize(("times", "works"), [(2, True), (100, False)])
def test_a_process_that_dies_while_it_starts_is_replaced(
    times: int, works: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    name = f"dies_{times}_times"
    (tmp_path / f"{name}.py").write_text(DIES.format(times=times))
    monkeypatch.syspath_prepend(tmp_path)
    with WorkerPool(1, seconds=600, preload=[name]) as pool:
        call = pool.submit(pow, 2, 5)
        if works:
            assert call.result(timeout=LIMIT) == 32
            return
        assert isinstance(call.exception(timeout=LIMIT), WorkerStartError)
        with pytest.raises(WorkerStartError):
            pool.submit(pow, 2, 5)


@pytest.mark.skipif(os.name == "nt", reason="there is no process from which others are forked")
def test_a_killed_server_of_forks_is_started_again() -> None:
    with WorkerPool(2, seconds=600) as pool:
        assert pool.submit(pow, 2, 3).result(timeout=LIMIT) == 8
        kill_server()
        assert isinstance(pool.submit(die).exception(timeout=LIMIT), WorkerLostError)
        assert [pool.submit(pow, 2, k).result(timeout=LIMIT) for k in range(4)] == [1, 2, 4, 8]


def test_workers_do_not_import_from_the_current_folder(tmp_path: Path) -> None:
    """A folder of fonts named as a package is, ``fs``, or somebody's ``numba.py``, is not a module."""
    (tmp_path / "fs").mkdir()
    (tmp_path / "numba.py").write_text("raise SystemExit('imported')")
    code = (
        "from glyphspline.runs.pool import WorkerPool\n"
        "if __name__ == '__main__':\n"
        "    pool = WorkerPool(1, 60.0, ['glyphspline.runs.worker'])\n"
        "    print(pool.submit(len, 'abc').result(600))\n"
        "    pool.shutdown()\n"
    )
    root = ROOT
    (tmp_path / "script").mkdir()
    (tmp_path / "script" / "run.py").write_text(code)
    done = subprocess.run(
        [sys.executable, "script/run.py"], cwd=tmp_path, capture_output=True, text=True, check=False,
        env=os.environ | {"PYTHONPATH": str(root)}, timeout=LIMIT,
    )  # fmt: skip
    assert (done.stdout, done.stderr) == ("3\n", "")


@pytest.mark.skipif(os.name == "nt", reason="there is no timer that ends a process")
def test_a_hung_process_whose_owner_was_killed_ends_itself(tmp_path: Path) -> None:
    script = tmp_path / "killed.py"
    script.write_text(
        "import os, signal, sys, time\n"
        "from glyphspline.runs import pool as pools\n"
        "def shorten():\n"
        "    pools._limit = 1.0\n"
        "    return os.getpid()\n"
        "def hang():\n"
        "    open(sys.argv[1], 'w').close()\n"
        "    time.sleep(600)\n"
        "if __name__ == '__main__':\n"
        "    pool = pools.WorkerPool(1, 600.0)\n"
        "    print(pool.submit(shorten).result(600), flush=True)\n"
        "    pool.submit(hang)\n"
        "    while not os.path.exists(sys.argv[1]):\n"
        "        time.sleep(0.01)\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    with open(tmp_path / "hung", "wb") as process:  # a pipe would stay open in the hung process
        subprocess.run(
            [sys.executable, str(script), str(tmp_path / "hangs")], stdout=process, check=False, timeout=LIMIT,
            env=os.environ | {"PYTHONPATH": str(ROOT)},
        )  # fmt: skip
    hung, until = int((tmp_path / "hung").read_text()), time.monotonic() + LIMIT
    while is_there(hung) and time.monotonic() < until:
        time.sleep(0.1)
    assert not is_there(hung)


def is_there(process: int) -> bool:
    """Whether it runs; one that has ended may wait for somebody to ask how."""
    asked = subprocess.run(["ps", "-o", "stat=", "-p", str(process)], capture_output=True, text=True, check=False)
    return asked.stdout.strip()[:1] not in ("", "Z")


@pytest.mark.skipif(os.name == "nt", reason="processes that are spawned get the parent's path")
def test_workers_with_other_code_are_an_error(tmp_path: Path) -> None:
    package = tmp_path / "elsewhere" / "glyphspline"
    for file in (
        "__init__.py",
        "__init__.pyi",
        "_version.py",
        "errors.py",
        "hooks.py",
        "code_files.py",
        "runs/__init__.py",
        "runs/pool.py",
    ):
        (package / file).parent.mkdir(parents=True, exist_ok=True)
        (package / file).write_bytes((ROOT / "glyphspline" / file).read_bytes())
    program = (
        f"import sys; sys.path.insert(0, {str(package.parent)!r})\n"
        "from glyphspline.runs.pool import WorkerPool, WorkerStartError\n"
        'code = \'__import__("sys").modules["glyphspline.runs.pool"].__file__\'\n'
        "with WorkerPool(1, 600.0) as pool:\n"
        "    try: print('worker', pool.submit(eval, code).result())\n"
        "    except WorkerStartError as error: print(error)\n"
    )
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=environment)
    code = f"{package}/runs/pool.py"  # later versions of Python hand the parent's path on
    assert ran.stdout in (f"worker {code}\n", f"workers run other code, {ROOT}/glyphspline/runs/pool.py, not {code}: "
                          "set PYTHONPATH to its folder\n"), ran.stderr  # fmt: skip
