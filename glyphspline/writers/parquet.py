"""Outlines, polygons, splines and measures as a Parquet table with one row per contour.

Columns of schema version 1. Lists are in curve order, points are pairs (x, y) in font units, y up.

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

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ..fitting.results import GlyphResult, end_to_end
from ..readers import Source
from .arrow_columns import arrow, fit_columns, fit_types, measure_columns, measure_types, source_columns, source_types

SCHEMA_VERSION = 1

ROWS = 512
"""Contours in a row group: those held in memory while writing, and the rest of a glyph."""


def schema() -> Any:
    """The table's columns as an Arrow schema, with its version as metadata."""
    pa = arrow()
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
    columns = of_glyph | fit_types() | source_types() | measure_types()
    return pa.schema(columns, metadata={"glyphspline.schema": str(SCHEMA_VERSION)})


def write_table(source: Source, glyphs: Iterable[GlyphResult], file: Any) -> int:
    """Write the table to a path or a binary file; returns the number of rows.

    Raises:
        GlyphsplineError: pyarrow, of the extra ``parquet``, is not installed.
    """
    arrow()
    from pyarrow.parquet import ParquetWriter

    count, waiting, held = 0, list[GlyphResult](), 0
    with ParquetWriter(str(file) if isinstance(file, Path) else file, schema(), compression="zstd") as writer:
        for glyph in glyphs:
            waiting.append(glyph)
            held += len(glyph.contours)
            if held >= ROWS:
                writer.write_table(rows(source, waiting), row_group_size=ROWS)
                count, waiting, held = count + held, [], 0
        if held:
            writer.write_table(rows(source, waiting), row_group_size=ROWS)
    return count + held


def rows(source: Source, glyphs: list[GlyphResult]) -> Any:
    """An Arrow table with a row for each contour."""
    pa, layout = arrow(), schema()
    found, offsets = end_to_end(glyphs)
    units = np.ones(len(found))
    columns = fit_columns(found, units) | source_columns(found, units) | measure_columns(found, units)
    outlines = [glyph.outline for glyph in glyphs]
    of_glyph = {
        "font": [source.family] * len(glyphs),
        "style": [source.style] * len(glyphs),
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
