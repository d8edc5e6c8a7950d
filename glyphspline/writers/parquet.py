"""Outlines, polygons, splines and measures as a Parquet table, one row a contour; glyphs without contours have none.

Columns of schema version 1. Lists are in curve order, points are pairs (x, y) in font units, y up.

==================== ============================= ==================================================================
font, style          string                        family and style of the source
glyph, gid           string, uint32                glyph name and index
codepoints           list<uint32>                  its characters, ascending
advance, units_per_em double                       in font units
contour              uint32                        which contour of the result, from 0
polygon              list<point>                   the sampled vertices
closed               list<bool>                    of each spline of the contour: one closed spline in "smooth", in
                                                   "sharp" as many arcs as there are between corners
degree               list<uint8>                   of each spline
knots                list<list<double>>            of each spline
control_points       list<list<point>>             of each spline
footpoints           list<list<double>>            parameter at which each spline passes its vertices
bezier_degrees       list<uint8>                   of the segments of the exact Bézier form, 1 to 3
bezier_points        list<point>                   their control points, each shared end once; the last segment ends
                                                   on the first point
source_degrees,      as those two                  the source contour in the same form
source_points
vertices …           as in :class:`.glyph.Measures` one column each, null where it was not computed
new_crossings
==================== ============================= ==================================================================
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import fields
from pathlib import Path
from typing import Any

from ..errors import GlyphsplineError
from ..fitting.results import ContourResult, GlyphResult, Measures
from ..readers import Source
from ..types import FloatArray

SCHEMA_VERSION = 1

ROWS = 512
"""Contours in a row group, which is what is held in memory while writing."""


def schema() -> Any:
    """The table's columns as an Arrow schema; its metadata say the version."""
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

    layout, count = schema(), 0
    with ParquetWriter(str(file) if isinstance(file, Path) else file, layout, compression="zstd") as writer:
        for batch in batches(rows(source, glyphs)):
            writer.write_table(pa.Table.from_pylist(batch, schema=layout))
            count += len(batch)
    return count


def rows(source: Source, glyphs: Iterable[GlyphResult]) -> Iterator[dict[str, Any]]:
    """A row for each contour."""
    for glyph in glyphs:
        outline = glyph.outline
        whole = {
            "font": source.family,
            "style": source.style,
            "glyph": outline.name,
            "gid": outline.gid,
            "codepoints": list(outline.unicodes),
            "advance": outline.advance,
            "units_per_em": outline.metrics.units_per_em,
        }
        for index, contour in enumerate(glyph.contours):
            yield whole | {"contour": index} | row(contour)


def row(contour: ContourResult) -> dict[str, Any]:
    """What a row says of the contour itself."""
    splines = [interpolation.spline for interpolation in contour.interpolations]
    measures = {field.name: getattr(contour.measures, field.name) for field in fields(Measures)}
    return measures | {
        "polygon": listed(contour.polygon),
        "closed": [spline.closed for spline in splines],
        "degree": [spline.degree for spline in splines],
        "knots": [listed(spline.knots) for spline in splines],
        "control_points": [listed(spline.control_points) for spline in splines],
        "footpoints": [listed(interpolation.parameters) for interpolation in contour.interpolations],
        "bezier_degrees": contour.curve.degrees.tolist(),
        "bezier_points": listed(contour.curve.points),
        "source_degrees": contour.source.degrees.tolist(),
        "source_points": listed(contour.source.points),
    }


def listed(array: FloatArray) -> list[Any]:
    """An array as nested lists of floats."""
    return list(array.tolist())


def batches(items: Iterator[dict[str, Any]]) -> Iterator[list[dict[str, Any]]]:
    """The rows by ``ROWS``."""
    batch: list[dict[str, Any]] = []
    for item in items:
        batch.append(item)
        if len(batch) == ROWS:
            yield batch
            batch = []
    if batch:
        yield batch


def arrow() -> Any:
    """The module pyarrow.

    Raises:
        GlyphsplineError: it is not installed.
    """
    try:
        import pyarrow
    except ImportError as error:
        raise GlyphsplineError('Parquet needs pyarrow: pip install "glyphspline[parquet]"') from error
    return pyarrow
