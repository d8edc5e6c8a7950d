"""What the process that hands out a run's glyphs and the workers exchange."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from ..outlines.outline import FontMetrics
from .entry import journal_line, manifest_line
from .spec import RunSpec
from .summary import NO_FACTS, Facts


@dataclass(frozen=True)
class Job:
    """What a worker needs to know of a run: how to open the source, and what to do with its glyphs.

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
    """One glyph, finished.

    Attributes:
        line: its line of the journal. seconds: its share of the time that its batch took.
        facts: of its measures, for the summary. row: of the gallery's table; "" where it is still to be made.
    """

    gid: int
    name: str
    status: str
    line: bytes
    seconds: float
    facts: Facts
    row: str


def failed(task: Task, error: str, seconds: float = 0.0) -> Done:
    """A glyph that could not be converted, or whose worker was lost."""
    line = manifest_line(task.name, task.gid, task.unicodes, None, "failed", "", "", error)
    return Done(task.gid, task.name, "failed", journal_line((), line), seconds, NO_FACTS, "")


def finished(
    task: Task, status: str, line: str, sizes: Sequence[int], seconds: float, facts: Facts, row: str
) -> Done:  # fmt: skip
    """A glyph that was converted: ``line`` of the manifest, and the sizes of its files."""
    return Done(task.gid, task.name, status, journal_line(sizes, line), seconds, facts, row)
