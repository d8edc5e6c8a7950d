"""A run that converts the glyphs of a font: the job, what is left to do, the curvature scale, manifest and gallery."""

from __future__ import annotations

import re
import shlex
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ..curves.curvature import Comb, shared_scale
from ..errors import OutputError
from ..extras import need
from ..files import remove_partials, writing
from ..fitting.results import GlyphResult, as_glyph
from ..readers import Selection, Source
from ..report import FOLDER as GALLERY
from ..report.gallery import is_whole, write_index, write_report
from ..types import Names
from ..writers.formats import format_named
from ..writers.svg.comb import combs
from .engine import Item, Job, Observer, choose_to_compile, reason, run
from .file_names import file_names
from .folder import (
    MANIFEST,
    Done,
    Output,
    Task,
    add_stored,
    done,
    entries_of,
    has_stored,
    progress_of,
    without_stored,
)
from .result_text import read_result
from .schedule import Place, heads_of, place_of, sources, workers
from .spec import MAPS, OF_RUNS, REQUEST, RESULTS, RunSpec, describe, read_run, write_run
from .summary import Summary
from .whole_formats import ResultsFormat

SCALE_SAMPLE = 200
"""Number of glyphs, evenly spread over those selected, from which the shared curvature scale is computed."""


@dataclass(frozen=True, kw_only=True)
class ConvertJob(Output, Job[Task, list[Done]]):
    """Glyphs converted, drawn and written to files, each with a line of the manifest."""

    place: Place

    budget = 40_000
    """Segments and vertices converted at once: some 40 glyphs of a CJK face."""

    def read(self, tasks: Sequence[Task]) -> list[Item | Exception]:
        """Outlines; one that is too large, or that a file of the run cannot have, is an error."""
        from .worker import items

        (source,) = sources(self.place)
        found = source.read([task.head for task in tasks])
        for whole in self.spec.whole:
            found = [each if isinstance(each, Exception) else whole.refused(each) or each for each in found]
        return items(found, self.spec.options, self.spec.limits)

    def together(self, tasks: Sequence[Task], contents: Sequence[Any]) -> list[Done]:
        """Convert outlines and write their files."""
        from .worker import convert_and_write

        made = zip(tasks, convert_and_write(self, tasks, contents), strict=True)
        return [one if isinstance(one, Done) else self.failed(task, one)[0] for task, one in made]

    def failed(self, task: Task, error: Exception) -> list[Done]:
        """The line of a glyph that could not be converted."""
        entry: dict[str, Any] = {
            "advance": None, "status": "failed", "files": {}, "deviation": None, "contours": (), "notes": (),
            "unread": (),
        }  # fmt: skip
        return [done(task, {**entry, "error": reason(error)})]

    def failures(self, result: list[Done]) -> int:
        """Number of glyphs that failed."""
        return sum(glyph.status == "failed" for glyph in result)


@dataclass(frozen=True)
class SurveyJob(Job[Task, list[Comb]]):
    """The combs of outlines, for a run's curvature scale; glyphs that fail are reported when they are converted.

    Chunks are small, so that a run over few glyphs uses all workers.
    """

    place: Place
    spec: RunSpec

    chunk = 4
    budget = 1.0

    read = ConvertJob.read

    def together(self, tasks: Sequence[Task], contents: Sequence[Any]) -> list[Comb]:
        """The combs of outlines."""
        return [comb for outline in contents for comb in combs(as_glyph(outline))]

    def failed(self, task: Task, error: Exception) -> list[Comb]:
        """None."""
        return []


def convert_font(
    source: Source,
    glyphs: Sequence[str],
    out: Path,
    spec: RunSpec | None = None,
    *,
    jobs: int | None = None,
    executor: Executor | None = None,
    restart: bool = False,
    observer: Observer | None = None,
) -> Summary:
    """Convert glyphs of one font into a folder: files for each glyph, ``run.json``, a manifest and a gallery.

    An earlier run in the folder with the same options is continued; its other glyphs remain.

    Args:
        source: the opened font; workers open it again by its path.
        glyphs: names, as :meth:`Source.select` gives them.
        out: the folder; it is created if it does not exist.
        spec: how to convert and what to write.
        jobs: worker processes; None takes all cores, 0 does everything in this process.
        executor: used instead of worker processes, such as a :class:`.cluster.ClusterExecutor`; it is not closed.
        restart: remove the files of an earlier run first.
        observer: called after each chunk of glyphs.

    Raises:
        OutputError: the folder cannot be written, another run writes to it, or it was made with other options and
            ``restart`` is not given.
        GlyphsplineError: the options are out of range.
    """
    started = time.perf_counter()
    spec = spec or RunSpec()
    require_libraries(spec)
    for whole in spec.whole:
        whole.check(source)
    table = spec.table.path(source, out) if spec.table else None
    with progress_of(out, spec, describe(source, spec, glyphs, None), restart, table) as progress:
        finished, summary = progress.finished, Summary()
        # Workers start while the tasks are listed; none do if all glyphs are finished.
        expected = len({*glyphs}.difference([source.glyph_names[gid] for gid in finished]))
        with workers(jobs if expected else 0, spec.limits.seconds, spec.kinds, expected, executor=executor) as pool:
            tasks = tasks_of(source, glyphs, spec.names, progress.stems)
            left = [task for task in tasks if task.head.gid not in finished]
            job = ConvertJob(out.absolute(), spec, font=(source.family, source.style), place=place_of(source))
            choose_to_compile(job, left, pool, len(left))  # before the scale, which is of a sample
            job = with_scale(job, source, glyphs, tasks, pool)
            for part in progress.advance(job, left, pool, observer):
                for glyph in part.result:
                    summary.time(part.seconds / len(part.tasks), glyph.name)
            for name in spec.folders if left else ():
                remove_partials(out / name)
        gallery = GALLERY in spec.formats
        is_changed = left or not progress.is_concluded
        if spec.table and table and (is_changed or not table.exists()):
            summary.remarks.append(f"{table.name}: {progress.write_table(spec.table, table)} contours")
        if is_changed or (gallery and not is_whole(out, len(progress.known))):
            progress.conclude(gallery, without_stored)
        files = [(each, each.path(source, out)) for each in spec.files]
        if not (left or not has_stored(out) or not all(path.exists() for _, path in files)):
            files = [(each, path) for each, path in files if each.always]
        if files:
            summary.remarks += write_font_files(source, out, spec, files)
        for entry in entries_of(out):
            summary.add(entry)
    summary.missing = getattr(glyphs, "missing", ())
    if not spec.options.is_fixed:
        each_its_em = spec.options.tolerance is None and source.each_its_em
        tolerance = spec.options.tolerance_for(1000.0 if each_its_em else source.metrics.units_per_em)
        summary.aim = f"{tolerance:.3g}{'/1000 em' if each_its_em else ' units'}"
    summary.seconds = time.perf_counter() - started
    return summary


def require_libraries(spec: RunSpec) -> None:
    """Raise a GlyphsplineError before the run starts if a library that it needs is not installed."""
    extras = [format_named(name).extra for name in spec.folders if name not in OF_RUNS]
    extras += [each.extra for each in spec.whole] + ["overlaps"] * spec.options.remove_overlaps
    for extra in filter(None, extras):
        need(extra)


def tasks_of(
    source: Source, glyphs: Sequence[str], names: Names = "glyph", stems: Mapping[int, str] = MappingProxyType({})
) -> list[Task]:
    """A task for each glyph, in glyph index order; ``stems`` are the names of files that are there, by glyph index."""
    heads = list(heads_of(source, glyphs).values())
    asked = glyphs.characters if isinstance(glyphs, Selection) else {}
    found = file_names(source.glyph_names, names, source.cmap, [head.gid for head in heads], asked, stems)
    return list(map(Task, heads, found))


def with_scale(job: ConvertJob, source: Source, glyphs: Sequence[str], tasks: list[Task], pool: Executor) -> ConvertJob:
    """The job with the run's curvature scale: from the folder's run.json, or computed now. Writes run.json."""
    old = read_run(job.out)
    if old is not None:
        job = replace(job, curvature_scale=old["curvature_scale"])
    elif (given := job.spec.maps.scale_for(source.metrics.units_per_em)) is not None:
        job = replace(job, curvature_scale=given)
    elif MAPS & set(job.spec.formats):
        chosen = tasks[:: -(-len(tasks) // SCALE_SAMPLE) or 1]
        found = run(SurveyJob(job.place, job.spec), chosen, pool, ordered=True)
        em = source.metrics.units_per_em
        scale = shared_scale((comb for part in found for comb in part.result), em) or 1 / em
        job = replace(job, curvature_scale=float(f"{scale:.6g}"))
    now = describe(source, job.spec, glyphs, job.curvature_scale)
    if old is None or any(old.get(name) != now[name] for name in REQUEST):
        write_run(job.out, now)
    return job


def write_gallery(folder: Path) -> None:
    """Write ``index.html`` for a run's folder, or for all runs in the folders below it.

    Raises:
        OutputError: there is no finished run, or one that cannot be read; or a run without the format "gallery". The
            message has the command that adds it.
    """
    is_one = (folder / MANIFEST).is_file()
    below = [folder] if is_one else sorted(path.parent for path in folder.glob(f"**/{MANIFEST}"))
    if not below:
        raise OutputError("holds no finished run, nor do the folders in it", font=str(folder))
    for path in below:
        made = read_run(path) or {}
        drawn: dict[str, str] = next((files for entry in entries_of(path) if (files := entry.get("files"))), {})
        if drawn and GALLERY not in drawn:
            words = re.sub(r" --format \S+", "", made.get("command", "glyphspline convert FONT"))
            words += (
                f" --format {','.join([*made.get('formats', drawn), GALLERY])} --out {shlex.quote(str(path))} --restart"
            )
            raise OutputError(f"was made without the format gallery; add it by: {words}", font=str(path))
        write_report(path, entries_of(path), made)
    if not is_one:
        write_index(folder, [path.relative_to(folder).as_posix() for path in below], f"{len(below)} fonts")


def write_font_files(
    source: Source, out: Path, spec: RunSpec, files: Sequence[tuple[ResultsFormat, Path]]
) -> list[str]:
    """Write the formats with one file a font, of all glyphs of the folder's manifest; returns remarks for the summary.

    Raises:
        OutputError: a file cannot be written, or a stored result cannot be read.
        GlyphsplineError: the source cannot become such a font.
    """
    remarks, held = [], dict[str, Mapping[str, Any]]()
    for whole, path in files:
        with writing(path):
            written, held[whole.name] = whole.write(source, results_of(source, out, spec), path, spec)
        remarks += written
    add_stored(out, held)
    return remarks


def results_of(source: Source, out: Path, spec: RunSpec) -> Iterator[GlyphResult]:
    """The results of a finished run in glyph index order, with empty glyphs and without failed ones."""
    for entry in entries_of(out):
        if entry["status"] == "empty":
            yield GlyphResult(source.outline(entry["glyph"]), spec.options, ())
        elif RESULTS in entry["files"]:
            yield read_result(out / RESULTS / Path(entry["files"][RESULTS]).name, GlyphResult)
