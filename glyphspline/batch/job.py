"""The messages between the process that schedules a run and its workers."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from ..outlines.outline import FontMetrics
from ..report.data import encoded
from .entry import journal_line, manifest_entry
from .spec import RunSpec
from .summary import NO_FACTS, Facts

Place = tuple[Path, int, tuple[tuple[str, float], ...]]
"""A file, a face and a location, as a worker opens them."""


@dataclass(frozen=True)
class Job:
    """A run as a worker needs it: how to open the source, and how to convert its glyphs.

    ``is_font`` says that the source is a font file, whose outlines are read in bulk.
    """

    path: Path
    face_index: int
    location: tuple[tuple[str, float], ...]
    out: Path
    spec: RunSpec
    metrics: FontMetrics
    is_font: bool
    curvature_scale: float | None = None


class Task(NamedTuple):
    """One glyph: its index, name, file name without suffix, and code points."""

    gid: int
    name: str
    stem: str
    unicodes: tuple[int, ...]


class Done(NamedTuple):
    """A finished glyph.

    Attributes:
        line: of the journal. seconds: its share of the time of its batch.
        facts: for the summary. row: of the gallery's table; "" if not made yet.
    """

    gid: int
    name: str
    status: str
    line: bytes
    seconds: float
    facts: Facts
    row: str


def failed(task: Task, error: str, seconds: float = 0.0) -> Done:
    """The message for a glyph that could not be converted, or whose worker was lost."""
    entry = manifest_entry(task.name, task.gid, task.unicodes, None, "failed", {}, (), error=error)
    return Done(task.gid, task.name, "failed", journal_line((), encoded(entry)), seconds, NO_FACTS, "")
