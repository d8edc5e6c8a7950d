"""The columns of a data set's rows, without those of their fonts: schema version 1.

With ``rows="glyph"`` each column marked * is a list with an item for each contour; with ``rows="contour"`` it is that
item. Contours are stored by the rules of :mod:`..outlines.canonical_outlines`, whatever way the font has them. Lengths
are in em or in font units (*normalise*), y up; the metadata of each field says its unit.

================== ======================== ============================================================================
schema_version     uint16                   of the row
glyph, gid         string, uint32           glyph name and index
codepoints         list<uint32>             its characters, ascending
characters         string                   the same as text
advance            double
em                 double                   in the row's unit of length: 1, or units per em
shape              string                   hash of the outline in em, rounded to 1/10,000 em: equal shapes have equal
                                            ones; null where there is no contour
contour            uint32                   with rows="contour": which of the glyph, from 0
points *           list<point>              at equal arc lengths of the exact curve, from its point with the least x + y
                                            on; the curve is the fit, if there is one, or else the outline. Or, with
                                            ``points=None``, the vertices of the polygon, or the points where segments
                                            meet, from that with the least x + y on
tangents *         list<point>              of length 1, at the points; at a corner, of what follows it
curvature *        list<float>              signed, at the points: positive where the contour turns left, as an outer
                                            contour does where it is convex; null at a cusp
corner *           list<bool>               whether the point is the nearest, along the contour, of a corner
source_degrees *   list<uint8>              of the Bézier segments of the outline
source_points *    list<point>              their points, each shared end once
polygon *          list<point>              of the fit, as in :mod:`..writers.parquet`; null where nothing is fitted,
                                            like all that follow but the raster
closed *           list<bool>
degree *           list<uint8>
knots *            list<list<double>>
control_points *   list<list<point>>
footpoints *       list<list<double>>
bezier_degrees *   list<uint8>
bezier_points *    list<point>
vertices *, …,     as in :class:`.Measures` null where it was not computed
source_kept *
raster             list<list<uint8>>        grey picture of the outline, first row on top: 255 where ink covers a pixel
================== ======================== ============================================================================

A *point* is a list (x, y): of float in ``points`` and ``tangents``, of double elsewhere. Lists of ``points`` points,
and the rows of a raster, have a fixed size in the schema too.
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
    metadata = {f"glyphspline.dataset.{name}": value for name, value in said.items()}
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
