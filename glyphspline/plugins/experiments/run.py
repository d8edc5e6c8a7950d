"""Experiments on the glyphs of a face, in workers; an interrupted run goes on."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cache
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import GlyphsplineError
from ...files import remove_partials, write_whole
from ...outlines.outline import Outline
from ...readers import Source
from ...runs.convert import tasks_of
from ...runs.engine import Item, Job, Observer, reason
from ...runs.folder import Done, Output, Task, done, progress_of
from ...runs.schedule import Place, place_of, sources
from ...runs.spec import write_run
from ...types import FloatArray
from .polygons import read_clicked
from .spec import ExperimentSpec, variants_of

TIMES = "times.csv"
"""The only file of a run that is never the same twice: seconds that each curve took."""


@dataclass(frozen=True, kw_only=True)
class ExperimentJob(Output, Job[Task, list[Done]]):
    """Curves through the polygons of glyphs, measured, and the sheets of some of them drawn.

    Attributes:
        spec: an :class:`.ExperimentSpec`. clicked: polygons by glyph, if there are such. drawn: glyph indices.
    """

    spec: ExperimentSpec
    place: Place
    clicked: Mapping[str, Sequence[FloatArray]] | None
    drawn: frozenset[int]

    chunk = 20
    budget = 2000

    def read(self, tasks: Sequence[Task]) -> list[Item | Exception]:
        """Outlines; one that is too large is an error. What takes seconds has a time limit of its own."""
        from ...runs.worker import items

        warm_up()
        (source,) = sources(self.place)
        found = items(source.read([task.head for task in tasks]), None, self.spec.limits)
        return [
            item._replace(kind=head.gid)
            if isinstance(item, Item) and (self.spec.radii or head.gid in self.drawn)
            else item
            for item, (head, _) in zip(found, tasks, strict=True)
        ]

    def together(self, tasks: Sequence[Task], contents: Sequence[Any]) -> list[Done]:
        """One after the other: each curve is timed by itself."""
        return [self._one(task, outline) for task, outline in zip(tasks, contents, strict=True)]

    def _one(self, task: Task, outline: Outline) -> Done:
        """A glyph: its rows, and its sheet if it gets one."""
        from .api import experiment

        spec, points = self.spec, None
        if self.clicked is not None and (points := self.clicked.get(outline.name)) is None:
            return self.failed(task, GlyphsplineError("the file of clicked points has none of it"))[0]
        kinds: Any = spec.formats
        how: Any = {"count": spec.count, "step": spec.step, "polygons": points, "radii": spec.radii}
        try:
            made = experiment(outline, variants_of(spec.variants), **how)
        except GlyphsplineError as error:
            return self.failed(task, error)[0]
        files, sizes = dict[str, str](), []
        if task.head.gid in self.drawn and made.polygons:
            for kind, data in made.drawn(kinds, " ".join(self.font).strip()).items():
                files[kind] = f"{kind}/{task.stem}.{kind}"
                sizes.append(write_whole(f"{self.out}/{files[kind]}", data))
        entry = {
            "advance": outline.advance, "status": "ok" if made.polygons else "empty", "files": files,
            "contours": made.rows, "error": None,
        }  # fmt: skip
        seconds = [
            (outline.name, k, method, f"{curve.seconds:.6f}")
            for k, own in enumerate(made.curves) for method, curve in own.items()
        ]  # fmt: skip
        return done(task, entry, sizes, lambda _: lines_of(seconds))

    def failed(self, task: Task, error: Exception) -> list[Done]:
        """The line of a glyph that was not done."""
        entry: dict[str, Any]
        entry = {"advance": None, "status": "failed", "files": {}, "contours": (), "error": reason(error)}
        return [done(task, entry)]

    def failures(self, result: list[Done]) -> int:
        """Number of glyphs that failed."""
        return sum(glyph.status == "failed" for glyph in result)


@cache
def warm_up() -> None:
    """Put every method through a square once in a process: the first call of each would take longest."""
    from . import PEERS, VARIANTS
    from .methods import curve_through

    for method in (*VARIANTS, *PEERS):
        curve_through(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), method, 1e-6)


def lines_of(rows: Sequence[Sequence[Any]]) -> str:
    """Rows as CSV."""
    text = StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def experiment_face(
    source: Source,
    glyphs: Sequence[str],
    out: Path,
    spec: ExperimentSpec,
    executor: Executor,
    *,
    restart: bool = False,
    observer: Observer | None = None,
) -> None:
    """Experiments on glyphs of one face, into a folder: ``run.json``, ``manifest.jsonl``, sheets and times.

    An earlier run in the folder with the same options is continued.

    Args:
        source: the opened font. glyphs: names; the first ones get sheets. out: the folder. spec: what is done.
        executor: of the workers; it is not closed. restart: do it all anew. observer: called after each chunk.

    Raises:
        OutputError: as :func:`...runs.convert.convert_font`.
        GlyphsplineError: the file of clicked points cannot be read.
    """
    facts, clicked = spec.run_facts(source, glyphs), None
    if spec.clicked is not None:
        clicked = of_glyphs(source, read_clicked(spec.clicked))
    with progress_of(out, spec, facts, restart) as progress:
        drawn = frozenset(source.gids[name] for name in glyphs[: spec.sheets])
        tasks = tasks_of(source, glyphs, spec.names)
        left = [task for task in tasks if task.head.gid not in progress.finished]
        job = ExperimentJob(
            out.absolute(), spec=spec, font=(source.family, source.style), place=place_of(source), clicked=clicked,
            drawn=drawn,
        )  # fmt: skip
        write_run(out, facts)
        for _ in progress.advance(job, left, executor, observer):
            pass
        if left:
            known = {} if restart else times_of(out)
            for entry in progress.entries():
                known |= parsed(entry.row)
            rows = ((*key, seconds) for key, seconds in known.items())
            write_whole(str(out / TIMES), lines_of([HEADINGS, *rows]))
        progress.conclude()
        for name in spec.folders:
            remove_partials(out / name)


HEADINGS = ("glyph", "contour", "method", "seconds")


def parsed(text: str) -> dict[tuple[str, ...], str]:
    """Lines of times: seconds by glyph, contour and method."""
    return {(row[0], row[1], row[2]): row[3] for row in csv.reader(StringIO(text)) if len(row) == len(HEADINGS)}


def times_of(out: Path) -> dict[tuple[str, ...], str]:
    """The times of a folder's curves, as far as they are known."""
    path = out / TIMES
    found = parsed(path.read_text(encoding="utf-8")) if path.exists() else {}
    found.pop(HEADINGS[:3], None)
    return found


def of_glyphs(source: Source, clicked: Mapping[str, Sequence[FloatArray]]) -> dict[str, Sequence[FloatArray]]:
    """Clicked polygons by the names of glyphs, of those that the font has."""
    named = {key: [key] if key in source.gids else list(source.select(text=key)) for key in clicked}
    return {names[0]: clicked[key] for key, names in named.items() if len(names) == 1}
