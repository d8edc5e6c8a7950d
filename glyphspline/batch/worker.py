"""The work of a worker, in batches: tasks to outlines to results to files and lines of the manifest."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..curves.curvature import Comb
from ..errors import GlyphsplineError, OutputError
from ..fitting.convert import convert_many, unfitted
from ..fitting.options import Options
from ..fitting.results import GlyphResult, as_glyph, end_to_end
from ..outlines.contour_arrays import joined, offsets_of
from ..outlines.outline import Outline
from ..readers import Source, open_source
from ..readers.opentype.bulk import BulkReader
from ..readers.source import reason as library_reason
from ..report.data import files_text, glyph_text, row_of
from ..report.gallery_files import FOLDER as GALLERY
from ..writers.figures.images import ImageKind
from ..writers.formats import format_named
from ..writers.svg.curvature_map import combs, curves_of, map_document
from ..writers.svg.document import svg_document
from ..writers.svg.path_data import PathData, curves_data
from ..writers.svg.polygon_drawing import PolygonData, polygon_data, polygon_document, source_data
from .entry import contour_texts, journal_line, manifest_line
from .files import write_whole
from .job import Done, Job, Task, failed
from .pool import sign_of_life
from .result_text import to_text
from .spec import POLYGON, RESULTS, Limits, suffix_of
from .summary import NO_FACTS, Facts, facts_of

Location = tuple[tuple[str, float], ...]

BATCH = 40_000
"""Segments and vertices converted at once: some 40 glyphs of a CJK face. A worker's time limit and memory are for one
batch."""

# The process that opens a font for the run reports what fontTools says of it; workers would say it once more each.
logging.getLogger("fontTools").addHandler(logging.NullHandler())


class Read(NamedTuple):
    """A glyph that has been read; ``cost`` counts segments, and vertices."""

    task: Task
    outline: Outline
    cost: float


def work(job: Job, tasks: Sequence[Task]) -> list[Done]:
    """Convert and write glyphs. A glyph that cannot be converted does not affect the others.

    Raises:
        OutputError: the output folder cannot be written to; every other glyph would fail too.
    """
    read, done = readable(job, tasks)
    for batch in batches(read):
        done += convert_and_write(job, batch)
        sign_of_life()
    return done


def survey(job: Job, tasks: Sequence[Task]) -> list[Comb]:
    """Combs of a few glyphs' outlines, for the run's curvature scale; glyphs that fail are skipped."""
    found = []
    for glyph in readable(job, tasks)[0]:
        sign_of_life()
        try:
            found += combs(as_glyph(glyph.outline))
        except Exception:  # reported when the glyph is converted for its files
            continue
    return found


def readable(job: Job, tasks: Sequence[Task]) -> tuple[list[Read], list[Done]]:
    """Read glyphs; those whose outlines cannot be read or are too large fail."""
    read, done = [], []
    found = outlines(job, tasks)
    good = [outline for outline in found if isinstance(outline, Outline)]
    vertices = iter(vertices_of(good, job.spec.options))
    for task, outline in zip(tasks, found, strict=True):
        try:
            if isinstance(outline, GlyphsplineError):
                raise outline
            read.append(Read(task, outline, cost_of(outline, next(vertices), job.spec.limits)))
        except GlyphsplineError as error:
            done.append(failed(task, reason(error)))
    return read, done


def outlines(job: Job, tasks: Sequence[Task]) -> Sequence[Outline | GlyphsplineError]:
    """The outline of each glyph, or its error."""
    if job.is_font:
        reader = bulk_reader(job.path, job.face_index, job.location)
        return reader.outlines([(task.name, task.gid, task.unicodes) for task in tasks], job.metrics)
    source = source_of(job.path, job.face_index, job.location)
    return source.outlines([task.gid for task in tasks], errors="return")


@lru_cache(maxsize=1)
def bulk_reader(path: Path, face_index: int, location: Location) -> BulkReader:
    """The reader of a font, opened once a process; it opens much faster than the font."""
    return BulkReader(path, face_index, location)


@lru_cache(maxsize=1)
def source_of(path: Path, face_index: int, location: Location) -> Source:
    """The source, opened once a process; only one is kept, which may take 100 MB."""
    return open_source(path, face_index, dict(location))


OPENED = (bulk_reader, source_of)


def forget_opened() -> None:
    """Open fonts anew from now on: their files may have been edited."""
    for opened in OPENED:
        opened.cache_clear()


def cost_of(outline: Outline, vertices: float, limits: Limits) -> float:
    """Segments of an outline and vertices together.

    Raises:
        GlyphsplineError: more than any real glyph has.
    """
    segments = len(outline.arrays.degrees)
    if segments > limits.segments:
        raise GlyphsplineError(f"{segments} segments, more than the {limits.segments} allowed")
    if not vertices <= limits.vertices:
        raise GlyphsplineError(f"about {vertices:.3g} vertices, more than the {limits.vertices} allowed")
    return segments + vertices


def vertices_of(outlines: Sequence[Outline], options: Options) -> list[float]:
    """Estimated number of vertices for ``step`` or ``count``, from the lengths of control polygons."""
    if options.step is None or not outlines:
        return [float(len(outline.contours) * (options.count or 0)) for outline in outlines]
    points, _, _, starts = joined([outline.arrays for outline in outlines])
    ends = offsets_of([len(outline.arrays.points) for outline in outlines])
    with np.errstate(all="ignore"):
        sides = np.zeros(len(points) + 1)
        sides[1:-1] = np.hypot(*(points[1:] - points[:-1]).T)
        sides[starts] = 0.0  # from one contour to the next
        return [float(sides[a:b].sum()) / options.step for a, b in pairwise(ends.tolist())]


def batches(read: Sequence[Read]) -> Iterator[list[Read]]:
    """Glyphs in batches of bounded cost, those of a batch with the same em."""
    batch: list[Read] = []
    cost = 0.0
    for glyph in read:
        if batch and (cost + glyph.cost > BATCH or glyph.outline.metrics != batch[0].outline.metrics):
            yield batch
            batch, cost = [], 0.0
        batch.append(glyph)
        cost += glyph.cost
    if batch:
        yield batch


def convert_and_write(job: Job, batch: Sequence[Read]) -> list[Done]:
    """Convert a batch and write its files; after an unexpected error, glyph by glyph."""
    started = time.perf_counter()
    try:
        results = converted(job, batch)
        glyphs = iter(drawn(job, [result for result in results if isinstance(result, GlyphResult)]))
        formats = job.spec.folders
        share = (time.perf_counter() - started) / len(batch)
        return [
            write_files(job, formats, read.task, next(glyphs), share)
            if isinstance(result, GlyphResult)
            else failed(read.task, reason(result), share)
            for read, result in zip(batch, results, strict=True)
        ]
    except OutputError:
        raise
    except Exception as error:
        if len(batch) == 1:
            return [failed(batch[0].task, reason(error), time.perf_counter() - started)]
        return [done for read in batch for done in convert_and_write(job, [read])]


def converted(job: Job, batch: Sequence[Read]) -> list[GlyphResult | GlyphsplineError]:
    """The results of a batch."""
    outlines = [read.outline for read in batch]
    if not job.spec.is_fitted:
        return unfitted(outlines, job.spec.options)
    options = job.spec.fitting(outlines[0].metrics.units_per_em)
    return convert_many(outlines, options, errors="return")


class Glyph(NamedTuple):
    """The input of the writers.

    Attributes:
        path: of the result. source: of the source; None if no format shows it.
        polygons: None without a gallery.
        measures: of the contours, as JSON without the brackets; None if nothing is fitted. facts: for the summary.
    """

    result: GlyphResult
    path: PathData
    source: PathData | None
    polygons: PolygonData | None
    measures: str | None
    facts: Facts


def drawn(job: Job, results: Sequence[GlyphResult]) -> list[Glyph]:
    """Path data and measures of a batch. What was not fitted is not measured."""
    if not results:
        return []
    spec = job.spec
    arrays, offsets = end_to_end(results)
    paths = curves_data(arrays.curves, spec.options.precision, offsets)
    nothing = [None] * len(results)
    if not spec.is_fitted:
        return list(map(Glyph, results, paths, paths, nothing, nothing, [NO_FACTS] * len(results)))
    sources = source_data(results) if {"source", GALLERY} & {*spec.formats} else nothing
    polygons = polygon_data(results) if GALLERY in spec.formats else nothing
    facts = [facts_of(arrays.measures, a, b) for a, b in pairwise(offsets.tolist())]
    return list(map(Glyph, results, paths, sources, polygons, contour_texts(arrays.measures, offsets), facts))


def write_files(job: Job, formats: Sequence[str], task: Task, glyph: Glyph, seconds: float) -> Done:
    """Write a glyph's files, none if it is empty. ``seconds``: time already spent on it."""
    started = time.perf_counter()
    empty = not glyph.result.contours
    files = {} if empty else {name: f"{name}/{task.stem}{suffix_of(name)}" for name in formats}
    sizes = [write_whole(f"{job.out}/{path}", written(name, job, glyph, files)) for name, path in files.items()]
    status, advance = "empty" if empty else "ok", glyph.result.outline.advance
    notes = tuple(dict.fromkeys([*glyph.result.outline.notes, *glyph.result.notes]))
    facts = glyph.facts._replace(notes=notes if empty else ())
    line = manifest_line(
        task.name, task.gid, task.unicodes, advance, status, files_text(files), glyph.measures,
        deviation=facts.deviation, notes=notes,
    )  # fmt: skip
    row = row_of(line) if GALLERY in formats else ""
    seconds += time.perf_counter() - started
    return Done(task.gid, task.name, status, journal_line(sizes, line), seconds, facts, row)


def reason(error: Exception) -> str:
    """The message of an error without the file's path, which may not be in a manifest."""
    if isinstance(error, GlyphsplineError):
        return error.message if error.contour is None else f"contour {error.contour}: {error.message}"
    if isinstance(error, MemoryError):
        return "not enough memory"
    return library_reason(error)


def written(name: str, job: Job, glyph: Glyph, files: dict[str, str]) -> str | bytes:
    """A glyph's file of a format."""
    writer = SHARING.get(name)
    if writer is not None:
        return writer(job, glyph, files)
    return format_named(name).write(glyph.result, job.spec.settings.scaled(glyph.result.outline.metrics))


def _source(job: Job, glyph: Glyph, files: dict[str, str]) -> bytes:
    assert glyph.source is not None
    return svg_document(glyph.result, glyph.source, job.spec.settings.look)


def _polygon(job: Job, glyph: Glyph, files: dict[str, str]) -> bytes:
    assert glyph.source is not None
    assert glyph.polygons is not None
    return polygon_document(glyph.result, glyph.source, glyph.polygons)


def _curvature(job: Job, glyph: Glyph, files: dict[str, str]) -> bytes:
    assert job.curvature_scale is not None
    result, whose = glyph.result, job.spec.maps.comb
    path = glyph.path if whose == "result" else curves_data(curves_of(result, whose), result.options.precision)[0]
    return map_document(result, path, job.curvature_scale, whose, in_corners=job.spec.maps.corner_teeth)


def _drawing(job: Job, glyph: Glyph, kind: ImageKind) -> bytes:
    from ..writers.figures.drawing import drawing_image  # imports matplotlib

    return drawing_image(glyph.result, kind, job.spec.settings.look, glyph.path.box)


def _map(job: Job, glyph: Glyph, kind: ImageKind) -> bytes:
    from ..writers.figures.raster import map_image

    spec = job.spec
    return map_image(
        glyph.result, kind, comb=spec.maps.comb, scale=job.curvature_scale, in_corners=spec.maps.corner_teeth
    )


def _gallery(job: Job, glyph: Glyph, files: dict[str, str]) -> bytes:
    assert glyph.source is not None
    assert glyph.polygons is not None
    assert glyph.measures is not None
    polygon, control = (part.text for part in glyph.polygons)
    shown = {"source": glyph.source.text, "result": glyph.path.text, "polygon": polygon, "control": control}
    return glyph_text(shown, files, glyph.measures)


SHARING: dict[str, Callable[[Job, Glyph, dict[str, str]], str | bytes]] = {
    "source": _source,
    "svg": lambda job, glyph, files: svg_document(glyph.result, glyph.path, job.spec.settings.look),
    "curvature": _curvature,
    "png": lambda job, glyph, files: _drawing(job, glyph, "png"),
    "pdf": lambda job, glyph, files: _drawing(job, glyph, "pdf"),
    "curvature-png": lambda job, glyph, files: _map(job, glyph, "png"),
    "curvature-pdf": lambda job, glyph, files: _map(job, glyph, "pdf"),
    GALLERY: _gallery,
    POLYGON: _polygon,
    RESULTS: lambda job, glyph, files: to_text(glyph.result),
}
"""Writers that share what is made for a whole batch or run, such as path data or the scale of maps, and those of
formats that only a run has. All other formats are written by their own ``write``."""
