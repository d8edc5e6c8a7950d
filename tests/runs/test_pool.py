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

from glyphspline.runs.pool import TimeLimitError, WorkerLostError, WorkerPool, sign_of_life
from tests.places import ROOT

LIMIT = 5.0
"""Seconds without a sign of life. A loaded machine may take one of them to start a process."""


def die(after: float) -> None:
    time.sleep(after)
    os.kill(os.getpid(), signal.SIGKILL)


def parts(number: int, each: float) -> int:
    for _ in range(number):
        sign_of_life()
        time.sleep(each)
    return number


def has_imported(name: str) -> bool:
    return name in sys.modules


@pytest.fixture(scope="module")
def pool() -> Iterator[WorkerPool]:
    with WorkerPool(2, seconds=LIMIT) as made:
        yield made


def test_results_and_errors_come_back(pool: WorkerPool) -> None:
    futures = [pool.submit(pow, 2, k) for k in range(100)]
    assert [future.result(timeout=60) for future in futures] == [2**k for k in range(100)]
    assert isinstance(pool.submit(pow, "a", 1).exception(timeout=60), TypeError)


def test_a_dead_worker_costs_one_call_and_is_replaced(pool: WorkerPool) -> None:
    lost = pool.submit(die, 0.05)
    kept = [pool.submit(pow, 3, k) for k in range(20)]
    assert isinstance(lost.exception(timeout=60), WorkerLostError)
    assert [future.result(timeout=60) for future in kept] == [3**k for k in range(20)]
    assert len({pool.submit(os.getpid).result(timeout=60) for _ in range(8)}) <= 2


@pytest.mark.parametrize(("call", "limit"), [(die, WorkerLostError), (time.sleep, TimeLimitError)])
def test_what_a_lost_worker_had_ahead_is_done_by_another(call: Callable[[float], None], limit: type[Exception]) -> None:
    with WorkerPool(1, seconds=LIMIT) as pool:
        first = pool.submit(os.getpid)
        lost, kept = pool.submit(call, 0.1 if call is die else 600), [pool.submit(pow, 5, k) for k in range(6)]
        last = pool.submit(os.getpid)
        assert isinstance(lost.exception(timeout=60), limit)
        assert [future.result(timeout=60) for future in kept] == [5**k for k in range(6)]
        assert first.result(timeout=60) != last.result(timeout=60)


def test_calls_too_large_for_a_pipe_are_not_handed_out_ahead() -> None:
    with WorkerPool(1, seconds=600) as pool:
        futures = [pool.submit(len, b"x" * 3_000_000) for _ in range(6)]
        assert [future.result(timeout=60) for future in futures] == [3_000_000] * 6


def test_a_hung_worker_is_killed_and_others_go_on(pool: WorkerPool) -> None:
    started = time.monotonic()
    hung, quick = pool.submit(time.sleep, 600), pool.submit(pow, 2, 2)
    assert quick.result(timeout=60) == 4
    assert isinstance(hung.exception(timeout=60), TimeLimitError)
    assert LIMIT <= time.monotonic() - started < 60
    assert pool.submit(pow, 2, 3).result(timeout=60) == 8


def test_the_limit_is_for_each_part_of_a_long_call(pool: WorkerPool) -> None:
    assert pool.submit(parts, 4, 0.4 * LIMIT).result(timeout=60) == 4


def test_closing_ends_what_is_running_and_queued() -> None:
    with WorkerPool(1, seconds=600) as pool:
        futures = [pool.submit(time.sleep, 600) for _ in range(3)]
        time.sleep(0.1)
    assert not wait(futures, timeout=60).not_done
    assert all(future.exception() is not None for future in futures)


def test_a_worker_has_imported_what_it_needs_before_its_time_counts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "slow_to_import.py").write_text("import time\ntime.sleep(1.2 * 5.0)\nREADY = True\n")
    monkeypatch.syspath_prepend(tmp_path)
    with WorkerPool(1, seconds=LIMIT, preload=["slow_to_import"]) as pool:  # the server of forks is there already
        assert pool.submit(has_imported, "slow_to_import").result(timeout=60) is True


def test_workers_do_not_import_from_the_current_folder(tmp_path: Path) -> None:
    """A folder of fonts named as a package is, ``fs``, or somebody's ``numba.py``, is not a module."""
    (tmp_path / "fs").mkdir()
    (tmp_path / "numba.py").write_text("raise SystemExit('imported')")
    code = (
        "from glyphspline.runs.pool import WorkerPool\n"
        "if __name__ == '__main__':\n"
        "    pool = WorkerPool(1, 60.0, ['glyphspline.runs.worker'])\n"
        "    print(pool.submit(len, 'abc').result(100))\n"
        "    pool.shutdown()\n"
    )
    root = ROOT
    (tmp_path / "script").mkdir()
    (tmp_path / "script" / "run.py").write_text(code)
    done = subprocess.run(
        [sys.executable, "script/run.py"], cwd=tmp_path, capture_output=True, text=True, check=False,
        env=os.environ | {"PYTHONPATH": str(root)}, timeout=120,
    )  # fmt: skip
    assert (done.stdout, done.stderr) == ("3\n", "")


@pytest.mark.skipif(os.name == "nt", reason="there is no timer that ends a process")
def test_a_hung_process_whose_owner_was_killed_ends_itself(tmp_path: Path) -> None:
    script = tmp_path / "killed.py"
    script.write_text(
        "import os, signal, time\n"
        "from glyphspline.runs.pool import WorkerPool\n"
        "if __name__ == '__main__':\n"
        "    pool = WorkerPool(1, 2.0)\n"
        "    print(pool.submit(os.getpid).result(60), flush=True)\n"
        "    pool.submit(time.sleep, 600)\n"
        "    time.sleep(0.5)\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    with open(tmp_path / "hung", "wb") as said:  # the end of a pipe would be that of the hung process
        subprocess.run(
            [sys.executable, str(script)], stdout=said, check=False, timeout=120,
            env=os.environ | {"PYTHONPATH": str(ROOT)},
        )  # fmt: skip
    hung, until = int((tmp_path / "hung").read_text()), time.monotonic() + 60
    assert is_there(hung)
    while is_there(hung) and time.monotonic() < until:
        time.sleep(0.1)
    assert not is_there(hung)


def is_there(process: int) -> bool:
    """Whether it runs; one that has ended may wait for somebody to ask how."""
    asked = subprocess.run(["ps", "-o", "stat=", "-p", str(process)], capture_output=True, text=True, check=False)
    return asked.stdout.strip()[:1] not in ("", "Z")
