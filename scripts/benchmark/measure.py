"""Timing: every case in turn, round after round, so that whatever else the machine does falls on all alike."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from statistics import median
from time import perf_counter
from typing import Any


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
        passes = [limit is not None and (self.value >= limit) == self.more for limit in (self.aim, self.must)]
        return "aim" if passes[0] else "must" if passes[1] else "no"

    def as_json(self) -> dict[str, Any]:
        """For the file beside the table."""
        return {**asdict(self), "reached": self.reached()}


def interleaved(cases: dict[str, Callable[[], object]], rounds: int = 15, repeat: int = 1) -> dict[str, float]:
    """Median seconds a call of each case. Each is called once before, uncounted."""
    for case in cases.values():
        case()
    times: dict[str, list[float]] = {name: [] for name in cases}
    for _ in range(rounds):
        for name, case in cases.items():
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
