"""The engine of runs: batches, order, errors, and what an observer sees."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import pytest

from glyphspline.errors import GlyphsplineError, OutputError
from glyphspline.runs.engine import Item, Job, run, work
from glyphspline.runs.schedule import InProcess


@dataclass(frozen=True)
class Squares(Job[int, list[Any]]):
    """Numbers squared; those of ``broken`` cannot be, nor those of ``unread`` read."""

    broken: tuple[int, ...] = ()
    unread: tuple[int, ...] = ()
    error: type[Exception] = ZeroDivisionError

    chunk = 5
    budget = 10.0

    def read(self, tasks: Sequence[int]) -> list[Item | Exception]:
        return [GlyphsplineError("unread") if n in self.unread else Item(n, 5.0, n >= 100) for n in tasks]

    def together(self, tasks: Sequence[int], contents: Sequence[int]) -> list[Any]:
        if {*tasks} & {*self.broken}:
            raise self.error("of all things")
        return [n * n for n in contents]

    def failed(self, task: int, error: Exception) -> list[Any]:
        return [(task, str(error))]

    def failures(self, result: list[Any]) -> int:
        return sum(isinstance(each, tuple) for each in result)


def test_batches_are_bounded_and_of_one_kind() -> None:
    parts = work(Squares(unread=(4,)), [1, 2, 3, 4, 5, 100, 101])
    assert [[*part.tasks] for part in parts] == [[1, 2], [3], [4], [5], [100, 101]]


@pytest.mark.parametrize("ordered", [False, True])
def test_a_task_that_fails_costs_only_itself(ordered: bool) -> None:
    seen: list[tuple[int, int, int]] = []
    job = Squares(broken=(4,), unread=(7,))
    parts = list(run(job, range(200), InProcess(), ordered=ordered, before=3, observer=lambda *n: seen.append(n)))
    assert [task for part in parts for task in part.tasks] == list(range(200))
    results = [each for part in parts for each in part.result]
    assert [each for each in results if isinstance(each, tuple)] == [(4, "of all things"), (7, "unread")]
    assert results[:4] == [0, 1, 4, 9]
    assert seen[-1] == (203, 203, 2)


def test_a_folder_that_cannot_be_written_ends_the_run() -> None:
    with pytest.raises(OutputError):
        list(run(Squares(broken=(4,), error=OutputError), range(20), InProcess()))
