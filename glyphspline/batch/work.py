"""What a worker does: open the font once, then glyph after glyph from outline to files and a manifest line."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from ..convert import convert
from ..curvature import Comb
from ..errors import GlyphsplineError
from ..express.lane import Drawn, draw_chunk, drawn_map, drawn_source, drawn_svg, suits
from ..express.reading import BulkReader
from ..glyph import GlyphResult
from ..outline import Outline
from ..readers import Font, Source, open_source
from ..writers.curvature_map import combs, combs_of, to_curvature_svg
from ..writers.source import to_source_svg
from ..writers.svg import to_svg
from .entry import contours_text, manifest_line, solved_text
from .files import write_whole
from .pool import sign_of_life
from .spec import RESULTS, SUFFIXES, RunSpec
from .store import to_text


@dataclass(frozen=True)
class Job:
    """What a worker has to know of a run: the source by how it is opened, and what to do with its glyphs."""

    path: Path
    face_index: int
    location: tuple[tuple[str, float], ...]
    out: Path
    spec: RunSpec
    curvature_scale: float | None = None


@dataclass(frozen=True)
class Task:
    """One glyph: its name and index, and its file name without suffix."""

    gid: int
    name: str
    stem: str


@dataclass(frozen=True)
class Done:
    """One glyph, finished: its manifest line, the sizes of its files in the line's order, and how long it took."""

    gid: int
    name: str
    status: str
    line: str
    sizes: tuple[int, ...]
    seconds: float


@lru_cache(maxsize=1)
def source_of(path: Path, face_index: int, location: tuple[tuple[str, float], ...]) -> Source:
    """The source, opened once a process; only one is kept, as a CJK face takes some 100 MB."""
    return open_source(path, face_index, dict(location))


@lru_cache(maxsize=1)
def unicodes_of(path: Path, face_index: int, location: tuple[tuple[str, float], ...]) -> dict[str, list[int]]:
    """The code points of each glyph that has any."""
    found: dict[str, list[int]] = {}
    for code, name in sorted(source_of(path, face_index, location).cmap.items()):
        found.setdefault(name, []).append(code)
    return found


@lru_cache(maxsize=1)
def bulk_reader(path: Path, face_index: int) -> BulkReader:
    """The short way's reader, made once a process."""
    return BulkReader(path, face_index)


def work(job: Job, tasks: Sequence[Task]) -> list[Done]:
    """Convert and write glyphs, the short way where there is one. A glyph that cannot be converted fails alone.

    Raises:
        OutputError: the output folder cannot be written to, which no other glyph would survive either.
    """
    found = []
    started = time.perf_counter()
    drawn = draw(job, tasks) if short_way(job) else [None] * len(tasks)
    share = (time.perf_counter() - started) / len(tasks)
    metrics = source_of(job.path, job.face_index, job.location).metrics
    unicodes = unicodes_of(job.path, job.face_index, job.location)
    for task, short in zip(tasks, drawn, strict=True):
        sign_of_life()
        if short is None:
            found.append(work_one(job, task))
        else:
            outline = Outline(task.name, task.gid, tuple(unicodes.get(task.name, ())), short.advance, (), metrics)
            found.append(write_drawn(job, task, outline, short, share))
    return found


def short_way(job: Job) -> bool:
    """Whether a run's glyphs can be converted in compiled chunks: drawings of a font that does not vary."""
    source = source_of(job.path, job.face_index, job.location)
    drawable = set(job.spec.folders) <= SHORT.keys()
    return drawable and suits(job.spec.options) and isinstance(source, Font) and not source.axes


def draw(job: Job, tasks: Sequence[Task]) -> list[Drawn | None]:
    """Convert glyphs the short way, all at once."""
    return draw_chunk(bulk_reader(job.path, job.face_index), [task.gid for task in tasks], job.spec.options)


def write_drawn(job: Job, task: Task, outline: Outline, drawn: Drawn, seconds: float) -> Done:
    """Write what the short way has drawn; of ``outline`` everything but its contours is needed."""
    started = time.perf_counter()
    files, sizes = {}, []
    folders = job.spec.folders
    for name in WRITERS:
        if name in folders:
            files[name] = f"{name}/{task.stem}{SUFFIXES[name]}"
            sizes.append(write_whole(f"{job.out}/{files[name]}", SHORT[name](job, outline, drawn)))
    contours = solved_text(drawn.solved)
    line = manifest_line(task.name, task.gid, outline.unicodes, outline.advance, "ok", files, contours)
    return Done(task.gid, task.name, "ok", line, tuple(sizes), seconds + time.perf_counter() - started)


def work_one(job: Job, task: Task) -> Done:
    """Convert and write one glyph."""
    started = time.perf_counter()
    files, written = {}, []
    try:
        outline = read(job, task)
        result = convert(outline, job.spec.fitting(outline.metrics.units_per_em))
        documents = {name: make(job, result) for name, make in writers(job).items()} if result.contours else {}
    except Exception as error:
        return failed(job, task, reason(error), time.perf_counter() - started)
    for name, document in documents.items():
        files[name] = f"{name}/{task.stem}{SUFFIXES[name]}"
        written.append(write_whole(f"{job.out}/{files[name]}", document))
    contours = contours_text((contour.measures for contour in result.contours), job.spec.options)
    status = "ok" if files else "empty"
    line = manifest_line(task.name, task.gid, outline.unicodes, outline.advance, status, files, contours)
    return Done(task.gid, task.name, status, line, tuple(written), time.perf_counter() - started)


def failed(job: Job, task: Task, error: str, seconds: float = 0.0) -> Done:
    """A glyph that could not be converted, or that no worker lived to tell of."""
    unicodes = unicodes_of(job.path, job.face_index, job.location).get(task.name, [])
    line = manifest_line(task.name, task.gid, unicodes, None, "failed", {}, "", error)
    return Done(task.gid, task.name, "failed", line, (), seconds)


def read(job: Job, task: Task) -> Outline:
    """The glyph's outline, if it is within the limits."""
    outline = source_of(job.path, job.face_index, job.location).outline(task.name)
    check_size(outline, job.spec)
    return outline


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
    return {name: writer for name, writer in WRITERS.items() if name in job.spec.folders}


def _source(job: Job, result: GlyphResult) -> str:
    return to_source_svg(result)


def _svg(job: Job, result: GlyphResult) -> str:
    return to_svg(result, view_box=job.spec.view_box)


def _curvature(job: Job, result: GlyphResult) -> str:
    return to_curvature_svg(result, scale=job.curvature_scale)


def _png(job: Job, result: GlyphResult) -> bytes:
    from ..writers.raster import to_png  # matplotlib, only when asked for

    return to_png(result, scale=job.curvature_scale)


def _pdf(job: Job, result: GlyphResult) -> bytes:
    from ..writers.raster import to_pdf

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


def _drawn_source(job: Job, outline: Outline, drawn: Drawn) -> bytes:
    return drawn_source(outline, drawn, job.spec.options.precision)


def _drawn_svg(job: Job, outline: Outline, drawn: Drawn) -> bytes:
    return drawn_svg(outline, drawn, job.spec.options.precision, job.spec.view_box)


def _drawn_map(job: Job, outline: Outline, drawn: Drawn) -> bytes:
    assert job.curvature_scale is not None
    return drawn_map(outline, drawn, job.curvature_scale)


SHORT: dict[str, Callable[[Job, Outline, Drawn], bytes]] = {
    "source": _drawn_source,
    "svg": _drawn_svg,
    "curvature": _drawn_map,
}


def survey(job: Job, tasks: Sequence[Task]) -> list[Comb]:
    """Combs of a few glyphs, for the scale that all curvature maps of the run share; what fails is left out."""
    found: list[Comb] = []
    drawn = draw(job, tasks) if short_way(job) else [None] * len(tasks)
    em = source_of(job.path, job.face_index, job.location).metrics.units_per_em
    for task, short in zip(tasks, drawn, strict=True):
        sign_of_life()
        if short is not None:
            found += combs_of(*short.curves, em)
            continue
        try:
            outline = read(job, task)
            found += combs(convert(outline, job.spec.fitting(outline.metrics.units_per_em)))
        except Exception:  # it will be reported when the glyph's own turn comes
            continue
    return found
