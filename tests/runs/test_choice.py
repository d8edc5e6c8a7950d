"""Whether a run compiles first: by its work, once, and before its tasks are done."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from glyphspline import code_files, hooks
from glyphspline.fitting.options import Options
from glyphspline.runs import choice as choices
from glyphspline.runs.choice import Choice, Cost, costs, least
from glyphspline.runs.engine import Item, Job, run
from glyphspline.runs.small_runs import work
from glyphspline.runs.spec import RunSpec, kinds_for

COSTS = {"a": Cost(100.0, 1.1, 0.1), "b": Cost(20.0, 0.6, 0.1), "c": Cost(10.0, 0.0, 0.0)}
"""Compiling a takes as long as 100 units as plain Python, and both as long as 80."""


@dataclass(frozen=True)
class Weights(Job[float, list[float]]):
    """Tasks that are their own costs."""

    def item(self, task: float) -> Item:
        return Item(task, task)

    def together(self, tasks: Sequence[float], contents: Sequence[Any]) -> list[float]:
        return list(tasks)

    def failed(self, task: float, error: Exception) -> list[float]:
        return []


class Pool(Executor):
    """Notes what it does, in order."""

    def __init__(self, kinds: Sequence[str], size: int = 1) -> None:
        self.done: list[Any] = []
        self._max_workers = size
        self.choice = Choice(kinds, size, lambda: self.done.append("compiled"))

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(fn(*args, **kwargs))
        self.done.append((fn.__name__, len(args[1])))
        return future


@pytest.fixture(autouse=True)
def nothing_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(choices, "costs", lambda: COSTS)
    monkeypatch.setattr(choices, "is_ready", lambda kinds: not kinds)
    monkeypatch.setattr(choices, "LARGE", 20.0)
    monkeypatch.delenv(code_files.OFF, raising=False)


@pytest.mark.parametrize(
    ("kinds", "size", "expected"),
    [(["a"], 1, 100.0), (["a", "b"], 1, 80.0), (["b"], 2, 80.0), (["a", "b"], 2, 133.33), (["c"], 1, np.inf)],
)
def test_the_least_work_that_repays_compiling(kinds: list[str], size: int, expected: float) -> None:
    """A kind is compiled by one process, while the work is shared by all."""
    assert least(kinds, size) == pytest.approx(expected, abs=0.01)


@pytest.mark.parametrize(("count", "sources", "compiles"), [(9, 1, False), (11, 1, True), (6, 2, True), (5, 2, False)])
def test_a_run_compiles_first_where_its_work_repays_it(count: int, sources: int, compiles: bool) -> None:
    pool = Pool(["a"])
    pool.choice.sources = sources
    parts = list(run(Weights(), [10.0] * count, pool))
    assert [task for part in parts for task in part.tasks] == [10.0] * count
    assert ("compiled" in pool.done[:2]) == ("compiled" in pool.done) == compiles
    assert pool.choice.is_plain != compiles
    assert {size for name, size in (one for one in pool.done if one != "compiled") if name == "work"} == {
        max(1, count // 8) if compiles else 1
    }


def test_few_tasks_are_not_even_looked_at() -> None:
    pool = Pool(["a"])
    list(run(Weights(), [1e9] * 4, pool))
    assert pool.done == [("work", 1)] * 4


def test_it_is_decided_once() -> None:
    pool = Pool(["a"])
    list(run(Weights(), [1.0] * 9, pool))
    list(run(Weights(), [1000.0] * 9, pool))
    assert "compiled" not in pool.done


def test_code_that_is_there_is_used_and_nothing_compiled_where_it_is_off(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not Pool([]).choice.is_plain
    monkeypatch.setenv(code_files.OFF, "1")
    pool = Pool(["a"])
    list(run(Weights(), [1000.0] * 9, pool))
    assert pool.choice.is_plain
    assert "compiled" not in pool.done


def test_the_costs_of_every_kind_of_work_are_known(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.undo()
    assert work().keys() == costs().keys() or (hooks.away() and work().keys() < costs().keys())
    for options in (Options(), Options(corners="smooth"), Options(step=9.0), Options(continuity="g2", effort="best")):
        assert 10 < least(kinds_for(options, RunSpec().formats), 2) < 1e6, "segments: a letter, and ten CJK faces"
