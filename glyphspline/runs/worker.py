"""The work of a worker, in batches: tasks to outlines to results to files and lines of the manifest."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ..errors import GlyphsplineError
from ..files import write_whole
from ..fitting.convert import convert_many, unfitted
from ..fitting.options import Options
from ..fitting.results import GlyphResult, end_to_end
from ..outlines.contour_arrays import joined, offsets_of
from ..outlines.outline import Outline
from ..readers.source import OutlineOrError
from ..report.data import encoded, glyph_text, row_of
from ..report.gallery_files import FOLDER as GALLERY
from ..writers.figures.images import ImageKind
from ..writers.formats import format_named
from ..writers.svg.curvature_map import curves_of, map_document
from ..writers.svg.document import svg_document
from ..writers.svg.path_data import PathData, curves_data
from ..writers.svg.polygon_drawing import PolygonData, polygon_data, polygon_document, source_data
from .engine import Item
from .entry import contour_entries, journal_line, manifest_entry
from .jobs.glyphs import Done, Output, Task, failed
from .places import Side, readers
from .result_text import to_text
from .spec import POLYGON, RESULTS, Limits, RunSpec, suffix_of
from .summary import NO_FACTS, Facts, facts_of

# The process that opens a font for the run reports what fontTools says of it; workers would say it once more each.
logging.getLogger("fontTools").addHandler(logging.NullHandler())


def read(side: Side, tasks: Sequence[Task], spec: RunSpec) -> list[Item | Exception]:
    """Outlines of one em to a batch, whose costs are segments and vertices; those too large are errors."""
    (reader,) = readers(side)
    found = reader([task.head for task in tasks])
    return items(found, spec.options, spec.limits)


def items(found: Sequence[OutlineOrError], options: Options | None, limits: Limits) -> list[Item | Exception]:
    """Outlines to be fitted, or without options none of them, as a job's items."""
    good = [outline for outline in found if isinstance(outline, Outline)]
    vertices = iter([0.0] * len(good) if options is None else vertices_of(good, options))
    read: list[Item | Exception] = []
    for outline in found:
        try:
            if isinstance(outline, GlyphsplineError):
                raise outline
            read.append(Item(outline, cost_of(outline, next(vertices), limits), outline.metrics))
        except GlyphsplineError as error:
            read.append(error)
    return read


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


def convert_and_write(job: Output, tasks: Sequence[Task], outlines: Sequence[Outline]) -> list[Done]:
    """Convert a batch and write its files."""
    if job.spec.is_fitted:
        options = job.spec.fitting(outlines[0].metrics.units_per_em)
        results = convert_many(outlines, options, errors="return")
    else:
        results = unfitted(outlines, job.spec.options)
    glyphs = iter(drawn(job, [result for result in results if isinstance(result, GlyphResult)]))
    return [
        write_files(job, task, next(glyphs)) if isinstance(result, GlyphResult) else failed(task, result)
        for task, result in zip(tasks, results, strict=True)
    ]


class Glyph(NamedTuple):
    """The input of the writers.

    Attributes:
        path: of the result. source: of the source; None if no format shows it.
        polygons: None without a gallery.
        measures: of the contours; None if nothing is fitted. facts: for the summary.
    """

    result: GlyphResult
    path: PathData
    source: PathData | None
    polygons: PolygonData | None
    measures: list[dict[str, Any]] | None
    facts: Facts


def drawn(job: Output, results: Sequence[GlyphResult]) -> list[Glyph]:
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
    return list(map(Glyph, results, paths, sources, polygons, contour_entries(arrays.measures, offsets), facts))


def write_files(job: Output, task: Task, glyph: Glyph) -> Done:
    """Write a glyph's files, none if it is empty."""
    empty, formats = not glyph.result.contours, job.spec.folders
    files = {} if empty else {name: f"{name}/{task.stem}{suffix_of(name)}" for name in formats}
    sizes = [write_whole(f"{job.out}/{path}", written(name, job, glyph, files)) for name, path in files.items()]
    status, advance = "empty" if empty else "ok", glyph.result.outline.advance
    notes = tuple(dict.fromkeys([*glyph.result.outline.notes, *glyph.result.notes]))
    facts = glyph.facts._replace(notes=notes if empty else ())
    entry = manifest_entry(
        task.name, task.gid, task.unicodes, advance, status, files, glyph.measures,
        deviation=facts.deviation, notes=notes,
    )  # fmt: skip
    row = row_of(entry) if GALLERY in formats else ""
    return Done(task.gid, task.name, status, journal_line(sizes, encoded(entry)), facts, row)


def written(name: str, job: Output, glyph: Glyph, files: dict[str, str]) -> str | bytes:
    """A glyph's file of a format."""
    writer = SHARING.get(name)
    if writer is not None:
        return writer(job, glyph, files)
    return format_named(name).write(glyph.result, job.spec.settings.scaled(glyph.result.outline.metrics))


def _source(job: Output, glyph: Glyph, files: dict[str, str]) -> bytes:
    assert glyph.source is not None
    return svg_document(glyph.result, glyph.source, job.spec.settings.look)


def _polygon(job: Output, glyph: Glyph, files: dict[str, str]) -> bytes:
    assert glyph.source is not None
    assert glyph.polygons is not None
    return polygon_document(glyph.result, glyph.source, glyph.polygons)


def _curvature(job: Output, glyph: Glyph, files: dict[str, str]) -> bytes:
    assert job.curvature_scale is not None
    result, whose = glyph.result, job.spec.maps.comb
    path = glyph.path if whose == "result" else curves_data(curves_of(result, whose), result.options.precision)[0]
    return map_document(result, path, job.curvature_scale, whose, in_corners=job.spec.maps.corner_teeth)


def _drawing(job: Output, glyph: Glyph, kind: ImageKind) -> bytes:
    from ..writers.figures.drawing import drawing_image  # imports matplotlib

    return drawing_image(glyph.result, kind, job.spec.settings.look, glyph.path.box)


def _map(job: Output, glyph: Glyph, kind: ImageKind) -> bytes:
    from ..writers.figures.raster import map_image

    spec = job.spec
    return map_image(
        glyph.result, kind, comb=spec.maps.comb, scale=job.curvature_scale, in_corners=spec.maps.corner_teeth
    )


def _gallery(job: Output, glyph: Glyph, files: dict[str, str]) -> bytes:
    assert glyph.source is not None
    assert glyph.polygons is not None
    assert glyph.measures is not None
    polygon, control = (part.text for part in glyph.polygons)
    shown = {"source": glyph.source.text, "result": glyph.path.text, "polygon": polygon, "control": control}
    return glyph_text(shown, files, glyph.measures)


SHARING: dict[str, Callable[[Output, Glyph, dict[str, str]], str | bytes]] = {
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
