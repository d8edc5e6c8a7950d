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

from collections.abc import Iterable, Iterator
from dataclasses import fields
from itertools import islice
from pathlib import Path
from typing import Any

from ..extras import need
from ..fitting.results import ContourResult, GlyphResult, Measures
from ..readers import Source

SCHEMA_VERSION = 1

ROWS = 512
"""Contours in a row group: those held in memory while writing."""


def schema() -> Any:
    """The table's columns as an Arrow schema, with its version as metadata."""
    pa = arrow()
    point = pa.list_(pa.float64(), 2)
    columns = [
        ("font", pa.string()),
        ("style", pa.string()),
        ("glyph", pa.string()),
        ("gid", pa.uint32()),
        ("codepoints", pa.list_(pa.uint32())),
        ("advance", pa.float64()),
        ("units_per_em", pa.float64()),
        ("contour", pa.uint32()),
        ("polygon", pa.list_(point)),
        ("closed", pa.list_(pa.bool_())),
        ("degree", pa.list_(pa.uint8())),
        ("knots", pa.list_(pa.list_(pa.float64()))),
        ("control_points", pa.list_(pa.list_(point))),
        ("footpoints", pa.list_(pa.list_(pa.float64()))),
        ("bezier_degrees", pa.list_(pa.uint8())),
        ("bezier_points", pa.list_(point)),
        ("source_degrees", pa.list_(pa.uint8())),
        ("source_points", pa.list_(point)),
    ]
    types = {"int": pa.int64(), "float": pa.float64(), "bool": pa.bool_()}
    columns += [(field.name, types[str(field.type).split(" | ")[0]]) for field in fields(Measures)]
    return pa.schema(columns, metadata={"glyphspline.schema": str(SCHEMA_VERSION)})


def write_table(source: Source, glyphs: Iterable[GlyphResult], file: Any) -> int:
    """Write the table to a path or a binary file; returns the number of rows.

    Raises:
        GlyphsplineError: pyarrow, of the extra ``parquet``, is not installed.
    """
    pa = arrow()
    from pyarrow.parquet import ParquetWriter

    layout, count, table = schema(), 0, rows(source, glyphs)
    with ParquetWriter(str(file) if isinstance(file, Path) else file, layout, compression="zstd") as writer:
        while batch := list(islice(table, ROWS)):
            writer.write_table(pa.Table.from_pylist(batch, schema=layout))
            count += len(batch)
    return count


def rows(source: Source, glyphs: Iterable[GlyphResult]) -> Iterator[dict[str, Any]]:
    """A row for each contour."""
    for glyph in glyphs:
        outline = glyph.outline
        of_glyph = {
            "font": source.family,
            "style": source.style,
            "glyph": outline.name,
            "gid": outline.gid,
            "codepoints": list(outline.unicodes),
            "advance": outline.advance,
            "units_per_em": outline.metrics.units_per_em,
        }
        for index, contour in enumerate(glyph.contours):
            yield of_glyph | {"contour": index} | row(contour)


def row(contour: ContourResult) -> dict[str, Any]:
    """The columns of the contour itself."""
    splines = [interpolation.spline for interpolation in contour.interpolations]
    return vars(contour.measures) | {
        "polygon": contour.polygon.tolist(),
        "closed": [spline.closed for spline in splines],
        "degree": [spline.degree for spline in splines],
        "knots": [spline.knots.tolist() for spline in splines],
        "control_points": [spline.control_points.tolist() for spline in splines],
        "footpoints": [interpolation.parameters.tolist() for interpolation in contour.interpolations],
        "bezier_degrees": contour.curve.degrees.tolist(),
        "bezier_points": contour.curve.points.tolist(),
        "source_degrees": contour.source.degrees.tolist(),
        "source_points": contour.source.points.tolist(),
    }


def arrow() -> Any:
    """The module pyarrow.

    Raises:
        GlyphsplineError: it is not installed.
    """
    return need("parquet")
