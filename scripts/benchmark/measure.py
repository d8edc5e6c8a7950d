"""Timing, memory and tables: cases are timed in turn, so that what else the machine does falls on all alike.

The memory of a run is the proportional set size of its processes, summed, in which a page that n processes share counts
1/n for each. The memory of a process is the most it has had resident, shared pages included: what ``top`` shows.
"""

from __future__ import annotations

import gc
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from time import perf_counter, sleep
from typing import NamedTuple, TypeVar

from ..survey import table

Name = TypeVar("Name")


@dataclass(frozen=True)
class Row:
    """A line of the table.

    Attributes:
        what: what was measured.
        value: the figure.
        unit: "x" for a ratio, above 1 where glyphspline is faster; else ms, us, ns.
        must: what it has to reach, aim: what is hoped for; None where nothing was set.
        more: whether more is better.
        note: the times themselves, in words.
    """

    what: str
    value: float
    unit: str = "x"
    must: float | None = None
    aim: float | None = None
    more: bool = True
    note: str = ""

    def reached(self) -> str:
        """In a word, whether the figure is what it has to be."""
        if self.must is None:
            return ""
        passes = [
            limit is not None and (self.value == limit or (self.value > limit) == self.more)
            for limit in (self.aim, self.must)
        ]
        return "aim" if passes[0] else "must" if passes[1] else "no"


def interleaved(
    cases: dict[Name, Callable[[], object]], rounds: int = 15, repeat: int = 1, *, warm: bool = True
) -> dict[Name, float]:
    """Median seconds a call of each case. With ``warm`` each is called once before, uncounted.

    What a case leaves behind is collected before the next one: geomdl's lists took the one after it a millisecond.
    """
    for case in cases.values() if warm else ():
        case()
    times: dict[Name, list[float]] = {name: [] for name in cases}
    for _ in range(rounds):
        for name, case in cases.items():
            gc.collect()
            start = perf_counter()
            for _ in range(repeat):
                case()
            times[name].append((perf_counter() - start) / repeat)
    return {name: median(values) for name, values in times.items()}


def in_words(seconds: float) -> str:
    """Three digits and a unit."""
    for factor, unit in ((1.0, "s"), (1e3, "ms"), (1e6, "us")):
        if seconds * factor >= 1:
            return f"{seconds * factor:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def ratio(what: str, theirs: float, ours: float, must: float | None = None, aim: float | None = None) -> Row:
    """How many times as fast ours is, with both times."""
    return Row(what, theirs / ours, "x", must, aim, note=f"{in_words(ours)}, {in_words(theirs)}")


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
            sleep(0.1)  # seconds between two looks
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


MARKERS = "<!-- benchmark {suite}: begin -->", "<!-- benchmark {suite}: end -->"


def markdown(found: list[Row]) -> str:
    """The table; ratios say how many times as fast glyphspline is."""
    rows = []
    for row in found:
        unit = "x" if row.unit == "x" else f" {row.unit}"
        limits = ["" if limit is None else f"{limit:g}{unit}" for limit in (row.must, row.aim)]
        value = f"{row.value:.0f}" if row.value >= 1000 else f"{row.value:.3g}"
        rows.append([row.what, f"{value}{unit}", *limits, row.reached(), row.note])
    return table(["what", "measured", "must", "aim", "reached", "times"], rows)


def write(suite: str, rows: list[Row], root: Path) -> None:
    """Put the table into docs/benchmarks.md, between the suite's markers."""
    begin, end = (marker.format(suite=suite) for marker in MARKERS)
    page = root / "docs" / "benchmarks.md"
    text = page.read_text(encoding="utf-8") if page.exists() else ""
    if begin in text and end in text:
        before, rest = text.split(begin, 1)
        after = rest.split(end, 1)[1]
        page.write_text(f"{before}{begin}\n{markdown(rows)}\n{end}{after}", encoding="utf-8")
