"""Whether a run compiles before it works: it does where what is left to do would take longer as plain Python.

``costs.json`` has what decides, as ``scripts/benchmark/plain.py`` measures it: of each kind of work the seconds of
one processor that compiling it takes, and those of a unit of work, as plain Python and compiled. A unit is a segment of
a source's outline, or a vertex: see :class:`.engine.Item`. All are of one machine; others are slower or faster in all
of them alike.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from functools import cache
from math import inf
from pathlib import Path
from typing import NamedTuple

from ..code_files import is_off
from .warm import is_ready

SLOWNESS = 400.0
"""How many times as long plain Python may take as compiled code: time limits are multiplied by it."""

SAMPLE = 8
"""Number of tasks whose costs stand for those of all."""

LARGE, USUAL = 1000.0, 40.0
"""Units of a large glyph, and of a usual one."""


class Cost(NamedTuple):
    """Seconds of a kind of work: of compiling it, and of a unit of it, as plain Python and compiled."""

    compiling: float
    plain: float
    compiled: float


@cache
def costs() -> dict[str, Cost]:
    """By kind of work, see :func:`.small_runs.work`."""
    found = json.loads(Path(__file__).with_name("costs.json").read_text(encoding="utf-8"))
    return {kind: Cost(**values) for kind, values in found["kinds"].items()}


def least(kinds: Iterable[str], processes: int) -> float:
    """Units of work from which on compiling some kinds first takes less time than plain Python, if ever.

    A kind is compiled by one process, and work is done by all.
    """
    own = [costs()[kind] for kind in kinds if kind in costs()]  # a stranger's is not measured
    compiling = max(sum(one.compiling for one in own), processes * max(one.compiling for one in own))
    saved = sum(one.plain - one.compiled for one in own)
    return compiling / saved if saved > 0 else inf


@dataclass
class Choice:
    """What a pool's calls run as.

    Attributes:
        kinds: of work that comes. processes: number of them.
        compile: compiles these, and has later calls run so.
        sources: number of those, like the first, that tasks are of.
        is_plain: whether calls run as plain Python. is_made: whether it is decided.
    """

    kinds: Sequence[str]
    processes: int
    compile: Callable[[], None]
    sources: int = 1
    is_plain: bool = field(init=False)
    is_made: bool = False

    def __post_init__(self) -> None:
        self.is_plain = not is_ready(self.kinds)
        self.is_made = not self.is_plain or is_off()

    def is_clear(self, tasks: int) -> bool:
        """Whether compiling does not pay whatever so many tasks are."""
        return tasks * self.sources * LARGE < least(self.kinds, self.processes)

    def take(self, tasks: int, sample: Sequence[float]) -> None:
        """Compile if that first takes less time, by the units of some tasks."""
        mean = sum(sample) / max(1, len(sample))
        if tasks * self.sources * mean > least(self.kinds, self.processes):
            self.compile()
            self.is_plain = False


def choice_of(pool: Executor) -> Choice | None:
    """The choice of a pool; None: it has none, and calls run as they find it."""
    return getattr(pool, "choice", None)


def is_plain(pool: Executor) -> bool:
    """Whether a pool's calls run as plain Python."""
    choice = choice_of(pool)
    return choice is not None and choice.is_plain
