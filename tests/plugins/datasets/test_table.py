"""The Parquet table: read back equal, by pyarrow and pandas-like lists, with a schema that says its version."""

from __future__ import annotations

import re
from io import BytesIO
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

import glyphspline as gs
from glyphspline.fitting.results import Measures
from glyphspline.plugins.datasets import table
from glyphspline.plugins.datasets.table import schema, write_table
from glyphspline.readers import open_font
from tests.drawings import L_SHAPE, polygon_contour, result
from tests.places import FONTS


def test_every_contour_is_read_back_equal(tmp_path: Path) -> None:
    source = open_font(FONTS / "kouzan-gyosho.otf")
    options = gs.Options(corners="smooth", tolerance=4.0)
    results = [gs.convert(source.outline(name), options) for name in source.select(text="O a")]
    count = write_table(source, results, tmp_path / "t.parquet")
    read = pq.read_table(tmp_path / "t.parquet")
    assert read.schema.metadata[b"glyphspline.schema"] == b"2"
    rows = read.to_pylist()
    expected = [(glyph, k, contour) for glyph in results for k, contour in enumerate(glyph.contours)]
    assert len(rows) == len(expected) == count > 3
    for row, (glyph, k, contour) in zip(rows, expected, strict=True):
        assert (row["glyph"], row["gid"], row["contour"]) == (glyph.outline.name, glyph.outline.gid, k)
        assert (row["font"], tuple(row["codepoints"])) == (source.family, glyph.outline.unicodes)
        (one,) = contour.interpolations
        spline = gs.Spline(row["control_points"][0], row["knots"][0], row["degree"][0], row["closed"][0])
        np.testing.assert_array_equal(spline.to_bezier(), one.spline.to_bezier())
        whole = gs.Spline(row["spline_points"], row["spline_knots"])
        np.testing.assert_array_equal(whole.to_bezier(), one.spline.to_bezier())
        np.testing.assert_array_equal(row["footpoints"][0], one.parameters)
        np.testing.assert_array_equal(row["polygon"], contour.polygon)
        np.testing.assert_array_equal(row["bezier_points"], contour.curve.points)
        np.testing.assert_array_equal(row["source_points"], contour.source.points)
        assert row["source_degrees"] == contour.source.degrees.tolist()
        assert Measures(**{name: row[name] for name in Measures.__dataclass_fields__}) == contour.measures


def test_row_groups_are_bounded_and_bytes_the_same() -> None:
    source = open_font(FONTS / "edge-cases.ttf")
    glyphs = [result(polygon_contour(L_SHAPE), name=str(k), gid=k) for k in range(8)]
    files = [BytesIO(), BytesIO()]
    for file in files:
        assert write_table(source, iter(glyphs), file, group=3) == 8
    assert files[0].getvalue() == files[1].getvalue()
    assert pq.ParquetFile(BytesIO(files[0].getvalue())).num_row_groups == 3


def test_no_glyphs_make_an_empty_table_with_all_columns() -> None:
    file = BytesIO()
    assert write_table(open_font(FONTS / "edge-cases.ttf"), [], file) == 0
    assert pq.read_table(BytesIO(file.getvalue())).schema.names == schema().names


def test_every_column_is_documented() -> None:
    documented = set(re.findall(r"\w+", table.__doc__ or ""))
    assert {name for name in schema().names if name not in Measures.__dataclass_fields__} <= documented
