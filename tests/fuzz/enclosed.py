"""Commands in processes of their own, forked from this one, with limits of time and memory; and which lines run."""

from __future__ import annotations

import contextlib
import gc
import os
import pickle
import resource
import signal
import sys
import tempfile
import traceback
from collections.abc import Sequence
from pathlib import Path
from types import CodeType
from typing import Any, NamedTuple, TypeAlias

import fontTools

import glyphspline
from glyphspline.cli.app import app
from glyphspline.interpolation.batch import _pool
from glyphspline.runs import schedule

SECONDS, WAITING, MEMORY = 60, 600, 3 << 30
"""Limits of a command: of processor time, of time, and of address space beyond that of this process."""

Lines: TypeAlias = set[tuple[str, int]]
"""Lines of source files."""


class Outcome(NamedTuple):
    """A command that has ended: its status or -signal, processor time, standard error, and lines that first ran."""

    status: int
    seconds: float
    errors: str
    lines: Lines


def enclosed(call: Sequence[str], here: Path, logs: Path, known: Lines) -> None:
    """Run a command in this process, just forked, which then ends."""
    status, lines, open_to = 70, Lines(), dict[CodeType, bool]()
    watched = tuple(str(Path(package.__file__ or "").parent) for package in (glyphspline, fontTools))

    def enter(frame: Any, _event: str, _argument: object) -> Any:
        code = frame.f_code
        if code not in open_to:
            its = {(code.co_filename, line) for _, _, line in code.co_lines()}
            open_to[code] = code.co_filename.startswith(watched) and not its <= known
        return step if open_to[code] else None

    def step(frame: Any, _event: str, _argument: object) -> Any:
        lines.add((frame.f_code.co_filename, frame.f_lineno))
        return step

    try:
        os.chdir(here)
        for number, name in ((1, "output"), (2, "errors")):
            os.dup2(os.open(logs / name, os.O_WRONLY | os.O_CREAT), number)
        tempfile.tempdir = str(logs / "tmp")
        space = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize() + MEMORY
        for limit, most in ((resource.RLIMIT_AS, space), (resource.RLIMIT_CPU, SECONDS), (resource.RLIMIT_CORE, 0)):
            resource.setrlimit(limit, (most, most + 5 if limit == resource.RLIMIT_CPU else most))
        signal.alarm(WAITING)
        sys.settrace(enter)
        app(list(call), prog_name="glyphspline")
        status = 0
    except SystemExit as end:
        status = int(end.code or 0)
    except BaseException:
        traceback.print_exc()
    finally:
        sys.settrace(None)
        sys.stdout.flush()
        (logs / "lines").write_bytes(pickle.dumps(lines - known))
        os._exit(status)


def ran(call: Sequence[str], here: Path, known: Lines) -> Outcome:
    """Run a command in a process of its own, in a folder, with a folder of temporary files beside it."""
    logs = here.with_name("logs")
    (logs / "tmp").mkdir(parents=True)
    sys.stdout.flush()
    child = os.fork()
    if not child:
        enclosed(call, here, logs, known)
    _, status, usage = os.wait4(child, 0)
    kept = logs / "lines"
    lines = pickle.loads(kept.read_bytes()) if kept.exists() else Lines()
    errors = (logs / "errors").read_text(errors="replace")
    return Outcome(os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime, errors, lines)


def warm(calls: Sequence[Sequence[str]]) -> None:
    """Run commands in this process: forked ones then have what these import and load. None of them starts workers."""
    schedule.workers = lambda *_, **__: schedule.InProcess()
    kept = [os.dup(number) for number in (1, 2)]
    with open(os.devnull, "w") as nothing:
        for number in (1, 2):
            os.dup2(nothing.fileno(), number)
        for call in calls:
            with contextlib.suppress(SystemExit):
                app(list(call), prog_name="glyphspline")
    for number, old in zip((1, 2), kept, strict=True):
        os.dup2(old, number)
    _pool.cache_clear()  # threads stay behind in a fork
    gc.collect()
    gc.freeze()
