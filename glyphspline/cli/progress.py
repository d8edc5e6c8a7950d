"""How far the work of a command is: a bar on a terminal, or JSON lines."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from .messages import say


@contextmanager
def json_lines() -> Iterator[Any]:
    """Progress as JSON lines on standard error, one a second at most."""
    last = 0.0

    def observe(done: int, total: int, failed: int) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= 1 or done == total:
            last = now
            say(json.dumps({"done": done, "total": total, "failed": failed}))

    yield observe


@contextmanager
def progress(quiet: bool, compiling: bool = False) -> Iterator[Any]:
    """A bar of glyphs, or of kinds of work that are compiled, on standard error, if that is a terminal.

    It is moved by what is yielded, called with the numbers done, of all, and failed; None where there is no bar.
    """
    if quiet or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )  # fmt: skip

    columns: list[Any] = [BarColumn(), MofNCompleteColumn()]
    if compiling:
        columns = [TextColumn("compiling"), *columns, TextColumn("kinds of work"), TimeElapsedColumn()]
    else:
        rate, failures = TextColumn("{task.fields[rate]:.0f}/s"), TextColumn("{task.fields[failed]} failed")
        columns += [rate, TimeRemainingColumn(), failures]
    bar = Progress(*columns, console=Console(stderr=True), transient=True)
    task = bar.add_task("", total=None, rate=0.0, failed=0)

    def observe(done: int, total: int, failed: int = 0) -> None:
        bar.start()  # not before: it would run over a line that says what is compiled
        bar.update(task, completed=done, total=total or None, failed=failed, rate=bar.tasks[0].speed or 0.0)

    try:
        if compiling:
            bar.start()
        yield observe
    finally:
        bar.stop()
