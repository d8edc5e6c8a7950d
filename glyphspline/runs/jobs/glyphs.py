"""A glyph of a run as a task, and when it is finished."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from ...report.data import encoded
from ..engine import reason
from ..entry import journal_line, manifest_entry
from ..places import Head, Side
from ..spec import RunSpec
from ..summary import NO_FACTS, Facts


class Task(NamedTuple):
    """One glyph: its index, name, file name without suffix, and code points."""

    gid: int
    name: str
    stem: str
    unicodes: tuple[int, ...]

    @property
    def head(self) -> Head:
        """What its outline is read by."""
        return self.name, self.gid, self.unicodes


class Done(NamedTuple):
    """A finished glyph.

    Attributes:
        line: of the journal. facts: for the summary. row: of the gallery's table; "" if not made yet.
    """

    gid: int
    name: str
    status: str
    line: bytes
    facts: Facts = NO_FACTS
    row: str = ""


@dataclass(frozen=True)
class Output:
    """What a worker needs to convert glyphs and write their files: the source, the folder, and how."""

    side: Side
    out: Path
    spec: RunSpec
    curvature_scale: float | None = None


def failed(task: Task, error: Exception) -> Done:
    """A glyph that could not be converted."""
    entry = manifest_entry(task.name, task.gid, task.unicodes, None, "failed", {}, (), error=reason(error))
    return Done(task.gid, task.name, "failed", journal_line((), encoded(entry)))
