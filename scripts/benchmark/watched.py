"""Commands and the memory of their processes, as Linux says it.

The memory of a run is the proportional set size of its processes, summed, in which a page that n processes share counts
1/n for each. The memory of a process is the most it has had resident, shared pages included: what ``top`` shows.
"""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter, sleep
from typing import NamedTuple

PAUSE = 0.1
"""Seconds between two looks."""


class Watched(NamedTuple):
    """Seconds of a command, the most memory of all its processes together, and of the largest of them, in MB."""

    seconds: float
    total: float
    largest: float


def run_watched(command: Sequence[str]) -> Watched:
    """Run a command.

    Raises:
        CalledProcessError: it says that it failed.
    """
    total = largest = 0.0
    start = perf_counter()
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
        while process.poll() is None:
            pids = family(process.pid)
            total = max(total, sum(said(pid, "smaps_rollup", "Pss:") for pid in pids))
            largest = max(largest, *(said(pid, "status", "VmHWM:") for pid in pids))
            sleep(PAUSE)
        seconds = perf_counter() - start
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, list(command))
    return Watched(seconds, total, largest)


def family(pid: int) -> list[int]:
    """A process and its descendants."""
    try:
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    except OSError:  # it has ended
        children = []
    return [pid, *(each for child in children for each in family(int(child)))]


def said(pid: int, file: str, entry: str) -> float:
    """An entry of a process's file in MB; 0 of a process that has ended."""
    try:
        lines = Path(f"/proc/{pid}/{file}").read_text().splitlines()
    except OSError:
        return 0.0
    return sum(int(line.split()[1]) for line in lines if line.startswith(entry)) / 1e3
