"""A row of a data set as the package's own values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...curves.bspline import Spline
from ...errors import GlyphsplineError
from ...outlines.outline import Contour, FontMetrics, Outline
from ...types import FloatArray, counted
from .columns import SCHEMA_VERSION


@dataclass(frozen=True, eq=False)
class Loaded:
    """What a row of a data set holds, in the row's unit of length: em, or font units.

    Attributes:
        outline: the glyph, or the one contour of the row, as :func:`.canonical_outlines` has it.
        splines: of each contour, in curve order; None where nothing was fitted.
        whole_splines: one of each contour, see :attr:`.ContourResult.spline`; None also for rows of schema version 1.
        points: (n, 2) of each contour.
    """

    outline: Outline
    splines: tuple[tuple[Spline, ...], ...] | None
    points: tuple[FloatArray, ...]
    whole_splines: tuple[Spline | None, ...] | None = None

    def __repr__(self) -> str:
        splines = "no splines" if self.splines is None else counted(sum(map(len, self.splines)), "spline")
        return f"<Loaded {self.outline}, {splines}, {counted(sum(map(len, self.points)), 'point')}>"


def load(row: Mapping[str, Any]) -> Loaded:
    """Outline, splines and points of a row of a data set.

    Args:
        row: of a table that ``glyphspline dataset`` wrote, by column: as pyarrow's ``to_pylist``, the library
            ``datasets``, or pandas' ``iloc`` and ``to_dict`` give it. Columns of the font may be missing.

    Raises:
        GlyphsplineError: a column is missing, or the row is of a version of the schema that this program does not know.

    Example:
        >>> from glyphspline import load, open_font
        >>> from glyphspline.datasets.rows import table_of
        >>> from glyphspline.datasets.spec import DatasetSpec
        >>> outlines = [open_font("fonts_test/kouzan-gyosho.ttf").outline("O")]
        >>> row, = table_of(outlines, None, DatasetSpec(options=None)).to_pylist()
        >>> load(row).outline
        <Outline 'O' gid 6 U+004F: 2 contours, 47 segments, advance 0.50293, 1 units per em>
    """
    try:
        version = int(row["schema_version"])
        if not 1 <= version <= SCHEMA_VERSION:
            raise GlyphsplineError(
                f"the row is of schema version {version}, and this program reads versions up to {SCHEMA_VERSION}:"
                " a newer glyphspline is needed"
            )
        return _loaded(row)
    except KeyError as error:
        raise GlyphsplineError(f"the row has no column {error.args[0]!r}") from error


def _loaded(row: Mapping[str, Any]) -> Loaded:
    def each(name: str) -> list[Any]:
        return [row[name]] if "contour" in row else list(row[name])

    contours = [
        Contour(_points(points), np.array(list(degrees), dtype=np.int64))
        for points, degrees in zip(each("source_points"), each("source_degrees"), strict=True)
    ]
    em = float(row["em"])
    ascender, descender = (row.get(name) for name in ("ascender", "descender"))
    if ascender is None or descender is None:
        metrics = FontMetrics(em, 0.8 * em, -0.2 * em)
    else:
        metrics = FontMetrics(em, float(ascender), float(descender))
    unicodes = tuple([int(code) for code in row["codepoints"]])
    outline = Outline(row["glyph"], int(row["gid"]), unicodes, float(row["advance"]), contours, metrics)
    splines = whole = None
    if not (row["knots"] is None or isinstance(row["knots"], float)):  # pandas: None or NaN
        columns = zip(*map(each, ("control_points", "knots", "degree", "closed")), strict=True)
        splines = tuple([
            tuple([
                Spline(_points(rows), np.array(list(knots), dtype=np.float64), int(degree), bool(closed))
                for rows, knots, degree, closed in zip(*of_contour, strict=True)
            ])
            for of_contour in columns
        ])  # fmt: skip
        if int(row["schema_version"]) > 1:
            columns = zip(each("spline_points"), each("spline_knots"), strict=True)
            whole = tuple([
                Spline(_points(rows), np.array(list(knots), dtype=np.float64)) if len(rows) else None
                for rows, knots in columns
            ])  # fmt: skip
    return Loaded(outline, splines, tuple([_points(points) for points in each("points")]), whole)


def _points(rows: Any) -> FloatArray:
    """(n, 2) of lists of lists, or of pandas' arrays of arrays."""
    return np.array([tuple(point) for point in rows], dtype=np.float64).reshape(-1, 2)
