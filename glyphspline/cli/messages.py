"""What commands say on standard error: lines, warnings of the libraries, and expected errors, which end the command."""

from __future__ import annotations

import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn

import typer

from . import interruption

QUIET = "GLYPHSPLINE_QUIET"
"""Environment variable that keeps processes from saying that they compile, as in :mod:`..compiled`."""


@contextmanager
def errors(quiet: bool = False, json_log: bool = False) -> Iterator[None]:
    """Print an expected error as one line on standard error and exit with status 2.

    Args:
        quiet, json_log: of the command: nothing is said of compiling then.
    """
    from ..errors import GlyphsplineError

    if quiet or json_log:
        os.environ[QUIET] = "1"
    try:
        yield
    except BrokenPipeError:
        raise
    except (GlyphsplineError, OSError, UnicodeDecodeError) as error:
        stop(str(error))
    except MemoryError:
        stop("not enough memory")
    except KeyboardInterrupt:
        say(interruption.WORDS)
        raise typer.Exit(interruption.STATUS) from None
    finally:
        os.environ.pop(QUIET, None)


def say(line: str) -> None:
    """Print a line on standard error. What fonts have in names does not move the cursor."""
    typer.echo(printable(line), err=True)


class Said(logging.Handler):
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
        log.handlers[:] = [handler for handler in log.handlers if not isinstance(handler, Said)]
        log.addHandler(Said(logging.ERROR if quiet else logging.WARNING))


def stop(message: str) -> NoReturn:
    """Exit with a message and status 2: the call or the font is unusable."""
    say(f"glyphspline: {message}")
    raise typer.Exit(2)


def printable(text: str) -> str:
    """Text without characters that move a terminal's cursor or change its colours; fonts may have any in names."""
    return "".join(c if c.isprintable() or c == "\n" else "\N{REPLACEMENT CHARACTER}" for c in text)
