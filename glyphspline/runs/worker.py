"""The work of a worker, in batches: tasks to outlines to results to files and lines of the manifest."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ..errors import GlyphsplineError
from ..files import write_whole
from ..fitting.convert import convert_many, unfitted
from ..fitting.options import Options
from ..fitting.results import BOUNDS, MEASURES, GlyphResult, MeasureColumns, joined_results
from ..outlines.outline import Outline
from ..readers.source import OutlineOrError
from ..report import FOLDER as GALLERY
from ..report.data import DECIMALS, FULL, encoded, glyph_text, plain, row_of
from ..types import IntArray, rounded_up
from ..writers.formats import format_named
from ..writers.settings import Whose
from ..writers.svg.comb_data import GlyphComb, combs_data
from ..writers.svg.document import PolygonData, polygon_data, polygon_document, source_data
from ..writers.svg.path_data import PathData, both_ways, curves_data
from .engine import Item
from .folder import Done, Output, Task, done
from .result_text import to_text
from .spec import MAPS, POLYGON, RESULTS, Limits, suffix_of

# The process that opens a font for the run reports what fontTools says of it; workers would say it once more each.
logging.getLogger("fontTools").addHandler(logging.NullHandler())


def items(found: Sequence[OutlineOrError], options: Options | None, limits: Limits) -> list[Item | Exception]:
    """Outlines to be fitted, or without options none of them, as a job's items of one em to a batch.

    Their costs are segments and vertices; those that have more than any real glyph are errors.
    """
    return [one if isinstance(one, GlyphsplineError) else _item(one, options, limits) for one in found]


def _item(outline: Outline, options: Options | None, limits: Limits) -> Item | GlyphsplineError:
    segments, vertices = len(outline.arrays.degrees), 0.0 if options is None else vertices_of(outline, options)
    if error := limits.error_of(segments):
        return error
    if not vertices <= limits.vertices:
        return GlyphsplineError(f"about {vertices:.3g} vertices, more than the {limits.vertices} allowed")
    return Item(outline, segments + vertices, outline.metrics)


def vertices_of(outline: Outline, options: Options) -> float:
    """Estimated number of vertices for ``step`` or ``count``, from the lengths of control polygons."""
    if options.step is None:
        return float(len(outline.contours) * (options.count or 0))
    points, _, _, starts = outline.arrays
    with np.errstate(all="ignore"):
        sides = np.hypot(*np.diff(points, axis=0, prepend=points[:1]).T)
        sides[starts[:-1]] = 0.0  # from one contour to the next
        return float(sides.sum()) / options.step


def convert_and_write(job: Output, tasks: Sequence[Task], outlines: Sequence[Outline]) -> list[Done | GlyphsplineError]:
    """Convert a batch and write its files; a glyph that cannot be converted has its error."""
    if job.spec.is_fitted:
        options = job.spec.fitting(outlines[0].metrics.units_per_em)
        results = convert_many(outlines, options, errors="return")
    else:
        results = unfitted(outlines, job.spec.options)
    good = [result for result in results if isinstance(result, GlyphResult)]
    glyphs, waiting = iter(drawn(job, good)), rows_of(job, good)
    finished: list[Done | GlyphsplineError] = []
    for task, result in zip(tasks, results, strict=True):
        if not isinstance(result, GlyphResult):
            finished.append(result)
            continue
        glyph = next(glyphs)
        deviations = [value for contour in glyph.measures or () if (value := contour["deviation"]) is not None]
        notes = tuple(dict.fromkeys([*result.outline.notes, *result.notes]))
        facts = {
            "deviation": max(deviations, default=None), "contours": glyph.measures, "notes": notes,
            "unread": result.outline.unread, "error": None,
        }  # fmt: skip
        finished.append(write_files(job, task, glyph, facts)._replace(rows=waiting))
        waiting = b""
    return finished


def rows_of(job: Output, results: list[GlyphResult]) -> bytes:
    """The rows of a batch; none if there is no table, or no contour."""
    table = job.spec.table
    return table.rows(job.font, results) if table and any(result.contours for result in results) else b""


class DrawnGlyph(NamedTuple):
    """A result with what is made of it for a whole batch: the input of the formats.

    Attributes:
        path: of the result. source: of the source; None if no format shows it. polygons: None without a gallery.
        finer: of the result, with a decimal more: the gallery draws combs over it, which are uneven otherwise.
        combs: of its curvature map; None if no format shows it.
        measures: of the contours; None if nothing is fitted.
        kept: what is stored as the result, if that is another one. axes: see :func:`.report.data.glyph_text`.
    """

    result: GlyphResult
    path: PathData
    source: PathData | None
    polygons: PolygonData | None
    measures: list[dict[str, Any]] | None
    kept: Any = None
    axes: Mapping[str, Any] | None = None
    finer: PathData | None = None
    combs: Mapping[Whose, GlyphComb] | None = None


def drawn(job: Output, results: Sequence[GlyphResult]) -> list[DrawnGlyph]:
    """Path data and measures of a batch. What was not fitted is not measured."""
    if not results:
        return []
    spec = job.spec
    arrays, offsets = joined_results(results)
    paths = curves_data(arrays.curves, results[0].options.precision, offsets)
    nothing = [None] * len(results)
    if not spec.is_fitted:
        return list(map(DrawnGlyph, results, paths, paths, nothing, nothing))
    sources = source_data(results) if {"source", GALLERY} & {*spec.formats} else nothing
    polygons = polygon_data(results) if GALLERY in spec.formats else nothing
    glyphs = list(map(DrawnGlyph, results, paths, sources, polygons, contour_entries(arrays.measures, offsets)))
    if GALLERY in spec.formats:
        finer = curves_data(arrays.curves, results[0].options.precision + 1, offsets)
        glyphs = [glyph._replace(finer=path) for glyph, path in zip(glyphs, finer, strict=True)]
    if "curvature" in spec.formats:
        maps, scale = spec.maps, map_scale(job, results[0])
        combs = combs_data(results, maps.comb, scale, in_corners=maps.corner_teeth)
        glyphs = [glyph._replace(combs=own) for glyph, own in zip(glyphs, combs, strict=True)]
    return glyphs


def map_scale(job: Output, result: GlyphResult) -> float:
    """The curvature, in 1/unit, of a full tooth in maps."""
    em = result.outline.metrics.units_per_em
    return job.curvature_scale or job.spec.maps.scale_for(em) or FULL / em


def contour_entries(measures: MeasureColumns, offsets: IntArray) -> list[list[dict[str, Any]]]:
    """The measures of each glyph's contours as JSON has them, bounds rounded up; null is not known, or not finite.

    Args:
        measures: columns of all contours. offsets: (G + 1,) where the contours of each glyph begin.
    """
    columns: list[Sequence[Any]] = []
    for name in MEASURES:
        column = measures.get(name, [None] * int(offsets[-1]))
        if name in BOUNDS:
            column = [value if value is None else rounded_up(value, DECIMALS) for value in column]
        if name in measures:
            column = [plain(value) if isinstance(value, float) else value for value in column]
        columns.append(column)
    entries = [dict(zip(MEASURES, row, strict=True)) for row in zip(*columns, strict=True)]
    return [entries[a:b] for a, b in pairwise(offsets.tolist())]


def write_files(
    job: Output, task: Task, glyph: DrawnGlyph, facts: Mapping[str, Any], encode: Callable[[Any], str] = encoded
) -> Done:
    """Write a glyph's files; of an empty one none, or the result in all masters.

    Args:
        facts: of the glyph, for its line of the manifest. encode: that line's data as JSON.
    """
    empty = not glyph.result.contours
    names = ([] if glyph.kept is None else [RESULTS]) if empty else job.spec.folders
    files = {name: f"{name}/{task.stem}{suffix_of(name)}" for name in names}
    sizes = [write_whole(f"{job.out}/{path}", written(name, job, glyph, files)) for name, path in files.items()]
    status, advance = "empty" if empty else "ok", plain(glyph.result.outline.advance)
    entry = {"advance": advance, "status": status, "files": files, **facts}
    return done(task, entry, sizes, row_of if GALLERY in job.spec.folders else None, encode)


def written(name: str, job: Output, glyph: DrawnGlyph, files: dict[str, str]) -> str | bytes:
    """A glyph's file of a format.

    Path data, measures and the scale of maps are made once for a batch or run, and handed to the formats named here.
    """
    spec, result, source, polygons = job.spec, glyph.result, glyph.source, glyph.polygons
    if name == RESULTS:
        return to_text(glyph.kept or result)
    if name in (POLYGON, GALLERY):
        assert source is not None
        assert polygons is not None
        if name == POLYGON:
            return polygon_document(result, source, polygons)
        polygon, control = (part.text for part in polygons)
        precision = result.options.precision
        finer = precision + (glyph.finer is not None)
        shown = {
            "source": both_ways(source, result.outline.arrays, precision),
            "result": both_ways(glyph.finer or glyph.path, result.arrays.curves, finer),
            "polygon": polygon,
            "control": control,
            **({"strokes": "open"} if glyph.path.strokes else {}),
        }
        return glyph_text(shown, files, glyph.measures or (), glyph.axes)
    path = {"path": glyph.path}
    shared: dict[str, dict[str, Any]] = {"svg": path, "source": {"path": source}, "png": path, "pdf": path}
    known = shared.get(name, {})
    if name in MAPS:
        known = {"maps": spec.maps, "scale": map_scale(job, result)}
        if name == "curvature":
            known |= {"combs": glyph.combs} | (path if spec.maps.comb != "source" else {})
    settings = spec.settings if known else spec.settings.scaled(result.outline.metrics)
    write: Any = format_named(name).write
    made: str | bytes = write(result, settings, **known)
    return made
