"""What commands write on standard error: lines, warnings of libraries, progress, and expected errors."""

from __future__ import annotations

import json
import logging
import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NoReturn

import typer

from . import interruption
from .status import INTERRUPTED, UNUSABLE

QUIET = "GLYPHSPLINE_QUIET"
"""Environment variable that keeps processes from reporting that they compile, as in :mod:`..compiled`."""


@contextmanager
def errors(quiet: bool) -> Iterator[None]:
    """Print an expected error as one line on standard error, and exit: unusable. ``quiet``: compile silently."""
    from ..errors import GlyphsplineError, words_of

    if quiet:
        os.environ[QUIET] = "1"
    try:
        yield
    except BrokenPipeError:
        raise
    except (GlyphsplineError, OSError, UnicodeDecodeError) as error:
        name = getattr(error, "filename", None)
        stop(f"{name}: {words_of(error)}" if name else words_of(error))
    except MemoryError:
        stop("not enough memory")
    except KeyboardInterrupt:
        say(interruption.WORDS)
        raise typer.Exit(INTERRUPTED) from None
    finally:
        os.environ.pop(QUIET, None)


def say(line: str) -> None:
    """Print a line on standard error. What fonts have in names does not move the cursor."""
    typer.echo(printable(line), err=True)


def print_json(facts: Any) -> None:
    """Print JSON data on standard output."""
    typer.echo(json.dumps(facts, indent=1, ensure_ascii=False))


class Logged(logging.Handler):
    """Prints what this package and fontTools log, each sentence once."""

    def __init__(self, level: int) -> None:
        super().__init__(level)
        self._before: set[str] = set()

    def emit(self, record: logging.LogRecord) -> None:
        """Print a record as a line on standard error."""
        line = f"{record.name.partition('.')[0]}: {record.getMessage()}"
        if line not in self._before:
            self._before.add(line)
            say(line)


def listen(quiet: bool = False) -> None:
    """Print warnings of the libraries on standard error, or only their errors."""
    for name in ("glyphspline", "fontTools"):
        log = logging.getLogger(name)
        log.handlers[:] = [handler for handler in log.handlers if not isinstance(handler, Logged)]
        log.addHandler(Logged(logging.ERROR if quiet else logging.WARNING))


def stop(message: str) -> NoReturn:
    """Exit with a message: the call or the font is unusable."""
    say(f"glyphspline: {message}")
    raise typer.Exit(UNUSABLE)


def printable(text: str) -> str:
    """Text without characters that move a terminal's cursor or change its colours; fonts may have any in names."""
    return "".join(c if c.isprintable() or c == "\n" else "\N{REPLACEMENT CHARACTER}" for c in text)


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
    """Show a bar of glyphs, or of kinds of work that are compiled, on standard error if that is a terminal.

    It is moved by what is yielded, called with the numbers done, of all, and failed; None where there is no bar.
    """
    if quiet or not sys.stderr.isatty():
        yield None
        return
    from rich import progress as rich
    from rich.console import Console

    columns: list[Any] = [rich.BarColumn(), rich.MofNCompleteColumn()]
    if compiling:
        words = rich.TextColumn("compiling"), rich.TextColumn("kinds of work")
        columns = [words[0], *columns, words[1], rich.TimeElapsedColumn()]
    else:
        rate, failures = rich.TextColumn("{task.fields[rate]:.0f}/s"), rich.TextColumn("{task.fields[failed]} failed")
        columns += [rate, rich.TimeRemainingColumn(), failures]
    bar = rich.Progress(*columns, console=Console(stderr=True), transient=True)
    task = bar.add_task("", total=None, rate=0.0, failed=0)

    def observe(done: int, total: int, failed: int = 0) -> None:
        bar.start()  # not before: it would run over a line about compiling
        bar.update(task, completed=done, total=total or None, failed=failed, rate=bar.tasks[0].speed or 0.0)

    try:
        if compiling:
            bar.start()
        yield observe
    finally:
        bar.stop()
