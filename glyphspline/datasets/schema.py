"""The columns of a data set's rows, without those of their fonts: schema version 1.

:mod:`.dataset_columns` says what they hold.

With ``rows="glyph"`` each column of :func:`contour_types` is a list with an item for each contour; with
``rows="contour"`` it is that item. Contours are stored by the rules of :mod:`..outlines.canonical_outlines`, whatever
way the font has them. Lengths are in em or in font units (*normalise*), y up; the metadata of each field says its unit.

A *point* is a list (x, y): of float in ``points`` and ``tangents``, of double elsewhere. Lists of ``points`` points,
and the rows of a raster, have a fixed size in the schema too. A measure is null where it was not computed.
"""

from __future__ import annotations

from typing import Any

from ..writers.arrow_columns import POWERS, arrow, fit_types, measure_types, source_types
from .dataset_spec import DatasetSpec

SCHEMA_VERSION = 1
"""Of the rows. A program reads the rows of its own version and of all before."""

LENGTHS = (
    "advance", "em", "points", "source_points", "polygon", "knots", "control_points", "footpoints",
    "bezier_points",
)  # fmt: skip
"""Columns in the unit of length, beside the measures."""


def schema(spec: DatasetSpec) -> Any:
    """The columns of this module's table as an Arrow schema, with units as metadata of the fields."""
    pa = arrow()
    powers = dict.fromkeys(LENGTHS, 1) | POWERS | {"curvature": -1}
    unit = "em" if spec.normalise == "em" else "font unit"
    units = {name: {1: unit, 2: f"{unit}^2", -1: f"1/{unit}"}[power] for name, power in powers.items()}

    def field(name: str, kind: Any) -> Any:
        return pa.field(name, kind, metadata={"unit": units[name]} if name in units else None)

    listed = contour_types(spec)
    if spec.rows == "glyph":
        listed = {name: pa.list_(kind) for name, kind in listed.items()}
    else:
        listed = {"contour": pa.uint32()} | listed
    kinds = glyph_types() | listed
    if spec.raster is not None:
        kinds["raster"] = pa.list_(pa.list_(pa.uint8(), spec.raster), spec.raster)
    said = {"schema": str(SCHEMA_VERSION), "rows": spec.rows, "unit": unit}
    metadata = {f"glyphspline.datasets.{name}": value for name, value in said.items()}
    return pa.schema([field(name, kind) for name, kind in kinds.items()], metadata=metadata)


def glyph_types() -> dict[str, Any]:
    """Arrow types of the columns that a glyph has."""
    pa = arrow()
    return {
        "schema_version": pa.uint16(),
        "glyph": pa.string(),
        "gid": pa.uint32(),
        "codepoints": pa.list_(pa.uint32()),
        "characters": pa.string(),
        "advance": pa.float64(),
        "em": pa.float64(),
        "shape": pa.string(),
    }


def point_types(spec: DatasetSpec) -> dict[str, Any]:
    """Arrow types of the columns that describe a contour by points."""
    pa = arrow()
    point, size = pa.list_(pa.float32(), 2), -1 if spec.points is None else spec.points
    kinds = {"points": point, "tangents": point, "curvature": pa.float32(), "corner": pa.bool_()}
    return {name: pa.list_(kind, size) for name, kind in kinds.items()}


def contour_types(spec: DatasetSpec) -> dict[str, Any]:
    """Arrow types of the columns that a contour has."""
    return point_types(spec) | source_types() | fit_types() | measure_types()
