"""Whether commands that start worker processes always end, with all that they should have.

``python -m scripts.starts [--starts 2000] [--loaded 500] [--killed 100] [--jobs 4] [--seed 0]``

Each start is a ``convert`` with two workers in a folder of its own, several at a time. Of all starts some run beside
four busy processes for each core, and in some a worker, or the process from which workers are forked, is killed at a
random moment. A start is good if it ends in ten minutes, with status 0 and the same files as an undisturbed run. The
stacks of one that does not end are printed. The exit status is 1 if any start is not good. Linux alone.
"""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import NamedTuple

from .survey import ROOT, parser, table

FONT = ROOT / "fonts_test" / "edge-cases.ttf"
CONVERT = [sys.executable, "-X", "faulthandler", "-m", "glyphspline", "convert", str(FONT), "--all", "--step", "60"]
CONVERT += ["--format", "svg", "--quiet"]
PATIENCE = 600.0


class Start(NamedTuple):
    """A start: whether a process was killed in it, whether it ended, and with all files; its seconds; what it said."""

    killed: bool
    ended: bool
    whole: bool
    seconds: float
    words: str


def written(folder: Path) -> dict[str, bytes]:
    """The drawings and the manifest of a run."""
    return {str(f.relative_to(folder)): f.read_bytes() for f in folder.rglob("*") if f.suffix in (".svg", ".jsonl")}


def workers(parent: int) -> list[int]:
    """The process from which the workers of a command are forked, and the workers."""
    found: list[int] = []
    for child in Path(f"/proc/{parent}/task/{parent}/children").read_text().split():
        with suppress(OSError):
            if "forkserver" in Path(f"/proc/{child}/cmdline").read_text():
                found += [int(child), *workers(int(child))]
    return found


def start(seed: int, kills: bool, expected: dict[str, bytes], usual: float, number: int) -> Start:
    """Start a command, kill one of its workers if asked for, and look at what it has written."""
    rng = random.Random(f"{seed} {number}")
    with tempfile.TemporaryDirectory(prefix="starts-") as folder:
        began, killed, ended = time.monotonic(), False, True
        run = subprocess.Popen([*CONVERT, "--jobs", "2", "-o", f"{folder}/out"], stderr=subprocess.PIPE, text=True)
        if kills:
            time.sleep(rng.uniform(0, usual))
            while not killed and run.poll() is None:
                with suppress(OSError):
                    if those := workers(run.pid):
                        os.kill(rng.choice(those), signal.SIGKILL)
                        killed = True
                time.sleep(0.01)
        try:
            _, words = run.communicate(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            run.send_signal(signal.SIGABRT)  # has it print the stacks of its threads
            _, words = run.communicate()
            ended = False
        whole = ended and run.returncode == 0 and written(Path(folder) / "out") == expected
        return Start(killed, ended, whole, time.monotonic() - began, words)


@contextmanager
def load(processes: int) -> Iterator[None]:
    """Processes that are busy."""
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(processes)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait()


def main() -> int:
    """Start, and print what came of it."""
    arguments = parser(__doc__, starts=2000, loaded=500, killed=100, jobs=4, seed=0).parse_args()
    with tempfile.TemporaryDirectory() as folder:
        began = time.monotonic()
        subprocess.run([*CONVERT, "--jobs", "2", "-o", f"{folder}/out"], check=True)
        usual, expected = time.monotonic() - began, written(Path(folder) / "out")
    calm = arguments.starts - arguments.loaded - arguments.killed
    rows: list[list[object]] = []
    for words, count, busy, kills in (
        ("a process killed", arguments.killed, 0, True),
        ("alone", calm, 0, False),
        ("under load", arguments.loaded, 4 * (os.cpu_count() or 1), False),
    ):
        case, found = partial(start, arguments.seed, kills, expected, usual), []
        with load(busy), ThreadPoolExecutor(arguments.jobs) as threads:
            for one in threads.map(case, range(count)):
                found.append(one)
                if not one.whole:
                    print(f"{words}, {one.seconds:.0f} s, ended: {one.ended}: {one.words[-3000:]}", flush=True)
        sums = (sum(bool(one[k]) for one in found) for k in range(3))
        rows.append([words, count, *sums, f"{max((one.seconds for one in found), default=0.0):.0f} s"])
    print(table(["starts", "number", "killed in", "ended", "whole", "longest"], rows))
    return int(any(row[1] != row[4] for row in rows))


if __name__ == "__main__":
    sys.exit(main())
