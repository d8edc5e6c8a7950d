"""How commands end, and what they write on standard error: lines, warnings of libraries, progress, expected errors."""

from __future__ import annotations

import json
import logging
import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any, NoReturn

import typer

from ..code_files import QUIET
from ..errors import GlyphsplineError, words_of
from ..files import make_place, writing

DONE, UNDONE, UNUSABLE, INTERRUPTED = 0, 1, 2, 130

RULE = (
    f"Exit status: {DONE} all was done; {UNDONE} something asked for was not: a glyph failed, a character is missing, "
    f"a result is not within its tolerance, one of several fonts cannot be read, or check -e and diff find what they "
    f"look for; {UNUSABLE} the call or the font is unusable; {INTERRUPTED} Ctrl-C."
)
"""The exit status, one rule for all commands, as the help says it."""

INTERRUPTION = "interrupted; the same command goes on from here"

STDOUT = Path("-")
"""Stands for standard output."""


@contextmanager
def errors(quiet: bool) -> Iterator[None]:
    """Print an expected error as one line on standard error, and exit: unusable. ``quiet``: compile silently."""
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
        say(INTERRUPTION)
        raise typer.Exit(INTERRUPTED) from None
    finally:
        os.environ.pop(QUIET, None)


def say(line: str) -> None:
    """Print a line on standard error. What fonts have in names does not move the cursor."""
    typer.echo(printable(line), err=True)


def print_json(facts: Any) -> None:
    """Print JSON data on standard output."""
    typer.echo(json.dumps(facts, indent=1, ensure_ascii=False))


def put(path: Path, content: str | bytes) -> None:
    """Write a file, or standard output.

    Raises:
        OutputError: the file cannot be written.
    """
    if path == STDOUT:
        typer.echo(content, nl=isinstance(content, str) and not content.endswith("\n"))
        return
    make_place(path)
    with writing(path):
        path.write_bytes(content.encode(errors="replace") if isinstance(content, str) else content)  # of paths


class Logged(logging.Handler):
    """Prints what this package and fontTools log, each sentence once."""

    def __init__(self, level: int) -> None:
        super().__init__(level)
        self._say = cache(say)

    def emit(self, record: logging.LogRecord) -> None:
        """Print a record as a line on standard error."""
        self._say(f"{record.name.partition('.')[0]}: {record.getMessage()}")


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


EVERY = 15.0
"""Seconds between two lines about how far a run is, off a terminal."""


@contextmanager
def progress(quiet: bool, *, json_lines: bool = False) -> Iterator[Any]:
    """Show a bar of glyphs on standard error if that is a terminal, or else a line every few seconds.

    It is moved by what is yielded, called with the numbers done, of all, and failed; None if ``quiet``. With
    ``json_lines`` these are JSON lines instead, one a second at most.
    """
    last = 0.0 if json_lines else time.monotonic()

    def log(done: int, total: int, failed: int = 0) -> None:
        nonlocal last
        if time.monotonic() - last >= (1 if json_lines else EVERY) or (json_lines and done == total):
            last = time.monotonic()
            say(json.dumps({"done": done, "total": total, "failed": failed}) if json_lines else f"{done} of {total}")

    if json_lines or quiet or not sys.stderr.isatty():
        yield log if json_lines or not quiet else None
        return
    from rich import progress as rich
    from rich.console import Console

    columns = (
        rich.BarColumn(), rich.MofNCompleteColumn(), "{task.fields[rate]:.0f}/s", rich.TimeRemainingColumn(),
        "{task.fields[failed]} failed",
    )  # fmt: skip
    bar = rich.Progress(*columns, console=Console(stderr=True), transient=True)
    task = bar.add_task("", total=None, rate=0.0, failed=0)

    def observe(done: int, total: int, failed: int = 0) -> None:
        bar.start()  # not before: it would run over lines about compiling
        bar.update(task, completed=done, total=total or None, failed=failed, rate=bar.tasks[0].speed or 0.0)

    try:
        yield observe
    finally:
        bar.stop()


def watch_interruption() -> None:
    """End this process soon after SIGINT, from a thread that nothing holds up. For the main thread to call.

    Python acts on a signal between two of its own steps, and one step of the compiler may take half a minute.
    """
    ours, theirs = socket.socketpair()
    theirs.setblocking(False)
    signal.set_wakeup_fd(theirs.fileno(), warn_on_full_buffer=False)
    threading.Thread(target=_wait, args=(ours, theirs), daemon=True).start()


def _wait(ours: socket.socket, theirs: socket.socket) -> None:
    while ours.recv(1) != bytes([signal.SIGINT]):
        pass
    time.sleep(0.6)  # in which a command may end in its own way, with what it has done so far written down
    end()


def end() -> None:
    """Kill the worker processes, remove the copy of standard input, make the terminal usable, say so and exit."""
    with suppress(Exception):
        if "glyphspline.runs.pool" in sys.modules:
            from ..runs.pool import kill_all

            kill_all()
        if "glyphspline.readers.open" in sys.modules:
            from ..readers.open import forget_standard_input

            forget_standard_input()
    with suppress(Exception):
        if sys.stderr.isatty():
            sys.stderr.write("\r\x1b[K\x1b[?25h")  # an empty line, and the cursor, which a progress bar hides
        sys.stderr.write(f"{INTERRUPTION}\n")
        sys.stderr.flush()
    os._exit(INTERRUPTED)
