"""Outlines, polygons, splines and measures as a Parquet table with one row per contour.

Columns of schema version 2; the first had no ``spline_…``. Lists are in curve order, points are pairs (x, y) in font
units, y up.

==================== ============================= ==================================================================
font, style          string                        family and style of the source
glyph, gid           string, uint32                glyph name and index
codepoints           list<uint32>                  its characters, ascending
advance, units_per_em double                       in font units
contour              uint32                        which contour of the result, from 0
polygon              list<point>                   the sampled vertices
closed               list<bool>                    of each spline of the contour: one closed spline in "smooth", one
                                                   arc between corners each in "sharp"
degree               list<uint8>                   of each spline
knots                list<list<double>>            of each spline
control_points       list<list<point>>             of each spline
footpoints           list<list<double>>            parameter at which each spline passes its vertices
spline_knots         list<double>                  of the contour as one closed cubic spline, lines included, with
                                                   triple knots at corners: :attr:`.ContourResult.spline`
spline_points        list<point>                   its control points, one less than knots
bezier_degrees       list<uint8>                   of the segments of the exact Bézier form, 1 to 3
bezier_points        list<point>                   their control points, each shared end once; the last segment ends
                                                   on the first point
source_degrees,      as those two                  the source contour in the same form
source_points
vertices …           as in :class:`.Measures`      one column each, null where it was not computed
source_kept
==================== ============================= ==================================================================
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import fields
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from ...extras import need
from ...fitting.results import (
    BOUNDS,
    PER_EM,
    QUANTITIES,
    ConvertedContours,
    GlyphResult,
    Measures,
    joined_results,
)
from ...outlines.contour_arrays import offsets_of
from ...readers import Source
from ...types import FloatArray, IntArray

SCHEMA_VERSION = 2

POWERS = {name: {"units": 1, "units²": 2, PER_EM: -1}[one.unit] for name, one in QUANTITIES.items() if one.unit}
"""Of the unit of length, in the measures that have one."""


def schema() -> Any:
    """The table's columns as an Arrow schema, with its version as metadata."""
    pa = need("parquet")
    of_glyph = {
        "font": pa.string(),
        "style": pa.string(),
        "glyph": pa.string(),
        "gid": pa.uint32(),
        "codepoints": pa.list_(pa.uint32()),
        "advance": pa.float64(),
        "units_per_em": pa.float64(),
        "contour": pa.uint32(),
    }
    columns = of_glyph | types_of(fit_columns) | types_of(source_columns) | measure_types()
    return pa.schema(columns, metadata={"glyphspline.schema": str(SCHEMA_VERSION)})


def write_table(source: Source, glyphs: Iterable[GlyphResult], file: Any, group: int = 512) -> int:
    """Write the table to a path or a binary file; returns the number of rows.

    Args:
        group: contours in a row group: held in memory while writing, with some glyphs more.

    Raises:
        GlyphsplineError: pyarrow, of the extra ``parquet``, is not installed.
    """
    every = iter(glyphs)
    batches = iter(lambda: list(islice(every, 64)), [])
    return write_rows((rows((source.family, source.style), batch) for batch in batches), file, group)


def write_rows(tables: Iterable[Any], file: Any, group: int = 512) -> int:
    """Write the rows of tables, those of a glyph in one of them; returns their number.

    A row group ends with the glyph that fills it, wherever tables end.
    """
    from pyarrow.parquet import ParquetWriter

    count, layout = 0, schema()
    with ParquetWriter(str(file) if isinstance(file, Path) else file, layout, **writing_of(layout)) as writer:
        for table in _groups(tables, layout.empty_table(), group):
            writer.write_table(table, row_group_size=table.num_rows)
            count += table.num_rows
    return count


def writing_of(layout: Any) -> dict[str, Any]:
    """Settings of a Parquet writer. Coordinates hardly repeat, and the least of them says nothing."""
    plain = [field.name for field in layout if not need("parquet").types.is_nested(field.type)]
    return {"compression": "zstd", "use_dictionary": plain, "write_statistics": plain}


def _groups(tables: Iterable[Any], waiting: Any, group: int) -> Iterator[Any]:
    concat = need("parquet").concat_tables
    for table in tables:
        waiting = concat([waiting, table])
        while waiting.num_rows >= group:
            gids = waiting["gid"].to_numpy()
            ends = np.append(np.nonzero(np.diff(gids))[0] + 1, len(gids))
            end = int(ends[np.searchsorted(ends, group)])
            yield waiting.slice(0, end).combine_chunks()
            waiting = waiting.slice(end)
    if waiting.num_rows:
        yield waiting.combine_chunks()


def rows(font: tuple[str, str], glyphs: list[GlyphResult]) -> Any:
    """An Arrow table with a row for each contour of glyphs of a font with this family and style."""
    pa, layout = need("parquet"), schema()
    found, offsets = joined_results(glyphs)
    units = np.ones(len(found))
    columns = fit_columns(found, units) | source_columns(found, units) | measure_columns(found, units)
    outlines = [glyph.outline for glyph in glyphs]
    of_glyph = {
        "font": [font[0]] * len(glyphs),
        "style": [font[1]] * len(glyphs),
        "glyph": [outline.name for outline in outlines],
        "gid": [outline.gid for outline in outlines],
        "codepoints": [outline.unicodes for outline in outlines],
        "advance": [outline.advance for outline in outlines],
        "units_per_em": [outline.metrics.units_per_em for outline in outlines],
    }
    owner = np.repeat(np.arange(len(glyphs)), np.diff(offsets))
    for name, values in of_glyph.items():
        columns[name] = pa.array(values, layout.field(name).type).take(pa.array(owner))
    columns["contour"] = pa.array(np.arange(len(found)) - offsets[owner], pa.uint32())
    return pa.Table.from_arrays([columns[name] for name in layout.names], schema=layout)


def types_of(columns: Callable[[ConvertedContours, FloatArray], dict[str, Any]]) -> dict[str, Any]:
    """Arrow types of the columns that one of the functions below makes."""
    return {name: column.type for name, column in columns(joined_results([])[0], np.empty(0)).items()}


def measure_types() -> dict[str, Any]:
    """Arrow types of the columns of the measures."""
    pa = need("parquet")
    types = {"int": pa.int64(), "float": pa.float64(), "bool": pa.bool_()}
    return {field.name: types[str(field.type).split(" | ")[0]] for field in fields(Measures)}


def nested(values: Any, *offsets: IntArray) -> Any:
    """Lists of an Arrow array, or lists of lists: the innermost offsets come first."""
    pa = need("parquet")
    for own in offsets:
        values = pa.ListArray.from_arrays(pa.array(own.astype(np.int32)), values)
    return values


def pairs(points: FloatArray) -> Any:
    """Points (N, 2) as an Arrow array of N lists of two."""
    pa = need("parquet")
    return pa.FixedSizeListArray.from_arrays(pa.array(points.ravel()), 2)


def source_columns(found: ConvertedContours, factors: FloatArray) -> dict[str, Any]:
    """The source of C contours; coordinates are multiplied by (C,) ``factors``."""
    pa, source = need("parquet"), found.source
    points = source.points * np.repeat(factors, np.diff(source.starts))[:, None]
    return {
        "source_degrees": nested(pa.array(source.degrees.astype(np.uint8)), source.offsets),
        "source_points": nested(pairs(points), source.starts),
    }


def fit_columns(found: ConvertedContours, factors: FloatArray) -> dict[str, Any]:
    """The fit of C contours; lengths, knots too, are multiplied by (C,) ``factors``."""
    pa, curves, polygons, controls = need("parquet"), found.curves, found.polygons, found.controls
    each = np.repeat(factors, np.diff(found.arc_offsets))
    splines = [arc.spline for arc in found.arcs]
    knots, at_knots = _numbers([spline.knots for spline in splines], each)
    feet, at_feet = _numbers([arc.parameters for arc in found.arcs], each)
    vertices = polygons.points * np.repeat(factors, np.diff(polygons.offsets))[:, None]
    beziers = curves.points * np.repeat(factors, np.diff(curves.starts))[:, None]
    rows = controls.points * np.repeat(each, np.diff(controls.offsets))[:, None]
    arcs, (whole, wholes) = found.arc_offsets, found.whole_splines
    whole_points = wholes.points * np.repeat(factors, np.diff(wholes.offsets))[:, None]
    at_whole = wholes.offsets + np.arange(len(wholes.offsets))
    return {
        "polygon": nested(pairs(vertices), polygons.offsets),
        "closed": nested(pa.array(controls.closed), arcs),
        "degree": nested(pa.array([spline.degree for spline in splines], pa.uint8()), arcs),
        "knots": nested(knots, at_knots, arcs),
        "control_points": nested(pairs(rows), controls.offsets, arcs),
        "footpoints": nested(feet, at_feet, arcs),
        "spline_knots": nested(pa.array(whole * np.repeat(factors, np.diff(at_whole))), at_whole),
        "spline_points": nested(pairs(whole_points), wholes.offsets),
        "bezier_degrees": nested(pa.array(curves.degrees.astype(np.uint8)), curves.offsets),
        "bezier_points": nested(pairs(beziers), curves.starts),
    }


def _numbers(parts: list[FloatArray], factors: FloatArray) -> tuple[Any, IntArray]:
    """Numbers of some arcs end to end, multiplied, and where each arc begins."""
    offsets = offsets_of([len(part) for part in parts])
    return need("parquet").array(np.concatenate([np.empty(0), *parts]) * np.repeat(factors, np.diff(offsets))), offsets


def measure_columns(found: ConvertedContours, factors: FloatArray) -> dict[str, Any]:
    """The measures of C contours, null where not computed, with lengths multiplied by (C,) ``factors``."""
    pa, columns = need("parquet"), {}
    scaled = bool((factors != 1.0).any())
    for name, kind in measure_types().items():
        values = found.measures.get(name)
        if values is None:
            columns[name] = pa.nulls(len(found), kind)
        elif scaled and name in POWERS:
            known = np.array([np.nan if value is None else value for value in values], dtype=np.float64)
            known = known * factors ** POWERS[name]
            if name in BOUNDS:
                known = np.nextafter(known, np.inf)  # the product may be rounded down
            columns[name] = pa.array(known, mask=np.array([value is None for value in values], dtype=np.bool_))
        else:
            columns[name] = pa.array(values, kind)
    return columns
