"""What a worker does: glyph after glyph from outline to files and a manifest line.

The font is opened by the first glyph that needs more of it than HarfBuzz draws.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache
from pathlib import Path

import numpy as np

from ..curves.curvature import Comb
from ..errors import GlyphsplineError
from ..fitting.convert import convert
from ..fitting.results import GlyphResult
from ..outlines.outline import Outline
from ..readers import Source, open_source
from ..readers.opentype.bulk_contours import BulkReader, read_chunk
from ..report.data import files_text, glyph_text, page_file, page_text
from ..report.drawings import Drawing, drawing, drawing_of
from ..writers.svg.curvature_map import combs, combs_of, to_curvature_svg
from ..writers.svg.document import to_svg
from ..writers.svg.source_drawing import to_source_svg
from .entry import known, measured, solved_texts, told_of_solved
from .files import write_whole
from .job import Done, Job, Task, failed, finished, page_of
from .lane import Drawn, draw_chunk, drawn_map, drawn_source, drawn_svg, source_texts, suits
from .pool import sign_of_life
from .spec import RESULTS, SUFFIXES, RunSpec
from .store import to_text


@lru_cache(maxsize=1)
def source_of(path: Path, face_index: int, location: tuple[tuple[str, float], ...]) -> Source:
    """The source, opened once a process; only one is kept, as a CJK face takes some 100 MB."""
    return open_source(path, face_index, dict(location))


@lru_cache(maxsize=1)
def bulk_reader(path: Path, face_index: int) -> BulkReader:
    """The short way's reader, made once a process."""
    return BulkReader(path, face_index)


def work(job: Job, tasks: Sequence[Task]) -> list[Done]:
    """Convert and write glyphs, the short way where there is one. A glyph that cannot be converted fails alone.

    Glyphs that are just a page of the gallery are written to it, too: now their drawings are in memory.

    Raises:
        OutputError: the output folder cannot be written to, which no other glyph would survive either.
    """
    each = draw_and_write(job, tasks) if short_way(job) else read_and_work(job, tasks)
    found, shown = [], []
    for done, glyph in each:
        found.append(done)
        shown.append(glyph)
        sign_of_life()
    page = page_of(tasks)
    if page is not None:
        write_whole(f"{job.out}/{page_file(page)}", page_text(shown))
    return found


def draw_and_write(job: Job, tasks: Sequence[Task]) -> Iterator[tuple[Done, bytes]]:
    """Glyphs the short way; those that it leaves, the long way."""
    started = time.perf_counter()
    drawn = draw(job, tasks)
    chunk = next((short.chunk for short in drawn if short is not None), None)
    lines = solved_texts(chunk.solved) if chunk is not None else []
    share = (time.perf_counter() - started) / len(tasks)
    folders = job.spec.folders
    for task, short in zip(tasks, drawn, strict=True):
        yield work_one(job, task) if short is None else write_drawn(job, folders, task, short, lines, share)


def read_and_work(job: Job, tasks: Sequence[Task]) -> Iterator[tuple[Done, bytes]]:
    """Glyphs the long way."""
    for task, outline in zip(tasks, outlines(job, tasks), strict=True):
        yield work_one(job, task, outline)


def short_way(job: Job) -> bool:
    """Whether a run's glyphs can be converted in compiled chunks: drawings of a font that does not vary."""
    return job.static and set(job.spec.folders) <= SHORT and suits(job.spec.options)


SHORT = {"source", "svg", "curvature"}
"""What the short way can write."""


def draw(job: Job, tasks: Sequence[Task]) -> list[Drawn | None]:
    """Glyphs the short way."""
    return draw_chunk(bulk_reader(job.path, job.face_index), [task.gid for task in tasks], job.spec.options)


def write_drawn(
    job: Job, folders: Sequence[str], task: Task, drawn: Drawn, lines: Sequence[str], seconds: float
) -> tuple[Done, bytes]:
    """Write what the short way has drawn; and the glyph as the gallery shows it. ``lines``: of its chunk's contours."""
    started = time.perf_counter()
    advance, (first, last) = drawn.advance, drawn.contours
    outline = Outline(task.name, task.gid, task.unicodes, advance, (), job.metrics)
    documents, shown = documents_of(job, folders, outline, drawn)
    files, sizes = write_documents(job, task, documents)
    contours = ",".join(lines[first:last])
    told = told_of_solved(task.name, task.gid, task.unicodes, advance, drawn.chunk.solved, first, last)
    seconds += time.perf_counter() - started
    done = finished(task, "ok", advance, files, sizes, contours, None, seconds, told)
    return done, glyph_text(shown, files, known(contours), None)


def write_documents(job: Job, task: Task, documents: Mapping[str, str | bytes]) -> tuple[str, tuple[int, ...]]:
    """Write a glyph's files: what they are called, as JSON, and their sizes."""
    files = {name: f"{name}/{task.stem}{SUFFIXES[name]}" for name in documents}
    sizes = [write_whole(f"{job.out}/{files[name]}", document) for name, document in documents.items()]
    return files_text(files), tuple(sizes)


def documents_of(job: Job, folders: Sequence[str], outline: Outline, drawn: Drawn) -> tuple[dict[str, bytes], Drawing]:
    """A glyph's files in the order of ``WRITERS``; of ``outline`` everything but its contours is needed."""
    documents, shown = {}, drawing(drawn.text)
    precision = job.spec.options.precision
    if "source" in folders:
        texts = source_texts(drawn, outline.metrics.units_per_em, precision)
        documents["source"] = drawn_source(outline, drawn, texts, precision)
        shown |= texts._asdict()
    if "svg" in folders:
        documents["svg"] = drawn_svg(outline, drawn, precision, job.spec.view_box)
    if "curvature" in folders:
        assert job.curvature_scale is not None
        documents["curvature"] = drawn_map(outline, drawn, job.curvature_scale)
    return documents, shown


def work_one(job: Job, task: Task, outline: Outline | None = None) -> tuple[Done, bytes]:
    """Convert and write one glyph; and the glyph as the gallery shows it. None: its outline is still to be read."""
    started = time.perf_counter()
    given = outline is not None
    try:
        outline = outline or outline_of(job, task)
        check_size(outline, job.spec)
        result = convert(outline, job.spec.fitting(outline.metrics.units_per_em))
        documents = {name: make(job, result) for name, make in writers(job).items()} if result.contours else {}
    except Exception as error:
        if given:  # the font's own reader knows better what is wrong
            return work_one(job, task)
        why = reason(error)
        return failed(task, why, time.perf_counter() - started), glyph_text(drawing(), "", "", why)
    files, sizes = write_documents(job, task, documents)
    contours = measured((contour.measures for contour in result.contours), job.spec.options)
    seconds = time.perf_counter() - started
    done = finished(task, "ok" if files else "empty", outline.advance, files, sizes, contours, None, seconds)
    texts = {name: document for name, document in documents.items() if isinstance(document, str)}
    return done, glyph_text(drawing_of(lambda kind: texts.get(kind, "")), files, contours, None)


def outline_of(job: Job, task: Task) -> Outline:
    """The glyph's outline, by the font's own reader."""
    return source_of(job.path, job.face_index, job.location).outline(task.name)


def outlines(job: Job, tasks: Sequence[Task]) -> list[Outline | None]:
    """What is read of glyphs in bulk; None where the font has to be opened for it."""
    if not job.static or job.spec.whole or not tasks:  # files of a whole font say what a glyph had beside its contours
        return [None] * len(tasks)
    found = read_chunk(bulk_reader(job.path, job.face_index), [task.gid for task in tasks])
    return [
        Outline(task.name, task.gid, task.unicodes, *glyph, job.metrics) if glyph is not None else None
        for task, glyph in zip(tasks, found, strict=True)
    ]


def check_size(outline: Outline, spec: RunSpec) -> None:
    """Refuse an outline that asks for more work than any real glyph does."""
    limits, options = spec.limits, spec.options
    segments = sum(len(contour) for contour in outline.contours)
    if segments > limits.segments:
        raise GlyphsplineError(f"{segments} segments, more than the {limits.segments} allowed")
    vertices = float(len(outline.contours) * (options.count or 0))
    if options.step is not None and options.step > 0:
        # The control polygon is at least as long as the contour.
        lengths = (np.hypot(*np.diff(c.points, axis=0, append=c.points[:1]).T).sum() for c in outline.contours)
        vertices = sum(lengths) / options.step
    if not vertices <= limits.vertices:
        raise GlyphsplineError(f"about {vertices:.3g} vertices, more than the {limits.vertices} allowed")


def reason(error: Exception) -> str:
    """What went wrong, without the file's path: a manifest does not tell where a font lay."""
    if isinstance(error, GlyphsplineError):
        return error.message if error.contour is None else f"contour {error.contour}: {error.message}"
    if isinstance(error, MemoryError):
        return "not enough memory"
    return f"{type(error).__name__}: {error}"


def writers(job: Job) -> dict[str, Callable[[Job, GlyphResult], str | bytes]]:
    """The writers of the formats asked for, in a fixed order."""
    folders = job.spec.folders
    return {name: writer for name, writer in WRITERS.items() if name in folders}


def _source(job: Job, result: GlyphResult) -> str:
    return to_source_svg(result)


def _svg(job: Job, result: GlyphResult) -> str:
    return to_svg(result, view_box=job.spec.view_box)


def _curvature(job: Job, result: GlyphResult) -> str:
    return to_curvature_svg(result, scale=job.curvature_scale)


def _png(job: Job, result: GlyphResult) -> bytes:
    from ..writers.figures.raster import to_png  # matplotlib, only when asked for

    return to_png(result, scale=job.curvature_scale)


def _pdf(job: Job, result: GlyphResult) -> bytes:
    from ..writers.figures.raster import to_pdf

    return to_pdf(result, scale=job.curvature_scale)


def _results(job: Job, result: GlyphResult) -> str:
    return to_text(result)


WRITERS: dict[str, Callable[[Job, GlyphResult], str | bytes]] = {
    "source": _source,
    "svg": _svg,
    "curvature": _curvature,
    "png": _png,
    "pdf": _pdf,
    RESULTS: _results,
}


def survey(job: Job, tasks: Sequence[Task]) -> list[Comb]:
    """Combs of a few glyphs, for the scale that all curvature maps of the run share; what fails is left out."""
    found: list[Comb] = []
    if short_way(job):
        drawn = draw(job, tasks)
        for short in drawn:
            found += combs_of(*short.curves, job.metrics.units_per_em) if short is not None else []
        tasks = [task for task, short in zip(tasks, drawn, strict=True) if short is None]
    for task, given in zip(tasks, outlines(job, tasks), strict=True):
        sign_of_life()
        try:
            outline = given or outline_of(job, task)
            check_size(outline, job.spec)
            found += combs(convert(outline, job.spec.fitting(outline.metrics.units_per_em)))
        except Exception:  # it will be reported when the glyph's own turn comes
            continue
    return found
