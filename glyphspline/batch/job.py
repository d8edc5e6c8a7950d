"""What the process that hands out a run's glyphs and the workers tell each other."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from ..outlines.outline import FontMetrics
from ..report.data import CHUNK
from .entry import Told, journal_line, manifest_line, told_of
from .spec import RunSpec
from .summary import Facts


@dataclass(frozen=True)
class Job:
    """What a worker has to know of a run: the source by how it is opened, and what to do with its glyphs.

    ``static`` says that it is a font file, and does not vary.
    """

    path: Path
    face_index: int
    location: tuple[tuple[str, float], ...]
    out: Path
    spec: RunSpec
    metrics: FontMetrics
    static: bool
    curvature_scale: float | None = None


class Task(NamedTuple):
    """One glyph: its name, index and code points, its file name without suffix, and its place in the manifest."""

    gid: int
    name: str
    stem: str
    unicodes: tuple[int, ...]
    place: int


class Done(NamedTuple):
    """One glyph, finished: its line of the journal, as :mod:`.manifest` has them, and how long it took.

    What the line says is there a second time, short: ``row`` of the gallery's table as JSON, ``facts`` to be counted.
    """

    gid: int
    name: str
    status: str
    line: bytes
    seconds: float
    row: str
    facts: Facts


def page_of(tasks: Sequence[Task]) -> int | None:
    """The number of the gallery's page that shows just these glyphs, if one does."""
    first = tasks[0].place
    whole = len(tasks) == CHUNK and tasks[-1].place == first + CHUNK - 1 and first % CHUNK == 0
    return first // CHUNK if whole else None


def failed(task: Task, error: str, seconds: float = 0.0) -> Done:
    """A glyph that could not be converted, or that no worker lived to tell of."""
    return finished(task, "failed", None, "", (), "", error, seconds)


def finished(
    task: Task,
    status: str,
    advance: float | None,
    files: str,
    sizes: tuple[int, ...],
    contours: str,
    error: str | None,
    seconds: float,
    told: Told | None = None,
) -> Done:
    """What is told of a glyph; ``files`` and ``contours`` are JSON as its line has it, ``told`` what else is known."""
    line = manifest_line(task.name, task.gid, task.unicodes, advance, status, files, contours, error)
    row, facts = told or told_of(json.loads(line))
    return Done(task.gid, task.name, status, journal_line(sizes, line), seconds, row, facts)
