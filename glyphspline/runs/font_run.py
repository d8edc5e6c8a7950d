"""The steps of a run: remaining glyphs, the shared curvature scale, workers, manifest and gallery."""

from __future__ import annotations

import json
import time
from collections.abc import Collection, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

from ..curves.curvature import robust_scale
from ..errors import OutputError
from ..files import make_folder, remove_partials
from ..readers import Source
from ..readers.svg_drawings import SvgDrawings
from ..report.data import row_of
from ..report.gallery import Gallery, is_whole, remove_gallery
from ..report.gallery_files import FOLDER as GALLERY
from ..types import Names
from .engine import Job, Observer, Part, run
from .file_names import file_names
from .jobs.convert import ConvertJob
from .jobs.glyphs import Done, Task
from .jobs.survey import SurveyJob
from .lock import locked
from .manifest import JOURNAL, MANIFEST, SIZES, Journal, Note, Record, finish, read_record, remove_written
from .places import side_of
from .schedule import workers
from .spec import MAPS, REQUEST, RUN_FILE, RunSpec, describe, differences, read_run, write_run
from .summary import Summary, facts_of_entry
from .whole import check_possible, missing, write_fonts

SCALE_SAMPLE = 200
"""Number of glyphs, evenly spread over those selected, from which the shared curvature scale is computed."""


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
    check_possible(spec)
    with locked(out):
        summary = _convert(source, glyphs, out, spec, jobs, executor, restart, observer)
    summary.missing = getattr(glyphs, "missing", ())
    summary.aim = aim(source, spec)
    summary.seconds = time.perf_counter() - started
    return summary


def _convert(
    source: Source,
    glyphs: Sequence[str],
    out: Path,
    spec: RunSpec,
    jobs: int | None,
    executor: Executor | None,
    restart: bool,
    observer: Observer | None,
) -> Summary:
    """:func:`convert_font` in a folder that is there and locked."""
    record = prepare(source, glyphs, out, spec, restart)
    job = ConvertJob(side_of(source), out.absolute(), spec)
    finished = record.finished()
    summary = Summary()
    with nullcontext(executor) if executor else workers_for(source, glyphs, finished, spec, jobs) as pool:
        tasks = tasks_of(source, glyphs, spec.names)
        left = [task for task in tasks if task.gid not in finished]
        job = with_scale(job, source, glyphs, tasks, pool)
        for part in recorded(job, left, pool, record, out, observer):
            for glyph in part.result:
                summary.time(part.seconds / len(part.tasks), glyph.name)
        for name in spec.folders if left else ():
            remove_partials(out / name)
    gallery = GALLERY in spec.formats
    whole = (out / MANIFEST).exists() and not (out / JOURNAL).exists()
    if left or not whole or (gallery and not is_whole(out, len(record.where))):
        conclude(out, record, summary, gallery)
    else:
        summary = record.counts
    if left or missing(source, out, spec):
        summary.remarks += write_fonts(source, out, spec)
    return summary


def aim(source: Source, spec: RunSpec) -> str:
    """The tolerance in words; "" if there is none. Each drawing has an em of its own."""
    if spec.options.is_fixed:
        return ""
    if spec.options.tolerance is None and isinstance(source, SvgDrawings):
        return "1/1000 em"
    return f"{spec.options.tolerance_for(source.metrics.units_per_em):.3g} units"


def workers_for(
    source: Source, glyphs: Sequence[str], finished: Collection[int], spec: RunSpec, jobs: int | None
) -> Executor:
    """Workers, which start while the tasks are listed; none if all glyphs are finished."""
    expected = len({*glyphs}.difference([source.glyph_names[gid] for gid in finished]))
    return workers(jobs if expected else 0, spec.limits.seconds, spec.options, spec.formats, expected)


def prepare(
    source: Source,
    glyphs: Sequence[str],
    out: Path,
    spec: RunSpec,
    restart: bool,
    others: Sequence[Source] = (),
    axis: str | None = None,
) -> Record:
    """Make the folders, and read the record of an earlier run; see :func:`.spec.describe`."""
    old = None if restart else read_run(out)
    if old is not None:
        changed = differences(old, describe(source, spec, glyphs, None, others, axis))
        if changed:
            raise OutputError(
                "holds a run with other options; --restart does it anew:\n  " + "\n  ".join(changed), font=str(out)
            )
    else:
        remove_written(out)
        remove_gallery(out)
        for name in (MANIFEST, SIZES, JOURNAL, RUN_FILE):
            (out / name).unlink(missing_ok=True)
    for name in spec.folders:
        make_folder(out / name)
        remove_partials(out / name)
    remove_partials(out)
    return read_record(out) if old is not None else Record()


def tasks_of(source: Source, glyphs: Sequence[str], names: Names = "glyph") -> list[Task]:
    """A task for each glyph, in glyph index order."""
    stems = file_names(source.glyph_names, names, source.cmap)
    unicodes: dict[str, list[int]] = {name: [] for name in glyphs}
    for code, name in source.cmap.items():
        if name in unicodes:
            unicodes[name].append(code)
    chosen = [(gid, name) for gid, name in enumerate(source.glyph_names) if name in unicodes]
    return [Task(gid, name, stems[gid], tuple(sorted(unicodes[name]))) for gid, name in chosen]


def with_scale(job: ConvertJob, source: Source, glyphs: Sequence[str], tasks: list[Task], pool: Executor) -> ConvertJob:
    """The job with the run's curvature scale: from the folder's run.json, or computed now. Writes run.json."""
    old = read_run(job.out)
    if old is not None:
        now = describe(source, job.spec, glyphs, old["curvature_scale"])
        if any(old.get(name) != now[name] for name in REQUEST):
            write_run(job.out, now)
        return replace(job, curvature_scale=old["curvature_scale"])
    if MAPS & set(job.spec.formats):
        chosen = tasks[:: -(-len(tasks) // SCALE_SAMPLE) or 1]
        found = run(SurveyJob(job.side, job.spec), chosen, pool, ordered=True)
        scale = robust_scale([comb for part in found for comb in part.result]) or 1 / source.metrics.units_per_em
        job = replace(job, curvature_scale=float(f"{scale:.6g}"))
    write_run(job.out, describe(source, job.spec, glyphs, job.curvature_scale))
    return job


def recorded(
    job: Job[Task, list[Done]],
    tasks: Sequence[Task],
    pool: Executor,
    record: Record,
    out: Path,
    observer: Observer | None,
) -> Iterator[Part[Task, list[Done]]]:
    """Do tasks in a pool; each is in the journal once its files are written, so that an interrupted run goes on."""
    if not tasks:
        return
    journal = Journal(out, record)
    try:
        for part in run(job, tasks, pool, observer=observer, before=len(record.finished())):
            journal.add(part.result)
            yield part
    finally:
        journal.close()


def conclude(out: Path, record: Record, summary: Summary, with_gallery: bool) -> None:
    """Write the manifest with the gallery's page and tables, and count its glyphs in the summary."""
    gallery = Gallery(out) if with_gallery else None
    with finish(out, record) as lines:
        for gid, line in lines:
            name, status, row, facts = record.notes.get(gid) or _noted(line)
            summary.count(name, status, json.loads(line)["error"] if status == "failed" else None, facts)
            if gallery:
                gallery.add(row or row_of(json.loads(line)))
        if gallery:
            gallery.close(read_run(out) or {})


def _noted(line: bytes) -> Note:
    """The note on a glyph converted in an earlier run."""
    entry = json.loads(line)
    return entry["glyph"], entry["status"], "", facts_of_entry(entry)
