"""A command in a session of its own, with the processor time and the memory that all its processes take."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

PAUSE = 0.05
"""Seconds between two looks at the processes."""


class Measured(NamedTuple):
    """What a command did.

    Attributes:
        status: of its end. out, said: standard output and error.
        seconds: of processor time, of all its processes. peak: bytes of memory of the process that had most.
    """

    status: int
    out: str
    said: str
    seconds: float
    peak: int


def measured(*arguments: str | Path, cwd: Path, limit: float = 900.0) -> Measured:
    """Run ``glyphspline`` with arguments; it is killed, which is an error, after so many seconds of wall clock."""
    call = [sys.executable, "-m", "glyphspline", *map(str, arguments)]
    with open(cwd / "stdout.txt", "w+b") as out, open(cwd / "stderr.txt", "w+b") as said:
        started = time.monotonic()
        process = subprocess.Popen(
            call, cwd=cwd, stdin=subprocess.DEVNULL, stdout=out, stderr=said, start_new_session=True
        )
        ticks, peaks = dict[int, int](), dict[int, int]()
        while process.poll() is None:
            for pid in members(process.pid):
                with suppress(OSError, ValueError):
                    now, peak = used(pid)
                    ticks[pid], peaks[pid] = now, max(peak, peaks.get(pid, 0))
            time.sleep(PAUSE)
            if time.monotonic() - started > limit:
                os.killpg(process.pid, signal.SIGKILL)
                raise AssertionError(f"{call} does not end")
        texts = []
        for file in (out, said):
            file.seek(0)
            texts.append(file.read().decode(errors="replace"))
    seconds = sum(ticks.values()) / os.sysconf("SC_CLK_TCK")
    return Measured(process.returncode, texts[0], texts[1], seconds, max(peaks.values(), default=0))


def members(session: int) -> list[int]:
    """The processes of a session."""
    found = []
    for name in os.listdir("/proc"):
        if name.isdigit():
            with suppress(OSError):
                if os.getsid(int(name)) == session:
                    found.append(int(name))
    return found


def used(pid: int) -> tuple[int, int]:
    """Ticks of processor time of a process so far, and the most memory that it has had."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    status = Path(f"/proc/{pid}/status").read_text()
    peak = status.partition("VmHWM:")[2].split()
    return int(fields[11]) + int(fields[12]), int(peak[0]) * 1024 if peak else 0
